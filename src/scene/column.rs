//! Columns and layers drained at their top: the lattice of points and its start.

use crate::exact::cosine_layer::Base;
use crate::exact::dynamic_column::{DynamicColumn, Start};
use crate::exact::error::ExactError;
use crate::exact::parameters::ColumnParameters;
use crate::exact::single_mode::SingleMode;
use crate::mpm::body::Problem;
use crate::mpm::method::Method;
use crate::mpm::operators::surface_load::LoadShape;
use crate::mpm::state::grid::Grid;
use crate::mpm::state::nodes::Support;
use crate::mpm::state::points::Points;
use crate::scene::SceneKind;
use crate::scene::arrangement::Arrangement;
use crate::soil::material::Material;
use crate::soil::tensor::Tensor;
use serde::{Deserialize, Serialize};

/// Cells above the column, so that a surface that rises stays on the grid.
const HEADROOM: usize = 1;

/// Geometry and load of a column, or of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Column {
    /// Initial height `H`, m.
    pub height: f64,
    /// Width, m; a one-dimensional column has none. Of a layer its length.
    pub width: f64,
    /// Load `q` on the surface, Pa; the amplitude of the initial pressure where there is no load.
    pub load: f64,
    /// Directions that are solved, 1 or 2. Left out of the identity of a case where it is 1: older
    /// records keep theirs.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub dimensions: usize,
    /// How a layer rests on its base; a column's base has no say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Base>,
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

