//! Tables of a foreign result compared with references.

use crate::case::grouping::distinct;
use crate::case::quantity::{Norm, Quantity};
use crate::record::ErrorRow;
use crate::render::table::{Cell, Table, TableColumn, columns};
use crate::render::{number, table};
use crate::report::tables::measures::NOT_RESOLVED;
use crate::score::score_series::ScoredSeries;
use crate::score::{Score, WorstPlace};
use std::collections::HashMap;

/// Relative difference of times that comes from the digits written.
const SAME_TIME: f64 = 1e-9;

/// One row per time and quantity: the main norm against every reference, and the place with most of the error against the
/// first.
pub fn errors_table(score: &Score, title: &str) -> Table {
    let unresolved = score.unresolved.iter().map(|one| one.reference.as_str());
    let references = distinct(score.errors.iter().map(|row| row.reference.as_str()).chain(unresolved));
    let mut columns = columns("> T_v | quantity | sample");
    columns.extend(references.iter().map(|name| TableColumn::number(format!("error against {name}"))));
    let is_plane = score.worst.iter().any(|worst| worst.x.is_some());
    columns.push(TableColumn::number("worst at ζ"));
    columns.extend(is_plane.then(|| TableColumn::number("and x/L")));
    columns.extend(table::columns("> share of squared error | > result there | > exact there"));
    let is_main = |row: &&ErrorRow| matches!(row.norm, Norm::L2 | Norm::Relative);
    let key = |row: &ErrorRow| (row.time_factor.to_bits(), row.quantity, row.sample, row.norm);
    let index: HashMap<_, &ErrorRow> =
        score.errors.iter().map(|row| ((key(row), row.reference.as_str()), row)).collect();
    let worst_of: HashMap<(u64, Quantity), &WorstPlace> =
        score.worst.iter().map(|worst| ((worst.time_factor.to_bits(), worst.quantity), worst)).collect();
    let first = references.first().copied().unwrap_or_default();
    let resolved = score.errors.iter().filter(is_main).filter(|row| row.reference == first);
    let resolved = resolved.map(|row| (row.time_factor, row.quantity, row.sample, row.norm, true));
    let unresolved = score.unresolved.iter().filter(|one| one.reference == first);
    let unresolved =
        unresolved.map(|one| (one.time_factor, one.quantity, one.sample, one.quantity.first_norm(), false));
    let rows = resolved.chain(unresolved).map(|(time_factor, quantity, sample, norm, is_resolved)| {
        let time = time_factor.to_bits();
        let mut cells = vec![Cell::Number(time_factor), quantity.name().into(), sample.name().into()];
        // Against another reference there may be an error where the first resolves none.
        let error = |name: &&str| index.get(&((time, quantity, sample, norm), *name)).copied();
        cells.extend(references.iter().map(|name| error_cell(error(name))));
        let worst = worst_of.get(&(time, quantity)).copied().filter(|_| is_resolved);
        cells.extend(place_cells(worst, is_plane));
        cells
    });
    Table::of(title, columns, rows).note(
        "relative L2 error over the samples; settlement as s/s_exact − 1; ζ is the initial depth \
             over the height",
    )
}

fn error_cell(row: Option<&ErrorRow>) -> Cell {
    match row {
        Some(row) if row.quantity.is_of_surface() => Cell::Percent(row.value),
        Some(row) => Cell::Error(row.value),
        None => Cell::missing(NOT_RESOLVED),
    }
}

fn place_cells(worst: Option<&WorstPlace>, is_plane: bool) -> Vec<Cell> {
    let mut cells = vec![Cell::of(worst.map(|worst| worst.zeta), Cell::Number, "")];
    cells.extend(is_plane.then(|| Cell::of(worst.and_then(|worst| worst.x), Cell::Number, "")));
    cells.extend(match worst {
        Some(worst) => {
            [Cell::Percent(worst.share), Cell::Measured(worst.computed), Cell::Measured(worst.exact)]
        }
        None => std::array::from_fn(|_| Cell::missing("")),
    });
    cells
}

