//! The declared meaning of a file's columns.

use crate::case::quantity::Sample;
use crate::import::units::{
    HorizontalSense, LengthUnit, StatedPlace, StressSign, StressUnit, TimeUnit, VerticalSense,
};
use crate::study::diagnostic::StudyError;
use crate::study::file::StudySource;
use serde::Deserialize;
use std::collections::BTreeMap;

/// What the columns of a file mean.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Kind of the places: a name for tables.
    #[serde(default = "points")]
    pub sample: Sample,
    /// What the volumes of all samples add up to, in the unit of their column. Where it is left out and the sum is
    /// no volume of the scene, they are mere weights.
    #[serde(default)]
    pub whole_volume: Option<f64>,
    /// Names of the columns, as the header spells them.
    pub columns: ColumnNames,
    /// Units of the columns.
    pub units: Units,
    /// Directions that count as positive; of x and y with the end from which they count.
    pub sign: Signs,
    /// Whether places are initial or present ones, of x as of y.
    pub position: Position,
    /// What the file writes at the end from which x and y count, in its unit of length.
    #[serde(default)]
    pub origin: Origin,
    /// Where the time stands, where it is no column.
    #[serde(default)]
    pub time: Time,
    /// Layout of the file.
    #[serde(default)]
    pub csv: TableLayout,
    /// Whether nobody declared it: a layer's horizontal displacement then may be missing.
    #[serde(skip)]
    pub is_convention: bool,
}

fn points() -> Sample {
    Sample::Points
}

/// Names of columns as the header spells them.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnNames {
    /// Time.
    pub t: Option<String>,
    /// Distance along a layer.
    pub x: Option<String>,
    /// Height or depth.
    pub y: String,
    /// Excess pore pressure.
    pub p: Option<String>,
    /// Horizontal displacement of the skeleton.
    pub u_x: Option<String>,
    /// Vertical displacement of the skeleton.
    pub u_y: Option<String>,
    /// Vertical effective stress.
    pub effective_stress: Option<String>,
    /// Volume or weight of each place; all weigh alike where none is named.
    pub volume: Option<String>,
}

/// Units of columns.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Unit of the time.
    pub time: TimeUnit,
    /// Unit of the places.
    pub length: LengthUnit,
    /// Unit of the displacement, where it is a column.
    pub displacement: Option<LengthUnit>,
    /// Unit of pressure and stress, where they are columns.
    pub stress: Option<StressUnit>,
}

/// Directions that count as positive.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Signs {
    /// `right` from the scene's `x = 0` (the crest of a layer's load), or `left` from its other end;
    /// where `x` is a column.
    pub x: Option<HorizontalSense>,
    /// `up` from the base, or `down` from the initial surface.
    pub y: VerticalSense,
    /// Sign of the pore pressure, where it is a column.
    pub p: Option<StressSign>,
    /// Sign of the horizontal displacement, where it is a column.
    pub u_x: Option<HorizontalSense>,
    /// Sign of the vertical displacement, where it is a column.
    pub u_y: Option<VerticalSense>,
    /// Sign of the effective stress, where it is a column.
    pub effective_stress: Option<StressSign>,
}

/// Whose places the coordinates are.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Position {
    /// Initial places, or present ones; of `x` as of `y`.
    pub y: StatedPlace,
}

/// Where the scene begins in the file's coordinates and their unit: what the file writes at the end
/// from which `sign` counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Origin {
    /// At the crest of a layer's load, or at its other end.
    pub x: f64,
    /// At the base, or at the initial surface.
    pub y: f64,
}

/// Times that stand beside the rows.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time of each file that holds one step, by its file name.
    #[serde(default)]
    pub files: BTreeMap<String, f64>,
}

/// Layout of a file.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TableLayout {
    /// What parts the columns.
    pub delimiter: char,
    /// What begins a line that is no row.
    pub comment: Option<char>,
}

impl Default for TableLayout {
    fn default() -> Self {
        Self { delimiter: ',', comment: Some('#') }
    }
}

/// What is not declared, and how to declare it.
type Undeclared = (String, String);

