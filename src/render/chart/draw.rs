//! Draws a figure: its layout in pixels, then layer over layer from the back to the front.

use crate::case::grouping::distinct;
use crate::render::RenderError;
use crate::render::chart::axis::{Ends, PlacedAxis, Reason, TICK_FONT};
use crate::render::chart::ends::{end_names, end_names_width};
use crate::render::chart::looks::{Legend, Look, draw_marker, looks};
use crate::render::chart::multiples::{SIDE_BY_SIDE, side_by_side};
use crate::render::chart::rows;
use crate::render::chart::rules::rules;
use crate::render::chart::svg::{
    Font, NARROW, Px, document, group, layer, line, scripted, stroke, units, write,
};
use crate::render::chart::{Chart, Series, Style};
use crate::render::palette::TWIN;
use crate::render::palette::{FINE_GRID, FRAME, GRID, QUIET, SCREEN, TEXT};
use crate::render::script::{width, wrap};
use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::style::text_anchor::HPos;
use std::collections::BTreeMap;

const TITLE: Font = Font { size: 15.0, colour: TEXT.light, is_bold: true };
const SUBTITLE: Font = Font { size: 12.0, colour: QUIET.light, is_bold: false };
const LABEL: Font = Font { size: 13.0, colour: TEXT.light, is_bold: false };
const TICK: Font = Font { size: TICK_FONT, colour: TEXT.light, is_bold: false };
const NOTE: Font = Font { size: 11.0, colour: QUIET.light, is_bold: false };
/// The most height of a plot on the screen of a phone, px.
const NARROW_HEIGHT: f64 = 280.0;
/// Margin around the figure, px.
const PAD: f64 = 14.0;
/// Height of a line in sizes of its font.
const LINE: f64 = 1.3;
/// Height of the ticks, labels and words of the horizontal axis, px.
const BELOW: f64 = 42.0;
/// Tick, gap to its label, and room for the words of an upright axis, px.
const BESIDE: f64 = 10.0 + 1.4 * LABEL.size;

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Frame {
    fn holds(&self, (x, y): Px) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }

    /// The frame, `by` wider on every side.
    fn grown(&self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }
}

/// A figure laid out, in pixels.
pub(super) struct Layout {
    pub size: Px,
    pub plot: Frame,
    pub x: PlacedAxis,
    pub y: PlacedAxis,
    title: Vec<String>,
    subtitle: Vec<String>,
    notes: Vec<String>,
    legend: Legend,
    pub looks: Vec<Look>,
    /// The places of the points of each series, if they can be drawn.
    pub points: Vec<Vec<Option<Px>>>,
}

impl Layout {
    /// Gives every part of a figure its room.
    pub fn of(chart: &Chart) -> Self {
        let within = |value: f64, low: f64, other: f64| {
            if value.is_finite() { value.clamp(low, 4000.0) } else { other }
        };
        let (wide, tall) =
            (within(chart.size.width, 240.0, 760.0), within(chart.size.plot_height, 80.0, 360.0));
        let (x_ends, y_ends) = ends(chart);
        let inner = wide - 2.0 * PAD;
        let title = wrap(&chart.title, inner / (TITLE.size * 1.05));
        let subtitle = wrap(chart.subtitle.as_deref().unwrap_or_default(), inner / SUBTITLE.size);
        let head = LINE * (title.len() as f64 * TITLE.size + subtitle.len() as f64 * SUBTITLE.size);
        let top = PAD + head + 8.0;

        let y_axis = PlacedAxis::new(&chart.y, y_ends, (top + tall, top), true);
        let left = PAD + y_axis.label_width() + BESIDE;
        let room = (wide - left - PAD - 14.0 - end_names_width(chart)).max(60.0);
        let plot = Frame { left, top, right: left + room, bottom: top + tall };
        let x = PlacedAxis::new(&chart.x, x_ends, (plot.left, plot.right), false);

        let place = |point: &(f64, f64)| x.px(point.0).zip(y_axis.px(point.1));
        let points: Vec<Vec<_>> =
            chart.series.iter().map(|series| series.points.iter().map(place).collect()).collect();
        let looks = looks(chart);
        let is_drawn = |series: usize| points[series].iter().flatten().next().is_some();
        let legend = Legend::of(chart, &looks, is_drawn, inner);
        let notes: Vec<String> =
            notes(chart, &x_ends, &y_ends).iter().flat_map(|note| wrap(note, inner / NOTE.size)).collect();
        let below = legend.height() + notes.len() as f64 * NOTE.size * LINE;
        let height = plot.bottom + BELOW + if below > 0.0 { 8.0 + below + PAD * 0.8 } else { 0.0 };
        let size = (wide, height.ceil());
        Self { size, plot, x, y: y_axis, title, subtitle, notes, legend, looks, points }
    }
}

