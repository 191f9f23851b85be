//! Single modes against the matrix exponential.

use super::*;
use nalgebra::{Matrix4, Vector4};
use oedometer_soil::material::Material;
use proptest::prelude::*;

/// `exp(A)`, by Taylor's series of `A/2^k` and `k` squarings.
#[expect(clippy::cast_possible_truncation, reason = "a logarithm is a small number")]
fn exponential(matrix: Matrix4<f64>) -> Matrix4<f64> {
    let halvings = 2 + matrix.norm().max(1.0).log2() as i32;
    let small = matrix / 2.0_f64.powi(halvings);
    let series =
        (1..=18).rev().fold(Matrix4::identity(), |sum, n| Matrix4::identity() + small * sum / f64::from(n));
    (0..halvings).fold(series, |power, _| power * power)
}

/// `exp(A t) x` of the mode's first-order system, by scaling and squaring.
fn by_matrix_exponential(mode: &Mode, start: InitialState, time: f64) -> Vector4<f64> {
    let n = mode.porosity;
    let squared = mode.wave_number * mode.wave_number;
    let (ms, mw, d) = (mode.solid_mass, mode.water_mass, mode.drag);
    let kss = squared * (mode.modulus + mode.coupling * (1.0 - n) * (1.0 - n));
    let ksw = squared * mode.coupling * n * (1.0 - n);
    let kww = squared * mode.coupling * n * n;
    #[rustfmt::skip]
    let system = Matrix4::new(
        0.0, 0.0, 1.0, 0.0,
        0.0, 0.0, 0.0, 1.0,
        -kss / ms, -ksw / ms, -d / ms, d / ms,
        -ksw / mw, -kww / mw, d / mw, -d / mw,
    );
    let [u, w] = start.displacement;
    let [v, vw] = start.velocity;
    exponential(system * time) * Vector4::new(u, w, v, vw)
}

proptest! {
    #[test]
    fn free_motion_is_the_matrix_exponential(
        exponent in -3.0..0.0_f64,
        stiffness in 1.0..1e3_f64,
        porosity in 0.1..0.9_f64,
        periods in 0.0..3.0_f64,
        u in -1.0..1.0_f64, w in -1.0..1.0_f64, v in -1.0..1.0_f64, vw in -1.0..1.0_f64,
    ) {
        // Around the passage from over- to underdamped slow waves.
        let column = ColumnParameters { soil: Material { porosity, water_bulk_modulus: stiffness * 1e6, hydraulic_conductivity: 10.0_f64.powf(exponent), ..Material::default() }, ..ColumnParameters::default() };
        let mode = Mode::new(&column, 1.5);
        let frequency = mode.roots.iter().map(|s| s.im).fold(1.0, f64::max);
        let start = InitialState {
            displacement: [u, w],
            velocity: [v * frequency, vw * frequency],
        };
        let time = periods / frequency;
        let expected = by_matrix_exponential(&mode, start, time);
        let computed = mode.amplitude(Drive::Release(start), Growth::None, time);
        let mixture = (1.0 - porosity) * expected[0] + porosity * expected[1];
        prop_assert!((computed.solid - expected[0]).abs() < 1e-10);
        prop_assert!((computed.mixture - mixture).abs() < 1e-10);
        prop_assert!((computed.solid_rate - expected[2]).abs() < 1e-10 * frequency);
    }
}

#[test]
fn confluent_roots_are_no_exception() {
    // Bisect the conductivity onto the double root of the slow waves.
    let mode = |k: f64| {
        let column = ColumnParameters {
            soil: Material { hydraulic_conductivity: k, ..Material::default() },
            ..ColumnParameters::default()
        };
        Mode::new(&column, 1.5)
    };
    let waves = |k: f64| mode(k).roots.iter().filter(|s| s.im > 1e-6 * modulus(**s)).count();
    let (mut over, mut under) = (1e-4, 1.0);
    assert_eq!((waves(over), waves(under)), (1, 2));
    while under / over > 1.0 + 1e-15 {
        let middle = (over * under).sqrt();
        if middle <= over || middle >= under {
            break;
        }
        if waves(middle) == 1 {
            over = middle;
        } else {
            under = middle;
        }
    }
    let start = InitialState { displacement: [1.0, -0.5], velocity: [10.0, 3.0] };
    for k in [over, over * (1.0 + 1e-9), over * 1.001, over * 1.01] {
        let critical = mode(k);
        assert!(k > over * 1.0001 || critical.cluster().is_some());
        for time in [1e-4, 1e-3, 1e-2] {
            let expected = by_matrix_exponential(&critical, start, time);
            let computed = critical.amplitude(Drive::Release(start), Growth::None, time);
            assert!((computed.solid - expected[0]).abs() < 1e-9, "{k} {time}");
            let mixture = 0.7 * expected[0] + 0.3 * expected[1];
            assert!((computed.mixture - mixture).abs() < 1e-9, "{k} {time}");
        }
    }
}
