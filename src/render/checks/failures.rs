//! What failed in a check, as lines of a terminal's width: the worst first, and the rest counted.

use crate::golden::compare::{CaseChange, Difference};
use crate::judge::study_check::{CaseNote, StudyCheck};
use crate::render::checks::items::{item, wrapped};
use crate::render::number;
use crate::render::tables::golden_changes::{count_of, judgement_of, summary};
use std::fmt::Write;

/// Items of a list before the rest is only counted.
const MOST: usize = 10;

/// Everything that failed, section by section.
pub(crate) fn text_of(check: &StudyCheck) -> String {
    text_of_failures(check) + &text_of_changes(check)
}

/// Expectations that are not met, cases that failed and records that cannot be right.
pub(crate) fn text_of_failures(check: &StudyCheck) -> String {
    let unmet = check.judgements.iter().filter(|judgement| !judgement.verdict.pass);
    let unmet = unmet.map(|judgement| {
        let verdict = &judgement.verdict;
        let (class, reason) = (verdict.classification.class.name(), &verdict.reason);
        item(&format!("✗ {}", judgement.subject), &format!("{class}: {reason}"))
    });
    let notes = |notes: &[CaseNote]| -> Vec<String> {
        notes.iter().map(|note| item(&format!("✗ {}", note.case), &note.sentence)).collect()
    };
    [
        section("expectations not met", unmet.collect()),
        section("failed cases", notes(&check.failed_cases)),
        section("records that cannot be right", notes(&check.unsound)),
    ]
    .concat()
}

/// Golden values that differ: kinds, the worst values, and cases.
fn text_of_changes(check: &StudyCheck) -> String {
    let mut sections = Vec::new();
    if !check.groups.is_empty() {
        let groups = check.groups.iter().map(|group| wrapped(&summary(group), "  ", "    "));
        sections.push(format!("\ngolden values that differ\n{}", groups.collect::<String>()));
        let (differences, cases) = worth_naming(check.differences(), &check.changes);
        sections.push(section("the worst of them", differences.into_iter().map(difference).collect()));
        sections.push(section("accuracy and cost together", cases.into_iter().map(case_change).collect()));
    }
    sections.concat()
}

/// Values and cases that are named one by one. Many values without a partner are those of an input that changed, which
/// their kind has told already: then only what moved is named.
fn worth_naming<'a>(
    differences: &'a [Difference],
    cases: &'a [CaseChange],
) -> (Vec<&'a Difference>, Vec<&'a CaseChange>) {
    let has_partner = |one: &&Difference| one.golden.is_some() && one.found.is_some();
    if differences.len() <= MOST + differences.iter().filter(has_partner).count() {
        return (differences.iter().collect(), cases.iter().collect());
    }
    let moved = cases.iter().filter(|case| case.worse + case.better > 0).collect();
    (differences.iter().filter(has_partner).collect(), moved)
}

/// A list under its title; nothing where it is empty.
fn section(title: &str, items: Vec<String>) -> String {
    if items.is_empty() {
        return String::new();
    }
    let rest = items.len().saturating_sub(MOST);
    let mut text = format!("\n{title}\n");
    text.extend(items.into_iter().take(MOST));
    if rest > 0 {
        let _ = writeln!(text, "  and {rest} more");
    }
    text
}

fn difference(one: &Difference) -> String {
    let how = match (one.golden, one.found, one.relative_change()) {
        (Some(golden), Some(found), Some(change)) => format!(
            "{}: {} was {}, a relative change of {}, {} its tolerance",
            one.change.name(),
            number::exact(found),
            number::exact(golden),
            number::error(change),
            times((found - golden).abs() / one.tolerance)
        ),
        (Some(golden), None, _) => format!("{}: was {}", one.change.name(), number::exact(golden)),
        (_, found, _) => {
            format!("{}: {}", one.change.name(), found.map_or(String::new(), number::exact))
        }
    };
    item(&one.name, &how)
}

fn times(ratio: f64) -> String {
    format!("{} times", number::number(ratio))
}

fn case_change(one: &CaseChange) -> String {
    let (mood, word) = judgement_of(one);
    let counts = format!(
        "{word}: cost {} of golden, {}, {} fell, {} without a partner",
        number::number(one.cost_ratio),
        count_of(one.worse, "value grew", "values grew"),
        one.better,
        one.unpaired
    );
    item(&format!("{} {}", mood.mark(), one.case), &counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::compare::Change;
    use oedometer_convergence::ParetoChange;

    #[test]
    fn values_of_an_input_that_changed_are_told_by_their_kind_and_hide_nothing_that_moved() {
        let difference = |golden: Option<f64>, found: Option<f64>| Difference {
            name: "MPM | pressure".to_owned(),
            change: if golden.is_some() && found.is_some() { Change::Moved } else { Change::Missing },
            golden,
            found,
            tolerance: 1e-9,
        };
        let case = |worse: usize| CaseChange {
            case: "MPM".to_owned(),
            change: ParetoChange::NotComparable,
            cost_ratio: 1.0,
            worse,
            better: 0,
            unpaired: 1,
        };
        let named = |missing: usize| {
            let mut differences = vec![difference(Some(1.0), None); missing];
            differences.insert(missing / 2, difference(Some(1.0), Some(2.0)));
            let cases = [case(0), case(1)];
            let (values, cases) = worth_naming(&differences, &cases);
            assert!(values.contains(&&differences[missing / 2]), "what moved is always named");
            (values.len(), cases.len())
        };
        assert_eq!(named(MOST), (MOST + 1, 2));
        assert_eq!(named(MOST + 1), (1, 1));
    }

    #[test]
    fn a_long_list_is_cut_and_counted() {
        let items = |count: usize| (0..count).map(|number| format!("  {number}\n")).collect::<Vec<_>>();
        assert_eq!(section("title", items(0)), "");
        assert!(section("title", items(MOST)).ends_with("  9\n"));
        assert!(section("title", items(MOST + 3)).ends_with("  9\n  and 3 more\n"));
    }
}
