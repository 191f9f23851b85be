//! Figures: a plain description ([`Chart`]) and its SVG ([`Chart::svg`]).
//!
//! One type serves every picture of a report: convergence, isochrones, work and precision, maps.
//! Nothing is hidden silently: what cannot be drawn is counted below the figure.

pub mod axis_numbers;
pub mod canvas;
pub mod data;
pub mod describe;
pub mod draw;
pub mod field;
pub mod layout;
pub mod palette;
pub mod parts;
pub mod svg_backend;

#[cfg(test)]
pub mod gallery;

#[cfg(test)]
mod tests;
