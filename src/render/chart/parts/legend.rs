//! The legend: what it says, and how much room it needs.
use crate::render::chart::canvas::{Canvas, Hold, Px, Rgb, Type};
use crate::render::chart::describe::{Chart, Style};
use crate::render::chart::palette::{DARK, TEXT, colour, dash, marker};
use crate::render::script::{width, wrap};
use oedometer_soil::elementary;

pub(crate) const FONT: f64 = 12.0;
const SAMPLE: f64 = 34.0;
const GAP: f64 = 8.0;
const ROW: f64 = 19.0;
/// Room between two entries in a row.
const BETWEEN: f64 = 22.0;

/// How a series looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Look {
    pub colour: Rgb,
    pub line: bool,
    pub dash: Option<&'static str>,
    pub width: u8,
    pub marker: Option<usize>,
}

/// The looks of all series, in their order. Numbers that are not given run on by name, so that one
/// method looks the same at every time.
pub(crate) fn looks(chart: &Chart) -> Vec<Look> {
    let mut names: Vec<&str> = Vec::new();
    let mut theories: Vec<&str> = Vec::new();
    chart
        .series
        .iter()
        .map(|series| {
            let theory = series.style == Style::Theory;
            let seen = if theory { &mut theories } else { &mut names };
            let place = seen.iter().position(|n| *n == series.name && !n.is_empty()).unwrap_or_else(|| {
                seen.push(&series.name);
                seen.len() - 1
            });
            let slot = series.slot.unwrap_or(place);
            Look {
                colour: if theory { DARK } else { colour(slot) },
                line: series.style != Style::Markers,
                dash: dash(slot),
                width: if theory { 17 } else { 15 },
                marker: matches!(series.style, Style::Markers | Style::LineAndMarkers).then_some(slot),
            }
        })
        .collect()
}

/// The legend of a chart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Legend {
    entries: Vec<(Look, Vec<String>)>,
}

impl Legend {
    pub fn of(chart: &Chart, looks: &[Look], drawn: &[usize]) -> Self {
        let mut seen: Vec<(Look, String)> = Vec::new();
        for ((series, look), &count) in chart.series.iter().zip(looks).zip(drawn) {
            let entry = (*look, series.name.clone());
            if count > 0 && !series.name.is_empty() && !seen.contains(&entry) {
                seen.push(entry);
            }
        }
        let entries = seen.into_iter().map(|(look, text)| (look, wrap(&text, 22.0))).collect();
        Self { entries }
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    fn entry_width(lines: &[String]) -> f64 {
        SAMPLE + GAP + lines.iter().map(|l| width(l) * FONT).fold(0.0, f64::max)
    }

    /// Width of the legend as one column.
    pub fn column_width(&self) -> f64 {
        self.entries.iter().map(|(_, lines)| Self::entry_width(lines)).fold(0.0, f64::max)
    }

    pub fn column_height(&self) -> f64 {
        self.entries.iter().map(|(_, lines)| entry_height(lines)).sum()
    }

    /// Places of the entries within `room` pixels, in columns if there is room for two, and the
    /// height of all rows.
    fn rows(&self, room: f64) -> (Vec<Px>, f64) {
        let column = self.column_width();
        let even = 2.0 * column + BETWEEN <= room;
        let (mut x, mut y, mut tall) = (0.0, 0.0, 0.0_f64);
        let mut places = Vec::new();
        for (_, lines) in &self.entries {
            let wide = if even { column } else { Self::entry_width(lines) };
            if x > 0.0 && x + wide > room {
                (x, y, tall) = (0.0, y + tall, 0.0);
            }
            places.push((x, y));
            x += wide + BETWEEN;
            tall = tall.max(entry_height(lines));
        }
        (places, y + tall)
    }

    pub fn rows_height(&self, room: f64) -> f64 {
        self.rows(room).1
    }

    pub fn draw_rows(&self, canvas: &mut Canvas, at: Px, room: f64) {
        for ((look, lines), (x, y)) in self.entries.iter().zip(self.rows(room).0) {
            draw_entry(canvas, *look, lines, (at.0 + x, at.1 + y));
        }
    }

    pub fn draw_column(&self, canvas: &mut Canvas, at: Px) {
        let mut y = at.1;
        for (look, lines) in &self.entries {
            draw_entry(canvas, *look, lines, (at.0, y));
            y += entry_height(lines);
        }
    }
}

fn entry_height(lines: &[String]) -> f64 {
    ROW + 14.0 * (lines.len().max(1) - 1) as f64
}

fn draw_entry(canvas: &mut Canvas, look: Look, lines: &[String], at: Px) {
    let middle = at.1 + ROW / 2.0;
    if look.line {
        stroke(canvas, &[vec![(at.0, middle), (at.0 + SAMPLE, middle)]], look);
    }
    if let Some(slot) = look.marker {
        marker(canvas, (at.0 + SAMPLE / 2.0, middle), slot, 4.0, look.colour);
    }
    let plain = Type { size: FONT, ink: TEXT, bold: false, hold: Hold::Start, upright: false };
    for (i, line) in lines.iter().enumerate() {
        canvas.text(line, (at.0 + SAMPLE + GAP, middle + 4.2 + 14.0 * i as f64), plain);
    }
}

/// Draws lines in the look of a series.
pub(crate) fn stroke(canvas: &mut Canvas, pieces: &[Vec<Px>], look: Look) {
    let mut attributes = vec![("stroke-linejoin", "round")];
    attributes.extend(look.dash.map(|d| ("stroke-dasharray", d)));
    canvas.group(&attributes, |canvas| {
        for piece in pieces {
            canvas.line(&thinned(piece), look.colour, f64::from(look.width) / 10.0);
        }
    });
}

/// The piece without points that nobody can tell from the one before.
fn thinned(piece: &[Px]) -> Vec<Px> {
    let mut out: Vec<Px> = Vec::new();
    for (i, &p) in piece.iter().enumerate() {
        let near = out.last().is_some_and(|q| elementary::hypot(p.0 - q.0, p.1 - q.1) < 0.4);
        if !near || i + 1 == piece.len() {
            out.push(p);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::describe::{ChartAxis, Series};

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
        assert!(looks[0].colour == DARK && looks[5].colour == DARK && looks[0].dash != looks[5].dash);
        assert_eq!(Legend::of(&chart, &looks, &[1; 6]).entries.len(), 4);
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let dense: Vec<Px> = (0..=1000).map(|i| (f64::from(i) / 100.0, 0.0)).collect();
        let thin = thinned(&dense);
        assert!(thin.len() < 30);
        assert_eq!((thin.first(), thin.last()), (dense.first(), dense.last()));
    }
}
