//! The errors that the race judges a run by: of pressure and effective stress where they are read, and of the displacement at
//! the points; at each output, of what exists there.

use crate::case::{Quantity, Sample};
use crate::record::{Record, Status};
use serde::{Deserialize, Serialize};

/// Quantities that are judged.
pub const ERRORS: usize = 3;
/// An error that shows the physics and no more.
pub const ROUGH: f64 = 1e-1;
/// The finishing line.
pub const ARRIVED: f64 = 1e-2;
/// The loosest tolerance of the race.
pub const LOOSEST: f64 = 5e-2;
/// The smallest tolerance of the race: refinement ends where it is reached and confirmed.
pub const SMALLEST: f64 = 5e-3;

/// Where pressure and effective stress are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReadOut {
    /// At the material points.
    Points,
    /// Means of cells at their centres.
    Centres,
}

impl ReadOut {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Points, Self::Centres];

    /// Its word in tables.
    pub fn name(self) -> &'static str {
        self.sample().name()
    }

    fn sample(self) -> Sample {
        match self {
            Self::Points => Sample::Points,
            Self::Centres => Sample::Centres,
        }
    }
}

/// Errors at an output: of pressure, effective stress, and displacement at the points; of a footing of its load alone.
pub type OutputErrors = [Option<f64>; ERRORS];

/// The errors of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunErrors {
    /// By read-out, at the outputs that were reached.
    pub at: [Vec<OutputErrors>; 2],
    /// Whether the run reached its last output.
    pub is_whole: bool,
}

impl RunErrors {
    /// Those of a record, against its own reference.
    pub fn of(record: &Record) -> Self {
        let Some(reference) = record.references.first() else { return Self::default() };
        let error = |quantity: Quantity, sample: Sample, time: f64| {
            let row = record.error(quantity, sample, quantity.first_norm(), &reference.name, time)?;
            Some(row.value.abs())
        };
        let at = |read_out: ReadOut, time: f64| {
            let read = |quantity| error(quantity, read_out.sample(), time);
            let displacement = error(Quantity::Displacement, Sample::Points, time);
            [
                read(Quantity::Pressure),
                read(Quantity::EffectiveStress),
                displacement.or_else(|| error(Quantity::LoadFactor, Sample::Surface, time)),
            ]
        };
        let is_whole = record.status == Status::Ok;
        let reached = if is_whole { usize::MAX } else { record.snapshots.len() };
        let times = || record.case.time_factors.iter().take(reached);
        Self { at: ReadOut::BOTH.map(|read_out| times().map(|time| at(read_out, *time)).collect()), is_whole }
    }

    /// The largest error of a quantity, or of all, at an output, or at all: of a run that ended well. `None` where nothing
    /// exists, or an error is no number.
    pub fn largest(&self, read_out: ReadOut, quantity: Option<usize>, output: Option<usize>) -> Option<f64> {
        self.largest_reached(read_out, quantity, output).filter(|_| self.is_whole)
    }

    /// The same over the outputs that were reached, however the run ended.
    pub fn largest_reached(
        &self,
        read_out: ReadOut,
        quantity: Option<usize>,
        output: Option<usize>,
    ) -> Option<f64> {
        let outputs = self.at[read_out as usize].iter().enumerate();
        let outputs = outputs.filter(|(place, _)| output.is_none_or(|output| output == *place));
        let errors = outputs.flat_map(|(_, errors)| match quantity {
            Some(quantity) => errors[quantity..=quantity].iter(),
            None => errors.iter(),
        });
        // What is no number is the largest.
        errors.copied().flatten().max_by(f64::total_cmp).filter(|error| error.is_finite())
    }
}
