//! Double-point MPM: one set of material points for the skeleton and one for the water (docs/theory.md, Eqs 21–23).
//!
//! The skeleton is a [`Body`] whose points carry no water: its grid, shape functions, strains, load and nodal fields.
//! [`DoublePoint`] puts the water beside it and takes the explicit step of [`Body::kick_and_drift`], each phase on its
//! own points. `water_points` are the water's state, `following_water` what it takes from the soil, `water_pressure` its continuity and what its pressure
//! does to the nodes, `pressure_lines` what its points forget, `sliver_nodes` the nodes that the surface has all but
//! left, `samples` the content of a snapshot. Balances of momentum, kicks and the skeleton's strain are those of a
//! single set of points.

mod following_water;
mod pressure_lines;
mod samples;
mod sliver_nodes;
mod water_points;
mod water_pressure;

use crate::integrate::double_point::sliver_nodes::SliverNodes;
use crate::integrate::double_point::water_points::WaterPoints;
use crate::kernel::Motion;
use crate::kernel::body::Body;
use crate::kernel::points_to_nodes::Nothing;
use crate::operators::basis::Shapes;
use crate::operators::recovery::RecoveryOperator;
use crate::operators::stencil::PointStencils;
use crate::state::cells::Cells;
use crate::state::points::Points;
use oedometer_problem::method::{PressureIntegration, Recovery};
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::wave_speeds::drag_of_point;
use oedometer_soil::tensor::{Tensor, Vector};

/// A skeleton with the water of its pores in a second set of points.
#[derive(Clone, Debug)]
pub struct DoublePoint<const D: usize> {
    /// The skeleton: its points carry no pressure. Its nodes hold both phases.
    pub body: Body<D>,
    /// The water.
    pub water: WaterPoints<D>,
    /// `N` and `∇N` between water points and nodes.
    pub basis: PointStencils<D>,
    /// The cell of every water point, among the cells that hold soil.
    pub cells: Cells<D>,
    /// `R`, from the sites of the divergence to the water points.
    pub recovery: RecoveryOperator<D>,
    /// Pressure increments at the sites, Pa; `[cell]` or `[point]`.
    pub site_values: Vec<f64>,
    /// Sums over the water points of each cell: weight times pressure, and weight, of its points, and the same of the
    /// domains that reach into it, or of its points a second time; m^D Pa and m^D.
    pub(crate) cell_sums: Vec<[f64; 4]>,
    /// Middle of the part that the soil fills in each cell with water points, m.
    pub(crate) middles: Vec<Vector<D>>,
    /// Slope over each of these cells of the field being mapped, per m.
    pub(crate) slopes: Vec<Vector<D>>,
    /// `A = Σ N m_w/n_w` at the nodes, kg: the water's inertia in its balance per volume of water.
    pub inertia: Vec<f64>,
    /// Nodes that cannot stand alone.
    pub slivers: SliverNodes,
    /// Whether a cell's divergence is the mean over its water points.
    pub takes_means: bool,
    /// Whether the pressure's forces are those of the cells' means: where points move and a cell has one rate.
    pub presses_by_cells: bool,
    /// Whether the pressure that a cell exerts takes the cell's own rate, while its points are given more than that.
    pub keeps_cell_rates: bool,
    /// Mass of the water at the start, kg.
    pub initial_mass: f64,
    /// Volume by which the water was compressed at the start, m^D.
    initial_compression: f64,
    /// Largest size of the pressure of any water point so far, Pa.
    largest_pressure: f64,
}

