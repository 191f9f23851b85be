//! Layers that differ in every key, in a column in which no two numbers are equal: settlement and pressure hold each other.

use oedometer_exact::numerics::integrate;
use oedometer_exact::{ColumnParameters, Reference, ReferenceKind};
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;

/// Thickness, E, ν, n, `K_w` and k of the layers from the base up.
const LAYERS: [[f64; 6]; 3] = [
    [0.7, 3e6, 0.31, 0.42, 5e7, 2e-6],
    [0.4, 8e5, 0.12, 0.55, 9e6, 7e-8],
    [1.2, 1.7e6, 0.23, 0.36, 2e7, 5e-7],
];

fn column() -> ColumnParameters {
    let layers = LAYERS.map(|[thickness, young, nu, n, water, k]| SoilLayer {
        thickness,
        youngs_modulus: Some(young),
        poissons_ratio: Some(nu),
        porosity: Some(n),
        water_bulk_modulus: Some(water),
        hydraulic_conductivity: Some(k),
    });
    let soil =
        Material { youngs_modulus: 2.1e6, poissons_ratio: 0.28, porosity: 0.47, ..Material::default() };
    ColumnParameters {
        height: 2.3,
        load: 3.4e4,
        soil: Material { water_density: 1030.0, gravity: 9.7, ..soil },
        soils: SoilLayers::from_slice(&layers).expect("three"),
        ..ColumnParameters::default()
    }
}

/// `∫ (q − p)/E_oed dy` between two heights, layer by layer, fine towards the faces.
fn compressed(reference: &Reference, column: &ColumnParameters, time: f64, top: f64) -> f64 {
    let (mut bottom, mut sum) = (0.0, 0.0);
    for [thickness, young, nu, ..] in LAYERS {
        let modulus = young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let upper = (bottom + thickness).min(top);
        let strain = |y: f64| {
            let zeta = 1.0 - y / column.height;
            (column.load - reference.fields(time, zeta).expect("inside").pressure) / modulus
        };
        // y = bottom + (1 − cos φ)/2 of the layer: places are dense at both of its faces.
        let along = |phi: f64| {
            let half = 0.5 * (upper - bottom);
            strain(bottom + half * (1.0 - phi.cos())) * half * phi.sin()
        };
        if upper > bottom {
            sum += integrate(along, 0.0, std::f64::consts::PI, 100);
        }
        bottom += thickness;
    }
    sum
}

#[test]
fn the_settlement_is_the_integral_of_the_pressures_at_all_times() {
    let column = column();
    // By the transform, by the series, and at the start and long after.
    for time in [0.0, 1e-6, 1e-4, 0.03, 1.0, 30.0] {
        let reference = Reference::new(ReferenceKind::Layered, &column, &[time]).expect("a column");
        let settlement = reference.settlement(time).expect("a time");
        let wanted = compressed(&reference, &column, time, column.height);
        assert!((settlement / wanted - 1.0).abs() < 1e-9, "{time}: {settlement:e} {wanted:e}");
        // In the middle of each layer too, and just above a face.
        for y in [0.35, 0.7 + 1e-6, 1.7] {
            let zeta = 1.0 - y / column.height;
            let moved = -reference.fields(time, zeta).expect("inside").displacement;
            let wanted = compressed(&reference, &column, time, y);
            assert!((moved / wanted - 1.0).abs() < 1e-8, "{time} {y}: {moved:e} {wanted:e}");
        }
    }
}

#[test]
fn each_layer_starts_with_the_pressure_of_its_own_soil_and_ends_with_its_own_strain() {
    let column = column();
    let reference = Reference::new(ReferenceKind::Layered, &column, &[0.0]).expect("a column");
    let (mut bottom, mut total) = (0.0, 0.0);
    for [thickness, young, nu, n, water, _] in LAYERS {
        let modulus = young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let zeta = 1.0 - (bottom + 0.5 * thickness) / column.height;
        let ratio = reference.fields(0.0, zeta).expect("inside").pressure / column.load;
        assert!((ratio * (1.0 + n * modulus / water) - 1.0).abs() < 1e-14, "{ratio}");
        (bottom, total) = (bottom + thickness, total + column.load * thickness / modulus);
    }
    assert!((reference.displacement_scale().expect("a scale") / total - 1.0).abs() < 1e-14);
}
