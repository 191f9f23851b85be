//! A result as columns of numbers with the places and times at which they stand.

use super::hypotheses::{Scale, scales};
use super::world::{Fields, World};
use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::score::coverage::lines;
use oedometer_soil::elementary::powi;
use std::borrow::Cow;

/// Number of outputs that are examined, spread over all of them.
const OUTPUTS: usize = 12;
/// Exact values below this share of the load, or of the final settlement, are round-off and show nothing.
const VANISHED: f64 = 1e-6;
/// Values above this share show something, whatever the exact ones are.
const SEEN: f64 = 0.01;
/// Largest relative error that a mesh of `N` rows explains, times N².
const MESH: f64 = 0.3;
/// Share of the size of a column that an output has at least, where its own error is judged.
const SHARE_OF_OUTPUT: f64 = 0.05;
/// A column with at most this residual is right, and never explained.
const RIGHT: f64 = 1e-3;

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
#[derive(Default)]
pub struct Column {
    pub field: Field,
    /// Its name for the user.
    pub name: &'static str,
    /// What a value of 1 stands for: the load, or the final settlement.
    pub scale: f64,
    /// Factors that it may have.
    pub scales: Vec<Scale>,
    pub values: Vec<f64>,
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
    /// Error that its mesh explains.
    pub mesh: f64,
}

