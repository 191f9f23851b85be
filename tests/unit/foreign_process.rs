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
    assert!(!found.left_processes && found.peak_memory.is_some_and(|bytes| bytes > 100_000), "{found:?}");
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
    assert!(found.left_processes && clock.elapsed() < Duration::from_secs(120));
    assert_eq!(found.output, "done\n");
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
