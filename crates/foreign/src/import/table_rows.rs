//! Reads text tables by their declared layout as rows in SI.

use crate::import::csv_text::{CsvText, line_of_record, number_of};
use crate::import::expected::left_out;
use crate::import::mapping::units::{SettlementSeries, VerticalSense};
use crate::import::mapping::{Column, DeclaredBy, Mapping, TableLayout};
use crate::import::origins::{Origin, Origins, PartKind};
use crate::import::raw_row::{RawRow, SolvedBody, is_at};
use crate::import::samples::{SampleRow, SampledState, states_of};
use crate::import::step_times::declared_time;
use oedometer_formats::{ImportError, excerpt};
use oedometer_soil::wording::typed;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Names of columns that a message lists.
const MOST_NAMES: usize = 30;
/// Largest relative distance of a time of a settlement curve from that of a state.
const NEAR: f64 = 1e-3;

/// A table that is being read, at one of its lines.
struct Table<'a> {
    path: &'a Path,
    header: csv::StringRecord,
    reader: csv::Reader<Cursor<Vec<u8>>>,
    line: csv::StringRecord,
    /// Its first byte below comments and blank lines, and its number.
    at: (usize, u64),
    comment: Option<char>,
    has_decimal_comma: bool,
    is_ended: bool,
}

impl<'a> Table<'a> {
    fn open(path: &'a Path, layout: &TableLayout) -> Result<Self, ImportError> {
        let CsvText { text, delimiter, comment, has_decimal_comma, names, is_ended } =
            CsvText::read(path, layout)?;
        let as_byte = |mark: char| u8::try_from(mark).unwrap_or(b'#');
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .comment(comment.map(as_byte))
            .trim(csv::Trim::All)
            .has_headers(names.is_none())
            .from_reader(Cursor::new(text));
        let header = if let Some(names) = names {
            csv::StringRecord::from(names)
        } else {
            let header = reader.headers();
            header.map_err(|error| ImportError::content(path, error.to_string()))?.clone()
        };
        Ok(Self {
            path,
            header,
            reader,
            line: csv::StringRecord::new(),
            at: (0, 1),
            comment,
            has_decimal_comma,
            is_ended,
        })
    }