fn undeclared(what: &str, help: &str) -> Undeclared {
    (what.to_owned(), help.to_owned())
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

    /// What a mapping lacks for a layer: its fields depend on the place along it.
    ///
    /// # Errors
    /// When no column holds that place.
    pub fn check_plane(&self, source: &StudySource) -> Result<(), StudyError> {
        if self.columns.x.is_some() {
            return Ok(());
        }
        Err(source.complaint(
            "the scene is a layer, and no column `x` says where along it a sample lies".to_owned(),
            "add `x = \"x\"` to [columns] and `x = \"right\"` to [sign], for a distance from the crest of the load"
                .to_owned(),
        ))
    }

    /// A column that lacks a declaration, and how to give it.
    fn undeclared(&self) -> Option<Undeclared> {
        self.undeclared_column().or_else(|| self.undeclared_place()).or_else(|| self.undeclared_layout())
    }

    /// A column without its unit, sign or end; or no column at all.
    fn undeclared_column(&self) -> Option<Undeclared> {
        let (columns, units, sign) = (&self.columns, &self.units, &self.sign);
        let stress = (units.stress.is_some(), "stress = \"kPa\"");
        let displacement = (units.displacement.is_some(), "displacement = \"mm\"");
        let (is_stress, compressive) = (columns.effective_stress.is_some(), "compression-positive");
        let rows = [
            ("p", columns.p.is_some(), stress, sign.p.is_some(), compressive),
            ("u_y", columns.u_y.is_some(), displacement, sign.u_y.is_some(), "up"),
            ("u_x", columns.u_x.is_some(), displacement, sign.u_x.is_some(), "right"),
            ("effective_stress", is_stress, stress, sign.effective_stress.is_some(), compressive),
        ];
        for (name, given, (has_unit, unit), has_sign, word) in rows {
            if given && !has_unit {
                let what = format!("the unit of the column `{name}` is not declared");
                return Some((what, format!("add `{unit}` to [units]")));
            }
            if given && !has_sign {
                let what = format!("the sign of the column `{name}` is not declared");
                return Some((what, format!("add `{name} = \"{word}\"` to [sign]")));
            }
        }
        if columns.x.is_some() && sign.x.is_none() {
            return Some(undeclared(
                "the end from which `x` counts is not declared",
                "add `x = \"right\"` to [sign] where x = 0 is under the crest of the load, `x = \"left\"` where it is \
                 at the other end",
            ));
        }
        rows.iter().all(|(_, given, ..)| !given).then(|| {
            let help = "name `p`, `u_y`, `u_x` or `effective_stress` in [columns]";
            undeclared("no column to score is named", help)
        })
    }

    /// Places, volumes and times that cannot be found.
    fn undeclared_place(&self) -> Option<Undeclared> {
        let columns = &self.columns;
        let is_current = self.position.y == StatedPlace::Current;
        for (place, given, component, has_component) in [
            ("y", true, "u_y", columns.u_y.is_some()),
            ("x", columns.x.is_some(), "u_x", columns.u_x.is_some()),
        ] {
            if is_current && given && !has_component {
                return Some((
                    format!("present places need the displacement to find the initial `{place}`"),
                    format!("name `{component}` in [columns], or give initial places"),
                ));
            }
        }
        if !(self.origin.x.is_finite() && self.origin.y.is_finite()) {
            return Some(undeclared("an origin is no finite number", "write it as in the file"));
        }
        if self.whole_volume.is_some_and(|volume| !(volume.is_finite() && volume > 0.0)) {
            let help = "give what the volumes of all samples add up to";
            return Some(undeclared("`whole_volume` is not positive", help));
        }
        (columns.t.is_none() && self.time.files.is_empty()).then(|| {
            let help = "name the column `t`, or give [time] files = { \"step_10.csv\" = 8.175 }";
            undeclared("no time is declared", help)
        })
    }

    /// Marks of the file that no file can have.
    fn undeclared_layout(&self) -> Option<Undeclared> {
        (!self.csv.delimiter.is_ascii() || !self.csv.comment.is_none_or(|mark| mark.is_ascii()))
            .then(|| undeclared("a delimiter or comment mark is no ASCII character", "use \",\" or \";\""))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::convention::{CONVENTION, PLANE_CONVENTION};

    fn read(text: &str) -> Result<Mapping, String> {
        Mapping::read(&StudySource { name: "map.toml".to_owned(), text: text.to_owned() })
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_convention_is_a_mapping() {
        for is_plane in [false, true] {
            let mapping = Mapping::convention(is_plane).expect("a constant");
            assert_eq!(mapping.columns.u_y.as_deref(), Some("u_y"));
            assert_eq!(mapping.columns.x.is_some(), is_plane);
            assert_eq!(mapping.position.y, StatedPlace::Reference);
        }
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
        for (remove, told) in [
            ("x = \"right\"\n", "the end from which `x` counts is not declared"),
            ("u_x = \"right\"\n", "sign of the column `u_x`"),
        ] {
            let error = read(&PLANE_CONVENTION.replacen(&format!("\n{remove}"), "\n", 1)).expect_err(remove);
            assert!(error.contains(told), "{remove}: {error}");
        }
        let current =
            PLANE_CONVENTION.replace("\"reference\"", "\"current\"").replacen("u_x = \"u_x\"\n", "", 1);
        assert!(read(&current).is_err_and(|error| error.contains("to find the initial `x`")));
        let volume = format!("whole_volume = 0.0\n{CONVENTION}");
        assert!(read(&volume).is_err_and(|error| error.contains("`whole_volume` is not positive")));
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
