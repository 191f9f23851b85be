//! A settlement curve in a file of its own.

use crate::import::mapping::Mapping;
use crate::import::mapping::mapping_parts::SettlementSeries;
use crate::import::mapping::units::VerticalSense;
use crate::import::opened_csv::{CsvTable, line_of};
use crate::import::raw_row::SolvedBody;
use crate::import::table::SampledState;
use oedometer_formats::bytes::short;
use oedometer_formats::import_error::ImportError;
use std::path::{Path, PathBuf};

/// How far, relative, a time of the curve may lie from that of a state.
const NEAR: f64 = 1e-3;

/// Gives each state the displacement of the surface at the curve's nearest time; how many got one, and the curve's file.
///
/// # Errors
/// What cannot be read or is no number.
pub fn attach(
    series: &SettlementSeries,
    folder: &Path,
    states: &mut [SampledState],
    mapping: &Mapping,
    frame: SolvedBody,
) -> Result<(usize, PathBuf), ImportError> {
    let beside = folder.join(&series.file);
    let path = if beside.is_file() { beside } else { Path::new(&series.file).to_owned() };
    let mut table = CsvTable::open(&path, &mapping.csv)?;
    let place = |name: &str| {
        let none = || {
            format!("there is no column `{name}` of the settlement curve; the header has {}", table.names())
        };
        table.place(name).ok_or_else(|| ImportError::table(&path, none()))
    };
    let (time, settlement) = (place(&series.t)?, place(&series.s)?);
    let unit = mapping.units.displacement.unwrap_or(mapping.units.length).metres();
    let upward = if series.sign == VerticalSense::Down { -unit } else { unit };
    let mut curve = Vec::new();
    let mut record = csv::StringRecord::new();
    while table.next(&mut record)? {
        let number = |place: usize| {
            let typed = record.get(place).unwrap_or_default();
            typed.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| ImportError::Row {
                path: path.clone(),
                line: line_of(&record),
                reason: format!("`{}` is no finite number", short(typed)),
            })
        };
        let seconds = mapping.units.time.seconds(number(time)?, frame.seconds_per_time_factor);
        curve.push((seconds, number(settlement)? * upward));
    }
    let mut matched = 0;
    for state in states {
        let off = |point: &&(f64, f64)| (point.0 - state.time).abs();
        let nearest = curve.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        state.surface_displacement =
            nearest.filter(|point| off(point) <= NEAR * state.time).map(|(_, displacement)| *displacement);
        matched += usize::from(state.surface_displacement.is_some());
    }
    Ok((matched, path))
}
