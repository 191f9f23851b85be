//! Figures: a plain description ([`Chart`]), drawn as SVG by plotters ([`Chart::svg`]).
//!
//! One type serves every picture of a report: convergence, isochrones, work and precision.
//! Values that cannot be drawn are counted below the figure.

mod axis;
mod draw;
mod ends;
mod looks;
mod multiples;
mod rows;
mod rules;
mod svg;

pub use crate::render::chart::rows::{ChartRow, ChartRows};

use crate::render::chart::axis::{Scale, drawable};
use crate::render::escape::csv_field;
use crate::render::number;
use std::fmt::Write;

/// A figure: its axes and what is drawn between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// One line above the figure.
    pub title: String,
    /// A second, smaller line.
    pub subtitle: Option<String>,
    /// Horizontal axis.
    pub x: ChartAxis,
    /// Vertical axis.
    pub y: ChartAxis,
    /// Lines and markers.
    pub series: Vec<Series>,
    /// Horizontal lines at single values.
    pub rules: Vec<Rule>,
    /// Rows with words, of a dot plot.
    pub rows: Option<ChartRows>,
    /// Whether the names of series stand at the ends of their lines, right of the plot, and not in a legend below it.
    pub names_at_ends: bool,
    /// Width of the figure and height of the plot.
    pub size: Size,
}

/// Share of the largest value within which results are one.
const SAME: f64 = 1e-3;

/// Whether some values are not one.
fn differ(values: impl Iterator<Item = f64> + Clone) -> bool {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(f64::NEG_INFINITY, f64::max);
    most - least > SAME * least.abs().max(most.abs())
}

impl Chart {
    /// An empty figure of the default size.
    pub fn new(title: impl Into<String>, x: ChartAxis, y: ChartAxis) -> Self {
        Self {
            title: title.into(),
            subtitle: None,
            x,
            y,
            series: Vec::new(),
            rules: Vec::new(),
            rows: None,
            names_at_ends: false,
            size: Size::default(),
        }
    }

    /// Adds a series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Whether it shows more than a sentence would: results that make more than one point, one upright or one level line.
    pub fn is_telling(&self) -> bool {
        let has_results = self.series.iter().any(|series| series.style != Style::Theory);
        let shown = self.series.iter().filter(|series| !has_results || series.style != Style::Theory);
        let is_drawn =
            |(x, y): &&(f64, f64)| drawable(*x, self.x.scale).is_ok() && drawable(*y, self.y.scale).is_ok();
        let drawn: Vec<(&Series, Vec<(f64, f64)>)> =
            shown.map(|series| (series, series.points.iter().filter(is_drawn).copied().collect())).collect();
        let points = || drawn.iter().flat_map(|(_, points)| points);
        let joins = drawn.iter().any(|(series, points)| series.style == Style::Markers || points.len() > 1);
        joins
            && points().count() >= 3
            && differ(points().map(|(x, _)| *x))
            && differ(points().map(|(_, y)| *y))
    }

    /// The data as CSV with all digits: one row per point of a series.
    pub fn data_csv(&self) -> String {
        let quoted = |text: &str| format!("\"{}\"", csv_field(text).replace('"', "\"\""));
        let mut out = format!("series,{},{}\n", quoted(&self.x.label), quoted(&self.y.label));
        for series in &self.series {
            let name = quoted(&series.name);
            for (x, y) in &series.points {
                let _ = writeln!(out, "{name},{},{}", number::exact(*x), number::exact(*y));
            }
        }
        out
    }
}

/// Pixels at the size at which the figure is meant to be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// The whole width.
    pub width: f64,
    /// The height between the axes, without titles, legend and notes.
    pub plot_height: f64,
}

impl Size {
    /// A figure with a neighbour.
    pub const PANEL: Self = Self { width: 560.0, plot_height: 360.0 };
}

impl Default for Size {
    fn default() -> Self {
        Self { width: 760.0, plot_height: 360.0 }
    }
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartAxis {
    /// Quantity and unit.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Lowest and highest value shown; all of the data if `None`.
    pub range: Option<(f64, f64)>,
    /// Whether values grow downwards or to the left, as a depth does.
    pub inverted: bool,
    /// Places of the ticks, such as mesh sizes; round numbers if `None`.
    pub ticks: Option<Vec<(f64, Option<String>)>>,
}

impl ChartAxis {
    /// A linear axis that shows all of the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None, inverted: false, ticks: None }
    }

    /// A logarithmic axis that shows all of the positive data.
    pub fn log10(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log10, ..Self::linear(label) }
    }

    /// Turns the axis round.
    #[must_use]
    pub fn inverted(mut self) -> Self {
        self.inverted = true;
        self
    }

    /// Sets the lowest and highest value shown.
    #[must_use]
    pub fn between(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// Puts the ticks at these values.
    #[must_use]
    pub fn with_ticks(mut self, ticks: Vec<f64>) -> Self {
        self.ticks = Some(ticks.into_iter().map(|value| (value, None)).collect());
        self
    }

    /// Places the ticks, each with its own label.
    #[must_use]
    pub fn with_labelled_ticks(mut self, ticks: impl IntoIterator<Item = (f64, String)>) -> Self {
        self.ticks = Some(ticks.into_iter().map(|(value, label)| (value, Some(label))).collect());
        self
    }
}

/// Points that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend. Series with the same look and name share an entry; an empty name has none.
    pub name: String,
    /// The points in the order in which a line joins them.
    pub points: Vec<(f64, f64)>,
    /// What is drawn.
    pub style: Style,
    /// Number of its colour, marker and dashes; the place of its name in the chart if `None`.
    pub slot: Option<usize>,
    /// Number of its marker, where that is another one.
    pub marker: Option<usize>,
}

impl Series {
    /// A series of markers joined by lines.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, style: Style::LineAndMarkers, slot: None, marker: None }
    }

    /// The curve that the others are compared with.
    pub fn theory(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { style: Style::Theory, ..Self::new(name, points) }
    }

    /// Sets what is drawn.
    #[must_use]
    pub fn style(mut self, style: Style) -> Self {
        self.style = style;
        self
    }

    /// Sets the number of colour, marker and dashes.
    #[must_use]
    pub fn slot(mut self, slot: usize) -> Self {
        self.slot = Some(slot);
        self
    }

    /// Sets the number of the marker alone.
    #[must_use]
    pub fn marker(mut self, marker: usize) -> Self {
        self.marker = Some(marker);
        self
    }
}

/// What is drawn of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// A line.
    Line,
    /// Markers only.
    Markers,
    /// Markers joined by a line.
    LineAndMarkers,
    /// The reference: a dark line above other lines and below all markers. Several references differ in their
    /// dashes.
    Theory,
    /// A thin grey line: a series that is coloured in another panel of small multiples.
    Context,
}

/// A horizontal line across the figure: a floor, a limit, a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The value on the vertical axis.
    pub at: f64,
    /// Words at the line.
    pub label: String,
}
