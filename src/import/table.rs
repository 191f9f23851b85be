//! From the rows of files to states of a column in SI, with the signs of this program.

use super::mapping::{Configuration, Direction, Mapping, StressSign};
use std::path::{Path, PathBuf};

/// Rows closer than this share of their time are of one time.
const SAME_TIME: f64 = 1e-9;
/// Share of the height by which a place may lie outside: round-off of a written number.
const RIM: f64 = 1e-6;

/// Samples of a column at one time: SI, heights from the base, pressure compression positive,
/// stress tension positive, displacement upward positive. A quantity that is no column is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledState {
    /// Time, s.
    pub time: f64,
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
}

/// Why a result cannot be taken.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file cannot be read.
    #[error("cannot read {path}: {source}")]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A row cannot be parsed.
    #[error("{path}: {source}")]
    Csv {
        /// Which file.
        path: PathBuf,
        /// Why, with the line.
        source: csv::Error,
    },
    /// A column is missing.
    #[error("{path}: there is no column `{name}`; the header has {header}")]
    NoColumn {
        /// Which file.
        path: PathBuf,
        /// Name of the column.
        name: String,
        /// The header.
        header: String,
    },
    /// A file's time is declared nowhere.
    #[error("{path}: its time is declared nowhere; add \"{name}\" = … to [time] files")]
    NoTime {
        /// Which file.
        path: PathBuf,
        /// Its name.
        name: String,
    },
    /// A field is no finite number.
    #[error("{path}:{line}: `{typed}` in the column `{column}` is no finite number")]
    NoNumber {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column.
        column: String,
        /// What stands there.
        typed: String,
    },
    /// A place is outside the column.
    #[error(
        "{path}:{line}: the initial height {height} m is outside the column of {column} m: look at the unit and the \
         sign of `y`, and at whose places they are"
    )]
    Outside {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Height, m.
        height: f64,
        /// Height of the column, m.
        column: f64,
    },
    /// A weight or a time is negative.
    #[error("{path}:{line}: {what} is negative")]
    Negative {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What.
        what: &'static str,
    },
    /// There are no rows.
    #[error("{path}: there are no rows")]
    Empty {
        /// Which file.
        path: PathBuf,
    },
}

/// What the column that was solved is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Height, m.
    pub height: f64,
    /// Seconds at which `T_v = 1`.
    pub seconds_per_time_factor: f64,
}

/// One row in SI.
struct Row {
    time: f64,
    initial_height: f64,
    volume: f64,
    pressure: Option<f64>,
    effective_stress: Option<f64>,
    displacement: Option<f64>,
}

/// States of all rows of the files of one run, by time.
///
/// # Errors
/// What cannot be read or taken, with file and line.
pub fn states_of(
    paths: &[PathBuf],
    mapping: &Mapping,
    height: f64,
    seconds_per_time_factor: f64,
) -> Result<Vec<SampledState>, ImportError> {
    let frame = Frame { height, seconds_per_time_factor };
    let mut rows = Vec::new();
    for path in paths {
        rows.extend(rows_of(path, mapping, frame)?);
    }
    rows.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.initial_height.total_cmp(&b.initial_height)));
    let mut states: Vec<SampledState> = Vec::new();
    for row in rows {
        let is_new = states.last().is_none_or(|state| row.time - state.time > SAME_TIME * row.time);
        if is_new {
            states.push(SampledState { time: row.time, ..SampledState::default() });
        }
        if let Some(state) = states.last_mut() {
            state.initial_height.push(row.initial_height);
            state.volume.push(row.volume);
            state.pressure.extend(row.pressure);
            state.effective_stress.extend(row.effective_stress);
            state.displacement.extend(row.displacement);
        }
    }
    Ok(states)
}

/// Places of the columns in a file's header.
struct Places {
    time: Option<usize>,
    height: usize,
    pressure: Option<usize>,
    displacement: Option<usize>,
    effective_stress: Option<usize>,
    volume: Option<usize>,
}

