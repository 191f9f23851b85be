//! Says that a run has to end: by Ctrl-C, or the signal that a scheduler sends before it kills a job.
//!
//! Ctrl-C, Ctrl-\ and a closed terminal end at once what is at work, with all processes that it has started; what is
//! finished is kept. A second Ctrl-C ends this program where it stands. SIGTERM lets what is at work come
//! to its end for a while.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, OnceLock};
use std::time::{Duration, Instant};

/// Time that the cases at work have to come to their ends after SIGTERM: schedulers kill half a minute after it
/// where nothing else is agreed.
const GRACE: Duration = Duration::from_secs(15);

/// Whether SIGTERM came.
static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
/// When it was first seen.
static SINCE: OnceLock<Instant> = OnceLock::new();
/// Whether Ctrl-C came, or the terminal was closed.
static AT_ONCE: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// From now on signals ask the run to end instead of ending the program. Calling it again changes nothing.
///
/// # Errors
/// When the system does not let signals be handled.
pub fn heed_signals() -> std::io::Result<()> {
    static HEEDED: OnceLock<()> = OnceLock::new();
    if HEEDED.set(()).is_err() {
        return Ok(());
    }
    signal_hook::flag::register(signal_hook::consts::SIGTERM, Arc::clone(&ASKED))?;
    for signal in end_at_once() {
        // Run before the flag is set: the first signal passes it, the second does what it did without.
        signal_hook::flag::register_conditional_default(signal, Arc::clone(&AT_ONCE))?;
        signal_hook::flag::register(signal, Arc::clone(&AT_ONCE))?;
    }
    Ok(())
}

/// Signals of a person: those that were ignored when this program began stay so (`nohup`).
#[cfg(unix)]
fn end_at_once() -> impl Iterator<Item = i32> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT};
    let ignored = ignored_signals();
    [SIGINT, SIGHUP, SIGQUIT].into_iter().filter(move |signal| ignored & (1 << (signal - 1)) == 0)
}

#[cfg(not(unix))]
fn end_at_once() -> impl Iterator<Item = i32> {
    std::iter::once(signal_hook::consts::SIGINT)
}

/// Signals that this process ignores, a bit each from the first on, if the system reports it.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Whether no further case may begin.
pub fn is_asked() -> bool {
    let is_asked = ASKED.load(Ordering::Relaxed);
    if is_asked {
        SINCE.get_or_init(Instant::now);
    }
    is_asked || AT_ONCE.load(Ordering::Relaxed)
}

/// Whether the cases at work have had their time too, and are dropped.
pub fn is_over() -> bool {
    is_asked()
        && (AT_ONCE.load(Ordering::Relaxed) || SINCE.get().is_some_and(|since| since.elapsed() > GRACE))
}
