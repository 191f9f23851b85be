//! The undrained start of the cosine-loaded layer against the figures of an independent
//! implementation: where volumetric locking shows.

use crate::campaign::case_run::run_case;
use crate::case::quantity::{Norm, Quantity, Sample};
use crate::record::Record;
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_mpm::run::Kernel;

/// The undrained start by a method on `cells` × `cells` square cells.
fn start(method: &str, cells: usize, stiffness_ratio: f64, more: &str) -> Record {
    let stiffness = stiffness_ratio * 1e6;
    let method = if method.starts_with('{') { method.to_owned() } else { format!("'{method}'") };
    let text = format!(
        "title = 'start'\nscene = 'cosine-layer'\noutput.time_factors = [0]\n\
         material.water_bulk_modulus = {stiffness:e}\n{more}\n\
         [[sweep]]\nmethod = [{method}]\ncells = [{cells}]\n"
    );
    let study = Study::check(&StudySource { name: "start.toml".to_owned(), text }).expect("a sound study");
    let case = &study.planned[0].case;
    run_case(case, &study.references, Kernel::Fastest, false, &|_, _| true).expect("the seed layer")
}

fn error(record: &Record, quantity: Quantity, sample: Sample) -> f64 {
    let row = record.error(quantity, sample, Norm::L2, "cosine-layer", 0.0);
    row.map_or(f64::NAN, |row| row.value)
}

/// Errors of nodal displacement, of pressure at the points and of pressure at the cell means.
fn three(record: &Record) -> [f64; 3] {
    [
        error(record, Quantity::Displacement, Sample::Nodes),
        error(record, Quantity::Pressure, Sample::Points),
        error(record, Quantity::Pressure, Sample::Centres),
    ]
}

#[test]
fn the_undrained_start_has_the_errors_of_the_oracle() {
    // Method, K_w/E, then the three errors on 8, 16 and 32 cells.
    let oracle: [(&str, f64, [[f64; 3]; 3]); 9] = [
        ("GIMP", 10.0, [[0.20, 3.1, 0.15], [6.7e-2, 1.9, 4.8e-2], [1.9e-2, 1.05, 1.3e-2]]),
        ("GIMP", 2200.0, [[0.98, 20.0, 0.91], [0.91, 36.0, 0.84], [0.73, 55.0, 0.65]]),
        ("GIMP", 1e6, [[1.0, 20.0, 0.93], [1.0, 41.0, 0.93], [1.0, 81.0, 0.93]]),
        ("GIMP-SRI", 2200.0, [[1.2e-2, 0.13, 1.3e-2], [3.0e-3, 6.5e-2, 3.3e-3], [7.6e-4, 3.2e-2, 8.3e-4]]),
        ("GIMP-SRI", 1e6, [[1.2e-2, 0.13, 1.3e-2], [3.0e-3, 6.5e-2, 3.3e-3], [7.6e-4, 3.2e-2, 8.3e-4]]),
        (
            "GIMP-SRI-patch",
            2200.0,
            [[8.4e-3, 1.3e-2, 9.5e-3], [2.1e-3, 3.0e-3, 2.4e-3], [5.3e-4, 6.8e-4, 6.0e-4]],
        ),
        (
            "GIMP-SRI-patch",
            1e6,
            [[8.4e-3, 1.3e-2, 9.5e-3], [2.1e-3, 3.0e-3, 2.4e-3], [5.3e-4, 6.8e-4, 6.0e-4]],
        ),
        (
            "GC-SRI-patch",
            2200.0,
            [[4.1e-3, 2.0e-2, 1.8e-2], [8.7e-4, 5.5e-3, 5.2e-3], [2.0e-4, 1.4e-3, 1.4e-3]],
        ),
        ("GC-SRI-patch", 1e6, [[4.1e-3, 2.0e-2, 1.8e-2], [8.7e-4, 5.5e-3, 5.2e-3], [2.0e-4, 1.4e-3, 1.4e-3]]),
    ];
    for (method, ratio, levels) in oracle {
        // The finest mesh with the stiffness of water alone: the others show it on two.
        let meshes = if ratio == 2200.0 { 3 } else { 2 };
        for (cells, expected) in [8, 16, 32].into_iter().zip(levels).take(meshes) {
            let got = three(&start(method, cells, ratio, ""));
            for (got, expected) in got.into_iter().zip(expected) {
                let off = (got / expected - 1.0).abs();
                assert!(off < 0.1, "{method}, K_w/E = {ratio}, {cells} cells: {got:.3e} for {expected:.3e}");
            }
        }
    }
}

#[test]
fn the_error_of_reduced_integration_does_not_depend_on_the_water_s_stiffness() {
    for method in ["GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch"] {
        let errors: Vec<f64> =
            [1e3, 1e4, 1e5, 1e6].map(|ratio| three(&start(method, 16, ratio, ""))[0]).into();
        let (least, most) =
            errors.iter().fold((f64::MAX, 0.0), |(least, most): (f64, f64), e| (least.min(*e), most.max(*e)));
        assert!(most / least - 1.0 < 0.02, "{method}: {errors:?}");
    }
}

#[test]
fn a_nearly_incompressible_skeleton_locks_all_but_b_bar() {
    let at = |method: &str, ratio: f64| {
        three(&start(method, 8, 2200.0, &format!("material.poissons_ratio = {ratio}")))[0]
    };
    for method in ["GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GIMP-SRI-nodal", "GIMP-mean", "GIMP-null-space"] {
        assert!(at(method, 0.4999) > 0.5, "{method}: {}", at(method, 0.4999));
    }
    for method in ["GIMP-Bbar", "GIMP-Bbar-patch", "GC-Bbar-patch"] {
        let (soft, stiff) = (at(method, 0.25), at(method, 0.4999));
        assert!(stiff < 0.02 && (stiff / soft - 1.0).abs() < 0.05, "{method}: {soft} and {stiff}");
    }
}

#[test]
fn splines_meet_rollers_without_nodes_beyond_them() {
    let displacement = |basis: &str, cells: usize| {
        let choices =
            format!("{{ basis = '{basis}', strain = 'standard', pressure = 'sri', recovery = 'patch' }}");
        three(&start(&choices, cells, 2200.0, ""))[0]
    };
    let (coarse, fine) = (displacement("bspline2", 8), displacement("bspline2", 16));
    assert!(fine < 3.7e-3 && (coarse / fine).log2() > 1.8, "{coarse} and {fine}");
    let cubic = displacement("bspline3", 16);
    assert!(cubic < 2.4e-2, "{cubic}");
}

#[test]
fn the_start_is_in_equilibrium_and_has_no_mean_pressure() {
    for base in ["rough", "smooth"] {
        for method in ["GIMP-SRI-patch", "GC-SRI-patch"] {
            let record = start(method, 8, 2200.0, &format!("layer.base = '{base}'\nlayer.length = 2.0"));
            let checks = record.start.expect("start checks");
            assert!(checks.unbalanced_force < 1e-9, "{base} {method}: {checks:?}");
            assert!(checks.undrained_pressure_error < 1e-9, "{base} {method}: {checks:?}");
            assert_eq!(checks.points, checks.points_expected);
            assert!(checks.volume_error.abs() < 1e-12);
            let [displacement, pressure, _] = three(&record);
            assert!(displacement < 0.02 && pressure < 0.03, "{base} {method}: {displacement} {pressure}");
        }
    }
}
