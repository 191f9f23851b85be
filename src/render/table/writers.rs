//! Writers of tables: text for a terminal, GitHub's Markdown, HTML, CSV and JSON.

use crate::case::method_words::method_words;
use crate::render::escape::{csv_field, html, markdown, markdown_target, one_line, plain_html};
use crate::render::marked_text::{html_code, html_with_code, markdown_with_code, wrapped};
use crate::render::table::{Align, Cell, Table, TableColumn, marked};
use crate::render::{RenderError, number};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Length in letters from which a cell of HTML is a sentence that needs a wide column.
const LONG: usize = 60;

impl Table {
    /// For a terminal of so many columns, without colours: a grid, or where that is too wide a list.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_text(&self, width: usize) -> Result<String, RenderError> {
        self.check()?;
        let (footnotes, powers) = (self.footnotes(), self.powers());
        let cell = |(cell, has_power): (&Cell, &bool)| match marked(cell, &footnotes, *has_power) {
            (text, Some(mark)) => format!("{} [{mark}]", one_line(&text)),
            (text, None) => one_line(&text),
        };
        let heads: Vec<String> = self.columns.iter().map(|column| one_line(&column.heading())).collect();
        let rows: Vec<Vec<String>> =
            self.shown_rows().iter().map(|row| row.iter().zip(&powers).map(cell).collect()).collect();
        let mut out =
            if self.title.is_empty() { String::new() } else { wrapped(&self.title, "", "  ", width) };
        let grid = grid(&self.columns, &heads, &rows, self.file.is_some());
        if grid.iter().all(|line| line.chars().count() <= width) {
            out.extend(grid.into_iter().map(|line| line + "\n"));
        } else {
            for row in &rows {
                let others = heads.iter().zip(row).skip(1).filter(|(_, cell)| !cell.is_empty());
                let others: Vec<String> = others.map(|(head, cell)| format!("{head} {cell}")).collect();
                out += &wrapped(&row[0], "  ", "    ", width);
                out += &wrapped(&others.join("; "), "    ", "    ", width);
            }
        }
        for (mark, note) in self.lines_below() {
            let mark = mark.map(|mark| format!("[{mark}] ")).unwrap_or_default();
            out += &wrapped(&format!("{mark}{note}"), "", "  ", width);
        }
        Ok(out)
    }

    /// For GitHub's Markdown.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_markdown(&self) -> Result<String, RenderError> {
        self.check()?;
        let (footnotes, powers) = (self.footnotes(), self.powers());
        let mut out = String::new();
        if !self.title.is_empty() {
            let _ = write!(out, "**{}**\n\n", markdown(&self.title));
        }
        let mut row = |cells: Vec<String>| {
            let _ = writeln!(out, "| {} |", cells.join(" | "));
        };
        row(self.columns.iter().map(|column| markdown(&column.heading())).collect());
        let rule = |align| if align == Align::Left { ":---" } else { "---:" };
        row(self.columns.iter().map(|column| rule(column.align).to_owned()).collect());
        for cells in self.shown_rows() {
            let cell = |(cell, has_power): (&Cell, &bool)| in_markdown(cell, &footnotes, *has_power);
            row(cells.iter().zip(&powers).map(cell).collect());
        }
        for (mark, note) in self.lines_below() {
            let mark = mark.map(|mark| format!("<sup>{mark}</sup> ")).unwrap_or_default();
            let _ = writeln!(out, "\n{mark}{}", markdown_with_code(&note));
        }
        Ok(out)
    }

    /// A fragment of HTML.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_html(&self) -> Result<String, RenderError> {
        self.check()?;
        let (footnotes, powers) = (self.footnotes(), self.powers());
        let class = |align| if align == Align::Left { "l" } else { "r" };
        let dense = if self.is_dense() { " dense" } else { "" };
        let mut out = format!("<div class=\"table{dense}\">\n<table>\n");
        if !self.title.is_empty() {
            let _ = writeln!(out, "<caption>{}</caption>", html(&self.title));
        }
        out.push_str("<thead>\n<tr>");
        for column in &self.columns {
            let unit = column.unit.as_ref().map(|unit| format!(" <small>{}</small>", html(unit)));
            let (class, unit) = (class(column.align), unit.unwrap_or_default());
            let head = match method_words(&column.header) {
                Some(words) => {
                    format!("<abbr title=\"{}\">{}</abbr>", plain_html(&words), html(&column.header))
                }
                None => html(&column.header),
            };
            let _ = write!(out, "<th scope=\"col\" class=\"{class}\">{head}{unit}</th>");
        }
        out.push_str("</tr>\n</thead>\n<tbody>\n");
        for row in self.shown_rows() {
            out.push_str("<tr>");
            for ((cell, column), has_power) in row.iter().zip(&self.columns).zip(&powers) {
                let value = cell.value().map_or(String::new(), |value| format!(" data-v=\"{value:.5e}\""));
                let is_long = matches!(cell, Cell::Text(text) if text.chars().count() > LONG);
                let more = match cell {
                    Cell::Shaded { shade, .. } => format!(" {}", shade.class()),
                    _ => if is_long { " long" } else { "" }.to_owned(),
                };
                let class = format!("{}{more}", class(column.align));
                let words = in_html(cell, &footnotes, *has_power);
                let _ = write!(out, "<td class=\"{class}\"{value}>{words}</td>");
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody>\n</table>\n</div>\n");
        for (mark, note) in self.lines_below() {
            let mark = mark.map(|mark| format!("<sup>{mark}</sup> ")).unwrap_or_default();
            let _ = writeln!(out, "<p class=\"small\">{mark}{}</p>", html_with_code(&note));
        }
        Ok(out)
    }

    /// For machines: numbers with all digits, shares as fractions, times in seconds, an empty field for a missing value. Words that a spreadsheet would take for a formula stand
    /// behind an apostrophe.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_csv(&self) -> Result<String, RenderError> {
        self.csv_with(|words| csv_field(words).into_owned())
    }

    /// CSV for programs: every word as it is.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_plain_csv(&self) -> Result<String, RenderError> {
        self.csv_with(str::to_owned)
    }

    /// For programs: title, headings and rows; numbers with all digits, words as they are, null for a missing value.
    pub fn to_json(&self) -> Value {
        let row = |row: &Vec<Cell>| row.iter().map(in_json).collect::<Vec<Value>>();
        let columns: Vec<String> = self.columns.iter().map(TableColumn::heading).collect();
        let rows: Vec<Vec<Value>> = self.rows.iter().map(row).collect();
        json!({ "file": self.file, "title": self.title, "columns": columns, "rows": rows })
    }

    fn csv_with(&self, words: impl Fn(&str) -> String) -> Result<String, RenderError> {
        self.check()?;
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut write = || -> Result<(), csv::Error> {
            writer.write_record(self.columns.iter().map(|column| words(&column.heading())))?;
            for row in &self.rows {
                writer.write_record(row.iter().map(|cell| in_csv(cell, &words)))?;
            }
            Ok(())
        };
        let fail = |source: csv::Error| RenderError::Csv { title: self.title.clone(), source };
        write().map_err(fail)?;
        let bytes = writer.into_inner().map_err(|error| fail(error.into_error().into()))?;
        String::from_utf8(bytes).map_err(|error| fail(std::io::Error::other(error).into()))
    }
}