impl Column {
    /// Root of the mean square of a list of this column's length, at an output or at all.
    pub fn size(&self, values: &[f64], output: Option<usize>) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0_f64);
        for (value, of) in values.iter().zip(&self.outputs) {
            if output.is_none_or(|output| output == *of) {
                sum += powi(value / self.scale, 2);
                count += 1.0;
            }
        }
        self.scale * (sum / count.max(1.0)).sqrt()
    }

    /// The values that a prediction has for this column; those of the file where it may have either.
    pub fn exact(&self, predicted: &Fields) -> Vec<f64> {
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

    /// The error of the values over the larger of both: that of a column as it is given.
    pub fn own_residual(&self, exact: &[f64]) -> f64 {
        let size = self.size(exact, None).max(self.size(&self.values, None)).max(VANISHED * self.scale);
        self.size(&self.beyond(exact, 1.0), None) / size
    }

    /// The error that a hypothesis with a factor of the file leaves at an output or at all, over what varies in it as the
    /// exact solution does; not a number where nothing does.
    pub fn misfit(&self, held: &Held, factor: f64, output: Option<usize>) -> f64 {
        let least = if output.is_some() { SHARE_OF_OUTPUT * self.size(&held.varying, None) } else { 0.0 };
        let size = self.size(&held.varying, output).max(least).max(held.floor);
        self.size(&self.beyond(&held.values, factor), output) / (factor.abs() * size)
    }

    /// The factor of a list that fits another one best, at an output or at all.
    pub fn factor(&self, values: &[f64], of: &[f64], output: Option<usize>) -> f64 {
        let (mut both, mut square) = (0.0, 0.0);
        for ((value, of), at) in values.iter().zip(of).zip(&self.outputs) {
            if output.is_none_or(|output| output == *at) {
                both += value / self.scale * (of / self.scale);
                square += powi(of / self.scale, 2);
            }
        }
        both / square
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
    pub fn at_output(&self, output: usize) -> Vec<f64> {
        let of = self.outputs.iter().zip(&self.values).filter(|(other, _)| **other == output);
        of.map(|(_, value)| *value).collect()
    }

    /// Whether there are several outputs and all have the same values.
    pub fn stands_still(&self) -> bool {
        let all: Vec<Vec<f64>> =
            self.own_outputs().into_iter().map(|output| self.at_output(output)).collect();
        all.len() > 1 && all.iter().all(|values| *values == all[0])
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
    /// The scene as it is.
    pub own: World,
    pub mapping: &'a Mapping,
    /// Times of the outputs, and of those before them, s.
    pub times: Vec<f64>,
    pub before: Vec<f64>,
    /// Sets of places with the number of their output.
    pub sets: Vec<(usize, Cow<'a, SampledState>)>,
    pub columns: Vec<Column>,
    /// Whether these are only some of the samples.
    pub are_picked: bool,
    /// What the scene's own solution predicts.
    pub exact: Fields,
}

impl<'a> Given<'a> {
    /// The columns of some of the outputs that show something, at most so many samples of each; `None` where the scene has
    /// no solution at these times.
    pub fn of(own: &World, mapping: &'a Mapping, outputs: &[Output<'a>], most: usize) -> Option<Self> {
        let count = outputs.len().min(OUTPUTS);
        let place = |number: usize| number * outputs.len().saturating_sub(1) / count.saturating_sub(1).max(1);
        let spread: Vec<Output<'_>> = (0..count).map(|number| outputs[place(number)]).collect();
        let mut sets = Vec::new();
        for (number, output) in spread.iter().enumerate() {
            sets.push((number, picked(output.state, most)));
            sets.extend(output.state.beside.iter().map(|set| (number, picked(&set.state, most))));
        }
        let mut given = Self {
            own: own.clone(),
            mapping,
            times: spread.iter().map(|output| output.state.time).collect(),
            before: spread.iter().map(|output| output.before).collect(),
            are_picked: sets.iter().any(|(_, set)| matches!(set, Cow::Owned(_))),
            sets,
            columns: Vec::new(),
            exact: Fields::default(),
        };
        given.exact = own.predict(&given, &given.times)?;
        // The names of a slab's components: its height lies along x.
        let [up, along] = if own.is_slab() { ["u_x", "u_y"] } else { ["u_y", "u_x"] };
        let columns = [
            (Field::Pressure, "p"),
            (Field::EffectiveStress, "effective_stress"),
            (Field::Up, up),
            (Field::Along, along),
            (Field::Settlement, "settlement"),
        ];
        given.columns = columns.into_iter().filter_map(|(field, name)| given.column(field, name)).collect();
        let all: Vec<Vec<Scale>> = given.columns.iter().map(|column| scales(column.field, &given)).collect();
        given.columns.iter_mut().zip(all).for_each(|(column, scales)| column.scales = scales);
        Some(given)
    }

    /// A field of all outputs as one column, if it shows something.
    fn column(&self, field: Field, name: &'static str) -> Option<Column> {
        let parameters = &self.own.parameters;
        let scale = if field.is_stress() { parameters.load } else { parameters.final_settlement() };
        let mut column = Column { field, name, scale, ..Column::default() };
        let (mut first, mut rows) = (0, 1);
        for (number, (output, set)) in self.sets.iter().enumerate() {
            let settled = set.surface_displacement.map(|up| -up);
            let (values, heights, from) = match field {
                Field::Pressure => (&set.pressure[..], &set.initial_height[..], first),
                Field::EffectiveStress => (&set.effective_stress[..], &set.initial_height[..], first),
                Field::Up => (&set.displacement[..], &set.initial_height[..], first),
                Field::Along => (&set.horizontal_displacement[..], &set.initial_height[..], first),
                Field::Settlement => (settled.as_slice(), &[0.0][..], number),
            };
            first += set.initial_height.len();
            column.values.extend(values);
            column.at.extend(from..from + values.len());
            column.heights.extend(heights.iter().take(values.len()));
            column.distances.extend(set.initial_distance.iter().take(values.len()));
            column.outputs.extend(values.iter().map(|_| *output));
            if !values.is_empty() {
                rows = rows.max(lines(heights, parameters.height).len());
            }
        }
        let exact = column.exact(&self.exact);
        column.residual = column.own_residual(&exact);
        column.mesh = if field == Field::Settlement { 0.0 } else { MESH / powi((rows.max(2) - 1) as f64, 2) };
        let is_seen = |values: &[f64], share: f64| column.size(values, None) > share * scale;
        (is_seen(&exact, VANISHED) || is_seen(&column.values, SEEN)).then_some(column)
    }

    /// Judges the columns by their residuals in all samples, and leaves out those that others do not have.
    pub fn judge_as(&mut self, whole: &Self) {
        self.columns.retain_mut(|column| {
            let of = whole.columns.iter().find(|other| other.field == column.field);
            (column.residual, column.mesh) = of.map_or((0.0, 0.0), |of| (of.residual, of.mesh));
            of.is_some()
        });
    }

    /// Whether a displacement or a settlement is there, which tells a stiffness from a permeability.
    pub fn moves(&self) -> bool {
        self.columns.iter().any(|column| !column.field.is_stress())
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

/// Some of the samples of a state, spread over all of them without a period: a mistake is in all samples, and every
/// trial evaluates the exact fields again.
fn picked(state: &SampledState, most: usize) -> Cow<'_, SampledState> {
    let all = state.initial_height.len();
    if all <= 2 * most {
        return Cow::Borrowed(state);
    }
    // One of each of as many equal parts, at a place in it that a multiple of the golden ratio gives.
    let place = |part: usize| part * all / most + (part.wrapping_mul(0x9e37_79b9) >> 16) % (all / most);
    let of = |list: &[f64]| (0..most).filter_map(|part| list.get(place(part)).copied()).collect();
    Cow::Owned(SampledState {
        time: state.time,
        initial_distance: of(&state.initial_distance),
        initial_height: of(&state.initial_height),
        pressure: of(&state.pressure),
        effective_stress: of(&state.effective_stress),
        displacement: of(&state.displacement),
        horizontal_displacement: of(&state.horizontal_displacement),
        surface_displacement: state.surface_displacement,
        ..SampledState::default()
    })
}

/// A list without its mean.
pub fn about_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}
