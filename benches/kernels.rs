//! Kernels: one step by method, operators built anew, and the exact series.
//!
//! `cargo bench --bench kernels` ends with a table of nanoseconds per point and step, the unit in
//! which the bar is set: at most 3.5 for `GC-SRI-patch` in one dimension with frozen weights, 25 with
//! moving points, 100 in two dimensions, on a core of 3.5 GHz; the least of rounds in which the kernels take
//! turns. Beside the moving step stand its passes one by one, and what bounds the one to the nodes.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use oedometer::exact::consolidation;
use oedometer::{
    AssembledStep, Body, Column, Configuration, EqualSteps, ExplicitSettings, IntegratorKind,
    Kernel as StepKernel, LinearStepper, Material, Method, Plan, Problem, SceneKind, Schedule, Stepper,
    TimeLimit, TimeStepRule, column_problem, predicted_critical_step,
};
use std::time::Instant;

const METHODS: [&str; 5] = ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch"];
const CELLS: [usize; 2] = [10, 80];
const POINTS_PER_CELL: usize = 2;
/// Steps an iteration: long enough that the clock costs nothing.
const STEPS: usize = 256;
/// Rounds of the tables; their figures are the least.
const ROUNDS: usize = 31;
/// Cells over the height and length of the layer.
const PLANE_CELLS: [usize; 2] = [8, 32];
const PLANE_STEPS: usize = 32;
const PLANE_ROUNDS: usize = 41;

/// A way to take a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kernel {
    PointWise,
    Assembled,
    Moving,
}

fn main() {
    divan::main();
    if std::env::args().all(|argument| argument != "--test" && argument != "--list") {
        print_table();
        print_moving_table();
        print_plane_table();
    }
}

#[divan::bench(args = METHODS, consts = CELLS)]
fn point_wise_step<const C: usize>(bencher: Bencher, method: &str) {
    bench_steps(bencher, method, C, Kernel::PointWise);
}

#[divan::bench(args = METHODS, consts = CELLS)]
fn assembled_step<const C: usize>(bencher: Bencher, method: &str) {
    bench_steps(bencher, method, C, Kernel::Assembled);
}

#[divan::bench(args = METHODS, consts = CELLS)]
fn moving_step<const C: usize>(bencher: Bencher, method: &str) {
    bench_steps(bencher, method, C, Kernel::Moving);
}

#[divan::bench(args = METHODS, consts = CELLS)]
fn build_operators<const C: usize>(bencher: Bencher, method: &str) {
    let problem = problem(method, C, Configuration::Updated);
    let bencher = bencher.counter(ItemsCount::new(problem.points.len()));
    let mut body = Body::new(problem);
    bencher.bench_local(|| body.build_operators());
}

/// One step of SDIRK2 on the frozen column: two solves of a banded system. What bounds it is the
/// chain of the back substitution, one multiply-add after another, and not memory.
#[divan::bench(args = METHODS, consts = CELLS)]
fn implicit_step<const C: usize>(bencher: Bencher, method: &str) {
    let problem = problem(method, C, Configuration::Frozen);
    let schedule = Schedule {
        critical_step: None,
        outputs: Vec::new(),
        history: Vec::new(),
        rule: TimeStepRule::Seconds(0.01),
        settings: ExplicitSettings::default(),
        kernel: StepKernel::Fastest,
        integrator: IntegratorKind::Implicit,
        formulation: IntegratorKind::Implicit.default_formulation(),
        threads: 1,
        time_limit: TimeLimit::default(),
    };
    let plan = Plan::of(&problem, &schedule);
    let mut stepper = LinearStepper::new(Body::new(problem), &plan);
    let step = EqualSteps::first(0.0, 0.01, 1);
    bencher
        .counter(ItemsCount::new(C * POINTS_PER_CELL))
        .bench_local(|| stepper.advance(black_box(&step), f64::INFINITY));
}

/// Time factors on both sides of the switch between the image and the series form.
#[divan::bench(args = [1e-6, 0.01, 0.1, 1.0])]
fn exact_isochrone(bencher: Bencher, time_factor: f64) {
    bencher.bench(|| consolidation::isochrone(black_box(0.37), black_box(time_factor)));
}

