//! A result as columns of numbers with the places and times at which they stand.

use super::hypotheses::{Scale, scales};
use super::world::{Fields, World};
use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::import::nodes::levels;
use oedometer_exact::ColumnParameters;
use std::ops::Range;

/// Number of outputs that are examined, spread over all of them.
const OUTPUTS: usize = 12;
/// Samples of an output that are looked at for patterns, and in the trials of hypotheses, where there are more than twice
/// as many.
const SAMPLES: [usize; 2] = [5000, 16];
/// Exact values below this share of the load, or of the final settlement, are round-off and show nothing.
const VANISHED: f64 = 1e-6;
/// Values above this share show something, whatever the exact ones are.
const SEEN: f64 = 0.01;
/// Largest relative error that a mesh of `N` rows explains, times N².
const MESH: f64 = 0.3;
/// Shift of times that a mesh explains, over the time in which water diffuses through a row.
const MOMENT: f64 = 0.25;
/// Share of the size of a column that an output has at least, where its own error is judged.
const SHARE_OF_OUTPUT: f64 = 0.05;
/// A column with at most this residual is right, and never explained.
const RIGHT: f64 = 1e-3;
/// Share of its residual that a correction may leave; where the mesh explains it, or values are few; and at most.
const SHARE: f64 = 0.1;
pub const CLEAN: f64 = 0.02;
pub const FEW: usize = 8;
pub const MOST: f64 = 0.1;
/// Multiple of the residual of a right column that a correction of another may leave.
const AS_OTHERS: f64 = 30.0;
/// Largest residual of what is right beside something that is wrong.
const MOST_BESIDE: f64 = 0.03;
/// Multiple of the limit of a column that an output may have.
const OF_OUTPUT: f64 = 3.0;

/// What a column of a result is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    #[default]
    Pressure,
    EffectiveStress,
    /// The displacement along the height.
    Up,
    /// The displacement along a layer, or across a slab.
    Along,
    Settlement,
}

impl Field {
    pub const ALL: [Self; 5] =
        [Self::Pressure, Self::EffectiveStress, Self::Up, Self::Along, Self::Settlement];

    /// Whether it is a stress, Pa; else it is a length, m.
    pub fn is_stress(self) -> bool {
        matches!(self, Self::Pressure | Self::EffectiveStress)
    }
}

/// What a file would hold.
pub struct Held {
    pub values: Vec<f64>,
    /// What of it varies as the exact solution does: the yardstick of its error.
    pub varying: Vec<f64>,
    /// What is round-off of it.
    pub floor: f64,
}

/// A column: its values at all samples of all outputs that have it, one after the other.
#[derive(Clone, Default)]
pub struct Column {
    pub field: Field,
    /// Its name for the user.
    pub name: &'static str,
    /// What a value of 1 stands for: the load, or the final settlement.
    pub scale: f64,
    /// Factors that it may have.
    pub scales: Vec<Scale>,
    pub values: Vec<f64>,
    /// What the scene's own solution predicts for them.
    pub exact: Vec<f64>,
    /// Where its values stand in [`Fields`].
    at: Vec<usize>,
    /// Initial height of each value, m.
    pub heights: Vec<f64>,
    /// Initial distance of each value along a layer, m; empty in a column.
    pub distances: Vec<f64>,
    /// Number of the output of each value.
    pub outputs: Vec<usize>,
    /// Its residual against the scene's own solution.
    pub residual: f64,
    /// What a correction may leave.
    pub limit: f64,
    /// Whether another column is right.
    pub is_other_right: bool,
}

impl Column {
    /// Where the values of an output stand, or all.
    fn places(&self, output: Option<usize>) -> Range<usize> {
        let before = |output: usize| self.outputs.partition_point(|of| *of < output);
        output.map_or(0..self.outputs.len(), |output| before(output)..before(output + 1))
    }

