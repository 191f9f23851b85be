//! Errors under refinement along an axis: which figures and tables a page shows, and every row of the tables of orders.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::{Path, SeriesSummary, common_times, first_measure, shown_time};
use crate::questions::blocks::drawn::{DrawnSeries, drawn};
use crate::questions::blocks::error_figure::ErrorFigure;
use crate::questions::blocks::number::Number;
use crate::questions::levels::{LevelError, LevelValue, levels_of};
use crate::questions::study_results::StudyResults;
use crate::record::Record;
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
use oedometer_convergence::{Class, Undefined};
use oedometer_problem::time_step::TimeStep;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Errors along an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RefinementFinding {
    /// What is refined.
    pub axis: Axis,
    /// Which series the figures show, where not all.
    pub drawn: Option<DrawnSeries>,
    /// An error each, against the scene's own solution.
    pub figures: Vec<ErrorFigure>,
    /// The pressure against another model, where the study expects something of it.
    pub other_model: Option<ErrorFigure>,
    /// Tables of orders; the first is that of the figures.
    pub tables: Vec<OrdersTable>,
}

/// Errors at every level with their orders, at one time against one reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OrdersTable {
    /// What is refined.
    pub axis: Axis,
    /// Reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// What all runs share.
    pub shared: String,
    /// Levels from coarse to fine.
    pub levels: Vec<LevelKey>,
    /// Whether errors along the axis fall with an order instead of ending in the error of the mesh.
    pub has_orders: bool,
    /// One row per error and path.
    pub rows: Vec<OrdersRow>,
}

/// A level by what it is run with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LevelKey {
    /// Cells over the height.
    Cells(usize),
    /// Step, s.
    Seconds(f64),
    /// Rule of the step.
    StepRule(String),
    /// Points in a cell.
    PointsPerCell(usize),
    /// Bulk modulus of the water, Pa.
    WaterBulkModulus(f64),
}

/// The errors of a path with their orders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OrdersRow {
    /// What tells the path from the others, the method first.
    pub label: String,
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// The error at each level of the table.
    pub errors: Vec<LevelFound>,
    /// Orders between neighbours.
    pub pairs: Vec<Option<f64>>,
    /// Order fitted to all levels.
    pub fitted: OrderFound,
    /// Order of the finest three levels.
    pub finest: OrderFound,
    /// Class, where the axis has one.
    pub class: Option<Class>,
    /// Height of the floor and what lowers it.
    pub floor: Option<(f64, String)>,
}

/// The error of a row at a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LevelFound {
    /// The error.
    Measured(Number),
    /// The run has none.
    NotMeasured,
    /// The run was not asked for this time.
    NotAsked,
    /// It is the finest of its path, with which the one before is compared.
    NoFiner,
    /// The path has no such level.
    NotRun,
}

/// An order, or why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OrderFound {
    /// The order with half of its 95 % interval, where a fit has one.
    Order(f64, Option<f64>),
    /// Why there is none.
    Undefined(String),
}

/// Quantities of the figures, side by side: the settlement of a column, the displacement of a layer.
fn panels(results: &StudyResults<'_>) -> [(Quantity, Sample); 4] {
    let of_the_body = if results.study.scene.measures(Quantity::LoadFactor) {
        (Quantity::LoadFactor, Sample::Surface)
    } else if results.study.scene.body.is_plane() {
        (Quantity::Displacement, Sample::Nodes)
    } else {
        (Quantity::Settlement, Sample::Surface)
    };
    [
        (Quantity::Pressure, Sample::Points),
        (Quantity::Pressure, Sample::Centres),
        (Quantity::EffectiveStress, Sample::Points),
        of_the_body,
    ]
}

/// Whether errors along the axis fall with an order instead of ending in the error of the mesh.
pub(super) fn shows_orders(axis: Axis, reference: &str) -> bool {
    axis == Axis::Cells || axis == Axis::TimeStep && reference == NEXT_FINER
}

/// The paths of this program, and those of others that have an error of the kind.
pub(super) fn measured<'a>(all: &[Path<'a>], measure: &Measure) -> Vec<Path<'a>> {
    let has = |path: &&Path<'_>| {
        let measure = path.own_measure(measure);
        path.records.iter().all(|record| record.case.has_integrator())
            || path.series(&measure).levels().iter().any(|level| level.error.is_some())
    };
    all.iter().filter(has).cloned().collect()
}

