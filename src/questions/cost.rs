//! What does accuracy cost? Runs by error and counted work, and the cheapest within each tolerance.

use crate::case::IntegratorKind;
use crate::case::grouping::{distinct, grouped};
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question, best};
use crate::questions::words::COUNTED_WORK;
use crate::questions::work_precision::WorkPrecision;
use crate::render::chart::{Chart, ChartAxis, Series, Size};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::palette::slots;
use crate::render::table::{Cell, Table, columns};
use oedometer_exact::ExactError;

/// What does accuracy cost?
pub static COST: Question = Question {
    id: "cost",
    heading: "What does accuracy cost?",
    template: include_str!("cost.md"),
    places: &[Place::Study, Place::Report],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// The widest tolerance of the pressure at the points, relative L2, at every output.
    tolerance: f64,
    /// Label of the cheapest run within it.
    run: Option<String>,
    /// Its counted work, s.
    seconds: Option<f64>,
    /// Whether a finer mesh stays within it too.
    is_confirmed: bool,
    /// The other methods within it with their least work, the cheapest first.
    others: Vec<MethodWork>,
}

/// The least work of a method.
#[derive(serde::Serialize)]
struct MethodWork {
    method: String,
    /// Counted work, s.
    seconds: f64,
}

/// The study with most runs of those that ask for their times, and these.
///
/// # Errors
/// None of its own.
pub fn timed_study<'b, 'a>(
    studies: &'b [StudyResults<'a>],
) -> Result<Option<(&'b StudyResults<'a>, WorkPrecision<'a>)>, ExactError> {
    best(studies, |one| {
        let Some(reference) = one.study.references.first().filter(|_| one.study.timing_repeats > 1) else {
            return Ok(None);
        };
        let precision = WorkPrecision::of(one.records, reference.name(), &one.study.case_expectations);
        Ok(precision.map(|precision| (precision.runs.len(), precision)))
    })
}

fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    Ok(timed_study(studies)?.and_then(|(one, precision)| answer(&one.study.name, &precision)))
}

fn answer(study: &str, precision: &WorkPrecision<'_>) -> Option<Finding> {
    let widest = precision.cheapest.first()?;
    let others = widest.methods.iter().skip(1);
    let facts = Facts {
        tolerance: widest.tolerance,
        run: widest.run.as_ref().map(|run| run.record.case.label()),
        seconds: widest.run.as_ref().map(|run| run.work),
        is_confirmed: widest.is_confirmed,
        others: others
            .map(|(method, seconds)| MethodWork { method: method.to_string(), seconds: *seconds })
            .collect(),
    };
    let caption = "Colour: method; marker: integrator. Each line joins the runs that no other run of the same two beats in both \
                   work and error.";
    let figure = Figure::new("cost", chart(precision), caption);
    let parts = COST.answer([study], &facts).with(Block::Figures(vec![figure]));
    Some(parts.with(Block::Table(table(precision))))
}

/// What the figure shows: who needs the least work for each tolerance.
fn title_of(precision: &WorkPrecision<'_>) -> String {
    let runs = precision.cheapest.iter().filter_map(|one| Some((one.tolerance, one.run.as_ref()?)));
    let least = runs.map(|(tolerance, run)| (run.record.case.method.to_string(), number::bound(tolerance)));
    let groups = grouped(least, |(method, _)| method.clone()).into_iter();
    let parts = groups.map(|(method, within)| {
        let within: Vec<String> = within.into_iter().map(|(_, tolerance)| tolerance).collect();
        format!("{method} to {}", within.join(", "))
    });
    let parts: Vec<String> = parts.collect();
    if parts.is_empty() {
        "No run is within 1 %".to_owned()
    } else {
        format!("Least work: {}", parts.join("; "))
    }
}

