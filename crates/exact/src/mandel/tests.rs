//! Mandel's slab against values of 40 digits, its own Laplace transform, and its limits.

use super::*;
use crate::talbot::{NODES, talbot_contour};
use core::f64::consts::PI;
use nalgebra::Complex;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;

/// The two materials of `crates/exact/tests/reference/make_mandel.py`.
fn slab(case: &str) -> Mandel {
    let seed = ColumnParameters::default();
    let water_bulk_modulus = if case == "seed" { seed.soil.water_bulk_modulus } else { 6e5 };
    Mandel::new(&ColumnParameters { soil: Material { water_bulk_modulus, ..seed.soil }, ..seed })
        .expect("a possible slab")
}

fn to_array(ratios: MandelRatios) -> [f64; 4] {
    [ratios.pressure, ratios.stress, ratios.displacement, ratios.strain]
}

/// Materials at the ends of what is admissible: nearly incompressible, auxetic, soft and stiff water.
fn extremes() -> Vec<Mandel> {
    let mut slabs = Vec::new();
    for poissons_ratio in [-0.999, -0.3, 0.0, 0.25, 0.49, 0.499_999_9] {
        for water_bulk_modulus in [1e3, 6e5, 2.2e9, 1e13] {
            for porosity in [0.01, 0.3, 0.99] {
                let seed = ColumnParameters::default();
                let parameters = ColumnParameters {
                    soil: Material { poissons_ratio, porosity, water_bulk_modulus, ..seed.soil },
                    ..seed
                };
                slabs.push(Mandel::new(&parameters).expect("a possible slab"));
            }
        }
    }
    slabs
}

#[test]
fn the_fields_agree_with_forty_digits() {
    let mut compared = 0;
    for line in include_str!("../../tests/reference/mandel.csv").lines().skip(3) {
        let cells: Vec<&str> = line.split(',').collect();
        let Ok(distance) = cells[3].parse::<f64>() else { continue };
        let number = |place: usize| cells[place].parse::<f64>().expect("a number");
        let computed = to_array(slab(cells[0]).ratios(number(2), distance).expect("inside"));
        for (place, value) in computed.into_iter().enumerate() {
            assert!((value - number(4 + place)).abs() < 1e-12, "{line}: {value} in column {place}");
            compared += 1;
        }
    }
    assert_eq!(compared, 2 * 9 * 5 * 4);
}

#[test]
fn the_pressure_peak_is_the_published_one_and_absent_where_no_pressure_rises() {
    // crates/exact/tests/reference/make_mandel.py: `T`, `p a/F`; the time factor has the drained c_v, T/B_1.
    for (case, time, height, share) in [
        ("seed", 0.068_017_581_9, 0.546_059_661_7, 0.999_836_39),
        ("soft", 0.059_887_797_8, 0.379_067_506_0, 0.625),
    ] {
        let (peak_time, peak) = slab(case).pressure_peak().expect("a peak");
        assert!((peak - height).abs() < 1e-10, "{case}: {peak}");
        assert!((peak_time * share / time - 1.0).abs() < 1e-6, "{case}: {peak_time}");
        // Lower on both sides, by no second formula.
        for aside in [0.99, 1.01] {
            assert!(slab(case).ratios(aside * peak_time, 0.0).expect("inside").pressure < peak);
        }
    }
    let seed = ColumnParameters::default();
    let keeps_its_volume =
        ColumnParameters { soil: Material { water_bulk_modulus: 1e-3, ..seed.soil }, ..seed };
    assert_eq!(Mandel::new(&keeps_its_volume).expect("possible").pressure_peak(), None);
}

