//! Writers of pages: one self-contained HTML file, and GitHub's Markdown with the figures beside it. The frame around the
//! sections of HTML is in `page.html` and `page.css`.

use crate::render::marked_text::{paragraphs, to_html, to_markdown};
use crate::render::page::{Block, Figure, Page, Section, check, shown_rows, table_file};
use crate::render::table::{Mood, Table};
use crate::render::{RenderError, escape, palette};
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// Sorts and filters tables; the page is whole without it.
const SCRIPT: &str = include_str!("page.js");

/// Counts what has been written, and knows the name of the page's files.
#[derive(Default)]
struct Written<'a> {
    figures: usize,
    tables: usize,
    switches: usize,
    files: Option<&'a str>,
}

impl<'a> Written<'a> {
    fn of(page: &'a Page) -> Self {
        Self { files: page.files.as_deref(), ..Self::default() }
    }

    /// The name of the file of the next table.
    fn next_table(&mut self, table: &Table) -> Option<String> {
        self.tables += usize::from(table.file.is_none());
        self.files.map(|page| table_file(page, self.tables, table))
    }
}

/// The page as one HTML file that needs nothing else.
///
/// # Errors
/// If a name is unusable or used twice, a table is ragged, or a figure cannot be drawn.
pub fn render_html(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let mut written = Written::of(page);
    let mut sections = String::new();
    for section in &page.sections {
        let (id, heading, mark) = (&section.id, escape::html(&section.heading), html_mark(section));
        let _ = writeln!(
            sections,
            "<section id=\"{id}\">\n<h2>{heading}{mark}<a class=\"anchor\" href=\"#{id}\" \
             aria-label=\"Link to this section\">#</a></h2>"
        );
        for block in &section.blocks {
            html_block(block, &mut sections, &mut written)?;
        }
        sections.push_str("</section>\n");
    }
    let footer = html_text(&page.footer);
    let filter = page.filter.as_deref().map(escape::plain_html);
    let callout = page.callout.as_ref().map(|(mood, text)| html_callout(*mood, text));
    Ok(filled(
        TEMPLATE,
        &[
            ("title", &escape::plain_html(&page.title)),
            ("style", &(STYLE.to_owned() + &palette::dark_rules(".card"))),
            ("wide", if page.is_wide { " wide" } else { "" }),
            ("links", &html_links(&page.links)),
            ("heading", &escape::html(&page.title)),
            ("lead", &html_text(&page.lead)),
            ("callout", &callout.unwrap_or_default()),
            ("contents", &html_contents(page)),
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

/// The links at the top of a page.
fn html_links(links: &[(String, String)]) -> String {
    let link = |(words, target): &(String, String)| {
        format!("<a href=\"{}\">{}</a>\n", escape::plain_html(target), escape::html(words))
    };
    let links: String = links.iter().map(link).collect();
    if links.is_empty() {
        links
    } else {
        format!("<nav class=\"links\" aria-label=\"Pages\">\n{links}</nav>\n")
    }
}

/// Sections that a list of contents may have: a longer one hides the page on a phone.
const MOST_CONTENTS: usize = 20;

/// The list of the sections, where there are several and not too many, and no links at the top that have them.
fn html_contents(page: &Page) -> String {
    let is_told = page.is_wide && !page.links.is_empty();
    if is_told || !(2..=MOST_CONTENTS).contains(&page.sections.len()) {
        return String::new();
    }
    let mut out = "<nav aria-label=\"Contents\">\n<p class=\"nav-title\">Contents</p>\n<ol>\n".to_owned();
    for section in &page.sections {
        let (id, heading, mark) = (&section.id, escape::html(&section.heading), html_mark(section));
        let _ = writeln!(out, "<li><a href=\"#{id}\">{heading}</a>{mark}</li>");
    }
    out + "</ol>\n</nav>\n"
}

fn html_mark(section: &Section) -> String {
    let marked = |mood: Mood| format!(" <span class=\"{}\">{}</span>", mood.class(), mood.mark());
    section.mood.map(marked).unwrap_or_default()
}

/// The paragraphs of a lightly marked text.
fn html_text(text: &str) -> String {
    paragraphs(text).iter().fold(String::new(), |out, paragraph| out + "<p>" + &to_html(paragraph) + "</p>\n")
}

fn html_callout(mood: Mood, text: &str) -> String {
    let (class, mark, text) = (mood.class(), mood.mark(), html_text(text));
    let mark = format!("<span class=\"mark\" aria-hidden=\"true\">{mark}</span>");
    format!("<aside class=\"callout {class}\">{mark}<div>{}</div></aside>\n", text.trim_end())
}

fn html_block(block: &Block, out: &mut String, written: &mut Written<'_>) -> Result<(), RenderError> {
    match block {
        Block::Paragraph(text) => out.push_str(&html_text(text)),
        Block::Code(text) => {
            let _ = writeln!(out, "<pre><code>{}</code></pre>", escape::plain_html(text));
        }
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
        Block::Table(table) => html_table(table, out, written)?,
        Block::Figure(figure) => html_figure(figure, out, written)?,
        Block::Figures(figures) => {
            out.push_str("<div class=\"row\">\n");
            for figure in figures {
                html_figure(figure, out, written)?;
            }
            out.push_str("</div>\n");
        }
        Block::Beside(main, aside) => {
            out.push_str("<div class=\"beside\">\n");
            for (blocks, [open, close]) in [(main, ["<div>", "</div>"]), (aside, ["<aside>", "</aside>"])] {
                let _ = writeln!(out, "{open}");
                for block in blocks {
                    html_block(block, out, written)?;
                }
                let _ = writeln!(out, "{close}");
            }
            out.push_str("</div>\n");
        }
        Block::Switch(views) => {
            written.switches += 1;
            out.push_str("<div class=\"switch\">\n");
            for (place, (word, _)) in views.iter().enumerate() {
                let (id, on) =
                    (format!("view-{}-{place}", written.switches), if place == 0 { " checked" } else { "" });
                let name = written.switches;
                let _ = writeln!(
                    out,
                    "<input type=\"radio\" name=\"view-{name}\" id=\"{id}\"{on}><label for=\"{id}\">{}</label>",
                    escape::html(word)
                );
            }
            // The views stand in one place, and count as one figure.
            let (first, mut last) = (written.figures, written.figures);
            for (word, blocks) in views {
                // Where all views are shown, as on paper, each has its word.
                let _ = writeln!(out, "<div>\n<p class=\"view\">{}</p>", escape::html(word));
                written.figures = first;
                for block in blocks {
                    html_block(block, out, written)?;
                }
                last = last.max(written.figures);
                out.push_str("</div>\n");
            }
            out.push_str("</div>\n");
            written.figures = last;
        }
        Block::Details { summary, blocks } => {
            let _ = writeln!(out, "<details>\n<summary>{}</summary>", escape::html(summary));
            for block in blocks {
                html_block(block, out, written)?;
            }
            out.push_str("</details>\n");
        }
    }
    Ok(())
}

/// A table with links to its files.
fn html_table(table: &Table, out: &mut String, written: &mut Written<'_>) -> Result<(), RenderError> {
    let file = written.next_table(table);
    let (shown, rest) = shown_rows(table, file.as_deref());
    out.push_str(&shown.to_html()?);
    out.push_str(&rest.map(|rest| html_text(&rest)).unwrap_or_default());
    if let Some(file) = file {
        let _ = writeln!(out, "<p class=\"files\"><a href=\"tables/{file}.csv\">CSV</a></p>");
    }
    Ok(())
}

/// A figure with its number, caption and links to its files.
fn html_figure(figure: &Figure, out: &mut String, written: &mut Written<'_>) -> Result<(), RenderError> {
    // A figure of the paper has the paper's number.
    let is_papers = figure.chart.title.starts_with("Fig. ");
    written.figures += usize::from(!is_papers);
    let number = if is_papers { String::new() } else { format!("<b>Figure {}.</b> ", written.figures) };
    let (name, svg) = (&figure.name, figure.svg()?);
    let files = written.files.map_or(String::new(), |_| {
        let svg = format!("<a href=\"figures/{name}.svg\">SVG</a>");
        format!(" <span class=\"files\">{svg} <a href=\"figures/{name}.csv\">data</a></span>")
    });
    // No screen makes a figure larger than it was meant to be.
    let width = natural_width(svg);
    let own = width.map_or(String::new(), |width| format!(" style=\"--own: {width}px\""));
    // A figure of several panels beside another would have letters that nobody reads.
    let whole = if width.is_some_and(|width| width > WIDEST_BESIDE) { " class=\"whole\"" } else { "" };
    let narrow = figure.narrow_svg()?.map(|svg| format!("<div class=\"card narrow\">{svg}</div>\n"));
    let (wide, narrow) = (if narrow.is_some() { " wide" } else { "" }, narrow.unwrap_or_default());
    let caption =
        paragraphs(&figure.caption).iter().map(|text| to_html(text)).collect::<Vec<_>>().join("<br>");
    let _ = write!(
        out,
        "<figure{whole} id=\"figure-{name}\">\n<div class=\"card{wide}\"{own}>{svg}</div>\n{narrow}\
         <figcaption>{number}{caption}{files}</figcaption>\n</figure>\n",
    );
    Ok(())
}

/// The widest figure that stands beside another, px.
const WIDEST_BESIDE: f64 = 600.0;

/// The width that an SVG document gives itself, in pixels.
fn natural_width(svg: &str) -> Option<f64> {
    let (head, _) = svg.split_once('>')?;
    let (_, after) = head.split_once(" width=\"")?;
    after.split_once('"')?.0.parse().ok().filter(|width: &f64| width.is_finite())
}

/// The page as Markdown. Its figures are at `figures/NAME.svg`, as `figures` lists them, and its links to pages of the
/// report lead to their Markdown form.
///
/// # Errors
/// If a name is unusable or used twice, or a table is ragged.
pub fn render_markdown(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let mut written = Written::of(page);
    let link = |(words, target): &(String, String)| format!("[{words}]({target})");
    let links = page.links.iter().map(link).collect::<Vec<_>>().join(" · ");
    let mut out = vec![
        markdown_text(&links),
        format!("# {}", escape::markdown(&page.title)),
        markdown_text(&page.lead),
    ];
    out.extend(page.callout.as_ref().map(|(mood, text)| markdown_callout(*mood, text)));
    let mark = |section: &Section| section.mood.map(|mood| format!(" {}", mood.mark())).unwrap_or_default();
    if page.sections.len() > 2 && (!page.is_wide || page.links.is_empty()) {
        let entry =
            |one: &Section| format!("- [{}](#{}){}", escape::markdown(&one.heading), one.id, mark(one));
        out.push(page.sections.iter().map(entry).collect::<Vec<_>>().join("\n"));
    }
    for section in &page.sections {
        // An anchor of our own: those made from headings change with every word.
        out.push(format!("<a id=\"{}\"></a>", section.id));
        out.push(format!("## {}{}", escape::markdown(&section.heading), mark(section)));
        for block in &section.blocks {
            out.push(markdown_block(block, &mut written)?);
        }
    }
    if !page.footer.is_empty() {
        out.extend(["---".to_owned(), markdown_text(&page.footer)]);
    }
    out.retain(|part| !part.is_empty());
    Ok(format!("{}\n", out.join("\n\n")))
}

/// Blocks as Markdown, without files.
///
/// # Errors
/// If a table is ragged.
pub fn markdown_of(blocks: &[Block]) -> Result<String, RenderError> {
    let mut written = Written::default();
    let parts: Vec<String> =
        blocks.iter().map(|block| markdown_block(block, &mut written)).collect::<Result<_, _>>()?;
    Ok(parts.join("\n\n") + "\n")
}

/// The paragraphs of a lightly marked text.
fn markdown_text(text: &str) -> String {
    paragraphs(text).iter().map(|paragraph| to_markdown(paragraph)).collect::<Vec<_>>().join("\n\n")
}

fn markdown_callout(mood: Mood, text: &str) -> String {
    let kind = match mood {
        Mood::Pass => "TIP",
        Mood::Fail => "CAUTION",
        Mood::Note => "NOTE",
    };
    format!("> [!{kind}]\n> {}", markdown_text(text).replace("\n\n", "\n>\n> "))
}

fn markdown_block(block: &Block, written: &mut Written<'_>) -> Result<String, RenderError> {
    Ok(match block {
        Block::Paragraph(text) => markdown_text(text),
        Block::Code(text) => format!("```\n{}\n```", text.trim_end()),
        Block::Heading(text) => format!("### {}", escape::markdown(text)),
        Block::List(points) => {
            let point = |point: &String| format!("- {}", to_markdown(&paragraphs(point).join(" ")));
            points.iter().map(point).collect::<Vec<_>>().join("\n")
        }
        Block::Table(table) => {
            let (shown, rest) = shown_rows(table, written.next_table(table).as_deref());
            let table = shown.to_markdown()?.trim_end().to_owned();
            std::iter::once(table).chain(rest).collect::<Vec<_>>().join("\n\n")
        }
        Block::Figure(figure) => markdown_figure(figure),
        Block::Figures(figures) => figures.iter().map(markdown_figure).collect::<Vec<_>>().join("\n\n"),
        Block::Beside(main, aside) => {
            let all = main.iter().chain(aside).map(|block| markdown_block(block, written));
            all.collect::<Result<Vec<_>, _>>()?.join("\n\n")
        }
        Block::Switch(views) => {
            let details = |(place, (word, blocks)): (usize, &(String, Vec<Block>))| {
                let details = Block::Details { summary: word.clone(), blocks: blocks.clone() };
                let view = markdown_block(&details, written)?;
                // The first one is seen at once.
                Ok(if place == 0 { view.replacen("<details>", "<details open>", 1) } else { view })
            };
            views.iter().enumerate().map(details).collect::<Result<Vec<_>, RenderError>>()?.join("\n\n")
        }
        Block::Details { summary, blocks } => {
            let inside: Result<Vec<_>, _> =
                blocks.iter().map(|block| markdown_block(block, written)).collect();
            let (summary, inside) = (escape::html(summary), inside?.join("\n\n"));
            format!("<details>\n<summary>{summary}</summary>\n\n{inside}\n\n</details>")
        }
    })
}

fn markdown_figure(figure: &Figure) -> String {
    let image = format!("![{}](figures/{}.svg)", escape::markdown(&figure.chart.title), figure.name);
    let caption = markdown_text(&figure.caption);
    if caption.is_empty() { image } else { format!("{image}\n\n{caption}") }
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
