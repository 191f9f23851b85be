//! Parts of a mapping in the words of its file: units, signs and origins of columns, which rows count, where times come
//! from, and what is derived from columns.

use oedometer_wording::{DAY, HOUR, MINUTE, MONTH, YEAR, words};
use serde::Deserialize;
use std::collections::BTreeMap;

/// A unit of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeUnit {
    /// Second.
    #[default]
    S,
    /// Minute.
    Min,
    /// Hour.
    H,
    /// Day.
    D,
    /// Month, a twelfth of a year.
    Month,
    /// Year of 365.25 days.
    A,
    /// Time factor `T_v`.
    TimeFactor,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metre.
    #[default]
    Metre,
    /// Centimetre.
    Centimetre,
    /// Millimetre.
    Millimetre,
}

/// A unit of stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressUnit {
    /// Pascal.
    Pascal,
    /// Kilopascal.
    Kilopascal,
    /// Megapascal.
    Megapascal,
}

/// A vertical direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VerticalSense {
    /// Against gravity.
    #[default]
    Up,
    /// With gravity.
    Down,
}

words!(VerticalSense: Up "up", Down "down");

/// A horizontal direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HorizontalSense {
    /// Away from the scene's `x = 0`: the crest of a layer's load.
    Right,
    /// Towards it.
    Left,
}

words!(HorizontalSense: Right "right", Left "left");

/// Which stress counts as positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressSign {
    /// Soil mechanics.
    CompressionPositive,
    /// Continuum mechanics.
    TensionPositive,
}

words!(StressSign: CompressionPositive "compression-positive", TensionPositive "tension-positive");

/// A configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StatedPlace {
    /// Places before the load came.
    #[default]
    Reference,
    /// Places at the time of the row.
    Current,
}

words!(StatedPlace: Reference "reference", Current "current");

words!(TimeUnit: S "s", Min "min", H "h", D "d", Month "month", A "a", TimeFactor "time-factor");

impl TimeUnit {
    /// Seconds of a time in this unit, with the seconds of `T_v = 1`.
    pub fn seconds(self, time: f64, seconds_per_time_factor: f64) -> f64 {
        time * match self {
            Self::S => 1.0,
            Self::Min => MINUTE,
            Self::H => HOUR,
            Self::D => DAY,
            Self::Month => MONTH,
            Self::A => YEAR,
            Self::TimeFactor => seconds_per_time_factor,
        }
    }
}

words!(LengthUnit: Metre "m", Centimetre "cm", Millimetre "mm");

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

words!(StressUnit: Pascal "Pa", Kilopascal "kPa", Megapascal "MPa");

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

/// Which rows count.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RowFilter {
    /// Only points at corners of cells: programs write 0 or meaningless values at mid-side nodes.
    pub corners: bool,
    /// Only rows at this place along `x`, in the file's unit: selects one of several columns of nodes.
    pub x: Option<f64>,
    /// Only rows in which a column has this value, like a material.
    pub equals: BTreeMap<String, f64>,
}

/// Where the time comes from if it is not a column.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// Time of each file with one step, by its file name.
    pub files: BTreeMap<String, f64>,
    /// Times of the files, in the order in which they are given.
    pub list: Vec<f64>,
    /// Whether the files, in their order, are at the times of the case.
    pub case: bool,
    /// Seconds from one numbered step to the next, if file names have the number of the step.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub step: Option<f64>,
    /// The file name, or its path from a folder on, with `{step}` in place of the step number and `*` for what differs;
    /// the last number of the name by default.
    pub pattern: Option<String>,
}

/// Where the displacement comes from.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementSource {
    /// What is subtracted from the current place.
    pub from: ZeroState,
    /// Column that identifies each point; the order of the rows by default.
    pub id: Option<String>,
}

/// Places that displacements count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ZeroState {
    /// Those of the first state.
    FirstFrame,
}

/// Water at rest, at the present height of a place: its initial one and `u_y`, where the files have it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hydrostatic {
    /// Its unit weight, Pa per m.
    #[schemars(extend("type" = ["number", "string"], "unit" = "N/m³"))]
    pub unit_weight: f64,
    /// Height of its table above the base, m; the surface by default.
    #[schemars(extend("type" = ["number", "string"], "unit" = "m"))]
    pub surface: Option<f64>,
}

