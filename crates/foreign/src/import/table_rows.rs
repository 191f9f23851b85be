//! Reads text tables by their declared layout as rows in SI.

use crate::import::csv_text::{CsvText, line_of_record, number_of, number_of_thousands};
use crate::import::expected::left_out;
use crate::import::mapping::units::{SettlementSeries, VerticalSense};
use crate::import::mapping::{Column, DeclaredBy, Mapping, TableLayout};
use crate::import::origins::{Origin, Origins, PartKind};
use crate::import::raw_row::{RawRow, SolvedBody, is_at};
use crate::import::said_units::SaidUnit;
use crate::import::samples::{SampleRow, SampledState, states_of};
use crate::import::step_times::declared_time;
use oedometer_formats::{ImportError, excerpt};
use oedometer_wording::typed;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Most doubts that are told of a table.
const MOST_DOUBTS: usize = 4;
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
    /// Units of the columns, where a row has them.
    units: Vec<String>,
    /// For each column with signs between thousands the first number that has one, with its line, and whether nothing else can
    /// be meant.
    thousands: Vec<Option<Thousands>>,
    /// For each column whose commas may stand between thousands, beside fractions with a point, the first such number.
    commas: Vec<Option<Thousands>>,
    is_ended: bool,
}

/// Numbers of a column with signs between their thousands.
#[derive(Clone, Debug)]
struct Thousands {
    first: String,
    line: u64,
    is_certain: bool,
}

/// What is told of a table beside its rows.
#[derive(Debug, Default)]
pub struct TableNotes {
    /// Whether its last line ends: a table that is cut inside its last number still reads as a table, with another number.
    pub is_ended: bool,
    /// What was taken from where.
    pub notes: Vec<String>,
    /// What it says in two ways.
    pub doubts: Vec<String>,
}

