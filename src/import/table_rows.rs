//! Reads text tables by their declared layout as rows in SI.

use crate::import::expected::left_out;
use crate::import::mapping::units::{SettlementSeries, VerticalSense};
use crate::import::mapping::{Column, DeclaredBy, Mapping, TableLayout};
use crate::import::raw_row::{RawRow, SolvedBody, is_at};
use crate::import::samples::{SampleRow, SampledState};
use crate::import::step_times::declared_time;
use oedometer_formats::{ImportError, excerpt, input_file};
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Names of columns that a message lists.
const MOST_NAMES: usize = 30;
/// Largest relative distance of a time of a settlement curve from that of a state.
const NEAR: f64 = 1e-3;

/// A table that is being read, at one of its lines.
struct Table<'a> {
    path: &'a Path,
    header: csv::StringRecord,
    reader: csv::Reader<File>,
    line: csv::StringRecord,
}

impl<'a> Table<'a> {
    fn open(path: &'a Path, layout: &TableLayout) -> Result<Self, ImportError> {
        let file = input_file::open(path).map_err(ImportError::io(path))?;
        let as_byte = |mark: char| u8::try_from(mark).unwrap_or(b',');
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(as_byte(layout.delimiter))
            .comment(layout.comment.map(as_byte))
            .trim(csv::Trim::All)
            .from_reader(file);
        let header = reader.headers().map_err(|error| ImportError::content(path, error.to_string()))?.clone();
        Ok(Self { path, header, reader, line: csv::StringRecord::new() })
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// The place of a column that must be there; `what` ends the sentence about one that is missing.
    fn find(&self, name: &str, what: &str) -> Result<usize, ImportError> {
        self.place(name).ok_or_else(|| {
            let names = self.header.iter().take(MOST_NAMES).map(|column| format!("`{}`", excerpt(column)));
            let more = self.header.len().saturating_sub(MOST_NAMES);
            let more = (more > 0).then(|| format!("and {more} more"));
            let names = names.chain(more).collect::<Vec<_>>().join(", ");
            self.error(format!("there is no column `{name}`{what}; the header has {names}"))
        })
    }

    fn error(&self, reason: String) -> ImportError {
        ImportError::content(self.path, reason)
    }

    fn error_in_line(&self, reason: String) -> ImportError {
        ImportError::line(self.path, self.line.position().map_or(0, csv::Position::line), reason)
    }

    /// Goes to the next line; false at the end.
    fn next(&mut self) -> Result<bool, ImportError> {
        let read = self.reader.read_record(&mut self.line);
        read.map_err(|error| ImportError::content(self.path, error.to_string()))
    }

    /// The number in a column of the line.
    fn number(&self, place: usize) -> Result<f64, ImportError> {
        let typed = self.line.get(place).unwrap_or_default();
        typed.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            let column = excerpt(self.header.get(place).unwrap_or_default());
            let typed = excerpt(typed);
            self.error_in_line(format!(
                "`{typed}` in the column `{column}` is invalid: expected a finite number"
            ))
        })
    }
}

/// Places of the columns in a header.
struct Places {
    columns: [Option<usize>; Column::ALL.len()],
    /// Columns with the value that a row must have to count.
    equals: Vec<(usize, f64)>,
    /// Columns whose meaning is not declared: they distinguish rows.
    others: Vec<usize>,
}

impl Places {
    fn of(table: &Table, mapping: &Mapping) -> Result<Self, ImportError> {
        if mapping.rows.corners {
            return Err(table.error("a table has no cells: take `corners` out of [rows]".to_owned()));
        }
        let find = |column: Column, name: &String| {
            if mapping.optional.iter().any(|optional| optional == column.name()) {
                return Ok(table.place(name));
            }
            let what = match (column, column.quantity()) {
                (Column::X, _) if mapping.declared_by == DeclaredBy::Convention => {
                    ", and a layer's fields depend on it: write the distance of each sample from the crest of the load, \
                     m, to a column `x`, or name another one with --mapping"
                        .to_owned()
                }
                (_, Some(quantity)) => format!(" (to leave it out, {})", left_out(column, quantity)),
                _ => String::new(),
            };
            table.find(name, &what).map(Some)
        };
        let mut columns = [None; Column::ALL.len()];
        for column in Column::ALL {
            columns[column as usize] =
                mapping.columns.get(column).map(|name| find(column, name)).transpose()?.flatten();
        }
        let equals = mapping.rows.equals.iter().map(|(name, value)| Ok((table.find(name, "")?, *value)));
        let others = (0..table.header.len()).filter(|place| !columns.contains(&Some(*place))).collect();
        Ok(Self { columns, equals: equals.collect::<Result<_, ImportError>>()?, others })
    }

