//! The tables beside the tidy one: profiles, settlement over time, and what every column means.

use crate::case::keys::KEYS;
use crate::record::Record;
use crate::record::csv::{lines_of, tidy};
use oedometer_problem::snapshot::Samples;

/// Columns of the profiles.
const PROFILE_COLUMNS: [(&str, &str, &str); 10] = [
    ("case", "", "hash of the case"),
    ("time_factor", "", "T_v = c_v t/H², with the drained c_v"),
    ("time", "s", "time since the load"),
    ("sample", "", "points, centres (means over a cell's points) or nodes"),
    ("distance", "m", "initial place along a layer; empty in one dimension"),
    ("height", "m", "initial height above the base"),
    ("pressure", "Pa", "excess pore pressure, compression positive"),
    ("effective_stress", "Pa", "vertical effective stress, tension positive"),
    ("displacement_height", "m", "initial height of the displacement"),
    ("displacement", "m", "vertical displacement, upward positive"),
];

/// Columns of the settlement over time.
const HISTORY_COLUMNS: [(&str, &str, &str); 5] = [
    ("case", "", "hash of the case"),
    ("time_factor", "", "T_v = c_v t/H², with the drained c_v"),
    ("degree_of_consolidation", "", "settlement over the final one of the problem's own reference"),
    ("kinetic_energy", "J", "of grains and water, per unit area or thickness, in problems with waves"),
    ("strain_energy", "J", "of skeleton and water, including the initial energy"),
];

/// Columns of the tidy table that are not inputs: name, unit, meaning.
const TIDY_COLUMNS: [(&str, &str, &str); 17] = [
    ("study", "", "name of the study"),
    ("case", "", "hash of the case"),
    ("largest_step_seconds", "s", "largest time step"),
    ("steps", "", "time steps"),
    ("point_updates", "", "steps times points"),
    ("status", "", "ok, or how the case failed"),
    ("sources", "", "hash of the program's sources"),
    ("time_factor", "", "T_v = c_v t/H², with the drained c_v"),
    ("quantity", "", "compared quantity, or a measure such as peak_pressure"),
    ("sample", "", "places of the comparison"),
    ("norm", "", "norm of the error; of a measure: relative or absolute"),
    ("reference", "", "exact solution"),
    ("value", "", "relative error; of the settlement with its sign"),
    ("absolute_error", "", "error over the load, or over the final settlement"),
    ("cell_size", "m", "edge of a cell"),
    ("wall_seconds", "s", "wall time, the least of the runs"),
    ("cpu_seconds", "s", "processor time, if the system reports it"),
];

/// A table with rows of every record, one record after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LongTable {
    /// Fields over the height at every output: a row per case, time and place.
    Profiles,
    /// Settlement over time: a row per case and time.
    History,
}

impl LongTable {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Profiles, Self::History];

    /// Its name, that of its file without the ending.
    pub fn name(self) -> &'static str {
        match self {
            Self::Profiles => "profiles",
            Self::History => "history",
        }
    }

    /// Its columns: name, unit, meaning.
    fn columns(self) -> &'static [(&'static str, &'static str, &'static str)] {
        match self {
            Self::Profiles => &PROFILE_COLUMNS,
            Self::History => &HISTORY_COLUMNS,
        }
    }

    /// The line of its columns, with its end.
    pub fn header_line(self) -> String {
        self.columns().iter().map(|(name, _, _)| *name).collect::<Vec<_>>().join(",") + "\n"
    }

    /// The rows of a record.
    ///
    /// # Errors
    /// Never for plain words; the writer's own otherwise.
    pub fn rows_of(self, record: &Record) -> Result<String, csv::Error> {
        match self {
            Self::Profiles => lines_of(profile_rows(record)),
            Self::History => lines_of(record.history.iter().map(|row| {
                let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:e}"));
                let numbers = [Some(row.time_factor), Some(row.degree_of_consolidation)];
                let energies =
                    [row.energy.map(|energy| energy.kinetic), row.energy.map(|energy| energy.strain)];
                let [factor, degree] = numbers.map(number);
                let [kinetic, strain] = energies.map(number);
                [record.hash.clone(), factor, degree, kinetic, strain]
            })),
        }
    }
}

fn profile_rows(record: &Record) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for (factor, snapshot) in record.case.time_factors.iter().zip(&record.snapshots) {
        let of_kind =
            [("points", &snapshot.points), ("centres", &snapshot.centres), ("nodes", &snapshot.nodes)];
        for (sample, samples) in of_kind {
            let first =
                [record.hash.clone(), factor.to_string(), format!("{:e}", snapshot.time), sample.to_owned()];
            rows.extend((0..samples.initial_height.len()).map(|place| profile_row(&first, samples, place)));
        }
    }
    rows
}

fn profile_row(first: &[String; 4], samples: &Samples, place: usize) -> Vec<String> {
    let number = |values: &[f64]| values.get(place).map_or(String::new(), |value| format!("{value:e}"));
    let distance = samples.plane.as_ref().map_or(String::new(), |plane| number(&plane.initial_distance));
    let mut row = first.to_vec();
    row.extend([
        distance,
        number(&samples.initial_height),
        number(&samples.pressure),
        number(&samples.effective_stress),
        number(samples.displacement_height.as_deref().unwrap_or(&samples.initial_height)),
        number(&samples.displacement),
    ]);
    row
}

/// Every column of the three tables with its unit and meaning.
///
/// # Errors
/// Never for plain numbers and words; the writer's own otherwise.
pub fn columns_csv() -> Result<String, csv::Error> {
    let mut rows = vec![["table", "column", "unit", "meaning"]];
    for name in tidy::columns() {
        let input = KEYS.iter().find(|key| key.name == name).map(|key| (key.unit, key.meaning));
        let other = TIDY_COLUMNS
            .iter()
            .find(|(column, _, _)| *column == name)
            .map(|(_, unit, meaning)| (*unit, *meaning));
        let (unit, meaning) = input.or(other).unwrap_or(match name {
            "scene" => ("", "physical problem"),
            _ => ("", "solve or stability"),
        });
        rows.push(["", name, unit, meaning]);
    }
    for table in LongTable::ALL {
        rows.extend(table.columns().iter().map(|(name, unit, meaning)| [table.name(), name, unit, meaning]));
    }
    lines_of(rows)
}