impl RefinementFinding {
    /// The errors of a study along every axis that it refines.
    pub fn along_all_axes(results: &StudyResults<'_>) -> Vec<Self> {
        Axis::REFINEMENTS.into_iter().filter_map(|axis| Self::new(results, axis)).collect()
    }

    /// The errors of a study along an axis; `None` without refinement along it.
    pub fn new(results: &StudyResults<'_>, axis: Axis) -> Option<Self> {
        let all = results.refined(axis);
        let shown = shown_time(&all)?;
        let references = references_of(results, axis);
        let own = references.first().copied().unwrap_or_default();
        let (few, drawn) = drawn(&all);
        let figures = panels(results)
            .map(|measured| ErrorFigure::new(results, &few, (axis, shown), measured, own))
            .into_iter()
            .flatten();
        let pressure = (Quantity::Pressure, Sample::Points);
        let other = references.get(1).filter(|_| expects_of_another_model(results));
        let other_model =
            other.and_then(|other| ErrorFigure::new(results, &few, (axis, shown), pressure, other));
        let times = common_times(&all);
        let other_times = times.iter().filter(|time| **time != shown).map(|time| (own, *time));
        let other_references = references.iter().skip(1).map(|reference| (*reference, shown));
        let tables = std::iter::once((own, shown)).chain(other_times).chain(other_references);
        Some(Self {
            axis,
            drawn,
            figures: figures.collect(),
            other_model,
            tables: tables.map(|place| OrdersTable::new(results, &all, axis, place)).collect(),
        })
    }
}

