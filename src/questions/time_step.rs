//! What does the time step change? The errors over the step, the order in it, and from where on it is unstable.

use crate::case::grouping::grouped;
use crate::case::{Quantity, Sample};
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question, best};
use crate::questions::series::{LevelError, Series, SeriesTable, name_of_level};
use crate::questions::series_figure::figure;
use crate::record::{Record, Status};
use crate::render::page::Block;
use crate::study::expectation::Axis;
use oedometer_convergence::Class;
use oedometer_exact::ExactError;
use serde::Serialize;

/// What does the time step change?
pub static TIME_STEP: Question = Question {
    id: "time-step",
    heading: "What does the time step change?",
    template: include_str!("time-step.md"),
    places: &[Place::Terminal, Place::Study, Place::Report],
    ask,
};

/// An error that a smaller step reduces by less than this factor is not the step's.
const STEP_COUNTS: f64 = 1.1;

/// Runs of one order that the sentence names.
const MOST_NAMED: usize = 4;

/// Every number and name of the sentence.
#[derive(Debug, PartialEq, Serialize)]
struct Facts {
    /// Time factor.
    time_factor: f64,
    /// Orders of the pressure in the step, each with the runs that have it.
    orders: Vec<StepOrder>,
    /// Runs of one order that are named.
    most_named: usize,
    /// Runs that fail from some step on.
    unstable: Vec<UnstableStep>,
    /// The run whose error against the exact solution changes most with the step.
    most: Option<StepChange>,
}

/// An order in the step.
#[derive(Debug, PartialEq, Serialize)]
struct StepOrder {
    /// Class of the series; none of fewer than three differences.
    class: Option<Class>,
    /// Order to two decimals, where the class has one.
    order: Option<f64>,
    /// Labels of the runs.
    runs: Vec<String>,
}

/// The smallest step that failed.
#[derive(Debug, PartialEq, Serialize)]
struct UnstableStep {
    /// Label of the runs.
    run: String,
    /// The step.
    step: String,
    /// How it ended.
    ending: &'static str,
}

/// Errors of the pressure with the largest and the smallest step that reached the end.
#[derive(Debug, PartialEq, Serialize)]
struct StepChange {
    /// Label of the runs.
    run: String,
    /// Largest and smallest step.
    steps: [String; 2],
    /// Relative L2 errors with these.
    errors: [f64; 2],
    /// Whether the smaller step makes the error smaller, by a tenth or more.
    is_of_step: bool,
}

/// The study that finds the order in the step of most methods answers.
fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let most = best(studies, |one| {
        let Some(found) = SeriesTable::new(one, Axis::TimeStep) else { return Ok(None) };
        let with_order = pressures(&found).filter(|one| one.class().is_some()).count();
        Ok(Some(((with_order, found.series.len()), found)))
    })?;
    let Some((one, found)) = most else { return Ok(None) };
    let mut facts = facts_of(&found);
    facts.unstable.extend(failed_alone(one, &found));
    let drawn = figure(&found, (Quantity::Pressure, Sample::Points));
    let finding = TIME_STEP
        .answer([one.study.name.as_str()], &facts)
        .with(Block::Table(found.table(TIME_STEP.id)))
        .with(Block::Figures(drawn.into_iter().collect()));
    Ok(Some(finding))
}

/// The series of the pressure, those at the centres of cells aside.
fn pressures<'s, 'a>(found: &'s SeriesTable<'a>) -> impl Iterator<Item = &'s Series<'a>> {
    let is_pressure =
        |one: &&Series<'_>| one.measured.0 == Quantity::Pressure && one.measured.1 != Sample::Centres;
    found.series.iter().filter(is_pressure)
}

fn facts_of(found: &SeriesTable<'_>) -> Facts {
    let rounded = |one: &&Series<'_>| one.order().map(|order| (100.0 * order).round().to_bits());
    let orders = grouped(pressures(found), |one| (one.class().map(Class::name), rounded(one)));
    let orders = orders.into_iter().map(|((_, rounded), of_order)| StepOrder {
        class: of_order[0].class(),
        order: rounded.map(|hundredths| f64::from_bits(hundredths) / 100.0),
        runs: of_order.iter().map(|one| one.label.clone()).collect(),
    });
    let step = |place: usize| name_of_level(found.levels[place].1, Axis::TimeStep);
    let unstable = pressures(found).filter_map(|one| {
        let place = one.errors.iter().rposition(|error| *error == LevelError::Failed)?;
        let record = one.summary.path.records[0];
        let failed = found.failed_at(record, place)?;
        Some(UnstableStep { run: one.label.clone(), step: step(place), ending: failed.status.name() })
    });
    let changes = pressures(found).filter_map(|one| {
        let [(largest, coarse), (smallest, fine)] = one.ends()?;
        let (run, steps, errors) = (one.label.clone(), [largest, smallest].map(step), [coarse, fine]);
        Some(StepChange { run, steps, errors, is_of_step: coarse / fine > STEP_COUNTS })
    });
    let ratio = |change: &StepChange| change.errors[0] / change.errors[1];
    Facts {
        time_factor: found.time_factor,
        orders: orders.collect(),
        most_named: MOST_NAMED,
        unstable: unstable.collect(),
        most: changes.max_by(|a, b| ratio(a).total_cmp(&ratio(b))),
    }
}

