//! Does the method converge, and to what? One row per method, small strain and large strain side by side.

use crate::case::contender::PAPERS;
use crate::case::quantity::{Quantity, Sample};
use crate::render::answers::regime::{MethodPath, Regime};
use crate::render::answers::{Answer, Question, short};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::labels::{CONVERGENCE, QUOTED_CELLS, distinct, is_settled, order_or_class};
use crate::render::report::{StudyResults, labels, refinement};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use oedometer_convergence::Class;

const QUESTION: Question = Question { heading: "Does the method converge, and to what?", id: "converges" };

/// Headings of the measures of [`CONVERGENCE`].
const HEADINGS: [&str; 4] = ["p, points", "p, centres", "σ′, points", "settlement"];

/// Sentence, table and figure.
pub fn answer(
    results: &[StudyResults<'_>],
    small: Option<&Regime<'_>>,
    large: Option<&Regime<'_>>,
) -> Answer {
    let regimes: Vec<(&str, &Regime<'_>)> = [("small strain", small), ("large strain", large)]
        .into_iter()
        .filter_map(|(name, one)| Some((name, one?)))
        .collect();
    if regimes.is_empty() {
        return None;
    }
    // Beside the race and timed studies, which have sections of their own on what to take and what it costs.
    let is_alone = !results.iter().any(|one| one.study.is_race || one.study.timing_repeats > 1);
    let sentences = regimes.iter().filter_map(|(name, regime)| {
        let advice =
            if is_alone { better(regime).unwrap_or_default() + &cost(regime) } else { String::new() };
        Some(sentence(name, regime)? + &advice)
    });
    let sentences: Vec<String> = sentences.collect();
    let studies = regimes.iter().flat_map(|(_, regime)| regime.methods.iter().map(|one| one.study));
    let mut blocks = vec![Block::Table(short(table(&regimes), "in the studies"))];
    blocks.extend(small.and_then(|regime| figure(results, regime)).map(Block::Figure));
    Some(QUESTION.told(&sentences.join(" "), studies, blocks))
}

/// The method of the sentence.
fn told<'r>(regime: &'r Regime<'_>) -> Option<&'r MethodPath<'r>> {
    regime.method(PAPERS).or(regime.methods.first())
}

/// What the paper's method, or the first of the methods, converges to and how fast; where an order is not settled, the
/// class instead.
fn sentence(name: &str, regime: &Regime<'_>) -> Option<String> {
    let one = told(regime)?;
    let of = [
        ("in the pressure at the points", Quantity::Pressure, Sample::Points),
        ("in the effective stress", Quantity::EffectiveStress, Sample::Points),
        ("in the settlement", Quantity::Settlement, Sample::Surface),
    ];
    let found = of.map(|(words, quantity, sample)| {
        let class = regime.summary(one, quantity, sample).classification;
        let order = if class.order.is_some() { "order " } else { "" };
        (is_settled(class.class), format!("{order}{} {words}", order_or_class(&class)))
    });
    let converges = found.iter().all(|(is_settled, _)| *is_settled);
    let orders = found.map(|(_, words)| words).join(", ");
    let whose = if one.method == PAPERS { ", the paper's method," } else { "" };
    let strain = match regime.strain() {
        Some(strain) if name == "large strain" => {
            format!("At a final strain of {},", number::percent(strain))
        }
        _ => format!("At {name}"),
    };
    let error = regime.error(one, Quantity::Pressure, Sample::Points, QUOTED_CELLS);
    let error = error.map_or(String::new(), |error| {
        format!("; on {QUOTED_CELLS} cells the error of its pressure is {}", number::percent(error))
    });
    let (method, solution) = (&one.method, labels::solution(regime.reference));
    Some(if converges {
        format!("{strain} `{method}`{whose} converges to {solution}: {orders}{error}.")
    } else {
        format!(
            "{strain} `{method}`{whose} does not have a settled order against {solution} everywhere: {orders}{error}."
        )
    })
}

/// The method to take instead of the one of the sentence: where the largest of its errors is at most half as large.
fn better(regime: &Regime<'_>) -> Option<String> {
    let largest = |one| regime.largest_error(one).unwrap_or(f64::INFINITY);
    let own = largest(told(regime)?);
    let least = regime.methods.iter().min_by(|a, b| largest(a).total_cmp(&largest(b)))?;
    let instead = Some(largest(least)).filter(|instead| 2.0 * instead <= own)?;
    let [instead, own] = [instead, own].map(number::percent);
    let (method, cells) = (&least.method, regime.finest_cells);
    Some(format!(
        " Take `{method}` instead: the largest of its errors on {cells} cells is {instead}, against {own}."
    ))
}

/// The coarsest meshes with a pressure error of 1 %, of studies that time nothing by repeats, and what these runs took.
fn cost(regime: &Regime<'_>) -> String {
    let within = regime.methods.iter().filter_map(|one| {
        let is_within = |cells| Some(regime.error(one, Quantity::Pressure, Sample::Points, cells)? <= WITHIN);
        // From coarse to fine; single times are too rough to choose by.
        let run = one.path.records.iter().find(|record| is_within(record.case.cells) == Some(true))?;
        let seconds = run.wall.iter().map(|sample| sample.seconds).reduce(f64::min)?;
        Some((seconds, format!("`{}` {} on {} cells", one.method, number::seconds(seconds), run.case.cells)))
    });
    let mut within: Vec<(f64, String)> = within.collect();
    within.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ways = within.into_iter().map(|(_, way)| way).collect::<Vec<_>>().join(", ");
    let (share, time) = (number::number(100.0 * WITHIN), regime.time_factor);
    match ways.as_str() {
        "" => format!(" No run has an error of the pressure below {share} % at T_v = {time}."),
        _ => format!(
            " A pressure within {share} % at T_v = {time} costs, each timed once beside others: {ways}."
        ),
    }
}

/// The error whose cost is told.
const WITHIN: f64 = 0.01;

fn table(regimes: &[(&str, &Regime<'_>)]) -> Table {
    let all =
        distinct(regimes.iter().flat_map(|(_, regime)| regime.methods.iter().map(|one| one.method.as_str())));
    let mut ranked: Vec<&str> = all.clone();
    // Methods that answer most come first, then those with the smaller error where it is hardest.
    ranked.sort_by(|a, b| {
        let tried = |name: &str| regimes.iter().filter(|(_, regime)| regime.method(name).is_some()).count();
        let error = |name: &str| {
            let last = regimes.iter().rev().find_map(|(_, regime)| Some((regime, regime.method(name)?)));
            last.and_then(|(regime, one)| regime.largest_error(one)).unwrap_or(f64::INFINITY)
        };
        let is_papers = |name: &str| usize::from(name == PAPERS);
        is_papers(b).cmp(&is_papers(a)).then(tried(b).cmp(&tried(a))).then(error(a).total_cmp(&error(b)))
    });
    let mut columns = columns("method");
    for (name, _) in regimes {
        let of = if regimes.len() > 1 { format!("{name}: ") } else { String::new() };
        columns.extend(HEADINGS.map(|what| TableColumn::text(format!("{of}{what}"))));
    }
    let rows = ranked.iter().map(|name| {
        let mut row = vec![method_cell(name)];
        for (_, regime) in regimes {
            row.extend(CONVERGENCE.map(|(quantity, sample)| match regime.method(name) {
                Some(one) => quote(regime, one, quantity, sample),
                None => Cell::missing("not tried on this column with at least three meshes"),
            }));
        }
        row
    });
    let at: Vec<String> = regimes
        .iter()
        .map(|(name, regime)| {
            format!("{name}: T_v = {}, against {}", regime.time_factor, labels::solution(regime.reference))
        })
        .collect();
    Table::of(format!("Order on the finest three meshes, error on {QUOTED_CELLS} cells"), columns, rows).note(
        format!(
            "{}; relative L_2 norm over the volume, |s/s_exact − 1| of the settlement. {}",
            at.join("; "),
            labels::CLASSES
        ),
    )
}

/// A method's name, with a mark at the paper's.
fn method_cell(name: &str) -> Cell {
    if name == PAPERS {
        Cell::Verdict(Mood::Note, format!("{name}, the paper's"))
    } else {
        Cell::Code(name.to_owned())
    }
}

/// Order and error in a few characters.
fn quote(regime: &Regime<'_>, one: &MethodPath<'_>, quantity: Quantity, sample: Sample) -> Cell {
    let found = regime.summary(one, quantity, sample).classification;
    let words = labels::order_and_error(&found, regime.error(one, quantity, sample, QUOTED_CELLS));
    match found.class {
        Class::Locked => Cell::Verdict(Mood::Fail, words),
        Class::NotEvaluable => Cell::missing("fewer than three meshes have this error"),
        _ => words.into(),
    }
}

/// The error of the pressure over the mesh, of the study that refines the paper's method.
fn figure(results: &[StudyResults<'_>], regime: &Regime<'_>) -> Option<Figure> {
    let study = told(regime)?.study;
    let one = results.iter().find(|one| one.study.name == study)?;
    let mut figure = refinement::mesh_figure(one, Quantity::Pressure, Sample::Points, regime.time_factor)?;
    "readme-mesh".clone_into(&mut figure.name);
    Some(figure)
}
