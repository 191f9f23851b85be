//! The shape of a type, as its deserialiser asks for it.

use serde_json::{Map, Value, json};

/// Shape of a value.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Node {
    /// Not asked for yet.
    #[default]
    Unseen,
    /// True or false.
    Boolean,
    /// A whole number.
    Integer,
    /// A number.
    Number,
    /// Words.
    Text,
    /// Whatever its visitor takes.
    Any,
    /// Nothing, or a value.
    Optional(Box<Node>),
    /// A list of values.
    List(Box<Node>),
    /// Values by any name.
    Map(Box<Node>),
    /// Values by known names.
    Object(Vec<Field>),
    /// One of several variants: their names, and what they hold where they hold something.
    OneOf(Vec<(String, Option<Node>)>),
}

/// A named value of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// Whether the value must be there.
    pub required: bool,
    /// Shape of the value.
    pub node: Node,
}

impl Node {
    /// Whether a variant somewhere below has not been asked for.
    pub fn is_incomplete(&self) -> bool {
        match self {
            Self::Optional(inner) | Self::List(inner) | Self::Map(inner) => inner.is_incomplete(),
            Self::Object(fields) => fields.iter().any(|field| field.node.is_incomplete()),
            Self::OneOf(variants) => {
                variants.iter().any(|(_, held)| held.as_ref().is_some_and(Self::is_unseen_or_incomplete))
            }
            _ => false,
        }
    }

    /// Names of the variants that hold nothing.
    pub fn words(&self) -> Vec<String> {
        match self {
            Self::OneOf(variants) => {
                variants.iter().filter(|(_, held)| held.is_none()).map(|(name, _)| name.clone()).collect()
            }
            _ => Vec::new(),
        }
    }

    fn is_unseen_or_incomplete(&self) -> bool {
        *self == Self::Unseen || self.is_incomplete()
    }

    /// The JSON Schema of the shape. `words` knows the words that a key allows where its type is
    /// text, `describe` what a key means.
    pub fn to_schema(&self, key: &str, language: &Language) -> Value {
        match self {
            Self::Unseen => json!({}),
            Self::Boolean => json!({ "type": "boolean" }),
            Self::Integer => json!({ "type": "integer" }),
            Self::Number => json!({ "type": "number" }),
            Self::Any => language.any(key),
            Self::Text => match language.words(key) {
                Some(words) => json!({ "enum": words }),
                None => json!({ "type": "string" }),
            },
            Self::Optional(inner) => {
                let inner = inner.to_schema(key, language);
                if language.has_null { json!({ "anyOf": [inner, { "type": "null" }] }) } else { inner }
            }
            Self::List(inner) => json!({ "type": "array", "items": inner.to_schema(key, language) }),
            Self::Map(inner) => {
                json!({ "type": "object", "additionalProperties": inner.to_schema(key, language) })
            }
            Self::Object(fields) => object(fields, language),
            Self::OneOf(variants) => one_of(variants, language),
        }
    }
}

/// What a schema says beyond the shapes.
#[derive(Clone, Debug, Default)]
pub struct Language {
    /// Whether nothing is written as null; else its key is left out.
    pub has_null: bool,
    /// Words that a key allows.
    pub words: Vec<(&'static str, Vec<String>)>,
    /// What a key means, with its unit.
    pub descriptions: &'static [(&'static str, &'static str)],
    /// Schema of a key that takes several types.
    pub any: Vec<(&'static str, Value)>,
}

impl Language {
    fn words(&self, key: &str) -> Option<&Vec<String>> {
        self.words.iter().find(|(known, _)| *known == key).map(|(_, words)| words)
    }

    fn any(&self, key: &str) -> Value {
        self.any.iter().find(|(known, _)| *known == key).map_or(json!({}), |(_, schema)| schema.clone())
    }
}

fn object(fields: &[Field], language: &Language) -> Value {
    let mut properties = Map::new();
    for field in fields {
        let mut schema = field.node.to_schema(&field.name, language);
        let described = language.descriptions.iter().find(|(key, _)| *key == field.name);
        if let (Some((_, text)), Some(schema)) = (described, schema.as_object_mut()) {
            schema.insert("description".to_owned(), (*text).into());
        }
        properties.insert(field.name.clone(), schema);
    }
    let required: Vec<&str> =
        fields.iter().filter(|field| field.required).map(|field| field.name.as_str()).collect();
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// Unit variants are words; the others are objects of one key, as serde writes them.
fn one_of(variants: &[(String, Option<Node>)], language: &Language) -> Value {
    let words: Vec<&str> =
        variants.iter().filter(|(_, held)| held.is_none()).map(|(name, _)| name.as_str()).collect();
    let mut choices: Vec<Value> = Vec::new();
    if !words.is_empty() {
        choices.push(json!({ "enum": words }));
    }
    for (name, held) in variants {
        if let Some(held) = held {
            choices.push(json!({
                "type": "object",
                "properties": { name.as_str(): held.to_schema(name, language) },
                "required": [name],
                "additionalProperties": false,
            }));
        }
    }
    if choices.len() == 1 { choices.swap_remove(0) } else { json!({ "anyOf": choices }) }
}
