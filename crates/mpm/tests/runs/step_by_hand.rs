//! The explicit step of points that move, written a second time from docs/theory.md in the plainest way, and compared with
//! whole runs of the program: weights, masses and volumes are evaluated anew from every point in every step.
//!
//! Golden values alone would not show which of two nearly equal numbers is right: masses of half a step ago, a pressure or
//! stress that has lost a share of its history, the initial volume in place of the present one. Here each of them is an
//! error many orders of magnitude above rounding.

use crate::column_problem;
use crate::{odd_column, odd_soil, run};
use oedometer_mpm::kernel::body::Discrete;
use oedometer_mpm::run::{Kernel, Schedule};
use oedometer_mpm::time_limit::TimeLimit;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::Method;
use oedometer_problem::settings::{Drag, ExplicitSettings, Scheme};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::XIE_LEO;
use oedometer_scenes::column::Column;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

const CELLS: usize = 8;
const POINTS_PER_CELL: usize = 3;
/// A power of two, so that the program's steps end exactly where these do.
const STEP: f64 = 1.0 / 8192.0;
const STEPS: usize = 4096;

/// A material point of a column.
#[derive(Clone, Copy)]
struct Point {
    place: f64,
    displacement: f64,
    initial_volume: f64,
    ratio: f64,
    initial_half_length: f64,
    half_length: f64,
    stress: f64,
    pressure: f64,
    solid_velocity: f64,
    water_velocity: f64,
}

/// Values of a node.
#[derive(Clone, Copy, Default)]
struct Node {
    grains: f64,
    pores: f64,
    drag: f64,
    momentum: [f64; 2],
    force: [f64; 2],
    velocity: [f64; 2],
    rate: [f64; 2],
}

/// A column whose points are hats (full integration) or GIMP domains (divergence at the cells' centres).
struct ByHand {
    points: Vec<Point>,
    soil: Material,
    load: f64,
    cell_size: f64,
    is_gimp: bool,
}

impl ByHand {
    fn new(problem: &Discrete<1>, is_gimp: bool) -> Self {
        let given = &problem.points;
        let gradient = problem.initial_gradient[0][0];
        let point = |p: usize| {
            let y = given.initial_position[p][0];
            let half_length = given.half_length[p][0];
            Point {
                place: y * (1.0 + gradient),
                displacement: y * gradient,
                initial_volume: given.initial_volume[p],
                ratio: 1.0 + gradient,
                initial_half_length: half_length,
                half_length: if is_gimp { half_length * (1.0 + gradient) } else { half_length },
                stress: given.effective_stress[p][0][0],
                pressure: given.pressure[p],
                solid_velocity: 0.0,
                water_velocity: 0.0,
            }
        };
        Self {
            points: (0..given.len()).map(point).collect(),
            soil: problem.material,
            load: problem.load,
            cell_size: problem.grid.cell_size,
            is_gimp,
        }
    }

    /// Hat of a node at a place.
    fn hat(&self, node: usize, place: f64) -> f64 {
        (1.0 - (place / self.cell_size - node as f64).abs()).max(0.0)
    }

    /// Integral of a node's hat from its left end to a place.
    fn hat_integral(&self, node: usize, place: f64) -> f64 {
        let x = (place / self.cell_size - node as f64).clamp(-1.0, 1.0);
        let left = x.min(0.0) + 1.0;
        let right = x.max(0.0);
        self.cell_size * (0.5 * left * left + right - 0.5 * right * right)
    }

    /// Weight and gradient of a node at a point.
    fn shape(&self, node: usize, point: &Point) -> [f64; 2] {
        if self.is_gimp {
            let (low, high) = (point.place - point.half_length, point.place + point.half_length);
            let length = 2.0 * point.half_length;
            let mean = (self.hat_integral(node, high) - self.hat_integral(node, low)) / length;
            return [mean, (self.hat(node, high) - self.hat(node, low)) / length];
        }
        let weight = self.hat(node, point.place);
        let slope = if weight == 0.0 {
            0.0
        } else if point.place > node as f64 * self.cell_size {
            -1.0
        } else {
            1.0
        };
        [weight, slope / self.cell_size]
    }

    /// Volumes of the grains and of the water of a point.
    fn volumes(&self, point: &Point) -> [f64; 2] {
        let grains = (1.0 - self.soil.porosity) * point.initial_volume;
        [grains, point.ratio * point.initial_volume - grains]
    }

