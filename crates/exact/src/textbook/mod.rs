//! Exact problems used in the tests of other programs, without a solver in this one.
//!
//! | name | problem | source |
//! |---|---|---|
//! | `biot-column` | Terzaghi's column with a Biot coefficient and grains of finite stiffness | Biot (1941), Detournay & Cheng (1993) |
//! | `cryer` | sphere under a pressure all round, drained at its surface | Cryer (1963) |
//! | `barron` | radial flow to a vertical drain, equal strain | Barron (1948), Hansbo (1981) |
//! | `barron-free-strain` | the same, free strain | Barron (1948) |
//! | `seabed` | column under a wave pressure that acts on soil and pore water | Verruijt (1982) |
//! | `injection` | point source of water in an infinite body | Rudnicki (1986) |
//! | `davis-raymond` | nonlinear column with a constant coefficient of consolidation | Davis & Raymond (1965) |
//!
//! Each has the height `H`, the load `q`, the material and the time factor `T_v = c_v t/H²` of a column, and what
//! [`TextbookParameters`] adds. Where the places are is said with each problem: `ζ = 0` is its drained or loaded end,
//! and `y = (1 − ζ)H` counts from the other one. docs/exact.md has the equations.

mod barron;
mod biot;
mod cryer;
mod davis_raymond;
mod injection;
mod seabed;
mod terms;

use crate::exact_error::ExactError;
use crate::parameters::ColumnParameters;
use crate::row::Row;
use crate::solution::Solution;
use barron::{Barron, BarronFreeStrain};
use biot::BiotColumn;
use cryer::Cryer;
use davis_raymond::DavisRaymond;
use injection::Injection;
use oedometer_wording::words;
use seabed::Seabed;
use std::sync::Arc;

/// A textbook problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextbookProblem {
    /// Terzaghi's column with a Biot coefficient and grains of finite stiffness.
    BiotColumn,
    /// Cryer's sphere.
    Cryer,
    /// Radial flow to a drain, equal strain.
    Barron,
    /// Radial flow to a drain, free strain.
    BarronFreeStrain,
    /// Column under a wave pressure.
    Seabed,
    /// Point source of water.
    Injection,
    /// Nonlinear column with a constant coefficient of consolidation.
    DavisRaymond,
}

words!(
    TextbookProblem:
    BiotColumn "biot-column", Cryer "cryer", Barron "barron", BarronFreeStrain "barron-free-strain",
    Seabed "seabed", Injection "injection", DavisRaymond "davis-raymond",
);

impl core::fmt::Display for TextbookProblem {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.pad(self.name())
    }
}

/// The rows of the problems, in their order.
static ROWS: [Row; 7] = [
    row(TextbookProblem::BiotColumn, biot::INPUTS, true),
    row(TextbookProblem::Cryer, cryer::INPUTS, true),
    row(TextbookProblem::Barron, barron::INPUTS, true),
    row(TextbookProblem::BarronFreeStrain, barron::INPUTS, true),
    row(TextbookProblem::Seabed, seabed::INPUTS, false),
    row(TextbookProblem::Injection, injection::INPUTS, false),
    row(TextbookProblem::DavisRaymond, davis_raymond::INPUTS, false),
];

const fn row(problem: TextbookProblem, inputs: &'static [&'static [&'static str]], adds_up: bool) -> Row {
    Row { name: problem.name(), inputs, adds_up, ..Row::COLUMN }
}

impl TextbookProblem {
    /// What is known of it whatever its parameters.
    pub(crate) const fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// Its solution for a column.
    pub(crate) fn solution(self, parameters: &ColumnParameters) -> Result<Arc<dyn Solution>, ExactError> {
        parameters.validate()?;
        Ok(match self {
            Self::BiotColumn => Arc::new(BiotColumn::new(parameters)?),
            Self::Cryer => Arc::new(Cryer::new(parameters)?),
            Self::Barron => Arc::new(Barron::new(parameters)?),
            Self::BarronFreeStrain => Arc::new(BarronFreeStrain::new(parameters)?),
            Self::Seabed => Arc::new(Seabed::new(parameters)?),
            Self::Injection => Arc::new(Injection::new(parameters)?),
            Self::DavisRaymond => Arc::new(DavisRaymond::new(parameters)?),
        })
    }
}
