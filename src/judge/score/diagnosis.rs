//! Likely mistakes behind the numbers of an external result.
//!
//! Each possible mistake is corrected as a trial, with nothing fitted but a gradient; it is named only where
//! the corrected numbers agree with the exact ones and the given ones do not. A solver that is merely
//! inaccurate agrees with none of them.

mod inputs;

use crate::case::Quantity;
use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::import::mapping::units::{LengthUnit, StressUnit, TimeUnit};
use crate::judge::score::coverage::SAME_PLACE;
use crate::measure::fields::ExactFields;
use oedometer_exact::{ColumnParameters, ExactError, Reference, ReferenceKind};
use oedometer_soil::elementary::powi;
use oedometer_soil::wording::short;
use std::borrow::Cow;

/// Relative errors below this are an inaccurate solver's, and no mistake in a file.
const INACCURATE: f64 = 0.1;
/// Relative error that a corrected result may have.
const CORRECTED: f64 = 0.1;
/// Share of its former error that a corrected result may have.
const IMPROVED: f64 = 0.1;
/// [`IMPROVED`] where a number was fitted.
const IMPROVED_BY_FIT: f64 = 0.01;
/// Share of the unit weight of water by which a gradient may miss it.
const UNIT_WEIGHT: f64 = 0.05;
/// Exact values below this share of the load's are round-off and show nothing.
const VANISHED: f64 = 1e-6;
/// Exact values above this share of the load's are not zero.
const NOTABLE: f64 = 1e-3;
/// Number of states that are examined, spread over all of them.
const STATES: usize = 12;
/// Samples of a state that are examined where there are more than twice as many.
const SAMPLES: u32 = 5000;
/// Share of a part by which the place of a sample in it advances from one part to the next, of 2³².
const GOLDEN_RATIO: u32 = 0x9e37_79b9;
/// Time factors in which a wrong unit of time is searched; before and after nothing changes.
const TIME_FACTORS: std::ops::RangeInclusive<f64> = 1e-7..=20.0;
/// Most mistakes of units, signs and ends that are searched together.
const MOST_TOGETHER: usize = 3;
/// Factor by which an explanation with one mistake more must be better.
const PENALTY: f64 = 1.2;
/// Difference over the final settlement from which on the top of a column is not plane.
const UNEVEN_TOP: f64 = 0.02;
/// Errors up to this are equal.
const ROUND_OFF: f64 = 1e-9;

/// A possible mistake, and the error that is left when it is corrected.
struct Mistake {
    sentence: String,
    left: f64,
    /// Number of single mistakes in it.
    count: usize,
}

impl Mistake {
    /// The error that is left, with a penalty for every further mistake: of two explanations the simpler one.
    fn cost(&self) -> f64 {
        let more = self.count.saturating_sub(1);
        (self.left + ROUND_OFF) * powi(PENALTY, i32::try_from(more).unwrap_or(i32::MAX))
    }
}

/// The exact fields with places or times read differently.
struct Variant {
    /// How the sentence goes on.
    said: String,
    /// The questions to ask.
    asked: Vec<String>,
    exact: Vec<ExactFields>,
}

/// A result with its exact solution.
struct Given<'a> {
    parameters: &'a ColumnParameters,
    solution: Reference,
    states: Vec<&'a SampledState>,
    /// Time factors of the states.
    times: Vec<f64>,
    mapping: &'a Mapping,
    /// Whether these are only some of the samples.
    are_picked: bool,
}

