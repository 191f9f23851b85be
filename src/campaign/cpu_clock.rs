//! How long the processor has worked on a thread: what other programs take of the machine does not count.

/// Seconds that this thread has been on a processor, where the system tells.
#[cfg(unix)]
pub fn thread_seconds() -> Option<f64> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ThreadCPUTime);
    let seconds = time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64;
    (seconds > 0.0).then_some(seconds)
}

/// Seconds that this thread has been on a processor: not told here.
#[cfg(not(unix))]
pub fn thread_seconds() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

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
}