    /// The mean product of two lists of this column's length over its scale, at an output or at all.
    fn product(&self, a: &[f64], b: &[f64], output: Option<usize>) -> f64 {
        let places = self.places(output);
        let products = a[places.clone()].iter().zip(&b[places.clone()]);
        let sum = products.fold(0.0, |sum, (a, b)| sum + a / self.scale * (b / self.scale));
        sum / (places.len() as f64).max(1.0)
    }

    /// Root of the mean square of a list, at an output or at all.
    pub fn size(&self, values: &[f64], output: Option<usize>) -> f64 {
        self.scale * self.product(values, values, output).sqrt()
    }

    /// The factor of a list that fits another one best, at an output or at all.
    pub fn factor(&self, values: &[f64], of: &[f64], output: Option<usize>) -> f64 {
        self.product(values, of, output) / self.product(of, of, output)
    }

    /// The values that a prediction has for this column; those of the file where it may have either.
    pub fn of_itself(&self, predicted: &Fields) -> Vec<f64> {
        let of_file = |(exact, value): (f64, &f64)| if exact.is_nan() { *value } else { exact };
        self.of_field(predicted, self.field).into_iter().zip(&self.values).map(of_file).collect()
    }

    /// The values that a prediction has of a field at the places of this column.
    pub fn of_field(&self, predicted: &Fields, field: Field) -> Vec<f64> {
        let all = &predicted[field as usize];
        self.at.iter().map(|place| all.get(*place).copied().unwrap_or(f64::INFINITY)).collect()
    }

    /// What the values have beyond a multiple of others.
    pub fn beyond(&self, others: &[f64], factor: f64) -> Vec<f64> {
        self.values.iter().zip(others).map(|(value, other)| value - factor * other).collect()
    }

    /// The exact values of the column itself as what it holds.
    pub fn itself(&self, exact: &[f64]) -> Held {
        Held { values: exact.to_vec(), varying: exact.to_vec(), floor: VANISHED * self.scale }
    }

    /// The error that a hypothesis with a factor of the file leaves at an output or at all, over what varies in it as the
    /// exact solution does; not a number where nothing does.
    pub fn misfit(&self, held: &Held, factor: f64, output: Option<usize>) -> f64 {
        let least = if output.is_some() { SHARE_OF_OUTPUT * self.size(&held.varying, None) } else { 0.0 };
        let size = self.size(&held.varying, output).max(least).max(held.floor);
        self.size(&self.beyond(&held.values, factor), output) / (factor.abs() * size)
    }

    /// The error that a hypothesis with a factor of the file leaves, if that is little in all and at every output.
    pub fn accepts(&self, held: &Held, factor: f64) -> Option<f64> {
        let (left, limit) = (self.misfit(held, factor, None), self.limit);
        let is_even = |output: usize| self.misfit(held, factor, Some(output)) <= OF_OUTPUT * limit;
        (left <= limit && self.own_outputs().into_iter().all(is_even)).then_some(left)
    }

    /// Whether all values are 0.
    pub fn is_zero(&self) -> bool {
        self.values.iter().all(|value| *value == 0.0)
    }

    /// Whether it is right, so that nothing of it is explained.
    pub fn is_right(&self) -> bool {
        self.residual <= RIGHT
    }

    /// The numbers of its outputs, each once.
    pub fn own_outputs(&self) -> Vec<usize> {
        let mut outputs = self.outputs.clone();
        outputs.dedup();
        outputs
    }

    /// The values of an output.
    pub fn at_output(&self, output: usize) -> &[f64] {
        &self.values[self.places(Some(output))]
    }

    /// Whether there are several outputs and all have the same values.
    pub fn stands_still(&self) -> bool {
        let outputs = self.own_outputs();
        let first = self.at_output(outputs[0]);
        outputs.len() > 1 && outputs.into_iter().all(|output| self.at_output(output) == first)
    }
}

/// The samples of an output at places of one kind.
#[derive(Clone)]
pub struct Set {
    pub output: usize,
    pub heights: Vec<f64>,
    /// Empty in a column.
    pub distances: Vec<f64>,
    /// The values of each [`Field`] in its order.
    values: Fields,
}

