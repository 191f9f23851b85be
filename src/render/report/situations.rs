//! The page of all situations: every study and every method of each.

use crate::judge::comparison::situation::{End, Ended, situations_of};
use crate::render::number;
use crate::render::page::{Block, Page, Section, slug};
use crate::render::report::labels::{capitalised, distinct};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};

/// Errors below this have a tick.
pub const TICK_BELOW: f64 = 0.01;

/// The judgement of an end, and its words.
pub fn words_of(end: &End) -> (Mood, String) {
    match end {
        End::Error(error) if *error < TICK_BELOW => (Mood::Pass, number::percent(*error)),
        End::Error(error) if *error < 1.0 => (Mood::Note, number::percent(*error)),
        End::Error(error) => (Mood::Fail, format!("{} off", number::percent(*error))),
        End::Oscillates(times) => (Mood::Fail, format!("oscillates, {times:.0} times the variation")),
        End::Locked => (Mood::Fail, "locked".to_owned()),
        End::Failed { name, failed, of } if failed == of => (Mood::Fail, (*name).to_owned()),
        End::Failed { name, failed, of } => (Mood::Fail, format!("{name} in {failed} of {of} runs")),
    }
}

/// The legend of the cells.
pub fn legend() -> String {
    format!(
        "{} error below {}; {} a larger error; {} no answer: the failure by its name, a body that locks (moves less than \
         half of what it should) or a pressure that oscillates. The error is that of the pressure at the points at the last \
         output, on the finest mesh of a study and with the best of its time steps; of the undrained layer the error of \
         what the row names",
        Mood::Pass.mark(),
        number::percent(TICK_BELOW),
        Mood::Note.mark(),
        Mood::Fail.mark()
    )
}

/// The page of all situations.
pub fn situations_page(ends: &[Ended<'_>]) -> Page {
    let sections = situations_of(ends).into_iter().map(|situation| {
        let own: Vec<&Ended<'_>> = ends.iter().filter(|one| one.situation == situation).collect();
        Section {
            heading: situation.name().to_owned(),
            id: slug(situation.name()),
            mood: None,
            blocks: vec![
                Block::Paragraph(format!("{}.", capitalised(situation.meaning()))),
                Block::Table(table_of(&own)),
            ],
        }
    });
    Page {
        title: "All situations".to_owned(),
        lead: format!(
            "The result of each method in each study, by situation: {}. [The answers](index.html).\n\nA study may expect a \
             run to fail: its page has the expectations.",
            legend()
        ),
        sections: sections.collect(),
        is_wide: true,
        filter: Some("Words that a row has".to_owned()),
        files: Some("situations".to_owned()),
        ..Page::default()
    }
}

/// One row a study, one column a method that some study of the situation tried.
fn table_of(own: &[&Ended<'_>]) -> Table {
    let methods = distinct(own.iter().map(|one| one.method.as_str()));
    let studies = distinct(own.iter().map(|one| one.study.name.as_str()));
    let mut columns = columns("study");
    columns.extend(methods.iter().map(|method| TableColumn::text(*method)));
    let rows = studies.into_iter().map(|study| {
        let of_study: Vec<&&Ended<'_>> = own.iter().filter(|one| one.study.name == study).collect();
        let title = of_study.first().map_or("", |one| one.study.title.as_str());
        let mut row =
            vec![Cell::Link { words: title.to_owned(), target: format!("studies/{}.html", slug(study)) }];
        row.extend(methods.iter().map(|method| {
            let end = of_study.iter().find(|one| one.method == *method).map(|one| words_of(&one.end));
            end.map_or(Cell::Text("not tried".to_owned()), |(mood, words)| Cell::Verdict(mood, words))
        }));
        row
    });
    Table::of("", columns, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_stands_below_a_percent_only_and_no_number_is_no_tick() {
        let mood = |error: f64| words_of(&End::Error(error)).0;
        assert_eq!([0.0099, 0.01, 1.0, f64::NAN].map(mood), [Mood::Pass, Mood::Note, Mood::Fail, Mood::Fail]);
        let failed = End::Failed { name: "unstable", failed: 1, of: 2 };
        assert_eq!(words_of(&failed), (Mood::Fail, "unstable in 1 of 2 runs".to_owned()));
    }
}
