//! `oedometer report`: run what is missing, render everything.

use crate::campaign::run_options::RunOptions;
use crate::case::tier::Tier;
use crate::cli::commands::run::{Beside, DEFAULT_RESULTS, jobs_of, load_or_shipped, run_and_store};
use crate::cli::exit::Exit;
use crate::cli::stream::say;
use crate::record::whole_file::write_whole;
use crate::render::page::figures;
use crate::render::page::html_page::render_html;
use crate::render::page::markdown_page::render_markdown;
use crate::render::report::StudyResults;
use crate::render::report::pages::{front_page, page_of};
use std::path::PathBuf;

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files or names of shipped studies; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    /// Folder of the records
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Cases at the same time; all cores where not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
}

/// Runs, renders and writes `index.html`, `report.md`, the short `README.md` and `figures/`.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let studies = load_or_shipped(&arguments.studies)?;
    let options = RunOptions { resume: true, ..RunOptions::whole(Tier::Full, jobs_of(arguments.jobs)) };
    let reports = run_and_store(&studies, &studies, &options, &arguments.records, Beside::Nothing)?;
    let results: Vec<StudyResults<'_>> = studies
        .iter()
        .zip(&reports)
        .map(|(study, report)| StudyResults::new(study, &report.records, Tier::Full))
        .collect();
    let page = page_of(&results)?;
    let front = front_page(&results, &page);
    let html = arguments.out.join("index.html");
    write_whole(&html, render_html(&page)?.as_bytes())?;
    for (name, page) in [("report.md", &page), ("README.md", &front)] {
        write_whole(&arguments.out.join(name), render_markdown(page)?.as_bytes())?;
    }
    for (name, svg) in figures(&page)?.into_iter().chain(figures(&front)?) {
        write_whole(&arguments.out.join("figures").join(name), svg.as_bytes())?;
    }
    say!("the report is {}", html.display());
    let is_whole = reports.iter().all(|report| report.errors.is_empty());
    Ok(if is_whole { Exit::Pass } else { Exit::CaseFailed })
}
