//! Collects the state of a column or a layer as samples, row by row.
//!
//! Programs that write values per cell repeat a node for each cell beside it: equal values at one place are one sample, and
//! unequal ones are told. Quantities may have places of their own: pressures at nodes, stresses at the centres of cells.

use crate::import::contradictions::Course;
use crate::import::mapping::Column;
use crate::import::origins::{Origin, Origins};
use oedometer_case::quantity::Sample;
use oedometer_formats::ImportError;
use std::collections::HashMap;
use std::path::Path;

/// Rows whose times differ by less than this share are of one time.
const SAME_TIME: f64 = 1e-9;
/// Places closer than this share of the largest coordinate are one.
pub(crate) const SAME_PLACE: f64 = 1e-9;
/// Values closer than this share of the largest of their state are equal: round-off of single precision.
pub(crate) const SAME_VALUE: f64 = 1e-6;

/// Share of the height within which a sample counts as at the surface or the base, and of the length as under the crest.
pub const RIM: f64 = 1e-6;

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
    /// Number of rows at the place of another one that no other column distinguishes from it, with other values.
    pub repeated: usize,
    /// Place of the first of them, with both values and where they were read.
    pub repeated_at: Option<String>,
    /// Quantities of this time at other places.
    pub beside: Vec<Beside>,
}

/// Quantities at different places.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// Kind of these places, if it is another one than that of the rest.
    pub sample: Option<Sample>,
    /// The samples.
    pub state: SampledState,
}

impl SampledState {
    /// The kind of its places with the samples there, and those beside them.
    pub fn sets(&self, sample: Sample) -> impl Iterator<Item = (Sample, &Self)> {
        let beside = self.beside.iter().map(move |set| (set.sample.unwrap_or(sample), &set.state));
        std::iter::once((sample, self)).chain(beside)
    }

    /// Vertical displacement of a sample at the surface of a body of a height, m: in a plane of a length, m, of one under the
    /// crest of its load.
    pub fn displacement_at_surface(&self, height: f64, length: Option<f64>) -> Option<f64> {
        let is_under_crest = |place: usize| {
            let distance = self.initial_distance.get(place);
            length.zip(distance).is_none_or(|(length, distance)| *distance < RIM * length)
        };
        let is_at_surface =
            |place: &usize| self.initial_height[*place] > (1.0 - RIM) * height && is_under_crest(*place);
        let place = (0..self.initial_height.len()).find(is_at_surface)?;
        self.displacement.get(place).copied()
    }

    /// Changes its samples, and those beside them.
    pub fn change(&mut self, change: &dyn Fn(&mut Self)) {
        change(self);
        for set in &mut self.beside {
            change(&mut set.state);
        }
    }
}

/// Which places a row is of: 0 for the first ones, and the kind of others.
pub type PlaceSet = (u8, Option<Sample>);

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
    /// Its kind of places, if quantities have different places.
    pub set: PlaceSet,
    /// Where it was read.
    pub origin: Origin,
}

impl SampleRow {
    /// A row without quantities at a time, s, and a height, m, with the weight of all others.
    pub fn at(time: f64, height: f64, origin: Origin) -> Self {
        let absent = f64::NAN;
        Self {
            time,
            initial_distance: absent,
            initial_height: height,
            volume: 1.0,
            pressure: absent,
            effective_stress: absent,
            displacement: absent,
            horizontal_displacement: absent,
            others: 0,
            set: PlaceSet::default(),
            origin,
        }
    }

    /// The columns of [`values`](Self::values).
    pub const COLUMNS: [Column; 4] = [Column::Pressure, Column::EffectiveStress, Column::Up, Column::Along];

    /// Its quantities.
    pub fn values(&self) -> [f64; 4] {
        [self.pressure, self.effective_stress, self.displacement, self.horizontal_displacement]
    }
}

/// The states of rows in the order in which they were read, and what of them contradicts itself, a sentence each. States are by
/// time; within a state samples are by height and distance.
///
/// # Errors
/// When only some rows of a state have a quantity, or only some states the horizontal displacement.
pub fn states_of(
    rows: &[SampleRow],
    origins: &Origins,
) -> Result<(Vec<SampledState>, Vec<String>), ImportError> {
    let first = || rows.iter().filter(|row| row.set.0 == 0);
    let lacks_along = first().filter(|row| row.horizontal_displacement.is_nan()).count();
    if ![0, first().count()].contains(&lacks_along) {
        return Err(incomplete(Column::Along));
    }
    let mut course = Course::new(rows, instants_of(rows), origins);
    let contradictions = course.settle();
    let mut states = Vec::new();
    for instant in &course.instants {
        let mut sets: Vec<&SampleRow> = instant.iter().map(|at| &rows[*at]).collect();
        // Times that differ by round-off may mix the sets.
        sets.sort_by_key(|row| row.set.0);
        let mut whole: Option<SampledState> = None;
        for set in sets.chunk_by(|a, b| a.set.0 == b.set.0) {
            let state = state_of(set, origins)?;
            match &mut whole {
                Some(whole) => whole.beside.push(Beside { sample: set[0].set.1, state }),
                None => whole = Some(state),
            }
        }
        states.extend(whole);
    }
    Ok((states, contradictions))
}

