//! Labels of paths that stand side by side: what differs, and what all share.

use crate::case::SolverName;
use crate::judge::paths::Path;
use oedometer_problem::method::{FULL_PROJECTION, Method};
use std::collections::{BTreeMap, BTreeSet};

/// Labels of paths that share a figure or a table: what differs, and what all share.
pub struct PathLabels {
    /// One label a path.
    pub each: Vec<String>,
    /// What all paths share.
    pub shared: String,
}

/// A part of a label with a long number as a study has it: `reload_modulus=1.2e7`.
fn with_power_of_ten(part: &str) -> String {
    let number = |text: &str| text.parse::<f64>().ok().filter(|value| value.abs() >= 1e5);
    match part.split_once('=').and_then(|(name, value)| Some((name, number(value)?))) {
        Some((name, value)) => format!("{name}={value:e}"),
        None => part.to_owned(),
    }
}

/// The name of a method with another share of the published projection: `PPP(0.5)`, not its choices one by one.
fn scaled_name(path: &Path<'_>) -> Option<String> {
    let SolverName::Own(method) = path.records[0].case.method else { return None };
    let full = Method { projection: FULL_PROJECTION, ..method }.to_string();
    let is_scaled = method.projection != FULL_PROJECTION && Method::named(&full).is_some();
    is_scaled.then(|| format!("{full}({})", f64::from(method.projection) / f64::from(FULL_PROJECTION)))
}

/// Splits the labels of paths into what differs and what is shared; the method is always named.
pub fn path_labels(paths: &[Path<'_>]) -> PathLabels {
    let mut parts: Vec<Vec<String>> = paths.iter().map(Path::parts).collect();
    for (own, path) in parts.iter_mut().zip(paths) {
        if let Some(name) = scaled_name(path) {
            own[0] = name;
        }
    }
    // Explicit steps follow their limit and are told only where nothing else tells two paths apart.
    let alike = |own: &Vec<String>| parts.iter().filter(|other| *other == own).count() > 1;
    let alike: Vec<bool> = parts.iter().map(alike).collect();
    for ((own, path), _) in parts.iter_mut().zip(paths).zip(alike).filter(|(_, is_alike)| *is_alike) {
        own.push(path.records[0].case.time_step.to_string());
    }
    let mut paths_with: BTreeMap<&str, usize> = BTreeMap::new();
    for own in &parts {
        let once: BTreeSet<&str> = own.iter().map(String::as_str).collect();
        for part in once {
            *paths_with.entry(part).or_default() += 1;
        }
    }
    let is_shared = |part: &String| paths_with.get(part.as_str()) == Some(&parts.len());
    let each = parts.iter().map(|own| {
        let differing = own.iter().enumerate().filter(|(place, part)| *place == 0 || !is_shared(part));
        differing.map(|(_, part)| with_power_of_ten(part)).collect::<Vec<_>>().join(", ")
    });
    let shared = parts
        .first()
        .map_or(Vec::new(), |own| own[1..].iter().filter(|part| is_shared(part)).cloned().collect());
    PathLabels { each: each.collect(), shared: shared.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::judge::paths::paths;
    use crate::study::expectation::Axis;

    #[test]
    fn runs_that_differ_in_their_explicit_steps_alone_are_told_apart_by_them() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.001]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['explicit']\ncells = [2, 4]\ntime_step = [{ stable = 0.5 }, { stable = 0.9 }]\n\
             water_bulk_modulus = [1e7]\n",
        );
        let labels = path_labels(&paths(&records, Axis::Cells));
        assert_eq!(labels.each, ["MPM, stable=0.5", "MPM, stable=0.9"]);
    }

    #[test]
    fn a_scaled_projection_keeps_the_name_of_its_method() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
             method = ['PPP', { basis = 'cpgimp', strain = 'standard', pressure = 'points', recovery = 'ppp', projection = 0.5 }]\nintegrator = ['implicit']\ncells = [2, 4]\n",
        );
        assert_eq!(path_labels(&paths(&records, Axis::Cells)).each, ["PPP", "PPP(0.5)"]);
    }

    #[test]
    fn a_long_number_is_written_as_a_study_has_it() {
        let parts =
            ["reload_modulus=12000000", "preconsolidation=100000", "load=99999", "x=-100000", "GIMP", "a=b"];
        assert_eq!(
            parts.map(with_power_of_ten),
            ["reload_modulus=1.2e7", "preconsolidation=1e5", "load=99999", "x=-1e5", "GIMP", "a=b"]
        );
    }
}
