use super::*;
use std::f64::consts::PI;

fn decay(count: usize) -> Vec<f64> {
    (0..count).map(|index| (PI / 2.0 * (index as f64 + 0.5) / count as f64).sin()).collect()
}

fn sign(index: usize) -> f64 {
    if index.is_multiple_of(2) { 1.0 } else { -1.0 }
}

#[test]
fn a_monotone_profile_does_not_oscillate() {
    let exact = decay(40);
    let smooth: Vec<f64> = exact.iter().map(|value| 0.9 * value + 0.05).collect();
    assert_eq!(reversal(&smooth, &exact), Some(0.0));
    assert_eq!(reversal(&exact, &exact), Some(0.0));
}

#[test]
fn a_checkerboard_by_cells_and_a_saw_inside_them_oscillate() {
    let exact = decay(40);
    let wavy: Vec<f64> = exact.iter().enumerate().map(|(i, x)| x + 0.1 * sign(i / 2)).collect();
    // 19 jumps of 0.2 between 20 cells, against a profile that rises by about 1.
    assert!(reversal(&wavy, &exact).unwrap() > 2.0);
    let saw: Vec<f64> = exact.iter().enumerate().map(|(i, x)| x + 0.05 * sign(i)).collect();
    assert!(reversal(&saw, &exact).unwrap() > 2.0);
}

#[test]
fn round_off_in_a_flat_stretch_does_not_hide_an_oscillation() {
    // Early in time the exact profile is 1 to round-off away from the drained end.
    for end in [0.2, 1.8] {
        let profile = |oscillation: f64| -> Vec<f64> {
            (0..20).map(|i| if i == 0 { end } else { 1.0 + oscillation * sign(i) }).collect()
        };
        assert!(reversal(&profile(0.1), &profile(2e-16)).unwrap() > 1.0);
    }
}

#[test]
fn turns_of_the_exact_profile_are_no_oscillation() {
    let exact: Vec<f64> = (0..60).map(|i| (f64::from(i) * PI / 20.0).cos()).collect();
    assert_eq!(turning_points(&exact), vec![20, 40]);
    let computed: Vec<f64> = exact.iter().map(|value| 1.2 * value).collect();
    assert!(reversal(&computed, &exact).unwrap() < 1e-12);
}

#[test]
fn what_is_no_profile_has_no_oscillation() {
    assert_eq!(reversal(&[1.0; 2], &[1.0; 2]), None);
    assert_eq!(reversal(&[1.0, 2.0, 3.0], &[0.0; 3]), None);
    assert_eq!(reversal(&[1.0, 2.0, 3.0], &[1.0; 4]), None);
    assert_eq!(reversal(&[f64::MAX, -f64::MAX, 3.0], &[1.0; 3]), None);
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(reversal(&[1.0, bad, 2.0], &[1.0; 3]), None);
        assert_eq!(reversal(&[1.0, 2.0, 3.0], &[1.0, bad, 1.0]), None);
    }
}

fn field(computed: impl Fn(usize, usize) -> f64) -> PlaneField {
    let exact = |i: usize, j: usize| (i + 2 * j) as f64;
    let all = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..6).flat_map(|j| (0..4).map(move |i| (i, j))).map(|(i, j)| f(i, j)).collect()
    };
    PlaneField { columns: 4, computed: all(&computed), exact: all(&exact) }
}

#[test]
fn a_smooth_error_has_no_oscillation_and_a_checkerboard_has() {
    assert_eq!(field(|i, j| (i + 2 * j) as f64 + 7.0).oscillation_index(), 0.0);
    // A staircase of two points a step.
    let staircase = field(|i, j| (i / 2 * 2) as f64 + 2.0 * j as f64);
    assert!(staircase.oscillation_index() <= 0.0);
    let board = field(|i, j| (i + 2 * j) as f64 + if (i + j) % 2 == 0 { 5.0 } else { -5.0 });
    assert!(board.oscillation_index() > 4.0, "{}", board.oscillation_index());
}

