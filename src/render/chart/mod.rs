//! Figures: a plain description ([`Chart`]), drawn as SVG by plotters ([`Chart::svg`]).
//!
//! One type serves every picture of a report: convergence, isochrones, work and precision, maps.
//! Values that cannot be drawn are counted below the figure.

mod axis;
mod describe;
mod draw;
mod looks;
mod multiples;
mod svg;
mod words;

pub use describe::{Chart, ChartAxis, ColourField, PointName, Rule, Series, Size, SlopeTriangle, Style};

#[cfg(test)]
mod tests;
