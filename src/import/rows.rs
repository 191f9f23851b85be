//! The rows of a run in SI, column by column, and the states by time that they make.
//!
//! A million rows take some fifty bytes each here, and twice that as a list of rows.

use crate::import::raw_row::SampleRow;
use crate::import::table::SampledState;
use oedometer_formats::import_error::ImportError;

/// Rows closer than this share of their time are of one time.
const SAME_TIME: f64 = 1e-9;

/// A quantity of all rows, NaN where a row lacks it; empty where all of them do.
#[derive(Default)]
struct Quantities(Vec<f64>);

impl Quantities {
    fn push(&mut self, row: usize, value: Option<f64>) {
        if value.is_some() || !self.0.is_empty() {
            self.0.resize(row, f64::NAN);
            self.0.push(value.unwrap_or(f64::NAN));
        }
    }

    fn get(&self, row: usize) -> Option<f64> {
        self.0.get(row).copied().filter(|value| !value.is_nan())
    }

    /// The values of some rows: of all of them, or none.
    fn of(&self, rows: &[usize], name: &'static str) -> Result<Vec<f64>, ImportError> {
        let values: Vec<f64> =
            if self.0.is_empty() { Vec::new() } else { rows.iter().map(|row| self.0[*row]).collect() };
        match values.iter().filter(|value| value.is_nan()).count() {
            0 => Ok(values),
            absent if absent == values.len() => Ok(Vec::new()),
            _ => Err(ImportError::NotInAll { name }),
        }
    }
}

/// Rows of a run.
#[derive(Default)]
pub struct Rows {
    time: Vec<f64>,
    initial_height: Vec<f64>,
    volume: Vec<f64>,
    /// What tells rows at one place apart.
    others: Vec<u64>,
    initial_distance: Quantities,
    pressure: Quantities,
    effective_stress: Quantities,
    displacement: Quantities,
    horizontal_displacement: Quantities,
}

impl Rows {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Makes room for more.
    pub fn reserve(&mut self, more: usize) {
        // The first file's rows as they are: most results are one file. Later ones with air, for there may be many.
        let is_first = self.time.is_empty();
        for column in [&mut self.time, &mut self.initial_height, &mut self.volume] {
            if is_first { column.reserve_exact(more) } else { column.reserve(more) }
        }
        if is_first { self.others.reserve_exact(more) } else { self.others.reserve(more) }
    }

    /// Takes a row.
    pub fn push(&mut self, row: &SampleRow) {
        let place = self.len();
        self.time.push(row.time);
        self.initial_height.push(row.initial_height);
        self.volume.push(row.volume);
        self.others.push(row.others);
        self.initial_distance.push(place, row.initial_distance);
        self.pressure.push(place, row.pressure);
        self.effective_stress.push(place, row.effective_stress);
        self.displacement.push(place, row.displacement);
        self.horizontal_displacement.push(place, row.horizontal_displacement);
    }

    /// The states of the rows, by time; within one by height and distance.
    ///
    /// # Errors
    /// When a quantity stands in some rows of a state only, or horizontal displacements in some states only.
    pub fn states(mut self) -> Result<Vec<SampledState>, ImportError> {
        // Shorter than the rows where the last ones lack it.
        for column in [
            &mut self.initial_distance,
            &mut self.pressure,
            &mut self.effective_stress,
            &mut self.displacement,
            &mut self.horizontal_displacement,
        ] {
            if !column.0.is_empty() {
                column.0.resize(self.time.len(), f64::NAN);
            }
        }
        if self.horizontal_displacement.0.iter().any(|value| value.is_nan()) {
            return Err(ImportError::NotInAll { name: "u_x" });
        }
        let order = self.order();
        let mut states = Vec::new();
        let mut from = 0;
        while let Some(first) = order.get(from) {
            let time = self.time[*first];
            let is_same = |row: &&usize| self.time[**row] - time <= SAME_TIME * self.time[**row];
            let count = order[from..].iter().take_while(is_same).count().max(1);
            states.push(self.state(time, &order[from..from + count])?);
            from += count;
        }
        Ok(states)
    }

