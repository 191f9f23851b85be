//! How the load comes on: at once, or linearly over a time.

/// Growth of the load, in units of the time factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loading {
    /// Time factor at which the load is full; 0 where it acts at once.
    duration: f64,
}

/// The load at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadAt {
    /// Share of the full load that does not act yet, `1 − λ`.
    pub absent: f64,
    /// `dλ/dT_v`.
    pub rate: f64,
}

/// Steps begin as if this share of the loading had passed since the growth last changed.
const FIRST_AGE: f64 = 1e-6;

impl Loading {
    /// A load that is full at the time factor `duration`.
    pub fn over(duration: f64) -> Self {
        Self { duration }
    }

    /// Whether it takes time.
    pub fn is_gradual(self) -> bool {
        self.duration > 0.0
    }

    /// Share `λ` of the full load at a time factor.
    pub fn share(self, time_factor: f64) -> f64 {
        if time_factor < self.duration { time_factor / self.duration } else { 1.0 }
    }

    /// `dλ/dT_v` from a time factor on.
    pub fn rate(self, time_factor: f64) -> f64 {
        if time_factor < self.duration { self.duration.recip() } else { 0.0 }
    }

    /// The load `later` after a time factor, with the growth that it has there: a step may end where
    /// the growth does.
    pub fn within_step(self, time_factor: f64, later: f64) -> LoadAt {
        LoadAt { absent: 1.0 - self.share(time_factor + later), rate: self.rate(time_factor) }
    }

    /// The time factor strictly between two at which the growth changes.
    pub fn kink_between(self, from: f64, to: f64) -> Option<f64> {
        (from < self.duration && self.duration < to).then_some(self.duration)
    }

    /// Time since the growth last changed, from which the size of a step follows.
    pub fn age(self, time_factor: f64) -> f64 {
        let since = if time_factor < self.duration { 0.0 } else { self.duration };
        (time_factor - since).max(FIRST_AGE * self.duration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_grows_to_its_full_value_and_stays() {
        let loading = Loading::over(0.2);
        assert!(loading.is_gradual() && !Loading::over(0.0).is_gradual());
        assert_eq!([0.0, 0.05, 0.2, 7.0].map(|time| loading.share(time)), [0.0, 0.25, 1.0, 1.0]);
        assert_eq!(Loading::over(0.0).share(0.0), 1.0);
        // The last stage of a step that ends with the growth still has it.
        assert_eq!(loading.within_step(0.1, 0.1), LoadAt { absent: 0.0, rate: 5.0 });
        assert_eq!(loading.within_step(0.2, 0.1), LoadAt { absent: 0.0, rate: 0.0 });
        assert_eq!(loading.kink_between(0.0, 0.3), Some(0.2));
        assert_eq!(loading.kink_between(0.0, 0.2), None);
        assert!((loading.age(0.25) - 0.05).abs() < 1e-15 && loading.age(0.0) > 0.0);
    }
}
