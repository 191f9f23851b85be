//! One error of several methods over an axis of refinement, as a figure shows it: a line per path, slopes that lines come
//! near, and the floor that they share.

use crate::case::grouping::distinct;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::{Path, SeriesSummary, first_measure};
use crate::questions::blocks::Point;
use crate::questions::blocks::drawn::drawn;
use crate::questions::blocks::refinement::{measured, shows_orders};
use crate::questions::study_results::StudyResults;
use crate::study::expectation::Axis;
use oedometer_convergence::Class;
use oedometer_exact::reference::ReferenceKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Slopes of the triangles: of first and of second order.
const SLOPES: [f64; 2] = [1.0, 2.0];
/// Distance of an order from a slope up to which its line has the triangle.
const NEAR: f64 = 0.3;
/// Floors within this factor are one line in a figure.
const SAME_FLOOR: f64 = 1.1;

/// An error over an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ErrorFigure {
    /// What is refined.
    pub axis: Axis,
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// What all runs share.
    pub shared: String,
    /// Sizes of the levels of all paths.
    pub sizes: Vec<f64>,
    /// One line per path.
    pub lines: Vec<ErrorLine>,
    /// Slopes with the first line that comes near each.
    pub slopes: Vec<NearSlope>,
    /// The floor.
    pub floor: Option<FloorLine>,
}

/// The error along a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ErrorLine {
    /// What tells the path from the others, the method first.
    pub label: String,
    /// Places of its errors.
    pub sample: Sample,
    /// Size of a level and error.
    pub points: Vec<Point>,
    /// Class.
    pub class: Class,
    /// Order that the class allows, where errors along the axis have one.
    pub order: Option<f64>,
}

/// A slope and the line that comes near it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NearSlope {
    /// The slope.
    pub slope: f64,
    /// Place of the line.
    pub line: usize,
}

/// A floor that is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FloorLine {
    /// Its height.
    pub value: f64,
    /// Place of the only line that has one; `None` where all lines end there.
    pub line: Option<usize>,
    /// How the model of the reference differs from that of the scene.
    pub cause: Option<String>,
}

impl ErrorFigure {
    /// The errors of paths over an axis; `None` where no path has any.
    pub fn new(
        results: &StudyResults<'_>,
        all: &[Path<'_>],
        (axis, time_factor): (Axis, f64),
        (quantity, sample): (Quantity, Sample),
        reference: &str,
    ) -> Option<Self> {
        let measure = first_measure(quantity, sample, reference, time_factor);
        let all = measured(all, &measure);
        let summaries: Vec<SeriesSummary<'_>> =
            all.iter().map(|path| path.summary(&path.own_measure(&measure))).collect();
        let labels = path_labels(&all);
        let has_orders = shows_orders(axis, reference);
        let lines: Vec<ErrorLine> = summaries
            .iter()
            .zip(labels.each)
            .map(|(summary, label)| ErrorLine::new(summary, label, has_orders))
            .collect();
        if lines.iter().all(|line| line.points.is_empty()) {
            return None;
        }
        let floor = shared_floor(&summaries).filter(|_| axis == Axis::Cells).map(|(value, line)| {
            let kind: Option<ReferenceKind> = reference.parse().ok();
            let soil = &all[0].records[0].case.material;
            let cause = kind.and_then(|kind| results.study.scene.model_difference(kind, soil));
            FloorLine { value, line, cause: cause.map(str::to_owned) }
        });
        let slopes = if has_orders { near_slopes(&summaries) } else { Vec::new() };
        let sizes = summaries.iter().flat_map(|summary| summary.series.levels()).map(|level| level.size);
        Some(Self {
            axis,
            quantity,
            sample,
            reference: reference.to_owned(),
            time_factor,
            shared: labels.shared,
            sizes: distinct(sizes),
            lines,
            slopes,
            floor,
        })
    }

    /// One error over the mesh, against the scene's own solution; `None` without refinement.
    pub fn over_the_mesh(
        results: &StudyResults<'_>,
        measured: (Quantity, Sample),
        time_factor: f64,
    ) -> Option<Self> {
        let own = results.study.references.first()?.name();
        let (few, _) = drawn(&results.refined(Axis::Cells));
        if few.is_empty() {
            return None;
        }
        Self::new(results, &few, (Axis::Cells, time_factor), measured, own)
    }
}

impl ErrorLine {
    fn new(summary: &SeriesSummary<'_>, label: String, has_orders: bool) -> Self {
        let finite = |error: Option<f64>| error.filter(|error| error.is_finite());
        let levels = summary.series.levels().iter();
        Self {
            label,
            sample: summary.measure.sample,
            points: levels.filter_map(|level| Some((level.size, finite(level.error)?))).collect(),
            class: summary.classification.class,
            order: summary.classification.order.filter(|_| has_orders),
        }
    }
}

/// Each slope that a series comes near, with the first that does.
fn near_slopes(summaries: &[SeriesSummary<'_>]) -> Vec<NearSlope> {
    let is_near = |summary: &SeriesSummary<'_>, slope: f64| {
        summary.finest.as_ref().is_ok_and(|order| (order - slope).abs() < NEAR)
    };
    let near = |slope: f64| {
        let line = summaries.iter().position(|summary| is_near(summary, slope))?;
        Some(NearSlope { slope, line })
    };
    SLOPES.into_iter().filter_map(near).collect()
}

/// The floor that a figure shows as one line, and its owner: the only limited series, or all series where they end
/// within a tenth of each other. Other floors are in the table.
fn shared_floor(summaries: &[SeriesSummary<'_>]) -> Option<(f64, Option<usize>)> {
    let floor = |summary: &SeriesSummary<'_>| Some(summary.classification.floor.as_ref()?.value);
    let floors: Vec<(f64, usize)> =
        summaries.iter().enumerate().filter_map(|(place, summary)| Some((floor(summary)?, place))).collect();
    let (lowest, highest) = floors
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), (floor, _)| (low.min(*floor), high.max(*floor)));
    match floors.as_slice() {
        [(only, place)] => Some((*only, Some(*place))),
        [_, _, ..] if floors.len() == summaries.len() && highest <= SAME_FLOOR * lowest => {
            Some(((lowest * highest).sqrt(), None))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::judge::paths::StudyPaths;
    use crate::record::Record;
    use oedometer_convergence::{Floor, Undefined};

    /// Series of methods with the floors and the finest orders that are given.
    fn summaries<'a, const N: usize>(
        records: &'a [Record],
        given: [(Option<f64>, f64); N],
    ) -> Vec<SeriesSummary<'a>> {
        let paths = StudyPaths::of(records);
        let measure = first_measure(Quantity::Pressure, Sample::Points, "terzaghi", 0.2);
        let summary = |(path, (floor, order)): (&Path<'a>, (Option<f64>, f64))| {
            let mut summary = path.summary(&measure);
            summary.classification.floor =
                floor.map(|value| Floor { value, fitted: true, limits_from: 0.25, limiter: None });
            summary.finest = Ok::<f64, Undefined>(order);
            summary
        };
        paths.along(Axis::Cells).iter().zip(given).map(summary).collect()
    }

