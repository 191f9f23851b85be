//! A random sweep of our own: cases over all scenes, methods, integrators, soils and meshes, and what must hold of any.
//!
//! The same cases on every machine and at every call. `OEDOMETER_RANDOM_CASES` asks for another number of them and
//! `OEDOMETER_RANDOM_SEED` for others; each violation is told with the command that repeats it.

mod differential;
mod draw;
mod halved;
mod known;
mod laws;
mod numbers;
mod options;
mod refused;
mod relations;
mod shares;
mod solved;

use crate::laws::{Violation, violations_of};
use crate::options::Options;
use crate::solved::Solved;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Cases of a call that asks for no other number.
const CASES: u64 = 400;
/// Seed of a call that asks for no other.
const SEED: u64 = 34;
/// Threads: those of a small machine. No result depends on it.
const THREADS: usize = 2;

/// What one index of the sweep comes to.
struct Outcome {
    options: Options,
    /// Kind of its end, or the relation that was looked at.
    kind: String,
    violations: Vec<Violation>,
}

fn asked(variable: &str, otherwise: u64) -> u64 {
    let Ok(typed) = std::env::var(variable) else { return otherwise };
    typed.parse().unwrap_or_else(|_| panic!("{variable}={typed} is no whole number"))
}

/// Outcomes in the order of their indices, solved side by side.
fn swept<T: Send>(cases: u64, outcome_of: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let (next, ended) = (AtomicU64::new(0), Mutex::new(BTreeMap::new()));
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= cases {
                        break;
                    }
                    let outcome = outcome_of(index);
                    ended.lock().expect("no thread panics").insert(index, outcome);
                }
            });
        }
    });
    ended.into_inner().expect("no thread panics").into_values().collect()
}

/// Counts the ends, and fails on what is violated and not known.
fn judge(what: &str, seed: u64, outcomes: &[Outcome]) {
    let mut ends: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut told, mut known, mut unknown) = (String::new(), 0, 0);
    for (index, outcome) in outcomes.iter().enumerate() {
        *ends.entry(&outcome.kind).or_default() += 1;
        for violation in &outcome.violations {
            let line = known::line_of(&outcome.options, violation);
            known += usize::from(line.is_some());
            unknown += usize::from(line.is_none());
            let (rule, said) = (violation.rule, &violation.said);
            let line = line.map_or(String::new(), |line| format!(" (known: {line})"));
            writeln!(told, "case {index}, {rule}{line}: {said}\n    {}", outcome.options.command())
                .expect("memory");
        }
    }
    let counts: Vec<String> = ends.iter().map(|(end, count)| format!("{count} {end}")).collect();
    let cases = outcomes.len();
    let summary = format!(
        "{told}{what} of seed {seed}: {cases} cases, {}; {known} known violations, {unknown} others",
        counts.join(", ")
    );
    std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("{summary}\n")).expect("a stream");
    assert_eq!(unknown, 0, "{what}: see the lines above");
}

/// What a sweep by hand once found, `bounds` or a relation and the command of the case, one a line.
const MENDED: &str = include_str!("mended.txt");

#[test]
fn what_was_mended_stays_mended() {
    let cases: Vec<(&str, Options)> = MENDED
        .lines()
        .map(|line| line.split_once(' ').expect("a law and a command"))
        .map(|(law, command)| (law, Options::of_command(command)))
        .collect();
    let outcomes = swept(cases.len() as u64, |index| {
        let (law, options) = cases[usize::try_from(index).expect("few")].clone();
        let (kind, violations) = if law == "bounds" {
            let solved = Solved::of(&options);
            (solved.end.kind(), violations_of(&solved))
        } else {
            relations::held(&relations::named(law, options.clone()))
        };
        Outcome { options, kind, violations }
    });
    judge("mended cases", 0, &outcomes);
}

#[test]
fn what_ends_ok_is_within_its_bounds() {
    let seed = asked("OEDOMETER_RANDOM_SEED", SEED);
    let outcomes = swept(asked("OEDOMETER_RANDOM_CASES", CASES), |index| {
        let options = draw::drawn(seed, index);
        let solved = Solved::of(&options);
        Outcome { options, kind: solved.end.kind(), violations: violations_of(&solved) }
    });
    judge("bounds", seed, &outcomes);
}

#[test]
fn what_theory_makes_equal_is_equal() {
    let seed = asked("OEDOMETER_RANDOM_SEED", SEED);
    let outcomes = swept(asked("OEDOMETER_RANDOM_CASES", CASES) * 3 / 4, |index| {
        let related = relations::drawn(seed, index);
        let (kind, violations) = relations::held(&related);
        Outcome { options: related.base, kind, violations }
    });
    judge("relations", seed, &outcomes);
}

#[test]
fn halved_steps_at_large_strain_do_not_leave_the_exact_solution_in_silence() {
    let seed = asked("OEDOMETER_RANDOM_SEED", SEED);
    let outcomes = swept(asked("OEDOMETER_RANDOM_CASES", CASES) / 20, |index| {
        let options = halved::drawn(seed, index);
        let (kind, violations) = halved::held(&options);
        Outcome { options, kind, violations }
    });
    judge("halved steps", seed, &outcomes);
}

#[test]
fn shares_of_the_critical_step_run_below_it_and_not_above() {
    let seed = asked("OEDOMETER_RANDOM_SEED", SEED);
    let outcomes = swept(asked("OEDOMETER_RANDOM_CASES", CASES) / 10, |index| {
        let options = shares::drawn(seed, index);
        let (kind, violations) = shares::held(&options);
        Outcome { options, kind, violations }
    });
    judge("shares of the critical step", seed, &outcomes);
}
