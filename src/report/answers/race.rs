//! Which method should I take? The race's sentences, profiles and panels, and the page with its full matrix.

use crate::case::contender::PAPERS;
use crate::case::grouping::grouped;
use crate::race::RaceFindings;
use crate::race::family::FamilyCurve;
use crate::race::finish::Question as RaceQuestion;
use crate::race::finish::{RaceQuantity, Reason};
use crate::race::profile::TIE;
use crate::race::sensitivity::Change;
use crate::race::situation::{Entry, Situation};
use crate::render::RenderError;
use crate::render::chart::{Chart, ChartAxis, Naming, Rule, Series, Size, Style, slots};
use crate::render::number;
use crate::render::page::{Block, Figure, Page, Section, slug};
use crate::render::table::{Cell, Mood, Shade, Table, TableColumn, columns};
use crate::report::answers::{Question, page_of};
use crate::report::blocks::labels::capitalised;
use crate::report::templates;
use minijinja::Environment;
use minijinja::value::Serde;

const QUESTION: Question = Question { heading: "Which method should I take?", id: "choice" };

/// Methods that are named and coloured in the figures.
const NAMED: usize = 6;
/// Methods that a reader looks for, after the best ones.
const KNOWN: [&str; 5] = [PAPERS, "GIMP-SRI-patch", "MPM", "VP-Bbar", "GIMP-Bbar-patch"];
/// The best ones that are named.
const BEST: usize = 3;
/// Multiples of the best cost that a profile shows.
const LARGEST_TAU: f64 = 1000.0;
/// Errors that the panels of the families show; those beyond stand at the frame.
const LEAST_ERROR: f64 = 1e-4;
const LARGEST_ERROR: f64 = 3.0;
/// The page of the full matrix.
const MATRIX: &str = "race.html";

/// Words for the families of situations.
const FAMILIES: [(&str, &str); 8] = [
    ("column", "columns at small strain"),
    ("points", "points out of place"),
    ("waves", "waves"),
    ("layer", "undrained layers and slabs"),
    ("strain", "columns at large strain"),
    ("plane", "large strain in the plane"),
    ("soil", "layers and yielding"),
    ("footing", "a footing at collapse"),
];

fn words_of(family: &str) -> &str {
    FAMILIES.iter().find(|(known, _)| *known == family).map_or(family, |(_, words)| words)
}

/// The sentences at the head of the page.
pub(crate) fn lead(findings: &RaceFindings) -> Result<String, RenderError> {
    templates::render(&environment(findings)?, "race-answers", findings)
}

/// The templates with what the race's need to know.
pub(crate) fn environment(findings: &RaceFindings) -> Result<Environment<'static>, RenderError> {
    let mut environment = templates::environment()?;
    let titles: Vec<(String, String)> =
        findings.situations.iter().map(|one| (one.name.clone(), one.title.clone())).collect();
    environment.add_filter("title_of", move |name: String| {
        titles.iter().find(|(known, _)| *known == name).map_or(name.clone(), |(_, title)| title.clone())
    });
    environment.add_filter("reason", |reason: Serde<Reason>| reason.0.words().to_owned());
    environment.add_filter("change", |change: Serde<Change>| change_words(&change.0));
    Ok(environment)
}

/// What is changed, in words.
fn change_words(change: &Change) -> String {
    match change {
        Change::WithoutFamily(family) => format!("without {}", words_of(family)),
        Change::Quantity(quantity) => format!("for {} alone", quantity_words(*quantity)),
        Change::Threshold(threshold) => format!("at {} %", 100.0 * threshold),
    }
}

fn quantity_words(quantity: RaceQuantity) -> &'static str {
    match quantity {
        RaceQuantity::Pressure => "pressure",
        RaceQuantity::Stress => "effective stress",
        RaceQuantity::Settlement => "settlement",
        RaceQuantity::All => "all three",
    }
}

