//! Errors over levels of refinement: the series of several paths side by side, from which every table and figure is written.

use crate::case::grouping::grouped;
use crate::case::{Quantity, Sample};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::{Path, SeriesSummary, common_times, first_measure, level_size};
use crate::judge::study_results::StudyResults;
use crate::questions::words;
use crate::record::Record;
use crate::render::number;
use crate::render::table::{Cell, Table, TableColumn};
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
use oedometer_convergence::{Class, WINDOW};
use oedometer_problem::time_step::TimeStep;

/// What is measured, and where.
pub type Measured = (Quantity, Sample);

/// What has a series, in the order of a table.
pub const MEASURED: [Measured; 6] = [
    (Quantity::Pressure, Sample::Points),
    (Quantity::Pressure, Sample::Centres),
    (Quantity::EffectiveStress, Sample::Points),
    (Quantity::Displacement, Sample::Nodes),
    (Quantity::Settlement, Sample::Surface),
    (Quantity::LoadFactor, Sample::Surface),
];

/// Rows of a table that a page shows.
const SHOWN_ROWS: usize = 40;

/// Errors of several paths along an axis against one reference, at the last output that all paths have.
pub struct SeriesTable<'a> {
    /// What is refined.
    pub axis: Axis,
    /// Reference.
    pub reference: &'static str,
    /// Time factor.
    pub time_factor: f64,
    /// What all runs share.
    pub shared: String,
    /// Levels from coarse to fine, with a record of each.
    pub levels: Vec<(LevelValue, &'a Record)>,
    /// An error of a path each: those of one path together.
    pub series: Vec<Series<'a>>,
    /// Runs of the paths that failed.
    failed: Vec<&'a Record>,
    /// How the model of the reference differs from that of the scene.
    pub model_difference: Option<&'static str>,
}

/// One error over the levels.
pub struct Series<'a> {
    /// What tells its path from the others, the method first.
    pub label: String,
    /// What is measured, and where.
    pub measured: Measured,
    /// The error at each level of the table.
    pub errors: Vec<LevelError>,
    /// Orders and class of the levels whose runs ended: of the errors, or over the step of the differences between neighbouring
    /// steps, which the mesh leaves alone.
    pub summary: SeriesSummary<'a>,
}

/// What makes two runs of different paths runs of one level.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LevelValue(String);

/// The error of a path at a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LevelError {
    /// The error.
    Measured(f64),
    /// The run has none.
    NotMeasured,
    /// The run was not asked for this time.
    NotAsked,
    /// The run failed.
    Failed,
    /// The path has no such level.
    NotRun,
}

impl LevelValue {
    /// The level of a record: its cells, points per cell and stiffness of water by their numbers, a step by its rule.
    fn new(record: &Record, axis: Axis) -> Self {
        let [before, value, unit] = level_name(record, axis);
        Self(before + &value + &unit)
    }
}

/// The name of a level: the number, and what stands before and behind it.
fn level_name(record: &Record, axis: Axis) -> [String; 3] {
    let case = &record.case;
    let name = |before: &str, value: String, unit: &str| [before.to_owned(), value, unit.to_owned()];
    match axis {
        Axis::Cells => name("", case.cells.to_string(), " cells"),
        Axis::PointsPerCell => name("", case.points_per_cell.to_string(), " per cell"),
        Axis::WaterBulkModulus => name("K_w = ", format!("{:e}", case.material.water_bulk_modulus), " Pa"),
        Axis::TimeStep => match case.time_step {
            TimeStep::Seconds(seconds) => name("Δt = ", number::rounded(seconds), " s"),
            rule => {
                let label = rule.to_string();
                let (rule, value) = label.split_once('=').unwrap_or(("", &label));
                name(&format!("{rule}="), value.to_owned(), "")
            }
        },
    }
}

/// The name of a record's level in a sentence.
pub fn name_of_level(record: &Record, axis: Axis) -> String {
    level_name(record, axis).concat()
}

/// The levels of all paths, each once, from coarse to fine, with a record of each.
fn levels_of<'a>(paths: &[Path<'a>], axis: Axis) -> Vec<(LevelValue, &'a Record)> {
    let records = paths.iter().flat_map(|path| path.records.iter().copied());
    let mut levels: Vec<(LevelValue, &Record)> = grouped(records, |record| LevelValue::new(record, axis))
        .into_iter()
        .map(|(value, records)| (value, records[0]))
        .collect();
    levels.sort_by(|a, b| level_size(b.1, axis).total_cmp(&level_size(a.1, axis)));
    levels
}