    /// The place of the first of several names, separated by `|`, that is a column.
    fn place_of(&self, typed: &str) -> Option<usize> {
        self.place(typed).or_else(|| typed.split('|').find_map(|name| self.place(name.trim())))
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// The place of a column that must be there; `what` ends the sentence about one that is missing.
    fn find(&self, name: &str, what: &str) -> Result<usize, ImportError> {
        let found = self.place_of(name);
        if let Some(column) = found.and_then(|place| self.header.get(place))
            && self.header.iter().filter(|other| *other == column).count() > 1
        {
            return Err(self.error(format!(
                "the header has `{}` more than once: rename the columns that are not meant",
                excerpt(column)
            )));
        }
        found.ok_or_else(|| {
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
        ImportError::line(self.path, self.at.1, reason)
    }

    /// Goes to the next line; false at the end.
    fn next(&mut self) -> Result<bool, ImportError> {
        let is_there = self.reader.read_record(&mut self.line).map_err(|error| match error.kind() {
            csv::ErrorKind::UnequalLengths { pos: Some(place), expected_len, len } => {
                let line =
                    line_of_record(self.reader.get_ref().get_ref(), place.byte(), self.comment, (0, 1)).1;
                ImportError::line(self.path, line, uneven(*len, *expected_len))
            }
            _ => ImportError::content(self.path, error.to_string()),
        })?;
        let byte = self.line.position().filter(|_| is_there).map(csv::Position::byte);
        if let Some(byte) = byte {
            self.at = line_of_record(self.reader.get_ref().get_ref(), byte, self.comment, self.at);
        }
        Ok(is_there)
    }

    /// Where the line is, in a part of a result.
    fn origin(&self, part: u32) -> Origin {
        Origin { part, line: u32::try_from(self.at.1).unwrap_or(u32::MAX) }
    }

    /// The number in a column of the line.
    fn number(&self, place: usize) -> Result<f64, ImportError> {
        let typed = self.line.get(place).unwrap_or_default();
        let number = number_of(typed, self.has_decimal_comma);
        number.filter(|number| number.is_finite()).ok_or_else(|| {
            let column = excerpt(self.header.get(place).unwrap_or_default());
            let has_comma = !self.has_decimal_comma && number_of(typed, true).is_some_and(f64::is_finite);
            let hint = if has_comma {
                "; where a comma begins fractions, write `decimal = \",\"` into [csv]"
            } else {
                ""
            };
            let typed = excerpt(typed);
            self.error_in_line(format!(
                "`{typed}` in the column `{column}` is invalid: expected a finite number{hint}"
            ))
        })
    }
}

/// What is wrong with a line of more or fewer fields than the lines above it.
fn uneven(fields: u64, expected: u64) -> String {
    let why = if fields < expected {
        "a value is missing, or the line is cut"
    } else {
        "there is a value too many; where a comma begins fractions, separate the columns by another sign"
    };
    let fields = if fields == 1 { "1 field".to_owned() } else { format!("{fields} fields") };
    format!("the line has {fields}, and those above have {expected}: {why}")
}

/// Places of the columns in a header.
struct Places {
    columns: [Option<usize>; Column::ALL.len()],
    /// Columns with the value that a row must have to count.
    equals: Vec<(usize, f64)>,
    /// Columns whose meaning is not declared: they distinguish rows.
    others: Vec<usize>,
    /// Quantities with one column per height.
    wide: Vec<Wide>,
}

/// Quantities with one column per height, at the same heights.
struct Wide {
    heights: Vec<f64>,
    /// The column of each height, for each quantity.
    quantities: Vec<(Column, Vec<usize>)>,
}

impl Wide {
    /// Those of a mapping; quantities with the same heights are together.
    fn of(table: &Table, mapping: &Mapping) -> Result<Vec<Self>, ImportError> {
        let mut sets: Vec<Self> = Vec::new();
        for (column, named) in mapping.columns.wide() {
            let what = format!(" for `{}`", column.name());
            let places = named.iter().map(|(name, _)| table.find(name, &what));
            let places = places.collect::<Result<Vec<usize>, ImportError>>()?;
            let heights: Vec<f64> = named.iter().map(|(_, height)| *height).collect();
            match sets.iter_mut().find(|set| set.heights == heights) {
                Some(set) => set.quantities.push((column, places)),
                None => sets.push(Self { heights, quantities: vec![(column, places)] }),
            }
        }
        Ok(sets)
    }
}

impl Places {
    fn of(table: &Table, mapping: &Mapping) -> Result<Self, ImportError> {
        if mapping.rows.corners {
            return Err(table.error("a table has no cells: take `corners` out of [rows]".to_owned()));
        }
        let find = |column: Column, name: &String| {
            // A row without a height is none, whoever declared its column.
            let is_optional = mapping.optional.iter().any(|optional| optional == column.name());
            if is_optional && column != Column::Y {
                return Ok(table.place_of(name));
            }
            let what = match (column, column.quantity()) {
                (Column::X, _) if mapping.declared_by == DeclaredBy::Convention => {
                    ", and a layer's fields depend on it: write the distance of each sample from the crest of the load, \
                     m, to a column `x`, or name another one with --mapping"
                        .to_owned()
                }
                (Column::Y, _) if !mapping.is_turned => {
                    " (the heights of the rows; a settlement curve alone is named by [settlement], with `p` and `u_y` empty in \
                     [columns])"
                        .to_owned()
                }
                (_, Some(quantity)) => format!(" (to leave it out, {})", left_out(mapping.shown(column), quantity)),
                _ => String::new(),
            };
            table.find(name, &what).map(Some)
        };
        let wide = Wide::of(table, mapping)?;
        let mut columns = [None; Column::ALL.len()];
        for column in Column::ALL {
            // The heights of columns are in the mapping.
            let is_there = column != Column::Y || wide.is_empty();
            let name = mapping.columns.get(column).filter(|_| is_there);
            columns[column as usize] = name.map(|name| find(column, name)).transpose()?.flatten();
        }
        let equals = mapping.rows.equals.iter().map(|(name, value)| Ok((table.find(name, "")?, *value)));
        let others = (0..table.header.len()).filter(|place| !columns.contains(&Some(*place))).collect();
        Ok(Self { columns, equals: equals.collect::<Result<_, ImportError>>()?, others, wide })
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

/// Adds the rows of a table; `place` counts the files of a run. Returns whether its last line ends: a table that is cut
/// inside its last number still reads as a table, with another number.
///
/// # Errors
/// What cannot be read, is not a number or lies outside the body, with its line.
pub fn take_rows(
    path: &Path,
    place: usize,
    mapping: &Mapping,
    body: SolvedBody,
    origins: &mut Origins,
    rows: &mut Vec<SampleRow>,
) -> Result<bool, ImportError> {
    let part = origins.add(path, path, PartKind::Lines);
    let mut table = Table::open(path, &mapping.csv)?;
    let mut places = Places::of(&table, mapping)?;
    let time_column = places.columns[Column::Time as usize];
    let time_of_file =
        if time_column.is_none() { declared_time(path, place, false, mapping, body) } else { Ok(None) };
    let time_of_file = time_of_file.map_err(|why| table.error(why))?;
    // A column that has the name of the convention needs no other word.
    let time_column = time_column.or_else(|| table.place("t").filter(|_| time_of_file.is_none()));
    places.columns[Column::Time as usize] = time_column;
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
        if !places.wide.is_empty() {
            take_wide(&table, &places.wide, seconds, part, mapping, body, rows)?;
            continue;
        }
        let mut others = DefaultHasher::new();
        for place in &places.others {
            table.line.get(*place).hash(&mut others);
        }
        let row = RawRow::read(seconds, others.finish(), table.origin(part), |column| {
            places.columns[column as usize].map(|place| table.number(place)).transpose()
        })?;
        rows.push(row.sample(mapping, body, &|reason| table.error_in_line(reason))?);
    }
    if rows.len() == before { Err(table.error("there are no rows".to_owned())) } else { Ok(table.is_ended) }
}

/// Adds the rows of a line with one column per height.
fn take_wide(
    table: &Table,
    sets: &[Wide],
    seconds: f64,
    part: u32,
    mapping: &Mapping,
    body: SolvedBody,
    rows: &mut Vec<SampleRow>,
) -> Result<(), ImportError> {
    for (number, set) in (0_u8..).zip(sets) {
        for (place, height) in set.heights.iter().enumerate() {
            let of = |column: Column| {
                let places = set.quantities.iter().find(|(known, _)| *known == column);
                places.map(|(_, places)| table.number(places[place])).transpose()
            };
            let row = RawRow {
                time: seconds,
                y: *height,
                pressure: of(Column::Pressure)?,
                stress: of(Column::EffectiveStress)?,
                displacement: of(Column::Up)?,
                horizontal_displacement: of(Column::Along)?,
                set: (number, None),
                origin: table.origin(part),
                ..RawRow::default()
            };
            rows.push(row.sample(mapping, body, &|reason| table.error_in_line(reason))?);
        }
    }
    Ok(())
}

/// A settlement curve: times, s, with the displacement of the surface, m.
pub struct Curve {
    points: Vec<(f64, f64)>,
    /// What of it contradicts itself, a sentence each.
    pub contradictions: Vec<String>,
    /// Its file.
    pub file: PathBuf,
    /// Whether the last line of the file ends.
    pub is_ended: bool,
}

impl Curve {
    /// Reads the curve that a mapping names, beside the results, in the current folder, or in the result itself.
    ///
    /// # Errors
    /// What cannot be read or is not a number.
    pub fn read(
        series: &SettlementSeries,
        result: Option<&Path>,
        mapping: &Mapping,
        body: SolvedBody,
    ) -> Result<Self, ImportError> {
        let folder = result.and_then(Path::parent).unwrap_or(Path::new(""));
        let beside = folder.join(&series.file);
        let file = match result {
            Some(result) if series.file.is_empty() => result.to_owned(),
            _ if beside.is_file() => beside,
            _ => Path::new(&series.file).to_owned(),
        };
        let mut table = Table::open(&file, &mapping.csv)?;
        let place = |name| table.find(name, " of the settlement curve");
        let (time, settlement) = (place(&series.t)?, place(&series.s)?);
        let unit = mapping.units.displacement.unwrap_or(mapping.units.length).metres();
        let upward = if series.sign == VerticalSense::Down { -unit } else { unit };
        let mut origins = Origins::of_curve(mapping);
        let part = origins.add(&file, &file, PartKind::Lines);
        let mut rows = Vec::new();
        while table.next()? {
            let seconds = mapping.units.time.seconds(table.number(time)?, body.seconds_per_time_factor);
            if seconds < 0.0 {
                return Err(table.error_in_line("the time is negative".to_owned()));
            }
            rows.push(SampleRow {
                displacement: table.number(settlement)? * upward,
                ..SampleRow::at(seconds, body.height, table.origin(part))
            });
        }
        if rows.is_empty() {
            return Err(table.error("there are no rows".to_owned()));
        }
        let (points, contradictions) = points_of(&rows, &origins)?;
        let is_ended = table.is_ended;
        Ok(Self { points, contradictions, file, is_ended })
    }

    /// Gives each state the displacement of the surface at the nearest time of the curve; returns how many states got one.
    pub fn attach(&self, states: &mut [SampledState]) -> usize {
        let mut matched = 0;
        for state in states {
            let off = |point: &&(f64, f64)| (point.0 - state.time).abs();
            let nearest = self.points.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            let near = nearest.filter(|point| off(point) <= NEAR * state.time);
            state.surface_displacement = near.map(|(_, displacement)| *displacement);
            matched += usize::from(state.surface_displacement.is_some());
        }
        matched
    }

    /// The states of a result that is nothing but the curve, by time.
    pub fn states(&self) -> Vec<SampledState> {
        let state = |(time, displacement): (f64, f64)| SampledState {
            time,
            surface_displacement: Some(displacement),
            ..SampledState::default()
        };
        self.points.iter().copied().map(state).collect()
    }
}

/// The times and displacements of a curve, and what of it contradicts itself.
fn points_of(rows: &[SampleRow], origins: &Origins) -> Result<(Vec<(f64, f64)>, Vec<String>), ImportError> {
    let (states, mut contradictions) = states_of(rows, origins)?;
    let repeated = states.iter().filter_map(|state| {
        let values = state.repeated_at.as_ref()?;
        Some(format!(
            "at t = {} s it has two values, at {values}: keep the run that counts",
            typed(state.time)
        ))
    });
    contradictions.splice(0..0, repeated);
    Ok((states.iter().map(|state| (state.time, state.displacement[0])).collect(), contradictions))
}

/// A sentence about a table whose last line does not end.
pub fn not_ended(path: &Path) -> String {
    format!(
        "{} does not end with a line break, so it may be cut inside its last number: end the last line with one",
        path.display()
    )
}
