//! Methods over a map of soils: where each was tried, comes within the tolerance, is cheapest and fails.

use crate::measure::statistics::median;
use crate::questions::blocks::Point;
use crate::questions::comparison::work_precision::{MappedSoil, TOLERANCE, Way, mapped_soils};
use crate::questions::study_results::StudyResults;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Fewest soils that make a map.
const LEAST_SOILS: usize = 4;

/// Methods over a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapFinding {
    /// Largest error of the pressure that counts as reached.
    pub tolerance: f64,
    /// Soils of the map.
    pub soils: usize,
    /// Where each soil lies, who is cheapest there and what breaks.
    #[serde(default)]
    pub places: Vec<SoilPlace>,
    /// Every method and integrator by its name.
    pub methods: Vec<MapMethod>,
}

/// A soil of the map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SoilPlace {
    /// Hydraulic conductivity, m/s, and Young's modulus of the skeleton, Pa.
    pub at: Point,
    /// The cheapest method and integrator within the tolerance.
    pub cheapest: Option<String>,
    /// Integrators of which a run failed.
    pub broken: BTreeSet<String>,
    /// Integrators of the study that were not tried here.
    pub untried: BTreeSet<String>,
}

/// A method with its integrator over all soils.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapMethod {
    /// Method and integrator.
    pub name: String,
    /// Soils on which it was tried.
    pub tried: usize,
    /// Soils on which it comes within the tolerance.
    pub within: usize,
    /// Soils on which no finer mesh confirms that.
    #[serde(default)]
    pub unconfirmed: usize,
    /// Soils on which it is the cheapest.
    pub cheapest: usize,
    /// Its cost over the cheapest, the median.
    pub cost_over_cheapest: Option<f64>,
    /// Its cells, the median.
    pub cells: Option<f64>,
    /// Soils on which a run of it failed.
    pub broken: usize,
}

/// The soils of a study that varies conductivity and stiffness; empty for others.
pub(super) fn soils_of(results: &StudyResults<'_>) -> Vec<MappedSoil> {
    let Some(reference) = results.study.references.first() else { return Vec::new() };
    let soils = mapped_soils(results.records, reference.name(), &results.study.case_expectations);
    if soils.len() < LEAST_SOILS { Vec::new() } else { soils }
}

impl MapFinding {
    /// Every method and integrator over the soils; `None` without soils.
    pub fn new(soils: &[MappedSoil]) -> Option<Self> {
        let names: BTreeSet<&str> = soils.iter().flat_map(|soil| &soil.tried).map(String::as_str).collect();
        let methods = names.into_iter().map(|name| MapMethod::new(name, soils)).collect();
        let of_study: BTreeSet<String> = soils.iter().flat_map(|soil| integrators(&soil.tried)).collect();
        let places = soils.iter().map(|soil| SoilPlace::new(soil, &of_study)).collect();
        (!soils.is_empty()).then_some(Self { tolerance: TOLERANCE, soils: soils.len(), places, methods })
    }
}

/// The integrators among methods and integrators.
fn integrators(names: &[String]) -> BTreeSet<String> {
    let integrator_of =
        |name: &String| name.rsplit_once(' ').map_or(name.as_str(), |parts| parts.1).to_owned();
    names.iter().map(integrator_of).collect()
}

impl SoilPlace {
    fn new(soil: &MappedSoil, of_study: &BTreeSet<String>) -> Self {
        Self {
            at: (soil.conductivity, soil.stiffness),
            cheapest: soil.cheapest().map(|way| way.name.clone()),
            broken: integrators(&soil.broken),
            untried: of_study.difference(&integrators(&soil.tried)).cloned().collect(),
        }
    }
}

impl MapMethod {
    fn new(name: &str, soils: &[MappedSoil]) -> Self {
        let count = |is: &dyn Fn(&MappedSoil) -> bool| soils.iter().filter(|soil| is(soil)).count();
        let ways: Vec<(&Way, &Way)> =
            soils.iter().filter_map(|soil| Some((soil.way_of(name)?, soil.cheapest()?))).collect();
        let over: Vec<f64> = ways.iter().map(|(own, best)| own.seconds / best.seconds).collect();
        let cells: Vec<f64> = ways.iter().map(|(own, _)| own.cells as f64).collect();
        Self {
            name: name.to_owned(),
            tried: count(&|soil| soil.tried.iter().any(|tried| tried == name)),
            within: ways.len(),
            unconfirmed: ways.iter().filter(|(own, _)| !own.is_confirmed).count(),
            cheapest: count(&|soil| soil.cheapest().is_some_and(|way| way.name == name)),
            cost_over_cheapest: median(&over),
            cells: median(&cells),
            broken: count(&|soil| soil.broken.iter().any(|broken| broken == name)),
        }
    }
}
