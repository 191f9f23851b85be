//! The answer page: what a reader asks of the records of all studies. Each question has a sentence from its template, a
//! short table or a figure, and a link to the study that shows it.
//!
//! Every number comes from the findings. A question that the records do not answer is not put.

pub(crate) mod race;

pub use race::matrix_page;

use crate::history::comparison::StudyComparison;
use crate::questions::answers::{ReportFindings, VerdictFinding};
use crate::questions::finding::{Finding, Place};
use crate::questions::sentence;
use crate::questions::study_findings::AllStudies;
use crate::record::provenance::Provenance;
use crate::render::RenderError;
use crate::render::page::{Block, Callout, Page, Section};
use crate::render::table::{Mood, Table};
use crate::report::blocks::answers as study_answers;
use crate::report::history_tables::comparison_tables;
use crate::report::sections::{links_to, section};
use oedometer_soil::wording::count_of;
use serde::Serialize;

/// What the answer page is made of.
pub struct Answers<'a> {
    /// The studies with what is found about each.
    pub all: &'a AllStudies,
    /// The studies that differ from their golden values; `None` where none has any.
    pub changes: Option<&'a [StudyComparison]>,
    /// When, where and by which command.
    pub making: &'a Making,
    /// What the records answer.
    pub findings: &'a ReportFindings,
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
    fn words(&self, all: &AllStudies) -> String {
        let records = all.records;
        let program = all.origins.main().map_or_else(String::new, program_of);
        let several = all.origins.several_programs().map_or_else(String::new, |programs| {
            format!(" The records are of more than one program: {programs}.")
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
fn program_of(origin: &Provenance) -> String {
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

/// A question of the reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Question {
    heading: &'static str,
    /// Anchor of its section.
    id: &'static str,
}

impl Question {
    /// The answer: a sentence with links to the studies that show it, then what is shown.
    fn answered<'s>(
        self,
        sentence: &str,
        studies: impl IntoIterator<Item = &'s str>,
        mut shown: Vec<Block>,
    ) -> Section {
        let links = links_to(studies);
        let evidence = if links.is_empty() { String::new() } else { format!(" Evidence: {links}.") };
        shown.insert(0, Block::Paragraph(sentence.to_owned() + &evidence));
        Section::new(self.heading, self.id, shown)
    }
}

/// Rows of a table on the answer page.
const MOST_ROWS: usize = 10;

/// The first rows of a table, with a line on where the others are.
fn short(mut table: Table, elsewhere: &str) -> Table {
    let more = table.rows.len().saturating_sub(MOST_ROWS);
    table.rows.truncate(MOST_ROWS);
    if more > 0 { table.note(format!("{more} more: {elsewhere}")) } else { table }
}

/// The answer to a question.
fn found<'f>(findings: &'f ReportFindings, question: &str) -> Option<&'f Finding> {
    findings.findings.iter().find(|finding| finding.question.id == question)
}

/// The answer page.
///
/// # Errors
/// When a reference refuses a case, or a template its findings.
pub fn answer_page(answers: &Answers<'_>) -> Result<Page, RenderError> {
    let (studies, findings) = (&answers.all.studies, answers.findings);
    let race = findings.race.as_ref().filter(|race| !race.situations.is_empty());
    let all = [
        race.map(|race| race::section(race, findings)).transpose()?,
        found(findings, "cost").map(|finding| section(finding, Place::Report)).transpose()?,
        found(findings, "peers").map(|finding| section(finding, Place::Report)).transpose()?,
        found(findings, "paper").map(|finding| section(finding, Place::Report)).transpose()?,
        answers.changes.map(changes_section).transpose()?,
        found(findings, "locking").map(|finding| section(finding, Place::Report)).transpose()?,
        found(findings, "convergence").map(|finding| section(finding, Place::Report)).transpose()?,
        found(findings, "time-step").map(|finding| section(finding, Place::Report)).transpose()?,
        found(findings, "audit").map(|finding| section(finding, Place::Report)).transpose()?,
        found(findings, "point-sets").map(|finding| section(finding, Place::Report)).transpose()?,
    ];
    let mut sections: Vec<Section> = all.into_iter().flatten().collect();
    // A small report names its studies, as perhaps no answer links to them.
    let few = match studies.len() {
        1..=FEW_STUDIES => format!(": {}", links_to(studies.iter().map(|study| study.name.as_str()))),
        _ => String::new(),
    };
    let made = format!(
        "**How was it made?** {}\n\n[All studies](studies/index.html){few}",
        answers.making.words(answers.all)
    );
    let verdict = verdict(&findings.verdict)?;
    let mut page = Page { title: "Convergence report".to_owned(), is_wide: true, ..Page::default() };
    // With a race its sentences stand first, and how it was made at the end.
    if let Some(race) = race {
        [page.title, page.lead] = race::headline(race)?;
        page.footer = made;
        sections.push(Section {
            heading: "Is everything as expected?".to_owned(),
            id: "expected".to_owned(),
            mood: Some(verdict.0),
            blocks: vec![Block::Paragraph(verdict.1)],
        });
        page.links = race::front_links(&sections, studies.len());
    } else {
        (page.lead, page.callout) = (made, Some(verdict));
        // What a report of one study is about.
        if let [study] = studies.as_slice() {
            page.lead = study_answers::lead(study)? + &page.lead;
        }
    }
    page.sections = sections;
    Ok(page)
}

/// Studies up to which the head of the page names each.
const FEW_STUDIES: usize = 6;

