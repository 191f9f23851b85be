//! `oedometer plan --calibrate`: what a step of each kind costs on this machine, beside the constants from which
//! times are estimated (`src/case/step_cost.rs`).

use crate::campaign::case_run::run_case;
use crate::case::step_cost::{StepKind, seconds_per_step};
use crate::case::work_estimate::estimated_steps;
use crate::cli::commands::run::checked;
use crate::cli::exit::Exit;
use crate::cli::output::csv_of;
use crate::cli::stream::print_data;
use crate::study::check::checker::Purpose;
use crate::study::file::StudySource;
use oedometer_mpm::run::Kernel;

/// Runs of each case; the least counts.
const ROUNDS: usize = 3;

/// Stands for columns of large strain in the plane, half as wide as high, whose points move.
const PLANE: &str = "moving plane";

/// Cases that cost mostly steps, of every kind and size: heads and sweeps of a study.
const CASES: [(&str, &str); 16] = [
    ("terzaghi", "integrator = [\"explicit\"]\ncells = [5, 40]\ntime_factors = [0.05]"),
    ("terzaghi", "integrator = [\"explicit\"]\nmethod = [\"MPM\"]\ncells = [10]\ntime_factors = [0.05]"),
    ("cosine-layer", "integrator = [\"explicit\"]\ncells = [4, 8]\ntime_factors = [0.01]"),
    ("xie-leo", "integrator = [\"explicit\"]\nmethod = [\"MPM\"]\ncells = [10]\ntime_factors = [0.02]"),
    ("xie-leo", "integrator = [\"explicit\"]\ncells = [10]\ntime_factors = [0.02]"),
    (
        "xie-leo",
        "integrator = [\"explicit\"]\nmethod = [\"CE-SRI-patch-cells\"]\ncells = [10]\ntime_factors = [0.02]",
    ),
    ("terzaghi", "integrator = [\"implicit\"]\ncells = [20, 640]\ntime_factors = [1.0]"),
    ("cosine-layer", "integrator = [\"implicit\"]\ncells = [4, 8, 16]\ntime_factors = [1.0]"),
    ("xie-leo", "integrator = [\"implicit\"]\nmethod = [\"MPM\"]\ncells = [10, 40]\ntime_factors = [1.0]"),
    ("xie-leo", "integrator = [\"implicit\"]\ncells = [10, 40]\ntime_factors = [1.0]"),
    (PLANE, "integrator = [\"explicit\"]\nmethod = [\"MPM\"]\ncells = [4, 8]\ntime_factors = [0.005]"),
    (PLANE, "integrator = [\"explicit\"]\ncells = [4, 8]\ntime_factors = [0.005]"),
    (PLANE, "integrator = [\"implicit\"]\nmethod = [\"MPM\"]\ncells = [4, 8]\ntime_factors = [0.02]"),
    (PLANE, "integrator = [\"implicit\"]\ncells = [8, 16]\ntime_factors = [0.02]"),
    ("cosine-layer", "integrator = [\"semi-implicit\"]\ncells = [4, 8]\ntime_factors = [0.01]"),
    ("dynamic-column", "integrator = [\"implicit\"]\ncells = [20]\ntime_factors = [0.1]"),
];

/// Runs them alone, one after the other, and prints a row a case.
pub fn run() -> anyhow::Result<Exit> {
    let mut rows = Vec::new();
    for (scene, sweep) in CASES {
        let method = if sweep.contains("method") { "" } else { "method = [\"GC-SRI-patch\"]\n" };
        let (scene, load) = match scene {
            "xie-leo" => (scene, "column.load = 2e5\n"),
            PLANE => ("xie-leo", "column = { dimensions = 2, width = 0.5, load = 1e4 }\n"),
            _ => (scene, ""),
        };
        let text =
            format!("title = \"calibration\"\nscene = \"{scene}\"\n{load}[[sweep]]\n{method}{sweep}\n");
        let study = checked(&StudySource { name: "calibration".to_owned(), text }, Purpose::Solving)?;
        for planned in &study.planned {
            let case = &planned.case;
            let (mut least, mut steps) = (f64::INFINITY, 0);
            for _ in 0..ROUNDS {
                // The first reference is the scene's own: what is measured is the solver.
                let record = run_case(case, &study.references[..1], Kernel::Fastest, true, &|_, _| true)?;
                // The processor's time where the system tells it: others may use the machine meanwhile.
                let times = record.wall.iter().map(|sample| sample.cpu_seconds.unwrap_or(sample.seconds));
                least = times.fold(least, f64::min);
                steps = record.counters.steps;
            }
            let per_point = |seconds: f64| 1e9 * seconds / case.expected_points() as f64;
            let (here, there) = (per_point(least / steps as f64), per_point(seconds_per_step(case)));
            rows.push(vec![
                format!("{:?} {}D", StepKind::of(case), case.column.dimensions),
                case.label(),
                case.expected_points().to_string(),
                steps.to_string(),
                format!("{:.0}", estimated_steps(case)),
                format!("{here:.1}"),
                format!("{there:.1}"),
                format!("{:.2}", here / there),
            ]);
        }
    }
    let header = [
        "step",
        "case",
        "points",
        "steps",
        "estimated_steps",
        "nanoseconds_per_point_and_step_here",
        "nanoseconds_of_the_estimates",
        "ratio",
    ];
    print_data(&csv_of(header, rows)?)?;
    Ok(Exit::Pass)
}
