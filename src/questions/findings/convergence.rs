//! The errors of a method over its meshes with the rate from each to the next, as a solver prints them at the end of a run.

use crate::case::{Quantity, Sample};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::{Path, StudyPaths, first_measure};
use crate::record::Record;
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_convergence::Class;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most methods, with their points and steps, that have a table each.
const MOST_TABLES: usize = 8;
/// Most series of which the finest mesh is printed.
const MOST_SERIES: usize = 40;

/// The errors of one method, its points and its steps over its meshes, at the last output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConvergenceTable {
    /// What the runs share.
    pub runs: String,
    /// Reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// Time, s.
    pub seconds: f64,
    /// Cells over the height, from coarse to fine.
    pub cells: Vec<usize>,
    /// Each quantity that has an error on every mesh.
    pub columns: Vec<ConvergenceColumn>,
}

/// A quantity over the meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConvergenceColumn {
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Errors, one per mesh.
    pub errors: Vec<f64>,
    /// Orders between neighbours, one fewer.
    pub rates: Vec<Option<f64>>,
    /// Class of the series.
    pub class: Class,
}

/// The finest meshes of more series than have a table each.
#[derive(Clone, Debug, PartialEq)]
pub struct FinestMeshes {
    /// What all runs share.
    pub shared: String,
    /// The first series in the order of the study, each by what tells it from the others.
    pub series: Vec<(String, ConvergenceTable)>,
    /// Series that are left out.
    pub more: usize,
}

impl FinestMeshes {
    /// Those of a study; `None` where each series has a table of its own, or none has two meshes.
    pub fn new(study: &Study, paths: &StudyPaths<'_>) -> Option<Self> {
        let reference = study.references.first()?;
        let paths = paths.along(Axis::Cells);
        if study.is_race || paths.len() <= MOST_TABLES {
            return None;
        }
        let labels = path_labels(paths);
        let named = paths.iter().zip(labels.each).take(MOST_SERIES);
        let series: Vec<(String, ConvergenceTable)> =
            named.filter_map(|(path, label)| Some((label, table_of(path, reference.name())?))).collect();
        let more = paths.len().saturating_sub(MOST_SERIES);
        (!series.is_empty()).then_some(Self { shared: labels.shared, series, more })
    }
}

/// The tables of a study: one per path over the mesh with two levels or more; empty where there are so many that [`FinestMeshes`]
/// has them.
pub fn convergence_tables(study: &Study, paths: &StudyPaths<'_>) -> Vec<ConvergenceTable> {
    let Some(reference) = study.references.first() else { return Vec::new() };
    let paths = paths.along(Axis::Cells);
    if study.is_race || paths.len() > MOST_TABLES {
        return Vec::new();
    }
    paths.iter().filter_map(|path| table_of(path, reference.name())).collect()
}

/// The table of the meshes whose runs ended: what failed has no error, and the others keep theirs.
fn table_of(path: &Path<'_>, reference: &str) -> Option<ConvergenceTable> {
    let ended = path.records.iter().copied().filter(|record| record.status.failure().is_none());
    let path = &Path { records: ended.collect(), ..path.clone() };
    let first = &path.records.first().filter(|_| path.records.len() > 1)?;
    let time_factor = *first.case.time_factors.last()?;
    let main = first.main_sample();
    let asked = [
        (Quantity::Pressure, main),
        (Quantity::EffectiveStress, main),
        (Quantity::Displacement, Sample::Nodes),
        (Quantity::Settlement, Sample::Surface),
        (Quantity::LoadFactor, Sample::Surface),
    ];
    let columns = asked.into_iter().filter_map(|(quantity, sample)| {
        let measure = path.own_measure(&first_measure(quantity, sample, reference, time_factor));
        let summary = path.summary(&measure);
        let errors: Option<Vec<f64>> = summary.series.levels().iter().map(|level| level.error).collect();
        let errors = errors.filter(|errors| errors.len() == path.records.len())?;
        let rates = summary.pairs.iter().map(|rate| rate.as_ref().ok().copied()).collect();
        let class = summary.classification.class;
        Some(ConvergenceColumn { quantity, sample: measure.sample, errors, rates, class })
    });
    let mut columns: Vec<ConvergenceColumn> = columns.collect();
    // What settles needs no second word for its displacement.
    if columns.iter().any(|column| column.quantity == Quantity::Settlement) {
        columns.retain(|column| column.quantity != Quantity::Displacement);
    }
    (!columns.is_empty()).then(|| ConvergenceTable {
        runs: label_without_cells(first),
        reference: reference.to_owned(),
        time_factor,
        seconds: time_factor * first.case.seconds_per_time_factor(),
        cells: path.records.iter().map(|record| record.case.cells).collect(),
        columns,
    })
}

