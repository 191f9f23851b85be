//! Which method should I take? The first screen of the front page, and the page with every method.

use crate::campaign::refinement::MOST_WORK;
use crate::case::contender::CONTENDERS;
use crate::judge::study_check::StudyCheck;
use crate::questions::choice::{
    LARGEST_TAU, SHOWN, dot_plot, facts, family_table, places_of, reason_words, words_of,
};
use crate::questions::finding::Finding;
use crate::questions::sentence;
use crate::questions::words::capitalised;
use crate::race::finish::{Budget, RaceQuantity, Reason, Terms};
use crate::race::group::{Group, races};
use crate::race::situation::{Entry, Situation};
use crate::race::{LADDER, RaceFindings};
use crate::record::race_errors::{ARRIVED, ReadOut};
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::{Block, Figure, Page, Section};
use crate::render::palette::slots;
use crate::render::table::{Cell, Mood, Shade, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::answers::Answers;
use crate::report::sections::page_of;
use serde::Serialize;

/// The page of every method.
const PAGE: &str = "race.html";

/// The headline of the front page and what stands below it.
pub(crate) fn headline(findings: &RaceFindings) -> Result<[String; 2], RenderError> {
    let facts = facts(findings);
    let [headline, lead] = [include_str!("race-headline.md"), include_str!("race-lead.md")];
    Ok([sentence::filled(headline, &facts)?, sentence::filled(lead, &facts)?])
}

/// The links at the top of the front page: its sections by a short name, and what else there is.
pub(crate) fn front_links(sections: &[Section], studies: usize) -> Vec<(String, String)> {
    const SHORT: [(&str, &str); 9] = [
        ("choice", "Which method?"),
        ("cost", "Cost"),
        ("paper", "The paper"),
        ("audit", "The equations"),
        ("locking", "Locking"),
        ("convergence", "Convergence"),
        ("time-step", "Time step"),
        ("changes", "Changes"),
        ("expected", "Trust"),
    ];
    let of_section = |(id, words): &(&str, &str)| {
        sections.iter().any(|one| one.id == *id).then(|| ((*words).to_owned(), format!("#{id}")))
    };
    let others = [
        (format!("{studies} studies"), "studies/index.html".to_owned()),
        ("Method names".to_owned(), "studies/index.html#names".to_owned()),
        ("How to read".to_owned(), format!("{PAGE}#rules")),
        ("race.csv".to_owned(), "tables/race.csv".to_owned()),
    ];
    SHORT.iter().filter_map(of_section).chain(others).collect()
}

/// The first screen: the problems one by one, what to take by the kind of problem, and why to believe it; then the answers of
/// the groups.
pub(crate) fn section(race: &RaceFindings, answers: &Answers<'_>) -> Result<Section, RenderError> {
    let facts = facts(race);
    let views = ReadOut::BOTH.map(|read_out| {
        let main = vec![Block::Figure(dot_plot(race, read_out))];
        let mut aside = vec![Block::Table(family_table(&facts, read_out))];
        if read_out == ReadOut::Points {
            aside.extend([Block::Heading("Why believe it?".to_owned()), Block::List(trust(race, answers))]);
        }
        (capitalised(places_of(read_out)), vec![Block::Beside(main, aside)])
    });
    let choice = answers.to("choice").map(Finding::sentence).transpose()?.unwrap_or_default();
    let more = format!("[Every method in every problem]({PAGE}) · [profile.csv](tables/profile.csv)");
    let blocks = vec![Block::Switch(views.to_vec()), Block::Paragraph(format!("{choice}\n\n{more}"))];
    Ok(Section::new("Which method should I use?", "choice", blocks))
}

/// What speaks for the benchmark, and where its choice changes.
fn trust(race: &RaceFindings, answers: &Answers<'_>) -> Vec<String> {
    let checks = || answers.studies.iter().map(|one| &one.check);
    let mut points = vec![format!(
        "{} of {} [expectations](#expected) met: errors, orders and ratios, mostly against exact solutions that a \
         second method confirms; golden values guard the benchmark's numbers only against change",
        checks().map(StudyCheck::met).sum::<usize>(),
        checks().map(|check| check.judgements.len()).sum::<usize>()
    )];
    let off = "with the paper's equations as printed the final settlement is {{ printed_settlement|signed_percent }} \
               off Xie & Leo's: [the audit](#paper)";
    let printed = answers.to("paper").filter(|paper| paper.facts["printed_settlement"].is_number());
    points.extend(printed.and_then(|paper| sentence::filled(off, &paper.facts).ok()));
    if answers.to("peers").is_some() {
        points.push("other programs solve [the same column](#peers)".to_owned());
    }
    let turns = facts(race).turns();
    if !turns.is_empty() {
        points.push(format!("the choice changes with {turns}: [where it holds]({PAGE}#answers)"));
    }
    points
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
            Cell::Measured(one.dearest),
            Cell::Count(one.alike.len() as u64),
            holds(one.holds.time),
            holds(one.holds.budget),
            holds(one.holds.tolerance),
            holds(one.holds.read_out),
        ]
    });
    let heads = "group | fields | method | > reaches 1 % in | > share | > interval | > within twice the cheapest | \
                 > most work over the cheapest | > equivalent methods | each output | half, twice the budget | \
                 0.5, 2, 5 % | other sampling";
    Table::of("The methods to use, and where that holds", columns(heads), rows).note(
        "share: families of problems have equal weight; the method with the largest sum of both shares, and \
         those within 0.03 of it; interval: nine tenths of the shares when problems are resampled; \
         equivalent: intervals of both shares overlap",
    )
}