/// The profiles with a switch, a panel per family, and what the answers rest on.
pub(crate) fn section(findings: &RaceFindings) -> Result<Section, RenderError> {
    let named = named(findings);
    let mut views: Vec<(String, Vec<Block>)> = [3, 0, 1, 2]
        .map(|place| RaceQuantity::EACH[place])
        .into_iter()
        .map(|quantity| {
            let figure = profile_figure(findings, RaceQuestion::Moving, quantity, &named);
            (capitalised(quantity_words(quantity)), vec![Block::Figure(figure)])
        })
        .collect();
    let total: Vec<String> = findings.answer(RaceQuestion::Total).map_or(Vec::new(), |answer| {
        answer.ranked.iter().take(NAMED).map(|choice| choice.method.clone()).collect()
    });
    if !total.is_empty() {
        let figure = profile_figure(findings, RaceQuestion::Total, RaceQuantity::All, &total);
        views.push(("The mesh follows the soil".to_owned(), vec![Block::Figure(figure)]));
    }
    let panels = findings
        .families()
        .into_iter()
        .map(|(family, situations)| panel(findings, family, &situations, &named))
        .collect();
    let limits = templates::render(&environment(findings)?, "race-limits", findings)?;
    let mut blocks = vec![
        Block::Switch(views),
        Block::Figures(panels),
        Block::Paragraph(limits),
        Block::Table(trade_table(findings)),
    ];
    let link = format!(
        "[Every method in every situation]({MATRIX}) · [race.csv](tables/race.csv) · [profile.csv](tables/profile.csv)"
    );
    blocks.push(Block::Paragraph(link));
    Ok(Section::new(QUESTION.heading, QUESTION.id, blocks))
}

/// The methods with a colour: the best of the moving ones, then those that a reader looks for.
fn named(findings: &RaceFindings) -> Vec<String> {
    let ranked = findings.answer(RaceQuestion::Moving).map_or(&[][..], |answer| &answer.ranked);
    let best = ranked.iter().take(BEST).map(|choice| choice.method.as_str());
    let mut named: Vec<String> = Vec::new();
    for name in best.chain(KNOWN) {
        if named.len() < NAMED && named.iter().all(|known| known != name) {
            named.push(name.to_owned());
        }
    }
    named
}

