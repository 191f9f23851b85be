//! The files of a report: the answer page, the list of studies, a page a study, and all tables and figures as
//! files of their own.

use crate::golden::compare::Difference;
use crate::judge::comparison::situation::{Ended, ends_of};
use crate::record::whole_file::write_rebuildable;
use crate::render::answers::making::Making;
use crate::render::answers::{Answers, answer_page};
use crate::render::escape::document;
use crate::render::page::html_page::render_html;
use crate::render::page::markdown_page::render_markdown;
use crate::render::page::{Page, all_figures, slug, tables};
use crate::render::report::StudyResults;
use crate::render::report::pages::index_page;
use crate::render::report::situations::situations_page;
use crate::render::report::study_page::study_page;
use oedometer_exact::exact_error::ExactError;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What stands before the name of a study in a link of the answers, and instead of the pages of all studies and of all
/// situations: each form of the page leads to its own.
const STUDY: &str = "study:";
const INDEX: &str = "page:studies";
const SITUATIONS: &str = "page:situations";

/// Writes all files below a folder; the path of the answer page.
pub fn write(
    out: &Path,
    results: &[StudyResults<'_>],
    changes: Option<&[(String, Difference)]>,
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
    write_forms(&studies, "index", "README", &index_page(results, "html"), &index_page(results, "md"))?;

    let ends: Result<Vec<Vec<Ended<'_>>>, ExactError> = results
        .par_iter()
        .map(|one| ends_of(one.study, one.records))
        .collect::<Vec<_>>()
        .into_iter()
        .collect();
    let ends = ends?.concat();
    let situations = |form| situations_page(&ends, form);
    write_forms(out, "situations", "situations", &situations("html"), &situations("md"))?;

    making.seconds = start.elapsed().as_secs_f64();
    let links = |study: &str| format!("{STUDY}{study}");
    let (index, situations) = (INDEX, SITUATIONS);
    let answers =
        Answers { results, changes, making: &making, links: &links, index, ends: &ends, situations };
    let front = Page { files: Some("answers".to_owned()), ..answer_page(&answers)? };
    write_exports(out, &front)?;
    let markdown = front.clone().with_links(&|target| match target.strip_prefix(STUDY) {
        Some(study) => markdown_link(out, results, study),
        None if target == INDEX => "studies/README.md".to_owned(),
        None => target.replace(SITUATIONS, "situations.md"),
    });
    write_page(&out.join("README.md"), &render_markdown(&markdown)?)?;
    let html = front.with_links(&|target| match target.strip_prefix(STUDY) {
        Some(study) => format!("studies/{}.html", slug(study)),
        None if target == INDEX => "studies/index.html".to_owned(),
        None => target.replace(SITUATIONS, "situations.html"),
    });
    let path = out.join("index.html");
    write_page(&path, &render_html(&html)?)?;
    Ok(path)
}

/// Writes a page in both forms, with the figures and tables of the first.
fn write_forms(
    folder: &Path,
    html_name: &str,
    markdown_name: &str,
    html: &Page,
    markdown: &Page,
) -> anyhow::Result<()> {
    write_page(&folder.join(format!("{html_name}.html")), &render_html(html)?)?;
    write_page(&folder.join(format!("{markdown_name}.md")), &render_markdown(markdown)?)?;
    write_exports(folder, html)
}

/// The pages of a study with their figures and tables.
fn write_study(studies: &Path, one: &StudyResults<'_>) -> anyhow::Result<()> {
    let page = study_page(one)?;
    let name = slug(&one.study.name);
    write_forms(studies, &name, &name, &page, &page)
}

/// Where the Markdown front page leads for a study: to its file, which a repository has beside the report, and to
/// its page where there is none.
fn markdown_link(out: &Path, results: &[StudyResults<'_>], study: &str) -> String {
    let page = format!("studies/{}.md", slug(study));
    let Some(one) = results.iter().find(|one| one.study.name == study) else { return page };
    let is_plain =
        |path: &Path| path.components().all(|part| matches!(part, std::path::Component::Normal(_)));
    if is_plain(out) && is_plain(Path::new(&one.file)) && Path::new(&one.file).is_file() {
        format!("{}{}", "../".repeat(out.components().count()), one.file)
    } else {
        page
    }
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