/// How many more problems each operator makes a method reach.
fn operator_table(findings: &RaceFindings) -> Table {
    let rows = LADDER.windows(2).map(|pair| {
        let [(without, _), (with, operator)] = [pair[0], pair[1]];
        let mut row = vec![operator.into(), Cell::Code(with.to_owned())];
        row.extend(races().map(|(group, read_out)| {
            let [without, with] = [without, with].map(|method| findings.reached(method, group, read_out));
            Cell::of(
                with.zip(without).map(|(with, without)| with as f64 - without as f64),
                Cell::Number,
                "not among the methods",
            )
        }));
        row
    });
    let mut heads = columns("operator | with it");
    heads.extend(races().map(|(group, read_out)| {
        TableColumn::number(format!("{}, {}", words_of(group), places_of(read_out)))
    }));
    Table::of("Problems gained by each operator", heads, rows)
        .note("problems in which 1 % is reached with it, less those without it")
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
    let heads = "problem | integrator | outputs, time factors | > half the budget, cells | > budget, cells | > twice the budget, cells";
    Table::of("The problems with their outputs and budgets", columns(heads), rows)
}

/// Performance profiles of a group and read-out: staircases, those of the answers and of known methods in colour.
fn profile_figure(findings: &RaceFindings, group: Group, read_out: ReadOut) -> Figure {
    let best = findings.best(group, read_out).map_or("", |one| &one.method);
    let whole = findings.best(group, read_out).map_or("No method reaches 1 %".to_owned(), |one| {
        format!("{} reaches 1 % in {} of {}", one.method, one.reached, one.of)
    });
    let title = format!("{whole}: {}, {}", words_of(group), places_of(read_out));
    let mut chart = Chart::new(
        title,
        ChartAxis::log10("work to 1 %, over that of the cheapest method").between(1.0, LARGEST_TAU),
        ChartAxis::linear("share of problems, each family weighs the same").between(0.0, 1.0),
    );
    chart.names_at_ends = true;
    chart.size = Size { width: 620.0, plot_height: 440.0 };
    let staircase = |steps: &[(f64, f64)]| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (tau, share) in steps.iter().filter(|(tau, _)| *tau <= LARGEST_TAU) {
            points.extend(points.last().map(|(_, before)| (*tau, *before)));
            points.push((*tau, *share));
        }
        points
    };
    let profiles = findings.profiles(group, read_out, RaceQuantity::All);
    let is_shown = |method: &str| SHOWN.iter().any(|(name, _)| name.trim_start_matches("TL-") == method);
    let is_named = |method: &str| method == best || is_shown(method.trim_start_matches("TL-"));
    let (named, others): (Vec<_>, Vec<_>) = profiles.iter().partition(|one| is_named(&one.method));
    let slots = slots(&named.iter().map(|one| one.method.as_str()).collect::<Vec<_>>());
    chart.series.extend(
        others.iter().map(|one| Series::new(one.method.clone(), staircase(&one.steps)).style(Style::Context)),
    );
    chart.series.extend(named.iter().zip(slots).map(|(one, slot)| {
        Series::new(one.method.clone(), staircase(&one.steps)).style(Style::Line).slot(slot)
    }));
    let caption = "Left end: how often a method is the cheapest; right end: how often it reaches 1 % (Dolan \
                   & Moré; only the first place in a profile is a ranking).";
    Figure::new(format!("race-profile-{}-{}", group.name(), read_out.name()), chart, caption)
}

