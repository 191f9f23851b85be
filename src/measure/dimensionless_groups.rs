//! Dimensionless groups of a case, and when they rule out a quasi-static reference.

use crate::case::Case;
use crate::record::Groups;
use oedometer_exact::ReferenceKind;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::time_step::TimeStep;
use oedometer_problem::wave_speeds;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;

/// The groups of a case whose largest step was a share of its limit; of layers those of the soil in which they are largest.
pub fn groups(case: &Case, step_over_limit: f64) -> Groups {
    let largest = |group: &dyn Fn(&Material) -> f64| {
        case.soils().iter().map(|(_, soil)| group(soil)).fold(0.0, f64::max)
    };
    Groups {
        storage: largest(&|soil| soil.oedometric_modulus() / soil.coupling_modulus()),
        finite_strain: largest(&|soil| case.column.pressure_scale() / soil.oedometric_modulus()),
        inertia: largest(&|soil| {
            soil.coefficient_of_consolidation()
                / (case.column.height * wave_speeds::undrained_wave_speed(soil))
        }),
        step_over_limit,
    }
}

/// Change of the slowest rate of consolidation by the skeleton's inertia beyond which the quasi-static
/// references do not hold. Terzaghi's settlement at `T_v = 0.05` is then 2 in a thousand off that of the
/// column with its inertia (both exact), and the gap grows in proportion.
const MOST_INERTIA: f64 = 1e-3;

/// Inertia of the water's own motion over its drag, in the slowest wave, from which on `u-p` is another problem than one
/// that keeps that inertia: at 0.1, the seed column's, both agree to the mesh.
const MOST_RELATIVE_INERTIA: f64 = 0.3;
/// Share of the slowest wave that steps may have taken at an output beyond what the drag took of it.
const MOST_DAMPED: f64 = 0.1;

/// Why a reference does not hold for a case: it neglects the inertia that the case is solved with, or the case neglects
/// or damps the waves of the reference.
pub fn inertia_rules(case: &Case, reference: ReferenceKind) -> Option<String> {
    // The undrained start is an equilibrium.
    let moves = case.time_factors.iter().any(|time_factor| *time_factor > 0.0);
    if !moves || case.formulation == Formulation::QuasiStatic || case.scene.motion.is_some() {
        return None;
    }
    let name = reference.name();
    if case.scene.waves {
        let wave = SlowestWave::of(case);
        // A load that grows over many periods excites no waves.
        if case.column.loading_time * wave.frequency > LONG_LOADING {
            return None;
        }
        let relative = wave.relative_inertia;
        if case.formulation == Formulation::UP && relative > MOST_RELATIVE_INERTIA {
            return Some(format!(
                "`{name}` does not apply: the relative inertia of the water is {relative:.1e} of its drag, \
                 more than {MOST_RELATIVE_INERTIA}, and `u-p` neglects it"
            ));
        }
        let damped = wave.damped_by_steps(case);
        return (damped > MOST_DAMPED).then(|| {
            format!(
                "`{name}` does not apply: semi-implicit steps damp {damped:.2} of the slowest wave, more \
                 than {MOST_DAMPED}"
            )
        });
    }
    let change = skeleton_inertia(case);
    let holds = change <= MOST_INERTIA;
    (!holds).then(|| {
        format!(
            "`{name}` is quasi-static and does not apply: the skeleton's inertia changes the rate of \
             consolidation by \
             {change:.1e}, more than {MOST_INERTIA:.0e}"
        )
    })
}

/// Phase, rad, of the slowest wave over which a load grows so slowly that nothing rings.
const LONG_LOADING: f64 = 20.0;

/// The slowest undrained wave of a column, `κ = π/(2H)`, in which the water moves with the skeleton.
struct SlowestWave {
    /// `ω = κ √((E_oed + Q)/ρ)`, rad/s.
    frequency: f64,
    /// `ω k/(n g)`: inertia of the water's own motion over its drag.
    relative_inertia: f64,
    /// Rate, 1/s, at which the drag damps it: `κ² X² k/(2 γ_w (E_oed + Q))` with `X = Q − ρ_w (E_oed + Q)/ρ`, half the
    /// power of the flow `(k/γ_w) X κ² u` over the wave's energy.
    damping: f64,
}