/// The colours of the named methods.
fn slots_of(named: &[String]) -> Vec<usize> {
    slots(&named.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Performance profiles of one question and quantity: staircases, the named ones in colour.
fn profile_figure(
    findings: &RaceFindings,
    question: RaceQuestion,
    quantity: RaceQuantity,
    named: &[String],
) -> Figure {
    let of = if quantity == RaceQuantity::All {
        "pressure, effective stress and settlement"
    } else {
        quantity_words(quantity)
    };
    let mut chart = Chart::new(
        "Performance profile (Dolan & Moré): higher and further left is better",
        ChartAxis::log10(format!("cost to 1 % of {of}, over that of the fastest method"))
            .between(1.0, LARGEST_TAU),
        ChartAxis::linear("share of situations").between(0.0, 1.0),
    );
    chart.size = Size { width: 1300.0, plot_height: 150.0, equal_units: false };
    chart.naming = Naming::Ends;
    let staircase = |steps: &[(f64, f64)]| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (tau, share) in steps.iter().filter(|(tau, _)| *tau <= LARGEST_TAU) {
            points.extend(points.last().map(|(_, before)| (*tau, *before)));
            points.push((*tau, *share));
        }
        points.extend(points.last().map(|(_, share)| (LARGEST_TAU, *share)));
        points
    };
    let profiles = findings.profiles(question, quantity);
    let others = profiles.iter().filter(|one| !named.contains(&one.contender));
    chart.series.extend(
        others.map(|one| Series::new(one.contender.clone(), staircase(&one.steps)).style(Style::Context)),
    );
    for (name, slot) in named.iter().zip(slots_of(named)) {
        if let Some(one) = profiles.iter().find(|one| one.contender == *name) {
            chart.series.push(Series::new(name.clone(), staircase(&one.steps)).style(Style::Line).slot(slot));
        }
    }
    let caption = match (question, quantity) {
        (RaceQuestion::Moving, RaceQuantity::All) => {
            "Grey: other methods. Left end: how often a method is the fastest, ties included; right end: how often it reaches 1 % at all."
        }
        (RaceQuestion::Moving, _) => "",
        (RaceQuestion::Total, _) => "Total Lagrangian methods alone.",
    };
    Figure::new(format!("race-profile-{}-{}", question.name(), quantity.name()), chart, caption)
}

/// Error over work in a family, a line per method, and the methods that do not arrive.
fn panel(findings: &RaceFindings, family: &str, situations: &[&Situation], named: &[String]) -> Figure {
    let mut chart = Chart::new(
        capitalised(words_of(family)),
        ChartAxis::log10("counted work (s)"),
        ChartAxis::log10("largest error").between(LEAST_ERROR, LARGEST_ERROR),
    );
    chart.size = Size { width: 340.0, plot_height: 82.0, equal_units: false };
    chart.naming = Naming::Hover;
    chart.rules.push(Rule { at: 1e-2, label: "1 %".to_owned() });
    let line = |curve: &FamilyCurve| {
        let inside = |(cost, error): &(f64, f64)| (*cost, error.clamp(LEAST_ERROR, LARGEST_ERROR));
        Series::new(curve.contender.clone(), curve.points.iter().map(inside).collect())
    };
    let others = findings.curves(family).filter(|curve| !named.contains(&curve.contender));
    chart.series.extend(others.map(|curve| line(curve).style(Style::Context)));
    for (name, slot) in named.iter().zip(slots_of(named)) {
        let curve = findings.curves(family).find(|curve| curve.contender == *name);
        chart.series.extend(curve.map(|curve| line(curve).style(Style::Line).slot(slot)));
    }
    Figure::new(format!("race-family-{}", slug(family)), chart, strip(situations, named))
}

/// The named methods that do not arrive in some situations of a family, by their reasons.
fn strip(situations: &[&Situation], named: &[String]) -> String {
    let mut by_reason: Vec<(&str, Vec<String>)> = Vec::new();
    for name in named {
        let entries =
            situations.iter().filter_map(|one| one.entries.iter().find(|entry| entry.contender == *name));
        let missed = entries.filter_map(|entry| entry.reason.as_ref());
        for (reason, missed) in grouped(missed, |reason| reason.words()) {
            let told = if situations.len() == 1 {
                format!("`{name}`")
            } else {
                format!("`{name}` {}/{}", missed.len(), situations.len())
            };
            match by_reason.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, names)) => names.push(told),
                None => by_reason.push((reason, vec![told])),
            }
        }
    }
    if by_reason.is_empty() {
        return "✓ the named methods all arrive".to_owned();
    }
    let told = by_reason.iter().map(|(reason, names)| format!("✗ {reason}: {}", names.join(", ")));
    told.collect::<Vec<_>>().join(" · ")
}

/// What each operator buys and costs.
fn trade_table(findings: &RaceFindings) -> Table {
    let times =
        |ratio: Option<f64>| ratio.map_or("–".to_owned(), |ratio| format!("× {}", number::short(ratio)));
    let rows = findings.trades.iter().map(|trade| {
        let mut row = vec![Cell::Text(trade.operator.clone()), Cell::Code(trade.methods[1].clone())];
        row.push(Cell::Text(times(trade.cost_ratio)));
        row.extend(trade.effects.iter().take(3).map(|effect| Cell::Text(times(effect.error_ratio))));
        let all = trade.effects.last();
        row.push(Cell::Text(all.map_or(String::new(), |all| format!("+{} −{}", all.won, all.lost))));
        row
    });
    Table::of(
        "What each operator buys and costs",
        columns("operator | with it | > cost | > pressure | > effective stress | > settlement | > situations that reach 1 %"),
        rows,
    )
    .note(
        "each row over the one above, the first over GIMP; cost and errors on equal cells, geometric means over families; errors \
         below 0.1 % count as 0.1 %",
    )
}

/// The choice in each family.
fn family_table(findings: &RaceFindings) -> Table {
    let rows = findings.families().into_iter().map(|(family, situations)| {
        let mut row = vec![Cell::Text(capitalised(words_of(family))), Cell::Count(situations.len() as u64)];
        for question in RaceQuestion::BOTH {
            let choice = findings
                .answer(question)
                .and_then(|answer| answer.by_family.iter().find(|one| one.family == family)?.choice.as_ref());
            row.push(
                choice.map_or(Cell::missing("no method reaches 1 %"), |choice| {
                    Cell::Code(choice.method.clone())
                }),
            );
            row.push(Cell::of(choice.map(|choice| choice.reached), Cell::Percent, "no method reaches 1 %"));
        }
        row
    });
    Table::of(
        "The choice in each family",
        columns("family | > situations | points move | > reaches 1 % | the mesh follows | > reaches 1 %"),
        rows,
    )
}

