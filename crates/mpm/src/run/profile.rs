//! Where the time of a run goes, phase by phase.
//!
//! A run says which phase it enters; nothing listens unless [`profiled`] does, and then the time
//! between two words belongs to the phase that the first one named. Results know nothing of it.

use oedometer_soil::wording::words;
use serde::{Deserialize, Serialize};
use std::cell::{Cell, RefCell};
use std::time::Instant;

/// What a run can be busy with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Problem, body and start.
    Setup,
    /// The critical step, predicted from the step operator.
    CriticalStep,
    /// Operators between points, nodes and cells on the points' present places.
    BuildWeights,
    /// Masses and velocities from the points to the grid.
    MapVelocities,
    /// Nodal forces and accelerations.
    Forces,
    /// Velocities and places of nodes and points.
    Motion,
    /// Effective stresses and volumes of the points.
    Stresses,
    /// Pressure increments and their recovery to the points.
    Recovery,
    /// What the balances of a trial state leave: forces, stresses and recovery of an implicit step.
    Balances,
    /// The matrix of an implicit step.
    Assembly,
    /// Its factors.
    Factors,
    /// Solutions of systems by the factors.
    Solve,
    /// Snapshots, history, and the look whether the run has left.
    Outputs,
    /// Exact solutions and errors.
    Assessment,
}

words!(Phase: Setup "setup",
    CriticalStep "critical step",
    BuildWeights "build weights",
    MapVelocities "map velocities",
    Forces "forces",
    Motion "motion",
    Stresses "stresses",
    Recovery "pressures and recovery",
    Balances "balances of trial states",
    Assembly "assembly",
    Factors "factors",
    Solve "solve",
    Outputs "outputs",
    Assessment "exact solution and errors",);

/// Time of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseTime {
    /// The phase.
    pub phase: Phase,
    /// Seconds, without those of the clock itself.
    pub seconds: f64,
    /// Share of the whole.
    pub share: f64,
    /// How often it was entered.
    pub entries: u64,
}

/// Phase in which time passes, and what the others took.
struct Clock {
    phase: Phase,
    since: Instant,
    seconds: [f64; Phase::ALL.len()],
    entries: [u64; Phase::ALL.len()],
}

thread_local! {
    static LISTENING: Cell<bool> = const { Cell::new(false) };
    static CLOCK: RefCell<Option<Clock>> = const { RefCell::new(None) };
}

/// Says that a phase begins.
#[inline]
pub fn enter(phase: Phase) {
    if LISTENING.get() {
        switch(phase);
    }
}

/// Does something that is a phase as a whole, whatever phases it is made of.
pub fn within<T>(phase: Phase, work: impl FnOnce() -> T) -> T {
    enter(phase);
    let listening = LISTENING.replace(false);
    let result = work();
    LISTENING.set(listening);
    result
}

#[cold]
fn switch(phase: Phase) {
    CLOCK.with_borrow_mut(|clock| {
        if let Some(clock) = clock {
            let now = Instant::now();
            clock.seconds[clock.phase as usize] += (now - clock.since).as_secs_f64();
            clock.entries[phase as usize] += 1;
            clock.phase = phase;
            clock.since = now;
        }
    });
}

/// Does something on this thread, and says which of its phases took how long, those that did not
/// occur left out.
pub fn profiled<T>(work: impl FnOnce() -> T) -> (T, Vec<PhaseTime>) {
    listen();
    let result = work();
    let Some(clock) = stop_listening() else { return (result, Vec::new()) };
    let cost = seconds_of_an_entry();
    let seconds =
        |phase: Phase| (clock.seconds[phase as usize] - cost * clock.entries[phase as usize] as f64).max(0.0);
    let whole: f64 = Phase::ALL.into_iter().map(seconds).sum();
    let time_of = |phase: Phase| PhaseTime {
        phase,
        seconds: seconds(phase),
        share: seconds(phase) / whole.max(f64::MIN_POSITIVE),
        entries: clock.entries[phase as usize],
    };
    let entered = Phase::ALL.into_iter().filter(|phase| clock.entries[*phase as usize] > 0);
    (result, entered.map(time_of).collect())
}

fn listen() {
    let mut entries = [0; Phase::ALL.len()];
    entries[Phase::Setup as usize] = 1;
    let clock =
        Clock { phase: Phase::Setup, since: Instant::now(), seconds: [0.0; Phase::ALL.len()], entries };
    CLOCK.set(Some(clock));
    LISTENING.set(true);
}

fn stop_listening() -> Option<Clock> {
    // Ends the phase that is on; its own entry is not one of the run's.
    let last = CLOCK.with_borrow(|clock| clock.as_ref().map(|clock| clock.phase))?;
    enter(last);
    LISTENING.set(false);
    let mut clock = CLOCK.take()?;
    clock.entries[last as usize] -= 1;
    Some(clock)
}

/// What the clock takes of the time between two words, s.
fn seconds_of_an_entry() -> f64 {
    const ENTRIES: u32 = 4096;
    const ROUNDS: usize = 7;
    let round = || {
        listen();
        for _ in 0..ENTRIES {
            enter(Phase::Setup);
        }
        stop_listening().map_or(0.0, |clock| clock.seconds[0] / f64::from(ENTRIES))
    };
    (0..ROUNDS).map(|_| round()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn time_belongs_to_the_phase_that_was_entered_last() {
        let ((), times) = profiled(|| {
            enter(Phase::Forces);
            std::thread::sleep(Duration::from_millis(4));
            within(Phase::Solve, || enter(Phase::Stresses));
            enter(Phase::Forces);
            std::thread::sleep(Duration::from_millis(4));
        });
        let of = |phase| times.iter().find(|time| time.phase == phase).copied();
        let forces = of(Phase::Forces).expect("entered");
        assert!(forces.seconds >= 0.008 && forces.share > 0.9, "{forces:?}");
        assert_eq!((forces.entries, of(Phase::Solve).map(|time| time.entries)), (2, Some(1)));
        assert_eq!(of(Phase::Stresses), None);
        assert!((times.iter().map(|time| time.share).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_listens_outside() {
        enter(Phase::Forces);
        assert!(CLOCK.with_borrow(Option::is_none));
    }
}
