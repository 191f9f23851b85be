//! The cosine-loaded layer against high-precision values and its limits.

use super::*;
use crate::terzaghi::Terzaghi;

fn seed_layer(length: f64, base: Base, water: Water) -> CosineLayer {
    CosineLayer::new(&ColumnParameters::default(), length, base, water).unwrap()
}

#[test]
fn layer_matches_high_precision_values() {
    let mut worst = [0.0_f64; 3];
    let mut count = 0;
    for line in include_str!("../../tests/reference/cosine_layer.csv").lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        let base = if cells[1] == "rough" { Base::Rough } else { Base::Smooth };
        let water = match cells[2] {
            "compressible" => Water::Compressible,
            _ => Water::Incompressible,
        };
        let layer = seed_layer(number(0), base, water);
        let state = match cells[3] {
            "inf" => layer.drained().unwrap(),
            _ => layer.at(number(3)).unwrap(),
        };
        let y = 1.0 - number(4);
        let [ux, uz, p] = [5, 6, 7].map(number);
        // sin βx = 1 in the middle, cos βx = 1 at x = 0.
        let horizontal = state.fields(0.5 * number(0), y).unwrap().displacement[0];
        let crest = state.fields(0.0, y).unwrap();
        let scale = layer.drained().unwrap().fields(0.0, 1.0).unwrap().displacement[1].abs();
        let errors = [(horizontal - ux) / scale, (-crest.displacement[1] - uz) / scale, crest.pressure - p];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
        count += 1;
    }
    assert_eq!(count, 140);
    assert!(worst.iter().all(|&worst| worst < 2e-13), "{worst:?}");
}

#[test]
fn long_layers_on_a_rough_base_are_terzaghis() {
    let column = ColumnParameters::default();
    let closed = Terzaghi::compressible(&column).unwrap();
    let difference = |length: f64| {
        let state = seed_layer(length, Base::Rough, Water::Compressible).at(0.1).unwrap();
        let at = |zeta: f64| {
            let layer = state.fields(0.0, 1.0 - zeta).unwrap();
            let exact = closed.fields(0.1, zeta).unwrap();
            let settled = (layer.displacement[1] - exact.displacement) / column.final_settlement();
            (layer.pressure - exact.pressure).abs() + settled.abs()
        };
        at(0.0) + at(0.3) + at(1.0)
    };
    let (long, longer, longest) = (difference(20.0), difference(200.0), difference(1000.0));
    // The distance falls with the square of the length, until round-off of the nearly plane waves.
    assert!((long / longer / 100.0 - 1.0).abs() < 0.1, "{long:e} {longer:e}");
    assert!(longest < 1e-4 && longest < longer, "{longest:e}");
}

#[test]
fn boundaries_and_equilibrium_hold() {
    let column = ColumnParameters { height: 0.7, load: 3.0e3, ..ColumnParameters::default() };
    let length = 1.3;
    for base in [Base::Rough, Base::Smooth] {
        let layer = CosineLayer::new(&column, length, base, Water::Compressible).unwrap();
        for (state, drained) in [
            (layer.undrained().unwrap(), false),
            (layer.at(0.03).unwrap(), true),
            (layer.drained().unwrap(), true),
        ] {
            let x = 0.4;
            let load = column.load * (PI * x / length).cos();
            let top = state.fields(x, column.height).unwrap();
            assert!((top.effective_stress[1] - top.pressure + load).abs() < 1e-9);
            assert!(top.effective_stress[3].abs() < 1e-9);
            assert!(!drained || top.pressure.abs() < 1e-9);
            let bottom = state.fields(x, 0.0).unwrap();
            assert!(bottom.displacement[1].abs() < 1e-15);
            match base {
                Base::Rough => assert!(bottom.displacement[0].abs() < 1e-15),
                Base::Smooth => assert!(bottom.effective_stress[3].abs() < 1e-9),
            }
            // ∂σ_xx/∂x + ∂σ_xy/∂y = 0 and ∂σ_xy/∂x + ∂σ_yy/∂y = 0, by central differences.
            let (y, step) = (0.5, 1e-5);
            let total = |x: f64, y: f64| {
                let fields = state.fields(x, y).unwrap();
                let [xx, yy, _, xy] = fields.effective_stress;
                [xx - fields.pressure, yy - fields.pressure, xy]
            };
            let along = |i: usize| (total(x + step, y)[i] - total(x - step, y)[i]) / (2.0 * step);
            let up = |i: usize| (total(x, y + step)[i] - total(x, y - step)[i]) / (2.0 * step);
            assert!((along(0) + up(2)).abs() < 1e-4);
            assert!((along(2) + up(1)).abs() < 1e-4);
        }
    }
}

#[test]
fn limits_are_approached_in_time() {
    let layer = seed_layer(1.0, Base::Rough, Water::Compressible);
    let undrained = layer.undrained().unwrap().fields(0.0, 0.5).unwrap();
    let early = layer.at(1e-7).unwrap().fields(0.0, 0.5).unwrap();
    assert!((early.pressure - undrained.pressure).abs() < 1e-3);
    let drained = layer.drained().unwrap().fields(0.0, 0.5).unwrap();
    for (time_factor, allowed) in [(10.0, 1e-12), (50.0, 1e-12), (1e3, 0.0)] {
        let late = layer.at(time_factor).unwrap().fields(0.0, 0.5).unwrap();
        assert!((late.displacement[1] / drained.displacement[1] - 1.0).abs() <= allowed);
    }
    assert_eq!(
        layer.at(0.0).unwrap().fields(0.0, 1.0).unwrap().pressure,
        layer.undrained().unwrap().fields(0.0, 1.0).unwrap().pressure
    );
    assert!(layer.accuracy(0.05).unwrap().tail_bound < 1e-10);
}

#[test]
fn impossible_questions_are_refused() {
    let column = ColumnParameters::default();
    assert!(CosineLayer::new(&column, 0.0, Base::Rough, Water::Compressible).is_err());
    assert!(CosineLayer::new(&column, f64::NAN, Base::Rough, Water::Compressible).is_err());
    let layer = seed_layer(1.0, Base::Smooth, Water::Incompressible);
    assert!(layer.at(-1.0).is_err());
    let error = layer.undrained().unwrap().fields(0.5, 1.5).unwrap_err();
    assert_eq!(error.to_string(), "the point at 1.5 lies outside the layer, whose height is 1");
}

#[test]
fn the_surface_of_a_layer_of_any_height_is_in_it() {
    for number in 1..=400 {
        let height = 0.003 + 0.008 * f64::from(number);
        let parameters = ColumnParameters { height, ..ColumnParameters::default() };
        let layer = CosineLayer::new(&parameters, height, Base::Rough, Water::Compressible).unwrap();
        assert!(layer.accuracy(0.0).is_ok(), "{height}");
        let state = layer.undrained().unwrap();
        // Places as a mesh makes them: so many cells of a size, or of a share of the height.
        for cells in [3, 7, 10, 49] {
            let size = height / f64::from(cells);
            for y in [size * f64::from(cells), f64::from(cells) * height / f64::from(cells)] {
                assert!(state.amplitudes(y).is_ok(), "{y} of {height}");
            }
        }
        assert!(
            state.amplitudes(height * (1.0 + 1e-9)).is_err() && state.amplitudes(-1e-9 * height).is_err()
        );
    }
}
