//! Runs a program in its own folder and process group, without input, with limits on time and output.
//!
//! Ours, and not the crate `process-wrap` (10.0.1). On Unix that begins a group and kills it, which are two calls here too, of
//! the standard library and of `rustix`. It neither sees nor ends a process that has left the group, which
//! `started_processes.rs` does; it has no limit on time or output; and its child is waited for by `waitpid` over the group,
//! which takes the status away from `wait4`, and with it processor time and memory. On Windows its job objects would hold more
//! than `taskkill` does; no test of ours runs there.

use crate::started_processes::{Family, Found, MARK, Mark};
use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Time between two questions whether the run is still wanted.
const LOOK: Duration = Duration::from_millis(50);
/// Time that streams are given to end after their program; what holds them open longer was left behind.
const STREAMS: Duration = Duration::from_millis(500);
/// Time that a killed program is given to be gone.
const GONE: Duration = Duration::from_secs(10);

/// What is started, and for how long.
#[derive(Clone, Debug)]
pub struct Order<'a> {
    /// The program and its arguments.
    pub words: &'a [OsString],
    /// Variables beside those of this program.
    pub environment: &'a [(String, String)],
    /// Folder in which it is started.
    pub folder: &'a Path,
    /// Longest wall time.
    pub timeout: Duration,
}

/// How a program ended.
#[derive(Debug)]
pub enum Ending {
    /// It could not be started.
    NotStarted(std::io::Error),
    /// Its time was over, and it was ended.
    TimedOut,
    /// It was not wanted any more, and was ended.
    Stopped,
    /// It ended by itself.
    Ended(ExitStatus),
}

/// What a run of a program came to.
#[derive(Debug)]
pub struct Finished {
    /// How it ended.
    pub ending: Ending,
    /// Wall time from its start to its end, s.
    pub seconds: f64,
    /// Processor time of it and of the children that it waited for, s, if the system reports it.
    pub cpu_seconds: Option<f64>,
    /// Largest memory of it or of one of those children, bytes, if the system reports it.
    pub peak_memory: Option<u64>,
    /// The end of its standard output.
    pub output: String,
    /// The end of its standard error.
    pub errors: String,
    /// What of it lived when its end had come or was made: processes that it left behind, where it ended by itself.
    pub found: Found,
}

/// The end of a process with what it took.
struct Reaped {
    at: Instant,
    status: std::io::Result<ExitStatus>,
    cpu_seconds: Option<f64>,
    peak_memory: Option<u64>,
}

