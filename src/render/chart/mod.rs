//! Figures: a plain description ([`Chart`]) and its SVG ([`Chart::svg`]).
//!
//! One type serves every picture of a report: convergence, isochrones, work and precision, maps.
//! Nothing is hidden silently: what cannot be drawn is counted below the figure.

pub mod axes;
pub mod canvas;
pub mod clip;
pub mod describe;
pub mod draw;
pub mod field;
pub mod fill;
pub mod label;
pub mod layout;
pub mod legend;
pub mod missing;
pub mod palette;
pub mod scale;
pub mod space;
pub mod svg_backend;
pub mod ticks;
pub mod triangle;
pub mod words;

#[cfg(test)]
#[path = "../../../tests/unit/render_chart_gallery.rs"]
pub mod gallery;

#[cfg(test)]
#[path = "../../../tests/unit/render_chart.rs"]
mod tests;
