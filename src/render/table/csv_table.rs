//! Tables for machines.
use crate::render::escape::csv_field;
use crate::render::number;
use crate::render::render_error::RenderError;
use crate::render::table::{Cell, Table};

impl Table {
    /// For machines: numbers with all of their digits, shares as shares, times in seconds, an empty
    /// field for what is missing; an order's interval has a column of its own. Words that a spreadsheet would take for
    /// a formula stand behind an apostrophe.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_csv(&self) -> Result<String, RenderError> {
        self.csv_with(|words| csv_field(words).into_owned())
    }

    /// The same with every word as it is, for what is no spreadsheet.
    ///
    /// # Errors
    /// If a row has too few or too many cells.
    pub fn to_plain_csv(&self) -> Result<String, RenderError> {
        self.csv_with(str::to_owned)
    }

    fn csv_with(&self, words: impl Fn(&str) -> String) -> Result<String, RenderError> {
        self.check()?;
        let fail = |reason: String| RenderError::Csv { title: self.title.clone(), reason };
        let wide: Vec<bool> = (0..self.columns.len())
            .map(|i| self.rows.iter().any(|row| matches!(row[i], Cell::OrderWithin(..))))
            .collect();
        let mut writer = ::csv::Writer::from_writer(Vec::new());
        let mut header = Vec::new();
        for (column, &wide) in self.columns.iter().zip(&wide) {
            header.push(words(&column.heading()));
            if wide {
                header.push(words(&format!("{} ±", column.heading())));
            }
        }
        writer.write_record(&header).map_err(|e| fail(e.to_string()))?;
        for row in &self.rows {
            let mut fields = Vec::new();
            for (cell, &wide) in row.iter().zip(&wide) {
                let (value, half) = show(cell, &words);
                fields.push(value);
                if wide {
                    fields.push(half);
                }
            }
            writer.write_record(&fields).map_err(|e| fail(e.to_string()))?;
        }
        let bytes = writer.into_inner().map_err(|e| fail(e.to_string()))?;
        String::from_utf8(bytes).map_err(|e| fail(e.to_string()))
    }
}

fn show(cell: &Cell, written: impl Fn(&str) -> String) -> (String, String) {
    let value = match cell {
        Cell::Text(text)
        | Cell::Code(text)
        | Cell::Verdict(_, text)
        | Cell::Link { words: text, .. }
        | Cell::Evidence { words: text, .. } => written(text),
        Cell::Error(v) | Cell::Order(v) | Cell::Percent(v) | Cell::Seconds(v) | Cell::Number(v) => {
            number::exact(*v)
        }
        Cell::OrderWithin(v, half) => return (number::exact(*v), number::exact(*half)),
        Cell::Count(n) => n.to_string(),
        Cell::Missing(_) => String::new(),
    };
    (value, String::new())
}
