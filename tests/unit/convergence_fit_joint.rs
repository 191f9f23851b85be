use super::*;

fn runs(error: impl Fn(f64, f64, f64) -> f64) -> Vec<Run> {
    let mut runs = Vec::new();
    for cell_size in [0.2, 0.1, 0.05, 0.025] {
        for time_step in [1e-3, 5e-4, 2.5e-4, 1.25e-4] {
            for points_per_cell in [1.0, 2.0, 4.0] {
                let error = error(cell_size, time_step, points_per_cell);
                runs.push(Run { cell_size, time_step, points_per_cell, error });
            }
        }
    }
    runs
}

#[test]
fn four_known_terms_are_found_again_and_the_limiting_axis_named() {
    let data = runs(|h, dt, n| 0.3 * h * h + 2.0 * dt + 1e-3 / n.powi(3) + 1e-4);
    let fit = fit_jointly(&data, &Exponents::default()).unwrap();
    let wanted = [
        (Axis::Mesh, 0.3, 2.0),
        (Axis::Step, 2.0, 1.0),
        (Axis::PointsPerCell, 1e-3, 3.0),
        (Axis::Floor, 1e-4, 0.0),
    ];
    for (axis, coefficient, order) in wanted {
        let term = fit.term(axis).unwrap();
        assert!((term.order - order).abs() < 1e-4, "{term:?}");
        assert!((term.coefficient / coefficient - 1.0).abs() < 1e-3, "{term:?}");
    }
    assert!(fit.residual < 1e-6);
    // 0.2, 1e-3, 4: the mesh has 0.012 of 0.0141. 0.025, 1e-3, 4: the step has 0.002.
    assert_eq!(fit.runs[2].limiting, Axis::Mesh);
    assert_eq!(fit.runs[38].limiting, Axis::Step);
    assert!(fit.runs.iter().all(|run| (run.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12));
}

#[test]
fn noise_of_two_per_cent_moves_orders_a_little() {
    let mut data = runs(|h, dt, _| 0.3 * h * h + 2.0 * dt);
    for (index, run) in data.iter_mut().enumerate() {
        run.error *= 1.0 + 0.02 * (index as f64 * 1.7).sin();
    }
    let fixed = Exponents { points_per_cell: Exponent::Fixed(1.0), ..Exponents::default() };
    let fit = fit_jointly(&data, &fixed).unwrap();
    assert!((fit.term(Axis::Mesh).unwrap().order - 2.0).abs() < 0.15, "{fit:?}");
    assert!((fit.term(Axis::Step).unwrap().order - 1.0).abs() < 0.15, "{fit:?}");
    assert!(fit.term(Axis::PointsPerCell).unwrap().coefficient < 1e-4);
    assert!(fit.residual < 0.02);
}

#[test]
fn an_axis_held_still_goes_to_the_floor() {
    let mut data = runs(|h, _, _| 0.3 * h * h + 2e-3);
    data.retain(|run| run.time_step == 1e-3 && run.points_per_cell == 2.0);
    let exponents = Exponents { mesh: Exponent::Fixed(2.0), ..Exponents::default() };
    let fit = fit_jointly(&data, &exponents).unwrap();
    assert_eq!(fit.not_varied, [Axis::Step, Axis::PointsPerCell]);
    assert!((fit.term(Axis::Floor).unwrap().coefficient / 2e-3 - 1.0).abs() < 1e-9);
    assert!(fit.term(Axis::Step).is_none());
}

#[test]
fn a_path_cannot_be_taken_apart() {
    let mut data = runs(|h, dt, _| h * h + dt);
    data.retain(|run| (run.time_step / run.cell_size - 5e-3).abs() < 1e-9);
    let tied = fit_jointly(&data, &Exponents::default());
    assert_eq!(tied, Err(NoJointFit::Tied { axes: vec![Axis::Mesh, Axis::Step, Axis::PointsPerCell] }));
}

#[test]
fn what_cannot_be_used_is_named() {
    let data = runs(|h, dt, _| h * h + dt);
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e-310] {
        let mut broken = data.clone();
        broken[4].error = bad;
        assert_eq!(fit_jointly(&broken, &Exponents::default()), Err(NoJointFit::BadRun { number: 5 }));
    }
    let none = Exponents::default();
    assert_eq!(fit_jointly(&[], &none), Err(NoJointFit::NothingVaried));
    assert_eq!(fit_jointly(&data[..1], &none), Err(NoJointFit::NothingVaried));
    assert_eq!(fit_jointly(&data[..3], &none), Err(NoJointFit::TooFewRuns { runs: 3, needed: 4 }));
}
