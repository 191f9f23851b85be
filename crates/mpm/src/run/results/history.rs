//! The settlement at the times that are asked for, from within the steps.

use crate::run::results::outcome::HistoryPoint;

/// Time and settlement at one end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Time, s.
    pub time: f64,
    /// Settlement, m.
    pub settlement: f64,
}

/// Times that are due and the settlements noted so far.
#[derive(Clone, Debug)]
pub struct History<'a> {
    due: &'a [f64],
    /// What has been noted.
    pub noted: Vec<HistoryPoint>,
}

impl<'a> History<'a> {
    /// Nothing noted yet of the times due, s, ascending.
    pub fn of(due: &'a [f64]) -> Self {
        Self { due, noted: Vec::with_capacity(due.len()) }
    }

    /// The next time that is due, s.
    pub fn next_due(&self) -> Option<f64> {
        self.due.get(self.noted.len()).copied()
    }

    /// Notes the times within a step, given its two ends and the rate of the settlement at the later
    /// one: a parabola through the three. Without a rate the settlement goes straight.
    pub fn note(&mut self, before: Settled, after: Settled, rate: Option<f64>) {
        let (first, last) = (before.settlement, after.settlement);
        let dt = after.time - before.time;
        let rate = rate.unwrap_or((last - first) / dt);
        while let Some(time) = self.next_due().filter(|due| *due <= after.time * (1.0 + 1e-12)) {
            let share = ((time - before.time) / dt).clamp(0.0, 1.0);
            let settlement =
                first + (last - first) * share * (2.0 - share) + rate * dt * share * (share - 1.0);
            self.noted.push(HistoryPoint { time, settlement });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_noted_exactly_at_every_time_that_is_due() {
        let settlement = |time: f64| 0.3 + 2.0 * time - 0.7 * time * time;
        let rate = |time: f64| 2.0 - 1.4 * time;
        let due = [0.1, 0.15, 0.2, 0.75, 1.0];
        let mut history = History::of(&due);
        let at = |time: f64| Settled { time, settlement: settlement(time) };
        // Steps with three times, with none, and with one inside and one at its end.
        for [start, end] in [[0.0, 0.2], [0.2, 0.5], [0.5, 1.0]] {
            history.note(at(start), at(end), Some(rate(end)));
        }
        assert_eq!(history.noted.len(), due.len());
        for (point, time) in history.noted.iter().zip(due) {
            assert_eq!(point.time, time);
            assert!((point.settlement - settlement(time)).abs() < 1e-15, "{point:?}");
        }
    }

    #[test]
    fn without_a_rate_the_settlement_goes_straight() {
        let due = [0.25];
        let mut history = History::of(&due);
        let [before, after] = [(0.0, 1.0), (1.0, 3.0)].map(|(time, settlement)| Settled { time, settlement });
        history.note(before, after, None);
        assert_eq!(history.noted, [HistoryPoint { time: 0.25, settlement: 1.5 }]);
    }
}
