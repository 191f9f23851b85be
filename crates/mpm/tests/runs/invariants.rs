//! What holds of the solver whatever the numbers: scaling of units, linearity, balances, and the
//! equalities between methods that theory demands on the regular lattice.

use crate::column_problem;
use crate::run;
use oedometer_mpm::run::{Kernel, Schedule};
use oedometer_mpm::time_limit::TimeLimit;
use oedometer_problem::method::{Configuration, Method};
use oedometer_problem::outcome::Outcome;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::snapshot::Snapshot;
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::Column;
use oedometer_scenes::{Scene, TERZAGHI};
use oedometer_soil::material::Material;
use proptest::prelude::*;

/// A run in dimensionless words, small enough for many of them.
#[derive(Clone, Debug)]
struct Setup {
    scene: &'static Scene,
    column: Column,
    soil: Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
    settings: ExplicitSettings,
    rule: TimeStep,
    kernel: Kernel,
    time_factors: Vec<f64>,
}

impl Setup {
    fn new(method: &str) -> Self {
        Self {
            scene: &TERZAGHI,
            column: Column::default(),
            soil: Material::default(),
            method: Method::named(method).expect("a known method"),
            cells: 5,
            points_per_cell: 2,
            settings: ExplicitSettings::default(),
            rule: TimeStep::Stable(0.8),
            kernel: Kernel::Fastest,
            time_factors: vec![0.0, 0.02, 0.05],
        }
    }

    fn moving(mut self) -> Self {
        self.method.configuration = Some(Configuration::Updated);
        self
    }

    /// Runs to the last output, which every test here must reach.
    fn solve(&self) -> Outcome {
        let problem = column_problem::<1>(
            self.scene,
            &self.column,
            &self.soil,
            self.method,
            self.cells,
            self.points_per_cell,
        )
        .expect("a possible column");
        let seconds = self.column.height * self.column.height / self.soil.coefficient_of_consolidation();
        let schedule = Schedule {
            integrator: oedometer_problem::integrator::IntegratorKind::Explicit,
            critical_step: None,
            formulation: oedometer_problem::integrator::Formulation::VW,
            threads: 1,
            time_limit: TimeLimit::default(),
            outputs: self.time_factors.iter().map(|factor| factor * seconds).collect(),
            history: Vec::new(),
            notes_energy: false,
            time_step: self.rule,
            settings: self.settings,
            kernel: self.kernel,
        };
        let outcome = run(problem, &schedule);
        assert_eq!(outcome.status, Ok(()), "{self:?}");
        assert_eq!(outcome.snapshots.len(), self.time_factors.len());
        outcome
    }

    fn end(&self) -> Snapshot {
        self.solve().snapshots.pop().expect("an output")
    }

    /// Settlement over `q H/E_oed`, and pressures over `q`.
    fn dimensionless(&self) -> Vec<f64> {
        let final_settlement = self.column.load * self.column.height / self.soil.oedometric_modulus();
        let mut numbers = Vec::new();
        for snapshot in self.solve().snapshots {
            numbers.push(snapshot.settlement / final_settlement);
            numbers.extend(snapshot.points.pressure.iter().map(|pressure| pressure / self.column.load));
            numbers.extend(snapshot.points.effective_stress.iter().map(|stress| stress / self.column.load));
        }
        numbers
    }
}

/// Largest difference over the largest size of the second.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(0.0, |scale: f64, x| scale.max(x.abs()));
    a.iter().zip(b).fold(0.0, |largest: f64, (x, y)| largest.max((x - y).abs())) / scale
}

fn field_difference(a: &Snapshot, b: &Snapshot) -> f64 {
    [
        difference(&a.points.pressure, &b.points.pressure),
        difference(&a.points.effective_stress, &b.points.effective_stress),
        difference(&a.points.displacement, &b.points.displacement),
        difference(&[a.settlement], &[b.settlement]),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

fn any_method() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec!["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch", "uGC-SRI-patch"])
}

