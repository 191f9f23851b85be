//! The solver core: the v–w material point method for saturated soil, with one set of material points or with two.
//!
//! Folders are floors; each uses only those below it, which a test keeps (`src/tests/source_order.rs` of `oedometer`). From the
//! ground up:
//!
//! - `time_limit`, `direct_solver`: deadlines and linear systems, which know nothing of points and nodes;
//! - `state`: grid, points, nodes, cells;
//! - `operators`: a method is four independent operators, each sparse between points, nodes and cell centres: shape
//!   functions, strain gradient, pressure divergence and recovery;
//! - `drag`: of a point, of a node, and what it allows as a step;
//! - `actions`: what acts on a body, each a type that the kernel calls at a named place;
//! - `kernel`: a body joins all of these; its step is that of Zheng et al. (2021), by name and in order in `kernel/step.rs`;
//! - `integrate`: ways through time: the kernel's step, the same as sparse maps where nothing moves, the water in points of
//!   its own, implicit steps of any size; with critical steps, schedules and results;
//! - `run`: chooses an integrator and drives it from output to output under watch;
//! - `discretise`: grid and points of a problem.
//!
//! Nothing here knows of scenes, exact solutions, studies, records or reports.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod actions;
mod direct_solver;
pub mod discretise;
mod drag;
mod entries;
pub mod integrate;
pub mod kernel;
pub mod operators;
pub mod run;
pub mod state;
pub mod time_limit;

pub(crate) use oedometer_soil::wide;

#[cfg(test)]
mod tests {
    pub(crate) mod double_point_columns;
    mod registers;

    use crate::discretise::discretise;
    use crate::kernel::body::Discrete;
    use oedometer_problem::method::Method;
    use oedometer_problem::problem::StartError;
    use oedometer_scenes::Scene;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    /// A scene's problem, discretised.
    pub(crate) fn column_problem<const D: usize>(
        scene: &'static Scene,
        column: &Column,
        soil: &Material,
        method: Method,
        cells: usize,
        points_per_cell: usize,
    ) -> Result<Discrete<D>, StartError> {
        discretise(&scene.problem(column, soil, method, cells, points_per_cell)?)
    }
}
