//! The critical time step of a problem, predicted from its own operators.

use super::assembled::AssembledColumn;
use super::body::{Body, Gimp, Hat, Problem};
use super::explicit::ExplicitSettings;
use super::grid::Grid;
use super::limits;
use super::method::Basis;
use super::stability::{self, GROWTH_TOLERANCE};

/// Cells of the column on which the critical step of a run is computed.
const FEW_CELLS: usize = 12;

/// A predicted critical step, with what it was predicted from.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Largest stable step, s.
    pub critical_step: f64,
    column: Option<AssembledColumn>,
    settings: ExplicitSettings,
}

impl Prediction {
    /// Largest step, s, under which nothing grows by more than `growth` a step.
    pub fn critical_step_for(&self, growth: f64) -> f64 {
        let safe = self.critical_step;
        let search = |column| stability::critical_step(column, &self.settings, safe, growth);
        self.column.as_ref().map_or(safe, search)
    }

    /// Growth a step of what grows fastest under steps of a size; 1 where the operator is not
    /// known.
    pub fn growth(&self, step: f64) -> f64 {
        let operator = |column| stability::step_operator(column, step, &self.settings);
        self.column.as_ref().map_or(1.0, |column| stability::spectral_radius(&operator(column)))
    }
}

/// Critical step, s, of the explicit integrator on a problem's initial configuration.
///
/// Computed on the problem's own operators; a long column loses its middle, which moves the limit
/// by less than a percent. Above one dimension, the safe formula.
pub fn predicted_critical_step<const D: usize>(problem: &Problem<D>, settings: &ExplicitSettings) -> f64 {
    predict(problem, settings, FEW_CELLS).critical_step
}

/// The prediction on at most so many cells.
pub fn predict<const D: usize>(
    problem: &Problem<D>,
    settings: &ExplicitSettings,
    most_cells: usize,
) -> Prediction {
    let safe = limits::combined_limit(&problem.material, problem.grid.cell_size, settings.drag);
    let problem = without_middle(problem, most_cells);
    let column = match problem.method.basis {
        Basis::Hat => AssembledColumn::new(&Body::<D, 2, Hat>::new(problem)),
        Basis::Ugimp | Basis::Cpgimp => AssembledColumn::new(&Body::<D, 3, Gimp>::new(problem)),
    };
    let critical_step = column
        .as_ref()
        .map_or(safe, |column| stability::critical_step(column, settings, safe, GROWTH_TOLERANCE));
    Prediction { critical_step, column, settings: *settings }
}

/// The problem with as many cells taken out of its middle as it has too many: base and surface, where
/// it is special, stay as they are.
fn without_middle<const D: usize>(problem: &Problem<D>, most_cells: usize) -> Problem<D> {
    let up = D - 1;
    let cell_size = problem.grid.cell_size;
    let mut cut = problem.clone();
    let first = problem.grid.cell_of(&[0.0; D])[up];
    let rows: Vec<usize> =
        cut.points.position.iter().map(|place| problem.grid.cell_of(place)[up] - first).collect();
    let cells = rows.iter().max().map_or(0, |top| top + 1);
    if cells <= most_cells {
        return cut;
    }
    let (below, removed) = (most_cells / 2, cells - most_cells);
    let keep: Vec<usize> =
        (0..rows.len()).filter(|point| rows[*point] < below || rows[*point] >= below + removed).collect();
    for point in keep.iter().filter(|point| rows[**point] >= below) {
        let down = removed as f64 * cell_size;
        cut.points.position[*point][up] -= down;
        cut.points.initial_position[*point][up] -= down;
    }
    cut.points = cut.points.select(&keep);
    let mut extent = problem.grid.cells;
    extent[up] -= removed;
    cut.grid = Grid::new(cell_size, extent);
    cut
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Arrangement, Column, SceneKind, column_problem};
    use crate::solver::explicit::Drag;
    use crate::solver::material::Material;
    use crate::solver::method::Method;

    #[test]
    fn a_column_without_its_middle_has_the_limit_of_the_whole() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        for (name, filling) in [("GIMP", 1.0), ("GC-SRI-patch", 1.0), ("GIMP-SRI-patch", 0.1)] {
            let points = Arrangement { filling, ..Arrangement::default() };
            let column = Column { points, ..Column::default() };
            let method = Method::named(name).expect("a known method");
            let problem = column_problem(SceneKind::Terzaghi, &column, &Material::default(), method, 30, 2)
                .expect("the seed column");
            let whole = predict(&problem, &settings, 30).critical_step;
            let cut = predict(&problem, &settings, FEW_CELLS).critical_step;
            assert!((cut / whole - 1.0).abs() < 0.01, "{name} {filling}: {cut} for {whole}");
        }
    }
}
