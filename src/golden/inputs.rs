//! Inputs of the cases of a golden file, and which of them changed: a changed input explains changed values.

use crate::case::{Case, Key};
use crate::golden::output_times;
use crate::study::inputs::unit_of;
use oedometer_soil::wording::count_of;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Inputs of a case by their keys in a study file (`youngs_modulus`, `points.jitter`), as a study may give them: numbers
/// with their unit.
pub type Inputs = BTreeMap<String, String>;

/// Inputs of the cases of a study: those that all cases share once, and the others by the label of their case.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct CaseInputs {
    /// Equal in all cases. Empty where no inputs are known, for all cases of a study have a scene.
    pub shared: Inputs,
    /// What differs between the cases.
    #[serde(skip)]
    pub own: BTreeMap<String, Inputs>,
}

impl CaseInputs {
    /// The inputs of cases.
    pub fn of<'a>(cases: impl IntoIterator<Item = &'a Case>) -> Self {
        let mut own: BTreeMap<String, Inputs> =
            cases.into_iter().map(|case| (case.label(), inputs_of(case))).collect();
        let mut shared = own.values().next().cloned().unwrap_or_default();
        shared.retain(|key, value| own.values().all(|inputs| inputs.get(key) == Some(value)));
        for inputs in own.values_mut() {
            inputs.retain(|key, _| !shared.contains_key(key));
        }
        Self { shared, own }
    }

    /// Those of one case.
    #[must_use]
    pub fn only(&self, label: &str) -> Self {
        let own = self.own.iter().filter(|(other, _)| *other == label);
        Self { own: own.map(|(label, own)| (label.clone(), own.clone())).collect(), ..self.clone() }
    }

    /// Whether none are known.
    pub fn is_unknown(&self) -> bool {
        self.shared.is_empty()
    }

    /// All inputs of every case by its label.
    fn whole(&self) -> BTreeMap<&str, BTreeMap<&str, &str>> {
        fn borrowed(inputs: &Inputs) -> impl Iterator<Item = (&str, &str)> {
            inputs.iter().map(|(key, value)| (key.as_str(), value.as_str()))
        }
        let case = |own| borrowed(&self.shared).chain(borrowed(own)).collect();
        self.own.iter().map(|(label, own)| (label.as_str(), case(own))).collect()
    }
}

/// The inputs of a case; what solves it by its name.
fn inputs_of(case: &Case) -> Inputs {
    fn flatten(prefix: &str, value: Value, inputs: &mut Inputs) {
        let key = prefix.rsplit('.').next().unwrap_or(prefix);
        let text = match value {
            Value::Null => return,
            Value::Object(table) => {
                for (key, value) in table {
                    // The tables whose keys a sweep takes by their own name.
                    let is_plain = ["", "column", "material", "settings"].contains(&prefix);
                    let key = if is_plain { key } else { format!("{prefix}.{key}") };
                    flatten(&key, value, inputs);
                }
                return;
            }
            Value::String(word) => word,
            Value::Number(number) if number.is_f64() => {
                let number = shortest(number.as_f64().unwrap_or(f64::NAN));
                unit_of(key).map_or(number.clone(), |unit| format!("{number} {unit}"))
            }
            other => other.to_string(),
        };
        inputs.insert(prefix.to_owned(), text);
    }
    let mut inputs = Inputs::new();
    if let Ok(Value::Object(mut table)) = serde_json::to_value(case) {
        for key in ["method", "time_step"].into_iter().filter_map(|name| Key::named(name, "sweep")) {
            table.insert(key.name.to_owned(), key.get(case).to_string().into());
        }
        flatten("", Value::Object(table), &mut inputs);
    }
    inputs
}

/// A number as short as it can be typed: `0.25`, `1e6`, `2650`.
fn shortest(value: f64) -> String {
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

/// How the cases of two states belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pairing {
    /// Label before and after, of cases that have another label now.
    renamed: BTreeMap<String, String>,
    /// Time factors before and after that are the same times, by the label of their case before.
    moved_times: BTreeMap<String, Vec<(f64, f64)>>,
    /// What differs, the most cases first.
    pub changes: Vec<InputChange>,
}

