//! `oedometer spread`: how far results scatter that should be equal, by number of threads, by the last
//! digit of an input, by kernel and by build: what the tolerances of golden values are derived from.

use crate::campaign::case_run::run_case;
use crate::case::tier::Tier;
use crate::cli::commands::accept::refuse_without_origin;
use crate::cli::commands::check::run_quietly;
use crate::cli::commands::run::{jobs_of, load};
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, json_of, print_tables};
use crate::cli::place::StudyArguments;
use crate::cli::stream::print_data;
use crate::cli::trust::TrustArguments;
use crate::golden::tolerance::spread_by_group;
use crate::golden::{GoldenFile, values_of};
use crate::judge::scatter::{ValueScatter, spread_of};
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::render::tables::runs;
use crate::study::check::Study;
use crate::study::perturbed::LastDigit;
use oedometer_mpm::run::Kernel;
use std::path::PathBuf;

/// Arguments of `spread`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Results of another build of the same sources, as by `cargo run -- run STUDY.toml --out DIR`
    /// without `--release`: the spread between optimisation levels
    #[arg(long, value_name = "DIR")]
    against: Vec<PathBuf>,
    /// Leave out the point-wise kernel, which takes a hundred times as long
    #[arg(long)]
    quick: bool,
    /// Make the spreads the tolerances of the golden files in this folder, whose values and reasons stay
    #[arg(long, value_name = "DIR")]
    into: Option<PathBuf>,
    /// Cases at the same time in the run that is compared with the sequential one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    #[command(flatten)]
    trust: TrustArguments,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Runs the CI tier in several ways and measures.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.into.is_some() {
        refuse_without_origin()?;
    }
    let chosen = arguments.studies.chosen()?;
    let mut studies = load(&chosen)?;
    arguments.trust.mark_all(&mut studies, &chosen)?;
    let mut spreads: Vec<ValueScatter> = Vec::new();
    for study in &studies {
        let one = records_of(study, 1)?;
        if one.is_empty() {
            continue;
        }
        let values = values_of(&one);
        let threads = jobs_of(arguments.jobs).max(2);
        let mut others = vec![(format!("{threads} threads"), values_of(&records_of(study, threads)?))];
        for digit in LastDigit::ALL {
            let records = records_of(&study.perturbed(digit), threads)?;
            others.push((digit.name().to_owned(), values_of(&records)));
        }
        if !arguments.quick {
            others.push(("point-wise kernel".to_owned(), values_of(&point_wise(study)?)));
        }
        for folder in &arguments.against {
            let store = RecordStore::new(folder, &study.name);
            let other: Vec<Record> =
                study.cases(Tier::Ci).into_iter().filter_map(|case| store.kept(case)).collect();
            let build = other.first().map_or("no record", |record| record.provenance.profile.as_str());
            others.push((format!("build `{build}` in {}", folder.display()), values_of(&other)));
        }
        spreads.extend(others.iter().map(|(source, other)| spread_of(&study.name, source, &values, other)));
        if let Some(folder) = &arguments.into {
            let spread = spread_by_group(&values, others.iter().map(|(_, other)| other));
            let golden =
                GoldenFile::read(folder, &study.name).map_err(|error| Ended::usage(error.to_string()))?;
            golden.widened_by(spread).write(folder)?;
        }
    }
    if spreads.is_empty() {
        return Err(Ended::with(Exit::NothingSelected, "no study has a case in the CI tier"));
    }
    match arguments.format {
        TableFormat::Json => print_data(&json_of(&spreads)?)?,
        format => print_tables(&[runs::spreads(&spreads)], format)?,
    }
    Ok(Exit::Pass)
}

fn records_of(study: &Study, threads: usize) -> anyhow::Result<Vec<Record>> {
    Ok(run_quietly(std::slice::from_ref(study), threads)?.pop().unwrap_or_default())
}

/// Runs the cases by the kernel that visits every point.
fn point_wise(study: &Study) -> anyhow::Result<Vec<Record>> {
    let run = |case| Ok(run_case(case, &study.references, Kernel::PointWise, true, &|_, _| true)?);
    study.cases(Tier::Ci).into_iter().map(run).collect()
}
