//! What a study expects of single cases: how they end, where their critical step lies, how large an
//! error or a drift may be. Hard cases are judged by this, not by series.

use crate::case::tier::Tier;
use crate::mpm::explicit::Drag;
use crate::mpm::explicit::scheme::Scheme;
use crate::mpm::method::Method;
use crate::mpm::run::integrator::IntegratorKind;
use crate::record::Record;
use crate::study::expectation::Measure;

/// Which cases of a study an expectation is about; what is not named fits every case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Method.
    pub method: Option<Method>,
    /// Integrator.
    pub integrator: Option<IntegratorKind>,
    /// Cells over the height.
    pub cells: Option<usize>,
    /// Points a cell.
    pub points_per_cell: Option<usize>,
    /// Time level of the drag.
    pub drag: Option<Drag>,
    /// Scheme of the explicit step.
    pub scheme: Option<Scheme>,
}

/// Bounds on one error of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorRange {
    /// Which error.
    pub measure: Measure,
    /// It must be smaller than this.
    pub below: f64,
    /// It must be at least this.
    pub above: f64,
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
    /// Largest imbalance of the water at any output, over what the load presses out.
    pub water_drift_below: Option<f64>,
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

impl Selection {
    /// Whether a record is of a case that it names.
    pub fn fits(&self, record: &Record) -> bool {
        fn fit<T: PartialEq>(asked: Option<&T>, has: &T) -> bool {
            asked.is_none_or(|asked| asked == has)
        }
        let case = &record.case;
        fit(self.method.as_ref(), &case.method)
            && fit(self.integrator.as_ref(), &case.integrator)
            && fit(self.cells.as_ref(), &case.cells)
            && fit(self.points_per_cell.as_ref(), &case.points_per_cell)
            && fit(self.drag.as_ref(), &case.settings.drag)
            && fit(self.scheme.as_ref(), &case.settings.scheme)
    }
}

impl CaseExpectation {
    /// Whether it says how a record is to end.
    pub fn foresees(&self, record: &Record) -> bool {
        self.selection.fits(record)
            && self.demand.status.as_ref().is_some_and(|status| *status == record.status.name())
    }
}
