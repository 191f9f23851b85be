//! Pages as one HTML file. What stands around the sections is in `page.html` and `page.css`.
use crate::render::escape;
use crate::render::page::marked_text::{paragraphs, to_html};
use crate::render::page::{Block, Figure, Page, Section, check, shown_rows, table_file};
use crate::render::render_error::RenderError;
use crate::render::table::{Mood, Table};
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
    let mut sections = String::new();
    let mut written = Written { files: page.files.as_deref(), ..Written::default() };
    for section in &page.sections {
        let (id, heading, mark) = (&section.id, escape::html(&section.heading), mark_of(section));
        let _ = writeln!(
            sections,
            "<section id=\"{id}\">\n<h2>{heading}{mark}<a class=\"anchor\" href=\"#{id}\" \
             aria-label=\"Link to this section\">#</a></h2>"
        );
        for block in &section.blocks {
            write_block(block, &mut sections, &mut written)?;
        }
        sections.push_str("</section>\n");
    }
    let footer = running(&page.footer);
    let filter = page.filter.as_deref().map(escape::plain_html);
    Ok(filled(
        TEMPLATE,
        &[
            ("title", &escape::plain_html(&page.title)),
            ("style", STYLE),
            ("wide", if page.is_wide { " wide" } else { "" }),
            ("heading", &escape::html(&page.title)),
            ("lead", &running(&page.lead)),
            ("callout", &page.callout.as_ref().map(|(mood, text)| callout(*mood, text)).unwrap_or_default()),
            ("contents", &contents(page)),
            ("filter", &filter.map(|filter| format!(" data-filter=\"{filter}\"")).unwrap_or_default()),
            ("sections", &sections),
            ("footer", &if footer.is_empty() { footer } else { format!("<footer>\n{footer}</footer>\n") }),
            ("script", SCRIPT),
        ],
    ))
}

/// A template with texts in the places of their names. What is filled in is not looked at again.
fn filled(template: &str, texts: &[(&str, &str)]) -> String {
    let mut out = String::new();
    for (at, part) in template.split("{{ ").enumerate() {
        let (name, after) = if at == 0 { ("", part) } else { part.split_once(" }}").unwrap_or((part, "")) };
        out.push_str(texts.iter().find(|(known, _)| *known == name).map_or("", |(_, text)| text));
        out.push_str(after);
    }
    out
}

/// The list of the sections, where there are several.
fn contents(page: &Page) -> String {
    if page.sections.len() < 2 {
        return String::new();
    }
    let mut out = "<nav aria-label=\"Contents\">\n<p class=\"nav-title\">Contents</p>\n<ol>\n".to_owned();
    for section in &page.sections {
        let (id, heading, mark) = (&section.id, escape::html(&section.heading), mark_of(section));
        let _ = writeln!(out, "<li><a href=\"#{id}\">{heading}</a>{mark}</li>");
    }
    out.push_str("</ol>\n</nav>\n");
    out
}

/// The mark of a section's mood.
fn mark_of(section: &Section) -> String {
    let marked = |mood: Mood| format!(" <span class=\"{}\">{}</span>", mood.class(), mood.mark());
    section.mood.map(marked).unwrap_or_default()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_of_the_template_is_filled_once_and_what_fills_it_stays_as_it_is() {
        assert_eq!(filled("a {{ x }} b {{ y }}\n", &[("y", "{{ x }}"), ("x", "1")]), "a 1 b {{ x }}\n");
        let page = Page { title: "A < B".to_owned(), ..Page::default() };
        let html = render_html(&page).expect("a page");
        assert!(html.contains("<title>A &lt; B</title>"), "{html}");
        assert!(html.contains("<div class=\"page\">") && html.ends_with("</html>\n"), "{html}");
        assert!(!html.contains("{{") && !html.contains("<nav") && !html.contains("<footer>"), "{html}");
        for place in TEMPLATE.split("{{ ").skip(1) {
            let (name, _) = place.split_once(" }}").expect("a place that ends");
            assert_eq!(TEMPLATE.matches(&format!("{{{{ {name} }}}}")).count(), 1, "{name}");
        }
    }
}
