//! The exact fields at the places of somebody else's samples.

use crate::exact::cosine_layer::{LayerFields, LayerState};
use crate::exact::error::ExactError;
use crate::exact::parameters::ColumnParameters;
use crate::exact::reference::{FieldValues, Reference};
use crate::import::table::SampledState;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Exact fields, a value a sample; SI, signs as in [`SampledState`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExactFields {
    /// Pore pressure, Pa.
    pub pressure: Vec<f64>,
    /// Vertical effective stress, Pa.
    pub effective_stress: Vec<f64>,
    /// Vertical displacement, m.
    pub displacement: Vec<f64>,
    /// Horizontal displacement, m.
    pub horizontal_displacement: Vec<f64>,
}

impl ExactFields {
    /// The fields of a reference at the places of a state: one evaluation a height, for a grid of
    /// samples has few.
    ///
    /// # Errors
    /// When the reference refuses the time factor.
    pub fn of(
        reference: &Reference,
        parameters: &ColumnParameters,
        time_factor: f64,
        state: &SampledState,
    ) -> Result<Self, ExactError> {
        match reference.plane_state(time_factor)? {
            Some(layer) => Self::along_layer(&layer, parameters, state),
            None => Self::over_height(reference, parameters, time_factor, state),
        }
    }

    fn over_height(
        reference: &Reference,
        parameters: &ColumnParameters,
        time_factor: f64,
        state: &SampledState,
    ) -> Result<Self, ExactError> {
        let mut known: HashMap<u64, FieldValues> = HashMap::new();
        let mut exact = Self::default();
        for height in &state.initial_height {
            let fields = match known.entry(height.to_bits()) {
                Entry::Occupied(found) => *found.get(),
                Entry::Vacant(new) => {
                    let depth = (1.0 - height / parameters.height).clamp(0.0, 1.0);
                    *new.insert(reference.fields(time_factor, depth)?)
                }
            };
            exact.pressure.push(fields.pressure);
            exact.effective_stress.push(fields.effective_stress);
            exact.displacement.push(fields.displacement);
            // A column strains vertically only.
            exact.horizontal_displacement.push(0.0);
        }
        Ok(exact)
    }

    fn along_layer(
        layer: &LayerState,
        parameters: &ColumnParameters,
        state: &SampledState,
    ) -> Result<Self, ExactError> {
        let mut known: HashMap<u64, LayerFields> = HashMap::new();
        let mut exact = Self::default();
        for (distance, height) in state.initial_distance.iter().zip(&state.initial_height) {
            let amplitudes = match known.entry(height.to_bits()) {
                Entry::Occupied(found) => *found.get(),
                Entry::Vacant(new) => *new.insert(layer.amplitudes(height.clamp(0.0, parameters.height))?),
            };
            let fields = amplitudes.at(layer.wave_number() * distance);
            exact.pressure.push(fields.pressure);
            exact.effective_stress.push(fields.effective_stress[1]);
            let [horizontal, vertical] = fields.displacement;
            exact.displacement.push(vertical);
            exact.horizontal_displacement.push(horizontal);
        }
        Ok(exact)
    }
}