#[divan::bench(args = [1e-6, 0.01, 0.1, 1.0])]
fn exact_degree_of_consolidation(bencher: Bencher, time_factor: f64) {
    bencher.bench(|| consolidation::degree_of_consolidation(black_box(time_factor)));
}

/// The seed column, from its undrained start.
fn problem(method: &str, cells: usize, configuration: Configuration) -> Problem<1> {
    crowded_problem(method, cells, POINTS_PER_CELL, configuration)
}

/// The same with any number of points per cell.
fn crowded_problem(
    method: &str,
    cells: usize,
    points_per_cell: usize,
    configuration: Configuration,
) -> Problem<1> {
    let method =
        Method { configuration: Some(configuration), ..Method::named(method).expect("a known method") };
    let (column, soil) = (Column::default(), Material::default());
    column_problem(SceneKind::Terzaghi, &column, &soil, method, cells, points_per_cell)
        .expect("the seed column")
}

/// A closure that takes `STEPS` steps.
fn stepper(method: &str, cells: usize, kernel: Kernel) -> Box<dyn FnMut()> {
    let configuration = if kernel == Kernel::Moving { Configuration::Updated } else { Configuration::Frozen };
    let problem = problem(method, cells, configuration);
    let settings = ExplicitSettings::default();
    let dt = 0.5 * predicted_critical_step(&problem, &settings);
    steps_of(Body::new(problem), kernel, dt, settings)
}

fn steps_of(mut body: Body<1>, kernel: Kernel, dt: f64, settings: ExplicitSettings) -> Box<dyn FnMut()> {
    if kernel == Kernel::Assembled {
        let mut column = AssembledStep::new(&body);
        column.set_step(dt, &settings);
        Box::new(move || {
            for _ in 0..STEPS {
                column.step(black_box(dt), &settings);
            }
        })
    } else {
        Box::new(move || {
            for _ in 0..STEPS {
                body.explicit_step(black_box(dt), &settings);
            }
        })
    }
}

fn bench_steps(bencher: Bencher, method: &str, cells: usize, kernel: Kernel) {
    let mut steps = stepper(method, cells, kernel);
    bencher.counter(ItemsCount::new(cells * POINTS_PER_CELL * STEPS)).bench_local(&mut steps);
}

/// Least nanoseconds per point and step, every kernel and method.
fn print_table() {
    println!("\nns per point and step, {POINTS_PER_CELL} points per cell, least of {ROUNDS} rounds");
    println!("{:<16}{:>6}{:>12}{:>12}{:>12}", "method", "cells", "point-wise", "assembled", "moving");
    for method in METHODS {
        for cells in CELLS {
            let [point_wise, assembled, moving] = least(method, cells);
            println!("{method:<16}{cells:>6}{point_wise:>12.1}{assembled:>12.1}{moving:>12.1}");
        }
    }
}

/// Prints the point-wise and the assembled step of the seed layer, in two dimensions.
fn print_plane_table() {
    println!(
        "\nns per point and step, two dimensions, frozen, {POINTS_PER_CELL} × {POINTS_PER_CELL} points per cell, \
         least of {PLANE_ROUNDS} rounds"
    );
    println!("{:<16}{:>6}{:>12}{:>12}", "method", "cells", "point-wise", "assembled");
    for method in ["GIMP", "GIMP-SRI-patch", "GC-SRI-patch", "GC-Bbar-patch"] {
        for cells in PLANE_CELLS {
            let [point_wise, assembled] = plane_cost(method, cells);
            println!("{method:<16}{cells:>6}{point_wise:>12.1}{assembled:>12.1}");
        }
    }
}

