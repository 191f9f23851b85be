//! The first iterate of a stage, extrapolated from the rates of earlier stages.
//!
//! The rates of one stage are smooth from step to step, but those of the two stages of a step differ by their errors. So a
//! first stage is extrapolated from first stages, and a second stage from the first of its step and the earlier differences
//! of both. Of the available orders each stage takes the one that would have been nearest in the last step: the lowest,
//! where points have just changed cells or the load has changed. Without it runs of 400 steps take 2 to 36 % more
//! iterations.

/// Number of rates of a stage that are kept: of this step and of three before it.
const AGES: usize = 4;
/// Number of orders: the last rate, and linear and quadratic extrapolation.
const ORDERS: usize = 3;

/// Rates of the stages of the last steps.
#[derive(Clone, Debug)]
pub struct StageGuess {
    /// Duration of the stages with these rates, s.
    duration: f64,
    /// Number of earlier steps with known rates.
    known: usize,
    /// Rates of the scaled unknowns, 1/s, `[stage][age][unknown]`.
    rates: [[Vec<f64>; AGES]; 2],
    /// Order of the guess of each stage.
    order: [usize; 2],
}

impl StageGuess {
    /// A guess for `count` unknowns, without known rates.
    pub fn new(count: usize) -> Self {
        let rates = [(); 2].map(|()| [(); AGES].map(|()| vec![0.0; count]));
        Self { duration: 0.0, known: 0, rates, order: [0; 2] }
    }

    /// Begins a step with stages of a duration, s; rates at other intervals are forgotten.
    pub fn begin_step(&mut self, duration: f64) {
        if self.duration != duration {
            self.duration = duration;
            self.known = 0;
        }
        for (stage, order) in self.order.iter_mut().enumerate() {
            *order = (*order).min(most_order(stage, self.known));
        }
    }

    /// Whether a stage is guessed with order zero.
    pub fn is_plain(&self, stage: usize) -> bool {
        self.order[stage] == 0
    }

    /// Guesses a stage with order zero the next time.
    pub fn make_plain(&mut self, stage: usize) {
        self.order[stage] = 0;
    }

    /// Writes the guess of a stage that starts at `start` into `state`; `before` are the rates at the end of the last step,
    /// 1/s.
    pub fn guess(&self, stage: usize, before: &[f64], start: &[f64], state: &mut [f64]) {
        self.continued(stage, self.order[stage], before, |unknown, rate| {
            state[unknown] = start[unknown] + self.duration * rate;
        });
    }

    /// Stores the rates of a stage from `start` to `state`, and chooses the order that would have been nearest.
    pub fn keep(&mut self, stage: usize, before: &[f64], start: &[f64], state: &[f64]) {
        for (rate, (end, start)) in self.rates[stage][0].iter_mut().zip(state.iter().zip(start)) {
            *rate = (end - start) / self.duration;
        }
        let mut nearest = (f64::INFINITY, 0);
        for order in 0..=most_order(stage, self.known + 1).min(ORDERS - 1) {
            if order > most_order(stage, self.known) {
                // Not available in this step, but usually the best in the next.
                nearest.1 = order;
                continue;
            }
            let mut off: f64 = 0.0;
            let rates = &self.rates[stage][0];
            self.continued(stage, order, before, |unknown, rate| {
                off = off.max((rates[unknown] - rate).abs());
            });
            if off < nearest.0 {
                nearest = (off, order);
            }
        }
        self.order[stage] = nearest.1;
    }

    /// Ends an accepted step.
    pub fn end_step(&mut self) {
        self.rates.iter_mut().for_each(|ages| ages.rotate_right(1));
        self.known = (self.known + 1).min(AGES - 1);
    }

    /// Lists the extrapolated rates of a stage, unknown by unknown.
    #[inline]
    fn continued(&self, stage: usize, order: usize, before: &[f64], mut take: impl FnMut(usize, f64)) {
        let [first, second] = &self.rates;
        let [now, last, older, oldest] = first;
        let lag = |age: usize, i: usize| second[age][i] - first[age][i];
        let unknowns = 0..now.len();
        match (stage, order) {
            (0, 0) => unknowns.for_each(|i| take(i, before[i])),
            (0, 1) => unknowns.for_each(|i| take(i, 2.0 * last[i] - older[i])),
            (0, _) => unknowns.for_each(|i| take(i, 3.0 * (last[i] - older[i]) + oldest[i])),
            (_, 0) => unknowns.for_each(|i| take(i, now[i])),
            (_, 1) => unknowns.for_each(|i| take(i, now[i] + lag(1, i))),
            (_, _) => unknowns.for_each(|i| take(i, now[i] + 2.0 * lag(1, i) - lag(2, i))),
        }
    }
}

/// Highest order available for a stage when the rates of so many earlier steps are known.
fn most_order(stage: usize, known: usize) -> usize {
    match stage {
        0 => known.saturating_sub(1).min(ORDERS - 1),
        _ => known.min(ORDERS - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Guesses both stages of some steps of rates that are functions of the time; what the last ones missed.
    fn missed(rate: impl Fn(f64) -> f64, steps: usize, lag: f64) -> [f64; 2] {
        let (mut guess, mut missed) = (StageGuess::new(1), [0.0; 2]);
        let mut before = [rate(0.0)];
        for step in 0..steps {
            guess.begin_step(0.5);
            let time = step as f64;
            for (stage, exact) in [rate(time + 0.5), rate(time + 1.0) + lag].into_iter().enumerate() {
                let mut state = [0.0];
                guess.guess(stage, &before, &[2.0], &mut state);
                missed[stage] = ((state[0] - 2.0) / 0.5 - exact).abs();
                guess.keep(stage, &before, &[2.0], &[2.0 + 0.5 * exact]);
            }
            before = [rate(time + 1.0)];
            guess.end_step();
        }
        missed
    }

    #[test]
    fn rates_along_a_parabola_are_guessed_despite_a_constant_difference_between_stages() {
        let parabola = |time: f64| 3.0 - 2.0 * time + 0.25 * time * time;
        for missed in missed(parabola, 6, 0.7) {
            assert!(missed < 1e-12, "{missed}");
        }
        assert!(missed(parabola, 1, 0.7).iter().all(|missed| *missed > 0.1), "nothing is known yet");
    }

    #[test]
    fn rates_along_a_line_are_guessed_from_two_steps() {
        let line = |time: f64| 3.0 - 2.0 * time;
        let [first, second] = missed(line, 3, 0.7);
        assert!(first < 1e-12 && second < 1e-12, "{first} {second}");
    }

    #[test]
    fn after_a_jump_the_last_rate_is_guessed_and_another_step_size_resets_the_guess() {
        let mut guess = StageGuess::new(1);
        for rate in [1.0, 2.0, 3.0, 9.0] {
            guess.begin_step(1.0);
            guess.keep(0, &[9.0], &[0.0], &[rate]);
            guess.keep(1, &[9.0], &[0.0], &[rate]);
            guess.end_step();
        }
        assert!(guess.is_plain(0), "the last rate was the nearest");
        guess.order = [2; 2];
        guess.begin_step(1.0);
        assert!(!guess.is_plain(0));
        guess.begin_step(0.5);
        assert!(guess.is_plain(0) && guess.is_plain(1));
    }
}
