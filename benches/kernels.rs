//! Kernels: one step by method, operators built anew, and the exact series.
//!
//! `cargo bench --bench kernels` ends with a table of nanoseconds per point and step, the unit in
//! which the bar is set: at most 3.5 for `GC-SRI-patch` in one dimension with frozen weights, 25 with
//! moving points, 100 in two dimensions, on a core of 3.5 GHz; the least of rounds in which the kernels take
//! turns. Beside the moving step stand its seven steps one by one, and under them a bound by counted operations.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use oedometer::exact::consolidation;
use oedometer::scenes::{COSINE_LAYER, TERZAGHI};
use oedometer::{
    AssembledStep, Body, Column, Configuration, Discrete, EqualSteps, ExplicitSettings, IntegratorKind,
    Kernel as StepKernel, LinearStepper, Material, Method, Plan, Schedule, Stepper, TimeLimit, TimeStep,
    column_problem, predicted_critical_step,
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
        notes_energy: false,
        time_step: TimeStep::Seconds(0.01),
        settings: ExplicitSettings::default(),
        kernel: StepKernel::Fastest,
        integrator: IntegratorKind::Implicit,
        formulation: IntegratorKind::Implicit.default_formulation(),
        threads: 1,
        time_limit: TimeLimit::default(),
    };
    let plan = Plan::new(&problem, &schedule);
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
fn problem(method: &str, cells: usize, configuration: Configuration) -> Discrete<1> {
    crowded_problem(method, cells, POINTS_PER_CELL, configuration)
}

/// The same with any number of points per cell.
fn crowded_problem(
    method: &str,
    cells: usize,
    points_per_cell: usize,
    configuration: Configuration,
) -> Discrete<1> {
    let method =
        Method { configuration: Some(configuration), ..Method::named(method).expect("a known method") };
    let (column, soil) = (Column::default(), Material::default());
    column_problem(&TERZAGHI, &column, &soil, method, cells, points_per_cell).expect("the seed column")
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
    let problem = column_problem::<2>(&COSINE_LAYER, &column, &soil, method, cells, POINTS_PER_CELL)
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

/// Steps of the moving kernel, as the table names them.
const PASSES: [&str; 7] =
    ["1 grid", "2 acceler.", "3 velocities", "4 points", "5 back", "6 stress", "7 pressure"];
/// Additions, multiplications, divisions, minima and maxima per point of each of them, of `GC-SRI-patch` in one and in two
/// dimensions, counted in the sources; those of the nodes are left out, for they are few where cells hold many points.
///
/// Step 1: place and cell 7, row of GIMP 25, volumes and drag 6, momenta 2, stresses 4, sums over the cell 3, and 2 for each of
/// 7 numbers at 3 nodes; in the plane two rows, and 27 products of them, and 30 at each of 9 nodes. Step 4: 2 for each of 4
/// numbers at each node, 12 to move, 2 for each momentum at each node. Step 6: row of the composite gradient 24, gradient 8,
/// strain, volume and stress 17; in the plane two rows, 16 nodes, and the stress is turned. Step 7: fit 30, sum 6.
const OPERATIONS: [[f64; 7]; 2] =
    [[89.0, 0.0, 0.0, 48.0, 0.0, 49.0, 36.0], [390.0, 0.0, 0.0, 238.0, 0.0, 267.0, 122.0]];
/// Operations that a cycle can begin in registers of four numbers, two at a time.
const PER_CYCLE: f64 = 8.0;
/// Steps an iteration of the moving table, so few that one goes by undisturbed on a machine that is busy, and its
/// rounds.
const MOVING_STEPS: usize = 8;
const MOVING_ROUNDS: usize = 300;
/// Clock cycles that wait for each other: the unit that does not depend on the clock.
const CYCLES: usize = 8;

/// The moving step of `GC-SRI-patch` and its seven steps, in a column of one dimension and of two, ns per point.
///
/// Under each line stands a bound: the [`OPERATIONS`] of each step, were two registers of four numbers filled and begun in
/// every cycle, with the length of a cycle as it is measured beside them. `cycles` is the whole step in cycles per point: what
/// does not depend on the clock.
fn print_moving_table() {
    println!("\nmoving step of GC-SRI-patch, ns per point, least of {MOVING_ROUNDS} rounds; below, by count");
    print!("{:>4}{:>10}{:>7}{:>8}", "", "pts/cell", "cells", "step");
    println!("{}{:>8}", PASSES.map(|pass| format!("{pass:>14}")).concat(), "cycles");
    for (cells, points_per_cell) in [(10, 2), (80, 2), (10, 4), (40, 4), (80, 4)] {
        let problem = crowded_problem("GC-SRI-patch", cells, points_per_cell, Configuration::Updated);
        print_moving_costs(problem, points_per_cell, cells);
    }
    for (cells, points_per_cell) in [(10, 2), (10, 4), (40, 4)] {
        let (column, soil) = (Column { dimensions: 2, ..Column::default() }, Material::default());
        let method = Method::named("GC-SRI-patch").expect("a known method");
        let method = Method { configuration: Some(Configuration::Updated), ..method };
        let problem = column_problem::<2>(&TERZAGHI, &column, &soil, method, cells, points_per_cell);
        print_moving_costs(problem.expect("the seed column"), points_per_cell * points_per_cell, cells);
    }
}

fn print_moving_costs<const D: usize>(problem: Discrete<D>, points_per_cell: usize, cells: usize) {
    let ([step, passes @ ..], cycle) = moving_cost(problem);
    let shown =
        |numbers: &[f64]| numbers.iter().map(|cost| format!("{cost:>14.1}")).collect::<Vec<_>>().concat();
    println!("{D:>3}D{points_per_cell:>10}{cells:>7}{step:>8.1}{}{:>8.0}", shown(&passes), step / cycle);
    let bounds = OPERATIONS[D - 1].map(|operations| operations / PER_CYCLE * cycle);
    let bound: f64 = bounds.iter().sum();
    println!("{:>21}{bound:>8.1}{}{:>8.0}", "by count", shown(&bounds), bound / cycle);
}

/// Nanoseconds per point of the step and of each of the seven, the least of rounds, and of a cycle of the clock.
fn moving_cost<const D: usize>(problem: Discrete<D>) -> ([f64; 8], f64) {
    let settings = ExplicitSettings::default();
    let dt = 0.5 * predicted_critical_step(&problem, &settings);
    let mut body = Body::new(problem);
    let count = body.points.len();
    let (mut least, mut least_cycle, mut chain) = ([f64::INFINITY; 8], f64::INFINITY, 1);
    for _ in 0..MOVING_ROUNDS {
        keep_least(&mut least[0], MOVING_STEPS, &mut || body.explicit_step(black_box(dt), &settings));
        let (mut seconds, mut pass, mut start) = ([0.0; 7], 0, Instant::now());
        for _ in 0..MOVING_STEPS {
            body.step_by_step(dt, dt, &settings, |_| {
                let now = Instant::now();
                seconds[pass % 7] += (now - start).as_secs_f64();
                (pass, start) = (pass + 1, now);
            });
        }
        for (least, seconds) in least[1..].iter_mut().zip(seconds) {
            *least = least.min(seconds);
        }
        // Each chain begins with the last one's end: short ones would run side by side otherwise.
        keep_least(&mut least_cycle, 1, &mut || chain = black_box(dependent_cycles(black_box(chain), count)));
    }
    let per_point = 1e9 / (MOVING_STEPS * count) as f64;
    (least.map(|seconds| per_point * seconds), 1e9 * least_cycle / (CYCLES * count) as f64)
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
