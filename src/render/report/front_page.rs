//! The front page of a report: what a reader sees first, short enough for a repository to keep.

use crate::render::page::{Block, Figure, Page, Section, all_figures};
use crate::render::report::{StudyResults, appendix, findings};
use crate::render::table::{Cell, Mood, Table, TableColumn};

/// What the front page shows a figure of: its name there, and what the names of the report's figures
/// have in them. The first figure of each kind is shown.
const SHOWN: [(&str, &str); 7] = [
    ("readme-mesh", "-cells-pressure-points-"),
    ("readme-isochrones", "-isochrones-gc-sri-patch"),
    ("readme-large-strain", "large-strain-mesh-isochrones-"),
    ("readme-consolidation", "-consolidation"),
    ("readme-layer", "-displacement-skeleton"),
    ("readme-critical-step", "-drag"),
    ("readme-wall-time", "-wall-time"),
];

/// The findings, a figure of each kind and the verdict on every study; the rest is in the `whole` report.
pub fn front_page(results: &[StudyResults<'_>], whole: &Page) -> Page {
    let mut findings = findings::section(results);
    findings.blocks.retain(|block| matches!(block, Block::Callout(..) | Block::Table(_)));
    let all = all_figures(whole);
    let shown = SHOWN.iter().filter_map(|(name, kind)| {
        let figure = all.iter().find(|figure| figure.name.contains(kind))?;
        Some(Block::Figure(Figure { name: (*name).to_owned(), ..(*figure).clone() }))
    });
    let shown: Vec<Block> = shown.collect();
    let mut sections = vec![findings];
    if !shown.is_empty() {
        sections.push(section("Figures", "figures", shown));
    }
    sections.push(section("Studies", "studies", vec![Block::Table(studies_table(results))]));
    let made_by = "`oedometer report` makes this page, `index.html` with every figure and table of every study, and \
                   the same as `report.md`; a repository keeps this page alone.";
    Page {
        title: whole.title.clone(),
        lead: format!("{}\n\nMade by {}. {made_by}", whole.lead, appendix::footer(results)),
        sections,
        footer: String::new(),
    }
}

fn section(heading: &str, id: &str, blocks: Vec<Block>) -> Section {
    Section { heading: heading.to_owned(), id: id.to_owned(), mood: None, blocks }
}

/// One row per study: how many of its expectations are met, and what runs it.
fn studies_table(results: &[StudyResults<'_>]) -> Table {
    let rows = results.iter().map(|one| {
        let met = one.judgements.iter().filter(|judgement| judgement.verdict.pass).count();
        let mood = if one.passes() { Mood::Pass } else { Mood::Fail };
        vec![
            one.study.title.as_str().into(),
            Cell::Count(one.records.len() as u64),
            Cell::Verdict(mood, format!("{met} of {}", one.judgements.len())),
            Cell::Code(one.run_command()),
        ]
    });
    let columns = ["study", "runs", "expectations met", "run it again"].map(TableColumn::text);
    Table { rows: rows.collect(), ..Table::new("", columns.to_vec()) }
}
