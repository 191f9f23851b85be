//! Exact solutions over times and depths.

use crate::api::error::ApiError;
use crate::api::scene_of;
use crate::study::asked::Asked;
use crate::study::overrides::Assignments;
use oedometer_exact::row::Axis;
use oedometer_exact::{Accuracy, ColumnParameters, ExactError, FieldValues, Reference, ReferenceKind};

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
    /// Degree of consolidation by settlement: `[time]`; NaN where it means nothing, as in a sealed element or in waves.
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
) -> Result<ExactValues, ApiError> {
    let (kind, _) = scene_of(solution)?;
    if kind.row().axis == Axis::AlongSlab && (x.is_empty() || !depths.is_empty()) {
        let why = "the fields of `mandel` depend on the distance from its middle: give `x`, from 0 to 1, and no depth";
        return Err(ApiError::Unfit(why.to_owned()));
    }
    let asked = Asked::of_solution(kind, &Assignments { assignments: assignments.to_vec() });
    let Asked { parameters, references, .. } = asked?;
    let reference = Reference::new(references[0], &parameters, time_factors)?;
    let mut values =
        ExactValues { height: parameters.height, load: parameters.load, ..ExactValues::default() };
    for time_factor in time_factors {
        values.time.push(parameters.time(*time_factor));
        values.settlement.push(reference.settlement(*time_factor)?);
        let degree = degree_of(&reference, *time_factor)?;
        values.degree_of_consolidation.push(degree.unwrap_or(f64::NAN));
        values.tail_bound.push(accuracy_of(&reference, *time_factor)?.tail_bound);
        if kind.row().axis == Axis::AlongSlab {
            for distance in x {
                if !(0.0..=1.0).contains(distance) {
                    return Err(ExactError::Distance(*distance).into());
                }
                values.add(reference.fields(*time_factor, 1.0 - distance)?);
            }
            continue;
        }
        let distances = (!x.is_empty()).then_some(x);
        let places = places_of(&reference, &parameters, *time_factor, depths, distances)?;
        let places = places.ok_or_else(|| {
            let name = reference.name();
            ApiError::Unfit(format!("`x` is for layers and `mandel`, and `{name}` depends only on depth"))
        })?;
        for Place { pressure, effective_stress, displacement, .. } in places {
            let (effective_stress, [horizontal, displacement]) = (effective_stress[1], displacement);
            values.add(FieldValues { pressure, effective_stress, displacement });
            values.horizontal_displacement.extend(distances.map(|_| horizontal));
        }
    }
    Ok(values)
}

/// Tail, over the load, above which a half-space does not stand for a column.
pub(crate) const MOST_TAIL: f64 = 1e-2;

/// Tail, over the load, above which a value says nothing.
const WORTHLESS: f64 = 0.1;

/// How far a solution can be trusted at a time.
///
/// # Errors
/// When the time is impossible, a half-space is asked for times at which the base matters, or the bound is not finite.
pub(crate) fn accuracy_of(reference: &Reference, time_factor: f64) -> Result<Accuracy, ExactError> {
    let accuracy = reference.accuracy(time_factor)?;
    let (bound, is_near) = (accuracy.tail_bound, |most: f64| accuracy.tail_bound <= most);
    match reference.kind() {
        ReferenceKind::YieldFront if !is_near(MOST_TAIL) => Err(ExactError::BaseFelt { time_factor, bound }),
        _ if !is_near(WORTHLESS) => Err(ExactError::Inaccurate { time_factor, bound }),
        _ => Ok(accuracy),
    }
}

/// The degree of consolidation by settlement, where it means anything.
///
/// # Errors
/// When the time is impossible.
pub(crate) fn degree_of(reference: &Reference, time_factor: f64) -> Result<Option<f64>, ExactError> {
    reference.has_degree().then(|| reference.degree_of_consolidation(time_factor)).transpose()
}

impl ExactValues {
    fn add(&mut self, fields: FieldValues) {
        self.pressure.push(fields.pressure);
        self.effective_stress.push(fields.effective_stress);
        self.displacement.push(fields.displacement);
    }
}

/// The fields of a solution at one place.
pub(crate) struct Place {
    /// Depth over the height.
    pub zeta: f64,
    /// Distance over the length, in a plane.
    pub x: Option<f64>,
    /// Pa.
    pub pressure: f64,
    /// Components xx, yy and xy, Pa; of a column yy alone.
    pub effective_stress: [f64; 3],
    /// Along x and upward, m.
    pub displacement: [f64; 2],
}

