//! Rows of a state in arrays: columns found among arrays and coordinates, rows chosen, displacements formed.

use crate::import::mapping::Mapping;
use crate::import::raw_row::{RawRow, SolvedBody, is_at};
use crate::import::rows::Rows;
use oedometer_formats::frame::{Array, Association, Frame};
use oedometer_formats::hints::program_of;
use oedometer_formats::import_error::ImportError;
use std::collections::{BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// The name under which the places of points, and the centres of cells, are columns.
const COORDINATES: &str = "coordinates";

/// A column as a mapping names it: `displacement[1]`, `cells:pressure`, one of several with `|`.
struct Spelling<'a> {
    on: Option<Association>,
    name: &'a str,
    component: Option<usize>,
}

fn spellings(typed: &str) -> Vec<Spelling<'_>> {
    let spelling = |typed: &str| -> (Option<Association>, usize, usize, Option<usize>) {
        let (on, start) = match typed.split_once(':') {
            Some(("points", _)) => (Some(Association::Points), 7),
            Some(("cells", _)) => (Some(Association::Cells), 6),
            _ => (None, 0),
        };
        let index = typed.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
        let index = index.and_then(|(name, index)| Some((name.len(), index.parse().ok()?)));
        match index {
            Some((end, component)) => (on, start, end, Some(component)),
            None => (on, start, typed.len(), None),
        }
    };
    let parted = typed.split('|').map(|one| {
        let (on, start, end, component) = spelling(one);
        Spelling { on, name: one.get(start..end).unwrap_or(one), component }
    });
    parted.collect()
}

/// Names of all arrays that a mapping may ask for.
pub fn wanted_names(mapping: &Mapping) -> BTreeSet<String> {
    let columns = &mapping.columns;
    let id = mapping.displacement.as_ref().and_then(|source| source.id.as_ref());
    let optional = [
        &columns.t,
        &columns.x,
        &columns.p,
        &columns.u_x,
        &columns.u_y,
        &columns.effective_stress,
        &columns.volume,
    ];
    let typed =
        optional.into_iter().flatten().chain([&columns.y]).chain(id).chain(mapping.rows.equals.keys());
    typed.flat_map(|typed| spellings(typed)).map(|one| one.name.to_owned()).collect()
}

/// Where the numbers of a column are.
#[derive(Clone, Copy)]
enum Source<'a> {
    Coordinates(usize),
    Array(&'a Array, usize),
}

/// Places of the points of a first state, by what names them.
pub struct Start {
    places: HashMap<u64, [f64; 2]>,
    /// File of that state, for messages.
    pub name: String,
}

/// A state with its file and mapping.
pub struct FrameReader<'a> {
    /// The state.
    pub frame: &'a Frame,
    /// Its file.
    pub path: &'a Path,
    /// What it means.
    pub mapping: &'a Mapping,
    /// What was solved.
    pub body: SolvedBody,
}

/// The columns of a state.
pub struct Columns<'a> {
    on: Association,
    y: Source<'a>,
    x: Option<Source<'a>>,
    pressure: Option<Source<'a>>,
    stress: Option<Source<'a>>,
    displacement: Option<Source<'a>>,
    horizontal: Option<Source<'a>>,
    volume: Option<Source<'a>>,
    equals: Vec<(Source<'a>, f64)>,
    id: Option<Source<'a>>,
    /// What was taken, and what was left out.
    pub notes: Vec<String>,
}

impl<'a> FrameReader<'a> {
    fn refused(&self, reason: String) -> ImportError {
        ImportError::table(self.path, reason)
    }