/// The ends of both axes.
pub(super) fn ends(chart: &Chart) -> (Ends, Ends) {
    let points = || chart.series.iter().flat_map(|series| &series.points);
    (Ends::of(&chart.x, points().map(|point| point.0)), Ends::of(&chart.y, points().map(|point| point.1)))
}

/// Sentences on what the figure cannot show.
fn notes(chart: &Chart, x: &Ends, y: &Ends) -> Vec<String> {
    let mut lost: BTreeMap<Reason, Vec<&str>> = BTreeMap::new();
    for series in chart.series.iter().filter(|series| series.style != Style::Context) {
        for &(a, b) in &series.points {
            let reason = match (x.visible(a), y.visible(b)) {
                (Ok(_), Ok(_)) => continue,
                // The first reason that hides the point altogether; lines are cut at the frame without a word.
                (Err(Reason::Outside) | Ok(_), Err(other)) | (Err(other), _) => other,
            };
            if reason == Reason::Outside && !matches!(series.style, Style::Markers | Style::LineAndMarkers) {
                continue;
            }
            lost.entry(reason).or_default().push(&series.name);
        }
    }
    let total: usize = lost.values().map(Vec::len).sum();
    let reasons = lost.into_iter().map(|(reason, names)| {
        format!("{} {} ({})", names.len(), reason.words(), distinct(names).join(", "))
    });
    let reasons = reasons.collect::<Vec<_>>().join("; ");
    let values = if total == 1 { "value" } else { "values" };
    let mut notes: Vec<String> = Vec::new();
    notes.extend((total > 0).then(|| format!("{total} {values} not drawn: {reasons}.")));
    notes.extend(without_data(chart));
    notes
}

/// Names the series without points, where others have some.
fn without_data(chart: &Chart) -> Option<String> {
    let with_points: Vec<&str> =
        chart.series.iter().filter(|one| !one.points.is_empty()).map(|one| one.name.as_str()).collect();
    let mut names: Vec<&str> = chart.series.iter().map(|one| one.name.as_str()).collect();
    let is_context =
        |name: &str| chart.series.iter().any(|one| one.name == name && one.style == Style::Context);
    names.retain(|name| !name.is_empty() && !with_points.contains(name) && !is_context(name));
    names.dedup();
    let is_told = !with_points.is_empty() && !names.is_empty();
    is_told.then(|| format!("Without data here: {}.", names.join(", ")))
}

impl Chart {
    /// The figure as a self-contained SVG document.
    ///
    /// # Errors
    /// If plotters fails to draw it.
    pub fn svg(&self) -> Result<String, RenderError> {
        self.document_of(|| match &self.rows {
            Some(rows) => rows::elements(self, rows, false),
            None => self.as_panels(SIDE_BY_SIDE),
        })
    }

    /// The same for the screen of a phone, where it does not fit one: narrower, with panels and names below each other.
    ///
    /// # Errors
    /// If plotters fails to draw it.
    pub fn narrow_svg(&self) -> Result<Option<String>, RenderError> {
        let document = match &self.rows {
            Some(rows) => self.document_of(|| rows::elements(self, rows, true)),
            None if self.size.width <= NARROW => return Ok(None),
            None => {
                let mut narrow = self.clone();
                narrow.size.plot_height = self.size.plot_height.min(NARROW_HEIGHT);
                narrow.size.width = NARROW;
                // Names beside lines have no room.
                narrow.names_at_ends = false;
                narrow.document_of(|| narrow.as_panels((1, NARROW)))
            }
        };
        document.map(Some)
    }

