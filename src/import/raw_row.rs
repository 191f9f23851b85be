//! One row as it stands in a file, and what it is in SI with the signs of this program.

use crate::import::mapping::Mapping;
use crate::import::mapping::mapping_parts::StressKind;
use crate::import::mapping::units::{HorizontalSense, StatedPlace, StressSign, StressUnit, VerticalSense};
use oedometer_formats::import_error::ImportError;

/// Share of the height by which a place may lie outside: round-off of a written number.
const RIM: f64 = 1e-6;

/// What was solved, as far as it takes to read a result of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedBody {
    /// Height, m.
    pub height: f64,
    /// Length along a layer, m; a column has none.
    pub length: Option<f64>,
    /// Seconds at which `T_v = 1`.
    pub seconds_per_time_factor: f64,
}

/// One row in SI.
pub struct SampleRow {
    pub time: f64,
    pub initial_distance: Option<f64>,
    pub initial_height: f64,
    pub volume: f64,
    pub pressure: Option<f64>,
    pub effective_stress: Option<f64>,
    pub displacement: Option<f64>,
    pub horizontal_displacement: Option<f64>,
    /// What tells it from other rows at its place and time, as a hash.
    pub others: u64,
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
    /// Change of `(x, y)` since the first state, where displacements come from there; `x` and `y` then are first ones.
    pub moved: Option<[f64; 2]>,
    /// What tells it from other rows at its place and time, as a hash.
    pub others: u64,
}

/// Whether a place is the one that is asked for, to round-off of single precision.
pub fn is_at(place: f64, asked: f64) -> bool {
    (place - asked).abs() <= RIM * asked.abs().max(1.0)
}

impl RawRow {
    /// The row in SI with the signs of this program.
    ///
    /// # Errors
    /// When it lies outside the body, or its time or volume is negative.
    pub fn sample(
        &self,
        mapping: &Mapping,
        frame: SolvedBody,
        refused: &dyn Fn(String) -> ImportError,
    ) -> Result<SampleRow, ImportError> {
        let (units, sign) = (&mapping.units, &mapping.sign);
        let stress = units.stress.map_or(1.0, StressUnit::pascals);
        let length = units.displacement.unwrap_or(units.length).metres();
        let upward = if sign.u_y == Some(VerticalSense::Down) { -1.0 } else { 1.0 };
        let rightward = if sign.u_x == Some(HorizontalSense::Left) { -1.0 } else { 1.0 };
        let compressive =
            |sign: Option<StressSign>| if sign == Some(StressSign::TensionPositive) { -1.0 } else { 1.0 };
        let mut displacement = self.displacement.map(|u| u * length * upward);
        let mut horizontal = self.horizontal_displacement.map(|u| u * length * rightward);
        if let Some([along, up]) = self.moved {
            let up_sign = if sign.y == VerticalSense::Down { -1.0 } else { 1.0 };
            displacement = Some(up * units.length.metres() * up_sign);
            horizontal = self.x.map(|_| along * units.length.metres() * horizontal_sign(mapping));
        }
        let is_current = mapping.position.y == StatedPlace::Current && self.moved.is_none();
        let y = (self.y - mapping.origin.y) * units.length.metres();
        let height = match sign.y {
            VerticalSense::Up => y,
            VerticalSense::Down => frame.height - y,
        };
        let initial_height = if is_current { height - displacement.unwrap_or(0.0) } else { height };
        if !(-RIM * frame.height..=(1.0 + RIM) * frame.height).contains(&initial_height) {
            return Err(refused(format!(
                "the initial height {initial_height} m is outside the column of {} m: look at the unit and the sign of \
                 `y`, and at whose places they are",
                frame.height
            )));
        }
        let initial_height = initial_height.clamp(0.0, frame.height);
        let moved = horizontal.filter(|_| is_current).unwrap_or(0.0);
        let distance = self.x.map(|x| distance(x, mapping, frame, moved, refused)).transpose()?;
        let pore = self.pressure.map(|p| p * stress * compressive(sign.p));
        let vertical = self.stress.map(|given| -given * stress * compressive(sign.effective_stress));
        let effective = match mapping.stress.is {
            StressKind::Effective => vertical,
            StressKind::Total => vertical.zip(pore).map(|(total, pore)| total + pore),
        };
        let at_rest = mapping.hydrostatic.map_or(0.0, |water| {
            water.unit_weight * (water.surface.unwrap_or(frame.height) - initial_height).max(0.0)
        });
        let negative = |number: f64, what: &str| {
            if number < 0.0 { Err(refused(format!("{what} is negative"))) } else { Ok(number) }
        };
        Ok(SampleRow {
            time: negative(self.time, "the time")?,
            initial_distance: distance,
            initial_height,
            volume: negative(self.volume.unwrap_or(1.0), "the volume")?,
            pressure: pore.map(|pore| pore - at_rest),
            effective_stress: effective,
            displacement,
            horizontal_displacement: horizontal,
            others: self.others,
        })
    }
}

