//! Exact solutions over times and depths.

use crate::api::scene_of;
use crate::study::overrides::{Asked, Assignments};
use oedometer_exact::{ColumnParameters, ExactError, FieldValues, Reference, ReferenceKind};

/// An exact solution at times and depths, in SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExactValues {
    /// Time, s: `[time]`.
    pub time: Vec<f64>,
    /// Excess pore pressure, compression positive, Pa: `[time][depth]`.
    pub pressure: Vec<f64>,
    /// Vertical effective stress, tension positive, Pa: `[time][depth]`.
    pub effective_stress: Vec<f64>,
    /// Displacement, upward positive, m: `[time][depth]`.
    pub displacement: Vec<f64>,
    /// Displacement along the layer, m: `[time][depth][distance]`; empty where no distances are given.
    pub horizontal_displacement: Vec<f64>,
    /// Settlement of the surface, downward positive, m: `[time]`.
    pub settlement: Vec<f64>,
    /// Degree of consolidation by settlement: `[time]`.
    pub degree_of_consolidation: Vec<f64>,
    /// Bound on the truncation error of the pressure over the load: `[time]`.
    pub tail_bound: Vec<f64>,
    /// Height, m.
    pub height: f64,
    /// Load, Pa.
    pub load: f64,
}

/// Evaluates a solution at time factors and at depths over the height, 0 at the surface. Distances `x` from the crest of a
/// layer's load, over its length, add an index behind the depth; without them the fields are those under the crest. Of
/// `mandel` the fields depend on the distance from its middle alone: give it, and no depths. `assignments` are those of
/// `--set`.
///
/// ```
/// let found = oedometer::api::exact::exact("terzaghi", &[0.1], &[0.5, 1.0], &[], &[]).expect("inside its range");
/// assert_eq!(found.pressure.len(), 2);
/// assert!(found.pressure[0] < found.pressure[1]);
/// ```
///
/// # Errors
/// When the solution does not exist or refuses its inputs.
pub fn exact(
    solution: &str,
    time_factors: &[f64],
    depths: &[f64],
    x: &[f64],
    assignments: &[String],
) -> Result<ExactValues, String> {
    let (kind, _) = scene_of(solution)?;
    if kind == ReferenceKind::Mandel && (x.is_empty() || !depths.is_empty()) {
        return Err("the fields of `mandel` depend on the distance from its middle: give `x`, from 0 to 1, and no depth"
            .to_owned());
    }
    let asked = Asked::of_solution(kind, &Assignments { assignments: assignments.to_vec() });
    let Asked { parameters, references, .. } = asked.map_err(|error| error.to_string())?;
    let told = |error: ExactError| error.to_string();
    let reference = Reference::new(references[0], &parameters, time_factors).map_err(told)?;
    let mut values =
        ExactValues { height: parameters.height, load: parameters.load, ..ExactValues::default() };
    for time_factor in time_factors {
        values.time.push(parameters.time(*time_factor));
        values.settlement.push(reference.settlement(*time_factor).map_err(told)?);
        values.degree_of_consolidation.push(reference.degree_of_consolidation(*time_factor).map_err(told)?);
        values.tail_bound.push(reference.accuracy(*time_factor).map_err(told)?.tail_bound);
        if kind == ReferenceKind::Mandel {
            for distance in x {
                if !(0.0..=1.0).contains(distance) {
                    return Err(told(ExactError::Distance(*distance)));
                }
                values.add(reference.fields(*time_factor, 1.0 - distance).map_err(told)?);
            }
        } else if x.is_empty() {
            for depth in depths {
                values.add(reference.fields(*time_factor, *depth).map_err(told)?);
            }
        } else {
            values.add_plane(&reference, &parameters, *time_factor, depths, x)?;
        }
    }
    Ok(values)
}

impl ExactValues {
    fn add(&mut self, fields: FieldValues) {
        self.pressure.push(fields.pressure);
        self.effective_stress.push(fields.effective_stress);
        self.displacement.push(fields.displacement);
    }

    /// Adds the fields of a plane problem at every depth and distance.
    fn add_plane(
        &mut self,
        reference: &Reference,
        parameters: &ColumnParameters,
        time_factor: f64,
        depths: &[f64],
        x: &[f64],
    ) -> Result<(), String> {
        let told = |error: ExactError| error.to_string();
        let layer = reference.plane_state(time_factor).map_err(told)?;
        for (depth, distance) in
            depths.iter().flat_map(|depth| x.iter().map(move |distance| (depth, distance)))
        {
            let (pressure, effective_stress, [horizontal, vertical]) = if let Some(layer) = &layer {
                let height = (1.0 - depth) * parameters.height;
                let at = layer.fields(distance * parameters.length, height).map_err(told)?;
                (at.pressure, at.effective_stress[1], at.displacement)
            } else if let Some(motion) = reference.manufactured() {
                let at = motion.plane_fields(time_factor, [*distance, 1.0 - depth]).map_err(told)?;
                (at.pressure, at.effective_stress[1][1], at.displacement)
            } else {
                return Err(format!(
                    "`x` is for layers and `mandel`, and `{}` depends on the depth alone",
                    reference.name()
                ));
            };
            self.add(FieldValues { pressure, effective_stress, displacement: vertical });
            self.horizontal_displacement.push(horizontal);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_a_time_is_that_of_its_time() {
        let times = [0.05, 0.2, 1.0];
        let all = exact("terzaghi", &times, &[0.5], &[], &[]).expect("inside");
        for (place, time) in times.into_iter().enumerate() {
            let one = exact("terzaghi", &[time], &[0.5], &[], &[]).expect("inside");
            let lists = |found: &ExactValues| {
                [
                    &found.time,
                    &found.pressure,
                    &found.effective_stress,
                    &found.displacement,
                    &found.settlement,
                    &found.degree_of_consolidation,
                ]
                .map(Clone::clone)
            };
            for (all, one) in lists(&all).iter().zip(lists(&one)) {
                assert!((all[place] / one[0] - 1.0).abs() < 1e-9, "{time}: {all:?} {one:?}");
            }
        }
    }
}
