//! A step allocates nothing, whatever the method, the configuration and the kernel.

use oedometer::scenes::TERZAGHI;
use oedometer::{
    AssembledStep, Body, Column, Configuration, Continuity, Discrete, Drag, ExplicitSettings, Material,
    Method, column_problem, predicted_critical_step,
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const STEPS: usize = 20;
/// The counter is the whole process's: another thread of the test harness may allocate once, a
/// step that allocates does so every time.
const TRIES: usize = 3;

/// Fewest allocations of the tries, which end with one that has none.
fn allocations(mut work: impl FnMut()) -> usize {
    let mut count = || {
        let region = Region::new(ALLOCATOR);
        work();
        let change = region.change();
        change.allocations + change.reallocations + change.deallocations
    };
    let mut fewest = usize::MAX;
    for _ in 0..TRIES {
        fewest = fewest.min(count());
        if fewest == 0 {
            break;
        }
    }
    fewest
}

fn column(name: &str, configuration: Configuration, continuity: Continuity) -> Discrete<1> {
    let method =
        Method { configuration: Some(configuration), ..Method::named(name).expect("a known method") };
    let soil = Material { continuity, ..Material::default() };
    column_problem(&TERZAGHI, &Column::default(), &soil, method, 6, 2).expect("the seed column")
}

/// Whether it steps by assembled operators too. A point-wise step that factors a matrix may allocate.
fn assert_no_allocation(
    problem: Discrete<1>,
    settings: &ExplicitSettings,
    what: &str,
    factors_every_step: bool,
) -> bool {
    let dt = 0.5 * predicted_critical_step(&problem, settings);
    let mut body = Body::new(problem);
    let assembled = (!body.configuration.deforms()).then(|| AssembledStep::new(&body));
    let has_assembled = assembled.is_some();
    if let Some(mut assembled) = assembled {
        assembled.set_step(dt, settings);
        let count = allocations(|| (0..STEPS).for_each(|_| assembled.step(dt, settings)));
        assert_eq!(count, 0, "assembled, {what}");
        assert!(assembled.largest_velocity() > 0.0, "it did step, {what}");
    }
    let count = allocations(|| (0..STEPS).for_each(|_| body.explicit_step(dt, settings)));
    assert!(count == 0 || factors_every_step, "point-wise, {what}: {count}");
    assert!(body.largest_velocity() > 0.0, "it did step, {what}");
    has_assembled
}

/// One test alone in its file: the counter is shared by all threads.
#[test]
fn a_step_allocates_nothing() {
    // The counter counts.
    assert!(allocations(|| drop(std::hint::black_box(vec![0_u8; 100]))) >= 2);
    let mut assembled = 0;
    for name in Method::names() {
        for configuration in Configuration::ALL {
            for (drag, flip, mapping_back, continuity) in [
                (Drag::Explicit, 1.0, true, Continuity::Conservative),
                (Drag::Implicit, 0.99, false, Continuity::ConstantPorosityGradient),
                (Drag::Centred, 1.0, true, Continuity::Conservative),
            ] {
                let settings = ExplicitSettings { drag, flip, mapping_back, ..ExplicitSettings::default() };
                let what = format!("{name} {configuration:?} {settings:?} {continuity:?}");
                let problem = column(&name, configuration, continuity);
                let factors_every_step = Method::named(&name).is_some_and(|method| method.has_projection());
                assembled += usize::from(assert_no_allocation(problem, &settings, &what, factors_every_step));
            }
        }
    }
    assert!(assembled > 0, "no method was assembled");
}
