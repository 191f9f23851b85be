//! Finds and ends the processes that a program has started, including those that left its process group or closed their
//! streams.

use std::process::Child;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Variable by which a process is known as one of a run, wherever it went; a run within a run has both their marks.
pub const MARK: &str = "OEDOMETER_RUN";
/// Time between two looks at what still lives.
const LOOK: Duration = Duration::from_millis(10);
/// Time that killed processes are given to be gone.
const GONE: Duration = Duration::from_secs(5);
/// Most processes that a sentence names.
const MOST_NAMED: usize = 5;

/// Runs of this program that are under way.
static UNDER_WAY: AtomicUsize = AtomicUsize::new(0);
/// Runs that were begun.
static BEGUN: AtomicUsize = AtomicUsize::new(0);

/// A process that was seen alive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seen {
    /// Its number.
    pub id: i32,
    /// What the system calls it.
    pub name: String,
}

/// What was found when the processes of a run were ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Those that were alive.
    pub seen: Vec<Seen>,
    /// Those of them that could not be ended.
    pub lives_on: Vec<Seen>,
}

/// The mark of a run that is about to begin, and what counts as under way as long as it is held.
pub struct Mark {
    text: String,
}

impl Mark {
    /// A mark that no other run has.
    pub fn new() -> Self {
        adopt_orphans();
        UNDER_WAY.fetch_add(1, Ordering::SeqCst);
        let number = BEGUN.fetch_add(1, Ordering::SeqCst);
        let around = std::env::var(MARK).map_or_else(|_| String::new(), |outer| outer + ",");
        let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
        let time = since.map_or(0, |since| since.as_nanos());
        Self { text: format!("{around}{}-{number}-{time}", std::process::id()) }
    }

    /// The value of the variable.
    pub fn text(&self) -> &str {
        &self.text
    }
}

impl Drop for Mark {
    fn drop(&mut self) {
        UNDER_WAY.fetch_sub(1, Ordering::SeqCst);
    }
}

/// A program that was started in a separate process group, with everything that it starts.
pub struct Family {
    mark: Mark,
    #[cfg(unix)]
    leader: rustix::process::Pid,
    #[cfg(not(unix))]
    leader: u32,
    /// When it began, in the system's ticks: nothing older is of this run.
    #[cfg(target_os = "linux")]
    since: Option<u64>,
}

impl Family {
    /// That of a child which has the mark in its environment.
    pub fn of(child: &Child, mark: Mark) -> Self {
        #[cfg(unix)]
        let leader = rustix::process::Pid::from_child(child);
        #[cfg(not(unix))]
        let leader = child.id();
        Self {
            mark,
            leader,
            // Nobody has asked for its end yet, so that it is there, be it over.
            #[cfg(target_os = "linux")]
            since: i32::try_from(child.id()).ok().and_then(Process::of).map(|process| process.start),
        }
    }

    /// Ends all that lives, and says what that was.
    pub fn end(&self) -> Found {
        let start = Instant::now();
        let mut seen: Vec<Seen> = Vec::new();
        loop {
            let alive = self.alive();
            self.kill(&alive);
            for one in &alive {
                if !seen.contains(one) {
                    seen.push(one.clone());
                }
            }
            if alive.is_empty() || start.elapsed() > GONE {
                self.forget(&seen);
                return Found { seen, lives_on: alive };
            }
            std::thread::sleep(LOOK);
        }
    }
}

#[cfg(unix)]
impl Family {
    /// Kills its group, and what has left it.
    fn kill(&self, alive: &[Seen]) {
        use rustix::process::{Pid, Signal, kill_process, kill_process_group};
        // Those that are gone already need nothing.
        let _ = kill_process_group(self.leader, Signal::KILL);
        for one in alive.iter().filter_map(|one| Pid::from_raw(one.id)) {
            let _ = kill_process(one, Signal::KILL);
        }
    }

    /// Waits for those that became children of this program when their parents ended.
    fn forget(&self, seen: &[Seen]) {
        use rustix::process::{Pid, WaitOptions, waitpid};
        let others = seen.iter().filter_map(|one| Pid::from_raw(one.id)).filter(|id| *id != self.leader);
        for id in others {
            let _ = waitpid(Some(id), WaitOptions::NOHANG);
        }
    }
}

#[cfg(not(unix))]
impl Family {
    fn kill(&self, _: &[Seen]) {
        let arguments = ["/T", "/F", "/PID", &self.leader.to_string()].map(str::to_owned);
        let _ = std::process::Command::new("taskkill").args(arguments).output();
    }

    fn forget(&self, _: &[Seen]) {}
}

/// Has the system give orphans of what is started to this program, where they are seen, and not to its first process.
fn adopt_orphans() {
    #[cfg(target_os = "linux")]
    {
        static ADOPTED: std::sync::Once = std::sync::Once::new();
        // Where the system refuses, orphans are known by the mark in their environment alone.
        ADOPTED.call_once(|| {
            let _ = rustix::process::set_child_subreaper(Some(rustix::process::getpid()));
        });
    }
}