impl Places {
    fn of(header: &csv::StringRecord, mapping: &Mapping, path: &Path) -> Result<Self, ImportError> {
        let find = |name: &String| {
            header.iter().position(|column| column == name).ok_or_else(|| ImportError::NoColumn {
                path: path.to_owned(),
                name: name.clone(),
                header: header.iter().map(|column| format!("`{column}`")).collect::<Vec<_>>().join(", "),
            })
        };
        let find_some = |name: &Option<String>| name.as_ref().map(&find).transpose();
        let columns = &mapping.columns;
        Ok(Self {
            time: find_some(&columns.t)?,
            height: find(&columns.y)?,
            pressure: find_some(&columns.p)?,
            displacement: find_some(&columns.u_y)?,
            effective_stress: find_some(&columns.effective_stress)?,
            volume: find_some(&columns.volume)?,
        })
    }
}

fn rows_of(path: &Path, mapping: &Mapping, frame: Frame) -> Result<Vec<Row>, ImportError> {
    let file =
        std::fs::File::open(path).map_err(|source| ImportError::Io { path: path.to_owned(), source })?;
    let as_byte = |mark: char| u8::try_from(mark).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(as_byte(mapping.csv.delimiter))
        .comment(mapping.csv.comment.map(as_byte))
        .trim(csv::Trim::All)
        .from_reader(file);
    let wrong = |source: csv::Error| ImportError::Csv { path: path.to_owned(), source };
    let header = reader.headers().map_err(wrong)?.clone();
    let places = Places::of(&header, mapping, path)?;
    let time_of_file = match places.time {
        Some(_) => None,
        None => Some(time_of_file(path, mapping)?),
    };
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(wrong)?;
        let line = RowReader { path, header: &header, record: &record };
        let time = match time_of_file {
            Some(time) => time,
            None => line.number(places.time.unwrap_or_default())?,
        };
        rows.push(line.row(&places, mapping, frame, time)?);
    }
    if rows.is_empty() {
        return Err(ImportError::Empty { path: path.to_owned() });
    }
    Ok(rows)
}

/// The declared time of a file that holds one step.
fn time_of_file(path: &Path, mapping: &Mapping) -> Result<f64, ImportError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let time = mapping.time.files.get(&name).copied();
    time.ok_or_else(|| ImportError::NoTime { path: path.to_owned(), name })
}

/// One line of a file.
struct RowReader<'a> {
    path: &'a Path,
    header: &'a csv::StringRecord,
    record: &'a csv::StringRecord,
}

