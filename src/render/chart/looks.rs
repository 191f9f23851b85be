//! Markers and dashes by number, and the legend. Any two of the first six series differ in all three, so that
//! the colour-blind and readers of grey paper can tell them apart.
use crate::case::grouping::distinct;
use crate::render::chart::svg::{
    Area, Drawn, Font, Px, group, layer, line, polygon, spot, stroke, units, write,
};
use crate::render::chart::{Chart, Series, Style};
use crate::render::palette::colour_and_shape;
use crate::render::palette::slots;
use crate::render::palette::{FRAME, SCREEN, SERIES, TEXT, THEORY};
use crate::render::script::{width, wrap};
use plotters::element::Circle;
use plotters::prelude::{Color, RGBColor};
use plotters::style::text_anchor::HPos;

/// Lengths of dashes and gaps in drawing units.
const DASHES: [&str; 7] = ["", "75 35", "22 28", "95 30 22 30", "105 25", "60 25 20 25 20 25", "40 30"];

/// How a series looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Look {
    pub colour: RGBColor,
    pub is_theory: bool,
    pub has_line: bool,
    dash: &'static str,
    pub marker: Option<usize>,
}

impl Look {
    /// Line width, px.
    pub fn width(&self) -> f64 {
        match self.colour {
            colour if colour == FRAME.light => 1.0,
            _ if self.is_theory => 1.7,
            _ => 1.5,
        }
    }

    /// Attributes of the group of its lines.
    pub fn line_attributes(&self) -> String {
        let dash =
            if self.dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", self.dash) };
        format!(" stroke-linejoin=\"round\"{dash}")
    }
}

/// The looks of all series, in their order. Where no number is given it is that of the name, so that a method looks
/// the same at every time.
pub(super) fn looks(chart: &Chart) -> Vec<Look> {
    let names = |is_theory: bool| {
        let series = chart.series.iter().filter(|series| series.style != Style::Context);
        distinct(
            series.filter(|series| (series.style == Style::Theory) == is_theory).map(|series| &*series.name),
        )
    };
    let (theory, computed) = (names(true), names(false));
    let slots = slots(&computed);
    let look = |series: &Series| {
        let place = |names: &[&str]| names.iter().position(|name| *name == series.name).unwrap_or_default();
        let by_name = if series.style == Style::Theory {
            place(&theory)
        } else {
            slots.get(place(&computed)).copied().unwrap_or_default()
        };
        look(series, series.slot.unwrap_or(by_name))
    };
    chart.series.iter().map(look).collect()
}

/// How a series with this number looks.
fn look(series: &Series, slot: usize) -> Look {
    Look {
        colour: match series.style {
            Style::Theory => THEORY.light,
            Style::Context => FRAME.light,
            _ => SERIES[colour_and_shape(slot).0].light,
        },
        is_theory: series.style == Style::Theory,
        has_line: series.style != Style::Markers,
        dash: if series.style == Style::Context { "" } else { DASHES[slot % DASHES.len()] },
        marker: matches!(series.style, Style::Markers | Style::LineAndMarkers)
            .then_some(series.marker.unwrap_or(slot)),
    }
}

