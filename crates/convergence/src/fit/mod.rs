//! Fits of an error over refinement: a power, two powers, a floor, a limit, terms of opposite sign.

pub mod approach_to_limit;
pub mod bending_order;
pub mod cancelling_terms;
pub mod floor;
pub mod least_squares;
pub mod odd_level;
pub mod two_terms;
