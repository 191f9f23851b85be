//! Who locks? The errors of every method over Poisson's ratio, where a study sweeps it in the plane.

use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question, best};
use crate::questions::stiffness_sweep::{KEPT, StiffnessSweep, SweepRow};
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Mood, Table, columns};
use oedometer_exact::ExactError;
use oedometer_wording::typed;
use std::cmp::Reverse;

/// Who locks?
pub static LOCKING: Question = Question {
    id: "locking",
    heading: "Which methods lock?",
    template: include_str!("locking.md"),
    places: &[Place::Terminal, Place::Study, Place::Report],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize, serde::Deserialize)]
struct Facts {
    /// Cells over the height.
    cells: usize,
    /// Time factor, the last of the outputs.
    time_factor: f64,
    /// A result is kept where displacement and pressure are off by less than this.
    kept_within: f64,
    /// Largest Poisson's ratio.
    largest_ratio: f64,
    /// Number of methods.
    methods: usize,
    /// Number of those that keep their result at every ratio.
    kept: usize,
    /// Their names.
    kept_methods: Vec<String>,
}

/// The study that sweeps Poisson's ratio with most methods, the first of equals, answers.
fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let most = best(studies, |one| {
        if !one.study.scene.locks {
            return Ok(None);
        }
        let sweep = StiffnessSweep::new(one.study, one.records);
        Ok(sweep.map(|sweep| (sweep.rows.len(), sweep)))
    })?;
    Ok(most.and_then(|(one, sweep)| answer(&one.study.name, &sweep)))
}

/// The answer of one sweep at its last output; methods that keep their result stand first.
fn answer(study: &str, sweep: &StiffnessSweep) -> Option<Finding> {
    let (time_factor, largest_ratio) = (sweep.time_factor, *sweep.values.last()?);
    let mut rows: Vec<&SweepRow> = sweep.rows.iter().collect();
    rows.sort_by_key(|row| Reverse(row.lost_from().unwrap_or(usize::MAX)));
    let kept = rows.iter().filter(|row| keeps(row));
    let kept_methods: Vec<String> = kept.map(|row| row.method.to_string()).collect();
    let (cells, methods, kept) = (sweep.cells, rows.len(), kept_methods.len());
    let facts = Facts { cells, time_factor, kept_within: KEPT, largest_ratio, methods, kept, kept_methods };
    let finding = LOCKING.answer([study], &facts).with(Block::Table(table(&rows, &sweep.values)));
    // Two ratios are no line.
    let figures = (sweep.values.len() > 2).then(|| Block::Figures(vec![figure(&rows, &sweep.values)]));
    Some(figures.into_iter().fold(finding, Finding::with))
}

/// Whether a method ran at the largest ratio and lost its result at none.
fn keeps(row: &SweepRow) -> bool {
    let ran = row.found.last().is_some_and(|errors| errors.iter().all(Option::is_some));
    ran && row.lost_from().is_none() && row.failed.is_none()
}

/// The errors of all methods at the smallest and the largest ratio.
fn table(rows: &[&SweepRow], ratios: &[f64]) -> Table {
    let last = ratios.len() - 1;
    let [least, most] = [0, last].map(|place| typed(ratios[place]));
    let limit = number::bound(KEPT);
    let header = format!(
        "method | above {limit} | > displacement, ν = {least} | > ν = {most} | > pressure, ν = {least} | > ν = {most}"
    );
    let cells = rows.iter().map(|row| {
        let ([u_least, p_least], [u_most, p_most]) = (row.found[0], row.found[last]);
        let errors = [u_least, u_most, p_least, p_most];
        let errors = errors.map(|error| Cell::of(error, Cell::Error, "no result"));
        [Cell::Code(row.method.to_string()), loss(row, ratios)].into_iter().chain(errors).collect()
    });
    Table::of("Errors over Poisson's ratio", columns(&header), cells).file("locking").note(format!(
        "relative L_2 errors of the nodal displacement and of the pressure at the points; above {limit}: \
         the first ratio at which either exceeds it"
    ))
}