/// The choice when the race is changed.
fn change_table(findings: &RaceFindings) -> Table {
    let changes: Vec<&Change> = findings
        .answers
        .first()
        .map_or(Vec::new(), |answer| answer.variants.iter().map(|one| &one.change).collect());
    let rows = changes.into_iter().map(|change| {
        let mut row = vec![Cell::Text(capitalised(&change_words(change)))];
        for question in RaceQuestion::BOTH {
            let variant = findings
                .answer(question)
                .and_then(|answer| answer.variants.iter().find(|variant| variant.change == *change));
            let told = variant.and_then(|variant| Some((variant.holds, variant.choice.as_ref()?)));
            row.push(told.map_or(Cell::missing("no method reaches it"), |(holds, choice)| {
                let words = format!("{} ({})", choice.method, number::rounded_percent(choice.reached));
                Cell::Verdict(if holds { Mood::Pass } else { Mood::Note }, words)
            }));
        }
        row
    });
    Table::of("The choice when the race is changed", columns("change | points move | the mesh follows"), rows)
        .note("✓ the same method; in brackets the share of situations in which it arrives")
}

/// The page of the full matrix: costs, errors on equal cells, and properties.
pub fn matrix_page(findings: &RaceFindings) -> Page {
    let views = vec![
        (
            "Cost to 1 %, ms".to_owned(),
            vec![Block::Table(matrix(&findings.situations, &|situation, entry| cost_cell(situation, entry)))],
        ),
        (
            "Largest error on equal cells, %".to_owned(),
            vec![Block::Table(matrix(&findings.situations, &|situation, entry| {
                error_cell(situation, entry)
            }))],
        ),
    ];
    let mut sections = vec![Section::new(
        "Every method in every situation",
        "matrix",
        vec![
            Block::Paragraph(
                "Cost: counted work to 1 % of pressure, effective stress and settlement; in the plane of the displacement, under the footing \
                 of the load. Shades: as cheap as the best of the row, within a factor of 2, within 10, beyond. ✗: 1 % is not reached; \
                 – : excluded by definition. A cell leads to the figure of its situation."
                    .to_owned(),
            ),
            Block::Switch(views),
        ],
    )];
    sections.push(Section::new(
        "The choice in each family, and when the race is changed",
        "choices",
        vec![Block::Table(family_table(findings)), Block::Table(change_table(findings))],
    ));
    if !findings.properties.is_empty() {
        sections.push(Section::new(
            "Properties that are no errors",
            "properties",
            vec![Block::Table(property_table(findings))],
        ));
    }
    if !findings.correlations.is_empty() {
        let rows = findings.correlations.iter().map(|one| {
            vec![
                one.situations[0].as_str().into(),
                one.situations[1].as_str().into(),
                Cell::Number(one.value),
            ]
        });
        let table = Table::of(
            "The situations that are most alike",
            columns("situation | situation | > correlation"),
            rows,
        )
        .note("of the logarithms of the largest errors on equal cells over all methods");
        sections.push(Section::new(
            "How alike are the situations?",
            "correlation",
            vec![Block::Table(table)],
        ));
    }
    Page {
        title: "The race to one per cent".to_owned(),
        lead: "[Back to the answers](index.html). Every number: [race.csv](tables/race.csv).".to_owned(),
        sections,
        is_wide: true,
        files: Some("race".to_owned()),
        ..Page::default()
    }
}

/// A cell of the matrix: its shade, its words, and its number where there is one.
type Shown = (Shade, String, Option<f64>);

