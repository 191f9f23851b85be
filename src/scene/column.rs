//! Columns drained at their top: the lattice of points and its start.

use super::{Arrangement, SceneKind};
use crate::exact::dynamic_column::{DynamicColumn, Start};
use crate::exact::single_mode::SingleMode;
use crate::exact::{ColumnParameters, ExactError};
use crate::solver::body::Problem;
use crate::solver::grid::Grid;
use crate::solver::material::Material;
use crate::solver::method::Method;
use crate::solver::nodes::Support;
use crate::solver::points::Points;
use serde::{Deserialize, Serialize};

/// Cells above the column, so that a surface that rises stays on the grid.
const HEADROOM: usize = 1;

/// Geometry and load of a column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Initial height `H`, m.
    pub height: f64,
    /// Width, m; a one-dimensional column has none.
    pub width: f64,
    /// Load `q` on the surface, Pa; the amplitude of the initial pressure where there is no load.
    pub load: f64,
    /// Time over which the load grows linearly, s; 0 where it acts at once.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub loading_time: f64,
    /// Where the points lie in their cells.
    #[serde(default, skip_serializing_if = "Arrangement::is_regular")]
    pub points: Arrangement,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Default for Column {
    /// The seed column under 1 Pa.
    fn default() -> Self {
        Self { height: 1.0, width: 0.1, load: 1.0, loading_time: 0.0, points: Arrangement::default() }
    }
}

/// The column as the exact solutions take it.
pub fn column_parameters(column: &Column, soil: &Material) -> ColumnParameters {
    ColumnParameters {
        height: column.height,
        load: column.load,
        youngs_modulus: soil.youngs_modulus,
        poissons_ratio: soil.poissons_ratio,
        porosity: soil.porosity,
        grain_density: soil.grain_density,
        water_density: soil.water_density,
        water_bulk_modulus: soil.water_bulk_modulus,
        hydraulic_conductivity: soil.hydraulic_conductivity,
        gravity: soil.gravity,
        loading_time: column.loading_time,
    }
}

/// The scene's problem on `cells` cells over the height with `points_per_cell` points each.
///
/// # Errors
/// When the parameters are impossible.
pub fn column_problem(
    scene: SceneKind,
    column: &Column,
    soil: &Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
) -> Result<Problem<1>, ExactError> {
    let cell_size = column.points.cell_size(column.height, cells);
    let mut points = Points::lattice(cell_size, [cells], points_per_cell);
    column.points.arrange(&mut points, cell_size, cells);
    let (load, initial_gradient) = match scene {
        SceneKind::Terzaghi => (column.load, [[start_undrained(&mut points, soil, column.load)]]),
        SceneKind::DynamicColumn => (column.load, [[0.0]]),
        SceneKind::StandingWave => {
            start_standing_wave(&mut points, column, soil)?;
            (0.0, [[0.0]])
        }
        SceneKind::SingleMode | SceneKind::DynamicSingleMode => {
            start_single_mode(&mut points, column, soil)?;
            (0.0, [[0.0]])
        }
        SceneKind::XieLeo => (column.load, [[start_undrained_finite(&mut points, soil, column.load)]]),
    };
    Ok(Problem {
        grid: Grid::new(cell_size, [cells + HEADROOM]),
        support: Support::oedometer(),
        points,
        material: *soil,
        method,
        configuration: method.configuration_or(scene.configuration()),
        load,
        loading_time: column.loading_time,
        initial_gradient,
        pressure_scale: column.load.abs(),
    })
}

/// The undrained equilibrium under the load: skeleton and water share one strain, which is
/// returned, reached before any water has moved.
fn start_undrained(points: &mut Points<1>, soil: &Material, load: f64) -> f64 {
    let strain = -load / (soil.oedometric_modulus() + soil.coupling_modulus());
    points.effective_stress.fill(soil.stiffness().stress(&[[strain]]));
    points.pressure.fill(-soil.coupling_modulus() * strain);
    strain
}

/// Corrections of the undrained strain; a few are enough where the water is stiffer than the soil.
const MOST_CORRECTIONS: usize = 60;

/// The undrained equilibrium at finite strain, `p(J) − σ'(J) = q`: returns the displacement
/// gradient `J − 1`.
fn start_undrained_finite(points: &mut Points<1>, soil: &Material, load: f64) -> f64 {
    let modulus = soil.oedometric_modulus();
    let carried =
        |strain: f64| soil.undrained_pressure_at(strain) - modulus * soil.law.uniaxial_stress_ratio(strain);
    let mut strain = 0.0;
    for _ in 0..MOST_CORRECTIONS {
        // The tangent of the unstrained state: the undrained strain is tiny, and it converges fast.
        let change = (carried(strain) - load) / (modulus + soil.coupling_modulus());
        strain += change;
        if change.abs() < f64::EPSILON * strain.abs() {
            break;
        }
    }
    points.effective_stress.fill([[modulus * soil.law.uniaxial_stress_ratio(strain)]]);
    points.pressure.fill(soil.undrained_pressure_at(strain));
    strain
}

fn start_single_mode(points: &mut Points<1>, column: &Column, soil: &Material) -> Result<(), ExactError> {
    let mode = SingleMode::compressible(&column_parameters(column, soil))?;
    for point in 0..points.len() {
        let zeta = 1.0 - points.initial_position[point][0] / column.height;
        let fields = mode.fields(0.0, zeta)?;
        let velocities = mode.velocities(0.0, zeta)?;
        points.pressure[point] = fields.pressure;
        points.effective_stress[point] = [[fields.effective_stress]];
        points.solid_velocity[point] = [velocities.solid];
        points.water_velocity[point] = [velocities.water];
    }
    Ok(())
}

/// Skeleton and water displaced together and let go at rest.
fn start_standing_wave(points: &mut Points<1>, column: &Column, soil: &Material) -> Result<(), ExactError> {
    let parameters = column_parameters(column, soil);
    let wave = DynamicColumn::new(&parameters, Start::StandingWave, &[0.0])?;
    for point in 0..points.len() {
        let zeta = 1.0 - points.initial_position[point][0] / column.height;
        let fields = wave.fields(0.0, zeta)?;
        points.pressure[point] = fields.pressure;
        points.effective_stress[point] = [[fields.effective_stress]];
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::material::Law;

    #[test]
    fn the_undrained_start_is_in_equilibrium_whatever_the_law() {
        for law in Law::ALL {
            for (load, stiffness) in [(1.0, 2.2e9), (2e5, 2.2e9), (2e5, 2e7), (2e5, 2e6)] {
                let soil = Material { law, water_bulk_modulus: stiffness, ..Material::default() };
                let mut points = Points::lattice(0.1, [10], 2);
                let gradient = start_undrained_finite(&mut points, &soil, load);
                assert!(gradient < 0.0 && gradient > -0.1);
                let total = points.pressure[7] - points.effective_stress[7][0][0];
                assert!((total / load - 1.0).abs() < 1e-9, "{law:?} {load} {stiffness}: {total}");
            }
        }
    }
}
