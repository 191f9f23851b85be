//! Whole cases: the seed column to `T_v` = 0.05, from the problem to its measured errors.

use divan::Bencher;
use divan::counter::ItemsCount;
use oedometer::record::Record;
use oedometer::scene::{Column, SceneKind};
use oedometer::solver::explicit::{Drag, ExplicitSettings};
use oedometer::solver::material::Material;
use oedometer::solver::method::{Configuration, Method};
use oedometer::solver::run::{Kernel, TimeStepRule};
use oedometer::study::{Case, IntegratorKind, run_case};

fn main() {
    divan::main();
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
    bench_case(bencher, &implicit_case("GC-SRI-patch", SceneKind::Terzaghi, cells), Kernel::Fastest);
}

#[divan::bench(args = ["TL-GC-SRI-patch", "GC-SRI-patch"], sample_count = 10)]
fn implicit_large_strain(bencher: Bencher, method: &str) {
    bench_case(bencher, &implicit_case(method, SceneKind::XieLeo, 10), Kernel::Fastest);
}

fn implicit_case(method: &str, scene: SceneKind, cells: usize) -> Case {
    let method = Method::named(method).expect("a known method");
    let is_large = scene == SceneKind::XieLeo;
    Case {
        scene,
        method,
        column: Column { load: if is_large { 2e5 } else { 1.0 }, ..Column::default() },
        material: Material { law: scene.default_law(), ..Material::default() },
        integrator: IntegratorKind::Implicit,
        formulation: IntegratorKind::Implicit.default_formulation(),
        points_per_cell: if is_large { 4 } else { 2 },
        time_step: IntegratorKind::Implicit.default_rule(),
        time_factors: vec![0.05, 0.2, 1.0],
        ..case("GC-SRI-patch", cells, Configuration::Frozen)
    }
}

fn case(method: &str, cells: usize, configuration: Configuration) -> Case {
    let method = Method::named(method).expect("a known method");
    Case {
        task: oedometer::study::Task::Solve,
        scene: SceneKind::Terzaghi,
        column: Column::default(),
        material: Material::default(),
        method: Method { configuration: Some(configuration), ..method },
        integrator: IntegratorKind::Explicit,
        formulation: IntegratorKind::Explicit.default_formulation(),
        settings: ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() },
        cells,
        points_per_cell: 2,
        time_step: TimeStepRule::Stable(0.8),
        time_factors: vec![0.05],
    }
}

/// One item is one point in one step.
fn bench_case(bencher: Bencher, case: &Case, kernel: Kernel) {
    let solve = || -> Record {
        run_case(case, case.scene.references(), kernel, true, &|_, _| true).expect("a possible column")
    };
    bencher.counter(ItemsCount::new(solve().counters.point_updates)).bench_local(solve);
}
