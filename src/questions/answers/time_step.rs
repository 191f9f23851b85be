//! What does the time step change? The order in the step, what it leaves of the error, and from where on it is unstable.

use crate::case::{Quantity, Sample};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::{Path, first_measure, grouped, shown_time};
use crate::questions::answers::study_with_most;
use crate::questions::study_results::StudyResults;
use crate::record::{Record, Status};
use crate::study::expectation::{Axis, NEXT_FINER};
use oedometer_convergence::Class;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An error that a smaller step reduces by less than this factor is not the step's.
const STEP_COUNTS: f64 = 1.1;

/// What the time step changes, in the study that finds the order in the step of most methods.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimeStepFinding {
    /// Study.
    pub study: String,
    /// Time factor.
    pub time_factor: f64,
    /// Orders of the pressure in the step, from the differences between neighbouring steps, each with the runs that have it.
    pub orders: Vec<StepOrder>,
    /// Runs that fail from some step on.
    pub unstable: Vec<UnstableStep>,
    /// The run whose error against the exact solution changes most with the step.
    pub most: Option<StepChange>,
}

/// An order in the step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StepOrder {
    /// Class of the series; `not-evaluable` for too few steps.
    pub class: Class,
    /// Order to two decimals, where the class has one.
    pub order: Option<f64>,
    /// Whether the order no longer changes from step to step.
    pub is_settled: bool,
    /// Labels of the runs.
    pub runs: Vec<String>,
}

/// The smallest step that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnstableStep {
    /// Label of the runs.
    pub run: String,
    /// The step.
    pub step: String,
    /// How it ended.
    pub ending: String,
}

/// Errors of the pressure with the largest and the smallest step that reached the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StepChange {
    /// Label of the runs.
    pub run: String,
    /// Largest and smallest step.
    pub steps: [String; 2],
    /// Relative L2 errors with these.
    pub errors: [f64; 2],
    /// Whether the smaller step makes the error smaller, by a tenth or more.
    pub is_of_step: bool,
}