fn one() -> usize {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_one(dimensions: &usize) -> bool {
    *dimensions == 1
}

/// Share of a cell by which a width may miss a whole number of cells.
const WIDTH_TOLERANCE: f64 = 1e-9;

impl Default for Column {
    /// The seed column under 1 Pa, in one dimension.
    fn default() -> Self {
        Self {
            height: 1.0,
            width: 0.1,
            load: 1.0,
            dimensions: 1,
            base: None,
            loading_time: 0.0,
            points: Arrangement::default(),
        }
    }
}

impl Column {
    /// The seed layer: as long as it is high, on a rough base.
    pub fn layer() -> Self {
        Self { width: 1.0, dimensions: 2, base: Some(Base::Rough), ..Self::default() }
    }

    /// Square cells over the width with `cells` over the height; `None` where they do not fill it.
    /// One dimension has one.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and saturates")]
    pub fn cells_across(&self, cells: usize) -> Option<usize> {
        if self.dimensions == 1 {
            return Some(1);
        }
        let across = self.width / self.height * cells as f64;
        let whole = across.round();
        (whole >= 1.0 && (across - whole).abs() <= WIDTH_TOLERANCE * whole).then_some(whole as usize)
    }

    /// Volume of the soil, m^D.
    pub fn volume(&self) -> f64 {
        if self.dimensions == 1 { self.height } else { self.height * self.width }
    }
}

/// The column as the exact solutions take it.
pub fn column_parameters(column: &Column, soil: &Material) -> ColumnParameters {
    ColumnParameters {
        height: column.height,
        length: column.width,
        base: column.base.unwrap_or_default(),
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

/// The scene's problem on `cells` cells over the height with `points_per_cell` points each, in the
/// dimension that is asked for.
///
/// # Errors
/// When the parameters are impossible.
pub fn column_problem<const D: usize>(
    scene: SceneKind,
    column: &Column,
    soil: &Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
) -> Result<Problem<D>, ExactError> {
    let cell_size = column.points.cell_size(column.height, cells);
    let mut extent = [column.cells_across(cells).unwrap_or(1); D];
    extent[D - 1] = cells;
    let mut points = Points::lattice(cell_size, extent, points_per_cell);
    column.points.arrange(&mut points, cell_size, cells);
    let (load, vertical_gradient) = match scene {
        SceneKind::Terzaghi => (column.load, start_undrained(&mut points, soil, column.load)),
        SceneKind::StandingWave => {
            start_standing_wave(&mut points, column, soil)?;
            (0.0, 0.0)
        }
        SceneKind::SingleMode | SceneKind::DynamicSingleMode => {
            start_single_mode(&mut points, column, soil)?;
            (0.0, 0.0)
        }
        // A load that grows finds the soil at rest without stress.
        SceneKind::XieLeo if column.loading_time > 0.0 => (column.load, 0.0),
        SceneKind::XieLeo => (column.load, start_undrained_finite(&mut points, soil, column.load)),
        // At rest without stress; a layer's body then finds its equilibrium by its own operators.
        SceneKind::DynamicColumn | SceneKind::CosineLayer => (column.load, 0.0),
    };
    let mut initial_gradient = [[0.0; D]; D];
    initial_gradient[D - 1][D - 1] = vertical_gradient;
    extent[D - 1] += HEADROOM;
    let support = match column.base {
        Some(Base::Rough) => Support::oedometer().on_rough_base(),
        Some(Base::Smooth) | None => Support::oedometer(),
    };
    Ok(Problem {
        grid: Grid::new(cell_size, extent),
        support,
        points,
        material: *soil,
        method,
        configuration: method.configuration_or(scene.configuration()),
        load,
        load_shape: if scene == SceneKind::CosineLayer {
            LoadShape::Cosine { length: column.width }
        } else {
            LoadShape::Uniform
        },
        undrained_start: scene == SceneKind::CosineLayer,
        loading_time: column.loading_time,
        initial_gradient,
        pressure_scale: column.load.abs(),
        is_bounded: true,
    })
}

/// The undrained equilibrium under the load: skeleton and water share one strain, which is
/// returned, reached before any water has moved.
fn start_undrained<const D: usize>(points: &mut Points<D>, soil: &Material, load: f64) -> f64 {
    let strain = -load / (soil.oedometric_modulus() + soil.coupling_modulus());
    points.effective_stress.fill(soil.stiffness().stress(&vertical(strain)));
    points.pressure.fill(-soil.coupling_modulus() * strain);
    strain
}

/// Corrections of the undrained strain; a few are enough where the water is stiffer than the soil.
const MOST_CORRECTIONS: usize = 60;

/// The undrained equilibrium at finite strain, `p(J) − σ'(J) = q`: returns the displacement
/// gradient `J − 1`.
fn start_undrained_finite<const D: usize>(points: &mut Points<D>, soil: &Material, load: f64) -> f64 {
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
    points.effective_stress.fill(at_rest(soil, modulus * soil.law.uniaxial_stress_ratio(strain)));
    points.pressure.fill(soil.undrained_pressure_at(strain));
    strain
}

fn start_single_mode<const D: usize>(
    points: &mut Points<D>,
    column: &Column,
    soil: &Material,
) -> Result<(), ExactError> {
    let mode = SingleMode::compressible(&column_parameters(column, soil))?;
    for point in 0..points.len() {
        let zeta = 1.0 - points.initial_position[point][D - 1] / column.height;
        let fields = mode.fields(0.0, zeta)?;
        let velocities = mode.velocities(0.0, zeta)?;
        points.pressure[point] = fields.pressure;
        points.effective_stress[point] = at_rest(soil, fields.effective_stress);
        points.solid_velocity[point][D - 1] = velocities.solid;
        points.water_velocity[point][D - 1] = velocities.water;
    }
    Ok(())
}

/// A tensor with a vertical component only.
fn vertical<const D: usize>(component: f64) -> Tensor<D> {
    let mut tensor = [[0.0; D]; D];
    tensor[D - 1][D - 1] = component;
    tensor
}

/// The effective stress of an oedometer, Pa, from its vertical one: `ν/(1 − ν)` of it to the sides.
fn at_rest<const D: usize>(soil: &Material, vertical_stress: f64) -> Tensor<D> {
    let ratio = soil.poissons_ratio / (1.0 - soil.poissons_ratio);
    let mut stress = vertical(vertical_stress);
    for d in 0..D - 1 {
        stress[d][d] = ratio * vertical_stress;
    }
    stress
}

/// Skeleton and water displaced together and let go at rest.
fn start_standing_wave<const D: usize>(
    points: &mut Points<D>,
    column: &Column,
    soil: &Material,
) -> Result<(), ExactError> {
    let parameters = column_parameters(column, soil);
    let wave = DynamicColumn::new(&parameters, Start::StandingWave, &[0.0])?;
    for point in 0..points.len() {
        let zeta = 1.0 - points.initial_position[point][D - 1] / column.height;
        let fields = wave.fields(0.0, zeta)?;
        points.pressure[point] = fields.pressure;
        points.effective_stress[point] = at_rest(soil, fields.effective_stress);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soil::material::Law;

    #[test]
    fn the_undrained_start_is_in_equilibrium_whatever_the_law() {
        for law in Law::ALL {
            for (load, stiffness) in [(1.0, 2.2e9), (2e5, 2.2e9), (2e5, 2e7), (2e5, 2e6)] {
                let soil = Material { law, water_bulk_modulus: stiffness, ..Material::default() };
                let mut points = Points::<1>::lattice(0.1, [10], 2);
                let gradient = start_undrained_finite(&mut points, &soil, load);
                assert!(gradient < 0.0 && gradient > -0.1);
                let total = points.pressure[7] - points.effective_stress[7][0][0];
                assert!((total / load - 1.0).abs() < 1e-9, "{law:?} {load} {stiffness}: {total}");
            }
        }
    }
}
