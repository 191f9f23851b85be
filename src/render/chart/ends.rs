//! Names at the ends of lines, right of the plot, moved apart where they would overlap.

use crate::render::chart::draw::Layout;
use crate::render::chart::svg::{Font, group, layer, write};
use crate::render::chart::{Chart, Style};
use crate::render::script::width;
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

const FONT: f64 = 12.0;
/// Least distance of two names, px.
const APART: f64 = 14.0;
/// Gap between the plot and the names, px.
const GAP: f64 = 8.0;

/// The room that the names need beside the plot, px.
pub(super) fn end_names_width(chart: &Chart) -> f64 {
    if !chart.names_at_ends {
        return 0.0;
    }
    let named = chart.series.iter().filter(|series| series.style != Style::Context);
    GAP + named.map(|series| FONT * width(&series.name)).fold(0.0, f64::max)
}

/// The names, each in the colour of its line and at the height of its last point.
pub(super) fn end_names(chart: &Chart, layout: &Layout) -> Result<String, String> {
    if !chart.names_at_ends {
        return Ok(String::new());
    }
    let series = chart.series.iter().zip(&layout.looks).zip(&layout.points);
    let mut ends: Vec<(f64, &str, RGBColor)> = series
        .filter(|((series, _), _)| series.style != Style::Context && !series.name.is_empty())
        .filter_map(|((series, look), places)| {
            Some((places.iter().flatten().next_back()?.1, series.name.as_str(), look.colour))
        })
        .collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let heights = apart(&ends.iter().map(|end| end.0).collect::<Vec<_>>(), layout.plot.bottom);
    let drawn = layer(layout.size, |area| {
        for ((_, name, colour), height) in ends.iter().zip(heights) {
            let font = Font { size: FONT, colour: *colour, is_bold: true };
            write(area, name, (layout.plot.right + GAP, height), font, HPos::Left)?;
        }
        Ok(())
    })?;
    Ok(group("", "", &drawn))
}

/// Heights in rising order, moved so that neighbours keep their distance and none lies below a bottom.
fn apart(heights: &[f64], bottom: f64) -> Vec<f64> {
    let mut moved: Vec<f64> = Vec::new();
    for height in heights {
        moved.push(moved.last().map_or(*height, |above| height.max(above + APART)));
    }
    let mut lowest = bottom;
    for height in moved.iter_mut().rev() {
        *height = height.min(lowest);
        lowest = *height - APART;
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::{ChartAxis, Series};

    #[test]
    fn names_at_the_ends_of_lines_keep_their_distance_and_stay_above_the_bottom() {
        assert_eq!(apart(&[10.0, 12.0, 80.0], 100.0), [10.0, 24.0, 80.0]);
        assert_eq!(apart(&[96.0, 98.0, 99.0], 100.0), [72.0, 86.0, 100.0]);
        let line = |name: &str, end: f64| Series::new(name, vec![(1.0, 0.0), (10.0, end)]).style(Style::Line);
        let mut chart = Chart::new("t", ChartAxis::log10("x"), ChartAxis::linear("y"))
            .with(line("upper", 0.9))
            .with(line("grey", 0.5).style(Style::Context));
        chart.names_at_ends = true;
        let svg = chart.svg().expect("a figure");
        // Written beside the plot and at the line; the grey one only when one points at it.
        assert_eq!(
            (svg.matches(">upper</text>").count(), svg.matches("<title>grey</title>").count()),
            (1, 1),
            "{svg}"
        );
        assert!(!svg.contains(">grey</text>"), "{svg}");
    }
}
