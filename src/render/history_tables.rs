//! Results over time as tables: two states of studies, and golden values over commits.

use crate::history::comparison::{StudyComparison, Trend};
use crate::history::timeline::Timeline;
use crate::render::number;
use crate::render::table::{Cell, Mood, Table, columns};
use crate::render::tables::golden_changes::summary;

fn trend(trend: Trend) -> Cell {
    let mood = match trend {
        Trend::Same | Trend::Improved => Mood::Pass,
        Trend::Mixed | Trend::Regressed => Mood::Fail,
    };
    Cell::Verdict(mood, trend.name().to_owned())
}

/// Two states beside each other: a row per study, then what moved in it.
pub(crate) fn comparison_tables(found: &[StudyComparison], names: [&str; 2]) -> Vec<Table> {
    let row = |one: &StudyComparison| {
        let largest =
            |of: fn(&StudyComparison) -> Option<f64>| Cell::of(of(one), Cell::Error, "nothing moved");
        vec![
            Cell::Code(one.study.clone()),
            trend(one.accuracy),
            trend(one.cost),
            Cell::Count(one.values as u64),
            Cell::Count(
                one.groups.iter().map(|group| group.values as u64).sum::<u64>() - one.unpaired as u64,
            ),
            Cell::Count(one.unpaired as u64),
            largest(|one| {
                let changes = one.groups.iter().filter_map(|group| group.worst.relative_change());
                changes.reduce(f64::max)
            }),
            Cell::of(one.seconds.map(|[before, after]| after / before), Cell::Number, "not timed in both"),
        ]
    };
    let header = "study | accuracy | cost | > values | > moved | > in one state only | > largest relative change \
                  | > processor time, after over before";
    let mut tables = vec![
        Table::of(format!("{} → {}", names[0], names[1]), columns(header), found.iter().map(row))
            .note("Cost is judged by work counters; times are shown and never judged."),
    ];
    let inputs: Vec<Vec<Cell>> = found
        .iter()
        .flat_map(|one| one.inputs.iter().map(move |input| (one, input)))
        .map(|(one, input)| {
            let value = |text: &str| if text.is_empty() { Cell::missing("not given") } else { text.into() };
            vec![
                Cell::Code(one.study.clone()),
                Cell::Code(input.key.clone()),
                value(&input.before),
                value(&input.after),
                Cell::Count(input.cases as u64),
            ]
        })
        .collect();
    if !inputs.is_empty() {
        tables.push(Table::of(
            "inputs that differ",
            columns("study | input | before | after | > cases"),
            inputs,
        ));
    }
    let moved: Vec<Vec<Cell>> = found
        .iter()
        .flat_map(|one| one.groups.iter().map(move |group| (one, group)))
        .map(|(one, group)| {
            let value = |value: Option<f64>| {
                value.map_or(Cell::missing("no value"), |value| number::exact(value).as_str().into())
            };
            vec![
                Cell::Code(one.study.clone()),
                Cell::Text(summary(group)),
                Cell::Code(group.worst.name.clone()),
                value(group.worst.golden),
                value(group.worst.found),
            ]
        })
        .collect();
    if !moved.is_empty() {
        tables.push(Table::of(
            "what moved",
            columns("study | what | worst value | > before | > after"),
            moved,
        ));
    }
    tables
}

/// Golden values over time: a row per commit that changed them.
pub(crate) fn timeline_table(lines: &[Timeline]) -> Table {
    let rows = lines.iter().flat_map(|line| {
        line.steps.iter().map(|step| {
            vec![
                Cell::Code(line.study.clone()),
                Cell::Code(step.commit.short().to_owned()),
                step.commit.date.as_str().into(),
                trend(step.accuracy),
                trend(step.cost),
                Cell::Number(step.error_index),
                Cell::Number(step.work_index),
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
            "study | commit | date | accuracy | cost | > error index | > work index | > moved | > came or went \
             | > largest relative change | reason | commit subject",
        ),
        rows,
    )
    .note("Indices are geometric means over those of the first golden file, chained over the values that neighbours share.")
}

/// The last state of each study, one row each.
pub(crate) fn timeline_summary(lines: &[Timeline]) -> Table {
    let rows = lines.iter().filter_map(|line| {
        let last = line.steps.last()?;
        let steps = line.steps.iter().skip(1).filter(|step| step.moved > 0);
        let moved = steps.clone().next_back();
        Some(vec![
            Cell::Code(line.study.clone()),
            Cell::Count(line.steps.len() as u64),
            Cell::Count(steps.count() as u64),
            Cell::Number(last.error_index),
            Cell::Number(last.work_index),
            moved.map_or(Cell::missing("nothing moved"), |step| Cell::Code(step.commit.short().to_owned())),
            moved.map_or(Cell::missing("nothing moved"), |step| step.reason.as_str().into()),
        ])
    });
    Table::of(
        "golden values over time",
        columns(
            "study | > commits | > with values that moved | > error index | > work index | last that moved | its reason",
        ),
        rows,
    )
    .note("Indices: geometric mean of the errors, and of the work, over those of the first golden file.")
}
