//! Which method should I take? The answers of the race with where they hold, and the problems one by one.

use crate::case::contender::PAPERS;
use crate::race::RaceFindings;
use crate::race::answer::Answer;
use crate::race::finish::{Reason, Terms};
use crate::race::group::Group;
use crate::race::situation::{Entry, Situation};
use crate::record::race_errors::ReadOut;
use crate::render::chart::{Chart, ChartAxis, Naming, Series, Size, Style, slots};
use crate::render::number;
use crate::render::page::Figure;
use crate::render::table::{Cell, Table, columns};
use serde::Serialize;

/// The method of the program's recommendation before the race, the paper's, the plainest, and one whose mesh follows.
pub const SHOWN: [&str; 4] = ["GC-Bbar-patch", PAPERS, "MPM", "TL-GC-SRI-patch"];
/// The largest multiple of the least cost that figures show.
pub const LARGEST_TAU: f64 = 100.0;
/// Where a method stands that does not reach the tolerance.
const NEVER: f64 = 200.0;

/// Words for a group.
pub fn words_of(group: Group) -> &'static str {
    match group {
        Group::Moving => "points that move through the mesh",
        Group::Rest => "points at rest",
        Group::Total => "a mesh that follows the soil",
    }
}

/// Where fields are read, in words.
pub fn places_of(read_out: ReadOut) -> &'static str {
    match read_out {
        ReadOut::Points => "at the points",
        ReadOut::Centres => "as means of cells",
    }
}

/// What is said of a group: one sentence where it holds wherever one looks, else one per read-out.
#[derive(Serialize)]
pub struct GroupAnswer<'a> {
    group: Group,
    words: &'static str,
    /// The method that holds wherever one looks.
    method: Option<&'a str>,
    reads: Vec<ReadAnswer<'a>>,
}

#[derive(Serialize)]
struct ReadAnswer<'a> {
    places: &'static str,
    /// The best and those that tie with it.
    methods: Vec<&'a str>,
    first: &'a Answer,
    /// What it changes with.
    changes_with: Vec<&'static str>,
}

fn group_answers(findings: &RaceFindings) -> Vec<GroupAnswer<'_>> {
    let read = |group: Group, read_out: ReadOut| {
        let answers: Vec<&Answer> =
            findings.answers.iter().filter(|one| (one.group, one.read_out) == (group, read_out)).collect();
        let first = *answers.first()?;
        let holds = first.holds;
        let all = [
            (holds.time, "the output"),
            (holds.budget, "the budget"),
            (holds.tolerance, "the tolerance"),
            (holds.read_out, "the read-out"),
        ];
        Some(ReadAnswer {
            places: places_of(read_out),
            methods: answers.iter().map(|one| one.method.as_str()).collect(),
            first,
            changes_with: all.into_iter().filter(|(holds, _)| !holds).map(|(_, what)| what).collect(),
        })
    };
    let of_group = |group: Group| {
        let reads: Vec<ReadAnswer<'_>> =
            ReadOut::BOTH.into_iter().filter_map(|read_out| read(group, read_out)).collect();
        let own = findings.answers.iter().filter(|one| one.group == group && one.holds.everywhere());
        let methods: Vec<(ReadOut, &str)> = own.map(|one| (one.read_out, one.method.as_str())).collect();
        let both = |method: &str| ReadOut::BOTH.iter().all(|read_out| methods.contains(&(*read_out, method)));
        let method = methods.iter().map(|(_, method)| *method).find(|method| both(method));
        (!reads.is_empty()).then(|| GroupAnswer { group, words: words_of(group), method, reads })
    };
    Group::EACH.into_iter().filter_map(of_group).collect()
}

/// Every number and name of the sentence.
#[derive(Serialize)]
pub struct Facts<'a> {
    /// What is said of each group.
    groups: Vec<GroupAnswer<'a>>,
}

/// What the sentence says.
pub fn facts(findings: &RaceFindings) -> Facts<'_> {
    Facts { groups: group_answers(findings) }
}

/// A reason with what was measured.
pub fn reason_words(reason: Reason) -> String {
    match reason {
        Reason::Budget(order) => format!("budget (order {})", number::fixed(order, 1)),
        Reason::Plateau(height) => format!("plateau ({})", number::percent(height)),
        other => other.word().to_owned(),
    }
}

