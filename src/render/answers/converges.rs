//! Does the method converge, and to what? One row a method, small strain and large strain side by side.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::SeriesSummary;
use crate::render::answers::question::{Answer, Links, Question, links_to, short};
use crate::render::answers::regime::{MethodPath, PAPERS, QUOTED_CELLS, Regime, distinct};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::{StudyResults, labels, refinement};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use oedometer_convergence::Class;

/// The question.
pub const QUESTION: Question =
    Question { heading: "Does the method converge, and to what?", id: "converges" };

/// What is quoted of a method at small strain.
const SMALL: [(Quantity, Sample, &str); 4] = [
    (Quantity::Pressure, Sample::Points, "p, points"),
    (Quantity::Pressure, Sample::Centres, "p, centres"),
    (Quantity::EffectiveStress, Sample::Points, "σ′, points"),
    (Quantity::Settlement, Sample::Surface, "settlement"),
];

/// Sentence, table and figure.
pub fn answer(
    results: &[StudyResults<'_>],
    small: Option<&Regime<'_>>,
    large: Option<&Regime<'_>>,
    links: Links<'_>,
) -> Answer {
    let regimes: Vec<(&str, &Regime<'_>)> = [("small strain", small), ("large strain", large)]
        .into_iter()
        .filter_map(|(name, one)| Some((name, one?)))
        .collect();
    if regimes.is_empty() {
        return QUESTION.open("a column on three meshes, as in `terzaghi-mesh`");
    }
    let sentences: Vec<String> = regimes.iter().filter_map(|(name, regime)| sentence(name, regime)).collect();
    let studies = regimes.iter().flat_map(|(_, regime)| regime.methods.iter().map(|one| one.study));
    let sentence = format!("{} Evidence: {}.", sentences.join(" "), links_to(links, studies));
    let mut blocks = vec![Block::Table(short(table(&regimes), "in the studies"))];
    blocks.extend(small.and_then(|regime| figure(results, regime)).map(Block::Figure));
    QUESTION.told(sentence, blocks)
}

/// What the paper's method, or the first of the methods, converges to and how fast.
fn sentence(name: &str, regime: &Regime<'_>) -> Option<String> {
    let one = regime.method(PAPERS).or(regime.methods.first())?;
    let order = |quantity, sample| order_words(&regime.summary(one, quantity, sample));
    let whose = if one.method == PAPERS { ", the paper's method," } else { "" };
    let strain = match regime.strain() {
        Some(strain) if name == "large strain" => {
            format!("At large strain, {} in the end,", number::percent(strain))
        }
        _ => format!("At {name}"),
    };
    let error =
        regime.error(one, Quantity::Pressure, Sample::Points, QUOTED_CELLS).map_or(String::new(), |error| {
            format!("; on {QUOTED_CELLS} cells its pressure is off by {}", number::percent(error))
        });
    Some(format!(
        "{strain} `{}`{whose} converges to {} with order {} in the pressure at the points, {} in the effective stress and {} \
         in the settlement{error}.",
        one.method,
        labels::solution(regime.reference),
        order(Quantity::Pressure, Sample::Points),
        order(Quantity::EffectiveStress, Sample::Points),
        order(Quantity::Settlement, Sample::Surface),
    ))
}

/// The order on the finest three meshes, with the class where that is not a settled order.
fn order_words(summary: &SeriesSummary<'_>) -> String {
    let class = &summary.classification;
    match (class.order, class.class) {
        (Some(order), Class::Asymptotic | Class::Superconvergent) => number::order(order),
        (Some(order), other) => format!("{} ({other})", number::order(order)),
        (None, other) => format!("none ({other})"),
    }
}

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
        columns.extend(SMALL.iter().map(|(_, _, what)| TableColumn::text(format!("{name}: {what}"))));
    }
    let rows = ranked.iter().map(|name| {
        let mut row = vec![method_cell(name)];
        for (_, regime) in regimes {
            row.extend(SMALL.iter().map(|(quantity, sample, _)| match regime.method(name) {
                Some(one) => quote(regime, one, *quantity, *sample),
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

/// A method's name; the paper's own marked.
pub fn method_cell(name: &str) -> Cell {
    if name == PAPERS {
        Cell::Verdict(Mood::Note, format!("{name}, the paper's"))
    } else {
        Cell::Code(name.to_owned())
    }
}

/// Order and error in a few characters.
fn quote(regime: &Regime<'_>, one: &MethodPath<'_>, quantity: Quantity, sample: Sample) -> Cell {
    let summary = regime.summary(one, quantity, sample);
    let class = summary.classification.class;
    let error = regime.error(one, quantity, sample, QUOTED_CELLS);
    let error =
        error.map_or(String::new(), |error| format!(", {}", number::error(error).replace('-', "\u{2011}")));
    let text = |head: &str| format!("{head}{error}");
    match (summary.classification.order, class) {
        (Some(order), Class::Asymptotic | Class::Superconvergent) => Cell::Text(text(&number::order(order))),
        (Some(order), other) => Cell::Text(text(&format!("{} ({other})", number::order(order)))),
        (None, Class::Locked) => Cell::Verdict(Mood::Fail, text("locked")),
        (None, Class::NotEvaluable) => Cell::missing("fewer than three meshes have this error"),
        (None, other) => Cell::Text(text(other.name())),
    }
}

/// The error of the pressure over the mesh, of the study that refines the paper's method.
fn figure(results: &[StudyResults<'_>], regime: &Regime<'_>) -> Option<Figure> {
    let study = regime.method(PAPERS).or(regime.methods.first())?.study;
    let one = results.iter().find(|one| one.study.name == study)?;
    let mut figure = refinement::mesh_figure(one, Quantity::Pressure, Sample::Points, regime.time_factor)?;
    "readme-mesh".clone_into(&mut figure.name);
    Some(figure)
}
