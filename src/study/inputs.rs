//! Tables of a study file that name inputs of a case: which keys they take stands in [`KEYS`].
//!
//! [`KEYS`]: crate::case::keys::KEYS

use crate::case::keys::{Key, Kind};
use crate::study::choice_tables::{MethodTable, Placed, TimeStepTable};
use oedometer_mpm::method::Method;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};
use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;
use toml::Spanned;

/// The value of an input as it was typed.
#[derive(Clone, Debug)]
pub enum TypedInput {
    Method(MethodEntry),
    TimeStep(TimeStepTable),
    Word(String),
    Flag(bool),
    Count(i64),
    Number(f64),
}

/// A method by name or by its choices.
#[derive(Clone, Debug)]
pub enum MethodEntry {
    Name(String),
    Choices(Box<MethodTable>),
}

/// An input with its place.
pub type One = Spanned<TypedInput>;
/// Several values of an input with their places.
pub type List = Spanned<Vec<One>>;

/// A table of inputs, each with one value or with several, and of keys of its own.
#[derive(Debug)]
pub struct InputTable<V, Own> {
    /// The inputs in the order of the file.
    pub inputs: Vec<(&'static Key, V)>,
    own: Own,
}

/// The keys that a table has beside inputs.
pub trait OwnKeys {
    /// Which inputs it takes: those of this table in the table of keys.
    const TABLE: &'static str;
}

/// What an input holds in a table: one value, or a list.
pub trait HeldKey: Sized {
    /// Reads values of a type.
    fn read<'de, T: Deserialize<'de>, A: MapAccess<'de>>(
        map: &mut A,
        typed: fn(T) -> TypedInput,
    ) -> Result<Self, A::Error>;
    /// Schema of what holds values of a schema.
    fn schema(value: Schema) -> Schema;
}

impl<V, Own> Deref for InputTable<V, Own> {
    type Target = Own;
    fn deref(&self) -> &Own {
        &self.own
    }
}

impl<V, Own: Default> Default for InputTable<V, Own> {
    fn default() -> Self {
        Self { inputs: Vec::new(), own: Own::default() }
    }
}

impl<V, Own> InputTable<V, Own> {
    /// What was typed for a key.
    pub fn typed(&self, name: &str) -> Option<&V> {
        self.inputs.iter().find(|(key, _)| key.name == name).map(|(_, typed)| typed)
    }
}

fn placed<T>(value: Placed<T>, typed: fn(T) -> TypedInput) -> One {
    Spanned::new(value.span(), typed(value.into_inner()))
}

impl HeldKey for One {
    fn read<'de, T: Deserialize<'de>, A: MapAccess<'de>>(
        map: &mut A,
        typed: fn(T) -> TypedInput,
    ) -> Result<Self, A::Error> {
        Ok(placed(map.next_value()?, typed))
    }
    fn schema(value: Schema) -> Schema {
        value
    }
}

impl HeldKey for List {
    fn read<'de, T: Deserialize<'de>, A: MapAccess<'de>>(
        map: &mut A,
        typed: fn(T) -> TypedInput,
    ) -> Result<Self, A::Error> {
        let list: Placed<Vec<Placed<T>>> = map.next_value()?;
        let span = list.span();
        Ok(Spanned::new(span, list.into_inner().into_iter().map(|one| placed(one, typed)).collect()))
    }
    fn schema(value: Schema) -> Schema {
        json_schema!({ "type": "array", "items": value })
    }
}

/// Reads the value of a key.
fn read<'de, H: HeldKey, A: MapAccess<'de>>(key: &Key, map: &mut A) -> Result<H, A::Error> {
    match key.kind {
        Kind::Method => H::read(map, TypedInput::Method),
        Kind::TimeStep => H::read(map, TypedInput::TimeStep),
        Kind::Word(_) => H::read(map, TypedInput::Word),
        Kind::Flag => H::read(map, TypedInput::Flag),
        Kind::Count(_) => H::read(map, TypedInput::Count),
        Kind::Number(_) => H::read(map, TypedInput::Number),
    }
}

impl<'de, H: HeldKey, Own: Deserialize<'de> + OwnKeys> Deserialize<'de> for InputTable<H, Own> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut inputs = Vec::new();
        let own = Own::deserialize(Parted { inner: deserializer, table: Own::TABLE, inputs: &mut inputs })?;
        Ok(Self { inputs, own })
    }
}

/// A deserialiser, visitor or map that keeps the inputs back and passes on the keys of the table's own.
struct Parted<'a, T, V> {
    inner: T,
    table: &'static str,
    inputs: &'a mut Vec<(&'static Key, V)>,
}

impl<'de, D: Deserializer<'de>, H: HeldKey> Deserializer<'de> for Parted<'_, D, H> {
    type Error = D::Error;

