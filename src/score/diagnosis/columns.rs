//! A result as columns of numbers with the places and times at which they stand.

use super::world::{Predicted, World};
use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::score::coverage::lines;
use oedometer_exact::row::Axis;
use oedometer_exact::{ColumnParameters, Reference, ReferenceKind};
use oedometer_soil::elementary::powi;
use std::borrow::Cow;

/// Number of outputs that are examined, spread over all of them.
const OUTPUTS: usize = 12;
/// Share of a part by which the place of a sample in it advances from one part to the next, of 2³².
const GOLDEN_RATIO: u32 = 0x9e37_79b9;
/// Exact values below this share of the load, or of the final settlement, are round-off and show nothing.
const VANISHED: f64 = 1e-6;
/// Values above this share show something, whatever the exact ones are.
const SEEN: f64 = 0.01;
/// Largest relative error that a mesh of `N` rows explains, times N².
const MESH: f64 = 0.3;
/// Share of the size of a column that an output has at least, where its own error is judged.
const SHARE_OF_OUTPUT: f64 = 0.05;

/// What a column of a result is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    Pressure,
    EffectiveStress,
    /// The displacement along the height.
    Up,
    /// The displacement along a layer, or across a slab.
    Along,
    Settlement,
}

impl Field {
    /// Whether it is a stress, Pa; else it is a length, m.
    pub fn is_stress(self) -> bool {
        matches!(self, Self::Pressure | Self::EffectiveStress)
    }
}

/// A column: its values at all samples of all outputs that have it, one after the other.
pub struct Column {
    pub field: Field,
    /// Its name for the user.
    pub name: &'static str,
    /// What a value of 1 stands for: the load, or the final settlement.
    pub scale: f64,
    pub values: Vec<f64>,
    /// Where its values stand in a [`Predicted`].
    at: Vec<usize>,
    /// Initial height of each value, m.
    pub heights: Vec<f64>,
    /// Initial distance of each value along a layer, m; empty in a column.
    pub distances: Vec<f64>,
    weights: Vec<f64>,
    /// Number of the output of each value.
    pub outputs: Vec<usize>,
    /// Its residual against the scene's own solution.
    pub residual: f64,
    /// Error that its mesh explains.
    pub mesh: f64,
}

impl Column {
    /// Root of the weighted mean square of those of a list of this column's length that are asked for.
    fn size_of(&self, values: &[f64], is_asked: impl Fn(usize) -> bool) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for place in (0..values.len()).filter(|place| is_asked(*place)) {
            sum += self.weights[place] * powi(values[place] / self.scale, 2);
            weights += self.weights[place];
        }
        if weights > 0.0 { (sum / weights).sqrt() * self.scale } else { 0.0 }
    }

    /// Root of the weighted mean square of a list of this column's length.
    pub fn size(&self, values: &[f64]) -> f64 {
        self.size_of(values, |_| true)
    }

    /// The values that a prediction has for this column.
    pub fn exact(&self, predicted: &Predicted) -> Vec<f64> {
        self.of_field(predicted, self.field)
    }

    /// The values that a prediction has of a field at the places of this column.
    pub fn of_field(&self, predicted: &Predicted, field: Field) -> Vec<f64> {
        let all = predicted.field(field);
        self.at.iter().map(|place| all.get(*place).copied().unwrap_or(f64::NAN)).collect()
    }

    /// What the values have beyond a multiple of others.
    pub fn beyond(&self, others: &[f64], factor: f64) -> Vec<f64> {
        self.values.iter().zip(others).map(|(value, other)| value - factor * other).collect()
    }

    /// The error of the values over the larger of both: that of a column as it is given.
    pub fn own_residual(&self, exact: &[f64]) -> f64 {
        let size = self.size(exact).max(self.size(&self.values)).max(VANISHED * self.scale);
        self.size(&self.beyond(exact, 1.0)) / size
    }

    /// The error that a hypothesis with a factor of the file leaves, over what varies in it as the exact solution does;
    /// infinite where nothing does. Of the column itself what vanishes is round-off.
    pub fn misfit(&self, held: &[f64], varying: &[f64], factor: f64, is_itself: bool) -> f64 {
        let size = (factor.abs() * self.size(varying)).max(self.vanished(factor, is_itself));
        if size > 0.0 { self.size(&self.beyond(held, factor)) / size } else { f64::INFINITY }
    }

    /// The error of an output, over what varies there.
    pub fn misfit_of(
        &self,
        output: usize,
        held: &[f64],
        varying: &[f64],
        factor: f64,
        is_itself: bool,
    ) -> f64 {
        let is_of = |place: usize| self.outputs[place] == output;
        let size = self.size_of(varying, is_of).max(SHARE_OF_OUTPUT * self.size(varying));
        let size = (factor.abs() * size).max(self.vanished(factor, is_itself));
        self.size_of(&self.beyond(held, factor), is_of) / size
    }

    /// What is round-off of the column itself.
    fn vanished(&self, factor: f64, is_itself: bool) -> f64 {
        if is_itself { VANISHED * self.scale * factor.abs().min(1.0) } else { 0.0 }
    }

    /// Weighted mean of a list.
    pub fn mean(&self, values: &[f64]) -> f64 {
        let all = || values.iter().zip(&self.weights);
        all().map(|(value, weight)| weight * value).sum::<f64>()
            / all().map(|(_, weight)| weight).sum::<f64>()
    }

    /// The factor of a list that fits another one best.
    pub fn factor(&self, values: &[f64], of: &[f64]) -> f64 {
        let (mut both, mut square) = (0.0, 0.0);
        for ((value, of), weight) in values.iter().zip(of).zip(&self.weights) {
            both += weight * value / self.scale * (of / self.scale);
            square += weight * powi(of / self.scale, 2);
        }
        both / square
    }

    /// Whether all values are 0.
    pub fn is_zero(&self) -> bool {
        self.values.iter().all(|value| *value == 0.0)
    }

    /// The numbers of its outputs, each once.
    pub fn own_outputs(&self) -> Vec<usize> {
        let mut outputs = self.outputs.clone();
        outputs.dedup();
        outputs
    }

    /// The values of an output.
    pub fn at_output(&self, output: usize) -> Vec<f64> {
        let of = self.outputs.iter().zip(&self.values).filter(|(other, _)| **other == output);
        of.map(|(_, value)| *value).collect()
    }

    /// Whether there are several outputs and all have the same values.
    pub fn stands_still(&self) -> bool {
        let outputs = self.own_outputs();
        let first = outputs.first().map(|output| self.at_output(*output));
        outputs.len() > 1 && outputs.iter().all(|output| Some(self.at_output(*output)) == first)
    }

    /// Whether neither the result nor the scene has anything to show here.
    fn shows_nothing(&self, exact: &[f64]) -> bool {
        self.size(exact) < VANISHED * self.scale && self.size(&self.values) <= SEEN * self.scale
    }
}

