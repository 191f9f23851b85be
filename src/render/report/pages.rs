//! The list of all studies, in groups, before their pages.

use crate::render::page::{Block, Page, Section, slug};
use crate::render::report::{StudyResults, appendix};
use crate::render::table::{Cell, Mood, Table, columns};

/// The list of studies, and how their numbers were made. `ending` is that of their pages.
pub fn index_page(results: &[StudyResults<'_>], ending: &str) -> Page {
    let groups = groups(results);
    let mut sections: Vec<Section> = groups
        .iter()
        .map(|(name, studies)| Section {
            heading: capitalised(name),
            id: slug(name),
            mood: Some(Mood::of(studies.iter().all(|one| one.passes()))),
            blocks: vec![Block::Table(studies_table(studies, ending))],
        })
        .collect();
    sections.push(appendix::section(results));
    let up = if ending == "html" { "../index.html" } else { "../README.md" };
    Page {
        title: "All studies".to_owned(),
        lead: format!("{} studies in {} groups. [The answers]({up}).", results.len(), groups.len()),
        sections,
        footer: appendix::footer(results),
        filter: Some("Words that a study has".to_owned()),
        files: Some("studies".to_owned()),
        ..Page::default()
    }
}

/// Studies by the first word of their names where several share it; the others together.
fn groups<'b, 'a>(results: &'b [StudyResults<'a>]) -> Vec<(String, Vec<&'b StudyResults<'a>>)> {
    let first_word = |one: &StudyResults<'_>| one.study.name.split('-').next().unwrap_or_default().to_owned();
    let mut groups: Vec<(String, Vec<&StudyResults<'a>>)> = Vec::new();
    for one in results {
        let word = first_word(one);
        let shared = results.iter().filter(|other| first_word(other) == word).count() > 1;
        let name = if shared { word } else { "other".to_owned() };
        match groups.iter_mut().find(|(known, _)| *known == name) {
            Some((_, studies)) => studies.push(one),
            None => groups.push((name, vec![one])),
        }
    }
    groups.sort_by_key(|(name, _)| name == "other");
    groups
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// One row per study: how many of its expectations are met, and what runs it.
fn studies_table(studies: &[&StudyResults<'_>], ending: &str) -> Table {
    let rows = studies.iter().map(|one| {
        vec![
            Cell::Link {
                words: one.study.title.clone(),
                target: format!("{}.{ending}", slug(&one.study.name)),
            },
            Cell::Count(one.records.len() as u64),
            Cell::Verdict(Mood::of(one.passes()), format!("{} of {}", one.met(), one.judgements.len())),
            Cell::Code(one.run_command()),
        ]
    });
    Table::of("", columns("study | > runs | expectations met | run it again"), rows)
}
