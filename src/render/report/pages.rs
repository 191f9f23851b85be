//! The page of one study: its question, expectations, figures, tables and checks; and the page that lists all studies.

use crate::case::Task;
use crate::case::quantity::Norm;
use crate::judge::blocks::{StudyBlocks, used_references};
use crate::judge::findings::study_answers::StudyAnswers;
use crate::judge::proposals::proposals;
use crate::judge::study_check::diagnoses;
use crate::judge::verdict::Judgement;
use crate::render::answers::locking;
use crate::render::checks::verdicts::{PROPOSED, judgements_table};
use crate::render::page::{Block, Callout, Page, Section, slug};
use crate::render::report::labels::grouped;
use crate::render::report::{
    StudyResults, checks, cost, layer, maps, race, refinement, setting, theory_lines, within,
};
use crate::render::table::{Cell, Mood, Table, columns};
use crate::render::tables::{runs, settlement, uncertainties};
use crate::render::{RenderError, templates};
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_mpm::scene::SceneKind;
use oedometer_soil::wording::count_of;
use std::fmt::Write;

/// The list of studies, and how their numbers were made.
pub fn index_page(results: &[StudyResults<'_>]) -> Page {
    let groups = groups(results);
    let mut sections: Vec<Section> = groups
        .iter()
        .map(|(name, studies)| Section {
            heading: (*name).to_owned(),
            id: slug(name),
            mood: Some(Mood::of(studies.iter().all(|one| one.passes()))),
            blocks: vec![Block::Table(studies_table(studies))],
        })
        .collect();
    sections.push(numbers_section(results));
    Page {
        title: "All studies".to_owned(),
        lead: format!(
            "{} of {}. [The answers](../index.html).",
            count_of(results.len(), "study", "studies"),
            count_of(groups.len(), "question", "questions")
        ),
        sections,
        footer: footer(results),
        filter: Some("Words that a study has".to_owned()),
        files: Some("studies".to_owned()),
        ..Page::default()
    }
}

/// Studies by what they ask, in the order of a reader's questions.
fn groups<'b, 'a>(results: &'b [StudyResults<'a>]) -> Vec<(&'static str, Vec<&'b StudyResults<'a>>)> {
    let mut groups = grouped(results.iter().map(|one| (question(one.study), one)));
    groups.sort_by_key(|(asked, _)| QUESTIONS.iter().position(|question| question == asked));
    groups
}

/// What studies ask, in the order in which they are listed.
const QUESTIONS: [&str; 9] = [
    "Which method reaches 1 % at the least cost?",
    "How fast does the error fall at small strain?",
    "How fast does the error fall at large strain?",
    "Do points that move through the mesh converge?",
    "Do layers, slabs and footings in the plane lock?",
    "Do layered and yielding soils converge?",
    "Do waves keep their speed and height?",
    "Does a body under its own weight stay at rest?",
    "Which steps are stable?",
];

