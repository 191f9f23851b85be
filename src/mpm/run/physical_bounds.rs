//! What a sound result cannot leave, whatever the method: looked at while a run goes on.

use crate::mpm::body::Problem;
use crate::mpm::operators::rigid_plate::NORMAL;
use crate::mpm::operators::surface_load::{LoadShape, LoadedSurface};

/// Settlements over their scale that no scene reaches.
///
/// Consolidation ends at one and never heaves. An undamped wave under a load that acts at once
/// swings its free end to twice the static settlement; half of that again is left to the mesh.
const SETTLEMENTS: [f64; 2] = [-1.0, 3.0];
/// Pore pressure over the load that no loaded column reaches.
///
/// Undrained it is at most the load, and a wave doubles that at the base; steps of a mesh overshoot
/// by as much again at a front.
const MOST_PRESSURE: f64 = 5.0;

/// Bounds of settlement and pressure that the scene of a problem sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhysicalBounds {
    /// Settlement that the problem's pressure makes in the end, or more, m.
    pub settlement_scale: f64,
    /// Least and largest settlement, m.
    settlement: [f64; 2],
    /// Largest pressure, Pa, either way.
    pressure: f64,
}

impl PhysicalBounds {
    /// The bounds of a problem.
    pub fn of<const D: usize>(problem: &Problem<D>) -> Self {
        let scale = settlement_scale(problem);
        let pressure = match problem.load_shape {
            LoadShape::Uniform => MOST_PRESSURE * problem.pressure_scale,
            // A layer of a method that locks starts at hundreds of times its load: that is what such
            // studies are about, and it is no end of a run.
            LoadShape::Cosine { .. } => f64::INFINITY,
        };
        if problem.is_bounded {
            Self { settlement_scale: scale, settlement: SETTLEMENTS.map(|share| share * scale), pressure }
        } else {
            let without = f64::INFINITY;
            Self { settlement_scale: scale, settlement: [-without, without], pressure: without }
        }
    }

    /// Why a settlement, m, is none of the scene's, where it is not.
    pub fn left_by_settlement(&self, settlement: f64) -> Option<String> {
        let [least, most] = self.settlement;
        // What is no number is in no range.
        if settlement.is_finite() && (least..=most).contains(&settlement) {
            return None;
        }
        Some(format!(
            "a settlement of {settlement:.3e} m is beyond what the scene can reach, {least:.3e} to {most:.3e} m"
        ))
    }

    /// Why pressures, Pa, are none of the scene's, where they are not.
    pub fn left_by_pressure(&self, pressures: &[f64]) -> Option<String> {
        let within = |pressure: &&f64| pressure.is_finite() && pressure.abs() <= self.pressure;
        let outside = pressures.iter().find(|pressure| !within(pressure))?;
        Some(format!(
            "a pore pressure of {outside:.3e} Pa is beyond what the scene can reach, {:.3e} Pa",
            self.pressure
        ))
    }
}

/// Settlement, m, that a problem's pressure makes in a column, `m_v q H`; of a plate across it,
/// `(1 − ν²) q b/E`; under a cosine at most that
/// and the one of a half-space, `2 (1 − ν²) q/(E k)`, which is left where shear is all that gives.
fn settlement_scale<const D: usize>(problem: &Problem<D>) -> f64 {
    let soil = &problem.material;
    if problem.plate_load.is_some() {
        let distance = problem.grid.cells[NORMAL] as f64 * problem.grid.cell_size;
        let compliance = (1.0 - soil.poissons_ratio * soil.poissons_ratio) / soil.youngs_modulus;
        return problem.pressure_scale * compliance * distance;
    }
    // The mean height: a cosine has none of its own.
    let height = LoadedSurface::of(&problem.points, problem.load).height(&problem.points);
    let column = problem.pressure_scale / soil.oedometric_modulus() * height;
    match problem.load_shape {
        LoadShape::Uniform => column,
        LoadShape::Cosine { length } => {
            let wave_number = std::f64::consts::PI / length;
            let compliance = 2.0 * (1.0 - soil.poissons_ratio * soil.poissons_ratio) / soil.youngs_modulus;
            column + problem.pressure_scale * compliance / wave_number
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mpm::method::Method;
    use crate::scene::SceneKind;
    use crate::scene::column::Column;
    use crate::scene::problem::column_problem;
    use crate::soil::material::Material;

    fn bounds_of(scene: SceneKind, column: &Column, soil: &Material) -> PhysicalBounds {
        let method = Method::named("GC-SRI-patch").expect("the paper's method");
        if scene.needs_two_dimensions() {
            PhysicalBounds::of(&column_problem::<2>(scene, column, soil, method, 4, 2).expect("a layer"))
        } else {
            PhysicalBounds::of(&column_problem::<1>(scene, column, soil, method, 4, 2).expect("a column"))
        }
    }

    #[test]
    fn a_column_is_held_to_what_consolidation_and_waves_can_reach() {
        let soil = Material::default();
        let bounds = bounds_of(SceneKind::Terzaghi, &Column::default(), &soil);
        let whole = 1.0 / soil.oedometric_modulus();
        for (settlement, is_within) in
            [(0.0, true), (2.0, true), (-0.9, true), (3.1, false), (-1.1, false), (f64::NAN, false)]
        {
            assert_eq!(bounds.left_by_settlement(settlement * whole).is_none(), is_within, "{settlement}");
        }
        for (pressure, is_within) in [(1.0, true), (-4.0, true), (6.0, false), (f64::INFINITY, false)] {
            assert_eq!(bounds.left_by_pressure(&[0.5, pressure]).is_none(), is_within, "{pressure}");
        }
    }

    #[test]
    fn a_layer_without_compressibility_still_settles_by_shear() {
        let soil = Material { poissons_ratio: 0.4999, ..Material::default() };
        let layer = Column { height: 10.0, ..Column::layer() };
        let bounds = bounds_of(SceneKind::CosineLayer, &layer, &soil);
        // A half-space under a cosine of a metre: 2 (1 − ν²) q L/(π E).
        let half_space = 2.0 * (1.0 - 0.4999_f64.powi(2)) / (std::f64::consts::PI * soil.youngs_modulus);
        assert!(bounds.settlement_scale > half_space && bounds.settlement_scale < 1.1 * half_space);
        assert!(bounds.left_by_pressure(&[300.0]).is_none(), "locked, and not ended");
    }
}
