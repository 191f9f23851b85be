//! Which method should I take? The answers of the race with where they hold, the families of problems, and the problems one by
//! one.

use crate::campaign::refinement::MOST_WORK;
use crate::case::contender::PAPERS;
use crate::case::grouping::{distinct, grouped};
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::words::COUNTED_WORK;
use crate::race::RaceFindings;
use crate::race::answer::Answer;
use crate::race::finish::{Reason, Terms};
use crate::race::group::{Group, cost_table, races};
use crate::race::profile::CostTable;
use crate::race::situation::{Entry, Situation};
use crate::record::race_errors::{ARRIVED, ReadOut};
use crate::render::chart::{Chart, ChartAxis, ChartRow, ChartRows, Series, Size, Style};
use crate::render::number;
use crate::render::page::Figure;
use crate::render::palette::slots;
use crate::render::table::{Cell, Table, columns};
use oedometer_exact::ExactError;
use oedometer_soil::elementary;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

/// Which method should I take?
pub static CHOICE: Question = Question {
    id: "choice",
    heading: "Which method should I use?",
    template: include_str!("choice.md"),
    places: &[Place::Report],
    ask,
};

/// A method that does not lock, the paper's, one whose mesh follows, and the plainest, each with a word on it.
pub const SHOWN: [(&str, &str); 4] = [
    ("GC-Bbar-patch", "does not lock"),
    (PAPERS, "the paper's"),
    ("TL-GC-Bbar-patch", "mesh follows"),
    ("MPM", "plain"),
];
/// The largest multiple of the least cost that figures show.
pub const LARGEST_TAU: f64 = 100.0;
/// Families of problems, in words, with letters from A in this order.
const FAMILIES: [(&str, &str); 8] = [
    ("column", "small strain, column"),
    ("footing", "footing at collapse"),
    ("layer", "undrained layer, slab"),
    ("plane", "large strain, plane"),
    ("points", "points off their lattice"),
    ("soil", "two soils, yielding"),
    ("strain", "large strain, column"),
    ("waves", "waves"),
];

/// Words for a group.
pub fn words_of(group: Group) -> &'static str {
    match group {
        Group::Moving => "points that move through the mesh",
        Group::Rest => "points at rest",
        Group::Total => "a mesh that follows the soil",
    }
}

/// Where fields are sampled, in words.
pub fn places_of(read_out: ReadOut) -> &'static str {
    match read_out {
        ReadOut::Points => "sampled at the points",
        ReadOut::Centres => "averaged over cells",
    }
}

/// The place of a family in the order of all.
fn place_of(family: &str) -> usize {
    FAMILIES.iter().position(|(name, _)| *name == family).unwrap_or(FAMILIES.len())
}

/// The letter of a family, which links its rows in the figure and in the table.
fn letter_of(family: &str) -> String {
    u8::try_from(place_of(family)).map_or(String::new(), |place| char::from(b'A' + place).to_string())
}

/// Every number and name of the sentences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Problems.
    pub problems: usize,
    /// Methods.
    pub methods: usize,
    /// The finishing line.
    pub tolerance: f64,
    /// Of each group and read-out the best method, and those that tie with it.
    pub answers: Vec<Answer>,
    /// What is said of each group.
    pub groups: Vec<GroupAnswer>,
    /// Per read-out who reaches 1 % most often, and at what price.
    pub leaders: Vec<Leader>,
    /// What to take in each family of problems, by group and read-out.
    pub families: Vec<FamilyAnswer>,
}

impl Facts {
    /// What some answer turns with, in words; empty where all hold wherever one looks.
    pub fn turns(&self) -> String {
        let all = self.groups.iter().flat_map(|group| &group.reads).flat_map(|read| &read.changes_with);
        distinct(all.map(String::as_str)).join(", ")
    }
}

/// What is said of a group: one sentence where it holds wherever one looks, else one per read-out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupAnswer {
    /// The group.
    pub group: Group,
    /// The group in words.
    words: String,
    /// The method that holds wherever one looks.
    method: Option<String>,
    /// Per read-out.
    reads: Vec<ReadAnswer>,
}

/// The best of a group and read-out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct ReadAnswer {
    /// Where fields are read, in words.
    places: String,
    /// The best and those that tie with it.
    methods: Vec<String>,
    /// Problems in which the first reaches 1 %.
    reached: usize,
    /// Problems.
    of: usize,
    /// What it changes with.
    changes_with: Vec<String>,
}

