//! Figures: a plain description ([`Chart`]) and its SVG ([`Chart::svg`]).
//!
//! One type serves every picture of a report: convergence, isochrones, work and precision, maps.
//! Nothing is hidden silently: what cannot be drawn is counted below the figure.
mod axes;
mod canvas;
mod clip;
mod describe;
mod draw;
mod field;
mod fill;
mod label;
mod layout;
mod legend;
mod missing;
mod palette;
mod polish;
mod scale;
mod space;
mod ticks;
mod triangle;
mod words;

#[cfg(test)]
pub(in crate::render) mod gallery;
#[cfg(test)]
mod tests;

pub use describe::{
    Annotation, Axis, Band, Chart, Direction, Place, Range, Rule, Scale, Series, Size, SlopeTriangle, Style,
};
pub use field::{Colours, Field};
