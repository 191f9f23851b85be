//! The exact fields at the places of samples.

use crate::case::{Case, Quantity};
use oedometer_exact::{ExactError, Reference};
use oedometer_problem::snapshot::{PlaneSamples, Samples, WaterSamples};
use rayon::prelude::*;

/// Number of different heights from which on they are evaluated in parallel.
const MANY_HEIGHTS: usize = 5_000;
/// Share of the height that is beside an end.
const BESIDE: f64 = 1e-9;

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
    /// The fields of a reference at places.
    ///
    /// # Errors
    /// When the reference refuses the time factor.
    pub fn of(reference: &Reference, time_factor: f64, places: SamplePlaces<'_>) -> Result<Self, ExactError> {
        let SamplePlaces { height, heights, distances } = places;
        let mut exact = Self::default();
        if let Some(motion) = reference.manufactured().filter(|_| !distances.is_empty()) {
            for (x, y) in distances.iter().zip(heights) {
                let fields = motion.plane_fields(time_factor, [*x, *y])?;
                exact.push(fields.pressure, fields.effective_stress[1][1], fields.displacement);
            }
            return Ok(exact);
        }
        if let Some(layer) = reference.plane_state(time_factor)?.filter(|_| !distances.is_empty()) {
            let amplitudes = ByHeight::of(heights, |y| layer.amplitudes(y.clamp(0.0, height)))?;
            for (x, y) in distances.iter().zip(heights) {
                let fields = amplitudes.at(*y).at(layer.wave_number() * x);
                exact.push(fields.pressure, fields.effective_stress[1], fields.displacement);
            }
            return Ok(exact);
        }
        // A column strains vertically only, a slab between rigid plates evenly across.
        let across = reference.strain_across(time_factor)?;
        let depth = |y: f64| (1.0 - y / height).clamp(0.0, 1.0);
        let fields = ByHeight::of(heights, |y| reference.fields(time_factor, depth(y)))?;
        for (place, y) in heights.iter().enumerate() {
            let fields = fields.at(*y);
            let horizontal = distances.get(place).map_or(0.0, |x| across * x);
            exact.push(fields.pressure, fields.effective_stress, [horizontal, fields.displacement]);
        }
        Ok(exact)
    }

    /// The fields with the value on the other side of the jump at the undrained start, where a result has that one: on a drained
    /// side the whole pressure is as right as none.
    ///
    /// # Errors
    /// When the reference refuses the time factor.
    pub fn on_either_side(
        mut self,
        reference: &Reference,
        time_factor: f64,
        places: SamplePlaces<'_>,
        [pressure, effective_stress]: [&[f64]; 2],
    ) -> Result<Self, ExactError> {
        if time_factor != 0.0 {
            return Ok(self);
        }
        let [low, high] = [BESIDE * places.height, (1.0 - BESIDE) * places.height];
        let heights: Vec<f64> = places.heights.iter().map(|height| height.clamp(low, high)).collect();
        let beside = Self::of(reference, time_factor, SamplePlaces { heights: &heights, ..places })?;
        for (own, beside, computed) in [
            (&mut self.pressure, &beside.pressure, pressure),
            (&mut self.effective_stress, &beside.effective_stress, effective_stress),
        ] {
            for ((own, beside), computed) in own.iter_mut().zip(beside).zip(computed) {
                if (computed - beside).abs() < (computed - *own).abs() {
                    *own = *beside;
                }
            }
        }
        Ok(self)
    }

    fn push(&mut self, pressure: f64, effective_stress: f64, [horizontal, vertical]: [f64; 2]) {
        self.pressure.push(pressure);
        self.effective_stress.push(effective_stress);
        self.horizontal_displacement.push(horizontal);
        self.displacement.push(vertical);
    }

    /// The field of a quantity; a settlement has that of the displacement.
    pub fn field(&self, quantity: Quantity) -> &[f64] {
        match quantity {
            Quantity::Pressure => &self.pressure,
            Quantity::EffectiveStress => &self.effective_stress,
            Quantity::Displacement | Quantity::Settlement | Quantity::LoadFactor => &self.displacement,
        }
    }
}

/// Values at heights, each evaluated once, because a grid of samples has few different heights.
struct ByHeight<T> {
    /// The different heights in rising order.
    heights: Vec<f64>,
    values: Vec<T>,
}

impl<T: Copy + Send> ByHeight<T> {
    /// Evaluates at the different ones of some heights, on all cores where these are many.
    fn of(heights: &[f64], value: impl Fn(f64) -> Result<T, ExactError> + Sync) -> Result<Self, ExactError> {
        let mut heights = heights.to_vec();
        heights.sort_unstable_by(f64::total_cmp);
        heights.dedup_by_key(|height| height.to_bits());
        let values = if heights.len() < MANY_HEIGHTS {
            heights.iter().map(|height| value(*height)).collect::<Result<_, _>>()
        } else {
            heights.par_iter().map(|height| value(*height)).collect()
        };
        Ok(Self { values: values?, heights })
    }

    /// The value at one of the heights.
    fn at(&self, height: f64) -> T {
        self.values[self.heights.partition_point(|known| known.total_cmp(&height).is_lt())]
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
    if case.method.built_in().is_none() {
        let computed = [&samples.pressure[..], &samples.effective_stress];
        exact = exact.on_either_side(reference, time_factor, own, computed)?;
    }
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
    use crate::case::Task;
    use oedometer_exact::parameters::ColumnParameters;
    use oedometer_exact::reference::ReferenceKind;
    use oedometer_scenes::TERZAGHI;
    use oedometer_scenes::column::column_parameters;

    #[test]
    fn many_samples_in_any_order_have_the_values_of_single_ones_to_the_bit() {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1]).expect("the seed column");
        let rows = 2 * MANY_HEIGHTS;
        let in_order: Vec<f64> =
            (0..5 * rows + 7).map(|place| (place * rows / (5 * rows + 7)) as f64 / rows as f64).collect();
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

    #[test]
    fn exact_displacements_are_those_at_their_own_heights() {
        let case = Case::seed(Task::Solve, &TERZAGHI);
        let column = column_parameters(&case.column, &case.material);
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1]).expect("the seed column");
        let at = |height: f64| reference.fields(0.1, 1.0 - height / column.height).expect("inside");
        let samples = |displaced: Option<f64>| Samples {
            initial_height: vec![0.2 * column.height],
            displacement_height: displaced.map(|height| vec![height]),
            ..Samples::default()
        };
        for height in [None, Some(0.9 * column.height)] {
            let exact = exact_samples(&case, &reference, 0.1, &samples(height)).expect("inside");
            assert_eq!(exact.pressure, [at(0.2 * column.height).pressure]);
            assert_eq!(exact.displacement, [at(height.unwrap_or(0.2 * column.height)).displacement]);
        }
    }
}
