//! A result as columns of numbers with the places and times at which they stand.

use super::world::Predicted;
use crate::import::SampledState;
use crate::import::mapping::Mapping;
use oedometer_exact::{ColumnParameters, Reference, ReferenceKind};
use oedometer_soil::elementary::powi;
use std::borrow::Cow;

/// Number of states that are examined, spread over all of them.
const STATES: usize = 12;
/// Share of a part by which the place of a sample in it advances from one part to the next, of 2³².
const GOLDEN_RATIO: u32 = 0x9e37_79b9;
/// Sizes up to this share of the load, or of the final settlement, are small.
const SMALL: f64 = 0.01;
/// Sizes below this share of what the load brings about are round-off and show nothing.
const VANISHED: f64 = 1e-6;

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

/// A column: its values at all samples of all states that have it, one after the other.
pub struct Column {
    pub field: Field,
    /// Its name for the user.
    pub name: &'static str,
    /// What a value of 1 stands for: the load, or the final settlement.
    pub scale: f64,
    pub computed: Vec<f64>,
    /// Where its values stand in a [`Predicted`].
    pub at: Vec<usize>,
    /// Initial height of each value, m.
    pub heights: Vec<f64>,
    /// Initial distance of each value along a layer, m; empty in a column.
    pub distances: Vec<f64>,
    pub weights: Vec<f64>,
    /// Number of the state of each value.
    pub states: Vec<usize>,
    /// Root mean square of what the scene's own exact solution has there.
    pub exact_size: f64,
    /// Whether it is wrong by itself, so that no world need explain it.
    pub is_left_out: bool,
}

impl Column {
    /// Root of the weighted mean square of a list of this column's length.
    pub fn size(&self, values: impl Iterator<Item = f64>) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (value, weight) in values.zip(&self.weights) {
            sum += weight * powi(value / self.scale, 2);
            weights += weight;
        }
        (sum / weights).sqrt() * self.scale
    }

    /// The values that a prediction has for this column.
    pub fn exact<'a>(&'a self, predicted: &'a Predicted) -> impl Iterator<Item = f64> + 'a {
        let field = predicted.field(self.field);
        self.at.iter().map(|place| field.get(*place).copied().unwrap_or(f64::NAN))
    }

    /// The error of the values as they are against exact ones, relative to the larger of both; what is small against the
    /// load, or the final settlement, counts by these.
    pub fn misfit_as_given(&self, exact: &[f64]) -> f64 {
        let size = self.size(exact.iter().copied()).max(self.size(self.computed.iter().copied()));
        let off = self.computed.iter().zip(exact).map(|(value, exact)| value - exact);
        self.size(off) / size.max(SMALL * self.scale)
    }

    /// The error that is left of corrected values against exact ones, relative to the larger of both; infinite where there
    /// is nothing exact to compare with.
    pub fn misfit(&self, exact: &[f64], corrected: impl Fn(usize, f64) -> f64) -> f64 {
        let all = || self.computed.iter().enumerate().map(|(place, value)| corrected(place, *value));
        let exact_size = self.size(exact.iter().copied());
        if exact_size.is_nan() || exact_size <= VANISHED * self.scale {
            return f64::INFINITY;
        }
        let off = all().zip(exact).map(|(value, exact)| value - exact);
        self.size(off) / exact_size.max(self.size(all()))
    }

    /// Whether all values are 0.
    pub fn is_zero(&self) -> bool {
        self.computed.iter().all(|value| *value == 0.0)
    }

    /// Whether neither the result nor the scene has anything to show here.
    pub fn shows_nothing(&self) -> bool {
        let is_seen = || self.size(self.computed.iter().copied()) > SMALL * self.scale;
        self.is_left_out || (self.exact_size < VANISHED * self.scale && !is_seen())
    }
}

/// A result with the scene that it is held against.
pub struct Given<'a> {
    pub parameters: &'a ColumnParameters,
    pub kind: ReferenceKind,
    pub mapping: &'a Mapping,
    pub states: Vec<Cow<'a, SampledState>>,
    pub columns: Vec<Column>,
    /// Whether these are only some of the samples.
    pub are_picked: bool,
    /// Whether stresses and displacements agree on one factor, which is the load's then.
    pub has_common_factor: bool,
    /// The scene's own solution, for worlds of the same body.
    pub solution: Option<Reference>,
}

