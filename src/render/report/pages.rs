//! The page of one study: its question, expectations, figures, tables and checks; and the page that lists all studies.

use crate::case::quantity::Norm;
use crate::judge::proposals::proposals;
use crate::judge::study_check::diagnoses;
use crate::judge::verdict::Judgement;
use crate::render::checks::verdicts::{PROPOSED, judgements_table};
use crate::render::page::{Block, Callout, Page, Section, slug};
use crate::render::report::labels::{capitalised, grouped};
use crate::render::report::{
    StudyResults, checks, cost, layer, maps, race, refinement, setting, theory_lines,
};
use crate::render::table::{Cell, Mood, Table, columns};
use crate::render::tables::{runs, uncertainties};
use crate::study::expectation::Axis;
use oedometer_exact::exact_error::ExactError;
use oedometer_soil::wording::count_of;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The list of studies, and how their numbers were made.
pub fn index_page(results: &[StudyResults<'_>]) -> Page {
    let groups = groups(results);
    let mut sections: Vec<Section> = groups
        .iter()
        .map(|(name, studies)| Section {
            heading: capitalised(name),
            id: slug(name),
            mood: Some(Mood::of(studies.iter().all(|one| one.passes()))),
            blocks: vec![Block::Table(studies_table(studies))],
        })
        .collect();
    sections.push(numbers_section(results));
    Page {
        title: "All studies".to_owned(),
        lead: format!(
            "{} in {}. [The answers](../index.html).",
            count_of(results.len(), "study", "studies"),
            count_of(groups.len(), "group", "groups")
        ),
        sections,
        footer: footer(results),
        filter: Some("Words that a study has".to_owned()),
        files: Some("studies".to_owned()),
        ..Page::default()
    }
}

/// Studies by the first word of their names where several share it; the others together, last.
fn groups<'b, 'a>(results: &'b [StudyResults<'a>]) -> Vec<(&'b str, Vec<&'b StudyResults<'a>>)> {
    let first_word = |one: &'b StudyResults<'_>| one.study.name.split('-').next().unwrap_or_default();
    let mut groups = grouped(results.iter().map(|one| {
        let word = first_word(one);
        let is_shared = results.iter().filter(|other| first_word(other) == word).count() > 1;
        (if is_shared { word } else { "other" }, one)
    }));
    groups.sort_by_key(|(name, _)| *name == "other");
    groups
}

