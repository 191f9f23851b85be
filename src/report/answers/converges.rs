//! Does the method converge, and to what? A row per method with its orders and errors at small and at large strain.

use crate::case::contender::PAPERS;
use crate::case::grouping::distinct;
use crate::questions::answers::converges::{ColumnFinding, ConvergesFinding, MethodOrders, OrderFinding};
use crate::questions::sentence;
use crate::questions::words;
use crate::render::page::{Block, Figure, Section};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::answers::{Question, short};
use crate::report::blocks::refinement;
use oedometer_convergence::Class;

const QUESTION: Question = Question { heading: "Does the method converge, and to what?", id: "converges" };

/// Headings of the orders of a method.
const HEADINGS: [&str; 4] = ["p, points", "p, centres", "σ′, points", "settlement"];

/// Methods of the table.
const MOST_METHODS: usize = 5;

/// Sentence, table, and the error of the pressure over the mesh.
pub fn section(found: &ConvergesFinding) -> Result<Section, RenderError> {
    let mut blocks = vec![Block::Table(short(table(found), "in the studies"))];
    let small = found.columns.iter().find(|column| column.final_strain.is_none());
    blocks.extend(small.and_then(figure).map(Block::Figure));
    let studies = found.columns.iter().map(|column| column.study.as_str());
    Ok(QUESTION.answered(&sentence::sentence("converges", found)?, studies, blocks))
}

fn strain_of(column: &ColumnFinding) -> &'static str {
    if column.final_strain.is_some() { "large strain" } else { "small strain" }
}

fn method_of<'a>(column: &'a ColumnFinding, name: &str) -> Option<&'a MethodOrders> {
    column.methods.iter().find(|method| method.method == name)
}

/// Methods: the paper's first, then those that answer most, then those with the smaller error where it is hardest.
fn ranked(found: &ConvergesFinding) -> Vec<&str> {
    let methods = found.columns.iter().flat_map(|column| &column.methods);
    let mut ranked = distinct(methods.map(|method| method.method.as_str()));
    ranked.sort_by(|a, b| {
        let of =
            |name: &str| found.columns.iter().rev().filter_map(|column| method_of(column, name)).collect();
        let [a_orders, b_orders]: [Vec<&MethodOrders>; 2] = [of(a), of(b)];
        let error = |orders: &[&MethodOrders]| orders[0].largest_error.unwrap_or(f64::INFINITY);
        let is_papers = |name: &str| name == PAPERS;
        is_papers(b)
            .cmp(&is_papers(a))
            .then(b_orders.len().cmp(&a_orders.len()))
            .then(error(&a_orders).total_cmp(&error(&b_orders)))
    });
    ranked
}

