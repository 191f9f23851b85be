//! Inputs of a case in the tables of a study file; [`KEYS`] lists which table takes which key.
//!
//! [`KEYS`]: crate::case::keys::KEYS

use crate::case::keys::{KEYS, Key, Kind};
use crate::study::reading::{Placed, Typed};
use oedometer_problem::method::{
    Basis, Configuration, Memory, Method, PressureIntegration, Quadrature, Recovery, StrainGradient,
};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::Value;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error, ValueDeserializer};

/// The value of an input as it was typed.
#[derive(Clone, Debug)]
pub enum TypedInput {
    MethodName(String),
    MethodChoices(Box<MethodTable>),
    TimeStep(TimeStepTable),
    Word(&'static str),
    Flag(bool),
    Count(i64),
    Number(f64),
    /// Several values, in a sweep.
    List(Vec<One>),
}

/// An input with its place.
pub type One = Placed<TypedInput>;

/// The inputs that a table names, in the order of the table of keys.
#[derive(Debug, Default)]
pub struct Inputs(pub Vec<(&'static Key, One)>);

impl Inputs {
    /// Takes the inputs out of a table that takes those `of` a name; the remaining keys belong to the table.
    fn take(table: &mut DeTable<'_>, of: &str, are_lists: bool) -> Result<Self, Error> {
        let taken = Key::in_table(of).filter_map(|key| Some((key, table.remove(key.name)?)));
        let inputs = taken.map(|(key, value)| Ok((key, typed(key.kind, value, are_lists)?)));
        inputs.collect::<Result<_, Error>>().map(Self)
    }

    /// What was typed for a key.
    pub fn typed(&self, name: &str) -> Option<&One> {
        self.0.iter().find(|(key, _)| key.name == name).map(|(_, typed)| typed)
    }

    /// The place of a key's value.
    pub fn span(&self, name: &str) -> Option<Range<usize>> {
        self.typed(name).map(Placed::span)
    }

    /// Values of a key that a sweep lists, each with its place.
    pub fn list(&self, name: &str) -> &[One] {
        match self.typed(name).map(|typed| &**typed) {
            Some(TypedInput::List(list)) => list,
            _ => &[],
        }
    }

    /// The place of the first value.
    pub fn first_span(&self) -> Option<Range<usize>> {
        self.0.iter().map(|(_, typed)| typed.span()).min_by_key(|span| span.start)
    }
}

/// Takes the inputs out of every table of a name, which may be repeated.
pub fn take_inputs(
    root: &mut DeTable<'_>,
    table: &str,
    of: &str,
    are_lists: bool,
) -> Result<Vec<Inputs>, Error> {
    match root.get_mut(table).map(Spanned::as_mut) {
        Some(DeValue::Table(table)) => Ok(vec![Inputs::take(table, of, are_lists)?]),
        Some(DeValue::Array(_)) if table == of && !are_lists => Err(refused("a table is expected")),
        Some(DeValue::Array(blocks)) => {
            let tables = blocks.iter_mut().filter_map(|block| match block.as_mut() {
                DeValue::Table(table) => Some(table),
                _ => None,
            });
            tables.map(|table| Inputs::take(table, of, are_lists)).collect()
        }
        _ => Ok(Vec::new()),
    }
}

fn typed(kind: Kind, value: Spanned<DeValue<'_>>, is_list: bool) -> Result<One, Error> {
    let place = value.span();
    let input = match (value.get_ref(), kind) {
        (DeValue::Array(_), _) if is_list => {
            let DeValue::Array(list) = value.into_inner() else { return Err(refused("a list")) };
            let values = list.into_iter().map(|item| typed(kind, item, false));
            return Ok(Placed::new(place, TypedInput::List(values.collect::<Result<_, Error>>()?)));
        }
        _ if is_list => return Err(refused("a list is expected")),
        (DeValue::String(name), Kind::Method) => TypedInput::MethodName(name.to_string()),
        (DeValue::String(word), Kind::Word(words)) => {
            let word = words.iter().find(|known| **known == word.as_ref());
            TypedInput::Word(word.ok_or_else(|| refused("an unknown word"))?)
        }
        (_, Kind::Word(_)) => return Err(refused("a word is expected")),
        (_, Kind::Method) => TypedInput::MethodChoices(Box::new(MethodTable::deserialize(reader(value))?)),
        (_, Kind::TimeStep) => TypedInput::TimeStep(TimeStepTable::deserialize(reader(value))?),
        (_, Kind::Flag) => TypedInput::Flag(bool::deserialize(reader(value))?),
        (_, Kind::Count(_)) => TypedInput::Count(i64::deserialize(reader(value))?),
        (_, Kind::Number(_)) => TypedInput::Number(f64::deserialize(reader(value))?),
    };
    Ok(Placed::new(place, input))
}

fn refused(what: &str) -> Error {
    serde::de::Error::custom(what)
}

fn reader(value: Spanned<DeValue<'_>>) -> ValueDeserializer<'_> {
    ValueDeserializer::from(value)
}

/// Adds the inputs `of` a name to the schema of a table that takes them.
pub fn add_inputs(schema: &mut Schema, of: &str, are_lists: bool) {
    let settings = SchemaSettings::draft2020_12().for_deserialize();
    let mut generator = settings.with(|settings| settings.inline_subschemas = true).into_generator();
    let properties = schema.ensure_object().entry("properties").or_insert(serde_json::json!({}));
    for key in Key::in_table(of) {
        let value = schema_of_values(key, &mut generator);
        let mut schema = if are_lists { json_schema!({ "type": "array", "items": value }) } else { value };
        schema.insert("description".to_owned(), key.description().into());
        properties[key.name] = schema.into();
    }
}

/// SI unit of the number that a key of a study file takes, where it has one.
pub fn unit_of(name: &str) -> Option<&'static str> {
    let of_key = || KEYS.iter().find(|key| key.name == name).map(|key| key.unit);
    if name == "thickness" { Some("m") } else { of_key().filter(|unit| !unit.is_empty()) }
}

/// Lets numbers stand with their unit in the schema of a list of soils.
pub fn add_units(schema: &mut Schema) {
    let properties = schema.ensure_object().get_mut("items").and_then(|items| items.get_mut("properties"));
    for (name, value) in properties.and_then(Value::as_object_mut).into_iter().flatten() {
        if let Some(unit) = unit_of(name) {
            value["type"] = serde_json::json!(["number", "string"]);
            value["unit"] = unit.into();
        }
    }
}

/// Schema of the values of a key.
fn schema_of_values(key: &Key, generator: &mut SchemaGenerator) -> Schema {
    match key.kind {
        Kind::Method => {
            let choices = MethodTable::json_schema(generator);
            // The name of a solver is any plain word.
            let solver = json_schema!({ "type": "string", "pattern": "^[A-Za-z][A-Za-z0-9._-]*$" });
            json_schema!({ "anyOf": [{ "enum": Method::names() }, solver, choices] })
        }
        Kind::TimeStep => TimeStepTable::json_schema(generator),
        Kind::Word(words) => json_schema!({ "enum": words }),
        Kind::Flag => json_schema!({ "type": "boolean" }),
        Kind::Count(_) => json_schema!({ "type": "integer" }),
        Kind::Number(_) if !key.unit.is_empty() => {
            json_schema!({ "type": ["number", "string"], "unit": key.unit })
        }
        Kind::Number(_) => json_schema!({ "type": "number" }),
    }
}

/// A rule of the time step: exactly one of its keys.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeStepTable {
    /// Safety factor: the step over the predicted critical step.
    pub stable: Typed<f64>,
    /// Courant number of the fastest wave.
    pub courant: Typed<f64>,
    /// Step, s.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub seconds: Typed<f64>,
    /// The step over the elapsed time.
    pub growth: Typed<f64>,
    /// Bound on the estimated error in time, relative to the load and to the settlement it makes.
    pub tolerance: Typed<f64>,
}

/// A method, choice by choice.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MethodTable {
    /// Shape functions between points and nodes.
    pub basis: Basis,
    /// Gradient that gives the strain for the effective stress.
    pub strain: StrainGradient,
    /// How the pore pressure is integrated.
    pub pressure: PressureIntegration,
    /// How a field is recovered from the pressures of cells.
    pub recovery: Typed<Recovery>,
    /// Where the pressure is stored.
    #[serde(default)]
    pub memory: Memory,
    /// Integration volume of a point.
    #[serde(default)]
    pub quadrature: Quadrature,
    /// Parameter of a pressure projection relative to the published one, 1 by default.
    pub projection: Typed<f64>,
    /// Configuration in which the operators act.
    pub configuration: Typed<Configuration>,
}
