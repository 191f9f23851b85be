//! Modified Cam-Clay as a law of one's own, against its closed forms.
//!
//! Roscoe & Burland (1968) with the integration of Borja & Lee (1990): an elliptic yield surface that grows with the plastic
//! volume, an associated flow, and a bulk modulus that grows with the mean stress. Here `p` and `q` are compression positive, the
//! stresses of a [`PointState`] tension positive; the specific volume `v` of the small strains is that of the start.
//!
//! ```text
//! q²/M² + p (p − p_c) = 0,   dp = v p/κ dε_v^e,   dp_c = v p_c/(λ − κ) dε_v^p,   G = 3 (1 − 2ν)/(2 (1 + ν)) v p/κ
//! ```

use oedometer_soil::plasticity::{Components, PointLaw, PointState, Tangent, contraction, deviator, mean};
use oedometer_soil::stiffness::Stiffness;

const UNIT: Components = [1.0, 1.0, 1.0, 0.0];
/// Strains by which the tangent is taken by differences.
const NUDGE: f64 = 1e-8;

/// A clay; its state's `yield_stress` is `p_c`.
#[derive(Debug)]
struct ModifiedCamClay {
    /// `M`, the ratio `q/p` of the critical state.
    critical_ratio: f64,
    /// `λ`, slope of first compression over `ln p`.
    compression: f64,
    /// `κ`, slope of swelling.
    swelling: f64,
    /// `v`, specific volume.
    volume: f64,
    /// `ν`.
    poissons_ratio: f64,
}

const CLAY: ModifiedCamClay = ModifiedCamClay {
    critical_ratio: 1.2,
    compression: 0.2,
    swelling: 0.04,
    volume: 2.0,
    poissons_ratio: 0.3,
};

impl ModifiedCamClay {
    /// `G` over the bulk modulus.
    fn shear_share(&self) -> f64 {
        1.5 * (1.0 - 2.0 * self.poissons_ratio) / (1.0 + self.poissons_ratio)
    }

    /// Plastic volume `x` and multiplier `φ` of a step that yields, from the trial state: Newton's iteration on the flow
    /// `x = φ (2p − p_c)` and the yield surface.
    fn yielding(&self, trial: [f64; 2], before: f64, shear: f64) -> [f64; 2] {
        let elastic = self.volume / self.swelling;
        let plastic = self.volume / (self.compression - self.swelling);
        let per_square = 1.0 / self.critical_ratio.powi(2);
        let [mut x, mut multiplier] = [0.0; 2];
        for _ in 0..50 {
            let pressure = trial[0] * (-elastic * x).exp();
            let limit = before * (plastic * x).exp();
            let softening = 1.0 + 6.0 * shear * multiplier * per_square;
            let square = per_square * (trial[1] / softening).powi(2);
            let flow = x - multiplier * (2.0 * pressure - limit);
            let surface = square + pressure * (pressure - limit);
            // Derivatives of both by x and by φ.
            let flow_by =
                [1.0 + multiplier * (2.0 * elastic * pressure + plastic * limit), limit - 2.0 * pressure];
            let surface_by = [
                -elastic * pressure * (2.0 * pressure - limit) - plastic * pressure * limit,
                -12.0 * shear * per_square * square / softening,
            ];
            let per_determinant = 1.0 / (flow_by[0] * surface_by[1] - flow_by[1] * surface_by[0]);
            let change = [
                per_determinant * (flow * surface_by[1] - surface * flow_by[1]),
                per_determinant * (surface * flow_by[0] - flow * surface_by[0]),
            ];
            x -= change[0];
            multiplier -= change[1];
            if change[0].abs() < 1e-15 && surface.abs() < 1e-12 * before * before {
                break;
            }
        }
        [x, multiplier]
    }

    /// The state after a strain increment.
    fn strained(&self, state: &PointState, strain: &Components) -> PointState {
        let elastic = self.volume / self.swelling;
        let pressure = -mean(&state.stress);
        let shear = self.shear_share() * elastic * pressure;
        let (shape, old) = (deviator(strain), deviator(&state.stress));
        let trial: Components = std::array::from_fn(|i| old[i] + 2.0 * shear * shape[i]);
        let size = (1.5 * contraction(&trial, &trial)).sqrt();
        let mut pressure = pressure * (-3.0 * elastic * mean(strain)).exp();
        let (mut limit, mut kept, mut plastic_strain) = (state.yield_stress, 1.0, state.plastic_strain);
        let square = (size / self.critical_ratio).powi(2);
        if square + pressure * (pressure - limit) > 0.0 {
            let [x, multiplier] = self.yielding([pressure, size], limit, shear);
            pressure *= (-elastic * x).exp();
            limit *= (self.volume / (self.compression - self.swelling) * x).exp();
            kept = 1.0 / (1.0 + 6.0 * shear * multiplier / self.critical_ratio.powi(2));
            plastic_strain += 2.0 * multiplier * kept * size / self.critical_ratio.powi(2);
        }
        let stress = std::array::from_fn(|i| kept * trial[i] - pressure * UNIT[i]);
        PointState { stress, yield_stress: limit, plastic_strain }
    }
}

