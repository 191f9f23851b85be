//! What seems to be wrong with somebody else's numbers: mistakes that are seen in them.
//!
//! Each mistake is mended by way of trial, with nothing fitted but a gradient; it is named only where
//! the mended numbers agree with the exact ones and the given ones do not. A solver that is merely
//! inaccurate agrees with none of them.

use super::completeness::short;
use super::fields::ExactFields;
use crate::exact::{ColumnParameters, ExactError, Reference, ReferenceKind};
use crate::import::{LengthUnit, Mapping, SampledState, StressUnit, TimeUnit};
use crate::record::Quantity;

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
/// States that are looked at, spread over all of them.
const STATES: usize = 12;
/// Time factors in which a wrong unit of time is looked for; before and after nothing changes.
const TIME_FACTORS: std::ops::RangeInclusive<f64> = 1e-7..=20.0;

/// A mistake, and the error that is left where it is mended.
struct Mistake {
    sentence: String,
    left: f64,
}

/// One quantity of the states looked at: computed, exact, weights.
struct Compared<'a> {
    quantity: Quantity,
    /// What a value of 1 is worth: the load, or the final settlement.
    scale: f64,
    states: &'a [&'a SampledState],
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
    let seen = spread(states);
    let times: Vec<f64> = seen.iter().map(|state| parameters.time_factor(state.time)).collect();
    let solution = Reference::new(reference, parameters, &times)?;
    let exact = exact_of(&solution, parameters, &times, &seen)?;
    let settled = parameters.final_settlement();
    let mut sentences: Vec<(String, Vec<&str>)> = Vec::new();
    for (quantity, column, scale) in [
        (Quantity::Pressure, "p", parameters.load),
        (Quantity::EffectiveStress, "effective_stress", parameters.load),
        (Quantity::Displacement, "u_y", settled),
    ] {
        let compared = Compared { quantity, scale, states: &seen };
        let error = compared.error(&exact, |value| value);
        let vanishes = compared.size(&exact) < VANISHED * scale;
        if vanishes || !(error > INACCURATE) {
            continue;
        }
        let trials =
            Trials { compared: &compared, exact: &exact, parameters, reference, times: &times, mapping };
        let mistakes = trials.all(error);
        let Some(mistake) = mistakes.into_iter().min_by(|a, b| a.left.total_cmp(&b.left)) else { continue };
        match sentences.iter_mut().find(|(sentence, _)| *sentence == mistake.sentence) {
            Some((_, columns)) => columns.push(column),
            None => sentences.push((mistake.sentence, vec![column])),
        }
    }
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

fn exact_of(
    solution: &Reference,
    parameters: &ColumnParameters,
    times: &[f64],
    states: &[&SampledState],
) -> Result<Vec<ExactFields>, ExactError> {
    let of = |(time, state): (&f64, &&SampledState)| ExactFields::of(solution, parameters, *time, state);
    times.iter().zip(states).map(of).collect()
}

impl Compared<'_> {
    fn computed<'a>(&self, state: &'a SampledState) -> &'a [f64] {
        match self.quantity {
            Quantity::Pressure => &state.pressure,
            Quantity::EffectiveStress => &state.effective_stress,
            _ => &state.displacement,
        }
    }

    fn exact<'a>(&self, fields: &'a ExactFields) -> &'a [f64] {
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
            (self.computed(state).iter().zip(self.exact(fields)).zip(places))
                .map(move |((computed, exact), (y, volume))| [*computed, *exact, height - y, *volume])
        })
    }

    /// Relative error over all states, with every computed value mended.
    fn error(&self, exact: &[ExactFields], mended: impl Fn(f64) -> f64) -> f64 {
        self.error_over(exact, 0.0, |value, _| mended(value))
    }

    /// The same where the depth below a height counts.
    fn error_over(&self, exact: &[ExactFields], height: f64, mended: impl Fn(f64, f64) -> f64) -> f64 {
        let (mut difference, mut size) = (0.0, 0.0);
        for [computed, exact, depth, volume] in self.samples(exact, height) {
            difference += volume * ((mended(computed, depth) - exact) / self.scale).powi(2);
            size += volume * (exact / self.scale).powi(2);
        }
        (difference / size).sqrt()
    }

    /// Root of the mean square of the exact values.
    fn size(&self, exact: &[ExactFields]) -> f64 {
        let (mut sum, mut volumes) = (0.0, 0.0);
        for [_, exact, _, volume] in self.samples(exact, 0.0) {
            sum += volume * (exact / self.scale).powi(2);
            volumes += volume;
        }
        (sum / volumes).sqrt() * self.scale
    }
}

