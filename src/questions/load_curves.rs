//! What does a footing carry? Load over the settlement of the plate, on the finest of the meshes that most methods have run.

use crate::case::Quantity;
use crate::case::grouping::grouped;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use oedometer_exact::footing::LOAD_FACTOR;

/// What does a footing carry?
pub static LOAD_CURVES: Question = Question {
    id: "load-curves",
    heading: "What does the footing carry?",
    template: include_str!("load_curves.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Methods with a run on the mesh.
    methods: usize,
    /// Cells under the plate.
    cells: usize,
    /// What keeps the soil undrained.
    undrained: String,
    /// The exact collapse load over width and strength, `2 + π`.
    exact: f64,
    /// Methods whose last load is off by no more than so much of it.
    kept_methods: Vec<String>,
    /// How much.
    kept_within: f64,
}

/// A method keeps the collapse load where its last load is off by no more than this; the figure shows as much on both sides.
const KEPT_WITHIN: f64 = 0.05;

/// All runs kept undrained as in the study's first case.
fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let undrained = one.records.first()?.case.column.footing.undrained;
    let is_drawn = |record: &&Record| {
        one.study.scene.measures(Quantity::LoadFactor)
            && !one.study.is_race
            && record.status == Status::Ok
            && record.case.column.footing.undrained == undrained
    };
    let of_methods = grouped(one.records.iter().filter(is_drawn), |record| record.case.method.to_string());
    let has = |own: &[&Record], cells: usize| own.iter().any(|record| record.case.cells == cells);
    let methods_on = |cells: usize| of_methods.iter().filter(|(_, own)| has(own, cells)).count();
    let meshes = of_methods.iter().flat_map(|(_, own)| own.iter().map(|record| record.case.cells));
    let cells = meshes.max_by_key(|cells| (methods_on(*cells), *cells))?;
    let [low, high] = [1.0 - KEPT_WITHIN, 1.0 + KEPT_WITHIN].map(|share| share * LOAD_FACTOR);
    let mut chart = Chart::new(
        "",
        ChartAxis::linear("settlement over the width u/B (–)"),
        ChartAxis::linear("bearing-capacity factor F/(B c_u) (–)").between(low, high),
    );
    chart.size = Size::PANEL;
    for (method, own) in &of_methods {
        if let Some(record) = own.iter().find(|record| record.case.cells == cells) {
            let points = record.history.iter().filter_map(|row| Some((row.time_factor, row.load_factor?)));
            let series = Series::new(method.as_str(), points.collect());
            chart.series.push(series.style(Style::Line));
        }
    }
    let ends_at =
        |series: &Series| series.points.last().map_or(f64::NAN, |(_, load)| load / LOAD_FACTOR - 1.0);
    let ends: Vec<(String, f64)> = chart.series.iter().map(|one| (one.name.clone(), ends_at(one))).collect();
    let (kept, off): (Vec<_>, Vec<_>) = ends.into_iter().partition(|(_, end)| end.abs() <= KEPT_WITHIN);
    chart.title = title_of(&kept, chart.series.len());
    let facts = Facts {
        methods: chart.series.len(),
        cells,
        undrained: undrained.name().to_owned(),
        exact: LOAD_FACTOR,
        kept_methods: kept.into_iter().map(|(method, _)| method).collect(),
        kept_within: KEPT_WITHIN,
    };
    let ends = chart.series.iter().flat_map(|series| &series.points).map(|(settlement, _)| *settlement);
    let end = ends.fold(0.0, f64::max);
    chart.series.push(Series::theory("2 + π", vec![(0.0, LOAD_FACTOR), (end, LOAD_FACTOR)]));
    let figure = Figure::new("load-settlement", chart, caption_of(&off));
    Some(LOAD_CURVES.answer([one.study.name.as_str()], &facts).with(Block::Figures(vec![figure])))
}

/// How many methods end near the exact load, and which ends nearest.
fn title_of(kept: &[(String, f64)], methods: usize) -> String {
    let within = number::rounded_percent(KEPT_WITHIN);
    let nearest = kept.iter().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let nearest = nearest.map_or(String::new(), |(method, end)| {
        format!("; {method} is nearest, {} off", number::percent(end.abs()))
    });
    format!("{} of {methods} methods end within {within} of the collapse load{nearest}", kept.len())
}

