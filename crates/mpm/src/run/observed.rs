//! The critical time step of a problem, predicted and observed.
//!
//! Predicted from the spectral radius of the step operator on the problem's own grid; observed in runs of the solver
//! itself, independent of the prediction, by bisection between a step that runs and one that fails. Where the body deforms the
//! limit changes along the run: there the runs are those of a user, whose steps are a share of the limit of the moment.

use crate::integrate::critical_step::power;
use crate::integrate::critical_step::predicted::{
    Prediction, one_point_set, predict, predict_for_run, whole_growth,
};
use crate::kernel::body::{Body, Discrete};
use crate::run::{Kernel, Observer, Schedule, run};
use crate::time_limit::TimeLimit;
use oedometer_problem::critical_step::{CriticalStep, OBSERVED_STEPS, Probe, SHARES};
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::outcome::{Failure, FailureKind};
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
/// Width of the last bracket of shares, relative.
const SHARE_RESOLUTION: f64 = 5e-3;
/// Smallest share that is tried: a run that fails under it fails by more than its steps.
const LEAST_SHARE: f64 = 0.05;

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
    if problem.configuration.deforms() {
        return SharesOfRuns::new(problem, settings, end, most_steps, observer).critical_step();
    }
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
    Ok(CriticalStep {
        predicted,
        creeping_from,
        unknown: prediction.growing.map(|growing| growing.to_string()),
        observed,
        resolution,
        probes,
        ..by_formula(&problem, settings)
    })
}

/// What is known of a problem's critical step without a run.
fn by_formula<const D: usize>(problem: &Discrete<D>, settings: &ExplicitSettings) -> CriticalStep {
    let cell_size = problem.grid.cell_size;
    CriticalStep {
        wave_limit: problem
            .least_of_soils(|soil| cell_size / wave_speeds::fastest_wave_speed(soil, soil.porosity)),
        drag_limit: problem.least_of_soils(wave_speeds::drag_limit),
        combined_limit: problem
            .least_of_soils(|soil| wave_speeds::combined_limit(soil, cell_size, settings.drag)),
        asymmetry: Some(power::asymmetry(&Body::new(one_point_set(problem)))),
        ..CriticalStep::default()
    }
}

/// Runs of a body that deforms, whose steps are shares of the critical one.
struct SharesOfRuns<'a, const D: usize> {
    problem: &'a Discrete<D>,
    settings: &'a ExplicitSettings,
    prediction: Prediction<D>,
    /// End of the scene, s.
    end: f64,
    most_steps: u64,
    observer: Observer<'a>,
}

/// What became of the run of a share.
struct RunOfShare {
    steps: u64,
    reaches_end: bool,
    /// Smallest critical step on its way, s.
    smallest: f64,
    failure: Option<Failure>,
}

impl<'a, const D: usize> SharesOfRuns<'a, D> {
    fn new(
        problem: &'a Discrete<D>,
        settings: &'a ExplicitSettings,
        end: f64,
        most_steps: u64,
        observer: Observer<'a>,
    ) -> Self {
        let prediction = predict_for_run(problem, settings);
        Self { problem, settings, prediction, end, most_steps, observer }
    }

    /// The critical step: predicted the smallest of the run, observed the largest share of it under which runs end, with a
    /// smaller one that was tried too.
    fn critical_step(&self) -> Result<CriticalStep, Stopped> {
        let runs = SHARES.map(|share| self.run(share));
        let [below, above] = runs;
        let runs = [below?, above?];
        let (observed, smallest) = self.observed_share(&runs)?;
        let reliable_share = observed.map(|[low, _]| reliable_share(low));
        let probe = |(share, run): (f64, RunOfShare)| Probe {
            share,
            step: share * smallest,
            predicted_growth: self.prediction.growth(share * self.prediction.critical_step),
            steps: run.steps,
            reaches_end: run.reaches_end,
            failure: run.failure,
        };
        Ok(CriticalStep {
            predicted: smallest,
            unknown: self.prediction.growing.map(|growing| growing.to_string()),
            observed: observed.map(|[low, high]| 0.5 * (low + high) * smallest),
            reliable_share,
            resolution: observed.map(|[low, high]| (high - low) / (high + low)),
            probes: SHARES.into_iter().zip(runs).map(probe).collect(),
            ..by_formula(self.problem, self.settings)
        })
    }

    /// Shares between which runs begin to fail, where there are any, and the smallest critical step of the run of the largest
    /// share that ends. While a point crosses cells a mode may grow, and fade before it shows: of two shares that run a smaller
    /// one may fail, and the search goes on below it.
    fn observed_share(&self, [below, above]: &[RunOfShare; 2]) -> Result<(Option<[f64; 2]>, f64), Stopped> {
        let [mut low, mut high] = SHARES;
        if above.failure.is_none() {
            return Ok((None, above.smallest));
        }
        let (mut runs, mut smallest) = (below.failure.is_none(), below.smallest);
        loop {
            while !runs {
                (high, low) = (low, 0.5 * low);
                if low < LEAST_SHARE {
                    return Ok((None, smallest));
                }
                let run = self.run(low)?;
                (runs, smallest) = (run.failure.is_none(), run.smallest);
            }
            while high - low > SHARE_RESOLUTION * low {
                let middle = 0.5 * (low + high);
                let run = self.run(middle)?;
                if run.failure.is_none() {
                    (low, smallest) = (middle, run.smallest);
                } else {
                    high = middle;
                }
            }
            let reliable = reliable_share(low);
            if self.run(reliable)?.failure.is_none() {
                return Ok((Some([low, high]), smallest));
            }
            (low, runs) = (reliable, false);
        }
    }

