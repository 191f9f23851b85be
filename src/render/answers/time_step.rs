//! What does the time step change? The order in the step, what it leaves of the error, and from where on it is unstable.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::Path;
use crate::judge::study_results::StudyResults;
use crate::record::{Record, Status};
use crate::render::answers::{Answer, Question, study_with_most};
use crate::render::number;
use crate::render::report::labels::{self, first_measure, grouped, order_or_class, path_labels};
use crate::render::report::refinement::{longest_paths, shown_time};
use crate::study::expectation::{Axis, NEXT_FINER};
use oedometer_convergence::Class;

const QUESTION: Question = Question { heading: "What does the time step change?", id: "time-step" };

/// What is said of one path along the step.
struct Row<'a> {
    label: String,
    /// The order of the differences between neighbouring steps, or their class; `None` for too few steps.
    order: Option<String>,
    /// The largest and the smallest step that reached the end.
    largest: &'a Record,
    smallest: &'a Record,
    /// Errors of the pressure with these two, against the scene's own solution.
    errors: [Option<f64>; 2],
    /// The smallest step that was unstable, and its end by name.
    unstable: Option<&'a Record>,
}

/// A study along the step.
struct Steps<'a> {
    time: f64,
    rows: Vec<Row<'a>>,
}

impl<'a> Steps<'a> {
    /// `None` for a study that refines no step.
    fn of(one: &'a StudyResults<'a>) -> Option<Self> {
        let paths = longest_paths(one, Axis::TimeStep);
        let time = shown_time(&paths)?;
        let reference = one.study.references.first()?.name();
        let labels = path_labels(&paths);
        let rows = paths.iter().zip(&labels.each);
        let rows: Vec<_> = rows.filter_map(|(path, label)| row(path, label, reference, time)).collect();
        (!rows.is_empty()).then_some(Self { time, rows })
    }
}

/// The study that says the order in the step of most methods.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let (one, steps) = study_with_most(results, |one| {
        let steps = Steps::of(one)?;
        let with_order = steps.rows.iter().filter(|row| row.order.is_some()).count();
        Some(((with_order, steps.rows.len()), steps))
    })?;
    Some(QUESTION.told(&sentence(&steps.rows, steps.time), [one.study.name.as_str()], Vec::new()))
}

fn row<'a>(path: &Path<'a>, label: &str, own: &str, time: f64) -> Option<Row<'a>> {
    let measure =
        |reference| path.own_measure(&first_measure(Quantity::Pressure, Sample::Points, reference, time));
    let is_ok = |record: &&Record| record.status == Status::Ok;
    let records = path.records.iter().copied().filter(is_ok).collect();
    let stable = Path { records, ..path.clone() };
    let (largest, smallest) = (*stable.records.first()?, *stable.records.last()?);
    let error = |record| measure(own).error(record).map(|row| row.value.abs());
    Some(Row {
        label: label.to_owned(),
        order: match stable.summary(&measure(NEXT_FINER)).classification {
            found if found.class == Class::NotEvaluable => None,
            found => Some(order_or_class(&found)),
        },
        largest,
        smallest,
        errors: [error(largest), error(smallest)],
        unstable: path.records.iter().copied().rfind(|record| !is_ok(record)),
    })
}

/// Names in a sentence before the rest is only counted.
const MOST_NAMES: usize = 4;

