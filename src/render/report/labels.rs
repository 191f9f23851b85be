//! Words for quantities, samples and axes, the same in every figure and table.

use crate::record::{Quantity, Sample};
use crate::study::{Axis, Measure};

/// A quantity in words.
pub fn quantity(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Pressure => "pore pressure",
        Quantity::EffectiveStress => "effective stress",
        Quantity::Displacement => "displacement",
        Quantity::Settlement => "settlement",
    }
}

/// Places in words.
pub fn sample(sample: Sample) -> &'static str {
    match sample {
        Sample::Points => "at the points",
        Sample::Centres => "at the cell centres",
        Sample::Nodes => "at the nodes",
        Sample::Surface => "of the surface",
    }
}

/// A measure in words, without its time.
pub fn measure(measure: &Measure) -> String {
    format!("{} {}", quantity(measure.quantity), sample(measure.sample))
}

/// Label of an axis of refinement.
pub fn axis(axis: Axis) -> &'static str {
    match axis {
        Axis::Cells => "cell size h (m)",
        Axis::TimeStep => "time step Δt (s)",
        Axis::PointsPerCell => "spacing of the points in a cell, 1/m (–)",
    }
}

/// Label of an error's axis.
pub fn error_axis(measure: &Measure) -> String {
    match measure.quantity {
        Quantity::Settlement => "relative error of settlement (–)".to_owned(),
        other => format!("relative L_2 error, {} (–)", quantity(other)),
    }
}