impl<'a> Table<'a> {
    fn open(path: &'a Path, layout: &TableLayout) -> Result<Self, ImportError> {
        let CsvText { text, delimiter, comment, has_decimal_comma, names, units, is_ended } =
            CsvText::read(path, layout)?;
        let as_byte = |mark: char| u8::try_from(mark).unwrap_or(b'#');
        let mut builder = csv::ReaderBuilder::new();
        builder
            .delimiter(delimiter)
            .comment(comment.map(as_byte))
            .trim(csv::Trim::All)
            .has_headers(names.is_none());
        let thousands = thousands_of(&builder, &text, has_decimal_comma, delimiter);
        let are_inferred = has_decimal_comma && layout.decimal.is_none();
        let commas = if are_inferred { commas_of(&builder, &text) } else { Vec::new() };
        let mut reader = builder.from_reader(Cursor::new(text));
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
            units,
            thousands,
            commas,
            is_ended,
        })
    }

    /// What its numbers become by the unit that it states for a column, and what is told of that.
    fn factor(&self, column: Column, place: usize, mapping: &Mapping, table_notes: &mut TableNotes) -> f64 {
        let name = self.header.get(place).unwrap_or_default();
        let stated = self.units.get(place).map(String::as_str).filter(|unit| !unit.is_empty());
        let said = match (stated, SaidUnit::in_name(name)) {
            (Some(unit), _) => SaidUnit::of(column, name, unit, mapping),
            // A word in brackets may be none.
            (None, Some(unit)) => match SaidUnit::of(column, name, unit, mapping) {
                SaidUnit::Unfit(_) => SaidUnit::AsMapped,
                said => said,
            },
            (None, None) => SaidUnit::AsMapped,
        };
        let file = self.path.display();
        match said {
            SaidUnit::AsMapped => 1.0,
            SaidUnit::Factor(factor, note) => {
                table_notes.notes.push(format!("{file}: {note}"));
                factor
            }
            SaidUnit::Unfit(doubt) => {
                table_notes.doubts.push(format!("{file}: {doubt}"));
                1.0
            }
        }
    }

    /// Doubts about numbers of a column that may have signs between thousands.
    fn doubt(&self, place: usize, table_notes: &mut TableNotes) {
        let doubtful = |columns: &[Option<Thousands>]| columns.get(place).cloned().flatten();
        let thousands = doubtful(&self.thousands).filter(|known| !known.is_certain);
        let read_as = |known: &Thousands| known.first.replace([',', '.'], "");
        let of_thousands = thousands
            .map(|known| (if self.has_decimal_comma { "point" } else { "comma" }, read_as(&known), known));
        let of_commas = doubtful(&self.commas).map(|known| ("comma", known.first.replace(',', "."), known));
        if let Some((sign, number, Thousands { first, line, .. })) = of_thousands.or(of_commas) {
            let column = excerpt(self.header.get(place).unwrap_or_default());
            table_notes.doubts.push(format!(
                "{}:{line}: the {sign} of `{first}` in the column `{column}` may be a thousands or a \
                 decimal separator; it is read as {number}: write the numbers without it, or set `decimal` \
                 in [csv]",
                self.path.display()
            ));
        }
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
        let thousands = self.thousands.get(place).and_then(Option::as_ref);
        let number = thousands.and_then(|_| number_of_thousands(typed, self.has_decimal_comma));
        let number = number.map(|(number, _)| number).or_else(|| number_of(typed, self.has_decimal_comma));
        number.filter(|number| number.is_finite()).ok_or_else(|| {
            let column = excerpt(self.header.get(place).unwrap_or_default());
            let has_comma = !self.has_decimal_comma && number_of(typed, true).is_some_and(f64::is_finite);
            let hint = if has_comma {
                "; if commas are decimal separators, write `decimal = \",\"` into [csv]"
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

/// The columns in which numbers have signs between thousands. A column that has the sign before other than three digits too has
/// fractions.
fn thousands_of(
    builder: &csv::ReaderBuilder,
    text: &[u8],
    has_decimal_comma: bool,
    delimiter: u8,
) -> Vec<Option<Thousands>> {
    let has = |letter: u8| text.contains(&letter);
    let may_have = if has_decimal_comma { has(b'.') } else { has(b',') && (delimiter != b',' || has(b'"')) };
    if !(may_have || has(b'\'') || text.windows(2).any(|pair| pair == "\u{a0}".as_bytes())) {
        return Vec::new();
    }
    let (mut found, mut others): (Vec<Option<Thousands>>, Vec<bool>) = (Vec::new(), Vec::new());
    let (decimal, other) = if has_decimal_comma { (',', '.') } else { ('.', ',') };
    let mut reader = builder.from_reader(text);
    for record in reader.records().map_while(Result::ok) {
        found.resize(found.len().max(record.len()), None);
        others.resize(found.len(), false);
        for (place, field) in record.iter().enumerate() {
            match number_of_thousands(field, has_decimal_comma) {
                Some((_, is_certain)) => {
                    let line = record.position().map_or(0, csv::Position::line);
                    let first = || Thousands { first: field.to_owned(), line, is_certain };
                    found[place].get_or_insert_with(first).is_certain |= is_certain;
                }
                None if field.contains(other) => others[place] = true,
                None => {}
            }
        }
        for (place, field) in record.iter().enumerate() {
            if let Some(known) = &mut found[place] {
                known.is_certain |= field.contains(decimal);
            }
        }
    }
    found.iter_mut().zip(others).filter(|(_, is_other)| *is_other).for_each(|(known, _)| *known = None);
    found
}

/// The columns whose numbers with a comma may all have it between thousands, in a table whose other columns have fractions with a
/// point: none where those have a comma too, or where one number tells that it begins a fraction.
fn commas_of(builder: &csv::ReaderBuilder, text: &[u8]) -> Vec<Option<Thousands>> {
    let (mut found, mut are_fractions): (Vec<Option<Thousands>>, Vec<bool>) = (Vec::new(), Vec::new());
    let mut have_points = false;
    let mut reader = builder.from_reader(text);
    for record in reader.records().map_while(Result::ok) {
        found.resize(found.len().max(record.len()), None);
        are_fractions.resize(found.len(), false);
        let line = record.position().map_or(0, csv::Position::line);
        for (place, field) in record.iter().enumerate() {
            have_points |= field.contains('.') && field.parse::<f64>().is_ok();
            if number_of_thousands(field, false).is_some() {
                let first = || Thousands { first: field.to_owned(), line, is_certain: false };
                found[place].get_or_insert_with(first);
            } else {
                are_fractions[place] |= field.contains(',');
            }
        }
    }
    for (known, is_fraction) in found.iter_mut().zip(&are_fractions) {
        if *is_fraction || !have_points || are_fractions.contains(&true) {
            *known = None;
        }
    }
    found
}

/// What is wrong with a line of more or fewer fields than the lines above it.
fn uneven(fields: u64, expected: u64) -> String {
    let why = if fields < expected {
        "a value is missing, or the line is cut"
    } else {
        "there is one value too many; if commas are decimal separators, use another column separator"
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
    /// What the numbers of each become by the units that the table states.
    factors: Vec<Vec<f64>>,
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
                None => sets.push(Self { heights, quantities: vec![(column, places)], factors: Vec::new() }),
            }
        }
        Ok(sets)
    }
}

impl Places {
    fn of(table: &Table, mapping: &Mapping) -> Result<Self, ImportError> {
        if mapping.rows.corners {
            return Err(table.error("a table has no cells: remove `corners` from [rows]".to_owned()));
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

/// Adds the rows of a table; `place` counts the files of a run. Returns what is told of it beside its rows.
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
) -> Result<TableNotes, ImportError> {
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
             --set-time-step if the name has a step number"
        )));
    }
    let mut table_notes = TableNotes { is_ended: table.is_ended, ..TableNotes::default() };
    let factors = Column::ALL.map(|column| match places.columns[column as usize] {
        Some(place) => {
            table.doubt(place, &mut table_notes);
            table.factor(column, place, mapping, &mut table_notes)
        }
        None => 1.0,
    });
    for set in &mut places.wide {
        for (column, of_heights) in &set.quantities {
            let factor = |place: &usize| {
                table.doubt(*place, &mut table_notes);
                table.factor(*column, *place, mapping, &mut table_notes)
            };
            set.factors.push(of_heights.iter().map(factor).collect());
        }
    }
    let before = rows.len();
    while table.next()? {
        if !places.counts(&table, mapping)? {
            continue;
        }
        let of_line = || -> Result<f64, ImportError> {
            let time = table.number(time_column.unwrap_or_default())?;
            let time = time * factors[Column::Time as usize];
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
            let number = places.columns[column as usize].map(|place| table.number(place)).transpose()?;
            Ok(number.map(|number| number * factors[column as usize]))
        })?;
        rows.push(row.sample(mapping, body, &|reason| table.error_in_line(reason))?);
    }
    if rows.len() == before {
        return Err(table.error("there are no rows".to_owned()));
    }
    table_notes.doubts.truncate(MOST_DOUBTS);
    Ok(table_notes)
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
                let quantities = set.quantities.iter().zip(&set.factors);
                let found = quantities.into_iter().find(|((known, _), _)| *known == column);
                found
                    .map(|((_, places), factors)| Ok(table.number(places[place])? * factors[place]))
                    .transpose()
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
    /// What is told of its file.
    pub table_notes: TableNotes,
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
        let mut table_notes = TableNotes { is_ended: table.is_ended, ..TableNotes::default() };
        let mut factor = |column: Column, place: usize| {
            table.doubt(place, &mut table_notes);
            table.factor(column, place, mapping, &mut table_notes)
        };
        let factors = [factor(Column::Time, time), factor(Column::Up, settlement)];
        let mut origins = Origins::of_curve(mapping);
        let part = origins.add(&file, &file, PartKind::Lines);
        let mut rows = Vec::new();
        while table.next()? {
            let seconds =
                mapping.units.time.seconds(table.number(time)? * factors[0], body.seconds_per_time_factor);
            if seconds < 0.0 {
                return Err(table.error_in_line("the time is negative".to_owned()));
            }
            rows.push(SampleRow {
                displacement: table.number(settlement)? * factors[1] * upward,
                ..SampleRow::at(seconds, body.height, table.origin(part))
            });
        }
        if rows.is_empty() {
            return Err(table.error("there are no rows".to_owned()));
        }
        let (points, contradictions) = points_of(&rows, &origins)?;
        Ok(Self { points, contradictions, file, table_notes })
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

/// Points of a curve as time (s) and displacement (m), and sentences on what of it contradicts itself.
type PointsAndContradictions = (Vec<(f64, f64)>, Vec<String>);

/// The times and displacements of a curve, and what of it contradicts itself.
fn points_of(rows: &[SampleRow], origins: &Origins) -> Result<PointsAndContradictions, ImportError> {
    let (states, mut contradictions) = states_of(rows, origins)?;
    let repeated = states.iter().filter_map(|state| {
        let values = state.repeated_at.as_ref()?;
        Some(format!("at t = {} s it has two values, at {values}: keep the right run", typed(state.time)))
    });
    contradictions.splice(0..0, repeated);
    Ok((states.iter().map(|state| (state.time, state.displacement[0])).collect(), contradictions))
}

/// A sentence about a table whose last line does not end.
pub fn not_ended(path: &Path) -> String {
    format!(
        "{} does not end with a line break, so it may be cut off inside its last number: end the last line with one",
        path.display()
    )
}
