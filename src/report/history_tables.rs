//! Results over time as tables: two states of studies, and golden values over commits.

use crate::golden::compare::{Change, Difference};
use crate::history::comparison::{StudyComparison, Trend};
use crate::history::timeline::{Step, Timeline};
use crate::render::number;
use crate::render::table::{Cell, Mood, Table, columns};
use crate::report::tables::golden_changes::summary;
use oedometer_wording::{count_of, first_few};
use std::collections::{BTreeMap, BTreeSet};

fn trend(trend: Trend) -> Cell {
    let mood = match trend {
        Trend::Same | Trend::Improved => Mood::Pass,
        Trend::Mixed | Trend::Regressed => Mood::Fail,
    };
    Cell::Verdict(mood, trend.name().to_owned())
}

/// Studies that are the same with a row each; more are named in one line where others differ.
const MOST_SAME: usize = 10;

/// Two states beside each other: the studies that differ, what got worse first, then what differs in them, and the
/// names of those that are the same.
pub(crate) fn comparison_tables(found: &[StudyComparison], names: [&str; 2]) -> Vec<Table> {
    let found = worst_first(found);
    let (differing, same): (Vec<_>, Vec<_>) = found.iter().copied().partition(|one| differs(one));
    let mut table = summary_table(&found, names);
    if same.len() > MOST_SAME && !differing.is_empty() {
        let studies = same.iter().map(|one| one.study.as_str()).collect::<Vec<_>>().join(", ");
        table =
            summary_table(&differing, names).note(format!("{} studies are the same: {studies}.", same.len()));
    }
    table = table.notes(origins(&found, names));
    let details = [cases_table(&found), inputs_table(&found), moved_table(&found), orders_table(&found)];
    std::iter::once(table).chain(details.into_iter().flatten()).collect()
}

/// What made the values of each state, with the number of studies where it is not all of them.
fn origins(found: &[&StudyComparison], names: [&str; 2]) -> Vec<String> {
    let of_state = |(state, name): (usize, &str)| {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for made_by in found.iter().flat_map(|one| &one.made_by[state]) {
            *counts.entry(made_by).or_default() += 1;
        }
        let all = counts.into_iter().map(|(made_by, studies)| match studies {
            _ if studies == found.len() => made_by.to_owned(),
            _ => format!("{made_by} ({})", count_of(studies, "study", "studies")),
        });
        let all: Vec<String> = all.collect();
        (!all.is_empty()).then(|| format!("{name} was made by {}.", all.join("; ")))
    };
    names.into_iter().enumerate().filter_map(of_state).collect()
}

/// One row per study, those that are the same among them, for programs.
pub(crate) fn comparison_rows(found: &[StudyComparison], names: [&str; 2]) -> Table {
    summary_table(&worst_first(found), names)
}

/// Whether a value, an input or the set of values is another.
fn differs(one: &StudyComparison) -> bool {
    one.has_changed() || one.unpaired > 0
}

/// What got worse first, then what changed, those that moved most in front.
fn worst_first(found: &[StudyComparison]) -> Vec<&StudyComparison> {
    let rank = |one: &StudyComparison| match (one.is_regression(), differs(one)) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => 2,
    };
    let mut sorted: Vec<&StudyComparison> = found.iter().collect();
    sorted.sort_by(|a, b| {
        let change = |one| largest_change(one).unwrap_or(0.0);
        rank(a).cmp(&rank(b)).then_with(|| change(b).total_cmp(&change(a)))
    });
    sorted
}

/// The largest relative change of a value that both states have; `None` where nothing moved.
fn largest_change(one: &StudyComparison) -> Option<f64> {
    one.groups.iter().filter_map(|group| group.worst.relative_change()).reduce(f64::max)
}

