//! Tables in GitHub's Markdown.
use crate::render::escape;
use crate::render::render_error::RenderError;
use crate::render::table::{Align, Cell, Table, marked};
use std::fmt::Write as _;

impl Table {
    /// For GitHub's Markdown.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_markdown(&self) -> Result<String, RenderError> {
        self.check()?;
        let footnotes = self.footnotes();
        let mut out = String::new();
        if !self.title.is_empty() {
            let _ = write!(out, "**{}**\n\n", escape::markdown(&self.title));
        }
        let heads: Vec<String> = self.columns.iter().map(|c| escape::markdown(&c.heading())).collect();
        let rules: Vec<&str> = self
            .columns
            .iter()
            .map(|c| match c.align {
                Align::Left => ":---",
                Align::Right => "---:",
            })
            .collect();
        let row = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        out.push_str(&row(&heads));
        out.push_str(&row(&rules.iter().map(|&r| r.to_owned()).collect::<Vec<_>>()));
        for cells in &self.rows {
            let cells: Vec<String> = cells.iter().map(|cell| show(cell, &footnotes)).collect();
            out.push_str(&row(&cells));
        }
        for (mark, note) in self.lines_below() {
            let mark = mark.map(|m| format!("<sup>{m}</sup> ")).unwrap_or_default();
            let _ = writeln!(out, "\n{mark}{}", escape::markdown(note));
        }
        Ok(out)
    }
}

fn show(cell: &Cell, footnotes: &[&str]) -> String {
    match (cell, marked(cell, footnotes)) {
        (Cell::Code(name), _) => code(name),
        (Cell::Verdict(mood, text), _) => format!("{} {}", mood.mark(), escape::markdown(text)),
        (Cell::Link { words, target }, _) => link(words, target),
        (Cell::Evidence { mood, words, target }, _) => format!("{} {}", mood.mark(), link(words, target)),
        (_, (text, Some(mark))) => format!("{text} <sup>{mark}</sup>"),
        // A number may well start with a minus.
        (Cell::Text(_), (text, None)) => escape::markdown(&text),
        (_, (text, None)) => text,
    }
}

fn link(words: &str, target: &str) -> String {
    format!("[{}]({})", escape::markdown(words), target.replace('|', "%7C"))
}

/// A name in back quotes, as many as it takes; a table's bars are escaped even there.
fn code(name: &str) -> String {
    let name = escape::one_line(name).replace('|', "\\|");
    if name.contains('`') { format!("`` {name} ``") } else { format!("`{name}`") }
}