#[test]
fn a_slab_reproduces_the_published_case_of_porepy() {
    // examples/mandel_biot.py of PorePy (Keilegavlen et al. 2021), after Mikelić, Wang & Wheeler (2014): a slab of
    // half width 100 m under 6e8 N/m with λ = 1.65e9 Pa, μ = 2.475e9 Pa, a storage of 6.0606e-11 1/Pa, α = 1, a
    // permeability of 9.869e-14 m² and a viscosity of 1e-3 Pa s: E = 5.94e9 Pa, ν = 0.2, B = 1/(1 + S K) = 5/6,
    // ν_u = 0.44, c = 0.46525 m²/s.
    let seed = ColumnParameters::default();
    let unit_weight = seed.soil.unit_weight_of_water();
    let (width, force) = (100.0, 6e8);
    let parameters = ColumnParameters {
        soil: Material {
            youngs_modulus: 5.94e9,
            poissons_ratio: 0.2,
            water_bulk_modulus: seed.soil.porosity / 6.0606e-11,
            hydraulic_conductivity: 9.869e-14 / 1e-3 * unit_weight,
            ..seed.soil
        },
        height: width,
        load: force / width,
        ..seed
    };
    let slab = Mandel::new(&parameters).expect("a possible slab");
    let undrained = 0.2 + slab.groups.kappa * 0.8;
    assert!((undrained - 0.44).abs() < 1e-5, "{undrained}");
    let diffusivity = parameters.soil.coefficient_of_consolidation() * slab.groups.storage_ratio;
    assert!((diffusivity - 0.46525).abs() < 5e-6, "{diffusivity}");
    // F B (1 + ν_u)/(3a): 2.4 MPa.
    let start = slab.fields(0.0, 1.0).expect("inside").pressure;
    assert!((start / (force * 0.83333 * 1.44 / (3.0 * width)) - 1.0).abs() < 1e-5, "{start}");
    // Their own series, of 200 roots found by bisection, at one tenth of the diffusion time in the middle.
    let ratio = 0.8 / 0.24;
    let mut sum = 0.0;
    for root in 0..200 {
        let pole = f64::from(root) * PI;
        let (mut low, mut high) = (pole + PI / 4.0, pole + PI / 2.0 - 2.2204e-9);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if middle.tan() < ratio * middle { low = middle } else { high = middle }
        }
        let (sine, cosine) = low.sin_cos();
        sum += sine / (low - sine * cosine) * (1.0 - cosine) * (-low * low * 0.1).exp();
    }
    let theirs = 2.0 * 0.4 * sum;
    let ours = slab.ratios(0.1 / slab.groups.storage_ratio, 0.0).expect("a time").pressure;
    assert!((ours / theirs - 1.0).abs() < 1e-4, "{ours} for {theirs}");
}

#[test]
fn the_pressure_peaks_at_the_reference_time_and_height() {
    // ../../tests/reference/mandel.csv: T = c t/a², p a/F, and that over the start (40 digits).
    for (case, time, height, over_start) in [
        ("seed", 0.068_017_581_878_9, 0.546_059_661_7, 1.092_238_463_6),
        ("soft-water", 0.059_887_797_7, 0.379_067_506_0, 1.061_389_016_8),
    ] {
        let slab = slab(case);
        let at = |time: f64| slab.ratios(time / slab.groups.storage_ratio, 0.0).expect("a time").pressure;
        let (mut low, mut high) = (0.01, 0.5);
        while high - low > 1e-9 {
            let third = (high - low) / 3.0;
            if at(low + third) < at(high - third) { low += third } else { high -= third }
        }
        // A maximum is flat: half of the digits tell its time.
        assert!((low - time).abs() < 1e-7, "{case}: {low}");
        assert!((at(low) - height).abs() < 1e-10, "{case}: {}", at(low));
        assert!((at(low) / at(0.0) - over_start).abs() < 1e-10);
    }
}

/// The ratios from their Laplace transforms (methods: `e(s)`, `p(x, s)` and `u_x` of the balances), by
/// another inversion.
fn by_laplace(slab: &Mandel, time: f64, distance: f64) -> [f64; 4] {
    let Groups { poissons_ratio: nu, kappa, start, .. } = slab.groups;
    let mut sums = [0.0; 3];
    for (z, weight) in talbot_contour(NODES) {
        let s = z / time;
        let r = elementary::sqrt_complex(s);
        let exp = |way: f64| elementary::exp_complex(-r * way);
        let unit = Complex::new(1.0, 0.0);
        let denominator = unit + exp(2.0);
        let tanh = (unit - exp(2.0)) / denominator;
        let plates = (r * (r - tanh * kappa)).inv();
        let shape = (exp(1.0 - distance) + exp(1.0 + distance)) / denominator;
        let within = (exp(1.0 - distance) - exp(1.0 + distance)) / denominator / r;
        for (sum, value) in sums.iter_mut().zip([plates, plates * shape, plates * within]) {
            *sum += (weight * value).re / time;
        }
    }
    let [plates, drained, within] = sums;
    let strain = 0.5 * (1.0 - nu) * (1.0 - kappa) * plates;
    let displacement = 0.5 * kappa * (plates * distance - within) + nu / (1.0 - nu) * strain * distance;
    [start * (plates - drained), plates - kappa * drained, displacement, strain]
}

