//! An external result compared with the references of a scene.

pub mod completeness;
pub mod coverage;
pub mod diagnosis;
pub mod results;
pub mod score_series;

use crate::case::{Norm, Quantity, Sample};
use crate::import::SampledState;
use crate::measure::fields::{
    ExactFields, FieldDifference, FieldError, LONG_AFTER, SamplePlaces, half_a_digit, largest_contribution,
    resolution, settlement_error, start_of,
};
use crate::record::ErrorRow;
use crate::score::completeness::{Finding, Lack};
use crate::score::score_series::{ScoredSeries, time_factors};
use oedometer_exact::{ColumnParameters, ExactError, Reference, ReferenceKind, TextbookProblem};
use oedometer_wording::rounded;
use std::borrow::Cow;

/// Multiple of the load, of the final settlement, or of the largest exact value that no correct result reaches.
const IMPOSSIBLE: f64 = 100.0;

/// The place that carries most of a field's error.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct WorstPlace {
    /// Time factor.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Initial depth over the height.
    pub zeta: f64,
    /// Initial distance from the crest of a layer's load over its length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// What the result has there.
    pub computed: f64,
    /// What the first reference has there.
    pub exact: f64,
    /// Its share of the squared L2 error.
    pub share: f64,
}

/// A result with its errors.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Score {
    /// Samples at each time factor.
    pub samples: Vec<(f64, usize)>,
    /// Errors against every reference.
    pub errors: Vec<ErrorRow>,
    /// Worst places against the first reference.
    pub worst: Vec<WorstPlace>,
    /// In what way the result is incomplete.
    pub warnings: Vec<Finding>,
    /// What is not judged because the result has no data for it: `--strict` does not pass it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_judged: Vec<Finding>,
    /// What seems to be wrong with its numbers, one sentence for each.
    pub diagnosis: Vec<String>,
    /// What has no relative error because the exact value is zero or below round-off.
    pub unresolved: Vec<Unresolved>,
    /// Orders and classes over all meshes of which this result is one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub series: Vec<ScoredSeries>,
    /// In which direction fields are off the first reference.
    #[serde(skip)]
    pub leanings: Vec<Leaning>,
}

/// In which direction a field is off. A norm has no sign: an error that changes sign between two meshes nearly
/// vanishes there and grows again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaning {
    /// Time factor.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Cosine between error and exact field, from −1, smaller everywhere, to 1, larger everywhere.
    pub cosine: f64,
    /// Half a unit in the last digit of the field's numbers, relative: no error is known better.
    pub half_a_digit: f64,
}

/// A quantity that cannot be compared with a reference at a time.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Unresolved {
    /// Time factor.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Where.
    pub sample: Sample,
    /// Which reference.
    pub reference: String,
    /// Root mean square of the difference over the load or the final settlement.
    pub absolute: f64,
}

/// Where the samples of a state are, in a column or layer of a height, m.
fn places_of(state: &SampledState, height: f64) -> SamplePlaces<'_> {
    SamplePlaces { height, heights: &state.initial_height, distances: &state.initial_distance }
}

/// The settlement that displacements are measured by, m.
fn settled(reference: &Reference, parameters: &ColumnParameters) -> Result<f64, ExactError> {
    if reference.is_plane() { reference.settlement(LONG_AFTER) } else { Ok(parameters.final_settlement()) }
}

/// Whether the reference has a settlement at one of the states that an error can be relative to.
fn has_settlement(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
) -> Result<bool, ExactError> {
    let times = time_factors(parameters, states);
    let reference = Reference::new(reference, parameters, &times)?;
    let scale = settled(&reference, parameters)?;
    let errors = times.iter().map(|time| settlement_error(&reference, *time, 0.0, scale));
    Ok(errors.collect::<Result<Vec<_>, _>>()?.iter().any(Option::is_some))
}

