//! What seems to be wrong with an external result's numbers: mistakes that are seen in them.
//!
//! Each mistake is mended by way of trial, with nothing fitted but a gradient; it is named only where
//! the mended numbers agree with the exact ones and the given ones do not. A solver that is merely
//! inaccurate agrees with none of them.

mod inputs;

use crate::case::quantity::Quantity;
use crate::import::mapping::Mapping;
use crate::import::mapping::units::{LengthUnit, StressUnit, TimeUnit};
use crate::import::table::SampledState;
use crate::judge::score::completeness::short;
use crate::measure::fields::exact_fields::ExactFields;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_soil::elementary::powi;
use std::borrow::Cow;

/// Relative errors below this are an inaccurate solver's, and no mistake in a file.
const INACCURATE: f64 = 0.1;
/// Relative error that a mended result may have.
const MENDED: f64 = 0.1;
/// Share of its former error that a mended result may have.
const IMPROVED: f64 = 0.1;
/// The same where a number was fitted.
const IMPROVED_BY_FIT: f64 = 0.01;
/// Share of the unit weight of water by which a gradient may miss it.
const UNIT_WEIGHT: f64 = 0.05;
/// Exact values below this share of the load's are round-off: nothing is seen in them.
const VANISHED: f64 = 1e-6;
/// Exact values above this share of the load's are no zeros.
const NOTABLE: f64 = 1e-3;
/// States that are looked at, spread over all of them.
const STATES: usize = 12;
/// Samples of a state that are looked at where there are more than twice as many.
const SAMPLES: u32 = 5000;
/// Share of a part by which the place of a sample in it goes on from one to the next, of 2³².
const GOLDEN_RATIO: u32 = 0x9e37_79b9;
/// Time factors in which a wrong unit of time is looked for; before and after nothing changes.
const TIME_FACTORS: std::ops::RangeInclusive<f64> = 1e-7..=20.0;

/// Most mistakes of units, signs and ends that are looked for together.
const MOST_TOGETHER: usize = 3;
/// Factor by which an explanation of one thing more must be better.
const DEARER: f64 = 1.2;
/// Errors up to this are equal.
const ROUND_OFF: f64 = 1e-9;

/// A mistake, and the error that is left where it is mended.
struct Mistake {
    sentence: String,
    left: f64,
    /// Of how many things it consists.
    count: usize,
}

impl Mistake {
    fn of(sentence: String, left: f64) -> Self {
        Self { sentence, left, count: 1 }
    }

    /// The error that is left, dearer the more is taken to be wrong: of two explanations the simpler one.
    fn cost(&self) -> f64 {
        let more = self.count.saturating_sub(1);
        (self.left + ROUND_OFF) * powi(DEARER, i32::try_from(more).unwrap_or(i32::MAX))
    }
}

/// The exact fields with places or times taken otherwise.
struct Variant {
    /// How the sentence goes on.
    said: String,
    /// What is asked, a question each.
    asked: Vec<String>,
    exact: Vec<ExactFields>,
}

/// The exact fields as they are, upside down, and both at times in other units.
fn variants_of(
    solution: &Reference,
    parameters: &ColumnParameters,
    times: &[f64],
    states: &[&SampledState],
    mapping: &Mapping,
) -> Vec<Variant> {
    let height = parameters.height;
    let turned: Vec<SampledState> = (states.iter())
        .map(|state| SampledState {
            initial_height: state.initial_height.iter().map(|y| (height - y).max(0.0)).collect(),
            initial_distance: state.initial_distance.clone(),
            ..SampledState::default()
        })
        .collect();
    let turned: Vec<&SampledState> = turned.iter().collect();
    let per_time_factor = parameters.time(1.0);
    let given = mapping.units.time;
    let others = TimeUnit::ALL.into_iter().filter(|unit| is_slow(solution) && *unit != given);
    let units = others.filter_map(|unit| {
        let ratio = unit.seconds(1.0, per_time_factor) / given.seconds(1.0, per_time_factor);
        let said = format!(" at {} × the time", short_factor(ratio));
        let asked = format!("are times in {} where {} is declared?", unit.name(), given.name());
        Some((said, vec![asked], times_seen(times, |time| time * ratio)?))
    });
    let as_they_are = (String::new(), Vec::new(), times.to_vec());
    let mut variants = Vec::new();
    for (said, asked, times) in std::iter::once(as_they_are).chain(units) {
        let Ok(solution) = Reference::new(solution.kind(), parameters, &times) else { continue };
        if let Ok(exact) = exact_of(&solution, parameters, &times, states) {
            variants.push(Variant { said: said.clone(), asked: asked.clone(), exact });
        }
        if let Ok(exact) = exact_of(&solution, parameters, &times, &turned) {
            let turned = "is `y` counted from the other end?".to_owned();
            let asked = asked.into_iter().chain([turned]).collect();
            variants.push(Variant { said: format!(" upside down{said}"), asked, exact });
        }
    }
    variants
}

