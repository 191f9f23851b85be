//! Large-strain consolidation for any soil law, by a spectral method to round-off.

pub mod diffusion;
mod layers;
mod legendre;
mod march;
mod radau;
mod similarity;

pub use crate::large_strain::diffusion::{LargeStrainModel, Water};

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::inputs::{COLUMN_KEYS, DRAINAGE_KEY, LAW_KEY, WATER_KEYS, WEIGHT_KEY};
use crate::large_strain::diffusion::{Diffusion, Loading};
use crate::large_strain::layers::{Layers, Profile};
use crate::large_strain::march::{March, State};
use crate::large_strain::similarity::Front;
use crate::parameters::ColumnParameters;
use crate::row::Row;
use crate::solution::{Accuracy, FieldValues, Solution};

/// The row of the solution.
pub(crate) static LARGE_STRAIN: Row = Row {
    name: "large-strain",
    words: "the exact large-strain solution of its own equations",
    inputs: &[
        COLUMN_KEYS,
        DRAINAGE_KEY,
        WATER_KEYS,
        LAW_KEY,
        WEIGHT_KEY,
        &["continuity", "loading_time", "soils"],
    ],
    is_prepared: true,
    ..Row::COLUMN
};

/// Resolutions: points in depth and growth of the time step. Each is held against the one before.
const RESOLUTIONS: [(usize, f64); 5] = [(14, 0.45), (20, 0.3), (30, 0.22), (44, 0.15), (64, 0.1)];
/// Two resolutions that differ by less than this in `p/q` are enough.
const ENOUGH: f64 = 1e-9;
/// Difference in `p/q` that is enough for a line in a figure: a hundredth of what a reader sees.
const ENOUGH_TO_DRAW: f64 = 1e-6;
/// Largest difference of the last two resolutions that is accepted as a reference.
const TOO_MUCH: f64 = 1e-6;
/// Round-off: smaller differences are not significant.
const ROUND_OFF: f64 = 1e-13;
/// Number of load increments to find the first front.
const LOAD_SHARES: u32 = 4;

/// One-dimensional consolidation at large strain (Gibson, England & Hussey 1967), for any soil law,
/// both forms of continuity, with compressible or incompressible water.
///
/// In the Lagrangian coordinate `Y`, with `p = q + σ'(J)`,
///
/// ```text
/// J̇ + (nJ/K_w) ṗ = −∂w/∂Y            conservative
/// J̇ + (nJ/K_w) ṗ = −n ∂(w/n)/∂Y      constant porosity gradient
/// w = −(k/(γ_w J)) ∂p/∂Y
/// ```
///
/// is `C ∂r/∂T_v − C_s dλ/dT_v = ∂/∂ζ (κ ∂r/∂ζ)` for `r = p/q` under the share `λ` of the load, with the storage `C`, its
/// skeleton's part `C_s` and the conductance `κ` functions of `σ'/q = r − λ`. Under a load at once, until
/// the front reaches the base, the solution is a function of `ζ/√T_v`; from there, or from rest under a
/// load that grows, one spectral element per layer marches with Radau IIA.
#[derive(Clone, Debug)]
pub struct LargeStrain {
    parameters: ColumnParameters,
    loading: Loading,
    /// The first front; none where the load grows.
    front: Option<Front>,
    march: March,
    /// States at the prepared time factors, in order, the first at the front's end or at rest.
    states: Vec<(State, Profile)>,
    /// Largest difference between the last two resolutions, over the load.
    difference: f64,
    resolution: usize,
}

/// The solution at one resolution.
struct Attempt {
    front: Option<Front>,
    march: March,
    states: Vec<(State, Profile)>,
}

impl LargeStrain {
    /// Solves for a column at `time_factors`; every evaluation at another time needs a march.
    ///
    /// # Errors
    /// When the parameters are impossible, the load would close the pores, a time factor is
    /// negative or not finite, or the solution does not converge.
    pub fn new(
        parameters: &ColumnParameters,
        model: LargeStrainModel,
        time_factors: &[f64],
    ) -> Result<Self, ExactError> {
        Self::within(ENOUGH, parameters, model, time_factors)
    }

