//! The program as a user calls it, for the tests that go through the binary: its exit code, what it
//! writes to both outputs, and never a panic.
#![allow(dead_code, reason = "every test takes the part that it needs")]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;
use tempfile::TempDir;

/// Where the program is.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_oedometer");
/// Longest that any call of a test may take.
const LONGEST: Duration = Duration::from_secs(600);
/// Variables of a CI that must not reach a test from the one that runs it.
pub const OF_A_CI: [&str; 4] = ["CI", "GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "NO_COLOR"];
/// What allows studies to start programs, as the studies of these tests may.
pub const ALLOWED: (&str, &str) = ("OEDOMETER_ALLOW_SOLVERS", "1");

/// What a call of the program came to.
pub struct Told {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Told {
    /// Standard output on one line: where a line is broken is the terminal's business.
    pub fn words(&self) -> String {
        self.out.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}

/// Calls the program in a folder.
pub fn call(folder: &Path, arguments: &[&str]) -> Told {
    call_with(folder, &[], arguments)
}

/// Calls the program in a folder with variables of the environment.
pub fn call_with(folder: &Path, variables: &[(&str, &str)], arguments: &[&str]) -> Told {
    let mut command = Command::new(PROGRAM);
    for name in OF_A_CI {
        command.env_remove(name);
    }
    command.envs([ALLOWED]).envs(variables.iter().copied()).current_dir(folder).args(arguments);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().expect("it starts");
    let (id, (ends, end)) = (child.id(), mpsc::channel());
    std::thread::spawn(move || ends.send(child.wait_with_output()));
    let output = end.recv_timeout(LONGEST).unwrap_or_else(|_| {
        let ended = Command::new("kill").arg(id.to_string()).status();
        panic!("{arguments:?} takes longer than {LONGEST:?}; ended: {ended:?}")
    });
    let output = output.expect("its outputs");
    let told = Told {
        code: output.status.code().expect("an exit code"),
        out: String::from_utf8(output.stdout).expect("words"),
        err: String::from_utf8(output.stderr).expect("words"),
    };
    assert!(!told.err.contains("panicked"), "{arguments:?}: {}", told.err);
    told
}

/// A folder with a study `short.toml`.
pub fn folder_with(study: &str) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("short.toml"), study).expect("a file");
    folder
}

/// The table of a study but for its times, which change from day to day: its last two columns.
pub fn table_without_times(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a table");
    let header = text.lines().next().expect("a header");
    assert!(header.ends_with(",wall_seconds,cpu_seconds"), "{header}");
    let kept = text.lines().map(|line| line.rsplitn(3, ',').nth(2).expect("columns"));
    kept.collect::<Vec<_>>().join("\n") + "\n"
}

/// Holds a text against its snapshot.
pub fn assert_snapshot(name: &str, text: &str) {
    let text = without_wall_time(text);
    settings().bind(|| insta::assert_snapshot!(name, text));
}

/// A text without what it says of slow cases: that is the machine's business. The sentence may stand on
/// several lines.
fn without_wall_time(text: &str) -> String {
    let mut lines: Vec<&str> = Vec::new();
    let mut is_inside = false;
    for line in text.lines() {
        is_inside |= line.contains("the cases took ");
        if !is_inside {
            lines.push(line);
        }
        is_inside &= !line.ends_with("judged");
    }
    lines.join("\n").trim_end().to_owned()
}

/// Holds the words of a table against its snapshot and not the numbers in it: those are for golden
/// values and expectations to judge, and their last digits are another platform's own.
pub fn assert_words(name: &str, text: &str) {
    // Numbers are not those in a name, as in `cells=4` or `L2`; columns are as wide as their numbers.
    let numbers = (r"([ (])[-+]?\d+(\.\d+)?(e-?\d+)?", "${1}#");
    let text = [numbers, (" {2,}", " "), ("-{3,}:?", "---")].into_iter().fold(
        without_wall_time(text),
        |text, (what, by)| {
            let what = regex_lite::Regex::new(what).expect("a pattern");
            what.replace_all(&text, by).into_owned()
        },
    );
    settings().bind(|| insta::assert_snapshot!(name, text));
}

fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}
