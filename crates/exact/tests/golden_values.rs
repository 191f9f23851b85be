//! Values of every exact solution on a few places and times, with the bounds that it gives on its own error, as a
//! snapshot: a fault in one shows at its own numbers, and not only in the errors of those scenes that happen to use it.

use oedometer_exact::cosine_layer::CosineLayer;
use oedometer_exact::dynamic_column::{DynamicColumn, Start};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::large_strain::diffusion::Water;
use oedometer_exact::parameters::{Base, ColumnParameters, Drainage};
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_exact::xie_leo::XieLeo;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use std::collections::BTreeMap;

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

/// Values by the names `case | what T_v=time`.
#[derive(Default)]
struct Values(BTreeMap<String, f64>);

impl Values {
    fn note(&mut self, case: &str, what: &str, time_factor: f64, value: f64) {
        self.0.insert(format!("{case} | {what} T_v={time_factor}"), value);
    }

    /// Notes a bound by its power of ten: one of 1e-20 is nothing beside any tolerance.
    fn note_bound(&mut self, case: &str, time_factor: f64, bound: f64) {
        self.note(case, "power of the tail bound", time_factor, elementary::log10(bound.max(LEAST_BOUND)));
    }

    /// Notes a solution on the depths at some times.
    fn note_solution(
        &mut self,
        case: &str,
        kind: ReferenceKind,
        parameters: &ColumnParameters,
        time_factors: &[f64],
    ) -> Result<(), ExactError> {
        let case = format!("{kind} {case}");
        let reference = Reference::new(kind, parameters, time_factors)?;
        for time_factor in time_factors.iter().copied() {
            let mut note = |what: &str, value| self.note(&case, what, time_factor, value);
            note("degree", reference.degree_of_consolidation(time_factor)?);
            let accuracy = reference.accuracy(time_factor)?;
            note("terms", accuracy.terms as f64);
            for zeta in DEPTHS {
                let fields = reference.fields(time_factor, zeta)?;
                note(&format!("p/q ζ={zeta}"), fields.pressure / parameters.load);
                note(&format!("σ'/q ζ={zeta}"), fields.effective_stress / parameters.load);
                let displacement = fields.displacement / parameters.final_settlement();
                note(&format!("u/(m_v q H) ζ={zeta}"), displacement);
            }
            self.note_bound(&case, time_factor, accuracy.tail_bound);
        }
        Ok(())
    }

    /// Notes what Xie & Leo give beside fields, for both drainages.
    fn note_drainages(&mut self, parameters: &ColumnParameters) -> Result<(), ExactError> {
        for (drainage, name) in [(Drainage::Top, "top"), (Drainage::Both, "top and base")] {
            let column = ColumnParameters { drainage, ..*parameters };
            let solution = Reference::new(ReferenceKind::XieLeo, &column, &[])?;
            let single = XieLeo::new(parameters)?;
            let case = format!("xie-leo drained at {name}");
            for time in TIME_FACTORS {
                // All at the time of one drained end.
                let time_factor = column.time_factor(parameters.time(time));
                let mut note = |what: &str, value| self.note(&case, what, time, value);
                note("settlement/H", solution.settlement(time_factor)? / parameters.height);
                note("degree", solution.degree_of_consolidation(time_factor)?);
                for zeta in DEPTHS {
                    let fields = solution.fields(time_factor, zeta)?;
                    note(&format!("p/q ζ={zeta}"), fields.pressure / parameters.load);
                    note(&format!("u/H ζ={zeta}"), fields.displacement / parameters.height);
                    if drainage == Drainage::Top {
                        note(&format!("J ζ={zeta}"), single.volume_ratio(time_factor, zeta)?);
                    }
                }
                self.note_bound(&case, time, solution.accuracy(time_factor)?.tail_bound);
            }
        }
        Ok(())
    }

