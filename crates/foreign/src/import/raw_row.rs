//! One row in the units and signs of its file, and its conversion to a sample in SI.

use crate::import::mapping::units::{
    HorizontalSense, StatedPlace, StressKind, StressSign, StressUnit, VerticalSense,
};
use crate::import::mapping::{Column, Mapping};
use crate::import::origins::Origin;
use crate::import::samples::{PlaceSet, SampleRow};
use oedometer_case::Case;
use oedometer_formats::ImportError;

/// Share of the height by which a place may lie outside: round-off of a number in a file.
const RIM: f64 = 1e-6;

/// What reading a result needs to know of the body that was solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedBody {
    /// Height, m.
    pub height: f64,
    /// Length of a layer, m; columns have none.
    pub length: Option<f64>,
    /// Seconds at which `T_v = 1`.
    pub seconds_per_time_factor: f64,
}

impl SolvedBody {
    /// The body of a case.
    pub fn of(case: &Case) -> Self {
        Self {
            height: case.column.height,
            length: case.scene.body.is_plane().then_some(case.column.extent()),
            seconds_per_time_factor: case.seconds_per_time_factor(),
        }
    }
}

/// A row in the units and signs of its file; the time is in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RawRow {
    /// Time, s.
    pub time: f64,
    /// Place along a layer.
    pub x: Option<f64>,
    /// Height or depth.
    pub y: f64,
    /// Weight.
    pub volume: Option<f64>,
    /// Pore pressure.
    pub pressure: Option<f64>,
    /// Vertical stress.
    pub stress: Option<f64>,
    /// Vertical displacement.
    pub displacement: Option<f64>,
    /// Horizontal displacement.
    pub horizontal_displacement: Option<f64>,
    /// Change of `(x, y)` since the first state, if displacements are derived from it; `x` and `y` are then those of the
    /// first state.
    pub moved: Option<[f64; 2]>,
    /// Hash of what distinguishes it from other rows at its place and time.
    pub others: u64,
    /// Its kind of places, if quantities have different places.
    pub set: PlaceSet,
    /// Where it was read.
    pub origin: Origin,
}

/// Whether a place is the requested one, up to the round-off of single precision.
pub fn is_at(place: f64, requested: f64) -> bool {
    (place - requested).abs() <= RIM * requested.abs().max(1.0)
}

impl RawRow {
    /// Reads the columns of a row one by one.
    ///
    /// # Errors
    /// Those of the columns.
    pub fn read(
        time: f64,
        others: u64,
        origin: Origin,
        number: impl Fn(Column) -> Result<Option<f64>, ImportError>,
    ) -> Result<Self, ImportError> {
        Ok(Self {
            time,
            x: number(Column::X)?,
            y: number(Column::Y)?.unwrap_or(f64::NAN),
            volume: number(Column::Volume)?,
            pressure: number(Column::Pressure)?,
            stress: number(Column::EffectiveStress)?,
            displacement: number(Column::Up)?,
            horizontal_displacement: number(Column::Along)?,
            moved: None,
            others,
            set: PlaceSet::default(),
            origin,
        })
    }

    /// The row in SI with the signs of a [`SampledState`](crate::import::SampledState).
    ///
    /// # Errors
    /// When it lies outside the body, or its time or volume is negative.
    pub fn sample(
        &self,
        mapping: &Mapping,
        body: SolvedBody,
        refused: &dyn Fn(String) -> ImportError,
    ) -> Result<SampleRow, ImportError> {
        let (units, sign) = (&mapping.units, &mapping.sign);
        let stress = units.stress.map_or(1.0, StressUnit::pascals);
        let length = units.length.metres();
        let u_length = units.displacement.unwrap_or(units.length).metres();
        let negated = |is_negated: bool| if is_negated { -1.0 } else { 1.0 };
        let compressive = |sign: Option<StressSign>| negated(sign == Some(StressSign::TensionPositive));
        let (is_down, is_left) = (sign.y == VerticalSense::Down, sign.x == Some(HorizontalSense::Left));
        let (displacement, horizontal) = match self.moved {
            Some([along, up]) => {
                (Some(up * length * negated(is_down)), self.x.map(|_| along * length * negated(is_left)))
            }
            None => (
                self.displacement.map(|u| u * u_length * negated(sign.u_y == Some(VerticalSense::Down))),
                self.horizontal_displacement
                    .map(|u| u * u_length * negated(sign.u_x == Some(HorizontalSense::Left))),
            ),
        };
        let is_current = mapping.position.y == StatedPlace::Current && self.moved.is_none();
        let before = |place: f64, moved: Option<f64>| {
            if is_current { place - moved.unwrap_or(0.0) } else { place }
        };
        let y = (self.y - mapping.origin.y) * length;
        let height = before(if is_down { body.height - y } else { y }, displacement);
        if !is_inside(height, body.height) {
            return Err(refused(outside(height, body.height, mapping.is_turned)));
        }
        let height = height.clamp(0.0, body.height);
        let distance = self.x.map(|x| {
            let x = (x - mapping.origin.x) * length;
            before(if is_left { body.length.unwrap_or(0.0) - x } else { x }, horizontal)
        });
        if let (Some(distance), Some(length)) = (distance, body.length)
            && !is_inside(distance, length)
        {
            return Err(refused(format!(
                "the initial distance {distance} m from the crest is outside the layer of {length} m: check \
                 the unit, the sign and the origin of `x`, and whether places are initial or current"
            )));
        }
        let pore = self.pressure.map(|p| (p - mapping.origin.p) * stress * compressive(sign.p));
        let vertical = self.stress.map(|given| -given * stress * compressive(sign.effective_stress));
        let effective = match mapping.stress.is {
            StressKind::Effective => vertical,
            StressKind::Total => vertical.zip(pore).map(|(total, pore)| total + pore),
        };
        let at_rest = hydrostatic_pressure(mapping, body, height + displacement.unwrap_or(0.0));
        let volume = self.volume.unwrap_or(1.0);
        for (number, what) in [(self.time, "the time"), (volume, "the volume")] {
            if number < 0.0 {
                return Err(refused(format!("{what} is negative")));
            }
        }
        let or_absent = |value: Option<f64>| value.unwrap_or(f64::NAN);
        Ok(SampleRow {
            time: self.time,
            initial_distance: or_absent(distance),
            initial_height: height,
            volume,
            pressure: or_absent(pore.map(|pore| pore - at_rest)),
            effective_stress: or_absent(effective),
            displacement: or_absent(displacement),
            horizontal_displacement: or_absent(horizontal),
            others: self.others,
            set: self.set,
            origin: self.origin,
        })
    }
}