/// A state of a result, with the time of the one before.
#[derive(Clone, Copy)]
pub struct Output<'a> {
    pub state: &'a SampledState,
    /// Time of the output before, s; 0 of the first.
    pub before: f64,
}

/// A result with the scene that it is held against.
pub struct Given<'a> {
    pub parameters: &'a ColumnParameters,
    pub kind: ReferenceKind,
    pub mapping: &'a Mapping,
    /// Times of the outputs, and of those before them, s.
    pub times: Vec<f64>,
    pub before: Vec<f64>,
    /// Sets of places with the number of their output.
    pub sets: Vec<(usize, Cow<'a, SampledState>)>,
    pub columns: Vec<Column>,
    /// Whether these are only some of the samples.
    pub are_picked: bool,
    /// The scene's own solution, for worlds of the same body.
    pub solution: Reference,
    /// What it predicts.
    pub own: Predicted,
}

impl<'a> Given<'a> {
    /// The columns of some of the outputs that show something, at most so many samples of each; `None` where the scene has
    /// no solution at these times.
    pub fn of(
        parameters: &'a ColumnParameters,
        solution: &Reference,
        outputs: &[Output<'a>],
        mapping: &'a Mapping,
        most: usize,
    ) -> Option<Self> {
        let count = outputs.len().min(OUTPUTS);
        let last = outputs.len().saturating_sub(1);
        let spread: Vec<Output<'_>> =
            (0..count).map(|place| outputs[place * last / count.saturating_sub(1).max(1)]).collect();
        let mut sets = Vec::new();
        for (number, output) in spread.iter().enumerate() {
            sets.push((number, picked(output.state, most)));
            sets.extend(output.state.beside.iter().map(|set| (number, picked(&set.state, most))));
        }
        let mut given = Self {
            parameters,
            kind: solution.kind(),
            mapping,
            times: spread.iter().map(|output| output.state.time).collect(),
            before: spread.iter().map(|output| output.before).collect(),
            are_picked: sets.iter().any(|(_, set)| matches!(set, Cow::Owned(_))),
            sets,
            columns: Vec::new(),
            solution: solution.clone(),
            own: Predicted::default(),
        };
        given.own = World::own(&given).predict_by(solution, &given, &given.times)?;
        let (load, settled) = (parameters.load, parameters.final_settlement());
        // The names of a slab's components: its height lies along x.
        let [up, along] =
            if given.kind.row().axis == Axis::AlongSlab { ["u_x", "u_y"] } else { ["u_y", "u_x"] };
        let columns = [
            (Field::Pressure, "p", load),
            (Field::EffectiveStress, "effective_stress", load),
            (Field::Up, up, settled),
            (Field::Along, along, settled),
            (Field::Settlement, "settlement", settled),
        ];
        given.columns =
            columns.into_iter().filter_map(|(field, name, scale)| given.column(field, name, scale)).collect();
        Some(given)
    }

    /// A field of all outputs as one column, if it shows something.
    fn column(&self, field: Field, name: &'static str, scale: f64) -> Option<Column> {
        let mut column = Column {
            field,
            name,
            scale,
            values: Vec::new(),
            at: Vec::new(),
            heights: Vec::new(),
            distances: Vec::new(),
            weights: Vec::new(),
            outputs: Vec::new(),
            residual: 0.0,
            mesh: 0.0,
        };
        let (mut first, mut rows) = (0, 1);
        for (output, set) in &self.sets {
            let from = first;
            first += set.initial_height.len();
            let here = (0..set.initial_height.len()).map(|place| (place, from + place));
            let values = match field {
                Field::Pressure => &set.pressure,
                Field::EffectiveStress => &set.effective_stress,
                Field::Up => &set.displacement,
                Field::Along => &set.horizontal_displacement,
                Field::Settlement => {
                    if let Some(up) = set.surface_displacement {
                        column.push(-up, *output, [0.0, 1.0], *output);
                    }
                    continue;
                }
            };
            // At the start a drained surface has the pressure of before or of after.
            let is_torn = |y: f64| {
                field == Field::Pressure && self.times[*output] <= 0.0 && y >= self.parameters.height
            };
            for (place, at) in
                here.filter(|(place, _)| values.len() > *place && !is_torn(set.initial_height[*place]))
            {
                column.push(values[place], at, [set.initial_height[place], set.volume[place]], *output);
                column.distances.extend(set.initial_distance.get(place));
            }
            if !values.is_empty() {
                rows = rows.max(lines(&set.initial_height, self.parameters.height).len());
            }
        }
        let exact = column.exact(&self.own);
        column.residual = column.own_residual(&exact);
        column.mesh = if field == Field::Settlement { 0.0 } else { MESH / powi((rows.max(2) - 1) as f64, 2) };
        (!column.values.is_empty() && !column.shows_nothing(&exact)).then_some(column)
    }

    /// Judges the columns by their residuals in all samples.
    pub fn judge_as(&mut self, whole: &Self) {
        self.columns.retain_mut(|column| {
            let of = whole.columns.iter().find(|other| other.field == column.field);
            (column.residual, column.mesh) = of.map_or((0.0, 0.0), |of| (of.residual, of.mesh));
            of.is_some()
        });
    }

    /// Whether the fields depend on the place along a layer.
    pub fn is_plane(&self) -> bool {
        matches!(self.kind, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible)
    }

    /// Whether fields grow with the load.
    pub fn is_linear(&self) -> bool {
        !matches!(self.kind, ReferenceKind::LargeStrain(_) | ReferenceKind::XieLeo)
    }

    /// Whether a displacement or a settlement is there, which tells a stiffness from a permeability.
    pub fn moves(&self) -> bool {
        self.columns.iter().any(|column| !column.field.is_stress())
    }

    /// Whether a pressure is there.
    pub fn has_pressure(&self) -> bool {
        self.columns.iter().any(|column| column.field == Field::Pressure)
    }

    /// Whether a stress is there.
    pub fn is_stressed(&self) -> bool {
        self.columns.iter().any(|column| column.field.is_stress())
    }

    /// The first and the last time after the start, s; `None` where there is none.
    pub fn span(&self) -> Option<[f64; 2]> {
        let positive = || self.times.iter().copied().filter(|time| *time > 0.0);
        Some([positive().reduce(f64::min)?, positive().reduce(f64::max)?])
    }
}

impl Column {
    fn push(&mut self, value: f64, at: usize, [height, weight]: [f64; 2], output: usize) {
        self.values.push(value);
        self.at.push(at);
        self.heights.push(height);
        self.weights.push(weight);
        self.outputs.push(output);
    }
}

/// Some of the samples of a state, spread over all of them without a period: a mistake is in all samples, and every
/// trial evaluates the exact fields again.
fn picked(state: &SampledState, most: usize) -> Cow<'_, SampledState> {
    let all = state.initial_height.len();
    if all <= 2 * most {
        return Cow::Borrowed(state);
    }
    let most = u32::try_from(most).unwrap_or(u32::MAX);
    // One of each of as many equal parts, at a place in it that advances by the golden ratio.
    let place = |part: u32| {
        let within = part.wrapping_mul(GOLDEN_RATIO);
        let places = u128::from(u64::from(part) << 32 | u64::from(within)) * all as u128;
        usize::try_from(places / (u128::from(most) << 32)).ok()
    };
    let places: Vec<usize> = (0..most).filter_map(place).collect();
    let of = |list: &[f64]| places.iter().filter_map(|place| list.get(*place).copied()).collect();
    Cow::Owned(SampledState {
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
    })
}