/// Lengths, moduli, densities, gravity and loads in other units, such that waves and
/// consolidation scale alike: `k` by `a G √(r/b)`.
fn scaled(setup: &Setup, length: f64, modulus: f64, density: f64, gravity: f64, load: f64) -> Setup {
    let mut other = setup.clone();
    other.column.height *= length;
    other.column.load *= load;
    other.soil.youngs_modulus *= modulus;
    other.soil.water_bulk_modulus *= modulus;
    other.soil.grain_density *= density;
    other.soil.water_density *= density;
    other.soil.gravity *= gravity;
    other.soil.hydraulic_conductivity *= length * gravity * (density / modulus).sqrt();
    other
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    /// Powers of two shift exponents and round nothing, so the scaled run has the same bits.
    #[test]
    fn units_that_are_powers_of_two_change_no_bit(
        name in any_method(),
        length in -3..4_i32,
        ratio in -2..3_i32,
        density in -3..4_i32,
        gravity in -2..3_i32,
        load in -4..5_i32,
        drag in prop::sample::select(vec![Drag::Explicit, Drag::Implicit]),
        moving: bool,
    ) {
        let mut setup = Setup::new(name);
        setup.settings.drag = drag;
        setup.time_factors = vec![0.0, 0.02];
        let modulus = density + 2 * ratio;
        // Where points move the strain must stay the same, and so the load goes with the modulus.
        let load = if moving { modulus } else { load };
        let setup = if moving { setup.moving() } else { setup };
        let [length, modulus, density, gravity, load] =
            [length, modulus, density, gravity, load].map(|power| f64::from(power).exp2());
        let other = scaled(&setup, length, modulus, density, gravity, load);
        prop_assert_eq!(setup.dimensionless(), other.dimensionless());
    }

    #[test]
    fn units_of_any_size_change_nothing_but_round_off(
        name in any_method(),
        length in 0.3..3.0_f64,
        modulus in 0.1..10.0_f64,
        density in 0.5..2.0_f64,
        gravity in 0.5..2.0_f64,
        load in 0.1..1e3_f64,
    ) {
        let setup = Setup::new(name);
        let other = scaled(&setup, length, modulus, density, gravity, load);
        let largest = difference(&other.dimensionless(), &setup.dimensionless());
        prop_assert!(largest < 1e-9, "{}", largest);
    }

    #[test]
    fn twice_the_load_is_twice_every_field_to_the_bit(
        name in any_method(),
        power in prop::sample::select(vec![-3_i32, 1, 7]),
        flip in prop::sample::select(vec![1.0, 0.99]),
        mapping_back: bool,
    ) {
        let mut setup = Setup::new(name);
        setup.settings = ExplicitSettings { drag: Drag::Implicit, flip, mapping_back, ..ExplicitSettings::default() };
        let mut other = setup.clone();
        let factor = f64::from(power).exp2();
        other.column.load *= factor;
        let (base, scaled) = (setup.end(), other.end());
        prop_assert_eq!(base.settlement * factor, scaled.settlement);
        for (base, scaled) in [
            (&base.points.pressure, &scaled.points.pressure),
            (&base.points.effective_stress, &scaled.points.effective_stress),
            (&base.points.displacement, &scaled.points.displacement),
            (&base.nodes.displacement, &scaled.nodes.displacement),
        ] {
            let times: Vec<f64> = base.iter().map(|value| value * factor).collect();
            prop_assert_eq!(&times, scaled);
        }
    }

    #[test]
    fn the_undrained_start_is_in_equilibrium(
        name in any_method(),
        cells in 1..12_usize,
        points_per_cell in 1..5_usize,
        load in 0.01..1e5_f64,
        porosity in 0.05..0.9_f64,
        youngs_modulus in 1e4..1e9_f64,
        poissons_ratio in 0.0..0.45_f64,
        height in 0.1..20.0_f64,
    ) {
        let mut setup = Setup::new(name);
        setup.column = Column { height, load, ..setup.column };
        setup.soil = Material { youngs_modulus, poissons_ratio, porosity, ..setup.soil };
        (setup.cells, setup.points_per_cell, setup.time_factors) = (cells, points_per_cell, vec![0.0]);
        let start = setup.end();
        let undrained = load / (1.0 + porosity * setup.soil.oedometric_modulus() / setup.soil.water_bulk_modulus);
        for (pressure, stress) in start.points.pressure.iter().zip(&start.points.effective_stress) {
            prop_assert!((pressure / undrained - 1.0).abs() < 1e-12);
            prop_assert!(((stress - pressure) / load + 1.0).abs() < 1e-12, "σ' − p = −q");
        }
        prop_assert!(start.totals.unbalanced_force < 1e-12 * load, "{}", start.totals.unbalanced_force);
        prop_assert!((start.totals.volume / height - 1.0).abs() < 1e-13);
        let solid_mass = (1.0 - porosity) * setup.soil.grain_density * height;
        prop_assert!((start.totals.solid_mass / solid_mass - 1.0).abs() < 1e-12);
    }

    #[test]
    fn masses_of_grains_and_internal_forces_balance_throughout(
        name in any_method(),
        points_per_cell in 1..4_usize,
        load in 1.0..1e4_f64,
        moving: bool,
    ) {
        let mut setup = Setup::new(name);
        setup.points_per_cell = points_per_cell;
        setup.column.load = load;
        let setup = if moving { setup.moving() } else { setup };
        let outcome = setup.solve();
        for snapshot in &outcome.snapshots {
            let drift = snapshot.totals.solid_mass / outcome.start.totals.solid_mass - 1.0;
            prop_assert!(drift.abs() < 1e-13, "grains {}", drift);
            prop_assert!(snapshot.totals.internal_force_imbalance < 1e-12);
        }
    }

    /// Every cell's pressure follows from what crossed its faces, so all that left the top is what
    /// the water expanded; the patch spreads it between cells and is exact to its order.
    #[test]
    fn the_water_that_left_is_the_expansion_of_the_water(
        name in prop::sample::select(vec!["MPM", "GIMP", "GIMP-SRI"]),
        points_per_cell in 1..4_usize,
        mapping_back: bool,
    ) {
        let mut setup = Setup::new(name);
        setup.points_per_cell = points_per_cell;
        setup.settings.mapping_back = mapping_back;
        let end = setup.end();
        let totals = end.totals;
        prop_assert!(totals.water_expansion > 0.0);
        let imbalance = totals.surface_flux / totals.water_expansion - 1.0;
        prop_assert!(imbalance.abs() < 1e-8, "{}", imbalance);
    }

    /// On the regular lattice no domain crosses a cell face, so GIMP's weights are the hat's, whose
    /// gradient is that of the cell's centre.
    #[test]
    fn full_and_reduced_integration_and_hat_and_gimp_agree_on_the_lattice(
        cells in 2..8_usize,
        points_per_cell in 1..5_usize,
        drag in prop::sample::select(vec![Drag::Explicit, Drag::Implicit]),
        porosity in 0.2..0.6_f64,
    ) {
        let solved = |name: &str, rule: TimeStep| {
            let mut setup = Setup::new(name);
            (setup.cells, setup.points_per_cell, setup.settings.drag) = (cells, points_per_cell, drag);
            (setup.soil.porosity, setup.rule) = (porosity, rule);
            setup.solve()
        };
        let mut full = solved("GIMP", TimeStep::Stable(0.5));
        let same_step = TimeStep::Seconds(full.step_sizes.target);
        let full = full.snapshots.pop().expect("an output");
        for name in ["MPM", "GIMP-SRI", "uGIMP", "uGIMP-SRI"] {
            let other = solved(name, same_step).snapshots.pop().expect("an output");
            let largest = field_difference(&other, &full);
            prop_assert!(largest < 1e-9, "{name}: {}", largest);
        }
    }
}