/// A row per study.
fn summary_table(found: &[&StudyComparison], names: [&str; 2]) -> Table {
    let row = |one: &&StudyComparison| {
        let of = |change: &[Change]| {
            let groups = one.groups.iter().filter(|group| change.contains(&group.change));
            groups.map(|group| group.values as u64).sum::<u64>()
        };
        let (gone, new) = (of(&[Change::Missing]), of(&[Change::Extra]));
        let moved = one.groups.iter().map(|group| group.values as u64).sum::<u64>() - gone - new;
        vec![
            Cell::Code(one.study.clone()),
            trend(one.accuracy),
            trend(one.cost),
            Cell::Count(one.values as u64),
            Cell::Count(moved),
            Cell::Count(gone),
            Cell::Count(new),
            Cell::of(largest_change(one), Cell::Error, "nothing moved"),
        ]
    };
    let header = "study | accuracy | cost | > values | > moved | > gone | > new | > largest relative change";
    let mut table = Table::of(format!("{} → {}", names[0], names[1]), columns(header), found.iter().map(row))
        .note("Cost is judged by work counters.");
    if found.iter().any(|one| one.seconds.is_some()) {
        table.columns.extend(columns("> processor time before [s] | > after [s]"));
        for (row, one) in table.rows.iter_mut().zip(found) {
            let median = |state: usize| one.seconds.map(|seconds| seconds[state].median);
            row.extend([0, 1].map(|state| Cell::of(median(state), Cell::Measured, "not timed in both")));
        }
        table = table.note("Times are medians over runs; they are never judged.");
    }
    table
}

/// The cases that were removed and added; none where both states have the same.
fn cases_table(found: &[&StudyComparison]) -> Option<Table> {
    let rows = found.iter().filter(|one| one.cases_apart.iter().any(|cases| !cases.is_empty()));
    let rows = rows.map(|one| {
        let [removed, added] = &one.cases_apart;
        vec![Cell::Code(one.study.clone()), cases(removed), cases(added)]
    });
    Table::of("cases removed and added", columns("study | removed | added"), rows).unless_empty()
}

/// The inputs that differ; none where none does.
fn inputs_table(found: &[&StudyComparison]) -> Option<Table> {
    let rows =
        found.iter().flat_map(|one| one.inputs.iter().map(move |input| (one, input))).map(|(one, input)| {
            let value = |text: &str| if text.is_empty() { Cell::missing("not given") } else { text.into() };
            let (study, key) = (Cell::Code(one.study.clone()), Cell::Code(input.key.clone()));
            vec![study, key, value(&input.before), value(&input.after), Cell::Count(input.cases as u64)]
        });
    let header = "study | input | before | after | > cases";
    Table::of("inputs that differ", columns(header), rows).unless_empty()
}

/// What moved, a row per kind of change; none where nothing did.
fn moved_table(found: &[&StudyComparison]) -> Option<Table> {
    let rows = found.iter().flat_map(|one| one.groups.iter().map(move |group| (one, group)));
    let rows = rows.map(|(one, group)| {
        let [before, after] = values_of(&group.worst);
        let (study, value) = (Cell::Code(one.study.clone()), Cell::Code(group.worst.key.to_string()));
        vec![study, Cell::Text(summary(group)), value, before, after]
    });
    let header = "study | what | worst value | > before | > after";
    Table::of("what moved", columns(header), rows).unless_empty()
}

/// The series whose order or class is another; none where there is none.
fn orders_table(found: &[&StudyComparison]) -> Option<Table> {
    let rows = found.iter().flat_map(|one| one.orders.iter().map(move |change| (one, change)));
    let rows = rows.map(|(one, change)| {
        let mut row = vec![Cell::Code(one.study.clone()), Cell::Code(change.series.clone())];
        for state in [&change.before, &change.after] {
            row.extend([Cell::of(state.order, Cell::Order, "the errors give none"), state.class.into()]);
        }
        row
    });
    let header = "study | series | > order before | class before | > order after | class after";
    Table::of("orders and classes that changed", columns(header), rows).unless_empty()
}

/// The value before and after, with digits that tell them apart.
fn values_of(one: &Difference) -> [Cell; 2] {
    if let (Some(before), Some(after)) = (one.golden, one.found) {
        return number::told_apart([before, after]).map(Cell::Text);
    }
    [one.golden, one.found]
        .map(|value| value.map_or(Cell::missing("no value"), |value| Cell::Text(number::error(value))))
}