/// The methods that may run in a problem and the least cost of all that reach the tolerance.
pub fn cheapest<'a>(
    situation: &'a Situation,
    terms: &Terms,
    takes: impl Fn(&str) -> bool,
) -> Option<(&'a Entry, f64)> {
    let costs = situation.entries.iter().filter(|entry| takes(&entry.contender));
    let costs = costs.filter_map(|entry| Some((entry, situation.arrival(entry, terms)?.cost)));
    costs.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// A row per problem: cost to 1 % over the cheapest of all methods.
pub fn dot_plot(findings: &RaceFindings, read_out: ReadOut) -> Figure {
    let terms = Terms::usual(read_out);
    let rows = || findings.situations.iter().enumerate().map(|(place, one)| (-(place as f64), one));
    let last = 1.0 - findings.situations.len() as f64;
    let mut chart = Chart::new(
        "Cost to 1 % over that of the cheapest method: no method is the cheapest everywhere",
        ChartAxis::log10("multiple of the least work; at the right end: 1 % is not reached")
            .between(0.8, 1.3 * NEVER)
            .with_labelled_ticks(
                [1.0, 2.0, 5.0, 10.0, 100.0]
                    .map(|tau| (tau, number::short(tau)))
                    .into_iter()
                    .chain([(NEVER, "never".to_owned())]),
            ),
        ChartAxis::linear("")
            .between(last - 0.7, 0.7)
            .with_labelled_ticks(rows().map(|(y, one)| (y, one.title.clone()))),
    );
    chart.size =
        Size { width: 960.0, plot_height: 20.0 * findings.situations.len() as f64, equal_units: false };
    chart.naming = Naming::Legend;
    for (name, slot) in SHOWN.into_iter().zip(slots(&SHOWN)) {
        let points = rows().filter_map(|(y, situation)| {
            let entry = situation.entry(name)?;
            let least = cheapest(situation, &terms, |_| true).map(|(_, cost)| cost);
            let ratio = situation.arrival(entry, &terms).zip(least).map(|(one, least)| one.cost / least);
            Some((ratio.map_or(NEVER, |ratio| ratio.min(LARGEST_TAU)), y))
        });
        chart.series.push(Series::new(name, points.collect()).style(Style::Markers).slot(slot));
    }
    Figure::new(format!("race-problems-{}", read_out.name()), chart, "")
}

/// The practitioner's table: per problem the cheapest method with its mesh, step and work, and what others cost beside it.
pub fn practice(findings: &RaceFindings, read_out: ReadOut) -> Table {
    let terms = Terms::usual(read_out);
    let row = |group: Group, situation: &Situation| {
        let best = cheapest(situation, &terms, |method| group.takes(method));
        let arrival = best.and_then(|(entry, _)| situation.arrival(entry, &terms));
        let mut row: Vec<Cell> = vec![words_of(group).into(), situation.title.as_str().into()];
        match (best, arrival) {
            (Some((entry, cost)), Some(arrival)) => row.extend([
                Cell::Code(entry.contender.clone()),
                Cell::Count(arrival.cells as u64),
                arrival.step.into(),
                Cell::Seconds(cost),
            ]),
            _ => row.extend(std::iter::repeat_n(Cell::missing("no method reaches 1 %"), 4)),
        }
        let of_total = if group == Group::Total { "TL-" } else { "" };
        row.extend(
            SHOWN[..3]
                .iter()
                .map(|name| regret(situation, &format!("{of_total}{name}"), &terms, best.map(|one| one.1))),
        );
        row
    };
    let rows = Group::EACH.into_iter().flat_map(|group| {
        findings.situations.iter().filter(move |one| group.has(one)).map(move |one| row(group, one))
    });
    let heads = format!(
        "group | problem | cheapest | > cells | step | > work to 1 % | > {} | > {} | > {}",
        SHOWN[0], SHOWN[1], SHOWN[2]
    );
    Table::of(format!("What 1 % takes, read {}", places_of(read_out)), columns(&heads), rows)
        .note("last columns: work over that of the cheapest, or why 1 % is not reached; where the mesh follows, their TL- forms")
}

fn regret(situation: &Situation, name: &str, terms: &Terms, least: Option<f64>) -> Cell {
    let Some(entry) = situation.entry(name) else { return Cell::missing("not among the methods") };
    match (situation.arrival(entry, terms), least, situation.reason(entry, terms)) {
        (Some(arrival), Some(least), _) => format!("× {}", number::short(arrival.cost / least)).into(),
        (_, _, Some(reason)) => reason_words(reason).into(),
        _ => Cell::missing("not run"),
    }
}
