use super::*;

fn absolute_error(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<f64> {
    FieldDifference::of(computed, exact, volumes)?.in_norm(norm).0
}

/// A field with a pointwise error of `h²` times a smooth shape, on uneven volumes.
fn manufactured(cells: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let h = 1.0 / cells as f64;
    let mut field = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..cells {
        for (offset, share) in [(0.3, 0.6), (0.8, 0.4)] {
            let place = (cell as f64 + offset) * h;
            let exact = 1.0 + place;
            field.0.push(exact + h * h);
            field.1.push(exact);
            field.2.push(share * h);
        }
    }
    field
}

#[test]
fn a_pointwise_second_order_error_reads_two_in_every_norm() {
    for norm in [Norm::L1, Norm::L2, Norm::Linf] {
        let absolute: Vec<f64> = [10, 20]
            .into_iter()
            .map(|cells| {
                let (computed, exact, volumes) = manufactured(cells);
                absolute_error(norm, &computed, &exact, &volumes).unwrap()
            })
            .collect();
        assert!(((absolute[0] / absolute[1]).log2() - 2.0).abs() < 1e-9, "{norm}: {absolute:?}");
        assert!((absolute[0] - 0.01).abs() < 1e-12, "{norm}: {}", absolute[0]);

        let relative: Vec<f64> = [1000, 2000]
            .into_iter()
            .map(|cells| {
                let (computed, exact, volumes) = manufactured(cells);
                relative_error(norm, &computed, &exact, &volumes).unwrap()
            })
            .collect();
        assert!(((relative[0] / relative[1]).log2() - 2.0).abs() < 1e-3, "{norm}: {relative:?}");
    }
    let errors =
        [0.01, 0.0025].map(|error| relative_error(Norm::Relative, &[2.0 + error], &[2.0], &[1.0]).unwrap());
    assert!(((errors[0] / errors[1]).log2() - 2.0).abs() < 1e-9);
}

#[test]
fn values_are_those_of_the_formulas() {
    let (computed, exact, volumes) = ([1.0, 3.0], [2.0, 1.0], [3.0, 1.0]);
    let absolute = |norm| absolute_error(norm, &computed, &exact, &volumes).unwrap();
    let relative = |norm| relative_error(norm, &computed, &exact, &volumes).unwrap();
    assert!((absolute(Norm::L1) - 5.0 / 4.0).abs() < 1e-15);
    assert!((absolute(Norm::L2) - (7.0_f64 / 4.0).sqrt()).abs() < 1e-15);
    assert!((absolute(Norm::Linf) - 2.0).abs() < 1e-15);
    assert!((relative(Norm::L1) - 5.0 / 7.0).abs() < 1e-15);
    assert!((relative(Norm::L2) - (7.0_f64 / 13.0).sqrt()).abs() < 1e-15);
    assert!((relative(Norm::Linf) - 1.0).abs() < 1e-15);
}

#[test]
fn what_is_no_field_has_no_error() {
    let error =
        |computed: &[f64], exact: &[f64], volumes: &[f64]| relative_error(Norm::L2, computed, exact, volumes);
    assert_eq!(error(&[], &[], &[]), None);
    assert_eq!(error(&[1.0], &[0.0], &[1.0]), None, "relative to zero");
    assert_eq!(error(&[1.0], &[1.0], &[0.0]), None, "without volume");
    assert_eq!(error(&[1.0], &[1.0], &[-1.0]), None);
    assert_eq!(error(&[1.0], &[1.0], &[f64::NAN]), None);
    assert_eq!(error(&[f64::MAX], &[-f64::MAX], &[1.0]), None, "overflow");
    assert_eq!(error(&[1.0], &[1.0, 2.0], &[1.0]), None);
    assert_eq!(error(&[1.0; 2], &[1.0; 2], &[1.0]), None);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(error(&[1.0, bad], &[1.0; 2], &[1.0; 2]), None);
        assert_eq!(error(&[1.0; 2], &[1.0, bad], &[1.0; 2]), None);
    }
    assert_eq!(relative_error(Norm::Relative, &[1.0; 2], &[1.0; 2], &[1.0; 2]), None, "of one number only");
}

#[test]
fn very_small_and_very_large_fields_keep_their_error() {
    for scale in [1e-300, 1.0, 1e300] {
        let error = relative_error(Norm::L2, &[1.1 * scale, 1.1 * scale], &[scale; 2], &[1.0; 2]);
        assert!((error.unwrap() - 0.1).abs() < 1e-12);
    }
}

#[test]
fn a_sample_without_volume_counts_in_no_norm() {
    for norm in [Norm::L1, Norm::L2, Norm::Linf] {
        let error = absolute_error(norm, &[1.5, 9.0], &[1.0, 1.0], &[2.0, 0.0]).unwrap();
        assert!((error - 0.5).abs() < 1e-15, "{norm}: {error}");
    }
}

#[test]
fn the_place_that_is_off_most_is_found_with_its_share() {
    let part = largest_contribution(&[1.0, 2.0, 3.5], &[1.1, 2.0, 3.0], &[1.0, 1.0, 2.0]).expect("an error");
    assert_eq!((part.index, part.error), (2, 0.5));
    assert!((part.share - 0.5 / 0.51).abs() < 1e-12);
    let tiny = largest_contribution(&[1e-200, 0.0], &[0.0, 0.0], &[1.0, 1.0]).expect("an error");
    assert_eq!(tiny.share, 1.0);
    let alike = largest_contribution(&[0.0, 1.0, 1.0], &[0.0; 3], &[1.0; 3]).expect("an error");
    assert_eq!((alike.index, alike.share), (1, 0.5));
}

#[test]
fn no_error_and_no_number_have_no_place() {
    assert!(largest_contribution(&[1.0], &[1.0], &[1.0]).is_none());
    assert!(largest_contribution(&[f64::NAN], &[1.0], &[1.0]).is_none());
    assert!(largest_contribution(&[], &[], &[]).is_none());
}
