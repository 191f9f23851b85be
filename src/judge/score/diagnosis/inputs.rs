//! Likely mistakes in the input of a solver or in the written field: a stress in place of the pressure, a wrong load,
//! stiffness, permeability or time, a missing plate.
//!
//! Only a factor or an offset of the time is fitted, and then less error must be left.

use super::{CORRECTED, IMPROVED, INACCURATE, Mistake, Trials, samples_at};
use crate::case::Quantity;
use crate::import::SampledState;
use crate::measure::fields::ExactFields;
use oedometer_exact::{Reference, ReferenceKind};
use oedometer_soil::elementary::{exp, ln};
use oedometer_soil::wording::short;

/// Relative errors below this are not taken for a mistake.
pub const NOTICED: f64 = 2e-3;
/// Words that mark a sentence on the load.
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
const NEAR_ONE: f64 = 5e-3;
/// How near a fitted factor must be to one that has a name.
const NEAR_NAME: f64 = 0.01;
/// Count of a mistake with a fitted number: a number with a name that does as well is preferred.
const FITTED_COUNT: usize = 2;
/// Fewest states that tell a factor from an offset, and both from an inaccurate solver.
const FEWEST: usize = 3;
/// Steps of the search before the golden section, and of that.
const SEARCH: [u32; 2] = [24, 24];
/// Samples of a state that a fit uses.
const SAMPLES: usize = 100;
/// Ratio of the remaining errors by which a factor and an offset are told apart.
const CLEARLY: f64 = 0.3;
/// A time factor before anything drains.
const EARLY: f64 = 1e-6;
/// The question about the modulus.
const MODULUS: &str = "is E taken for E_oed?";