#[test]
fn a_saw_along_rows_and_one_up_columns_oscillate_alike() {
    let saw = |index: usize| if index.is_multiple_of(2) { 5.0 } else { -5.0 };
    let along = field(|i, j| (i + 2 * j) as f64 + saw(i)).oscillation_index();
    let up = field(|i, j| (i + 2 * j) as f64 + saw(j)).oscillation_index();
    // Steps of 9 and 11 instead of 1 along six rows of three, of 8 and 12 instead of 2 up four columns of five.
    let exact = 6.0 * 3.0 + 4.0 * 10.0;
    assert!((along - (6.0 * (9.0 + 11.0 + 9.0) + 40.0 - exact) / exact).abs() < 1e-12, "{along}");
    assert!((up - (18.0 + 4.0 * (3.0 * 8.0 + 2.0 * 12.0) - exact) / exact).abs() < 1e-12, "{up}");
}

#[test]
fn the_exact_field_of_a_run_is_not_that_of_another_time_lattice_or_soil() {
    let records = crate::campaign::runner::records_of(
        "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.02, 0.1, 0.3]\n[[sweep]]\n\
         method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [2, 4]\npoints_per_cell = [2, 3]\n\
         porosity = [0.3, 0.4]\noffset = [0.0, 0.2]\ntime_step = [{ growth = 0.5 }]\n",
    );
    assert_eq!(records.len(), 16);
    let exact = |record: &Record, time: f64| {
        let case = &record.case;
        let own = case.scene.references[0].kind.for_soil(&case.material);
        let reference = known_reference(case, own, &[time]).expect("a theory");
        let points = &record.snapshot(time).expect("a state").points;
        let load = case.column.pressure_scale();
        let pressures = exact_samples(case, &reference, time, points).expect("inside").pressure;
        pressures.into_iter().map(|p| p / load).collect::<Vec<f64>>()
    };
    let mut fields: Vec<Vec<f64>> = Vec::new();
    for round in 0..2 {
        for (time, record) in
            [0.1, 0.02, 0.3].into_iter().flat_map(|time| records.iter().map(move |record| (time, record)))
        {
            let field = PlaneField::of(record, time).expect("a theory").expect("a plane");
            assert_eq!(field.exact, exact(record, time), "{time} {}", record.case.label());
            // A square layer: as many lines of points along it as up.
            let lines = record.case.cells * record.case.points_per_cell;
            assert_eq!((field.columns, field.exact.len()), (lines, lines * lines));
            let load = record.case.column.load;
            let first = record.snapshot(time).expect("a state").points.pressure[0];
            assert_eq!(field.computed[0], first / load);
            assert!(PlaneField::of(record, 0.5).expect("no output").is_none());
            if round == 0 {
                assert!(!fields.contains(&field.exact), "{time} {}", record.case.label());
                fields.push(field.exact);
            }
        }
    }
}

#[test]
fn an_oscillation_is_the_variation_beyond_the_net_changes_by_hand() {
    for (computed, exact, found) in [
        ([0.0, 2.0, 1.0, 3.0], [0.0, 1.0, 2.0, 3.0], Some(2.0 / 3.0)),
        ([3.0, 1.0, 2.0, 0.0], [3.0, 2.0, 1.0, 0.0], Some(2.0 / 3.0)),
        // The exact one turns at its third place: there the computed one may too.
        ([0.0, 1.0, 2.0, 1.0], [0.0, 1.0, 3.0, 2.0], Some(0.0)),
        ([2.0, 1.0, 0.0, 1.0], [3.0, 2.0, 0.0, 1.0], Some(0.0)),
        ([0.0, 3.0, 2.0, 1.0], [0.0, 1.0, 3.0, 2.0], Some(5.0 / 3.0 - 1.0)),
        ([1.0; 4], [0.0, 1.0, 3.0, 2.0], None),
    ] {
        let index = reversal(&computed, &exact);
        let is_near = index.zip(found).is_some_and(|(one, other)| (one - other).abs() < 1e-15);
        assert!(is_near || index == found, "{computed:?}: {index:?}");
    }
}
