//! Refuses, before anything starts, cases that would take longer than a week.

use crate::case::keys::{Key, Value};
use crate::case::work_estimate::estimated_seconds;
use crate::case::{Case, Task, Tier};
use crate::study::check::Study;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_wording::{count_of, duration};

/// Longest estimated time of a case, s, unless the study's `case_seconds` allows more: a week.
pub const LONGEST_CASE: f64 = 7.0 * 86400.0;

/// How much faster another choice has to be to be worth naming.
const WORTH_NAMING: f64 = 5.0;

/// Cases of a study that would take longer than [`LONGEST_CASE`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{study}: {} would take longer than a week, so nothing was run\n  longest: {}, about {}\n  {}\n  or set \
     `case_seconds = {:.1e}` in the study to run it anyway", count_of(*cases, "case", "cases"),
    longest.label(), duration(*seconds), remedy(longest), 1.1 * seconds
)]
pub struct EndlessCases {
    /// The study.
    pub study: String,
    /// How many there are.
    pub cases: usize,
    /// The one that takes longest.
    pub longest: Box<Case>,
    /// Its estimated time, s.
    pub seconds: f64,
}

/// Refuses a study with cases that would take longer than a week. A study whose `case_seconds` is longer than the estimate asks for them.
///
/// # Errors
/// How many there are, and what takes less.
pub fn refuse_endless(study: &Study, tier: Tier) -> Result<(), EndlessCases> {
    let most = LONGEST_CASE.max(study.case_seconds);
    let timed = study.cases(tier).into_iter().map(|case| (study.estimated_seconds(case), case));
    // What has no finite estimate has numbers that nothing can run with, and the solver names them.
    let endless: Vec<(f64, &Case)> =
        timed.filter(|(seconds, _)| seconds.is_finite() && *seconds > most).collect();
    let Some((seconds, longest)) = endless.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Ok(());
    };
    let longest = Box::new(longest.clone());
    Err(EndlessCases { study: study.name.clone(), cases: endless.len(), longest, seconds })
}

/// What takes less time than a case.
fn remedy(case: &Case) -> String {
    match faster(case) {
        Some(other) => {
            let (name, time) = (other.integrator.name(), duration(estimated_seconds(&other)));
            format!(
                "use the {name} integrator, which takes about {time}; the drag of the pore water limits explicit steps, and their \
                 number grows as 1/hydraulic_conductivity²"
            )
        }
        None => "use larger steps, fewer cells or earlier outputs".to_owned(),
    }
}

/// The case by the integrator that takes long steps, where that is much faster: a scene without waves needs no
/// step that follows them.
pub fn faster(case: &Case) -> Option<Case> {
    if case.integrator == IntegratorKind::Implicit || case.task == Task::Stability || case.scene.waves {
        return None;
    }
    let mut other = case.clone();
    Key::named("integrator", "sweep")?.set(&mut other, Value::Word(IntegratorKind::Implicit.name()));
    (estimated_seconds(case) > WORTH_NAMING * estimated_seconds(&other)).then_some(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{RunError, RunOptions, run_study, study_of};

    /// Whoever runs a study: nothing is solved, no record is made, and the report has the one error.
    #[test]
    fn the_library_refuses_them_too_and_runs_nothing() {
        let text = "title = 't'\nscene = 'terzaghi'\nmaterial.hydraulic_conductivity = 1e-9\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['explicit', 'implicit']\ncells = [2]\n";
        let told = std::sync::Mutex::new(0);
        let count = |_| *told.lock().expect("no thread panics") += 1;
        let report = run_study(&study_of("clay", text), &RunOptions::whole(Tier::Full, 2), None, &count);
        assert_eq!((report.records.len(), *told.lock().expect("no thread panics")), (0, 0));
        assert!(
            matches!(&report.errors[..], [RunError::Endless(refused)] if refused.cases == 1),
            "{:?}",
            report.errors
        );
        let text = text.replace("'explicit', ", "");
        let report = run_study(&study_of("clay", &text), &RunOptions::whole(Tier::Full, 2), None, &|_| {});
        assert_eq!((report.records.len(), report.errors.len()), (1, 0));
    }

    #[test]
    fn a_clay_with_explicit_steps_is_refused_with_what_takes_less_unless_the_study_asks_for_it() {
        let study = |conductivity: &str, head: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n{head}\n[material]\nhydraulic_conductivity = {conductivity}\n[sweep_defaults]\n"
            )
            .replace("[sweep_defaults]\n", "[[sweep]]\nmethod = ['MPM']\nintegrator = ['explicit', 'implicit']\ncells = [10, 20]\n");
            study_of("clay", &text)
        };
        let refused = refuse_endless(&study("1e-9", ""), Tier::Full).expect_err("centuries");
        assert!(
            refused.cases == 2 && refused.longest.cells == 20 && refused.seconds > LONGEST_CASE,
            "{refused:?}"
        );
        let sentence = refused.to_string();
        for words in [
            "clay: 2 cases would take longer than a week",
            "MPM explicit cells=20",
            "use the implicit integrator",
        ] {
            assert!(sentence.contains(words), "{sentence}");
        }
        assert_eq!(refuse_endless(&study("1e-3", ""), Tier::Full), Ok(()));
        assert_eq!(refuse_endless(&study("1e-9", "case_seconds = 1e15"), Tier::Full), Ok(()));
    }
}