/// A method whose mesh follows the soil.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Following {
    /// The method.
    pub method: String,
    /// Problems in which it reaches 1 %; where nothing moves it is the method whose mesh stays.
    pub reached: usize,
}

/// Who reaches 1 % most often of the methods for all problems, those whose mesh stays, and at what price.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leader {
    /// Where fields are read.
    #[serde(rename = "readout")]
    pub read_out: ReadOut,
    /// The method; of several that reach it as often the one that costs the least times the cheapest at worst.
    pub method: String,
    /// It and the others that reach it as often, in words.
    who: String,
    /// How many do.
    as_often: usize,
    /// Problems in which it reaches 1 %.
    pub reached: usize,
    /// Problems.
    pub of: usize,
    /// Its largest cost over that of the cheapest method, of any group.
    pub dearest: f64,
    /// The method whose mesh follows the soil that reaches it most often, where that is at least as often.
    pub following: Option<Following>,
}

/// What to take in a family of problems.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FamilyAnswer {
    /// The group.
    pub group: Group,
    /// Where fields are read.
    #[serde(rename = "readout")]
    pub read_out: ReadOut,
    /// The family.
    pub family: String,
    /// The best method and those that tie with it; none where nobody reaches 1 %.
    pub methods: Vec<String>,
    /// Problems in which the first reaches it.
    pub reached: usize,
    /// Problems.
    pub of: usize,
    /// Work to 1 % of the first in the easiest and the hardest problem that it reaches, s.
    pub work: Option<[f64; 2]>,
}

impl FamilyAnswer {
    /// The family in words.
    pub fn words(&self) -> String {
        let words = FAMILIES.iter().find(|(name, _)| *name == self.family);
        let words = words.map_or(self.family.as_str(), |(_, words)| words);
        if self.group == Group::Total { "… mesh follows".to_owned() } else { words.to_owned() }
    }
}

/// The studies of the race answer.
#[expect(clippy::unnecessary_wraps, reason = "every question may refuse a case")]
fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let race = RaceFindings::from_studies(studies.iter().map(|one| (one.study, one.records)));
    Ok(race.as_ref().and_then(answer))
}

/// The answer of a race; none where nothing is judged by its errors.
pub fn answer(race: &RaceFindings) -> Option<Finding> {
    let studies = race.situations.iter().map(|one| one.study.as_str());
    (!race.situations.is_empty()).then(|| CHOICE.answer(studies, &facts(race)))
}

/// What the sentences say.
pub fn facts(race: &RaceFindings) -> Facts {
    Facts {
        problems: race.situations.len(),
        methods: methods(race).len(),
        tolerance: ARRIVED,
        answers: race.answers.clone(),
        groups: group_answers(race),
        leaders: ReadOut::BOTH.into_iter().filter_map(|read_out| leader(race, read_out)).collect(),
        families: races().flat_map(|(group, read_out)| family_answers(race, group, read_out)).collect(),
    }
}

/// Methods that may run in some problem.
fn methods(race: &RaceFindings) -> Vec<&str> {
    distinct(race.situations.iter().flat_map(|one| &one.entries).map(|entry| entry.contender.as_str()))
}

fn group_answers(race: &RaceFindings) -> Vec<GroupAnswer> {
    let read = |group: Group, read_out: ReadOut| {
        let answers: Vec<&Answer> =
            race.answers.iter().filter(|one| (one.group, one.read_out) == (group, read_out)).collect();
        let first = *answers.first()?;
        let holds = first.holds;
        let all = [
            (holds.time, "the output"),
            (holds.budget, "the work allowed"),
            (holds.tolerance, "the tolerance"),
            (holds.read_out, "the sampling"),
        ];
        Some(ReadAnswer {
            places: places_of(read_out).to_owned(),
            methods: answers.iter().map(|one| one.method.clone()).collect(),
            reached: first.reached,
            of: first.of,
            changes_with: all
                .into_iter()
                .filter(|(holds, _)| !holds)
                .map(|(_, what)| what.to_owned())
                .collect(),
        })
    };
    let of_group = |group: Group| {
        let reads: Vec<ReadAnswer> =
            ReadOut::BOTH.into_iter().filter_map(|read_out| read(group, read_out)).collect();
        let firm = |read_out: ReadOut, method: &str| {
            race.answers.iter().any(|one| {
                (one.group, one.read_out, one.method.as_str()) == (group, read_out, method)
                    && one.holds.everywhere()
            })
        };
        let mut methods = race.answers.iter().filter(|one| one.group == group).map(|one| &one.method);
        let method = methods.find(|method| ReadOut::BOTH.iter().all(|read_out| firm(*read_out, method)));
        let words = words_of(group).to_owned();
        (!reads.is_empty()).then(|| GroupAnswer { group, words, method: method.cloned(), reads })
    };
    Group::EACH.into_iter().filter_map(of_group).collect()
}

