//! What a study expects of its results: of series of cases, and of single cases. Hard cases are judged by how they
//! end, where their critical step lies, how large an error or a drift is.

use crate::case::{Case, Key, Norm, Quantity, Sample, SolverName, Tier, Value};
use crate::measure::soundness::{PoorOutput, is_unjudged, unjudged_outputs};
use crate::record::{ErrorRow, Record};
use oedometer_convergence::SeriesDemand as Demand;
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::outcome::FailureKind;
use oedometer_wording::{typed, words};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt;

/// Status of a case that ends with its results, of which a check fails.
pub const UNSOUND: &str = "unsound";

/// What is refined along a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// Cell size, by the number of cells.
    #[default]
    Cells,
    /// Size of the time step.
    TimeStep,
    /// Spacing of the points in a cell.
    PointsPerCell,
    /// Compressibility of the water: not a refinement, and what does not lock does not change with it.
    WaterBulkModulus,
}

words!(
    Axis:
    Cells "cells", TimeStep "time_step", PointsPerCell "points_per_cell",
    WaterBulkModulus "water_bulk_modulus",
);

impl Axis {
    /// Those along which a discretisation gets finer.
    pub const REFINEMENTS: [Self; 3] = [Self::Cells, Self::TimeStep, Self::PointsPerCell];

    /// A hash of everything but the axis and the time factors: equal for cases that differ along the axis alone.
    pub fn what_is_shared(self, case: &Case) -> u64 {
        case.number_with(|case| {
            case.time_factors.clear();
            match self {
                Self::Cells => case.cells = 0,
                // Rules of one kind are steps of one path; of different kinds they are different schemes.
                Self::TimeStep => case.time_step = case.time_step.with_number(0.0),
                Self::PointsPerCell => case.points_per_cell = 0,
                Self::WaterBulkModulus => case.material.water_bulk_modulus = 0.0,
            }
        })
    }

    /// The most levels that cases have along the axis, alike in everything else.
    pub fn levels<'a>(self, cases: impl IntoIterator<Item = &'a Case>) -> usize {
        let mut counts: HashMap<u64, usize> = HashMap::new();
        for case in cases {
            *counts.entry(self.what_is_shared(case)).or_default() += 1;
        }
        counts.into_values().max().unwrap_or(0)
    }
}

/// The reference that needs no theory: the same run at the next finer level. Differences of
/// neighbours have no floor but round-off, whatever the exact solution.
pub const NEXT_FINER: &str = "next-finer";

/// No reference at all: what is judged is a value, its differences from the next finer level, and the
/// numerical uncertainty that refinement leaves it.
pub const NO_REFERENCE: &str = "none";

/// Which error of a run: what, where, in which norm, against which reference, when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Norm.
    pub norm: Norm,
    /// Name of the reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// Depth `ζ`, from 0 at the surface to 1 at the base, of the one place of a field that has no
    /// reference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probe: Option<f64>,
}

impl Measure {
    /// The measure at the places of another program's result, where that is not at the points.
    #[must_use]
    pub fn at_places_of(&self, record: &Record) -> Self {
        let is_elsewhere = self.sample == Sample::Points && record.main_sample() != Sample::Points;
        if is_elsewhere { Self { sample: record.main_sample(), ..self.clone() } } else { self.clone() }
    }

    /// Why a record has no error to judge at this output, where its reference is too inaccurate there.
    pub fn unjudged(&self, record: &Record) -> Option<String> {
        let is_this = |output: &PoorOutput| {
            output.reference == self.reference && output.time_factor == self.time_factor
        };
        unjudged_outputs(record).iter().find(|output| is_this(output)).map(PoorOutput::sentence)
    }

    /// Where a record has this error instead, with what to write; none where that is not the reason why it is missing.
    pub fn elsewhere(&self, record: &Record) -> Option<String> {
        let there = self.at_places_of(record);
        let is_there = there != *self && self.error(record).is_none() && there.error(record).is_some();
        is_there.then(|| {
            let place = there.sample.name();
            format!("the result is at {place}: leave `sample` out, or write `sample = \"{place}\"`")
        })
    }

