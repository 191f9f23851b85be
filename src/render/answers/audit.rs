//! Are the published equations right? Each pairing of stress–strain law and continuity against the wanted solution:
//! over time on one mesh, and over the mesh at one time, where right equations converge and wrong ones do not.

use crate::case::Case;
use crate::case::quantity::{Quantity, Sample};
use crate::record::{Record, Status};
use crate::render::answers::{Answer, Question};
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, SlopeTriangle};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::StudyResults;
use crate::render::report::labels::{self, first_measure, grouped};
use oedometer_exact::reference::ReferenceKind;

const QUESTION: Question = Question { heading: "Are the published equations right?", id: "audit" };

/// Largest error of the settlement on the finest mesh for the wanted equations.
const AGREES: f64 = 0.01;

/// Equations as the paper prints them: its Eq. 6 without the porosity gradient, and its Eqs 7 and 8 as rates.
const PRINTED: (&str, &str) = ("porosity-dependent", "constant-porosity-gradient");

const MAPPING_BACK: &str = "The paper's step 5, mapping velocities back, needs a boundary condition that the paper does not name: where \
    the skeleton sticks to a base and the water slides along it, a flux between the phases grows that no pressure drives. Here the \
    nodes of the base keep the velocity of the water themselves, and nothing grows (docs/theory.md, section 3).";

const SETTLEMENT: (Quantity, Sample) = (Quantity::Settlement, Sample::Surface);
const PRESSURE: (Quantity, Sample) = (Quantity::Pressure, Sample::Points);

/// One pairing of law and continuity by one method, from coarse to fine.
struct Pairing<'a> {
    law_and_continuity: (&'static str, &'static str),
    levels: Vec<&'a Record>,
}

impl Pairing<'_> {
    fn name(&self) -> String {
        let (law, continuity) = self.law_and_continuity;
        let mark = if self.is_printed() { " (as printed)" } else { "" };
        format!("{law}, {continuity}{mark}")
    }

    fn is_printed(&self) -> bool {
        self.law_and_continuity == PRINTED
    }

    fn on(&self, cells: usize) -> Option<&Record> {
        self.levels.iter().copied().find(|record| record.case.cells == cells)
    }
}

/// The error of a quantity at a time, with its sign if it has one.
fn error(record: &Record, (quantity, sample): (Quantity, Sample), time: f64) -> Option<f64> {
    Some(first_measure(quantity, sample, ReferenceKind::XieLeo.name(), time).error(record)?.value)
}

/// What all pairings share: their finest common mesh, its times, and the time of the figure over the mesh.
struct Common {
    cells: usize,
    times: Vec<f64>,
    middle: f64,
}

/// Settlement over time and pressure over the mesh, in a figure each, and which equations agree.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let audited = results.iter().filter_map(|one| {
        let pairings = pairings(one.records);
        let common = common_of(&pairings)?;
        Some((one, pairings, common))
    });
    // More pairings first, then more meshes and times.
    let worth = |pairings: &[Pairing<'_>], common: &Common| {
        let levels: usize = pairings.iter().map(|one| one.levels.len()).sum();
        (pairings.len().min(4), levels * common.times.len())
    };
    let best = audited.max_by_key(|(_, pairings, common)| worth(pairings, common));
    let (one, pairings, common) = best?;
    let figures = vec![over_time(&pairings, &common), over_mesh(&pairings, &common)];
    let blocks = vec![Block::Figures(figures), Block::Paragraph(MAPPING_BACK.to_owned())];
    Some(QUESTION.told(&sentence(&pairings, &common), [one.study.name.as_str()], blocks))
}

/// The pairings of the method that has most of them.
fn pairings(records: &[Record]) -> Vec<Pairing<'_>> {
    let is_audited = |record: &&Record| {
        record.status == Status::Ok
            && record.case.scene.is_large_strain()
            && record.references.iter().any(|used| used.name == ReferenceKind::XieLeo.name())
    };
    let audited = records.iter().filter(is_audited).map(|record| (what_is_shared(&record.case), record));
    let groups = grouped(audited).into_iter().map(|(_, group)| pairings_of(group));
    groups.max_by_key(Vec::len).unwrap_or_default()
}

/// The pairings of records that differ in mesh, law and continuity alone, each with the run of most outputs on every mesh.
fn pairings_of<'a>(group: Vec<&'a Record>) -> Vec<Pairing<'a>> {
    let key = |record: &Record| (record.case.material.law.name(), record.case.material.continuity.name());
    let pairing = |(law_and_continuity, records): (_, Vec<&'a Record>)| {
        let outputs = |record: &Record| record.case.time_factors.len();
        let on_each_mesh = grouped(records.into_iter().map(|record| (record.case.cells, record)));
        let most = |own: Vec<_>| own.into_iter().reduce(|a, b| if outputs(b) > outputs(a) { b } else { a });
        let mut levels: Vec<_> = on_each_mesh.into_iter().filter_map(|(_, own)| most(own)).collect();
        levels.sort_by_key(|record| record.case.cells);
        Pairing { law_and_continuity, levels }
    };
    grouped(group.into_iter().map(|record| (key(record), record))).into_iter().map(pairing).collect()
}