/// Whether nothing but diffusion goes on in a solution.
fn is_slow(solution: &Reference) -> bool {
    !matches!(
        solution.kind(),
        ReferenceKind::DynamicColumn | ReferenceKind::DynamicSingleMode | ReferenceKind::StandingWave
    )
}

/// Times taken otherwise, where something can be seen at them.
fn times_seen(times: &[f64], change: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
    let times: Vec<f64> = times.iter().map(|time| change(*time)).collect();
    let is_seen = times.iter().any(|time| TIME_FACTORS.contains(time));
    let is_within = |time: &f64| (0.0..=*TIME_FACTORS.end()).contains(time);
    (is_seen && times.iter().all(is_within)).then_some(times)
}

/// Sentences on what seems to be wrong with the numbers of a result, held against a reference.
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
    let seen: Vec<&SampledState> = picked.iter().map(Cow::as_ref).collect();
    let times: Vec<f64> = seen.iter().map(|state| parameters.time_factor(state.time)).collect();
    let solution = Reference::new(reference, parameters, &times)?;
    let exact = exact_of(&solution, parameters, &times, &seen)?;
    let mut sentences: Vec<(String, Vec<&str>)> = Vec::new();
    let mut variants: Option<Vec<Variant>> = None;
    let mut judged = 0;
    for (quantity, column, scale) in [
        (Quantity::Pressure, "p", parameters.load),
        (Quantity::EffectiveStress, "effective_stress", parameters.load),
        (Quantity::Displacement, "u_y", parameters.final_settlement()),
    ] {
        let trials = Trials {
            quantity,
            scale,
            states: &seen,
            exact: &exact,
            parameters,
            solution: &solution,
            times: &times,
            mapping,
            are_picked: picked.iter().any(|state| matches!(state, Cow::Owned(_))),
        };
        let error = trials.error(&exact, |value| value);
        let is_given = seen.iter().any(|state| !trials.computed(state).is_empty());
        if !is_given || trials.size(&exact) < VANISHED * scale {
            continue;
        }
        judged += 1;
        let is_wrong = error > INACCURATE;
        let mut mistakes = if is_wrong {
            let variants =
                variants.get_or_insert_with(|| variants_of(&solution, parameters, &times, &seen, mapping));
            trials.all(error, variants)
        } else {
            Vec::new()
        };
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
    // A load is in all that a result has; what one quantity alone is off by is something else.
    sentences.retain(|(sentence, columns)| !sentence.contains(inputs::OF_LOAD) || columns.len() == judged);
    Ok(sentences
        .into_iter()
        .map(|(sentence, columns)| format!("your {} {sentence}", columns.join(" and your ")))
        .collect())
}

/// Some of the states, from the first to the last.
fn spread(states: &[SampledState]) -> Vec<&SampledState> {
    let count = states.len().min(STATES);
    let last = states.len().saturating_sub(1);
    (0..count).filter_map(|one| states.get(one * last / count.saturating_sub(1).max(1))).collect()
}

/// Some of the samples of a state, spread over all of them without a rhythm: a mistake is in all, and every trial takes
/// the exact fields once more.
fn picked(state: &SampledState) -> Cow<'_, SampledState> {
    let all = state.initial_height.len();
    if all <= 2 * SAMPLES as usize {
        return Cow::Borrowed(state);
    }
    // One of each of as many equal parts, at a place in it that the golden ratio turns on.
    let place = |part: u32| {
        let within = part.wrapping_mul(GOLDEN_RATIO);
        let places = u128::from(u64::from(part) << 32 | u64::from(within)) * all as u128;
        usize::try_from(places / (u128::from(SAMPLES) << 32)).ok()
    };
    let places: Vec<usize> = (0..SAMPLES).filter_map(place).collect();
    let of = |list: &[f64]| places.iter().filter_map(|place| list.get(*place).copied()).collect();
    Cow::Owned(SampledState {
        initial_distance: of(&state.initial_distance),
        initial_height: of(&state.initial_height),
        volume: of(&state.volume),
        pressure: of(&state.pressure),
        effective_stress: of(&state.effective_stress),
        displacement: of(&state.displacement),
        horizontal_displacement: of(&state.horizontal_displacement),
        ..SampledState {
            time: state.time,
            surface_displacement: state.surface_displacement,
            ..SampledState::default()
        }
    })
}

