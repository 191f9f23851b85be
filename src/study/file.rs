//! A study as it was typed: every value with its place in the text, nothing judged yet.

use crate::study::diagnostic::{Diagnostic, StudyError, nearest};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use std::fmt;
use toml::Spanned;

/// A typed value with its place.
type Typed<T> = Option<Spanned<T>>;
/// A typed list with the places of its values.
type TypedList<T> = Option<Spanned<Vec<Spanned<T>>>>;

/// Text of a study with a name for messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudySource {
    /// File name, or what stands for it.
    pub name: String,
    /// TOML.
    pub text: String,
}

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    pub title: Spanned<String>,
    pub summary: Option<String>,
    pub scene: Spanned<String>,
    #[serde(default)]
    pub column: ColumnTable,
    pub layer: Option<Spanned<LayerTable>>,
    #[serde(default)]
    pub points: PointsTable,
    pub task: Typed<String>,
    pub case_seconds: Typed<f64>,
    #[serde(default)]
    pub material: MaterialTable,
    #[serde(default)]
    pub integrator: IntegratorTable,
    #[serde(default)]
    pub output: OutputTable,
    #[serde(default)]
    pub sweep: Vec<Spanned<SweepTable>>,
    #[serde(default)]
    pub expect: Vec<Spanned<ExpectTable>>,
    #[serde(default)]
    pub expect_case: Vec<Spanned<ExpectCaseTable>>,
    #[serde(default)]
    pub timing: TimingTable,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnTable {
    pub height: Typed<f64>,
    pub width: Typed<f64>,
    pub load: Typed<f64>,
    pub dimensions: Typed<i64>,
    pub loading_time: Typed<f64>,
}

/// Where the points lie in their cells.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointsTable {
    pub offset: Typed<f64>,
    pub jitter: Typed<f64>,
    pub filling: Typed<f64>,
}

