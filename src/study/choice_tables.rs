//! Typed values with their places, and the tables of choices that are a value themselves: a method, a step rule.

use crate::case::keys::Choice;
use crate::study::reading::toml_tree;
use oedometer_mpm::method::{Basis, Configuration, Memory, PressureIntegration, Recovery, StrainGradient};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::Deref;
use toml::Spanned;

/// A value with its place in the text.
#[derive(Clone, Debug)]
pub struct Placed<T>(Spanned<T>);

/// A word that names one of the choices of a type; judged later, at its place.
#[derive(Clone, Debug, Deserialize)]
#[serde(transparent)]
pub struct Named<T>(String, PhantomData<T>);

/// A typed value with its place.
pub type Typed<T> = Option<Placed<T>>;
/// A typed list with the places of its values.
pub type TypedList<T> = Option<Placed<Vec<Placed<T>>>>;

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Placed<T> {
    fn deserialize<D: Deserializer<'de>>(tree: D) -> Result<Self, D::Error> {
        toml_tree::with_place(tree).map(Self)
    }
}

impl<T> Deref for Placed<T> {
    type Target = Spanned<T>;
    fn deref(&self) -> &Spanned<T> {
        &self.0
    }
}

impl<T> Placed<T> {
    /// The value without its place.
    pub fn into_inner(self) -> T {
        self.0.into_inner()
    }
}

impl<T> Named<T> {
    /// The word.
    pub fn word(&self) -> &str {
        &self.0
    }
}

impl<T: JsonSchema> JsonSchema for Placed<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

impl<T: Choice> JsonSchema for Named<T> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<T>().into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "enum": T::words() })
    }
}

/// A rule of the time step: exactly one of its keys.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeStepTable {
    /// Share of the predicted critical step.
    pub stable: Typed<f64>,
    /// Share of a cell that the fastest wave crosses in a step.
    pub courant: Typed<f64>,
    /// Step, s.
    pub seconds: Typed<f64>,
    /// Step over the time that has passed.
    pub growth: Typed<f64>,
    /// Bound on the estimated error in time, relative to the load and to the settlement it makes.
    pub tolerance: Typed<f64>,
}

/// A method, choice by choice.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MethodTable {
    /// Weights between points and nodes.
    pub basis: Typed<Named<Basis>>,
    /// Gradient from which the effective stress takes its strain.
    pub strain: Typed<Named<StrainGradient>>,
    /// How the pore pressure is integrated.
    pub pressure: Typed<Named<PressureIntegration>>,
    /// How the pressure of a cell becomes a field again.
    pub recovery: Typed<Named<Recovery>>,
    /// Where the pressure is remembered.
    pub memory: Typed<Named<Memory>>,
    /// Configuration on which the operators live.
    pub configuration: Typed<Named<Configuration>>,
}
