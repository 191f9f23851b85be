//! Joint fit of an error over mesh, time step and points per cell:
//! `e = A h^p + B Δt^q + C n^−r + F` with `A, B, C, F ≥ 0`.
//!
//! Refining one axis alone need not converge, and refining two together shows the smaller order;
//! the joint fit says which axis limits which run. Residuals are relative, so that all runs count
//! alike; coefficients are eliminated (variable projection), exponents searched for.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::convergence::fit::least_squares::solve_nonnegative;
use crate::convergence::fit::pattern_search::least;
use crate::convergence::fit::two_terms::Exponent;
use crate::elementary;

/// What a run varies, and its error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Cell size `h` in m.
    pub cell_size: f64,
    /// Time step `Δt` in s.
    pub time_step: f64,
    /// Points per cell `n`.
    pub points_per_cell: f64,
    /// The error, relative or in the unit of the quantity.
    pub error: f64,
}

/// The terms of the fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// `A h^p`.
    Mesh,
    /// `B Δt^q`.
    Step,
    /// `C n^−r`.
    PointsPerCell,
    /// `F`: what no axis moves.
    Floor,
}

/// The exponents of the three axes, given or searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponents {
    /// `p`.
    pub mesh: Exponent,
    /// `q`.
    pub step: Exponent,
    /// `r`.
    pub points_per_cell: Exponent,
}

impl Default for Exponents {
    fn default() -> Self {
        let free = Exponent::Between(0.5, 4.0);
        Self { mesh: free, step: free, points_per_cell: free }
    }
}

/// One term `coefficient · x^order`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Term {
    /// The axis.
    pub axis: Axis,
    /// Its coefficient, not negative; for runs in the units of [`Run`].
    pub coefficient: f64,
    /// Its order; 0 for the floor, and for points per cell the order in `1/n`. Where the
    /// coefficient is 0 it means nothing.
    pub order: f64,
}

/// How much each term makes up of one run's error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// Shares from 0 to 1, for each term of the fit, in its order.
    pub shares: Vec<f64>,
    /// The axis with the largest share: the one to refine.
    pub limiting: Axis,
}

/// The joint fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointFit {
    /// The terms of the axes that were varied, and the floor last.
    pub terms: Vec<Term>,
    /// Axes with one value in all runs: what they do is part of the floor.
    pub not_varied: Vec<Axis>,
    /// Root mean square of the relative residuals.
    pub residual: f64,
    /// For every run, in the order given.
    pub runs: Vec<Shares>,
}

/// Why there is no joint fit.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
pub enum NoJointFit {
    /// A run has a number that is not positive and finite.
    #[error("run {number} has a size, step, number of points or error that is not positive")]
    BadRun {
        /// Number of the run in the list, from 1.
        number: usize,
    },
    /// No axis has two values.
    #[error("no axis is varied")]
    NothingVaried,
    /// There are not more runs than numbers to fit.
    #[error("{runs} runs are too few: {needed} are needed")]
    TooFewRuns {
        /// Runs there are.
        runs: usize,
        /// Runs needed.
        needed: usize,
    },
    /// One axis follows the others in every run.
    #[error("the axes {axes:?} are tied along one path: vary one of them alone in some runs")]
    Tied {
        /// The varied axes.
        axes: Vec<Axis>,
    },
    /// The numbers leave the range of a double.
    #[error("the runs do not determine a fit")]
    NotDetermined,
}

impl JointFit {
    /// The term of an axis, if it is part of the fit.
    pub fn term(&self, axis: Axis) -> Option<&Term> {
        self.terms.iter().find(|term| term.axis == axis)
    }
}

/// One varied axis: its values scaled by the largest, which serves for the units at the end.
struct Varied {
    axis: Axis,
    values: Vec<f64>,
    largest: f64,
    exponent: Exponent,
}

