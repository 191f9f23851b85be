//! The declared meaning of a file's columns.

use crate::record::Sample;
use crate::study::{StudyError, StudySource};
use serde::Deserialize;
use std::collections::BTreeMap;

/// What a file means for which nothing is declared, as a mapping file would say it.
pub const CONVENTION: &str = r#"sample = "points"

[columns]
t = "t"
y = "y"
p = "p"
u_y = "u_y"

[units]
time = "s"
length = "m"
displacement = "m"
stress = "Pa"

[sign]
y = "up"
p = "compression-positive"
u_y = "up"

[position]
y = "reference"
"#;

/// What the columns of a file mean.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Kind of the places: a name for tables.
    #[serde(default = "points")]
    pub sample: Sample,
    /// Names of the columns.
    pub columns: Columns,
    /// Units of the columns.
    pub units: Units,
    /// Directions that count as positive.
    pub sign: Signs,
    /// Whose places the heights are.
    pub position: Position,
    /// Where the time stands, where it is no column.
    #[serde(default)]
    pub time: Time,
    /// Layout of the file.
    #[serde(default)]
    pub csv: Layout,
}

fn points() -> Sample {
    Sample::Points
}

/// Names of columns as the header spells them.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// Time.
    pub t: Option<String>,
    /// Height or depth.
    pub y: String,
    /// Excess pore pressure.
    pub p: Option<String>,
    /// Vertical displacement of the skeleton.
    pub u_y: Option<String>,
    /// Vertical effective stress.
    pub effective_stress: Option<String>,
    /// Volume or weight of each place; all weigh alike where none is named.
    pub volume: Option<String>,
}

/// Units of columns.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Unit of the time.
    pub time: TimeUnit,
    /// Unit of the height.
    pub length: LengthUnit,
    /// Unit of the displacement, where it is a column.
    pub displacement: Option<LengthUnit>,
    /// Unit of pressure and stress, where they are columns.
    pub stress: Option<StressUnit>,
}

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeUnit {
    /// Second.
    S,
    /// Minute.
    Min,
    /// Hour.
    H,
    /// Day.
    D,
    /// Year of 365.25 days.
    A,
    /// Time factor `T_v`.
    TimeFactor,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum LengthUnit {
    /// Metre.
    #[serde(rename = "m")]
    Metre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
}

/// A unit of stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum StressUnit {
    /// Pascal.
    #[serde(rename = "Pa")]
    Pascal,
    /// Kilopascal.
    #[serde(rename = "kPa")]
    Kilopascal,
    /// Megapascal.
    #[serde(rename = "MPa")]
    Megapascal,
}

/// Directions that count as positive.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signs {
    /// `up` from the base, or `down` from the initial surface.
    pub y: Direction,
    /// Sign of the pore pressure, where it is a column.
    pub p: Option<StressSign>,
    /// Sign of the displacement, where it is a column.
    pub u_y: Option<Direction>,
    /// Sign of the effective stress, where it is a column.
    pub effective_stress: Option<StressSign>,
}

/// A direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Against gravity.
    Up,
    /// With gravity.
    Down,
}

/// Which stress counts as positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StressSign {
    /// Soil mechanics.
    CompressionPositive,
    /// Continuum mechanics.
    TensionPositive,
}

/// Whose places the heights are.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Position {
    /// Initial places, or present ones.
    pub y: Configuration,
}

/// A configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Configuration {
    /// Places before the load came.
    Reference,
    /// Places at the time of the row.
    Current,
}

/// Times that stand beside the rows.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time of each file that holds one step, by its file name.
    #[serde(default)]
    pub files: BTreeMap<String, f64>,
}

/// Layout of a file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Layout {
    /// What parts the columns.
    pub delimiter: char,
    /// What begins a line that is no row.
    pub comment: Option<char>,
}

impl Default for Layout {
    fn default() -> Self {
        Self { delimiter: ',', comment: Some('#') }
    }
}

impl TimeUnit {
    /// Seconds of a time in this unit, with the seconds of `T_v = 1`.
    pub fn seconds(self, time: f64, seconds_per_time_factor: f64) -> f64 {
        time * match self {
            Self::S => 1.0,
            Self::Min => 60.0,
            Self::H => 3600.0,
            Self::D => 86_400.0,
            Self::A => 365.25 * 86_400.0,
            Self::TimeFactor => seconds_per_time_factor,
        }
    }
}

impl LengthUnit {
    /// Metres of one.
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 1e-2,
            Self::Millimetre => 1e-3,
        }
    }
}

impl StressUnit {
    /// Pascals of one.
    pub fn pascals(self) -> f64 {
        match self {
            Self::Pascal => 1.0,
            Self::Kilopascal => 1e3,
            Self::Megapascal => 1e6,
        }
    }
}

