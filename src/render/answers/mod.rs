//! The answer page: what a reader asks of the records of all studies. Each question has a sentence, a short table or a
//! figure, and a link to the study that shows it.
//!
//! Every sentence is made from records. A question that the records do not answer is not put.

mod audit;
mod converges;
mod cost;
mod double_point;
mod locking;
pub(crate) mod paper;
mod race;
mod soil;
mod time_step;

use crate::history::comparison::StudyComparison;
use crate::judge::race::RaceRow;
use crate::record::provenance::{Origins, Provenance};
use crate::render::history_tables::comparison_tables;
use crate::render::page::{Block, Callout, Page, Section, slug};
use crate::render::report::labels::distinct;
use crate::render::report::{StudyResults, setting};
use crate::render::table::{Mood, Table};
use oedometer_exact::exact_error::ExactError;
use oedometer_soil::wording::count_of;
use std::fmt::Write;

/// What the answer page is made of.
pub struct Answers<'a> {
    /// The studies with their records and judgements.
    pub results: &'a [StudyResults<'a>],
    /// The studies that differ from their golden values; `None` where none has any.
    pub changes: Option<&'a [StudyComparison]>,
    /// When, where and by which command.
    pub making: &'a Making,
    /// Every contender in every situation of the race.
    pub race: &'a [RaceRow<'a>],
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
    fn words(&self, results: &[StudyResults<'_>]) -> String {
        let mut origins = Origins::default();
        let records: Vec<_> = results.iter().flat_map(|one| one.records).collect();
        for record in &records {
            origins.add(&record.provenance);
        }
        let program = origins.main().map_or_else(String::new, program_of);
        let several = origins.several_programs().map_or_else(String::new, |programs| {
            format!(" The records are of more than one program: {programs}.")
        });
        let run = match self.cases_run {
            0 => format!("rendered in {:.1} s from {} records", self.seconds, records.len()),
            run => format!("{:.1} s with {run} of {} cases run", self.seconds, records.len()),
        };
        let left_out = match self.left_out {
            0 => String::new(),
            cases => format!(
                " {} of the full tier not run; `oedometer report --tier full` runs {}.",
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

/// The page of a study, from the answer page.
fn page_of(study: &str) -> String {
    format!("studies/{}.html", slug(study))
}

/// A question of the reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Question {
    heading: &'static str,
    /// Anchor of its section.
    id: &'static str,
}

/// The answer of the records to a question: a section, a sentence first, then a short table or figures. `None` where they
/// have none: what was not asked is not answered.
pub(crate) type Answer = Option<Section>;

impl Question {
    /// The answer: a sentence with links to the studies that show it, then what is shown.
    fn told<'s>(
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

/// The study that has most of what answers a question, the first of equals. The race has an answer of its own.
fn study_with_most<'a, T, W: PartialOrd>(
    results: &'a [StudyResults<'a>],
    found: impl Fn(&'a StudyResults<'a>) -> Option<(W, T)>,
) -> Option<(&'a StudyResults<'a>, T)> {
    let studies = results.iter().filter(|one| !one.study.is_race);
    let all = studies.filter_map(|one| found(one).map(|(worth, found)| (worth, (one, found))));
    all.reduce(|most, next| if next.0 > most.0 { next } else { most }).map(|(_, found)| found)
}

/// Links to the pages of studies, each once, in running text.
fn links_to<'a>(studies: impl IntoIterator<Item = &'a str>) -> String {
    let links = distinct(studies).into_iter().map(|study| format!("[`{study}`]({})", page_of(study)));
    links.collect::<Vec<_>>().join(", ")
}

/// The answer page.
///
/// # Errors
/// When a reference refuses a case.
pub fn answer_page(answers: &Answers<'_>) -> Result<Page, ExactError> {
    let results = answers.results;
    let all = [
        race::answer(answers.race),
        locking::answer(results)?,
        converges::answer(results),
        paper::answer(results)?,
        time_step::answer(results),
        soil::answer(results),
        cost::answer(results),
        audit::answer(results),
        double_point::answer(results),
        what_changed(answers.changes),
    ];
    let sections = all.into_iter().flatten().collect();
    // A small report names its studies, as perhaps no answer links to them.
    let few = match results.len() {
        1..=FEW_STUDIES => format!(": {}", links_to(results.iter().map(|one| one.study.name.as_str()))),
        _ => String::new(),
    };
    let setting = match results {
        [one] => setting::sentence(one.records).map_or(String::new(), |sentence| sentence + "\n\n"),
        _ => String::new(),
    };
    let made = answers.making.words(results);
    Ok(Page {
        title: "Convergence report".to_owned(),
        lead: format!(
            "{setting}**How was it made?** {made}\n\n[All studies, with every table and figure](studies/index.html){few}"
        ),
        callout: Some(verdict(results)),
        sections,
        is_wide: true,
        ..Page::default()
    })
}

/// Studies up to which the head of the page names each.
const FEW_STUDIES: usize = 6;

/// Whether everything is as expected, in one sentence that names what is not.
fn verdict(results: &[StudyResults<'_>]) -> Callout {
    let sum = |of: fn(&StudyResults<'_>) -> usize| results.iter().map(of).sum::<usize>();
    let judged = sum(|one| one.judgements.len());
    let unsound = sum(|one| one.unsound.len());
    let failing: Vec<&str> =
        results.iter().filter(|one| !one.passes()).map(|one| one.study.name.as_str()).collect();
    let met = match judged {
        0 => "No expectations".to_owned(),
        _ => format!("{} of {judged} expectations met", results.iter().map(StudyResults::met).sum::<usize>()),
    };
    let (studies, runs) = (count_of(results.len(), "study", "studies"), sum(|one| one.records.len()));
    let mut text = format!("**{met}** in {studies} of {runs} runs.");
    if unsound > 0 {
        let _ = write!(text, " {unsound} checks of runs fail.");
    }
    if !failing.is_empty() {
        let _ = write!(text, " Not as expected: `{}`.", failing.join("`, `"));
    }
    let mood = if judged == 0 && failing.is_empty() { Mood::Note } else { Mood::of(failing.is_empty()) };
    (mood, text)
}

const CHANGES: Question = Question { heading: "What changed?", id: "changes" };

/// The studies that differ, as `oedometer compare` shows them.
fn what_changed(changes: Option<&[StudyComparison]>) -> Answer {
    let changes = changes?;
    if changes.is_empty() {
        let text = "Nothing: every value that these studies share with the golden values agrees within its tolerance.";
        return Some(CHANGES.told(text, [], Vec::new()));
    }
    let worse = changes.iter().filter(|one| one.is_regression()).count();
    let sentence = format!(
        "Against the golden values {} changed, of which {worse} got worse.",
        count_of(changes.len(), "study", "studies")
    );
    let tables = comparison_tables(changes, ["the golden values", "this report"]);
    let block = |table| Block::Table(short(table, "listed by `oedometer compare` and `oedometer check`"));
    Some(CHANGES.told(&sentence, [], tables.into_iter().map(block).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::history::state::StudyState;
    use crate::render::table::{Cell, columns};

    #[test]
    fn a_report_from_records_alone_says_so() {
        let making = Making { seconds: 1.25, command: "oedometer report".to_owned(), ..Making::default() };
        assert!(making.words(&[]).contains("rendered in 1.2 s from 0 records"), "{}", making.words(&[]));
        let run = Making { cases_run: 3, ..making };
        assert!(run.words(&[]).contains("with 3 of 0 cases run"));
    }

    #[test]
    fn nothing_expected_is_neither_met_nor_failed() {
        let (mood, text) = verdict(&[]);
        assert_eq!((mood, text.as_str()), (Mood::Note, "**No expectations** in 0 studies of 0 runs."));
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
            let values = [("GIMP cells=4 | pressure T_v=1".to_owned(), error)].into();
            StudyState::of_golden(GoldenFile { values, ..GoldenFile::of("s", &[], "-") })
        };
        let changes = [("worse", 0.3), ("better", 0.1)]
            .map(|(name, error)| StudyComparison::of(name, &state(0.2), &state(error)));
        let Some(section) = what_changed(Some(&changes)) else { panic!("they differ") };
        let told = format!("{section:?}");
        assert!(told.contains("Against the golden values 2 studies changed, of which 1 got worse"), "{told}");
        assert!(told.contains("regressed") && told.contains("improved"), "{told}");
        assert!(format!("{:?}", what_changed(Some(&[]))).contains("Nothing"));
        assert!(what_changed(None).is_none());
    }
}
