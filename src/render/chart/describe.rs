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
    /// Shaded intervals beneath the lines.
    pub bands: Vec<ShadedBand>,
    /// Lines and markers.
    pub series: Vec<Series>,
    /// Straight lines at one value of one axis.
    pub rules: Vec<Rule>,
    /// Triangles that show what an order looks like.
    pub triangles: Vec<SlopeTriangle>,
    /// Words inside the figure.
    pub annotations: Vec<PointLabel>,
    /// What a ring around a point means; wanted where a series has ringed points.
    pub ring: Option<String>,
    /// Lines below the figure.
    pub notes: Vec<String>,
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
            bands: Vec::new(),
            series: Vec::new(),
            rules: Vec::new(),
            triangles: Vec::new(),
            annotations: Vec::new(),
            ring: None,
            notes: Vec::new(),
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
    /// Colour by number; by place in the chart if not given.
    pub colour: Option<usize>,
    /// Marker by number; as the colour if not given.
    pub marker: Option<usize>,
    /// Dash pattern by number; as the colour if not given.
    pub dash: Option<usize>,
    /// Points, by index, with a ring around them: the Pareto front, say.
    pub ringed: Vec<usize>,
    /// Lower and upper end of a bar at each point: a spread.
    pub bars: Vec<(f64, f64)>,
    /// A few characters written at the curve itself.
    pub tag: Option<String>,
}

impl Series {
    /// A series of markers joined by lines.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.into(),
            points,
            style: Style::LineAndMarkers,
            colour: None,
            marker: None,
            dash: None,
            ringed: Vec::new(),
            bars: Vec::new(),
            tag: None,
        }
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
        (self.colour, self.marker, self.dash) = (Some(slot), Some(slot), Some(slot));
        self
    }

    /// The same series with words at the curve.
    #[must_use]
    pub fn tag(mut self, tag: impl Into<String>) -> Self {
        self.tag = Some(tag.into());
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
    /// A line that stays level up to the next point and jumps there.
    Stairs,
    /// The reference: always dark, above other lines and beneath all markers. Several references
    /// differ by their dashes.
    Theory,
}

/// A shaded interval.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadedBand {
    /// Name in the legend.
    pub name: String,
    /// Place, lower end, upper end.
    pub points: Vec<(f64, f64, f64)>,
    /// Colour by number.
    pub colour: usize,
}

/// Which axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChartDirection {
    /// The horizontal axis.
    X,
    /// The vertical axis.
    Y,
}

/// A straight line across the figure: a floor, a limit, a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The axis on which the value is read.
    pub axis: ChartDirection,
    /// The value.
    pub at: f64,
    /// Words at the line.
    pub label: String,
}

/// A triangle on doubly logarithmic axes whose upper side has a given slope.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeTriangle {
    /// The slope; negative where the error falls to the right.
    pub slope: f64,
    /// Where to put it.
    pub place: TrianglePlace,
}

/// Where a triangle is put.
#[derive(Debug, Clone, PartialEq)]
pub enum TrianglePlace {
    /// Where there is room beside the series of this name.
    Beside(String),
    /// At this point, in the units of the axes.
    At(f64, f64),
}

/// Words at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLabel {
    /// The point, in the units of the axes.
    pub at: (f64, f64),
    /// The words.
    pub text: String,
}
