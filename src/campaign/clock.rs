//! Processor time of a run, which the load of the machine hardly changes.

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
