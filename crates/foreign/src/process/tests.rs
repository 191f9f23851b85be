use super::*;
use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;

fn shell(script: &str, seconds: f64) -> Finished {
    shell_while(script, seconds, &|| true)
}

fn shell_while(script: &str, seconds: f64, is_wanted: &dyn Fn() -> bool) -> Finished {
    let words = ["sh", "-c", script].map(OsString::from);
    let folder = PathBuf::from("/");
    let environment = [("ATTACHED".to_owned(), "yes".to_owned())];
    let timeout = Duration::from_secs_f64(seconds);
    run(&Order { words: &words, environment: &environment, folder: &folder, timeout }, is_wanted)
}

#[test]
fn a_program_without_input_ends_by_itself_and_is_heard() {
    let found = shell("cat; echo $ATTACHED; pwd; echo trouble >&2; exit 3", 60.0);
    assert!(matches!(&found.ending, Ending::Ended(status) if status.code() == Some(3)), "{found:?}");
    assert_eq!((found.output.as_str(), found.errors.as_str()), ("yes\n/\n", "trouble\n"));
    assert!(
        found.found == Found::default() && found.peak_memory.is_some_and(|bytes| bytes > 100_000),
        "{found:?}"
    );
}

#[test]
fn what_hangs_is_ended_with_all_that_it_started() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mark = folder.path().join("alive");
    // A grandchild that would write a mark if it outlived its parent.
    let script = format!("(sleep 2; touch {}) & sleep 600", mark.display());
    let clock = Instant::now();
    let found = shell(&script, 0.3);
    assert!(matches!(found.ending, Ending::TimedOut), "{found:?}");
    assert!(clock.elapsed() < Duration::from_secs(60));
    std::thread::sleep(Duration::from_millis(2500));
    assert!(!mark.exists(), "a process of its group lived on");
}

#[test]
fn what_is_left_behind_is_ended_too_and_told() {
    let clock = Instant::now();
    let found = shell("sleep 600 & echo done", 300.0);
    assert!(matches!(&found.ending, Ending::Ended(status) if status.success()), "{found:?}");
    assert!(cfg!(not(target_os = "linux")) || !found.found.seen.is_empty());
    assert!(clock.elapsed() < Duration::from_secs(120));
    assert_eq!(found.output, "done\n");
}

/// A process that says who it is and would live on for long, without the streams of its parent.
#[cfg(target_os = "linux")]
fn left_behind(how: &str, with: &str) -> (Finished, i32, tempfile::TempDir) {
    let folder = tempfile::TempDir::new().expect("a folder");
    let told = folder.path().join("told");
    let lived = format!("sh -c 'echo $$ > {0}.new; mv {0}.new {0}; exec sleep 600'", told.display());
    let script = format!("{how} {lived} </dev/null >/dev/null 2>&1 & {with}");
    let script = script.replace("TOLD", &told.display().to_string());
    let found = shell(&script, 20.0);
    let id = std::fs::read_to_string(&told).expect("it was started").trim().parse().expect("a number");
    (found, id, folder)
}

#[cfg(target_os = "linux")]
fn lives(id: i32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    stat.rsplit(')').next().and_then(|rest| rest.split_whitespace().next()).is_some_and(|state| state != "Z")
}

#[test]
#[cfg(target_os = "linux")]
fn what_leaves_its_group_or_closes_its_streams_is_found_named_and_ended() {
    let wait = "while [ ! -e TOLD ]; do sleep 0.01; done";
    for how in ["", "setsid", "setsid setsid -f", "nohup"] {
        let (found, id, _folder) = left_behind(how, wait);
        assert!(matches!(&found.ending, Ending::Ended(status) if status.success()), "{how}: {found:?}");
        assert!(
            found.found.seen.iter().any(|seen| seen.id == id && ["sh", "sleep"].contains(&&*seen.name)),
            "{how}: {found:?}"
        );
        assert!(found.found.lives_on.is_empty() && !lives(id), "{how}: {found:?}");
    }
    let (found, id, _folder) = left_behind("setsid", &format!("{wait}; kill -SEGV $$"));
    assert!(matches!(&found.ending, Ending::Ended(status) if status.signal() == Some(11)), "{found:?}");
    assert!(!lives(id), "it crashed and left {id}");
}