/// The page of every method: answers, profiles, budgets, the whole matrix and properties.
pub fn matrix_page(findings: &RaceFindings) -> Page {
    let by_read_out = |blocks: &dyn Fn(ReadOut) -> Vec<Block>| {
        Block::Switch(ReadOut::BOTH.map(|one| (capitalised(places_of(one)), blocks(one))).to_vec())
    };
    let profiles = races().map(|(group, read_out)| {
        let words = format!("{}, {}", capitalised(words_of(group)), places_of(read_out));
        (words, vec![Block::Figure(profile_figure(findings, group, read_out))])
    });
    let mut sections = vec![
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
                by_read_out(&|one| vec![Block::Table(matrix(&findings.situations, one))]),
            ],
        ),
    ];
    sections.push(Section::new(
        "How to read",
        "rules",
        vec![Block::Paragraph(
            sentence::filled(
                include_str!("race-rules.md"),
                &Rules { tolerance: ARRIVED, most_work: MOST_WORK },
            )
            .unwrap_or_default(),
        )],
    ));
    if !findings.properties.is_empty() {
        let table = Block::Table(property_table(findings));
        sections.push(Section::new("Properties other than errors", "properties", vec![table]));
    }
    Page {
        title: "Which method reaches one per cent?".to_owned(),
        links: page_links(&sections),
        sections,
        is_wide: true,
        files: Some("race".to_owned()),
        ..Page::default()
    }
}

/// The numbers of the rules.
#[derive(Serialize)]
struct Rules {
    /// The finishing line.
    tolerance: f64,
    /// Work that a mesh may take in one dimension and in the plane, s.
    most_work: [f64; 2],
}

/// The links at the top of the page: back, its sections, and its tables.
fn page_links(sections: &[Section]) -> Vec<(String, String)> {
    let link = |words: &str, target: &str| (words.to_owned(), target.to_owned());
    let of_sections = sections.iter().map(|one| (one.heading.clone(), format!("#{}", one.id)));
    [link("All answers", "index.html"), link("Studies", "studies/index.html")]
        .into_iter()
        .chain(of_sections)
        .chain([
            link("Method names", "studies/index.html#names"),
            link("race.csv", "tables/race.csv"),
            link("profile.csv", "tables/profile.csv"),
        ])
        .collect()
}

/// The cost to 1 % of every method in every problem, ms.
fn matrix(situations: &[Situation], read_out: ReadOut) -> Table {
    let terms = Terms::usual(read_out);
    let mut heads = columns("problem");
    heads.extend(CONTENDERS.iter().map(|one| TableColumn::number(one.name)));
    let rows = situations.iter().map(|situation| {
        let target = page_of(&situation.study);
        let least = situation.cheapest(&terms).map(|(_, cost)| cost);
        let cell = |entry: &Entry| {
            let arrival = situation.arrival(entry, &terms);
            let cost = arrival.as_ref().map(|one| one.cost);
            let (shade, words) = match (cost.zip(least), situation.reason(entry, &terms)) {
                (Some((cost, least)), _) => (Shade::of_ratio(cost / least), number::two_digits(1e3 * cost)),
                (_, Some(Reason::NotApplicable)) => (Shade::Empty, "–".to_owned()),
                (_, reason) => (Shade::Failed, reason.map_or("", Reason::shown).to_owned()),
            };
            let title = match (&arrival, &entry.refused) {
                (Some(one), _) => format!("{}: {} cells, {}", entry.contender, one.cells, one.step),
                (_, Some(why)) => format!("{}: {why}", entry.contender),
                _ => format!(
                    "{}: {} on {} cells",
                    entry.contender,
                    situation.reason(entry, &terms).map_or(String::new(), reason_words),
                    entry.levels.last().map_or(0, |level| level.cells)
                ),
            };
            Cell::Shaded { shade, words, value: cost, title, target: target.clone() }
        };
        let mut row = vec![Cell::Link { words: situation.title.clone(), target: target.clone() }];
        row.extend(CONTENDERS.iter().map(|one| match situation.entry(one.name) {
            Some(entry) => cell(entry),
            None => Cell::missing("same run as without TL-"),
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
            Cell::of(step, Cell::Measured, "not observed"),
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
    .note("skeleton, water: asymmetry of the stiffness; round-off if the power of the forces equals that of \
           the stresses")
}