    /// Solves with fewer points and steps, for lines in figures; [`accuracy`](Self::accuracy) says how good they are.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn for_lines(
        parameters: &ColumnParameters,
        model: LargeStrainModel,
        time_factors: &[f64],
    ) -> Result<Self, ExactError> {
        Self::within(ENOUGH_TO_DRAW, parameters, model, time_factors)
    }

    /// The first resolution that differs by less than `enough` from the one before.
    fn within(
        enough: f64,
        parameters: &ColumnParameters,
        model: LargeStrainModel,
        time_factors: &[f64],
    ) -> Result<Self, ExactError> {
        let mut times = time_factors
            .iter()
            .map(|&time_factor| checked_time_factor(time_factor))
            .collect::<Result<Vec<_>, _>>()?;
        times.sort_by(f64::total_cmp);
        times.dedup();
        Layers::new(parameters, model, RESOLUTIONS[0].0)?;
        let loading = Loading::over(parameters.time_factor(parameters.loading_time));
        let mut before: Option<Attempt> = None;
        let mut difference = f64::INFINITY;
        let mut resolution = 0;
        for (order, growth) in RESOLUTIONS {
            let Ok(attempt) = Attempt::new(parameters, model, loading, (order, growth), &times) else {
                continue;
            };
            if let Some(before) = &before {
                difference = attempt.difference(before);
            }
            resolution = order;
            before = Some(attempt);
            if difference < enough {
                break;
            }
        }
        match before {
            Some(attempt) if difference < TOO_MUCH => Ok(Self {
                parameters: *parameters,
                loading,
                front: attempt.front,
                march: attempt.march,
                states: attempt.states,
                difference: difference.max(ROUND_OFF),
                resolution,
            }),
            _ => Err(ExactError::NotConverged { difference }),
        }
    }

    /// Profile at a time factor after the front: a prepared one, or marched to from the last before.
    fn profile(&self, time_factor: f64) -> Result<Profile, ExactError> {
        let later = self.states.partition_point(|(state, _)| state.time_factor <= time_factor);
        let (state, profile) = &self.states[later.saturating_sub(1)];
        if state.time_factor == time_factor {
            return Ok(profile.clone());
        }
        self.march
            .advance(state, time_factor)
            .map(|state| self.march.profile(&state))
            .ok_or(ExactError::NotConverged { difference: f64::INFINITY })
    }

    /// `p/q` and `∫_ζ^1 (1 − J) dζ` at a depth.
    fn ratio_and_shrinkage(&self, time_factor: f64, zeta: f64) -> Result<(f64, f64), ExactError> {
        if let Some(front) = self.front.as_ref().filter(|front| time_factor <= front.valid_until()) {
            return Ok((front.pressure_ratio(time_factor, zeta), front.shrinkage_below(time_factor, zeta)));
        }
        let profile = self.profile(time_factor)?;
        Ok((profile.pressure_ratio(zeta), profile.shrinkage_below(zeta)))
    }

    /// Volume ratio `J` at a relative depth.
    ///
    /// # Errors
    /// As for [`fields`](Self::fields).
    pub fn volume_ratio(&self, time_factor: f64, zeta: f64) -> Result<f64, ExactError> {
        let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
        let (ratio, _) = self.ratio_and_shrinkage(time_factor, zeta)?;
        let lacking = ratio + 1.0 - self.loading.share(time_factor);
        Ok(1.0 - self.march.layers.shrinkage(zeta, lacking))
    }
}

impl Solution for LargeStrain {
    /// Pressure, effective (Cauchy) stress and displacement at a Lagrangian relative depth.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
        let (ratio, shrinkage) = self.ratio_and_shrinkage(time_factor, zeta)?;
        let load = self.parameters.load;
        Ok(FieldValues {
            pressure: load * ratio,
            effective_stress: load * (ratio - self.loading.share(time_factor)),
            displacement: -self.parameters.height * shrinkage,
        })
    }

    /// Settlement of the surface, downward positive, m.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        let time_factor = checked_time_factor(time_factor)?;
        let (_, shrinkage) = self.ratio_and_shrinkage(time_factor, 0.0)?;
        Ok(self.parameters.height * shrinkage)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.parameters.height * self.march.layers.final_shrinkage())
    }

    /// Points in depth, and the difference to the next coarser resolution as the bound.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        checked_time_factor(time_factor)?;
        Ok(Accuracy::new(self.resolution, self.difference))
    }
}

impl Attempt {
    fn new(
        parameters: &ColumnParameters,
        model: LargeStrainModel,
        loading: Loading,
        (order, growth): (usize, f64),
        times: &[f64],
    ) -> Result<Self, ExactError> {
        let failed = ExactError::NotConverged { difference: f64::INFINITY };
        let march = March::new(Layers::new(parameters, model, order)?, loading, growth);
        let mut front: Option<Front> = None;
        if !loading.is_gradual() {
            // A steep front is reached by way of smaller loads.
            for share in 1..=LOAD_SHARES {
                let share = f64::from(share) / f64::from(LOAD_SHARES);
                let partly = Diffusion::new(model, parameters, share)?;
                front = Some(Front::new(&partly, 2 * order + 8, front.as_ref())?);
            }
        }
        let first =
            front.as_ref().map_or_else(|| march.rest(), |front| march.start(front, front.valid_until()));
        let mut states = vec![(first.clone(), march.profile(&first))];
        let mut now = first;
        for &time_factor in times {
            if time_factor > now.time_factor {
                now = march.advance(&now, time_factor).ok_or(failed.clone())?;
                states.push((now.clone(), march.profile(&now)));
            }
        }
        Ok(Self { front, march, states })
    }

    /// Largest difference of the pressure ratio from another resolution's at all its times.
    fn difference(&self, other: &Self) -> f64 {
        let fronts = self.front.iter().zip(&other.front);
        let early = fronts.flat_map(|(fine, coarse)| {
            let end = fine.valid_until();
            self.march
                .layers
                .depths()
                .map(move |zeta| fine.pressure_ratio(end, zeta) - coarse.pressure_ratio(end, zeta))
        });
        let late = self.states.iter().zip(&other.states).flat_map(|((_, fine), (_, coarse))| {
            self.march.layers.depths().map(|zeta| fine.pressure_ratio(zeta) - coarse.pressure_ratio(zeta))
        });
        early.chain(late).fold(0.0, |worst, difference| difference.abs().max(worst))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::continuity::Continuity;
    use oedometer_soil::law::Law;

    #[test]
    fn front_is_handed_over_smoothly() {
        let column = ColumnParameters { load: 2e5, height: 2.0, ..ColumnParameters::default() };
        for continuity in Continuity::ALL {
            let steep =
                LargeStrainModel { law: Law::PorosityDependent, continuity, water: Water::Compressible };
            let general = LargeStrain::new(&column, steep, &[0.05]).unwrap();
            let end = general.front.as_ref().expect("a load at once has a front").valid_until();
            for zeta in [0.001, 0.02, 0.1, 0.4, 1.0] {
                let before = general.fields(end, zeta).unwrap();
                let after = general.fields(end * (1.0 + 1e-14), zeta).unwrap();
                assert!((before.pressure - after.pressure).abs() < 1e-9 * column.load);
                assert!((before.displacement - after.displacement).abs() < 1e-10);
            }
        }
    }
}
