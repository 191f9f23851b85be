//! What a figure shows, as plain data.
use crate::render::chart::field::ColourField;
use crate::render::chart::layout::scale::{Range, Scale};

/// A figure: axes, what is drawn between them, and what is said about it.
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
    /// Cells of colour beneath everything else.
    pub field: Option<ColourField>,
    /// Lines and markers.
    pub series: Vec<Series>,
    /// Level lines at one value.
    pub rules: Vec<Rule>,
    /// Triangles that show what an order looks like.
    pub triangles: Vec<SlopeTriangle>,
    /// Words beside single points.
    pub names: Vec<PointName>,
    /// Outer width and height of the plotting area.
    pub size: Size,
}

impl Chart {
    /// An empty figure with the usual size.
    pub fn new(title: impl Into<String>, x: ChartAxis, y: ChartAxis) -> Self {
        Self {
            title: title.into(),
            subtitle: None,
            x,
            y,
            field: None,
            series: Vec::new(),
            rules: Vec::new(),
            triangles: Vec::new(),
            names: Vec::new(),
            size: Size::default(),
        }
    }

    /// Adds a series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }
}

/// Pixels at the size at which the figure is meant to be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// The whole width, legend included.
    pub width: f64,
    /// The height between the axes; titles, legend and notes come on top of it.
    pub plot_height: f64,
    /// One unit of x as long as one unit of y, as maps of a body want it.
    pub equal_units: bool,
}

impl Size {
    /// That of a figure with a neighbour.
    pub const PANEL: Self = Self { width: 560.0, plot_height: 360.0, equal_units: false };
}

impl Default for Size {
    fn default() -> Self {
        Self { width: 760.0, plot_height: 360.0, equal_units: false }
    }
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartAxis {
    /// Quantity and unit.
    pub label: String,
    /// How values are spread.
    pub scale: Scale,
    /// What is shown.
    pub range: Range,
    /// Small values at the top or at the right: depth, or refinement from left to right.
    pub inverted: bool,
    /// Where to put the ticks, if not anywhere: mesh sizes, say.
    pub ticks: Option<Vec<f64>>,
}

impl ChartAxis {
    /// A linear axis that shows all of the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: Range::Auto, inverted: false, ticks: None }
    }

    /// A logarithmic axis that shows all of the positive data.
    pub fn log10(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log10, ..Self::linear(label) }
    }

    /// The same axis, the other way round.
    #[must_use]
    pub fn inverted(mut self) -> Self {
        self.inverted = true;
        self
    }

    /// The same axis over a fixed range.
    #[must_use]
    pub fn between(mut self, low: f64, high: f64) -> Self {
        self.range = Range::Fixed(low, high);
        self
    }

    /// The same axis with ticks at these values.
    #[must_use]
    pub fn with_ticks(mut self, ticks: Vec<f64>) -> Self {
        self.ticks = Some(ticks);
        self
    }
}

/// Points that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend. Series that look alike and share a name share its entry; an empty name
    /// has none.
    pub name: String,
    /// The points in the order in which a line joins them.
    pub points: Vec<(f64, f64)>,
    /// What is drawn.
    pub style: Style,
    /// Colour, marker and dash pattern by number; by place in the chart if not given.
    pub slot: Option<usize>,
}

impl Series {
    /// A series of markers joined by lines.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, style: Style::LineAndMarkers, slot: None }
    }

    /// The curve that the others are held against.
    pub fn theory(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { style: Style::Theory, ..Self::new(name, points) }
    }

    /// The same series in another style.
    #[must_use]
    pub fn style(mut self, style: Style) -> Self {
        self.style = style;
        self
    }

    /// The same series with colour, marker and dash of one number.
    #[must_use]
    pub fn slot(mut self, slot: usize) -> Self {
        self.slot = Some(slot);
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
    /// The reference: always dark, above other lines and beneath all markers. Several references
    /// differ by their dashes.
    Theory,
}

/// A level line across the figure: a floor, a limit, a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The value on the vertical axis.
    pub at: f64,
    /// Words at the line.
    pub label: String,
}

/// The name of a point, written beside it where there is room.
#[derive(Debug, Clone, PartialEq)]
pub struct PointName {
    /// The point.
    pub at: (f64, f64),
    /// Its name.
    pub name: String,
}

/// A triangle on doubly logarithmic axes whose upper side has a given slope.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeTriangle {
    /// The slope; negative where the error falls to the right.
    pub slope: f64,
    /// Name of the series that it stands beside, where there is room.
    pub beside: String,
}