fn matrix(situations: &[Situation], show: &dyn Fn(&Situation, &Entry) -> Shown) -> Table {
    let names = situations.first().map_or(&[][..], |one| &one.entries);
    let mut heads = columns("situation");
    heads.extend(names.iter().map(|entry| TableColumn::number(entry.contender.as_str())));
    let rows = situations.iter().map(|situation| {
        let target = format!("{}#figure-{}-race-all", page_of(&situation.study), slug(&situation.study));
        let mut row = vec![Cell::Link { words: situation.title.clone(), target: page_of(&situation.study) }];
        row.extend(situation.entries.iter().map(|entry| {
            let (shade, words, value) = show(situation, entry);
            let reason = entry.reason.as_ref().map_or("arrives", Reason::words);
            let detail = if entry.detail.is_empty() { String::new() } else { format!(", {}", entry.detail) };
            let title = format!("{}: {reason}{detail}", entry.contender);
            Cell::Shaded { shade, words, value, title, target: target.clone() }
        }));
        row
    });
    Table::of("", heads, rows)
}

fn cost_cell(situation: &Situation, entry: &Entry) -> Shown {
    let least = situation.entries.iter().filter_map(|one| one.costs[1]).min_by(f64::total_cmp);
    match (entry.costs[1], least) {
        (Some(cost), Some(least)) => {
            (Shade::of_ratio(cost / least / TIE), number::short(1e3 * cost), Some(cost))
        }
        _ if entry.reason == Some(Reason::ByDefinition) => (Shade::Empty, "–".to_owned(), None),
        _ => (Shade::Failed, "✗".to_owned(), None),
    }
}

fn error_cell(situation: &Situation, entry: &Entry) -> Shown {
    let least = situation.entries.iter().filter_map(Entry::largest_error).min_by(f64::total_cmp);
    match (entry.largest_error(), least) {
        (Some(error), Some(least)) => {
            let tenth = |error: f64| error.max(crate::race::finish::NEGLIGIBLE);
            (Shade::of_ratio(tenth(error) / tenth(least) / 1.02), number::short(100.0 * error), Some(error))
        }
        _ if entry.reason == Some(Reason::ByDefinition) => (Shade::Empty, "–".to_owned(), None),
        _ => (Shade::Failed, "✗".to_owned(), None),
    }
}

