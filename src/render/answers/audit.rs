//! Are the published equations right? Each pairing of stress–strain law and continuity against the
//! solution that was wanted, at equal time.

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::exact::reference::ReferenceKind;
use crate::judge::paths::first_norm;
use crate::record::{Record, Status};
use crate::render::answers::question::{Links, link, section, unanswered};
use crate::render::chart::describe::{Chart, ChartAxis, Rule, Series, Size};
use crate::render::number;
use crate::render::page::{Block, Figure, Section};
use crate::render::report::StudyResults;

const HEADING: &str = "Are the published equations right?";

/// A settlement this near to the wanted one, over it, is of the equations that one wanted.
const AGREES: f64 = 0.01;

/// One pairing on one mesh.
struct Pairing<'a> {
    name: String,
    record: &'a Record,
}

impl Pairing<'_> {
    /// The error of a quantity against the wanted solution over the time factor, with its sign where it has one.
    fn errors(&self, quantity: Quantity, sample: Sample) -> Vec<(f64, f64)> {
        let (norm, wanted) = (first_norm(quantity), ReferenceKind::XieLeo.name());
        let times = self.record.case.time_factors.iter();
        times
            .filter_map(|time| Some((*time, self.record.error(quantity, sample, norm, wanted, *time)?.value)))
            .collect()
    }

    /// The largest of its errors in the settlement.
    fn largest(&self) -> Option<(f64, f64)> {
        let errors = self.errors(Quantity::Settlement, Sample::Surface);
        errors.into_iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }
}

/// Settlement and pressure of the pairings, in a figure each, and who agrees.
pub fn answer(results: &[StudyResults<'_>], links: Links<'_>) -> Section {
    let audited =
        results.iter().map(|one| (one, pairings(one.records))).max_by_key(|(_, pairings)| pairings.len());
    let Some((one, pairings)) = audited.filter(|(_, pairings)| pairings.len() > 1) else {
        let needed = "one column at large strain with several laws and continuities, as in `studies/large-strain-models.toml`";
        return unanswered(HEADING, "audit", needed);
    };
    let cells = pairings[0].record.case.cells;
    let settlement = figure(&pairings, Quantity::Settlement, Sample::Surface, "settlement");
    let pressure = figure(&pairings, Quantity::Pressure, Sample::Points, "pressure");
    let blocks = vec![
        Block::Paragraph(format!(
            "{} Evidence: {}.",
            sentence(&pairings, cells),
            link(links, &one.study.name)
        )),
        Block::Figures(vec![settlement, pressure]),
    ];
    section(HEADING, "audit", blocks)
}

/// The pairings of law and continuity of one method, the first run with most outputs of each, on the finest
/// mesh that all have so.
fn pairings(records: &[Record]) -> Vec<Pairing<'_>> {
    let audited = records.iter().filter(|record| {
        record.status == Status::Ok
            && record.case.scene.is_large_strain()
            && record.references.iter().any(|used| used.name == ReferenceKind::XieLeo.name())
    });
    let mut all: Vec<Pairing<'_>> = Vec::new();
    for record in audited {
        let soil = &record.case.material;
        let name = format!("{}, {}", soil.law.name(), soil.continuity.name());
        let outputs = |record: &Record| (record.case.time_factors.len(), record.case.cells);
        match all.iter_mut().find(|other| other.name == name) {
            Some(other)
                if other.record.case.method == record.case.method
                    && outputs(other.record) < outputs(record) =>
            {
                other.record = record;
            }
            Some(_) => {}
            None => all.push(Pairing { name, record }),
        }
    }
    // Alike in mesh and method, or not comparable.
    let most = all.iter().map(|one| one.record.case.time_factors.len()).max().unwrap_or(0);
    all.retain(|one| one.record.case.time_factors.len() == most);
    let first = all.first().map(|one| (one.record.case.cells, one.record.case.method));
    all.retain(|one| Some((one.record.case.cells, one.record.case.method)) == first);
    all
}

fn sentence(pairings: &[Pairing<'_>], cells: usize) -> String {
    let mut right = Vec::new();
    let mut wrong = Vec::new();
    for one in pairings {
        let Some((time, error)) = one.largest() else { continue };
        if error.abs() < AGREES {
            right.push(format!("**{}** (settlement within {})", one.name, number::percent(error.abs())));
        } else {
            wrong.push(format!(
                "**{}** (settlement off by {} at T_v = {time})",
                one.name,
                number::percent(error)
            ));
        }
    }
    let joined = |all: &[String]| if all.is_empty() { "none".to_owned() } else { all.join(", ") };
    format!(
        "Of the pairings of law and continuity these are the equations of Xie & Leo, on {cells} cells: {}; these are others: {}.",
        joined(&right),
        joined(&wrong)
    )
}

fn figure(pairings: &[Pairing<'_>], quantity: Quantity, sample: Sample, word: &str) -> Figure {
    let (title, label) = match first_norm(quantity) {
        Norm::Relative => ("Settlement against Xie & Leo", "s/s_exact − 1 (–)"),
        _ => ("Pressure against Xie & Leo", "relative L_2 error at the points (–)"),
    };
    let y = if quantity == Quantity::Settlement { ChartAxis::linear(label) } else { ChartAxis::log10(label) };
    let mut chart = Chart::new(title, ChartAxis::log10("time factor T_v (–)"), y);
    chart.size = Size::PANEL;
    for one in pairings {
        chart.series.push(Series::new(one.name.clone(), one.errors(quantity, sample)));
    }
    if quantity == Quantity::Settlement {
        chart.rules.push(Rule { at: 0.0, label: "Xie & Leo".to_owned() });
    }
    let case = &pairings[0].record.case;
    let caption =
        format!("`{}` on {} cells; one line a pairing of law and continuity.", case.method, case.cells);
    Figure::new(format!("readme-audit-{word}"), chart, caption)
}
