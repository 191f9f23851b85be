//! How long the processor has worked: what other programs take of the machine does not count.

/// Seconds that this thread has been on a processor, where the system tells.
pub fn thread_seconds() -> Option<f64> {
    seconds_of(Whose::Thread)
}

/// Seconds that all threads of this program have been on processors, where the system tells.
pub fn process_seconds() -> Option<f64> {
    seconds_of(Whose::Process)
}

/// Whose work is counted.
#[derive(Clone, Copy, Debug)]
enum Whose {
    Thread,
    Process,
}

#[cfg(unix)]
fn seconds_of(whose: Whose) -> Option<f64> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(match whose {
        Whose::Thread => ClockId::ThreadCPUTime,
        Whose::Process => ClockId::ProcessCPUTime,
    });
    let seconds = time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64;
    (seconds > 0.0).then_some(seconds)
}

/// Not told here.
#[cfg(not(unix))]
fn seconds_of(_: Whose) -> Option<f64> {
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
