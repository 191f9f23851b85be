//! The exact column with inertia of both phases.

mod column;
mod growing;
mod modes;
mod quartic;
mod summation;

use std::borrow::Cow;

use crate::consolidation::eigenvalue;
use crate::dynamic_column::column::Steady;
pub use crate::dynamic_column::column::{DynamicColumn, Start};
use crate::dynamic_column::modes::ModeState;
use crate::dynamic_column::summation::{BLOCK, Waves};
use crate::exact_error::{ExactError, checked_depth, checked_time_factor, positive};
use crate::inputs::{COLUMN_KEYS, LAW_KEY, WATER_KEYS, WEIGHT_KEY};
use crate::parameters::ColumnParameters;
use crate::row::{Changes, Row};
use crate::single_mode::PhaseVelocities;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary;

/// Its row under a load.
pub(crate) static DYNAMIC_COLUMN: Row = Row {
    name: "dynamic-column",
    words: "the exact column with inertia",
    inputs: &[COLUMN_KEYS, WATER_KEYS, LAW_KEY, WEIGHT_KEY, &["grain_density", "loading_time"]],
    is_prepared: true,
    changes: Changes::Waves,
    ..Row::COLUMN
};
/// Its row of a mode.
pub(crate) static DYNAMIC_SINGLE_MODE: Row = Row {
    name: "dynamic-single-mode",
    words: "the exact first eigenmode with inertia",
    inputs: &[COLUMN_KEYS, WATER_KEYS, LAW_KEY, &["grain_density"]],
    is_prepared: true,
    changes: Changes::Waves,
    ..Row::COLUMN
};
/// Its row of an undrained wave.
pub(crate) static STANDING_WAVE: Row = Row {
    name: "standing-wave",
    words: "the exact standing wave",
    inputs: &[COLUMN_KEYS, WATER_KEYS, LAW_KEY, &["grain_density"]],
    is_prepared: true,
    changes: Changes::Waves,
    ..Row::COLUMN
};

/// Both phases' fields at one depth and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicFields {
    /// Pressure, effective stress and displacement of the solid.
    pub solid: FieldValues,
    /// Displacement of the water, upward positive, m.
    pub water_displacement: f64,
    /// Velocities of both phases.
    pub velocities: PhaseVelocities,
}

impl DynamicColumn {
    /// The column, with its modes summed in advance at `time_factors`.
    ///
    /// # Errors
    /// When the parameters or the ramp's duration are impossible or a time factor is negative or not finite.
    pub fn new(
        parameters: &ColumnParameters,
        start: Start,
        time_factors: &[f64],
    ) -> Result<Self, ExactError> {
        parameters.validate()?;
        if let Start::Ramp { duration } = start {
            positive("duration of the ramp", duration)?;
        }
        let mut column = Self { parameters: *parameters, start, prepared: Vec::new() };
        column.prepared = time_factors
            .iter()
            .map(|&time_factor| Ok(column.snapshot(checked_time_factor(time_factor)?)))
            .collect::<Result<_, ExactError>>()?;
        Ok(column)
    }

    /// The modes at a time factor: the prepared ones, or summed afresh.
    fn modes_at(&self, time_factor: f64) -> Cow<'_, ModeState> {
        self.prepared
            .iter()
            .find(|snapshot| snapshot.time_factor == time_factor)
            .map_or_else(|| Cow::Owned(self.snapshot(time_factor)), Cow::Borrowed)
    }

    /// All fields of both phases at a relative depth.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    pub fn dynamic_fields(&self, time_factor: f64, zeta: f64) -> Result<DynamicFields, ExactError> {
        let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
        let column = &self.parameters;
        let snapshot = self.modes_at(time_factor);
        let mut state = self.departed_from(column.time(time_factor), zeta)?;
        let coupling = column.soil.coupling_modulus();
        let waves = Waves::at(zeta);
        for (block, amplitudes) in snapshot.amplitudes.chunks(BLOCK).enumerate().rev() {
            let first = block * BLOCK;
            let [sines, cosines] = waves.of_block(first);
            for (place, amplitude) in amplitudes.iter().enumerate().rev() {
                let (m, sine, cosine) = (self.wave_number(first + place), sines[place], cosines[place]);
                state.solid += amplitude.solid * sine;
                state.mixture += amplitude.mixture * sine;
                state.solid_rate += amplitude.solid_rate * sine;
                state.mixture_rate += amplitude.mixture_rate * sine;
                state.solid_strain += amplitude.solid * m * cosine;
                state.pressure -= coupling * amplitude.mixture * m * cosine;
            }
        }
        let mut fields = self.assemble(&state);
        if self.start.is_release() {
            let sine = elementary::sin(eigenvalue(0) * (1.0 - zeta));
            let [solid, water] = self.released().displacement;
            fields.solid.displacement -= solid * sine;
            fields.water_displacement -= water * sine;
        }
        Ok(fields)
    }

    /// The state in closed form that the modes depart from, at a time in s and a relative depth.
    fn departed_from(&self, time: f64, zeta: f64) -> Result<Steady, ExactError> {
        match self.start {
            _ if time == 0.0 => Ok(Steady::default()),
            Start::Mode | Start::StandingWave => Ok(Steady::default()),
            // The whole load is one that has grown over no time.
            Start::Step => self.diffusion(0.0, time, zeta),
            Start::Ramp { duration } => self.diffusion(duration, time, zeta),
        }
    }

    /// Fields of both phases from those of the solid and the mixture.
    fn assemble(&self, state: &Steady) -> DynamicFields {
        let column = &self.parameters;
        let water = |mixture: f64, solid: f64| {
            (mixture - (1.0 - column.soil.porosity) * solid) / column.soil.porosity
        };
        DynamicFields {
            solid: FieldValues {
                pressure: state.pressure,
                effective_stress: column.soil.oedometric_modulus() * state.solid_strain,
                displacement: state.solid,
            },
            water_displacement: water(state.mixture, state.solid),
            velocities: PhaseVelocities {
                solid: state.solid_rate,
                water: water(state.mixture_rate, state.solid_rate),
            },
        }
    }
}

impl Solution for DynamicColumn {
    /// Pressure, effective stress and displacement of the solid at a relative depth.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        Ok(self.dynamic_fields(time_factor, zeta)?.solid)
    }

    /// Settlement of the surface, downward positive, m.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(-self.fields(time_factor, 0.0)?.displacement)
    }

    /// Where waves run the settlement may exceed it or be negative.
    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(match self.start {
            Start::Step | Start::Ramp { .. } => self.parameters.final_settlement(),
            Start::Mode | Start::StandingWave => self.released().displacement[0],
        })
    }

    /// The surface swings about its consolidation.
    fn has_degree(&self) -> bool {
        false
    }

    /// Modes summed and the bound on the others' pressure and effective stress, over the load.
    ///
    /// As long as a wave front is sharp, the bound is the height of its jump: near the front the
    /// sum of the modes rings, whatever their number.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let snapshot = self.modes_at(checked_time_factor(time_factor)?);
        let load = self.parameters.load;
        let phases: f64 = snapshot.amplitudes.iter().map(|amplitude| amplitude.phase_error).sum();
        let terms = snapshot.amplitudes.len();
        // Pressures are the water's stiffness times differences of displacements of the size of the skeleton's.
        let stiffness = self.parameters.soil.coupling_modulus() / self.parameters.soil.oedometric_modulus();
        let phase_bound = 4.0 * (phases / load + f64::EPSILON * stiffness);
        Ok(Accuracy { terms, tail_bound: snapshot.tail / load, phase_bound })
    }
}
