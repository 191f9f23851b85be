//! The critical step of a problem, predicted and observed.

use crate::outcome::{Failure, FailureKind};
use serde::{Deserialize, Serialize};

/// Steps of an observing run: growth of 1/700 per step shows.
pub const OBSERVED_STEPS: u64 = 32_768;
/// Shares of the predicted step that must run and must fail.
pub const SHARES: [f64; 2] = [0.97, 1.03];

/// One run at a share of the predicted step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Probe {
    /// Share of the predicted critical step.
    pub share: f64,
    /// Step, s.
    pub step: f64,
    /// Spectral radius of the step operator: the largest growth per step; none where the problem is too large.
    pub predicted_growth: Option<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Whether these steps reach the end of the scene.
    pub reaches_end: bool,
    /// Failure of the run, if it failed.
    pub failure: Option<Failure>,
}

/// The critical step of a problem, predicted and observed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CriticalStep {
    /// From the spectral radius, s: beyond it a mode grows by as much as is observed, `ln(5·10^4)/32768` per step, in a plane
    /// a doubling in 10 000 steps.
    pub predicted: f64,
    /// Step, s, from which on a mode grows more slowly, where that begins long before: no run of a few thousand steps
    /// shows it, but a million steps can.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub creeping_from: Option<f64>,
    /// Says that no limit is known, where a mode grows under any step; `predicted` is the formula's step then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unknown: Option<String>,
    /// Observed in runs, s; none where none failed.
    pub observed: Option<f64>,
    /// Half of the bracket that is left of the search, over the observed step: a smaller difference is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resolution: Option<f64>,
    /// Share of the predicted step whose run was tried and ends, where points deform: a twentieth below the observed one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reliable_share: Option<f64>,
    /// `h/c` with the fastest undamped wave, s.
    pub wave_limit: f64,
    /// Limit of explicit drag alone, s.
    pub drag_limit: f64,
    /// The safe formula for both, s.
    pub combined_limit: f64,
    /// Runs at the shares 0.97 and 1.03 of the predicted step.
    pub probes: Vec<Probe>,
    /// Asymmetry of the stiffness of skeleton and water over its largest entry: zero to round-off where the power of the
    /// forces is that of the stresses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asymmetry: Option<[f64; 2]>,
}

impl Probe {
    /// Whether it ran below the predicted step, or failed above it; a run that was stopped or timed out did neither.
    pub fn is_as_predicted(&self) -> bool {
        match &self.failure {
            None => self.share < 1.0,
            Some(failure) => {
                self.share > 1.0 && !matches!(failure.kind, FailureKind::Stopped | FailureKind::TimedOut)
            }
        }
    }
}

impl CriticalStep {
    /// Whether the runs on both sides of the prediction agree with it; false without a run on either side.
    pub fn probes_agree(&self) -> bool {
        let has = |side: fn(f64) -> bool| self.probes.iter().any(|probe| side(probe.share));
        has(|share| share < 1.0) && has(|share| share > 1.0) && self.probes.iter().all(Probe::is_as_predicted)
    }

    /// The predicted step, s, where a limit is known.
    pub fn known(&self) -> Option<f64> {
        self.unknown.is_none().then_some(self.predicted)
    }

    /// Observed over predicted step, minus one; 0 where that is within the [resolution](Self::resolution) of the search.
    pub fn deviation(&self) -> Option<f64> {
        let deviation = self.observed? / self.predicted - 1.0;
        // The prediction lies at an end of the last bracket where the search confirms it.
        // NaN stays.
        let is_none = deviation.abs() <= 1.01 * self.resolution.unwrap_or(0.0);
        Some(if is_none { 0.0 } else { deviation })
    }

    /// The resolution of the search, where observed and predicted step do not differ by more.
    pub fn within(&self) -> Option<f64> {
        self.resolution.filter(|_| self.deviation() == Some(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probe(share: f64, failure: Option<FailureKind>) -> Probe {
        let failed = |kind| Failure {
            kind,
            step: 7,
            time: 1.0,
            growth: None,
            reason: "as the test wants it".to_owned(),
        };
        let failure = failure.map(failed);
        Probe { share, step: share, predicted_growth: None, steps: 10, reaches_end: true, failure }
    }

    #[test]
    fn a_difference_below_the_resolution_of_the_search_is_none() {
        let limit = |observed: f64| CriticalStep {
            predicted: 2.0,
            observed: Some(observed),
            resolution: Some(5e-4),
            ..CriticalStep::default()
        };
        for (observed, deviation, within) in
            [(2.0009, 0.0, Some(5e-4)), (1.9991, 0.0, Some(5e-4)), (2.02, 0.01, None), (1.98, -0.01, None)]
        {
            let found = limit(observed);
            assert!((found.deviation().expect("observed") - deviation).abs() < 1e-12, "{observed}");
            assert_eq!(found.within(), within, "{observed}");
        }
    }

    #[test]
    fn probes_agree_where_the_run_below_the_limit_ends_and_the_one_above_is_unstable() {
        let [below, above] = SHARES;
        assert!(below < 1.0 && above > 1.0);
        let [unstable, stopped, late] =
            [FailureKind::Unstable, FailureKind::Stopped, FailureKind::TimedOut].map(Some);
        for (probes, agrees) in [
            (&[(below, None), (above, unstable)][..], true),
            (&[(below, unstable), (above, unstable)], false),
            (&[(below, None), (above, None)], false),
            (&[(below, None), (above, stopped)], false),
            (&[(below, None), (above, late)], false),
            (&[(below, stopped), (above, unstable)], false),
            (&[(below, late), (above, unstable)], false),
            (&[(below, None)], false),
            (&[(above, unstable)], false),
            (&[], false),
        ] {
            let probes: Vec<_> = probes.iter().map(|(share, failure)| probe(*share, *failure)).collect();
            let limit =
                CriticalStep { predicted: 1.0, observed: Some(1.0), probes, ..CriticalStep::default() };
            assert_eq!(limit.probes_agree(), agrees, "{:?}", limit.probes);
        }
    }
}