/// The smallest step at which runs failed that have too few steps for a series, for each method and integrator.
fn failed_alone(one: &StudyResults<'_>, found: &SeriesTable<'_>) -> Vec<UnstableStep> {
    let is_told = |record: &Record| {
        let shared = Axis::TimeStep.what_is_shared(&record.case);
        let paths = found.series.iter().map(|one| &one.summary.path.records[0].case);
        paths.into_iter().any(|case| Axis::TimeStep.what_is_shared(case) == shared)
    };
    let failed = one.records.iter().filter(|record| record.status != Status::Ok && !is_told(record));
    let runs = grouped(failed, |record| format!("{}, {}", record.case.method, record.case.integrator.name()));
    let smallest = |(run, records): (String, Vec<&Record>)| {
        let least = records.into_iter().min_by(|a, b| a.step_sizes.target.total_cmp(&b.step_sizes.target))?;
        let (step, ending) = (name_of_level(least, Axis::TimeStep), least.status.name());
        Some(UnstableStep { run, step, ending })
    };
    runs.into_iter().filter_map(smallest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['GIMP-SRI', 'MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [4]\n\
        time_step = [{ seconds = 0.04 }, { seconds = 0.02 }, { seconds = 0.01 }, { seconds = 0.005 }]\n";

    #[test]
    fn the_smallest_step_that_fails_is_the_one_named() {
        let (study, mut records) = solved("s", &STUDY.replace(", 'MPM', 'GIMP'", ""));
        for record in &mut records[..2] {
            record.status = failed_at(1);
        }
        let told = |records: &[Record]| {
            let results = [StudyResults::new(&study, records, Tier::Full)];
            let found = ask(&results).expect("sound cases").expect("steps");
            let unstable = found.facts["unstable"].as_array().expect("a list").clone();
            let told = unstable.iter().map(|one| format!("{} {} {}", one["run"], one["ending"], one["step"]));
            (told.collect::<Vec<_>>(), found.facts["most"]["steps"].clone())
        };
        let first = r#""GIMP-SRI" "unstable" "Δt = 0.02 s""#.to_owned();
        assert_eq!(told(&records), (vec![first.clone()], serde_json::json!(["Δt = 0.01 s", "Δt = 0.005 s"])));
        // A run that failed at its only step is no less unstable.
        let mut alone = records[0].clone();
        alone.hash = "another".to_owned();
        alone.case.cells = 7;
        records.push(alone);
        assert_eq!(told(&records).0, [first, r#""GIMP-SRI, implicit" "unstable" "Δt = 0.04 s""#.to_owned()]);
        assert_eq!(ask(&[]).expect("nothing to refuse"), None);
    }

    #[test]
    fn runs_of_one_order_stand_together_and_the_one_that_the_step_changes_most_is_told() {
        let (study, mut records) = solved("s", STUDY);
        for (error, most, is_of_step) in
            [(0.1, "MPM", true), (0.2728, "MPM", false), (f64::NAN, "GIMP", false)]
        {
            for (place, record) in records.iter_mut().enumerate() {
                let (method, step) = (place / 4, place % 4);
                let value = match method {
                    1 => [0.3, 0.2, 0.2, error][step],
                    _ => [0.12, 0.115, 0.11, 0.1095 - 0.0001 * method as f64][step],
                };
                record.errors.iter_mut().for_each(|row| row.value = -value);
            }
            if error.is_nan() {
                records
                    .iter_mut()
                    .filter(|one| one.case.method.to_string() == "MPM")
                    .for_each(|one| one.errors.clear());
            }
            let results = [StudyResults::new(&study, &records, Tier::Full)];
            let found = SeriesTable::new(&results[0], Axis::TimeStep).expect("steps");
            let facts = facts_of(&found);
            let runs: usize = facts.orders.iter().map(|order| order.runs.len()).sum();
            assert_eq!(runs, if error.is_nan() { 2 } else { 3 });
            let change = facts.most.expect("two errors");
            assert_eq!((change.run.as_str(), change.is_of_step), (most, is_of_step), "{error}");
        }
    }
}