/// Nanoseconds of the point-wise and of the assembled step per point. The steps take turns; the least of the rounds is
/// what the machine can do undisturbed.
fn plane_cost(name: &str, cells: usize) -> [f64; 2] {
    let method = Method::named(name).expect("a known method");
    let (column, soil) = (Column::layer(), Material::default());
    let problem = column_problem::<2>(SceneKind::CosineLayer, &column, &soil, method, cells, POINTS_PER_CELL)
        .expect("the seed layer");
    let settings = ExplicitSettings::default();
    let dt = 0.5 * predicted_critical_step(&problem, &settings);
    let mut body = Body::new(problem);
    let mut plane = AssembledStep::new(&body);
    plane.set_step(dt, &settings);
    let points = body.points.len() as f64;
    let mut least = [f64::INFINITY; 2];
    for _ in 0..PLANE_ROUNDS {
        let mut time = |kind: usize, one: &mut dyn FnMut()| keep_least(&mut least[kind], PLANE_STEPS, one);
        time(0, &mut || body.explicit_step(black_box(dt), &settings));
        time(1, &mut || plane.step(black_box(dt), &settings));
    }
    least.map(|seconds| 1e9 * seconds / (PLANE_STEPS as f64 * points))
}

/// Times so many repeats of a work, and keeps the seconds where they are the least so far.
fn keep_least(least: &mut f64, repeats: usize, work: &mut dyn FnMut()) {
    let start = Instant::now();
    (0..repeats).for_each(|_| work());
    *least = least.min(start.elapsed().as_secs_f64());
}

/// The kernels take turns, so that what drifts on the machine meets each alike.
fn least(method: &str, cells: usize) -> [f64; 3] {
    let kernels = [Kernel::PointWise, Kernel::Assembled, Kernel::Moving];
    let mut steppers = kernels.map(|kernel| stepper(method, cells, kernel));
    least_of_rounds(&mut steppers).map(|seconds| 1e9 * seconds / (STEPS * cells * POINTS_PER_CELL) as f64)
}

/// Least seconds of each of some works that take turns.
fn least_of_rounds<const N: usize>(works: &mut [Box<dyn FnMut()>; N]) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..ROUNDS {
        for (work, least) in works.iter_mut().zip(&mut least) {
            keep_least(least, 1, work);
        }
    }
    least
}

/// Nodes whose coefficients lie side by side, as in the frozen step.
const LANES: usize = 4;
/// Sums that do not wait for each other in the bound.
const CHAINS: usize = 4;
/// `STEPS` passes over the nodes with so many multiply-adds each.
fn streaming(cells: usize, terms: usize) -> Box<dyn FnMut()> {
    let blocks = cells.div_ceil(LANES);
    let terms = terms.next_multiple_of(CHAINS);
    let coefficients = vec![[1e-3; LANES]; blocks * terms];
    let mut field = vec![[1.0; LANES]; blocks];
    let mut sums = vec![[0.0; LANES]; blocks];
    Box::new(move || {
        for _ in 0..STEPS {
            for (block, sum) in sums.iter_mut().enumerate() {
                // Four chains of sums hide the latency of an addition.
                let mut chains = [[0.0; LANES]; CHAINS];
                let value = field[block];
                for rows in coefficients[block * terms..][..terms].chunks_exact(CHAINS) {
                    for (chain, row) in chains.iter_mut().zip(rows) {
                        for lane in 0..LANES {
                            chain[lane] += row[lane] * value[lane];
                        }
                    }
                }
                for lane in 0..LANES {
                    sum[lane] = chains.iter().map(|chain| chain[lane]).sum();
                }
            }
            black_box((&mut sums, &mut field));
        }
    })
}

/// Passes of the moving step and their bounds, in the order of the table.
const PASSES: [&str; 7] =
    ["step", "operators", "to nodes", "back", "adding to nodes", "waiting", "eight cycles"];
/// Steps an iteration of the moving table, so few that one goes by undisturbed on a machine that is busy, and its
/// rounds.
const MOVING_STEPS: usize = 8;
const MOVING_ROUNDS: usize = 300;
/// Clock cycles that wait for each other: the unit that does not depend on the clock.
const CYCLES: usize = 8;