#[test]
fn the_laplace_transform_gives_the_same_fields() {
    for slab in extremes() {
        for time in [1e-4, 3e-3, 0.019, 0.021, 0.3, 4.0] {
            for distance in [0.0, 0.4, 0.9, 1.0] {
                let computed =
                    to_array(slab.ratios(time / slab.groups.storage_ratio, distance).expect("inside"));
                for (value, other) in computed.into_iter().zip(by_laplace(&slab, time, distance)) {
                    assert!((value - other).abs() < 2e-12, "{slab:?} {time} {distance}: {value} for {other}");
                }
            }
        }
    }
}

#[test]
fn the_closed_form_of_short_times_is_the_series() {
    for slab in extremes() {
        for time in [1e-6, 1e-4, 0.005, 0.02, 0.03] {
            for distance in [0.0, 0.5, 0.98, 1.0] {
                let terms = series::terms(time);
                let long = to_array(series::sum(&slab.groups, time, distance, terms));
                let closed = to_array(early::ratios(&slab.groups, time, distance));
                for (value, other) in long.into_iter().zip(closed) {
                    let rest = series::bound(time, terms) + early::bound(&slab.groups, time);
                    assert!(
                        (value - other).abs() < rest + 3e-14,
                        "{slab:?} {time} {distance}: {value} {other}"
                    );
                }
            }
        }
    }
}

#[test]
fn omitted_terms_are_within_their_bound() {
    for slab in extremes() {
        for distance in [0.0, 0.7, 1.0] {
            let time = 0.1;
            let converged = to_array(series::sum(&slab.groups, time, distance, 20));
            for terms in 1..4 {
                let cut = to_array(series::sum(&slab.groups, time, distance, terms));
                let bound = series::bound(time, terms);
                for (value, other) in cut.into_iter().zip(converged) {
                    assert!((value - other).abs() <= bound + 1e-15, "{terms}: {value} for {other}, {bound}");
                }
            }
            // Later than it is used, where what it leaves out shows.
            let closed = to_array(early::ratios(&slab.groups, time, distance));
            for (value, other) in closed.into_iter().zip(converged) {
                let bound = early::bound(&slab.groups, time);
                assert!(
                    (value - other).abs() <= bound + 1e-14 && bound < 0.1,
                    "{value} for {other}, {bound}"
                );
            }
        }
    }
    assert!(slab("seed").accuracy(0.0199).expect("a time").tail_bound < 1e-19);
}

#[test]
fn every_root_solves_the_equation_in_its_own_interval() {
    for slab in extremes() {
        let kappa = slab.groups.kappa;
        assert!(kappa > 0.0 && kappa <= 0.75, "{kappa}");
        for index in [0, 1, 2, 10, 1000] {
            let gap = series::gap_below_pole(kappa, index);
            let root = (index as f64 + 0.5) * PI - gap;
            assert!(gap > 0.0 && root > index as f64 * PI);
            // tan α = cot δ = α/κ
            assert!((root * elementary::tan(gap) / kappa - 1.0).abs() < 1e-13, "{kappa} {index}");
        }
    }
    // methods: α_0 of both materials.
    for (case, root) in [("seed", 1.324_225_891_702_15), ("soft-water", 1.402_652_657_454_25)] {
        let computed = 0.5 * PI - series::gap_below_pole(slab(case).groups.kappa, 0);
        assert!((computed - root).abs() < 1e-13, "{case}: {computed}");
    }
}

#[test]
fn it_starts_undrained_and_ends_drained() {
    for slab in extremes() {
        let nu = slab.parameters.soil.poissons_ratio;
        let start = slab.ratios(0.0, 0.3).expect("the start");
        // An undrained element under a plane load: every water is in place.
        assert!((start.stress - 1.0).abs() < 1e-14);
        let undrained = nu + slab.groups.kappa * (1.0 - nu);
        assert!((start.displacement - 0.5 * 0.3 * undrained).abs() < 1e-14);
        assert!((start.strain - 0.5 * (1.0 - undrained)).abs() < 1e-14);
        let end = slab.ratios(100.0 / slab.groups.storage_ratio, 0.3).expect("the end");
        assert!(end.pressure.abs() < 1e-14 && (end.stress - 1.0).abs() < 1e-14);
        assert!((end.displacement - 0.5 * 0.3 * nu).abs() < 1e-14);
        assert!((end.strain - 0.5 * (1.0 - nu)).abs() < 1e-14);
    }
    assert_eq!(
        slab("seed").ratios(0.1, 1.2).expect_err("outside").to_string(),
        "the distance x/a must lie between 0 (middle) and 1 (drained side), got 1.2"
    );
}
