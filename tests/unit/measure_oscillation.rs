use super::*;

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
    let measured = oscillation(&smooth, &exact, 2.0).unwrap();
    assert_eq!(measured.reversal, Some(0.0));
    assert!((measured.variation_excess.unwrap() + 0.1).abs() < 1e-12);
    assert!(measured.short_wave_share.unwrap() < 0.01, "{measured:?}");

    let same = oscillation(&exact, &exact, 2.0).unwrap();
    assert_eq!((same.variation_excess, same.reversal), (Some(0.0), Some(0.0)));
    assert_eq!((same.excess_over_peak, same.short_wave_share), (0.0, None));
}

#[test]
fn a_checkerboard_by_cells_is_all_short_wave() {
    let exact = decay(40);
    let wavy: Vec<f64> = exact.iter().enumerate().map(|(i, x)| x + 0.1 * sign(i / 2)).collect();
    let measured = oscillation(&wavy, &exact, 2.0).unwrap();
    assert!(measured.short_wave_share.unwrap() > 0.95, "{measured:?}");
    // 19 jumps of 0.2 between 20 cells, against a profile that rises by about 1.
    assert!((measured.excess_over_peak - 3.8).abs() < 0.7, "{measured:?}");
    assert!(measured.reversal.unwrap() > 2.0 && measured.variation_excess.unwrap() > 2.0);
}

#[test]
fn a_saw_inside_the_cells_is_short_wave_too() {
    let exact = decay(40);
    let saw: Vec<f64> = exact.iter().enumerate().map(|(i, x)| x + 0.02 * sign(i)).collect();
    assert!(oscillation(&saw, &exact, 2.0).unwrap().short_wave_share.unwrap() > 0.98);
}

#[test]
fn the_energy_of_single_modes_goes_to_its_side() {
    let (count, exact) = (32_usize, vec![1.0; 32]);
    for mode in 1..count {
        let wave: Vec<f64> =
            (0..count).map(|i| 1.0 + (PI * mode as f64 * (i as f64 + 0.5) / count as f64).cos()).collect();
        let share = oscillation(&wave, &exact, 1.0).unwrap().short_wave_share.unwrap();
        let wanted = if mode >= 16 { 1.0 } else { 0.0 };
        assert!((share - wanted).abs() < 1e-12, "mode {mode}: {share}");
    }
}

#[test]
fn an_offset_counts_as_smooth_with_its_full_energy() {
    // An offset of 1 has energy N, a cosine of amplitude 1 has N/2: a third is short.
    let wave = |i: u32| 2.0 + (PI * 20.0 * (f64::from(i) + 0.5) / 32.0).cos();
    let wavy: Vec<f64> = (0..32).map(wave).collect();
    let share = oscillation(&wavy, &[1.0; 32], 1.0).unwrap().short_wave_share.unwrap();
    assert!((share - 1.0 / 3.0).abs() < 1e-12, "{share}");
}

#[test]
fn round_off_in_a_flat_stretch_does_not_hide_a_oscillation() {
    // Early in time the exact profile is 1 to round-off away from the drained end.
    for end in [0.2, 1.8] {
        let profile = |oscillation: f64| -> Vec<f64> {
            (0..20).map(|i| if i == 0 { end } else { 1.0 + oscillation * sign(i) }).collect()
        };
        let found = oscillation(&profile(0.1), &profile(2e-16), 2.0).unwrap();
        assert!(found.reversal.unwrap() > 1.0, "{found:?}");
    }
}

#[test]
fn turns_of_the_exact_profile_are_no_oscillation() {
    let exact: Vec<f64> = (0..60).map(|i| (f64::from(i) * PI / 20.0).cos()).collect();
    assert_eq!(turning_points(&exact), vec![20, 40]);
    let computed: Vec<f64> = exact.iter().map(|value| 1.2 * value).collect();
    assert!(oscillation(&computed, &exact, 1.0).unwrap().reversal.unwrap() < 1e-12);
}

#[test]
fn a_flat_exact_profile_still_has_an_excess() {
    let wavy: Vec<f64> = (0..10).map(|i| 1.0 + 0.5 * sign(i)).collect();
    let measured = oscillation(&wavy, &[1.0; 10], 1.0).unwrap();
    assert_eq!(measured.variation_excess, None);
    assert!((measured.excess_over_peak - 9.0).abs() < 1e-12);
}

#[test]
fn what_has_no_value_is_named() {
    use UndefinedOscillation as Undefined;
    let of = |computed: &[f64], exact: &[f64], samples| oscillation(computed, exact, samples).unwrap_err();
    assert_eq!(of(&[1.0; 2], &[1.0; 2], 1.0), Undefined::TooFewSamples { samples: 2 });
    assert_eq!(of(&[1.0; 3], &[0.0; 3], 1.0), Undefined::ZeroExact);
    assert_eq!(of(&[1.0; 3], &[1.0; 4], 1.0), Undefined::LengthMismatch { computed: 3, exact: 4 });
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(of(&[1.0, bad, 1.0], &[1.0; 3], 1.0), Undefined::NotFinite);
        assert_eq!(of(&[1.0; 3], &[1.0, bad, 1.0], 1.0), Undefined::NotFinite);
        assert_eq!(of(&[bad; 3], &[bad; 3], 1.0), Undefined::NotFinite);
        assert_eq!(of(&[1.0; 3], &[1.0; 3], bad), Undefined::BadSamplesPerCell);
    }
    assert_eq!(of(&[1.0; 3], &[1.0; 3], 0.0), Undefined::BadSamplesPerCell);
}
