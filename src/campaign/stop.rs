//! A scheduler's word that a run has to end: the signal that comes before a job is killed.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, OnceLock};
use std::time::{Duration, Instant};

/// Time that the cases at work have to come to their ends after the signal: schedulers kill half a minute after it
/// where nothing else is agreed.
const GRACE: Duration = Duration::from_secs(15);

/// Whether the signal came.
static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
/// When it was first seen.
static SINCE: OnceLock<Instant> = OnceLock::new();

/// Takes SIGTERM as the word to end from now on, and not as the end itself.
///
/// # Errors
/// When the system does not let signals be handled.
pub fn heed_signals() -> std::io::Result<()> {
    signal_hook::flag::register(signal_hook::consts::SIGTERM, Arc::clone(&ASKED)).map(|_| ())
}

/// Whether no further case may begin.
pub fn is_asked() -> bool {
    let is_asked = ASKED.load(Ordering::Relaxed);
    if is_asked {
        SINCE.get_or_init(Instant::now);
    }
    is_asked
}

/// Whether the cases at work have had their time too, and are dropped.
pub fn is_over() -> bool {
    is_asked() && SINCE.get().is_some_and(|since| since.elapsed() > GRACE)
}
