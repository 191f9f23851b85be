//! Collects the state of a column or a layer as samples, row by row.

use crate::import::mapping::Column;
use oedometer_formats::ImportError;
use std::path::Path;

/// Rows whose times differ by less than this share are of one time.
const SAME_TIME: f64 = 1e-9;

/// Samples at one time: SI, heights from the base and distances from the scene's `x = 0`, pressure
/// compression positive, stress tension positive, displacement upward and away from `x = 0`
/// positive. The list of a quantity that the result lacks is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledState {
    /// Time, s.
    pub time: f64,
    /// Initial distance of each place from the scene's `x = 0`, m.
    pub initial_distance: Vec<f64>,
    /// Initial height of each place, m.
    pub initial_height: Vec<f64>,
    /// Weight of each place.
    pub volume: Vec<f64>,
    /// Pore pressure, Pa.
    pub pressure: Vec<f64>,
    /// Vertical effective stress, Pa.
    pub effective_stress: Vec<f64>,
    /// Vertical displacement, m.
    pub displacement: Vec<f64>,
    /// Horizontal displacement, m.
    pub horizontal_displacement: Vec<f64>,
    /// Displacement of the surface, m, if it is known by itself: from a settlement curve.
    pub surface_displacement: Option<f64>,
    /// Number of rows at the place of another one that no other column distinguishes from it.
    pub repeated: usize,
}

/// One row in SI, with the signs of [`SampledState`]; NaN for a quantity that it lacks.
#[derive(Clone, Copy, Debug)]
pub struct SampleRow {
    pub time: f64,
    pub initial_distance: f64,
    pub initial_height: f64,
    pub volume: f64,
    pub pressure: f64,
    pub effective_stress: f64,
    pub displacement: f64,
    pub horizontal_displacement: f64,
    /// Hash of what distinguishes it from other rows at its place and time.
    pub others: u64,
}

/// The states of rows, by time; within a state by height and distance.
///
/// # Errors
/// When only some rows of a state have a quantity, or only some states the horizontal displacement.
pub fn states_of(rows: &[SampleRow]) -> Result<Vec<SampledState>, ImportError> {
    let lacks_along = rows.iter().filter(|row| row.horizontal_displacement.is_nan()).count();
    if ![0, rows.len()].contains(&lacks_along) {
        return Err(incomplete(Column::Along));
    }
    let mut order: Vec<&SampleRow> = rows.iter().collect();
    order.sort_by(|a, b| {
        (a.time.total_cmp(&b.time))
            .then(a.initial_height.total_cmp(&b.initial_height))
            .then(a.initial_distance.total_cmp(&b.initial_distance))
            .then(a.others.cmp(&b.others))
    });
    let mut states = Vec::new();
    let mut rest = order.as_slice();
    while let Some(first) = rest.first() {
        let is_same = |row: &SampleRow| row.time - first.time <= SAME_TIME * row.time;
        let count = rest.iter().take_while(|row| is_same(row)).count().max(1);
        let (state, after) = rest.split_at(count);
        states.push(state_of(state)?);
        rest = after;
    }
    Ok(states)
}

fn state_of(rows: &[&SampleRow]) -> Result<SampledState, ImportError> {
    let all = |value: fn(&SampleRow) -> f64| rows.iter().map(|row| value(row)).collect::<Vec<f64>>();
    let of = |column: Column, value: fn(&SampleRow) -> f64| {
        let values = all(value);
        match values.iter().filter(|value| value.is_nan()).count() {
            0 => Ok(values),
            absent if absent == values.len() => Ok(Vec::new()),
            _ => Err(incomplete(column)),
        }
    };
    let is_repeated = |pair: &&[&SampleRow]| {
        let place =
            |row: &SampleRow| (row.initial_height, (row.initial_distance + 0.0).to_bits(), row.others);
        place(pair[0]) == place(pair[1])
    };
    Ok(SampledState {
        time: rows[0].time,
        initial_distance: of(Column::X, |row| row.initial_distance)?,
        initial_height: all(|row| row.initial_height),
        volume: all(|row| row.volume),
        pressure: of(Column::Pressure, |row| row.pressure)?,
        effective_stress: of(Column::EffectiveStress, |row| row.effective_stress)?,
        displacement: of(Column::Up, |row| row.displacement)?,
        horizontal_displacement: of(Column::Along, |row| row.horizontal_displacement)?,
        surface_displacement: None,
        repeated: rows.windows(2).filter(is_repeated).count(),
    })
}