/// The question of a study, by its task and scene.
fn question(study: &Study) -> &'static str {
    let is_stability = study.planned.iter().any(|planned| planned.case.task == Task::Stability);
    QUESTIONS[match study.scene {
        _ if study.is_race => 0,
        _ if is_stability => 8,
        SceneKind::Terzaghi | SceneKind::SingleMode | SceneKind::SealedElement => 1,
        SceneKind::XieLeo => 2,
        SceneKind::ManufacturedBox | SceneKind::ManufacturedShear | SceneKind::ManufacturedVortex => 3,
        SceneKind::CosineLayer | SceneKind::Mandel | SceneKind::Footing => 4,
        SceneKind::Layered | SceneKind::YieldFront => 5,
        SceneKind::DynamicColumn | SceneKind::DynamicSingleMode | SceneKind::StandingWave => 6,
        SceneKind::AtRest => 7,
    }]
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
    let used = used_references(results);
    let references = used.iter().map(|used| {
        vec![Cell::Code(used.name.clone()), Cell::Count(used.terms as u64), Cell::Error(used.tail_bound)]
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
/// When a reference refuses a case, or a template its findings.
pub fn study_page(results: &StudyResults<'_>) -> Result<Page, RenderError> {
    let study = results.study;
    let mut blocks = unmet(results);
    let found = StudyBlocks::new(results)?;
    let told = diagnoses(study, results.records);
    // The race has a page and sentences of its own.
    let answers = StudyAnswers::new(study, results.records, &results.paths)?;
    if study.is_race {
        blocks.extend(race::blocks(results)?);
    } else {
        blocks.extend(answered(&answers)?);
        blocks.extend(maps::cheapest_methods(results, found.map.as_ref()));
        blocks.extend(layer::load_settlement(results, found.loads.as_ref()));
        blocks.extend(layer::blocks(results, found.fields.as_ref())?);
        blocks.extend(theory_lines::blocks(results, found.profiles.as_ref())?);
        for axis in Axis::REFINEMENTS {
            blocks.extend(refinement::blocks(results, axis));
        }
    }
    blocks.push(Block::Heading("Runs".to_owned()));
    blocks.extend(checks::survival(&found.ends).map(|table| Block::Details {
        summary: "How each case ended".to_owned(),
        blocks: vec![Block::Table(table)],
    }));
    blocks.extend(uncertainties::table_of(&results.judgements).map(Block::Table));
    blocks.extend(checks::measures(&found.measures));
    blocks.extend(maps::critical_steps(results));
    if let Some(table) = runs::attached_table(&found.outside_runs) {
        blocks.push(Block::Heading("Attached solvers".to_owned()));
        blocks.extend(results.taken_over.iter().map(|sentence| Block::Paragraph(format!("{sentence}."))));
        blocks.push(Block::Table(table.notes(told.clone())));
    }
    if results.records.iter().any(|record| record.stability.is_none()) {
        // The race has figures of its own of error against work.
        if !study.is_race {
            blocks.extend(cost::work_blocks(results, &found.timing));
        }
        blocks.extend(cost::wall_time_blocks(results));
        blocks.push(checks::worst_checks(&found.checks, &found.groups));
    }
    blocks.push(Block::Heading("Expectations".to_owned()));
    blocks.extend(expectations(results));
    let mut setting = setting::sentence(found.setting.as_ref())?;
    if !setting.is_empty() {
        setting += "\n\n";
    }
    let page = Page {
        title: study.title.clone(),
        lead: format!(
            "{}\n\n{setting}{}[All studies](index.html). Run it again: `{}`.",
            study.summary,
            within::sentences(&answers.within)? + "\n\n",
            results.run_command()
        ),
        // A situation of the race is judged by its answer.
        callout: (!study.is_race || !results.judgements.is_empty() || !results.passes())
            .then(|| verdict(results, &told)),
        sections: sections(blocks),
        files: Some(slug(&study.name)),
        ..Page::default()
    };
    Ok(page.without_idle_figures())
}

/// Settlements by date, and who locks: what the answers on top of the page are read off from.
fn answered(answers: &StudyAnswers) -> Result<Vec<Block>, RenderError> {
    let mut blocks = Vec::new();
    if !answers.settlements.is_empty() {
        blocks.push(Block::Heading("Settlement by date".to_owned()));
    }
    for found in &answers.settlements {
        let mut table = settlement::table_of(found);
        table.title = settlement::heading(found);
        blocks.push(Block::Table(table));
    }
    if let Some(found) = &answers.locking {
        blocks.push(Block::Heading("Who locks?".to_owned()));
        blocks.push(Block::Paragraph(templates::sentence("locking", found)?));
        blocks.push(Block::Table(locking::table(found)));
    }
    Ok(blocks)
}

/// Whether everything is as expected, and the reasons if not.
fn verdict(results: &StudyResults<'_>, diagnoses: &[String]) -> Callout {
    let judged = results.judgements.len();
    let mut text = String::new();
    for sentence in diagnoses {
        let _ = write!(text, "Diagnosis: {sentence}\n\n");
    }
    let _ = match judged {
        0 => write!(text, "The study has no expectations."),
        _ => write!(text, "{} of {judged} expectations are met.", results.met()),
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

/// The expectations that are not met, under a heading; nothing where all are.
fn unmet(results: &StudyResults<'_>) -> Vec<Block> {
    let failing = failing(results);
    if failing.is_empty() {
        return Vec::new();
    }
    let table = judgements_table("Expectations that are not met", &failing);
    vec![Block::Heading("Not as expected".to_owned()), Block::Table(table)]
}

/// The expectations that a study could have, and every one that it has behind a click.
fn expectations(results: &StudyResults<'_>) -> Vec<Block> {
    let mut blocks = Vec::new();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::Tier;

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
    fn studies_stand_by_what_they_ask_and_norms_and_references_once() {
        let text = |name: &str| {
            let scene = if name.starts_with("mesh") { "layered" } else { "terzaghi" };
            format!(
                "title = '{name}'\nscene = '{scene}'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
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
        let groups: Vec<_> = page.sections[..2].iter().map(told).collect();
        assert_eq!(groups, [is(QUESTIONS[1], "zeta race-a race-b"), is(QUESTIONS[5], "mesh-a mesh-b")]);
        assert_eq!(page.lead, "5 studies of 2 questions. [The answers](../index.html).");
        assert_eq!(index_page(&results[..1]).lead, "1 study of 1 question. [The answers](../index.html).");
        assert!(
            page.footer.starts_with("oedometer 0.0.1, sources "),
            "that of the first record: {}",
            page.footer
        );
        let Block::Table(references) = &page.sections[2].blocks[1] else { panic!("norms, then references") };
        let row = |name: &str, terms: u64, tail: f64| {
            vec![Cell::Code(name.to_owned()), Cell::Count(terms), Cell::Error(tail)]
        };
        assert_eq!(references.rows, [row("layered", 5, 1e-8), row("terzaghi", 9, 1e-9)]);
    }
}
