//! The deadline of a run, checked inside long computations that no observer interrupts.

use std::time::{Duration, Instant};

/// Longest limit, s: a century.
const MOST_SECONDS: f64 = 3e9;

/// The end of the time that a run has; none where it has all of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TimeLimit {
    end: Option<Instant>,
}

impl TimeLimit {
    /// The end of so many seconds from now.
    pub fn after(seconds: f64) -> Self {
        Self { end: Some(Instant::now() + Duration::from_secs_f64(seconds.clamp(0.0, MOST_SECONDS))) }
    }

    /// Whether the time is over.
    pub fn is_over(self) -> bool {
        self.end.is_some_and(|end| Instant::now() >= end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_limit_is_over_at_its_end_and_an_absent_one_never() {
        assert!(TimeLimit::after(0.0).is_over());
        assert!(!TimeLimit::after(f64::INFINITY).is_over() && !TimeLimit::default().is_over());
    }
}
