//! A step allocates nothing, whatever the method, the configuration and the kernel.

use oedometer::{
    AssembledStep, Body, Column, Configuration, Continuity, Drag, ExplicitSettings, Material, Method,
    Problem, SceneKind, column_problem, predicted_critical_step,
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const STEPS: usize = 100;
/// The counter is the whole process's: another thread of the test harness may allocate once, a
/// step that allocates does so every time.
const TRIES: usize = 3;

/// Fewest allocations of the tries.
fn allocations(mut work: impl FnMut()) -> usize {
    let count = |_| {
        let region = Region::new(ALLOCATOR);
        work();
        let change = region.change();
        change.allocations + change.reallocations + change.deallocations
    };
    (0..TRIES).map(count).min().unwrap_or(usize::MAX)
}

fn problem(name: &str, configuration: Configuration, continuity: Continuity) -> Problem<1> {
    let method =
        Method { configuration: Some(configuration), ..Method::named(name).expect("a known method") };
    let soil = Material { continuity, ..Material::default() };
    column_problem(SceneKind::Terzaghi, &Column::default(), &soil, method, 6, 2).expect("the seed column")
}

fn assert_no_allocation(mut body: Body<1>, dt: f64, settings: &ExplicitSettings, what: &str) {
    if !body.configuration.deforms() {
        let mut column = AssembledStep::new(&body);
        column.set_step(dt, settings);
        let count = allocations(|| (0..STEPS).for_each(|_| column.step(dt, settings)));
        assert_eq!(count, 0, "assembled, {what}");
        assert!(column.largest_velocity() > 0.0, "it did step");
    }
    let count = allocations(|| (0..STEPS).for_each(|_| body.explicit_step(dt, settings)));
    assert_eq!(count, 0, "point-wise, {what}");
    assert!(body.largest_velocity() > 0.0, "it did step");
}

/// One test alone in its file: the counter is shared by all threads.
#[test]
fn a_step_allocates_nothing() {
    // The counter counts.
    assert!(allocations(|| drop(std::hint::black_box(vec![0_u8; 100]))) >= 2);
    for name in Method::names() {
        for configuration in Configuration::ALL {
            for (drag, flip, mapping_back, continuity) in [
                (Drag::Explicit, 1.0, true, Continuity::Conservative),
                (Drag::Implicit, 0.99, false, Continuity::ConstantPorosityGradient),
                (Drag::Centred, 1.0, true, Continuity::Conservative),
            ] {
                let settings = ExplicitSettings { drag, flip, mapping_back, ..ExplicitSettings::default() };
                let problem = problem(&name, configuration, continuity);
                let dt = 0.5 * predicted_critical_step(&problem, &settings);
                let what = format!("{name} {configuration:?} {settings:?} {continuity:?}");
                assert_no_allocation(Body::new(problem), dt, &settings, &what);
            }
        }
    }
}