    fn take_velocities(nodes: &mut [Node]) {
        for (number, node) in nodes.iter_mut().enumerate() {
            let is_held = number == 0 || node.grains == 0.0;
            node.velocity = if is_held {
                [0.0; 2]
            } else {
                [node.momentum[0] / node.grains, node.momentum[1] / node.pores]
            };
        }
    }

    fn step(&mut self, kick: f64, dt: f64, drag: Drag) {
        let mut nodes = vec![Node::default(); CELLS + 3];
        let soil = self.soil;
        let shapes: Vec<Vec<[f64; 2]>> = self
            .points
            .iter()
            .map(|point| (0..nodes.len()).map(|node| self.shape(node, point)).collect())
            .collect();
        for (point, shapes) in self.points.iter().zip(&shapes) {
            let [grains, pores] = self.volumes(point);
            let volume = grains + pores;
            let resistivity =
                soil.unit_weight_of_water() / soil.law.conductivity(soil.hydraulic_conductivity, point.ratio);
            for (node, [weight, gradient]) in nodes.iter_mut().zip(shapes) {
                node.grains += weight * grains;
                node.pores += weight * pores;
                node.drag += weight * pores * resistivity;
                node.momentum[0] += weight * grains * point.solid_velocity;
                node.momentum[1] += weight * pores * point.water_velocity;
                node.force[0] += gradient * volume * (point.pressure - point.stress);
                node.force[1] += gradient * volume * point.pressure;
            }
        }
        let top = self.points.last().expect("points");
        let edge = if self.is_gimp { top.half_length } else { top.initial_half_length * top.ratio };
        for number in 0..nodes.len() {
            nodes[number].force[0] -= self.load * self.hat(number, top.place + edge);
        }
        Self::take_velocities(&mut nodes);
        for (number, node) in nodes.iter_mut().enumerate() {
            if number == 0 || node.grains == 0.0 {
                continue;
            }
            // (1) a volume of water: A a_w = f_w − D (v_w − v_s); (2) M_s a_s + M_w a_w = f.
            let solid = soil.grain_density * node.grains;
            let water = soil.water_density * node.pores;
            let inertia = soil.water_density * (node.grains + node.pores);
            let now = node.velocity[1] - node.velocity[0];
            // Implicit drag D (now + kick (a_w − a_s)): two equations for two accelerations.
            let implicit = if drag == Drag::Implicit { kick * node.drag } else { 0.0 };
            let right = node.force[1] - node.drag * now;
            // a_s = (f − M_w a_w)/M_s
            let a_w =
                (right + implicit * node.force[0] / solid) / (inertia + implicit * (1.0 + water / solid));
            node.rate = [(node.force[0] - water * a_w) / solid, a_w];
            for phase in 0..2 {
                node.velocity[phase] += kick * node.rate[phase];
                node.momentum[phase] = 0.0;
            }
        }
        nodes[0].momentum = [0.0; 2];
        for (point, shapes) in self.points.iter_mut().zip(&shapes) {
            let at = |value: fn(&Node) -> f64| -> f64 {
                nodes.iter().zip(shapes).map(|(node, [weight, _])| weight * value(node)).sum()
            };
            let carried = at(|node| node.velocity[0]);
            point.solid_velocity += kick * at(|node| node.rate[0]);
            point.water_velocity += kick * at(|node| node.rate[1]);
            point.place += dt * carried;
            point.displacement += dt * carried;
        }
        for (point, shapes) in self.points.iter().zip(&shapes) {
            let [grains, pores] = self.volumes(point);
            for (node, [weight, _]) in nodes.iter_mut().zip(shapes) {
                node.momentum[0] += weight * grains * point.solid_velocity;
                node.momentum[1] += weight * pores * point.water_velocity;
            }
        }
        Self::take_velocities(&mut nodes);
        self.strain(&nodes, &shapes, dt);
    }

