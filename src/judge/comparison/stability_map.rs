//! Records of critical steps as maps: curves over the parameter that varies, one a method.

use crate::case::Case;
use crate::measure::largest::larger;
use crate::record::Record;

/// What a map is drawn over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapAxis {
    /// Hydraulic conductivity, m/s.
    Conductivity,
    /// `K_w/E`.
    Stiffness,
    /// Porosity.
    Porosity,
    /// Points a cell.
    Points,
    /// Shift of the points in spacings.
    Offset,
    /// FLIP share.
    Flip,
}

/// One case of a map; steps over `h/c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Place on the axis.
    pub at: f64,
    /// Predicted critical step.
    pub predicted: f64,
    /// Observed one.
    pub observed: Option<f64>,
}

/// The cases of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct MapCurve {
    /// Method.
    pub name: String,
    /// Its cases along the axis.
    pub points: Vec<MapPoint>,
}

/// A map.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityMap {
    /// What it is drawn over.
    pub axis: MapAxis,
    /// What its cases share beside the method, in words.
    pub shared: String,
    /// One a method.
    pub curves: Vec<MapCurve>,
    /// Largest difference of observed from predicted, relative.
    pub largest_deviation: f64,
}

const AXES: [MapAxis; 6] = [
    MapAxis::Conductivity,
    MapAxis::Stiffness,
    MapAxis::Porosity,
    MapAxis::Points,
    MapAxis::Offset,
    MapAxis::Flip,
];

impl MapAxis {
    fn of(self, case: &Case) -> f64 {
        match self {
            Self::Conductivity => case.material.hydraulic_conductivity,
            Self::Stiffness => case.material.water_bulk_modulus / case.material.youngs_modulus,
            Self::Porosity => case.material.porosity,
            Self::Points => case.points_per_cell as f64,
            Self::Offset => case.column.points.offset,
            Self::Flip => case.settings.flip,
        }
    }
}

/// The maps of records: over the one parameter that takes most values, apart for every choice of the
/// integrator.
pub fn maps_of(records: &[Record]) -> Vec<StabilityMap> {
    let Some(axis) = widest_axis(records) else { return Vec::new() };
    let mut maps: Vec<StabilityMap> = Vec::new();
    for record in records {
        let Some(found) = &record.stability else { continue };
        let shared = settings_of(&record.case);
        let place = maps.iter().position(|map| map.shared == shared).unwrap_or_else(|| {
            maps.push(StabilityMap { axis, shared, curves: Vec::new(), largest_deviation: 0.0 });
            maps.len() - 1
        });
        let map = &mut maps[place];
        let deviation = found.deviation().map_or(0.0, f64::abs);
        map.largest_deviation = larger(map.largest_deviation, deviation);
        let name = record.case.method.to_string();
        let curve = map.curves.iter().position(|curve| curve.name == name).unwrap_or_else(|| {
            map.curves.push(MapCurve { name, points: Vec::new() });
            map.curves.len() - 1
        });
        map.curves[curve].points.push(MapPoint {
            at: axis.of(&record.case),
            predicted: found.predicted / found.wave_limit,
            observed: found.observed.map(|observed| observed / found.wave_limit),
        });
    }
    for curve in maps.iter_mut().flat_map(|map| &mut map.curves) {
        curve.points.sort_by(|a, b| a.at.total_cmp(&b.at));
    }
    maps
}

/// The parameter that takes most values, two at least.
fn widest_axis(records: &[Record]) -> Option<MapAxis> {
    let values = |axis: MapAxis| {
        let mut values: Vec<f64> = records.iter().map(|record| axis.of(&record.case)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    AXES.into_iter()
        .map(|axis| (axis, values(axis)))
        .filter(|(_, count)| *count > 1)
        .max_by_key(|one| one.1)
        .map(|one| one.0)
}

/// The choices of the integrator, in words.
fn settings_of(case: &Case) -> String {
    let settings = &case.settings;
    let mapping = if settings.mapping_back { "" } else { ", no mapping back" };
    let scheme =
        if settings.scheme.is_paper() { String::new() } else { format!(", {}", settings.scheme.name()) };
    let slopes = if settings.affine { ", slopes of velocities" } else { "" };
    let stresses = if settings.stress_slopes { ", slopes of stresses" } else { "" };
    format!("{} drag{mapping}{slopes}{stresses}{scheme}", settings.drag.name())
}