impl ColumnTable {
    /// Place of the first key that was typed.
    pub fn typed(&self) -> Option<std::ops::Range<usize>> {
        let numbers = [&self.height, &self.width, &self.load, &self.loading_time];
        let numbers = numbers.into_iter().flatten().map(Spanned::span);
        numbers.chain(self.dimensions.as_ref().map(Spanned::span)).min_by_key(|span| span.start)
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayerTable {
    pub length: Typed<f64>,
    pub height: Typed<f64>,
    pub base: Typed<String>,
    pub load: Typed<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialTable {
    pub law: Typed<String>,
    pub youngs_modulus: Typed<f64>,
    pub poissons_ratio: Typed<f64>,
    pub porosity: Typed<f64>,
    pub grain_density: Typed<f64>,
    pub water_density: Typed<f64>,
    pub water_bulk_modulus: Typed<f64>,
    pub hydraulic_conductivity: Typed<f64>,
    pub gravity: Typed<f64>,
    pub continuity: Typed<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IntegratorTable {
    pub formulation: Typed<String>,
    pub scheme: Typed<String>,
    pub drag: Typed<String>,
    pub flip: Typed<f64>,
    pub mapping_back: Typed<bool>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputTable {
    pub time_factors: TypedList<f64>,
    pub references: TypedList<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimingTable {
    pub repeats: Typed<i64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepTable {
    pub method: TypedList<MethodEntry>,
    pub integrator: TypedList<String>,
    pub formulation: TypedList<String>,
    pub cells: TypedList<i64>,
    pub points_per_cell: TypedList<i64>,
    pub time_step: TypedList<TimeStepTable>,
    pub scheme: TypedList<String>,
    pub drag: TypedList<String>,
    pub flip: TypedList<f64>,
    pub mapping_back: TypedList<bool>,
    pub time_factors: TypedList<f64>,
    pub law: TypedList<String>,
    pub continuity: TypedList<String>,
    pub porosity: TypedList<f64>,
    pub hydraulic_conductivity: TypedList<f64>,
    pub water_bulk_modulus: TypedList<f64>,
    pub poissons_ratio: TypedList<f64>,
    pub offset: TypedList<f64>,
    pub path: TypedList<String>,
    pub tier: Typed<String>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeStepTable {
    pub stable: Typed<f64>,
    pub courant: Typed<f64>,
    pub seconds: Typed<f64>,
    pub growth: Typed<f64>,
    pub tolerance: Typed<f64>,
}

/// A method by name or by its choices.
#[derive(Clone, Debug)]
pub enum MethodEntry {
    Name(String),
    Choices(Box<MethodTable>),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodTable {
    pub basis: Typed<String>,
    pub strain: Typed<String>,
    pub pressure: Typed<String>,
    pub recovery: Typed<String>,
    pub memory: Typed<String>,
    pub configuration: Typed<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpectTable {
    pub method: Typed<MethodEntry>,
    pub integrator: Typed<String>,
    pub quantity: Typed<String>,
    pub norm: Typed<String>,
    pub sample: Typed<String>,
    pub time_factor: Typed<f64>,
    pub reference: Typed<String>,
    pub axis: Typed<String>,
    pub cells: Typed<i64>,
    pub points_per_cell: Typed<i64>,
    pub law: Typed<String>,
    pub continuity: Typed<String>,
    pub water_bulk_modulus: Typed<f64>,
    pub poissons_ratio: Typed<f64>,
    pub scheme: Typed<String>,
    pub drag: Typed<String>,
    pub mapping_back: Typed<bool>,
    pub order: Typed<OrderTable>,
    pub at: Typed<LevelTable>,
    pub spread: Typed<LevelTable>,
    pub class: Typed<String>,
    pub floor: Typed<FloorTable>,
    pub oscillation: Typed<BelowTable>,
    pub uncertainty: Typed<BelowTable>,
    pub probe: Typed<f64>,
    pub xfail: Typed<XfailTable>,
    pub tier: Typed<String>,
}

/// What single cases must do.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpectCaseTable {
    pub method: Typed<MethodEntry>,
    pub integrator: Typed<String>,
    pub cells: Typed<i64>,
    pub points_per_cell: Typed<i64>,
    pub drag: Typed<String>,
    pub scheme: Typed<String>,
    pub status: Typed<String>,
    pub critical_step_within: Typed<f64>,
    pub solid_drift_below: Typed<f64>,
    pub water_drift_below: Typed<f64>,
    pub error: Typed<RangeTable>,
    pub quantity: Typed<String>,
    pub norm: Typed<String>,
    pub sample: Typed<String>,
    pub time_factor: Typed<f64>,
    pub reference: Typed<String>,
    pub tier: Typed<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RangeTable {
    pub below: Typed<f64>,
    pub above: Typed<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrderTable {
    pub value: Spanned<f64>,
    pub minus: Typed<f64>,
    pub plus: Typed<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelTable {
    pub cells: Typed<i64>,
    pub points_per_cell: Typed<i64>,
    pub seconds: Typed<f64>,
    pub water_bulk_modulus: Typed<f64>,
    pub below: Typed<f64>,
    pub above: Typed<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FloorTable {
    pub above: Typed<f64>,
    pub below: Typed<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BelowTable {
    pub below: Spanned<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct XfailTable {
    pub strict: Typed<bool>,
    pub reason: Spanned<String>,
}

impl<'de> Deserialize<'de> for MethodEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entry;
        impl<'de> Visitor<'de> for Entry {
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
        deserializer.deserialize_any(Entry)
    }
}

impl StudySource {
    /// Reads TOML into tables, refusing unknown keys and wrong types at their place.
    ///
    /// # Errors
    /// What the parser refuses, with the nearest key.
    pub fn parse(&self) -> Result<StudyFile, StudyError> {
        self.read()
    }

    /// Reads TOML into any tables, with the complaints of a study.
    ///
    /// # Errors
    /// What the parser refuses, with the nearest key.
    pub fn read<T: serde::de::DeserializeOwned>(&self) -> Result<T, StudyError> {
        toml::from_str(&self.text).map_err(|error| self.error(vec![explained(&error, &self.text)]))
    }

    /// One complaint about the whole text.
    pub fn complaint(&self, message: String, help: String) -> StudyError {
        self.error(vec![Diagnostic { message, span: None, help: Some(help) }])
    }

    /// An error of this study.
    pub fn error(&self, diagnostics: Vec<Diagnostic>) -> StudyError {
        StudyError { name: self.name.clone(), source: self.text.clone(), diagnostics }
    }
}

/// A parser's error with the nearest key, where the key is unknown.
fn explained(error: &toml::de::Error, text: &str) -> Diagnostic {
    let message = error.message().trim().replace('\n', "; ");
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let help = match quoted.split_first() {
        Some((word, candidates)) if message.starts_with("unknown field") => {
            Some(match nearest(word, candidates.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the keys here are {}", candidates.join(", ")),
            })
        }
        _ if is_bare_word(error, text) => Some("words are written in quotes, like \"terzaghi\"".to_owned()),
        _ if ["missing field `title`", "missing field `scene`"].contains(&message.as_str()) => {
            Some("a study needs at least `title`, `scene` and one [[sweep]] block".to_owned())
        }
        _ => None,
    };
    let message = match (message.starts_with("unknown field"), quoted.first()) {
        (true, Some(word)) => format!("unknown key `{word}`"),
        _ => message,
    };
    Diagnostic { message, span: error.span(), help }
}

/// Whether the parser stumbled over a word where a value should be.
fn is_bare_word(error: &toml::de::Error, text: &str) -> bool {
    let found = error.span().and_then(|span| text.get(span.start..)).unwrap_or_default();
    let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
    found.starts_with(char::is_alphabetic) && before.trim_end_matches([' ', '\t']).ends_with(['=', '[', ','])
}
