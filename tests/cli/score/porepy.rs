//! `PorePy`: files written by the program.

use crate::program::call;
use crate::score::real_files::{files, score, values};

/// Pressures of ten finite volumes after backward Euler steps of 4.0875 s: computed here anew.
fn finite_volumes(steps: usize) -> Vec<f64> {
    let (cells, spread) = (10, 1e-4 * 1.2e6 / 9810.0);
    let mut pressure = vec![1.0_f64; cells];
    let share = spread * 4.0875 * 100.0;
    for _ in 0..steps {
        let mut diagonal: Vec<f64> = (0..cells).map(|_| 1.0 + 2.0 * share).collect();
        (diagonal[0], diagonal[9]) = (1.0 + share, 1.0 + 3.0 * share);
        for cell in 1..cells {
            let factor = -share / diagonal[cell - 1];
            diagonal[cell] += factor * share;
            pressure[cell] -= factor * pressure[cell - 1];
        }
        pressure[9] /= diagonal[9];
        for cell in (0..9).rev() {
            pressure[cell] = (pressure[cell] + share * pressure[cell + 1]) / diagonal[cell];
        }
    }
    pressure
}

/// The files hold 20 steps of `ΔT_v` = 0.05, so that every state's error is that of the same scheme made here.
#[test]
fn pore_py_has_its_pressures_on_cells() {
    let told = score(&["porepy/col.pvd", "--preset", "porepy"]);
    let found = values(&told, ",pressure,centres,l2,");
    let depths: Vec<String> = (0..10).map(|cell| ((9.5 - f64::from(cell)) / 10.0).to_string()).collect();
    let states = [("0.05", 1), ("0.1", 2), ("0.2", 4), ("0.5", 10), ("1", 20)];
    assert_eq!(found.len(), states.len());
    for (found, (time_factor, steps)) in found.iter().zip(states) {
        let exact =
            call(&files(), &["exact", "terzaghi", "--time-factor", time_factor, "--zeta", &depths.join(",")]);
        let exact = exact
            .out
            .lines()
            .skip(1)
            .map(|row| row.split(',').nth(2).expect("p").parse::<f64>().expect("a number"));
        let pairs: Vec<(f64, f64)> = finite_volumes(steps).into_iter().zip(exact).collect();
        let sum = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
        let own = (sum(&|(a, b)| (a - b).powi(2)) / sum(&|(_, b)| b * b)).sqrt();
        assert!((found / own - 1.0).abs() < 1e-3, "T_v = {time_factor}: {found} and {own}");
    }
    assert!(told.err.contains("the settlement is not judged"), "{}", told.err);
}
