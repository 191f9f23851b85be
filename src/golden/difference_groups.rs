//! Differences by kind, with what those of a kind have in common: a long list says less than one line
//! that names the cases it is of and its largest change.

use crate::golden::compare::{Change, Difference};
use crate::golden::parts;
use std::collections::{BTreeMap, BTreeSet};

/// The differences of one kind.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DifferenceGroup {
    /// What happened.
    pub change: Change,
    /// Values.
    pub values: usize,
    /// Cases that they are of.
    pub cases: usize,
    /// Words of the cases' labels that all of them share and that not every value of the study has.
    pub shared_by_cases: Vec<String>,
    /// Words of the measures that all of them share and that not every value of the study has.
    pub shared_by_measures: Vec<String>,
    /// The worst.
    pub worst: Difference,
    /// Where most of its error is, as a sentence: of somebody else's result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
}

/// Words of a value's name, each marked with the side it stands on.
fn words(name: &str) -> BTreeSet<(NameSide, &str)> {
    let (case, measure) = parts(name);
    // Variants stand in brackets behind the label: `(u-p, implicit drag)`.
    let (label, variants) = case.split_once(" (").unwrap_or((case, ""));
    let variants = variants.trim_end_matches(')').split(", ").filter(|variant| !variant.is_empty());
    let of_case = label.split_whitespace().chain(variants).map(|word| (NameSide::Case, word));
    of_case.chain(measure.split_whitespace().map(|word| (NameSide::Measure, word))).collect()
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum NameSide {
    Case,
    Measure,
}

/// The groups of differences that are in their order, the worst group first. `all` are the names of
/// every value that was compared.
pub fn groups_of<'a>(
    differences: &[Difference],
    all: impl IntoIterator<Item = &'a str>,
) -> Vec<DifferenceGroup> {
    let mut everywhere: BTreeMap<(NameSide, &str), usize> = BTreeMap::new();
    let mut number = 0;
    for name in all {
        number += 1;
        for word in words(name) {
            *everywhere.entry(word).or_default() += 1;
        }
    }
    let mut groups = Vec::new();
    for of_kind in differences.chunk_by(|a, b| a.change == b.change) {
        let Some(worst) = of_kind.first() else { continue };
        let mut shared = words(&worst.name);
        for one in of_kind {
            let words = words(&one.name);
            shared.retain(|word| words.contains(word));
        }
        shared.retain(|word| everywhere.get(word).is_none_or(|count| *count < number));
        let of = |side| shared.iter().filter(|word| word.0 == side).map(|word| word.1.to_owned()).collect();
        groups.push(DifferenceGroup {
            change: worst.change,
            values: of_kind.len(),
            cases: of_kind.iter().map(|one| parts(&one.name).0).collect::<BTreeSet<_>>().len(),
            shared_by_cases: of(NameSide::Case),
            shared_by_measures: of(NameSide::Measure),
            worst: worst.clone(),
            place: None,
        });
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::golden::compare::compare;

    /// Names of a study with two methods, two meshes, two formulations and three measures.
    fn names() -> Vec<String> {
        let mut all = Vec::new();
        for method in ["MPM", "GIMP"] {
            for cells in [4, 8] {
                for variant in ["(u-p, implicit drag)", "(implicit drag)"] {
                    for measure in
                        ["steps", "pressure points l2 terzaghi T_v=0.1", "settlement surface relative T_v=1"]
                    {
                        all.push(format!("{method} implicit cells={cells} {variant} | {measure}"));
                    }
                }
            }
        }
        all
    }

    /// The groups where values are changed by factors.
    fn groups(factor: impl Fn(&str) -> f64) -> Vec<DifferenceGroup> {
        let values: BTreeMap<String, f64> = names().into_iter().map(|name| (name, 0.5)).collect();
        let found = values.iter().map(|(name, value)| (name.clone(), value * factor(name))).collect();
        let golden = GoldenFile { values: values.clone(), ..GoldenFile::of("study", &[], "test") };
        groups_of(&compare(&golden, &found), values.keys().map(String::as_str))
    }

    #[test]
    fn what_the_values_of_a_group_share_is_told_and_what_all_share_is_not() {
        let found = groups(|name| match (name.contains("u-p"), name.contains("pressure")) {
            (true, true) if name.contains("cells=8") && name.starts_with("GIMP") => 1.5,
            (true, true) => 1.1,
            _ => 1.0,
        });
        assert_eq!(found.len(), 1, "{found:?}");
        let group = &found[0];
        assert_eq!((group.change, group.values, group.cases), (Change::Moved, 4, 4));
        assert_eq!(group.shared_by_cases, ["u-p"], "`implicit` and `implicit drag` are of every case");
        assert_eq!(group.shared_by_measures, ["T_v=0.1", "l2", "points", "pressure", "terzaghi"]);
        assert!(group.worst.name.starts_with("GIMP implicit cells=8 (u-p"), "{}", group.worst.name);
        assert!((group.worst.relative_change().expect("both sides") - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn kinds_are_kept_apart_and_values_without_a_common_word_have_none() {
        let found = groups(|name| match name {
            name if name.starts_with("MPM") && name.contains("steps") => 2.0,
            name if name.starts_with("GIMP") && name.contains("settlement") => 0.5,
            _ => 1.0,
        });
        let kinds: Vec<_> = found.iter().map(|group| (group.change, group.values)).collect();
        assert_eq!(kinds, [(Change::Moved, 4), (Change::Stale, 4)]);
        assert_eq!(found[0].shared_by_cases, ["MPM"]);
        assert_eq!(found[1].shared_by_cases, ["GIMP"]);
        let everything = groups(|_| 1.1);
        assert!(everything[0].shared_by_cases.is_empty() && everything[0].shared_by_measures.is_empty());
    }
}