    fn document_of(
        &self,
        draw: impl FnOnce() -> Result<(Px, String), String>,
    ) -> Result<String, RenderError> {
        let drawn =
            draw().map(|(size, elements)| document(size, &self.title, &self.description(), &elements));
        drawn.map_err(|reason| RenderError::Draw { title: self.title.clone(), reason })
    }

    /// One plot, or panels in columns of a width.
    fn as_panels(&self, columns: (usize, f64)) -> Result<(Px, String), String> {
        let mut panels = self.panels();
        if panels.is_empty() {
            return self.elements();
        }
        for panel in &mut panels {
            panel.size.width = columns.1;
        }
        Ok(side_by_side(&panels.iter().map(Self::elements).collect::<Result<Vec<_>, _>>()?, columns))
    }

    /// Size of the figure as one plot, and its elements.
    fn elements(&self) -> Result<(Px, String), String> {
        let chart = &self.with_twins_named();
        let layout = Layout::of(chart);
        let back = chart.axes(&layout)? + &chart.lines(&layout)?;
        let (markers, words) =
            (chart.markers(&layout)?, rules(chart, &layout)? + &end_names(chart, &layout)?);
        let below = (PAD, layout.plot.bottom + BELOW + 8.0);
        let around = layout.legend.elements(layout.size, below)? + &Self::texts(&layout)?;
        Ok((layout.size, [back, markers, words, around].concat()))
    }

    /// The figure in which a series that lies upon an earlier one is named after it too: its line is not seen.
    fn with_twins_named(&self) -> Self {
        let mut named = self.clone();
        for (place, series) in self.series.iter().enumerate() {
            let counts = |one: &&Series| {
                matches!(one.style, Style::Line | Style::LineAndMarkers)
                    && one.points.len() > 1
                    && !one.name.is_empty()
                    && !one.name.contains(TWIN)
            };
            let is_twin =
                |one: &&Series| counts(one) && one.name != series.name && one.points == series.points;
            if let Some(twin) = self.series[..place].iter().find(is_twin).filter(|_| counts(&series)) {
                named.series[place].name = format!("{}{TWIN}{}", series.name, twin.name);
            }
        }
        named
    }

    /// White ground, grid and axes.
    fn axes(&self, layout: &Layout) -> Result<String, String> {
        let (plot, size) = (layout.plot, layout.size);
        layer(size, |area| {
            area.fill(&SCREEN.light)?;
            let mut chart = ChartBuilder::on(area)
                .margin_left(units(PAD))
                .margin_top(units(plot.top))
                .margin_right(units(size.0 - plot.right))
                .margin_bottom(units(size.1 - plot.bottom - BELOW))
                .set_label_area_size(LabelAreaPosition::Left, units(plot.left - PAD))
                .set_label_area_size(LabelAreaPosition::Bottom, units(BELOW))
                .build_cartesian_2d(layout.x.for_plotters(), layout.y.for_plotters())?;
            let longest = width(&self.x.label).max(1.0);
            let label = Font { size: LABEL.size.min((size.0 - 2.0 * PAD) / longest), ..LABEL };
            let upright = fitted(&self.y.label, plot);
            let (x_label, y_label) =
                (|x: &i32| scripted(&layout.x.label_at(*x)), |y: &i32| scripted(&layout.y.label_at(*y)));
            let mut mesh = chart.configure_mesh();
            mesh.bold_line_style(stroke(GRID.light, 1.0))
                .light_line_style(stroke(FINE_GRID.light, 1.0))
                .axis_style(stroke(FRAME.light, 1.0))
                .set_all_tick_mark_size(units(4.0))
                .label_style(TICK.style(HPos::Center))
                .x_label_formatter(&x_label)
                .y_label_formatter(&y_label)
                .axis_desc_style(upright.style(HPos::Center))
                .y_desc(scripted(&self.y.label));
            mesh.draw()?;
            let at = (f64::midpoint(plot.left, plot.right), plot.bottom + BELOW - 8.0);
            write(area, &self.x.label, at, label, HPos::Center)
        })
    }

