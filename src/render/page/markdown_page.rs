//! Pages in GitHub's Markdown.
use crate::render::escape;
use crate::render::page::marked_text::{paragraphs, to_markdown};
use crate::render::page::{Block, Figure, Page, Section, check, shown_rows, table_file};
use crate::render::render_error::RenderError;
use crate::render::table::{Mood, Table};

/// The page as Markdown. Its figures are at `figures/NAME.svg`, as `figures` lists them.
///
/// # Errors
/// If a name is unusable or used twice, or a table is ragged.
pub fn render_markdown(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let mut out = vec![format!("# {}", escape::markdown(&page.title))];
    let mut written = Written { files: page.files.as_deref(), tables: 0 };
    out.extend(running(&page.lead));
    if let Some((mood, text)) = &page.callout {
        out.push(callout(*mood, text));
    }
    if page.sections.len() > 2 {
        let entry = |s: &Section| format!("- [{}](#{}){}", escape::markdown(&s.heading), s.id, mark_of(s));
        let entries = page.sections.iter().map(entry);
        out.push(entries.collect::<Vec<_>>().join("\n"));
    }
    for section in &page.sections {
        // An anchor of our own: those made from headings change with every word.
        out.push(format!("<a id=\"{}\"></a>", section.id));
        out.push(format!("## {}{}", escape::markdown(&section.heading), mark_of(section)));
        for block in &section.blocks {
            out.push(write_block(block, &mut written)?);
        }
    }
    if !page.footer.is_empty() {
        out.push("---".to_owned());
        out.extend(running(&page.footer));
    }
    out.retain(|part| !part.is_empty());
    Ok(format!("{}\n", out.join("\n\n")))
}

/// The name of the page's files, and the tables that were written so far.
struct Written<'a> {
    files: Option<&'a str>,
    tables: usize,
}

/// How a section ended, as the end of its heading.
fn mark_of(section: &Section) -> String {
    section.mood.map(|mood| format!(" {}", mood.mark())).unwrap_or_default()
}

/// The paragraphs of a text.
fn running(text: &str) -> Vec<String> {
    paragraphs(text).iter().map(|p| to_markdown(p)).collect()
}

fn callout(mood: Mood, text: &str) -> String {
    let kind = match mood {
        Mood::Pass => "TIP",
        Mood::Fail => "CAUTION",
        Mood::Note => "NOTE",
    };
    let lines: Vec<String> = running(text).iter().map(|p| format!("> {p}")).collect();
    format!("> [!{kind}]\n{}", lines.join("\n>\n"))
}

fn write_table(table: &Table, written: &mut Written<'_>) -> Result<String, RenderError> {
    written.tables += 1;
    let file = written.files.map(|page| table_file(page, written.tables));
    let (shown, rest) = shown_rows(table, file.as_deref());
    let table = shown.to_markdown()?.trim_end().to_owned();
    Ok(std::iter::once(table).chain(rest).collect::<Vec<_>>().join("\n\n"))
}

fn write_block(block: &Block, written: &mut Written<'_>) -> Result<String, RenderError> {
    Ok(match block {
        Block::Paragraph(text) => running(text).join("\n\n"),
        Block::Heading(text) => format!("### {}", escape::markdown(text)),
        Block::List(points) => {
            let point = |p: &String| format!("- {}", to_markdown(&paragraphs(p).join(" ")));
            points.iter().map(point).collect::<Vec<_>>().join("\n")
        }
        Block::Table(table) => write_table(table, written)?,
        Block::Figure(figure) => write_figure(figure),
        Block::Figures(figures) => figures.iter().map(write_figure).collect::<Vec<_>>().join("\n\n"),
        Block::Callout(mood, text) => callout(*mood, text),
        Block::Details { summary, blocks } => {
            let inside =
                blocks.iter().map(|block| write_block(block, written)).collect::<Result<Vec<_>, _>>()?;
            let inside = inside.join("\n\n");
            format!("<details>\n<summary>{}</summary>\n\n{inside}\n\n</details>", escape::html(summary))
        }
    })
}

fn write_figure(figure: &Figure) -> String {
    let image = format!("![{}](figures/{}.svg)", escape::markdown(&figure.chart.title), figure.name);
    let caption = running(&figure.caption);
    if caption.is_empty() { image } else { format!("{image}\n\n{}", caption.join("\n\n")) }
}