    /// The error of a record, where it was measured and the reference is accurate enough to judge it.
    pub fn error<'a>(&self, record: &'a Record) -> Option<&'a ErrorRow> {
        if is_unjudged(record, &self.reference, self.time_factor) {
            return None;
        }
        record.error(self.quantity, self.sample, self.norm, &self.reference, self.time_factor)
    }
}

impl fmt::Display for Measure {
    /// In words, as subjects of verdicts have it.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, norm, sample, reference, time_factor, probe } = self;
        match (reference.as_str(), probe) {
            (NO_REFERENCE, None) => write!(out, "{} without reference", quantity.name())?,
            (NO_REFERENCE, Some(depth)) => {
                write!(out, "{} at ζ = {depth} without reference", quantity.name())?;
            }
            _ => write!(out, "{} {norm} {} against {reference}", quantity.name(), sample.name())?,
        }
        write!(out, " at T_v = {}", typed(*time_factor))
    }
}

/// Which cases an expectation is about, by the values of their inputs; an input that is not named fits every case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection(pub Vec<(&'static Key, Value)>);

impl Selection {
    /// Whether it names a case.
    pub fn fits(&self, case: &Case) -> bool {
        self.fits_along("", case)
    }

    /// Whether it names a case of a series along a key, whose own values do not count.
    pub fn fits_along(&self, axis: &str, case: &Case) -> bool {
        self.0.iter().all(|(key, value)| key.name == axis || key.get(case) == *value)
    }

    /// The method, where one is named.
    pub fn method(&self) -> Option<SolverName> {
        self.0
            .iter()
            .find_map(|(_, value)| if let Value::Method(method) = value { Some(*method) } else { None })
    }
}

/// An expectation of a series of cases.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesExpectation {
    /// Which cases.
    pub selection: Selection,
    /// Which error.
    pub measure: Measure,
    /// Reference, typed; none where a series is compared with itself or with nothing.
    pub reference: Option<ReferenceKind>,
    /// Axis of the series.
    pub axis: Axis,
    /// Whether it names no places, so that those of a result count that is not at the points.
    pub any_places: bool,
    /// What is wanted of the series.
    pub demand: Demand,
    /// Smallest tier whose cases can answer it.
    pub tier: Tier,
    /// The file's line, for messages.
    pub line: usize,
}

/// A range of values: the lower end belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest value.
    pub above: f64,
    /// Values are smaller than this.
    pub below: f64,
}

/// Bounds on one error of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorRange {
    /// Which error.
    pub measure: Measure,
    /// Whether it names no places, so that those of a result count that is not at the points.
    pub any_places: bool,
    /// What it must be.
    pub bounds: Bounds,
}

/// What is wanted of a case; everything asked is judged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseDemand {
    /// Name of its end: `ok`, or a failure's.
    pub status: Option<String>,
    /// Largest relative difference of the observed from the predicted critical step.
    pub critical_step_within: Option<f64>,
    /// Bounds on an error.
    pub error: Option<ErrorRange>,
    /// Largest drift of the mass of solids at any output, relative.
    pub solid_drift_below: Option<f64>,
    /// Largest imbalance of the water at any output, over what the load expels.
    pub water_drift_below: Option<f64>,
    /// Bounds on the largest size, at any output, of the water in the soil over its pores, minus one: of two point sets.
    pub pore_water: Option<Bounds>,
    /// Largest difference, at any output, of the share of the water that left from the settlement over `n_0 H`.
    pub water_left_within: Option<f64>,
    /// Bounds on the largest pressure of any water point of two point sets, between outputs too, over the load.
    pub largest_pressure: Option<Bounds>,
    /// Largest difference of any error from that of the same case with one point set.
    pub one_set_within: Option<f64>,
    /// Bounds on the largest velocity at any output of a column at rest, over the hydraulic conductivity.
    pub spurious_velocity: Option<Bounds>,
    /// Bounds on the time factor at which the pressure at the impermeable end is highest.
    pub peak_time_factor: Option<Bounds>,
    /// Bounds on that pressure over the load.
    pub peak_pressure: Option<Bounds>,
}

