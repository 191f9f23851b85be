//! Critical steps as maps: curves over the parameter that varies, one for each method.

use crate::case::Case;
use crate::judge::paths::grouped;
use crate::measure::statistics::largest;
use crate::record::{CriticalStep, Record};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the axis of a map is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MapScale {
    /// Logarithmic.
    Log,
    /// Linear.
    Linear,
    /// Linear with a tick at every small whole number.
    Counts,
}

/// What a map is drawn over.
#[derive(Debug)]
struct MapAxis {
    label: &'static str,
    scale: MapScale,
    of: fn(&Case) -> f64,
}

/// One case of a map; steps over `h/c`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapPoint {
    /// Place on the axis.
    pub at: f64,
    /// Predicted critical step.
    pub predicted: f64,
    /// Observed one.
    pub observed: Option<f64>,
}

/// The cases of one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapCurve {
    /// Method.
    pub name: String,
    /// Its cases along the axis.
    pub points: Vec<MapPoint>,
}

/// A map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityMap {
    /// What it is drawn over, with its unit.
    pub over: String,
    /// How its axis is drawn.
    pub scale: MapScale,
    /// What its cases have in common besides the method, in words.
    pub shared: String,
    /// One curve for each method.
    pub curves: Vec<MapCurve>,
    /// Largest difference of observed from predicted, relative.
    pub largest_deviation: f64,
}

static AXES: [MapAxis; 6] = [
    MapAxis {
        label: "hydraulic conductivity k (m/s)",
        scale: MapScale::Log,
        of: |case| case.material.hydraulic_conductivity,
    },
    MapAxis {
        label: "stiffness of the water K_w/E (–)",
        scale: MapScale::Log,
        of: |case| case.material.water_bulk_modulus / case.material.youngs_modulus,
    },
    MapAxis { label: "porosity n (–)", scale: MapScale::Log, of: |case| case.material.porosity },
    MapAxis {
        label: "points per cell (–)", scale: MapScale::Counts, of: |case| case.points_per_cell as f64
    },
    MapAxis {
        label: "shift of the points, in spacings (–)",
        scale: MapScale::Linear,
        of: |case| case.column.points.offset,
    },
    MapAxis { label: "FLIP share (–)", scale: MapScale::Linear, of: |case| case.settings.flip },
];

/// The maps of records: over the one parameter that takes most values, one map for every choice of the
/// integrator.
pub fn maps_of(records: &[Record]) -> Vec<StabilityMap> {
    let Some(axis) = widest_axis(records) else { return Vec::new() };
    let searched = records.iter().filter_map(|record| Some((&record.case, record.stability.as_ref()?)));
    let map = |(shared, cases): (String, Vec<_>)| {
        let deviations = cases.iter().map(|(_, found): &(&Case, &CriticalStep)| {
            found.within().unwrap_or(found.deviation().map_or(0.0, f64::abs))
        });
        let largest_deviation = largest(deviations).unwrap_or(0.0);
        let curve = |(name, cases): (String, Vec<(&Case, &CriticalStep)>)| {
            let point = |(case, found): (&Case, &CriticalStep)| MapPoint {
                at: (axis.of)(case),
                predicted: found.predicted / found.wave_limit,
                observed: found.observed.map(|observed| observed / found.wave_limit),
            };
            let mut points: Vec<MapPoint> = cases.into_iter().map(point).collect();
            points.sort_by(|a, b| a.at.total_cmp(&b.at));
            MapCurve { name, points }
        };
        let curves = grouped(cases, |(case, _)| case.method.to_string()).into_iter().map(curve).collect();
        StabilityMap { over: axis.label.to_owned(), scale: axis.scale, shared, curves, largest_deviation }
    };
    grouped(searched, |(case, _)| settings_of(case)).into_iter().map(map).collect()
}

