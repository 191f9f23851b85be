//! How a figure shares out its room.

pub mod clip;
pub mod missing;
pub mod scale;
pub mod space;
pub mod ticks;

use crate::render::chart::describe::{Chart, ChartAxis};
use crate::render::chart::layout::clip::PixelFrame;
use crate::render::chart::layout::scale::{Ruler, Span};
use crate::render::chart::layout::ticks::{Room, Tick, ticks};
use crate::render::chart::parts::legend::Legend;
use crate::render::script::{width, wrap};

pub(crate) const TITLE: f64 = 15.0;
pub(crate) const SMALL: f64 = 12.0;
pub(crate) const LABEL: f64 = 13.0;
pub(crate) const NOTE: f64 = 11.0;
const PAD: f64 = 14.0;
pub(crate) const LINE: f64 = 1.3;

/// Where the legend goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LegendSide {
    None,
    Right,
    Below,
}

/// An axis laid out: where its values stand, its ticks and its words.
#[derive(Debug, Clone)]
pub(crate) struct Edge {
    pub ruler: Ruler,
    pub ticks: Vec<Tick>,
    pub words: Vec<String>,
}

/// A colour bar and its axis.
#[derive(Debug, Clone)]
pub(crate) struct Bar {
    pub frame: PixelFrame,
    pub edge: Edge,
}

/// A figure laid out, in pixels.
#[derive(Debug, Clone)]
pub(crate) struct ChartLayout {
    pub width: f64,
    pub height: f64,
    pub plot: PixelFrame,
    pub x: Edge,
    pub y: Edge,
    pub bar: Option<Bar>,
    pub title: Vec<String>,
    pub subtitle: Vec<String>,
    pub side: LegendSide,
    pub legend: (f64, f64),
    pub notes: Vec<String>,
    pub notes_top: f64,
    pub left: f64,
}

/// The ends of both axes, whatever the room.
fn spans(chart: &Chart) -> (Span, Span) {
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for series in &chart.series {
        xs.extend(series.points.iter().map(|p| p.0));
        ys.extend(series.points.iter().map(|p| p.1));
    }
    if let Some(field) = &chart.field {
        xs.extend(&field.x_edges);
        ys.extend(&field.y_edges);
    }
    // A field fills its axes.
    let margin = if chart.field.is_some() { 0.0 } else { 0.04 };
    let span =
        |axis: &ChartAxis, values: Vec<f64>| Span::over(axis.scale, axis.range, values.into_iter(), margin);
    (span(&chart.x, xs), span(&chart.y, ys))
}

/// Width and plot height, within reason.
fn outer(chart: &Chart) -> (f64, f64) {
    let within = |v: f64, low: f64, other: f64| {
        if v.is_finite() { v.clamp(low, 4000.0) } else { other }
    };
    (within(chart.size.width, 240.0, 760.0), within(chart.size.plot_height, 80.0, 360.0))
}

