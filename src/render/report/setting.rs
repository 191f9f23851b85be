//! The setting of a study in everyday units: geometry and soil, settlement in millimetres, time in days.

use crate::case::Case;
use crate::record::Record;
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::column_parameters;
use oedometer_soil::elementary;
use oedometer_soil::wording::duration;

/// A quantity of a case: its symbol, unit and value in SI.
type Stated = (&'static str, &'static str, fn(&Case) -> f64);

/// What is stated of every scene, in the order in which it is read.
const STATED: [Stated; 7] = [
    ("H", "m", |case| case.column.height),
    ("q", "Pa", |case| case.column.load),
    ("E", "Pa", |case| case.material.youngs_modulus),
    ("ν", "", |case| case.material.poissons_ratio),
    ("n", "", |case| case.material.porosity),
    ("k", "m/s", |case| case.material.hydraulic_conductivity),
    ("K_w", "Pa", |case| case.material.water_bulk_modulus),
];

/// The inputs of all cases in one sentence, ranges where they differ, and what they come to; `None` where nothing was run.
pub fn sentence(records: &[Record]) -> Option<String> {
    let cases: Vec<&Case> = records.iter().map(|record| &record.case).collect();
    let stated = STATED.iter().filter_map(|(symbol, unit, value)| {
        let text = range(&cases, unit, value)?;
        Some(format!("*{symbol}* = {text}"))
    });
    let inputs = stated.collect::<Vec<_>>().join(", ");
    let outcome: Vec<String> = [settlement(&cases), unit_of_time(&cases)].into_iter().flatten().collect();
    (!inputs.is_empty()).then(|| {
        let outcome = if outcome.is_empty() { String::new() } else { format!(": {}", outcome.join("; ")) };
        format!("{inputs}{outcome}.")
    })
}

/// The value that all cases share, or the least and the largest; `None` where it is nowhere given.
fn range(cases: &[&Case], unit: &str, value: impl Fn(&Case) -> f64) -> Option<String> {
    let values: Vec<f64> = cases.iter().map(|case| value(case)).filter(|value| *value != 0.0).collect();
    let (least, most) = ends(&values)?;
    Some(if least == most {
        with_unit(least, unit)
    } else {
        format!("{} … {}", with_unit(least, unit), with_unit(most, unit))
    })
}

/// The least and the largest of some values.
fn ends(values: &[f64]) -> Option<(f64, f64)> {
    let all = || values.iter().copied();
    Some((all().reduce(f64::min)?, all().reduce(f64::max)?))
}

/// A value in the unit that suits it.
fn with_unit(value: f64, unit: &str) -> String {
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

/// What the surface of a column settles by in the end.
fn settlement(cases: &[&Case]) -> Option<String> {
    let of = |case: &Case| match case.scene {
        SceneKind::Terzaghi => column_parameters(&case.column, &case.material).final_settlement(),
        SceneKind::XieLeo => {
            let strain = 1.0 - elementary::exp(-case.column.load / case.material.oedometric_modulus());
            case.column.height * strain
        }
        _ => 0.0,
    };
    let text = range(cases, "mm", |case| 1e3 * of(case))?;
    Some(format!("the surface settles by {text} in the end"))
}

/// What a time factor of one is on the clock, where the scene consolidates.
fn unit_of_time(cases: &[&Case]) -> Option<String> {
    let first = cases.first()?;
    let consolidates =
        first.scene.is_loaded() && !matches!(first.scene, SceneKind::Footing | SceneKind::SealedElement);
    let seconds = |case: &&Case| column_parameters(&case.column, &case.material).time(1.0);
    let all: Vec<f64> = cases.iter().map(seconds).collect();
    let (least, most) = ends(&all)?;
    let text =
        if least == most { duration(least) } else { format!("{} … {}", duration(least), duration(most)) };
    consolidates.then(|| format!("T_v = 1 is {text}"))
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
}