impl Given<'_> {
    /// The exact fields of a solution at times and at the samples of states.
    fn exact_of(
        &self,
        solution: &Reference,
        times: &[f64],
        states: &[&SampledState],
    ) -> Result<Vec<ExactFields>, ExactError> {
        let of = |(time, state): (&f64, &&SampledState)| {
            ExactFields::of(solution, *time, state.places(self.parameters.height))
        };
        times.iter().zip(states).map(of).collect()
    }

    /// A sentence about the top of a column that does not stay plane: samples of its highest row that settle differently.
    fn uneven_top(&self, settlement: f64) -> Option<String> {
        if self.solution.is_plane() {
            return None;
        }
        let last =
            self.states.last().filter(|state| state.displacement.len() == state.initial_height.len())?;
        let highest = last.initial_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_top = |y: f64| highest - y <= SAME_PLACE * self.parameters.height;
        let top = last.initial_height.iter().zip(&last.displacement).filter(|(y, _)| is_top(**y));
        let moved = top.map(|(_, moved)| *moved);
        let [least, most] = moved.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], moved| {
            [least.min(moved), most.max(moved)]
        });
        (most - least > UNEVEN_TOP * settlement.abs()).then(|| {
            format!(
                "your top is not plane: at y = {} m u_y lies between {} and {} m: are the sides on rollers, and does the \
                 load press evenly?",
                short(highest),
                short(least),
                short(most)
            )
        })
    }

    /// Whether nothing but diffusion happens in the solution.
    fn is_slow(&self) -> bool {
        use ReferenceKind::{DynamicColumn, DynamicSingleMode, StandingWave};
        !matches!(self.solution.kind(), DynamicColumn | DynamicSingleMode | StandingWave)
    }

    /// Changed times with the solution prepared for them, where it is slow and the times show something.
    fn at_times(&self, change: impl Fn(f64) -> f64) -> Option<(Vec<f64>, Reference)> {
        let times: Vec<f64> = self.times.iter().map(|time| change(*time)).collect();
        let is_seen = times.iter().any(|time| TIME_FACTORS.contains(time));
        let is_within = |time: &f64| (0.0..=*TIME_FACTORS.end()).contains(time);
        if !(self.is_slow() && is_seen && times.iter().all(is_within)) {
            return None;
        }
        let solution = Reference::new(self.solution.kind(), self.parameters, &times).ok()?;
        Some((times, solution))
    }

    /// The exact fields as they are and upside down, each at the given times and at times in other units.
    fn variants(&self) -> Vec<Variant> {
        let height = self.parameters.height;
        let turned: Vec<SampledState> = (self.states.iter())
            .map(|state| SampledState {
                initial_height: state.initial_height.iter().map(|y| (height - y).max(0.0)).collect(),
                initial_distance: state.initial_distance.clone(),
                ..SampledState::default()
            })
            .collect();
        let turned: Vec<&SampledState> = turned.iter().collect();
        let per_time_factor = self.parameters.time(1.0);
        let given = self.mapping.units.time;
        let in_unit = |unit: TimeUnit| {
            let ratio = unit.seconds(1.0, per_time_factor) / given.seconds(1.0, per_time_factor);
            let said = format!(" at {} × the time", short_factor(ratio));
            let asked = format!("are times in {} where {} is declared?", unit.name(), given.name());
            Some((said, Some(asked), self.at_times(|time| time * ratio)?))
        };
        let as_given = self.at_own_times().map(|own| (String::new(), None, own));
        let others = TimeUnit::ALL.into_iter().filter(|unit| *unit != given);
        let mut variants = Vec::new();
        for (said, asked, (times, solution)) in as_given.into_iter().chain(others.filter_map(in_unit)) {
            for (states, end, question) in [
                (&self.states, "", None),
                (&turned, " upside down", Some("is `y` counted from the other end?")),
            ] {
                let Ok(exact) = self.exact_of(&solution, &times, states) else { continue };
                let asked = asked.clone().into_iter().chain(question.map(str::to_owned)).collect();
                variants.push(Variant { said: format!("{end}{said}"), asked, exact });
            }
        }
        variants
    }

    fn at_own_times(&self) -> Option<(Vec<f64>, Reference)> {
        let solution = Reference::new(self.solution.kind(), self.parameters, &self.times).ok()?;
        Some((self.times.clone(), solution))
    }
}