    /// Whether the line of a table counts.
    fn counts(&self, table: &Table, mapping: &Mapping) -> Result<bool, ImportError> {
        for (place, value) in &self.equals {
            if table.number(*place)? != *value {
                return Ok(false);
            }
        }
        match (mapping.rows.x, self.columns[Column::X as usize]) {
            (Some(x), Some(place)) => Ok(is_at(table.number(place)?, x)),
            _ => Ok(true),
        }
    }
}

/// Adds the rows of a table; `place` counts the files of a run.
///
/// # Errors
/// What cannot be read, is not a number or lies outside the body, with its line.
pub fn take_rows(
    path: &Path,
    place: usize,
    mapping: &Mapping,
    body: SolvedBody,
    rows: &mut Vec<SampleRow>,
) -> Result<(), ImportError> {
    let mut table = Table::open(path, &mapping.csv)?;
    let places = Places::of(&table, mapping)?;
    let time_column = places.columns[Column::Time as usize];
    let time_of_file =
        if time_column.is_none() { declared_time(path, place, mapping, body) } else { Ok(None) };
    let time_of_file = time_of_file.map_err(|why| table.error(why))?;
    if time_column.or(time_of_file.map(|_| 0)).is_none() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        return Err(table.error(format!(
            "its time is declared nowhere: add \"{name}\" = … to [time] files, name a column `t`, or give \
             --set-time-step if the name has the number of a step"
        )));
    }
    let before = rows.len();
    while table.next()? {
        if !places.counts(&table, mapping)? {
            continue;
        }
        let of_line = || -> Result<f64, ImportError> {
            let time = table.number(time_column.unwrap_or_default())?;
            Ok(mapping.units.time.seconds(time, body.seconds_per_time_factor))
        };
        let seconds = time_of_file.map_or_else(of_line, Ok)?;
        let mut others = DefaultHasher::new();
        for place in &places.others {
            table.line.get(*place).hash(&mut others);
        }
        let row = RawRow::read(seconds, others.finish(), |column| {
            places.columns[column as usize].map(|place| table.number(place)).transpose()
        })?;
        rows.push(row.sample(mapping, body, &|reason| table.error_in_line(reason))?);
    }
    if rows.len() == before { Err(table.error("there are no rows".to_owned())) } else { Ok(()) }
}

/// Gives each state the surface displacement at the nearest time of a settlement curve; returns how many states got one,
/// and the file of the curve.
///
/// # Errors
/// What cannot be read or is not a number.
pub fn attach_settlement(
    series: &SettlementSeries,
    folder: &Path,
    states: &mut [SampledState],
    mapping: &Mapping,
    body: SolvedBody,
) -> Result<(usize, PathBuf), ImportError> {
    let beside = folder.join(&series.file);
    let path = if beside.is_file() { beside } else { Path::new(&series.file).to_owned() };
    let mut table = Table::open(&path, &mapping.csv)?;
    let place = |name| table.find(name, " of the settlement curve");
    let (time, settlement) = (place(&series.t)?, place(&series.s)?);
    let unit = mapping.units.displacement.unwrap_or(mapping.units.length).metres();
    let upward = if series.sign == VerticalSense::Down { -unit } else { unit };
    let mut curve = Vec::new();
    while table.next()? {
        let seconds = mapping.units.time.seconds(table.number(time)?, body.seconds_per_time_factor);
        curve.push((seconds, table.number(settlement)? * upward));
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

/// Whether the last line of a table ends. A table that is cut inside its last number still reads as a table, with another
/// number.
///
/// # Errors
/// When it cannot be read.
pub fn is_ended(path: &Path) -> Result<bool, ImportError> {
    let last = || {
        let mut file = input_file::open(path)?;
        if file.metadata()?.len() == 0 {
            return Ok(b'\n');
        }
        let mut last = [0];
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last).map(|()| last[0])
    };
    Ok([b'\n', b'\r'].contains(&last().map_err(ImportError::io(path))?))
}

/// A sentence about a table whose last line does not end.
pub fn not_ended(path: &Path) -> String {
    format!(
        "{} does not end with a line break, so it may be cut inside its last number: end the last line with one",
        path.display()
    )
}