fn names(rows: &[&Row<'_>]) -> String {
    let mut names: Vec<String> = rows.iter().take(MOST_NAMES).map(|row| format!("`{}`", row.label)).collect();
    names.extend((rows.len() > MOST_NAMES).then(|| format!("{} more", rows.len() - MOST_NAMES)));
    names.join(", ")
}

/// What is said where the steps are too few for an order.
const NO_ORDER: &str = "too few steps for an order";

/// The orders, the paths with the same one together; then where steps are unstable; then what the step leaves of the error.
fn sentence(rows: &[Row<'_>], time: f64) -> String {
    let orders = grouped(rows.iter().map(|row| (row.order.as_deref().unwrap_or(NO_ORDER), row)));
    let orders = orders.into_iter().map(|(order, rows)| format!("{order} for {}", names(&rows)));
    let orders = orders.collect::<Vec<_>>().join("; ");
    let unstable = rows.iter().filter_map(|row| {
        let step = labels::step(row.unstable?);
        Some(format!("`{}` ends {} from {step} on", row.label, row.unstable?.status.name()))
    });
    let unstable = unstable.collect::<Vec<_>>().join(", ");
    let ends = if unstable.is_empty() { "All steps tried are stable".to_owned() } else { unstable };
    format!(
        "Order of the pressure in the step, from the differences between neighbouring steps at T_v = {time}: {orders}. {ends}.{}",
        left(rows).unwrap_or_default()
    )
}

/// What the error against the exact solution comes to when the step gets smaller, of the path where it changes most.
fn left(rows: &[Row<'_>]) -> Option<String> {
    let change = |row: &Row<'_>| Some(row.errors[0]? / row.errors[1]?);
    let most = rows.iter().max_by(|a, b| change(a).unwrap_or(0.0).total_cmp(&change(b).unwrap_or(0.0)))?;
    let [coarse, fine] = most.errors;
    Some(format!(
        " Against the exact solution `{}` is off by {} with {} and by {} with {}: {}.",
        most.label,
        number::percent(coarse?),
        labels::step(most.largest),
        number::percent(fine?),
        labels::step(most.smallest),
        if change(most)? > STEP_COUNTS {
            "the step is too large for the mesh"
        } else {
            "the mesh, not the step, makes the error"
        }
    ))
}

/// An error that a smaller step reduces by less than this factor is not the step's.
const STEP_COUNTS: f64 = 1.1;

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
        let results = [StudyResults::new(&study, &records, Tier::Full)];
        let steps = Steps::of(&results[0]).expect("a study of the step");
        let [row] = &steps.rows[..] else { panic!("one method") };
        let step = |record: &Record| labels::step(record);
        assert_eq!(row.unstable.map(step), Some(step(&records[1])));
        assert_eq!([row.largest, row.smallest].map(step), [2, 3].map(|place| step(&records[place])));
        assert!(sentence(&steps.rows, 0.1).contains(&format!("unstable from {} on", step(&records[1]))));
    }

    #[test]
    fn paths_of_one_order_stand_together_and_the_one_that_the_step_changes_most_is_told() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4]\ntime_step = [{ seconds = 0.04 }, { seconds = 0.02 }]\n";
        let steps = records_of(text);
        let mut fallen = steps[0].clone();
        fallen.status = failed_at(1);
        let row = |label: &str, order: Option<&str>, errors: [Option<f64>; 2]| Row {
            label: label.to_owned(),
            order: order.map(str::to_owned),
            largest: &steps[0],
            smallest: &steps[1],
            errors,
            unstable: (label == "b").then_some(&fallen),
        };
        let of = |b: [Option<f64>; 2]| {
            let same = [Some(0.12), Some(0.11)];
            let mut rows = vec![row("a", Some("2.00"), same), row("b", None, b)];
            rows.extend(["c", "d", "e", "f"].map(|label| row(label, Some("2.00"), same)));
            rows
        };
        let start = "Order of the pressure in the step, from the differences between neighbouring steps at T_v = 0.1: 2.00 for \
                     `a`, `c`, `d`, `e`, 1 more; too few steps for an order for `b`. `b` ends unstable from Δt = 0.04 s on.";
        for (b, left) in [
            (
                [Some(0.3), Some(0.1)],
                " `b` is off by 30.0 % with Δt = 0.04 s and by 10.0 % with Δt = 0.02 s: the step is too large for the mesh.",
            ),
            (
                [Some(0.3), Some(0.274)],
                " `b` is off by 30.0 % with Δt = 0.04 s and by 27.4 % with Δt = 0.02 s: the mesh, not the step, makes the error.",
            ),
            (
                [Some(0.3), None],
                " `f` is off by 12.0 % with Δt = 0.04 s and by 11.0 % with Δt = 0.02 s: the mesh, not the step, makes the error.",
            ),
        ] {
            assert_eq!(sentence(&of(b), 0.1), format!("{start} Against the exact solution{left}"));
        }
        let unknown = [row("a", Some("1.00"), [None; 2]), row("c", Some("2.00"), [None; 2])];
        let told = sentence(&unknown, 0.1);
        assert!(told.ends_with(": 1.00 for `a`; 2.00 for `c`. All steps tried are stable."), "{told}");
    }
}
