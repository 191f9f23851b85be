//! The exact solutions as golden values, with the bounds that they give on their own errors: a fault
//! in one shows at its own numbers, and not only in the errors of those scenes that happen to use it.

use crate::golden::GoldenFile;
use crate::golden::tolerance::spread_by_group;
use crate::study::perturbed::LastDigit;
use oedometer_exact::cosine_layer::CosineLayer;
use oedometer_exact::dynamic_column::{DynamicColumn, Start};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::large_strain::diffusion::Water;
use oedometer_exact::parameters::Base;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_exact::xie_leo::{Drainage, XieLeo};
use oedometer_soil::elementary;
use std::collections::BTreeMap;

/// Name under which their golden values are kept.
pub const REFERENCES: &str = "references";

/// Time factors: before and after the front reaches the base, and on both sides of the switch
/// between images and modes.
const TIME_FACTORS: [f64; 5] = [0.0, 0.02, 0.19, 0.21, 1.0];
/// Depths.
const DEPTHS: [f64; 3] = [0.1, 0.5, 1.0];
/// Load that strains the seed column by a sixth, Pa.
const LARGE_LOAD: f64 = 2e5;
/// Water so soft that its storage shows, Pa.
const SOFT_WATER: f64 = 2e7;

/// Time factor to which a load grows: waves are still running then, and a front is under way.
const LOADED_AT: f64 = 1e-3;
/// Time factors under a load that grows: within its time, and after it.
const TIMES_OF_GROWTH: [f64; 3] = [2e-4, 1e-3, 5e-3];
/// Bounds of nothing at all count as this.
const LEAST_BOUND: f64 = 1e-300;

impl GoldenFile {
    /// The present values of the exact solutions as golden, for a reason.
    ///
    /// # Errors
    /// When a solution refuses its column: a fault of this program.
    pub fn of_references(reason: &str) -> Result<Self, ExactError> {
        let values = reference_values()?;
        let spread = spread_by_group(&values, &perturbed_reference_values()?);
        let golden = Self { seconds: None, values, ..Self::of(REFERENCES, &[], reason) };
        Ok(golden.widened_by(spread))
    }
}

/// Pressures, stresses, displacements and degrees of every solution on a few places and times, and the
/// bounds on what their sums leave out.
///
/// # Errors
/// When a solution refuses the column: a fault of this program.
pub fn reference_values() -> Result<BTreeMap<String, f64>, ExactError> {
    values_of_column(&ColumnParameters::default())
}

/// The same with the last digit of one input after the other changed: what they move by is round-off.
///
/// # Errors
/// When a solution refuses the column: a fault of this program.
pub fn perturbed_reference_values() -> Result<Vec<BTreeMap<String, f64>>, ExactError> {
    let perturbed = LastDigit::ALL.map(|digit| {
        let mut column = ColumnParameters::default();
        digit.change(&mut column.youngs_modulus, &mut column.hydraulic_conductivity);
        values_of_column(&column)
    });
    perturbed.into_iter().collect()
}

