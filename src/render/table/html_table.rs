//! Tables as fragments of HTML.
use crate::render::escape::{html, plain_html};
use crate::render::render_error::RenderError;
use crate::render::table::{Align, Cell, Table, marked};
use std::fmt::Write as _;

impl Table {
    /// A fragment of HTML.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_html(&self) -> Result<String, RenderError> {
        self.check()?;
        let footnotes = self.footnotes();
        let mut out = String::from("<div class=\"table\">\n<table>\n");
        if !self.title.is_empty() {
            let _ = writeln!(out, "<caption>{}</caption>", html(&self.title));
        }
        out.push_str("<thead>\n<tr>");
        for column in &self.columns {
            let unit =
                column.unit.as_ref().map(|u| format!(" <small>{}</small>", html(u))).unwrap_or_default();
            let _ = write!(
                out,
                "<th scope=\"col\" class=\"{}\">{}{unit}</th>",
                class(column.align),
                html(&column.header)
            );
        }
        out.push_str("</tr>\n</thead>\n<tbody>\n");
        for row in &self.rows {
            out.push_str("<tr>");
            for (cell, column) in row.iter().zip(&self.columns) {
                let value = cell.value().map_or(String::new(), |value| format!(" data-v=\"{value:.5e}\""));
                let shown = show(cell, &footnotes);
                let long = if is_long(cell) { " long" } else { "" };
                let _ = write!(out, "<td class=\"{}{long}\"{value}>{shown}</td>", class(column.align));
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody>\n</table>\n</div>\n");
        for (mark, note) in self.lines_below() {
            let mark = mark.map(|mark| format!("<sup>{mark}</sup> ")).unwrap_or_default();
            let _ = writeln!(out, "<p class=\"small\">{mark}{}</p>", html(note));
        }
        Ok(out)
    }
}

/// Letters from which on a cell is a sentence, which must not be squeezed into a column of single words.
const LONG: usize = 60;

fn is_long(cell: &Cell) -> bool {
    matches!(cell, Cell::Text(text) if text.chars().count() > LONG)
}

fn class(align: Align) -> &'static str {
    match align {
        Align::Left => "l",
        Align::Right => "r",
    }
}

fn show(cell: &Cell, footnotes: &[&str]) -> String {
    match (cell, marked(cell, footnotes)) {
        (Cell::Code(name), _) => format!("<code>{}</code>", plain_html(name)),
        (Cell::Text(text), _) => html(text),
        (Cell::Link { words, target }, _) => {
            format!("<a href=\"{}\">{}</a>", plain_html(target), html(words))
        }
        (Cell::Verdict(mood, text), _) => {
            format!("<span class=\"{}\">{} {}</span>", mood.class(), mood.mark(), html(text))
        }
        (Cell::Evidence { mood, words, target }, _) => format!(
            "<a class=\"{}\" href=\"{}\">{} {}</a>",
            mood.class(),
            plain_html(target),
            mood.mark(),
            html(words)
        ),
        (Cell::Missing(reason), (text, mark)) => {
            let mark = mark.map(|m| format!("<sup>{m}</sup>")).unwrap_or_default();
            format!("<span class=\"missing\" title=\"{}\">{text}{mark}</span>", plain_html(reason))
        }
        // The hyphen of a negative number, not the one in its exponent.
        (_, (text, _)) => match text.strip_prefix('-') {
            Some(rest) => format!("−{}", plain_html(rest)),
            None => plain_html(&text),
        },
    }
}
