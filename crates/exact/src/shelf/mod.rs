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
//! [`ShelfParameters`] adds. Where the places are is said with each problem: `ζ = 0` is its drained or loaded end,
//! and `y = (1 − ζ)H` counts from the other one. docs/exact.md has the equations.

mod barron;
mod biot;
mod cryer;
mod davis_raymond;
mod injection;
mod seabed;

use crate::exact_error::ExactError;
use crate::parameters::ColumnParameters;
use crate::solution::{Accuracy, Solution};
use barron::{Barron, BarronFreeStrain};
use biot::BiotColumn;
use cryer::Cryer;
use davis_raymond::DavisRaymond;
use injection::Injection;
use oedometer_soil::wording::words;
use seabed::Seabed;
use std::sync::Arc;

/// A problem of the shelf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShelfProblem {
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
    ShelfProblem:
    BiotColumn "biot-column", Cryer "cryer", Barron "barron", BarronFreeStrain "barron-free-strain",
    Seabed "seabed", Injection "injection", DavisRaymond "davis-raymond",
);

impl core::fmt::Display for ShelfProblem {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.pad(self.name())
    }
}

/// What the problems of the shelf ask beyond a column; each heeds those of [`ShelfKey`] that name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShelfParameters {
    /// Biot coefficient `α`; without it `1 − K/K_s`, and 1 without both.
    pub biot_coefficient: Option<f64>,
    /// Bulk modulus of the grains `K_s`, Pa; without it `K/(1 − α)`, infinite where `α = 1`.
    pub grain_bulk_modulus: Option<f64>,
    /// Radius `r_w` of a drain, m.
    pub drain_radius: f64,
    /// Period of a wave, s.
    pub wave_period: f64,
    /// Vertical effective stress of the start, compression positive, Pa; without it that of the load.
    pub initial_stress: Option<f64>,
}

impl Default for ShelfParameters {
    fn default() -> Self {
        Self {
            biot_coefficient: None,
            grain_bulk_modulus: None,
            drain_radius: 0.05,
            wave_period: 10.0,
            initial_stress: None,
        }
    }
}

/// A key of a problem's own input, for command lines.
#[derive(Clone, Copy, Debug)]
pub struct ShelfKey {
    /// Dotted, as other keys are.
    pub key: &'static str,
    /// Problems that heed it.
    pub problems: &'static [ShelfProblem],
    /// SI unit, empty where it has none.
    pub unit: &'static str,
    /// Sets it.
    pub set: fn(&mut ShelfParameters, f64),
}

/// Problems of Biot's full equations.
const OF_BIOT: &[ShelfProblem] =
    &[ShelfProblem::BiotColumn, ShelfProblem::Cryer, ShelfProblem::Seabed, ShelfProblem::Injection];
/// Problems of flow to a drain.
const OF_DRAINS: &[ShelfProblem] = &[ShelfProblem::Barron, ShelfProblem::BarronFreeStrain];

impl ShelfKey {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::of("material.biot_coefficient", OF_BIOT, "", |shelf, value| {
            shelf.biot_coefficient = Some(value);
        }),
        Self::of("material.grain_bulk_modulus", OF_BIOT, "Pa", |shelf, value| {
            shelf.grain_bulk_modulus = Some(value);
        }),
        Self::of("drain.radius", OF_DRAINS, "m", |shelf, value| shelf.drain_radius = value),
        Self::of("wave.period", &[ShelfProblem::Seabed], "s", |shelf, value| shelf.wave_period = value),
        Self::of("column.initial_stress", &[ShelfProblem::DavisRaymond], "Pa", |shelf, value| {
            shelf.initial_stress = Some(value);
        }),
    ];

    const fn of(
        key: &'static str,
        problems: &'static [ShelfProblem],
        unit: &'static str,
        set: fn(&mut ShelfParameters, f64),
    ) -> Self {
        Self { key, problems, unit, set }
    }
}

impl ShelfProblem {
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

/// What the terms left out of a series may add to the pressure over the load.
const NEGLIGIBLE: f64 = 1e-17;

/// The least number of terms, up to `most`, whose bound on the rest is negligible, with that bound.
///
/// # Errors
/// When there are too few terms for the time.
fn terms_for(most: usize, time_factor: f64, tail: impl Fn(usize) -> f64) -> Result<Accuracy, ExactError> {
    if tail(most) > NEGLIGIBLE {
        return Err(ExactError::TooEarly { time_factor, terms: most });
    }
    // The bound falls with the number of terms.
    let (mut few, mut enough) = (0, most);
    while enough - few > 1 {
        let middle = usize::midpoint(few, enough);
        if tail(middle) > NEGLIGIBLE { few = middle } else { enough = middle }
    }
    Ok(Accuracy { phase_bound: ROUND_OFF * enough as f64, ..Accuracy::of(enough, tail(enough)) })
}

/// What a term's round-off may add to the pressure over the load.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