impl<'a> Given<'a> {
    /// The columns of some of the samples, at most so many of a state.
    pub fn of(
        parameters: &'a ColumnParameters,
        kind: ReferenceKind,
        states: &'a [SampledState],
        mapping: &'a Mapping,
        most: usize,
    ) -> Self {
        let states: Vec<Cow<'_, SampledState>> =
            spread(states).into_iter().map(|state| picked(state, most)).collect();
        let are_picked = states.iter().any(|state| matches!(state, Cow::Owned(_)));
        let (load, settled) = (parameters.load, parameters.final_settlement());
        // The names of a slab's components: its height lies along x.
        let [up, along] = if kind == ReferenceKind::Mandel { ["u_x", "u_y"] } else { ["u_y", "u_x"] };
        let columns = [
            (Field::Pressure, "p", load),
            (Field::EffectiveStress, "effective_stress", load),
            (Field::Up, up, settled),
            (Field::Along, along, settled),
            (Field::Settlement, "settlement", settled),
        ];
        let columns = columns.into_iter().map(|(field, name, scale)| column(&states, field, name, scale));
        let columns = columns.filter(|column| !column.computed.is_empty()).collect();
        Self {
            parameters,
            kind,
            mapping,
            states,
            columns,
            are_picked,
            has_common_factor: false,
            solution: None,
        }
    }

    /// Keeps what shows something, with the size of the scene's own solution.
    pub fn hold_against(&mut self, own: &Predicted) {
        for column in &mut self.columns {
            column.exact_size = column.size(column.exact(own));
        }
    }

    /// Whether the fields depend on the place along a layer.
    pub fn kind_is_plane(&self) -> bool {
        matches!(self.kind, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible)
    }

    /// Whether a displacement or a settlement is there, which tells a stiffness from a permeability.
    pub fn moves(&self) -> bool {
        self.columns.iter().any(|column| !column.field.is_stress() && !column.shows_nothing())
    }

    /// Whether one column alone shows something.
    pub fn is_one_column(&self) -> bool {
        self.columns.iter().filter(|column| !column.shows_nothing()).count() == 1
    }

    /// Whether a pressure is there.
    pub fn has_pressure(&self) -> bool {
        self.columns.iter().any(|column| column.field == Field::Pressure && !column.shows_nothing())
    }

    /// Whether a stress is there.
    pub fn is_stressed(&self) -> bool {
        self.columns.iter().any(|column| column.field.is_stress() && !column.shows_nothing())
    }
}

/// A field of all states as one column.
fn column(states: &[Cow<'_, SampledState>], field: Field, name: &'static str, scale: f64) -> Column {
    let mut column = Column {
        field,
        name,
        scale,
        computed: Vec::new(),
        at: Vec::new(),
        heights: Vec::new(),
        distances: Vec::new(),
        weights: Vec::new(),
        states: Vec::new(),
        exact_size: 0.0,
        is_left_out: false,
    };
    let mut first = 0;
    for (number, state) in states.iter().enumerate() {
        let count = state.initial_height.len();
        if field == Field::Settlement {
            if let Some(up) = state.surface_displacement {
                column.computed.push(-up);
                column.at.push(number);
                column.weights.push(1.0);
                column.heights.push(0.0);
                column.states.push(number);
            }
            continue;
        }
        let values = match field {
            Field::Pressure => &state.pressure,
            Field::EffectiveStress => &state.effective_stress,
            Field::Up => &state.displacement,
            _ => &state.horizontal_displacement,
        };
        if values.len() == count && count > 0 {
            column.computed.extend(values);
            column.at.extend(first..first + count);
            column.heights.extend(&state.initial_height);
            column.distances.extend(&state.initial_distance);
            column.weights.extend(&state.volume);
            column.states.extend(std::iter::repeat_n(number, count));
        }
        first += count;
    }
    column
}

/// Some of the states, from the first to the last.
fn spread(states: &[SampledState]) -> Vec<&SampledState> {
    let count = states.len().min(STATES);
    let last = states.len().saturating_sub(1);
    (0..count).filter_map(|place| states.get(place * last / count.saturating_sub(1).max(1))).collect()
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
    Cow::Owned(samples_at(state, &(0..most).filter_map(place).collect::<Vec<_>>()))
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