#[test]
fn patch_and_cmpm_change_the_result() {
    let plain = Setup::new("GIMP-SRI").end();
    let patch = Setup::new("GIMP-SRI-patch").end();
    let gradient_and_patch = Setup::new("GC-SRI-patch").end();
    assert!(difference(&patch.points.pressure, &plain.points.pressure) > 1e-2);
    assert!(difference(&gradient_and_patch.points.effective_stress, &patch.points.effective_stress) > 1e-2);
}

#[test]
fn points_that_move_under_one_pascal_agree_with_points_that_do_not() {
    for name in ["GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch", "uGIMP-SRI-patch"] {
        let frozen = Setup::new(name);
        let (moving, frozen) = (frozen.clone().moving().end(), frozen.end());
        for (moved, held) in [
            (&moving.points.pressure, &frozen.points.pressure),
            (&moving.points.effective_stress, &frozen.points.effective_stress),
            (&moving.points.displacement, &frozen.points.displacement),
        ] {
            let largest = difference(moved, held);
            assert!(largest < 2e-6, "{name}: {largest:e}");
            assert!(largest > 1e-10, "{name}: it did move, {largest:e}");
        }
    }
}

/// A moving surface is the edge of the top domain, a frozen one the top node: with the strain of
/// the basis the two are one, with CMPM's they differ by its gradient, the less the finer the cells.
#[test]
fn the_settlement_of_a_moving_surface_is_that_of_a_frozen_one() {
    let gap = |name: &str, cells: usize| {
        let mut frozen = Setup::new(name);
        (frozen.cells, frozen.time_factors) = (cells, vec![0.05]);
        difference(&[frozen.clone().moving().end().settlement], &[frozen.end().settlement])
    };
    for name in ["GIMP", "GIMP-SRI", "GIMP-SRI-patch"] {
        assert!(gap(name, 5) < 2e-6, "{name}");
    }
    let [coarse, fine] = [5, 10].map(|cells| gap("GC-SRI-patch", cells));
    assert!(coarse < 0.03 && fine < 0.4 * coarse, "{coarse:e} then {fine:e}");
}

#[test]
fn the_difference_that_motion_makes_is_proportional_to_the_strain() {
    let at = |load: f64| {
        let mut frozen = Setup::new("GIMP-SRI-patch");
        frozen.column.load = load;
        difference(&frozen.clone().moving().end().points.pressure, &frozen.end().points.pressure)
    };
    let (small, large) = (at(10.0), at(1000.0));
    assert!((large / small / 100.0 - 1.0).abs() < 0.2, "{small:e} at 10 Pa, {large:e} at 1 kPa");
}