/// The rows of each time, by their places in the list; times that differ by round-off are one.
pub fn instants_of(rows: &[SampleRow]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|a, b| {
        let [a, b] = [&rows[*a], &rows[*b]];
        (a.time.total_cmp(&b.time))
            .then(a.set.0.cmp(&b.set.0))
            .then(a.initial_height.total_cmp(&b.initial_height))
            .then(a.initial_distance.total_cmp(&b.initial_distance))
            .then(a.others.cmp(&b.others))
    });
    let mut instants = Vec::new();
    let mut rest = order.as_slice();
    while let Some(first) = rest.first() {
        let is_same = |at: &usize| rows[*at].time - rows[*first].time <= SAME_TIME * rows[*at].time;
        let count = rest.iter().take_while(|at| is_same(at)).count().max(1);
        let (of_time, after) = rest.split_at(count);
        instants.push(of_time.to_vec());
        rest = after;
    }
    instants
}

/// Rows without those that repeat another one with equal values, and those that repeat it with others, each with the other.
fn distinct<'a>(rows: &[&'a SampleRow]) -> (Vec<&'a SampleRow>, Vec<[&'a SampleRow; 2]>) {
    let largest = |value: &dyn Fn(&SampleRow) -> f64| {
        rows.iter().map(|row| value(row).abs()).filter(|size| size.is_finite()).fold(0.0, f64::max)
    };
    let scales = [0, 1, 2, 3].map(|place| SAME_VALUE * largest(&|row| row.values()[place]));
    let extent = largest(&|row| row.initial_height).max(largest(&|row| row.initial_distance));
    let step = SAME_PLACE * extent;
    let rounded = |place: f64| if step > 0.0 { (place / step).round() + 0.0 } else { place + 0.0 };
    let key = |row: &SampleRow| {
        (rounded(row.initial_height).to_bits(), rounded(row.initial_distance).to_bits(), row.others)
    };
    let are_equal = |a: &SampleRow, b: &SampleRow| {
        let pairs = a.values().into_iter().zip(b.values()).zip(scales);
        pairs.into_iter().all(|((a, b), scale)| (a - b).abs() <= scale || (a.is_nan() && b.is_nan()))
    };
    let mut known: HashMap<_, Vec<&SampleRow>> = HashMap::new();
    let (mut kept, mut repeated) = (Vec::with_capacity(rows.len()), Vec::new());
    for row in rows {
        let there = known.entry(key(row)).or_default();
        if there.iter().any(|other| are_equal(other, row)) {
            continue;
        }
        repeated.extend(there.first().map(|other| [*other, *row]));
        there.push(row);
        kept.push(*row);
    }
    (kept, repeated)
}

/// The sentence on the first of rows that repeat another one with other values: the quantity that differs most, on its scale.
fn repetition(repeated: &[[&SampleRow; 2]], rows: &[&SampleRow], origins: &Origins) -> Option<String> {
    let [one, other] = *repeated.first()?;
    let off = |quantity: &usize| {
        let scale = rows
            .iter()
            .map(|row| row.values()[*quantity].abs())
            .filter(|size| size.is_finite())
            .fold(0.0, f64::max);
        let off = (one.values()[*quantity] - other.values()[*quantity]).abs() / scale;
        if off.is_nan() { 0.0 } else { off }
    };
    let most = (0..4).max_by(|a, b| off(a).total_cmp(&off(b)))?;
    let mut pair = [one, other];
    pair.sort_by_key(|row| row.origin);
    Some(origins.two_values(most, pair))
}

fn state_of(rows: &[&SampleRow], origins: &Origins) -> Result<SampledState, ImportError> {
    let (rows, repeated) = distinct(rows);
    let all = |value: fn(&SampleRow) -> f64| rows.iter().map(|row| value(row)).collect::<Vec<f64>>();
    let of = |column: Column, value: fn(&SampleRow) -> f64| {
        let values = all(value);
        match values.iter().filter(|value| value.is_nan()).count() {
            0 => Ok(values),
            absent if absent == values.len() => Ok(Vec::new()),
            _ => Err(incomplete(column)),
        }
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
        repeated: repeated.len(),
        repeated_at: repetition(&repeated, &rows, origins),
        beside: Vec::new(),
    })
}