    /// The lines of all series, theory last, cut at the frame.
    fn lines(&self, layout: &Layout) -> Result<String, String> {
        let mut out = String::new();
        for is_theory in [false, true] {
            let lines = self.series.iter().zip(&layout.looks).zip(&layout.points);
            for ((series, look), places) in
                lines.filter(|((_, look), _)| look.has_line && look.is_theory == is_theory)
            {
                let drawn = layer(layout.size, |area| {
                    // Broken at values that cannot be drawn.
                    for piece in places.split(Option::is_none).filter(|piece| piece.len() > 1) {
                        let places: Vec<Px> = piece.iter().flatten().copied().collect();
                        line(area, &places, stroke(look.colour, look.width()))?;
                    }
                    Ok(())
                })?;
                out += &group(&look.line_attributes(), &series.name, &drawn);
            }
        }
        // A document within the document cuts what lies outside of it.
        let Frame { left, top, right, bottom } = layout.plot.grown(0.5);
        let [x, y, w, h] = [left, top, right - left, bottom - top].map(units);
        let frame = format!("x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\"");
        Ok(if out.is_empty() { out } else { format!("<svg {frame}>\n{out}</svg>\n") })
    }

    /// The markers of all series. Those of later series are smaller, so that points that coincide are seen to be
    /// several, above all where no line shows it.
    fn markers(&self, layout: &Layout) -> Result<String, String> {
        let inside = layout.plot.grown(0.5);
        let mut kinds: Vec<Look> = Vec::new();
        let mut out = String::new();
        for ((series, look), places) in self.series.iter().zip(&layout.looks).zip(&layout.points) {
            let Some(slot) = look.marker else { continue };
            let place = kinds.iter().position(|kind| kind == look).unwrap_or_else(|| {
                kinds.push(*look);
                kinds.len() - 1
            });
            let step = place.min(3) as f64;
            let radius = if look.has_line { 4.6 - 0.25 * step } else { 5.4 - 0.85 * step };
            let drawn = layer(layout.size, |area| {
                for at in places.iter().flatten().copied().filter(|at| inside.holds(*at)) {
                    draw_marker(area, at, slot, radius, look.colour)?;
                }
                Ok(())
            })?;
            out += &group("", &series.name, &drawn);
        }
        Ok(out)
    }

    /// Title, subtitle and notes; a sentence in place of missing data.
    fn texts(layout: &Layout) -> Result<String, String> {
        layer(layout.size, |area| {
            let mut top = PAD - 2.0;
            for (lines, font) in [(&layout.title, TITLE), (&layout.subtitle, SUBTITLE)] {
                for words in lines {
                    write(area, words, (PAD, top + 0.5 * font.size), font, HPos::Left)?;
                    top += font.size * LINE;
                }
            }
            let mut bottom = layout.size.1 - PAD * 0.8 - layout.notes.len() as f64 * NOTE.size * LINE;
            for words in &layout.notes {
                write(area, words, (PAD, bottom + 0.5 * NOTE.size), NOTE, HPos::Left)?;
                bottom += NOTE.size * LINE;
            }
            if layout.points.iter().flatten().flatten().next().is_none() {
                let Frame { left, top, right, bottom } = layout.plot;
                let centre = (f64::midpoint(left, right), f64::midpoint(top, bottom));
                write(area, "no data", centre, Font { size: 22.0, ..NOTE }, HPos::Center)?;
            }
            Ok(())
        })
    }

    /// What the figure shows, for those who cannot see it.
    fn description(&self) -> String {
        let mut names: Vec<&str> =
            self.series.iter().map(|series| series.name.as_str()).filter(|name| !name.is_empty()).collect();
        names.dedup();
        let what = if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
        format!("{} against {}{what}.", self.y.label, self.x.label)
    }
}

/// The font of the words of an upright axis, smaller where they are longer than the plot.
fn fitted(words: &str, plot: Frame) -> Font {
    Font { size: LABEL.size.min((plot.bottom - plot.top + 30.0) / width(words).max(1.0)), ..LABEL }
}
