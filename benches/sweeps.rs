//! Sweeps: what a case costs beyond its solve, and what the second core is worth.
//!
//! `cargo bench --bench sweeps` makes ten thousand tiny cases, runs them with their records kept on
//! disk, and prints what each took beyond its solve; then it runs a sweep of longer cases by one and by
//! two threads in turns. What other work does meanwhile is in the figures: the least of the rounds is
//! what counts.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use oedometer::{RecordStore, RunOptions, Selected, Study, StudySource, Tier, run_studies};
use std::fmt::Write;
use std::time::Instant;
use tempfile::TempDir;

/// Rounds of each measurement; their least counts.
const ROUNDS: usize = 3;
/// Values along each of the two axes of the tiny cases.
const AXIS: usize = 100;

fn main() {
    // A bench that is only to be listed or tried has nothing to try quickly.
    if std::env::args().any(|argument| argument == "--test" || argument == "--list") {
        return;
    }
    overhead();
    scaling();
}

fn study(name: &str, text: String) -> Study {
    Study::check(&StudySource { name: format!("{name}.toml"), text }).expect("a sound study")
}

/// Implicit runs on four cells, different in step and in porosity.
fn tiny_cases() -> Study {
    let list = |first: f64, entry: &dyn Fn(f64) -> String| {
        let entries = (0..AXIS).map(|i| entry(first + 0.002 * i as f64));
        entries.collect::<Vec<_>>().join(", ")
    };
    let steps = list(0.2, &|growth| format!("{{ growth = {growth:.3} }}"));
    let porosities = list(0.2, &|porosity| format!("{porosity:.3}"));
    study(
        "tiny",
        format!(
            "title = \"Tiny\"\nscene = \"terzaghi\"\n[output]\ntime_factors = [0.1]\n[[sweep]]\n\
             method = [\"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [4]\npoints_per_cell = [1]\n\
             time_step = [{steps}]\nporosity = [{porosities}]\n"
        ),
    )
}

fn overhead() {
    let study = tiny_cases();
    let cases = study.planned.len();
    println!("{cases} tiny cases with their records on disk, one thread");
    println!("{:>8}{:>12}{:>12}{:>22}", "round", "whole, s", "solves, s", "beyond it, ms a case");
    for round in 1..=ROUNDS {
        let folder = TempDir::new().expect("a folder");
        let store = RecordStore::new(folder.path(), &study.name);
        let (seconds, solves) = run(&study, Some(&store), 1);
        println!("{round:>8}{seconds:>12.2}{solves:>12.2}{:>22.3}", 1e3 * (seconds - solves) / cases as f64);
    }
}

/// Explicit runs of some ten milliseconds.
fn longer_cases() -> Study {
    let mut shares = String::new();
    for i in 0..60 {
        let _ = write!(shares, "{{ stable = {:.3} }}, ", 0.5 + 0.005 * f64::from(i));
    }
    study(
        "longer",
        format!(
            "title = \"Longer\"\nscene = \"terzaghi\"\n[output]\ntime_factors = [0.05]\n[[sweep]]\n\
             method = [\"GC-SRI-patch\"]\ncells = [10]\ntime_step = [{shares}]\ndrag = [\"implicit\"]\n"
        ),
    )
}

fn scaling() {
    let study = longer_cases();
    println!("\n{} longer cases by one and by two threads in turns", study.planned.len());
    println!("{:>8}{:>12}{:>12}{:>10}", "round", "one, s", "two, s", "ratio");
    let mut least = [f64::INFINITY; 2];
    for round in 1..=2 * ROUNDS {
        let [one, two] = [1, 2].map(|threads| run(&study, None, threads).0);
        least = [least[0].min(one), least[1].min(two)];
        println!("{round:>8}{one:>12.3}{two:>12.3}{:>10.2}", one / two);
    }
    println!("{:>8}{:>12.3}{:>12.3}{:>10.2}", "least", least[0], least[1], least[0] / least[1]);
}

/// Seconds that a study takes, and those of its solves alone.
fn run(study: &Study, store: Option<&RecordStore>, threads: usize) -> (f64, f64) {
    let start = Instant::now();
    let options = RunOptions::whole(Tier::Full, threads);
    let reports = run_studies(&[Selected { study, store, is_kept: true }], &options, &|_| {});
    let seconds = start.elapsed().as_secs_f64();
    let records = reports.iter().flat_map(|report| &report.records);
    let solves = records.flat_map(|record| &record.wall).map(|sample| sample.seconds).sum();
    (seconds, solves)
}