    /// Finds a column by the first of its spellings that is there.
    fn find(&self, typed: &str, on: Option<Association>) -> Result<Option<Source<'a>>, ImportError> {
        for one in spellings(typed) {
            let wanted = one.on.or(on);
            if one.name == COORDINATES && !self.frame.coordinates.is_empty() {
                let component = one.component.unwrap_or(1);
                if component > 2 {
                    return Err(self.refused(format!("`{typed}`: places have the components 0, 1 and 2")));
                }
                return Ok(Some(Source::Coordinates(component)));
            }
            let whole = self.frame.array(one.name, Some(Association::Whole));
            let Some(array) = self.frame.array(one.name, wanted).or(whole) else { continue };
            let component = match one.component {
                Some(component) if component < array.components => component,
                None if array.components == 1 => 0,
                _ => {
                    return Err(self.refused(format!(
                        "`{typed}`: the array `{}` has {} components; say which, from `{}[0]` to `{}[{}]`",
                        array.name,
                        array.components,
                        array.name,
                        array.name,
                        array.components - 1
                    )));
                }
            };
            return Ok(Some(Source::Array(array, component)));
        }
        Ok(None)
    }

    /// A column of the mapping, where it is named and there; one that only a preset names may be missing.
    fn column(
        &self,
        key: &str,
        typed: Option<&String>,
        on: Option<Association>,
        notes: &mut Vec<String>,
    ) -> Result<Option<Source<'a>>, ImportError> {
        let Some(typed) = typed else { return Ok(None) };
        if let Some(source) = self.find(typed, on)? {
            if let Source::Array(array, component) = source {
                let index = if array.components > 1 { format!("[{component}]") } else { String::new() };
                notes.push(format!("{key} = {}{index} on {}", array.name, array.on.name()));
            } else if let Source::Coordinates(component) = source {
                notes.push(format!("{key} = {COORDINATES}[{component}]"));
            }
            return Ok(Some(source));
        }
        if self.mapping.optional.iter().any(|optional| optional == key) {
            return Ok(None);
        }
        Err(self
            .refused(format!("there is no array `{typed}` for `{key}`; the file has {}", self.frame.names())))
    }

    /// The preset to take where another one is laid over files that look like a program's own; empty elsewhere.
    pub fn hint_of_program(&self) -> String {
        match program_of(self.frame) {
            Some(preset) if self.mapping.is_of_preset && self.mapping.preset != preset => {
                format!(": it looks like a file for `--preset {preset}`, which knows what its arrays mean")
            }
            _ => String::new(),
        }
    }

    /// All columns.
    ///
    /// # Errors
    /// When one that is needed is not there, or belongs to something else.
    pub fn columns(&self) -> Result<Columns<'a>, ImportError> {
        let names = &self.mapping.columns;
        let mut notes = Vec::new();
        let pressure = self.column("p", names.p.as_ref(), None, &mut notes)?;
        let on = match pressure {
            Some(Source::Array(array, _)) if array.on != Association::Whole => Some(array.on),
            _ => None,
        };
        let displacement = self.column("u_y", names.u_y.as_ref(), on, &mut notes)?;
        let on = match (on, displacement) {
            (Some(on), _) => Some(on),
            (None, Some(Source::Array(array, _))) => Some(array.on),
            _ => None,
        };
        let stress = self.column("effective_stress", names.effective_stress.as_ref(), on, &mut notes)?;
        if [pressure, displacement, stress].iter().all(Option::is_none) && self.mapping.displacement.is_none()
        {
            return Err(self.refused(format!(
                "there is nothing to score: no array of the mapping is there; the file has {}; name one with --mapping{}",
                self.frame.names(),
                self.hint_of_program()
            )));
        }
        let on = on.unwrap_or(Association::Points);
        let y = self.column("y", Some(&names.y), Some(on), &mut notes)?;
        let y = y.ok_or_else(|| {
            self.refused(format!("there is no height `{}`; the file has {}", names.y, self.frame.names()))
        })?;
        let mut equals = Vec::new();
        for (name, value) in &self.mapping.rows.equals {
            equals
                .extend(self.column(name, Some(name), Some(on), &mut notes)?.map(|source| (source, *value)));
        }
        let along = names.x.clone().or_else(|| self.mapping.rows.x.map(|_| "coordinates[0]".to_owned()));
        let id = self.mapping.displacement.as_ref().and_then(|source| source.id.as_ref());
        let some = Some(on);
        let mut columns = Columns {
            on,
            y,
            x: self.column("x", along.as_ref(), some, &mut notes)?,
            pressure,
            stress,
            displacement,
            horizontal: self.column("u_x", names.u_x.as_ref(), some, &mut notes)?,
            volume: self.column("volume", names.volume.as_ref(), some, &mut notes)?,
            equals,
            id: self.column("id", id, some, &mut notes)?,
            notes: Vec::new(),
        };
        columns.drop_strangers(self)?;
        if self.mapping.displacement.is_some() {
            notes.push("displacement = place less that of the first state".to_owned());
        }
        columns.notes = vec![format!("{}: {}", self.path.display(), notes.join(", "))];
        if self.mapping.rows.corners && self.frame.cells.is_none() {
            columns.notes.push(format!(
                "{}: it has no cells, so corners cannot be told from the middle of sides (an XDMF beside it has them)",
                self.path.display()
            ));
        }
        Ok(columns)
    }

    /// Rows that count: places in the arrays.
    fn chosen(&self, columns: &Columns) -> Result<Vec<usize>, ImportError> {
        let all = columns.count(self.frame);
        let mut is_chosen = vec![true; all];
        if self.mapping.rows.corners && columns.on == Association::Points {
            if let Some(cells) = &self.frame.cells {
                is_chosen = cells.are_corners(all);
            } else if !self.mapping.optional.is_empty() {
                // A preset asks for corners where there are cells.
            } else {
                return Err(self.refused("it has no cells: take `corners` out of [rows]".to_owned()));
            }
        }
        let mut chosen = Vec::new();
        for (row, is_chosen) in is_chosen.into_iter().enumerate() {
            let mut counts = is_chosen;
            for (source, value) in &columns.equals {
                counts &= columns.number(self.frame, *source, row) == *value;
            }
            if let (Some(asked), Some(along)) = (self.mapping.rows.x, columns.x) {
                counts &= is_at(columns.number(self.frame, along, row), asked);
            }
            if counts {
                chosen.push(row);
            }
        }
        if chosen.is_empty() {
            return Err(self.refused(format!("none of its {all} rows counts by [rows]")));
        }
        Ok(chosen)
    }

    /// Present places by what names them, as the start of displacements.
    ///
    /// # Errors
    /// When a column is missing.
    pub fn start(&self) -> Result<Start, ImportError> {
        let columns = self.columns()?;
        let name = |row: usize| match columns.id {
            Some(id) => columns.number(self.frame, id, row).to_bits(),
            None => row as u64,
        };
        let place = |row: usize| {
            let x = columns.x.map_or(0.0, |x| columns.number(self.frame, x, row));
            [x, columns.number(self.frame, columns.y, row)]
        };
        let places = (0..columns.count(self.frame)).map(|row| (name(row), place(row))).collect();
        Ok(Start { places, name: self.path.display().to_string() })
    }

    /// Adds the rows of the state at a time, s.
    ///
    /// # Errors
    /// What is missing, not finite or outside the body, with its file and row.
    pub fn take_rows(
        &self,
        columns: &Columns,
        time: f64,
        start: Option<&Start>,
        rows: &mut Rows,
    ) -> Result<(), ImportError> {
        let chosen = self.chosen(columns)?;
        rows.reserve(chosen.len());
        for row in chosen {
            let refused = |reason: String| self.refused(format!("{} {row}: {reason}", columns.kind_of_row()));
            let number = |source: Source, what: &str| {
                let number = columns.number(self.frame, source, row);
                if number.is_finite() { Ok(number) } else { Err(refused(format!("`{what}` is {number}"))) }
            };
            let some = |source: Option<Source>, what| source.map(|source| number(source, what)).transpose();
            let mut raw = RawRow {
                time,
                x: some(columns.x.filter(|_| self.mapping.columns.x.is_some()), "x")?,
                y: number(columns.y, "y")?,
                volume: some(columns.volume, "volume")?,
                pressure: some(columns.pressure, "p")?,
                stress: some(columns.stress, "effective_stress")?,
                displacement: some(columns.displacement, "u_y")?,
                horizontal_displacement: some(columns.horizontal, "u_x")?,
                moved: None,
                others: self.place_of(columns, row),
            };
            if let Some(start) = start {
                let name = some(columns.id, "id")?.map_or(row as u64, f64::to_bits);
                let first = start.places.get(&name).ok_or_else(|| {
                    refused(format!("it is not in the first state, {}; name its points by `id`", start.name))
                })?;
                raw.moved = Some([raw.x.unwrap_or(0.0) - first[0], raw.y - first[1]]);
                raw.x = raw.x.map(|_| first[0]);
                raw.y = first[1];
            }
            rows.push(&raw.sample(self.mapping, self.body, &refused)?);
        }
        Ok(())
    }

    /// What tells rows at one height apart: all of their place.
    fn place_of(&self, columns: &Columns, row: usize) -> u64 {
        let mut hasher = DefaultHasher::new();
        for component in 0..3 {
            let at = if self.frame.coordinates.is_empty() {
                match columns.y {
                    Source::Array(array, _) if component < array.components => {
                        columns.number(self.frame, Source::Array(array, component), row)
                    }
                    _ => 0.0,
                }
            } else {
                columns.number(self.frame, Source::Coordinates(component), row)
            };
            at.to_bits().hash(&mut hasher);
        }
        hasher.finish()
    }

    /// The time that an array states, in the unit of the mapping.
    ///
    /// # Errors
    /// When such an array is named and not there.
    pub fn time_of_array(&self) -> Result<Option<f64>, ImportError> {
        let mut notes = Vec::new();
        match self.column("t", self.mapping.columns.t.as_ref(), None, &mut notes)? {
            Some(Source::Array(array, component)) => Ok(array.values.get(component).copied()),
            _ => Ok(None),
        }
    }
}

