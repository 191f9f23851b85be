//! A scene's problem in the dimension that its case asks for: where one `match` turns a number into
//! a type.

use super::{Column, SceneKind, column_problem};
use crate::exact::ExactError;
use crate::solver::body::Problem;
use crate::solver::critical::{CriticalStep, Stopped, critical_step};
use crate::solver::explicit::ExplicitSettings;
use crate::solver::material::Material;
use crate::solver::method::Method;
use crate::solver::outcome::Outcome;
use crate::solver::run::{Observer, Schedule, run};

/// A problem of one or of two dimensions.
#[derive(Clone, Debug)]
pub enum SceneProblem {
    /// A column.
    Column(Problem<1>),
    /// Plane strain.
    Plane(Problem<2>),
}

impl SceneProblem {
    /// The scene's problem on `cells` cells over the height with `points_per_cell` points a cell
    /// and direction.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn new(
        scene: SceneKind,
        column: &Column,
        soil: &Material,
        method: Method,
        cells: usize,
        points_per_cell: usize,
    ) -> Result<Self, ExactError> {
        Ok(if column.dimensions == 1 {
            Self::Column(column_problem(scene, column, soil, method, cells, points_per_cell)?)
        } else {
            Self::Plane(column_problem(scene, column, soil, method, cells, points_per_cell)?)
        })
    }

    /// Predicts and observes its critical step, with runs beside it up to `end` seconds or
    /// `most_steps` steps.
    ///
    /// # Errors
    /// [`Stopped`] where the observer ends it.
    pub fn critical_step(
        &self,
        settings: &ExplicitSettings,
        end: f64,
        most_steps: u64,
        observer: Observer<'_>,
    ) -> Result<CriticalStep, Stopped> {
        match self {
            Self::Column(problem) => critical_step(problem, settings, end, most_steps, observer),
            Self::Plane(problem) => critical_step(problem, settings, end, most_steps, observer),
        }
    }

    /// Solves it.
    pub fn run(self, schedule: &Schedule, observer: Observer<'_>) -> Outcome {
        match self {
            Self::Column(problem) => run(problem, schedule, observer),
            Self::Plane(problem) => run(problem, schedule, observer),
        }
    }
}