/// Outline of a marker of unit size; empty for a disc.
fn outline(shape: usize) -> Vec<Px> {
    // An arm and its copies turned by one, two and three right angles.
    let four_arms = |arm: [Px; 3]| {
        let turned = |arm: &[Px; 3]| Some(arm.map(|(x, y)| (-y, x)));
        std::iter::successors(Some(arm), turned).take(4).flatten().collect()
    };
    match shape {
        1 => vec![(-0.88, -0.88), (0.88, -0.88), (0.88, 0.88), (-0.88, 0.88)],
        2 => vec![(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
        3 => vec![(0.0, -1.3), (1.05, 0.0), (0.0, 1.3), (-1.05, 0.0)],
        4 => vec![(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
        5 => four_arms([(-0.36, -1.2), (0.36, -1.2), (0.36, -0.36)]),
        6 => four_arms([(-1.1, -0.6), (-0.6, -1.1), (0.0, -0.5)]),
        _ => Vec::new(),
    }
}

/// Draws the marker of a slot.
pub(super) fn draw_marker(area: &Area<'_>, at: Px, slot: usize, radius: f64, colour: RGBColor) -> Drawn {
    let (_, shape, is_hollow) = colour_and_shape(slot);
    let shape = outline(shape);
    // A thin white edge keeps neighbours apart.
    let layers = [
        (radius + 0.7, SCREEN.light.mix(0.9)),
        (radius, colour.to_rgba()),
        (radius * 0.55, SCREEN.light.to_rgba()),
    ];
    for (radius, colour) in layers.into_iter().take(if is_hollow { 3 } else { 2 }) {
        if shape.is_empty() {
            area.draw(&Circle::new(spot(at), units(radius), colour.filled()))?;
        } else {
            let corners: Vec<Px> =
                shape.iter().map(|(x, y)| (at.0 + radius * x, at.1 + radius * y)).collect();
            polygon(area, &corners, colour)?;
        }
    }
    Ok(())
}

pub(super) const FONT: Font = Font { size: 12.0, colour: TEXT.light, is_bold: false };
/// Width of the sample of a line, and of the gap behind it, px.
const SAMPLE: f64 = 34.0;
const GAP: f64 = 8.0;
const ROW: f64 = 19.0;
/// Height of a further line of a name, px.
const LINE: f64 = 14.0;
const BETWEEN_COLUMNS: f64 = 22.0;

/// The legend below the plot, in columns of equal width; a name that is wider than those of most takes more than one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Legend {
    entries: Vec<(Look, Vec<String>)>,
    /// `[entry] = (row, column)`.
    places: Vec<(usize, usize)>,
    column_width: f64,
    row: f64,
}

impl Legend {
    /// The legend of the series that have something drawn, within so many pixels.
    pub fn of(chart: &Chart, looks: &[Look], is_drawn: impl Fn(usize) -> bool, room: f64) -> Self {
        let mut seen: Vec<(Look, &str)> = Vec::new();
        let in_legend = |series: &Series| !chart.names_at_ends && series.style != Style::Context;
        for (place, (series, look)) in
            chart.series.iter().zip(looks).enumerate().filter(|(_, (one, _))| in_legend(one))
        {
            let entry = (*look, series.name.as_str());
            if is_drawn(place) && !series.name.is_empty() && !seen.contains(&entry) {
                seen.push(entry);
            }
        }
        let most = (room - SAMPLE - GAP) / FONT.size;
        let entries: Vec<_> = seen.into_iter().map(|(look, name)| (look, wrap(name, most))).collect();
        let width_of = |(_, lines): &(Look, Vec<String>)| {
            lines.iter().map(|line| width(line) * FONT.size).fold(0.0, f64::max)
        };
        // The name of the theory is a sentence; it does not make the columns of the others wide.
        let narrow = entries.iter().filter(|(look, _)| !look.is_theory).map(width_of);
        let widest =
            narrow.reduce(f64::max).unwrap_or_else(|| entries.iter().map(width_of).fold(0.0, f64::max));
        let column_width = SAMPLE + GAP + widest + BETWEEN_COLUMNS;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few columns")]
        let whole = |columns: f64| columns.max(1.0) as usize;
        let columns = whole(((room + BETWEEN_COLUMNS) / column_width).floor());
        let (mut row, mut column) = (0, 0);
        let mut places = Vec::new();
        for entry in &entries {
            let needed = SAMPLE + GAP + width_of(entry) + BETWEEN_COLUMNS;
            let span = whole((needed / column_width).ceil()).min(columns);
            if column + span > columns {
                (row, column) = (row + 1, 0);
            }
            places.push((row, column));
            column += span;
        }
        let tallest = entries.iter().map(|(_, lines)| lines.len()).max().unwrap_or(1).max(1);
        Self { entries, places, column_width, row: ROW + LINE * (tallest - 1) as f64 }
    }

    pub fn height(&self) -> f64 {
        self.places.last().map_or(0.0, |(row, _)| (row + 1) as f64 * self.row)
    }

    /// The elements of the legend with its upper left corner at a place.
    pub fn elements(&self, size: Px, corner: Px) -> Result<String, String> {
        let mut out = String::new();
        for ((look, lines), (row, column)) in self.entries.iter().zip(&self.places) {
            let x = corner.0 + *column as f64 * self.column_width;
            let y = corner.1 + *row as f64 * self.row + ROW / 2.0;
            let mut entry = String::new();
            if look.has_line {
                let style = stroke(look.colour, look.width());
                let sample = layer(size, |area| line(area, &[(x, y), (x + SAMPLE, y)], style))?;
                entry += &group(&look.line_attributes(), "", &sample);
            }
            entry += &layer(size, |area| {
                if let Some(slot) = look.marker {
                    draw_marker(area, (x + SAMPLE / 2.0, y), slot, 4.0, look.colour)?;
                }
                for (row, words) in lines.iter().enumerate() {
                    write(area, words, (x + SAMPLE + GAP, y + LINE * row as f64), FONT, HPos::Left)?;
                }
                Ok(())
            })?;
            // The script of a page hides the series of a name by a click on its entry.
            out += &group(" class=\"key\"", &lines.join(" "), &entry);
        }
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::{ChartAxis, Series};

    #[test]
    fn the_first_slots_differ_in_colour_dash_and_shape() {
        for a in 0..7 {
            for b in 0..a {
                assert_ne!(SERIES[a].light, SERIES[b].light);
                assert_ne!(DASHES[a], DASHES[b]);
                assert_ne!(outline(a), outline(b));
            }
        }
    }

    #[test]
    fn markers_are_full_for_seven_slots_and_hollow_for_the_next_seven() {
        let drawn = |slot: usize| {
            let marker = |area: &Area<'_>| draw_marker(area, (10.0, 10.0), slot, 4.0, SERIES[0].light);
            layer((20.0, 20.0), marker).expect("a marker")
        };
        for slot in 0..7 {
            let [full, hollow] = [drawn((slot + 1) % 7), drawn(slot + 7)];
            let hole = hollow.strip_prefix(&full).expect("the full marker with a hole in it");
            assert_eq!((full.matches("/>").count(), hole.matches("/>").count()), (2, 1), "{hollow}");
            assert!(hole.contains("#FFFFFF"), "{hole}");
            assert_eq!(drawn(slot + 14), drawn((slot + 2) % 7), "full again");
        }
    }

    #[test]
    fn a_wide_name_of_the_theory_takes_columns_instead_of_widening_all() {
        let mut chart = Chart::new("", ChartAxis::linear("x"), ChartAxis::linear("y"))
            .with(Series::theory("a solution with a name as long as a sentence", vec![]));
        for name in ["a", "b", "c", "d"] {
            chart = chart.with(Series::new(name, vec![]));
        }
        let places = |room: f64| Legend::of(&chart, &looks(&chart), |_| true, room).places;
        assert_eq!(places(450.0), [(0, 0), (0, 5), (1, 0), (1, 1), (1, 2)]);
        assert_eq!(places(120.0), [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0)]);
    }

    #[test]
    fn a_name_has_one_look_and_one_entry() {
        let chart = Chart::new("", ChartAxis::linear("x"), ChartAxis::linear("y"))
            .with(Series::theory("exact", vec![]))
            .with(Series::new("a", vec![]))
            .with(Series::new("b", vec![]))
            .with(Series::theory("exact", vec![]))
            .with(Series::new("a", vec![]))
            .with(Series::theory("other", vec![]));
        let looks = looks(&chart);
        assert_eq!(looks[1], looks[4]);
        assert_eq!(looks[0], looks[3]);
        assert_ne!(looks[1], looks[2]);
        assert!(
            looks[0].colour == THEORY.light
                && looks[5].colour == THEORY.light
                && looks[0].dash != looks[5].dash
        );
        assert_eq!(Legend::of(&chart, &looks, |_| true, 500.0).entries.len(), 4);
    }
}