    /// Rows by time, height, distance and what tells them apart.
    fn order(&self) -> Vec<usize> {
        let distance = |row: usize| self.initial_distance.get(row).unwrap_or_default();
        let by_place = |a: usize, b: usize| {
            (self.time[a].total_cmp(&self.time[b]))
                .then(self.initial_height[a].total_cmp(&self.initial_height[b]))
                .then(distance(a).total_cmp(&distance(b)))
        };
        let mut order: Vec<usize> = (0..self.len()).collect();
        // Meshes are written row by row: what is in order already costs next to nothing, and the rest is short.
        order.sort_by(|a, b| by_place(*a, *b));
        for same in order.chunk_by_mut(|a, b| by_place(*a, *b).is_eq()) {
            same.sort_by_key(|row| self.others[*row]);
        }
        order
    }

    fn state(&self, time: f64, rows: &[usize]) -> Result<SampledState, ImportError> {
        let of = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let is_repeated = |pair: &&[usize]| self.is_place_of(pair[0], pair[1]);
        Ok(SampledState {
            time,
            initial_distance: self.initial_distance.of(rows, "x")?,
            initial_height: of(&self.initial_height),
            volume: of(&self.volume),
            pressure: self.pressure.of(rows, "p")?,
            effective_stress: self.effective_stress.of(rows, "effective_stress")?,
            displacement: self.displacement.of(rows, "u_y")?,
            horizontal_displacement: self.horizontal_displacement.of(rows, "u_x")?,
            surface_displacement: None,
            repeated: rows.windows(2).filter(is_repeated).count(),
        })
    }

    /// Whether two rows stand at one place, and no column tells them apart.
    fn is_place_of(&self, a: usize, b: usize) -> bool {
        self.initial_height[a] == self.initial_height[b]
            && self.initial_distance.get(a) == self.initial_distance.get(b)
            && self.others[a] == self.others[b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(time: f64, height: f64, pressure: Option<f64>, along: Option<f64>) -> SampleRow {
        SampleRow {
            time,
            initial_distance: None,
            initial_height: height,
            volume: 1.0,
            pressure,
            effective_stress: None,
            displacement: None,
            horizontal_displacement: along,
            others: 0,
        }
    }

    fn states(rows: &[SampleRow]) -> Result<Vec<SampledState>, ImportError> {
        let mut all = Rows::default();
        for row in rows {
            all.push(row);
        }
        all.states()
    }

    #[test]
    fn states_are_by_time_and_rows_by_height() {
        let found = states(&[
            row(2.0, 0.5, Some(5.0), None),
            row(1.0, 0.75, Some(2.0), None),
            row(1.0 + 1e-12, 0.25, Some(1.0), None),
            row(1.0, 0.75, Some(3.0), None),
        ])
        .expect("alike");
        assert_eq!((found.len(), found[0].repeated), (2, 1));
        assert_eq!(
            found[0].initial_height,
            [0.75, 0.75, 0.25],
            "times that differ by round-off are sorted so"
        );
        assert_eq!(found[1].pressure, [5.0]);
        assert!(found[0].displacement.is_empty());
    }

    #[test]
    fn a_quantity_of_some_rows_of_a_state_is_refused_and_of_some_states_is_not() {
        let mixed = states(&[row(1.0, 0.5, None, None), row(1.0, 0.6, Some(1.0), None)]);
        assert!(mixed.is_err_and(|error| error.to_string().contains("`p`")));
        let later = states(&[row(1.0, 0.5, None, None), row(2.0, 0.6, Some(1.0), None)]).expect("two states");
        assert_eq!((later[0].pressure.len(), later[1].pressure.len()), (0, 1));
        let earlier =
            states(&[row(1.0, 0.5, Some(1.0), None), row(2.0, 0.6, None, None)]).expect("two states");
        assert_eq!((earlier[0].pressure.len(), earlier[1].pressure.len()), (1, 0));
        let along = states(&[row(1.0, 0.5, Some(1.0), Some(0.0)), row(2.0, 0.6, Some(1.0), None)]);
        assert!(along.is_err_and(|error| error.to_string().contains("`u_x`")));
    }
}