fn leader(race: &RaceFindings, read_out: ReadOut) -> Option<Leader> {
    let terms = Terms::usual(read_out);
    let of_method = |method: &str| {
        let ratios = race.situations.iter().filter_map(|one| one.ratio(entry_of(one, method)?, &terms));
        let ratios: Vec<f64> = ratios.collect();
        Leader {
            read_out,
            method: method.to_owned(),
            who: method.to_owned(),
            as_often: 1,
            reached: ratios.len(),
            of: race.situations.len(),
            dearest: ratios.into_iter().fold(1.0, f64::max),
            following: None,
        }
    };
    let ranked = |group: Group| {
        let mut all: Vec<Leader> =
            methods(race).into_iter().filter(|method| group.takes(method)).map(of_method).collect();
        all.sort_by(|a, b| Reverse(a.reached).cmp(&Reverse(b.reached)).then(a.dearest.total_cmp(&b.dearest)));
        all
    };
    let all = ranked(Group::Moving);
    let first = all.first().filter(|one| one.reached > 0)?.clone();
    let equals: Vec<&str> =
        all.iter().take_while(|one| one.reached == first.reached).map(|one| one.method.as_str()).collect();
    let who = match equals[..] {
        [only] => only.to_owned(),
        [one, other] => format!("{one} and {other}"),
        [one, ref others @ ..] => format!("{one} and {} others", others.len()),
        [] => return None,
    };
    let following = ranked(Group::Total).into_iter().next().filter(|one| one.reached >= first.reached);
    let following = following.map(|one| Following { method: one.method, reached: one.reached });
    Some(Leader { who, as_often: equals.len(), following, ..first })
}

fn family_answers(race: &RaceFindings, group: Group, read_out: ReadOut) -> Vec<FamilyAnswer> {
    let table = cost_table(&race.situations, group, &Terms::usual(read_out));
    let mut families: Vec<&str> = table.rows.iter().map(|row| row.family.as_str()).collect();
    families.dedup();
    let of_family = |family: &str| {
        let rows = table.rows.iter().filter(|row| row.family == family).cloned().collect();
        let table = CostTable { rows, methods: table.methods.clone() };
        // Of those that tie the one that arrives most often, and then the cheapest.
        let worth = |method: &str| {
            let place = table.methods.iter().position(|one| one == method).unwrap_or_default();
            let ratios: Vec<f64> = table.rows.iter().filter_map(|row| row.ratio(place)).collect();
            let mean = ratios.iter().map(|ratio| elementary::ln(*ratio)).sum::<f64>() / ratios.len() as f64;
            (ratios.len(), mean)
        };
        let mut best: Vec<(&str, (usize, f64))> =
            table.best().into_iter().map(|method| (method, worth(method))).collect();
        best.sort_by(|(_, a), (_, b)| b.0.cmp(&a.0).then(a.1.total_cmp(&b.1)));
        let first = best.first().and_then(|(first, _)| table.methods.iter().position(|one| one == first));
        let own = || table.rows.iter().filter_map(|row| row.costs[first?]);
        let work = own().reduce(f64::min).zip(own().reduce(f64::max));
        FamilyAnswer {
            group,
            read_out,
            family: family.to_owned(),
            methods: best.iter().map(|(method, _)| (*method).to_owned()).collect(),
            reached: best.first().map_or(0, |(_, (reached, _))| *reached),
            of: table.rows.len(),
            work: work.map(|(least, most)| [least, most]),
        }
    };
    families.into_iter().map(of_family).collect()
}

/// A reason with what was measured.
pub fn reason_words(reason: Reason) -> String {
    match reason {
        Reason::Budget(order) => format!("too costly (order {})", number::fixed(order, 1)),
        Reason::Plateau(height) => format!("plateau ({})", number::percent(height)),
        other => other.shown().to_owned(),
    }
}