impl<const D: usize> DoublePoint<D> {
    /// A body with its water on a lattice of points, both displaced by a uniform gradient at the start; a `settled` body
    /// has compressed its water by the displacement of its nodes.
    pub fn new(mut body: Body<D>, lattice: &Points<D>, gradient: &Tensor<D>, settled: bool) -> Self {
        let displacement = settled.then(|| body.nodes.displacement.clone());
        let moves = body.configuration.moves_points();
        let water = WaterPoints::new(lattice, &body.material, moves.then_some(gradient));
        let count = water.len();
        // The water carries them now.
        body.points.pressure.fill(0.0);
        body.points.water_velocity = Vec::new();
        let method = body.method;
        let soil = &body.material;
        // Surfaces leave nodes where points move; sites at the points see no cell that would have to close.
        let full_mass = if moves && method.pressure.is_by_cells() {
            let cell: f64 = (0..D).map(|_| body.grid.cell_size).product();
            cell * (1.0 - soil.porosity) * soil.grain_density
        } else {
            0.0
        };
        let presses_by_cells = moves && method.pressure == PressureIntegration::Sri;
        let sites = if method.pressure.is_by_cells() { body.grid.cell_count() } else { count };
        let mut double = Self {
            basis: method.basis.stencils(count),
            cells: Cells::new(&body.grid, count),
            recovery: RecoveryOperator::new(method, &body.grid, count),
            site_values: vec![0.0; sites],
            cell_sums: vec![[0.0; 4]; body.grid.cell_count()],
            middles: vec![[0.0; D]; body.grid.cell_count()],
            slopes: vec![[0.0; D]; body.grid.cell_count()],
            inertia: vec![0.0; body.nodes.len()],
            slivers: SliverNodes::new(&body.grid, full_mass),
            takes_means: method.pressure == PressureIntegration::Mean,
            presses_by_cells,
            keeps_cell_rates: presses_by_cells && method.recovery != Recovery::Constant,
            initial_mass: water.mass.iter().sum(),
            initial_compression: 0.0,
            largest_pressure: 0.0,
            water,
            body,
        };
        double.build_water_operators();
        double.map_water();
        if let Some(displacement) = displacement {
            double.compress_by(&displacement);
        }
        double.initial_compression = double.water_compression();
        double
    }

    /// Records the largest pressure now: a burst may ring down again before the next output.
    pub(crate) fn note_largest_pressure(&mut self) {
        self.largest_pressure =
            self.water.pressure.iter().fold(self.largest_pressure, |largest, pressure| {
                if largest > pressure.abs() || largest.is_nan() { largest } else { pressure.abs() }
            });
    }

