//! Ctrl-C and SIGTERM while somebody else's solver runs: it ends with all that it has started, what is finished is
//! kept, and `--resume` goes on.
#![cfg(target_os = "linux")]

use crate::program::{ALLOWED, OF_A_CI, PROGRAM, call};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longest that anything of these tests may take.
const LONGEST: Duration = Duration::from_secs(120);

/// A solver that hangs with a child of its own while a file `slow` lies beside the study, and says who they are; else
/// one that leaves a result at once.
const ADAPTER: &str = r#"
if [ -e "$2/slow" ]; then
    sleep 600 &
    echo "$$ $!" > "$2/started.new"
    mv "$2/started.new" "$2/started"
    wait
fi
echo t,y,p,u_y > "$1/result.csv"
for y in 0 0.25 0.5 0.75 1; do echo "8.175,$y,0.5,0" >> "$1/result.csv"; done
"#;

const STUDY: &str = r#"title = "One that hangs beside one that does not"
scene = "terzaghi"
output.time_factors = [0.1]

[[solver]]
name = "slow"
command = ["sh", "adapter.sh", "{out}", "{study}"]
result = "{out}/result.csv"
mapping = "nodes.toml"

[[sweep]]
method = ["GC-SRI-patch", "slow"]
integrator = ["implicit"]
cells = [4]
"#;

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    for (name, text) in
        [("adapter.sh", ADAPTER), ("s.toml", STUDY), ("nodes.toml", "sample = \"nodes\"\n"), ("slow", "")]
    {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

fn start(at: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(PROGRAM);
    if ignores_a_terminal() {
        // Tests started in the background, or by nohup, ignore these signals, and the program would inherit that.
        command = Command::new("env");
        command.arg("--default-signal=HUP,INT,QUIT").arg(PROGRAM);
    }
    for name in OF_A_CI {
        command.env_remove(name);
    }
    command
        .current_dir(at)
        .envs([ALLOWED])
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().expect("it starts")
}

/// Whether this process ignores HUP, INT or QUIT: the lowest three bits of the mask.
fn ignores_a_terminal() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 7 != 0)
}

/// Waits until something is so.
fn until(what: &str, is_so: impl Fn() -> bool) {
    let clock = Instant::now();
    while !is_so() {
        assert!(clock.elapsed() < LONGEST, "{what} does not come");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The solver and its child, once both run.
fn processes(at: &Path) -> Vec<String> {
    let told = at.join("started");
    until("the solver", || told.exists());
    let text = fs::read_to_string(told).expect("numbers");
    text.split_whitespace().map(str::to_owned).collect()
}

/// Whether a process runs: one that has ended and that nobody has asked for yet does not.
fn runs(process: &str) -> bool {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let state = stat.rsplit(')').next().and_then(|rest| rest.split_whitespace().next());
    state.is_some_and(|state| state != "Z" && state != "X")
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
    assert!(sent.expect("kill").success());
}

/// The end of a program that was told to end: its exit code and what it said.
fn end_of(child: Child) -> (Option<i32>, String) {
    let stat = format!("/proc/{}/stat", child.id());
    until("the end of the program", || {
        fs::read_to_string(&stat)
            .is_ok_and(|stat| stat.rsplit(')').next().is_some_and(|rest| rest.starts_with(" Z")))
    });
    let output = child.wait_with_output().expect("its end");
    let said = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(said).expect("words"))
}

fn records(at: &Path) -> usize {
    oedometer::RecordStore::new(&at.join("out"), "s").hashes().len()
}

#[test]
fn control_c_ends_a_solver_with_its_children_and_a_resume_goes_on() {
    let folder = folder();
    let at = folder.path();
    let child = start(at, &["run", "s.toml", "--jobs", "2"]);
    let solver = processes(at);
    until("the other case", || records(at) == 1);
    assert!(solver.iter().all(|process| runs(process)) && solver.len() == 2, "{solver:?}");
    send("INT", &child);
    let (code, said) = end_of(child);
    assert_eq!(code, Some(6), "{said}");
    assert!(said.contains("1 case was not run") && said.contains("--resume"), "{said}");
    assert!(!solver.iter().any(|process| runs(process)), "{solver:?} run on");
    let left: Vec<_> = fs::read_dir(at.join("out/s/cases")).into_iter().flatten().flatten().collect();
    assert!(records(at) == 1 && left.is_empty(), "nothing of the case that was ended: {left:?}");
    fs::remove_file(at.join("slow")).expect("it was there");
    let told = call(at, &["run", "s.toml", "--resume"]);
    assert!(told.code == 0 && told.err.contains("2 cases (1 reused, 0 failed)"), "{}", told.err);
}

#[test]
fn sigterm_leaves_a_solver_its_time_and_then_ends_it() {
    let folder = folder();
    let at = folder.path();
    let child = start(at, &["run", "s.toml", "--jobs", "2"]);
    let solver = processes(at);
    let clock = Instant::now();
    send("TERM", &child);
    std::thread::sleep(Duration::from_secs(1));
    assert!(solver.iter().all(|process| runs(process)), "it has time to come to its end");
    let (code, said) = end_of(child);
    assert!(clock.elapsed() > Duration::from_secs(10), "its time was {:?}", clock.elapsed());
    assert_eq!(code, Some(6), "{said}");
    assert!(!solver.iter().any(|process| runs(process)), "{solver:?} run on");
}

#[test]
fn a_check_that_is_ended_judges_nothing() {
    let folder = folder();
    let at = folder.path();
    let child = start(at, &["check", "s.toml", "--jobs", "2"]);
    let solver = processes(at);
    send("INT", &child);
    let (code, said) = end_of(child);
    assert_eq!(code, Some(6), "{said}");
    assert!(said.contains("interrupted: nothing was judged"), "{said}");
    assert!(!solver.iter().any(|process| runs(process)), "{solver:?} run on");
}

#[test]
fn a_quit_and_a_closed_terminal_end_a_solver_with_what_left_its_group() {
    for signal in ["QUIT", "HUP"] {
        let folder = folder();
        let at = folder.path();
        fs::write(
            at.join("adapter.sh"),
            ADAPTER.replace("    sleep 600 &", "    setsid sleep 600 >&- 2>&- &"),
        )
        .expect("a file");
        let child = start(at, &["run", "s.toml", "--jobs", "2"]);
        let solver = processes(at);
        until("both", || solver.iter().all(|process| runs(process)));
        send(signal, &child);
        let (code, said) = end_of(child);
        assert_eq!(code, Some(6), "{signal}: {said}");
        assert!(!solver.iter().any(|process| runs(process)), "{signal}: {solver:?} run on");
    }
}

#[test]
fn what_a_solver_leaves_without_group_streams_and_environment_is_ended_and_named() {
    let folder = folder();
    let at = folder.path();
    let adapter = ADAPTER.replace("if [ -e \"$2/slow\" ]; then", "env -i setsid -f sh -c \"echo \\$\\$ > '$2/left'; exec \
         sleep 600\" </dev/null >/dev/null 2>&1\nwhile [ ! -s \"$2/left\" ]; do sleep 0.01; done\nif false; then");
    fs::write(at.join("adapter.sh"), adapter).expect("a file");
    let told = call(at, &["run", "s.toml", "--jobs", "1"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let left = fs::read_to_string(at.join("left")).expect("it was started");
    assert!(!runs(left.trim()), "{left} runs on");
    let explained = call(at, &["explain", "slow cells=4", "s.toml"]).words();
    let sentence = format!("it left processes behind, which were ended: {} (sleep)", left.trim());
    assert!(explained.contains(&sentence), "{explained}");
}