impl Set {
    /// The samples of a state; a settlement alone stands at the surface.
    fn of(output: usize, state: &SampledState, height: f64) -> Self {
        let SampledState { pressure, effective_stress, displacement, horizontal_displacement, .. } =
            state.clone();
        let settlement = state.surface_displacement.map(|up| -up).into_iter().collect();
        let values = [pressure, effective_stress, displacement, horizontal_displacement, settlement];
        let (mut heights, distances) = (state.initial_height.clone(), state.initial_distance.clone());
        if heights.is_empty() {
            heights.push(height);
        }
        Self { output, heights, distances, values }
    }

    /// Some of the samples, spread over all of them without a period: a mistake is in all samples, and every trial evaluates
    /// the exact fields again.
    fn thinned(&self, most: usize) -> Self {
        let all = self.heights.len();
        if all <= 2 * most {
            return self.clone();
        }
        // One of each of as many equal parts, at a place in it that a multiple of the golden ratio gives.
        let place = |part: usize| part * all / most + (part.wrapping_mul(0x9e37_79b9) >> 16) % (all / most);
        let of = |list: &Vec<f64>| (0..most).filter_map(|part| list.get(place(part)).copied()).collect();
        Self {
            output: self.output,
            heights: of(&self.heights),
            distances: of(&self.distances),
            values: self.values.each_ref().map(of),
        }
    }
}

/// A result with the scene that it is held against.
#[derive(Clone)]
pub struct Given<'a> {
    /// The scene as it is.
    pub own: World,
    pub mapping: &'a Mapping,
    /// Times of the outputs, and of those before them, s.
    pub times: Vec<f64>,
    pub before: Vec<f64>,
    pub sets: Vec<Set>,
    pub columns: Vec<Column>,
}

impl<'a> Given<'a> {
    /// The columns of some of the outputs that show something; `None` where the scene has no solution at these times.
    pub fn of(own: &World, mapping: &'a Mapping, states: &[&SampledState]) -> Option<Self> {
        let count = states.len().min(OUTPUTS);
        let place = |number: usize| number * states.len().saturating_sub(1) / count.saturating_sub(1).max(1);
        let before = |place: usize| place.checked_sub(1).map_or(0.0, |before| states[before].time);
        let places = || (0..count).map(place);
        let given = Self {
            own: own.clone(),
            mapping,
            times: places().map(|place| states[place].time).collect(),
            before: places().map(before).collect(),
            sets: Vec::new(),
            columns: Vec::new(),
        };
        let of_output = |(number, place): (usize, usize)| {
            let beside = states[place].beside.iter().map(|beside| &beside.state);
            let all = std::iter::once(states[place]).chain(beside);
            all.map(move |state| Set::of(number, state, own.parameters.height).thinned(SAMPLES[0]))
        };
        let sets = places().enumerate().flat_map(of_output);
        given.with(sets.collect())
    }

    /// Some of the samples, in the same columns, which are judged by all samples.
    pub fn thin(&self) -> Option<Self> {
        let thin =
            Self { sets: self.sets.iter().map(|set| set.thinned(SAMPLES[1])).collect(), ..self.clone() };
        let predicted = thin.own.predict(&thin, &thin.times)?;
        let column = |whole: &Column| Column {
            residual: whole.residual,
            limit: whole.limit,
            is_other_right: whole.is_other_right,
            ..thin.column(whole.field, &predicted)
        };
        Some(Self { columns: self.columns.iter().map(column).collect(), ..thin })
    }

    /// Some of the outputs, in the columns that are right there and some others.
    pub fn at_outputs(&self, outputs: &[usize], names: &[&str]) -> Option<Self> {
        let sets = self.sets.iter().filter(|set| outputs.contains(&set.output));
        let mut part = self.with(sets.cloned().collect())?;
        part.columns.retain(|column| column.is_right() || names.contains(&column.name));
        Some(part)
    }

