//! `oedometer stability`: the critical step of a case, predicted and observed.

use crate::campaign::runner::{RunOptions, run_study};
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{SolveFormat, csv_of, json_of, print_data, table_width};
use crate::cli::running::jobs_of;
use crate::cli::study_files::tell_warnings;
use crate::questions::stability;
use crate::record::{Probe, Record};
use crate::study::check::Purpose;
use crate::study::overrides::{Assignments, StudyLines, TIMING, toml_of};
use oedometer_problem::critical_step::CriticalStep;

/// Largest relative difference of observed and predicted step at which they agree.
const AGREEMENT: f64 = 0.02;

/// Arguments of `stability`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Benchmark problem, like `terzaghi`
    scene: String,
    /// Methods, comma-separated
    #[arg(long, default_value = "GC-SRI-patch", value_name = "LIST")]
    method: String,
    /// Cells over the height, comma-separated
    #[arg(long, default_value = "8", value_name = "LIST")]
    cells: String,
    /// Material points per cell and direction, comma-separated
    #[arg(long, default_value = "2", value_name = "LIST")]
    points_per_cell: String,
    /// Time factor at which the observed runs end, after at most a million steps
    #[arg(long, default_value_t = 0.05)]
    time_factor: f64,
    #[command(flatten)]
    set: Assignments,
    /// Output format
    #[arg(long, value_enum, default_value_t = SolveFormat::Table)]
    format: SolveFormat,
}

/// Predicts, observes and prints. The verdict: both agree within 2 %, 0.97 of the predicted step is stable, and 1.03 of
/// it fails with a named cause.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let mut lines = StudyLines::of("stability", &arguments.scene, "the scene's name")?;
    lines.give("task", "\"stability\"", "`stability`")?;
    lines.give("output.time_factors", &toml_of(vec![arguments.time_factor]), "`--time-factor`")?;
    lines.assign(&arguments.set)?;
    lines.refuse_without_effect(&[TIMING])?;
    let methods: Vec<&str> = arguments.method.split(',').map(str::trim).collect();
    let sweep = [
        format!("method = {}", toml_of(methods)),
        format!("cells = [{}]", arguments.cells),
        format!("points_per_cell = [{}]", arguments.points_per_cell),
    ];
    let study = lines.study(Purpose::Solving, sweep)?;
    tell_warnings(&study);
    let options = RunOptions::whole(Tier::Full, jobs_of(None));
    let mut report = run_study(&study, &options, None, &|_| {});
    if let Some(error) = report.errors.pop() {
        return Err(error.into());
    }
    match arguments.format {
        SolveFormat::Table => {
            print_data(&(stability::table(&report.records).to_text(table_width())? + "\n"))?;
        }
        SolveFormat::Csv => print_data(&csv_of(COLUMNS, report.records.iter().flat_map(rows_of))?)?,
        SolveFormat::Json => {
            let rows: Vec<_> = report.records.iter().map(StabilityJson::of).collect();
            print_data(&json_of(&rows)?)?;
        }
    }
    end_of(&report.records)
}

/// The end of a command: that of the first record that failed, that has no limit, or that does not agree.
///
/// # Errors
/// A sentence on the first case that failed, else on the first without a known limit.
fn end_of(records: &[Record]) -> anyhow::Result<Exit> {
    let failed = records.iter().find_map(|record| Some((record, record.status.failure()?)));
    if let Some((record, failure)) = failed {
        let label = record.case.label();
        return Err(Ended::with(
            Exit::CaseFailed,
            format!("{label}: {}: {}", failure.kind.name(), failure.reason),
        ));
    }
    let unknown =
        records.iter().find_map(|record| Some((record, record.stability.as_ref()?.unknown.as_ref()?)));
    if let Some((record, sentence)) = unknown {
        return Err(Ended::with(Exit::VerdictFailed, format!("{}: {sentence}", record.case.label())));
    }
    let contradicts = records.iter().find_map(|record| {
        let found = record.stability.as_ref().filter(|found| !agrees(found))?;
        Some(contradiction(&record.case, found))
    });
    contradicts.map_or(Ok(Exit::Pass), |sentence| Err(Ended::with(Exit::VerdictFailed, sentence)))
}

/// Says how far the predicted step is from those that run, and which share of it does.
fn contradiction(case: &Case, found: &CriticalStep) -> String {
    let label = case.label_without_step();
    let Some(share) = found.observed.map(|observed| observed / found.predicted) else {
        return format!("{label}: no run near the predicted step shows a limit");
    };
    let Some(reliable) = found.reliable_share.filter(|_| share < 1.0 - AGREEMENT) else {
        let at =
            found.probes.iter().find(|probe| !probe.is_as_predicted()).map_or(share, |probe| probe.share);
        return format!("{label}: the run at {at} of the predicted step contradicts the prediction");
    };
    let why = if case.configuration().moves_points() {
        "points cross cells, and the prediction is for their initial positions: "
    } else {
        ""
    };
    format!(
        "{label}: {why}`solve` with `--time-step stable={reliable}` runs to its end, and of larger steps up to \
         the predicted one some do not"
    )
}

