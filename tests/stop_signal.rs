//! A signal ends the runs at work, and none that begins after them in the same process.
#![cfg(unix)]

use oedometer::{RunOptions, Study, StudySource, Tier, run_study};

/// A study of an attached solver that asks this process to end, and one of this program's methods.
const STUDIES: [&str; 2] = [
    r#"title = "Ends its starter"
scene = "terzaghi"
output.time_factors = [0.1]
[[solver]]
name = "rude"
command = ["sh", "-c", "kill -TERM $PPID"]
result = "{out}/none.csv"
[[sweep]]
method = ["rude"]
cells = [4, 8]
"#,
    r#"title = "Begins later"
scene = "terzaghi"
output.time_factors = [0.1]
[[sweep]]
method = ["GIMP"]
integrator = ["implicit"]
cells = [4, 8]
"#,
];

#[test]
fn a_signal_stops_no_run_that_begins_after_it() {
    let records = STUDIES.map(|text| {
        let source = StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
        let study = Study { may_start_solvers: true, ..Study::check(&source).expect("a sound study") };
        run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {}).records.len()
    });
    // The first case ends without a result, the second is not begun.
    assert_eq!(records, [1, 2]);
}
