//! A number as JSON can hold it: what is finite as a number, what is not as one of the words `inf`, `-inf` and `nan`.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A measured number, finite or not. JSON has no infinity and no NaN, and a reader must not take one for a missing value.
#[derive(Clone, Copy, Debug)]
pub struct Number(pub f64);

const WORDS: [(&str, f64); 3] = [("inf", f64::INFINITY), ("-inf", f64::NEG_INFINITY), ("nan", f64::NAN)];

impl PartialEq for Number {
    /// To the bit: a NaN that is read is the one that was written.
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits() || self.0 == other.0
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let word = WORDS.iter().find(|(_, value)| value.total_cmp(&self.0).is_eq());
        match word {
            Some((word, _)) => out.serialize_str(word),
            None if self.0.is_nan() => out.serialize_str("nan"),
            None => out.serialize_f64(self.0),
        }
    }
}

/// What stands in a file.
#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Number(f64),
    Word(String),
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
        match Written::deserialize(input)? {
            Written::Number(value) => Ok(Self(value)),
            Written::Word(word) => {
                let known = WORDS.iter().find(|(known, _)| *known == word);
                known.map(|(_, value)| Self(*value)).ok_or_else(|| {
                    D::Error::invalid_value(Unexpected::Str(&word), &"a number, `inf`, `-inf` or `nan`")
                })
            }
        }
    }
}

impl JsonSchema for Number {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Number".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number" }, { "enum": WORDS.map(|(word, _)| word) }] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_is_a_word_and_is_read_as_what_it_was() {
        for (value, written) in [
            (0.25, "0.25"),
            (-3e-14, "-3e-14"),
            (f64::INFINITY, "\"inf\""),
            (f64::NEG_INFINITY, "\"-inf\""),
            (f64::NAN, "\"nan\""),
            (-f64::NAN, "\"nan\""),
        ] {
            let json = serde_json::to_string(&Number(value)).expect("a word or a number");
            assert_eq!(json, written);
            let read: Number = serde_json::from_str(&json).expect(written);
            assert!(read.0.total_cmp(&value).is_eq() || read.0.is_nan() && value.is_nan(), "{written}");
        }
        for wrong in ["null", "\"Infinity\"", "[]"] {
            assert!(serde_json::from_str::<Number>(wrong).is_err(), "{wrong}");
        }
    }
}
