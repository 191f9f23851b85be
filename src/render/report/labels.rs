//! Words for quantities, samples and axes, the same in every figure and table.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::{Path, SeriesSummary, first_norm};
use crate::record::Record;
use crate::render::table::Cell;
use crate::study::expectation::{Axis, Measure};
use std::collections::{BTreeMap, BTreeSet};

/// What the words beside an order, or instead of one, say.
pub const CLASSES: &str = "Words beside an order say that it is not settled: pre-asymptotic, it still changes from mesh to \
                           mesh; contaminated, a term of lower order takes over on fine meshes; superconvergent, higher \
                           than promised. Words instead of one: oscillatory, the error goes up and down; divergent, it \
                           grows; floor-limited, something else than the mesh limits it; locked, the body hardly moves";

/// A reference in words, for running text and legends.
pub fn solution(reference: &str) -> String {
    match reference {
        "terzaghi" => "Terzaghi's solution with compressible water".to_owned(),
        "terzaghi-incompressible" => "Terzaghi's solution".to_owned(),
        "large-strain" => "the exact large-strain solution of its own equations".to_owned(),
        "xie-leo" => "Xie & Leo's solution".to_owned(),
        other => format!("the exact solution `{other}`"),
    }
}

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

/// Work of a case, which nobody counts for an attached solver.
pub fn counted(record: &Record, work: u64) -> Cell {
    if record.case.is_attached() { Cell::missing("of an attached solver") } else { Cell::Count(work) }
}

/// A measure in words, without its time.
pub fn measure(measure: &Measure) -> String {
    format!("{} {}", quantity(measure.quantity), sample(measure.sample))
}

/// A measure in the norm in which its quantity is reported first.
pub fn first_measure(quantity: Quantity, sample: Sample, reference: &str, time_factor: f64) -> Measure {
    let norm = first_norm(quantity);
    Measure { quantity, sample, norm, reference: reference.to_owned(), time_factor, probe: None }
}

/// Label of an axis of refinement.
pub fn axis(axis: Axis) -> &'static str {
    match axis {
        Axis::Cells => "cell size h (m)",
        Axis::TimeStep => "time step Δt (s)",
        Axis::PointsPerCell => "spacing of the points in a cell, 1/m (–)",
        Axis::WaterBulkModulus => "compressibility of the water 1/K_w (1/Pa)",
    }
}

/// Label of an error's axis.
pub fn error_axis(measure: &Measure) -> String {
    match measure.quantity {
        Quantity::Settlement => "relative error of settlement (–)".to_owned(),
        other => format!("relative L_2 error, {} (–)", quantity(other)),
    }
}

/// Labels of paths that share a figure or a table: what tells them apart, and, once for all, what
/// does not.
pub struct PathLabels {
    /// One label a path.
    pub each: Vec<String>,
    /// What all paths share.
    pub shared: String,
}

impl PathLabels {
    /// The labels with the places of a path's errors, where they are not those of the figure.
    #[must_use]
    pub fn with_places(mut self, summaries: &[SeriesSummary<'_>], asked: Sample) -> Self {
        for (label, summary) in self.each.iter_mut().zip(summaries) {
            if summary.measure.sample != asked {
                *label = format!("{label}, {}", sample(summary.measure.sample));
            }
        }
        self
    }

    /// What all share, as the end of a subtitle.
    pub fn subtitle_end(&self) -> String {
        if self.shared.is_empty() { String::new() } else { format!("; {}", self.shared) }
    }
}

/// Splits the labels of paths into what differs and what is shared; the method is always named.
pub fn path_labels(paths: &[Path<'_>]) -> PathLabels {
    let parts: Vec<Vec<String>> = paths.iter().map(Path::parts).collect();
    let mut paths_with: BTreeMap<&str, usize> = BTreeMap::new();
    for own in &parts {
        let once: BTreeSet<&str> = own.iter().map(String::as_str).collect();
        for part in once {
            *paths_with.entry(part).or_default() += 1;
        }
    }
    let is_shared = |part: &String| paths_with.get(part.as_str()) == Some(&parts.len());
    let each = parts.iter().map(|own| {
        let differing = own.iter().enumerate().filter(|(place, part)| *place == 0 || !is_shared(part));
        differing.map(|(_, part)| part.as_str()).collect::<Vec<_>>().join(", ")
    });
    let shared = parts
        .first()
        .map_or(Vec::new(), |own| own[1..].iter().filter(|part| is_shared(part)).cloned().collect());
    PathLabels { each: each.collect(), shared: shared.join(", ") }
}
