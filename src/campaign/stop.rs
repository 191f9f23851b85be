//! Says that a run has to end: by Ctrl-C, or the signal that a scheduler sends before it kills a job.
//!
//! Ctrl-C, Ctrl-\ and a closed terminal end at once what is at work, with all processes that it has started; what is
//! finished is kept. A second Ctrl-C ends this program where it stands. SIGTERM lets what is at work come
//! to its end for a while. A signal ends the runs at work and none that begins after them; where none is at work it does
//! what it did without this program.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock};
use std::time::{Duration, Instant};

/// Time that the cases at work have to come to their ends after SIGTERM: schedulers kill half a minute after it
/// where nothing else is agreed.
const GRACE: Duration = Duration::from_secs(15);

/// Whether SIGTERM came.
static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
/// When it was first seen.
static SINCE: Mutex<Option<Instant>> = Mutex::new(None);
/// Runs at work.
static AT_WORK: Mutex<usize> = Mutex::new(0);
/// Whether there are none.
static IDLE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(true)));
/// Whether Ctrl-C came, or the terminal was closed.
static AT_ONCE: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// A run at work, as long as it is held.
#[must_use = "a run is at work as long as this is held"]
pub struct AtWork(());

/// A run begins: the first of several forgets the signals that ended those before it.
pub fn begin() -> AtWork {
    let mut runs = lock(&AT_WORK);
    if *runs == 0 {
        ASKED.store(false, Ordering::Relaxed);
        AT_ONCE.store(false, Ordering::Relaxed);
        *lock(&SINCE) = None;
        IDLE.store(false, Ordering::Relaxed);
    }
    *runs += 1;
    AtWork(())
}

impl Drop for AtWork {
    fn drop(&mut self) {
        let mut runs = lock(&AT_WORK);
        *runs -= 1;
        IDLE.store(*runs == 0, Ordering::Relaxed);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// From now on signals ask the runs at work to end instead of ending the program. Calling it again changes nothing.
///
/// # Errors
/// When the system does not let signals be handled.
pub fn heed_signals() -> std::io::Result<()> {
    static HEEDED: OnceLock<()> = OnceLock::new();
    if HEEDED.set(()).is_err() {
        return Ok(());
    }
    let term = signal_hook::consts::SIGTERM;
    signal_hook::flag::register_conditional_default(term, Arc::clone(&IDLE))?;
    signal_hook::flag::register(term, Arc::clone(&ASKED))?;
    for signal in end_at_once() {
        signal_hook::flag::register_conditional_default(signal, Arc::clone(&IDLE))?;
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
        lock(&SINCE).get_or_insert_with(Instant::now);
    }
    is_asked || AT_ONCE.load(Ordering::Relaxed)
}

/// Whether the cases at work have had their time too, and are dropped.
pub fn is_over() -> bool {
    is_asked()
        && (AT_ONCE.load(Ordering::Relaxed) || lock(&SINCE).is_some_and(|since| since.elapsed() > GRACE))
}
