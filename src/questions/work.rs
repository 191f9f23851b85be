//! What does accuracy cost in counted work? The error of the pressure over points times steps.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::first_measure;
use crate::questions::blocks::drawn::drawn;
use crate::questions::finding::{Finding, Part, Place, Question};
use crate::questions::study_results::StudyResults;
use crate::questions::words;
use crate::record::Record;
use crate::render::chart::{Chart, ChartAxis, Series};
use crate::render::number;
use crate::render::page::Figure;
use crate::study::expectation::{Axis, Measure};

/// What does accuracy cost in counted work?
pub static WORK: Question = Question {
    id: "work",
    heading: "Error against work",
    template: include_str!("work.md"),
    places: &[Place::Study],
    facts: |schemas| schemas.subschema_for::<Facts>(),
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence.
#[derive(serde::Serialize, schemars::JsonSchema)]
struct Facts {
    /// Series over the mesh whose work is counted.
    series: usize,
    /// Those that are drawn.
    shown: usize,
}

const CAPTION: &str = "Every step visits every point once, or does the same by one banded map of the grid. Order p in h gives e ~ \
                       W^(−p/m) where W ~ h^(−m): m counts the dimensions of the mesh, and one more where steps shrink with \
                       the cells.";

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let mut along_mesh = one.paths.along(Axis::Cells).to_vec();
    along_mesh.retain(|path| path.records.iter().all(|record| record.case.counts_work()));
    if along_mesh.len() < 2
        || one.study.is_race
        || one.records.iter().all(|record| record.stability.is_some())
    {
        return None;
    }
    // Pressure at the points against the scene's own reference at the last output.
    let reference = one.study.references.first()?.name();
    let last = *one.records.first()?.case.time_factors.last()?;
    let measure = first_measure(Quantity::Pressure, Sample::Points, reference, last);
    let (paths, _) = drawn(&along_mesh);
    let labels = path_labels(&paths);
    let x = ChartAxis::log10("point updates (points × steps)");
    let error = ChartAxis::log10(words::error_axis(measure.quantity));
    let mut chart = Chart::new("Error against work", x, error);
    let measured = words::measured(measure.quantity, measure.sample);
    let end = words::subtitle_end(&labels.shared);
    chart.subtitle = Some(format!("{measured}, T_v = {}{end}", number::time_factor(last)));
    for (path, name) in paths.iter().zip(labels.each) {
        let point =
            |record: &&Record| Some((record.counters.point_updates as f64, error_of(record, &measure)?));
        let points = path.records.iter().filter_map(point).filter(|(_, error)| error.is_finite());
        chart.series.push(Series::new(name, points.collect()));
    }
    let facts = Facts { series: along_mesh.len(), shown: paths.len() };
    let figure = Figure::new("work", chart, CAPTION);
    Some(WORK.answer([one.study.name.as_str()], &facts).with(Part::Figures(vec![figure])))
}

/// The size of an error of a record, where its program measures it.
fn error_of(record: &Record, measure: &Measure) -> Option<f64> {
    let own = Measure { sample: record.main_sample(), ..measure.clone() };
    Some(own.error(record)?.value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    #[test]
    fn every_case_has_its_point_with_its_work_and_error_and_one_series_is_no_figure() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.3]\n[[sweep]]\n\
                    method = ['MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [4, 8]\n";
        let (study, mut records) = solved("s", text);
        for (place, record) in records.iter_mut().enumerate() {
            record.counters.point_updates = 100 * (place as u64 + 1);
            for row in &mut record.errors {
                let is_meant = (row.quantity, row.sample) == (Quantity::Pressure, Sample::Points);
                let size = if is_meant && row.time_factor == 0.3 { 0.01 } else { 7.0 };
                row.value = -size * (place + 1) as f64;
            }
        }
        let found = |records: &[Record]| ask(&[StudyResults::new(&study, records, Tier::Full)]);
        let answer = found(&records).expect("two series");
        let told = "Counted and not timed, up to the last output: 2 of 2 series.";
        assert_eq!(answer.sentence().expect("a sentence"), told);
        let [Part::Figures(figures)] = &answer.parts[..] else { panic!("{answer:?}") };
        let mut points: Vec<(f64, f64)> =
            figures[0].chart.series.iter().flat_map(|series| series.points.iter().copied()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(points, [1.0, 2.0, 3.0, 4.0].map(|place| (100.0 * place, 0.01 * place)));
        records.retain(|record| record.case.method.to_string() == "MPM");
        assert_eq!(found(&records), None);
    }
}
