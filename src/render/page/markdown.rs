//! Pages and blocks as GitHub's Markdown, with the figures beside it.

use crate::render::RenderError;
use crate::render::escape;
use crate::render::marked_text::{paragraphs, to_markdown};
use crate::render::page::contents::check;
use crate::render::page::walk::{Group, Walk, Writer};
use crate::render::page::{Block, Figure, Page, Section, shown_rows};
use crate::render::table::{Mood, Table};

/// The page as Markdown. Its figures are at `figures/NAME.svg`, as `figures` lists them, and its links to pages of the
/// report lead to their Markdown form.
///
/// # Errors
/// If a name is unusable or used twice, or a table is ragged.
pub fn render_markdown(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let link = |(words, target): &(String, String)| format!("[{words}]({target})");
    let links = page.links.iter().map(link).collect::<Vec<_>>().join(" · ");
    let mut out =
        Markdown(vec![marked(&links), format!("# {}", escape::markdown(&page.title)), marked(&page.lead)]);
    out.0.extend(page.callout.as_ref().map(|(mood, text)| callout(*mood, text)));
    if page.sections.len() > 2 && (!page.is_wide || page.links.is_empty()) {
        let entry =
            |one: &Section| format!("- [{}](#{}){}", escape::markdown(&one.heading), one.id, mark(one));
        out.0.push(page.sections.iter().map(entry).collect::<Vec<_>>().join("\n"));
    }
    Walk::page(page, &mut out)?;
    if !page.footer.is_empty() {
        out.0.extend(["---".to_owned(), marked(&page.footer)]);
    }
    out.0.retain(|part| !part.is_empty());
    Ok(format!("{}\n", out.0.join("\n\n")))
}

/// Blocks as Markdown, without files.
///
/// # Errors
/// If a table is ragged.
pub fn markdown_of(blocks: &[Block]) -> Result<String, RenderError> {
    let mut out = Markdown(Vec::new());
    Walk::default().blocks(blocks, &mut out)?;
    Ok(out.0.join("\n\n") + "\n")
}

fn mark(section: &Section) -> String {
    section.mood.map(|mood| format!(" {}", mood.mark())).unwrap_or_default()
}

/// The paragraphs of a lightly marked text.
fn marked(text: &str) -> String {
    paragraphs(text).iter().map(|paragraph| to_markdown(paragraph)).collect::<Vec<_>>().join("\n\n")
}

fn callout(mood: Mood, text: &str) -> String {
    let kind = match mood {
        Mood::Pass => "TIP",
        Mood::Fail => "CAUTION",
        Mood::Note => "NOTE",
    };
    format!("> [!{kind}]\n> {}", marked(text).replace("\n\n", "\n>\n> "))
}

/// Parts with an empty line between them.
struct Markdown(Vec<String>);

impl<'a> Writer<'a> for Markdown {
    fn paragraph(&mut self, text: &'a str) {
        self.0.push(marked(text));
    }

    fn code(&mut self, lines: &'a str) {
        self.0.push(format!("```\n{}\n```", lines.trim_end()));
    }

    fn heading(&mut self, words: &'a str) {
        self.0.push(format!("### {}", escape::markdown(words)));
    }

    fn list(&mut self, points: &'a [String]) {
        let point = |point: &String| format!("- {}", to_markdown(&paragraphs(point).join(" ")));
        self.0.push(points.iter().map(point).collect::<Vec<_>>().join("\n"));
    }

    fn table(&mut self, table: &'a Table, file: Option<String>) -> Result<(), RenderError> {
        let (shown, rest) = shown_rows(table, file.as_deref());
        self.0.push(shown.to_markdown()?.trim_end().to_owned());
        self.0.extend(rest);
        Ok(())
    }

    fn figure(&mut self, figure: &'a Figure, _: Option<usize>) -> Result<(), RenderError> {
        let title = escape::markdown(&figure.chart.title);
        self.0.push(format!("![{title}](figures/{}.svg)", figure.name));
        self.0.extend(Some(marked(&figure.caption)).filter(|caption| !caption.is_empty()));
        Ok(())
    }

    fn open(&mut self, group: &Group<'a>) -> bool {
        match group {
            // An anchor of our own: those made from headings change with every word.
            Group::Section(section) => self.0.extend([
                format!("<a id=\"{}\"></a>", section.id),
                format!("## {}{}", escape::markdown(&section.heading), mark(section)),
            ]),
            Group::View(place, word) => {
                // The first one is seen at once.
                let open = if *place == 0 { " open" } else { "" };
                self.0.push(format!("<details{open}>\n<summary>{}</summary>", escape::html(word)));
            }
            Group::Details(summary) => {
                self.0.push(format!("<details>\n<summary>{}</summary>", escape::html(summary)));
            }
            _ => {}
        }
        true
    }

    fn close(&mut self, group: &Group<'a>) {
        if let Group::View(..) | Group::Details(_) = group {
            self.0.push("</details>".to_owned());
        }
    }
}
