//! What is measured of a run beside errors of fields: the peak of a pressure, and what moves where nothing may.

use crate::case::Case;
use crate::exact::reference::Reference;
use crate::measure::pressure_peak::peak_measures;
use crate::mpm::run::results::snapshot::Snapshot;
use crate::record::{Balance, MeasureRow};

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::csv::tidy;

    #[test]
    fn a_peak_and_what_moves_at_rest_are_rows_of_the_table() {
        for (scene, more, name, exact) in [
            (
                "mandel",
                "output = { time_factors = [0.0645, 0.068, 0.0717] }",
                "peak_pressure",
                0.546_059_661_7,
            ),
            ("at-rest", "output = { time_factors = [1e-4] }", SPURIOUS_VELOCITY, 0.0),
        ] {
            let study = format!(
                "title = \"t\"\nscene = \"{scene}\"\n{more}\n[[sweep]]\nmethod = [\"GIMP-SRI\"]\n\
                 integrator = [\"implicit\"]\ncells = [10]\ntime_step = [{{ growth = 0.02 }}]\n"
            );
            let record = records_of(&study).remove(0);
            let row = record.measures.iter().find(|row| row.name == name).expect("the measure");
            assert!((row.exact - exact).abs() < 1e-10 && row.error().abs() < 5e-3, "{row:?}");
            let table = tidy::rows_of("t", &record);
            let told = table.lines().filter(|line| line.contains(&format!(",{name},,"))).count();
            assert_eq!(told, 1, "{table}");
        }
    }
}
