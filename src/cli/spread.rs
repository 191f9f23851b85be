//! `oedometer spread`: how far results scatter that should be equal, by kernel, by number of
//! threads and by build: what the tolerances of golden values are derived from.

use super::check::run_quietly;
use super::exit::{Ended, Exit};
use super::output::{TableFormat, print_tables};
use super::run::{jobs_of, load_or_shipped};
use crate::assess::spread::{Spread, spread_of};
use crate::golden::values_of;
use crate::record::{Record, RecordStore};
use crate::render::spreads;
use crate::solver::run::Kernel;
use crate::study::{Study, Tier, run_case};
use std::path::PathBuf;

/// Arguments of `spread`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Results of another build of the same sources, as by `cargo run -- run STUDY.toml --out DIR`
    /// without `--release`: the spread between optimisation levels
    #[arg(long, value_name = "DIR")]
    against: Vec<PathBuf>,
    /// Cases at the same time in the run that is held against the sequential one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Runs the CI tier in several ways and measures.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let studies = load_or_shipped(&arguments.studies)?;
    let mut spreads: Vec<Spread> = Vec::new();
    for study in &studies {
        let one = records_of(study, 1)?;
        if one.is_empty() {
            continue;
        }
        let values = values_of(&one);
        let threads = jobs_of(arguments.jobs).max(2);
        let many = values_of(&records_of(study, threads)?);
        spreads.push(spread_of(&study.name, &format!("{threads} threads"), &values, &many));
        spreads.push(spread_of(&study.name, "point-wise kernel", &values, &values_of(&point_wise(study)?)));
        for folder in &arguments.against {
            let store = RecordStore::new(folder, &study.name);
            let other: Vec<Record> =
                study.cases(Tier::Ci).into_iter().filter_map(|case| store.kept(case)).collect();
            let build = other.first().map_or("no record", |record| record.provenance.profile.as_str());
            let source = format!("build `{build}` in {}", folder.display());
            spreads.push(spread_of(&study.name, &source, &values, &values_of(&other)));
        }
    }
    if spreads.is_empty() {
        return Err(Ended::with(Exit::NothingSelected, "no study has a case in the CI tier"));
    }
    match arguments.format {
        TableFormat::Json => println!("{}", serde_json::to_string_pretty(&spreads)?),
        format => print_tables(&[spreads::table_of(&spreads)], format)?,
    }
    Ok(Exit::Pass)
}

fn records_of(study: &Study, threads: usize) -> anyhow::Result<Vec<Record>> {
    Ok(run_quietly(std::slice::from_ref(study), threads)?.pop().unwrap_or_default())
}

/// The same cases by the kernel that visits every point.
fn point_wise(study: &Study) -> anyhow::Result<Vec<Record>> {
    let run = |case| Ok(run_case(case, &study.references, Kernel::PointWise, true, &|_, _| true)?);
    study.cases(Tier::Ci).into_iter().map(run).collect()
}
