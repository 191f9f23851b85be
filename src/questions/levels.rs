//! The levels of several paths side by side: each error belongs to its level by the level's value, not by its place.

use crate::judge::paths::{Path, grouped, level_size};
use crate::record::Record;
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
use oedometer_convergence::ErrorSeries;
use oedometer_problem::time_step::TimeStep;

/// What makes two runs of different paths runs of one level.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LevelValue(String);

/// The error of a path at a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LevelError {
    /// The error.
    Measured(f64),
    /// The run has none.
    NotMeasured,
    /// The run was not asked for this time.
    NotAsked,
    /// It is the finest of its path, with which the one before is compared.
    NoFiner,
    /// The path has no such level.
    NotRun,
}

impl LevelValue {
    /// The level of a record: its cells, points per cell and stiffness of water by their numbers, a step by its rule.
    pub fn new(record: &Record, axis: Axis) -> Self {
        let case = &record.case;
        Self(match axis {
            Axis::Cells => case.cells.to_string(),
            Axis::PointsPerCell => case.points_per_cell.to_string(),
            Axis::WaterBulkModulus => format!("{:e}", case.material.water_bulk_modulus),
            Axis::TimeStep => match case.time_step {
                TimeStep::Seconds(seconds) => format!("{seconds:e} s"),
                rule => rule.to_string(),
            },
        })
    }
}

/// The levels of all paths, each once, from coarse to fine, with a record of each.
pub fn levels_of<'a>(paths: &[Path<'a>], axis: Axis) -> Vec<(LevelValue, &'a Record)> {
    let records = paths.iter().flat_map(|path| path.records.iter().copied());
    let mut levels: Vec<(LevelValue, &Record)> = grouped(records, |record| LevelValue::new(record, axis))
        .into_iter()
        .map(|(value, records)| (value, records[0]))
        .collect();
    levels.sort_by(|a, b| level_size(b.1, axis).total_cmp(&level_size(a.1, axis)));
    levels
}

impl Path<'_> {
    /// The error of a measure at a level, out of the series of the path.
    pub fn error_at(&self, level: &LevelValue, measure: &Measure, series: &ErrorSeries) -> LevelError {
        let is_there = |record: &&&Record| LevelValue::new(record, self.axis) == *level;
        let Some(record) = self.records.iter().find(is_there) else { return LevelError::NotRun };
        if !record.case.time_factors.contains(&measure.time_factor) {
            return LevelError::NotAsked;
        }
        match series.at(level_size(record, self.axis)) {
            Some(level) => level.error.map_or(LevelError::NotMeasured, LevelError::Measured),
            None if measure.reference == NEXT_FINER => LevelError::NoFiner,
            None => LevelError::NotMeasured,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::{Quantity, Sample};
    use crate::judge::paths::{first_measure, paths};
    use LevelError::{Measured, NoFiner, NotAsked, NotRun};

    /// Two paths, each with levels that the other lacks: every error must stand under the cells of its own run.
    #[test]
    fn errors_stand_under_their_own_level_where_paths_have_unlike_ones() {
        let sweep = |method: &str, cells: &str| {
            format!("[[sweep]]\nmethod = ['{method}']\nintegrator = ['implicit']\ncells = {cells}\n")
        };
        let mut records = records_of(&format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n{}{}",
            sweep("MPM", "[5, 10, 40]"),
            sweep("GIMP", "[8, 10, 20]")
        ));
        for record in &mut records {
            let error = record.case.cells as f64;
            record.errors.iter_mut().for_each(|row| row.value = error);
        }
        let all = paths(&records, Axis::Cells);
        let levels = levels_of(&all, Axis::Cells);
        let cells: Vec<usize> = levels.iter().map(|(_, record)| record.case.cells).collect();
        assert_eq!(cells, [5, 8, 10, 20, 40]);
        let row = |path: &Path, reference: &str, time: f64| -> Vec<LevelError> {
            let measure = first_measure(Quantity::Pressure, Sample::Points, reference, time);
            let series = path.series(&measure);
            levels.iter().map(|(level, _)| path.error_at(level, &measure, &series)).collect()
        };
        let (own, time) = ("terzaghi", 0.1);
        assert_eq!(row(&all[0], own, time), [Measured(5.0), NotRun, Measured(10.0), NotRun, Measured(40.0)]);
        assert_eq!(row(&all[1], own, time), [NotRun, Measured(8.0), Measured(10.0), Measured(20.0), NotRun]);
        assert_eq!(row(&all[0], own, 0.3), [NotAsked, NotRun, NotAsked, NotRun, NotAsked]);
        assert_eq!(row(&all[0], NEXT_FINER, time)[4], NoFiner);
    }
}
