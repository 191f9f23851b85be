//! Where does it lock, where does it break? One row per situation, one column per method, the worst of all studies in
//! each, in words and colour.

use crate::judge::comparison::situation::{End, Ended, Situation, situations_of};
use crate::render::answers::regime::PAPERS;
use crate::render::answers::{Answer, Links, Question, link, short};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::labels::distinct;
use crate::render::report::situations;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use oedometer_soil::wording::count_of;

const QUESTION: Question = Question { heading: "Where does it lock, where does it break?", id: "breaks" };

/// Methods in the matrix.
const MOST_METHODS: usize = 8;

/// The matrix, with a link to the page of all situations.
pub(crate) fn answer(ends: &[Ended<'_>], links: Links<'_>) -> Answer {
    let methods = methods_shown(ends);
    if methods.len() < 2 {
        return QUESTION.open("several methods in the same situation, as in the `hard-…` studies");
    }
    let mut columns = columns("situation");
    columns.extend(methods.iter().map(|method| TableColumn::text(*method)));
    columns.push(TableColumn::number("studies"));
    let rows = situations_of(ends).into_iter().map(|situation| {
        let mut row: Vec<Cell> = vec![situation.name().into()];
        row.extend(methods.iter().map(|method| match worst(ends, situation, method) {
            None => Cell::Text("not tried".to_owned()),
            Some(one) => evidence(one, links),
        }));
        row.push(Cell::Count(studies_of(ends, situation) as u64));
        row
    });
    let table = Table::of("", columns, rows)
        .note(format!("the worst of all studies of a situation; {}", situations::legend()));
    let table = short(table, "on the page of all situations");
    QUESTION.told(
        format!("{} [Every study of every situation](situations.html).", sentence(ends, links)),
        vec![Block::Table(table)],
    )
}

/// A cell that leads to the study with the worst end.
fn evidence(one: &Ended<'_>, links: Links<'_>) -> Cell {
    let (mood, words) = situations::words_of(&one.end);
    Cell::Evidence { mood, words, target: links(&one.study.name) }
}

/// The results of the paper's method, or else of the first: where it holds, its largest error, where it fails.
fn sentence(ends: &[Ended<'_>], links: Links<'_>) -> String {
    let papers = ends.iter().map(|one| one.method.as_str()).find(|method| *method == PAPERS);
    let Some(method) = papers.or_else(|| ends.first().map(|one| one.method.as_str())) else {
        return String::new();
    };
    let own: Vec<&Ended<'_>> =
        situations_of(ends).into_iter().filter_map(|situation| worst(ends, situation, method)).collect();
    let holds = own.iter().filter(|one| situations::words_of(&one.end).0 == Mood::Pass).count();
    let place = |one: &Ended<'_>| format!("“{}” ({})", one.situation.name(), link(links, &one.study.name));
    let mut parts = vec![format!(
        "`{method}`{} was tried in {}; its worst error is below {} in {holds}",
        if papers.is_some() { ", the paper's method," } else { "" },
        count_of(own.len(), "situation", "situations"),
        number::percent(situations::TICK_BELOW)
    )];
    let errors = own.iter().filter(|one| matches!(one.end, End::Error(_)));
    let largest = errors.reduce(|a, b| if b.end.is_worse_than(&a.end) { b } else { a });
    if let Some(one) = largest.filter(|one| situations::words_of(&one.end).0 != Mood::Pass) {
        parts.push(format!("the largest is {} in {}", situations::words_of(&one.end).1, place(one)));
    }
    let failing: Vec<String> = own
        .iter()
        .filter(|one| !matches!(one.end, End::Error(_)))
        .map(|one| format!("{}: **{}**", place(one), situations::words_of(&one.end).1))
        .collect();
    parts.push(match failing.as_slice() {
        [] => "it gives a result in all of them".to_owned(),
        all => format!("it gives no usable result in {}", all.join(", ")),
    });
    parts.join("; ") + "."
}

/// The worst end of a method in a situation, over all studies.
fn worst<'b, 'a>(ends: &'b [Ended<'a>], situation: Situation, method: &str) -> Option<&'b Ended<'a>> {
    let own = ends.iter().filter(|one| (one.situation, one.method.as_str()) == (situation, method));
    own.reduce(|worst, next| if next.end.is_worse_than(&worst.end) { next } else { worst })
}

fn studies_of(ends: &[Ended<'_>], situation: Situation) -> usize {
    let own = ends.iter().filter(|one| one.situation == situation);
    distinct(own.map(|one| one.study.name.as_str())).len()
}

/// The paper's method, those that are best in some situation, and those that most situations tried.
fn methods_shown<'b>(ends: &'b [Ended<'_>]) -> Vec<&'b str> {
    let situations = situations_of(ends);
    let all = distinct(ends.iter().map(|one| one.method.as_str()));
    let worsts = |situation: Situation| {
        all.iter().filter_map(move |method| worst(ends, situation, method)).collect::<Vec<_>>()
    };
    let is_best = |method: &str| {
        situations.iter().any(|situation| {
            let tried = worsts(*situation);
            let best = tried.iter().copied().reduce(|a, b| if a.end.is_worse_than(&b.end) { b } else { a });
            tried.len() > 2 && best.is_some_and(|best| best.method == method)
        })
    };
    let tried = |method: &str| {
        situations.iter().filter(|situation| worst(ends, **situation, method).is_some()).count()
    };
    let mut ranked: Vec<(&str, (bool, bool, usize))> =
        all.iter().map(|method| (*method, (*method == PAPERS, is_best(method), tried(method)))).collect();
    // Stable: of equals the first that a study names.
    ranked.sort_by_key(|(_, worth)| std::cmp::Reverse(*worth));
    ranked.truncate(MOST_METHODS);
    ranked.into_iter().map(|(method, _)| method).collect()
}
