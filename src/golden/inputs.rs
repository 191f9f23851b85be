//! Inputs that differ between the cases of two states: a changed input explains changed values.

use crate::case::keys::{KEYS, Value};
use crate::case::{Case, Key};
use oedometer_wording::count_of;
use serde::Serialize;
use std::collections::BTreeMap;

/// A number as short as it can be typed: `0.25`, `1e6`, `2650`.
pub(super) fn shortest(value: f64) -> String {
    let (plain, power) = (format!("{value}"), format!("{value:e}"));
    if power.len() < plain.len() { power } else { plain }
}

/// An input that differs in the same way in some cases of a study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct InputChange {
    /// Key, `youngs_modulus`.
    pub key: String,
    /// Value before; empty where it was not given.
    pub before: String,
    /// Value after.
    pub after: String,
    /// Cases in which it differs so.
    pub cases: usize,
}

impl InputChange {
    /// What differs between cases of the same labels, the most cases first.
    pub fn between(before: &BTreeMap<String, Case>, after: &BTreeMap<String, Case>) -> Vec<Self> {
        let mut counts: BTreeMap<(&str, String, String), usize> = BTreeMap::new();
        for (old, new) in before.iter().filter_map(|(label, old)| Some((old, after.get(label)?))) {
            let (old, new) = (inputs_of(old), inputs_of(new));
            for ((key, before), (_, after)) in old.into_iter().zip(new).filter(|(old, new)| old != new) {
                *counts.entry((key, before, after)).or_default() += 1;
            }
        }
        let change = |((key, before, after), cases): ((&str, String, String), usize)| Self {
            key: key.to_owned(),
            before,
            after,
            cases,
        };
        let mut changes: Vec<Self> = counts.into_iter().map(change).collect();
        changes.sort_by(|a, b| b.cases.cmp(&a.cases).then_with(|| a.key.cmp(&b.key)));
        changes
    }

    /// What differs, and in how many cases: `youngs_modulus 1e6 Pa → 1.1e6 Pa in 24 cases`.
    pub fn sentence(&self) -> String {
        let value = |text: &str| if text.is_empty() { "not given".to_owned() } else { text.to_owned() };
        format!(
            "{} {} → {} in {}",
            self.key,
            value(&self.before),
            value(&self.after),
            count_of(self.cases, "case", "cases")
        )
    }
}

/// The inputs of a case as a study may give them, in one order for all cases: numbers with their unit. Keys that give another
/// one in other words are left out: their values follow from it.
fn inputs_of(case: &Case) -> Vec<(&'static str, String)> {
    let text = |key: &Key| match key.get(case) {
        Value::Number(number) => format!("{} {}", shortest(number), key.unit).trim_end().to_owned(),
        other => other.to_string(),
    };
    let lists = [
        ("scene", case.scene.name.to_owned()),
        ("time_factors", format!("{:?}", &case.time_factors[..])),
        ("soils", format!("{:?}", case.column.soils)),
    ];
    let keys = KEYS.iter().filter(|key| key.in_place_of.is_empty());
    keys.map(|key| (key.name, text(key))).chain(lists).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cases(material: &str, cells: &str) -> BTreeMap<String, Case> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n{material}\n[[sweep]]\n\
             method = [\"MPM\", \"GIMP\"]\nintegrator = [\"implicit\"]\ncells = {cells}\n"
        );
        let planned = crate::campaign::runner::study_of("t", &text).planned;
        planned.into_iter().map(|planned| (planned.case.label(), planned.case)).collect()
    }

    #[test]
    fn an_input_that_changed_is_told_with_its_unit_and_the_number_of_its_cases() {
        let before = cases("material.youngs_modulus = 1e6", "[4, 8]");
        for (material, cells, wanted) in [
            ("material.youngs_modulus = 1e6", "[4, 8]", &[][..]),
            ("material.youngs_modulus = 1.1e6", "[4, 8]", &["youngs_modulus 1e6 Pa → 1.1e6 Pa in 4 cases"]),
            ("material.youngs_modulus = 1.1e6", "[8, 16]", &["youngs_modulus 1e6 Pa → 1.1e6 Pa in 2 cases"]),
            ("", "[4, 8]\ntime_factors = [0.2]", &["time_factors [0.1] → [0.2] in 4 cases"]),
            ("column.load = 40", "[4, 8]", &["load 1 Pa → 40 Pa in 4 cases"]),
            ("", "[16]", &[]),
        ] {
            let changes = InputChange::between(&before, &cases(material, cells));
            let told: Vec<String> = changes.iter().map(InputChange::sentence).collect();
            assert_eq!(told, wanted, "{material} {cells}");
        }
        for (value, short) in
            [(0.25, "0.25"), (1e6, "1e6"), (2650.0, "2650"), (1e-4, "1e-4"), (1000.0, "1e3"), (120.0, "120")]
        {
            assert_eq!(shortest(value), short);
        }
    }
}