/// The error of a path at a level.
fn error_at(path: &Path<'_>, level: &LevelValue, measure: &Measure) -> LevelError {
    let is_there = |record: &&&Record| LevelValue::new(record, path.axis) == *level;
    let Some(record) = path.records.iter().find(is_there) else { return LevelError::NotRun };
    if record.status.failure().is_some() {
        return LevelError::Failed;
    }
    if !record.case.time_factors.contains(&measure.time_factor) {
        return LevelError::NotAsked;
    }
    measure.error(record).map_or(LevelError::NotMeasured, |row| LevelError::Measured(row.value.abs()))
}

/// The path without the runs that failed; none where fewer than two are left.
fn ended<'a>(path: &Path<'a>) -> Option<Path<'a>> {
    let records = path.records.iter().copied().filter(|record| record.status.failure().is_none());
    let records: Vec<&Record> = records.collect();
    (records.len() > 1).then(|| Path { records, ..path.clone() })
}

/// The reference of errors along an axis: the scene's own, or the other one where the study expects something of it along the
/// axis.
fn reference_of(results: &StudyResults<'_>, axis: Axis) -> Option<&'static str> {
    let own = results.study.references.first()?;
    let expected = results.study.expectations.iter().filter(|one| one.axis == axis);
    let other = expected.filter_map(|one| one.reference).find(|reference| reference != own);
    Some(other.filter(|_| axis == Axis::WaterBulkModulus).unwrap_or(*own).name())
}

impl<'a> SeriesTable<'a> {
    /// Those of a study; `None` where no path has two levels whose runs ended, or in a race, which answers elsewhere.
    pub fn new(results: &StudyResults<'a>, axis: Axis) -> Option<Self> {
        if results.study.is_race {
            return None;
        }
        Self::of_paths(results, results.paths.along(axis), axis)
    }

    /// Those of some paths of a study along an axis.
    pub fn of_paths(results: &StudyResults<'a>, paths: &[Path<'a>], axis: Axis) -> Option<Self> {
        let reference = reference_of(results, axis)?;
        let paths: Vec<(&Path<'a>, Path<'a>)> =
            paths.iter().filter_map(|path| Some((path, ended(path)?))).collect();
        let (all, ended): (Vec<Path<'a>>, Vec<Path<'a>>) =
            paths.into_iter().map(|(all, ended)| (all.clone(), ended)).unzip();
        let first = *ended.first()?.records.first()?;
        let time_factor = *common_times(&ended).last()?;
        let labels = path_labels(&ended);
        let levels = levels_of(&all, axis);
        let mut series = Vec::new();
        for ((all, ended), label) in all.iter().zip(&ended).zip(&labels.each) {
            for measured in MEASURED {
                let measure = first_measure(measured.0, measured.1, reference, time_factor);
                let measure = ended.own_measure(&measure);
                let errors: Vec<LevelError> =
                    levels.iter().map(|(level, _)| error_at(all, level, &measure)).collect();
                if errors.iter().any(|error| matches!(error, LevelError::Measured(_))) {
                    let asked = match axis {
                        Axis::TimeStep => Measure { reference: NEXT_FINER.to_owned(), ..measure },
                        _ => measure,
                    };
                    let measured = (asked.quantity, asked.sample);
                    series.push(Series {
                        label: label.clone(),
                        measured,
                        errors,
                        summary: ended.summary(&asked),
                    });
                }
            }
        }
        // What settles, or bears a load, needs no second word for its displacement.
        if series.iter().any(|one| one.measured.0.is_of_surface()) {
            series.retain(|one| one.measured.0 != Quantity::Displacement);
        }
        let model_difference =
            results.study.scene.model_difference(reference.parse().ok()?, &first.case.material);
        let shared = labels.shared;
        let failed = all.iter().flat_map(|path| path.records.iter().copied());
        let failed = failed.filter(|record| record.status.failure().is_some()).collect();
        let table = Self { axis, reference, time_factor, shared, levels, series, failed, model_difference };
        (!table.series.is_empty()).then_some(table)
    }

    /// Whether errors along the axis fall with an order instead of ending in the error of the mesh.
    pub fn has_orders(&self) -> bool {
        matches!(self.axis, Axis::Cells | Axis::TimeStep)
    }

    /// Whether the order of some series has not settled: then each has its class beside it.
    fn has_classes(&self) -> bool {
        let is_unsettled = |one: &Series<'_>| one.class().is_some_and(|class| !class.is_settled());
        self.has_orders() && self.series.iter().any(is_unsettled)
    }

    /// The run at a level that failed, of the path of a record.
    pub fn failed_at(&self, of: &Record, place: usize) -> Option<&'a Record> {
        let shared = self.axis.what_is_shared(&of.case);
        let is_it = |record: &&&Record| {
            self.axis.what_is_shared(&record.case) == shared
                && LevelValue::new(record, self.axis) == self.levels[place].0
        };
        self.failed.iter().find(is_it).copied()
    }

    /// A row per series: its errors, its order and its class, where there are levels enough for one. The means of cells are for
    /// figures.
    pub fn table(&self, file: &str) -> Table {
        let mut columns = vec![TableColumn::text("method"), TableColumn::text("error of")];
        let first = level_name(self.levels[0].1, self.axis);
        columns.extend(self.levels.iter().enumerate().map(|(place, (_, record))| {
            let [before, value, unit] = level_name(record, self.axis);
            let is_told = place > 0 && [&before, &unit] == [&first[0], &first[2]];
            TableColumn::number(if is_told { value } else { before + &value + &unit })
        }));
        if self.has_orders() {
            columns.push(TableColumn::number("order"));
        }
        if self.has_classes() {
            columns.push(TableColumn::text("class"));
        }
        let shown = self.series.iter().filter(|one| one.measured.1 != Sample::Centres);
        let rows: Vec<Vec<Cell>> = shown.map(|one| self.row(one)).collect();
        let orders = match self.axis {
            Axis::Cells if self.levels.len() >= WINDOW => "order of the finest three meshes",
            Axis::Cells => "order between two meshes",
            Axis::TimeStep => "order of the differences between neighbouring steps",
            _ => "",
        };
        let shared = if self.shared.is_empty() { String::new() } else { format!("all {}", self.shared) };
        let below = [shared, orders.to_owned()].into_iter().filter(|note| !note.is_empty());
        let notes = [below.collect::<Vec<_>>().join("; "), words::class_meanings(&rows)];
        let title = format!(
            "Errors against {}, {}",
            words::solution(self.reference),
            words::output_time(&self.levels[0].1.case, self.time_factor)
        );
        let notes = notes.into_iter().filter(|note| !note.is_empty());
        Table::of(title, columns, rows).notes(notes).file(file).shown(SHOWN_ROWS)
    }

    fn row(&self, one: &Series<'_>) -> Vec<Cell> {
        let mut row = vec![Cell::Code(one.label.clone()), words::quantity(one.measured.0).into()];
        row.extend(one.errors.iter().map(|error| match error {
            LevelError::Measured(error) => Cell::Error(*error),
            LevelError::NotMeasured => Cell::missing("no error was measured"),
            LevelError::NotAsked => Cell::missing("not requested at this time"),
            LevelError::Failed => Cell::missing("the run failed"),
            LevelError::NotRun => Cell::missing("not run"),
        }));
        if self.has_orders() {
            let why =
                if one.class().is_some() { "the errors give none" } else { "too few levels for an order" };
            row.push(Cell::of(one.order(), Cell::Order, why));
        }
        if self.has_classes() {
            row.push(
                one.class().map_or(Cell::missing("of fewer than three levels"), |class| class.name().into()),
            );
        }
        row
    }

    /// What limits the series that end in a floor, and what lowers it; `None` where none does.
    pub fn floors(&self) -> Option<Table> {
        let rows = self.series.iter().filter(|_| self.has_orders()).filter_map(|one| {
            let (floor, advice) =
                one.summary.classification.floor.as_ref().zip(one.summary.classification.advice.as_ref())?;
            let measured = words::measured(one.measured.0, one.measured.1);
            Some(vec![
                Cell::Code(one.label.clone()),
                measured.into(),
                Cell::Error(floor.value),
                advice.as_str().into(),
            ])
        });
        let columns = crate::render::table::columns("method | error of | > floor | what lowers it");
        Table::of("Errors that reach a plateau", columns, rows).shown(SHOWN_ROWS).unless_empty()
    }
}

