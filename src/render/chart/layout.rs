//! How a figure shares out its room.
use super::clip::Frame;
use super::describe::{Axis, Chart, Range};
use super::legend::Legend;
use super::scale::{Ruler, Span};
use super::ticks::{Room, Tick, ticks};
use crate::render::script::{width, wrap};

pub(super) const TITLE: f64 = 15.0;
pub(super) const SMALL: f64 = 12.0;
pub(super) const LABEL: f64 = 13.0;
pub(super) const NOTE: f64 = 11.0;
const PAD: f64 = 14.0;
const LINE: f64 = 1.3;

/// Where the legend goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    None,
    Right,
    Below,
}

/// An axis laid out: where its values stand, its ticks and its words.
#[derive(Debug, Clone)]
pub(super) struct Edge {
    pub ruler: Ruler,
    pub ticks: Vec<Tick>,
    pub words: Vec<String>,
}

/// A colour bar and its axis.
#[derive(Debug, Clone)]
pub(super) struct Bar {
    pub frame: Frame,
    pub edge: Edge,
}

/// A figure laid out, in pixels.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub width: f64,
    pub height: f64,
    pub plot: Frame,
    pub x: Edge,
    pub y: Edge,
    pub bar: Option<Bar>,
    pub title: Vec<String>,
    pub subtitle: Vec<String>,
    pub side: Side,
    pub legend: (f64, f64),
    pub notes: Vec<String>,
    pub notes_top: f64,
    pub left: f64,
}

/// The ends of both axes, whatever the room.
pub(super) fn spans(chart: &Chart) -> (Span, Span) {
    let field = chart.field.as_ref();
    let edges = |e: Option<&Vec<f64>>| e.cloned().unwrap_or_default();
    let (xe, ye) = (edges(field.map(|f| &f.x_edges)), edges(field.map(|f| &f.y_edges)));
    let points = || chart.series.iter().flat_map(|s| s.points.iter().copied());
    let bars = chart.series.iter().flat_map(|s| s.bars.iter().flat_map(|b| [b.0, b.1]));
    let bands = || chart.bands.iter().flat_map(|b| b.points.iter().copied());
    let xs = points().map(|p| p.0).chain(bands().map(|p| p.0)).chain(xe.iter().copied());
    let ys = points().map(|p| p.1).chain(bars).chain(bands().flat_map(|p| [p.1, p.2])).chain(ye.iter().copied());
    let margin = if field.is_some() { 0.0 } else { 0.04 };
    let span = |axis: &Axis, values: &mut dyn Iterator<Item = f64>| {
        let kept: Vec<f64> = values.collect();
        if margin == 0.0 && axis.range == Range::Auto {
            Span::over(axis.scale, axis.range, kept.into_iter(), 0.0)
        } else {
            Span::of(axis, kept.into_iter())
        }
    };
    (span(&chart.x, &mut xs.into_iter()), span(&chart.y, &mut ys.into_iter()))
}