/// One row per series over meshes, with its errors, order and class.
pub fn series_table(series: &[ScoredSeries]) -> Table {
    let references = distinct(series.iter().map(|one| one.measure.reference.as_str()));
    let shared = if let [only] = references[..] { Some(only) } else { None };
    let mut columns = columns("> T_v | quantity");
    columns.extend(shared.is_none().then(|| TableColumn::text("reference")));
    let cells = series.first().map_or(&[][..], |one| &one.cells);
    columns.extend(cells.iter().map(|cells| TableColumn::number(format!("{cells} cells"))));
    columns.extend(table::columns("> order | class"));
    let rows = series.iter().map(|one| {
        let mut row = vec![Cell::Number(one.measure.time_factor), one.measure.quantity.name().into()];
        row.extend(shared.is_none().then(|| one.measure.reference.as_str().into()));
        let levels = one.series.levels().iter();
        row.extend(levels.map(|level| Cell::of(level.error, Cell::Error, "no such row in the result")));
        let class = &one.classification;
        row.push(Cell::of(class.order, Cell::Order, "the class allows no order"));
        row.push(class.class.name().into());
        row
    });
    let unsettled = series.iter().filter(|one| !one.classification.class.is_settled());
    let reasons = unsettled.map(|one| {
        let (class, measure) = (&one.classification, &one.measure);
        let time = number::time_factor(measure.time_factor);
        format!("{} at T_v = {time}: {}: {}", measure.quantity.name(), class.class.name(), class.reason)
    });
    let reasons = distinct(reasons);
    let mut notes = vec!["the order is that of the finest three meshes".to_owned()];
    let difference = series.iter().map(|one| one.time_difference).fold(0.0, f64::max);
    if difference > SAME_TIME {
        notes.push(format!(
            "times differ between the meshes by up to {difference:.1e} of the T_v shown; each is compared with the exact \
             solution at its own time"
        ));
    }
    let title =
        shared.map_or("convergence".to_owned(), |reference| format!("convergence against {reference}"));
    Table::of(title, columns, rows).notes(notes).notes(reasons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::quantity::Sample;
    use crate::score::Unresolved;
    use oedometer_convergence::{Class, Classification, ErrorSeries};

    #[test]
    fn the_worst_place_of_an_error_stands_beside_it() {
        let row = |value: f64| ErrorRow {
            time_factor: 0.2,
            quantity: Quantity::Pressure,
            sample: Sample::Points,
            norm: Norm::L2,
            reference: "theirs".to_owned(),
            value,
            absolute: 0.5,
        };
        let worst = WorstPlace {
            time_factor: 0.2,
            quantity: Quantity::Pressure,
            zeta: 0.75,
            x: Some(0.25),
            computed: 11.0,
            exact: 13.0,
            share: 0.4,
        };
        let score = Score { errors: vec![row(0.07)], worst: vec![worst], ..Score::default() };
        let table = errors_table(&score, "t");
        let expected = [
            Cell::Number(0.2),
            "pressure".into(),
            "points".into(),
            Cell::Error(0.07),
            Cell::Number(0.75),
            Cell::Number(0.25),
            Cell::Percent(0.4),
            Cell::Measured(11.0),
            Cell::Measured(13.0),
        ];
        assert_eq!(table.rows, [expected.to_vec()]);
    }

    #[test]
    fn the_largest_difference_of_times_is_told_wherever_it_stands() {
        let told = |differences: [f64; 3]| {
            let series = differences.map(|time_difference| ScoredSeries {
                group: 0,
                cells: vec![2, 4],
                measure: ErrorRow {
                    time_factor: 0.2,
                    quantity: Quantity::Pressure,
                    sample: Sample::Points,
                    norm: Norm::L2,
                    reference: "theirs".to_owned(),
                    value: 0.1,
                    absolute: 0.5,
                },
                time_difference,
                series: ErrorSeries::from_pairs(&[(0.5, 0.1), (0.25, 0.025)]),
                classification: Classification::new(Class::NotEvaluable, "two meshes"),
            });
            series_table(&series).notes
        };
        let differ = "times differ between the meshes by up to 2.0e-3 of the T_v shown";
        for place in 0..3 {
            for others in [0.0, 1e-3] {
                let mut differences = [others; 3];
                differences[place] = 2e-3;
                let notes = told(differences);
                assert!(notes[1].starts_with(differ), "{differences:?}: {notes:?}");
            }
        }
        // What the written digits lose is no difference.
        for differences in [[0.0; 3], [9e-10; 3]] {
            assert!(told(differences).iter().all(|note| !note.contains("times differ")), "{differences:?}");
        }
    }

    #[test]
    fn what_has_no_error_against_the_first_reference_stands_last_with_the_reason() {
        let row = |quantity: Quantity, norm: Norm, reference: &str, value: f64| ErrorRow {
            time_factor: 0.2,
            quantity,
            sample: if quantity.is_of_surface() { Sample::Surface } else { Sample::Nodes },
            norm,
            reference: reference.to_owned(),
            value,
            absolute: 0.5,
        };
        let errors = vec![
            row(Quantity::Pressure, Norm::L1, "first", 0.9),
            row(Quantity::Pressure, Norm::L2, "first", 0.07),
            row(Quantity::Settlement, Norm::Relative, "first", 0.03),
            row(Quantity::Pressure, Norm::L2, "second", 0.08),
            row(Quantity::Displacement, Norm::L2, "second", 0.06),
        ];
        let unresolved = |quantity: Quantity, reference: &str| Unresolved {
            time_factor: 0.2,
            quantity,
            sample: Sample::Nodes,
            reference: reference.to_owned(),
            absolute: 1e-9,
        };
        let lost = vec![unresolved(Quantity::Displacement, "first"), unresolved(Quantity::Pressure, "third")];
        let table = errors_table(&Score { errors, unresolved: lost, ..Score::default() }, "t");
        let shown: Vec<Vec<String>> =
            table.rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        assert_eq!(
            shown,
            [
                ["0.2", "pressure", "nodes", "7.00e-2", "8.00e-2", "–", "–", "–", "–", "–"],
                ["0.2", "settlement", "surface", "3.00 %", "–", "–", "–", "–", "–", "–"],
                ["0.2", "displacement", "nodes", "–", "6.00e-2", "–", "–", "–", "–", "–"],
            ]
        );
        let heads: Vec<&str> = table.columns[3..7].iter().map(|column| column.header.as_str()).collect();
        assert_eq!(
            heads,
            ["error against first", "error against second", "error against third", "worst at ζ"]
        );
        assert_eq!(table.footnotes(), [NOT_RESOLVED]);
    }
}