/// The fields at depths, and there at every distance where some are given; `None` where the solution has no such plane.
///
/// # Errors
/// When the solution refuses a place.
pub(crate) fn places_of(
    reference: &Reference,
    parameters: &ColumnParameters,
    time_factor: f64,
    depths: &[f64],
    distances: Option<&[f64]>,
) -> Result<Option<Vec<Place>>, ExactError> {
    let mut places = Vec::new();
    let layer = distances.map(|_| reference.plane_state(time_factor)).transpose()?.flatten();
    for &zeta in depths {
        let Some(distances) = distances else {
            let FieldValues { pressure, effective_stress, displacement } =
                reference.fields(time_factor, zeta)?;
            let (effective_stress, displacement) = ([0.0, effective_stress, 0.0], [0.0, displacement]);
            places.push(Place { zeta, x: None, pressure, effective_stress, displacement });
            continue;
        };
        for &distance in distances {
            let (pressure, displacement, effective_stress) = if let Some(layer) = &layer {
                let at = layer.fields(distance * parameters.length, (1.0 - zeta) * parameters.height)?;
                let [xx, yy, _, xy] = at.effective_stress;
                (at.pressure, at.displacement, [xx, yy, xy])
            } else if let Some(motion) = reference.manufactured() {
                let at = motion.plane_fields(time_factor, [distance, 1.0 - zeta])?;
                let [[xx, xy], [_, yy]] = at.effective_stress;
                (at.pressure, at.displacement, [xx, yy, xy])
            } else {
                return Ok(None);
            };
            places.push(Place { zeta, x: Some(distance), pressure, effective_stress, displacement });
        }
    }
    Ok(Some(places))
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

    #[test]
    fn places_of_a_layer_have_their_cosine_and_the_middle_of_a_slab_its_largest_pressure() {
        let set = ["layer.length=3.0", "layer.height=2.0"].map(str::to_owned);
        let (depths, x) = ([0.3, 0.8], [0.0, 0.25, 1.0]);
        let found = exact("cosine-layer", &[0.1], &depths, &x, &set).expect("inside");
        let crest = exact("cosine-layer", &[0.1], &depths, &[], &set).expect("inside");
        for (depth, at) in [(0, 0), (1, 3)] {
            for (place, cosine) in [(0, 1.0), (1, std::f64::consts::FRAC_1_SQRT_2), (2, -1.0)] {
                for (all, under) in [
                    (&found.pressure, &crest.pressure),
                    (&found.effective_stress, &crest.effective_stress),
                    (&found.displacement, &crest.displacement),
                ] {
                    let (value, wanted) = (all[at + place], cosine * under[depth]);
                    assert!(
                        (value - wanted).abs() < 1e-9 * wanted.abs(),
                        "{depth} {place}: {value} {wanted}"
                    );
                }
            }
            let along = &found.horizontal_displacement[at..at + 3];
            assert!(along[1].abs() > 1e6 * along[0].abs().max(along[2].abs()), "{along:?}");
        }
        assert!(crest.horizontal_displacement.is_empty());
        let slab = exact("mandel", &[0.1], &[], &[0.0, 0.5, 1.0], &[]).expect("inside").pressure;
        assert!(slab[0] > slab[1] && slab[1] > 0.0 && slab[2].abs() < 1e-9 * slab[0], "{slab:?}");
        for (solution, depths, x, told) in [
            ("mandel", &[][..], &[][..], "give `x`"),
            ("mandel", &[0.5], &[0.5], "give `x`"),
            ("mandel", &[], &[1.5], "1.5"),
            ("mandel", &[], &[-0.5], "-0.5"),
            ("terzaghi", &[0.5], &[0.5], "depends only on depth"),
            ("terzagi", &[0.5], &[], "there is no exact solution `terzagi`"),
        ] {
            let error = exact(solution, &[0.1], depths, x, &[]).expect_err(solution).to_string();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn the_column_of_the_textbooks_is_what_a_hand_computes() {
        let set = ["column.height=2.0", "column.load=40.0"].map(str::to_owned);
        let found = exact("terzaghi-incompressible", &[0.0, 0.01], &[0.5, 1.0], &[], &set).expect("inside");
        assert_eq!((found.height, found.load), (2.0, 40.0));
        // c_v = 1e-4 · 1.2e6/9810 m²/s, T_v = 0.01; early a half space, U = 2√(T_v/π), s = U q H/E_oed.
        let seconds = 0.01 * 4.0 * 9810.0 / 120.0;
        assert!(found.time[0] == 0.0 && (found.time[1] / seconds - 1.0).abs() < 1e-12, "{:?}", found.time);
        let degree = 2.0 * (0.01 / std::f64::consts::PI).sqrt();
        assert!((found.degree_of_consolidation[1] / degree - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.settlement[1] / (degree * 80.0 / 1.2e6) - 1.0).abs() < 1e-9, "{found:?}");
        // The load is still in the water, in the middle but for erfc(2.5) of it.
        let at = |values: &[f64], wanted: [f64; 4], near: f64| {
            assert!(
                values.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < near),
                "{values:?}"
            );
        };
        let erfc = 40.0 * 4.069_52e-4;
        at(&found.pressure, [40.0, 40.0, 40.0 - erfc, 40.0], 1e-4);
        at(&found.effective_stress, [0.0, 0.0, -erfc, 0.0], 1e-4);
        assert_eq!(found.horizontal_displacement, [0.0; 0]);
    }
}
