//! The parts of a figure, each drawn on a canvas.

pub mod axes;
pub mod legend;
pub mod triangle;
pub mod words;