/// What the runs of a path over the mesh share: method, integrator, points, steps and all else that is not by default.
fn label_without_cells(record: &Record) -> String {
    record.case.label().replace(&format!(" cells={}", record.case.cells), "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;

    #[test]
    fn a_mesh_whose_run_failed_leaves_the_others_in_the_table() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16]\n";
        let (study, mut records) = solved("s", text);
        let meshes = |records: &[Record]| {
            let tables = convergence_tables(&study, &StudyPaths::of(records));
            tables.into_iter().map(|table| (table.cells, table.columns.len())).collect::<Vec<_>>()
        };
        records[1].status = crate::campaign::runner::failed_at(3);
        assert_eq!(meshes(&records), [(vec![4, 16], 3)]);
        records[2].status = crate::campaign::runner::failed_at(3);
        assert_eq!(meshes(&records), [], "one mesh is no series");
    }

    #[test]
    fn every_mesh_has_its_error_and_the_rate_to_it() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.1]\n[[sweep]]\nmethod = ['MPM', 'GIMP']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16]\n[[sweep]]\nmethod = ['VP']\nintegrator = ['implicit']\n\
                    cells = [4]\n";
        let (study, mut records) = solved("s", text);
        for record in &mut records {
            for row in &mut record.errors {
                let order = if row.quantity == Quantity::Pressure { 2 } else { 1 };
                row.value = -(row.time_factor / record.case.cells as f64).powi(order);
            }
        }
        let tables = convergence_tables(&study, &StudyPaths::of(&records));
        assert_eq!(tables.len(), 2, "one mesh is no series");
        let table = &tables[0];
        assert_eq!(table.runs, "MPM implicit points=2 growth=0.05");
        assert_eq!((table.cells.as_slice(), table.time_factor), (&[4, 8, 16][..], 0.1));
        let quantities: Vec<_> = table.columns.iter().map(|column| column.quantity).collect();
        assert_eq!(quantities, [Quantity::Pressure, Quantity::EffectiveStress, Quantity::Settlement]);
        assert!((table.columns[0].errors[1] - 1.5625e-4).abs() < 1e-15);
        for (column, order) in table.columns.iter().zip([2.0, 1.0, 1.0]) {
            assert_eq!(column.rates.len(), 2);
            assert!(
                column.rates.iter().all(|rate| rate.is_some_and(|rate| (rate - order).abs() < 1e-12)),
                "{column:?}"
            );
        }
        assert_eq!(table.columns[1].class, Class::Asymptotic, "the method promises first order");
    }

    #[test]
    fn more_series_than_have_a_table_each_have_a_row_and_the_rest_is_counted() {
        for (count, tables, rows, more) in [(8, 8, None, 0), (9, 0, Some(9), 0), (43, 0, Some(40), 3)] {
            let porosities: Vec<f64> = (0..count).map(|place| 0.2 + 0.01 * f64::from(place)).collect();
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                 integrator = ['implicit']\ncells = [2, 4]\nporosity = {porosities:?}\n"
            );
            let (study, records) = solved("s", &text);
            let paths = StudyPaths::of(&records);
            assert_eq!(convergence_tables(&study, &paths).len(), tables, "{count}");
            let finest = FinestMeshes::new(&study, &paths);
            assert_eq!(finest.as_ref().map(|finest| finest.series.len()), rows, "{count}");
            assert_eq!(finest.as_ref().map_or(0, |finest| finest.more), more, "{count}");
            if let Some(finest) = finest {
                assert_eq!(finest.series[0].0, "MPM, porosity=0.2");
                assert_eq!(finest.series[0].1.cells, [2, 4]);
            }
        }
    }
}