    /// Stresses and pressures from the nodal velocities mapped back.
    fn strain(&mut self, nodes: &[Node], shapes: &[Vec<[f64; 2]>], dt: f64) {
        let soil = self.soil;
        let flux = |node: &Node| {
            let porosity = if node.grains > 0.0 { node.pores / (node.grains + node.pores) } else { 0.0 };
            node.velocity[0] + porosity * (node.velocity[1] - node.velocity[0])
        };
        // Places and volumes of the beginning of the step: cells and their porosity are those of the weights.
        let cells: Vec<usize> = shapes.iter().map(|shapes| Self::cell_of(shapes)).collect();
        let mut of_cells = [[0.0; 2]; CELLS + 2];
        for (point, cell) in self.points.iter().zip(&cells) {
            let [grains, pores] = self.volumes(point);
            of_cells[*cell][0] += pores;
            of_cells[*cell][1] += grains + pores;
        }
        for ((point, shapes), cell) in self.points.iter_mut().zip(shapes).zip(cells) {
            let gradient_of = |value: &dyn Fn(&Node) -> f64| -> f64 {
                nodes.iter().zip(shapes).map(|(node, [_, gradient])| gradient * value(node)).sum()
            };
            let strain = dt * gradient_of(&|node| node.velocity[0]);
            let before = point.ratio;
            point.ratio *= strain.exp();
            if self.is_gimp {
                point.half_length *= strain.exp();
            }
            let softening = match soil.law {
                Law::PorosityDependent => 1.0 / (before * point.ratio).sqrt(),
                _ => 1.0,
            };
            point.stress += softening * soil.oedometric_modulus() * strain;
            let [porosity, rate] = if self.is_gimp {
                let [pores, volume] = of_cells[cell];
                [pores / volume, (flux(&nodes[cell + 1]) - flux(&nodes[cell])) / self.cell_size]
            } else {
                [1.0 - (1.0 - soil.porosity) / point.ratio, gradient_of(&flux)]
            };
            point.pressure -= dt * soil.water_bulk_modulus / porosity * rate;
        }
    }

    /// Cell that held a point when its weights were made: the one between the nodes with hats around its middle.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place on a short mesh")]
    fn cell_of(shapes: &[[f64; 2]]) -> usize {
        let place: f64 = shapes.iter().enumerate().map(|(node, [weight, _])| node as f64 * weight).sum();
        // The mean of the hats' places over a domain is the middle of the domain: hats reproduce lines.
        (place + 1e-10).floor().max(0.0) as usize
    }
}

/// Largest difference between both over the load and over the settlement of the top.
fn difference_of(method: &str, soil: &Material, settings: &ExplicitSettings) -> [f64; 3] {
    let column = Column { load: 1.9e5, ..odd_column() };
    let method_of = Method::named(method).expect("a known method");
    let problem = column_problem::<1>(&XIE_LEO, &column, soil, method_of, CELLS, POINTS_PER_CELL)
        .expect("a possible column");
    let mut by_hand = ByHand::new(&problem, method != "MPM");
    let mut last = 0.0;
    for _ in 0..STEPS {
        let kick = match settings.scheme {
            Scheme::ForwardEuler => STEP,
            Scheme::Leapfrog => 0.5 * (last + STEP),
        };
        by_hand.step(kick, STEP, settings.drag);
        last = STEP;
    }
    let schedule = Schedule {
        outputs: vec![STEPS as f64 * STEP],
        history: Vec::new(),
        notes_energy: false,
        time_step: TimeStep::Seconds(STEP),
        settings: *settings,
        kernel: Kernel::Fastest,
        integrator: IntegratorKind::Explicit,
        critical_step: None,
        formulation: IntegratorKind::Explicit.default_formulation(),
        threads: 1,
        time_limit: TimeLimit::default(),
    };
    let outcome = run(problem, &schedule);
    assert_eq!(outcome.status, Ok(()), "{method}");
    assert_eq!(outcome.counters.steps, STEPS as u64);
    let computed = &outcome.snapshots.last().expect("an output").points;
    let settled = by_hand.points.last().expect("points").displacement;
    assert!(-settled > 0.25 * by_hand.cell_size, "{method}: points cross cells: {settled}");
    let mut largest = [0.0; 3];
    for (p, point) in by_hand.points.iter().enumerate() {
        let differences = [
            (computed.pressure[p] - point.pressure) / column.load,
            (computed.effective_stress[p] - point.stress) / column.load,
            (computed.displacement[p] - point.displacement) / settled,
        ];
        for (largest, difference) in largest.iter_mut().zip(differences) {
            *largest = f64::max(*largest, difference.abs());
        }
    }
    largest
}

#[test]
fn moving_steps_are_those_of_the_equations() {
    for method in ["MPM", "GIMP-SRI"] {
        for (law, drag, scheme) in [
            (Law::LogLinear, Drag::Implicit, Scheme::ForwardEuler),
            (Law::PorosityDependent, Drag::Explicit, Scheme::ForwardEuler),
            (Law::LogLinear, Drag::Implicit, Scheme::Leapfrog),
        ] {
            let soil = Material { law, ..odd_soil() };
            let settings = ExplicitSettings { drag, scheme, ..ExplicitSettings::default() };
            let largest = difference_of(method, &soil, &settings);
            assert!(
                largest.iter().all(|difference| *difference < 1e-11),
                "{method} {law:?} {drag:?} {scheme:?}: {largest:?}"
            );
        }
    }
}
