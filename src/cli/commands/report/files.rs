//! The files of a report: the answer page, the list of studies, a page a study, and all tables and figures as
//! files of their own.

use crate::golden::compare::Difference;
use crate::record::whole_file::write_whole;
use crate::render::answers::making::Making;
use crate::render::answers::{Answers, answer_page};
use crate::render::page::html_page::render_html;
use crate::render::page::markdown_page::render_markdown;
use crate::render::page::{Page, all_figures, slug, tables};
use crate::render::report::StudyResults;
use crate::render::report::pages::index_page;
use crate::render::report::study_page::study_page;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Writes all files below a folder; the path of the answer page.
pub fn write(
    out: &Path,
    results: &[StudyResults<'_>],
    changes: Option<&[(String, Difference)]>,
    mut making: Making,
    start: Instant,
) -> anyhow::Result<PathBuf> {
    let studies = out.join("studies");
    for one in results {
        let page = study_page(one)?;
        let name = slug(&one.study.name);
        write_page(&studies.join(format!("{name}.html")), &render_html(&page)?)?;
        write_page(&studies.join(format!("{name}.md")), &render_markdown(&page)?)?;
        write_exports(&studies, &page)?;
    }
    let index = index_page(results, "html");
    write_page(&studies.join("index.html"), &render_html(&index)?)?;
    write_exports(&studies, &index)?;
    write_page(&studies.join("README.md"), &render_markdown(&index_page(results, "md"))?)?;

    making.seconds = start.elapsed().as_secs_f64();
    let html = |study: &str| format!("studies/{}.html", slug(study));
    let markdown = |study: &str| markdown_link(out, results, study);
    let page = |links: &dyn Fn(&str) -> String, index| {
        answer_page(&Answers { results, changes, making: &making, links, index })
    };
    let front = Page { files: Some("answers".to_owned()), ..page(&html, "studies/index.html")? };
    write_exports(out, &front)?;
    let path = out.join("index.html");
    write_page(&path, &render_html(&front)?)?;
    write_page(&out.join("README.md"), &render_markdown(&page(&markdown, "studies/README.md")?)?)?;
    Ok(path)
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

fn write_page(path: &Path, text: &str) -> anyhow::Result<()> {
    Ok(write_whole(path, text.as_bytes())?)
}

/// Every figure of a page as SVG with its data as CSV, and every table as CSV and LaTeX.
fn write_exports(folder: &Path, page: &Page) -> anyhow::Result<()> {
    let figures = folder.join("figures");
    for figure in all_figures(page) {
        write_page(&figures.join(format!("{}.svg", figure.name)), &figure.chart.svg()?)?;
        write_page(&figures.join(format!("{}.csv", figure.name)), &figure.chart.data_csv())?;
    }
    for (name, table) in tables(page) {
        let folder = folder.join("tables");
        write_page(&folder.join(format!("{name}.csv")), &table.to_csv()?)?;
        write_page(&folder.join(format!("{name}.tex")), &table.to_latex()?)?;
    }
    Ok(())
}
