//! What a key of `[columns]` names: one column or array, or one column per height.

use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// The column or columns of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnName {
    /// A column or an array; another column has the heights.
    Single(String),
    /// Columns with the height that each stands for, in the unit of places.
    ByHeight(Vec<(String, f64)>),
}

impl ColumnName {
    /// The name of a single column.
    pub fn single(&self) -> Option<&String> {
        match self {
            Self::Single(name) => Some(name),
            Self::ByHeight(_) => None,
        }
    }

    /// Whether it names nothing.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Single(name) => name.is_empty(),
            Self::ByHeight(columns) => columns.is_empty(),
        }
    }
}

impl<'de> Deserialize<'de> for ColumnName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Names)
    }
}

struct Names;

impl<'de> Visitor<'de> for Names {
    type Value = ColumnName;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(
            "the name of a column, or a table of columns with their heights, like { \"p0\" = 0.0 }",
        )
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<ColumnName, E> {
        Ok(ColumnName::Single(name.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ColumnName, A::Error> {
        let mut columns = Vec::new();
        while let Some((name, height)) = map.next_entry::<String, f64>()? {
            if !height.is_finite() {
                return Err(A::Error::custom(format!("the height of `{name}` is not finite")));
            }
            columns.push((name, height));
        }
        // By height, whatever the order in the file.
        columns.sort_by(|a, b| a.1.total_cmp(&b.1));
        Ok(ColumnName::ByHeight(columns))
    }
}

impl schemars::JsonSchema for ColumnName {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "ColumnName".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "The name of a column or array, or columns with the height that each stands for",
            "anyOf": [
                { "type": "string" },
                { "type": "object", "additionalProperties": { "type": "number" } },
            ],
        })
    }
}
