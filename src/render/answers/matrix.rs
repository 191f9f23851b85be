//! Where does it lock, where does it break? Methods × situations, in words and colour.

use crate::case::Task;
use crate::case::quantity::{Quantity, Sample};
use crate::convergence::class::Class;
use crate::exact::exact_error::ExactError;
use crate::judge::locking::standings;
use crate::record::{Record, Status};
use crate::render::answers::question::{Links, link_cell, section, unanswered};
use crate::render::answers::regime::PAPERS;
use crate::render::number;
use crate::render::page::{Block, Section};
use crate::render::report::StudyResults;
use crate::render::report::labels::first_measure;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};

const HEADING: &str = "Where does it lock, where does it break?";

/// A tick stands at errors below this only.
const TICK_BELOW: f64 = 0.01;

/// Methods that the matrix has: those that most situations tried.
const MOST_METHODS: usize = 10;

const UNTRIED: &str = "not tried";

/// A row of the matrix: what was hard, and how each method that was tried came out.
struct Situation<'a> {
    name: String,
    study: &'a str,
    ends: Vec<(String, Cell)>,
}

/// The matrix, and how to read it.
pub fn answer(results: &[StudyResults<'_>], links: Links<'_>) -> Result<Section, ExactError> {
    let mut situations = Vec::new();
    for one in results {
        if one.study.scene.shows_locking() {
            situations.extend(of_layer(one)?);
        } else if is_hard(one) || is_of_several_methods(one) {
            situations.extend(of_study(one));
        }
    }
    let methods = methods_of_most(&situations);
    if methods.len() < 2 {
        return Ok(unanswered(
            HEADING,
            "breaks",
            "several methods in the same hard case, as in the `hard-…` studies",
        ));
    }
    let mut columns = columns("situation");
    columns.extend(methods.iter().map(|method| TableColumn::text(method.clone())));
    columns.push(TableColumn::text("study"));
    let tried =
        |situation: &&Situation<'_>| situation.ends.iter().any(|(method, _)| methods.contains(method));
    let rows = situations.iter().filter(tried).map(|situation| {
        let mut row: Vec<Cell> = vec![situation.name.as_str().into()];
        row.extend(methods.iter().map(|method| {
            let end = situation.ends.iter().find(|(name, _)| name == method);
            end.map_or(Cell::Text(UNTRIED.to_owned()), |(_, cell)| cell.clone())
        }));
        row.push(link_cell(links, situation.study));
        row
    });
    let table = Table::of("", columns, rows).note(format!(
        "{} below {}: the largest error of the pressure at the points at the last output, over the runs of the study on its \
         finest mesh (the layer: of the displacement at its undrained start); {} the error where it is larger; {} the name of \
         a failure, and in how many of the runs, or a body that locks",
        Mood::Pass.mark(),
        number::percent(TICK_BELOW),
        Mood::Note.mark(),
        Mood::Fail.mark()
    ));
    let lead = format!(
        "{} {}",
        worst_sentence(&situations),
        "A study may mean a run to fail: what it expects stands on its page."
    );
    Ok(section(HEADING, "breaks", vec![Block::Paragraph(lead), Block::Table(table)]))
}

/// In how many situations the paper's method was tried, and where it does not hold.
fn worst_sentence(situations: &[Situation<'_>]) -> String {
    let of_papers: Vec<(&str, &Cell)> = situations
        .iter()
        .filter_map(|one| Some((one.name.as_str(), &one.ends.iter().find(|(method, _)| method == PAPERS)?.1)))
        .collect();
    if of_papers.is_empty() {
        return format!("`{PAPERS}` was not tried here.");
    }
    let failing: Vec<String> = of_papers
        .iter()
        .filter_map(|(name, cell)| match cell {
            Cell::Verdict(Mood::Fail, word) => Some(format!("{name} ({word})")),
            _ => None,
        })
        .collect();
    let held = of_papers.iter().filter(|(_, cell)| matches!(cell, Cell::Verdict(Mood::Pass, _))).count();
    let fails = if failing.is_empty() {
        "it fails in none".to_owned()
    } else {
        format!("it fails in: {}", failing.join("; "))
    };
    format!(
        "`{PAPERS}`, the paper's method, was tried in {} situations and is within {} in {held}; {fails}.",
        of_papers.len(),
        number::percent(TICK_BELOW)
    )
}

fn is_hard(one: &StudyResults<'_>) -> bool {
    one.study.case_expectations.iter().any(|expectation| expectation.demand.status.is_some())
}

/// Whether a study holds three methods or more against each other.
fn is_of_several_methods(one: &StudyResults<'_>) -> bool {
    methods_in(one.records).len() > 2
}

fn methods_in(records: &[Record]) -> Vec<String> {
    let mut seen: Vec<String> = Vec::new();
    for record in records.iter().filter(|record| record.case.task == Task::Solve) {
        let method = record.case.method.to_string();
        if !seen.contains(&method) {
            seen.push(method);
        }
    }
    seen
}

/// How each method of a study came out: the failures by name, or the largest error on its finest mesh.
fn of_study<'a>(one: &'a StudyResults<'a>) -> Option<Situation<'a>> {
    let reference = one.study.references.first()?.name();
    let ends: Vec<(String, Cell)> = methods_in(one.records)
        .into_iter()
        .filter_map(|method| {
            let own: Vec<&Record> =
                one.records.iter().filter(|record| record.case.method.to_string() == method).collect();
            Some((method, end_of(&own, reference)?))
        })
        .collect();
    (!ends.is_empty()).then(|| Situation { name: one.study.title.clone(), study: &one.study.name, ends })
}

fn end_of(records: &[&Record], reference: &str) -> Option<Cell> {
    let failed: Vec<&str> = records
        .iter()
        .filter_map(|record| record.status.failure().map(|failure| failure.kind.name()))
        .collect();
    if let Some(first) = failed.first() {
        let word = if failed.len() == records.len() {
            (*first).to_owned()
        } else {
            format!("{first} in {} of {}", failed.len(), records.len())
        };
        return Some(Cell::Verdict(Mood::Fail, word));
    }
    let finest = records.iter().map(|record| record.case.cells).max()?;
    let on_finest =
        records.iter().filter(|record| record.case.cells == finest && record.status == Status::Ok);
    let errors = on_finest.filter_map(|record| {
        let time = *record.case.time_factors.last()?;
        let measure = first_measure(Quantity::Pressure, Sample::Points, reference, time);
        Some(measure.error(record)?.value.abs())
    });
    errors.reduce(f64::max).map(judged)
}

/// An error with a tick where it is small enough, and none where it is not.
fn judged(error: f64) -> Cell {
    let text = number::percent(error);
    match error {
        error if error < TICK_BELOW => Cell::Verdict(Mood::Pass, text),
        error if error < 1.0 => Cell::Verdict(Mood::Note, text),
        _ => Cell::Verdict(Mood::Fail, format!("{text} off")),
    }
}

/// A layer at its undrained start, with the usual soil and with one that hardly compresses.
fn of_layer<'a>(one: &'a StudyResults<'a>) -> Result<Vec<Situation<'a>>, ExactError> {
    let standings = standings(one.study, one.records)?;
    let locked = || Cell::Verdict(Mood::Fail, Class::Locked.name().to_owned());
    let usual: Vec<(String, Cell)> = standings
        .iter()
        .filter_map(|standing| {
            let cell =
                if standing.class == Some(Class::Locked) { locked() } else { judged(standing.displacement?) };
            Some((standing.method.to_string(), cell))
        })
        .collect();
    let stiff: Vec<(String, Cell)> = standings
        .iter()
        .filter_map(|standing| {
            let error = standing.stiff_skeleton?;
            // Less than half of the displacement is what the class `locked` means.
            let cell = if error > 0.5 { locked() } else { judged(error) };
            Some((standing.method.to_string(), cell))
        })
        .collect();
    let name = |what: &str| format!("{}: {what}", one.study.title);
    let rows = [(name("undrained start"), usual), (name("undrained start at the largest ν"), stiff)];
    let rows = rows.into_iter().filter(|(_, ends)| !ends.is_empty());
    Ok(rows.map(|(name, ends)| Situation { name, study: &one.study.name, ends }).collect())
}

/// The methods that most situations tried, the paper's first.
fn methods_of_most(situations: &[Situation<'_>]) -> Vec<String> {
    let mut known: Vec<(String, usize)> = Vec::new();
    for (method, _) in situations.iter().flat_map(|one| &one.ends) {
        match known.iter_mut().find(|(name, _)| name == method) {
            Some((_, count)) => *count += 1,
            None => known.push((method.clone(), 1)),
        }
    }
    known.sort_by_key(|(name, count)| (name != PAPERS, std::cmp::Reverse(*count)));
    known.truncate(MOST_METHODS);
    known.into_iter().map(|(name, _)| name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_stands_below_a_percent_only_and_no_number_is_no_tick() {
        assert!(matches!(judged(0.0099), Cell::Verdict(Mood::Pass, _)));
        assert!(matches!(judged(0.01), Cell::Verdict(Mood::Note, _)));
        assert!(matches!(judged(1.0), Cell::Verdict(Mood::Fail, _)));
        assert!(matches!(judged(f64::NAN), Cell::Verdict(Mood::Fail, _)));
    }
}