/// Which lines end outside of the figure, and where.
fn caption_of(off: &[(String, f64)]) -> String {
    let ends = off
        .iter()
        .map(|(method, end)| format!("{method} at {} times the exact load", number::two_digits(1.0 + end)));
    let ends = ends.collect::<Vec<_>>().join(", ");
    if off.is_empty() {
        "All lines end within the figure.".to_owned()
    } else {
        format!("Off the scale at the end: {ends}.")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, study_of};
    use crate::case::planned::Tier;
    use crate::record::HistoryRow;
    use crate::study::check::Study;
    use oedometer_problem::method::Method;
    use oedometer_scenes::column::Undrained;

    #[test]
    fn load_and_settlement_are_drawn_on_the_finest_mesh_of_most_methods() {
        let text = |scene: &str| {
            format!(
                "title = 't'\nscene = '{scene}'\n[[sweep]]\nmethod = ['GIMP']\nintegrator = ['implicit']\ncells = [2]\n"
            )
        };
        let [study, column] = ["footing", "terzaghi"].map(|scene| study_of("s", &text(scene)));
        let one = records_of(&(text("terzaghi").replace("[[", "output.time_factors = [0.1]\n[["))).remove(0);
        // Each curve ends at the settlement of its number of cells.
        let run = |(name, cells): &(&str, usize)| {
            let mut record = one.clone();
            (record.case.method, record.case.cells) = (Method::named(name).expect("a method").into(), *cells);
            let row = |time_factor: f64, load_factor: Option<f64>| HistoryRow {
                time_factor,
                degree_of_consolidation: 0.0,
                load_factor,
                energy: None,
            };
            record.history = vec![row(0.5, Some(3.0)), row(9.0, None), row(*cells as f64, Some(5.0))];
            record
        };
        let found = |study: &Study, records: &[Record]| ask(&[StudyResults::new(study, records, Tier::Full)]);
        let drawn = |study: &Study, records: &[Record]| {
            let answer = found(study, records).expect("curves");
            let [Block::Figures(figures)] = &answer.parts[..] else { panic!("{answer:?}") };
            let curve = |one: &Series| (one.name.clone(), one.points.last().map_or(0.0, |last| last.0));
            let curves: Vec<_> = figures[0].chart.series.iter().map(curve).collect();
            (answer.sentence().expect("a sentence"), curves)
        };
        let told = |runs: &[(&str, usize)]| drawn(&study, &runs.iter().map(run).collect::<Vec<_>>());
        let (a, b, c) = ("GIMP", "MPM", "VP");
        for (runs, cells, methods) in [
            (&[(a, 4), (a, 8), (b, 8), (b, 16), (c, 8)][..], 8, &[a, b, c][..]),
            (&[(b, 16), (b, 8), (a, 8), (a, 4), (c, 4), (c, 8)], 8, &[b, a, c]),
            (&[(a, 4), (b, 4), (b, 16), (c, 4), (c, 8)], 4, &[a, b, c]),
            (&[(a, 4), (a, 16), (b, 4), (b, 8)], 4, &[a, b]),
            (&[(a, 4), (b, 8), (c, 8)], 8, &[b, c]),
            (&[(a, 4), (b, 8)], 8, &[b]),
            (&[(a, 4)], 4, &[a]),
        ] {
            let (caption, curves) = told(runs);
            assert!(
                caption.contains(&format!(
                    "on {cells} cells under the plate, with the undrained model `total-stress`"
                )),
                "{caption}"
            );
            let wanted = methods.iter().chain([&"2 + π"]).map(|name| ((*name).to_owned(), f64::from(cells)));
            assert_eq!(curves, wanted.collect::<Vec<_>>(), "{runs:?}");
        }
        // Neither what failed nor what is undrained otherwise counts; of several runs the first is drawn.
        let mut records = [(a, 4), (a, 8), (b, 4), (b, 8), (b, 4)].map(|one| run(&one)).to_vec();
        records[1].status = failed_at(1);
        records[3].case.column.footing.undrained = Undrained::TwoPhase;
        records[4].history.clear();
        let (caption, curves) = drawn(&study, &records);
        assert!(caption.contains("on 4 cells") && curves.len() == 3, "{caption} {curves:?}");
        assert!(curves.iter().all(|(_, end)| *end == 4.0), "{curves:?}");
        // Half of the exact load and four times of it are named, as the figure does not show them.
        let off = [("A", -0.5), ("B", 3.0)].map(|(name, end)| (name.to_owned(), end));
        assert_eq!(
            caption_of(&off),
            "Off the scale at the end: A at 0.50 times the exact load, B at 4.0 times the exact load."
        );
        let kept = [("A", 0.04), ("B", -0.011)].map(|(name, end)| (name.to_owned(), end));
        assert_eq!(
            title_of(&kept, 3),
            "2 of 3 methods end within 5 % of the collapse load; B is nearest, 1.10 % off"
        );
        assert_eq!(title_of(&[], 1), "0 of 1 methods end within 5 % of the collapse load");
        for (study, records) in [(&study, &[][..]), (&study, &records[1..2]), (&column, &records)] {
            assert_eq!(found(study, records), None);
        }
    }
}
