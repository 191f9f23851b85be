//! Mistakes in what a solver was given, or in which of its fields was written: another stress in the place of the
//! pressure, another load, stiffness, permeability or clock, a plate that is none.
//!
//! A factor or an offset of the time is fitted, of all else nothing; so much less error must be left.

use super::{IMPROVED, INACCURATE, MENDED, Mistake, Trials, exact_of, is_slow, times_seen};
use crate::case::quantity::Quantity;
use crate::import::table::SampledState;
use crate::judge::score::completeness::short;
use crate::measure::fields::exact_fields::ExactFields;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_soil::elementary::{exp, ln};

/// Relative errors below this are no mistake's.
pub const NOTICED: f64 = 0.01;
/// Words by which a sentence on the load is known.
pub const OF_LOAD: &str = "is the load";
/// Factors of a load that people confuse: both faces of a slab, half of a symmetric one.
const LOADS: [f64; 2] = [2.0, 0.5];
/// Viscosity of water at 20 °C, Pa s.
const VISCOSITY: f64 = 1.0e-3;
/// Share of its former error that a result may have at fitted times.
const FITTED: f64 = 0.05;
/// Factors of the time that are fitted.
const FACTORS: [f64; 2] = [0.2, 5.0];
/// Factors of the time closer than this to 1 are an inaccurate solver's.
const NEAR_ONE: f64 = 0.03;
/// How near a fitted factor must be to one that has a name.
const NEAR_NAME: f64 = 0.01;
/// What a fitted number counts for: where one with a name does as well, that is it.
const FITTED_COUNT: usize = 2;
/// Fewest states that tell a factor from an offset, and both from an inaccurate solver.
const FEWEST: usize = 3;
/// Steps of the search before the golden section, and of that.
const SEARCH: [u32; 2] = [24, 24];
/// Samples of a state that a fit looks at.
const SAMPLES: usize = 100;
/// Ratio of what is left by which a factor and an offset are told apart.
const CLEARLY: f64 = 0.3;