impl Pairing {
    /// Pairs cases of equal label, and of those that are left the ones whose inputs differ least: a label may tell the
    /// input that changed. Nothing where one side does not know its inputs.
    pub fn of<'a>(before: &'a CaseInputs, after: &'a CaseInputs) -> Self {
        if before.is_unknown() || after.is_unknown() || before == after {
            return Self::default();
        }
        let (old, new) = (before.whole(), after.whole());
        let renamed = nearest(&old, &new);
        let mut counts: BTreeMap<(&str, &str, &str), usize> = BTreeMap::new();
        let mut moved_times = BTreeMap::new();
        for (label, old) in &old {
            let Some(new) = new.get(renamed.get(label).unwrap_or(label)) else { continue };
            let moved = output_times::moved(old, new);
            // Outputs at the same times are no other outputs.
            let are_same = output_times::are_all_paired(old, new, &moved);
            for key in unlike(old, new).filter(|key| !(are_same && *key == output_times::KEY)) {
                let value =
                    |inputs: &BTreeMap<&'a str, &'a str>| inputs.get(key).copied().unwrap_or_default();
                *counts.entry((key, value(old), value(new))).or_default() += 1;
            }
            if !moved.is_empty() {
                moved_times.insert((*label).to_owned(), moved);
            }
        }
        let change = |((key, before, after), cases): ((&str, &str, &str), usize)| InputChange {
            key: key.to_owned(),
            before: before.to_owned(),
            after: after.to_owned(),
            cases,
        };
        let mut changes: Vec<InputChange> = counts.into_iter().map(change).collect();
        changes.sort_by(|a, b| b.cases.cmp(&a.cases).then_with(|| a.key.cmp(&b.key)));
        let owned = |(before, after): (&str, &str)| (before.to_owned(), after.to_owned());
        Self { renamed: renamed.into_iter().map(owned).collect(), moved_times, changes }
    }

    /// What stands by the name of a value or the label of a case, that of cases with another label now under that label, and of
    /// outputs with another time factor now under that time factor.
    pub fn rename<T>(&self, all: BTreeMap<String, T>) -> BTreeMap<String, T> {
        let name = |name: String| {
            let (label, measure) =
                name.split_once(" | ").map_or((&*name, None), |(label, rest)| (label, Some(rest)));
            let moved = self.moved_times.get(label).map_or(&[][..], Vec::as_slice);
            match (self.renamed.get(label), measure) {
                (Some(label), Some(measure)) => output_times::at_time(format!("{label} | {measure}"), moved),
                (Some(label), None) => label.clone(),
                (None, Some(_)) => output_times::at_time(name, moved),
                (None, None) => name,
            }
        };
        all.into_iter().map(|(one, value)| (name(one), value)).collect()
    }
}

/// Keys whose values differ.
fn unlike<'a>(
    one: &'a BTreeMap<&'a str, &'a str>,
    other: &'a BTreeMap<&'a str, &'a str>,
) -> impl Iterator<Item = &'a str> {
    let keys: BTreeSet<&str> = one.keys().chain(other.keys()).copied().collect();
    keys.into_iter().filter(|key| one.get(key) != other.get(key))
}

/// Pairs of cases that are tried: a study of thousands of other labels takes no minutes to compare.
const MOST_PAIRS: usize = 1_000_000;

