//! Situations: what makes a run hard, derived from its inputs.

use crate::record::Record;
use oedometer_soil::elementary;

/// Final strain from which on the loss of height dominates everything else.
const MUCH_OF_THE_HEIGHT: f64 = 0.4;
/// Heights, m, of a usual column.
const USUAL_HEIGHTS: [f64; 2] = [0.05, 500.0];
/// Porosities of a usual soil.
const USUAL_POROSITIES: [f64; 2] = [0.1, 0.8];
/// `n E_oed/K_w` of a usual soil in water: from stiff rock to soft clay with some air.
const USUAL_STORAGE: [f64; 2] = [1e-6, 1e-1];
/// `c_v/(H V)` below which the water cannot move in any time that a run with inertia can wait for.
const USUAL_INERTIA: f64 = 1e-9;
/// A last output before this time factor is a very early one.
const EARLY: f64 = 1e-3;
/// What makes a run hard, in the order of a report: the easy ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Situation {
    /// Small strain in a usual soil, points on their lattice.
    Usual,
    /// Small strain with points off their lattice, or one a cell.
    OutOfPlace,
    /// Small strain in an unusual soil, size or time.
    Extreme,
    /// Waves.
    Waves,
    /// Large strain under a load that is applied at once.
    LoadAtOnce,
    /// Large strain under a load that grows.
    GrowingLoad,
    /// Large strain that takes much of the height.
    MuchOfTheHeight,
    /// Large strain without a load on the surface.
    BodyForces,
}

/// Names in tables, in the order of the enumeration.
const NAMES: [&str; 8] = [
    "Small strain, usual soil",
    "Small strain, points out of place",
    "Small strain, extreme soil, size or time",
    "Waves",
    "Large strain, load at once",
    "Large strain, load that grows",
    "Large strain of 40 % and more",
    "Large strain under body forces",
];

impl Situation {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        NAMES[self as usize]
    }

    /// The situation of a run.
    pub fn of(record: &Record) -> Self {
        let within = |value: f64, range: [f64; 2]| (range[0]..=range[1]).contains(&value);
        let (case, groups) = (&record.case, &record.groups);
        let column = &case.column;
        let last = case.time_factors.last().copied().unwrap_or(0.0);
        if case.scene.is_large_strain() {
            return match 1.0 - elementary::exp(-groups.finite_strain) {
                _ if !case.scene.is_loaded() => Self::BodyForces,
                strain if strain >= MUCH_OF_THE_HEIGHT => Self::MuchOfTheHeight,
                _ if column.loading_time > 0.0 => Self::GrowingLoad,
                _ => Self::LoadAtOnce,
            };
        }
        let is_usual = within(column.height, USUAL_HEIGHTS)
            && within(case.material.porosity, USUAL_POROSITIES)
            && within(groups.storage, USUAL_STORAGE)
            && groups.inertia >= USUAL_INERTIA
            && last >= EARLY;
        match () {
            () if case.scene.has_waves() => Self::Waves,
            () if !column.points.is_regular() || case.points_per_cell == 1 => Self::OutOfPlace,
            () if !is_usual => Self::Extreme,
            () => Self::Usual,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

    #[test]
    fn a_situation_is_read_off_the_inputs() {
        let one = |table: &str, sweep: &str| {
            let text = format!(
                "title = 't'\n{table}\n[output]\ntime_factors = [0.05]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
                 integrator = ['implicit']\ncells = [4]\n{sweep}"
            );
            Situation::of(&records_of(&text)[0])
        };
        assert_eq!(one("scene = 'terzaghi'", ""), Situation::Usual);
        assert_eq!(one("scene = 'terzaghi'\npoints.jitter = 0.1", ""), Situation::OutOfPlace);
        assert_eq!(one("scene = 'terzaghi'", "points_per_cell = [1]"), Situation::OutOfPlace);
        assert_eq!(one("scene = 'terzaghi'\ncolumn.height = 1e-6", ""), Situation::Extreme);
        assert_eq!(one("scene = 'xie-leo'\ncolumn.load = 2e5", ""), Situation::LoadAtOnce);
        let growing = "scene = 'xie-leo'\ncolumn = { load = 2e5, loading_time = 1.0 }";
        assert_eq!(one(growing, ""), Situation::GrowingLoad);
        let much = "scene = 'xie-leo'\ncolumn.load = 8.4e5\nmaterial.porosity = 0.7";
        assert_eq!(one(much, ""), Situation::MuchOfTheHeight);
    }
}