/// What becomes of a result, in a few words.
fn loss(row: &SweepRow, ratios: &[f64]) -> Cell {
    let at = |place: usize| typed(ratios[place]);
    match (row.lost_from(), &row.failed) {
        (Some(place), _) => Cell::Verdict(Mood::Fail, format!("from ν = {}", at(place))),
        (None, Some((place, how))) => {
            Cell::Verdict(Mood::Fail, format!("failed at ν = {}: {how}", at(*place)))
        }
        (None, None) if keeps(row) => Cell::Verdict(Mood::Pass, "never".to_owned()),
        (None, None) => Cell::missing("not run at the largest ratio"),
    }
}

/// What the figure shows: how many methods keep the pressure at every ratio.
fn title_of(rows: &[&SweepRow]) -> String {
    let is_kept = |errors: &[Option<f64>; 2]| errors[1].is_some_and(|error| error < KEPT);
    let kept = rows.iter().filter(|row| row.found.iter().all(is_kept)).count();
    format!("{kept} of {} methods keep the pressure at the points within {}", rows.len(), number::bound(KEPT))
}

/// The error of the pressure of all methods over a ratio spaced as 1 − 2ν.
fn figure(rows: &[&SweepRow], ratios: &[f64]) -> Figure {
    let ticks = ratios.iter().map(|ratio| (1.0 - 2.0 * ratio, typed(*ratio)));
    let x = ChartAxis::log10("Poisson's ratio ν (–), spaced as 1 − 2ν").inverted().with_labelled_ticks(ticks);
    let mut chart = Chart::new(title_of(rows), x, ChartAxis::log10("relative L_2 error (–)"));
    chart.size = Size::PANEL;
    for row in rows {
        let point = |(ratio, errors): (&f64, &[Option<f64>; 2])| Some((1.0 - 2.0 * ratio, errors[1]?));
        let points = ratios.iter().zip(&row.found).filter_map(point).collect();
        chart.series.push(Series::new(row.method.to_string(), points));
    }
    chart.rules.push(Rule { at: KEPT, label: number::bound(KEPT) });
    Figure::new("locking-pressure", chart, "The line of a method that does not lock stays level.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;
    use crate::case::{Quantity, Sample, SolverName};
    use crate::judge::paths::first_error;
    use oedometer_problem::method::Method;

    fn row(name: &str, errors: [[Option<f64>; 2]; 3]) -> SweepRow {
        SweepRow {
            method: SolverName::Own(Method::named(name).expect("a method")),
            found: errors.to_vec(),
            failed: None,
        }
    }

    fn found(rows: Vec<SweepRow>) -> Finding {
        let sweep = StiffnessSweep { cells: 4, values: vec![0.2, 0.4, 0.49], time_factor: 0.1, rows };
        answer("s", &sweep).expect("methods")
    }

    #[test]
    fn a_result_is_lost_with_either_quantity_from_the_first_ratio_on() {
        let (kept, lost) = (Some(0.05), Some(0.2));
        let sound = [[kept; 2]; 3];
        assert_eq!(row("MPM", sound).lost_from(), None);
        assert_eq!(row("MPM", [[Some(0.099), Some(0.0)]; 3]).lost_from(), None);
        for bad in [
            [lost, kept],
            [kept, lost],
            [lost, lost],
            [None, kept],
            [kept, None],
            [Some(f64::NAN), kept],
            [kept, Some(f64::NAN)],
            [Some(KEPT), kept],
            [kept, Some(KEPT)],
        ] {
            for place in 0..3 {
                let mut errors = sound;
                errors[place] = bad;
                assert_eq!(row("MPM", errors).lost_from(), Some(place), "{errors:?}");
                errors[2] = [lost; 2];
                assert_eq!(row("MPM", errors).lost_from(), Some(place), "{errors:?}");
            }
        }
        let mut failed = row("B2", [[kept, kept], [kept, kept], [None, None]]);
        failed.failed = Some((2, "unstable at step 3".to_owned()));
        let found = found(vec![
            row("MPM", [[kept, kept], [kept, Some(0.25)], [Some(3.2), kept]]),
            row("GIMP", sound),
            row("GIMP-SRI", [[kept, kept], [kept, kept], [Some(4.6), Some(0.1)]]),
            row("VP", [[kept, kept], [Some(0.5), kept], [kept, kept]]),
            failed,
            row("GIMP-mean", [[kept, kept], [kept, kept], [None, None]]),
        ]);
        let shown: Vec<[String; 2]> =
            found.tables()[0].rows.iter().map(|row| [row[0].show(), row[1].show()]).collect();
        let wanted = [
            ["GIMP", "✓ never"],
            ["B2", "✗ failed at ν = 0.49: unstable at step 3"],
            ["GIMP-mean", "–"],
            ["GIMP-SRI", "✗ from ν = 0.49"],
            ["MPM", "✗ from ν = 0.4"],
            ["VP", "✗ from ν = 0.4"],
        ];
        assert_eq!(shown, wanted, "those that keep it first");
        assert_eq!(
            found.sentence().expect("a sentence"),
            "On 4 cells, 1 of 6 methods keeps displacement and pressure within 10 % up to ν = 0.49 at T_v = \
             0.1: `GIMP`."
        );
    }

    #[test]
    fn every_error_stands_under_its_quantity_and_ratio() {
        let errors = [[0.01, 0.02], [0.03, 0.04], [0.05, 0.06]].map(|both| both.map(Some));
        let found = found(vec![row("MPM", errors), row("GIMP", [[Some(0.01), None]; 3])]);
        let rows = &found.tables()[0].rows;
        assert_eq!(rows[0][2..], [0.01, 0.05, 0.02, 0.06].map(Cell::Error));
        assert_eq!(rows[1][4], Cell::missing("no result"));
        let Some(Block::Figures(figures)) = found.parts.last() else { panic!("{found:?}") };
        let series = &figures[0].chart.series;
        assert_eq!(series[0].points[2], (1.0 - 2.0 * 0.49, 0.06));
        assert_eq!(series[1].points.len(), 0, "nothing is drawn where nothing was found");
    }

    #[test]
    fn of_several_studies_the_one_with_most_methods_answers_and_at_its_last_time() {
        let study = |name: &str, methods: &str| {
            let text = format!(
                "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\nmethod = {methods}\n\
                 integrator = ['implicit']\ncells = [2]\npoissons_ratio = [0.25, 0.3, 0.4]\ntime_step = [{{ growth = 0.5 }}]\n"
            );
            solved(name, &text)
        };
        let all = [
            study("one", "['GIMP']"),
            study("two", "['GIMP', 'GIMP-SRI']"),
            study("as-many", "['MPM', 'GIMP']"),
        ];
        for places in [&[0, 1, 2][..], &[1, 0], &[1, 2, 0]] {
            let results: Vec<StudyResults<'_>> = places
                .iter()
                .map(|place| StudyResults::new(&all[*place].0, &all[*place].1, Tier::Full))
                .collect();
            let found = ask(&results).expect("sound cases").expect("who locks");
            let (study, records) = &all[1];
            let record =
                records.iter().find(|record| record.case.material.poissons_ratio == 0.25).expect("ν = 0.25");
            let method = Cell::Code(record.case.method.to_string());
            let row = found.tables()[0].rows.iter().find(|row| row[0] == method).expect("its row");
            let [displacement, pressure] =
                [(Quantity::Displacement, Sample::Nodes), (Quantity::Pressure, Sample::Points)].map(
                    |(quantity, sample)| {
                        let error = first_error(record, quantity, sample, study.references[0].name(), 0.2);
                        Cell::Error(error.expect("an error"))
                    },
                );
            assert_eq!((&row[2], &row[4]), (&displacement, &pressure));
            let facts: Facts = serde_json::from_value(found.facts).expect("facts");
            assert_eq!((found.studies, facts.methods, facts.cells), (vec!["two".to_owned()], 2, 2));
            assert_eq!(facts.time_factor, 0.2);
        }
        assert!(ask(&[]).expect("no case").is_none());
    }
}