/// Runs a program to its end, to the end of its time, or until `is_wanted` says no.
pub fn run(order: &Order<'_>, is_wanted: &dyn Fn() -> bool) -> Finished {
    let start = Instant::now();
    let mark = Mark::new();
    let mut child = match started(order, &mark) {
        Ok(child) => child,
        Err(error) => return Finished::not_started(error),
    };
    let listeners = [child.stdout.take().map(Listener::to), child.stderr.take().map(Listener::to)];
    let family = Family::of(&child, mark);
    let end = reaped(child);
    let deadline = start + order.timeout;
    let mut found = Found::default();
    let (ending, reaped) = loop {
        let left = deadline.saturating_duration_since(Instant::now());
        match end.recv_timeout(left.min(LOOK)) {
            Ok(reaped) => break (None, Some(reaped)),
            Err(RecvTimeoutError::Disconnected) => break (None, None),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let over = if Instant::now() >= deadline {
            Some(Ending::TimedOut)
        } else {
            (!is_wanted()).then_some(Ending::Stopped)
        };
        if let Some(over) = over {
            found = family.end();
            break (Some(over), end.recv_timeout(GONE).ok());
        }
    };
    let end_of_streams = || listeners.iter().flatten().all(|listener| listener.ends_within(STREAMS));
    if ending.is_none() {
        // What it started may be about to end with it.
        end_of_streams();
        found = family.end();
    }
    end_of_streams();
    let [output, errors] =
        listeners.map(|listener| listener.map_or_else(String::new, |listener| listener.text()));
    Finished {
        seconds: reaped.as_ref().map_or_else(|| start.elapsed(), |reaped| reaped.at - start).as_secs_f64(),
        cpu_seconds: reaped.as_ref().and_then(|reaped| reaped.cpu_seconds),
        peak_memory: reaped.as_ref().and_then(|reaped| reaped.peak_memory),
        ending: ending.unwrap_or_else(|| ended(reaped)),
        output,
        errors,
        found,
    }
}

impl Finished {
    fn not_started(error: std::io::Error) -> Self {
        Self {
            ending: Ending::NotStarted(error),
            seconds: 0.0,
            cpu_seconds: None,
            peak_memory: None,
            output: String::new(),
            errors: String::new(),
            found: Found::default(),
        }
    }
}

fn ended(reaped: Option<Reaped>) -> Ending {
    match reaped.map(|reaped| reaped.status) {
        Some(Ok(status)) => Ending::Ended(status),
        Some(Err(error)) => Ending::NotStarted(error),
        None => Ending::NotStarted(std::io::Error::other("waiting for its end failed")),
    }
}

fn started(order: &Order<'_>, mark: &Mark) -> std::io::Result<Child> {
    let Some((program, arguments)) = order.words.split_first() else {
        return Err(std::io::Error::other("the command is empty"));
    };
    let mut command = Command::new(program);
    command
        .args(arguments)
        .envs(order.environment.iter().map(|(name, value)| (name, value)))
        .env(MARK, mark.text())
        .current_dir(order.folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn()
}

/// Waits for a process in a separate thread, which reports its end.
fn reaped(mut child: Child) -> Receiver<Reaped> {
    let (tell, end) = channel();
    std::thread::spawn(move || {
        // Nobody listens any more where the process would not go.
        let _ = tell.send(reap(&mut child));
    });
    end
}

/// Waits for a process: its end, and what it took with the children that it waited for.
#[cfg(unix)]
fn reap(child: &mut Child) -> Reaped {
    use wait4::Wait4;
    let ended = child.wait4();
    let at = Instant::now();
    match ended {
        Ok(end) => Reaped {
            at,
            status: Ok(end.status),
            cpu_seconds: Some((end.rusage.utime + end.rusage.stime).as_secs_f64()),
            peak_memory: Some(end.rusage.maxrss).filter(|bytes| *bytes > 0),
        },
        Err(error) => Reaped { at, status: Err(error), cpu_seconds: None, peak_memory: None },
    }
}

#[cfg(not(unix))]
fn reap(child: &mut Child) -> Reaped {
    let status = child.wait();
    Reaped { at: Instant::now(), status, cpu_seconds: None, peak_memory: None }
}

/// Bytes that are kept of what a program says on one stream.
const KEPT_BYTES: usize = 65_536;
/// Bytes that are read at once.
const BLOCK: usize = 8192;

/// A stream that is being read.
struct Listener {
    kept: Arc<Mutex<VecDeque<u8>>>,
    ended: Receiver<()>,
}

impl Listener {
    /// Reads a stream to its end in a separate thread.
    fn to(mut stream: impl Read + Send + 'static) -> Self {
        let kept = Arc::new(Mutex::new(VecDeque::new()));
        let (tell, ended) = channel();
        let shared = Arc::clone(&kept);
        std::thread::spawn(move || {
            let mut block = [0; BLOCK];
            loop {
                match stream.read(&mut block) {
                    Ok(0) => break,
                    Ok(count) => keep(&shared, &block[..count]),
                    Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                    Err(_) => break,
                }
            }
            // Nobody listens any more where the program was given up.
            let _ = tell.send(());
        });
        Self { kept, ended }
    }

    /// Whether the stream comes to its end within a time: it does not while any process holds it open.
    fn ends_within(&self, time: Duration) -> bool {
        !matches!(self.ended.recv_timeout(time), Err(RecvTimeoutError::Timeout))
    }

    /// The end of what was said so far.
    fn text(&self) -> String {
        let bytes: Vec<u8> =
            self.kept.lock().map_or_else(|_| Vec::new(), |kept| kept.iter().copied().collect());
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

fn keep(shared: &Mutex<VecDeque<u8>>, block: &[u8]) {
    if let Ok(mut kept) = shared.lock() {
        kept.extend(block);
        let beyond = kept.len().saturating_sub(KEPT_BYTES);
        kept.drain(..beyond);
    }
}

/// The last lines of a text, as a person reads them: without control characters, each of a bounded length.
pub fn last_lines(text: &str, most: usize, longest: usize) -> Vec<String> {
    let plain = |line: &str| {
        let letters = line.chars().filter(|letter| !letter.is_control());
        let line: String = letters.clone().take(longest).collect();
        if letters.count() > longest { line + "…" } else { line }
    };
    let lines: Vec<String> =
        text.lines().map(|line| plain(line.trim_end())).filter(|line| !line.is_empty()).collect();
    lines[lines.len().saturating_sub(most)..].to_vec()
}

#[cfg(all(test, unix))]
mod tests;