/// Sentences on what seems to be wrong with the numbers of a result, compared with a reference.
///
/// # Errors
/// When the reference refuses the result's own times.
pub fn diagnosis(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
    mapping: &Mapping,
) -> Result<Vec<String>, ExactError> {
    let picked: Vec<Cow<'_, SampledState>> = spread(states).into_iter().map(picked).collect();
    let states: Vec<&SampledState> = picked.iter().map(Cow::as_ref).collect();
    let times: Vec<f64> = states.iter().map(|state| parameters.time_factor(state.time)).collect();
    let solution = Reference::new(reference, parameters, &times)?;
    let are_picked = picked.iter().any(|state| matches!(state, Cow::Owned(_)));
    let given = Given { parameters, solution, states, times, mapping, are_picked };
    let exact = given.exact_of(&given.solution, &given.times, &given.states)?;
    let mut sentences: Vec<(String, Vec<&str>)> = Vec::new();
    let mut variants: Option<Vec<Variant>> = None;
    let mut judged = 0;
    for (quantity, column, scale) in [
        (Quantity::Pressure, "p", parameters.load),
        (Quantity::EffectiveStress, "effective_stress", parameters.load),
        (Quantity::Displacement, "u_y", parameters.final_settlement()),
    ] {
        let trials = Trials { given: &given, quantity, scale, states: &given.states, exact: &exact };
        let error = trials.error(&exact, 1.0);
        let is_given = given.states.iter().any(|state| !trials.computed(state).is_empty());
        if !is_given || trials.size() < VANISHED * scale {
            continue;
        }
        judged += 1;
        if given.states.iter().all(|state| trials.computed(state).iter().all(|value| *value == 0.0)) {
            sentences.push((
                "is 0 everywhere: is it another array than the one that is meant?".to_owned(),
                vec![column],
            ));
            continue;
        }
        let mut mistakes = Vec::new();
        if error > INACCURATE {
            mistakes.extend(trials.all(error, variants.get_or_insert_with(|| given.variants())));
        }
        if error > inputs::NOTICED {
            mistakes.extend(trials.inputs(error));
        }
        let Some(mistake) = mistakes.into_iter().min_by(|a, b| a.cost().total_cmp(&b.cost())) else {
            continue;
        };
        match sentences.iter_mut().find(|(sentence, _)| *sentence == mistake.sentence) {
            Some((_, columns)) => columns.push(column),
            None => sentences.push((mistake.sentence, vec![column])),
        }
    }
    // A wrong load shows in everything that a result has; a factor on one quantity alone is something else.
    sentences.retain(|(sentence, columns)| !sentence.contains(inputs::OF_LOAD) || columns.len() == judged);
    let uneven = given.uneven_top(parameters.final_settlement());
    let told = |(sentence, columns): (String, Vec<&str>)| match columns.split_last() {
        Some((last, others)) if !others.is_empty() => {
            format!("each of your {} and {last} {sentence}", others.join(", "))
        }
        _ => format!("your {} {sentence}", columns.concat()),
    };
    Ok(sentences.into_iter().map(told).chain(uneven).collect())
}

/// Some of the states, from the first to the last.
fn spread(states: &[SampledState]) -> Vec<&SampledState> {
    let count = states.len().min(STATES);
    let last = states.len().saturating_sub(1);
    (0..count).filter_map(|one| states.get(one * last / count.saturating_sub(1).max(1))).collect()
}

/// Some of the samples of a state, spread over all of them without a period: a mistake is in all samples, and every
/// trial evaluates the exact fields again.
fn picked(state: &SampledState) -> Cow<'_, SampledState> {
    let all = state.initial_height.len();
    if all <= 2 * SAMPLES as usize {
        return Cow::Borrowed(state);
    }
    // One of each of as many equal parts, at a place in it that advances by the golden ratio.
    let place = |part: u32| {
        let within = part.wrapping_mul(GOLDEN_RATIO);
        let places = u128::from(u64::from(part) << 32 | u64::from(within)) * all as u128;
        usize::try_from(places / (u128::from(SAMPLES) << 32)).ok()
    };
    Cow::Owned(samples_at(state, &(0..SAMPLES).filter_map(place).collect::<Vec<_>>()))
}

/// The samples of a state at some of its places.
fn samples_at(state: &SampledState, places: &[usize]) -> SampledState {
    let of = |list: &[f64]| places.iter().filter_map(|place| list.get(*place).copied()).collect();
    SampledState {
        time: state.time,
        initial_distance: of(&state.initial_distance),
        initial_height: of(&state.initial_height),
        volume: of(&state.volume),
        pressure: of(&state.pressure),
        effective_stress: of(&state.effective_stress),
        displacement: of(&state.displacement),
        horizontal_displacement: of(&state.horizontal_displacement),
        surface_displacement: state.surface_displacement,
        ..SampledState::default()
    }
}

/// A sample: computed and exact value, height in m, weight.
type Sample = [f64; 4];