/// A method in a problem; where nothing moves a mesh that follows is the same mesh.
fn entry_of<'a>(situation: &'a Situation, method: &str) -> Option<&'a Entry> {
    let at_rest = || situation.entry(method.trim_start_matches("TL-")).filter(|_| !situation.moves);
    situation.entry(method).or_else(at_rest)
}

/// The methods of the dot plot with a word on each: who reaches 1 % most often first.
fn plotted(race: &RaceFindings, read_out: ReadOut) -> Vec<(String, &'static str)> {
    let leader = leader(race, read_out).map(|one| one.method);
    let most = leader.iter().filter(|method| SHOWN.iter().all(|(name, _)| name != method));
    let most = most.map(|method| (method.clone(), "leads on a fixed mesh"));
    most.chain(SHOWN.iter().map(|(name, word)| ((*name).to_owned(), *word))).collect()
}

/// Who is the cheapest of all in most problems, and in how many.
fn cheapest_of_most(race: &RaceFindings, terms: &Terms) -> String {
    let first = race.situations.iter().filter_map(|one| Some(one.cheapest(terms)?.0.contender.as_str()));
    let mut methods = grouped(first, |method| *method);
    methods.sort_by_key(|(_, problems)| Reverse(problems.len()));
    methods.first().map_or("No method reaches 1 %".to_owned(), |(method, problems)| {
        format!("{method} is the cheapest most often, in {} of {}", problems.len(), race.situations.len())
    })
}

/// A row per problem: cost to 1 % over the cheapest of all methods, why a method does not get there, and the cheapest with its
/// cost, cells and step.
pub fn dot_plot(race: &RaceFindings, read_out: ReadOut) -> Figure {
    let terms = Terms::usual(read_out);
    let methods = plotted(race, read_out);
    let names: Vec<&str> = methods.iter().map(|(name, _)| name.as_str()).collect();
    let ticks = [
        (1.0, "× 1"),
        (2.0, "× 2"),
        (5.0, "× 5"),
        (10.0, "× 10"),
        (20.0, ""),
        (50.0, ""),
        (LARGEST_TAU, "× 100"),
    ];
    let mut chart = Chart::new(
        format!("{}: work to 1 %, {}", cheapest_of_most(race, &terms), places_of(read_out)),
        ChartAxis::log10("Work over the cheapest")
            .between(1.0, LARGEST_TAU)
            .with_labelled_ticks(ticks.map(|(tau, words)| (tau, words.to_owned()))),
        ChartAxis::linear("row"),
    );
    chart.size = Size { width: 950.0, ..Size::default() };
    for ((name, word), slot) in methods.iter().zip(slots(&names)) {
        let points = race.situations.iter().enumerate().filter_map(|(place, situation)| {
            Some((situation.ratio(entry_of(situation, name)?, &terms)?, place as f64))
        });
        let points: Vec<(f64, f64)> = points.collect();
        let label = format!("{name}, {word}: {} of {}", points.len(), race.situations.len());
        chart.series.push(Series::new(label, points).style(Style::Markers).slot(slot));
    }
    chart.rows = Some(ChartRows {
        without: "Does not reach 1 %".to_owned(),
        heads: ["Cheapest", "ms", "cells", "step"].map(str::to_owned).to_vec(),
        rows: race.situations.iter().map(|one| plotted_row(one, &names, &terms)).collect(),
    });
    let caption = match read_out {
        ReadOut::Points => {
            let [column, plane] = MOST_WORK.map(number::rounded);
            format!(
                "Farther right: dearer; equal marks are stacked. Where nothing moves, *TL-* changes nothing. *Too costly*: the error \
                 still fell on the finest mesh allowed, of {column} s of work ({plane} s in the plane); *plateau*: it no longer fell; \
                 *locks*: too little settlement; *inaccurate*: large errors that do not fall, or a run that ends early; *n/a*: does not \
                 apply. {}Work: {COUNTED_WORK}. Cells: over the height, or under the footing. Step: of the elapsed time t or of the \
                 critical step t_c.",
                unmarked(race, &names, &terms)
            )
        }
        ReadOut::Centres => {
            let leads = leader(race, read_out).map_or(String::new(), |one| {
                let first = if one.as_often > 1 { ", the first" } else { "" };
                let dearest = number::two_digits(one.dearest);
                format!("Most often within 1 %: {}{first} at up to {dearest} times the least work. ", one.who)
            });
            format!("{leads}Marks and words as where fields are sampled at the points.")
        }
    };
    Figure::new(format!("race-problems-{}", read_out.name()), chart, caption)
}