/// An expectation of single cases.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseExpectation {
    /// Which cases.
    pub selection: Selection,
    /// What of each.
    pub demand: CaseDemand,
    /// Smallest tier whose cases can answer it.
    pub tier: Tier,
    /// The file's line, for messages.
    pub line: usize,
}

impl CaseExpectation {
    /// Whether it is about a solver that is absent.
    pub fn asks_for_a_skip(&self) -> bool {
        self.demand.status.as_deref() == Some(FailureKind::Skipped.name())
    }

    /// Whether it says how a record is to end.
    pub fn foresees(&self, record: &Record) -> bool {
        self.selection.fits(&record.case)
            && self.demand.status.as_ref().is_some_and(|status| *status == record.status.name())
    }

    /// Whether it says that a record is to end with a failed check.
    pub fn foresees_complaints(&self, record: &Record) -> bool {
        self.demand.status.as_deref() == Some(UNSOUND) && self.selection.fits(&record.case)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_problem::method::Method;
    use oedometer_scenes::TERZAGHI;

    #[test]
    fn a_measure_is_told_by_what_it_is_held_against() {
        let of = |reference: &str, probe, time_factor| {
            let measure = Measure {
                quantity: Quantity::EffectiveStress,
                sample: Sample::Centres,
                norm: Norm::Linf,
                reference: reference.to_owned(),
                time_factor,
                probe,
            };
            measure.to_string()
        };
        assert_eq!(of("terzaghi", None, 0.1), "effective_stress linf centres against terzaghi at T_v = 0.1");
        assert_eq!(
            of("next-finer", None, 0.0),
            "effective_stress linf centres against next-finer at T_v = 0"
        );
        assert_eq!(of("none", None, 0.1), "effective_stress without reference at T_v = 0.1");
        assert_eq!(of("none", Some(0.25), 2.0), "effective_stress at ζ = 0.25 without reference at T_v = 2");
    }

    #[test]
    fn a_selection_fits_by_every_input_that_it_names_but_that_of_the_axis() {
        let key = |name: &str| Key::named(name, "sweep").expect("a key");
        let method = SolverName::Own(Method::named("MPM").expect("a method"));
        let mut case = Case { cells: 8, ..Case::seed(Task::Solve, &TERZAGHI) };
        key("method").set(&mut case, Value::Method(method));
        let cells = |cells: usize| (key("cells"), Value::Count(cells));
        let porosity = |porosity: f64| (key("porosity"), Value::Number(porosity));
        // The seed's porosity is 0.3.
        for (named, fits, along_cells, along_porosity) in [
            (vec![], true, true, true),
            (vec![cells(8), porosity(0.3)], true, true, true),
            (vec![cells(4), porosity(0.3)], false, true, false),
            (vec![cells(8), porosity(0.4)], false, false, true),
            (vec![porosity(0.4), cells(4)], false, false, false),
        ] {
            let selection = Selection(named);
            let found = [
                selection.fits(&case),
                selection.fits_along("cells", &case),
                selection.fits_along("porosity", &case),
            ];
            assert_eq!(found, [fits, along_cells, along_porosity], "{selection:?}");
            assert_eq!(selection.method(), None);
        }
        let selection = Selection(vec![cells(8), (key("method"), Value::Method(method))]);
        assert_eq!(selection.method(), Some(method));
        for (status, is_skip) in
            [(Some("skipped"), true), (Some("ok"), false), (Some("crashed"), false), (None, false)]
        {
            let demand = CaseDemand { status: status.map(str::to_owned), ..CaseDemand::default() };
            let expectation =
                CaseExpectation { selection: Selection::default(), demand, tier: Tier::Ci, line: 1 };
            assert_eq!(expectation.asks_for_a_skip(), is_skip, "{status:?}");
        }
    }
}