#[test]
#[cfg(target_os = "linux")]
fn what_left_the_group_of_a_hung_program_is_ended_with_it() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let told = folder.path().join("told");
    let script =
        format!("setsid sh -c 'echo $$ > {}; exec sleep 600' >/dev/null 2>&1 & sleep 600", told.display());
    let found = shell(&script, 1.0);
    let id: i32 = std::fs::read_to_string(&told).expect("started").trim().parse().expect("a number");
    assert!(matches!(found.ending, Ending::TimedOut) && !lives(id), "{found:?}");
    assert!(
        found.found.lives_on.is_empty() && found.found.seen.iter().any(|seen| seen.id == id),
        "{found:?}"
    );
}

#[test]
fn signals_wrong_programs_and_a_word_from_outside_are_told_apart() {
    let killed = shell("kill -ABRT $$", 60.0);
    assert!(matches!(&killed.ending, Ending::Ended(status) if status.signal() == Some(6)), "{killed:?}");
    let words = [OsString::from("/no/such/program")];
    let folder = PathBuf::from("/");
    let timeout = Duration::from_secs(60);
    let order = Order { words: &words, environment: &[], folder: &folder, timeout };
    assert!(matches!(run(&order, &|| true).ending, Ending::NotStarted(_)));
    let nothing = run(&Order { words: &[], ..order }, &|| true);
    assert!(
        matches!(&nothing.ending, Ending::NotStarted(error) if error.to_string() == "the command is empty")
    );
    assert_eq!((nothing.seconds, nothing.cpu_seconds, nothing.peak_memory), (0.0, None, None));
    assert!(matches!(shell_while("sleep 600", 600.0, &|| false).ending, Ending::Stopped));
}

#[test]
fn work_counts_as_processor_time_and_sleep_does_not() {
    let slept = shell("sleep 0.5", 60.0);
    let cpu = slept.cpu_seconds.expect("told on Unix");
    assert!(slept.seconds >= 0.5 && cpu < 0.4, "{slept:?}");
    let worked = shell("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done", 600.0);
    assert!(worked.cpu_seconds.expect("told on Unix") > cpu + 0.01, "{worked:?}");
}

/// The shell tells the time of itself and that of its children, each of the program's own work and of the system's for it.
#[test]
fn processor_time_is_that_of_a_program_and_its_children_and_of_the_system_for_them() {
    let count = "i=0; while [ $i -lt 50000 ]; do i=$((i+1)); done";
    let copy = "dd if=/dev/zero of=/dev/null bs=1 count=500000 2>/dev/null";
    let found = shell(&format!("{count}; {copy}; times"), 600.0);
    let seconds = |told: &str| -> Option<f64> {
        let (minutes, seconds) = told.strip_suffix('s')?.split_once('m')?;
        Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
    };
    let times: Vec<f64> = found.output.split_whitespace().filter_map(seconds).collect();
    let cpu = found.cpu_seconds.expect("told on Unix");
    // Rounded to ticks of a hundredth, and the end of the shell comes on top.
    assert!(times.len() == 4 && (cpu - times.iter().sum::<f64>()).abs() <= 0.06, "{times:?}, {found:?}");
}

#[test]
fn the_end_of_a_long_talk_is_kept_and_no_more() {
    let talk = "x".repeat(3 * KEPT_BYTES) + "the end";
    let listener = Listener::to(std::io::Cursor::new(talk));
    assert!(listener.ends_within(Duration::from_secs(60)));
    let text = listener.text();
    assert_eq!(text.len(), KEPT_BYTES);
    assert!(text.ends_with("xxthe end"));
}

#[test]
fn last_lines_are_few_short_and_without_control_characters() {
    let text = "one\n\ntwo\u{1b}[31m\u{7}\n  \nthree is long\n";
    assert_eq!(last_lines(text, 2, 8), ["two[31m", "three is…"]);
    assert_eq!(last_lines("eight ab\r\nnine abcd \n", 3, 8), ["eight ab", "nine abc…"]);
    assert!(last_lines("", 3, 8).is_empty());
}
