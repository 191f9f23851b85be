//! The page of one study: whether all is as expected, what it answers, and every expectation.

use crate::judge::study_results::StudyResults;
use crate::judge::verdict::Judgement;
use crate::questions::finding::{Finding, Place};
use crate::questions::setting::SETTING;
use crate::render::RenderError;
use crate::render::page::{Block, Callout, Page, Section, slug};
use crate::render::table::Mood;
use crate::report::check_page::{judgements_table, objection};
use crate::report::sections::section;
use oedometer_wording::first_few;
use std::fmt::Write;

/// The page of a study from its answers at [`Place::Study`].
///
/// # Errors
/// When a template refuses its facts.
pub fn study_page(one: &StudyResults<'_>, findings: &[Finding]) -> Result<Page, RenderError> {
    let name = slug(&one.study.name);
    let links = [("Study file", format!("{name}.toml")), ("CSV", format!("tables/{name}.csv"))];
    let (setting, answers): (Vec<&Finding>, Vec<&Finding>) =
        findings.iter().partition(|finding| finding.question == &SETTING);
    let lead = setting.first().map(|setting| setting.sentence()).transpose()?;
    let lead = lead.map_or(String::new(), |lead| lead + "\n\n");
    let mut sections = Vec::new();
    for finding in answers {
        sections.push(section(finding, Place::Study)?);
    }
    sections.extend(expectations(one));
    // A situation of the race is judged by its answer.
    let shows_verdict = !one.study.is_race || !one.check.judgements.is_empty() || !one.check.meets_all();
    Ok(Page {
        title: one.study.title.clone(),
        links: links.map(|(words, target)| (words.to_owned(), target)).to_vec(),
        lead: format!("{}\n\n{lead}Run it again: `{}`.", one.study.summary, one.run_command()),
        callout: shows_verdict.then(|| verdict(one)),
        sections,
        files: Some(name),
        ..Page::default()
    })
}

/// The page of a study beside those of others, with links to what all share.
#[must_use]
pub fn among_others(mut page: Page) -> Page {
    let link = |(words, target): (&str, &str)| (words.to_owned(), target.to_owned());
    page.links.splice(0..0, [("All answers", "../index.html"), ("All studies", "index.html")].map(link));
    page.links.extend([("Method names", "index.html#names"), ("How to read", "index.html#how")].map(link));
    page
}

/// Reasons in the red box before the rest is only counted.
const MOST_REASONS: usize = 5;

/// Whether everything is as expected, and the reasons if not.
fn verdict(one: &StudyResults<'_>) -> Callout {
    let check = &one.check;
    let judged = check.judgements.len();
    let mut text = String::new();
    for sentence in &check.diagnoses {
        let _ = write!(text, "Diagnosis: {sentence}\n\n");
    }
    let _ = match judged {
        0 => write!(text, "The study has no expectations."),
        _ => write!(text, "{} of {judged} expectations are met.", check.met()),
    };
    let objections = check.objections();
    for sentence in first_few(objections.iter().map(objection).collect(), MOST_REASONS) {
        let _ = write!(text, "\n\n{sentence}");
    }
    (if objections.is_empty() { mood_of(one) } else { Mood::Fail }, text)
}

/// Whether a study is as expected; nothing is said of one that expects nothing.
pub fn mood_of(one: &StudyResults<'_>) -> Mood {
    let passes = one.check.meets_all();
    if one.check.judgements.is_empty() && passes { Mood::Note } else { Mood::of(passes) }
}

/// Every expectation of the study behind a click.
fn expectations(one: &StudyResults<'_>) -> Option<Section> {
    let all: Vec<&Judgement> = one.check.judgements.iter().collect();
    let each = || Block::Details {
        summary: "Every expectation, with the reason for its verdict".to_owned(),
        blocks: vec![Block::Table(judgements_table("Expectations", &all))],
    };
    (!all.is_empty()).then(|| Section::new("Expectations", "expectations", vec![each()]))
}