/// A line per method and integrator over its best runs.
fn chart(precision: &WorkPrecision<'_>) -> Chart {
    let mut chart = Chart::new(
        title_of(precision),
        ChartAxis::log10("counted work (ms)"),
        ChartAxis::log10("error of the pore pressure, worst of the outputs (–)"),
    );
    chart.size = Size { width: 1000.0, plot_height: 460.0 };
    let fronts = precision.fronts();
    let methods = distinct(fronts.iter().map(|runs| runs[0].record.case.method.to_string()));
    let names: Vec<&str> = methods.iter().map(String::as_str).collect();
    let slots = slots(&names);
    for runs in &fronts {
        let case = &runs[0].record.case;
        let method = case.method.to_string();
        let place = methods.iter().position(|other| *other == method).unwrap_or_default();
        let marker = IntegratorKind::ALL.iter().position(|kind| *kind == case.integrator);
        let name = format!("{method}, {}", case.integrator.name());
        let points = runs.iter().map(|run| (1e3 * run.work, run.error)).collect();
        let series = Series::new(name, points);
        chart.series.push(series.slot(slots[place]).marker(marker.unwrap_or_default()));
    }
    chart
}

fn table(precision: &WorkPrecision<'_>) -> Table {
    let rows = precision.cheapest.iter().map(|cheapest| {
        let mut row = vec![Cell::Bound(cheapest.tolerance)];
        row.extend(cheapest.run.iter().flat_map(|run| {
            let (case, counters) = (&run.record.case, &run.record.counters);
            [
                Cell::Code(case.label()),
                Cell::Error(run.error),
                Cell::Measured(1e3 * run.work),
                Cell::Count(counters.steps),
                Cell::Count(counters.point_updates),
                if cheapest.is_confirmed { "yes" } else { "no" }.into(),
            ]
        }));
        row.resize(7, Cell::missing("no run reaches the tolerance"));
        row
    });
    let header =
        "> tolerance | run | > error | > work [ms] | > steps | > point updates | finer mesh within it";
    Table::of("The cheapest run within a tolerance", columns(header), rows).file("cost").note(format!(
        "error of the pore pressure at the points, relative L_2, the worst of the outputs; work: {COUNTED_WORK}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::questions::work_precision::{Cheapest, CostedRun};

    #[test]
    fn every_number_of_the_work_stands_under_its_name() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = ['GIMP', 'MPM']\n\
             integrator = ['implicit']\ncells = [4]\n",
        );
        let run = |place: usize, work: f64, error: f64| CostedRun { record: &records[place], error, work };
        let (cheapest, other) = (run(0, 0.011, 0.0071), run(1, 0.023, 0.0092));
        let methods = [&cheapest, &other].map(|run| (run.record.case.method, run.work)).to_vec();
        let precision = WorkPrecision {
            cheapest: vec![
                Cheapest { tolerance: 1e-2, run: Some(cheapest.clone()), is_confirmed: true, methods },
                Cheapest { tolerance: 1e-3, run: None, is_confirmed: false, methods: Vec::new() },
            ],
            runs: vec![cheapest, other],
        };
        let (label, counters) = (records[0].case.label(), &records[0].counters);
        let found = answer("s", &precision).expect("runs");
        assert_eq!(
            found.sentence().expect("a sentence"),
            format!(
                "A pressure within 1 % at every output takes 11 ms of counted work: `{label}`; `MPM` takes 23 ms."
            )
        );
        let table = found.tables()[0];
        let expected = [
            Cell::Bound(1e-2),
            Cell::Code(label),
            Cell::Error(0.0071),
            Cell::Measured(11.0),
            Cell::Count(counters.steps),
            Cell::Count(counters.point_updates),
            "yes".into(),
        ];
        assert_eq!(table.rows[0], expected);
        assert!(matches!(table.rows[1][1..], [Cell::Missing(_), ..]), "{:?}", table.rows[1]);
        let chart = chart(&precision);
        assert_eq!(chart.title, "Least work: GIMP to 1 %");
        let series =
            |place: usize| (chart.series[place].name.as_str(), chart.series[place].points.as_slice());
        assert_eq!(series(0), ("GIMP, implicit", &[(11.0, 0.0071)][..]));
        assert_eq!(series(1), ("MPM, implicit", &[(23.0, 0.0092)][..]));
        assert_ne!(chart.series[0].slot, chart.series[1].slot, "a colour per method");
        assert_eq!(chart.series[0].marker, chart.series[1].marker, "a marker per integrator");
    }
}
