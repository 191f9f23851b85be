//! The page of one study: its question, expectations, figures, tables and checks, from its findings alone.

use crate::questions::study_findings::StudyFindings;
use crate::render::RenderError;
use crate::render::page::{Block, Page, Section, slug};
use crate::report::blocks::{answers, expectations, race};

/// A part of the page: its blocks, or none where the findings have nothing for it.
type Part = fn(&StudyFindings) -> Result<Vec<Block>, RenderError>;

/// The parts in the order of the page, after what is not as expected.
const PARTS: [Part; 3] =
    [|study| Ok(race::blocks(study)), answers::blocks, |study| Ok(expectations::all(study))];

/// The page of a study.
///
/// # Errors
/// When a template refuses its findings.
pub fn study_page(study: &StudyFindings) -> Result<Page, RenderError> {
    let mut blocks = expectations::unmet(study);
    for part in PARTS {
        blocks.extend(part(study)?);
    }
    let name = slug(&study.name);
    let links = [
        ("All answers", "../index.html".to_owned()),
        ("All studies", "index.html".to_owned()),
        ("Study file", format!("{name}.toml")),
        ("CSV", format!("tables/{name}.csv")),
        ("Method names", "index.html#names".to_owned()),
        ("How to read", "index.html#how".to_owned()),
    ];
    let page = Page {
        title: study.title.clone(),
        links: links.map(|(words, target)| (words.to_owned(), target)).to_vec(),
        lead: format!("{}\n\n{}Run it again: `{}`.", study.summary, answers::lead(study)?, study.run_command),
        callout: study.shows_verdict.then(|| expectations::verdict(study)),
        sections: sections(blocks),
        files: Some(name),
        ..Page::default()
    };
    Ok(page.without_idle_figures())
}

/// A section from every heading on; the first block is one.
fn sections(blocks: Vec<Block>) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    for block in blocks {
        if let Block::Heading(heading) = block {
            let id = format!("{}-{}", slug(&heading), sections.len() + 1);
            sections.push(Section::new(heading, id, Vec::new()));
        } else if let Some(last) = sections.last_mut() {
            last.blocks.push(block);
        }
    }
    sections.retain(|section| !section.blocks.is_empty());
    sections
}
