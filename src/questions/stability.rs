//! Which steps are stable? Critical steps of a study whose task is stability, predicted and observed.

use crate::judge::study_results::StudyResults;
use crate::measure::statistics::largest;
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{CriticalStep, Probe, Record};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};

/// Which steps are stable?
pub static STABILITY: Question = Question {
    id: "stability",
    heading: "Which steps are stable?",
    template: include_str!("stability.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cases whose critical step was searched.
    cases: usize,
    /// Those of which a step was predicted and observed.
    compared: usize,
    /// The largest difference of observed from predicted, relative.
    largest_deviation: f64,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let searched: Vec<&CriticalStep> =
        one.records.iter().filter_map(|record| record.stability.as_ref()).collect();
    if searched.is_empty() {
        return None;
    }
    // Below the resolution of the search, that.
    let difference = |found: &&CriticalStep| found.known().and(found.within().or(found.deviation()));
    let deviations = || searched.iter().filter_map(difference);
    let facts = Facts {
        cases: searched.len(),
        compared: deviations().count(),
        largest_deviation: largest(deviations().map(f64::abs)).unwrap_or(0.0),
    };
    let summary = "Every case with the runs just below and above its limit".to_owned();
    let every_case = Block::Details { summary, blocks: vec![Block::Table(table(one.records))] };
    Some(STABILITY.answer([one.study.name.as_str()], &facts).with(every_case))
}

/// One row per case: predicted and observed critical step, and what the runs beside the limit did.
pub fn table(records: &[Record]) -> Table {
    let header = "case | > predicted [s] | > observed [s] | > difference | > over h/c | > slow growth from [s] | at 0.97 \
                  | > steps at 0.97 | at 1.03 | > steps at 1.03 | > growth a step | > predicted growth";
    let rows = records.iter().filter_map(row_of);
    Table::of("Critical time step, predicted and observed", columns(header), rows)
        .file("critical-steps")
        .note(
            "predicted: from the spectral radius of the step operator on the case's own grid; observed: by \
         bisection over runs without the prediction, and in a plane of up to 8 × 8 cells over the \
         eigenvalues of its own step, which show a doubling in 10 000 steps; where points deform, the \
         smallest step predicted during the run and the largest fraction of it with which `solve` succeeds; \
         c: the fastest undamped wave",
        )
}

fn row_of(record: &Record) -> Option<Vec<Cell>> {
    let found = record.stability.as_ref()?;
    let predicted = found.known();
    let (no_limit, not_stable) = ("no limit is known: something grows under any step", "no step was stable");
    let why = if predicted.is_none() { no_limit } else { not_stable };
    let mut row = vec![
        Cell::Code(record.case.label_without_step()),
        Cell::of(predicted, Cell::Error, no_limit),
        Cell::of(found.observed, Cell::Error, not_stable),
        match predicted.and(found.within()) {
            Some(within) => Cell::Text(format!("≤ {}", number::percent(within))),
            None => Cell::of(predicted.and(found.deviation()), Cell::Percent, why),
        },
        Cell::Measured(found.predicted / found.wave_limit),
        found.creeping_from.map_or(Cell::Text("–".to_owned()), Cell::Error),
    ];
    row.extend(found.probes.iter().flat_map(|probe| {
        let mood = Mood::of(probe.is_as_predicted());
        [
            Cell::Verdict(mood, end_of(probe).to_owned()),
            Cell::Count(probe.failure.as_ref().map_or(probe.steps, |one| one.step)),
        ]
    }));
    let growing = found.probes.iter().find_map(|probe| Some((probe, probe.failure.as_ref()?.growth?)));
    let factor =
        |growth: Option<f64>, why: &str| Cell::of(growth, |growth| Cell::Text(format!("{growth:.4}")), why);
    row.extend([
        factor(growing.map(|(_, seen)| seen), "nothing grew"),
        factor(growing.and_then(|(probe, _)| probe.predicted_growth), "not predicted"),
    ]);
    Some(row)
}

/// How a run beside the limit ended.
fn end_of(probe: &Probe) -> &'static str {
    match &probe.failure {
        Some(failure) => failure.kind.name(),
        None if probe.reaches_end => "to the end",
        None => "ran",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, solved};
    use crate::case::planned::Tier;
    use oedometer_problem::outcome::{Failure, FailureKind};

    #[test]
    fn the_largest_deviation_counts_on_both_sides_wherever_it_stands() {
        let (study, records) = solved(
            "s",
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\nhydraulic_conductivity = [1e-4, 1e-5, 1e-6]\n",
        );
        for (place, worst) in (0..3).flat_map(|place| [(place, 0.6), (place, 1.4)]) {
            let mut records = records.clone();
            for (number, record) in records.iter_mut().enumerate() {
                record.stability = Some(CriticalStep {
                    predicted: 2.0,
                    observed: Some(2.0 * if number == place { worst } else { 0.9 }),
                    wave_limit: 4.0,
                    drag_limit: 8.0,
                    combined_limit: 3.0,
                    ..CriticalStep::default()
                });
            }
            let found = ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("searched");
            let told = "3 of 3 cases have both a predicted and an observed critical step; they differ by at \
                        most 40.00 %.";
            assert_eq!(found.sentence().expect("a sentence"), told, "{worst} at {place}");
        }
    }

    #[test]
    fn a_limit_that_is_not_known_has_no_difference_and_a_run_beside_it_is_told_by_its_end() {
        let probe = |steps: u64, growth: Option<f64>| Probe {
            share: 1.03,
            step: 0.5,
            steps,
            reaches_end: steps == 7,
            failure: growth.map(|_| {
                let kind = FailureKind::Unstable;
                Failure { kind, step: steps, time: 1.0, growth, reason: String::new() }
            }),
            predicted_growth: (steps == 9).then_some(1.0625),
        };
        let probes = [probe(7, None), probe(8, None), probe(9, Some(1.125)), probe(10, Some(1.25))];
        assert_eq!(probes.each_ref().map(end_of), ["to the end", "ran", "unstable", "unstable"]);
        let with = |observed: Option<f64>, unknown: Option<&str>, places: [usize; 2]| {
            let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                        integrator = ['implicit']\ncells = [2]\n";
            let mut record = records_of(text).remove(0);
            record.stability = Some(CriticalStep {
                predicted: 0.5,
                observed,
                wave_limit: 0.25,
                drag_limit: 1.0,
                combined_limit: 1.0,
                unknown: unknown.map(str::to_owned),
                probes: places.map(|place| probes[place].clone()).to_vec(),
                ..CriticalStep::default()
            });
            table(&[record]).rows.remove(0)
        };
        let found = |observed: Option<f64>, unknown: Option<&str>| with(observed, unknown, [0, 1]);
        let ends =
            |places: [usize; 2]| with(None, None, places)[6..].iter().map(Cell::show).collect::<Vec<_>>();
        assert_eq!(ends([0, 2])[..4], ["✗ to the end", "7", "✓ unstable", "9"].map(str::to_owned));
        assert_eq!(ends([0, 2])[4..], ["1.1250", "1.0625"]);
        assert_eq!(ends([0, 3])[4..], ["1.2500", "–"]);
        assert_eq!(ends([0, 1])[4..], ["–", "–"]);
        let shown: Vec<String> = found(Some(0.75), None).iter().map(Cell::show).collect();
        assert_eq!(shown[1..6], ["5.00e-1", "7.50e-1", "50.0 %", "2.00", "–"]);
        let none = Cell::missing("no step was stable");
        assert_eq!(found(None, None)[2..4], [none.clone(), none]);
        let unknown = found(Some(0.75), Some("a reason"));
        let nothing = "no limit is known: something grows under any step";
        assert_eq!((&unknown[1], &unknown[2]), (&Cell::missing(nothing), &Cell::Error(0.75)));
        assert_eq!(unknown[3], Cell::missing(nothing), "a step was stable");
    }
}