fn values_of_column(seed: &ColumnParameters) -> Result<BTreeMap<String, f64>, ExactError> {
    let mut values = BTreeMap::new();
    let seed = *seed;
    let soft = ColumnParameters { load: LARGE_LOAD, water_bulk_modulus: SOFT_WATER, ..seed };
    // Motions that were chosen have no column; their balances hold them in the tests.
    for kind in ReferenceKind::ALL.into_iter().filter(|kind| !kind.is_manufactured()) {
        for (column, parameters) in [("seed column", seed), ("soft water, 200 kPa", soft)] {
            let reference = Reference::new(kind, &parameters, &TIME_FACTORS)?;
            note_solution(&mut values, &format!("{kind} {column}"), &reference, &parameters, &TIME_FACTORS)?;
        }
    }
    for kind in ReferenceKind::ALL {
        let parameters = ColumnParameters { loading_time: seed.time(LOADED_AT), ..soft };
        if matches!(kind, ReferenceKind::DynamicColumn | ReferenceKind::LargeStrain(_)) {
            let reference = Reference::new(kind, &parameters, &TIMES_OF_GROWTH)?;
            let name = format!("{kind} growing load");
            note_solution(&mut values, &name, &reference, &parameters, &TIMES_OF_GROWTH)?;
        }
    }
    note_drainages(&mut values, &ColumnParameters { load: LARGE_LOAD, ..seed })?;
    for (start, name) in
        [(Start::Step, "step"), (Start::Mode, "mode"), (Start::StandingWave, "standing wave")]
    {
        let column = DynamicColumn::new(&seed, start, &TIME_FACTORS)?;
        let (length, rate) = (seed.final_settlement(), seed.final_settlement() / seed.time(1.0));
        for time_factor in TIME_FACTORS {
            for zeta in DEPTHS {
                let fields = column.dynamic_fields(time_factor, zeta)?;
                let mut note = |what: &str, value: f64| {
                    values
                        .insert(format!("dynamic-column {name} | {what} ζ={zeta} T_v={time_factor}"), value);
                };
                note("u_w/(m_v q H)", fields.water_displacement / length);
                note("v_s/(m_v q c_v/H)", fields.velocities.solid / rate);
                note("v_w/(m_v q c_v/H)", fields.velocities.water / rate);
            }
        }
    }
    for (base, name) in [(Base::Rough, "rough"), (Base::Smooth, "smooth")] {
        let layer = CosineLayer::new(&seed, 1.0, base, Water::Compressible)?;
        for time_factor in TIME_FACTORS {
            let state = layer.at(time_factor)?;
            for (x, y) in [(0.0, 0.9), (0.3, 0.5), (0.5, 0.1)] {
                let fields = state.fields(x, y)?;
                let mut note = |what: &str, value: f64| {
                    values
                        .insert(format!("cosine-layer {name} | {what} x={x} y={y} T_v={time_factor}"), value);
                };
                note("p", fields.pressure);
                for (stress, direction) in fields.effective_stress.iter().zip(["xx", "yy", "zz", "xy"]) {
                    note(&format!("σ'_{direction}"), *stress);
                }
                for (displacement, direction) in fields.displacement.iter().zip(["x", "y"]) {
                    note(&format!("u_{direction}/(m_v q H)"), displacement / seed.final_settlement());
                }
            }
        }
    }
    Ok(values)
}

/// A solution on the depths at some times.
fn note_solution(
    values: &mut BTreeMap<String, f64>,
    name: &str,
    reference: &Reference,
    parameters: &ColumnParameters,
    time_factors: &[f64],
) -> Result<(), ExactError> {
    let mut note = |what: &str, time_factor: f64, value: f64| {
        values.insert(format!("{name} | {what} T_v={time_factor}"), value);
    };
    for time_factor in time_factors.iter().copied() {
        note("degree", time_factor, reference.degree_of_consolidation(time_factor)?);
        let accuracy = reference.accuracy(time_factor)?;
        note("terms", time_factor, accuracy.terms as f64);
        // By its power of ten: a bound of 1e-20 is nothing beside any tolerance.
        note("power of the tail bound", time_factor, elementary::log10(accuracy.tail_bound.max(LEAST_BOUND)));
        for zeta in DEPTHS {
            let fields = reference.fields(time_factor, zeta)?;
            let load = parameters.load;
            note(&format!("p/q ζ={zeta}"), time_factor, fields.pressure / load);
            note(&format!("σ'/q ζ={zeta}"), time_factor, fields.effective_stress / load);
            let displacement = fields.displacement / parameters.final_settlement();
            note(&format!("u/(m_v q H) ζ={zeta}"), time_factor, displacement);
        }
    }
    Ok(())
}

/// What Xie & Leo give beside fields, for both drainages.
fn note_drainages(
    values: &mut BTreeMap<String, f64>,
    parameters: &ColumnParameters,
) -> Result<(), ExactError> {
    for (drainage, name) in [(Drainage::Top, "top"), (Drainage::TopAndBase, "top and base")] {
        let solution = XieLeo::drained(parameters, drainage)?;
        let mut note = |what: &str, time_factor: f64, value: f64| {
            values.insert(format!("xie-leo drained at {name} | {what} T_v={time_factor}"), value);
        };
        for time_factor in TIME_FACTORS {
            note("settlement/H", time_factor, solution.settlement(time_factor)? / parameters.height);
            note("degree", time_factor, solution.degree_of_consolidation(time_factor)?);
            let bound = solution.accuracy(time_factor)?.tail_bound;
            note("power of the tail bound", time_factor, elementary::log10(bound.max(LEAST_BOUND)));
            for zeta in DEPTHS {
                let fields = solution.fields(time_factor, zeta)?;
                note(&format!("p/q ζ={zeta}"), time_factor, fields.pressure / parameters.load);
                let displacement = fields.displacement / parameters.height;
                note(&format!("u/H ζ={zeta}"), time_factor, displacement);
                note(&format!("J ζ={zeta}"), time_factor, solution.volume_ratio(time_factor, zeta)?);
            }
        }
    }
    Ok(())
}