fn table(found: &ConvergesFinding) -> Table {
    let ranked = ranked(found);
    let mut columns = columns("method");
    for column in &found.columns {
        let strain = if found.columns.len() > 1 { format!("{}: ", strain_of(column)) } else { String::new() };
        columns.extend(HEADINGS.map(|what| TableColumn::text(format!("{strain}{what}"))));
    }
    let rows = ranked.iter().take(MOST_METHODS).map(|name| {
        let method = if *name == PAPERS {
            Cell::Verdict(Mood::Note, format!("{name}, the paper's"))
        } else {
            Cell::Code((*name).to_owned())
        };
        let cells = found.columns.iter().flat_map(|column| match method_of(column, name) {
            Some(method) => method.orders.iter().map(order_cell).collect(),
            None => {
                vec![Cell::missing("not tried on this column with at least three meshes"); HEADINGS.len()]
            }
        });
        std::iter::once(method).chain(cells).collect()
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    let times = found
        .columns
        .iter()
        .map(|column| format!("{}: T_v = {}", strain_of(column), number::time_factor(column.time_factor)));
    let norms = format!(
        "{}; relative L_2 norm over the volume, |s/s_exact − 1| of the settlement",
        times.collect::<Vec<_>>().join("; ")
    );
    let more = ranked.len().saturating_sub(MOST_METHODS);
    let others = if more > 0 { format!("{more} more: on the pages of the studies") } else { String::new() };
    let notes = [norms, words::class_meanings(&rows), others].into_iter().filter(|note| !note.is_empty());
    let shown = ranked.iter().take(MOST_METHODS).flat_map(|name| {
        found.columns.iter().filter_map(|column| method_of(column, name)).flat_map(|method| &method.orders)
    });
    // Not every study runs the mesh on which errors are quoted.
    let mut shown = shown.filter(|order| order.error.is_some());
    let errors = shown.next().map_or(String::new(), |_| format!(", error on {} cells", found.cells));
    let title = format!("Order on the finest three meshes{errors}");
    Table::of(title, columns, rows).notes(notes)
}

/// Order and error in a few characters.
fn order_cell(order: &OrderFinding) -> Cell {
    let words = words::order_and_error(order.class, order.order, order.error);
    match order.class {
        Class::Locked => Cell::Verdict(Mood::Fail, words),
        Class::NotEvaluable => Cell::missing("fewer than three meshes have this error"),
        _ => words.into(),
    }
}

/// The error of the pressure over the mesh.
fn figure(column: &ColumnFinding) -> Option<Figure> {
    let mut figure = refinement::figure(&column.study, column.figure.as_ref()?);
    "readme-mesh".clone_into(&mut figure.name);
    Some(figure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Quantity, Sample};

    #[test]
    fn the_paper_s_method_leads_the_table_and_the_others_follow_by_their_largest_error() {
        let order = |class: Class, order: Option<f64>, error: Option<f64>| OrderFinding {
            quantity: Quantity::Pressure,
            sample: Sample::Points,
            class,
            order,
            is_settled: class == Class::Asymptotic,
            error,
        };
        let method = |name: &str, largest_error: Option<f64>| MethodOrders {
            method: name.to_owned(),
            orders: vec![
                order(Class::Asymptotic, Some(1.998), Some(0.04)),
                order(Class::PreAsymptotic, Some(1.5), None),
                order(Class::Locked, None, Some(0.9)),
                order(Class::NotEvaluable, None, None),
            ],
            largest_error,
        };
        let column = |final_strain: Option<f64>, methods: Vec<MethodOrders>| ColumnFinding {
            study: "s".to_owned(),
            final_strain,
            reference: "terzaghi".to_owned(),
            time_factor: 0.1,
            method: PAPERS.to_owned(),
            is_papers: true,
            is_settled: true,
            orders: Vec::new(),
            methods,
            better: None,
            within: Vec::new(),
            figure: None,
        };
        let found = |columns: Vec<ColumnFinding>| ConvergesFinding { cells: 10, is_alone: false, columns };
        let small = column(
            None,
            vec![
                method("MPM", Some(0.5)),
                method("GIMP", None),
                method("VP", Some(0.3)),
                method(PAPERS, Some(0.9)),
            ],
        );
        let shown = table(&found(vec![small.clone()]));
        let names: Vec<String> = shown.rows.iter().map(|row| row[0].show()).collect();
        assert_eq!(names, ["• GC-SRI-patch, the paper's", "VP", "MPM", "GIMP"]);
        let cells: Vec<String> = shown.rows[0][1..4].iter().map(Cell::show).collect();
        assert_eq!(cells, ["2.00, 4.00e\u{2011}2", "1.50 (pre-asymptotic)", "✗ locked, 9.00e\u{2011}1"]);
        let heads: Vec<&str> = shown.columns.iter().map(|column| column.header.as_str()).collect();
        assert_eq!(heads, ["method", "p, points", "p, centres", "σ′, points", "settlement"]);
        // What was tried on both columns stands first, the others by their error there.
        let both =
            found(vec![small, column(Some(0.15), vec![method("GIMP", Some(0.2)), method("B2", Some(0.1))])]);
        assert_eq!(ranked(&both), [PAPERS, "GIMP", "B2", "VP", "MPM"]);
        let table = table(&both);
        assert_eq!(table.columns[5].header, "large strain: p, points");
        assert_eq!(table.rows[0][5], Cell::missing("not tried on this column with at least three meshes"));
    }
}