/// What a column of stress contains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StressMeaning {
    /// The effective stress, or the total one.
    pub is: StressKind,
}

/// A stress of a soil.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StressKind {
    /// Stress of the skeleton.
    #[default]
    Effective,
    /// Stress of skeleton and water together.
    Total,
}

/// A settlement curve.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettlementSeries {
    /// CSV file, relative to the results or to the current folder; the result itself by default.
    #[serde(default)]
    pub file: String,
    /// Column of the time, in the unit of `[units]`; `t` by default.
    #[serde(default = "time_column")]
    pub t: String,
    /// Column of the settlement, in the unit of displacements; `s` by default.
    #[serde(default = "settlement_column")]
    pub s: String,
    /// `down` if settlement is positive, `up` if the displacement of the surface is given.
    #[serde(default = "downward")]
    pub sign: VerticalSense,
}

fn time_column() -> String {
    "t".to_owned()
}

fn settlement_column() -> String {
    "s".to_owned()
}

fn downward() -> VerticalSense {
    VerticalSense::Down
}
#[cfg(test)]
mod tests {
    use crate::import::mapping::{Column, Mapping};
    use crate::import::raw_row::{RawRow, SolvedBody};
    use crate::solver::Preset;
    use clap::ValueEnum;
    use oedometer_formats::ImportError;
    use oedometer_input::source::StudySource;
    use std::path::Path;

    /// A body 5 m high and 8 m long in which `T_v` = 1 is 250 s.
    const BODY: SolvedBody = SolvedBody { height: 5.0, length: Some(8.0), seconds_per_time_factor: 250.0 };

    fn mapping(table: &str, key: &str, word: &str) -> Result<Mapping, String> {
        let head =
            "columns = { x = \"x\", p = \"p\", u_x = \"u_x\", u_y = \"u_y\", effective_stress = \"s\" }\n";
        let text = format!("{head}[{table}]\n{key} = \"{word}\"\n");
        Mapping::read(&StudySource { name: "map.toml".to_owned(), text }).map_err(|error| error.to_string())
    }

