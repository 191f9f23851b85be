//! A plane: pressure fields beside the exact one; of a footing the load over the settlement of all methods.

use crate::case::Quantity;
use crate::judge::paths::grouped;
use crate::measure::fields::PlaneField;
use crate::questions::blocks::Point;
use crate::questions::study_results::StudyResults;
use crate::record::{Record, Status};
use oedometer_exact::ExactError;
use oedometer_exact::footing::LOAD_FACTOR;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cells over the height of the runs whose fields are drawn.
const SHOWN_CELLS: usize = 8;

/// Reach of the colours over the largest exact value.
const REACH: f64 = 1.25;

/// Pressure fields over the load at the first output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FieldsFinding {
    /// Cells over the height.
    #[serde(default)]
    pub cells: usize,
    /// Poisson's ratio of the skeleton.
    pub poissons_ratio: f64,
    /// Time factor.
    pub time_factor: f64,
    /// The exact field and that of the first sound run of each method.
    pub fields: Vec<FieldFinding>,
}

/// A field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FieldFinding {
    /// Method; `None` for theory.
    pub method: Option<String>,
    /// Total variation over the exact one's, minus one.
    pub oscillation: Option<f64>,
    /// Largest size of a value.
    pub largest: f64,
    /// Reach of the colours.
    pub reach: f64,
    /// Lines between the points over the length, over the height.
    pub x_edges: Vec<f64>,
    /// Lines between the points over the height.
    pub y_edges: Vec<f64>,
    /// `p/q`, row by row from the base.
    pub values: Vec<f64>,
}

impl FieldsFinding {
    /// Fields of a study of a layer; `None` for a column.
    ///
    /// # Errors
    /// When the reference refuses a case.
    pub fn new(results: &StudyResults<'_>) -> Result<Option<Self>, ExactError> {
        let scene = results.study.scene;
        let shown = shown_records(results.records);
        let Some(first) =
            shown.first().filter(|_| scene.body.is_plane() && scene.measures(Quantity::Pressure))
        else {
            return Ok(None);
        };
        let time_factor = first.case.time_factors[0];
        let exact = PlaneField::of(first, time_factor)?;
        let mut fields: Vec<FieldFinding> =
            exact.iter().map(|field| FieldFinding::new(field, &field.exact, None)).collect();
        for record in &shown {
            if let Some(field) = PlaneField::of(record, time_factor)? {
                let method = record.case.method.to_string();
                let run = Some((method, field.oscillation_index()));
                fields.push(FieldFinding::new(&field, &field.computed, run));
            }
        }
        Ok(Some(Self {
            cells: SHOWN_CELLS,
            poissons_ratio: first.case.material.poissons_ratio,
            time_factor,
            fields,
        }))
    }
}

impl FieldFinding {
    /// A field of values; all share the reach of the exact one.
    pub fn new(field: &PlaneField, values: &[f64], run: Option<(String, f64)>) -> Self {
        let (method, oscillation) = run.unzip();
        Self {
            method,
            oscillation,
            largest: largest_size(values),
            reach: REACH * largest_size(&field.exact),
            x_edges: field.x_edges.clone(),
            y_edges: field.y_edges.clone(),
            values: values.to_vec(),
        }
    }
}

fn largest_size(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

/// The first sound run of each method on the shown mesh, in the undisturbed soil.
pub(crate) fn shown_records(records: &[Record]) -> Vec<&Record> {
    let mut shown: Vec<&Record> = Vec::new();
    for record in records {
        let case = &record.case;
        if case.cells == SHOWN_CELLS
            && record.status == Status::Ok
            && case.has_usual_compressibility()
            && shown.iter().all(|other| other.case.method != case.method)
        {
            shown.push(record);
        }
    }
    shown
}

/// Load over the settlement of a footing, on the finest of the meshes that most methods have run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LoadCurves {
    /// Cells under the plate.
    pub cells: usize,
    /// What keeps the soil undrained.
    pub undrained: String,
    /// The first run of each method on that mesh; the place of a method among all of the study is its colour.
    pub runs: Vec<LoadCurve>,
    /// The exact collapse load over width and strength, `2 + π`.
    pub exact: f64,
    /// The largest settlement over the width.
    pub end: f64,
}

/// Load over settlement of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LoadCurve {
    /// Method.
    pub method: String,
    /// Its place among the methods of the study.
    pub place: usize,
    /// Settlement over the width, and load over width and strength.
    pub points: Vec<Point>,
}

impl LoadCurves {
    /// The curves of a footing, all kept undrained as in the study's first case; `None` for other scenes.
    pub fn new(results: &StudyResults<'_>) -> Option<Self> {
        let undrained = results.records.first()?.case.column.footing.undrained;
        let is_drawn = |record: &&Record| {
            results.study.scene.measures(Quantity::LoadFactor)
                && record.status == Status::Ok
                && record.case.column.footing.undrained == undrained
        };
        let of_methods =
            grouped(results.records.iter().filter(is_drawn), |record| record.case.method.to_string());
        let has = |own: &[&Record], cells: usize| own.iter().any(|record| record.case.cells == cells);
        let methods_on = |cells: usize| of_methods.iter().filter(|(_, own)| has(own, cells)).count();
        let meshes = of_methods.iter().flat_map(|(_, own)| own.iter().map(|record| record.case.cells));
        let cells = meshes.max_by_key(|cells| (methods_on(*cells), *cells))?;
        let curve = |(place, (method, own)): (usize, &(String, Vec<&Record>))| {
            let record = own.iter().find(|record| record.case.cells == cells)?;
            let points = record.history.iter().filter_map(|row| Some((row.time_factor, row.load_factor?)));
            Some(LoadCurve { method: method.clone(), place, points: points.collect() })
        };
        let runs: Vec<LoadCurve> = of_methods.iter().enumerate().filter_map(curve).collect();
        let end = runs
            .iter()
            .flat_map(|run| &run.points)
            .fold(0.0, |end: f64, (settlement, _)| end.max(*settlement));
        Some(Self { cells, undrained: undrained.name().to_owned(), runs, exact: LOAD_FACTOR, end })
    }
}