/// Compares states with references.
///
/// ```
/// use oedometer::exact::{ColumnParameters, Reference, ReferenceKind};
/// use oedometer::{Sample, SampledState, score};
///
/// let column = ColumnParameters::default();
/// let exact = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1])?;
/// // An external result whose pressure is one per cent too large everywhere.
/// let depths = [0.1, 0.3, 0.5, 0.7, 0.9];
/// let pressure = |zeta: &f64| exact.fields(0.1, *zeta).map(|fields| 1.01 * fields.pressure);
/// let state = SampledState {
///     time: 0.1 / column.time_factor(1.0),
///     initial_height: depths.iter().map(|zeta| (1.0 - zeta) * column.height).collect(),
///     volume: vec![0.2; depths.len()],
///     pressure: depths.iter().map(pressure).collect::<Result<_, _>>()?,
///     ..SampledState::default()
/// };
/// let score = score(&column, &[ReferenceKind::Terzaghi], &[state], Sample::Points)?;
/// assert!(!score.errors.is_empty());
/// assert!(score.errors.iter().all(|row| (row.value.abs() - 0.01).abs() < 1e-6));
/// # Ok::<(), oedometer::exact::ExactError>(())
/// ```
///
/// # Errors
/// When a reference refuses the column or a time.
pub fn score(
    parameters: &ColumnParameters,
    references: &[ReferenceKind],
    states: &[SampledState],
    sample: Sample,
) -> Result<Score, ExactError> {
    let times = time_factors(parameters, states);
    let references: Vec<Reference> =
        references.iter().map(|kind| Reference::new(*kind, parameters, &times)).collect::<Result<_, _>>()?;
    let mut score = Score::default();
    for (state, time_factor) in states.iter().zip(times) {
        score.samples.push((time_factor, state.initial_height.len()));
        for (place, reference) in references.iter().enumerate() {
            let mut is_settled = false;
            for (sample, state) in state.sets(sample) {
                let compared = ScoredState { parameters, reference, state, time_factor, sample, is_settled };
                is_settled |= compared.displacement_of_surface().is_some();
                score.add(&compared, place == 0)?;
            }
        }
    }
    Ok(score)
}

/// A state and a reference.
struct ScoredState<'a> {
    parameters: &'a ColumnParameters,
    reference: &'a Reference,
    state: &'a SampledState,
    time_factor: f64,
    sample: Sample,
    /// Whether its settlement is known from other samples.
    is_settled: bool,
}

impl Score {
    /// Adds the errors of a state against a reference, of the first reference the worst places too.
    fn add(&mut self, compared: &ScoredState<'_>, is_first: bool) -> Result<(), ExactError> {
        let ScoredState { parameters, reference, state, time_factor, sample, .. } = *compared;
        let places = places_of(state, parameters.height);
        let computed = [&state.pressure[..], &state.effective_stress];
        let exact = ExactFields::of(reference, time_factor, places)?.on_either_side(
            reference,
            time_factor,
            places,
            computed,
        )?;
        let settled = settled(reference, parameters)?;
        // The components one after the other.
        let displacement = one_after_the_other(&state.displacement, &state.horizontal_displacement);
        let exact_displacement = one_after_the_other(
            &exact.displacement[..state.displacement.len()],
            &exact.horizontal_displacement[..state.horizontal_displacement.len()],
        );
        let volumes = one_after_the_other(
            &state.volume,
            if displacement.len() > state.volume.len() { &state.volume } else { &[] },
        );
        for (quantity, computed, exact, scale) in [
            (Quantity::Pressure, &*state.pressure, &*exact.pressure, parameters.load),
            (Quantity::EffectiveStress, &state.effective_stress, &exact.effective_stress, parameters.load),
            (Quantity::Displacement, &displacement, &exact_displacement, settled),
        ] {
            if computed.is_empty() {
                continue;
            }
            let volumes = &volumes[..computed.len()];
            let components = if state.volume.len() < computed.len() { 2 } else { 1 };
            let (name, resolution) = (reference.name(), resolution(reference, time_factor));
            let field =
                FieldError { time_factor, quantity, sample, reference: name, scale, components, resolution };
            let at_start = || {
                let places = places_of(state, parameters.height);
                let start = ExactFields::of(reference, 0.0, places).ok();
                start_of(quantity, start.as_ref().map(|start| start.field(quantity)), scale, time_factor)
            };
            let rows = field.rows(computed, exact, volumes, at_start);
            if rows.is_empty() {
                let difference = FieldDifference::of(computed, exact, volumes);
                let absolute =
                    difference.and_then(|difference| difference.in_norm(Norm::L2).0).unwrap_or(f64::NAN);
                self.unresolved.push(compared.unresolved(quantity, sample, absolute / scale));
            }
            self.errors.extend(rows);
            if is_first {
                // One finding for each quantity.
                let begin = format!("{} of ", quantity.name());
                let is_known = self
                    .warnings
                    .iter()
                    .any(|known| known.name == Lack::ValueImpossible && known.sentence.starts_with(&begin));
                let found = impossible_value(quantity, computed, exact, scale, time_factor);
                let sentence = found.filter(|_| !is_known);
                self.warnings.extend(sentence.map(|sentence| Finding::new(Lack::ValueImpossible, sentence)));
                let cosine = cosine_of_error(computed, exact, volumes);
                let half_a_digit = half_a_digit(computed);
                self.leanings.push(Leaning { time_factor, quantity, cosine, half_a_digit });
                self.worst.extend(compared.worst_place(quantity, computed, exact, volumes));
            }
        }
        if let Some(displacement) = compared.displacement_of_surface() {
            if let Some(row) = settlement_error(reference, time_factor, -displacement, settled)? {
                self.errors.push(row);
            } else {
                let absolute = (-displacement - reference.settlement(time_factor)?) / settled;
                let settlement = compared.unresolved(Quantity::Settlement, Sample::Surface, absolute);
                self.unresolved.push(settlement);
            }
        }
        Ok(())
    }
}