/// Fits all runs together.
///
/// # Errors
/// [`NoJointFit`] says what the runs lack.
pub fn fit_jointly(runs: &[Run], exponents: &Exponents) -> Result<JointFit, NoJointFit> {
    let positive = |value: f64| value.is_normal() && value > 0.0;
    let sound =
        |run: &Run| [run.cell_size, run.time_step, run.points_per_cell, run.error].into_iter().all(positive);
    if let Some(index) = runs.iter().position(|run| !sound(run)) {
        return Err(NoJointFit::BadRun { number: index + 1 });
    }
    let axes = [
        (Axis::Mesh, exponents.mesh, runs.iter().map(|run| run.cell_size).collect::<Vec<_>>()),
        (Axis::Step, exponents.step, runs.iter().map(|run| run.time_step).collect()),
        (
            Axis::PointsPerCell,
            exponents.points_per_cell,
            runs.iter().map(|run| 1.0 / run.points_per_cell).collect(),
        ),
    ];
    let (mut varied, mut not_varied) = (Vec::new(), Vec::new());
    for (axis, exponent, values) in axes {
        let largest = values.iter().copied().fold(0.0, f64::max);
        if values.iter().all(|value| *value > largest * (1.0 - 1e-9)) {
            not_varied.push(axis);
        } else {
            let values = values.iter().map(|value| value / largest).collect();
            varied.push(Varied { axis, values, largest, exponent });
        }
    }
    if varied.is_empty() {
        return Err(NoJointFit::NothingVaried);
    }
    if tied(&varied) {
        return Err(NoJointFit::Tied { axes: varied.iter().map(|axis| axis.axis).collect() });
    }
    let free = |axis: &&Varied| matches!(axis.exponent, Exponent::Between(..));
    let needed = varied.len() + 1 + varied.iter().filter(free).count() + 1;
    if runs.len() < needed {
        return Err(NoJointFit::TooFewRuns { runs: runs.len(), needed });
    }
    let errors: Vec<f64> = runs.iter().map(|run| run.error).collect();
    let ranges: Vec<_> = varied.iter().map(|axis| axis.exponent.range()).collect();
    let square = |orders: &[f64]| project(&varied, &errors, orders).map_or(f64::INFINITY, |found| found.1);
    let orders = least(&ranges, square);
    let (coefficients, square) = project(&varied, &errors, &orders).ok_or(NoJointFit::NotDetermined)?;
    let residual = (square / runs.len() as f64).sqrt();
    describe(&varied, not_varied, &coefficients, &orders, residual).ok_or(NoJointFit::NotDetermined)
}

/// Whether the logarithms of the axes lie in fewer dimensions than there are axes.
fn tied(varied: &[Varied]) -> bool {
    let count = varied[0].values.len();
    let column = |j: usize| {
        let mean = varied[j].values.iter().map(|value| elementary::ln(*value)).sum::<f64>() / count as f64;
        let logs: Vec<_> = varied[j].values.iter().map(|value| elementary::ln(*value) - mean).collect();
        let norm = logs.iter().map(|log| log * log).sum::<f64>().sqrt();
        logs.into_iter().map(move |log| log / norm).collect::<Vec<_>>()
    };
    let columns: Vec<_> = (0..varied.len()).map(column).collect();
    let matrix = DMatrix::from_fn(count, varied.len(), |row, j| columns[j][row]);
    count < varied.len() || matrix.singular_values().min() < 1e-3
}

/// Coefficients of the terms (floor last) and the sum of squared relative residuals.
fn project(varied: &[Varied], errors: &[f64], orders: &[f64]) -> Option<(Vec<f64>, f64)> {
    let column = |(axis, order): (&Varied, &f64)| -> Vec<f64> {
        axis.values.iter().zip(errors).map(|(x, error)| elementary::powf(*x, *order) / error).collect()
    };
    let mut columns: Vec<_> = varied.iter().zip(orders).map(column).collect();
    columns.push(errors.iter().map(|error| 1.0 / error).collect());
    // Columns of one size each keep the rank test meaningful.
    let norms: Vec<f64> = columns
        .iter_mut()
        .map(|column| {
            let norm = column.iter().copied().fold(0.0, f64::max);
            for value in column.iter_mut() {
                *value /= norm;
            }
            norm
        })
        .collect();
    let ones = vec![1.0; errors.len()];
    let (mut coefficients, square) = solve_nonnegative(&columns, &ones, &ones)?;
    for (coefficient, norm) in coefficients.iter_mut().zip(norms) {
        *coefficient /= norm;
    }
    Some((coefficients, square))
}

fn describe(
    varied: &[Varied],
    not_varied: Vec<Axis>,
    coefficients: &[f64],
    orders: &[f64],
    residual: f64,
) -> Option<JointFit> {
    let mut terms: Vec<_> = varied
        .iter()
        .zip(coefficients.iter().zip(orders))
        .map(|(axis, (coefficient, order))| Term {
            axis: axis.axis,
            coefficient: coefficient / elementary::powf(axis.largest, *order),
            order: *order,
        })
        .collect();
    let floor = *coefficients.last()?;
    terms.push(Term { axis: Axis::Floor, coefficient: floor, order: 0.0 });
    let shares = |run: usize| {
        let part =
            |(axis, (c, order)): (&Varied, (&f64, &f64))| c * elementary::powf(axis.values[run], *order);
        let mut parts: Vec<_> = varied.iter().zip(coefficients.iter().zip(orders)).map(part).collect();
        parts.push(floor);
        let total: f64 = parts.iter().sum();
        let shares: Vec<_> = parts.iter().map(|part| part / total).collect();
        let largest = (0..shares.len()).max_by(|a, b| shares[*a].total_cmp(&shares[*b]))?;
        Some(Shares { limiting: terms[largest].axis, shares })
    };
    let runs: Option<Vec<_>> = (0..varied.first()?.values.len()).map(shares).collect();
    let finite = terms.iter().all(|term| term.coefficient.is_finite()) && residual.is_finite();
    let fit = JointFit { runs: runs?, terms, not_varied, residual };
    finite.then_some(fit)
}

#[cfg(test)]
#[path = "../../../tests/unit/convergence_fit_joint.rs"]
mod tests;
