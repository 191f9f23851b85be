//! Notes on long runs before they start: the estimated time, and what would take less.

use crate::campaign::runner::LongestCase;
use crate::case::keys::{Key, Value};
use crate::case::work_estimate::estimated_seconds;
use crate::case::{Case, Task};
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_soil::wording::duration;

/// Seconds from which on a case is worth a word before it starts.
const LONG_CASE: f64 = 120.0;
/// Seconds from which on a whole run is.
const LONG_RUN: f64 = 60.0;
/// How much faster another choice has to be to be worth naming.
const WORTH_NAMING: f64 = 5.0;

/// Time of cases side by side, s: that of their sum over the cores, and of the longest at least.
pub fn side_by_side(total: f64, longest: f64, jobs: usize) -> f64 {
    (total / jobs.max(1) as f64).max(longest)
}

/// How long a run will take, where that is worth a word.
pub fn note_on_run(name: &str, cases: usize, seconds: f64) -> Option<String> {
    (seconds >= LONG_RUN).then(|| format!("{name}: {cases} cases, about {}", duration(seconds)))
}

/// What is to be said of the longest case of a run, where it is long: its time, and what would take less.
pub fn note_on_longest(longest: &LongestCase) -> Option<String> {
    note_with(longest, |integrator| format!("`integrator = [\"{integrator}\"]` in its [[sweep]]"))
}

/// Time notes of a case that the command line describes.
pub fn note_on_solve(longest: &LongestCase) -> Option<String> {
    note_with(longest, |integrator| format!("`--integrator {integrator}`"))
}

fn note_with(longest: &LongestCase, take: impl Fn(&str) -> String) -> Option<String> {
    let LongestCase { study, case, case_seconds } = longest;
    let seconds = estimated_seconds(case);
    if seconds < LONG_CASE {
        return None;
    }
    let own = case.integrator.name();
    let remedy = match faster(case) {
        Some(other) => {
            format!("; {}: {}", take(other.integrator.name()), duration(estimated_seconds(&other)))
        }
        None if case.task == Task::Stability => "; an earlier last `time_factors` takes less".to_owned(),
        None => "; larger steps, fewer cells or an earlier last `time_factors` take less".to_owned(),
    };
    let end = if *case_seconds < seconds {
        format!(", and the case is ended after {} (`case_seconds = {case_seconds}`)", duration(*case_seconds))
    } else {
        String::new()
    };
    Some(format!("warning: {study}: {}\n  {own}: about {}{remedy}{end}", case.label(), duration(seconds)))
}

/// The case by the integrator that takes long steps, where that is much faster: a scene without waves needs no
/// step that follows them.
fn faster(case: &Case) -> Option<Case> {
    if case.integrator == IntegratorKind::Implicit || case.task == Task::Stability || case.scene.has_waves() {
        return None;
    }
    let mut other = case.clone();
    Key::named("integrator", "sweep")?.set(&mut other, Value::Word(IntegratorKind::Implicit.name()));
    (estimated_seconds(case) > WORTH_NAMING * estimated_seconds(&other)).then_some(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_mpm::scene::SceneKind;

    fn longest(scene: SceneKind, integrator: IntegratorKind, conductivity: f64) -> LongestCase {
        let mut case = Case::seed(Task::Solve, scene);
        case.cells = 20;
        case.time_factors = vec![1.0].into();
        case.material.hydraulic_conductivity = conductivity;
        let key = Key::named("integrator", "sweep").expect("a key");
        key.set(&mut case, Value::Word(integrator.name()));
        LongestCase { study: "soft".to_owned(), case, case_seconds: 3600.0 }
    }

    #[test]
    fn a_case_of_hours_is_told_with_what_takes_seconds() {
        let note = note_on_longest(&longest(SceneKind::Terzaghi, IntegratorKind::Explicit, 1e-7));
        let note = note.expect("it is long");
        assert!(
            note.contains("integrator = [\"implicit\"]") && note.contains("case_seconds = 3600"),
            "{note}"
        );
        assert_eq!(note_on_longest(&longest(SceneKind::Terzaghi, IntegratorKind::Explicit, 1e-3)), None);
        assert_eq!(note_on_longest(&longest(SceneKind::Terzaghi, IntegratorKind::Implicit, 1e-7)), None);
    }

    #[test]
    fn no_scene_of_waves_is_sent_to_long_steps() {
        let note = note_on_longest(&longest(SceneKind::DynamicColumn, IntegratorKind::Explicit, 1e-7));
        assert!(!note.expect("it is long").contains("implicit"));
    }

    #[test]
    fn cases_side_by_side_take_as_long_as_the_longest() {
        assert_eq!(side_by_side(10.0, 2.0, 4), 2.5);
        assert_eq!(side_by_side(10.0, 8.0, 4), 8.0);
    }
}
