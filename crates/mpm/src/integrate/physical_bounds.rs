//! Physical bounds of a sound result, checked during a run with any method.

use crate::actions::rigid_plate::NORMAL;
use crate::actions::surface_load::{LoadShape, LoadedSurface};
use crate::kernel::body::Discrete;
use oedometer_problem::wave_speeds;
use oedometer_soil::material::Material;

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

/// Force that accelerates a node over that of the load, times the cells over the height: a pressure that is wrong by a
/// share of the load over the whole height is out of balance by that share of it over one cell. Sound runs leave a
/// hundredth of it once their first waves are gone.
const MOST_FORCE: f64 = 0.2;
/// Force over that of the load where points move: stresses jump as points cross cells.
const MOST_FORCE_MOVING: f64 = 1.0;
/// Force over that of the load at the time that a wave takes through the body and drag takes to join the phases: as water
/// begins to leave, it falls with time from there on.
const RELEASE: f64 = 4.0;
/// Forces of a start out of balance that its waves reach where they meet.
const STARTS: f64 = 4.0;

/// Bounds of settlement and pressure that the scene of a problem sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhysicalBounds {
    /// Settlement that the problem's pressure makes in the end, or more, m.
    pub settlement_scale: f64,
    /// Work of the load on one cell over the settlement, J.
    pub energy_scale: f64,
    /// Least and largest settlement, m.
    settlement: [f64; 2],
    /// Largest pressure, Pa, either way.
    pressure: f64,
    /// Largest force that accelerates a node, N, beside that of the release.
    force: f64,
    /// Force of the release of water at the drained surface, N, times its time, s.
    release: f64,
    /// Whether a run that leaves them is ended; not where growth is the question.
    pub are_kept: bool,
}

impl PhysicalBounds {
    /// The bounds of a problem.
    pub fn new<const D: usize>(problem: &Discrete<D>) -> Self {
        let scale = settlement_scale(problem);
        let without = f64::INFINITY;
        let cell_size = problem.grid.cell_size;
        let of_load = problem.pressure_scale * (1..D).map(|_| cell_size).product::<f64>();
        if !problem.is_bounded {
            return Self {
                settlement_scale: scale,
                energy_scale: of_load * scale,
                settlement: [-without, without],
                pressure: without,
                force: without,
                release: 0.0,
                are_kept: false,
            };
        }
        let up = if problem.plate_load.is_some() { NORMAL } else { D - 1 };
        let cells = problem.grid.cells[up] as f64;
        let force = if problem.forcing.is_some() || problem.loading_time > 0.0 {
            // The forces keep changing.
            without
        } else if problem.configuration.deforms() {
            MOST_FORCE_MOVING * of_load
        } else {
            MOST_FORCE * of_load / cells
        };
        let joining = 0.5 * problem.most_of_soils(wave_speeds::drag_limit);
        let passing = cells * cell_size / problem.least_of_soils(wave_speeds::undrained_wave_speed);
        Self {
            settlement_scale: scale,
            energy_scale: of_load * scale,
            settlement: SETTLEMENTS.map(|share| share * scale),
            pressure: MOST_PRESSURE * problem.pressure_scale,
            force,
            release: RELEASE * of_load * (passing + joining),
            are_kept: true,
        }
    }

    /// The bounds of a run from a start, whose pressures may be many times the load where a method locks, which is what
    /// studies of that are about, and whose unbalanced forces run through the body as waves.
    #[must_use]
    pub fn widened_by_start(self, pressures: &[f64], unbalanced_force: f64) -> Self {
        let largest = pressures.iter().fold(0.0, |largest: f64, pressure| largest.max(pressure.abs()));
        Self {
            pressure: self.pressure.max(MOST_PRESSURE * largest),
            force: self.force + STARTS * unbalanced_force,
            ..self
        }
    }

    /// Says why a force, N, that accelerates a node at a time, s, is outside the bounds of the scene.
    pub fn left_by_force(&self, force: f64, time: f64) -> Option<String> {
        let most = self.force + self.release / time;
        let is_within = force <= most;
        (!is_within).then(|| {
            format!(
                "the out-of-balance force at a node is {force:.3e} N, more than the {most:.3e} N that this \
                 problem can cause at that time"
            )
        })
    }

    /// Says why a settlement, m, is outside the bounds of the scene.
    pub fn left_by_settlement(&self, settlement: f64) -> Option<String> {
        let [least, most] = self.settlement;
        // NaN is in no range.
        if settlement.is_finite() && (least..=most).contains(&settlement) {
            return None;
        }
        Some(format!(
            "a settlement of {settlement:.3e} m is beyond what the problem can reach, {least:.3e} to {most:.3e} m"
        ))
    }