fn exact_of(
    solution: &Reference,
    parameters: &ColumnParameters,
    times: &[f64],
    states: &[&SampledState],
) -> Result<Vec<ExactFields>, ExactError> {
    let of = |(time, state): (&f64, &&SampledState)| {
        ExactFields::of(solution, *time, state.places(parameters.height))
    };
    times.iter().zip(states).map(of).collect()
}

/// All that is tried on one quantity.
struct Trials<'a> {
    quantity: Quantity,
    /// What a value of 1 is worth: the load, or the final settlement.
    scale: f64,
    states: &'a [&'a SampledState],
    exact: &'a [ExactFields],
    parameters: &'a ColumnParameters,
    solution: &'a Reference,
    times: &'a [f64],
    mapping: &'a Mapping,
    /// Whether these are some of the samples only.
    are_picked: bool,
}

impl Trials<'_> {
    fn computed<'a>(&self, state: &'a SampledState) -> &'a [f64] {
        match self.quantity {
            Quantity::Pressure => &state.pressure,
            Quantity::EffectiveStress => &state.effective_stress,
            _ => &state.displacement,
        }
    }

    fn exact_field<'a>(&self, fields: &'a ExactFields) -> &'a [f64] {
        match self.quantity {
            Quantity::Pressure => &fields.pressure,
            Quantity::EffectiveStress => &fields.effective_stress,
            _ => &fields.displacement,
        }
    }

    /// Every sample: computed, exact, depth in m, weight.
    fn samples<'a>(&'a self, exact: &'a [ExactFields], height: f64) -> impl Iterator<Item = [f64; 4]> + 'a {
        self.states.iter().zip(exact).flat_map(move |(state, fields)| {
            let places = state.initial_height.iter().zip(&state.volume);
            (self.computed(state).iter().zip(self.exact_field(fields)).zip(places))
                .map(move |((computed, exact), (y, volume))| [*computed, *exact, height - y, *volume])
        })
    }

    /// Relative error over all states, with every computed value mended.
    fn error(&self, exact: &[ExactFields], mended: impl Fn(f64) -> f64) -> f64 {
        self.error_over(exact, 0.0, |value, _| mended(value))
    }

    /// The same where the depth below a height counts.
    fn error_over(&self, exact: &[ExactFields], height: f64, mended: impl Fn(f64, f64) -> f64) -> f64 {
        self.error_of(self.samples(exact, height), mended)
    }

    /// The same over some samples.
    fn error_of(&self, samples: impl Iterator<Item = [f64; 4]>, mended: impl Fn(f64, f64) -> f64) -> f64 {
        let (mut difference, mut size) = (0.0, 0.0);
        for [computed, exact, depth, volume] in samples {
            difference += volume * powi((mended(computed, depth) - exact) / self.scale, 2);
            size += volume * powi(exact / self.scale, 2);
        }
        (difference / size).sqrt()
    }

    /// Root of the mean square of the exact values.
    fn size(&self, exact: &[ExactFields]) -> f64 {
        let (mut sum, mut volumes) = (0.0, 0.0);
        for [_, exact, _, volume] in self.samples(exact, 0.0) {
            sum += volume * powi(exact / self.scale, 2);
            volumes += volume;
        }
        (sum / volumes).sqrt() * self.scale
    }

    /// The mistakes that would explain the error.
    fn all(&self, error: f64, variants: &[Variant]) -> Vec<Mistake> {
        let convinces = |mistake: &Mistake, share: f64| mistake.left <= MENDED.min(share * error);
        let mut mistakes = self.conventions(variants);
        mistakes.extend(self.total_stress());
        mistakes.extend(self.zeros());
        mistakes.retain(|mistake| convinces(mistake, IMPROVED));
        mistakes.extend(self.gradient().filter(|mistake| convinces(mistake, IMPROVED_BY_FIT)));
        mistakes
    }

    /// The exact field in another unit, with another sign, upside down or at times in another unit: up to three of these
    /// together.
    fn conventions(&self, variants: &[Variant]) -> Vec<Mistake> {
        let units: Vec<(&str, f64)> = if self.quantity == Quantity::Displacement {
            let given = self.mapping.units.displacement.unwrap_or(self.mapping.units.length);
            LengthUnit::ALL.map(|unit| (unit.name(), unit.metres() / given.metres())).to_vec()
        } else {
            let given = self.mapping.units.stress.unwrap_or(StressUnit::Pascal);
            StressUnit::ALL.map(|unit| (unit.name(), unit.pascals() / given.pascals())).to_vec()
        };
        let given = units.iter().find(|(_, factor)| *factor == 1.0).map_or("", |(name, _)| name);
        let mut mistakes = Vec::new();
        for variant in variants {
            for (name, factor) in &units {
                for sign in [1.0, -1.0] {
                    let unit =
                        (*factor != 1.0).then(|| format!("is it in {name} where {given} is declared?"));
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
                    // In a layer under a cosine the other end looks like the other sign.
                    let is_sign_alone = asked.len() == 1 && sign < 0.0;
                    let end = if is_sign_alone && self.solution.is_plane() {
                        " Or does `x` count from the other end?"
                    } else {
                        ""
                    };
                    mistakes.push(Mistake {
                        sentence: format!("{begin}{}: {}{end}", variant.said, asked.join(" And ")),
                        left: self.error(&variant.exact, |value| sign * factor * value),
                        count: asked.len(),
                    });
                }
            }
        }
        mistakes
    }

    /// The total stress where the effective one is declared.
    fn total_stress(&self) -> Option<Mistake> {
        if self.quantity != Quantity::EffectiveStress {
            return None;
        }
        let total = self.exact.iter().map(|fields| ExactFields {
            effective_stress: (fields.effective_stress.iter().zip(&fields.pressure))
                .map(|(s, p)| s - p)
                .collect(),
            ..ExactFields::default()
        });
        Some(Mistake::of(
            "matches the exact total stress: is the pore pressure left in?".to_owned(),
            self.error(&total.collect::<Vec<_>>(), |value| value),
        ))
    }

    /// Places inside at which nothing was written: mid-side nodes of elements that carry the pressure
    /// at their corners.
    fn zeros(&self) -> Option<Mistake> {
        let samples: Vec<[f64; 4]> = self.samples(self.exact, 0.0).collect();
        let is_inside = |exact: f64| exact.abs() > NOTABLE * self.scale;
        let inside = samples.iter().filter(|[_, exact, ..]| is_inside(*exact)).count();
        let is_zero = |sample: &&[f64; 4]| sample[0] == 0.0 && is_inside(sample[1]);
        let zeros = samples.iter().filter(is_zero).count();
        if zeros < 2 || 4 * zeros > 3 * inside {
            return None;
        }
        Some(Mistake {
            count: 1,
            sentence: format!(
                "is exactly 0 at {zeros} of {inside} samples{} where it should not be, and right at the others: are \
                 they mid-side nodes without a value?",
                if self.are_picked { " looked at" } else { "" }
            ),
            left: self.error_of(samples.iter().filter(|sample| !is_zero(sample)).copied(), |value, _| value),
        })
    }

    /// A constant gradient over the depth beside the exact pressure: the weight of the water.
    fn gradient(&self) -> Option<Mistake> {
        if self.quantity != Quantity::Pressure {
            return None;
        }
        let height = self.parameters.height;
        let (mut sums, mut offsets) = ([0.0; 3], [0.0; 2]);
        for [computed, exact, depth, volume] in self.samples(self.exact, height) {
            let (depth, difference) = (depth / height, computed - exact);
            sums = [sums[0] + volume, sums[1] + volume * depth, sums[2] + volume * depth * depth];
            offsets = [offsets[0] + volume * difference, offsets[1] + volume * difference * depth];
        }
        let determinant = sums[0] * sums[2] - sums[1] * sums[1];
        let slope = (sums[0] * offsets[1] - sums[1] * offsets[0]) / determinant;
        let constant = (offsets[0] - slope * sums[1]) / sums[0];
        let gradient = slope / height;
        let weight = self.parameters.unit_weight_of_water();
        let is_water = (gradient.abs() / weight - 1.0).abs() <= UNIT_WEIGHT;
        // By fit for the judgement, for a level of the water above or below the surface is a constant.
        let left = self.error_over(self.exact, height, |value, depth| value - constant - gradient * depth);
        is_water.then(|| Mistake {
            count: 1,
            sentence: format!(
                "differs from the exact one by a constant gradient of {} Pa/m: is the hydrostatic part left in?",
                short(gradient)
            ),
            left,
        })
    }
}

/// A factor as one says it: −1.00, 0.001, 60.
fn short_factor(factor: f64) -> String {
    let digits = if factor.abs() == 1.0 { format!("{factor:.2}") } else { short(factor) };
    digits.replace('-', "−")
}

#[cfg(test)]
mod tests;