    #[test]
    fn a_floor_is_that_of_the_only_series_with_one_or_of_all_that_have_about_the_same() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\n\
             method = ['MPM', 'GIMP', 'GIMP-SRI']\nintegrator = ['implicit']\ncells = [2, 4]\n",
        );
        let floors = |floors: &[Option<f64>; 3], shown: usize| {
            let all = summaries(&records, floors.map(|floor| (floor, 1.0)));
            assert_eq!(all.len(), 3);
            shared_floor(&all[..shown])
        };
        let floor = |[a, b]: [Option<f64>; 2]| floors(&[a, b, None], 2);
        assert_eq!(floor([None, None]), None);
        assert_eq!(floor([None, Some(0.3)]), Some((0.3, Some(1))));
        let (both, line) = floor([Some(0.4), Some(0.42)]).expect("about the same");
        assert!((both - 0.168_f64.sqrt()).abs() < 1e-15 && line.is_none(), "{both} {line:?}");
        assert_eq!(floor([Some(0.4), Some(0.8)]), None);
        assert_eq!(floor([Some(0.8), Some(0.4)]), None);
        let alike = [Some(0.42), Some(0.4), Some(0.41)];
        assert_eq!(floors(&alike, 3).expect("about the same").1, None);
        for place in 0..3 {
            let with = |floor: Option<f64>, rest: [Option<f64>; 3]| {
                let mut all = rest;
                all[place] = floor;
                floors(&all, 3)
            };
            assert_eq!(with(None, alike), None, "two of three are neither one nor all: {place}");
            assert_eq!(with(Some(0.8), alike), None, "{place}");
            assert_eq!(with(Some(0.1), alike), None, "{place}");
            assert_eq!(with(Some(0.3), [None; 3]), Some((0.3, Some(place))));
        }

        let near = |orders: [f64; 2]| {
            let found = near_slopes(&summaries(&records, orders.map(|order| (None, order))));
            found.iter().map(|near| (near.slope, near.line)).collect::<Vec<_>>()
        };
        assert_eq!(near([0.2, 3.0]), []);
        assert_eq!(near([2.1, 0.9]), [(1.0, 1), (2.0, 0)]);
        assert_eq!(near([1.8, 1.9]), [(2.0, 0)], "the first of several");
    }
}
