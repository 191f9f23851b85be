//! One file's rows in SI, with the signs of this program.

use crate::import::mapping::Mapping;
use crate::import::opened_csv::{CsvTable, line_of};
use crate::import::raw_row::{RawRow, SolvedBody, is_at};
use crate::import::rows::Rows;
use crate::import::step_times::declared_time;
use oedometer_formats::bytes::short;
use oedometer_formats::import_error::ImportError;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// Places of the columns in a file's header.
struct Places {
    time: Option<usize>,
    distance: Option<usize>,
    height: usize,
    pressure: Option<usize>,
    displacement: Option<usize>,
    effective_stress: Option<usize>,
    horizontal_displacement: Option<usize>,
    volume: Option<usize>,
    /// Columns with the value that a row must have to count.
    equals: Vec<(usize, f64)>,
    /// Columns of which nothing is declared: they tell rows apart.
    others: Vec<usize>,
}

impl Places {
    fn of(table: &CsvTable, mapping: &Mapping) -> Result<Self, ImportError> {
        let path = table.path;
        let find = |name: &String| {
            let none = || format!("there is no column `{name}`; the header has {}", table.names());
            table.place(name).ok_or_else(|| ImportError::table(path, none()))
        };
        let find_some = |name: &Option<String>| name.as_ref().map(&find).transpose();
        let columns = &mapping.columns;
        let distance = columns.x.as_ref().map(|name| match table.place(name) {
            None if mapping.is_convention => {
                let reason = format!(
                    "there is no column `x`, and a layer's fields depend on it: write the distance of each sample from \
                     the crest of the load, m, to a column `x`, or name another with --mapping; the header has {}",
                    table.names()
                );
                Err(ImportError::table(path, reason))
            }
            _ => find(name),
        });
        let mut places = Self {
            time: find_some(&columns.t)?,
            distance: distance.transpose()?,
            height: find(&columns.y)?,
            pressure: find_some(&columns.p)?,
            displacement: find_some(&columns.u_y)?,
            effective_stress: find_some(&columns.effective_stress)?,
            horizontal_displacement: match &columns.u_x {
                Some(name) if mapping.is_convention => table.place(name),
                name => find_some(name)?,
            },
            volume: find_some(&columns.volume)?,
            equals: Vec::new(),
            others: Vec::new(),
        };
        if mapping.rows.corners {
            return Err(ImportError::table(path, "a table has no cells: take `corners` out of [rows]"));
        }
        for (name, value) in &mapping.rows.equals {
            places.equals.push((find(name)?, *value));
        }
        places.others = (0..table.header.len()).filter(|place| !places.has(*place)).collect();
        Ok(places)
    }

    /// Whether a meaning is declared for a column.
    fn has(&self, place: usize) -> bool {
        let optional = [
            self.time,
            self.distance,
            self.pressure,
            self.displacement,
            self.effective_stress,
            self.horizontal_displacement,
            self.volume,
        ];
        self.height == place || optional.contains(&Some(place))
    }
}

/// Adds the rows of one file, the so many-th of its run.
///
/// # Errors
/// What cannot be read or taken, with its line.
pub fn take_rows(
    path: &Path,
    place_of_file: usize,
    mapping: &Mapping,
    frame: SolvedBody,
    rows: &mut Rows,
) -> Result<(), ImportError> {
    let mut table = CsvTable::open(path, &mapping.csv)?;
    let places = Places::of(&table, mapping)?;
    let time_of_file = match places.time {
        Some(_) => None,
        None => Some(time_of_file(path, place_of_file, mapping, frame)?),
    };
    let before = rows.len();
    let header = table.header.clone();
    let mut record = csv::StringRecord::new();
    while table.next(&mut record)? {
        let line = RowReader { path, header: &header, record: &record };
        if !line.counts(&places, mapping)? {
            continue;
        }
        let seconds = if let Some(seconds) = time_of_file {
            seconds
        } else {
            let time = line.number(places.time.unwrap_or_default())?;
            mapping.units.time.seconds(time, frame.seconds_per_time_factor)
        };
        let refused = |reason: String| line.error(reason);
        rows.push(&line.row(&places, seconds)?.sample(mapping, frame, &refused)?);
    }
    if rows.len() == before {
        return Err(ImportError::table(path, "there are no rows"));
    }
    Ok(())
}

/// The declared time of a file that holds one step, s.
fn time_of_file(path: &Path, place: usize, mapping: &Mapping, frame: SolvedBody) -> Result<f64, ImportError> {
    let declared = declared_time(path, place, mapping, frame).map_err(|why| ImportError::table(path, why))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let nowhere = || {
        format!(
            "its time is declared nowhere; add \"{name}\" = … to [time] files, name a column `t`, or give \
             --set-time-step where the name has the number of a step"
        )
    };
    declared.ok_or_else(|| ImportError::table(path, nowhere()))
}

/// One line of a file.
struct RowReader<'a> {
    path: &'a Path,
    header: &'a csv::StringRecord,
    record: &'a csv::StringRecord,
}

impl RowReader<'_> {
    fn error(&self, reason: String) -> ImportError {
        ImportError::Row { path: self.path.to_owned(), line: line_of(self.record), reason }
    }

    fn number(&self, place: usize) -> Result<f64, ImportError> {
        let typed = self.record.get(place).unwrap_or_default();
        match typed.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let column = short(self.header.get(place).unwrap_or_default());
                Err(self.error(format!("`{}` in the column `{column}` is no finite number", short(typed))))
            }
        }
    }

    /// The row as it stands in the file.
    fn row(&self, places: &Places, time: f64) -> Result<RawRow, ImportError> {
        let read = |place: Option<usize>| place.map(|place| self.number(place)).transpose();
        Ok(RawRow {
            time,
            x: read(places.distance)?,
            y: self.number(places.height)?,
            volume: read(places.volume)?,
            pressure: read(places.pressure)?,
            stress: read(places.effective_stress)?,
            displacement: read(places.displacement)?,
            horizontal_displacement: read(places.horizontal_displacement)?,
            moved: None,
            others: self.others(places),
        })
    }

    /// Whether the row counts.
    fn counts(&self, places: &Places, mapping: &Mapping) -> Result<bool, ImportError> {
        for (place, value) in &places.equals {
            if self.number(*place)? != *value {
                return Ok(false);
            }
        }
        match (mapping.rows.x, places.distance) {
            (Some(x), Some(place)) => Ok(is_at(self.number(place)?, x)),
            _ => Ok(true),
        }
    }

    /// What stands in the columns of which nothing is declared, as one number.
    fn others(&self, places: &Places) -> u64 {
        let mut hasher = DefaultHasher::new();
        for place in &places.others {
            self.record.get(*place).hash(&mut hasher);
        }
        hasher.finish()
    }
}