impl SlowestWave {
    fn of(case: &Case) -> Self {
        let soil = &case.material;
        let wave_number = std::f64::consts::FRAC_PI_2 / case.column.height;
        let speed = wave_speeds::undrained_wave_speed(soil);
        let frequency = wave_number * speed;
        let undrained = soil.oedometric_modulus() + soil.coupling_modulus();
        let driving = soil.coupling_modulus() - soil.water_density * speed * speed;
        let conductance = soil.hydraulic_conductivity / soil.unit_weight_of_water();
        let driven = wave_number * driving;
        Self {
            frequency,
            relative_inertia: frequency * soil.hydraulic_conductivity / (soil.porosity * soil.gravity),
            damping: 0.5 * conductance * driven * driven / undrained,
        }
    }

    /// Largest share of the wave, over the outputs, that the drag leaves and backward Euler's steps of the pressure do
    /// not: `exp(−δ t) (1 − exp(−ω² Δt t/2))`.
    fn damped_by_steps(&self, case: &Case) -> f64 {
        if case.integrator != IntegratorKind::SemiImplicit {
            return 0.0;
        }
        let limit =
            wave_speeds::semi_implicit_limit(&case.material, case.cell_size(), case.has_undamped_motions());
        let step = match case.time_step {
            TimeStep::Growth(_) | TimeStep::Tolerance(_) => return 0.0,
            rule => rule.first(&case.step_scales(limit)),
        };
        let by_steps = 0.5 * self.frequency * self.frequency * step;
        let seconds = case.seconds_per_time_factor();
        let lost = case.time_factors.iter().map(|factor| {
            let time = factor * seconds;
            -elementary::exp(-self.damping * time) * elementary::exp_m1(-by_steps * time)
        });
        lost.fold(0.0, f64::max)
    }
}