impl RowReader<'_> {
    fn line(&self) -> u64 {
        self.record.position().map_or(0, csv::Position::line)
    }

    fn number(&self, place: usize) -> Result<f64, ImportError> {
        let typed = self.record.get(place).unwrap_or_default();
        match typed.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(ImportError::NoNumber {
                path: self.path.to_owned(),
                line: self.line(),
                column: self.header.get(place).unwrap_or_default().to_owned(),
                typed: typed.to_owned(),
            }),
        }
    }

    fn not_negative(&self, number: f64, what: &'static str) -> Result<f64, ImportError> {
        if number < 0.0 {
            return Err(ImportError::Negative { path: self.path.to_owned(), line: self.line(), what });
        }
        Ok(number)
    }

    /// The row in SI with the signs of this program.
    fn row(&self, places: &Places, mapping: &Mapping, frame: Frame, time: f64) -> Result<Row, ImportError> {
        let (units, sign) = (&mapping.units, &mapping.sign);
        let scaled = |place: Option<usize>, factor: f64| {
            place.map(|place| Ok(self.number(place)? * factor)).transpose()
        };
        let stress = units.stress.map_or(1.0, super::mapping::StressUnit::pascals);
        let length = units.displacement.unwrap_or(units.length).metres();
        let upward =
            |direction: Option<Direction>| if direction == Some(Direction::Down) { -1.0 } else { 1.0 };
        let compressive =
            |sign: Option<StressSign>| if sign == Some(StressSign::TensionPositive) { -1.0 } else { 1.0 };
        let displacement = scaled(places.displacement, length * upward(sign.u_y))?;
        let y = self.number(places.height)? * units.length.metres();
        let height = match sign.y {
            Direction::Up => y,
            Direction::Down => frame.height - y,
        };
        let initial_height = match mapping.position.y {
            Configuration::Reference => height,
            Configuration::Current => height - displacement.unwrap_or(0.0),
        };
        if !(-RIM * frame.height..=(1.0 + RIM) * frame.height).contains(&initial_height) {
            return Err(ImportError::Outside {
                path: self.path.to_owned(),
                line: self.line(),
                height: initial_height,
                column: frame.height,
            });
        }
        let volume = scaled(places.volume, 1.0)?.unwrap_or(1.0);
        Ok(Row {
            time: self.not_negative(units.time.seconds(time, frame.seconds_per_time_factor), "the time")?,
            initial_height: initial_height.clamp(0.0, frame.height),
            volume: self.not_negative(volume, "the volume")?,
            pressure: scaled(places.pressure, stress * compressive(sign.p))?,
            effective_stress: scaled(places.effective_stress, -stress * compressive(sign.effective_stress))?,
            displacement,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::StudySource;

    const STRANGE: &str = r#"
[columns]
t = "day"
y = "depth"
p = "pwp"
u_y = "settled"
effective_stress = "sig"
[units]
time = "d"
length = "cm"
displacement = "mm"
stress = "kPa"
[sign]
y = "down"
p = "tension-positive"
u_y = "down"
effective_stress = "compression-positive"
[position]
y = "current"
[csv]
delimiter = ";"
"#;

    fn states(mapping: &str, text: &str) -> Result<Vec<SampledState>, String> {
        let source = StudySource { name: "map.toml".to_owned(), text: mapping.to_owned() };
        let mapping = Mapping::read(&source).expect("a mapping");
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("result.csv");
        std::fs::write(&path, text).expect("a file");
        states_of(&[path], &mapping, 1.0, 81.75).map_err(|error| error.to_string())
    }

    #[test]
    fn units_and_signs_become_those_of_this_program() {
        let text = "# by a stranger\nday; depth; pwp; settled; sig\n1; 25; -3; 2; 4\n0.5; 50; -5; 1; 0\n";
        let states = states(STRANGE, text).expect("rows");
        assert_eq!(states.len(), 2, "by time");
        assert_eq!(states[0].time, 43_200.0);
        let later = &states[1];
        assert_eq!((later.pressure[0], later.effective_stress[0]), (3e3, -4e3));
        assert_eq!(later.displacement[0], -2e-3);
        assert!((later.initial_height[0] - 0.752).abs() < 1e-15, "a point at 0.75 m has sunk by 2 mm");
    }

    #[test]
    fn what_is_no_number_or_outside_is_told_with_its_line() {
        for (row, told) in [
            ("1; 25; NaN; 2; 4", "result.csv:2: `NaN` in the column `pwp`"),
            ("1; 25; ; 2; 4", "result.csv:2: `` in the column `pwp`"),
            ("-1; 25; 3; 2; 4", "the time is negative"),
            ("1; 250; 3; 2; 4", "outside the column of 1 m"),
            ("1; 25; 3", "result.csv"),
        ] {
            let error = states(STRANGE, &format!("day; depth; pwp; settled; sig\n{row}\n")).expect_err(row);
            assert!(error.contains(told), "{row}: {error}");
        }
        let error = states(STRANGE, "day; depth; pwp; settled\n").expect_err("a column is missing");
        assert!(error.contains("no column `sig`; the header has `day`, `depth`"), "{error}");
        let error = states(STRANGE, "day; depth; pwp; settled; sig\n").expect_err("no rows");
        assert!(error.contains("there are no rows"), "{error}");
    }
}