/// One row per study: how many of its expectations are met, and what runs it.
fn studies_table(studies: &[&StudyResults<'_>]) -> Table {
    let rows = studies.iter().map(|one| {
        vec![
            Cell::Link { words: one.study.title.clone(), target: format!("{}.html", slug(&one.study.name)) },
            Cell::Count(one.records.len() as u64),
            met_cell(one),
            Cell::Code(one.run_command()),
        ]
    });
    Table::of("", columns("study | > runs | expectations met | run it again"), rows)
}

/// How many expectations are met; without a mark if the study has none.
fn met_cell(one: &StudyResults<'_>) -> Cell {
    let mood = if one.judgements.is_empty() && one.passes() { Mood::Note } else { Mood::of(one.passes()) };
    let words = match one.judgements.len() {
        0 => "no expectations".to_owned(),
        all => format!("{} of {all}", one.met()),
    };
    Cell::Verdict(mood, words)
}

/// Norms and references of all records.
fn numbers_section(results: &[StudyResults<'_>]) -> Section {
    let norms = Norm::ALL.iter().map(|norm| vec![Cell::Code(norm.name().to_owned()), norm.formula().into()]);
    let mut used: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for reference in results.iter().flat_map(|one| one.records).flat_map(|record| &record.references) {
        let entry = used.entry(reference.name.as_str()).or_default();
        entry.0 = entry.0.max(reference.terms);
        entry.1 = entry.1.max(reference.tail_bound);
    }
    let references = used.iter().map(|(name, (terms, tail))| {
        vec![Cell::Code((*name).to_owned()), Cell::Count(*terms as u64), Cell::Error(*tail)]
    });
    let blocks = vec![
        Block::Table(
            Table::of("Norms", columns("norm | formula: x computed, x̂ exact, V volume of a sample"), norms)
                .note("the exact field is evaluated at the Lagrangian place of the sample"),
        ),
        Block::Table(
            Table::of(
                "References",
                columns("reference | > terms at most | > tail bound, over the load"),
                references,
            )
            .note(
                "terzaghi: with the water's compressibility; terzaghi-incompressible: the textbook's; \
                 single-mode: slowest mode, with the water's compressibility",
            ),
        ),
    ];
    Section::new("How the numbers were made", "how", blocks)
}

/// The program that made the records.
fn footer(results: &[StudyResults<'_>]) -> String {
    let provenance = results.iter().flat_map(|one| one.records).map(|record| &record.provenance).next();
    provenance.map_or(String::new(), |origin| {
        format!(
            "oedometer {}, sources {}, {}, {}, {} profile",
            origin.version, origin.sources, origin.compiler, origin.target, origin.profile
        )
    })
}

/// Reasons in the red box before the rest is only counted.
const MOST_REASONS: usize = 5;

/// Proposed expectations that stand open on the page.
const MOST_OPEN: usize = 4;

/// The page of a study.
///
/// # Errors
/// When a reference refuses a case.
pub fn study_page(results: &StudyResults<'_>) -> Result<Page, ExactError> {
    let study = results.study;
    let mut blocks = expectations(results);
    if study.is_race {
        blocks.extend(race::blocks(results));
    } else {
        blocks.extend(checks::survival(results).map(Block::Table));
        blocks.extend(maps::cheapest_methods(results));
        blocks.extend(layer::load_settlement(results));
        blocks.extend(layer::blocks(results)?);
        blocks.extend(theory_lines::blocks(results)?);
        for axis in Axis::REFINEMENTS {
            blocks.extend(refinement::blocks(results, axis));
        }
    }
    blocks.extend(uncertainties::table_of(&results.judgements).map(Block::Table));
    blocks.extend(checks::measures(results));
    blocks.extend(maps::critical_steps(results));
    if let Some(table) = runs::attached_table(results.records) {
        blocks.push(Block::Heading("Attached solvers".to_owned()));
        blocks.extend(results.taken_over.iter().map(|sentence| Block::Paragraph(format!("{sentence}."))));
        blocks.push(Block::Table(table.notes(diagnoses(study, results.records))));
    }
    if results.records.iter().any(|record| record.stability.is_none()) {
        blocks.extend(cost::work_blocks(results));
        blocks.extend(cost::wall_time_blocks(results));
        blocks.push(checks::worst_checks(results));
    }
    Ok(Page {
        title: study.title.clone(),
        lead: format!(
            "{}\n\n{}[All studies](index.html). Run it again: `{}`.",
            study.summary,
            setting::sentence(results.records).map_or(String::new(), |sentence| sentence + "\n\n"),
            results.run_command()
        ),
        callout: Some(verdict(results)),
        sections: sections(blocks),
        files: Some(slug(&study.name)),
        ..Page::default()
    })
}

/// Whether everything is as expected, and the reasons if not.
fn verdict(results: &StudyResults<'_>) -> Callout {
    let judged = results.judgements.len();
    let mut text = match judged {
        0 => "The study has no expectations.".to_owned(),
        _ => format!("{} of {judged} expectations are met.", results.met()),
    };
    if let Some((case, sentence)) = results.unsound.first() {
        let fail = count_of(results.unsound.len(), "check of its runs fails", "checks of its runs fail");
        let _ = write!(text, " {fail}, first {case}: {sentence}.");
    }
    let failing = failing(results);
    for judgement in failing.iter().take(MOST_REASONS) {
        let _ = write!(text, "\n\n`{}`: {}", judgement.subject, judgement.verdict.reason);
    }
    if failing.len() > MOST_REASONS {
        let _ = write!(text, "\n\nAnd {} more, below.", failing.len() - MOST_REASONS);
    }
    let mood = if judged == 0 && results.passes() { Mood::Note } else { Mood::of(results.passes()) };
    (mood, text)
}

fn failing<'b>(results: &'b StudyResults<'_>) -> Vec<&'b Judgement> {
    results.judgements.iter().filter(|judgement| !judgement.verdict.pass).collect()
}

/// The unmet expectations, and every expectation behind a click.
fn expectations(results: &StudyResults<'_>) -> Vec<Block> {
    let mut blocks = Vec::new();
    let failing = failing(results);
    if !failing.is_empty() {
        blocks.push(Block::Table(judgements_table("Expectations that are not met", &failing)));
    }
    let proposed = proposals(results.study, &results.paths);
    if !proposed.is_empty() {
        blocks.push(Block::Paragraph(PROPOSED.to_owned()));
        let whole = Block::Code(proposed.join("\n"));
        blocks.push(if proposed.len() > MOST_OPEN {
            Block::Details { summary: format!("The {} expectations", proposed.len()), blocks: vec![whole] }
        } else {
            whole
        });
    }
    if !results.judgements.is_empty() {
        let all: Vec<_> = results.judgements.iter().collect();
        blocks.push(Block::Details {
            summary: "Every expectation, with the reason for its verdict".to_owned(),
            blocks: vec![Block::Table(judgements_table("Expectations", &all))],
        });
    }
    blocks
}

/// A section from every heading on; the blocks before the first are about the expectations.
fn sections(blocks: Vec<Block>) -> Vec<Section> {
    let mut sections = vec![Section::new("Expectations", "expectations", Vec::new())];
    for block in blocks {
        if let Block::Heading(heading) = block {
            let id = format!("{}-{}", slug(&heading), sections.len());
            sections.push(Section::new(heading, id, Vec::new()));
        } else if let Some(last) = sections.last_mut() {
            last.blocks.push(block);
        }
    }
    sections.retain(|section| !section.blocks.is_empty());
    sections
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::Tier;
    use crate::study::check::Study;

    #[test]
    fn a_study_is_marked_by_what_is_met_and_by_what_is_wrong_with_its_records() {
        let of = |bounds: &[f64], wrong: usize| {
            let expect = |below: &f64| {
                format!("[[expect_case]]\ntime_factor = 0.2\nerror = {{ below = {below:e} }}\n")
            };
            let text =
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = ['GIMP']\n\
                        integrator = ['implicit']\ncells = [4]\n"
                    .to_owned() + &bounds.iter().map(expect).collect::<String>();
            let (study, records) = solved("s", &text);
            let mut results = StudyResults::new(&study, &records, Tier::Full);
            results.unsound = vec![("a case".to_owned(), "why".to_owned()); wrong];
            met_cell(&results)
        };
        for (bounds, wrong, mood, words) in [
            (&[0.9, 0.8][..], 0, Mood::Pass, "2 of 2"),
            (&[0.9, 1e-9], 0, Mood::Fail, "1 of 2"),
            (&[0.9], 1, Mood::Fail, "1 of 1"),
            (&[], 0, Mood::Note, "no expectations"),
            (&[], 1, Mood::Fail, "no expectations"),
        ] {
            assert_eq!(of(bounds, wrong), Cell::Verdict(mood, words.to_owned()), "{bounds:?}");
        }
    }

    #[test]
    fn studies_stand_by_their_first_word_and_those_alone_last_and_norms_and_references_once() {
        let text = |name: &str| {
            format!(
                "title = '{name}'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                 integrator = ['implicit']\ncells = [2]\n"
            )
        };
        let mut all: Vec<(Study, _)> =
            ["zeta", "race-a", "mesh-a", "race-b", "mesh-b"].map(|name| solved(name, &text(name))).into();
        // The largest of each, wherever they stand.
        for ((_, records), (terms, tail)) in
            all.iter_mut().zip([(3, 1e-9), (9, 1e-12), (5, 1e-8), (1, 0.0), (2, 0.0)])
        {
            (records[0].references[0].terms, records[0].references[0].tail_bound) = (terms, tail);
            records[0].references.truncate(1);
        }
        all[0].1[0].provenance.version = "0.0.1".to_owned();
        let results: Vec<StudyResults<'_>> =
            all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
        let page = index_page(&results);
        let told = |section: &Section| {
            let Block::Table(table) = &section.blocks[0] else { panic!("{section:?}") };
            (
                section.heading.clone(),
                table.rows.iter().map(|row| row[0].show()).collect::<Vec<_>>().join(" "),
            )
        };
        let is = |heading: &str, studies: &str| (heading.to_owned(), studies.to_owned());
        let groups: Vec<_> = page.sections[..3].iter().map(told).collect();
        assert_eq!(groups, [is("Race", "race-a race-b"), is("Mesh", "mesh-a mesh-b"), is("Other", "zeta")]);
        assert_eq!(page.lead, "5 studies in 3 groups. [The answers](../index.html).");
        assert_eq!(index_page(&results[..1]).lead, "1 study in 1 group. [The answers](../index.html).");
        assert!(
            page.footer.starts_with("oedometer 0.0.1, sources "),
            "that of the first record: {}",
            page.footer
        );
        let Block::Table(references) = &page.sections[3].blocks[1] else { panic!("norms, then references") };
        assert_eq!(references.rows, [[Cell::Code("terzaghi".to_owned()), Cell::Count(9), Cell::Error(1e-8)]]);
    }
}