/// All that is tried on one quantity.
struct Trials<'a> {
    compared: &'a Compared<'a>,
    exact: &'a [ExactFields],
    parameters: &'a ColumnParameters,
    reference: ReferenceKind,
    times: &'a [f64],
    mapping: &'a Mapping,
}

impl Trials<'_> {
    /// The mistakes that would explain the error.
    fn all(&self, error: f64) -> Vec<Mistake> {
        let convinces =
            |mistake: &Mistake, improved: f64| mistake.left <= MENDED && mistake.left <= improved * error;
        let mut mistakes = self.signs_and_units();
        mistakes.extend(self.total_stress());
        mistakes.extend(self.turned());
        mistakes.extend(self.units_of_time());
        mistakes.retain(|mistake| convinces(mistake, IMPROVED));
        mistakes.extend(self.gradient().filter(|mistake| convinces(mistake, IMPROVED_BY_FIT)));
        mistakes
    }

    /// The exact field times −1, or in another unit.
    fn signs_and_units(&self) -> Vec<Mistake> {
        let units: Vec<(&str, f64)> = match self.compared.quantity {
            Quantity::Displacement => {
                let given = self.mapping.units.displacement.unwrap_or(self.mapping.units.length);
                LengthUnit::ALL.map(|unit| (unit.name(), unit.metres() / given.metres())).to_vec()
            }
            _ => {
                let given = self.mapping.units.stress.unwrap_or(StressUnit::Pascal);
                StressUnit::ALL.map(|unit| (unit.name(), unit.pascals() / given.pascals())).to_vec()
            }
        };
        let given = units.iter().find(|(_, factor)| *factor == 1.0).map_or("", |(name, _)| name);
        let mut mistakes = Vec::new();
        for (name, factor) in &units {
            for sign in [1.0, -1.0] {
                if *factor == 1.0 && sign > 0.0 {
                    continue;
                }
                let unit = format!("is it in {name} where {given} is declared?");
                let asked = match (*factor == 1.0, sign > 0.0) {
                    (true, _) => format!("is the sign declared wrongly?{}", self.other_end()),
                    (false, true) => unit,
                    (false, false) => format!("{unit} And is the sign declared wrongly?"),
                };
                mistakes.push(Mistake {
                    sentence: format!("is {} × the exact one: {asked}", short_factor(sign / factor)),
                    left: self.compared.error(self.exact, |value| sign * factor * value),
                });
            }
        }
        mistakes
    }

    /// In a layer under a cosine the other end looks like the other sign.
    fn other_end(&self) -> &'static str {
        if self.is_plane() { " Or does `x` count from the other end?" } else { "" }
    }

    fn is_plane(&self) -> bool {
        matches!(self.reference, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible)
    }

    /// The total stress where the effective one is declared.
    fn total_stress(&self) -> Option<Mistake> {
        if self.compared.quantity != Quantity::EffectiveStress {
            return None;
        }
        let total = self.exact.iter().map(|fields| ExactFields {
            effective_stress: fields
                .effective_stress
                .iter()
                .zip(&fields.pressure)
                .map(|(s, p)| s - p)
                .collect(),
            ..ExactFields::default()
        });
        Some(Mistake {
            sentence: "matches the exact total stress: is the pore pressure left in?".to_owned(),
            left: self.compared.error(&total.collect::<Vec<_>>(), |value| value),
        })
    }

    /// The exact field with the height upside down.
    fn turned(&self) -> Option<Mistake> {
        let height = self.parameters.height;
        let turned: Vec<SampledState> = (self.compared.states.iter())
            .map(|state| SampledState {
                initial_height: state.initial_height.iter().map(|y| (height - y).max(0.0)).collect(),
                initial_distance: state.initial_distance.clone(),
                ..SampledState::default()
            })
            .collect();
        let solution = Reference::new(self.reference, self.parameters, self.times).ok()?;
        let exact =
            exact_of(&solution, self.parameters, self.times, &turned.iter().collect::<Vec<_>>()).ok()?;
        Some(Mistake {
            sentence: "matches the exact one upside down: is `y` counted from the other end?".to_owned(),
            left: self.compared.error(&exact, |value| value),
        })
    }

    /// The exact field at times in another unit.
    fn units_of_time(&self) -> Vec<Mistake> {
        let per_time_factor = self.parameters.time(1.0);
        let given = self.mapping.units.time;
        let is_slow = !matches!(
            self.reference,
            ReferenceKind::DynamicColumn | ReferenceKind::DynamicSingleMode | ReferenceKind::StandingWave
        );
        let others = TimeUnit::ALL.into_iter().filter(|unit| is_slow && *unit != given);
        others
            .filter_map(|unit| {
                let ratio = unit.seconds(1.0, per_time_factor) / given.seconds(1.0, per_time_factor);
                let times: Vec<f64> = self.times.iter().map(|time| time * ratio).collect();
                let is_seen = times.iter().any(|time| TIME_FACTORS.contains(time));
                if !is_seen || times.iter().any(|time| *time > *TIME_FACTORS.end()) {
                    return None;
                }
                let solution = Reference::new(self.reference, self.parameters, &times).ok()?;
                let exact = exact_of(&solution, self.parameters, &times, self.compared.states).ok()?;
                Some(Mistake {
                    sentence: format!(
                        "matches the exact one at {} × the time: are times in {} where {} is declared?",
                        short_factor(ratio),
                        unit.name(),
                        given.name()
                    ),
                    left: self.compared.error(&exact, |value| value),
                })
            })
            .collect()
    }

    /// A constant gradient over the depth beside the exact pressure: the weight of the water.
    fn gradient(&self) -> Option<Mistake> {
        if self.compared.quantity != Quantity::Pressure {
            return None;
        }
        let height = self.parameters.height;
        let (mut sums, mut offsets) = ([0.0; 3], [0.0; 2]);
        for [computed, exact, depth, volume] in self.compared.samples(self.exact, height) {
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
        let left =
            self.compared.error_over(self.exact, height, |value, depth| value - constant - gradient * depth);
        is_water.then(|| Mistake {
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
    if factor.abs() == 1.0 {
        format!("{factor:.2}").replace('-', "−")
    } else {
        short(factor).replace('-', "−")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::{CONVENTION, PLANE_CONVENTION};
    use crate::study::StudySource;

    fn mapping(text: &str) -> Mapping {
        Mapping::read(&StudySource { name: "map.toml".to_owned(), text: text.to_owned() }).expect("a mapping")
    }

    /// The exact column at its nodes, as if written at `written(T_v)` and off by a share.
    fn states(times: &[f64], written: impl Fn(f64) -> f64, off: f64) -> Vec<SampledState> {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, times).expect("the seed column");
        let one = |time: &f64| {
            let mut state = SampledState { time: column.time(written(*time)), ..SampledState::default() };
            for node in 0..=20 {
                let zeta = f64::from(node) / 20.0;
                let fields = reference.fields(*time, zeta).expect("inside");
                // An error that no mistake looks like: it waves.
                let wave = 1.0 + off * (7.0 * zeta + 3.0 * time).sin();
                state.initial_height.push(1.0 - zeta);
                state.volume.push(1.0);
                state.pressure.push(fields.pressure * wave);
                state.effective_stress.push(fields.effective_stress * wave);
                state.displacement.push(fields.displacement * wave);
            }
            state
        };
        times.iter().map(one).collect()
    }

    const TIMES: [f64; 4] = [0.05, 0.1, 0.5, 1.0];

    fn told_by(states: &[SampledState], text: &str) -> Vec<String> {
        diagnosis(&ColumnParameters::default(), ReferenceKind::Terzaghi, states, &mapping(text))
            .expect("a column")
    }

    fn told(states: &[SampledState]) -> Vec<String> {
        told_by(states, CONVENTION)
    }

    fn changed(off: f64, change: impl Fn(&mut SampledState)) -> Vec<SampledState> {
        let mut states = states(&TIMES, |time| time, off);
        states.iter_mut().for_each(change);
        states
    }

    fn scale(list: &mut [f64], factor: f64) {
        list.iter_mut().for_each(|value| *value *= factor);
    }

    #[test]
    fn every_mistake_is_named_in_good_and_in_mediocre_results() {
        for off in [0.0, 1e-3, 0.05] {
            let one = |states: Vec<SampledState>, words: &str| {
                let told = told(&states);
                assert!(told.len() == 1 && told[0].contains(words), "{off} {words}: {told:?}");
            };
            one(changed(off, |state| scale(&mut state.pressure, -1.0)), "your p is −1.00 × the exact one");
            one(
                changed(off, |state| scale(&mut state.pressure, 1e-3)),
                "your p is 0.001 × the exact one: is it in kPa where Pa is declared?",
            );
            one(
                changed(off, |state| scale(&mut state.displacement, -1e3)),
                "your u_y is −1000 × the exact one: is it in mm where m is declared? And is the sign",
            );
            one(
                changed(off, |state| {
                    let total = state.effective_stress.iter().zip(&state.pressure).map(|(s, p)| s - p);
                    state.effective_stress = total.collect();
                }),
                "your effective_stress matches the exact total stress",
            );
            for level in [0.0, 0.3] {
                one(
                    changed(off, |state| {
                        for (pressure, height) in state.pressure.iter_mut().zip(&state.initial_height) {
                            *pressure += 9810.0 * (1.0 + level - height);
                        }
                    }),
                    "constant gradient of 9810 Pa/m: is the hydrostatic part left in?",
                );
            }
        }
        for off in [0.0, 1e-3] {
            let upside_down = told(&changed(off, |state| {
                state.initial_height.iter_mut().for_each(|height| *height = 1.0 - *height);
            }));
            assert!(upside_down.iter().all(|told| told.contains("upside down")) && !upside_down.is_empty());
            let minutes = told(&states(&TIMES, |time| time / 60.0, off));
            assert_eq!(minutes.len(), 1, "{minutes:?}");
            assert!(
                minutes[0].starts_with("your p and your effective_stress and your u_y matches")
                    || minutes[0].contains("60 × the time: are times in min where s is declared?"),
                "{minutes:?}"
            );
        }
        let seconds =
            told_by(&states(&TIMES, |time| 60.0 * time, 0.0), &CONVENTION.replace("\"s\"", "\"min\""));
        assert!(
            seconds.iter().any(|told| told.contains("are times in s where min is declared?")),
            "{seconds:?}"
        );
    }

    #[test]
    fn an_inaccurate_solver_is_told_nothing() {
        for off in [0.0, 1e-3, 0.05, 0.2, 0.6, 2.0] {
            assert_eq!(told(&states(&TIMES, |time| time, off)), [""; 0], "waves of {off}");
        }
        // Too slow or too fast, as with a wrong permeability or too few steps.
        for factor in [0.5, 0.8, 0.95, 1.1, 1.5, 3.0] {
            assert_eq!(told(&states(&TIMES, |time| factor * time, 0.0)), [""; 0], "{factor} × the time");
        }
        // A locked or a soft one, and one that forgets the last digits.
        for factor in [0.3, 0.7, 1.4, 2.0] {
            let wrong = changed(0.02, |state| {
                scale(&mut state.displacement, factor);
                scale(&mut state.pressure, factor);
            });
            assert_eq!(told(&wrong), [""; 0], "{factor} × the fields");
        }
        let zero = changed(0.0, |state| {
            scale(&mut state.pressure, 0.0);
            scale(&mut state.displacement, 0.0);
        });
        assert_eq!(told(&zero), [""; 0], "nothing at all");
        // Long after, when nothing is left to be seen.
        assert_eq!(told(&states(&[30.0, 40.0], |time| time, 0.9)), [""; 0]);
    }

    #[test]
    fn in_a_layer_the_other_end_may_look_like_the_other_sign() {
        let layer = ColumnParameters::default();
        let solution = Reference::new(ReferenceKind::CosineLayer, &layer, &[]).expect("a layer");
        let exact = solution.plane_state(0.1).expect("a state").expect("in the plane");
        let mut state = SampledState { time: layer.time(0.1), ..SampledState::default() };
        for (x, y) in (0..=8).flat_map(|i| (0..=8).map(move |j| (f64::from(i) / 8.0, f64::from(j) / 8.0))) {
            let fields = exact.fields(1.0 - x, y).expect("inside");
            state.initial_distance.push(x);
            state.initial_height.push(y);
            state.volume.push(1.0);
            state.pressure.push(fields.pressure);
        }
        let told = diagnosis(&layer, ReferenceKind::CosineLayer, &[state], &mapping(PLANE_CONVENTION));
        let told = told.expect("a layer");
        assert!(told.len() == 1 && told[0].contains("does `x` count from the other end?"), "{told:?}");
    }
}