    /// The run that a user makes with steps of this share: to the end of the scene, or as far as growth shows.
    fn run(&self, share: f64) -> Result<RunOfShare, Stopped> {
        let critical = self.prediction.critical_step;
        let step = share * critical;
        let steps = steps_to(self.end, step).clamp(OBSERVED_STEPS, self.most_steps.max(OBSERVED_STEPS));
        let end = steps as f64 * step;
        let schedule =
            Schedule { time_step: TimeStep::Stable(share), ..schedule_of(self.settings, end, critical) };
        let outcome = run(self.problem.clone(), &schedule, self.observer);
        Ok(RunOfShare {
            steps: outcome.counters.steps,
            reaches_end: end >= self.end * (1.0 - 1e-9),
            smallest: outcome.step_sizes.smallest_critical.unwrap_or(critical),
            failure: failure_of(outcome.status)?,
        })
    }
}

/// The share that is named beside the largest under which a run ended: a twentieth below it, in hundredths.
fn reliable_share(largest: f64) -> f64 {
    (95.0 * largest).floor() / 100.0
}

/// Largest step that runs, s, and half of the bracket that is left of the bisection, over it; none where no step near the
/// prediction fails. The search begins between the probes and goes outwards where they contradict the prediction.
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
        time_step: TimeStep::Seconds(step),
        // Steps of so many seconds do not depend on the critical one; a failure names their share of it.
        ..schedule_of(settings, steps as f64 * step, predicted)
    };
    let outcome = run(problem.clone(), &schedule, observer);
    Ok((outcome.counters.steps, failure_of(outcome.status)?))
}

/// A run to an end, s, under the critical step, with a critical step that is known.
fn schedule_of(settings: &ExplicitSettings, end: f64, critical: f64) -> Schedule {
    Schedule {
        outputs: vec![end],
        history: Vec::new(),
        notes_energy: false,
        time_step: TimeStep::Seconds(critical),
        settings: *settings,
        kernel: Kernel::Fastest,
        integrator: IntegratorKind::Explicit,
        formulation: Formulation::VW,
        threads: 1,
        time_limit: TimeLimit::default(),
        critical_step: Some(critical),
    }
}

fn failure_of(status: Result<(), Failure>) -> Result<Option<Failure>, Stopped> {
    match status.err() {
        Some(failure) if failure.kind == FailureKind::Stopped => Err(Stopped),
        failure => Ok(failure),
    }
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
    use oedometer_problem::settings::Drag;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{TERZAGHI, XIE_LEO};
    use oedometer_soil::law::Law;
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

    #[test]
    fn where_points_deform_the_limit_is_that_of_the_runs_of_a_user() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        let soil = Material {
            law: Law::LogLinear,
            porosity: 0.6,
            hydraulic_conductivity: 1e-3,
            ..Material::default()
        };
        let shortening = -(1.0_f64 - 0.3).ln();
        let column = Column { load: shortening * soil.oedometric_modulus(), ..Column::default() };
        // Points that cross cells fail before the predicted step, and beyond a step that fails others may run.
        for (name, least, most, above) in
            [("TL-GC-SRI-patch", 0.97, 1.05, 1.1), ("MPM", 0.05, 0.97, 1.1 / 0.05)]
        {
            let method = Method::named(name).expect("a known method");
            let problem = column_problem::<1>(&XIE_LEO, &column, &soil, method, 8, 2).expect("a column");
            let end = 0.05 / soil.coefficient_of_consolidation();
            let found =
                critical_step(&problem, &settings, end, 1 << 18, &|_, _| true).expect("nobody stops it");
            let share = found.observed.expect("a limit") / found.predicted;
            let reliable = found.reliable_share.expect("a limit");
            assert!((0.0..0.011).contains(&(0.95 * share - reliable)), "{name}: {reliable} below {share}");
            assert!((least..=most).contains(&share), "{name}: {share} of {found:?}");
            let start = predict_for_run(&problem, &settings).critical_step;
            assert!(
                found.predicted < 0.95 * start,
                "{name}: the smallest of the run, {} of {start}",
                found.predicted
            );
            let runs = |share: f64| {
                let schedule =
                    Schedule { time_step: TimeStep::Stable(share), ..schedule_of(&settings, end, start) };
                run(problem.clone(), &schedule, &|_, _| true).status.is_ok()
            };
            assert_eq!([reliable, above * share].map(runs), [true, false], "{name}");
            assert_eq!(
                found.probes[0].failure.is_none(),
                runs(SHARES[0]),
                "{name}: what is observed is what runs"
            );
        }
    }
}