    /// Notes displacements and velocities of both phases in the column with inertia.
    fn note_waves(&mut self, seed: &ColumnParameters) -> Result<(), ExactError> {
        let starts = [(Start::Step, "step"), (Start::Mode, "mode"), (Start::StandingWave, "standing wave")];
        let (length, rate) = (seed.final_settlement(), seed.final_settlement() / seed.time(1.0));
        for (start, name) in starts {
            let column = DynamicColumn::new(seed, start, &TIME_FACTORS)?;
            let case = format!("dynamic-column {name}");
            for time_factor in TIME_FACTORS {
                for zeta in DEPTHS {
                    let fields = column.dynamic_fields(time_factor, zeta)?;
                    let mut note =
                        |what: &str, value| self.note(&case, &format!("{what} ζ={zeta}"), time_factor, value);
                    note("u_w/(m_v q H)", fields.water_displacement / length);
                    note("v_s/(m_v q c_v/H)", fields.velocities.solid / rate);
                    note("v_w/(m_v q c_v/H)", fields.velocities.water / rate);
                }
            }
        }
        Ok(())
    }

    /// Notes the fields of the cosine layer on both bases.
    fn note_layers(&mut self, seed: &ColumnParameters) -> Result<(), ExactError> {
        for (base, name) in [(Base::Rough, "rough"), (Base::Smooth, "smooth")] {
            let layer = CosineLayer::new(seed, 1.0, base, Water::Compressible)?;
            let case = format!("cosine-layer {name}");
            for time_factor in TIME_FACTORS {
                let state = layer.at(time_factor)?;
                for (x, y) in [(0.0, 0.9), (0.3, 0.5), (0.5, 0.1)] {
                    let fields = state.fields(x, y)?;
                    let mut note = |what: &str, value| {
                        self.note(&case, &format!("{what} x={x} y={y}"), time_factor, value);
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
        Ok(())
    }
}

/// Values of every solution on the seed column and on softer ones.
fn values_of_column(seed: &ColumnParameters) -> Result<BTreeMap<String, f64>, ExactError> {
    let mut values = Values::default();
    let soft = ColumnParameters {
        soil: Material { water_bulk_modulus: SOFT_WATER, ..seed.soil },
        load: LARGE_LOAD,
        ..*seed
    };
    let growing = ColumnParameters { loading_time: seed.time(LOADED_AT), ..soft };
    // Motions that were chosen and a footing have no column; their balances are tested. Soils of several kinds and soils
    // that yield are compared with values computed by other ways.
    let has_seed_column = |kind: &ReferenceKind| {
        let needs_own_inputs = matches!(
            kind,
            ReferenceKind::Layered
                | ReferenceKind::YieldFront
                | ReferenceKind::SealedElement
                | ReferenceKind::Footing
        );
        !kind.is_manufactured() && !needs_own_inputs
    };
    for kind in ReferenceKind::ALL.into_iter().filter(has_seed_column) {
        values.note_solution("seed column", kind, seed, &TIME_FACTORS)?;
        values.note_solution("soft water, 200 kPa", kind, &soft, &TIME_FACTORS)?;
        if matches!(kind, ReferenceKind::DynamicColumn | ReferenceKind::LargeStrain(_)) {
            values.note_solution("growing load", kind, &growing, &TIMES_OF_GROWTH)?;
        }
    }
    values.note_drainages(&ColumnParameters { load: LARGE_LOAD, ..*seed })?;
    values.note_waves(seed)?;
    values.note_layers(seed)?;
    Ok(values.0)
}

/// Values below this are round-off.
const ROUND_OFF: f64 = 1e-12;

#[test]
fn exact_solutions_keep_their_values() {
    let values =
        values_of_column(&ColumnParameters::default()).expect("every solution takes the seed column");
    let lines = values.iter().map(|(name, value)| {
        if value.abs() < ROUND_OFF { format!("{name}: 0") } else { format!("{name}: {value:.9e}") }
    });
    insta::assert_snapshot!(lines.collect::<Vec<_>>().join("\n"));
}
