//! The critical time step of a problem, predicted and observed.
//!
//! Predicted from the spectral radius of the step operator on the problem's own grid; observed in runs of the solver
//! itself, independent of the prediction, by bisection between a step that runs and one that fails.

use crate::integrate::critical_step::power;
use crate::integrate::critical_step::predicted::{one_point_set, predict, whole_growth};
use crate::kernel::body::{Body, Discrete};
use crate::run::{Kernel, Observer, Schedule, run};
use crate::time_limit::TimeLimit;
use oedometer_problem::critical_step::{CriticalStep, OBSERVED_STEPS, Probe, SHARES};
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::outcome::{Failure, FailureKind, RunStatus};
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::time_step::TimeStep;
use oedometer_problem::wave_speeds;

/// Cells up to which the prediction is for the whole column; longer ones are shortened in their middle.
const WHOLE_COLUMN: usize = 24;
/// Bisections between a step that runs and one that fails.
pub const BISECTIONS: u32 = 24;
/// Width of the last bracket, relative.
const RESOLUTION: f64 = 1e-3;
/// Growth per step that counts as unstable in a plane, whether a run shows it or not: a doubling in ten thousand steps.
const SLOWEST_SEEN: f64 = 6.9e-5;
/// Growth per step that a run of so many steps shows: `ln(5·10^4)/32768`.
const VISIBLE_GROWTH: f64 = 3.3e-4;
/// The observer stopped the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

/// Predicts, observes, and probes both sides of the prediction, up to `end` seconds or `most_steps`
/// steps.
///
/// # Errors
/// [`Stopped`] where the observer ends it.
pub fn critical_step<const D: usize>(
    problem: &Discrete<D>,
    settings: &ExplicitSettings,
    end: f64,
    most_steps: u64,
    observer: Observer<'_>,
) -> Result<CriticalStep, Stopped> {
    let mut problem = problem.clone();
    // Growth is to be observed, not refused.
    problem.is_bounded = false;
    let prediction = predict(&problem, settings, WHOLE_COLUMN);
    let strict = prediction.critical_step;
    let seen = if D > 1 { SLOWEST_SEEN } else { VISIBLE_GROWTH };
    let is_sharp = prediction.growth(SHARES[1] * strict).is_none_or(|growth| growth > 1.0 + seen);
    let predicted = if is_sharp { strict } else { prediction.critical_step_for(seen).max(strict) };
    let creeping_from = (strict < SHARES[0] * predicted).then_some(strict);
    let mut probes = Vec::with_capacity(SHARES.len());
    for share in SHARES {
        let step = share * predicted;
        let steps = steps_to(end, step).clamp(OBSERVED_STEPS, most_steps.max(OBSERVED_STEPS));
        let (taken, failure) = leaves(&problem, settings, [step, predicted], steps, observer)?;
        probes.push(Probe {
            share,
            step,
            predicted_growth: prediction.growth(step),
            steps: taken,
            reaches_end: steps as f64 * step >= end * (1.0 - 1e-9),
            failure,
        });
    }
    let (observed, resolution) = observed_step(&problem, settings, predicted, &probes, observer)?.unzip();
    let cell_size = problem.grid.cell_size;
    Ok(CriticalStep {
        predicted,
        creeping_from,
        unknown: prediction.growing.map(|growing| growing.to_string()),
        observed,
        resolution,
        wave_limit: problem
            .least_of_soils(|soil| cell_size / wave_speeds::fastest_wave_speed(soil, soil.porosity)),
        drag_limit: problem.least_of_soils(wave_speeds::drag_limit),
        combined_limit: problem
            .least_of_soils(|soil| wave_speeds::combined_limit(soil, cell_size, settings.drag)),
        probes,
        asymmetry: Some(power::asymmetry(&Body::new(one_point_set(&problem)))),
    })
}