/// The refusal of a height outside the column, or of a distance outside a slab, which is turned.
fn outside(place: f64, extent: f64, is_turned: bool) -> String {
    if is_turned {
        format!(
            "the initial distance {place} m from the middle is outside the slab, whose drained side lies at \
             {extent} m: check the unit, the sign and the origin of `x`, whether places are initial or \
             current, and whether the axes are exchanged: x runs along the drained direction"
        )
    } else {
        format!(
            "the initial height {place} m is outside the column of {extent} m: check the unit and the sign \
             of `y`, and whether places are initial or current"
        )
    }
}

fn is_inside(place: f64, extent: f64) -> bool {
    (-RIM * extent..=(1.0 + RIM) * extent).contains(&place)
}

/// The pressure of water at rest at a present height, Pa, where the mapping says that the file's pressures hold it: the table
/// stays while the soil settles.
fn hydrostatic_pressure(mapping: &Mapping, body: SolvedBody, present: f64) -> f64 {
    mapping
        .hydrostatic
        .map_or(0.0, |water| water.unit_weight * (water.surface.unwrap_or(body.height) - present).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_input::source::StudySource;
    use std::path::Path;

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "single precision is the question")]
    fn a_place_is_the_requested_one_to_single_precision_and_no_further() {
        for requested in [0.0, 0.3, 40.0, -40.0] {
            let rim = RIM * f64::max(1.0, f64::abs(requested));
            for side in [-1.0, 1.0] {
                assert!(is_at(requested + 0.9 * side * rim, requested), "{requested}");
                assert!(!is_at(requested + 1.1 * side * rim, requested), "{requested}");
            }
            assert!(is_at(f64::from(requested as f32), requested) && !is_at(f64::NAN, requested));
        }
        assert!(!is_at(0.301, 0.3), "a point beside it");
    }

    fn sample(mapping: &str, row: RawRow) -> SampleRow {
        let source = StudySource { name: "map.toml".to_owned(), text: mapping.to_owned() };
        let mapping = Mapping::read(&source).expect("a mapping");
        let frame = SolvedBody { height: 2.0, length: None, seconds_per_time_factor: 1.0 };
        let refused = |reason: String| ImportError::content(Path::new("a"), reason);
        row.sample(&mapping, frame, &refused).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn water_at_rest_and_the_total_stress_are_taken_off() {
        let row = RawRow { y: 0.5, pressure: Some(20.0), stress: Some(50.0), ..RawRow::default() };
        let mapping = "stress = { is = \"total\" }\nhydrostatic = { unit_weight = 9810.0 }\n\
                       columns = { p = \"p\", effective_stress = \"s\" }\nunits = { stress = \"kPa\" }\n";
        let sample = sample(mapping, row);
        assert!((sample.pressure - (20e3 - 1.5 * 9810.0)).abs() < 1e-9);
        assert!((sample.effective_stress + 30e3).abs() < 1e-9, "-50 kPa + 20 kPa");
        let down = format!("{mapping}sign = {{ y = \"down\" }}\n");
        let below = self::sample(&down, row);
        assert!((below.pressure - (20e3 - 0.5 * 9810.0)).abs() < 1e-9, "half a metre under the surface");
    }

    #[test]
    fn a_place_that_moved_gives_the_displacement_in_the_sense_of_its_axis() {
        let row = RawRow { y: 0.5, moved: Some([0.0, 0.01]), ..RawRow::default() };
        let up = sample("displacement = { from = \"first-frame\" }", row);
        assert_eq!((up.initial_height, up.displacement), (0.5, 0.01));
        let down = sample("displacement = { from = \"first-frame\" }\nsign = { y = \"down\" }", row);
        assert_eq!((down.initial_height, down.displacement), (1.5, -0.01));
    }

    #[test]
    fn above_the_surface_of_the_water_nothing_is_at_rest() {
        let mapping = "hydrostatic = { unit_weight = 9810.0, surface = 1.2 }\ncolumns = { p = \"p\" }\n";
        for (y, at_rest) in [(0.0, 1.2 * 9810.0), (0.7, 0.5 * 9810.0), (1.2, 0.0), (1.9, 0.0)] {
            let found = sample(mapping, RawRow { y, pressure: Some(20.0), ..RawRow::default() });
            assert!((found.pressure - (20.0 - at_rest)).abs() < 1e-9, "{y}: {}", found.pressure);
        }
    }

    #[test]
    fn a_displacement_taken_from_places_has_their_unit_and_one_of_a_column_its_own() {
        let units = "units = { length = \"cm\", displacement = \"mm\" }\n";
        let row = RawRow { x: Some(10.0), y: 50.0, ..RawRow::default() };
        let of = |found: SampleRow| [found.horizontal_displacement, found.displacement];
        let near = |found: [f64; 2], wanted: [f64; 2]| {
            assert!(found.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-15), "{found:?}");
        };
        let from = format!("displacement = {{ from = \"first-frame\" }}\n{units}");
        near(of(sample(&from, RawRow { moved: Some([0.3, 2.0]), ..row })), [0.003, 0.02]);
        let (displacement, horizontal_displacement) = (Some(2.0), Some(0.3));
        let columns = format!("columns = {{ u_y = \"u\", u_x = \"v\" }}\n{units}");
        near(of(sample(&columns, RawRow { displacement, horizontal_displacement, ..row })), [0.0003, 0.002]);
    }

    #[test]
    fn a_row_outside_the_body_or_before_its_start_is_refused_beyond_the_round_off_of_its_size() {
        let text = "columns = { x = \"x\", p = \"p\", u_x = \"u\", u_y = \"v\" }\n".to_owned();
        let mapping = Mapping::read(&StudySource { name: "map.toml".to_owned(), text }).expect("a mapping");
        let body = SolvedBody { height: 2.0, length: Some(8.0), seconds_per_time_factor: 1.0 };
        let taken = |[x, y]: [f64; 2], time: f64, volume: Option<f64>, body: SolvedBody| {
            let refused = |reason: String| ImportError::content(Path::new("a"), reason);
            let row = RawRow { time, x: Some(x), y, volume, pressure: Some(1.0), ..RawRow::default() };
            let found = row.sample(&mapping, body, &refused);
            found
                .map(|row| [row.initial_distance, row.initial_height, row.volume])
                .map_err(|error| error.to_string())
        };
        let of = |place: [f64; 2]| taken(place, 0.0, None, body);
        // The height is that of the body up to round-off; a distance stays as it is.
        for (place, found) in [
            ([0.0, 2.0], [0.0, 2.0]),
            ([8.0, 0.0], [8.0, 0.0]),
            ([1.0, 2.000_001_9], [1.0, 2.0]),
            ([1.0, -0.000_001_9], [1.0, 0.0]),
            ([8.000_007, 1.0], [8.000_007, 1.0]),
            ([-0.000_007, 1.0], [-0.000_007, 1.0]),
        ] {
            assert_eq!(of(place), Ok([found[0], found[1], 1.0]));
        }
        let high = |height: &str| {
            format!(
                "a: the initial height {height} m is outside the column of 2 m: check the unit and the sign \
                 of `y`, and whether places are initial or current"
            )
        };
        let far = |distance: &str| {
            format!(
                "a: the initial distance {distance} m from the crest is outside the layer of 8 m: check the \
                 unit, the sign and the origin of `x`, and whether places are initial or current"
            )
        };
        for (place, told) in [
            ([0.0, 2.000_003], high("2.000003")),
            ([0.0, -0.000_003], high("-0.000003")),
            ([8.000_009, 1.0], far("8.000009")),
            ([-0.000_009, 1.0], far("-0.000009")),
            ([9.0, 3.0], high("3")),
        ] {
            assert_eq!(of(place), Err(told));
        }
        let column = SolvedBody { length: None, ..body };
        assert_eq!(taken([9.0, 1.0], 0.0, Some(0.0), column), Ok([9.0, 1.0, 0.0]), "a column has no length");
        assert_eq!(taken([0.0, 1.0], -1e-9, None, body), Err("a: the time is negative".to_owned()));
        assert_eq!(taken([0.0, 1.0], 0.0, Some(-1e-9), body), Err("a: the volume is negative".to_owned()));
    }
}
