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

fn case(method: &str, cells: usize, configuration: Configuration) -> Case {
    let method = Method::named(method).expect("a known method");
    Case {
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