/// What is found of one path along the step.
struct Row<'a> {
    label: String,
    class: Class,
    order: Option<f64>,
    /// The largest and the smallest step that reached the end, with their errors.
    ends: [(&'a Record, Option<f64>); 2],
    /// The smallest step that failed.
    unstable: Option<&'a Record>,
}

impl TimeStepFinding {
    /// The study with most orders; `None` where none refines its step.
    pub(super) fn new(results: &[StudyResults<'_>]) -> Option<Self> {
        let (one, (rows, time_factor)) = study_with_most(results, |one| {
            let paths = one.refined(Axis::TimeStep);
            let time = shown_time(&paths)?;
            let reference = one.study.references.first()?.name();
            let labels = path_labels(&paths).each;
            let rows = paths.iter().zip(labels);
            let rows: Vec<_> =
                rows.filter_map(|(path, label)| Row::new(path, label, reference, time)).collect();
            let with_order = rows.iter().filter(|row| row.class != Class::NotEvaluable).count();
            (!rows.is_empty()).then_some(((with_order, rows.len()), (rows, time)))
        })?;
        let mut finding = Self::from_rows(&one.study.name, time_factor, &rows);
        finding.unstable.extend(failed_alone(one));
        Some(finding)
    }

    fn from_rows(study: &str, time_factor: f64, rows: &[Row<'_>]) -> Self {
        let rounded = |row: &Row<'_>| row.order.map(|order| (100.0 * order).round().to_bits());
        let orders = grouped(rows, |row| (row.class.name(), rounded(row)));
        let orders = orders.into_iter().map(|((_, rounded), rows)| StepOrder {
            class: rows[0].class,
            order: rounded.map(|hundredths| f64::from_bits(hundredths) / 100.0),
            is_settled: rows[0].class.is_settled(),
            runs: rows.iter().map(|row| row.label.clone()).collect(),
        });
        let unstable = rows.iter().filter_map(|row| {
            let record = row.unstable?;
            Some(UnstableStep {
                run: row.label.clone(),
                step: record.case.time_step.to_string(),
                ending: record.status.name().clone(),
            })
        });
        let changes = rows.iter().filter_map(Row::change);
        Self {
            study: study.to_owned(),
            time_factor,
            orders: orders.collect(),
            unstable: unstable.collect(),
            most: changes.max_by(|a, b| a.ratio().total_cmp(&b.ratio())),
        }
    }
}

/// The smallest step at which runs failed that have too few steps for an order, for each method and integrator.
fn failed_alone(one: &StudyResults<'_>) -> Vec<UnstableStep> {
    let refined = one.refined(Axis::TimeStep);
    let is_refined = |record: &Record| {
        refined.iter().flat_map(|path| &path.records).any(|other| other.hash == record.hash)
    };
    let failed = one.records.iter().filter(|record| record.status != Status::Ok && !is_refined(record));
    let runs = grouped(failed, |record| format!("{}, {}", record.case.method, record.case.integrator.name()));
    let smallest = |(run, records): (String, Vec<&Record>)| {
        let least = records.into_iter().min_by(|a, b| a.step_sizes.target.total_cmp(&b.step_sizes.target))?;
        let (step, ending) = (least.case.time_step.to_string(), least.status.name().clone());
        Some(UnstableStep { run, step, ending })
    };
    runs.into_iter().filter_map(smallest).collect()
}

impl<'a> Row<'a> {
    fn new(path: &Path<'a>, label: String, reference: &str, time: f64) -> Option<Self> {
        let measure =
            |against| path.own_measure(&first_measure(Quantity::Pressure, Sample::Points, against, time));
        let is_ok = |record: &&Record| record.status == Status::Ok;
        let records = path.records.iter().copied().filter(is_ok).collect();
        let stable = Path { records, ..path.clone() };
        let end = |record: &'a Record| (record, measure(reference).error(record).map(|row| row.value.abs()));
        let classification =
            stable.records.last().map(|_| stable.summary(&measure(NEXT_FINER)).classification)?;
        Some(Self {
            label,
            class: classification.class,
            order: classification.order,
            ends: [end(stable.records[0]), end(stable.records[stable.records.len() - 1])],
            unstable: path.records.iter().copied().rfind(|record| !is_ok(record)),
        })
    }

    fn change(&self) -> Option<StepChange> {
        let [(largest, coarse), (smallest, fine)] = self.ends;
        let (coarse, fine) = (coarse?, fine?);
        Some(StepChange {
            run: self.label.clone(),
            steps: [largest, smallest].map(|record| record.case.time_step.to_string()),
            errors: [coarse, fine],
            is_of_step: coarse / fine > STEP_COUNTS,
        })
    }
}

impl StepChange {
    fn ratio(&self) -> f64 {
        self.errors[0] / self.errors[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, solved};
    use crate::case::planned::Tier;

    #[test]
    fn the_smallest_step_that_fails_is_the_one_named() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP-SRI']\n\
                    integrator = ['implicit']\ncells = [5]\n\
                    time_step = [{ seconds = 0.04 }, { seconds = 0.02 }, { seconds = 0.01 }, { seconds = 0.005 }]\n";
        let (study, mut records) = solved("s", text);
        for record in &mut records[..2] {
            record.status = failed_at(1);
        }
        let found = TimeStepFinding::new(&[StudyResults::new(&study, &records, Tier::Full)]).expect("steps");
        let step = |place: usize| records[place].case.time_step.to_string();
        assert_eq!(found.unstable.len(), 1);
        assert_eq!((&found.unstable[0].step, found.unstable[0].ending.as_str()), (&step(1), "unstable"));
        assert_eq!(found.most.expect("two are left").steps, [2, 3].map(step));
        assert_eq!(TimeStepFinding::new(&[]), None);
        // A run that failed at its only step is no less unstable.
        let mut alone = records[0].clone();
        alone.hash = "another".to_owned();
        alone.case.cells = 7;
        records.push(alone);
        let found = TimeStepFinding::new(&[StudyResults::new(&study, &records, Tier::Full)]).expect("steps");
        let unstable: Vec<&str> = found.unstable.iter().map(|one| one.run.as_str()).collect();
        assert_eq!((found.unstable.len(), unstable[1]), (2, "GIMP-SRI, implicit"));
    }

    #[test]
    fn runs_of_one_order_stand_together_and_the_one_that_the_step_changes_most_is_told() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4]\ntime_step = [{ seconds = 0.04 }, { seconds = 0.02 }]\n";
        let steps = records_of(text);
        let row = |label: &str, order: Option<f64>, errors: [Option<f64>; 2]| Row {
            label: label.to_owned(),
            class: if order.is_some() { Class::Asymptotic } else { Class::NotEvaluable },
            order,
            ends: [(&steps[0], errors[0]), (&steps[1], errors[1])],
            unstable: None,
        };
        for (errors, most, is_of_step) in [
            ([Some(0.3), Some(0.1)], "b", true),
            ([Some(0.3), Some(0.2728)], "b", false),
            // Of equals the last.
            ([Some(0.3), None], "c", false),
        ] {
            let same = [Some(0.12), Some(0.1095)];
            let rows = [row("a", Some(1.999), same), row("b", None, errors), row("c", Some(2.004), same)];
            let found = TimeStepFinding::from_rows("s", 0.1, &rows);
            let orders: Vec<_> = found.orders.iter().map(|one| (one.order, one.runs.join(" "))).collect();
            assert_eq!(orders, [(Some(2.0), "a c".to_owned()), (None, "b".to_owned())]);
            let change = found.most.expect("two errors");
            assert_eq!((change.run.as_str(), change.is_of_step), (most, is_of_step), "{errors:?}");
        }
    }
}