/// References along an axis, that of the figures first: over the step the next finer one, whose differences the mesh leaves
/// alone.
fn references_of(results: &StudyResults<'_>, axis: Axis) -> Vec<&'static str> {
    let mut references: Vec<&str> = results.study.references.iter().map(|kind| kind.name()).collect();
    let expects_nothing = results.study.expectations.is_empty();
    if axis == Axis::TimeStep && (expects_nothing || results.asks_for(NEXT_FINER)) {
        references.insert(0, NEXT_FINER);
    }
    references
}

/// Whether the study has expectations against another model than its own.
fn expects_of_another_model(results: &StudyResults<'_>) -> bool {
    let own = results.study.references.first().copied();
    results.study.expectations.iter().any(|one| one.reference.is_some() && one.reference != own)
}

impl OrdersTable {
    fn new(
        results: &StudyResults<'_>,
        all: &[Path<'_>],
        axis: Axis,
        (reference, time_factor): (&str, f64),
    ) -> Self {
        let levels = levels_of(all, axis);
        let labels = path_labels(all);
        let mut rows = Vec::new();
        for (quantity, sample) in panels(results) {
            let asked = first_measure(quantity, sample, reference, time_factor);
            for (path, label) in all.iter().zip(&labels.each) {
                if !measured(std::slice::from_ref(path), &asked).is_empty() {
                    let summary = path.summary(&path.own_measure(&asked));
                    rows.push(OrdersRow::new(&summary, label, &levels));
                }
            }
        }
        Self {
            axis,
            reference: reference.to_owned(),
            time_factor,
            shared: labels.shared,
            levels: levels.iter().map(|(_, record)| LevelKey::new(record, axis)).collect(),
            has_orders: shows_orders(axis, reference),
            rows,
        }
    }
}

impl OrdersRow {
    fn new(summary: &SeriesSummary<'_>, label: &str, levels: &[(LevelValue, &Record)]) -> Self {
        let SeriesSummary { path, measure, series, classification, .. } = summary;
        // More points in a cell refine the quadrature: their errors end in that of the mesh, and have no class.
        let has_class = path.axis != Axis::PointsPerCell;
        let error = |(level, _): &(LevelValue, &Record)| match path.error_at(level, measure, series) {
            LevelError::Measured(error) => LevelFound::Measured(Number(error)),
            LevelError::NotMeasured => LevelFound::NotMeasured,
            LevelError::NotAsked => LevelFound::NotAsked,
            LevelError::NoFiner => LevelFound::NoFiner,
            LevelError::NotRun => LevelFound::NotRun,
        };
        let floor = classification.floor.as_ref().zip(classification.advice.as_ref());
        Self {
            label: label.to_owned(),
            quantity: measure.quantity,
            sample: measure.sample,
            errors: levels.iter().map(error).collect(),
            pairs: summary.pairs.iter().map(|order| order.as_ref().ok().copied()).collect(),
            fitted: OrderFound::new(summary.slope.as_ref().map(|fit| (fit.order, fit.half_width))),
            finest: OrderFound::new(summary.finest.as_ref().map(|order| (*order, None))),
            class: Some(classification.class).filter(|_| has_class),
            floor: floor.filter(|_| has_class).map(|(floor, advice)| (floor.value, advice.clone())),
        }
    }
}

impl OrderFound {
    fn new(order: Result<(f64, Option<f64>), &Undefined>) -> Self {
        match order {
            Ok((order, half_width)) => Self::Order(order, half_width),
            Err(why) => Self::Undefined(why.to_string()),
        }
    }
}

impl LevelKey {
    /// The level of a record.
    pub fn new(record: &Record, axis: Axis) -> Self {
        let case = &record.case;
        match axis {
            Axis::Cells => Self::Cells(case.cells),
            Axis::PointsPerCell => Self::PointsPerCell(case.points_per_cell),
            Axis::WaterBulkModulus => Self::WaterBulkModulus(case.material.water_bulk_modulus),
            Axis::TimeStep => match case.time_step {
                TimeStep::Seconds(seconds) => Self::Seconds(seconds),
                rule => Self::StepRule(rule.to_string()),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::case::planned::Tier;
    use crate::judge::paths::StudyPaths;

    #[test]
    fn the_middle_of_the_times_that_all_paths_have_is_shown_and_levels_are_those_of_their_axis() {
        let of = |times: &str, sweep: &str| records_of(&text_of(times, sweep));
        let shown = |times: [&str; 2]| {
            let records = times.map(|times| of(times, "cells = [2, 4]")).concat();
            let paths: Vec<Path<'_>> = records
                .chunks(2)
                .map(|own| Path { axis: Axis::Cells, records: own.iter().collect(), smaller_step: None })
                .collect();
            shown_time(&paths)
        };
        for (times, middle) in [
            (["[0.1]"; 2], Some(0.1)),
            (["[0.1, 0.2]"; 2], Some(0.1)),
            (["[0.1, 0.2, 0.3]"; 2], Some(0.2)),
            (["[0.1, 0.2, 0.3, 0.4]"; 2], Some(0.2)),
            (["[0.1, 0.2, 0.3]", "[0.2, 0.3, 0.4]"], Some(0.2)),
            (["[0.1, 0.2, 0.3]", "[0.3, 0.4]"], Some(0.3)),
            (["[0.1]", "[0.2]"], None),
        ] {
            assert_eq!(shown(times), middle, "{times:?}");
        }
        assert_eq!(shown_time(&[]), None);
        let steps = "cells = [2]\ntime_step = [{ seconds = 0.2 }, { seconds = 0.1 }, { seconds = 0.05 }]";
        for (axis, sweep, keys) in [
            (Axis::Cells, "cells = [2, 4, 8]", [2, 4, 8].map(LevelKey::Cells)),
            (
                Axis::PointsPerCell,
                "cells = [2]\npoints_per_cell = [1, 2, 3]",
                [1, 2, 3].map(LevelKey::PointsPerCell),
            ),
            (Axis::TimeStep, steps, [0.2, 0.1, 0.05].map(LevelKey::Seconds)),
        ] {
            let records = of("[0.1]", sweep);
            let paths = StudyPaths::of(&records);
            let shorter =
                Path { axis, records: paths.along(axis)[0].records[..2].to_vec(), smaller_step: None };
            let both = [shorter, paths.along(axis)[0].clone()];
            let levels = levels_of(&both, axis);
            assert_eq!(
                levels.iter().map(|(_, record)| LevelKey::new(record, axis)).collect::<Vec<_>>(),
                keys
            );
            let study = study_of("s", &text_of("[0.1]", sweep));
            let results = StudyResults::new(&study, &records, Tier::Full);
            // Along the points of a cell the error ends in that of the mesh: there is no order and no class.
            let found = RefinementFinding::new(&results, axis).expect("three levels");
            let has = axis != Axis::PointsPerCell;
            let table = &found.tables[0];
            assert_eq!((table.has_orders, table.rows[0].class.is_some()), (has, has), "{axis:?}");
        }
        assert!(!shows_orders(Axis::TimeStep, "terzaghi") && shows_orders(Axis::TimeStep, NEXT_FINER));
        assert!(shows_orders(Axis::Cells, "terzaghi") && !shows_orders(Axis::PointsPerCell, NEXT_FINER));
    }

    fn text_of(times: &str, sweep: &str) -> String {
        format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = {times}\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\n{sweep}\n"
        )
    }
}