impl Trials<'_> {
    /// The mistakes in a solver's input that would explain an error.
    pub(super) fn inputs(&self, error: f64) -> Vec<Mistake> {
        let mut mistakes = Vec::new();
        if error > INACCURATE {
            mistakes.extend(self.other_stress());
            mistakes.extend(LOADS.map(|factor| {
                let said = short(factor);
                let sentence = format!("is {said} × the exact one: {OF_LOAD} {said} × that of the scene?");
                self.mistake(self.exact, 1.0 / factor, sentence)
            }));
            mistakes.extend(self.other_conductivity());
            mistakes.extend(self.plate_that_bends());
            mistakes.retain(|mistake| mistake.left <= CORRECTED.min(IMPROVED * error));
        }
        let fitted = self.other_modulus().into_iter().chain(self.other_clock());
        mistakes.extend(fitted.filter(|mistake| mistake.left <= FITTED * error));
        mistakes
    }

    /// The effective or the total stress in place of the pressure.
    fn other_stress(&self) -> Vec<Mistake> {
        if self.quantity != Quantity::Pressure {
            return Vec::new();
        }
        let effective = self.exact_with(|fields| fields.effective_stress.iter().map(|s| -s).collect());
        let total = self.exact_with(|fields| {
            fields.pressure.iter().zip(&fields.effective_stress).map(|(p, s)| p - s).collect()
        });
        let tried = [("effective", &effective, ""), ("total", &total, " Or does nothing drain?")];
        let signs = [(1.0, ""), (-1.0, " with the other sign")];
        let of = |((name, exact, or), (sign, of_sign)): ((&str, &Vec<ExactFields>, &str), (f64, &str))| {
            let sentence = format!(
                "matches the exact {name} stress{of_sign}: is it given in place of the pore pressure?{or}"
            );
            self.mistake(exact, sign, sentence)
        };
        signs.into_iter().flat_map(|sign| tried.map(|one| of((one, sign)))).collect()
    }

    /// The exact field of a permeability that is divided by the viscosity or by the unit weight of water once too often,
    /// or not at all.
    fn other_conductivity(&self) -> Vec<Mistake> {
        let weight = self.given.parameters.soil.unit_weight_of_water();
        let named = [
            (1.0 / VISCOSITY, "is k/μ taken for the hydraulic conductivity k?"),
            (VISCOSITY, "is k divided by μ where it should not be?"),
            (weight, "is k taken for k/γ_w?"),
            (1.0 / weight, "is k/γ_w, or k/μ in place of it, taken for the hydraulic conductivity k?"),
        ];
        let of = |(factor, asked): (f64, &str)| {
            let sentence = format!("matches the exact one at {} × the time: {asked}", short(factor));
            Some(self.mistake(&self.exact_at(|time| factor * time)?, 1.0, sentence))
        };
        named.into_iter().filter_map(of).collect()
    }

    /// Young's modulus over the oedometric one.
    fn modulus_ratio(&self) -> f64 {
        self.given.parameters.soil.youngs_modulus / self.given.parameters.soil.oedometric_modulus()
    }

    /// The exact field with Young's modulus in place of the oedometric one: slower, and softer.
    fn other_modulus(&self) -> Vec<Mistake> {
        let ratio = self.modulus_ratio();
        if (ratio - 1.0).abs() < NEAR_ONE {
            return Vec::new();
        }
        let larger = format!("is {} × the exact one", short(rounded(1.0 / ratio)));
        let moves = self.quantity == Quantity::Displacement;
        let (softer, begin) = if moves { (ratio, &*larger) } else { (1.0, "matches the exact one") };
        let slower = self.exact_at(|time| ratio * time).map(|exact| {
            let sentence = format!("{begin} at {} × the time: {MODULUS}", short(rounded(ratio)));
            self.mistake(&exact, softer, sentence)
        });
        let alone = moves.then(|| self.mistake(self.exact, ratio, format!("{larger}: {MODULUS}")));
        slower.into_iter().chain(alone).collect()
    }

    /// The exact field at other times: all multiplied by a factor, or all shifted.
    fn other_clock(&self) -> Option<Mistake> {
        use ReferenceKind::{Mandel, Terzaghi, TerzaghiIncompressible};
        let is_closed = matches!(self.given.solution.kind(), Terzaghi | TerzaghiIncompressible | Mandel);
        if !is_closed || self.states.len() < FEWEST {
            return None;
        }
        let thinned = |state: &&SampledState| {
            let count = state.initial_height.len();
            let places: Vec<usize> = (0..count).step_by(count.div_ceil(SAMPLES).max(1)).collect();
            samples_at(state, &places)
        };
        let thin: Vec<SampledState> = self.states.iter().map(thinned).collect();
        let thin: Vec<&SampledState> = thin.iter().collect();
        let few = Trials { states: &thin, ..*self };
        let left_of = |trials: &Trials<'_>, change: &dyn Fn(f64) -> f64| {
            trials.exact_at(change).map_or(f64::INFINITY, |exact| trials.error(&exact, 1.0))
        };
        let factor = exp(least(FACTORS.map(ln), &|power| left_of(&few, &|time| exp(power) * time)));
        let (first, last) = (*self.given.times.first()?, *self.given.times.last()?);
        let offset = least([-0.95 * first, last], &|offset| left_of(&few, &|time| time + offset));
        let by_factor = left_of(self, &|time| factor * time);
        let by_offset = left_of(self, &|time| time + offset);
        let (sentence, left) = if by_factor <= CLEARLY * by_offset && (factor - 1.0).abs() >= NEAR_ONE {
            let asked = if (factor / self.modulus_ratio() - 1.0).abs() < NEAR_NAME {
                MODULUS.to_owned()
            } else {
                self.off_by(factor)
            };
            (format!("matches the exact one at {} × the time: {asked}", short(rounded(factor))), by_factor)
        } else if by_offset <= CLEARLY * by_factor {
            let seconds = short(rounded(self.given.parameters.time(offset.abs())));
            let (side, late) = if offset < 0.0 { ("before", "late") } else { ("after", "early") };
            let sentence = format!(
                "matches the exact one {seconds} s {side}: do your times count from another moment, so that all are \
                 {seconds} s too {late}?"
            );
            (sentence, by_offset)
        } else {
            return None;
        };
        Some(Mistake { sentence, left, count: FITTED_COUNT })
    }

    /// The inputs of which each alone would make the time run faster by a factor, with the numbers that they would be.
    fn off_by(&self, factor: f64) -> String {
        let given = self.given.parameters;
        let [k, modulus, height] = [
            given.soil.hydraulic_conductivity * factor,
            given.soil.oedometric_modulus() * factor,
            given.height / factor.sqrt(),
        ]
        .map(|number| short(rounded(number)));
        format!(
            "is k {k} m/s for {}, or E_oed {modulus} Pa for {}, or H {height} m for {} (H² counts), or are the times off?",
            short(given.soil.hydraulic_conductivity),
            short(given.soil.oedometric_modulus()),
            short(given.height)
        )
    }

    /// A slab whose water drains as if the load stayed where it is: only a plate that stays plane moves it to the middle.
    fn plate_that_bends(&self) -> Option<Mistake> {
        let given = self.given;
        if given.solution.kind() != ReferenceKind::Mandel || self.quantity != Quantity::Pressure {
            return None;
        }
        let start = given.solution.fields(EARLY, 1.0).ok()?.pressure;
        let column =
            Reference::new(ReferenceKind::TerzaghiIncompressible, given.parameters, &given.times).ok()?;
        let exact = given.exact_of(&column, &given.times, self.states).ok()?;
        let sentence =
            "matches a slab whose load does not move to its middle: is the top held plane by a rigid plate?";
        Some(self.mistake(&exact, given.parameters.load / start, sentence))
    }

    /// The exact fields at other times, where these show something.
    fn exact_at(&self, change: impl Fn(f64) -> f64) -> Option<Vec<ExactFields>> {
        let (times, solution) = self.given.at_times(change)?;
        self.given.exact_of(&solution, &times, self.states).ok()
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

/// A number rounded to three digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}
