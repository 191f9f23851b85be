//! Dimensionless groups of a case, and where they leave a quasi-static reference behind.

use crate::case::Case;
use crate::elementary;
use crate::exact::reference::ReferenceKind;
use crate::mpm::critical_step::formula;
use crate::mpm::run::integrator::Formulation;
use crate::record::Groups;

/// The groups of a case whose largest step was a share of its limit.
pub fn groups(case: &Case, step_over_limit: f64) -> Groups {
    let soil = &case.material;
    Groups {
        storage: soil.oedometric_modulus() / soil.coupling_modulus(),
        finite_strain: case.column.load / soil.oedometric_modulus(),
        inertia: soil.coefficient_of_consolidation()
            / (case.column.height * formula::undrained_wave_speed(soil)),
        step_over_limit,
    }
}

/// Change of the slowest rate of consolidation by the skeleton's inertia beyond which the quasi-static
/// references do not hold. Terzaghi's settlement at `T_v = 0.05` is then 2 in a thousand off that of the
/// column with its inertia (both exact), and the gap grows in proportion.
const MOST_INERTIA: f64 = 1e-3;

/// Why a quasi-static reference does not hold for a case that is solved with its inertia, where it does
/// not. A scene of waves is about that difference and measures it.
pub fn inertia_rules(case: &Case, reference: ReferenceKind) -> Option<String> {
    // The undrained start is an equilibrium, whatever comes after it.
    let moves = case.time_factors.iter().any(|time_factor| *time_factor > 0.0);
    let has_inertia = moves && case.formulation != Formulation::QuasiStatic;
    let change = skeleton_inertia(case);
    let holds = change <= MOST_INERTIA;
    (has_inertia && !case.scene.has_waves() && !holds).then(|| {
        format!(
            "`{}` is quasi-static and does not hold: the skeleton's inertia changes the rate of consolidation by \
             {change:.1e}, more than {MOST_INERTIA:.0e}",
            reference.name()
        )
    })
}

/// Relative change of the slowest rate of consolidation by the inertia of the skeleton.
///
/// Water that cannot be compressed moves against the skeleton: a mode of wave number `κ = π/(2H)` has
/// `m ü + (γ_w/k) u̇ + κ² E_oed u = 0` with `m = (1−n)ρ_s + (1−n)²/n ρ_w`, and its slower rate is
/// `c_v κ² (1 + δ + …)` with `δ = (κ c_v)² m/E_oed`.
fn skeleton_inertia(case: &Case) -> f64 {
    let soil = &case.material;
    let n = soil.porosity;
    let inertia = (1.0 - n) * soil.grain_density + (1.0 - n) * (1.0 - n) / n * soil.water_density;
    let wave_number = std::f64::consts::FRAC_PI_2 / case.column.height;
    elementary::powi(wave_number * soil.coefficient_of_consolidation(), 2) * inertia
        / soil.oedometric_modulus()
}