/// A sentence on the value farthest beyond what the load can cause, where one is.
fn impossible_value(
    quantity: Quantity,
    computed: &[f64],
    exact: &[f64],
    scale: f64,
    time_factor: f64,
) -> Option<String> {
    let largest = |list: &[f64]| list.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let (found, possible) = (largest(computed), largest(exact).max(scale.abs()));
    (found > IMPOSSIBLE * possible).then(|| {
        let (name, time) = (quantity.name(), rounded(time_factor));
        format!(
            "{name} of {found:.3e} at T_v = {time}: more than {IMPOSSIBLE} times what the load can cause ({possible:.3e})"
        )
    })
}

/// Two lists as one, copied only where both have values.
fn one_after_the_other<'a>(first: &'a [f64], second: &[f64]) -> Cow<'a, [f64]> {
    if second.is_empty() { Cow::Borrowed(first) } else { Cow::Owned([first, second].concat()) }
}

/// Cosine between the error of a field and the exact field, weighted by volumes; 0 where one of them vanishes.
fn cosine_of_error(computed: &[f64], exact: &[f64], volumes: &[f64]) -> f64 {
    let (mut product, mut of_error, mut of_exact) = (0.0, 0.0, 0.0);
    for ((computed, exact), volume) in computed.iter().zip(exact).zip(volumes) {
        let error = computed - exact;
        product += volume * error * exact;
        of_error += volume * error * error;
        of_exact += volume * exact * exact;
    }
    let lengths = (of_error * of_exact).sqrt();
    if lengths > 0.0 { product / lengths } else { 0.0 }
}