/// Whether everything is as expected, in one sentence that names what is not.
fn verdict(verdict: &VerdictFinding) -> Result<Callout, RenderError> {
    let passes = verdict.failing.is_empty();
    let mood = if verdict.expectations == 0 && passes { Mood::Note } else { Mood::of(passes) };
    Ok((mood, sentence::sentence("verdict", verdict)?))
}

/// How many studies changed.
#[derive(Serialize)]
struct Changes {
    changed: usize,
    worse: usize,
}

/// The studies that differ, as `oedometer compare` shows them.
fn changes_section(changes: &[StudyComparison]) -> Result<Section, RenderError> {
    let question = Question { heading: "What changed?", id: "changes" };
    let worse = changes.iter().filter(|one| one.is_regression()).count();
    let sentence = sentence::sentence("changes", &Changes { changed: changes.len(), worse })?;
    let tables = comparison_tables(changes, ["the golden values", "this report"]);
    let tables = if changes.is_empty() { Vec::new() } else { tables };
    let block = |table| Block::Table(short(table, "listed by `oedometer compare` and `oedometer check`"));
    Ok(question.answered(&sentence, [], tables.into_iter().map(block).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;
    use crate::golden::GoldenFile;
    use crate::history::state::StudyState;
    use crate::judge::study_check::CaseNote;
    use crate::questions::study_results::StudyResults;
    use crate::record::Record;
    use crate::render::table::{Cell, columns};
    use crate::study::check::Study;

    #[test]
    fn a_report_from_records_alone_says_so() {
        let none = AllStudies::new(&[]).expect("no case");
        let making = Making { seconds: 1.25, command: "oedometer report".to_owned(), ..Making::default() };
        assert!(making.words(&none).contains("rendered in 1.2 s from 0 records"), "{}", making.words(&none));
        let run = Making { cases_run: 3, ..making };
        assert!(run.words(&none).contains("with 3 of 0 cases run"));
    }

    #[test]
    fn a_table_of_the_answers_ends_after_ten_rows_and_says_where_the_others_are() {
        let table =
            |rows: usize| Table::of("", columns("a"), (0..rows).map(|row| vec![Cell::Count(row as u64)]));
        let cut = short(table(12), "in the studies");
        assert_eq!((cut.rows.len(), cut.notes.as_slice()), (10, &["2 more: in the studies".to_owned()][..]));
        assert_eq!(short(table(10), "in the studies"), table(10));
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
        assert_eq!(told, "Against the golden values 2 studies changed, of which 1 got worse.");
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
    fn the_head_of_the_page_counts_what_is_met_and_names_what_is_not_and_few_studies() {
        let (met, unmet, bare) =
            (study("met", &[0.9, 0.8]), study("unmet", &[0.9, 1e-9]), study("bare", &[]));
        let of = |all: &[(&(Study, Vec<Record>), usize)]| {
            let results = |((study, records), wrong): &(&'_ (Study, Vec<Record>), usize)| {
                let mut one = StudyResults::new(study, records, Tier::Full);
                let (case, sentence) = ("a case".to_owned(), "why".to_owned());
                one.check.unsound = vec![CaseNote { case, sentence }; *wrong];
                let findings = ReportFindings::new(&[one]).expect("sound cases");
                let (mood, text) = verdict(&findings.verdict).expect("a verdict");
                format!("{mood:?} {text}")
            };
            all.iter().map(results).collect::<Vec<_>>()
        };
        assert_eq!(
            of(&[(&met, 0), (&unmet, 0), (&met, 2), (&bare, 0), (&bare, 1)]),
            [
                "Pass **2 of 2 expectations met** in 1 study of 1 run.",
                "Fail **1 of 2 expectations met** in 1 study of 1 run. Not as expected: `unmet`.",
                "Fail **2 of 2 expectations met** in 1 study of 1 run. 2 checks of runs fail. Not as expected: `met`.",
                "Note **No expectations** in 1 study of 1 run.",
                "Fail **No expectations** in 1 study of 1 run. 1 check of runs fails. Not as expected: `bare`.",
            ]
        );
        let all: Vec<_> = ["a", "b", "c", "d", "e", "f", "g"].map(|name| study(name, &[])).into();
        for (count, links, setting) in [(1, 1, true), (2, 2, false), (6, 6, false), (7, 0, false)] {
            let results: Vec<_> = all[..count]
                .iter()
                .map(|(study, records)| StudyResults::new(study, records, Tier::Full))
                .collect();
            let making = Making::default();
            let findings = ReportFindings::new(&results).expect("sound cases");
            let all = AllStudies::new(&results).expect("sound cases");
            let answers = Answers { all: &all, changes: None, making: &making, findings: &findings };
            let page = answer_page(&answers);
            let lead = page.expect("a page").lead;
            let (head, listed) = lead.split_once("(studies/index.html)").expect("a link to all");
            assert_eq!(listed.matches("](studies/").count(), links, "{lead}");
            assert_eq!(head.starts_with("*H* = 1 m"), setting, "what one study is about: {lead}");
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
            making.words(&AllStudies::new(&results).expect("sound cases"))
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
                " The records are of more than one program: 1 of version 1 and sources abc, 2 of version 2 and sources abc."
            ),
            "{several}"
        );
    }

    #[test]
    fn every_study_is_linked_once() {
        let question = Question { heading: "What changed?", id: "changes" };
        let section = question.answered("So it is.", ["b", "a_x", "b"], vec![Block::Code("c".to_owned())]);
        let text = "So it is. Evidence: [`b`](studies/b.html), [`a_x`](studies/a_x.html).".to_owned();
        let blocks = vec![Block::Paragraph(text), Block::Code("c".to_owned())];
        assert_eq!(section, Section::new("What changed?", "changes", blocks));
    }
}
