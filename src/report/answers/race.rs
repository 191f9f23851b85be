//! Which method should I take? The answers of the race with where they hold, the problems one by one, and the page with every
//! method.

use crate::case::contender::CONTENDERS;
use crate::questions::choice::{
    LARGEST_TAU, SHOWN, cheapest, dot_plot, facts, places_of, practice, reason_words, words_of,
};
use crate::questions::sentence;
use crate::questions::words::capitalised;
use crate::race::RaceFindings;
use crate::race::finish::{Budget, RaceQuantity, Reason, Terms};
use crate::race::group::{Group, races};
use crate::race::situation::{Entry, Situation};
use crate::record::race_errors::ReadOut;
use crate::render::chart::{Chart, ChartAxis, Naming, Series, Style, slots};
use crate::render::page::{Block, Figure, Page, Section};
use crate::render::table::{Cell, Mood, Shade, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::answers::Question;
use crate::report::sections::page_of;

const QUESTION: Question = Question { heading: "Which method should I take?", id: "choice" };

/// The page of every method.
const PAGE: &str = "race.html";

/// The sentences at the head of the page.
pub(crate) fn lead(findings: &RaceFindings) -> Result<String, RenderError> {
    sentence::sentence("race-answers", &facts(findings))
}

/// The problems one by one, as a figure and a table for each read-out.
pub(crate) fn section(findings: &RaceFindings) -> Section {
    let views = ReadOut::BOTH.map(|read_out| {
        let blocks =
            vec![Block::Figure(dot_plot(findings, read_out)), Block::Table(practice(findings, read_out))];
        (format!("Read {}", places_of(read_out)), blocks)
    });
    let link = format!(
        "[Every method in every problem]({PAGE}) · [race.csv](tables/race.csv) · [profile.csv](tables/profile.csv)"
    );
    Section::new(QUESTION.heading, QUESTION.id, vec![Block::Switch(views.to_vec()), Block::Paragraph(link)])
}

/// Every answer with where it holds.
fn answer_table(findings: &RaceFindings) -> Table {
    let holds = |holds: bool| {
        Cell::Verdict(
            if holds { Mood::Pass } else { Mood::Note },
            if holds { "holds" } else { "changes" }.to_owned(),
        )
    };
    let rows = findings.answers.iter().map(|one| {
        let interval = one.interval.map(number::rounded_percent).join(" – ");
        vec![
            words_of(one.group).into(),
            places_of(one.read_out).into(),
            Cell::Code(one.method.clone()),
            format!("{} of {}", one.reached, one.of).into(),
            Cell::Percent(one.share),
            interval.into(),
            Cell::Percent(one.within_two),
            Cell::Count(one.alike.len() as u64),
            holds(one.holds.time),
            holds(one.holds.budget),
            holds(one.holds.tolerance),
            holds(one.holds.read_out),
        ]
    });
    let heads = "group | read | method | > reaches 1 % | > share | > interval | > within twice the cheapest | > methods not told apart | \
                 each output | half, twice the budget | 0.5, 2, 5 % | read the other way";
    Table::of("The methods to take, and where that holds", columns(heads), rows).note(
        "share: families of problems weigh alike; the method with the largest sum of both shares, and those within 0.03 of it; interval: \
         nine tenths of the shares when problems are drawn anew; not told apart: intervals of both shares overlap",
    )
}

/// What each operator changes.
fn operator_table(findings: &RaceFindings) -> Table {
    let rows = findings.operators.iter().map(|one| {
        let mut row = vec![Cell::Text(one.operator.clone()), Cell::Code(one.methods[1].clone())];
        row.extend(one.arrivals.iter().map(|counts| match counts {
            Some([without, with]) => format!("{without} → {with}").into(),
            None => Cell::missing("not among the methods"),
        }));
        row
    });
    let mut heads = columns("operator | with it");
    heads.extend(races().map(|(group, read_out)| {
        TableColumn::number(format!("{}, {}", words_of(group), places_of(read_out)))
    }));
    Table::of("Problems that reach 1 % without and with each operator", heads, rows)
}

/// Outputs, meshes and budgets.
fn budget_table(findings: &RaceFindings) -> Table {
    let rows = findings.situations.iter().map(|one| {
        vec![
            one.title.as_str().into(),
            one.integrator.as_str().into(),
            one.outputs.join(", ").into(),
            Cell::Count(one.most_cells(Budget::Half) as u64),
            Cell::Count(one.most_cells(Budget::Whole) as u64),
            Cell::Count(one.most_cells(Budget::Twice) as u64),
        ]
    });
    let heads = "problem | integrator | outputs | > half the budget, cells | > budget, cells | > twice the budget, cells";
    Table::of("The problems with their outputs and budgets", columns(heads), rows)
}

/// Performance profiles of a group and read-out: staircases, those of the answers and of known methods in colour.
fn profile_figure(findings: &RaceFindings, group: Group, read_out: ReadOut) -> Figure {
    let best = findings.best(group, read_out).map_or("", |one| &one.method);
    let title = format!(
        "Share of problems within a multiple of the least cost: {}, read {}",
        words_of(group),
        places_of(read_out)
    );
    let mut chart = Chart::new(
        title,
        ChartAxis::log10("cost to 1 %, over that of the cheapest method").between(1.0, LARGEST_TAU),
        ChartAxis::linear("share of problems").between(0.0, 1.0),
    );
    chart.naming = Naming::Ends;
    let staircase = |steps: &[(f64, f64)]| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (tau, share) in steps.iter().filter(|(tau, _)| *tau <= LARGEST_TAU) {
            points.extend(points.last().map(|(_, before)| (*tau, *before)));
            points.push((*tau, *share));
        }
        points
    };
    let profiles = findings.profiles(group, read_out, RaceQuantity::All);
    let is_named = |method: &str| method == best || SHOWN.contains(&method.trim_start_matches("TL-"));
    let (named, others): (Vec<_>, Vec<_>) = profiles.iter().partition(|one| is_named(&one.method));
    let slots = slots(&named.iter().map(|one| one.method.as_str()).collect::<Vec<_>>());
    chart.series.extend(
        others.iter().map(|one| Series::new(one.method.clone(), staircase(&one.steps)).style(Style::Context)),
    );
    chart.series.extend(named.iter().zip(slots).map(|(one, slot)| {
        Series::new(one.method.clone(), staircase(&one.steps)).style(Style::Line).slot(slot)
    }));
    let caption = "Left end: how often a method is the cheapest; right end: how often it reaches 1 % (Dolan & Moré; beyond the first \
                   place profiles compare with the first alone).";
    Figure::new(format!("race-profile-{}-{}", group.name(), read_out.name()), chart, caption)
}