/// The moving step of `GC-SRI-patch` and its passes, in a column of one dimension and of two.
///
/// `operators` builds all weights anew; `to nodes` is the pass that sums masses and momenta, `back` the one
/// that maps velocities back; what is left are the nodes, the points' motion, their stresses and their pressures.
/// Two bounds of the pass to the nodes stand beside it: `adding to nodes`, its multiply-adds with nothing to wait
/// for, each with a coefficient and a value from the cache; and `waiting`: neighbours give to the same node, so every
/// sum is stored, loaded and added to before the next, measured with one number a point. `eight cycles` is the
/// length of the clock's cycle, eight of them one after the other, and `ratio` the step over it: what does not depend
/// on the clock.
fn print_moving_table() {
    println!("\nmoving step of GC-SRI-patch and its passes, ns per point, least of {MOVING_ROUNDS} rounds");
    print!("{:>10}{:>10}{:>6}", "dimensions", "pts/cell", "cells");
    println!("{}{:>10}", PASSES.map(|pass| format!("{pass:>16}")).concat(), "ratio");
    for (cells, points_per_cell) in [(10, 2), (80, 2), (10, 4), (40, 4), (80, 4)] {
        let problem = crowded_problem("GC-SRI-patch", cells, points_per_cell, Configuration::Updated);
        print_moving_costs(problem, points_per_cell, cells);
    }
    for (cells, points_per_cell) in [(10, 2), (10, 4), (40, 4)] {
        let (column, soil) = (Column { dimensions: 2, ..Column::default() }, Material::default());
        let method = Method::named("GC-SRI-patch").expect("a known method");
        let method = Method { configuration: Some(Configuration::Updated), ..method };
        let problem =
            column_problem::<2>(SceneKind::Terzaghi, &column, &soil, method, cells, points_per_cell);
        print_moving_costs(problem.expect("the seed column"), points_per_cell * points_per_cell, cells);
    }
}

fn print_moving_costs<const D: usize>(problem: Problem<D>, points_per_cell: usize, cells: usize) {
    print!("{D:>10}{points_per_cell:>10}{cells:>6}");
    let costs = moving_cost(problem, points_per_cell);
    let [step, .., cycles] = costs;
    println!("{}{:>10.1}", costs.map(|cost| format!("{cost:>16.1}")).concat(), step / cycles);
}

/// Nanoseconds per point of the step and of each pass, which take turns.
fn moving_cost<const D: usize>(problem: Problem<D>, points_per_cell: usize) -> [f64; PASSES.len()] {
    let settings = ExplicitSettings::default();
    let dt = 0.5 * predicted_critical_step(&problem, &settings);
    let mut body = Body::new(problem);
    let count = body.points.len();
    let mut node_sums = vec![0.0; count / points_per_cell + 1];
    // Three masses and two momenta at three nodes a direction.
    let nodes: usize = (0..D).map(|_| 3).product();
    let mut adding = streaming(count, nodes * (3 + 2 * D));
    let (mut least, mut chain) = ([f64::INFINITY; PASSES.len()], 1);
    for _ in 0..MOVING_ROUNDS {
        let mut time = |pass: usize, one: &mut dyn FnMut()| keep_least(&mut least[pass], MOVING_STEPS, one);
        time(0, &mut || body.explicit_step(black_box(dt), &settings));
        time(1, &mut || body.build_operators());
        time(2, &mut || {
            body.map_masses();
            body.map_velocities();
        });
        time(3, &mut || body.map_velocities());
        time(5, &mut || {
            for point in 0..count {
                let node = &mut node_sums[point / points_per_cell];
                *black_box(node) += 1.0;
            }
        });
        // Each chain begins with the last one's end: short ones would run side by side otherwise.
        time(6, &mut || chain = black_box(dependent_cycles(black_box(chain), count)));
        keep_least(&mut least[4], 1, &mut adding);
    }
    least[4] *= MOVING_STEPS as f64 / STEPS as f64;
    least.map(|seconds| 1e9 * seconds / (MOVING_STEPS * count) as f64)
}

/// So many times [`CYCLES`] operations of one cycle, each of which waits for the last.
fn dependent_cycles(start: u64, times: usize) -> u64 {
    let (mut number, key) = (start, black_box(0x9e37_79b9_7f4a_7c15));
    for _ in 0..times {
        for _ in 0..CYCLES / 2 {
            number = (number ^ key).rotate_left(7);
        }
    }
    number
}
