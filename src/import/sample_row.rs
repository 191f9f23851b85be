//! One file's rows in SI, with the signs of this program.

use crate::import::import_error::ImportError;
use crate::import::mapping::Mapping;
use crate::import::units::{HorizontalSense, StatedPlace, StressSign, StressUnit, VerticalSense};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

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
    /// Columns of which nothing is declared: they tell rows apart.
    others: Vec<usize>,
}

impl Places {
    fn of(header: &csv::StringRecord, mapping: &Mapping, path: &Path) -> Result<Self, ImportError> {
        let place = |name: &String| header.iter().position(|column| column == name);
        let names = || header.iter().map(|column| format!("`{column}`")).collect::<Vec<_>>().join(", ");
        let find = |name: &String| {
            let none = || format!("there is no column `{name}`; the header has {}", names());
            place(name).ok_or_else(|| ImportError::table(path, none()))
        };
        let find_some = |name: &Option<String>| name.as_ref().map(&find).transpose();
        let columns = &mapping.columns;
        let distance = columns.x.as_ref().map(|name| match place(name) {
            None if mapping.is_convention => {
                let reason = format!(
                    "there is no column `x`, and a layer's fields depend on it: write the distance of each sample from \
                     the crest of the load, m, to a column `x`, or name another with --mapping; the header has {}",
                    names()
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
                Some(name) if mapping.is_convention => place(name),
                name => find_some(name)?,
            },
            volume: find_some(&columns.volume)?,
            others: Vec::new(),
        };
        places.others = (0..header.len()).filter(|place| !places.has(*place)).collect();
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

/// The rows of one file.
///
/// # Errors
/// What cannot be read or taken, with its line.
pub fn rows_of(path: &Path, mapping: &Mapping, frame: SolvedBody) -> Result<Vec<SampleRow>, ImportError> {
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
        return Err(ImportError::table(path, "there are no rows"));
    }
    Ok(rows)
}

/// The declared time of a file that holds one step.
fn time_of_file(path: &Path, mapping: &Mapping) -> Result<f64, ImportError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let time = mapping.time.files.get(&name).copied();
    let nowhere = || format!("its time is declared nowhere; add \"{name}\" = … to [time] files");
    time.ok_or_else(|| ImportError::table(path, nowhere()))
}

/// One line of a file.
struct RowReader<'a> {
    path: &'a Path,
    header: &'a csv::StringRecord,
    record: &'a csv::StringRecord,
}

impl RowReader<'_> {
    fn refused<T>(&self, reason: String) -> Result<T, ImportError> {
        let line = self.record.position().map_or(0, csv::Position::line);
        Err(ImportError::Row { path: self.path.to_owned(), line, reason })
    }

    fn number(&self, place: usize) -> Result<f64, ImportError> {
        let typed = self.record.get(place).unwrap_or_default();
        match typed.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let column = self.header.get(place).unwrap_or_default();
                self.refused(format!("`{typed}` in the column `{column}` is no finite number"))
            }
        }
    }

    fn not_negative(&self, number: f64, what: &str) -> Result<f64, ImportError> {
        if number < 0.0 {
            return self.refused(format!("{what} is negative"));
        }
        Ok(number)
    }

    /// The row in SI with the signs of this program.
    fn row(
        &self,
        places: &Places,
        mapping: &Mapping,
        frame: SolvedBody,
        time: f64,
    ) -> Result<SampleRow, ImportError> {
        let (units, sign) = (&mapping.units, &mapping.sign);
        let scaled = |place: Option<usize>, factor: f64| {
            place.map(|place| Ok(self.number(place)? * factor)).transpose()
        };
        let stress = units.stress.map_or(1.0, StressUnit::pascals);
        let length = units.displacement.unwrap_or(units.length).metres();
        let upward = |direction: Option<VerticalSense>| {
            if direction == Some(VerticalSense::Down) { -1.0 } else { 1.0 }
        };
        let compressive =
            |sign: Option<StressSign>| if sign == Some(StressSign::TensionPositive) { -1.0 } else { 1.0 };
        let rightward =
            |side: Option<HorizontalSense>| if side == Some(HorizontalSense::Left) { -1.0 } else { 1.0 };
        let displacement = scaled(places.displacement, length * upward(sign.u_y))?;
        let horizontal = scaled(places.horizontal_displacement, length * rightward(sign.u_x))?;
        let y = (self.number(places.height)? - mapping.origin.y) * units.length.metres();
        let height = match sign.y {
            VerticalSense::Up => y,
            VerticalSense::Down => frame.height - y,
        };
        let initial_height = match mapping.position.y {
            StatedPlace::Reference => height,
            StatedPlace::Current => height - displacement.unwrap_or(0.0),
        };
        if !(-RIM * frame.height..=(1.0 + RIM) * frame.height).contains(&initial_height) {
            return self.refused(format!(
                "the initial height {initial_height} m is outside the column of {} m: look at the unit and the sign of \
                 `y`, and at whose places they are",
                frame.height
            ));
        }
        let distance = match places.distance {
            Some(place) => {
                let x = (self.number(place)? - mapping.origin.x) * units.length.metres();
                Some(self.distance(x, mapping, frame, horizontal.unwrap_or(0.0))?)
            }
            None => None,
        };
        let volume = scaled(places.volume, 1.0)?.unwrap_or(1.0);
        Ok(SampleRow {
            time: self.not_negative(units.time.seconds(time, frame.seconds_per_time_factor), "the time")?,
            initial_distance: distance,
            initial_height: initial_height.clamp(0.0, frame.height),
            volume: self.not_negative(volume, "the volume")?,
            pressure: scaled(places.pressure, stress * compressive(sign.p))?,
            effective_stress: scaled(places.effective_stress, -stress * compressive(sign.effective_stress))?,
            displacement,
            horizontal_displacement: horizontal,
            others: self.others(places),
        })
    }

    /// Initial distance from the scene's `x = 0`, m; a column has no ends that it could miss.
    fn distance(
        &self,
        x: f64,
        mapping: &Mapping,
        frame: SolvedBody,
        displacement: f64,
    ) -> Result<f64, ImportError> {
        let length = frame.length.unwrap_or(0.0);
        let distance = match mapping.sign.x {
            Some(HorizontalSense::Left) => length - x,
            _ => x,
        };
        let initial = match mapping.position.y {
            StatedPlace::Reference => distance,
            StatedPlace::Current => distance - displacement,
        };
        if frame.length.is_some() && !(-RIM * length..=(1.0 + RIM) * length).contains(&initial) {
            return self.refused(format!(
                "the initial distance {initial} m from the crest is outside the layer of {length} m: look at the unit, \
                 the sign and the origin of `x`, and at whose places they are"
            ));
        }
        Ok(initial)
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
