//! The files of a report: the answer page, the list of studies, one page per study, and all tables and figures.

use crate::history::comparison::StudyComparison;
use crate::judge::race::RaceRow;
use crate::record::whole_file::write_rebuildable;
use crate::render::answers::{Answers, Making, answer_page};
use crate::render::escape::document;
use crate::render::page::{Page, all_figures, render_html, render_markdown, slug, tables};
use crate::render::report::StudyResults;
use crate::render::report::pages::index_page;
use crate::render::report::study_page::study_page;
use crate::render::tables::race;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Writes all files below a folder; the path of the answer page.
pub fn write(
    out: &Path,
    results: &[StudyResults<'_>],
    (against, changes): (&str, Option<&[StudyComparison]>),
    mut making: Making,
    start: Instant,
) -> anyhow::Result<PathBuf> {
    let studies = out.join("studies");
    // Collected before the first error is taken: the same error every time.
    results
        .par_iter()
        .map(|one| write_study(&studies, one))
        .collect::<Vec<_>>()
        .into_iter()
        .collect::<anyhow::Result<()>>()?;
    write_both(&studies, "index", "README", &index_page(results))?;
    let rows: Vec<RaceRow<'_>> =
        results.iter().filter_map(|one| RaceRow::of(one.study, one.records)).collect();
    if !rows.is_empty() {
        write_page(&out.join("tables/race.csv"), &race::table_of(&rows).to_plain_csv()?)?;
    }

    making.seconds = start.elapsed().as_secs_f64();
    let answers = Answers { results, changes, against, making: &making, race: &rows };
    let front = Page { files: Some("answers".to_owned()), ..answer_page(&answers)? };
    write_both(out, "index", "README", &front)?;
    let readme = results.iter().fold(render_markdown(&front)?, |text, one| match path_from(out, &one.file) {
        Some(file) => {
            text.replace(&format!("](studies/{}.md)", slug(&one.study.name)), &format!("]({file})"))
        }
        None => text,
    });
    write_page(&out.join("README.md"), &readme)?;
    Ok(out.join("index.html"))
}

/// The pages of a study with their figures and tables.
fn write_study(studies: &Path, one: &StudyResults<'_>) -> anyhow::Result<()> {
    let name = slug(&one.study.name);
    write_both(studies, &name, &name, &study_page(one)?)
}

/// A page as HTML and Markdown, with its figures and tables as files.
fn write_both(folder: &Path, html: &str, markdown: &str, page: &Page) -> anyhow::Result<()> {
    write_page(&folder.join(format!("{html}.html")), &render_html(page)?)?;
    write_page(&folder.join(format!("{markdown}.md")), &render_markdown(page)?)?;
    write_exports(folder, page)
}

/// The path from the folder of the report to the file of a study, if both are below the current folder: the front page
/// in a repository links to the files of studies, because their pages are not kept.
fn path_from(out: &Path, file: &str) -> Option<String> {
    let is_plain =
        |path: &Path| path.components().all(|part| matches!(part, std::path::Component::Normal(_)));
    let is_near = is_plain(out) && is_plain(Path::new(file)) && Path::new(file).is_file();
    is_near.then(|| format!("{}{file}", "../".repeat(out.components().count())))
}

/// Whole or not at all, and not forced to the disk: after a loss of power the report is made again from its records.
fn write_page(path: &Path, text: &str) -> anyhow::Result<()> {
    Ok(write_rebuildable(path, document(text).as_bytes())?)
}

/// Every figure of a page as SVG with its data as CSV, and every table as CSV and LaTeX.
fn write_exports(folder: &Path, page: &Page) -> anyhow::Result<()> {
    let figures = folder.join("figures");
    for figure in all_figures(page) {
        write_page(&figures.join(format!("{}.svg", figure.name)), figure.svg()?)?;
        write_page(&figures.join(format!("{}.csv", figure.name)), &figure.chart.data_csv())?;
    }
    for (name, table) in tables(page) {
        let folder = folder.join("tables");
        write_page(&folder.join(format!("{name}.csv")), &table.to_csv()?)?;
        write_page(&folder.join(format!("{name}.tex")), &table.to_latex()?)?;
    }
    Ok(())
}
