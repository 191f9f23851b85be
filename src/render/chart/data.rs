//! What a figure draws, as rows of numbers.
use crate::render::chart::describe::Chart;
use crate::render::escape::csv_field;
use crate::render::number;
use std::fmt::Write;

impl Chart {
    /// The data of the figure as CSV: one row a point of a series, with all of its digits; of a field one row a
    /// cell, at its middle.
    pub fn data_csv(&self) -> String {
        let quoted = |text: &str| format!("\"{}\"", csv_field(text).replace('"', "\"\""));
        let mut out = format!("series,{},{}", quoted(&self.x.label), quoted(&self.y.label));
        if let Some(field) = &self.field {
            let _ = write!(out, ",{}", quoted(&field.label));
        }
        out.push('\n');
        for series in &self.series {
            for (x, y) in &series.points {
                let end = if self.field.is_some() { "," } else { "" };
                let _ = writeln!(
                    out,
                    "{},{},{}{end}",
                    quoted(&series.name),
                    number::exact(*x),
                    number::exact(*y)
                );
            }
        }
        if let Some((field, (columns, rows))) =
            self.field.as_ref().and_then(|field| Some((field, field.shape()?)))
        {
            let middle = |edges: &[f64], at: usize| number::exact(f64::midpoint(edges[at], edges[at + 1]));
            for row in 0..rows {
                for column in 0..columns {
                    let value = number::exact(field.values[row * columns + column]);
                    let (x, y) = (middle(&field.x_edges, column), middle(&field.y_edges, row));
                    let _ = writeln!(out, "{},{x},{y},{value}", quoted(&self.title));
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use crate::render::chart::describe::{Chart, ChartAxis, Series};
    use crate::render::chart::field::ColourField;

    #[test]
    fn every_point_and_every_cell_has_a_row() {
        let mut chart = Chart::new("f", ChartAxis::linear("x, m"), ChartAxis::linear("y"))
            .with(Series::new("a \"b\"", vec![(0.1, 2.0), (0.3, 4.0)]));
        assert_eq!(
            chart.data_csv(),
            "series,\"x, m\",\"y\"\n\"a \"\"b\"\"\",0.1,2.0\n\"a \"\"b\"\"\",0.3,4.0\n"
        );
        let (x_edges, y_edges) = (vec![0.0, 1.0, 2.0], vec![0.0, 2.0]);
        chart.field = Some(ColourField {
            label: "p".to_owned(),
            reach: None,
            x_edges,
            y_edges,
            values: vec![5.0, 6.0],
        });
        assert!(chart.data_csv().ends_with("\"f\",0.5,1.0,5.0\n\"f\",1.5,1.0,6.0\n"), "{}", chart.data_csv());
    }
}
