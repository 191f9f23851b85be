//! The exact fields at the places of samples.

use crate::case::Case;
use oedometer_exact::cosine_layer::{LayerFields, LayerState};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::field_values::FieldValues;
use oedometer_exact::manufactured::Manufactured;
use oedometer_exact::reference::Reference;
use oedometer_mpm::run::results::snapshot::{PlaneSamples, Samples, WaterSamples};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Samples from which on several threads take a part of them each.
const MANY_SAMPLES: usize = 50_000;

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
        let all = places.heights.len();
        let mut exact = Self {
            pressure: vec![0.0; all],
            effective_stress: vec![0.0; all],
            displacement: vec![0.0; all],
            horizontal_displacement: vec![0.0; all],
        };
        // A column strains vertically only, a slab between rigid plates evenly across.
        let across = reference.strain_across(time_factor)?;
        for (horizontal, distance) in exact.horizontal_displacement.iter_mut().zip(places.distances) {
            *horizontal = across * distance;
        }
        let threads = if all < MANY_SAMPLES {
            1
        } else {
            std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get)
        };
        let part = all.div_ceil(threads).max(1);
        let parts = (places.heights.chunks(part).zip(exact.pressure.chunks_mut(part)))
            .zip(exact.effective_stress.chunks_mut(part).zip(exact.displacement.chunks_mut(part)));
        std::thread::scope(|scope| {
            let fill = |((heights, pressure), (effective_stress, displacement))| {
                let of_heights = HeightFields { reference, time_factor, height: places.height };
                let into = [pressure, effective_stress, displacement];
                move || of_heights.fill(heights, into)
            };
            // The last part is this thread's own.
            let mut parts: Vec<_> = parts.map(fill).collect();
            let own = parts.pop();
            let others: Vec<_> = parts.into_iter().map(|part| scope.spawn(part)).collect();
            own.map_or(Ok(()), |part| part())?;
            others.into_iter().try_for_each(|part| match part.join() {
                Ok(filled) => filled,
                Err(panic) => std::panic::resume_unwind(panic),
            })
        })?;
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

/// Fields of a reference over the height at a time factor.
#[derive(Clone, Copy)]
struct HeightFields<'a> {
    reference: &'a Reference,
    time_factor: f64,
    /// Height of the column or layer, m.
    height: f64,
}

impl HeightFields<'_> {
    /// Fills in pressure, effective stress and displacement at heights. Where these are in order, equal ones are
    /// neighbours and the last one is all that has to be known.
    fn fill(self, heights: &[f64], into: [&mut [f64]; 3]) -> Result<(), ExactError> {
        let is_in_order = heights.is_sorted();
        let mut last: Option<(u64, FieldValues)> = None;
        let mut known: HashMap<u64, FieldValues> = HashMap::new();
        let [pressure, effective_stress, displacement] = into;
        for (place, height) in heights.iter().enumerate() {
            let key = height.to_bits();
            let fields = match last.filter(|(known, _)| *known == key) {
                Some((_, fields)) => fields,
                None if is_in_order => self.at(*height)?,
                None => match known.entry(key) {
                    Entry::Occupied(found) => *found.get(),
                    Entry::Vacant(new) => *new.insert(self.at(*height)?),
                },
            };
            last = Some((key, fields));
            pressure[place] = fields.pressure;
            effective_stress[place] = fields.effective_stress;
            displacement[place] = fields.displacement;
        }
        Ok(())
    }

    fn at(self, height: f64) -> Result<FieldValues, ExactError> {
        self.reference.fields(self.time_factor, (1.0 - height / self.height).clamp(0.0, 1.0))
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_exact::parameters::ColumnParameters;
    use oedometer_exact::reference::ReferenceKind;

    #[test]
    fn many_samples_in_any_order_have_the_values_of_single_ones_to_the_bit() {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1]).expect("the seed column");
        let rows = MANY_SAMPLES / 50;
        let in_order: Vec<f64> = (0..MANY_SAMPLES + 7)
            .map(|place| (place * rows / (MANY_SAMPLES + 7)) as f64 / rows as f64)
            .collect();
        let mut mixed = in_order.clone();
        mixed.rotate_left(rows / 3);
        mixed.reverse();
        for heights in [&in_order, &mixed, &in_order[..10].to_vec()] {
            let places = SamplePlaces { height: column.height, heights, distances: &[] };
            let exact = ExactFields::of(&reference, 0.1, places).expect("inside");
            for (place, height) in heights.iter().enumerate().step_by(997) {
                let one = reference.fields(0.1, 1.0 - height / column.height).expect("inside");
                let found = [exact.pressure[place], exact.effective_stress[place], exact.displacement[place]];
                assert_eq!(found, [one.pressure, one.effective_stress, one.displacement]);
            }
            assert!(exact.horizontal_displacement.iter().all(|u| *u == 0.0));
        }
        let beyond = SamplePlaces { height: column.height, heights: &in_order, distances: &[] };
        assert!(ExactFields::of(&reference, -0.1, beyond).is_err(), "by every thread");
    }
}