/// Settlement with a share of FLIP over that with pure FLIP, at a step in seconds.
fn settlement_kept(flip: f64, seconds: f64) -> f64 {
    let settlement = |flip: f64| {
        let mut setup = Setup::new("GIMP-SRI-patch");
        (setup.settings.flip, setup.rule) = (flip, TimeStep::Seconds(seconds));
        setup.time_factors = vec![0.01];
        setup.end().settlement
    };
    settlement(flip) / settlement(1.0)
}

#[test]
fn pic_in_the_transfer_is_viscosity() {
    let [some, more, all] = [0.99, 0.9, 0.0].map(|flip| settlement_kept(flip, 1e-6));
    assert!(1.0 > some && some > more && more > all, "{some} {more} {all}");
    assert!(some < 0.99, "even one percent shows: {some}");
    assert!(all < 0.6, "pure PIC holds the column back: {all}");
}

#[test]
fn the_viscosity_of_pic_rises_as_the_step_falls() {
    let (coarse, fine) = (1.0 - settlement_kept(0.9, 4e-6), 1.0 - settlement_kept(0.9, 1e-6));
    assert!(fine > 2.0 * coarse && coarse > 0.0, "its viscosity is h²/Δt: {coarse:e} then {fine:e}");
}

#[test]
fn drag_at_old_and_at_new_velocities_consolidate_alike() {
    for name in ["GIMP", "GC-SRI-patch"] {
        let with = |drag: Drag, share: f64| {
            let mut setup = Setup::new(name);
            (setup.settings.drag, setup.rule) = (drag, TimeStep::Courant(share));
            setup.end()
        };
        let differences = [0.4, 0.1]
            .map(|share| field_difference(&with(Drag::Implicit, share), &with(Drag::Explicit, share)));
        assert!(differences[0] < 1e-4, "{name}: {differences:?}");
        assert!(differences[1] < 0.5 * differences[0], "it is the step's error: {name} {differences:?}");
    }
}

#[test]
fn mapping_back_or_not_consolidates_alike() {
    for name in ["GIMP-SRI-patch", "GC-SRI-patch"] {
        let with = |mapping_back: bool| {
            let mut setup = Setup::new(name);
            (setup.settings.mapping_back, setup.rule) = (mapping_back, TimeStep::Courant(0.2));
            setup.end()
        };
        let largest = field_difference(&with(true), &with(false));
        assert!(largest < 2e-4, "{name}: {largest:e}");
        assert!(largest > 0.0, "{name}: it is another step");
    }
}

#[test]
fn results_do_not_depend_on_the_step_size() {
    let at = |share: f64| {
        let mut setup = Setup::new("GC-SRI-patch");
        setup.rule = TimeStep::Stable(share);
        setup.end()
    };
    let largest = field_difference(&at(0.9), &at(0.1));
    assert!(largest < 1e-4, "{largest:e}");
}

#[test]
fn the_same_run_has_the_same_bits() {
    for setup in [Setup::new("GC-SRI-patch"), Setup::new("GC-SRI-patch").moving()] {
        assert_eq!(setup.solve(), setup.solve());
    }
}

/// Every number of a snapshot that is proportional to the load.
fn proportional_to_load(state: &Snapshot) -> Vec<f64> {
    let mut values = vec![state.settlement, state.totals.surface_flux, state.totals.water_expansion];
    for samples in [&state.points, &state.centres, &state.nodes] {
        values.extend(&samples.pressure);
        values.extend(&samples.effective_stress);
        values.extend(&samples.displacement);
    }
    values
}

/// Frozen weights are linear in the load, and a power of two scales without rounding: whatever is
/// added anywhere without belonging there, however small, breaks the equality of bits.
#[test]
fn a_load_scaled_by_a_power_of_two_scales_every_result_to_the_bit() {
    let tiny = 2.0_f64.powi(-200);
    for method in ["MPM", "GIMP-SRI", "GC-SRI-patch"] {
        for kernel in [Kernel::Fastest, Kernel::PointWise] {
            for drag in [Drag::Explicit, Drag::Implicit] {
                let full = Setup {
                    kernel,
                    settings: ExplicitSettings { drag, flip: 0.99, ..ExplicitSettings::default() },
                    time_factors: vec![0.0, 0.002],
                    ..Setup::new(method)
                };
                let mut small = full.clone();
                small.column.load *= tiny;
                for (full, small) in full.solve().snapshots.iter().zip(&small.solve().snapshots) {
                    let scaled: Vec<f64> = proportional_to_load(full).iter().map(|x| x * tiny).collect();
                    assert_eq!(proportional_to_load(small), scaled, "{method} {kernel:?} {drag:?}");
                }
            }
        }
    }
}
