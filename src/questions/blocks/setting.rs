//! The setting of a study: geometry and soil, the settlement in the end, and what a time factor of one is on the clock.

use crate::case::Case;
use crate::record::Record;
use oedometer_scenes::column::column_parameters;
use oedometer_scenes::scene::Clock;
use oedometer_soil::material::Material;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A quantity of a case: its symbol, unit and value in SI.
type Stated = (&'static str, &'static str, fn(&Case) -> f64);
/// The same of a soil.
type StatedOfSoil = (&'static str, &'static str, fn(&Material) -> f64);

/// What is stated of every body, in the order in which it is read.
const STATED: [Stated; 2] = [("H", "m", |case| case.column.height), ("q", "Pa", |case| case.column.load)];
/// What is stated of its soil.
const OF_SOIL: [StatedOfSoil; 5] = [
    ("E", "Pa", |soil| soil.youngs_modulus),
    ("ν", "", |soil| soil.poissons_ratio),
    ("n", "", |soil| soil.porosity),
    ("k", "m/s", |soil| soil.hydraulic_conductivity),
    ("K_w", "Pa", |soil| soil.water_bulk_modulus),
];

/// Geometry and soil of all cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SettingFinding {
    /// What all layers share.
    pub stated: Vec<StatedRange>,
    /// What differs from layer to layer in the first case, from the base up.
    pub layers: Vec<LayerFinding>,
    /// Whether other cases have other layers.
    pub layers_vary: bool,
    /// Settlement of the surface in the end, m.
    pub settlement: Option<Range>,
    /// What a time factor of one is, s.
    pub unit_of_time: Option<Range>,
}

/// The least and the largest of all cases.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Range {
    /// The least.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

/// A quantity over all cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StatedRange {
    /// Its symbol.
    pub symbol: String,
    /// Its unit; empty for a number.
    pub unit: String,
    /// The least.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

/// A layer with what it does not share with the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LayerFinding {
    /// Thickness, m.
    pub thickness: f64,
    /// What is its own.
    pub stated: Vec<StatedRange>,
}

impl StatedRange {
    fn new(symbol: &str, unit: &str, range: Range) -> Self {
        Self { symbol: symbol.to_owned(), unit: unit.to_owned(), least: range.least, most: range.most }
    }
}

impl SettingFinding {
    /// The setting of all records; `None` where nothing was run.
    pub fn new(records: &[Record]) -> Option<Self> {
        let cases: Vec<&Case> = records.iter().map(|record| &record.case).collect();
        let first = *cases.first()?;
        // What all layers share is the body's, and what differs is said layer by layer.
        let differs = |value: fn(&Material) -> f64| {
            let mut soils = cases.iter().map(|case| case.soils());
            soils.any(|soils| soils.iter().any(|(_, soil)| value(soil) != value(&soils[0].1)))
        };
        let of_body = STATED
            .iter()
            .filter_map(|(symbol, unit, value)| Some(StatedRange::new(symbol, unit, range(&cases, value)?)));
        let of_soil =
            OF_SOIL.iter().filter(|(_, _, value)| !differs(*value)).filter_map(|(symbol, unit, value)| {
                let range = range(&cases, |case| value(&case.soils()[0].1))?;
                Some(StatedRange::new(symbol, unit, range))
            });
        let stated: Vec<StatedRange> = of_body.chain(of_soil).collect();
        let layered: Vec<&StatedOfSoil> = OF_SOIL.iter().filter(|(_, _, value)| differs(*value)).collect();
        let layer = |(thickness, soil): &(f64, Material)| LayerFinding {
            thickness: *thickness,
            stated: layered
                .iter()
                .map(|(symbol, unit, value)| {
                    let value = value(soil);
                    StatedRange::new(symbol, unit, Range { least: value, most: value })
                })
                .collect(),
        };
        let layers = if layered.is_empty() { Vec::new() } else { first.soils().iter().map(layer).collect() };
        Some(Self {
            stated,
            layers,
            layers_vary: cases.iter().any(|other| other.column.soils != first.column.soils),
            settlement: range(&cases, |case| final_settlement(case).unwrap_or(0.0)),
            unit_of_time: range(&cases, |case| unit_of_time(case).unwrap_or(0.0)),
        })
    }
}

/// The least and the largest of all cases; `None` where it is nowhere given.
fn range(cases: &[&Case], value: impl Fn(&Case) -> f64) -> Option<Range> {
    let all = || cases.iter().map(|case| value(case)).filter(|value| *value != 0.0);
    Some(Range { least: all().reduce(f64::min)?, most: all().reduce(f64::max)? })
}

/// What the surface of a column settles by in the end, m.
pub fn final_settlement(case: &Case) -> Option<f64> {
    // Each layer has its own share.
    let settlement = case.scene.final_settlement.filter(|_| case.column.soils.is_empty())?;
    Some(settlement(&case.column, &case.material))
}

/// What a time factor of one is on the clock, s, where the scene consolidates.
pub fn unit_of_time(case: &Case) -> Option<f64> {
    let consolidates = matches!(case.scene.clock, Clock::Consolidation | Clock::HalfSpace);
    consolidates.then(|| column_parameters(&case.column, &case.material).time(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use oedometer_scenes::{COSINE_LAYER, XIE_LEO};

    #[test]
    fn what_consolidates_has_a_settlement_and_a_unit_of_time() {
        let case = |head: &str| {
            let text = format!(
                "title = 't'\n{head}\n[[sweep]]\nmethod = ['GIMP']\nintegrator = ['implicit']\ncells = [2]\n"
            );
            records_of(&text).remove(0).case
        };
        let footing = case("scene = 'footing'");
        assert_eq!([final_settlement(&footing), unit_of_time(&footing)], [None; 2]);
        let mut column =
            case("scene = 'terzaghi'\noutput.time_factors = [0.1]\ncolumn = { height = 2.0, load = 12e3 }");
        // m_v q H = 12e3/1.2e6 · 2 m; H² γ_w/(k E_oed) = 4 · 9810/(1e-4 · 1.2e6) s.
        let near =
            |value: Option<f64>, wanted: f64| value.is_some_and(|value| (value / wanted - 1.0).abs() < 0.01);
        assert!(near(final_settlement(&column), 0.02) && near(unit_of_time(&column), 327.0));
        column.scene = &XIE_LEO;
        assert!(near(final_settlement(&column), 2.0 * (1.0 - (-0.01_f64).exp())), "logarithmic strain");
        column.scene = &COSINE_LAYER;
        assert_eq!(final_settlement(&column), None);
    }
}
