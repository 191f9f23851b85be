//! Wave speeds, drag, and the time-step limits that follow from them by formula.

use crate::settings::Drag;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;

/// Speed, m/s, of the fastest wave of the undamped two-phase column at a porosity: the
/// out-of-phase wave, from the largest eigenvalue of `M⁻¹K` (docs/theory.md, Eq. 9).
pub fn fastest_wave_speed(soil: &Material, porosity: f64) -> f64 {
    let (n, coupling) = (porosity, soil.water_bulk_modulus / porosity);
    let (solid, water) = ((1.0 - n) * soil.grain_density, n * soil.water_density);
    let ss = (soil.initial_modulus() + coupling * (1.0 - n) * (1.0 - n)) / solid;
    let ww = coupling * n * n / water;
    let sw_squared = elementary::powi(coupling * n * (1.0 - n), 2) / (solid * water);
    let mean = 0.5 * (ss + ww);
    (mean + (0.25 * (ss - ww) * (ss - ww) + sw_squared).sqrt()).sqrt()
}

/// Speed, m/s, of the undrained wave, in which water moves with the skeleton: `√((E_oed + Q)/ρ)`.
pub fn undrained_wave_speed(soil: &Material) -> f64 {
    let n = soil.porosity;
    let density = (1.0 - n) * soil.grain_density + n * soil.water_density;
    ((soil.initial_modulus() + soil.coupling_modulus()) / density).sqrt()
}

/// Drag of a point, N s/m: of the pores in its volume (m^D), at its volume ratio.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the innermost loops of the step")]
pub fn drag_of_point(soil: &Material, pore_volume: f64, volume_ratio: f64) -> f64 {
    let [drag] = drags_of_points(soil, &[pore_volume], &[volume_ratio]);
    drag
}

/// Drags of some points of one soil.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the innermost loops of the step")]
pub fn drags_of_points<const N: usize>(
    soil: &Material,
    pore_volumes: &[f64; N],
    volume_ratios: &[f64; N],
) -> [f64; N] {
    let weight = soil.unit_weight_of_water();
    let conductivities = soil.law.conductivities(soil.hydraulic_conductivity, volume_ratios);
    let mut drags = *pore_volumes;
    for p in 0..N {
        drags[p] = drags[p] * weight / conductivities[p];
    }
    drags
}

/// Limit, s, of the explicit drag alone (docs/theory.md, Eq. 10):
/// `2 / [(n² γ_w/k)(1/((1−n)ρ_s) + 1/(nρ_w))]`.
pub fn drag_limit(soil: &Material) -> f64 {
    let n = soil.porosity;
    let drag = n * drag_of_point(soil, n, 1.0);
    2.0 / (drag * (1.0 / ((1.0 - n) * soil.grain_density) + 1.0 / (n * soil.water_density)))
}

/// Limit, s, by formula, safe for every method (docs/theory.md, Eq. 11): `Δt_w(√(1+z²) − z)` with `Δt_w = h/c` and
/// `z = Δt_w/(2Δt_d)` where the drag is explicit.
pub fn combined_limit(soil: &Material, cell_size: f64, drag: Drag) -> f64 {
    let wave = cell_size / fastest_wave_speed(soil, soil.porosity);
    match drag {
        Drag::Implicit | Drag::Centred => wave,
        Drag::Explicit => {
            let z = wave / (2.0 * drag_limit(soil));
            // Rationalised: a difference of two large numbers where drag dominates.
            wave / ((1.0 + z * z).sqrt() + z)
        }
    }
}

/// Limit, s, of the semi-implicit integrator, by formula: `(c + √(c² + 4ω²))/ω²` with the
/// frequency `ω² = 4 E_oed/(m h²)` of the shortest wave of the skeleton and its damping
/// `c = γ_w/(k m)`.
///
/// In one dimension incompressible water moves against the skeleton, `n (v_w − v_s) = −v_s`: inertia
/// `m = (1−n)ρ_s + (1−n)²/n ρ_w` and drag `γ_w/k` per volume, taken at the end of the step. Where motions `are_undamped`
/// that move both together, `h/√(E_oed/ρ)` is a second limit: shear in more dimensions, and volumes that a projected
/// storage of the pressure takes in.
pub fn semi_implicit_limit(soil: &Material, cell_size: f64, are_undamped: bool) -> f64 {
    let n = soil.porosity;
    let inertia = (1.0 - n) * soil.grain_density + (1.0 - n) * (1.0 - n) / n * soil.water_density;
    let stiffness = 4.0 * soil.initial_modulus() / (cell_size * cell_size);
    let against =
        skeleton_limit(stiffness, inertia, soil.unit_weight_of_water() / soil.hydraulic_conductivity);
    if !are_undamped {
        return against;
    }
    against.min(skeleton_limit(stiffness, soil.mixture_density(), 0.0))
}

/// Largest step, s, of an explicit skeleton of a stiffness, an inertia and a damping that is taken at the end of the step:
/// `s Δt² = 4 m + 2 c Δt` (docs/theory.md, Eq. 45); beyond it a motion that turns its sign every step grows.
pub fn skeleton_limit(stiffness: f64, inertia: f64, damping: f64) -> f64 {
    (damping + (damping * damping + 4.0 * stiffness * inertia).sqrt()) / stiffness
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_seed_column_has_the_measured_speeds_and_limits() {
        let soil = Material::default();
        assert!((fastest_wave_speed(&soil, 0.3) - 2034.0).abs() < 1.0);
        assert!((undrained_wave_speed(&soil) - 1844.8).abs() < 0.5);
        assert!((drag_limit(&soil) / 5.85e-5 - 1.0).abs() < 2e-3);
    }

    #[test]
    fn the_combined_limit_is_that_of_the_drag_where_drag_dominates() {
        let soil = Material { hydraulic_conductivity: 1e-9, ..Material::default() };
        let limit = combined_limit(&soil, 0.1, Drag::Explicit);
        assert!((limit / drag_limit(&soil) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn waves_are_faster_at_a_lower_porosity() {
        let soil = Material::default();
        let ratio = fastest_wave_speed(&soil, 0.17) / fastest_wave_speed(&soil, 0.3);
        assert!((ratio - 1.22).abs() < 0.01, "22 % faster at n = 0.17, got {ratio}");
    }

    #[test]
    fn a_semi_implicit_step_is_as_long_as_the_shortest_wave_of_the_drained_skeleton_allows() {
        let soil = Material { hydraulic_conductivity: 2e-3, porosity: 0.4, ..Material::default() };
        let inertia = 0.6 * 2650.0 + 0.36 / 0.4 * 1000.0;
        // Of u'' + d u' + s u = 0 with a kick before the drift: s dt^2 = 4 + 2 d dt at the limit.
        let (stiffness, damping) = (1.2e6 / inertia * 1600.0, 9810.0 / (2e-3 * inertia));
        let step = semi_implicit_limit(&soil, 0.05, false);
        let off = stiffness * step * step - 2.0 * damping * step - 4.0;
        assert!(off.abs() < 1e-9 * stiffness * step * step, "{step:e}: {off:e}");
        let undamped = semi_implicit_limit(&soil, 0.05, true);
        let wave = 0.05 / (1.2e6_f64 / (0.6 * 2650.0 + 0.4 * 1000.0)).sqrt();
        assert!((undamped / step.min(wave) - 1.0).abs() < 1e-12, "{undamped:e} {wave:e}");
    }
}
