//! When a case has to end.

use std::cell::Cell;
use std::time::{Duration, Instant};

/// No limit on a case's time is longer than this, s: a century.
const MOST_SECONDS: f64 = 3e9;
/// Time between two looks at the clock that is short enough: a look may cost as much as many steps.
const LOOK: Duration = Duration::from_millis(1);
/// Most questions that are answered without a look.
const MOST_UNSEEN: u32 = 63;

/// The end of a time that started when it was made.
pub struct Deadline {
    end: Instant,
    looked: Cell<Instant>,
    /// Questions between two looks, and those left until the next.
    unseen: Cell<u32>,
    left: Cell<u32>,
}

impl Deadline {
    /// A deadline so many seconds from now.
    pub fn after(seconds: f64) -> Self {
        let now = Instant::now();
        let end = now + Duration::from_secs_f64(seconds.min(MOST_SECONDS));
        Self { end, looked: Cell::new(now), unseen: Cell::new(0), left: Cell::new(0) }
    }

    /// Whether the time is over. Asked often, it looks at the clock about once in a millisecond.
    pub fn is_over(&self) -> bool {
        if self.left.get() > 0 {
            self.left.set(self.left.get() - 1);
            return false;
        }
        let now = Instant::now();
        let is_often = now - self.looked.get() < LOOK;
        self.looked.set(now);
        self.unseen.set(if is_often {
            (2 * self.unseen.get() + 1).min(MOST_UNSEEN)
        } else {
            self.unseen.get() / 4
        });
        self.left.set(self.unseen.get());
        now >= self.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deadline_that_is_asked_often_or_rarely_is_over_in_time() {
        let now = Deadline::after(0.0);
        assert!((0..2).any(|_| now.is_over()));
        let start = Instant::now();
        let soon = Deadline::after(0.02);
        while !soon.is_over() {}
        assert!(start.elapsed() >= Duration::from_millis(20));
        let rare = Deadline::after(0.01);
        std::thread::sleep(Duration::from_millis(11));
        assert!(rare.is_over());
        assert!(!Deadline::after(f64::INFINITY).is_over());
    }
}
