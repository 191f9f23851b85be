//! The answer page: what a reader asks of the records of all studies. Each question has a sentence from its template, a
//! short table or a figure, and a link to the study that shows it.
//!
//! Every number comes from the findings. A question that the records do not answer is not put.

pub(crate) mod race;

pub use race::matrix_page;

use crate::history::comparison::StudyComparison;
use crate::judge::study_results::StudyResults;
use crate::questions::expected::EXPECTED;
use crate::questions::finding::{Finding, Place};
use crate::questions::{answers_with, sentence};
use crate::race::RaceFindings;
use crate::record::provenance::{Origins, Provenance};
use crate::render::RenderError;
use crate::render::page::{Block, Callout, Page, Section};
use crate::render::table::Mood;
use crate::report::history_tables::comparison_tables;
use crate::report::sections::{links_to, section};
use oedometer_exact::ExactError;
use oedometer_wording::count_of;
use serde::Serialize;

/// What the answer page is made of.
pub struct Answers<'a> {
    /// The studies.
    pub studies: &'a [StudyResults<'a>],
    /// What they answer together.
    pub findings: Vec<Finding>,
    /// The race to 1 %, where there was one.
    pub race: Option<RaceFindings>,
    /// The studies that differ from their golden values; `None` where none has any.
    pub changes: Option<Vec<StudyComparison>>,
}

impl<'a> Answers<'a> {
    /// The answers of some studies, and what changed in them.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(
        studies: &'a [StudyResults<'a>],
        changes: Option<Vec<StudyComparison>>,
    ) -> Result<Self, ExactError> {
        let race = RaceFindings::from_studies(studies.iter().map(|one| (one.study, one.records)));
        let race = race.filter(|race| !race.situations.is_empty());
        Ok(Self { studies, findings: answers_with(studies, Place::Report, race.as_ref())?, race, changes })
    }

    /// The answer to a question.
    fn to(&self, question: &str) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.question.id == question)
    }
}

/// When, where and by which command a report was made.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Making {
    /// Day, as 2026-11-22.
    pub date: String,
    /// The processor, with the number of its threads.
    pub processor: String,
    /// The command, as it was typed.
    pub command: String,
    /// Seconds it took.
    pub seconds: f64,
    /// Cases that were run for this report; the others had their records.
    pub cases_run: usize,
    /// Cases of the studies that have no record: those of a larger tier.
    pub left_out: usize,
}