/// Cases that are named before the rest is only counted.
const MOST_CASES: usize = 3;

/// Cases by their labels, or a dash.
fn cases(all: &[String]) -> Cell {
    match all {
        [] => Cell::missing("no case"),
        _ => Cell::Code(first_few(all.to_vec(), MOST_CASES).join(", ")),
    }
}

/// Whether errors or work rose or fell at a commit: nothing is known of that where no value is left to compare.
fn trend_of(step: &Step, word: Trend) -> Cell {
    if step.shared == 0 { Cell::missing("no value in common with the previous file") } else { trend(word) }
}

/// Golden values over time: a row per commit that changed them.
pub(crate) fn timeline_table(lines: &[Timeline]) -> Table {
    let rows = lines.iter().flat_map(|line| {
        line.steps.iter().map(|step| {
            vec![
                Cell::Code(line.study.clone()),
                Cell::Code(step.commit.short().to_owned()),
                step.commit.date.as_str().into(),
                cases(&step.removed),
                cases(&step.added),
                trend_of(step, step.accuracy),
                trend_of(step, step.cost),
                Cell::Measured(step.error_index),
                Cell::Measured(step.work_index),
                Cell::Count(step.moved as u64),
                Cell::Count(step.unpaired as u64),
                Cell::Error(step.largest_change),
                step.reason.as_str().into(),
                step.commit.subject.as_str().into(),
            ]
        })
    });
    Table::of(
        "golden values over time",
        columns(
            "study | commit | date | cases removed | cases added | accuracy | cost | > error index | > work index \
             | > moved | > added or removed | > largest relative change | reason | commit subject",
        ),
        rows,
    )
    .note("Indices are geometric means relative to the first golden file, chained over the values that \
           successive files share.")
}

