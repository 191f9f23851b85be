//! Pages as one HTML file. What stands around the sections is in `page.html` and `page.css`.
use crate::render::escape;
use crate::render::page::marked_text::{paragraphs, to_html};
use crate::render::page::{Block, Figure, Page, check, shown_rows, table_file};
use crate::render::render_error::RenderError;
use crate::render::table::{Mood, Table};
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, Value, context};
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// Sorting and filtering: what a page has without it is all there, in the order of its making.
const SCRIPT: &str = include_str!("page.js");

/// What was written so far, to be counted on, and the name of the page's files.
#[derive(Default)]
struct Written<'a> {
    figures: usize,
    tables: usize,
    files: Option<&'a str>,
}

/// The page as one HTML file that needs nothing else.
///
/// # Errors
/// If a name is unusable or used twice, a table is ragged, or a figure cannot be drawn.
pub fn render_html(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let fail =
        |e: minijinja::Error| RenderError::Template { title: page.title.clone(), reason: e.to_string() };
    let mut sections = Vec::new();
    let mut written = Written { files: page.files.as_deref(), ..Written::default() };
    for section in &page.sections {
        let mut body = String::new();
        for block in &section.blocks {
            write_block(block, &mut body, &mut written)?;
        }
        sections.push(context! {
            id => section.id.as_str(),
            heading => safe(escape::html(&section.heading)),
            class => section.mood.map(Mood::class),
            mark => section.mood.map(Mood::mark),
            body => safe(body),
        });
    }
    let mut environment = Environment::new();
    let mut syntax = SyntaxConfig::builder();
    syntax.trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true);
    environment.set_syntax(syntax.build().map_err(fail)?);
    environment.add_template("page.html", TEMPLATE).map_err(fail)?;
    let template = environment.get_template("page.html").map_err(fail)?;
    template
        .render(context! {
            title => page.title.as_str(),
            heading => safe(escape::html(&page.title)),
            style => safe(STYLE.to_owned()),
            lead => safe(running(&page.lead)),
            callout => page.callout.as_ref().map(|(mood, text)| safe(callout(*mood, text))),
            footer => safe(running(&page.footer)),
            is_wide => page.is_wide,
            filter => page.filter.as_deref(),
            script => safe(SCRIPT.to_owned()),
            sections => Value::from(sections),
        })
        .map_err(fail)
}

/// Text that is escaped already.
fn safe(text: String) -> Value {
    Value::from_safe_string(text)
}

fn running(text: &str) -> String {
    paragraphs(text).iter().fold(String::new(), |mut out, p| {
        let _ = writeln!(out, "<p>{}</p>", to_html(p));
        out
    })
}

/// A sentence in a box of the colour of its mood.
fn callout(mood: Mood, text: &str) -> String {
    format!(
        "<aside class=\"callout {}\"><span class=\"mark\" aria-hidden=\"true\">{}</span><div>{}</div></aside>\n",
        mood.class(),
        mood.mark(),
        running(text).trim_end()
    )
}

/// A table, and where it is to be had as a file.
fn write_table(table: &Table, out: &mut String, written: &mut Written<'_>) -> Result<(), RenderError> {
    written.tables += 1;
    let file = written.files.map(|page| table_file(page, written.tables));
    let (shown, rest) = shown_rows(table, file.as_deref());
    out.push_str(&shown.to_html()?);
    out.push_str(&rest.map(|rest| running(&rest)).unwrap_or_default());
    if let Some(file) = file {
        let _ = writeln!(
            out,
            "<p class=\"files\"><a href=\"tables/{file}.csv\">CSV</a> <a href=\"tables/{file}.tex\">LaTeX</a></p>"
        );
    }
    Ok(())
}

fn write_block(block: &Block, out: &mut String, written: &mut Written<'_>) -> Result<(), RenderError> {
    match block {
        Block::Paragraph(text) => out.push_str(&running(text)),
        Block::Heading(text) => {
            let _ = writeln!(out, "<h3>{}</h3>", escape::html(text));
        }
        Block::List(points) => {
            out.push_str("<ul>\n");
            for point in points {
                let _ = writeln!(out, "<li>{}</li>", to_html(&paragraphs(point).join(" ")));
            }
            out.push_str("</ul>\n");
        }
        Block::Table(table) => write_table(table, out, written)?,
        Block::Figure(figure) => write_figure(figure, out, written)?,
        Block::Figures(figures) => {
            out.push_str("<div class=\"row\">\n");
            for figure in figures {
                write_figure(figure, out, written)?;
            }
            out.push_str("</div>\n");
        }
        Block::Callout(mood, text) => out.push_str(&callout(*mood, text)),
        Block::Details { summary, blocks } => {
            let _ = writeln!(out, "<details>\n<summary>{}</summary>", escape::html(summary));
            for block in blocks {
                write_block(block, out, written)?;
            }
            out.push_str("</details>\n");
        }
    }
    Ok(())
}

fn write_figure(figure: &Figure, out: &mut String, written: &mut Written<'_>) -> Result<(), RenderError> {
    written.figures += 1;
    let number = written.figures;
    let name = &figure.name;
    let files = written.files.map_or(String::new(), |_| {
        format!(" <span class=\"files\"><a href=\"figures/{name}.svg\">SVG</a> <a href=\"figures/{name}.csv\">data</a></span>")
    });
    let svg = figure.svg()?;
    // No screen makes a figure larger than it was meant to be.
    let own = natural_width(svg).map_or(String::new(), |w| format!(" style=\"--own: {w}px\""));
    let caption = paragraphs(&figure.caption).iter().map(|p| to_html(p)).collect::<Vec<_>>().join("<br>");
    let _ = write!(
        out,
        "<figure id=\"figure-{}\">\n<div class=\"card\"{own}>{svg}</div>\n\
         <figcaption><b>Figure {number}.</b> {caption}{files}</figcaption>\n</figure>\n",
        figure.name,
    );
    Ok(())
}

/// The width that an SVG document gives itself, in pixels.
fn natural_width(svg: &str) -> Option<f64> {
    let (head, _) = svg.split_once('>')?;
    let (_, after) = head.split_once(" width=\"")?;
    after.split_once('"')?.0.parse().ok().filter(|w: &f64| w.is_finite())
}