/// For the labels that only one side has, each with at most one partner, the pairs that differ in the fewest keys; none where there
/// are too many to try.
fn nearest<'a>(
    before: &BTreeMap<&'a str, BTreeMap<&'a str, &'a str>>,
    after: &BTreeMap<&'a str, BTreeMap<&'a str, &'a str>>,
) -> BTreeMap<&'a str, &'a str> {
    let gone = || before.iter().filter(|(label, _)| !after.contains_key(*label));
    let new = || after.iter().filter(|(label, _)| !before.contains_key(*label));
    if gone().count().saturating_mul(new().count()) > MOST_PAIRS {
        return BTreeMap::new();
    }
    let mut pairs: Vec<(usize, &str, &str)> = gone()
        .flat_map(|(label, old)| new().map(move |(other, new)| (unlike(old, new).count(), *label, *other)))
        .collect();
    pairs.sort_unstable();
    let mut found = BTreeMap::new();
    let mut taken = BTreeSet::new();
    for (_, label, other) in pairs {
        if !found.contains_key(label) && taken.insert(other) {
            found.insert(label, other);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn inputs(material: &str, cells: &str) -> CaseInputs {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n{material}\n[[sweep]]\n\
             method = [\"MPM\", \"GIMP\"]\nintegrator = [\"implicit\"]\ncells = {cells}\n"
        );
        let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
        CaseInputs::of(study.cases(crate::case::Tier::Full))
    }

    fn told(before: &CaseInputs, after: &CaseInputs) -> Vec<String> {
        Pairing::of(before, after).changes.iter().map(InputChange::sentence).collect()
    }

    #[test]
    fn what_all_cases_share_is_kept_once_and_numbers_have_their_unit() {
        let found = inputs("material.youngs_modulus = 1.5e6", "[4, 8]");
        assert_eq!(found.shared["youngs_modulus"], "1.5e6 Pa");
        assert_eq!(found.shared["scene"], "terzaghi");
        assert_eq!(found.own.len(), 4);
        let keys: Vec<&str> =
            found.own["MPM implicit cells=4 points=2 growth=0.05"].keys().map(String::as_str).collect();
        assert_eq!(keys, ["cells", "method"]);
        let label = "GIMP implicit cells=8 points=2 growth=0.05";
        let only = found.only(label);
        assert_eq!(
            (only.shared, only.own),
            (found.shared.clone(), [(label.to_owned(), found.own[label].clone())].into())
        );
        assert_eq!(found.only("GIMP").own.len(), 0);
        assert!(CaseInputs::of([]).is_unknown() && !found.is_unknown());
        for (value, short) in
            [(0.25, "0.25"), (1e6, "1e6"), (2650.0, "2650"), (1e-4, "1e-4"), (1000.0, "1e3"), (120.0, "120")]
        {
            assert_eq!(shortest(value), short);
        }
    }

    #[test]
    fn an_input_that_changed_is_told_with_the_number_of_its_cases() {
        let before = inputs("material.youngs_modulus = 1e6", "[4, 8]");
        let after = inputs("material.youngs_modulus = 1.1e6", "[4, 8]");
        assert_eq!(told(&before, &after), ["youngs_modulus 1e6 Pa → 1.1e6 Pa in 4 cases"]);
        assert_eq!(told(&before, &before), [""; 0]);
        assert_eq!(told(&CaseInputs::default(), &after), [""; 0], "what is not known differs in nothing");
    }

    #[test]
    fn a_study_in_times_keeps_its_golden_values_where_another_soil_has_other_time_factors() {
        let of = |material: &str, times: &str| {
            let text = format!(
                "title = \"t\"\nscene = \"terzaghi\"\noutput = {{ {times} }}\n{material}\n[[sweep]]\nmethod = [\"MPM\"]\n\
                 integrator = [\"implicit\"]\ncells = [4]\n"
            );
            let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
            let case = &study.planned[0].case;
            let name = |factor: &f64| format!("{} | pressure points l2 terzaghi T_v={factor}", case.label());
            let names: Vec<String> = case.time_factors.iter().map(name).collect();
            (CaseInputs::of([case]), names)
        };
        let times = "times = ['10 s', '20 s', '1 min']";
        let (before, old) = of("", times);
        for (material, key) in [
            ("material.hydraulic_conductivity = 1.1e-4", "hydraulic_conductivity"),
            ("material.youngs_modulus = 2e6", "youngs_modulus"),
            ("material.poissons_ratio = 0.3", "poissons_ratio"),
            ("column.height = 2.5", "height"),
        ] {
            let (after, new) = of(material, times);
            assert_ne!(old, new, "{material}");
            let pairing = Pairing::of(&before, &after);
            let values: BTreeMap<String, f64> = old.iter().cloned().zip([1.0, 2.0, 3.0]).collect();
            let moved: BTreeMap<String, f64> = new.into_iter().zip([1.0, 2.0, 3.0]).collect();
            assert_eq!(pairing.rename(values), moved, "{material}");
            let keys: Vec<&str> = pairing.changes.iter().map(|change| change.key.as_str()).collect();
            assert_eq!(keys, [key], "{material}");
        }
        // Another output has no partner, and that is told.
        let (after, _) = of("", "times = ['10 s', '30 s', '1 min']");
        let told = told(&before, &after);
        assert!(told.len() == 1 && told[0].starts_with("time_factors ["), "{told:?}");
    }

    #[test]
    fn a_case_without_partner_is_paired_with_its_nearest_and_each_has_at_most_one() {
        let before = inputs("", "[4, 8]");
        let after = inputs("", "[4, 16]");
        assert_eq!(told(&before, &after), ["cells 8 → 16 in 2 cases"]);
        let value = |label: &str| BTreeMap::from([(format!("{label} | steps"), 1.0)]);
        let pairing = Pairing::of(&before, &after);
        let renamed = pairing.rename(value("GIMP implicit cells=8 points=2 growth=0.05"));
        assert_eq!(renamed, value("GIMP implicit cells=16 points=2 growth=0.05"));
        assert_eq!(told(&before, &inputs("", "[4]")), [""; 0], "a case that is gone has no partner");
    }

    #[test]
    fn a_renamed_case_has_its_nearest_and_leaves_the_others_theirs() {
        let of = |values: [&'static str; 3]| {
            BTreeMap::from([("k", values[0]), ("l", values[1]), ("m", values[2])])
        };
        let before = BTreeMap::from([("a", of(["1", "1", "1"])), ("b", of(["8", "8", "8"]))]);
        let after = BTreeMap::from([("c", of(["1", "1", "2"])), ("d", of(["1", "9", "9"]))]);
        assert_eq!(nearest(&before, &after), BTreeMap::from([("a", "c"), ("b", "d")]));
        assert_eq!(nearest(&after, &before), BTreeMap::from([("c", "a"), ("d", "b")]));
        // Too many to try.
        let labels = |side: &str| (0..=1000).map(|number| format!("{side}{number}")).collect::<Vec<_>>();
        let (old, new) = (labels("a"), labels("b"));
        let [old, new] =
            [&old, &new].map(|all| all.iter().map(|one| (one.as_str(), BTreeMap::new())).collect());
        assert_eq!(nearest(&old, &new), BTreeMap::new());
    }

    #[test]
    fn an_input_that_is_given_on_one_side_only_is_told_from_either() {
        let plain = inputs("", "[4, 8]");
        let jittered = inputs("points.jitter = 0.1", "[4, 8]");
        let forth = told(&plain, &jittered);
        let back = told(&jittered, &plain);
        assert!(forth.iter().any(|one| one.contains("jitter")), "{forth:?}");
        assert_eq!(forth.len(), back.len());
        let of = |all: [(&'static str, &'static str); 2]| BTreeMap::from(all);
        let (one, other) = (of([("k", "1"), ("l", "2")]), of([("k", "1"), ("m", "2")]));
        for (one, other) in [(&one, &other), (&other, &one)] {
            assert_eq!(unlike(one, other).collect::<Vec<_>>(), ["l", "m"]);
        }
        // What a side does not know is `not given` there.
        let with = |key: Option<&str>| CaseInputs {
            shared: [("scene", "terzaghi")]
                .into_iter()
                .chain(key.map(|key| (key, "7")))
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .collect(),
            own: BTreeMap::from(["a", "b"].map(|label| (label.to_owned(), Inputs::new()))),
        };
        assert_eq!(told(&with(None), &with(Some("new"))), ["new not given → 7 in 2 cases"]);
        assert_eq!(told(&with(Some("old")), &with(None)), ["old 7 → not given in 2 cases"]);
        assert_eq!(
            told(&with(Some("old")), &with(Some("new"))),
            ["new not given → 7 in 2 cases", "old 7 → not given in 2 cases"]
        );
    }
}
