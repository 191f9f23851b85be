//! A step allocates nothing, whatever the method, the configuration and the kernel.

use oedometer::{
    Column, Configuration, Continuity, Drag, ExplicitSettings, Material, Method, SceneKind, SteppedColumn,
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

fn column(
    name: &str,
    configuration: Configuration,
    continuity: Continuity,
    settings: ExplicitSettings,
) -> SteppedColumn {
    let method =
        Method { configuration: Some(configuration), ..Method::named(name).expect("a known method") };
    let soil = Material { continuity, ..Material::default() };
    let of_seed = (&Column::default(), &soil, method);
    SteppedColumn::new(SceneKind::Terzaghi, of_seed, [6, 2], settings).expect("the seed column")
}

/// Whether it steps by assembled operators too. A point-wise step that factors a matrix may allocate.
fn assert_no_allocation(mut column: SteppedColumn, what: &str, factors_every_step: bool) -> bool {
    let dt = 0.5 * column.critical_step;
    let has_assembled = column.set_step(dt);
    if has_assembled {
        let count = allocations(|| (0..STEPS).for_each(|_| column.assembled_step(dt)));
        assert_eq!(count, 0, "assembled, {what}");
    }
    let count = allocations(|| (0..STEPS).for_each(|_| column.step(dt)));
    assert!(count == 0 || factors_every_step, "point-wise, {what}: {count}");
    let [point_wise, assembled] = column.largest_velocities();
    assert!(point_wise > 0.0 && (assembled > 0.0 || !has_assembled), "it did step, {what}");
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
                let column = column(&name, configuration, continuity, settings);
                let factors_every_step = Method::named(&name).is_some_and(|method| method.has_projection());
                assembled += usize::from(assert_no_allocation(column, &what, factors_every_step));
            }
        }
    }
    assert!(assembled > 0, "no method was assembled");
}
