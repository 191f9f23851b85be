//! Tables for papers: `tabular` with the rules of the package `booktabs`.
use crate::render::escape::{latex, latex_text};
use crate::render::render_error::RenderError;
use crate::render::table::{Align, Cell, Table, marked};
use std::fmt::Write as _;

impl Table {
    /// For LaTeX with `booktabs`; the title and the lines below as comments, for a caption of one's own.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_latex(&self) -> Result<String, RenderError> {
        self.check()?;
        let footnotes = self.footnotes();
        let mut out = String::new();
        if !self.title.is_empty() {
            let _ = writeln!(out, "% {}", one_line(&self.title));
        }
        let aligned = self.columns.iter().map(|column| match column.align {
            Align::Left => 'l',
            Align::Right => 'r',
        });
        let _ = writeln!(out, "\\begin{{tabular}}{{{}}}\n\\toprule", aligned.collect::<String>());
        let heads: Vec<String> = self.columns.iter().map(|column| latex_text(&column.heading())).collect();
        let _ = writeln!(out, "{} \\\\\n\\midrule", heads.join(" & "));
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|cell| show(cell, &footnotes)).collect();
            let _ = writeln!(out, "{} \\\\", cells.join(" & "));
        }
        out.push_str("\\bottomrule\n\\end{tabular}\n");
        for (mark, note) in self.lines_below() {
            let mark = mark.map_or(String::new(), |mark| format!("({mark}) "));
            let _ = writeln!(out, "% {mark}{}", one_line(note));
        }
        Ok(out)
    }
}

/// A cell; numbers in powers of ten as mathematics.
fn show(cell: &Cell, footnotes: &[&str]) -> String {
    match (cell, marked(cell, footnotes)) {
        (Cell::Code(name), _) => format!("\\texttt{{{}}}", latex(name)),
        (Cell::Verdict(_, text) | Cell::Evidence { words: text, .. }, _) => latex_text(text),
        (Cell::Error(_) | Cell::Number(_), (text, _)) => power(&text),
        (_, (text, Some(mark))) => format!("{}\\textsuperscript{{{mark}}}", latex_text(&text)),
        (_, (text, None)) => latex_text(&text),
    }
}

/// `3.62e-3` as `$3.62\\cdot10^{-3}$`.
fn power(text: &str) -> String {
    let plain = text.replace('−', "-");
    match plain.split_once('e') {
        Some((digits, exponent)) if exponent.parse::<i32>().is_ok() => {
            format!("${digits}\\cdot10^{{{exponent}}}$")
        }
        _ if plain.parse::<f64>().is_ok() => format!("${plain}$"),
        _ => latex(text),
    }
}

/// A comment ends with its line.
fn one_line(text: &str) -> String {
    text.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::table::columns;

    #[test]
    fn a_table_for_a_paper_has_its_rules_its_powers_and_no_bare_specials() {
        let row = vec![
            Cell::Code("a_b".into()),
            Cell::Error(3.62e-3),
            Cell::Percent(0.05),
            Cell::missing("no run"),
        ];
        let latex = Table::of("T", columns("m | > e | > share | > x"), [row]).to_latex().expect("a table");
        assert!(latex.contains("\\begin{tabular}{lrrr}\n\\toprule\n"), "{latex}");
        assert!(
            latex.contains("\\texttt{a\\_b} & $3.62\\cdot10^{-3}$ & 5.00 \\% & –\\textsuperscript{a} \\\\"),
            "{latex}"
        );
        assert!(latex.contains("\\bottomrule\n\\end{tabular}\n% (a) no run"), "{latex}");
    }
}