impl Mapping {
    /// The mapping of a text.
    ///
    /// # Errors
    /// What is wrong, at its place: an unknown key or word, or a column whose unit or sign is not
    /// declared.
    pub fn read(source: &StudySource) -> Result<Self, StudyError> {
        let mapping: Self = source.read()?;
        match mapping.undeclared() {
            None => Ok(mapping),
            Some((message, help)) => Err(source.complaint(message, help)),
        }
    }

    /// The meaning of a file for which nothing is declared.
    ///
    /// # Errors
    /// Never: the text is a constant.
    pub fn convention() -> Result<Self, StudyError> {
        Self::read(&StudySource { name: "the convention".to_owned(), text: CONVENTION.to_owned() })
    }

    /// A column that lacks a declaration, and how to give it.
    fn undeclared(&self) -> Option<(String, String)> {
        let (columns, units, sign) = (&self.columns, &self.units, &self.sign);
        let rows = [
            ("p", columns.p.is_some(), units.stress.is_some(), sign.p.is_some(), "stress = \"kPa\""),
            (
                "u_y",
                columns.u_y.is_some(),
                units.displacement.is_some(),
                sign.u_y.is_some(),
                "displacement = \"mm\"",
            ),
            (
                "effective_stress",
                columns.effective_stress.is_some(),
                units.stress.is_some(),
                sign.effective_stress.is_some(),
                "stress = \"kPa\"",
            ),
        ];
        for (name, given, has_unit, has_sign, unit) in rows {
            if given && !has_unit {
                return Some((
                    format!("the unit of the column `{name}` is not declared"),
                    format!("add `{unit}` to [units]"),
                ));
            }
            if given && !has_sign {
                let word = if name == "u_y" { "up" } else { "compression-positive" };
                return Some((
                    format!("the sign of the column `{name}` is not declared"),
                    format!("add `{name} = \"{word}\"` to [sign]"),
                ));
            }
        }
        if rows.iter().all(|(_, given, ..)| !given) {
            return Some((
                "no column to score is named".to_owned(),
                "name `p`, `u_y` or `effective_stress` in [columns]".to_owned(),
            ));
        }
        if self.position.y == Configuration::Current && columns.u_y.is_none() {
            return Some((
                "present places need the displacement to find the initial ones".to_owned(),
                "name `u_y` in [columns], or give initial places".to_owned(),
            ));
        }
        if columns.t.is_none() && self.time.files.is_empty() {
            return Some((
                "no time is declared".to_owned(),
                "name the column `t`, or give [time] files = { \"step_10.csv\" = 8.175 }".to_owned(),
            ));
        }
        (!self.csv.delimiter.is_ascii() || !self.csv.comment.is_none_or(|mark| mark.is_ascii())).then(|| {
            ("a delimiter or comment mark is no ASCII character".to_owned(), "use \",\" or \";\"".to_owned())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Mapping, String> {
        Mapping::read(&StudySource { name: "map.toml".to_owned(), text: text.to_owned() })
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_convention_is_a_mapping() {
        let mapping = Mapping::convention().expect("a constant");
        assert_eq!(mapping.columns.u_y.as_deref(), Some("u_y"));
        assert_eq!(mapping.position.y, Configuration::Reference);
    }

    #[test]
    fn what_is_not_declared_is_asked_for() {
        for (remove, told) in [
            ("p = \"compression-positive\"\n", "sign of the column `p` is not declared"),
            ("u_y = \"up\"\n", "sign of the column `u_y`"),
            ("stress = \"Pa\"\n", "unit of the column `p`"),
            ("displacement = \"m\"\n", "unit of the column `u_y`"),
            ("t = \"t\"\n", "no time is declared"),
            ("time = \"s\"\n", "missing field `time`"),
            ("y = \"reference\"\n", "missing field `y`"),
        ] {
            let error = read(&CONVENTION.replacen(remove, "", 1)).expect_err(remove);
            assert!(error.contains(told), "{remove}: {error}");
        }
        let current = CONVENTION.replace("\"reference\"", "\"current\"").replacen("u_y = \"u_y\"\n", "", 1);
        assert!(read(&current).is_err_and(|error| error.contains("present places need the displacement")));
    }

    #[test]
    fn unknown_words_are_told_at_their_place() {
        let error = read(&CONVENTION.replace("\"Pa\"", "\"kpa\"")).expect_err("no unit");
        assert!(error.contains("map.toml:13:") && error.contains('^') && error.contains("kPa"), "{error}");
        let error = read(&CONVENTION.replace("length =", "lenght =")).expect_err("no key");
        assert!(error.contains("did you mean `length`?"), "{error}");
    }
}