    /// One explicit step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        self.reset_grid(settings); // step 1
        self.map_forces();
        let inertia = &self.inertia;
        self.body.accelerate_nodes(kick, settings.drag, |_, node| inertia[node]); // step 2
        self.slivers.follow_accelerations(&mut self.body.nodes);
        self.body.nodal_velocities(kick, dt); // step 3
        let motion = Motion { kick, dt, flip: settings.flip };
        self.body.advance_points::<Nothing>(motion); // step 4
        self.advance_water(motion);
        if settings.mapping_back {
            self.map_velocities(); // step 5
        }
        self.body.update_effective_stress(dt); // step 6
        self.update_pressure(dt); // step 7, and step 8 is the next one
    }

    /// Step 1: operators, masses and velocities of both sets at their places.
    fn reset_grid(&mut self, settings: &ExplicitSettings) {
        self.body.follow_places();
        if self.body.configuration.deforms() {
            self.body.map_masses();
            self.map_water();
        } else if !settings.mapping_back {
            self.map_velocities();
        }
    }

    /// Maps the mass of the water and the velocities of both phases to nodes that have the masses of the skeleton.
    fn map_water(&mut self) {
        self.slivers.find(&self.body.grid, &self.body.nodes);
        if self.body.configuration.moves_points() {
            self.follow_water();
        }
        self.map_water_masses();
        self.slivers.merge_masses(&mut self.body.nodes, &mut self.inertia);
        self.map_velocities();
    }

    /// Mass, inertia and drag of the water at the nodes with soil:
    /// `M_w = Σ_w N_iw m_w`, `A_i = Σ_w N_iw m_w/n_w`, `D_i = Σ_w N_iw (n_w γ_w/k) V_w`.
    fn map_water_masses(&mut self) {
        let (soil, water) = (&self.body.material, &self.water);
        let given = |point: usize| {
            let (porosity, mass) = (water.porosity[point], water.mass_inside(point));
            let volume_ratio = (1.0 - soil.porosity) / (1.0 - porosity);
            let drag = drag_of_point(soil, porosity * water.volume_inside(point), volume_ratio);
            [[mass, mass / porosity, drag, 0.0]]
        };
        let nodes = &mut self.body.nodes;
        self.basis.sum_values(self.body.grid.node_stride(), given, &mut nodes.sums.masses);
        for node in 0..nodes.len() {
            let [[mass, inertia, drag, _]] = nodes.sums.masses[node];
            let is_wet = nodes.is_active(node) && mass > 0.0;
            nodes.water_mass[node] = if is_wet { mass } else { 0.0 };
            nodes.per_water_mass[node] = if is_wet { 1.0 / mass } else { 0.0 };
            nodes.drag[node] = if is_wet { drag } else { 0.0 };
            // A node without water has no say in it: any inertia will do.
            self.inertia[node] = if is_wet { inertia } else { soil.water_density * nodes.volume[node] };
        }
    }

    /// Step 5: the velocities of both phases from their points, weighted with mass; water that no soil holds goes with
    /// the soil, and what slides along a rough base stays as the node has it.
    fn map_velocities(&mut self) {
        self.body.map_velocities();
        let (water, nodes) = (&self.water, &mut self.body.nodes);
        let momentum = |point: usize| {
            [water.velocity[point].map(|velocity| water.mass_inside(point) * velocity), [0.0; D]]
        };
        self.basis.sum_values(self.body.grid.node_stride(), momentum, &mut nodes.sums.momenta);
        for node in 0..nodes.len() {
            let [momentum, _] = nodes.sums.momenta[node];
            for d in (0..D).filter(|d| nodes.sliding[node][*d] == 0.0) {
                nodes.water_velocity[node][d] = if nodes.water_mass[node] > 0.0 {
                    momentum[d] * (nodes.water_free[node][d] * nodes.per_water_mass[node])
                } else {
                    nodes.solid_velocity[node][d]
                };
            }
        }
        self.slivers.merge_velocities(nodes);
    }

    /// Forces of the skeleton's stress and of the water's pressure: on the mixture and on the water.
    fn map_forces(&mut self) {
        self.body.map_forces();
        if self.presses_by_cells {
            self.add_cell_forces();
        } else {
            self.add_pressure_forces();
        }
        self.slivers.merge_forces(&mut self.body.nodes);
    }

    /// Step 4 of the water: velocities and places of its points.
    fn advance_water(&mut self, motion: Motion) {
        let moves = self.body.configuration.moves_points();
        let (stride, nodes) = (self.body.grid.node_stride(), &self.body.nodes);
        for point in 0..self.water.len() {
            let at_point = |field: &[Vector<D>]| self.basis.value(stride, point, field);
            let rate = at_point(&nodes.water_acceleration);
            let nodal = at_point(&nodes.water_velocity);
            motion.accelerate(&mut self.water.velocity[point], &rate, &nodal);
            if moves {
                motion.carry(&mut self.water.position[point], &nodal);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::body::Discrete;
    use crate::run::{Kernel, Schedule, run};
    use crate::tests::column_problem;
    use crate::time_limit::TimeLimit;
    use oedometer_problem::arrangement::Arrangement;
    use oedometer_problem::integrator::{Formulation, IntegratorKind};
    use oedometer_problem::method::Method;
    use oedometer_problem::outcome::Outcome;
    use oedometer_problem::settings::Scheme;
    use oedometer_problem::settings::{Drag, ExplicitSettings};
    use oedometer_problem::snapshot::{Snapshot, Totals};
    use oedometer_problem::time_step::TimeStep;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, SINGLE_MODE, Scene, TERZAGHI, XIE_LEO};
    use oedometer_soil::law::Law;
    use oedometer_soil::material::Material;

    /// A column, or a plane, under a load, with points of the water or without.
    fn problem<const D: usize>(
        scene: &'static Scene,
        method: &str,
        points: [usize; 2],
        load: f64,
    ) -> Discrete<D> {
        let [of_skeleton, of_water] = points;
        let sets = if of_water == 0 { 1 } else { 2 };
        let arrangement = Arrangement { sets, water_per_cell: of_water, ..Arrangement::default() };
        let is_column = scene.body == oedometer_scenes::scene::Body::Column;
        let base = if is_column { Column::default() } else { Column::layer() };
        let width = if is_column { 0.4 } else { 1.0 };
        let column = Column { load, points: arrangement, dimensions: D, ..base }.with_extent(width);
        let law = if scene == &XIE_LEO { Law::LogLinear } else { Law::Linear };
        let soil = Material { law, hydraulic_conductivity: 1e-3, ..Material::default() };
        let method = Method::named(method).expect("a known method");
        column_problem(scene, &column, &soil, method, 5, of_skeleton).expect("a column")
    }

    fn solved<const D: usize>(problem: Discrete<D>, settings: ExplicitSettings, end: f64) -> Outcome {
        let schedule = Schedule {
            outputs: vec![0.0, end],
            history: Vec::new(),
            notes_energy: false,
            time_step: TimeStep::Stable(0.7),
            settings,
            kernel: Kernel::PointWise,
            integrator: IntegratorKind::Explicit,
            // Half of the least of them: no need to look for it.
            critical_step: Some(0.9e-4),
            formulation: Formulation::VW,
            threads: 1,
            time_limit: TimeLimit::default(),
        };
        run(problem, &schedule, &|_, _| true)
    }

    fn assert_same(first: &Outcome, second: &Outcome, name: &str) {
        assert_eq!((&first.status, first.counters.steps), (&second.status, second.counters.steps), "{name}");
        let totals = |first: &Outcome| first.snapshots[1].totals;
        for total in [|first: Totals| first.surface_flux, |first: Totals| first.water_expansion] {
            let (first, second) = (total(totals(first)), total(totals(second)));
            // Of the order of a settlement of 1e-6 m: under a cosine nothing but round-off.
            assert!((first - second).abs() <= 1e-10 * first.abs() + 1e-20, "{name}: {second} for {first}");
        }
        for (first, second) in first.snapshots.iter().zip(&second.snapshots) {
            for (a, b) in [
                (&*first.points.pressure, second.points.pressures().0),
                (&first.points.effective_stress, &second.points.effective_stress),
                (&first.points.displacement, &second.points.displacement),
                (&first.nodes.pressure, second.nodes.pressures().0),
            ] {
                assert_eq!(a.len(), b.len(), "{name}");
                let scale = a.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
                for (x, y) in a.iter().zip(b) {
                    assert!((x - y).abs() <= 1e-10 * scale, "{name}: {y} for {x}");
                }
            }
        }
    }

    #[test]
    fn frozen_equal_point_sets_are_one_set_to_round_off() {
        let implicit = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        let names =
            ["MPM", "GIMP", "GIMP-SRI", "GC-SRI-patch", "GIMP-SRI-nodal", "GIMP-mean", "VP", "GC-Bbar-patch"];
        for name in names.into_iter().chain(["GIMP-null-space"]) {
            for scene in [&SINGLE_MODE, &TERZAGHI] {
                let sets = |of_water| solved::<1>(problem(scene, name, [3, of_water], 1.0), implicit, 0.01);
                assert_same(&sets(0), &sets(3), name);
            }
        }
        for settings in [
            ExplicitSettings { flip: 0.99, ..ExplicitSettings::default() },
            ExplicitSettings { mapping_back: false, ..implicit },
            ExplicitSettings { scheme: Scheme::Leapfrog, drag: Drag::Centred, ..implicit },
        ] {
            let sets = |of_water| {
                solved::<1>(problem(&SINGLE_MODE, "GIMP-SRI-patch", [2, of_water], 1.0), settings, 0.01)
            };
            assert_same(&sets(0), &sets(2), "settings");
        }
        // In the plane too, from an undrained start under a cosine.
        for name in ["GIMP-SRI-patch", "GIMP"] {
            let sets =
                |of_water| solved::<2>(problem(&COSINE_LAYER, name, [2, of_water], 1.0), implicit, 1e-3);
            assert_same(&sets(0), &sets(2), name);
        }
    }

    #[test]
    fn an_undrained_start_has_the_same_pressure_at_other_water_points() {
        let settings = ExplicitSettings::default();
        let at = |of_water| {
            solved::<2>(problem(&COSINE_LAYER, "GIMP-SRI-patch", [2, of_water], 1.0), settings, 1e-6)
        };
        let mean = |outcome: &Outcome| {
            let (pressure, volume) = outcome.start.centres.pressures();
            let sum: f64 = pressure.iter().zip(volume).map(|(p, v)| p.abs() * v).sum();
            sum / volume.iter().sum::<f64>()
        };
        let (two, three) = (at(2), at(3));
        assert_eq!(three.start.points.pressures().0.len(), 225);
        assert!((mean(&three) / mean(&two) - 1.0).abs() < 0.02, "{} {}", mean(&three), mean(&two));
    }

    #[test]
    fn water_leaves_a_soil_that_settles_and_none_is_lost() {
        let implicit = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        for name in ["GIMP", "GIMP-SRI-patch", "GIMP-SRI"] {
            let outcome = solved::<1>(problem(&XIE_LEO, name, [4, 4], 2e5), implicit, 0.15);
            assert_eq!(outcome.status, Ok(()), "{name}");
            let last = &outcome.snapshots[1];
            let double = last.totals.double_point.expect("two sets of points");
            // Grains and water are incompressible: what left are the pores that were lost.
            let lost = last.settlement / 0.3;
            assert!(double.water_left > 0.05 && double.water_points < 20, "{name} {double:?}");
            assert!((double.water_left - lost).abs() < 5e-3, "{name}: {} for {lost}", double.water_left);
            assert!((double.water_volume / double.pore_volume - 1.0).abs() < 5e-3, "{name}: {double:?}");
            // Consolidation begins at the load, the first front overshoots it, and nothing burst on the way.
            assert!((1.9e5..2.8e5).contains(&double.largest_pressure), "{name}: {double:?}");
            assert!(last.totals.internal_force_imbalance < 1e-12, "{name}");
            assert!((last.totals.solid_mass / outcome.start.totals.solid_mass - 1.0).abs() < 1e-12, "{name}");
        }
    }

    #[test]
    fn a_plane_column_of_two_sets_equals_the_column_on_a_line() {
        let implicit = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        // The domains of CPDI's skeleton could turn, and the water's keep their axes.
        for method in ["GIMP-SRI-patch", "CPDI-SRI-patch"] {
            let line = solved::<1>(problem(&XIE_LEO, method, [2, 2], 2e5), implicit, 0.05);
            let plane = solved::<2>(problem(&XIE_LEO, method, [2, 2], 2e5), implicit, 0.05);
            assert_eq!(plane.status, Ok(()), "{method}");
            let (line, plane) = (&line.snapshots[1], &plane.snapshots[1]);
            let left =
                |snapshot: &Snapshot| snapshot.totals.double_point.expect("two sets of points").water_left;
            // The steps differ with the limits that are predicted for a line and for a plane.
            assert!((plane.settlement / line.settlement - 1.0).abs() < 2e-3, "{method}");
            assert!((left(plane) / left(line) - 1.0).abs() < 1e-2 && left(line) > 0.0, "{method}");
            let across = &plane.points.plane.as_ref().expect("a plane").horizontal_displacement;
            let largest = across.iter().fold(0.0, |largest: f64, moved| largest.max(moved.abs()));
            assert!(largest < 1e-9 * plane.settlement, "{method}: {largest}");
        }
    }

    #[test]
    fn an_implicit_run_of_two_sets_ends_with_a_sentence() {
        let schedule = Schedule {
            outputs: vec![1e-3],
            history: Vec::new(),
            notes_energy: false,
            time_step: TimeStep::Growth(0.1),
            settings: ExplicitSettings::default(),
            kernel: Kernel::Fastest,
            integrator: IntegratorKind::Implicit,
            critical_step: None,
            formulation: Formulation::QuasiStatic,
            threads: 1,
            time_limit: TimeLimit::default(),
        };
        let outcome = run(problem::<1>(&TERZAGHI, "GIMP", [2, 2], 1.0), &schedule, &|_, _| true);
        let Err(failure) = outcome.status else { panic!("solved") };
        assert!(failure.reason.contains("integrated explicitly, not with `implicit`"), "{}", failure.reason);
    }
}