fn incomplete(column: Column) -> ImportError {
    let reason = format!(
        "some files have the column `{}` and others lack it: give it in all or in none",
        column.name()
    );
    ImportError::content(Path::new("the result"), reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(time: f64, height: f64, pressure: f64, along: f64) -> SampleRow {
        SampleRow {
            time,
            initial_distance: f64::NAN,
            initial_height: height,
            volume: 1.0,
            pressure,
            effective_stress: f64::NAN,
            displacement: f64::NAN,
            horizontal_displacement: along,
            others: 0,
        }
    }

    #[test]
    fn states_are_by_time_and_rows_by_height() {
        let found = states_of(&[
            row(2.0, 0.5, 5.0, f64::NAN),
            row(1.0, 0.75, 2.0, f64::NAN),
            row(1.0 + 1e-12, 0.25, 1.0, f64::NAN),
            row(1.0, 0.75, 3.0, f64::NAN),
        ])
        .expect("alike");
        assert_eq!((found.len(), found[0].repeated), (2, 1));
        assert_eq!(
            found[0].initial_height,
            [0.75, 0.75, 0.25],
            "sorted by time even if it differs by round-off"
        );
        assert_eq!(found[1].pressure, [5.0]);
        assert!(found[0].displacement.is_empty());
    }

    #[test]
    fn a_quantity_of_some_rows_of_a_state_is_refused_and_of_some_states_is_not() {
        let nan = f64::NAN;
        let mixed = states_of(&[row(1.0, 0.5, nan, nan), row(1.0, 0.6, 1.0, nan)]);
        assert!(mixed.is_err_and(|error| error.to_string().contains("`p`")));
        for (one, other) in [(nan, 1.0), (1.0, nan)] {
            let states =
                states_of(&[row(1.0, 0.5, one, nan), row(2.0, 0.6, other, nan)]).expect("two states");
            let counts = [&states[0], &states[1]].map(|state| state.pressure.len());
            assert_eq!(counts, [one, other].map(|value| usize::from(!value.is_nan())));
        }
        let along = states_of(&[row(1.0, 0.5, 1.0, 0.0), row(2.0, 0.6, 1.0, nan)]);
        assert!(along.is_err_and(|error| error.to_string().contains("`u_x`")));
    }

    #[test]
    fn rows_of_a_height_are_by_distance_and_those_of_one_place_are_repeated_where_nothing_tells_them_apart() {
        let nan = f64::NAN;
        let at = |distance: f64, height: f64, others: u64| SampleRow {
            initial_distance: distance,
            effective_stress: 10.0 * distance,
            others,
            ..row(1.0, height, height, distance)
        };
        let found = states_of(&[
            at(2.0, 0.5, 0),
            at(1.0, 0.75, 0),
            at(0.0, 0.5, 0),
            at(1.0, 0.5, 0),
            at(1.0, 0.25, 0),
        ]);
        let state = &found.expect("alike")[0];
        assert_eq!(state.initial_distance, [1.0, 0.0, 1.0, 2.0, 1.0]);
        assert_eq!(state.initial_height, [0.25, 0.5, 0.5, 0.5, 0.75]);
        assert_eq!(state.effective_stress, [10.0, 0.0, 10.0, 20.0, 10.0]);
        for (rows, repeated) in [
            (vec![at(1.0, 0.5, 0), at(1.0, 0.5, 0), at(1.0, 0.5, 0)], 2),
            (vec![at(1.0, 0.5, 0), at(2.0, 0.5, 0)], 0),
            (vec![at(1.0, 0.5, 0), at(1.0, 0.6, 0)], 0),
            (vec![at(1.0, 0.5, 0), at(1.0, 0.5, 1)], 0),
            (vec![at(1.0, 0.5, 1), at(1.0, 0.5, 0), at(1.0, 0.5, 1)], 1),
            (vec![at(0.0, 0.5, 0), at(-0.0, 0.5, 0)], 1),
        ] {
            assert_eq!(states_of(&rows).expect("alike")[0].repeated, repeated, "{rows:?}");
        }
        assert_eq!(states_of(&[]).expect("nothing"), []);
        // Beyond a thousandth of a millionth of it is another time.
        for (off, states) in [(0.9e-9, 1), (1.1e-9, 2)] {
            let found = states_of(&[row(1000.0 * (1.0 + off), 0.5, 1.0, nan), row(1000.0, 0.5, 1.0, nan)]);
            assert_eq!(found.expect("alike").len(), states, "{off}");
        }
        let lacking = |change: fn(&mut SampleRow)| {
            let mut rows = [at(1.0, 0.5, 0), at(1.0, 0.6, 0)];
            change(&mut rows[1]);
            rows[0].displacement = 0.0;
            states_of(&rows).expect_err("some lack it").to_string()
        };
        let told = |column: &str| {
            format!(
                "the result: some files have the column `{column}` and others lack it: give it in all or in none"
            )
        };
        assert_eq!(lacking(|_| ()), told("u_y"));
        assert_eq!(lacking(|row| row.effective_stress = f64::NAN), told("effective_stress"));
        assert_eq!(lacking(|row| row.initial_distance = f64::NAN), told("x"));
        assert_eq!(lacking(|row| row.horizontal_displacement = f64::NAN), told("u_x"));
    }
}