impl Trials<'_> {
    /// The mistakes in a solver's input that would explain an error.
    pub(super) fn inputs(&self, error: f64) -> Vec<Mistake> {
        let mut mistakes = Vec::new();
        if error > INACCURATE {
            mistakes.extend(self.other_stress());
            mistakes.extend(self.other_load());
            mistakes.extend(self.other_conductivity());
            mistakes.extend(self.plate_that_bends());
            mistakes.retain(|mistake| mistake.left <= MENDED.min(IMPROVED * error));
        }
        let fitted = self.other_modulus().into_iter().chain(self.other_clock());
        mistakes.extend(fitted.filter(|mistake| mistake.left <= FITTED * error));
        mistakes
    }

    /// The effective or the total stress in the place of the pressure.
    fn other_stress(&self) -> Vec<Mistake> {
        if self.quantity != Quantity::Pressure {
            return Vec::new();
        }
        let stress = |part: &dyn Fn(f64, f64) -> f64| -> Vec<ExactFields> {
            let of = |fields: &ExactFields| ExactFields {
                pressure: fields
                    .effective_stress
                    .iter()
                    .zip(&fields.pressure)
                    .map(|(s, p)| part(*s, *p))
                    .collect(),
                ..ExactFields::default()
            };
            self.exact.iter().map(of).collect()
        };
        let mut mistakes = Vec::new();
        for (sign, of_sign) in [(1.0, ""), (-1.0, " with the other sign")] {
            for (name, exact) in [
                ("effective stress", stress(&|s, _| -sign * s)),
                ("total stress", stress(&|s, p| sign * (p - s))),
            ] {
                let or = if name == "total stress" { " Or does nothing drain?" } else { "" };
                mistakes.push(Mistake::of(
                    format!("matches the exact {name}{of_sign}: is it given in the place of the pore pressure?{or}"),
                    self.error(&exact, |value| value),
                ));
            }
        }
        mistakes
    }

    /// The exact field of another load.
    fn other_load(&self) -> Vec<Mistake> {
        let of = |factor: f64| {
            Mistake::of(
                format!(
                    "is {} × the exact one: {OF_LOAD} {} × that of the scene?",
                    short(factor),
                    short(factor)
                ),
                self.error(self.exact, |value| value / factor),
            )
        };
        LOADS.map(of).into()
    }

    /// The exact field of a permeability that is divided by the viscosity or by the unit weight of water once too often,
    /// or not at all.
    fn other_conductivity(&self) -> Vec<Mistake> {
        let weight = self.parameters.unit_weight_of_water();
        let named = [
            (1.0 / VISCOSITY, "is k/μ taken for the hydraulic conductivity k?"),
            (VISCOSITY, "is k divided by μ where it should not be?"),
            (weight, "is k taken for k/γ_w?"),
            (1.0 / weight, "is k/γ_w, or k/μ in place of it, taken for the hydraulic conductivity k?"),
        ];
        let of = |(factor, asked): (f64, &str)| {
            let exact = self.exact_at(self.states, |time| factor * time)?;
            Some(Mistake::of(
                format!("matches the exact one at {} × the time: {asked}", short(factor)),
                self.error(&exact, |value| value),
            ))
        };
        named.into_iter().filter_map(of).collect()
    }

    /// The exact field with Young's modulus in the place of the oedometric one: slower, and softer.
    fn other_modulus(&self) -> Vec<Mistake> {
        let ratio = self.parameters.youngs_modulus / self.parameters.oedometric_modulus();
        if (ratio - 1.0).abs() < NEAR_ONE {
            return Vec::new();
        }
        let softer = if self.quantity == Quantity::Displacement { ratio } else { 1.0 };
        let asked = "is E taken for E_oed?";
        let slower = self.exact_at(self.states, |time| ratio * time).map(|exact| {
            let begin = if softer == 1.0 {
                "matches the exact one".to_owned()
            } else {
                format!("is {} × the exact one", short(rounded(1.0 / ratio)))
            };
            Mistake::of(
                format!("{begin} at {} × the time: {asked}", short(rounded(ratio))),
                self.error(&exact, |value| softer * value),
            )
        });
        let alone = (self.quantity == Quantity::Displacement).then(|| {
            Mistake::of(
                format!("is {} × the exact one: {asked}", short(rounded(1.0 / ratio))),
                self.error(self.exact, |value| ratio * value),
            )
        });
        slower.into_iter().chain(alone).collect()
    }

    /// The exact field at other times: all times a factor, or all an offset.
    fn other_clock(&self) -> Option<Mistake> {
        let is_closed = matches!(
            self.solution.kind(),
            ReferenceKind::Terzaghi | ReferenceKind::TerzaghiIncompressible | ReferenceKind::Mandel
        );
        if !is_closed || self.states.len() < FEWEST {
            return None;
        }
        let thin: Vec<SampledState> = self.states.iter().map(|state| thinned(state)).collect();
        let thin: Vec<&SampledState> = thin.iter().collect();
        let few = Trials { states: &thin, ..*self };
        let left_of = |trials: &Trials<'_>, change: &dyn Fn(f64) -> f64| {
            let exact = trials.exact_at(trials.states, change);
            exact.map_or(f64::INFINITY, |exact| trials.error(&exact, |value| value))
        };
        let factor = exp(least(FACTORS.map(ln), &|power| left_of(&few, &|time| exp(power) * time)));
        let (first, last) = (*self.times.first()?, *self.times.last()?);
        let offset = least([-0.95 * first, last], &|offset| left_of(&few, &|time| time + offset));
        let by_factor = left_of(self, &|time| factor * time);
        let by_offset = left_of(self, &|time| time + offset);
        if by_factor <= CLEARLY * by_offset && (factor - 1.0).abs() >= NEAR_ONE {
            let ratio = self.parameters.youngs_modulus / self.parameters.oedometric_modulus();
            let asked = if (factor / ratio - 1.0).abs() < NEAR_NAME {
                "is E taken for E_oed?"
            } else {
                "are the times, k or the stiffness off by this factor?"
            };
            let said = short(rounded(factor));
            return Some(Mistake {
                sentence: format!("matches the exact one at {said} × the time: {asked}"),
                left: by_factor,
                count: FITTED_COUNT,
            });
        }
        (by_offset <= CLEARLY * by_factor).then(|| {
            let seconds = self.parameters.time(offset.abs());
            let late = if offset < 0.0 { "late" } else { "early" };
            Mistake {
                sentence: format!(
                    "matches the exact one {} s {}: do your times count from another moment, so that all are {} s too {late}?",
                    short(rounded(seconds)),
                    if offset < 0.0 { "before" } else { "after" },
                    short(rounded(seconds)),
                ),
                left: by_offset,
                count: FITTED_COUNT,
            }
        })
    }

    /// A slab whose water drains as if the load stayed where it is: only a plate that stays plane moves it to the middle.
    fn plate_that_bends(&self) -> Option<Mistake> {
        if self.solution.kind() != ReferenceKind::Mandel || self.quantity != Quantity::Pressure {
            return None;
        }
        let start = self.solution.fields(EARLY, 1.0).ok()?.pressure;
        let column =
            Reference::new(ReferenceKind::TerzaghiIncompressible, self.parameters, self.times).ok()?;
        let exact = exact_of(&column, self.parameters, self.times, self.states).ok()?;
        let share = start / self.parameters.load;
        Some(Mistake::of(
            "matches a slab whose load does not move to its middle: is the top held plane by a rigid plate?"
                .to_owned(),
            self.error(&exact, |value| value / share),
        ))
    }

    /// The exact fields of states at other times, where something can be seen then.
    fn exact_at(&self, states: &[&SampledState], change: impl Fn(f64) -> f64) -> Option<Vec<ExactFields>> {
        let times = is_slow(self.solution).then(|| times_seen(self.times, change)).flatten()?;
        let solution = Reference::new(self.solution.kind(), self.parameters, &times).ok()?;
        exact_of(&solution, self.parameters, &times, states).ok()
    }
}

/// A time factor before anything drains.
const EARLY: f64 = 1e-6;

/// Every so many-th sample of a state.
fn thinned(state: &SampledState) -> SampledState {
    let step = state.initial_height.len().div_ceil(SAMPLES).max(1);
    let of = |list: &[f64]| list.iter().copied().step_by(step).collect();
    SampledState {
        initial_distance: of(&state.initial_distance),
        initial_height: of(&state.initial_height),
        volume: of(&state.volume),
        pressure: of(&state.pressure),
        effective_stress: of(&state.effective_stress),
        displacement: of(&state.displacement),
        time: state.time,
        ..SampledState::default()
    }
}

/// Where a function is least between two ends: the best of some steps, and a golden section around it.
fn least([from, to]: [f64; 2], value: &dyn Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let [steps, sections] = SEARCH;
    let width = (to - from) / f64::from(steps);
    let at = |step: u32| from + width * f64::from(step);
    let best = (0..=steps).map(|step| (value(at(step)), step)).min_by(|a, b| a.0.total_cmp(&b.0));
    let best = best.map_or(from, |(_, step)| at(step));
    let (mut low, mut high) = ((best - width).max(from), (best + width).min(to));
    for _ in 0..sections {
        let (left, right) = (high - SECTION * (high - low), low + SECTION * (high - low));
        if value(left) <= value(right) { high = right } else { low = left }
    }
    f64::midpoint(low, high)
}

/// Three digits of a number.
fn rounded(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}