/// The page of every method: first what a practitioner asks, then answers, budgets, profiles, the whole matrix and properties.
pub fn matrix_page(findings: &RaceFindings) -> Page {
    let by_read_out = |blocks: &dyn Fn(ReadOut) -> Vec<Block>| {
        Block::Switch(ReadOut::BOTH.map(|one| (format!("Read {}", places_of(one)), blocks(one))).to_vec())
    };
    let profiles = races().map(|(group, read_out)| {
        let words = format!("{}, read {}", capitalised(words_of(group)), places_of(read_out));
        (words, vec![Block::Figure(profile_figure(findings, group, read_out))])
    });
    let mut sections = vec![
        Section::new(
            "What 1 % takes",
            "practice",
            vec![by_read_out(&|one| vec![Block::Table(practice(findings, one))])],
        ),
        Section::new(
            "Which method, and where does it hold?",
            "answers",
            vec![
                Block::Table(answer_table(findings)),
                Block::Table(operator_table(findings)),
                Block::Switch(profiles.collect()),
            ],
        ),
        Section::new(
            "Every method in every problem",
            "matrix",
            vec![
                Block::Table(budget_table(findings)),
                Block::Paragraph(sentence::sentence("race-rules", &()).unwrap_or_default()),
                by_read_out(&|one| vec![Block::Table(matrix(&findings.situations, one))]),
            ],
        ),
    ];
    if !findings.properties.is_empty() {
        let table = Block::Table(property_table(findings));
        sections.push(Section::new("Properties that are no errors", "properties", vec![table]));
    }
    Page {
        title: "Which method reaches one per cent?".to_owned(),
        lead: "[Back to the answers](index.html). Every number: [race.csv](tables/race.csv).".to_owned(),
        sections,
        is_wide: true,
        files: Some("race".to_owned()),
        ..Page::default()
    }
}

/// The cost to 1 % of every method in every problem, ms.
fn matrix(situations: &[Situation], read_out: ReadOut) -> Table {
    let terms = Terms::usual(read_out);
    let mut heads = columns("problem");
    heads.extend(CONTENDERS.iter().map(|one| TableColumn::number(one.name)));
    let rows = situations.iter().map(|situation| {
        let target = page_of(&situation.study);
        let least = cheapest(situation, &terms, |_| true).map(|(_, cost)| cost);
        let cell = |entry: &Entry| {
            let arrival = situation.arrival(entry, &terms);
            let cost = arrival.as_ref().map(|one| one.cost);
            let (shade, words) = match (cost.zip(least), situation.reason(entry, &terms)) {
                (Some((cost, least)), _) => (Shade::of_ratio(cost / least), number::short(1e3 * cost)),
                (_, Some(Reason::NotApplicable)) => (Shade::Empty, "–".to_owned()),
                (_, reason) => (Shade::Failed, reason.map_or(String::new(), reason_words)),
            };
            let title = match (&arrival, &entry.refused) {
                (Some(one), _) => format!("{}: {} cells, {}", entry.contender, one.cells, one.step),
                (_, Some(why)) => format!("{}: {why}", entry.contender),
                _ => format!(
                    "{}: {} cells",
                    entry.contender,
                    entry.levels.last().map_or(0, |level| level.cells)
                ),
            };
            Cell::Shaded { shade, words, value: cost, title, target: target.clone() }
        };
        let mut row = vec![Cell::Link { words: situation.title.clone(), target: target.clone() }];
        row.extend(CONTENDERS.iter().map(|one| match situation.entry(one.name) {
            Some(entry) => cell(entry),
            None => Cell::missing("the same run as without TL-"),
        }));
        row
    });
    Table::of("", heads, rows)
}

/// Critical step, rest and power, per method.
fn property_table(findings: &RaceFindings) -> Table {
    let rows = CONTENDERS.iter().map(|method| {
        let of_method = || findings.properties.iter().filter_map(|one| one.entry(method.name));
        let step =
            of_method().filter(|entry| entry.spurious_velocity.is_none()).find_map(|entry| entry.step_ratio);
        let asymmetry = of_method().find_map(|entry| entry.asymmetry);
        let velocity = of_method().find_map(|entry| entry.spurious_velocity);
        vec![
            Cell::Code(method.name.to_owned()),
            Cell::of(step, Cell::Number, "not observed"),
            Cell::of(velocity, Cell::Error, "not run"),
            Cell::of(asymmetry.map(|one| one[0]), Cell::Error, "not measured"),
            Cell::of(asymmetry.map(|one| one[1]), Cell::Error, "not measured"),
        ]
    });
    Table::of(
        "",
        columns("method | > critical step over the formula's | > velocity at hydrostatic equilibrium over k | > skeleton | > water"),
        rows,
    )
    .note("skeleton, water: asymmetry of the stiffness; round-off where the forces do the power of the stresses")
}