/// The last state of each study, one row each.
pub(crate) fn timeline_summary(lines: &[Timeline]) -> Table {
    let rows = lines.iter().filter_map(|line| {
        let last = line.steps.last()?;
        let steps = line.steps.iter().skip(1).filter(|step| step.has_changed());
        let moved = steps.clone().next_back();
        let all = |of: fn(&Step) -> &Vec<String>| {
            line.steps.iter().flat_map(of).map(String::as_str).collect::<BTreeSet<_>>()
        };
        let (removed, added) = (all(|step| &step.removed), all(|step| &step.added));
        let apart = |one: &BTreeSet<&str>, other: &BTreeSet<&str>| {
            cases(&one.difference(other).map(|case| (*case).to_owned()).collect::<Vec<_>>())
        };
        Some(vec![
            Cell::Code(line.study.clone()),
            apart(&removed, &added),
            apart(&added, &removed),
            Cell::Count(line.steps.len() as u64),
            Cell::Count(steps.count() as u64),
            Cell::Measured(last.error_index),
            Cell::Measured(last.work_index),
            moved.map_or(Cell::missing("nothing changed"), |step| Cell::Code(step.commit.short().to_owned())),
            moved.map_or(Cell::missing("nothing changed"), |step| step.reason.as_str().into()),
        ])
    });
    Table::of(
        "golden values over time",
        columns(
            "study | cases removed | cases added | > commits | > with changes | > error index | > work index \
             | last with a change | its reason",
        ),
        rows,
    )
    .note("Indices: geometric mean of the errors, and of the work, relative to the first golden file.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::golden::inputs::InputChange;
    use crate::golden::measure::key;
    use crate::history::comparison::{Behaviour, OrderChange, Seconds};
    use crate::history::repository::Commit;
    use crate::history::state::StudyState;

    /// A study whose errors, one a mesh, go from these values to others.
    fn meshes<const N: usize>(name: &str, states: [[Option<f64>; N]; 2]) -> StudyComparison {
        let state = |errors: [Option<f64>; N]| {
            let measure =
                |mesh: usize| key(&format!("GIMP cells={}", 4 << mesh), 1.0, "pressure points terzaghi");
            let value = |(mesh, error): (usize, Option<f64>)| Some((measure(mesh), error?));
            let values = errors.into_iter().enumerate().filter_map(value).collect();
            StudyState::of_golden(GoldenFile { values, ..GoldenFile::of(name, &[], "-") })
        };
        let [before, after] = states.map(state);
        StudyComparison::of(name, &before, &after)
    }

    /// A study whose error on the second mesh goes from one value to another.
    fn study(name: &str, before: f64, after: Option<f64>) -> StudyComparison {
        meshes(name, [Some(before), after].map(|error| [Some(0.5), error]))
    }

    #[test]
    fn what_got_worse_comes_first_and_many_that_are_the_same_are_named_below() {
        let mut found: Vec<StudyComparison> =
            (0..=MOST_SAME).map(|one| study(&format!("a{one}"), 0.2, Some(0.2))).collect();
        found.push(study("better", 0.2, Some(0.1)));
        found.push(meshes("new", [None, Some(0.2)].map(|error| [Some(0.5), error])));
        found.push(study("gone", 0.2, None));
        let states = [[Some(0.5), Some(0.3), None, None], [Some(0.6), None, Some(0.2), Some(0.1)]];
        found.push(meshes("all-kinds", states));
        found.push(study("much-worse", 0.2, Some(0.4)));
        found.push(study("worse", 0.2, Some(0.3)));
        let rows = |table: &Table| -> Vec<String> {
            table.rows.iter().map(|row| format!("{:?} {:?} {:?}", row[0], row[1], row[5])).collect()
        };
        let tables = comparison_tables(&found, ["A", "B"]);
        let told = rows(&tables[0]);
        let names = ["much-worse", "worse", "all-kinds", "gone", "better", "new"];
        assert_eq!(told.len(), names.len(), "{told:?}");
        for (row, name) in told.iter().zip(names) {
            assert!(row.contains(&format!("Code(\"{name}\")")), "{name}: {told:?}");
        }
        // In both, moved, gone, new.
        let counts = [[2, 1, 0, 0], [2, 1, 0, 0], [1, 1, 1, 2], [1, 0, 1, 0], [2, 1, 0, 0], [1, 0, 0, 1]];
        for (row, counts) in tables[0].rows.iter().zip(counts) {
            assert_eq!(format!("{:?}", &row[3..7]), format!("{:?}", counts.map(Cell::Count)));
        }
        assert!(tables[0].notes.iter().any(|note| note.starts_with("11 studies are the same: a0, a1")));
        assert_eq!(comparison_rows(&found, ["A", "B"]).rows.len(), found.len(), "programs get every study");
        assert_eq!(rows(&comparison_tables(&found[..3], ["A", "B"])[0]).len(), 3, "few have a row each");
    }

    fn step(number: usize, moved: usize, unpaired: usize) -> Step {
        let at = number as f64;
        let (accuracy, cost) = [(Trend::Same, Trend::Improved), (Trend::Mixed, Trend::Regressed)][number % 2];
        Step {
            commit: Commit {
                hash: format!("{number}23456789abc"),
                date: format!("2026-01-0{number}"),
                subject: format!("Subject {number}"),
            },
            reason: format!("reason {number}"),
            removed: Vec::new(),
            added: (0..if number == 1 { 0 } else { unpaired }).map(|case| format!("case {case}")).collect(),
            values: 40,
            shared: 40,
            error_index: 0.5 * at,
            work_index: 0.25 * at,
            moved,
            unpaired,
            largest_change: 0.125 * at,
            accuracy,
            cost,
        }
    }

    fn csv(table: &Table) -> Vec<String> {
        table.to_csv().expect("a table").lines().skip(1).map(str::to_owned).collect()
    }

    #[test]
    fn a_timeline_tells_every_commit_and_in_short_the_last_that_changed_anything() {
        // What the first file has has not moved.
        let all = [
            Timeline {
                study: "a".to_owned(),
                steps: vec![step(1, 9, 2), step(2, 5, 0), step(3, 7, 1), step(4, 0, 3)],
            },
            Timeline { study: "b".to_owned(), steps: vec![step(1, 9, 0)] },
            Timeline { study: "c".to_owned(), steps: Vec::new() },
        ];
        let rows = [
            "a,12345678,2026-01-01,,,mixed,regressed,0.5,0.25,9,2,0.125,reason 1,Subject 1",
            "a,22345678,2026-01-02,,,same,improved,1.0,0.5,5,0,0.25,reason 2,Subject 2",
            "a,32345678,2026-01-03,,case 0,mixed,regressed,1.5,0.75,7,1,0.375,reason 3,Subject 3",
            "a,42345678,2026-01-04,,\"case 0, case 1, case 2\",same,improved,2.0,1.0,0,3,0.5,reason 4,Subject 4",
            "b,12345678,2026-01-01,,,mixed,regressed,0.5,0.25,9,0,0.125,reason 1,Subject 1",
        ];
        assert_eq!(csv(&timeline_table(&all)), rows);
        assert_eq!(
            csv(&timeline_summary(&all)),
            ["a,,\"case 0, case 1, case 2\",4,3,2.0,1.0,42345678,reason 4", "b,,,1,0,0.5,0.25,,"]
        );
    }

    #[test]
    fn states_have_their_times_their_values_and_their_orders_side_by_side() {
        let seconds = |median: f64, least: f64, most: f64| Seconds { median, least, most };
        let moods =
            [Trend::Same, Trend::Improved, Trend::Mixed, Trend::Regressed].map(|one| trend(one).show());
        assert_eq!(moods, ["✓ same", "✓ improved", "✗ mixed", "✗ regressed"]);
        let timed = [seconds(2.0, 1.0, 3.0), seconds(5.0, 4.0, 6.0)];
        let mut one = StudyComparison { seconds: Some(timed), ..study("timed", 0.75, Some(1.0)) };
        let behaviour = |order: Option<f64>, class: &'static str| Behaviour { class, order };
        one.orders = vec![OrderChange {
            series: "its series".to_owned(),
            before: behaviour(Some(2.0), "asymptotic"),
            after: behaviour(None, "divergent"),
        }];
        one.inputs = vec![InputChange {
            key: "porosity".to_owned(),
            before: String::new(),
            after: "0.4".to_owned(),
            cases: 3,
        }];
        let found = [study("other", 0.2, Some(0.2)), one, study("gone", 0.25, None)];
        let tables = comparison_tables(&found, ["A", "B"]);
        let titles: Vec<&str> = tables.iter().map(|table| table.title.as_str()).collect();
        assert_eq!(
            titles,
            [
                "A → B",
                "cases removed and added",
                "inputs that differ",
                "what moved",
                "orders and classes that changed"
            ]
        );
        let told: Vec<Vec<String>> = tables.iter().map(csv).collect();
        assert_eq!(
            told[0],
            [
                "timed,regressed,same,2,1,0,0,0.25,2.0,5.0",
                "gone,same,same,1,0,1,0,,,",
                "other,same,same,2,0,0,0,,,"
            ]
        );
        assert_eq!(told[1], ["gone,GIMP cells=8,"]);
        assert_eq!(told[2], ["timed,porosity,,0.4,3"]);
        let value = "GIMP cells=8 | pressure points terzaghi T_v=1";
        let moved = "\"1 value moved, in 1 case; largest relative change 2.50e-1\"";
        let gone = "\"1 value is no longer measured, in 1 case\"";
        assert_eq!(
            told[3],
            [format!("timed,{moved},{value},7.50e-1,1.00"), format!("gone,{gone},{value},2.50e-1,")]
        );
        assert_eq!(told[4], ["timed,its series,2.0,asymptotic,,divergent"]);
        assert_eq!(
            comparison_tables(&found[..1], ["A", "B"]).len(),
            1,
            "where nothing differs there are no details"
        );
    }
}
