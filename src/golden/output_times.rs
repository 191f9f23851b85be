//! Outputs at the same times, s, of a case whose inputs changed: a study that names times has other time factors then, and
//! its golden values are of these.

use crate::case::keys::{KEYS, Kind};
use crate::case::{Case, Task, Value};
use crate::study::units::in_si;
use oedometer_scenes::Scene;
use std::collections::BTreeMap;

/// Largest relative difference of two times that are the same: round-off of inputs that were written and read.
const SAME: f64 = 1e-9;
/// Key of the time factors among the inputs of a case.
pub(super) const KEY: &str = "time_factors";

/// Inputs of a case by their keys.
type Inputs<'a> = BTreeMap<&'a str, &'a str>;

/// Time factors of the inputs before, each with the one of the inputs after that is the same time: of all outputs where all
/// have a partner; else of those that only one side has, for the others were typed as time factors.
pub(super) fn moved(before: &Inputs<'_>, after: &Inputs<'_>) -> Vec<(f64, f64)> {
    if before.get(KEY) == after.get(KEY) {
        return Vec::new();
    }
    let pairs = || {
        let (old, new) = (factors(before)?, factors(after)?);
        let [unit_before, unit_after] = [seconds_per_time_factor(before)?, seconds_per_time_factor(after)?];
        let is_same = |old: f64, new: f64| {
            (old * unit_before - new * unit_after).abs() <= SAME * (old * unit_before).abs()
        };
        let only = |side: &[f64], other: &[f64]| -> Vec<f64> {
            side.iter().copied().filter(|factor| !other.contains(factor)).collect()
        };
        let paired = |old: &[f64], new: &[f64]| -> Vec<(f64, f64)> {
            let pair = |old: &f64| Some((*old, *new.iter().find(|new| is_same(*old, **new))?));
            old.iter().filter_map(pair).collect()
        };
        let all = paired(&old, &new);
        let is_all = all.len() == old.len() && old.len() == new.len();
        Some(if is_all { all } else { paired(&only(&old, &new), &only(&new, &old)) })
    };
    pairs().unwrap_or_default()
}

/// Whether all time factors are those of before, or the same times.
pub(super) fn are_all_paired(before: &Inputs<'_>, after: &Inputs<'_>, moved: &[(f64, f64)]) -> bool {
    let (Some(mut old), Some(new)) = (factors(before), factors(after)) else { return false };
    for factor in &mut old {
        let partner = moved.iter().find(|(from, _)| from == factor);
        *factor = partner.map_or(*factor, |(_, to)| *to);
    }
    old == new
}

/// The name of a value with its time factor exchanged for that of the same time.
pub(super) fn at_time(name: String, moved: &[(f64, f64)]) -> String {
    let Some((measure, typed)) = name.rsplit_once(" T_v=") else { return name };
    let Ok(factor) = typed.parse::<f64>() else { return name };
    match moved.iter().find(|(from, _)| *from == factor) {
        Some((_, to)) => format!("{measure} T_v={to}"),
        None => name,
    }
}

fn factors(inputs: &Inputs<'_>) -> Option<Vec<f64>> {
    serde_json::from_str(inputs.get(KEY)?).ok()
}

/// Time, s, at which `T_v` = 1 by the inputs of a case; none where one of them is unknown to this program.
fn seconds_per_time_factor(inputs: &Inputs<'_>) -> Option<f64> {
    let mut case = Case::seed(Task::Solve, Scene::named(inputs.get("scene")?)?);
    for key in KEYS {
        let Some(typed) = inputs.get(key.name) else { continue };
        let value = match key.kind {
            Kind::Number(_) => Value::Number(typed.parse().or_else(|_| in_si(typed, key.unit)).ok()?),
            Kind::Word(words) => Value::Word(words.iter().copied().find(|word| word == typed)?),
            Kind::Method | Kind::TimeStep | Kind::Flag | Kind::Count(_) => continue,
        };
        key.set(&mut case, value);
    }
    Some(case.seconds_per_time_factor())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs<'a>(conductivity: &'a str, height: &'a str, factors: &'a str) -> Inputs<'a> {
        let named = [("hydraulic_conductivity", conductivity), ("height", height), (KEY, factors)];
        named.into_iter().chain([("scene", "terzaghi")]).collect()
    }

    /// `T_v` = `c_v` t/H²: twice the conductivity doubles it, twice the height makes a quarter of it.
    #[test]
    fn outputs_at_the_same_times_are_paired_and_typed_time_factors_stand_for_themselves() {
        let before = inputs("1e-4 m/s", "1 m", "[0.1,0.2,0.4]");
        for (after, pairs, are_all) in [
            (inputs("2e-4 m/s", "1 m", "[0.2,0.4,0.8]"), &[(0.1, 0.2), (0.2, 0.4), (0.4, 0.8)][..], true),
            (inputs("1e-4 m/s", "2 m", "[0.025,0.05,0.1]"), &[(0.1, 0.025), (0.2, 0.05), (0.4, 0.1)], true),
            (inputs("3e-4 m/s", "1 m", "[0.1,0.2,0.4]"), &[], true),
            (inputs("3e-4 m/s", "1 m", "[0.1,0.6]"), &[(0.2, 0.6)], false),
            (inputs("3e-4 m/s", "1 m", "[0.5]"), &[], false),
            (inputs("what", "1 m", "[0.3,0.6,1.2]"), &[], false),
        ] {
            let found = moved(&before, &after);
            assert_eq!(found, pairs, "{after:?}");
            assert_eq!(are_all_paired(&before, &after, &found), are_all, "{after:?}");
        }
        let swapped = [(0.1, 0.2), (0.2, 0.1)];
        for (name, right) in [
            ("a | pressure T_v=0.1", "a | pressure T_v=0.2"),
            ("a | pressure T_v=0.2", "a | pressure T_v=0.1"),
            ("a | pressure T_v=0.3", "a | pressure T_v=0.3"),
            ("a | steps", "a | steps"),
        ] {
            assert_eq!(at_time(name.to_owned(), &swapped), right);
        }
    }
}