/// Relative change of the slowest rate of consolidation by the inertia of the skeleton.
///
/// Water that cannot be compressed moves against the skeleton: a mode of wave number `κ = π/(2H)` has
/// `m ü + (γ_w/k) u̇ + κ² E_oed u = 0` with `m = (1−n)ρ_s + (1−n)²/n ρ_w`, and its slower rate is
/// `c_v κ² (1 + δ + …)` with `δ = (κ c_v)² m/E_oed`.
///
/// Of layers it is the largest: what each takes of the settlement times its own `δ`, as far as its motion is not over before
/// that of the slowest one by the first output.
fn skeleton_inertia(case: &Case) -> f64 {
    let wave_number = std::f64::consts::FRAC_PI_2 / case.column.height;
    let soils = case.soils();
    let compression = |(thickness, soil): &(f64, Material)| thickness / soil.oedometric_modulus();
    let whole: f64 = soils.iter().map(compression).sum();
    // Rate at which a motion ends, 1/s: by the flow, or by the drag where it oscillates.
    let motion = |soil: &Material| {
        let n = soil.porosity;
        let mass = (1.0 - n) * soil.grain_density + (1.0 - n) * (1.0 - n) / n * soil.water_density;
        let flow = wave_number * soil.coefficient_of_consolidation();
        let change = flow * flow * mass / soil.oedometric_modulus();
        let by_drag = 0.5 * soil.unit_weight_of_water() / (soil.hydraulic_conductivity * mass);
        (change, (wave_number * flow).min(by_drag))
    };
    let slowest = soils.iter().map(|(_, soil)| motion(soil).1).fold(f64::INFINITY, f64::min);
    let first =
        case.time_factors.iter().copied().filter(|factor| *factor > 0.0).fold(f64::INFINITY, f64::min);
    let first = first * case.seconds_per_time_factor();
    let of_layer = |layer: &(f64, Material)| {
        let (change, rate) = motion(&layer.1);
        change * compression(layer) / whole * elementary::exp(-(rate - slowest) * first)
    };
    soils.iter().map(of_layer).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    #[test]
    fn the_inertia_of_the_skeleton_is_what_slows_the_slowest_mode() {
        let text = "title = 't'\nscene = 'terzaghi'\ncolumn.height = 2.3\nmaterial.hydraulic_conductivity = 1e-3\n\
                    [[sweep]]\nmethod = ['MPM']\ncells = [8]\n";
        let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
        let case = Study::check(&source).expect("sound").planned[0].case.clone();
        // The roots of m s² − (γ_w/k) s + κ² E_oed = 0 themselves.
        let (soil, kappa) = (&case.material, std::f64::consts::FRAC_PI_2 / 2.3);
        let (grains, drag) = (1.0 - soil.porosity, 1000.0 * 9.81 / 1e-3);
        let mass = grains * 2650.0 + grains * grains / soil.porosity * 1000.0;
        let stiffness = kappa * kappa * soil.oedometric_modulus();
        let slower = 2.0 * stiffness / (drag + (drag * drag - 4.0 * mass * stiffness).sqrt());
        let expected = slower * drag / stiffness - 1.0;
        let found = skeleton_inertia(&case);
        assert!((found / expected - 1.0).abs() < 1e-3, "{found:e} for {expected:e}");
    }

    #[test]
    fn layers_have_the_inertia_of_the_soil_that_moves_most() {
        let case = |layers: &str, first: f64| {
            let text = format!(
                "title = 't'\nscene = 'layered'\noutput.time_factors = [{first:e}, 1.0]\ncolumn.soils = [{layers}]\n\
                 [[sweep]]\nmethod = ['MPM']\nintegrator = ['explicit']\ncells = [8]\n"
            );
            let source = StudySource { name: "t.toml".to_owned(), text };
            Study::check(&source).expect("sound").planned[0].case.clone()
        };
        let tight = "{thickness = 0.25}";
        let open = "{thickness = 0.75, hydraulic_conductivity = 1e-1}";
        let equal = case(&format!("{tight}, {{thickness = 0.75}}"), 0.1);
        let alone = skeleton_inertia(&equal);
        for layers in [format!("{tight}, {open}"), format!("{open}, {tight}")] {
            // A thousand times the flow in three quarters of the settlement: a motion that rings for a second.
            let early = skeleton_inertia(&case(&layers, 1e-9));
            assert!((early / (1e6 * alone) - 1.0).abs() < 1e-3, "{early:e} for {alone:e}");
            let told = inertia_rules(&case(&layers, 1e-9), ReferenceKind::Layered).expect("it does not hold");
            let said = "`layered` is quasi-static and does not apply: the skeleton's inertia changes the \
                        rate of consolidation by ";
            assert!(told.starts_with(said) && told.ends_with(", more than 1e-3"), "{told}");
            // It is over long before the tight layer has drained.
            let late = case(&layers, 0.5);
            assert!((skeleton_inertia(&late) / (0.25 / 0.75 * alone) - 1.0).abs() < 1e-3);
            assert_eq!(inertia_rules(&late, ReferenceKind::Layered), None);
            assert!((groups(&late, 0.5).inertia / groups(&equal, 0.5).inertia - 1e3).abs() < 1e-6);
        }
        // A layer counts by what it takes of the settlement, not by its thickness.
        let stiffness = equal.material.youngs_modulus;
        for (ratio, expected) in [(4.0, 4.0 * 3.0 / 7.0), (0.25, 0.25 * 12.0 / 13.0)] {
            let other = format!("{{thickness = 0.75, youngs_modulus = {:e}}}", ratio * stiffness);
            for layers in [format!("{tight}, {other}"), format!("{other}, {tight}")] {
                let found = skeleton_inertia(&case(&layers, 1e-9)) / (alone / 0.75);
                assert!((found / expected - 1.0).abs() < 1e-3, "{found:e} for {expected:e}: {layers}");
            }
        }
    }

    #[test]
    fn what_steps_damp_of_a_wave_is_the_most_of_all_outputs() {
        let mut case = Case::seed(crate::case::Task::Solve, &oedometer_scenes::DYNAMIC_COLUMN);
        (case.integrator, case.time_step) = (IntegratorKind::SemiImplicit, TimeStep::Seconds(1e-4));
        let wave = SlowestWave::of(&case);
        let unit = 1.0 / case.seconds_per_time_factor();
        let damped = |case: &mut Case, times: &[f64]| {
            case.time_factors = times.to_vec().into();
            wave.damped_by_steps(case)
        };
        // Later than it takes the soil to damp the wave nothing is left to damp.
        let mut times = [0.01, 0.1, 100.0].map(|share| share * unit / wave.damping);
        let each = times.map(|time| damped(&mut case, &[time]));
        let most = each.into_iter().fold(0.0, f64::max);
        assert!(most > each[0] && most > each[2], "{each:?}");
        for _ in 0..3 {
            assert_eq!(damped(&mut case, &times), most, "{times:?}");
            times.rotate_left(1);
        }
        // Every rule has the steps that it means.
        case.cells = 50;
        let soil = case.material.clone();
        let limit = wave_speeds::semi_implicit_limit(&soil, case.cell_size(), case.has_undamped_motions());
        let crossing = case.cell_size() / wave_speeds::fastest_wave_speed(&soil, soil.porosity);
        let mut by = |rule: TimeStep| {
            case.time_step = rule;
            damped(&mut case, &times)
        };
        for (rule, step) in [(TimeStep::Stable(0.5), 0.5 * limit), (TimeStep::Courant(0.5), 0.5 * crossing)] {
            assert_eq!(by(rule), by(TimeStep::Seconds(step)));
            assert!(by(rule) > by(TimeStep::Seconds(0.5 * step)), "{rule:?}");
        }
        for rule in [TimeStep::Growth(0.5), TimeStep::Tolerance(1e-3)] {
            assert_eq!(by(rule), 0.0, "{rule:?} is not taken with these steps");
        }
    }

    #[test]
    fn waves_rule_out_a_case_that_leaves_out_or_damps_what_they_need() {
        // Stiffness, height, and porosity each change the slowest wave.
        for (porosity, height, stiffness) in
            [(0.3, 1.0, 1e6), (0.5, 1.0, 1e6), (0.2, 1.0, 1e6), (0.3, 3.0, 1e6), (0.3, 1.0, 1e8)]
        {
            let mut case = Case::seed(crate::case::Task::Solve, &oedometer_scenes::DYNAMIC_COLUMN);
            case.column.height = height;
            case.column.loading_time = 0.0;
            case.material.porosity = porosity;
            case.material.youngs_modulus = stiffness;
            case.material.poissons_ratio = 0.0;
            case.material.water_bulk_modulus = 2e9;
            case.material.grain_density = 2650.0;
            case.material.water_density = 1000.0;
            case.material.gravity = 9.81;
            (case.integrator, case.formulation) = (IntegratorKind::Explicit, Formulation::UP);
            case.time_factors = vec![0.0, 1e-3].into();
            let density = (1.0 - porosity) * 2650.0 + porosity * 1000.0;
            let speed: f64 = ((stiffness + 2e9 / porosity) / density).sqrt();
            let frequency = 0.5 * std::f64::consts::PI / height * speed;
            // `ω k/(n g)` at the limit.
            let conductivity = 0.3 * porosity * 9.81 / frequency;
            let rules = |change: &dyn Fn(&mut Case)| {
                let mut case = case.clone();
                change(&mut case);
                inertia_rules(&case, ReferenceKind::Terzaghi).unwrap_or_default()
            };
            let open = |case: &mut Case| case.material.hydraulic_conductivity = 1.02 * conductivity;
            let told = rules(&open);
            let open_soil = "`terzaghi` does not apply: the relative inertia of the water is 3.1e-1 of its \
                             drag, more than 0.3, and `u-p` neglects it";
            assert_eq!(told, open_soil);
            let semi_implicit = |case: &mut Case, step: f64| {
                open(case);
                case.formulation = Formulation::VW;
                case.integrator = IntegratorKind::SemiImplicit;
                case.time_step = TimeStep::Seconds(step);
                case.time_factors = vec![1.0 / (frequency * case.seconds_per_time_factor())].into();
            };
            // One radian of the wave: steps take `1 − exp(−ω Δt/2)` of it, and the drag a share that is small here.
            for (what, found) in [
                ("a tight soil", rules(&|case| case.material.hydraulic_conductivity = 0.98 * conductivity)),
                (
                    "the water's own inertia",
                    rules(&|case| (open(case), case.formulation = Formulation::VW).1),
                ),
                ("no inertia", rules(&|case| (open(case), case.formulation = Formulation::QuasiStatic).1)),
                ("the start alone", rules(&|case| (open(case), case.time_factors = vec![0.0].into()).1)),
                ("a slow load", rules(&|case| (open(case), case.column.loading_time = 20.2 / frequency).1)),
                ("short steps", rules(&|case| semi_implicit(case, 0.1 / frequency))),
            ] {
                assert_eq!(found, "", "{what}: {porosity} {height} {stiffness}");
            }
            let fast = rules(&|case| (open(case), case.column.loading_time = 19.8 / frequency).1);
            assert_eq!(fast, told, "a load that is fast enough");
            let damped = rules(&|case| semi_implicit(case, 1.0 / frequency));
            let (said, rest) = damped.split_once("damp ").expect("a share");
            assert_eq!(said, "`terzaghi` does not apply: semi-implicit steps ");
            assert!(
                rest.starts_with("0.") && rest.ends_with(" of the slowest wave, more than 0.1"),
                "{damped}"
            );
        }
    }
}
