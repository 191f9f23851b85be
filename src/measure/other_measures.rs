//! What is measured of a run beside errors of fields: the peak of a pressure, and what moves where nothing may.

use crate::case::Case;
use crate::measure::pressure_peak::peak_measures;
use crate::record::{Balance, MeasureRow};
use oedometer_exact::reference::Reference;
use oedometer_mpm::run::results::snapshot::Snapshot;

/// Name of the largest nodal velocity over the hydraulic conductivity, of a column at rest.
pub const SPURIOUS_VELOCITY: &str = "spurious_velocity";
/// Name of the water in the soil over its pores, less one, of two layers.
pub const PORE_WATER: &str = "pore_water";
/// Name of the share of the water that left less the settlement over `n_0 H`, of two layers.
pub const WATER_LEFT_ERROR: &str = "water_left_error";
/// Name of the largest pressure of any water point since the start over the load, of two layers: where all of the load
/// acts at once, what is beyond one is no consolidation.
pub const LARGEST_PRESSURE: &str = "largest_pressure";

/// The measures of a run, with the scene's own reference for what they must be; at every output, or of the whole run.
pub fn measures_of(
    case: &Case,
    own: Option<&Reference>,
    balance: &[Balance],
    snapshots: &[Snapshot],
) -> Vec<MeasureRow> {
    let Some(own) = own else { return Vec::new() };
    let mut measures = peak_measures(case, own, snapshots);
    for output in balance {
        let layers = output.layers.as_ref();
        let values = [
            (SPURIOUS_VELOCITY, output.spurious_velocity, 0.0),
            (PORE_WATER, layers.map(|one| one.pore_water), 0.0),
            (WATER_LEFT_ERROR, layers.map(|one| one.water_left_error), 0.0),
            (LARGEST_PRESSURE, layers.and_then(|one| one.largest_pressure), 1.0),
        ];
        measures.extend(values.into_iter().filter_map(|(name, found, exact)| {
            Some(MeasureRow {
                name: name.to_owned(),
                time_factor: Some(output.time_factor),
                reference: own.name().to_owned(),
                found: found?,
                exact,
            })
        }));
    }
    measures
}
