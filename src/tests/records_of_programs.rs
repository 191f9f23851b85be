//! Records of what other programs leave: errors at the outputs, and nothing made up.
#![cfg(unix)]

use crate::campaign::case_runner::CaseRunner;
use crate::case::quantity::{Norm, Quantity, Sample};
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::file::StudySource;

/// Rows of the three nodes at an output of 8.175 s.
const ROWS: &str = "t,y,p,u_y\n8.175,0,0.9,0\n8.175,0.5,0.6,-1e-7\n8.175,1,0,-3e-7\n";

/// The record of a solver that leaves these rows.
fn record_of_rows(rows: &str) -> Record {
    let folder = tempfile::TempDir::new().expect("a folder");
    let table = folder.path().join("rows.csv");
    std::fs::write(&table, rows).expect("written");
    let text = format!(
        "title = 't'\nscene = 'terzaghi'\noutput = {{ time_factors = [0.1], references = ['terzaghi'] }}\n\
         solver = [{{ name = 'toy', command = ['cp', '{}', 'result.csv'], result = '{{out}}/result.csv' }}]\n\
         sweep = [{{ method = ['toy'], cells = [2] }}]\n",
        table.display()
    );
    let name = folder.path().join("t.toml").display().to_string();
    let mut study = Study::check(&StudySource { name, text }).expect("sound");
    study.may_start_solvers = true;
    CaseRunner::of(&study).run_alone(&study.planned[0].case, None).expect("a sound column")
}

#[test]
fn a_result_becomes_a_record_with_errors_at_the_requested_time() {
    let record = record_of_rows(ROWS);
    assert_eq!(record.status, Status::Ok, "{:?}", record.outside_run());
    let error = record.error(Quantity::Pressure, Sample::Points, Norm::L2, "terzaghi", 0.1);
    assert!(error.is_some_and(|row| row.value.is_finite() && row.value > 0.0));
    assert!(record.errors.iter().any(|row| row.quantity == Quantity::Settlement));
    assert_eq!((record.wall.len(), record.snapshots.len(), record.history.len()), (1, 1, 1));
    assert!((record.snapshots[0].settlement - 3e-7).abs() < 1e-20);
}

#[test]
fn a_state_near_an_output_is_held_against_the_solution_at_its_own_time() {
    let error = |time: &str| {
        let record = record_of_rows(&ROWS.replace("8.175", time));
        let error = record.error(Quantity::Pressure, Sample::Points, Norm::L2, "terzaghi", 0.1);
        error.expect("an error").value
    };
    let (on_time, late) = (error("8.175"), error("8.182"));
    assert!((late - on_time).abs() > 1e-6 * on_time, "{on_time} {late}");
}

#[test]
fn without_a_sample_at_the_surface_no_settlement_is_made_up() {
    let record = record_of_rows("t,y,p,u_y\n8.175,0.25,0.9,0\n8.175,0.75,0.6,-1e-7\n");
    assert_eq!(record.status, Status::Ok);
    assert!(record.errors.iter().all(|row| row.quantity != Quantity::Settlement));
    assert!(record.history.is_empty() && record.snapshots[0].settlement.is_nan());
    let text = serde_json::to_string(&record).expect("plain");
    let back: Record = serde_json::from_str(&text).expect("the record can be read again");
    assert!(back.snapshots[0].settlement.is_nan());
}
