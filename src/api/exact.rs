//! Exact solutions over times and depths.

use crate::api::scene_of;
use crate::study::asked::Asked;
use crate::study::overrides::Assignments;
use oedometer_exact::reference::{Reference, ReferenceKind};

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

/// Evaluates a solution at time factors and at depths over the height, 0 at the surface; for a layer under the crest of
/// its load. `assignments` are those of `--set`.
///
/// ```
/// let found = oedometer::api::exact::exact("terzaghi", &[0.1], &[0.5, 1.0], &[]).expect("inside its range");
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
    assignments: &[String],
) -> Result<ExactValues, String> {
    let (kind, _) = scene_of(solution)?;
    if kind == ReferenceKind::Mandel {
        return Err(
            "the fields of `mandel` depend on the distance from the middle and not on a depth: use `oedometer exact mandel \
             --x LIST`"
                .to_owned(),
        );
    }
    let asked = Asked::of_solution(kind, &Assignments { assignments: assignments.to_vec() });
    let Asked { parameters, references, .. } = asked.map_err(|error| error.to_string())?;
    let told = |error: oedometer_exact::exact_error::ExactError| error.to_string();
    let reference = Reference::new(references[0], &parameters, time_factors).map_err(told)?;
    let mut values =
        ExactValues { height: parameters.height, load: parameters.load, ..ExactValues::default() };
    for time_factor in time_factors {
        values.time.push(parameters.time(*time_factor));
        values.settlement.push(reference.settlement(*time_factor).map_err(told)?);
        values.degree_of_consolidation.push(reference.degree_of_consolidation(*time_factor).map_err(told)?);
        values.tail_bound.push(reference.accuracy(*time_factor).map_err(told)?.tail_bound);
        for depth in depths {
            let fields = reference.fields(*time_factor, *depth).map_err(told)?;
            values.pressure.push(fields.pressure);
            values.effective_stress.push(fields.effective_stress);
            values.displacement.push(fields.displacement);
        }
    }
    Ok(values)
}