#[cfg(not(target_os = "linux"))]
impl Family {
    /// Other systems do not tell what lives without more than the standard library.
    fn alive(&self) -> Vec<Seen> {
        let _ = self.mark.text();
        Vec::new()
    }
}

/// What Linux reports about a process in `/proc/ID/stat`.
#[cfg(target_os = "linux")]
struct Process {
    seen: Seen,
    parent: i32,
    group: i32,
    session: i32,
    /// When it began, in ticks since the system did.
    start: u64,
    /// Whether it has ended.
    is_over: bool,
}

#[cfg(target_os = "linux")]
impl Process {
    /// All that live.
    fn all() -> Vec<Self> {
        let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
        let all = entries.filter_map(|entry| Self::of(entry.file_name().to_str()?.parse().ok()?));
        all.filter(|process| !process.is_over).collect()
    }

    /// One that lives, or has ended and was not asked for yet.
    fn of(id: i32) -> Option<Self> {
        let bytes = std::fs::read(format!("/proc/{id}/stat")).ok()?;
        let text = String::from_utf8_lossy(&bytes);
        // The name may hold anything, parentheses too.
        let (head, rest) = text.rsplit_once(')')?;
        let name = head.split_once('(')?.1.to_owned();
        let mut fields = rest.split_whitespace();
        let is_over = matches!(fields.next()?, "Z" | "X" | "x");
        let mut number = || fields.next()?.parse().ok();
        let (parent, group, session) = (number()?, number()?, number()?);
        // The 22nd of all fields.
        let start = fields.nth(15)?.parse().ok()?;
        Some(Self { seen: Seen { id, name }, parent, group, session, start, is_over })
    }

    /// The mark of the run that it belongs to, where its environment has one and can be read.
    fn mark(&self) -> Option<String> {
        let bytes = std::fs::read(format!("/proc/{}/environ", self.seen.id)).ok()?;
        let prefix = format!("{MARK}=");
        let mut variables = bytes.split(|byte| *byte == 0);
        let value = variables.find_map(|variable| variable.strip_prefix(prefix.as_bytes()))?;
        Some(String::from_utf8_lossy(value).into_owned())
    }
}

#[cfg(target_os = "linux")]
impl Family {
    /// The processes of the run that live: those of its group, those with its mark, orphans that nothing else could have
    /// left here, and all that descend from any of these.
    fn alive(&self) -> Vec<Seen> {
        let leader = self.leader.as_raw_nonzero().get();
        let own = Process::of(i32::try_from(std::process::id()).unwrap_or(0));
        let is_only_run = UNDER_WAY.load(Ordering::SeqCst) == 1;
        let belongs = |process: &Process| {
            let mark = process.mark();
            let is_marked = mark.as_ref().is_some_and(|mark| mark.split(',').any(|one| self.is_own(one)));
            // What this program starts stays in its session.
            let is_orphan = own.as_ref().is_some_and(|own| {
                let is_later = self.since.is_some_and(|since| process.start >= since);
                process.parent == own.seen.id && process.session != own.session && is_later && mark.is_none()
            });
            process.group == leader || is_marked || (is_orphan && is_only_run)
        };
        let (mut alive, mut others): (Vec<Process>, Vec<Process>) = Process::all()
            .into_iter()
            .filter(|process| own.as_ref().is_none_or(|own| process.seen.id != own.seen.id))
            .partition(belongs);
        loop {
            let descends = |process: &Process| alive.iter().any(|one| one.seen.id == process.parent);
            let (more, rest): (Vec<Process>, Vec<Process>) = others.into_iter().partition(descends);
            if more.is_empty() {
                return alive.into_iter().map(|process| process.seen).collect();
            }
            alive.extend(more);
            others = rest;
        }
    }

    /// Whether a mark among those of runs within runs is this one's.
    fn is_own(&self, mark: &str) -> bool {
        self.mark.text().rsplit(',').next() == Some(mark)
    }
}

/// Processes by number and name, the first few.
pub fn named(all: &[Seen]) -> String {
    let plain = |name: &str| name.chars().filter(|letter| !letter.is_control()).collect::<String>();
    let mut words: Vec<String> =
        all.iter().take(MOST_NAMED).map(|one| format!("{} ({})", one.id, plain(&one.name))).collect();
    if all.len() > MOST_NAMED {
        words.push(format!("{} more", all.len() - MOST_NAMED));
    }
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_processes_are_named_without_control_characters_and_the_others_are_counted() {
        let seen = |count: i32| {
            (1..=count).map(|id| Seen { id, name: format!("a\u{7}b ({id})\n") }).collect::<Vec<_>>()
        };
        for (count, told) in [
            (0, ""),
            (1, "1 (ab (1))"),
            (5, "1 (ab (1)), 2 (ab (2)), 3 (ab (3)), 4 (ab (4)), 5 (ab (5))"),
            (6, "1 (ab (1)), 2 (ab (2)), 3 (ab (3)), 4 (ab (4)), 5 (ab (5)), 1 more"),
            (7, "1 (ab (1)), 2 (ab (2)), 3 (ab (3)), 4 (ab (4)), 5 (ab (5)), 2 more"),
        ] {
            assert_eq!(named(&seen(count)), told);
        }
    }
}
