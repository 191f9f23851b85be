//! What is the setting? Geometry and soil of a study, the settlement in the end, and what a time factor of one is on the clock.

use crate::case::Case;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::sentence::{Amount, Layer};
use oedometer_scenes::column::column_parameters;
use oedometer_scenes::scene::Clock;
use oedometer_soil::material::Material;

/// What is the setting? It stands at the head of the page of a study.
pub static SETTING: Question = Question {
    id: "setting",
    heading: "Setting",
    template: include_str!("setting.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence: the least and the largest of all cases.
#[derive(serde::Serialize)]
struct Facts {
    /// What all layers share.
    stated: Vec<Amount>,
    /// What differs from layer to layer in the first case, from the base up.
    layers: Vec<Layer>,
    /// Whether other cases have other layers.
    layers_vary: bool,
    /// Settlement of the surface in the end, m.
    settlement: Option<[f64; 2]>,
    /// What a time factor of one is, s.
    unit_of_time: Option<[f64; 2]>,
}

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

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let cases: Vec<&Case> = one.records.iter().map(|record| &record.case).collect();
    let first = *cases.first()?;
    // What all layers share is the body's, and what differs is said layer by layer.
    let differs = |value: fn(&Material) -> f64| {
        let mut soils = cases.iter().map(|case| case.soils());
        soils.any(|soils| soils.iter().any(|(_, soil)| value(soil) != value(&soils[0].1)))
    };
    let of_body =
        STATED.iter().filter_map(|(symbol, unit, value)| Some(amount(symbol, unit, range(&cases, value)?)));
    let (layered, shared): (Vec<&StatedOfSoil>, Vec<_>) =
        OF_SOIL.iter().partition(|(_, _, value)| differs(*value));
    let of_soil = shared.iter().filter_map(|(symbol, unit, value)| {
        Some(amount(symbol, unit, range(&cases, |case| value(&case.soils()[0].1))?))
    });
    let layer = |(thickness, soil): &(f64, Material)| {
        let stated = layered.iter().map(|(symbol, unit, value)| amount(symbol, unit, [value(soil); 2]));
        Layer { thickness: *thickness, stated: stated.collect() }
    };
    let facts = Facts {
        stated: of_body.chain(of_soil).collect(),
        layers: if layered.is_empty() { Vec::new() } else { first.soils().iter().map(layer).collect() },
        layers_vary: cases.iter().any(|other| other.column.soils != first.column.soils),
        settlement: range(&cases, |case| final_settlement(case).unwrap_or(0.0)),
        unit_of_time: range(&cases, |case| unit_of_time(case).unwrap_or(0.0)),
    };
    Some(SETTING.answer([one.study.name.as_str()], &facts))
}

fn amount(symbol: &str, unit: &str, [least, most]: [f64; 2]) -> Amount {
    Amount { symbol: symbol.to_owned(), unit: unit.to_owned(), least, most }
}

/// The least and the largest of all cases; `None` where it is nowhere given.
fn range(cases: &[&Case], value: impl Fn(&Case) -> f64) -> Option<[f64; 2]> {
    let all = || cases.iter().map(|case| value(case)).filter(|value| *value != 0.0);
    Some([all().reduce(f64::min)?, all().reduce(f64::max)?])
}

/// What the surface of a column settles by in the end, m.
fn final_settlement(case: &Case) -> Option<f64> {
    // Each layer has its own share.
    let settlement = case.scene.final_settlement.filter(|_| case.column.soils.is_empty())?;
    Some(settlement(&case.column, &case.material))
}

/// What a time factor of one is on the clock, s, where the scene consolidates.
fn unit_of_time(case: &Case) -> Option<f64> {
    let consolidates = matches!(case.scene.clock, Clock::Consolidation | Clock::HalfSpace);
    consolidates.then(|| column_parameters(&case.column, &case.material).time(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, solved};
    use crate::case::planned::Tier;
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

    fn setting_of(text: &str) -> String {
        let (study, records) = solved("s", text);
        let found = ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("cases");
        found.sentence().expect("a sentence")
    }

    #[test]
    fn a_clay_is_told_in_kilopascals_millimetres_and_days() {
        let study = |soil: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n[column]\nheight = 5.0\nload = 50e3\n[output]\ntime_factors = [0.1]\n\
                 [[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [4]\nhydraulic_conductivity = [1e-9]\n{soil}\n"
            );
            setting_of(&text)
        };
        // m_v q H = 5e4/1.2e6 · 5 m; H² γ_w/(k E_oed) = 25 · 9810/(1e-9 · 1.2e6) s.
        assert_eq!(
            study(""),
            "*H* = 5 m, *q* = 50 kPa, *E* = 1 MPa, *ν* = 0.25, *n* = 0.3, *k* = 1e-9 m/s, *K_w* = 2.2 GPa; \
             final settlement 208.3 mm; a time factor of one is 6.5 years."
        );
        let several = study("youngs_modulus = [5e5, 1e6]");
        assert!(several.contains("*E* = 500 kPa … 1 MPa"), "{several}");
        assert!(
            several.contains("208.3 mm … 416.7 mm") && several.contains("6.5 years … 13 years"),
            "{several}"
        );
    }

    #[test]
    fn layers_are_told_by_what_differs_among_them() {
        let told = setting_of(
            "title = 't'\nscene = 'layered'\noutput.time_factors = [0.1]\ncolumn.height = 3.0\n[[column.soils]]\nthickness = 1.0\n\
             youngs_modulus = 2e6\n[[column.soils]]\nthickness = 2.0\nyoungs_modulus = 5e6\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [3]\n",
        );
        let layers = "*K_w* = 2.2 GPa; layers from the base up: 1 m with *E* = 2 MPa; 2 m with *E* = 5 MPa; a time factor";
        assert!(told.contains(layers) && told.matches("*E*").count() == 2, "{told}");
    }
}
