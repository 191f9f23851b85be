//! A scene's problem in the dimension that its case asks for: where one `match` turns a number into
//! a type.

use crate::exact::exact_error::ExactError;
use crate::mpm::body::Problem;
use crate::mpm::critical_step::observed::{CriticalStep, Stopped, critical_step};
use crate::mpm::explicit::ExplicitSettings;
use crate::mpm::method::Method;
use crate::mpm::run::outcome::Outcome;
use crate::mpm::run::{Observer, Schedule, run};
use crate::scene::SceneKind;
use crate::scene::column::{Column, column_problem};
use crate::soil::material::Material;

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
