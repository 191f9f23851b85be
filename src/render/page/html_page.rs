//! Pages as one HTML file. What stands around the sections is in `page.html` and `page.css`.
use crate::render::escape;
use crate::render::page::marked_text::{paragraphs, to_html};
use crate::render::page::{Block, Figure, Page, check};
use crate::render::render_error::RenderError;
use crate::render::table::Mood;
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, Value, context};
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// The page as one HTML file that needs nothing else.
///
/// # Errors
/// If a name is unusable or used twice, a table is ragged, or a figure cannot be drawn.
pub fn render_html(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let fail =
        |e: minijinja::Error| RenderError::Template { title: page.title.clone(), reason: e.to_string() };
    let mut sections = Vec::new();
    let mut number = 0;
    for section in &page.sections {
        let mut body = String::new();
        for block in &section.blocks {
            write_block(block, &mut body, &mut number)?;
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
            footer => safe(running(&page.footer)),
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

fn write_block(block: &Block, out: &mut String, number: &mut usize) -> Result<(), RenderError> {
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
        Block::Table(table) => out.push_str(&table.to_html()?),
        Block::Figure(figure) => write_figure(figure, out, number)?,
        Block::Figures(figures) => {
            out.push_str("<div class=\"row\">\n");
            for figure in figures {
                write_figure(figure, out, number)?;
            }
            out.push_str("</div>\n");
        }
        Block::Callout(mood, text) => {
            let _ = writeln!(
                out,
                "<aside class=\"callout {}\"><span class=\"mark\" aria-hidden=\"true\">{}</span><div>{}</div></aside>",
                mood.class(),
                mood.mark(),
                running(text).trim_end()
            );
        }
        Block::Details { summary, blocks } => {
            let _ = writeln!(out, "<details>\n<summary>{}</summary>", escape::html(summary));
            for block in blocks {
                write_block(block, out, number)?;
            }
            out.push_str("</details>\n");
        }
    }
    Ok(())
}

fn write_figure(figure: &Figure, out: &mut String, number: &mut usize) -> Result<(), RenderError> {
    *number += 1;
    let svg = figure.chart.svg()?;
    // No screen makes a figure larger than it was meant to be.
    let own = natural_width(&svg).map_or(String::new(), |w| format!(" style=\"--own: {w}px\""));
    let caption = paragraphs(&figure.caption).iter().map(|p| to_html(p)).collect::<Vec<_>>().join("<br>");
    let _ = write!(
        out,
        "<figure id=\"figure-{}\">\n<div class=\"card\"{own}>{svg}</div>\n\
         <figcaption><b>Figure {number}.</b> {caption}</figcaption>\n</figure>\n",
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
