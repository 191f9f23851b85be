//! Clocks of a run: when a case has to end, and how long the processor has worked on it, for which other programs do not
//! count.

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

/// Seconds that this thread has worked on a processor, where the system tells.
pub fn thread_seconds() -> Option<f64> {
    #[cfg(unix)]
    return seconds_of(rustix::time::ClockId::ThreadCPUTime);
    #[cfg(not(unix))]
    None
}

/// Seconds that all threads of this program have worked on processors, where the system tells.
pub fn process_seconds() -> Option<f64> {
    #[cfg(unix)]
    return seconds_of(rustix::time::ClockId::ProcessCPUTime);
    #[cfg(not(unix))]
    None
}

#[cfg(unix)]
fn seconds_of(clock: rustix::time::ClockId) -> Option<f64> {
    let time = rustix::time::clock_gettime(clock);
    let seconds = time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64;
    (seconds > 0.0).then_some(seconds)
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

    #[test]
    fn work_counts_and_sleep_does_not() {
        let Some(start) = thread_seconds() else { return };
        std::thread::sleep(Duration::from_millis(60));
        let slept = thread_seconds().expect("told before") - start;
        assert!(slept < 0.05, "{slept} s of sleep");
        let clock = Instant::now();
        let mut sum = 0_u64;
        while thread_seconds().expect("told before") - start < 0.02 && clock.elapsed().as_secs() < 60 {
            sum = (0..10_000).fold(sum, |sum, one| std::hint::black_box(sum ^ one));
        }
        assert!(thread_seconds().expect("told before") - start >= 0.02);
    }

    #[test]
    fn the_work_of_another_thread_counts_for_the_process_alone() {
        let Some((thread, process)) = thread_seconds().zip(process_seconds()) else { return };
        let work = || {
            let (clock, start) = (Instant::now(), thread_seconds().expect("told before"));
            while thread_seconds().expect("told before") - start < 0.06 && clock.elapsed().as_secs() < 60 {
                std::hint::black_box((0..10_000_u64).fold(0, |sum, one| std::hint::black_box(sum ^ one)));
            }
        };
        std::thread::scope(|scope| scope.spawn(work).join().expect("no panic"));
        assert!(thread_seconds().expect("told before") - thread < 0.05);
        assert!(process_seconds().expect("told before") - process >= 0.05);
    }
}
