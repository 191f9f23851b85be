//! The setting of a study in everyday units: geometry and soil, settlement in millimetres, time in days.

use crate::case::Case;
use crate::record::Record;
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::column_parameters;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use oedometer_soil::wording::duration;

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

/// The inputs of all cases in one sentence, ranges where they differ, and what they come to; `None` where nothing was run.
pub fn sentence(records: &[Record]) -> Option<String> {
    let cases: Vec<&Case> = records.iter().map(|record| &record.case).collect();
    let stated = STATED.iter().filter_map(|(symbol, unit, value)| {
        let text = range(&cases, value, |value| with_unit(value, unit))?;
        Some(format!("*{symbol}* = {text}"))
    });
    // What all layers share is the body's, and what differs is said layer by layer.
    let differs = |value: fn(&Material) -> f64| {
        let mut soils = cases.iter().map(|case| case.soils());
        soils.any(|soils| soils.iter().any(|(_, soil)| value(soil) != value(&soils[0].1)))
    };
    let of_soil =
        OF_SOIL.iter().filter(|(_, _, value)| !differs(*value)).filter_map(|(symbol, unit, value)| {
            let text = range(&cases, |case| value(&case.soils()[0].1), |value| with_unit(value, unit))?;
            Some(format!("*{symbol}* = {text}"))
        });
    let mut inputs = stated.chain(of_soil).collect::<Vec<_>>().join(", ");
    let layered = OF_SOIL.iter().filter(|(_, _, value)| differs(*value)).collect::<Vec<_>>();
    if let Some(case) = cases.first().filter(|_| !layered.is_empty()) {
        let layer = |(thickness, soil): &(f64, Material)| {
            let own = layered
                .iter()
                .map(|(symbol, unit, value)| format!("*{symbol}* = {}", with_unit(value(soil), unit)));
            format!("{} with {}", with_unit(*thickness, "m"), own.collect::<Vec<_>>().join(", "))
        };
        let layers = case.soils().iter().map(layer).collect::<Vec<_>>().join("; ");
        let varied = if cases.iter().any(|other| other.column.soils != case.column.soils) {
            ", first case"
        } else {
            ""
        };
        inputs.extend(["; layers from the base up", varied, ": ", &layers]);
    }
    let settlement =
        range(&cases, |case| 1e3 * final_settlement(case).unwrap_or(0.0), |value| with_unit(value, "mm"))
            .map(|text| format!("the surface settles by {text} in the end"));
    let time = range(&cases, |case| unit_of_time(case).unwrap_or(0.0), duration)
        .map(|text| format!("T_v = 1 is {text}"));
    let outcome: Vec<String> = [settlement, time].into_iter().flatten().collect();
    (!inputs.is_empty()).then(|| {
        let outcome = if outcome.is_empty() { String::new() } else { format!(": {}", outcome.join("; ")) };
        format!("{inputs}{outcome}.")
    })
}

/// The value that all cases share, or the least and the largest, in words; `None` where it is nowhere given.
fn range(cases: &[&Case], value: impl Fn(&Case) -> f64, words: impl Fn(f64) -> String) -> Option<String> {
    let all = || cases.iter().map(|case| value(case)).filter(|value| *value != 0.0);
    let (least, most) = (all().reduce(f64::min)?, all().reduce(f64::max)?);
    Some(if least == most { words(least) } else { format!("{} … {}", words(least), words(most)) })
}