fn agrees(critical: &CriticalStep) -> bool {
    critical.deviation().is_some_and(|deviation| deviation.abs() <= AGREEMENT) && critical.probes_agree()
}

#[derive(serde::Serialize)]
struct StabilityJson<'a> {
    label: String,
    deviation: Option<f64>,
    /// Resolution of the search, where the two steps do not differ by more.
    within: Option<f64>,
    stability: Option<&'a CriticalStep>,
    case: &'a crate::case::Case,
}

impl<'a> StabilityJson<'a> {
    fn of(record: &'a Record) -> Self {
        Self {
            label: record.case.label(),
            deviation: record.stability.as_ref().and_then(CriticalStep::deviation),
            within: record.stability.as_ref().and_then(CriticalStep::within),
            stability: record.stability.as_ref(),
            case: &record.case,
        }
    }
}

/// Columns of the CSV: one row per run near a limit.
const COLUMNS: [&str; 13] = [
    "method",
    "cells",
    "points_per_cell",
    "predicted_seconds",
    "observed_seconds",
    "wave_limit_seconds",
    "drag_limit_seconds",
    "combined_limit_seconds",
    "share",
    "status",
    "steps",
    "predicted_growth",
    "observed_growth",
];

fn rows_of(record: &Record) -> Vec<Vec<String>> {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:e}"));
    let Some(critical) = &record.stability else { return Vec::new() };
    let row = |probe: &Probe| {
        let failure = probe.failure.as_ref();
        vec![
            record.case.method.to_string(),
            record.case.cells.to_string(),
            record.case.points_per_cell.to_string(),
            format!("{:e}", critical.predicted),
            number(critical.observed),
            format!("{:e}", critical.wave_limit),
            format!("{:e}", critical.drag_limit),
            format!("{:e}", critical.combined_limit),
            probe.share.to_string(),
            failure.map_or("ok", |failure| failure.kind.name()).to_owned(),
            probe.steps.to_string(),
            number(probe.predicted_growth),
            number(failure.and_then(|failure| failure.growth)),
        ]
    };
    critical.probes.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Status;
    use oedometer_problem::outcome::{Failure, FailureKind};

    fn failure() -> Failure {
        Failure { kind: FailureKind::Unstable, step: 7, time: 1.0, growth: None, reason: "why".to_owned() }
    }

    fn found(observed: Option<f64>) -> CriticalStep {
        let probe = |share: f64| Probe {
            share,
            step: 2.0 * share,
            steps: 7,
            reaches_end: false,
            predicted_growth: None,
            failure: (share > 1.0).then(failure),
        };
        CriticalStep {
            predicted: 2.0,
            observed,
            reliable_share: observed.map(|observed| 0.47 * observed),
            wave_limit: 4.0,
            drag_limit: 8.0,
            combined_limit: 3.0,
            probes: vec![probe(0.97), probe(1.03)],
            ..CriticalStep::default()
        }
    }

    #[test]
    fn one_case_that_fails_has_no_limit_or_does_not_agree_is_the_end_of_all_wherever_it_stands() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2, 3, 4]\n";
        let mut all = crate::campaign::runner::records_of(text);
        for record in &mut all {
            record.stability = Some(found(Some(2.0)));
        }
        assert_eq!(end_of(&all).expect("no error"), Exit::Pass);
        let told =
            |records: &[Record]| end_of(records).map_err(|error| (Exit::of(&error), error.to_string()));
        for place in 0..3 {
            let mut records = all.clone();
            let label = records[place].case.label();
            records[place].stability = Some(found(Some(1.0)));
            let half = format!(
                "{}: `solve` with `--time-step stable=0.47` runs to its end, and of larger steps up to the predicted \
                 one some do not",
                records[place].case.label_without_step()
            );
            assert_eq!(told(&records), Err((Exit::VerdictFailed, half)), "{place}");
            let unknown = Some("no limit".to_owned());
            records[place].stability = Some(CriticalStep { unknown, ..found(None) });
            assert_eq!(told(&records), Err((Exit::VerdictFailed, format!("{label}: no limit"))));
            // What failed is told of before what has no limit.
            let last = (place + 1) % 3;
            records[last].status = Status::Failed(failure());
            let label = records[last].case.label();
            assert_eq!(told(&records), Err((Exit::CaseFailed, format!("{label}: unstable: why"))));
        }
    }

    #[test]
    fn an_observed_step_agrees_within_two_per_cent_on_either_side() {
        for (share, agree) in
            [(0.5, false), (0.979, false), (0.981, true), (1.0, true), (1.019, true), (1.021, false)]
        {
            assert_eq!(agrees(&found(Some(2.0 * share))), agree, "{share}");
        }
        assert!(!agrees(&found(None)), "nothing was observed");
        let one = CriticalStep { probes: found(None).probes[..1].to_vec(), ..found(Some(2.0)) };
        assert!(!agrees(&one), "no probe above the prediction");
    }
}