/// The cheapest methods that have no mark.
fn unmarked(race: &RaceFindings, marked: &[&str], terms: &Terms) -> String {
    let best = race.situations.iter().filter_map(|one| one.cheapest(terms));
    let best = distinct(best.map(|(entry, _)| entry.contender.as_str()));
    let named: Vec<String> =
        best.iter().filter(|one| !marked.contains(one)).map(|one| format!("`{one}`")).collect();
    if named.is_empty() { String::new() } else { format!("Without a mark: {}. ", named.join(", ")) }
}

/// The words of a problem.
fn plotted_row(situation: &Situation, methods: &[&str], terms: &Terms) -> ChartRow {
    let without = methods.iter().map(|method| {
        let reason = entry_of(situation, method).map(|entry| situation.reason(entry, terms));
        reason.unwrap_or(Some(Reason::NotRun)).map_or("", Reason::shown).to_owned()
    });
    let best = situation.cheapest(terms);
    let arrival = best.and_then(|(entry, cost)| Some((entry, cost, situation.arrival(entry, terms)?)));
    let words = match arrival {
        Some((entry, cost, arrival)) => vec![
            entry.contender.clone(),
            number::two_digits(1e3 * cost),
            arrival.cells.to_string(),
            step_words(&arrival.step),
        ],
        None => vec![nearest(situation, terms)],
    };
    ChartRow {
        name: situation.title.clone(),
        family: letter_of(&situation.family),
        without: without.collect(),
        words,
    }
}

/// A rule of steps in short: a share of the elapsed time, or of the critical step.
fn step_words(rule: &str) -> String {
    match rule.split_once('=') {
        Some(("growth", share)) => format!("{share} t"),
        Some(("stable", share)) => format!("{share} t_c"),
        _ => rule.replace('=', " "),
    }
}

/// How near the most accurate method came where none reaches the tolerance.
fn nearest(situation: &Situation, terms: &Terms) -> String {
    let finest = situation.entries.iter().filter_map(|entry| {
        let level =
            entry.levels.iter().rev().find(|level| level.cells <= situation.most_cells(terms.budget))?;
        Some((level.error(terms)?, level.cells, &entry.contender))
    });
    finest.min_by(|a, b| a.0.total_cmp(&b.0)).map_or("none".to_owned(), |(error, cells, method)| {
        format!("none; {method} {} on {cells}", number::percent(error))
    })
}

/// What to take by the kind of problem, and what 1 % costs.
pub fn family_table(facts: &Facts, read_out: ReadOut) -> Table {
    let mut families: Vec<&FamilyAnswer> =
        facts.families.iter().filter(|one| one.read_out == read_out).collect();
    families.sort_by_key(|one| place_of(&one.family));
    // The method that the headline names may tie with the one named here.
    let following = facts.leaders.iter().find(|one| one.read_out == read_out);
    let following = following.and_then(|one| Some(one.following.as_ref()?.method.as_str()));
    let tied = families.iter().find_map(|one| {
        let method = one.methods.iter().skip(1).find(|method| Some(method.as_str()) == following)?;
        Some(format!(", `{method}` in {} among them", letter_of(&one.family)))
    });
    let rows = families.into_iter().map(|one| {
        let milliseconds = |work: f64| number::two_digits(1e3 * work);
        let work = one.work.map(|[least, most]| {
            let both = [least, most].map(milliseconds);
            if both[0] == both[1] { both[0].clone() } else { both.join(" – ") }
        });
        let none = || Cell::Text(String::new());
        vec![
            letter_of(&one.family).into(),
            one.words().into(),
            one.methods.first().map_or("none".into(), |method| Cell::Code(method.clone())),
            one.methods.len().checked_sub(2).map_or_else(none, |more| Cell::Count(more as u64 + 1)),
            format!("{} of {}", one.reached, one.of).into(),
            Cell::Text(work.unwrap_or_default()),
        ]
    });
    Table::of(
        "If your problem is …, and what 1 % costs",
        columns("| your problem | use | > ties | > 1 % in | > its ms"),
        rows,
    )
    .file(format!("families-{}", read_out.name()))
    .note(format!(
        "ties: other methods that are as good{}; ms: work of the method named, easiest to hardest problem",
        tied.unwrap_or_default()
    ))
}