/// The parameter that takes most values, two at least.
fn widest_axis(records: &[Record]) -> Option<&'static MapAxis> {
    let values = |axis: &MapAxis| {
        let mut values: Vec<f64> = records.iter().map(|record| (axis.of)(&record.case)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    AXES.iter().filter(|axis| values(axis) > 1).max_by_key(|axis| values(axis))
}

/// The choices of the integrator, in words.
fn settings_of(case: &Case) -> String {
    let settings = &case.settings;
    let mapping = if settings.mapping_back { "" } else { ", no mapping back" };
    let scheme =
        if settings.scheme.is_paper() { String::new() } else { format!(", {}", settings.scheme.name()) };
    let slopes = if settings.affine { ", APIC" } else { "" };
    let stresses = if settings.stress_slopes { ", stress slopes" } else { "" };
    format!("{} drag{mapping}{slopes}{stresses}{scheme}", settings.drag.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use oedometer_problem::settings::Drag;
    use oedometer_problem::settings::Scheme;

    #[test]
    fn a_map_is_drawn_over_what_takes_most_values_wherever_its_axis_stands() {
        let axis = |sweep: &str| {
            let records = records_of(&format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\n\
                 time_step = [{{ growth = 0.5 }}]\ncells = [2]\n{sweep}"
            ));
            widest_axis(&records).map(|axis| axis.label)
        };
        let (conductivity, porosity) = ("hydraulic conductivity k (m/s)", "porosity n (–)");
        let sweep = |k: &str, n: &str| format!("hydraulic_conductivity = [{k}]\nporosity = [{n}]\n");
        assert_eq!(axis(&sweep("1e-4, 1e-5", "0.3, 0.4, 0.5")), Some(porosity));
        assert_eq!(axis(&sweep("1e-4, 1e-5, 1e-6", "0.3, 0.4")), Some(conductivity));
        assert_eq!(axis(&sweep("1e-4", "0.3, 0.4")), Some(porosity));
        assert_eq!(axis(""), None);
    }

    #[test]
    fn the_largest_deviation_counts_on_both_sides_wherever_it_stands() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\nhydraulic_conductivity = [1e-4, 1e-5, 1e-6]\n",
        );
        for (place, worst) in (0..3).flat_map(|place| [(place, 0.6), (place, 1.4)]) {
            let mut records = records.clone();
            for (number, record) in records.iter_mut().enumerate() {
                record.stability = Some(CriticalStep {
                    predicted: 2.0,
                    creeping_from: None,
                    unknown: None,
                    observed: Some(2.0 * if number == place { worst } else { 0.9 }),
                    resolution: None,
                    wave_limit: 4.0,
                    drag_limit: 8.0,
                    combined_limit: 3.0,
                    probes: Vec::new(),
                    asymmetry: None,
                });
            }
            let maps = maps_of(&records);
            assert_eq!(maps.len(), 1);
            assert!((maps[0].largest_deviation - 0.4).abs() < 1e-12, "{worst} at {place}: {maps:?}");
        }
    }

    #[test]
    fn curves_lie_along_the_axis_of_their_map_with_steps_over_that_of_the_wave() {
        use MapScale::{Counts, Linear, Log};
        for (key, values, label, scale, places) in [
            ("hydraulic_conductivity", "1e-4, 1e-6", "hydraulic conductivity k (m/s)", Log, [1e-6, 1e-4]),
            ("water_bulk_modulus", "4e9, 2e9", "stiffness of the water K_w/E (–)", Log, [2e3, 4e3]),
            ("porosity", "0.4, 0.2", "porosity n (–)", Log, [0.2, 0.4]),
            ("points_per_cell", "3, 2", "points per cell (–)", Counts, [2.0, 3.0]),
            ("offset", "0.25, -0.25", "shift of the points, in spacings (–)", Linear, [-0.25, 0.25]),
            ("flip", "1.0, 0.5", "FLIP share (–)", Linear, [0.5, 1.0]),
        ] {
            let mut records = records_of(&format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [1e-4]\n[[sweep]]\nmethod = ['MPM', 'GIMP']\n\
                 integrator = ['explicit']\ncells = [2]\n{key} = [{values}]\n"
            ));
            for record in &mut records {
                record.stability = Some(CriticalStep {
                    predicted: 2.0,
                    observed: (record.case.method.to_string() == "MPM").then_some(1.0),
                    wave_limit: 4.0,
                    drag_limit: 8.0,
                    combined_limit: 3.0,
                    ..CriticalStep::default()
                });
            }
            // A record whose step was not searched is on no map.
            let not_searched = Record { stability: None, ..records[0].clone() };
            let maps = maps_of(&[&records[..], &[not_searched]].concat());
            let [map] = &maps[..] else { panic!("{maps:?}") };
            assert_eq!((&*map.over, map.scale, &*map.shared), (label, scale, "explicit drag"));
            assert_eq!(map.largest_deviation, 0.5);
            let point = |observed: Option<f64>| move |at: f64| MapPoint { at, predicted: 0.5, observed };
            let curve = |name: &str, observed: Option<f64>| MapCurve {
                name: name.to_owned(),
                points: places.map(point(observed)).to_vec(),
            };
            assert_eq!(map.curves, [curve("MPM", Some(0.25)), curve("GIMP", None)], "{key}");
            // Another choice of the integrator is another map.
            records[0].case.settings.mapping_back = false;
            let shared: Vec<String> = maps_of(&records).into_iter().map(|map| map.shared).collect();
            assert_eq!(shared, ["explicit drag, no mapping back", "explicit drag"], "{key}");
            let settings = &mut records[0].case.settings;
            (settings.drag, settings.scheme) = (Drag::Centred, Scheme::Leapfrog);
            (settings.affine, settings.stress_slopes) = (true, true);
            let all = "centred drag, no mapping back, APIC, stress slopes, leapfrog";
            assert_eq!(settings_of(&records[0].case), all);
        }
    }
}