/// All that is tried on one quantity.
struct Trials<'a> {
    given: &'a Given<'a>,
    quantity: Quantity,
    /// What a value of 1 stands for: the load, or the final settlement.
    scale: f64,
    states: &'a [&'a SampledState],
    exact: &'a [ExactFields],
}

impl Trials<'_> {
    fn computed<'a>(&self, state: &'a SampledState) -> &'a [f64] {
        match self.quantity {
            Quantity::Pressure => &state.pressure,
            Quantity::EffectiveStress => &state.effective_stress,
            _ => &state.displacement,
        }
    }

    fn samples<'a>(&'a self, exact: &'a [ExactFields]) -> impl Iterator<Item = Sample> + 'a {
        self.states.iter().zip(exact).flat_map(|(state, fields)| {
            let places = state.initial_height.iter().zip(&state.volume);
            (self.computed(state).iter().zip(fields.field(self.quantity)).zip(places))
                .map(|((computed, exact), (y, volume))| [*computed, *exact, *y, *volume])
        })
    }

    /// Relative error over all states, with every computed value multiplied by a factor.
    fn error(&self, exact: &[ExactFields], factor: f64) -> f64 {
        self.error_of(self.samples(exact), |value, _| factor * value)
    }

    /// Relative error over samples, with every computed value corrected by its height.
    fn error_of(&self, samples: impl Iterator<Item = Sample>, corrected: impl Fn(f64, f64) -> f64) -> f64 {
        let (mut difference, mut size) = (0.0, 0.0);
        for [computed, exact, height, volume] in samples {
            difference += volume * powi((corrected(computed, height) - exact) / self.scale, 2);
            size += volume * powi(exact / self.scale, 2);
        }
        (difference / size).sqrt()
    }

    /// Root of the mean square of the exact values.
    fn size(&self) -> f64 {
        let (mut sum, mut volumes) = (0.0, 0.0);
        for [_, exact, _, volume] in self.samples(self.exact) {
            sum += volume * powi(exact / self.scale, 2);
            volumes += volume;
        }
        (sum / volumes).sqrt() * self.scale
    }

    /// The mistake that makes exact fields into computed ones divided by a factor.
    fn mistake(&self, exact: &[ExactFields], factor: f64, sentence: impl Into<String>) -> Mistake {
        Mistake { sentence: sentence.into(), left: self.error(exact, factor), count: 1 }
    }

    /// The exact fields with another field in place of the quantity.
    fn exact_with(&self, field: impl Fn(&ExactFields) -> Vec<f64>) -> Vec<ExactFields> {
        let of = |fields: &ExactFields| match self.quantity {
            Quantity::Pressure => ExactFields { pressure: field(fields), ..ExactFields::default() },
            _ => ExactFields { effective_stress: field(fields), ..ExactFields::default() },
        };
        self.exact.iter().map(of).collect()
    }

    /// The mistakes that would explain the error.
    fn all(&self, error: f64, variants: &[Variant]) -> Vec<Mistake> {
        let convinces = |mistake: &Mistake, share: f64| mistake.left <= CORRECTED.min(share * error);
        let mut mistakes = self.conventions(variants);
        if self.quantity == Quantity::EffectiveStress {
            let total = self.exact_with(|fields| {
                fields.effective_stress.iter().zip(&fields.pressure).map(|(s, p)| s - p).collect()
            });
            let sentence = "matches the exact total stress: is the pore pressure left in?";
            mistakes.push(self.mistake(&total, 1.0, sentence));
        }
        mistakes.extend(self.zeros());
        mistakes.retain(|mistake| convinces(mistake, IMPROVED));
        mistakes.extend(self.gradient().filter(|mistake| convinces(mistake, IMPROVED_BY_FIT)));
        mistakes
    }

    /// The exact field in another unit, with another sign, upside down or at times in another unit: up to three of these
    /// together.
    fn conventions(&self, variants: &[Variant]) -> Vec<Mistake> {
        let declared = &self.given.mapping.units;
        let units: Vec<(&str, f64)> = if self.quantity == Quantity::Displacement {
            let given = declared.displacement.unwrap_or(declared.length);
            LengthUnit::ALL.map(|unit| (unit.name(), unit.metres() / given.metres())).to_vec()
        } else {
            let given = declared.stress.unwrap_or(StressUnit::Pascal);
            StressUnit::ALL.map(|unit| (unit.name(), unit.pascals() / given.pascals())).to_vec()
        };
        let given = units.iter().find(|(_, factor)| *factor == 1.0).map_or("", |(name, _)| name);
        let signed = units.iter().flat_map(|(name, factor)| [(name, factor, 1.0), (name, factor, -1.0)]);
        let mut mistakes = Vec::new();
        for variant in variants {
            for (name, factor, sign) in signed.clone() {
                let unit = (*factor != 1.0).then(|| format!("is it in {name} where {given} is declared?"));
                let turned = (sign < 0.0).then(|| "is the sign declared wrongly?".to_owned());
                let asked: Vec<String> =
                    [unit, turned].into_iter().flatten().chain(variant.asked.clone()).collect();
                if !(1..=MOST_TOGETHER).contains(&asked.len()) {
                    continue;
                }
                let begin = match sign / factor {
                    1.0 => "matches the exact one".to_owned(),
                    ratio => format!("is {} × the exact one", short_factor(ratio)),
                };
                // In a layer under a cosine load the other end looks like the other sign.
                let is_sign_alone = asked.len() == 1 && sign < 0.0 && self.given.solution.is_plane();
                let end = if is_sign_alone { " Or does `x` count from the other end?" } else { "" };
                let sentence = format!("{begin}{}: {}{end}", variant.said, asked.join(" And "));
                let mistake = self.mistake(&variant.exact, sign * factor, sentence);
                mistakes.push(Mistake { count: asked.len(), ..mistake });
            }
        }
        mistakes
    }

    /// Places inside at which nothing was written: mid-side nodes of elements that have the pressure
    /// at their corners.
    fn zeros(&self) -> Option<Mistake> {
        let is_inside = |sample: &Sample| sample[1].abs() > NOTABLE * self.scale;
        let is_zero = |sample: &Sample| sample[0] == 0.0 && is_inside(sample);
        let inside = self.samples(self.exact).filter(is_inside).count();
        let zeros = self.samples(self.exact).filter(is_zero).count();
        if zeros < 2 || 4 * zeros > 3 * inside {
            return None;
        }
        let others = self.samples(self.exact).filter(|sample| !is_zero(sample));
        let sentence = format!(
            "is exactly 0 at {zeros} of {inside} samples{} where it should not be, and right at the others: are \
             they mid-side nodes without a value?",
            if self.given.are_picked { " looked at" } else { "" }
        );
        Some(Mistake { sentence, left: self.error_of(others, |value, _| value), count: 1 })
    }

    /// A constant gradient over the depth on top of the exact pressure: the weight of the water.
    fn gradient(&self) -> Option<Mistake> {
        if self.quantity != Quantity::Pressure {
            return None;
        }
        let height = self.given.parameters.height;
        let depth = |y: f64| (height - y) / height;
        let (mut sums, mut offsets) = ([0.0; 3], [0.0; 2]);
        for [computed, exact, y, volume] in self.samples(self.exact) {
            let (depth, difference) = (depth(y), computed - exact);
            sums = [sums[0] + volume, sums[1] + volume * depth, sums[2] + volume * depth * depth];
            offsets = [offsets[0] + volume * difference, offsets[1] + volume * difference * depth];
        }
        let determinant = sums[0] * sums[2] - sums[1] * sums[1];
        let slope = (sums[0] * offsets[1] - sums[1] * offsets[0]) / determinant;
        let constant = (offsets[0] - slope * sums[1]) / sums[0];
        let gradient = slope / height;
        let weight = self.given.parameters.soil.unit_weight_of_water();
        // A water level above or below the surface adds the constant.
        let corrected = |value: f64, y: f64| value - constant - slope * depth(y);
        let left = self.error_of(self.samples(self.exact), corrected);
        let sentence = format!(
            "differs from the exact one by a constant gradient of {} Pa/m: is the hydrostatic part left in?",
            short(gradient)
        );
        let is_water = (gradient.abs() / weight - 1.0).abs() <= UNIT_WEIGHT;
        is_water.then_some(Mistake { sentence, left, count: 1 })
    }
}

/// A factor in words: −1.00, 0.001, 60.
fn short_factor(factor: f64) -> String {
    let digits = if factor.abs() == 1.0 { format!("{factor:.2}") } else { short(factor) };
    digits.replace('-', "−")
}

#[cfg(test)]
mod tests;