/// Lays the figure out. `notes` stand below it.
pub(super) fn lay_out(chart: &Chart, legend: &Legend, notes: &[String]) -> Layout {
    let finite = |v: f64, low: f64, high: f64, other: f64| if v.is_finite() { v.clamp(low, high) } else { other };
    let wide = finite(chart.size.width, 240.0, 4000.0, 760.0);
    let tall = finite(chart.size.plot_height, 80.0, 4000.0, 360.0);
    let (xs, ys) = spans(chart);
    let inner = wide - 2.0 * PAD;

    let title = wrap(&chart.title, inner / (TITLE * 1.05));
    let subtitle = wrap(chart.subtitle.as_deref().unwrap_or_default(), inner / SMALL);
    let head = title.len() as f64 * TITLE * LINE + subtitle.len() as f64 * SMALL * LINE;
    let top = PAD + head + if head > 0.0 { 8.0 } else { 4.0 };

    let y_words = wrap(&chart.y.label, tall / LABEL);
    let y_ticks_of = |height: f64| edge(&chart.y, ys, (top + height, top), false, y_words.clone());
    let left = PAD + y_words.len() as f64 * LABEL * LINE + widest(&y_ticks_of(tall).ticks) + 10.0;

    let bar_words = chart.field.as_ref().map_or(Vec::new(), |f| wrap(&f.label, tall / LABEL));
    let bar_edge = |height: f64| {
        chart.field.as_ref().filter(|f| f.shape().is_some()).map(|f| {
            let axis = Axis { scale: f.scale, ..Axis::linear("") };
            edge(&axis, f.span(), (top + height, top), false, bar_words.clone())
        })
    };
    let bar_room = bar_edge(tall).map(|e| 18.0 + 16.0 + 8.0 + widest(&e.ticks) + e.words.len() as f64 * LABEL * LINE);
    let side = if legend.is_empty() {
        Side::None
    } else if bar_room.is_none() && legend.column_width() <= 0.36 * wide && legend.column_height() <= tall + 24.0 {
        Side::Right
    } else {
        Side::Below
    };
    let right = match (side, bar_room) {
        (Side::Right, _) => PAD + legend.column_width() + 18.0,
        (_, Some(room)) => PAD + room,
        _ => PAD + 14.0,
    };
    let (plot_width, plot_height) = shape(chart, (xs, ys), (wide - left - right).max(60.0), tall);
    let plot = Frame { left, top, right: left + plot_width, bottom: top + plot_height };

    let x_words = wrap(&chart.x.label, plot_width.max(160.0) / LABEL);
    let x = edge(&chart.x, xs, (plot.left, plot.right), true, x_words);
    let below = plot.bottom + 24.0 + x.words.len() as f64 * LABEL * LINE;
    let (legend_at, after) = match side {
        Side::None => ((0.0, 0.0), below),
        Side::Right => {
            let end = top - 4.0 + legend.column_height();
            ((plot.right + 18.0, top - 4.0), below.max(end))
        }
        Side::Below => ((left, below + 8.0), below + 8.0 + legend.rows_height(wide - left - PAD)),
    };
    let notes: Vec<String> = notes.iter().flat_map(|n| wrap(n, inner / NOTE)).collect();
    let notes_top = after + if notes.is_empty() { 0.0 } else { 6.0 };
    let height = notes_top + notes.len() as f64 * NOTE * LINE + PAD * 0.8;
    let bar = bar_edge(plot_height).map(|edge| {
        let frame = Frame { left: plot.right + 18.0, right: plot.right + 34.0, ..plot };
        Bar { frame, edge }
    });
    let y = y_ticks_of(plot_height);
    Layout {
        width: wide,
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

/// The size of the plot; where a unit must be as long in both directions, the smaller one rules.
fn shape(chart: &Chart, (xs, ys): (Span, Span), room: f64, tall: f64) -> (f64, f64) {
    if !chart.size.equal_units {
        return (room, tall);
    }
    let (dx, dy) = (xs.high - xs.low, ys.high - ys.low);
    let unit = (room / dx).min(tall / dy);
    if unit.is_finite() && unit > 0.0 { ((unit * dx).max(30.0), (unit * dy).max(30.0)) } else { (room, tall) }
}

fn edge(axis: &Axis, span: Span, (low, high): (f64, f64), beside: bool, words: Vec<String>) -> Edge {
    let (from, to) = if axis.inverted { (high, low) } else { (low, high) };
    let ruler = Ruler { span, from, to };
    let ticks = ticks(&ruler, axis.ticks.as_deref(), Room { font: SMALL, beside });
    Edge { ruler, ticks, words }
}

fn widest(ticks: &[Tick]) -> f64 {
    ticks.iter().filter_map(|t| t.label.as_deref()).map(|l| width(l) * SMALL).fold(0.0, f64::max)
}