impl PointLaw for ModifiedCamClay {
    fn update(&self, state: &PointState, strain: &Components) -> (PointState, Tangent) {
        let mut tangent = Tangent::default();
        for j in 0..4 {
            let stress = |nudge: f64| {
                let mut strain = *strain;
                strain[j] += nudge;
                self.strained(state, &strain).stress
            };
            let (less, more) = (stress(-NUDGE), stress(NUDGE));
            for i in 0..4 {
                tangent[i][j] = (more[i] - less[i]) / (2.0 * NUDGE);
            }
        }
        (self.strained(state, strain), tangent)
    }
}

/// A clay on its yield surface under an isotropic compression, Pa.
fn normally_consolidated(pressure: f64) -> PointState {
    PointState { stress: UNIT.map(|unit| -pressure * unit), yield_stress: pressure, ..PointState::default() }
}

/// `p` and `q` of a state whose axis is `yy`, compression positive.
fn invariants(state: &PointState) -> [f64; 2] {
    [-mean(&state.stress), state.stress[0] - state.stress[1]]
}

/// Takes a state through many equal increments.
fn strain(law: &impl PointLaw, state: PointState, total: Components, steps: u32) -> PointState {
    let part = total.map(|component| component / f64::from(steps));
    (0..steps).fold(state, |state, _| law.update(&state, &part).0)
}

#[test]
fn an_isotropic_compression_follows_both_lines() {
    // p = p_0 exp(v ε/λ) on the first way, by κ on the way back.
    let virgin = strain(&CLAY, normally_consolidated(1e5), [-0.02, -0.02, -0.02, 0.0], 7);
    let exact = 1e5 * (2.0 * 0.06 / 0.2_f64).exp();
    assert!((invariants(&virgin)[0] / exact - 1.0).abs() < 1e-9, "{virgin:?}");
    let back = strain(&CLAY, virgin, [0.005, 0.005, 0.005, 0.0], 3);
    assert!((invariants(&back)[0] / (exact * (-2.0 * 0.015 / 0.04_f64).exp()) - 1.0).abs() < 1e-9);
    assert_eq!(back.yield_stress, virgin.yield_stress);
}

#[test]
fn an_undrained_triaxial_test_ends_at_the_strength_of_the_critical_state() {
    // Without a change of volume p = p_0 (M²/(M² + η²))^Λ, Λ = 1 − κ/λ, and q = M p_0 2^−Λ at the end.
    let share = 1.0 - CLAY.swelling / CLAY.compression;
    let mut state = normally_consolidated(1e5);
    for _ in 0..20 {
        state = strain(&CLAY, state, [0.0025, -0.005, 0.0025, 0.0], 400);
        let [pressure, shear] = invariants(&state);
        let square = CLAY.critical_ratio.powi(2);
        let exact = 1e5 * (square / (square + (shear / pressure).powi(2))).powf(share);
        assert!((pressure / exact - 1.0).abs() < 1e-3, "{pressure} for {exact}");
    }
    let [pressure, shear] = invariants(&state);
    assert!((pressure / (1e5 * 0.5_f64.powf(share)) - 1.0).abs() < 1e-3, "{pressure}");
    assert!((shear / pressure / CLAY.critical_ratio - 1.0).abs() < 1e-3, "{shear}");
}

#[test]
fn an_oedometer_keeps_the_ratio_of_its_stresses() {
    // Constant η with dε_s = 2/3 dε_v: 2/3 λ = 2 η (λ − κ)/(M² − η²) + η κ/(3 G/K).
    let excess = |ratio: f64| {
        let plastic =
            2.0 * ratio * (CLAY.compression - CLAY.swelling) / (CLAY.critical_ratio.powi(2) - ratio * ratio);
        plastic + ratio * CLAY.swelling / (3.0 * CLAY.shear_share()) - 2.0 / 3.0 * CLAY.compression
    };
    let (mut low, mut high) = (0.0, 0.999 * CLAY.critical_ratio);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { high = middle } else { low = middle }
    }
    let start = strain(&CLAY, normally_consolidated(1e4), [0.0, -0.3, 0.0, 0.0], 6000);
    let [pressure, shear] = invariants(&start);
    assert!((shear / pressure / low - 1.0).abs() < 1e-3, "{} for {low}", shear / pressure);
    // On that way p grows by λ too.
    let end = strain(&CLAY, start, [0.0, -0.1, 0.0, 0.0], 2000);
    let exact = (CLAY.volume * 0.1 / CLAY.compression).exp();
    assert!(
        (invariants(&end)[0] / pressure / exact - 1.0).abs() < 1e-3,
        "{}",
        invariants(&end)[0] / pressure
    );
}

#[test]
fn the_elastic_tangent_is_that_of_the_moduli_of_the_pressure() {
    let state = PointState { yield_stress: 4e5, ..normally_consolidated(1e5) };
    let (_, tangent) = CLAY.update(&state, &[0.0; 4]);
    let bulk = CLAY.volume / CLAY.swelling * 1e5;
    let shear = CLAY.shear_share() * bulk;
    let exact = Stiffness { lame: bulk - 2.0 / 3.0 * shear, shear }.tangent(1.0, 0.0, &[0.0; 4]);
    for (row, of_exact) in tangent.iter().zip(&exact) {
        for (got, exact) in row.iter().zip(of_exact) {
            assert!((got - exact).abs() < 1e-5 * bulk, "{got} for {exact}");
        }
    }
}