fn horizontal_sign(mapping: &Mapping) -> f64 {
    if mapping.sign.x == Some(HorizontalSense::Left) { -1.0 } else { 1.0 }
}

/// Initial distance from the scene's `x = 0`, m; a column has no ends that it could miss.
fn distance(
    x: f64,
    mapping: &Mapping,
    frame: SolvedBody,
    moved: f64,
    refused: &dyn Fn(String) -> ImportError,
) -> Result<f64, ImportError> {
    let x = (x - mapping.origin.x) * mapping.units.length.metres();
    let length = frame.length.unwrap_or(0.0);
    let distance = match mapping.sign.x {
        Some(HorizontalSense::Left) => length - x,
        _ => x,
    };
    let initial = distance - moved;
    if frame.length.is_some() && !(-RIM * length..=(1.0 + RIM) * length).contains(&initial) {
        return Err(refused(format!(
            "the initial distance {initial} m from the crest is outside the layer of {length} m: look at the unit, \
             the sign and the origin of `x`, and at whose places they are"
        )));
    }
    Ok(initial)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::file::StudySource;
    use std::path::Path;

    fn sample(mapping: &str, row: RawRow) -> SampleRow {
        let source = StudySource { name: "map.toml".to_owned(), text: mapping.to_owned() };
        let mapping = Mapping::read(&source).expect("a mapping");
        let frame = SolvedBody { height: 2.0, length: None, seconds_per_time_factor: 1.0 };
        let refused = |reason: String| ImportError::table(Path::new("a"), reason);
        row.sample(&mapping, frame, &refused).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn water_at_rest_and_the_total_stress_are_taken_off() {
        let row = RawRow { y: 0.5, pressure: Some(20.0), stress: Some(50.0), ..RawRow::default() };
        let mapping = "stress = { is = \"total\" }\nhydrostatic = { unit_weight = 9810.0 }\n\
                       columns = { p = \"p\", effective_stress = \"s\" }\nunits = { stress = \"kPa\" }\n";
        let sample = sample(mapping, row);
        assert!((sample.pressure.expect("a pressure") - (20e3 - 1.5 * 9810.0)).abs() < 1e-9);
        assert!((sample.effective_stress.expect("a stress") + 30e3).abs() < 1e-9, "-50 kPa + 20 kPa");
    }

    #[test]
    fn a_place_that_moved_gives_the_displacement_in_the_sense_of_its_axis() {
        let row = RawRow { y: 0.5, moved: Some([0.0, 0.01]), ..RawRow::default() };
        let up = sample("displacement = { from = \"first-frame\" }", row);
        assert_eq!((up.initial_height, up.displacement), (0.5, Some(0.01)));
        let down = sample("displacement = { from = \"first-frame\" }\nsign = { y = \"down\" }", row);
        assert_eq!((down.initial_height, down.displacement), (1.5, Some(-0.01)));
    }
}