impl Making {
    /// The line of provenance: program, commit, day, processor, time, command.
    pub fn words(&self, studies: &[StudyResults<'_>]) -> String {
        let mut origins = Origins::default();
        studies.iter().flat_map(|one| one.records).for_each(|record| origins.add(&record.provenance));
        let records: usize = studies.iter().map(|one| one.records.len()).sum();
        let program = origins.main().map_or_else(String::new, program_of);
        let several = origins.several_programs().map_or_else(String::new, |programs| {
            format!(" The records come from more than one program: {programs}.")
        });
        let run = match self.cases_run {
            0 => format!("rendered in {:.1} s from {records} records", self.seconds),
            run => format!("{:.1} s with {run} of {records} cases run", self.seconds),
        };
        let left_out = match self.left_out {
            0 => String::new(),
            cases => format!(
                " {} of the test level `full` not run; `oedometer report --tier full` runs {}.",
                count_of(cases, "case", "cases"),
                if cases == 1 { "it" } else { "them" }
            ),
        };
        let Self { date, processor, command, .. } = self;
        format!("{program} · {date} · {processor} · {run} · `{command}`{several}{left_out}")
    }
}

/// Version, commit or sources, compiler and profile.
pub(crate) fn program_of(origin: &Provenance) -> String {
    let commit = match (origin.commit.is_empty(), origin.dirty) {
        (true, _) => String::new(),
        (false, false) => format!("commit `{}`, ", origin.commit),
        (false, true) => format!("commit `{}` with changes, ", origin.commit),
    };
    format!(
        "oedometer {} · {commit}sources `{}` · {}, {} profile",
        origin.version, origin.sources, origin.compiler, origin.profile
    )
}

/// Rows of a table on the answer page.
const MOST_ROWS: usize = 10;

/// The questions of the page behind the choice of a method, in their order; what changed stands before the first of the last.
const ASKED: [&str; 8] = ["cost", "peers", "paper", CHANGES, "locking", "convergence", "time-step", "audit"];

/// The section of what changed.
const CHANGES: &str = "changes";

/// The answer page.
///
/// # Errors
/// When a template refuses its facts.
pub fn answer_page(answers: &Answers<'_>, making: &Making) -> Result<Page, RenderError> {
    let studies = answers.studies;
    let mut sections = Vec::new();
    if let Some(race) = &answers.race {
        sections.push(race::section(race, answers)?);
    }
    for asked in ASKED {
        sections.extend(match asked {
            CHANGES => answers.changes.as_deref().map(changes_section).transpose()?,
            _ => answers.to(asked).map(|finding| section(finding, Place::Report)).transpose()?,
        });
    }
    // A small report names its studies, as perhaps no answer links to them.
    let few = match studies.len() {
        1..=FEW_STUDIES => format!(": {}", links_to(studies.iter().map(|one| one.study.name.as_str()))),
        _ => String::new(),
    };
    let made =
        format!("**How was it made?** {}\n\n[All studies](studies/index.html){few}", making.words(studies));
    let (mood, verdict) = verdict(answers)?;
    let mut page = Page { title: "Convergence report".to_owned(), is_wide: true, ..Page::default() };
    // With a race its sentences stand first, and how it was made at the end.
    if let Some(race) = &answers.race {
        [page.title, page.lead] = race::headline(race)?;
        page.footer = made;
        sections.push(Section {
            heading: EXPECTED.heading.to_owned(),
            id: EXPECTED.id.to_owned(),
            mood: Some(mood),
            blocks: vec![Block::Paragraph(verdict)],
        });
        page.links = race::front_links(&sections, studies.len());
    } else {
        (page.lead, page.callout) = (made, Some((mood, verdict)));
    }
    page.sections = sections;
    Ok(page)
}

/// Studies up to which the head of the page names each.
const FEW_STUDIES: usize = 6;

/// Whether everything is as expected, in one sentence that names what is not.
fn verdict(answers: &Answers<'_>) -> Result<Callout, RenderError> {
    let expects = answers.studies.iter().any(|one| !one.check.judgements.is_empty());
    let passes = answers.studies.iter().all(|one| one.check.meets_all());
    let mood = if passes && !expects { Mood::Note } else { Mood::of(passes) };
    let sentence = answers.to(EXPECTED.id).map(Finding::sentence).transpose()?;
    Ok((mood, sentence.unwrap_or_default()))
}

/// How many studies changed.
#[derive(Serialize)]
struct Changes {
    changed: usize,
    worse: usize,
}

/// The studies that differ, as `oedometer compare` shows them.
pub fn changes_section(changes: &[StudyComparison]) -> Result<Section, RenderError> {
    let worse = changes.iter().filter(|one| one.is_regression()).count();
    let sentence = sentence::filled(include_str!("changes.md"), &Changes { changed: changes.len(), worse })?;
    let tables = comparison_tables(changes, ["the golden values", "this report"]);
    let shown = tables.into_iter().filter(|_| !changes.is_empty());
    let shown = shown.map(|table| Block::Table(table.shown(MOST_ROWS)));
    let blocks = std::iter::once(Block::Paragraph(sentence)).chain(shown).collect();
    Ok(Section::new("What changed?", CHANGES, blocks))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;
    use crate::golden::GoldenFile;
    use crate::history::state::StudyState;
    use crate::record::Record;
    use crate::study::check::Study;

    #[test]
    fn a_report_from_records_alone_says_so() {
        let making = Making { seconds: 1.25, command: "oedometer report".to_owned(), ..Making::default() };
        assert!(making.words(&[]).contains("rendered in 1.2 s from 0 records"), "{}", making.words(&[]));
        let run = Making { cases_run: 3, ..making };
        assert!(run.words(&[]).contains("with 3 of 0 cases run"));
    }

    #[test]
    fn what_got_worse_is_counted_and_shown_and_nothing_is_said_to_be_nothing() {
        let state = |error: f64| {
            let pressure = crate::golden::measure::key("GIMP cells=4", 1.0, "pressure points terzaghi");
            let values = [(pressure, error)].into();
            StudyState::of_golden(GoldenFile { values, ..GoldenFile::of("s", &[], "-") })
        };
        let changes = [("worse", 0.3), ("better", 0.1)]
            .map(|(name, error)| StudyComparison::of(name, &state(0.2), &state(error)));
        let section = changes_section(&changes).expect("a section");
        let [Block::Paragraph(told), Block::Table(table), ..] = &section.blocks[..] else {
            panic!("{section:?}")
        };
        assert_eq!(told, "Compared with the golden values, 2 studies changed; 1 of them got worse.");
        assert_eq!(table.title, "the golden values → this report");
        let trends: Vec<_> = table.rows.iter().map(|row| [row[0].show(), row[1].show()]).collect();
        assert_eq!(trends, [["worse", "✗ regressed"], ["better", "✓ improved"]]);
        assert_eq!(changes_section(&[]).expect("a section").blocks.len(), 1);
    }

    /// A small study with expectations of which some are met.
    fn study(name: &str, bounds: &[f64]) -> (Study, Vec<Record>) {
        let expect =
            |below: &f64| format!("[[expect_case]]\ntime_factor = 0.1\nerror = {{ below = {below:e} }}\n");
        let text =
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                    integrator = ['implicit']\ncells = [4]\n"
                .to_owned()
                + &bounds.iter().map(expect).collect::<String>();
        solved(name, &text)
    }

    #[test]
    fn the_head_of_the_page_has_the_verdict_and_few_studies() {
        let all: Vec<_> = ["a", "b", "c", "d", "e", "f", "g"].map(|name| study(name, &[])).into();
        let page = |all: &[(Study, Vec<Record>)]| {
            let of = |(study, records)| StudyResults::new(study, records, Tier::Full);
            let results: Vec<_> = all.iter().map(|(study, records)| of((study, records))).collect();
            let answers = Answers::new(&results, None).expect("sound cases");
            answer_page(&answers, &Making::default()).expect("a page")
        };
        for (count, links) in [(2, 2), (6, 6), (7, 0)] {
            let lead = page(&all[..count]).lead;
            let (_, listed) = lead.split_once("(studies/index.html)").expect("a link to all");
            assert_eq!(listed.matches("](studies/").count(), links, "{lead}");
        }
        for (bounds, mood, words) in [
            (&[][..], Mood::Note, "No expectations"),
            (&[0.9, 0.8], Mood::Pass, "2 of 2 expectations met"),
            (&[0.9, 1e-9], Mood::Fail, "1 of 2 expectations met"),
        ] {
            let (found, text) = page(&[study("s", bounds)]).callout.expect("a verdict");
            assert_eq!((found, text.contains(words)), (mood, true), "{text}");
        }
    }

    #[test]
    fn the_program_that_made_most_records_is_told_and_that_there_are_several() {
        let (study, records) = study("s", &[]);
        let with = |version: &str, commit: &str, dirty: bool| {
            let mut record = records[0].clone();
            let text = |word: &str| word.to_owned();
            record.provenance = Provenance {
                version: text(version),
                sources: text("abc"),
                commit: text(commit),
                dirty,
                compiler: text("rustc"),
                target: text("x86"),
                profile: text("release"),
            };
            record
        };
        let making = Making {
            date: "DAY".to_owned(),
            processor: "CPU".to_owned(),
            command: "it".to_owned(),
            ..Making::default()
        };
        let told = |records: &[Record], making: &Making| {
            let results = [StudyResults::new(&study, records, Tier::Full)];
            making.words(&results)
        };
        let end = "· rustc, release profile · DAY · CPU · rendered in 0.0 s from 1 records · `it`";
        assert_eq!(told(&[with("1", "", true)], &making), format!("oedometer 1 · sources `abc` {end}"));
        assert_eq!(
            told(&[with("1", "f0", false)], &making),
            format!("oedometer 1 · commit `f0`, sources `abc` {end}")
        );
        let changed = format!("oedometer 1 · commit `f0` with changes, sources `abc` {end}");
        assert_eq!(told(&[with("1", "f0", true)], &making), changed);
        let more = " 1 case of the test level `full` not run; `oedometer report --tier full` runs it.";
        assert_eq!(told(&[with("1", "f0", true)], &Making { left_out: 1, ..making.clone() }), changed + more);
        let several = told(&[with("1", "", false), with("2", "", false), with("2", "", false)], &making);
        assert!(several.starts_with("oedometer 2 ·"), "{several}");
        assert!(
            several.ends_with(
                " The records come from more than one program: 1 of version 1 and sources abc, 2 of version \
                 2 and sources abc."
            ),
            "{several}"
        );
    }

    #[test]
    fn every_study_is_linked_once() {
        assert_eq!(links_to(["b", "a_x", "b"]), "[`b`](studies/b.html), [`a_x`](studies/a_x.html)");
    }
}
