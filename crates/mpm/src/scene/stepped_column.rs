//! A column that takes single steps: for tests outside of this crate, which would compile the step anew for themselves if
//! they named its number of dimensions.

use crate::assembled::step::AssembledStep;
use crate::body::Body;
use crate::critical_step::predicted::predicted_critical_step;
use crate::explicit::ExplicitSettings;
use crate::method::Method;
use crate::scene::SceneKind;
use crate::scene::column::Column;
use crate::scene::problem::column_problem;
use oedometer_exact::exact_error::ExactError;
use oedometer_soil::material::Material;

/// A column of a scene before its first step, point by point and, where its points keep their weights, assembled.
#[derive(Debug)]
pub struct SteppedColumn {
    settings: ExplicitSettings,
    /// Critical step that is predicted, s.
    pub critical_step: f64,
    body: Body<1>,
    assembled: Option<AssembledStep<1>>,
}

impl SteppedColumn {
    /// The column of a scene on `cells` cells of `points_per_cell` points each.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn new(
        scene: SceneKind,
        (column, soil, method): (&Column, &Material, Method),
        [cells, points_per_cell]: [usize; 2],
        settings: ExplicitSettings,
    ) -> Result<Self, ExactError> {
        let problem = column_problem(scene, column, soil, method, cells, points_per_cell)?;
        let critical_step = predicted_critical_step(&problem, &settings);
        let body = Body::new(problem);
        let assembled = (!body.configuration.deforms()).then(|| AssembledStep::new(&body));
        Ok(Self { settings, critical_step, body, assembled })
    }

    /// Prepares the assembled operators for steps of `dt` seconds; `false` where the points' weights change.
    pub fn set_step(&mut self, dt: f64) -> bool {
        self.assembled.as_mut().is_some_and(|assembled| {
            assembled.set_step(dt, &self.settings);
            true
        })
    }

    /// One step of `dt` seconds by the assembled operators, where there are any.
    pub fn assembled_step(&mut self, dt: f64) {
        if let Some(assembled) = &mut self.assembled {
            assembled.step(dt, &self.settings);
        }
    }

    /// One step of `dt` seconds point by point.
    pub fn step(&mut self, dt: f64) {
        self.body.explicit_step(dt, &self.settings);
    }

    /// Largest velocity of a node, m/s, point by point and assembled; 0 where there are no assembled operators.
    pub fn largest_velocities(&self) -> [f64; 2] {
        [self.body.largest_velocity(), self.assembled.as_ref().map_or(0.0, AssembledStep::largest_velocity)]
    }
}