/// A number for all inputs but mesh, outputs, law and continuity.
fn what_is_shared(case: &Case) -> u64 {
    case.number_with(|case| {
        let seed = Case::seed(case.task, case.scene).material;
        case.cells = 0;
        case.time_factors.clear();
        case.material.law = seed.law;
        case.material.continuity = seed.continuity;
    })
}

/// What several pairings share; `None` for a single one.
fn common_of(pairings: &[Pairing<'_>]) -> Option<Common> {
    let first = pairings.first().filter(|_| pairings.len() > 1)?;
    let is_common = |record: &&&Record| pairings.iter().all(|one| one.on(record.case.cells).is_some());
    let finest = first.levels.iter().filter(is_common).max_by_key(|record| record.case.cells)?;
    let cells = finest.case.cells;
    let has_all = |time: &f64| {
        pairings
            .iter()
            .all(|one| one.on(cells).is_some_and(|record| error(record, SETTLEMENT, *time).is_some()))
    };
    let times: Vec<f64> = finest.case.time_factors.iter().copied().filter(has_all).collect();
    let middle = *times.get(times.len().saturating_sub(1) / 2)?;
    Some(Common { cells, times, middle })
}

/// The error of the settlement of a pairing at all common times.
fn settlement(one: &Pairing<'_>, common: &Common) -> Vec<(f64, f64)> {
    let Some(record) = one.on(common.cells) else { return Vec::new() };
    common.times.iter().filter_map(|time| Some((*time, error(record, SETTLEMENT, *time)?))).collect()
}

/// Which pairings are the wanted equations, and how far off the others are, the printed one first.
fn sentence(pairings: &[Pairing<'_>], common: &Common) -> String {
    let mut right = Vec::new();
    let mut wrong = Vec::new();
    for one in pairings {
        let errors = settlement(one, common).into_iter();
        let Some((time, error)) = errors.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { continue };
        let percent = number::percent(error.abs());
        if error.abs() < AGREES {
            right.push(format!("`{}` ({percent})", one.name()));
        } else {
            let sign = if error > 0.0 { "+" } else { "−" };
            let place = if one.is_printed() { 0 } else { wrong.len() };
            wrong.insert(place, format!("`{}` ({sign}{percent} at T_v = {time})", one.name()));
        }
    }
    let (cells, limit) = (common.cells, number::percent(AGREES));
    let agree = match right.as_slice() {
        [] => format!(
            "On {cells} cells no pairing of law and continuity gives Xie & Leo's settlement within {limit}"
        ),
        all => format!(
            "On {cells} cells these pairings of law and continuity give Xie & Leo's settlement at every time (largest \
             error): {}",
            all.join(", ")
        ),
    };
    match wrong.as_slice() {
        [] => format!("{agree}."),
        all => format!("{agree}. These are other theories (largest difference): {}.", all.join(", ")),
    }
}

fn over_time(pairings: &[Pairing<'_>], common: &Common) -> Figure {
    let mut chart = Chart::new(
        "Settlement against Xie & Leo, over time",
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("settlement over the exact one, minus one (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(subtitle(pairings, &format!("{} cells", common.cells)));
    chart.series.extend(pairings.iter().map(|one| Series::new(one.name(), settlement(one, common))));
    chart.rules.push(Rule { at: 0.0, label: "Xie & Leo".to_owned() });
    let caption = "One line per pairing of law and continuity; zero is Xie & Leo's column.";
    Figure::new("readme-audit-settlement", chart, caption)
}

fn over_mesh(pairings: &[Pairing<'_>], common: &Common) -> Figure {
    let ticks =
        labels::ticks(pairings.iter().flat_map(|one| &one.levels).map(|record| record.case.cell_size()));
    let mut chart = Chart::new(
        "Pressure against Xie & Leo, over the mesh",
        ChartAxis::log10("cell size h (m)").with_ticks(ticks),
        ChartAxis::log10("relative L_2 error of the pressure at the points (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(subtitle(pairings, &format!("T_v = {}", common.middle)));
    let mut falls: Vec<(f64, String)> = Vec::new();
    for one in pairings {
        let point =
            |record: &&Record| Some((record.case.cell_size(), error(record, PRESSURE, common.middle)?));
        let points: Vec<(f64, f64)> = one.levels.iter().filter_map(point).collect();
        if let [coarse, _, .., fine] = points.as_slice() {
            falls.push((coarse.1 / fine.1, one.name()));
        }
        chart.series.push(Series::new(one.name(), points));
    }
    let steepest = falls.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    chart.triangles.extend(steepest.map(|(_, beside)| SlopeTriangle { slope: 2.0, beside }));
    let caption = "The error of the right equations falls with every mesh; the triangle has the slope of second order, which \
                   the method promises. The error of wrong ones stops at the difference of the two theories.";
    Figure::new("readme-audit-pressure", chart, caption)
}

/// The method, which all pairings share.
fn subtitle(pairings: &[Pairing<'_>], at: &str) -> String {
    let method = pairings.first().and_then(|one| one.levels.first()).map(|record| record.case.method);
    method.map_or_else(|| at.to_owned(), |method| format!("{method}, {at}"))
}