    /// Other samples, in the columns that show something.
    fn with(&self, sets: Vec<Set>) -> Option<Self> {
        let mut given = Self { sets, ..self.clone() };
        let predicted = given.own.predict(&given, &given.times)?;
        let is_seen = |column: &Column| {
            column.size(&column.exact, None) > VANISHED * column.scale
                || column.size(&column.values, None) > SEEN * column.scale
        };
        let columns = Field::ALL.into_iter().map(|field| given.column(field, &predicted));
        let mut columns: Vec<Column> = columns.filter(is_seen).collect();
        let residuals: Vec<f64> = columns.iter().map(|column| column.residual).collect();
        let right = residuals.iter().copied().filter(|residual| *residual <= RIGHT).reduce(f64::max);
        let most = right.map_or(MOST, |worst| MOST.min(CLEAN.max(AS_OTHERS * worst)));
        for column in &mut columns {
            column.limit = column.limit.min(most);
            column.is_other_right = residuals.iter().any(|other| *other <= right_beside(column.residual));
        }
        given.columns = columns;
        Some(given)
    }

    /// A field of all outputs as one column.
    fn column(&self, field: Field, predicted: &Fields) -> Column {
        let parameters = &self.own.parameters;
        let scale = if field.is_stress() { parameters.load } else { parameters.final_settlement() };
        // The height of a slab lies along x.
        let [up, along] = if self.own.is_slab() { ["u_x", "u_y"] } else { ["u_y", "u_x"] };
        let name = ["p", "effective_stress", up, along, "settlement"][field as usize];
        let mut column = Column { field, name, scale, scales: scales(field, self), ..Column::default() };
        let (mut first, mut rows) = (0, 2);
        for set in &self.sets {
            let values = &set.values[field as usize];
            column.values.extend(values);
            column.at.extend(first..first + values.len());
            column.heights.extend(set.heights.iter().take(values.len()));
            column.distances.extend(set.distances.iter().take(values.len()));
            column.outputs.extend(values.iter().map(|_| set.output));
            first += set.heights.len();
            if !values.is_empty() {
                rows = rows.max(levels(&set.heights, parameters.height).len());
            }
        }
        column.exact = column.of_itself(predicted);
        column.residual = column.misfit(&column.itself(&column.exact), 1.0, None);
        let is_of_mesh =
            field != Field::Settlement && column.residual < MESH / ((rows - 1) * (rows - 1)) as f64;
        let share = if is_of_mesh || column.values.len() < FEW { CLEAN } else { SHARE };
        column.limit = share * column.residual;
        column
    }

    /// Whether a displacement or a settlement is there, which tells a stiffness from a permeability.
    pub fn moves(&self) -> bool {
        self.columns.iter().any(|column| !column.field.is_stress())
    }

    /// Whether the times of a world, or its drainage, are off by no more than a mesh with these rows makes them at every output:
    /// a pressure that begins at 0 at the drained node has lost half a cell of water, as after `π/16 h²/c_v`.
    pub fn is_clock_of_mesh(&self, world: &World) -> bool {
        let parameters = &self.own.parameters;
        let rows = self.sets.iter().map(|set| levels(&set.heights, parameters.height).len()).max();
        let row = parameters.height / rows.unwrap_or(2).saturating_sub(1).max(1) as f64;
        let drains = |parameters: &ColumnParameters| parameters.soil.coefficient_of_consolidation();
        let most = MOMENT * row * row / drains(parameters);
        let ([clock, moment], faster) = (world.clock, drains(&world.parameters) / drains(parameters));
        let factor = clock * faster;
        let is_little = |time: &f64| (factor * time + moment - time).abs() < most;
        [factor, moment] != [1.0, 0.0] && self.times.iter().all(is_little)
    }

    /// The first and the last time after the start, s; 0 where there is none.
    pub fn span(&self) -> [f64; 2] {
        let positive = || self.times.iter().copied().filter(|time| *time > 0.0);
        [positive().reduce(f64::min).unwrap_or(0.0), positive().fold(0.0, f64::max)]
    }
}

/// The error up to which something is right beside what has a larger one.
pub fn right_beside(error: f64) -> f64 {
    (SHARE * error).clamp(RIGHT, MOST_BESIDE)
}

/// A list without its mean.
pub fn about_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}