impl Columns<'_> {
    /// What the rows lie on.
    pub const fn on(&self) -> Association {
        self.on
    }

    /// Names of the quantities that the state has, by the keys of a mapping.
    pub fn quantities(&self) -> Vec<&'static str> {
        let all = [
            ("p", self.pressure.is_some()),
            ("effective_stress", self.stress.is_some()),
            ("u_y", self.displacement.is_some()),
            ("u_x", self.horizontal.is_some()),
        ];
        all.into_iter().filter_map(|(name, is_there)| is_there.then_some(name)).collect()
    }

    const fn kind_of_row(&self) -> &'static str {
        if matches!(self.on, Association::Cells) { "cell" } else { "point" }
    }

    /// Leaves out what belongs to something else than the rows, where a preset named it.
    fn drop_strangers(&mut self, reader: &FrameReader) -> Result<(), ImportError> {
        let count = self.count(reader.frame);
        let is_stranger = |source: &Source| match source {
            Source::Array(array, _) => {
                array.on != Association::Whole && (array.on != self.on || array.tuples != count)
            }
            Source::Coordinates(_) => false,
        };
        let strange = [
            self.pressure,
            self.displacement,
            self.stress,
            self.x,
            self.horizontal,
            self.volume,
            self.id,
            Some(self.y),
        ];
        let equal = self.equals.iter().map(|(source, _)| *source);
        for source in strange.into_iter().flatten().chain(equal).filter(is_stranger) {
            if let Source::Array(array, _) = source {
                return Err(reader.refused(format!(
                    "`{}` has {} tuples on {}, and the rows are {count} {}: take both from one of them",
                    array.name,
                    array.tuples,
                    array.on.name(),
                    self.on.name()
                )));
            }
        }
        Ok(())
    }

    /// Rows before any is chosen.
    fn count(&self, frame: &Frame) -> usize {
        match (self.pressure.or(self.displacement), self.on) {
            (Some(Source::Array(array, _)), _) if array.on != Association::Whole => array.tuples,
            (_, Association::Cells) => frame.cells.as_ref().map_or(0, oedometer_formats::frame::Cells::count),
            _ if !frame.coordinates.is_empty() => frame.coordinates.len(),
            _ => match self.y {
                Source::Array(array, _) => array.tuples,
                Source::Coordinates(_) => 0,
            },
        }
    }

    fn number(&self, frame: &Frame, source: Source, row: usize) -> f64 {
        match source {
            Source::Array(array, component) => {
                let tuple = if array.on == Association::Whole { 0 } else { row };
                array.values.get(tuple * array.components + component).copied().unwrap_or(f64::NAN)
            }
            Source::Coordinates(component) => match (self.on, &frame.cells) {
                (Association::Cells, Some(cells)) if row < cells.count() => {
                    let corners = cells.corners(row);
                    let sum: f64 =
                        corners.iter().map(|point| frame.coordinates[*point as usize][component]).sum();
                    sum / corners.len() as f64
                }
                _ => frame.coordinates.get(row).map_or(f64::NAN, |place| place[component]),
            },
        }
    }
}

/// Cells over the height, where corners lie in rows of equal number: levels of corners less one.
pub fn cells_over_height(frame: &Frame, mapping: &Mapping, height: f64) -> Option<usize> {
    let cells = frame.cells.as_ref().filter(|cells| cells.dimension() > 0)?;
    let component = spellings(&mapping.columns.y)
        .iter()
        .find(|one| one.name == COORDINATES)
        .map_or(1, |one| one.component.unwrap_or(1).min(2));
    let is_corner = cells.are_corners(frame.coordinates.len());
    let corners = frame.coordinates.iter().zip(is_corner).filter(|(_, is_corner)| *is_corner);
    let mut levels: Vec<f64> = corners.map(|(place, _)| place[component]).collect();
    levels.sort_by(f64::total_cmp);
    let all = levels.len();
    let near = 1e-5 * height / mapping.units.length.metres();
    levels.dedup_by(|later, earlier| *later - *earlier <= near);
    (levels.len() > 1 && all.is_multiple_of(levels.len())).then(|| levels.len() - 1)
}
