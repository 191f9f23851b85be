//! Tables for a terminal, without colours.
use crate::render::escape::one_line as line;
use crate::render::render_error::RenderError;
use crate::render::table::{Align, Table, marked};
use comfy_table::{CellAlignment, ContentArrangement};

impl Table {
    /// For a terminal.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_text(&self) -> Result<String, RenderError> {
        self.check()?;
        let footnotes = self.footnotes();
        let mut grid = comfy_table::Table::new();
        grid.load_style(comfy_table::presets::ASCII_MARKDOWN);
        grid.set_content_arrangement(ContentArrangement::Disabled);
        grid.set_header(self.columns.iter().map(|c| line(&c.heading())));
        for row in &self.rows {
            grid.add_row(row.iter().map(|cell| match marked(cell, &footnotes) {
                (text, Some(mark)) => format!("{} [{mark}]", line(&text)),
                (text, None) => line(&text),
            }));
        }
        for (i, column) in self.columns.iter().enumerate() {
            let align = match column.align {
                Align::Left => CellAlignment::Left,
                Align::Right => CellAlignment::Right,
            };
            if let Some(c) = grid.column_mut(i) {
                c.set_cell_alignment(align);
            }
        }
        let mut out = String::new();
        if !self.title.is_empty() {
            out.push_str(&line(&self.title));
            out.push_str("\n\n");
        }
        for row in grid.lines() {
            out.push_str(row.trim_end());
            out.push('\n');
        }
        let marked_line = |(mark, note): (Option<String>, &str)| {
            mark.map(|mark| format!("[{mark}] ")).unwrap_or_default() + &line(note)
        };
        let notes: Vec<String> = self.lines_below().into_iter().map(marked_line).collect();
        if !notes.is_empty() {
            out.push('\n');
            out.push_str(&notes.join("\n"));
            out.push('\n');
        }
        Ok(out)
    }
}
