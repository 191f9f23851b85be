//! Are the published equations right? Each pairing of stress–strain law and continuity against the solution that
//! was wanted: over time on one mesh, and over the mesh at one time, where a right one falls with the mesh and a
//! wrong one does not.

use crate::case::Case;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::first_norm;
use crate::record::{Record, Status};
use crate::render::answers::question::{Answer, Links, Question, link};
use crate::render::chart::describe::{Chart, ChartAxis, Rule, Series, Size, SlopeTriangle};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::StudyResults;
use oedometer_exact::reference::ReferenceKind;
use std::collections::HashMap;

/// The question.
pub const QUESTION: Question = Question { heading: "Are the published equations right?", id: "audit" };

/// An error of the settlement this small on the finest mesh is of the equations that one wanted.
const AGREES: f64 = 0.01;

/// What the paper prints: its Eq. 6, without the porosity gradient, and its Eqs 7 and 8 as rates.
const PRINTED: (&str, &str) = ("porosity-dependent", "constant-porosity-gradient");

/// What the paper's step 5 needs beside it.
const MAPPING_BACK: &str = "Its step 5, mapping velocities back, needs a condition that the paper does not name: where the \
    skeleton sticks to a base and the water slides along it, the water takes the velocity of points that the base does not hold, and \
    a flux between the phases grows that no pressure drives: by 14 and 22 1/s on a layer of 4 × 4 cells (k = 1e-8 m/s, steps of 1.8e-4 \
    and 1.8e-5 s), to 261 times the pressure within 7642 steps that end without a sign of it. Here the nodes of the base keep the water's \
    velocity themselves, and nothing grows (docs/theory.md, section 3). Columns, and bases that are smooth, do not have it.";

/// One pairing of law and continuity by one method, from coarse to fine.
struct Pairing<'a> {
    law: &'static str,
    continuity: &'static str,
    levels: Vec<&'a Record>,
}

impl Pairing<'_> {
    /// The pairing in words; that of the paper marked.
    fn name(&self) -> String {
        let words = format!("{}, {}", self.law, self.continuity);
        if (self.law, self.continuity) == PRINTED { format!("{words} (as printed)") } else { words }
    }

    /// The error of a quantity on a mesh at a time, with its sign where it has one.
    fn error(&self, cells: usize, (quantity, sample): (Quantity, Sample), time: f64) -> Option<f64> {
        let record = self.levels.iter().find(|record| record.case.cells == cells)?;
        let wanted = ReferenceKind::XieLeo.name();
        Some(record.error(quantity, sample, first_norm(quantity), wanted, time)?.value)
    }

    fn cells(&self) -> impl Iterator<Item = usize> {
        self.levels.iter().map(|record| record.case.cells)
    }

    fn has(&self, cells: usize) -> bool {
        self.cells().any(|own| own == cells)
    }
}

const SETTLEMENT: (Quantity, Sample) = (Quantity::Settlement, Sample::Surface);
const PRESSURE: (Quantity, Sample) = (Quantity::Pressure, Sample::Points);

/// What all pairings have: their finest common mesh, its times, and the time of the figure over the mesh.
struct Common {
    cells: usize,
    times: Vec<f64>,
    middle: f64,
}

/// Settlement over time and pressure over the mesh, in a figure each, and who agrees.
pub fn answer(results: &[StudyResults<'_>], links: Links<'_>) -> Answer {
    let audited = results.iter().filter_map(|one| {
        let pairings = pairings(one.records);
        let common = common_of(&pairings)?;
        Some((one, pairings, common))
    });
    // Pairings first, then meshes and times: a figure lives on them.
    let worth = |pairings: &[Pairing<'_>], common: &Common| {
        let levels: usize = pairings.iter().map(|one| one.levels.len()).sum();
        (pairings.len().min(4), levels * common.times.len())
    };
    let Some((one, pairings, common)) = audited.max_by_key(|(_, pairings, common)| worth(pairings, common))
    else {
        return QUESTION.open(
            "one column at large strain with several laws and continuities, as in `large-strain-models`",
        );
    };
    let figures = vec![over_time(&pairings, &common), over_mesh(&pairings, &common)];
    QUESTION.told(
        format!("{} Evidence: {}.", sentence(&pairings, &common), link(links, &one.study.name)),
        vec![Block::Figures(figures), Block::Paragraph(MAPPING_BACK.to_owned())],
    )
}

/// The pairings of the method that has most of them, each with the run of most outputs on every mesh.
fn pairings(records: &[Record]) -> Vec<Pairing<'_>> {
    let is_audited = |record: &&Record| {
        record.status == Status::Ok
            && record.case.scene.is_large_strain()
            && record.references.iter().any(|used| used.name == ReferenceKind::XieLeo.name())
    };
    let mut groups: Vec<Vec<&Record>> = Vec::new();
    let mut places: HashMap<u64, usize> = HashMap::new();
    for record in records.iter().filter(is_audited) {
        let place = *places.entry(what_is_shared(&record.case)).or_insert(groups.len());
        match groups.get_mut(place) {
            Some(group) => group.push(record),
            None => groups.push(vec![record]),
        }
    }
    groups.into_iter().map(pairings_of).max_by_key(Vec::len).unwrap_or_default()
}

/// The pairings of records that differ in mesh, law and continuity alone, each with the run of most outputs on every mesh.
fn pairings_of(group: Vec<&Record>) -> Vec<Pairing<'_>> {
    let mut all: Vec<Pairing<'_>> = Vec::new();
    for record in group {
        let soil = &record.case.material;
        let (law, continuity) = (soil.law.name(), soil.continuity.name());
        let place = all.iter().position(|one| (one.law, one.continuity) == (law, continuity));
        let place = place.unwrap_or_else(|| {
            all.push(Pairing { law, continuity, levels: Vec::new() });
            all.len() - 1
        });
        let levels = &mut all[place].levels;
        match levels.iter_mut().find(|other| other.case.cells == record.case.cells) {
            Some(other) if other.case.time_factors.len() < record.case.time_factors.len() => {
                *other = record;
            }
            Some(_) => {}
            None => levels.push(record),
        }
    }
    for one in &mut all {
        one.levels.sort_by_key(|record| record.case.cells);
    }
    all
}