impl ScoredState<'_> {
    fn unresolved(&self, quantity: Quantity, sample: Sample, absolute: f64) -> Unresolved {
        let reference = self.reference.name().to_owned();
        Unresolved { time_factor: self.time_factor, quantity, sample, reference, absolute }
    }

    /// The sample that carries most of a field's error.
    fn worst_place(
        &self,
        quantity: Quantity,
        computed: &[f64],
        exact: &[f64],
        volumes: &[f64],
    ) -> Option<WorstPlace> {
        let worst = largest_contribution(computed, exact, volumes)?;
        let place = worst.index % self.state.initial_height.len();
        let distance = || self.state.initial_distance[place] / self.parameters.length;
        Some(WorstPlace {
            time_factor: self.time_factor,
            quantity,
            zeta: (1.0 - self.state.initial_height[place] / self.parameters.height).clamp(0.0, 1.0),
            x: self.reference.is_plane().then(distance),
            computed: computed[worst.index],
            exact: exact[worst.index],
            share: worst.share,
        })
    }

    /// Vertical displacement of the surface, in a layer under the crest of its load: from a settlement curve, or from a
    /// sample there. The settlement of a slab is that of its plate, and of a free layer that is drained by wells the mean: no
    /// sample has them.
    fn displacement_of_surface(&self) -> Option<f64> {
        let (state, parameters) = (self.state, self.parameters);
        if self.is_settled {
            return None;
        }
        let mean_or_plate =
            [ReferenceKind::Mandel, ReferenceKind::Textbook(TextbookProblem::BarronFreeStrain)];
        if state.surface_displacement.is_some() || mean_or_plate.contains(&self.reference.kind()) {
            return state.surface_displacement;
        }
        let length = self.reference.is_plane().then_some(parameters.length);
        state.displacement_at_surface(parameters.height, length)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::import::RIM;

    /// The exact fields on places, the pressure off by `error(ζ)`.
    pub(crate) fn state(places: usize, time_factor: f64, error: impl Fn(f64) -> f64) -> SampledState {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[]).expect("the seed column");
        let mut state = SampledState { time: column.time(time_factor), ..SampledState::default() };
        for place in 0..=places {
            let zeta = 1.0 - place as f64 / places as f64;
            let fields = reference.fields(time_factor, zeta).expect("inside");
            state.initial_height.push(1.0 - zeta);
            state.volume.push(1.0);
            state.pressure.push(fields.pressure + error(zeta));
            state.displacement.push(fields.displacement);
        }
        state
    }

    pub(crate) fn scored(states: &[SampledState]) -> Score {
        score(&ColumnParameters::default(), &[ReferenceKind::Terzaghi], states, Sample::Nodes)
            .expect("a score")
    }

    #[test]
    fn the_exact_solution_scores_round_off_and_a_wrong_place_is_named() {
        let clean = scored(&[state(20, 0.1, |_| 0.0)]);
        assert!(clean.errors.iter().all(|row| row.value.abs() < 1e-9), "{clean:?}");
        assert!(clean.errors.iter().any(|row| row.quantity == Quantity::Settlement));
        assert!(clean.errors.iter().all(|row| row.quantity != Quantity::EffectiveStress), "no such column");
        let off = scored(&[state(20, 0.1, |zeta| if (zeta - 0.25).abs() < 0.01 { 0.1 } else { 0.0 })]);
        assert!((off.worst[0].zeta - 0.25).abs() < 1e-12 && off.worst[0].share > 0.999_999);
    }

    #[test]
    fn what_the_reference_does_not_resolve_is_listed_and_has_no_error() {
        let late = scored(&[state(20, 50.0, |_| 1e-13)]);
        assert!(late.errors.iter().all(|row| row.quantity != Quantity::Pressure), "{:?}", late.errors);
        let pressure: Vec<_> =
            late.unresolved.iter().map(|output| (output.quantity, output.time_factor)).collect();
        assert_eq!(pressure.len(), 1);
        assert_eq!(pressure[0].0, Quantity::Pressure);
        assert!((pressure[0].1 - 50.0).abs() < 1e-9);
        assert_eq!(scored(&[state(20, 0.1, |_| 0.0)]).unresolved, []);
    }

    #[test]
    fn a_layer_is_measured_where_its_samples_are_and_by_vectors() {
        let layer = ColumnParameters { length: 2.0, ..ColumnParameters::default() };
        let reference = Reference::new(ReferenceKind::CosineLayer, &layer, &[]).expect("a layer");
        let exact = reference.plane_state(0.1).expect("a state").expect("in the plane");
        let mut state = SampledState { time: layer.time(0.1), ..SampledState::default() };
        for (x, y) in (0..=4).flat_map(|i| (0..=4).map(move |j| (0.5 * f64::from(i), 0.25 * f64::from(j)))) {
            let fields = exact.fields(x, y).expect("inside");
            state.initial_distance.push(x);
            state.initial_height.push(y);
            state.volume.push(1.0);
            state.pressure.push(fields.pressure);
            state.horizontal_displacement.push(1.01 * fields.displacement[0]);
            state.displacement.push(1.01 * fields.displacement[1]);
        }
        let kinds = [ReferenceKind::CosineLayer];
        let found = score(&layer, &kinds, &[state.clone()], Sample::Nodes).expect("a score");
        let value = |quantity: Quantity, norm: Norm| {
            found.errors.iter().find(|row| (row.quantity, row.norm) == (quantity, norm)).expect("a row").value
        };
        assert!(value(Quantity::Pressure, Norm::L2) < 1e-12);
        for (quantity, norm) in [(Quantity::Displacement, Norm::L2), (Quantity::Settlement, Norm::Relative)] {
            assert!((value(quantity, norm) - 0.01).abs() < 1e-12, "{quantity:?}");
        }
        // Places are shares of the length, which is twice the height: the sample in the middle, and one beside the crest.
        let mut other = state.clone();
        other.pressure[12] += 1e3;
        other.initial_distance[4] = 1.5 * RIM;
        let found = score(&layer, &kinds, &[other], Sample::Nodes).expect("a score");
        let worst = found.worst.iter().find(|worst| worst.quantity == Quantity::Pressure).expect("a place");
        assert_eq!((worst.x, worst.zeta), (Some(0.5), 0.5));
        assert!(found.errors.iter().any(|row| row.quantity == Quantity::Settlement));
        // The settlement is that of the sample under the crest; that at the far end differs.
        let far: Vec<usize> = (0..25).filter(|place| state.initial_distance[*place] > 0.1).collect();
        let only = |list: &[f64]| far.iter().map(|place| list[*place]).collect::<Vec<f64>>();
        let without = SampledState {
            time: state.time,
            initial_distance: only(&state.initial_distance),
            initial_height: only(&state.initial_height),
            volume: only(&state.volume),
            displacement: only(&state.displacement),
            ..SampledState::default()
        };
        let found = score(&layer, &kinds, &[without], Sample::Nodes).expect("a score");
        assert!(found.errors.iter().all(|row| row.quantity != Quantity::Settlement));
    }
}
