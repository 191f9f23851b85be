//! The whole explicit step gives the same bits in registers of two numbers and of four.
//!
//! The two steps are compiled from one source (`crates/mpm/src/wide.rs`); without optimisation, and on a processor
//! without registers of four, both are the same code and agree by themselves.

use crate::kernel::body::{Body, Discrete};
use crate::tests::column_problem;
use crate::wide::in_narrow_registers;
use oedometer_problem::method::{Configuration, Method};
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::wave_speeds;
use oedometer_scenes::XIE_LEO;
use oedometer_scenes::column::Column;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// Bits of everything that points and nodes know after some steps.
fn bits_after<const D: usize>(problem: &Discrete<D>, dt: f64, steps: usize) -> Vec<u64> {
    let settings = ExplicitSettings { drag: Drag::Implicit, flip: 0.99, ..ExplicitSettings::default() };
    let mut body = Body::new(problem.clone());
    for _ in 0..steps {
        body.explicit_step(dt, &settings);
    }
    let (points, nodes) = (&body.points, &body.nodes);
    let scalars =
        points.pressure.iter().chain(&points.volume_ratio).chain(&nodes.drag).chain(&nodes.porosity);
    let vectors = [&points.position, &points.half_length, &points.solid_velocity, &points.water_velocity];
    let nodal = [&nodes.solid_velocity, &nodes.water_velocity, &nodes.solid_acceleration, &nodes.flux];
    let vectors = vectors.into_iter().chain(nodal).flatten().flatten();
    let stresses = points.effective_stress.iter().flatten().flatten();
    scalars.chain(vectors).chain(stresses).map(|number| number.to_bits()).collect()
}

/// A column under a load, whose points move apart and together.
fn squeezed<const D: usize>(name: &str, points_per_cell: usize, law: Law) -> Discrete<D> {
    let method = Method::named(name).expect("a known method");
    let method = Method { configuration: Some(Configuration::Updated), ..method };
    let soil = Material { law, porosity: 0.6, ..Material::default() };
    let column = Column { load: 8e5, dimensions: D, ..Column::default() };
    let mut problem =
        column_problem::<D>(&XIE_LEO, &column, &soil, method, 8, points_per_cell).expect("the column");
    // Each point goes its own way, so that neighbours in a register differ.
    for (point, velocity) in problem.points.solid_velocity.iter_mut().enumerate() {
        velocity[D - 1] -= 10.0 * (0.5 + (point as f64).cos());
    }
    problem
}

fn assert_same_bits<const D: usize>(names: &[&str], per_cell: &[usize], law: Law, steps: usize) {
    for name in names {
        for points_per_cell in per_cell {
            let problem = squeezed::<D>(name, *points_per_cell, law);
            let (soil, cell_size) = (&problem.material, problem.grid.cell_size);
            let dt = 0.5 * wave_speeds::combined_limit(soil, cell_size, Drag::Implicit);
            let wide = bits_after(&problem, dt, steps);
            let narrow = in_narrow_registers(|| bits_after(&problem, dt, steps));
            assert!(wide.iter().all(|bits| f64::from_bits(*bits).is_finite()), "{name} {D} runs");
            assert_ne!(wide, bits_after(&problem, dt, steps - 1), "{name} {D} moves");
            let apart = wide.iter().zip(&narrow).filter(|(wide, narrow)| wide != narrow).count();
            assert_eq!((apart, wide.len()), (0, narrow.len()), "{name} {D} {points_per_cell} {law:?}");
        }
    }
}

#[test]
fn a_column_steps_to_the_same_bits_in_registers_of_two_and_of_four() {
    let names =
        ["GC-SRI-patch", "GIMP", "CE-SRI-patch-cells", "MPM", "CPDI-SRI-patch", "VP", "GC-Bbar-patch"];
    assert_same_bits::<1>(&names, &[3], Law::LogLinear, 20);
    assert_same_bits::<1>(&names[..1], &[1, 2, 4, 5], Law::PorosityDependent, 20);
}

#[test]
fn a_plane_steps_to_the_same_bits_in_registers_of_two_and_of_four() {
    let names = ["GC-SRI-patch", "GIMP", "CE-SRI-patch", "CPDI-SRI-patch"];
    assert_same_bits::<2>(&names, &[2], Law::LogLinear, 10);
    assert_same_bits::<2>(&names[..1], &[3], Law::PorosityDependent, 10);
}
