//! The pages of a report: the whole, and a front page with what a reader sees first, short enough for a
//! repository to keep.

use crate::exact::exact_error::ExactError;
use crate::render::page::{Block, Figure, Page, Section, all_figures};
use crate::render::report::{StudyResults, appendix, findings, study_section, survival};
use crate::render::table::{Cell, Mood, Table, columns};

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

/// The page over the results of studies.
///
/// # Errors
/// When a reference refuses a case.
pub fn page_of(results: &[StudyResults<'_>]) -> Result<Page, ExactError> {
    let mut sections = vec![findings::section(results)];
    for one in results {
        sections.push(study_section::of_study(one)?);
    }
    sections.extend(survival::section(results));
    sections.push(appendix::section(results));
    Ok(Page {
        title: "Convergence report".to_owned(),
        lead: findings::lead(results),
        sections,
        footer: appendix::footer(results),
    })
}

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
        vec![
            one.study.title.as_str().into(),
            Cell::Count(one.records.len() as u64),
            Cell::Verdict(Mood::of(one.passes()), format!("{} of {}", one.met(), one.judgements.len())),
            Cell::Code(one.run_command()),
        ]
    });
    Table::of("", columns("study | > runs | expectations met | run it again"), rows)
}
