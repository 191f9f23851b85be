//! The exact fields at the places of samples.

use crate::case::Case;
use crate::exact::cosine_layer::{LayerFields, LayerState};
use crate::exact::exact_error::ExactError;
use crate::exact::field_values::FieldValues;
use crate::exact::manufactured::Manufactured;
use crate::exact::reference::{Reference, ReferenceKind};
use crate::mpm::run::snapshot::{PlaneSamples, Samples, WaterSamples};
use crate::scene::column::column_parameters;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Exact fields, `[sample]`; SI, signs as in [`Samples`].
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

/// Places over the height and along a layer.
#[derive(Clone, Copy, Debug)]
pub struct SamplePlaces<'a> {
    /// Height of the column or layer, m.
    pub height: f64,
    /// Initial height of each sample, m.
    pub heights: &'a [f64],
    /// Initial distance of each sample along a layer, m; empty in a column.
    pub distances: &'a [f64],
}

impl ExactFields {
    /// The fields of a reference at places: one evaluation per height, for a grid of samples has few.
    ///
    /// # Errors
    /// When the reference refuses the time factor.
    pub fn of(reference: &Reference, time_factor: f64, places: SamplePlaces<'_>) -> Result<Self, ExactError> {
        if let Some(motion) = reference.manufactured().filter(|_| !places.distances.is_empty()) {
            return Self::of_motion(motion, time_factor, places);
        }
        match reference.plane_state(time_factor)? {
            Some(layer) if !places.distances.is_empty() => Self::along_layer(&layer, places),
            _ => Self::over_height(reference, time_factor, places),
        }
    }

    fn over_height(
        reference: &Reference,
        time_factor: f64,
        places: SamplePlaces<'_>,
    ) -> Result<Self, ExactError> {
        let mut known: HashMap<u64, FieldValues> = HashMap::new();
        let mut exact = Self::default();
        // A column strains vertically only, a slab between rigid plates evenly across.
        let across = reference.strain_across(time_factor)?;
        exact.horizontal_displacement.extend(places.distances.iter().map(|distance| across * distance));
        exact.horizontal_displacement.resize(places.heights.len(), 0.0);
        for height in places.heights {
            let fields = match known.entry(height.to_bits()) {
                Entry::Occupied(found) => *found.get(),
                Entry::Vacant(new) => {
                    let depth = (1.0 - height / places.height).clamp(0.0, 1.0);
                    *new.insert(reference.fields(time_factor, depth)?)
                }
            };
            exact.pressure.push(fields.pressure);
            exact.effective_stress.push(fields.effective_stress);
            exact.displacement.push(fields.displacement);
        }
        Ok(exact)
    }

    fn of_motion(
        motion: &Manufactured,
        time_factor: f64,
        places: SamplePlaces<'_>,
    ) -> Result<Self, ExactError> {
        let mut exact = Self::default();
        for (distance, height) in places.distances.iter().zip(places.heights) {
            let fields = motion.plane_fields(time_factor, [*distance, *height])?;
            exact.pressure.push(fields.pressure);
            exact.effective_stress.push(fields.effective_stress[1][1]);
            exact.horizontal_displacement.push(fields.displacement[0]);
            exact.displacement.push(fields.displacement[1]);
        }
        Ok(exact)
    }

    fn along_layer(layer: &LayerState, places: SamplePlaces<'_>) -> Result<Self, ExactError> {
        let mut known: HashMap<u64, LayerFields> = HashMap::new();
        let mut exact = Self::default();
        for (distance, height) in places.distances.iter().zip(places.heights) {
            let amplitudes = match known.entry(height.to_bits()) {
                Entry::Occupied(found) => *found.get(),
                Entry::Vacant(new) => *new.insert(layer.amplitudes(height.clamp(0.0, places.height))?),
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

/// A reference for the column and soil of a case, prepared for time factors.
///
/// # Errors
/// When it refuses them.
pub fn reference_of(case: &Case, kind: ReferenceKind, times: &[f64]) -> Result<Reference, ExactError> {
    Reference::new(kind, &column_parameters(&case.column, &case.material), times)
}

/// The exact fields at the Lagrangian places of a run's samples.
///
/// # Errors
/// When the reference refuses the time factor.
pub fn exact_samples(
    case: &Case,
    reference: &Reference,
    time_factor: f64,
    samples: &Samples,
) -> Result<Samples, ExactError> {
    let plane = samples.plane.as_ref();
    let own = SamplePlaces {
        height: case.column.height,
        heights: &samples.initial_height,
        distances: plane.map_or(&[], |plane| &plane.initial_distance),
    };
    let mut exact = ExactFields::of(reference, time_factor, own)?;
    let heights = samples.displacement_height.as_deref();
    let distances = plane.and_then(|plane| plane.displacement_distance.as_deref());
    if heights.is_some() || distances.is_some() {
        let displaced = SamplePlaces {
            heights: heights.unwrap_or(own.heights),
            distances: distances.unwrap_or(own.distances),
            ..own
        };
        let there = ExactFields::of(reference, time_factor, displaced)?;
        exact.displacement = there.displacement;
        exact.horizontal_displacement = there.horizontal_displacement;
    }
    let water = samples.water.as_ref().map(|water| -> Result<WaterSamples, ExactError> {
        let distances = water.initial_distance.as_deref().unwrap_or(&[]);
        let there = SamplePlaces { heights: &water.initial_height, distances, ..own };
        let pressure = ExactFields::of(reference, time_factor, there)?.pressure;
        Ok(WaterSamples { pressure, ..water.clone() })
    });
    Ok(Samples {
        water: water.transpose()?,
        initial_height: samples.initial_height.clone(),
        pressure: exact.pressure,
        effective_stress: exact.effective_stress,
        displacement: exact.displacement,
        plane: plane.map(|plane| PlaneSamples {
            horizontal_displacement: exact.horizontal_displacement,
            ..plane.clone()
        }),
        ..Samples::default()
    })
}