impl Series<'_> {
    /// The class, which needs three levels.
    pub fn class(&self) -> Option<Class> {
        Some(self.summary.classification.class).filter(|_| self.summary.series.levels().len() >= WINDOW)
    }

    /// The order that the class allows; of two levels the order between them.
    pub fn order(&self) -> Option<f64> {
        match self.class() {
            Some(_) => self.summary.classification.order,
            None => self.summary.pairs.first().and_then(|order| order.as_ref().ok().copied()),
        }
    }

    /// The first and the last level with an error, by their places, with these errors.
    pub fn ends(&self) -> Option<[(usize, f64); 2]> {
        let errors = self.errors.iter().enumerate().filter_map(|(place, error)| match error {
            LevelError::Measured(error) => Some((place, *error)),
            _ => None,
        });
        let errors: Vec<(usize, f64)> = errors.collect();
        Some([*errors.first()?, *errors.last()?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, study_of};
    use crate::case::planned::Tier;
    use crate::questions::series_figure::figures;
    use LevelError::{Failed, Measured, NotRun};

    fn text_of(sweeps: &[String]) -> String {
        format!("title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2]\n{}", sweeps.concat())
    }

    fn sweep(method: &str, levels: &str) -> String {
        format!("[[sweep]]\nmethod = ['{method}']\nintegrator = ['implicit']\n{levels}\n")
    }

    /// Two paths, each with levels that the other lacks: every error must stand under the cells of its own run, at the last
    /// output, and what failed leaves the others their order.
    #[test]
    fn errors_stand_under_their_own_level_where_paths_have_unlike_ones() {
        let text = text_of(&[sweep("MPM", "cells = [5, 10, 40]"), sweep("GIMP", "cells = [8, 10, 20]")]);
        let (study, mut records) = (study_of("s", &text), records_of(&text));
        for record in &mut records {
            let error = 1.0 / record.case.cells as f64;
            record.errors.iter_mut().for_each(|row| row.value = -error * row.time_factor);
        }
        let errors = |records: &[Record]| {
            let results = StudyResults::new(&study, records, Tier::Full);
            let table = SeriesTable::new(&results, Axis::Cells).expect("two paths");
            let pressure = |label: &str| {
                let is_it = |one: &&Series<'_>| {
                    one.label == label && one.measured == (Quantity::Pressure, Sample::Points)
                };
                let one = table.series.iter().find(is_it).expect("a series");
                (one.errors.clone(), one.class(), one.order().map(|order| (order * 100.0).round() / 100.0))
            };
            (pressure("MPM"), pressure("GIMP"), table.table("t"))
        };
        let (mpm, gimp, table) = errors(&records);
        let of = |cells: f64| Measured(1.0 / cells * 0.2);
        assert_eq!(mpm.0, [of(5.0), NotRun, of(10.0), NotRun, of(40.0)]);
        assert_eq!(gimp.0, [NotRun, of(8.0), of(10.0), of(20.0), NotRun]);
        assert_eq!(mpm.2, Some(1.0));
        let heads: Vec<&str> = table.columns.iter().map(|column| column.header.as_str()).collect();
        assert_eq!(heads, ["method", "error of", "5 cells", "8", "10", "20", "40", "order", "class"]);
        let rows: Vec<String> = table.rows.iter().map(|row| row[1].show()).collect();
        assert_eq!(rows, ["pore pressure", "effective stress", "settlement"].repeat(2));
        records[1].status = failed_at(3);
        let (mpm, _, table) = errors(&records);
        assert_eq!(mpm, (vec![of(5.0), NotRun, Failed, NotRun, of(40.0)], None, Some(1.0)));
        assert_eq!(table.rows[0][4], Cell::missing("the run failed"));
        records[2].status = failed_at(3);
        let results = StudyResults::new(&study, &records, Tier::Full);
        let table = SeriesTable::new(&results, Axis::Cells).expect("a path");
        assert!(table.series.iter().all(|one| one.label == "GIMP"), "one mesh is no series");
    }

    #[test]
    fn levels_are_those_of_their_axis_and_points_in_a_cell_have_no_order() {
        for (axis, levels, names) in [
            (Axis::Cells, "cells = [2, 4, 8]", ["2 cells", "4", "8"]),
            (Axis::PointsPerCell, "cells = [2]\npoints_per_cell = [1, 2, 3]", ["1 per cell", "2", "3"]),
            (
                Axis::TimeStep,
                "cells = [2]\ntime_step = [{ seconds = 0.2 }, { seconds = 0.1 }, { seconds = 0.05 }]",
                ["Δt = 0.2 s", "0.1", "0.05"],
            ),
            (
                Axis::WaterBulkModulus,
                "cells = [2]\nwater_bulk_modulus = [1e7, 2.2e9, 1e10]",
                ["K_w = 1e7 Pa", "2.2e9", "1e10"],
            ),
        ] {
            let text = text_of(&[sweep("MPM", levels)]);
            let (study, records) = (study_of("s", &text), records_of(&text));
            let results = StudyResults::new(&study, &records, Tier::Full);
            let found = SeriesTable::new(&results, axis).expect("three levels");
            let table = found.table("t");
            let heads: Vec<&str> = table.columns[2..5].iter().map(|column| column.header.as_str()).collect();
            assert_eq!(heads, names);
            let has_order = table.columns.iter().any(|column| column.header == "order");
            assert_eq!(has_order, [Axis::Cells, Axis::TimeStep].contains(&axis), "{axis:?}");
            let titles = figures(&found).into_iter().map(|figure| figure.chart.title);
            let say_order = titles.filter(|title| title.contains("order")).count();
            assert!(has_order || say_order == 0, "{axis:?}");
        }
    }
}