/// A number for everything but mesh, law and continuity: only runs that differ in these alone tell them apart.
fn what_is_shared(case: &Case) -> u64 {
    case.number_with(|case| {
        let seed = Case::seed(case.task, case.scene).material;
        case.cells = 0;
        case.time_factors.clear();
        case.material.law = seed.law;
        case.material.continuity = seed.continuity;
    })
}

/// What several pairings have in common; none of a single one.
fn common_of(pairings: &[Pairing<'_>]) -> Option<Common> {
    let first = pairings.first().filter(|_| pairings.len() > 1)?;
    let cells = first.cells().filter(|cells| pairings.iter().all(|one| one.has(*cells))).max()?;
    let record = first.levels.iter().find(|record| record.case.cells == cells)?;
    let has_all = |time: &f64| pairings.iter().all(|one| one.error(cells, SETTLEMENT, *time).is_some());
    let times: Vec<f64> = record.case.time_factors.iter().copied().filter(has_all).collect();
    let middle = *times.get(times.len().saturating_sub(1) / 2)?;
    Some(Common { cells, times, middle })
}

/// Which pairings are the wanted equations, and how far the others are from them, the printed one first.
fn sentence(pairings: &[Pairing<'_>], common: &Common) -> String {
    let largest = |one: &Pairing<'_>| {
        let errors =
            common.times.iter().filter_map(|time| Some((*time, one.error(common.cells, SETTLEMENT, *time)?)));
        errors.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    };
    let mut right = Vec::new();
    let mut wrong = Vec::new();
    for one in pairings {
        let Some((time, error)) = largest(one) else { continue };
        if error.abs() < AGREES {
            right.push(format!("`{}` ({})", one.name(), number::percent(error.abs())));
        } else {
            let which = format!("`{}` ({} at T_v = {time})", one.name(), signed(error));
            let is_printed = (one.law, one.continuity) == PRINTED;
            wrong.insert(if is_printed { 0 } else { wrong.len() }, which);
        }
    }
    let cells = common.cells;
    let agree = match right.as_slice() {
        [] => format!(
            "No pairing of law and continuity here gives Xie & Leo's settlement within {} on {cells} cells",
            number::percent(AGREES)
        ),
        all => format!(
            "On {cells} cells these pairings of law and continuity give Xie & Leo's settlement at every time, by their largest error: {}",
            all.join(", ")
        ),
    };
    match wrong.as_slice() {
        [] => format!("{agree}."),
        all => format!("{agree}. These are other theories, off by as much: {}.", all.join(", ")),
    }
}

/// A share with its sign.
fn signed(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "−" };
    format!("{sign}{}", number::percent(share.abs()))
}

fn over_time(pairings: &[Pairing<'_>], common: &Common) -> Figure {
    let mut chart = Chart::new(
        "Settlement against Xie & Leo, over time",
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("settlement over the exact one, minus one (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(subtitle(pairings, &format!("{} cells", common.cells)));
    for one in pairings {
        let points =
            common.times.iter().filter_map(|time| Some((*time, one.error(common.cells, SETTLEMENT, *time)?)));
        chart.series.push(Series::new(one.name(), points.collect()));
    }
    chart.rules.push(Rule { at: 0.0, label: "Xie & Leo".to_owned() });
    Figure::new(
        "readme-audit-settlement",
        chart,
        "One line a pairing of law and continuity; on zero it is Xie & Leo's column.",
    )
}

fn over_mesh(pairings: &[Pairing<'_>], common: &Common) -> Figure {
    let mut ticks: Vec<f64> =
        pairings.iter().flat_map(|one| &one.levels).map(|record| record.case.cell_size()).collect();
    ticks.sort_by(f64::total_cmp);
    ticks.dedup();
    let mut chart = Chart::new(
        "Pressure against Xie & Leo, over the mesh",
        ChartAxis::log10("cell size h (m)").with_ticks(ticks),
        ChartAxis::log10("relative L_2 error of the pressure at the points (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(subtitle(pairings, &format!("T_v = {}", common.middle)));
    let mut steepest: Option<(f64, String)> = None;
    for one in pairings {
        let points: Vec<(f64, f64)> = one
            .levels
            .iter()
            .filter_map(|record| {
                Some((record.case.cell_size(), one.error(record.case.cells, PRESSURE, common.middle)?))
            })
            .collect();
        if let (Some(coarse), Some(fine)) = (points.first(), points.last()) {
            let fall = coarse.1 / fine.1;
            if points.len() > 2 && steepest.as_ref().is_none_or(|(most, _)| fall > *most) {
                steepest = Some((fall, one.name()));
            }
        }
        chart.series.push(Series::new(one.name(), points));
    }
    chart.triangles.extend(steepest.map(|(_, beside)| SlopeTriangle { slope: 2.0, beside }));
    let caption = "The right equations come nearer with every mesh, with the slope of second order that the method promises; \
                   wrong ones stop at what tells the two theories apart.";
    Figure::new("readme-audit-pressure", chart, caption)
}

/// What all pairings share.
fn subtitle(pairings: &[Pairing<'_>], at: &str) -> String {
    let method = pairings.first().and_then(|one| one.levels.first()).map(|record| record.case.method);
    method.map_or_else(|| at.to_owned(), |method| format!("{method}, {at}"))
}
