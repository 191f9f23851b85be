//! How far the exact solution of the paper's equations, as they are printed, is from Xie & Leo's: no mesh is in it.

use oedometer_exact::exact_error::ExactError;
use oedometer_exact::large_strain::{LargeStrainModel, Water};
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;
use serde::{Deserialize, Serialize};

/// Cells of the mesh on which errors are quoted: the paper's.
pub const QUOTED_CELLS: usize = 10;
/// Load of the paper's column at large strain, Pa.
pub const LARGE_STRAIN_LOAD: f64 = 200e3;
/// Output times, as time factors.
const TIMES: [f64; 6] = [0.0079, 0.1, 0.2, 0.4, 0.85, 1.0];
/// A time factor at which nothing moves any more.
pub const END: f64 = 10.0;
/// Places over the height at which pressures are compared.
const PLACES: usize = 200;

/// How far one exact solution is from another at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Departure {
    /// Time factor.
    pub time_factor: f64,
    /// Settlement over Xie & Leo's, less one.
    pub settlement: f64,
    /// Relative L2 difference of the pressure over the height.
    pub pressure: f64,
}

/// Differences of the printed equations from Xie & Leo's solution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PublishedEquations {
    /// At the output times.
    pub departures: Vec<Departure>,
    /// Of the final settlement.
    pub final_settlement: f64,
}

impl PublishedEquations {
    /// The differences, exact against exact.
    ///
    /// # Errors
    /// When a solution refuses the paper's column.
    pub fn new() -> Result<Self, ExactError> {
        let column = |law, continuity| ColumnParameters {
            load: LARGE_STRAIN_LOAD,
            soil: Material { law, continuity, ..Material::default() },
            ..ColumnParameters::default()
        };
        let times: Vec<f64> = TIMES.into_iter().chain([END]).collect();
        let (law, continuity) = (Law::PorosityDependent, Continuity::ConstantPorosityGradient);
        let model = LargeStrainModel { law, continuity, water: Water::Compressible };
        let printed =
            Reference::for_lines(ReferenceKind::LargeStrain(model), &column(law, continuity), &times)?;
        let xie_leo = column(Law::LogLinear, Continuity::Conservative);
        let xie_leo = Reference::new(ReferenceKind::XieLeo, &xie_leo, &times)?;
        let settlement = |time: f64| -> Result<f64, ExactError> {
            Ok(printed.settlement(time)? / xie_leo.settlement(time)? - 1.0)
        };
        let departure = |time_factor: f64| -> Result<Departure, ExactError> {
            let (mut difference, mut size) = (0.0, 0.0);
            for place in 0..PLACES {
                let zeta = (place as f64 + 0.5) / PLACES as f64;
                let [ours, theirs] = [&printed, &xie_leo].map(|one| one.fields(time_factor, zeta));
                let (ours, theirs) = (ours?.pressure, theirs?.pressure);
                difference += (ours - theirs) * (ours - theirs);
                size += theirs * theirs;
            }
            let pressure = (difference / size).sqrt();
            Ok(Departure { time_factor, settlement: settlement(time_factor)?, pressure })
        };
        Ok(Self {
            departures: TIMES.into_iter().map(departure).collect::<Result<_, _>>()?,
            final_settlement: settlement(END)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_equations_settle_too_fast_and_end_too_high_by_known_shares() {
        let found = PublishedEquations::new().expect("the paper's column");
        // The differences that were computed when the trap was found, in per cent.
        let settlements: Vec<f64> =
            found.departures.iter().map(|one| (1e3 * one.settlement).round() / 10.0).collect();
        assert_eq!(settlements, [7.8, 7.7, 6.8, 3.2, -2.7, -3.9]);
        let pressures: Vec<f64> =
            found.departures.iter().map(|one| (1e3 * one.pressure).round() / 10.0).collect();
        assert_eq!(pressures, [2.8, 6.9, 11.1, 20.4, 36.5, 40.7]);
        // 0.14286 m over 0.15352 m.
        assert!(
            (found.final_settlement - (0.142_86 / 0.153_52 - 1.0)).abs() < 2e-4,
            "{}",
            found.final_settlement
        );
    }
}