/// A value in the unit that suits it.
pub fn with_unit(value: f64, unit: &str) -> String {
    let scaled = |scale: f64| format!("{:.3e}", value / scale).parse::<f64>().unwrap_or(value);
    let prefixes: &[(f64, &str)] = match unit {
        "Pa" => &[(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")],
        _ => &[],
    };
    if let Some((scale, name)) = prefixes.iter().find(|(scale, _)| value.abs() >= *scale) {
        return format!("{} {name}", scaled(*scale));
    }
    let is_plain = (1e-3..1e4).contains(&value.abs());
    let number = if is_plain { format!("{}", scaled(1.0)) } else { format!("{:e}", scaled(1.0)) };
    format!("{number} {unit}").trim_end().to_owned()
}

/// What the surface of a column settles by in the end, m.
pub fn final_settlement(case: &Case) -> Option<f64> {
    match case.scene {
        // Each layer has its own share.
        _ if !case.column.soils.is_empty() => None,
        SceneKind::Terzaghi => Some(column_parameters(&case.column, &case.material).final_settlement()),
        SceneKind::XieLeo => {
            let strain = 1.0 - elementary::exp(-case.column.load / case.material.oedometric_modulus());
            Some(case.column.height * strain)
        }
        _ => None,
    }
}

/// What a time factor of one is on the clock, s, where the scene consolidates.
pub fn unit_of_time(case: &Case) -> Option<f64> {
    let is_fast = matches!(case.scene, SceneKind::Footing | SceneKind::SealedElement);
    let consolidates = case.scene.is_loaded() && !is_fast;
    consolidates.then(|| column_parameters(&case.column, &case.material).time(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

    #[test]
    fn a_clay_is_told_in_kilopascals_millimetres_and_days() {
        let study = |soil: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n[column]\nheight = 5.0\nload = 50e3\n[output]\ntime_factors = [0.1]\n\
                 [[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [4]\nhydraulic_conductivity = [1e-9]\n{soil}\n"
            );
            sentence(&records_of(&text)).expect("it ran")
        };
        // m_v q H = 5e4/1.2e6 · 5 m; H² γ_w/(k E_oed) = 25 · 9810/(1e-9 · 1.2e6) s.
        assert_eq!(
            study(""),
            "*H* = 5 m, *q* = 50 kPa, *E* = 1 MPa, *ν* = 0.25, *n* = 0.3, *k* = 1e-9 m/s, *K_w* = 2.2 GPa: the surface settles \
             by 208.3 mm in the end; T_v = 1 is 6.5 years."
        );
        let several = study("youngs_modulus = [5e5, 1e6]");
        assert!(several.contains("*E* = 500 kPa … 1 MPa"), "{several}");
        assert!(
            several.contains("208.3 mm … 416.7 mm") && several.contains("6.5 years … 13 years"),
            "{several}"
        );
        assert_eq!(sentence(&[]), None);
    }

    #[test]
    fn layers_are_told_by_what_differs_among_them() {
        let records = records_of(
            "title = 't'\nscene = 'layered'\noutput.time_factors = [0.1]\ncolumn.height = 3.0\n[[column.soils]]\nthickness = 1.0\n\
             youngs_modulus = 2e6\n[[column.soils]]\nthickness = 2.0\nyoungs_modulus = 5e6\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [3]\n",
        );
        let told = sentence(&records).expect("a setting");
        let layers =
            "*K_w* = 2.2 GPa; layers from the base up: 1 m with *E* = 2 MPa; 2 m with *E* = 5 MPa: T_v = 1";
        assert!(told.contains(layers) && told.matches("*E*").count() == 2, "{told}");
    }

    #[test]
    fn numbers_have_the_unit_that_suits_them_and_what_does_not_consolidate_has_no_time() {
        for (value, unit, words) in [
            (1e9, "Pa", "1 GPa"),
            (9.99e8, "Pa", "999 MPa"),
            (1e6, "Pa", "1 MPa"),
            (-2500.0, "Pa", "-2.5 kPa"),
            (1.0, "Pa", "1 Pa"),
            (0.5, "Pa", "0.5 Pa"),
            (1e-3, "m/s", "0.001 m/s"),
            (9.9e-4, "m/s", "9.9e-4 m/s"),
            (9999.0, "m", "9999 m"),
            (1e4, "m", "1e4 m"),
            (0.123_456, "", "0.1235"),
        ] {
            assert_eq!(with_unit(value, unit), words);
        }
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
        column.scene = SceneKind::XieLeo;
        assert!(near(final_settlement(&column), 2.0 * (1.0 - (-0.01_f64).exp())), "logarithmic strain");
        column.scene = SceneKind::CosineLayer;
        assert_eq!(final_settlement(&column), None);
    }
}