/// Lays the figure out. `notes` stand below it.
pub(crate) fn lay_out(chart: &Chart, legend: &Legend, notes: &[String]) -> ChartLayout {
    let (wide, tall) = outer(chart);
    let (xs, ys) = spans(chart);
    let inner = wide - 2.0 * PAD;

    let title = wrap(&chart.title, inner / (TITLE * 1.05));
    let subtitle = wrap(chart.subtitle.as_deref().unwrap_or_default(), inner / SMALL);
    let head = title.len() as f64 * TITLE * LINE + subtitle.len() as f64 * SMALL * LINE;
    let top = PAD + head + if head > 0.0 { 8.0 } else { 4.0 };

    let y_words = wrap(&chart.y.label, tall / LABEL);
    let y_edge = |height: f64| edge(&chart.y, ys, (top + height, top), false, y_words.clone());
    let left = PAD + upright_room(&y_edge(tall)) + 10.0;
    let bar_room = bar_edge(chart, top, tall, tall).map(|e| 18.0 + 16.0 + 8.0 + upright_room(&e));
    let side = side(legend, wide, tall, bar_room.is_some());
    let right = match (side, bar_room) {
        (LegendSide::Right, _) => PAD + legend.column_width() + 18.0,
        (_, Some(room)) => PAD + room,
        _ => PAD + 14.0,
    };
    let (plot_width, plot_height) = shape(chart, (xs, ys), (wide - left - right).max(60.0), tall);
    let plot = PixelFrame { left, top, right: left + plot_width, bottom: top + plot_height };

    let x_words = wrap(&chart.x.label, plot_width.max(160.0) / LABEL);
    let x = edge(&chart.x, xs, (plot.left, plot.right), true, x_words);
    let below = plot.bottom + 24.0 + x.words.len() as f64 * LABEL * LINE;
    let (legend_at, after) = match side {
        LegendSide::None => ((0.0, 0.0), below),
        LegendSide::Right => ((plot.right + 18.0, top - 4.0), below.max(top - 4.0 + legend.column_height())),
        LegendSide::Below => ((left, below + 8.0), below + 8.0 + legend.rows_height(wide - left - PAD)),
    };
    let notes: Vec<String> = notes.iter().flat_map(|n| wrap(n, inner / NOTE)).collect();
    let notes_top = after + if notes.is_empty() { 0.0 } else { 6.0 };
    let height = notes_top + notes.len() as f64 * NOTE * LINE + PAD * 0.8;
    let bar = bar_edge(chart, top, plot_height, tall).map(|edge| {
        let frame = PixelFrame { left: plot.right + 18.0, right: plot.right + 34.0, ..plot };
        Bar { frame, edge }
    });
    let y = y_edge(plot_height);
    // A slender body leaves room that nobody needs.
    let lines = [(TITLE * 1.05, &title), (SMALL, &subtitle), (NOTE, &notes)];
    let words = lines.into_iter().flat_map(|(font, lines)| lines.iter().map(move |l| font * width(l)));
    let needed = words.fold(plot.right + right - PAD, |most, w| most.max(PAD + w)) + PAD;
    let slender = chart.size.equal_units && side != LegendSide::Below;
    ChartLayout {
        width: if slender { needed.min(wide).ceil() } else { wide },
        height: height.ceil(),
        plot,
        x,
        y,
        bar,
        title,
        subtitle,
        side,
        legend: legend_at,
        notes,
        notes_top,
        left: PAD,
    }
}

/// Width of a figure up to which nothing stands beside its plot: those in a row keep one shape.
const NARROW: f64 = 420.0;

/// A legend beside the plot must leave it its room.
fn side(legend: &Legend, wide: f64, tall: f64, has_bar: bool) -> LegendSide {
    let fits = legend.column_width() <= 0.36 * wide && legend.column_height() <= tall + 24.0;
    match legend.is_empty() {
        true => LegendSide::None,
        false if fits && !has_bar && wide > NARROW => LegendSide::Right,
        false => LegendSide::Below,
    }
}

fn bar_edge(chart: &Chart, top: f64, height: f64, tall: f64) -> Option<Edge> {
    let field = chart.field.as_ref().filter(|f| f.shape().is_some())?;
    Some(edge(
        &ChartAxis::linear(""),
        field.span(),
        (top + height, top),
        false,
        wrap(&field.label, tall / LABEL),
    ))
}

/// Room for the labels and the words of an upright axis.
fn upright_room(edge: &Edge) -> f64 {
    let labels = edge.ticks.iter().filter_map(|t| t.label.as_deref());
    let widest = labels.map(|l| width(l) * SMALL).fold(0.0, f64::max);
    widest + edge.words.len() as f64 * LABEL * LINE
}

/// The size of the plot; where a unit must be as long in both directions, the smaller one rules.
fn shape(chart: &Chart, (xs, ys): (Span, Span), room: f64, tall: f64) -> (f64, f64) {
    if !chart.size.equal_units {
        return (room, tall);
    }
    let (dx, dy) = (xs.high - xs.low, ys.high - ys.low);
    let unit = (room / dx).min(tall / dy);
    if unit.is_finite() && unit > 0.0 { ((unit * dx).max(30.0), (unit * dy).max(30.0)) } else { (room, tall) }
}

fn edge(axis: &ChartAxis, span: Span, (low, high): (f64, f64), beside: bool, words: Vec<String>) -> Edge {
    let (from, to) = if axis.inverted { (high, low) } else { (low, high) };
    let ruler = Ruler { span, from, to };
    let ticks = ticks(&ruler, axis.ticks.as_deref(), Room { font: SMALL, beside });
    Edge { ruler, ticks, words }
}