    /// Why the scene cannot reach pressures, Pa; none where it can.
    pub fn left_by_pressure(&self, pressures: &[f64]) -> Option<String> {
        let within = |pressure: &&f64| pressure.is_finite() && pressure.abs() <= self.pressure;
        let outside = pressures.iter().find(|pressure| !within(pressure))?;
        Some(format!(
            "a pore pressure of {outside:.3e} Pa is beyond what the problem can reach, {:.3e} Pa",
            self.pressure
        ))
    }
}

/// Settlement, m, that a problem's pressure makes in a column, `m_v q H`; of a plate across it,
/// `(1 − ν²) q b/E`; under a cosine at most that
/// and the one of a half-space, `2 (1 − ν²) q/(E k)`, which is left where shear is all that gives.
fn settlement_scale<const D: usize>(problem: &Discrete<D>) -> f64 {
    let soil = &problem.material;
    if problem.plate_load.is_some() {
        let distance = problem.grid.cells[NORMAL] as f64 * problem.grid.cell_size;
        let compliance = (1.0 - soil.poissons_ratio * soil.poissons_ratio) / soil.youngs_modulus;
        return problem.pressure_scale * compliance * distance;
    }
    // The mean height: a cosine has none of its own.
    let height = LoadedSurface::new(&problem.points, problem.load).height(&problem.points);
    let softest = problem.least_of_soils(Material::oedometric_modulus);
    let column = problem.pressure_scale / softest * height;
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
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, DYNAMIC_COLUMN, Scene, TERZAGHI};
    use oedometer_soil::material::Material;

    fn bounds_of(scene: &'static Scene, column: &Column, soil: &Material) -> PhysicalBounds {
        let method = Method::named("GC-SRI-patch").expect("the paper's method");
        if scene.body == oedometer_scenes::scene::Body::Column {
            PhysicalBounds::new(&column_problem::<1>(scene, column, soil, method, 4, 2).expect("a column"))
        } else {
            PhysicalBounds::new(&column_problem::<2>(scene, column, soil, method, 4, 2).expect("a layer"))
        }
    }

    #[test]
    fn a_column_is_bounded_by_what_consolidation_and_waves_can_reach() {
        let soil = Material::default();
        let bounds = bounds_of(&TERZAGHI, &Column::default(), &soil);
        let final_settlement = 1.0 / soil.oedometric_modulus();
        for (settlement, is_within) in
            [(0.0, true), (2.0, true), (-0.9, true), (3.1, false), (-1.1, false), (f64::NAN, false)]
        {
            assert_eq!(
                bounds.left_by_settlement(settlement * final_settlement).is_none(),
                is_within,
                "{settlement}"
            );
        }
        for (pressure, is_within) in
            [(1.0, true), (-4.0, true), (6.0, false), (-6.0, false), (f64::INFINITY, false)]
        {
            assert_eq!(bounds.left_by_pressure(&[0.5, pressure]).is_none(), is_within, "{pressure}");
        }
    }

    #[test]
    fn a_layer_without_compressibility_still_settles_by_shear() {
        let soil = Material { poissons_ratio: 0.4999, ..Material::default() };
        let layer = Column { height: 10.0, ..Column::layer() };
        let bounds = bounds_of(&COSINE_LAYER, &layer, &soil);
        // A half-space under a cosine of a metre: 2 (1 − ν²) q L/(π E).
        let half_space = 2.0 * (1.0 - 0.4999_f64.powi(2)) / (std::f64::consts::PI * soil.youngs_modulus);
        assert!(bounds.settlement_scale > half_space && bounds.settlement_scale < 1.1 * half_space);
        assert!(bounds.left_by_pressure(&[300.0]).is_some());
        let locked = bounds.widened_by_start(&[-80.0, 20.0], 0.0);
        assert!(locked.left_by_pressure(&[300.0]).is_none(), "locked from its start, and not ended");
        assert!(locked.left_by_pressure(&[500.0]).is_some(), "and ended where it goes on to grow");
    }

    #[test]
    fn the_bound_on_unbalanced_forces_allows_the_release_of_water_and_the_first_waves() {
        let soil = Material { hydraulic_conductivity: 1e-6, ..Material::default() };
        let bounds = bounds_of(&TERZAGHI, &Column { load: 50.0, ..Column::default() }, &soil);
        // Of 50 Pa on five cells a hundredth, and half a millisecond for a wave.
        for (force, time, is_within) in
            [(150.0, 5e-4, true), (1.5, 1.0, true), (2.5, 1.0, false), (f64::NAN, 1.0, false)]
        {
            assert_eq!(bounds.left_by_force(force, time).is_none(), is_within, "{force} {time}");
        }
        let waves = bounds.widened_by_start(&[], 50.0);
        assert!(waves.left_by_force(150.0, 1.0).is_none() && waves.left_by_force(250.0, 1.0).is_some());
        let growing = Column { loading_time: 1.0, ..Column::default() };
        let growing = bounds_of(&DYNAMIC_COLUMN, &growing, &soil);
        assert!(growing.left_by_force(1e9, 1.0).is_none());
    }
}