    /// Table, key and word of a mapping; y and x as given; what the row becomes.
    type Word = (&'static str, &'static str, &'static str, [f64; 2], [f64; 7]);

    /// What a row becomes: time, x, y, p, stress, `u_y`, `u_x`.
    fn taken(mapping: &Mapping, y: f64, x: f64) -> [f64; 7] {
        let row = RawRow {
            time: mapping.units.time.seconds(3.0, BODY.seconds_per_time_factor),
            x: Some(x),
            y,
            pressure: Some(7.0),
            stress: Some(11.0),
            displacement: Some(0.25),
            horizontal_displacement: Some(0.125),
            ..RawRow::default()
        };
        let refused = |reason: String| ImportError::content(Path::new("a"), reason);
        let sample =
            row.sample(mapping, BODY, &refused).unwrap_or_else(|error: ImportError| panic!("{error}"));
        [
            sample.time,
            sample.initial_distance,
            sample.initial_height,
            sample.pressure,
            sample.effective_stress,
            sample.displacement,
            sample.horizontal_displacement,
        ]
    }

    /// Every word of a mapping with the numbers that a row then becomes. As given: 3 s, x = 2, y = 4, p = 7,
    /// stress 11 in compression, `u_y` = 0.25 up, `u_x` = 0.125 to the right.
    #[test]
    fn every_unit_and_sign_makes_its_own_number() {
        let plain = [3.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125];
        let words: [Word; 32] = [
            ("units", "time", "s", [4.0, 2.0], plain),
            ("units", "time", "min", [4.0, 2.0], [180.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("units", "time", "h", [4.0, 2.0], [10_800.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("units", "time", "d", [4.0, 2.0], [259_200.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("units", "time", "month", [4.0, 2.0], [7_889_400.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("units", "time", "a", [4.0, 2.0], [94_672_800.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("units", "time", "time-factor", [4.0, 2.0], [750.0, 2.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("units", "length", "m", [4.0, 2.0], plain),
            ("units", "length", "cm", [400.0, 200.0], [3.0, 2.0, 4.0, 7.0, -11.0, 0.0025, 0.00125]),
            ("units", "length", "mm", [4000.0, 2000.0], [3.0, 2.0, 4.0, 7.0, -11.0, 0.00025, 0.000_125]),
            ("units", "displacement", "m", [4.0, 2.0], plain),
            ("units", "displacement", "cm", [4.0, 2.0], [3.0, 2.0, 4.0, 7.0, -11.0, 0.0025, 0.00125]),
            ("units", "displacement", "mm", [4.0, 2.0], [3.0, 2.0, 4.0, 7.0, -11.0, 0.00025, 0.000_125]),
            ("units", "stress", "Pa", [4.0, 2.0], plain),
            ("units", "stress", "kPa", [4.0, 2.0], [3.0, 2.0, 4.0, 7000.0, -11_000.0, 0.25, 0.125]),
            ("units", "stress", "MPa", [4.0, 2.0], [3.0, 2.0, 4.0, 7e6, -11e6, 0.25, 0.125]),
            ("sign", "x", "right", [4.0, 2.0], plain),
            ("sign", "x", "left", [4.0, 2.0], [3.0, 6.0, 4.0, 7.0, -11.0, 0.25, 0.125]),
            ("sign", "y", "up", [4.0, 2.0], plain),
            ("sign", "y", "down", [4.0, 2.0], [3.0, 2.0, 1.0, 7.0, -11.0, 0.25, 0.125]),
            ("sign", "p", "compression-positive", [4.0, 2.0], plain),
            ("sign", "p", "tension-positive", [4.0, 2.0], [3.0, 2.0, 4.0, -7.0, -11.0, 0.25, 0.125]),
            ("sign", "effective_stress", "compression-positive", [4.0, 2.0], plain),
            (
                "sign",
                "effective_stress",
                "tension-positive",
                [4.0, 2.0],
                [3.0, 2.0, 4.0, 7.0, 11.0, 0.25, 0.125],
            ),
            ("sign", "u_x", "right", [4.0, 2.0], plain),
            ("sign", "u_x", "left", [4.0, 2.0], [3.0, 2.0, 4.0, 7.0, -11.0, 0.25, -0.125]),
            ("sign", "u_y", "up", [4.0, 2.0], plain),
            ("sign", "u_y", "down", [4.0, 2.0], [3.0, 2.0, 4.0, 7.0, -11.0, -0.25, 0.125]),
            ("position", "y", "reference", [4.0, 2.0], plain),
            ("position", "y", "current", [4.0, 2.0], [3.0, 1.875, 3.75, 7.0, -11.0, 0.25, 0.125]),
            ("stress", "is", "effective", [4.0, 2.0], plain),
            ("stress", "is", "total", [4.0, 2.0], [3.0, 2.0, 4.0, 7.0, -4.0, 0.25, 0.125]),
        ];
        for (table, key, word, [y, x], expected) in words {
            let mapping =
                mapping(table, key, word).unwrap_or_else(|told| panic!("{table}.{key} = {word}: {told}"));
            let found = taken(&mapping, y, x);
            let is_near =
                |(found, expected): (&f64, &f64)| (found - expected).abs() <= 1e-14 * expected.abs();
            assert!(found.iter().zip(&expected).all(is_near), "{table}.{key} = {word}: {found:?}");
        }
        // No word is missing above: of an unknown one a message lists all there are.
        for (table, key) in words.map(|(table, key, ..)| (table, key)) {
            let told = mapping(table, key, "nonsense").expect_err("no word");
            let all = told.split("it can be ").nth(1).expect("a list");
            let of_key = words.iter().filter(|(other, name, ..)| (*other, *name) == (table, key));
            let known: Vec<&str> = of_key.map(|(_, _, word, ..)| *word).collect();
            assert_eq!(
                all.trim().split(", ").map(|word| word.trim_matches('`')).collect::<Vec<_>>(),
                known,
                "{table}.{key}: {told}"
            );
        }
    }

    /// Every preset with all that it says: columns of a plane, and names outside the convention.
    #[test]
    #[expect(clippy::too_many_lines, reason = "one table of all presets")]
    fn every_preset_names_these_columns_and_no_others() {
        for (preset, [t, x, y, p, u_x, u_y, stress, volume], said) in [
            (
                "ogs",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "pressure",
                    "displacement[0]",
                    "displacement[1]",
                    "sigma[1]",
                    "",
                ],
                "nodes, corners, stress tension-positive",
            ),
            (
                "kratos",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "WATER_PRESSURE",
                    "DISPLACEMENT[0]",
                    "DISPLACEMENT[1]",
                    "",
                    "",
                ],
                "nodes, corners, p tension-positive",
            ),
            (
                "porepy",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "cells:pressure",
                    "cells:u[0]",
                    "cells:u[1]",
                    "",
                    "",
                ],
                "centres",
            ),
            (
                "geotaichi",
                [
                    "t_current",
                    "position[0]|coordinates[0]",
                    "position[1]|coordinates[1]",
                    "pressure",
                    "",
                    "",
                    "stress[1]",
                    "volume",
                ],
                "points, stress tension-positive, current, first frame",
            ),
            (
                "anura3d",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "pressure_liquid",
                    "displacement_solid[0]",
                    "displacement_solid[1]",
                    "eff_stress_solid[4]",
                    "",
                ],
                "points, kPa, p tension-positive, stress tension-positive, current",
            ),
            (
                "cb-geo",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "liquid_svars_0|pore_pressures",
                    "displacement_x|displacements[0]",
                    "displacement_y|displacements[1]",
                    "stress_yy|stresses[4]",
                    "volume",
                ],
                "points, stress tension-positive, current",
            ),
            (
                "kratos-poro",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "LIQUID_PRESSURE",
                    "DISPLACEMENT[0]",
                    "DISPLACEMENT[1]",
                    "",
                    "",
                ],
                "nodes, corners",
            ),
            (
                "kratos-mpm",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[1]",
                    "",
                    "MP_DISPLACEMENT[0]",
                    "MP_DISPLACEMENT[1]",
                    "MP_CAUCHY_STRESS_VECTOR[1]",
                    "MP_VOLUME",
                ],
                "points, stress tension-positive, current",
            ),
            (
                "mpm-geomechanics",
                [
                    "",
                    "coordinates[0]",
                    "coordinates[2]",
                    "Pressure|Pore Pressure",
                    "Displacement[0]",
                    "Displacement[2]",
                    "Stress_ZZ",
                    "",
                ],
                "points, stress tension-positive, current",
            ),
            (
                "meshio",
                [
                    "time|t",
                    "coordinates[0]|x|position[0]",
                    "coordinates[1]|y|position[1]",
                    "pressure|p|pore_pressure|porepressure|water_pressure|pressure_interpolated",
                    "displacement[0]|u[0]|disp[0]|u_x",
                    "displacement[1]|u[1]|disp[1]|u_y",
                    "",
                    "",
                ],
                "points",
            ),
        ] {
            let preset = Preset::from_str(preset, false).expect("a preset");
            let mapping =
                Mapping::resolve(Some(preset), None, crate::import::mapping::Axes::Layer).expect("a mapping");
            let columns = &mapping.columns;
            let found = [
                Column::Time,
                Column::X,
                Column::Y,
                Column::Pressure,
                Column::Along,
                Column::Up,
                Column::EffectiveStress,
                Column::Volume,
            ]
            .map(|column| columns.get(column).cloned().unwrap_or_default());
            assert_eq!(found, [t, x, y, p, u_x, u_y, stress, volume], "{}", preset.name);
            // What a row of 7 Pa and 11 Pa becomes says the signs, and the place the configuration.
            let [_, along, height, pressure, effective, up, right] = taken(&mapping, 4.0, 2.0);
            let words = [
                Some(mapping.sample.name()),
                mapping.rows.corners.then_some("corners"),
                (pressure.abs() == 7e3).then_some("kPa"),
                (pressure < 0.0).then_some("p tension-positive"),
                (effective > 0.0).then_some("stress tension-positive"),
                (height == 3.75 && along == 1.875).then_some("current"),
                mapping.displacement.is_some().then_some("first frame"),
            ];
            assert_eq!(words.into_iter().flatten().collect::<Vec<_>>().join(", "), said, "{}", preset.name);
            assert_eq!((up, right), (0.25, 0.125), "{}", preset.name);
        }
        assert_eq!(Preset::value_variants().len(), 10, "a new preset is written above, too");
    }
}
