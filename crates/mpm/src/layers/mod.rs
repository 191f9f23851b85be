//! Two layers of material points: those of the skeleton, and those of the water (docs/theory.md, Eqs 21–23).
//!
//! The skeleton is a [`Body`](crate::body::Body) whose points carry no water: its grid, weights, strains, load
//! and nodal fields. `two_layers` puts the water beside it and takes the explicit step; each part of what the water
//! does has its file:
//!
//! - `water_domains`: porosity, volume and domain of a water point, cut at the soil's surface,
//! - `motion`: how far a step takes points,
//! - `phases`: what the points of either phase and the nodes give each other,
//! - `water_to_nodes`: mass, drag and pressure of the water on their way to the nodes,
//! - `cell_forces`: the pressure's forces where a cell knows one rate of it,
//! - `cell_pressures`: the pressure that a cell presses with, which takes that rate,
//! - `pressure_lines`: lines through those pressures, and how what points carry beyond them fades,
//! - `sliver_nodes`: nodes that the surface has all but left,
//! - `water_pressure`: the continuity at the water points,
//! - `samples`: what a snapshot tells of them,
//! - `two_layer_stepper`: the driver's view of it.
//!
//! Balances of momentum, kicks and the skeleton's strain are those of one layer, from where one layer takes them.

pub mod cell_forces;
pub mod cell_pressures;
pub mod motion;
pub mod phases;
pub mod pressure_lines;
pub mod samples;
pub mod sliver_nodes;
pub mod two_layer_stepper;
pub mod two_layers;
pub mod water_domains;
pub mod water_pressure;
pub mod water_sums;
pub mod water_to_nodes;