/// Lines of a grid: heads and rows with two blanks between columns. In an answer the first cell is not told again in the row below.
fn grid(columns: &[TableColumn], heads: &[String], rows: &[Vec<String>], is_answer: bool) -> Vec<String> {
    let width = |place: usize| {
        let cells = rows.iter().map(|row| row[place].chars().count());
        cells.chain([heads[place].chars().count()]).max().unwrap_or_default()
    };
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let cells =
            cells.into_iter().zip(&widths).zip(columns).map(|((cell, width), column)| match column.align {
                Align::Left => format!("{cell:<width$}"),
                Align::Right => format!("{cell:>width$}"),
            });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let mut lines = vec![line(heads.iter().map(String::as_str).collect())];
    for (place, row) in rows.iter().enumerate() {
        let is_told = place > 0 && columns.len() > 1 && is_answer && rows[place - 1][0] == row[0];
        let cells = row.iter().enumerate().map(|(at, cell)| if at == 0 && is_told { "" } else { cell });
        lines.push(line(cells.collect()));
    }
    lines
}

fn in_json(cell: &Cell) -> Value {
    match cell {
        Cell::Missing(_) => Value::Null,
        Cell::Count(count) => json!(count),
        Cell::Text(text) | Cell::Code(text) | Cell::Verdict(_, text) => json!(text),
        other => match other.value() {
            Some(value) if value.is_finite() => json!(value),
            _ => json!(other.show()),
        },
    }
}

fn in_markdown(cell: &Cell, footnotes: &[&str], has_power: bool) -> String {
    let link = |words: &str, target: &str| {
        format!("[{}]({})", markdown(words), markdown_target(target).replace('|', "%7C"))
    };
    match (cell, marked(cell, footnotes, has_power)) {
        (Cell::Code(name), _) => {
            // The bars of a table are escaped even within back quotes.
            let name = one_line(name).replace('|', "\\|");
            if name.contains('`') { format!("`` {name} ``") } else { format!("`{name}`") }
        }
        (Cell::Verdict(mood, text), _) => format!("{} {}", mood.mark(), markdown(text)),
        (Cell::Link { words, target }, _) => link(words, target),
        (_, (text, Some(mark))) => format!("{text} <sup>{mark}</sup>"),
        // Only words are escaped: a number may start with a minus.
        (Cell::Text(_) | Cell::Shaded { .. }, (text, None)) => markdown_with_code(&text),
        (_, (text, None)) => text,
    }
}

fn in_html(cell: &Cell, footnotes: &[&str], has_power: bool) -> String {
    match (cell, marked(cell, footnotes, has_power)) {
        (Cell::Code(name), _) => html_code(name),
        (Cell::Text(text), _) => html_with_code(text),
        (Cell::Link { words, target }, _) => {
            format!("<a href=\"{}\">{}</a>", plain_html(target), html(words))
        }
        (Cell::Verdict(mood, text), _) => {
            format!("<span class=\"{}\">{} {}</span>", mood.class(), mood.mark(), html(text))
        }
        (Cell::Shaded { words, title, target, .. }, _) => {
            let [target, title] = [target, title].map(|text| plain_html(text));
            format!("<a href=\"{target}\" title=\"{title}\">{}</a>", html(words))
        }
        (Cell::Missing(reason), (text, mark)) => {
            let mark = mark.map(|mark| format!("<sup>{mark}</sup>")).unwrap_or_default();
            format!("<span class=\"missing\" title=\"{}\">{text}{mark}</span>", plain_html(reason))
        }
        // The minus of a number, not the one in its exponent.
        (_, (text, _)) => text.strip_prefix('-').map_or_else(|| plain_html(&text), |rest| format!("−{rest}")),
    }
}

fn in_csv(cell: &Cell, words: impl Fn(&str) -> String) -> String {
    match cell {
        Cell::Text(text)
        | Cell::Code(text)
        | Cell::Verdict(_, text)
        | Cell::Link { words: text, .. }
        | Cell::Shaded { value: None, words: text, .. } => words(text),
        Cell::Count(count) => count.to_string(),
        other => other.value().map_or(String::new(), number::exact),
    }
}