/// Critical step, rest and power, per method.
fn property_table(findings: &RaceFindings) -> Table {
    let names = findings.properties.first().map_or(&[][..], |one| &one.entries);
    let rows = names.iter().map(|first| {
        let of_method = || {
            findings
                .properties
                .iter()
                .filter_map(|one| one.entries.iter().find(|entry| entry.contender == first.contender))
        };
        let step =
            of_method().filter(|entry| entry.spurious_velocity.is_none()).find_map(|entry| entry.step_ratio);
        let asymmetry = of_method().find_map(|entry| entry.asymmetry);
        let velocity = of_method().find_map(|entry| entry.spurious_velocity);
        vec![
            Cell::Code(first.contender.clone()),
            Cell::of(step, Cell::Number, "not observed"),
            Cell::of(velocity, Cell::Error, "not run"),
            Cell::of(asymmetry.map(|one| one[0]), Cell::Error, "not measured"),
            Cell::of(asymmetry.map(|one| one[1]), Cell::Error, "not measured"),
        ]
    });
    Table::of(
        "",
        columns("method | > critical step over the formula's | > velocity at rest over k | > skeleton | > water"),
        rows,
    )
    .note("skeleton, water: asymmetry of the stiffness; round-off where the forces do the power of the stresses")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::race::finish::Level;
    use crate::race::situation::THRESHOLDS;

    /// A situation of some contenders with the cost of 1 %, or with none.
    fn situation(name: &str, costs: &[(&str, Option<f64>)]) -> Situation {
        let entry = |(contender, cost): &(&str, Option<f64>)| {
            let error = if cost.is_some() { 0.009 } else { 0.5 };
            let levels = [(4, 0.1, 0.6), (8, 1.0, error)].map(|(cells, share, error)| Level {
                cells,
                cost: share * cost.unwrap_or(2.0),
                seconds: None,
                errors: [Some(error); 3],
            });
            let levels = levels.to_vec();
            let costs = THRESHOLDS
                .map(|threshold| crate::race::finish::cost_to(&levels, RaceQuantity::All, threshold));
            Entry {
                contender: (*contender).to_owned(),
                costs,
                reason: costs[1].is_none().then_some(Reason::Locks),
                errors: [Some(error); 3],
                cost: *cost,
                levels,
                ..Entry::default()
            }
        };
        Situation {
            family: name.split('-').next().unwrap_or_default().to_owned(),
            name: name.to_owned(),
            title: format!("the {name}"),
            study: format!("race-{name}"),
            moves: false,
            integrator: "implicit".to_owned(),
            is_property: false,
            budget: 8,
            common_cells: 8,
            entries: costs.iter().map(entry).collect(),
        }
    }

    #[test]
    fn every_branch_of_the_templates_says_what_the_findings_are() {
        let costs = [("GIMP", Some(1.0)), ("MPM", Some(5.0)), ("TL-GC-SRI-patch", Some(0.5))];
        let locked = [("GIMP", None), ("MPM", Some(1.0)), ("TL-GC-SRI-patch", None)];
        let mut findings = RaceFindings::from_situations(vec![
            situation("column-a", &costs),
            situation("waves-b", &costs),
            situation("layer-c", &locked),
        ]);
        let told = lead(&findings).expect("filled");
        for part in [
            "**Where points move through the mesh, take `MPM`:** it reaches 1 % of pressure, effective stress and settlement in \
             100 % of the situations, in 33 % at no more than twice the cost of the fastest method.",
            "take `TL-GC-SRI-patch`:** it reaches 1 % in 67 %, in 67 % at no more than twice the cost of the fastest of 1 total",
            "3 situations (3 implicit) in 3 families of equal weight, 2 methods. `TL-GC-SRI-patch` misses 1 % in 1. Costs are",
            "Contact, separation and flow are not tested.",
        ] {
            assert!(told.contains(part), "{part}\n{told}");
        }
        let limits = environment(&findings)
            .and_then(|environment| templates::render(&environment, "race-limits", &findings))
            .expect("filled");
        for part in [
            "**`MPM`** reaches 1 % in every situation.",
            "**`TL-GC-SRI-patch`** misses 1 % in 1 of 3 situations: the layer-c (locks).",
            "it changes without undrained layers and slabs (`GIMP`, 100 %)",
        ] {
            assert!(limits.contains(part), "{part}\n{limits}");
        }
        findings.answers.clear();
        assert!(lead(&findings).expect("filled").contains("No method reaches 1 % in any situation."));
    }

    #[test]
    fn a_panel_names_who_does_not_arrive_and_a_profile_its_best_and_known_methods() {
        let costs = [("GIMP", None), ("MPM", Some(1.0)), ("GC-SRI-patch", Some(2.0))];
        let findings =
            RaceFindings::from_situations(vec![situation("layer-a", &costs), situation("layer-b", &costs)]);
        let named = named(&findings);
        assert_eq!(named, ["MPM", "GC-SRI-patch", "GIMP", "GIMP-SRI-patch", "VP-Bbar", "GIMP-Bbar-patch"]);
        let situations: Vec<&Situation> = findings.situations.iter().collect();
        let panel = panel(&findings, "layer", &situations, &named);
        assert_eq!(panel.caption, "✗ locks: `GIMP` 2/2");
        assert_eq!(strip(&situations, &named[..2]), "✓ the named methods all arrive");
        // Each miss has its own reason.
        let mut other = situations[1].clone();
        other.entries[0].reason = Some(Reason::Stalls);
        assert_eq!(strip(&[situations[0], &other], &named), "✗ locks: `GIMP` 1/2 · ✗ stalls: `GIMP` 1/2");
        let figure = profile_figure(&findings, RaceQuestion::Moving, RaceQuantity::All, &named);
        let stairs =
            &figure.chart.series.iter().find(|one| one.name == "GC-SRI-patch").expect("drawn").points;
        // Twice the best cost: from nothing to all at 2.
        assert_eq!(stairs[0], (1.0, 0.0));
        assert!(
            stairs.contains(&(2.0, 0.0))
                && stairs.contains(&(2.0, 1.0))
                && stairs.last() == Some(&(LARGEST_TAU, 1.0))
        );
    }
}
