//! Whole cases: the seed column to `T_v` = 0.05, from the problem to its measured errors.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use divan::Bencher;
use divan::counter::ItemsCount;
use oedometer::scenes::{Scene, TERZAGHI, XIE_LEO};
use oedometer::{
    Case, Column, Configuration, Counters, Drag, ExplicitSettings, IntegratorKind, Kernel, Material, Method,
    Record, TimeStep, run_case,
};

/// Cells of the table of linear cost.
const MESHES: [usize; 5] = [40, 80, 160, 320, 640];
/// Rounds of the table; the least of each mesh counts.
const ROUNDS: usize = 7;

fn main() {
    divan::main();
    if std::env::args().all(|argument| argument != "--test" && argument != "--list") {
        print_linear_cost();
    }
}

/// The implicit integrator to `T_v` = 1: its cost must grow as cells times steps. Work counters are
/// exact; of the wall times, taken in turns over the meshes, the least counts.
fn print_linear_cost() {
    let cases = MESHES.map(|cells| implicit_case("GC-SRI-patch", &TERZAGHI, cells));
    let mut least = [f64::INFINITY; MESHES.len()];
    let mut counters = [Counters::default(); MESHES.len()];
    for _ in 0..ROUNDS {
        for (i, case) in cases.iter().enumerate() {
            let record = solve(case, Kernel::Fastest);
            least[i] = record.wall.iter().map(|sample| sample.seconds).fold(least[i], f64::min);
            counters[i] = record.counters;
        }
    }
    println!("\nimplicit to T_v = 1: cost over cells and steps, least of {ROUNDS} rounds");
    println!(
        "{:>6}{:>8}{:>16}{:>16}{:>12}{:>20}{:>10}",
        "cells", "steps", "factorisations", "cells × steps", "wall, ms", "ns a cell and step", "exponent"
    );
    for i in 0..MESHES.len() {
        let work = |i: usize| (MESHES[i] as u64 * counters[i].steps) as f64;
        let exponent = match i.checked_sub(1) {
            Some(last) => format!("{:.2}", (least[i] / least[last]).ln() / (work(i) / work(last)).ln()),
            None => String::new(),
        };
        println!(
            "{:>6}{:>8}{:>16}{:>16}{:>12.3}{:>20.1}{exponent:>10}",
            MESHES[i],
            counters[i].steps,
            counters[i].factorisations,
            work(i),
            1e3 * least[i],
            1e9 * least[i] / work(i),
        );
    }
}

#[divan::bench(args = [5, 10, 20], sample_count = 10)]
fn frozen_assembled(bencher: Bencher, cells: usize) {
    bench_case(bencher, &case("GC-SRI-patch", cells, Configuration::Frozen), Kernel::Fastest);
}

#[divan::bench(args = [5, 10], sample_count = 10)]
fn frozen_point_wise(bencher: Bencher, cells: usize) {
    bench_case(bencher, &case("GC-SRI-patch", cells, Configuration::Frozen), Kernel::PointWise);
}

#[divan::bench(args = [5, 10], sample_count = 10)]
fn moving(bencher: Bencher, cells: usize) {
    bench_case(bencher, &case("GC-SRI-patch", cells, Configuration::Updated), Kernel::PointWise);
}

/// To `T_v` = 1 with steps that grow with time.
#[divan::bench(args = [10, 80, 640], sample_count = 10)]
fn implicit_frozen(bencher: Bencher, cells: usize) {
    bench_case(bencher, &implicit_case("GC-SRI-patch", &TERZAGHI, cells), Kernel::Fastest);
}

#[divan::bench(args = ["TL-GC-SRI-patch", "GC-SRI-patch"], sample_count = 10)]
fn implicit_large_strain(bencher: Bencher, method: &str) {
    bench_case(bencher, &implicit_case(method, &XIE_LEO, 10), Kernel::Fastest);
}

fn implicit_case(method: &str, scene: &'static Scene, cells: usize) -> Case {
    let method = Method::named(method).expect("a known method");
    let is_large = scene == &XIE_LEO;
    Case {
        scene,
        method: method.into(),
        column: Column { load: if is_large { 2e5 } else { 1.0 }, ..Column::default() }.into(),
        material: Material { law: (scene.soil)().law, ..Material::default() }.into(),
        integrator: IntegratorKind::Implicit,
        formulation: IntegratorKind::Implicit.default_formulation(),
        points_per_cell: if is_large { 4 } else { 2 },
        time_step: IntegratorKind::Implicit.default_rule(),
        time_factors: vec![0.05, 0.2, 1.0].into(),
        ..case("GC-SRI-patch", cells, Configuration::Frozen)
    }
}

fn case(method: &str, cells: usize, configuration: Configuration) -> Case {
    let method = Method::named(method).expect("a known method");
    Case {
        task: oedometer::Task::Solve,
        scene: &TERZAGHI,
        column: Column::default().into(),
        material: Material::default().into(),
        method: Method { configuration: Some(configuration), ..method }.into(),
        integrator: IntegratorKind::Explicit,
        formulation: IntegratorKind::Explicit.default_formulation(),
        settings: ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() },
        cells,
        points_per_cell: 2,
        time_step: TimeStep::Stable(0.8),
        time_factors: vec![0.05].into(),
        swept: std::sync::Arc::default(),
    }
}

/// One item is one point in one step.
fn bench_case(bencher: Bencher, case: &Case, kernel: Kernel) {
    let updates = solve(case, kernel).counters.point_updates;
    bencher.counter(ItemsCount::new(updates)).bench_local(|| solve(case, kernel));
}

fn solve(case: &Case, kernel: Kernel) -> Record {
    run_case(case, &case.scene.reference_kinds(), kernel, true, &|_, _| true).expect("a possible column")
}