    fn deserialize_struct<W: Visitor<'de>>(
        self,
        _: &'static str,
        own: &'static [&'static str],
        visitor: W,
    ) -> Result<W::Value, D::Error> {
        let Self { inner, table, inputs } = self;
        inner.deserialize_map(Parted { inner: (visitor, own), table, inputs })
    }

    fn deserialize_any<W: Visitor<'de>>(self, visitor: W) -> Result<W::Value, D::Error> {
        self.inner.deserialize_any(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

impl<'de, W: Visitor<'de>, H: HeldKey> Visitor<'de> for Parted<'_, (W, &'static [&'static str]), H> {
    type Value = W::Value;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.0.expecting(out)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<W::Value, A::Error> {
        let Self { inner: (visitor, own), table, inputs } = self;
        visitor.visit_map(Parted { inner: (map, own), table, inputs })
    }
}

impl<'de, A: MapAccess<'de>, H: HeldKey> MapAccess<'de> for Parted<'_, (A, &'static [&'static str]), H> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        let (map, own) = &mut self.inner;
        let mut seed = seed;
        loop {
            match map.next_key_seed(AnyKey { table: self.table, own, seed })? {
                None => return Ok(None),
                Some(FoundInput::Own(key)) => return Ok(Some(key)),
                Some(FoundInput::Input(key, unused)) => {
                    self.inputs.push((key, read(key, map)?));
                    seed = unused;
                }
            }
        }
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, A::Error> {
        self.inner.0.next_value_seed(seed)
    }
}

/// Reads a key that may be an input's or the table's own.
struct AnyKey<'a, K> {
    table: &'static str,
    own: &'a [&'static str],
    seed: K,
}

enum FoundInput<T, K> {
    Own(T),
    Input(&'static Key, K),
}

impl<'de, K: DeserializeSeed<'de>> DeserializeSeed<'de> for AnyKey<'_, K> {
    type Value = FoundInput<K::Value, K>;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl<'de, K: DeserializeSeed<'de>> Visitor<'de> for AnyKey<'_, K> {
    type Value = FoundInput<K::Value, K>;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        if let Some(key) = Key::named(name, self.table) {
            return Ok(FoundInput::Input(key, self.seed));
        }
        if self.own.contains(&name) {
            return self.seed.deserialize(StrDeserializer::new(name)).map(FoundInput::Own);
        }
        let known = Key::of(self.table).map(|key| key.name).chain(self.own.iter().copied());
        let known: Vec<String> = known.map(|name| format!("`{name}`")).collect();
        Err(E::custom(format!("unknown field `{name}`, expected one of {}", known.join(", "))))
    }
}

impl<'de> Deserialize<'de> for MethodEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TypedEntry;
        impl<'de> Visitor<'de> for TypedEntry {
            type Value = MethodEntry;
            fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
                out.write_str("the name of a method or a table of its choices")
            }
            fn visit_str<E>(self, name: &str) -> Result<MethodEntry, E> {
                Ok(MethodEntry::Name(name.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MethodEntry, A::Error> {
                MethodTable::deserialize(MapAccessDeserializer::new(map))
                    .map(|table| MethodEntry::Choices(Box::new(table)))
            }
        }
        deserializer.deserialize_any(TypedEntry)
    }
}

impl<H: HeldKey, Own: JsonSchema + OwnKeys> JsonSchema for InputTable<H, Own> {
    fn schema_name() -> Cow<'static, str> {
        Own::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = Own::json_schema(generator);
        let own = schema.get("properties").and_then(|own| own.as_object().cloned()).unwrap_or_default();
        let mut properties = serde_json::Map::new();
        for key in Key::of(Own::TABLE) {
            let mut one = H::schema(schema_of_values(key, generator));
            one.insert("description".to_owned(), key.description().into());
            properties.insert(key.name.to_owned(), one.into());
        }
        properties.extend(own);
        schema.insert("properties".to_owned(), properties.into());
        schema
    }
}

/// Schema of the values of a key.
fn schema_of_values(key: &Key, generator: &mut SchemaGenerator) -> Schema {
    match key.kind {
        Kind::Method => {
            let choices = MethodTable::json_schema(generator);
            // The name of an attached solver is any plain word.
            let solver = json_schema!({ "type": "string", "pattern": "^[A-Za-z][A-Za-z0-9._-]*$" });
            json_schema!({ "anyOf": [{ "enum": Method::names() }, solver, choices] })
        }
        Kind::TimeStep => TimeStepTable::json_schema(generator),
        Kind::Word(words) => json_schema!({ "enum": words() }),
        Kind::Flag => json_schema!({ "type": "boolean" }),
        Kind::Count(_) => json_schema!({ "type": "integer" }),
        Kind::Number(_) => json_schema!({ "type": "number" }),
    }
}