fn incomplete(column: Column) -> ImportError {
    let reason = format!(
        "some files have the column `{}` and others do not: give it in all or in none",
        column.name()
    );
    ImportError::content(Path::new("the result"), reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::mapping::{Axes, Mapping};

    fn states_of(rows: &[SampleRow]) -> Result<Vec<SampledState>, ImportError> {
        let mapping = Mapping::convention(Axes::Column).expect("a constant");
        super::states_of(rows, &Origins::new(&mapping)).map(|(states, _)| states)
    }

    fn row(time: f64, height: f64, pressure: f64, along: f64) -> SampleRow {
        SampleRow {
            pressure,
            horizontal_displacement: along,
            ..SampleRow::at(time, height, Origin::default())
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
        assert_eq!(
            (found.len(), found[0].repeated, found[0].repeated_at.as_deref()),
            (2, 1, Some("y = 0.75 m: p is 2 Pa (row 0) and 3 Pa (row 0)"))
        );
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
        let place_of = |state: &SampledState| {
            Some(state.repeated_at.as_ref()?.split(':').next().unwrap_or_default().to_owned())
        };
        // Equal values are one sample; others are told, where no column tells the rows apart.
        let with =
            |distance: f64, pressure: f64, others: u64| SampleRow { pressure, ..at(distance, 0.5, others) };
        for (rows, left, repeated) in [
            (vec![with(1.0, 2.0, 0); 3], 1, None),
            (vec![with(1.0, 2.0, 0), with(1.0, 2.0 + 1e-6, 0)], 1, None),
            (vec![with(1.0 + 1e-12, 2.0, 0), with(1.0, 2.0, 0)], 1, None),
            (vec![with(1.0, 2.0, 0), with(1.0, 2.0 + 1e-5, 0)], 2, Some(1)),
            (vec![with(1.0, 2.0, 0), with(1.0, 3.0, 0), with(1.0, 2.0, 0)], 2, Some(1)),
            (vec![with(1.0, 2.0, 0), with(1.0, 3.0, 0), with(1.0, 4.0, 0)], 3, Some(2)),
            (vec![with(1.0, 2.0, 0), with(2.0, 2.0, 0)], 2, None),
            (vec![with(1.0, 2.0, 0), with(1.0, 2.0, 1)], 2, None),
            (vec![with(1.0, 2.0, 1), with(1.0, 2.0, 0), with(1.0, 3.0, 1)], 3, Some(1)),
            (vec![with(0.0, 2.0, 0), with(-0.0, 2.0, 0)], 1, None),
        ] {
            let state = &states_of(&rows).expect("alike")[0];
            let place = repeated.map(|_| "y = 0.5 m, x = 1 m".to_owned());
            assert_eq!(
                (state.pressure.len(), state.repeated, place_of(state)),
                (left, repeated.unwrap_or(0), place),
                "{rows:?}"
            );
        }
        // Of several places the first is told, by height and distance.
        let several =
            [at(3.0, 0.75, 0), with(2.0, 5.0, 0), with(2.0, 6.0, 0), with(1.0, 5.0, 0), with(1.0, 6.0, 0)];
        let state = &states_of(&several).expect("alike")[0];
        assert_eq!((state.repeated, place_of(state)), (2, Some("y = 0.5 m, x = 1 m".to_owned())));
        assert_eq!(states_of(&[]).expect("nothing"), []);
        // Beyond a thousandth of a millionth of it is another time.
        for (off, states) in [(0.9e-9, 1), (1.1e-9, 2)] {
            let found = states_of(&[row(1000.0 * (1.0 + off), 0.5, 2.0, nan), row(1000.0, 0.5, 1.0, nan)]);
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
                "the result: some files have the column `{column}` and others do not: give it in all or in none"
            )
        };
        assert_eq!(lacking(|_| ()), told("u_y"));
        assert_eq!(lacking(|row| row.effective_stress = f64::NAN), told("effective_stress"));
        assert_eq!(lacking(|row| row.initial_distance = f64::NAN), told("x"));
        assert_eq!(lacking(|row| row.horizontal_displacement = f64::NAN), told("u_x"));
    }

    #[test]
    fn quantities_at_places_of_their_own_stand_beside_the_first_ones() {
        let nan = f64::NAN;
        let stress = |time: f64, height: f64| SampleRow {
            effective_stress: -height,
            set: (1, Some(Sample::Centres)),
            ..row(time, height, nan, nan)
        };
        let found = states_of(&[
            stress(1.0, 0.25),
            row(1.0 + 1e-12, 0.5, 1.0, nan),
            row(1.0, 0.0, 2.0, nan),
            stress(1.0 + 1e-12, 0.75),
            row(2.0, 0.0, 3.0, nan),
        ]);
        let states = found.expect("two times");
        assert_eq!((states.len(), &states[0].pressure[..], states[1].beside.len()), (2, &[2.0, 1.0][..], 0));
        let [beside] = &states[0].beside[..] else { panic!("{states:?}") };
        assert_eq!(
            (beside.sample, &beside.state.effective_stress[..]),
            (Some(Sample::Centres), &[-0.25, -0.75][..])
        );
        assert_eq!(beside.state.initial_height, [0.25, 0.75]);
        let kinds: Vec<Sample> = states[0].sets(Sample::Nodes).map(|(sample, _)| sample).collect();
        assert_eq!(kinds, [Sample::Nodes, Sample::Centres]);
    }
}