/// Largest step that runs, s, and half of the bracket that is left of the bisection, over it; none where no step near the prediction fails. The search begins between the probes
/// and goes outwards where they contradict the prediction.
fn observed_step<const D: usize>(
    problem: &Discrete<D>,
    settings: &ExplicitSettings,
    predicted: f64,
    probes: &[Probe],
    observer: Observer<'_>,
) -> Result<Option<(f64, f64)>, Stopped> {
    // Growth that doubles in ten thousand steps shows in the spectral radius, where the problem is small enough, but not
    // in a run of a few ten thousand steps.
    let grows =
        |step: f64| whole_growth(problem, settings, step).is_some_and(|growth| growth > 1.0 + SLOWEST_SEEN);
    let runs = |step: f64| -> Result<bool, Stopped> {
        if grows(step) {
            return Ok(false);
        }
        leaves(problem, settings, [step, predicted], OBSERVED_STEPS, observer)
            .map(|(_, failure)| failure.is_none())
    };
    let [below, above] = probes else { return Ok(None) };
    // A probe that failed only after more steps than the runs of the search have did not fail by their measure.
    let held =
        |probe: &Probe| (probe.failure.is_none() || probe.steps > OBSERVED_STEPS) && !grows(probe.step);
    let (least, most) = (1e-3 * below.step, 1e3 * above.step);
    let (mut low, mut low_runs) = (below.step, held(below));
    let (mut high, mut high_runs) = (above.step, held(above));
    while !low_runs {
        (high, high_runs) = (low, false);
        low *= 0.5;
        // Written so that a prediction of NaN ends the search.
        let is_near = low >= least;
        if !is_near {
            return Ok(None);
        }
        low_runs = runs(low)?;
    }
    while high_runs {
        low = high;
        high *= 2.0;
        let is_near = high <= most;
        if !is_near {
            return Ok(None);
        }
        high_runs = runs(high)?;
    }
    for _ in 0..BISECTIONS {
        if high - low < RESOLUTION * low {
            break;
        }
        let middle = 0.5 * (low + high);
        if runs(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    let middle = 0.5 * (low + high);
    Ok(Some((middle, 0.5 * (high - low) / middle)))
}

/// Runs a number of steps of a size, which is told beside the predicted one; the steps taken, and how the run failed.
fn leaves<const D: usize>(
    problem: &Discrete<D>,
    settings: &ExplicitSettings,
    [step, predicted]: [f64; 2],
    steps: u64,
    observer: Observer<'_>,
) -> Result<(u64, Option<Failure>), Stopped> {
    let schedule = Schedule {
        outputs: vec![steps as f64 * step],
        history: Vec::new(),
        time_step: TimeStep::Seconds(step),
        settings: *settings,
        kernel: Kernel::Fastest,
        integrator: IntegratorKind::Explicit,
        formulation: Formulation::VW,
        threads: 1,
        time_limit: TimeLimit::default(),
        // Steps of so many seconds do not depend on it; a failure names their share of it.
        critical_step: Some(predicted),
    };
    let outcome = run(problem.clone(), &schedule, observer);
    let failure = match outcome.status {
        RunStatus::Ok => None,
        RunStatus::Failed(failure) if failure.kind == FailureKind::Stopped => return Err(Stopped),
        RunStatus::Failed(failure) => Some(failure),
    };
    Ok((outcome.counters.steps, failure))
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
fn steps_to(end: f64, step: f64) -> u64 {
    (end / step).ceil().max(1.0) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_scenes::TERZAGHI;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    #[test]
    fn a_search_finds_the_limit_from_probes_on_one_side_of_it() {
        let settings = ExplicitSettings::default();
        let method = Method::named("GIMP-SRI-patch").expect("a known method");
        let (column, soil) = (Column::default(), Material::default());
        let problem = column_problem::<1>(&TERZAGHI, &column, &soil, method, 4, 2).expect("a column");
        let observed_limit = |steps: [f64; 2]| {
            let probes = steps.map(|step| {
                let (steps, failure) = leaves(&problem, &settings, [step; 2], OBSERVED_STEPS, &|_, _| true)
                    .expect("nobody stops it");
                Probe { share: 1.0, step, predicted_growth: None, steps, reaches_end: true, failure }
            });
            let found = observed_step(&problem, &settings, steps[0], &probes, &|_, _| true);
            found.expect("nobody stops it").expect("a limit").0
        };
        let predicted = predict(&problem, &settings, WHOLE_COLUMN).critical_step;
        let about = observed_limit([0.97 * predicted, 1.03 * predicted]);
        assert!((about / predicted - 1.0).abs() < 0.02, "{about} for {predicted}");
        for [low, high] in [[1.9, 2.0], [0.2, 0.3]] {
            let from_aside = observed_limit([low * predicted, high * predicted]);
            assert!((from_aside / about - 1.0).abs() < 2e-3, "{from_aside} for {about}");
        }
    }
}
