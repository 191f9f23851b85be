//! Rows of a state in arrays: its columns (`finding`), which of its rows are samples, and their numbers.

mod finding;

use crate::import::mapping::{Column, DeclaredBy, Mapping};
use crate::import::origins::Origin;
use crate::import::raw_row::{RawRow, SolvedBody, is_at};
use crate::import::said_units::SaidUnit;
use crate::import::samples::{PlaceSet, SampleRow};
use crate::import::spelling::spellings;
use crate::solver::Preset;
use oedometer_formats::{Array, Association, Frame, ImportError};
use std::collections::{BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// Name of the places of points, and of the centres of cells, as a column.
const COORDINATES: &str = "coordinates";
/// Quantities, the one that chooses the places first.
const QUANTITIES: [Column; 4] = [Column::Pressure, Column::Up, Column::EffectiveStress, Column::Along];
/// Coordinates that differ by less than this share of the largest are equal.
const SAME_PLACE: f64 = 1e-9;

/// Names of arrays that number the points, as programs write them.
const IDS: [&str; 12] = [
    "id",
    "ids",
    "ID",
    "Id",
    "pid",
    "particle_id",
    "particleID",
    "point_id",
    "GlobalPointIds",
    "GlobalNodeIds",
    "GlobalIds",
    "tag",
];

/// Names of all arrays that a mapping may ask for.
pub fn wanted_names(mapping: &Mapping) -> BTreeSet<String> {
    let numbers = IDS.iter().filter(|_| mapping.displacement.is_some()).map(|name| (*name).to_owned());
    let columns = Column::ALL.into_iter().filter_map(|column| mapping.columns.get(column));
    let id = mapping.displacement.as_ref().and_then(|source| source.id.as_ref());
    let typed = columns.chain(id).chain(mapping.rows.equals.keys());
    typed.flat_map(|typed| spellings(typed)).map(|spelled| spelled.name.to_owned()).chain(numbers).collect()
}

/// Where the numbers of a column are.
#[derive(Clone, Copy)]
enum Source<'a> {
    Coordinates(usize),
    Array(&'a Array, usize),
}

/// Places of the points in the first state, by what identifies them.
pub struct Start {
    places: HashMap<u64, [f64; 2]>,
    file: String,
}

/// A state in arrays, with the columns that its mapping finds in it.
pub struct FrameRows<'a> {
    frame: &'a Frame,
    path: &'a Path,
    mapping: &'a Mapping,
    body: SolvedBody,
    /// What the rows lie on.
    pub on: Association,
    /// Rows before any are selected.
    count: usize,
    columns: [Option<Source<'a>>; Column::ALL.len()],
    /// Places along `x` that select rows.
    along: Option<Source<'a>>,
    equals: Vec<(Source<'a>, f64)>,
    id: Option<Source<'a>>,
    /// What the numbers of each column become by the units that the file states.
    factors: [f64; Column::ALL.len()],
    /// What the file and the mapping say in two ways.
    pub doubts: Vec<String>,
    /// Quantities that are on something else than the rows.
    elsewhere: Vec<Column>,
    /// Which places the rows are of.
    set: PlaceSet,
    /// Centres of the cells, where the rows lie on cells.
    centres: Vec<[f64; 3]>,
    /// Volumes of the cells, where the rows lie on cells and these differ.
    volumes: Vec<f64>,
    /// What each column was read from.
    pub notes: Vec<String>,
}

impl FrameRows<'_> {
    fn refused(&self, reason: String) -> ImportError {
        ImportError::content(self.path, reason)
    }

    /// A hint at the preset to take, if the file looks like another program's than that of the preset.
    pub fn hint_of_program(&self) -> String {
        match (Preset::of_frame(self.frame), self.mapping.declared_by) {
            (Some(found), DeclaredBy::Preset(taken)) if found.name != taken => format!(
                ": it looks like a file for `--preset {}`, which knows what its arrays mean",
                found.name
            ),
            _ => String::new(),
        }
    }

    /// Width of the body across its height, m: from the outermost nodes, or points with half a spacing beyond them.
    pub fn width(&self) -> Option<f64> {
        let across = |height: usize| usize::from(height == 0);
        let of_array = |array: &Array, component: usize| -> Vec<f64> {
            array.values.iter().skip(component).step_by(array.components).copied().collect()
        };
        let mut lines: Vec<f64> = match (self.columns[Column::Y as usize]?, self.along) {
            (Source::Coordinates(height), _) => {
                self.frame.coordinates.iter().map(|place| place[across(height)]).collect()
            }
            (Source::Array(array, height), _) if array.components > 1 => of_array(array, across(height)),
            (Source::Array(..), Some(Source::Array(array, component))) => of_array(array, component),
            _ => return None,
        };
        lines.sort_by(f64::total_cmp);
        let extent = lines.last()? - lines.first()?;
        lines.dedup_by(|place, before| *place - *before <= 1e-4 * extent);
        let has_nodes = self.frame.cells.as_ref().is_some_and(|cells| cells.dimension() > 0);
        let beyond = if has_nodes { 0.0 } else { extent / (lines.len() - 1).max(1) as f64 };
        (extent > 0.0).then_some((extent + beyond) * self.mapping.units.length.metres())
    }

    /// Columns that the state has.
    pub fn columns(&self) -> impl Iterator<Item = Column> {
        Column::ALL.into_iter().filter(|column| self.columns[*column as usize].is_some())
    }

    /// Checks that each column has one number per row, or one in all.
    fn check_lengths(&self) -> Result<(), ImportError> {
        let equals = self.equals.iter().map(|(source, _)| *source);
        for source in self.columns.into_iter().flatten().chain(self.along).chain(self.id).chain(equals) {
            let Source::Array(Array { name, on, tuples, .. }, _) = source else { continue };
            if *on != Association::Whole && (*on != self.on || *tuples != self.count) {
                return Err(self.refused(format!(
                    "`{name}` has {tuples} tuples on {}, and the rows are {} {}: take both from one of them",
                    on.name(),
                    self.count,
                    self.on.name()
                )));
            }
        }
        Ok(())
    }

    fn number(&self, source: Source, row: usize) -> f64 {
        match source {
            Source::Array(array, component) => {
                let tuple = if array.on == Association::Whole { 0 } else { row };
                array.values.get(tuple * array.components + component).copied().unwrap_or(f64::NAN)
            }
            Source::Coordinates(component) => {
                let places =
                    if self.on == Association::Cells { &self.centres } else { &self.frame.coordinates };
                places.get(row).map_or(f64::NAN, |place| place[component])
            }
        }
    }

    /// The rows that the mapping selects.
    fn selected(&self) -> Result<Vec<usize>, ImportError> {
        let rows = &self.mapping.rows;
        let is_preset = matches!(self.mapping.declared_by, DeclaredBy::Preset(_));
        let are_corners = match &self.frame.cells {
            Some(cells) if rows.corners && self.on == Association::Points => cells.are_corners(self.count),
            None if rows.corners && self.on == Association::Points && !is_preset => {
                return Err(self.refused("it has no cells: remove `corners` from [rows]".to_owned()));
            }
            // A preset asks for corners in case there are cells.
            _ => vec![true; self.count],
        };
        let is_sample = self.are_samples();
        let is_selected = |row: &usize| {
            are_corners[*row]
                && is_sample(*row)
                && !self.is_masked(*row)
                && self.equals.iter().all(|(source, value)| self.number(*source, *row) == *value)
                && rows.x.zip(self.along).is_none_or(|(x, along)| is_at(self.number(along, *row), x))
        };
        let selected: Vec<usize> = (0..self.count).filter(is_selected).collect();
        if selected.is_empty() {
            return Err(self.refused(format!("[rows] selects none of its {} rows", self.count)));
        }
        Ok(selected)
    }

    /// The number that stands for no value in the array of a source.
    fn fill_of(&self, source: Source) -> Option<f64> {
        let Source::Array(array, _) = source else { return None };
        self.frame.fills.get(&array.name).copied()
    }

    /// Whether the file has no value at a row, of any quantity: there is no sample.
    fn is_masked(&self, row: usize) -> bool {
        let mut quantities = QUANTITIES.iter().filter_map(|column| self.columns[*column as usize]).peekable();
        !self.frame.fills.is_empty()
            && quantities.peek().is_some()
            && quantities.all(|source| self.fill_of(source).is_some() && self.number(source, row).is_nan())
    }

    /// Whether a row is a sample: a point that no other piece owns and that a cell of the highest dimension has the value
    /// of, or such a cell; edges and faces beside cells are their borders.
    fn are_samples(&self) -> Box<dyn Fn(usize) -> bool + '_> {
        let Frame { cells, ghosts, .. } = self.frame;
        let Some(cells) = cells.as_ref().filter(|cells| cells.dimension() > 0) else {
            return Box::new(|row| !ghosts.get(row).copied().unwrap_or(false));
        };
        if self.on == Association::Cells {
            let highest = cells.dimension();
            return Box::new(move |row| cells.dimension_of(row) == highest);
        }
        let have_values = cells.have_values(self.frame.coordinates.len());
        Box::new(move |row| {
            have_values.get(row).copied().unwrap_or(true) && !ghosts.get(row).copied().unwrap_or(false)
        })
    }

    /// The present places, from which later displacements count.
    pub fn start(&self) -> Start {
        let of = |column: Column, row| {
            let number = self.columns[column as usize].map(|source| self.number(source, row));
            number.map(|number| number * self.factors[column as usize])
        };
        let place = |row| [of(Column::X, row).unwrap_or(0.0), of(Column::Y, row).unwrap_or(0.0)];
        let id = |row| self.id.map_or(row as u64, |id| self.number(id, row).to_bits());
        let places = (0..self.count).map(|row| (id(row), place(row))).collect();
        Start { places, file: self.path.display().to_string() }
    }

    /// Adds the rows of the state at a time, s; `origin` says where a row was read.
    ///
    /// # Errors
    /// What is missing, not finite or outside the body, with its file and row.
    pub fn take_rows(
        &self,
        time: f64,
        origin: &dyn Fn(usize) -> Origin,
        start: Option<&Start>,
        rows: &mut Vec<SampleRow>,
    ) -> Result<(), ImportError> {
        let selected = self.selected()?;
        rows.reserve(selected.len());
        let kind = if self.on == Association::Cells { "cell" } else { "point" };
        let largest = |most: f64, place: &[f64; 3]| place.iter().fold(most, |most, at| most.max(at.abs()));
        let step = SAME_PLACE * self.frame.coordinates.iter().fold(0.0, largest);
        for row in selected {
            let refused = |reason: String| self.refused(format!("{kind} {row}: {reason}"));
            let number = |source: Source, key: &str| {
                let number = self.number(source, row);
                match self.fill_of(source).filter(|_| number.is_nan()) {
                    Some(fill) => Err(refused(format!(
                        "`{key}` has no value: the file has {fill} there, which it says is none (`_FillValue` or \
                         `missing_value`)"
                    ))),
                    None if number.is_finite() => Ok(number),
                    None => Err(refused(format!("`{key}` is {number}"))),
                }
            };
            let mut raw = RawRow::read(time, self.hash_of_place(row, step), origin(row), |column| {
                let number =
                    self.columns[column as usize].map(|source| number(source, column.name())).transpose()?;
                Ok(number.map(|number| number * self.factors[column as usize]))
            })?;
            raw.set = self.set;
            if let Some(volume) = self.volumes.get(row) {
                raw.volume = Some(*volume);
            }
            if let Some(start) = start {
                let id = self.id.map_or(Ok(row as u64), |id| number(id, "id").map(f64::to_bits))?;
                let first = start.places.get(&id).ok_or_else(|| {
                    refused(format!("it is not in the first state, {}: name its points by `id`", start.file))
                })?;
                raw.moved = Some([raw.x.unwrap_or(0.0) - first[0], raw.y - first[1]]);
                raw.x = raw.x.map(|_| first[0]);
                raw.y = first[1];
            }
            rows.push(raw.sample(self.mapping, self.body, &refused)?);
        }
        Ok(())
    }

    /// What distinguishes rows at one height: their whole place, in steps of round-off.
    fn hash_of_place(&self, row: usize, step: f64) -> u64 {
        let mut hasher = DefaultHasher::new();
        for component in 0..3 {
            let at = match self.columns[Column::Y as usize] {
                _ if !self.frame.coordinates.is_empty() => self.number(Source::Coordinates(component), row),
                Some(Source::Array(array, _)) if component < array.components => {
                    self.number(Source::Array(array, component), row)
                }
                _ => 0.0,
            };
            let at = if step > 0.0 { (at / step).round() } else { at };
            (at + 0.0).to_bits().hash(&mut hasher);
        }
        hasher.finish()
    }

    /// The time in the array that the mapping names, in the unit of the mapping.
    ///
    /// # Errors
    /// When the user names such an array and it is missing.
    pub fn time_of_array(&self) -> Result<Option<f64>, ImportError> {
        let Some(Source::Array(array, component)) =
            self.source("t", self.mapping.columns.t.as_ref(), None, &mut Vec::new())?
        else {
            return Ok(None);
        };
        let factor = match said_unit(self.frame, &array.name, Column::Time, self.mapping) {
            SaidUnit::Factor(factor, _) => factor,
            SaidUnit::AsMapped | SaidUnit::Unfit(_) => 1.0,
        };
        let times = || array.values.iter().skip(component).step_by(array.components);
        let first = times().next().map(|time| time * factor);
        match times().find(|time| Some(**time * factor) != first) {
            Some(other) => Err(self.refused(format!(
                "`{}` has several times, {} and {other} among them, and a state has one: no array of the mapping has an \
                 axis of their number",
                array.name,
                first.unwrap_or(f64::NAN)
            ))),
            None => Ok(first),
        }
    }
}

/// What the unit means that a file states for an array that is a column: in an attribute, or in brackets behind its name, where
/// a word may be none.
pub fn said_unit(frame: &Frame, name: &str, column: Column, mapping: &Mapping) -> SaidUnit {
    if let Some(unit) = frame.units.get(name) {
        return SaidUnit::of(column, name, unit, mapping);
    }
    match SaidUnit::in_name(name).map(|unit| SaidUnit::of(column, name, unit, mapping)) {
        Some(said @ SaidUnit::Factor(..)) => said,
        _ => SaidUnit::AsMapped,
    }
}

/// Number of cells over the height: levels of corners less one, if all levels have equally many.
pub fn cells_over_height(frame: &Frame, mapping: &Mapping, height: f64) -> Option<usize> {
    let cells = frame.cells.as_ref().filter(|cells| cells.dimension() > 0)?;
    let component = spellings(&mapping.columns.y)
        .find(|one| one.name == COORDINATES)
        .map_or(1, |one| one.component.unwrap_or(1).min(2));
    let is_corner = cells.are_corners(frame.coordinates.len());
    let corners = frame.coordinates.iter().zip(is_corner).filter(|(_, is_corner)| *is_corner);
    let near = 1e-5 * height / mapping.units.length.metres();
    // Some programs repeat a corner for each of its cells.
    let rounded = |place: &[f64; 3]| {
        let mut across = *place;
        across[component] = 0.0;
        across.map(|at| ((at / near).round() + 0.0).to_bits())
    };
    let mut places: Vec<(f64, [u64; 3])> =
        corners.map(|(place, _)| (place[component], rounded(place))).collect();
    places.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.total_cmp(&b.0)));
    places.dedup_by(|later, earlier| later.1 == earlier.1 && later.0 - earlier.0 <= near);
    let mut levels: Vec<f64> = places.into_iter().map(|(level, _)| level).collect();
    levels.sort_by(f64::total_cmp);
    let all = levels.len();
    levels.dedup_by(|later, earlier| *later - *earlier <= near);
    (levels.len() > 1 && all.is_multiple_of(levels.len())).then(|| levels.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_formats::Cells;
    use oedometer_input::source::StudySource;

    #[test]
    fn cells_over_the_height_are_the_levels_of_corners_less_one() {
        let line = |levels: &[f64], types: u8, corners: usize| Frame {
            coordinates: levels.iter().flat_map(|y| [[0.0, *y, 0.0], [1.0, *y, 0.0]]).collect(),
            cells: Some(Cells {
                types: vec![types; levels.len() - 1],
                ends: (1..levels.len()).map(|cell| corners * cell).collect(),
                connectivity: (0..u32::try_from(levels.len()).expect("few") - 1)
                    .flat_map(|cell| [2 * cell, 2 * cell + 1, 2 * cell + 3, 2 * cell + 2])
                    .collect(),
            }),
            ..Frame::default()
        };
        let source = StudySource { name: "map.toml".to_owned(), text: String::new() };
        let mapping = Mapping::read(&source).expect("a mapping");
        let cells = |levels: &[f64]| cells_over_height(&line(levels, 9, 4), &mapping, 2.0);
        assert_eq!(cells(&[0.0, 0.5, 1.2, 2.0]), Some(3));
        assert_eq!(cells(&[0.0, 2.0]), Some(1));
        assert_eq!(cells_over_height(&Frame::default(), &mapping, 2.0), None);
        // Nodes of one level that differ by the last digit of a file in millimetres.
        let text = "units = { length = \"mm\" }".to_owned();
        let mapping = Mapping::read(&StudySource { name: "map.toml".to_owned(), text }).expect("a mapping");
        let mut frame = line(&[0.0, 500.0, 1200.0, 2000.0], 9, 4);
        frame.coordinates.iter_mut().step_by(2).for_each(|place| place[1] += 0.01);
        assert_eq!(cells_over_height(&frame, &mapping, 2.0), Some(3));
    }

    #[test]
    fn a_body_is_as_wide_as_its_nodes_or_as_its_points_with_half_a_spacing_beyond_them() {
        let source = StudySource {
            name: "map.toml".to_owned(),
            text: "[columns]\ny = \"coordinates[1]\"\np = \"p\"\nu_y = \"\"\n[units]\nlength = \"cm\"\n"
                .to_owned(),
        };
        let mapping = Mapping::read(&source).expect("a mapping");
        let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 1.0 };
        let width = |lines: &[f64]| {
            let places: Vec<[f64; 3]> =
                [25.0, 75.0].into_iter().flat_map(|y| lines.iter().map(move |x| [*x, y, 0.0])).collect();
            let values = vec![1.0; places.len()];
            let pressure = Array {
                name: "p".to_owned(),
                on: Association::Points,
                components: 1,
                tuples: values.len(),
                values,
                shape: Vec::new(),
            };
            let frame = Frame { coordinates: places, arrays: vec![pressure], ..Frame::default() };
            FrameRows::find(&frame, Path::new("f.vtu"), &mapping, body).expect("its columns").width()
        };
        let is = |found: Option<f64>, width: f64| found.is_some_and(|found| (found - width).abs() < 1e-12);
        assert!(is(width(&[10.0, 30.0, 50.0]), 0.6), "{:?}", width(&[10.0, 30.0, 50.0]));
        assert!(is(width(&[10.0, 30.0]), 0.4), "{:?}", width(&[10.0, 30.0]));
        assert_eq!(width(&[10.0]), None);
    }

    #[test]
    fn the_width_shows_in_places_that_are_an_array_of_the_points() {
        let array = |name: &str, components: usize, values: &[f64]| Array {
            name: name.to_owned(),
            on: Association::Points,
            components,
            tuples: values.len() / components,
            values: values.to_vec(),
            shape: Vec::new(),
        };
        let arrays = vec![
            array("position", 2, &[0.1, 0.5, 0.3, 0.5, 0.1, 1.5, 0.3, 1.5]),
            array("x", 1, &[0.1, 0.3, 0.1, 0.3]),
            array("y", 1, &[0.5, 0.5, 1.5, 1.5]),
            array("p", 1, &[4.0, 3.0, 2.0, 1.0]),
        ];
        let frame = Frame { arrays, ..Frame::default() };
        let body = SolvedBody { height: 2.0, length: None, seconds_per_time_factor: 1.0 };
        for (places, width) in [
            ("y = 'position[1]'", Some(0.4)),
            ("y = 'position[0]'", Some(2.0)),
            ("x = 'x', y = 'y'", Some(0.4)),
            ("y = 'y'", None),
        ] {
            let text = format!("columns = {{ {places}, p = 'p', u_y = '' }}");
            let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
            let rows = FrameRows::find(&frame, Path::new("f.npz"), &mapping, body).expect("its columns");
            let found = rows.width().map(|width| (1e9 * width).round() / 1e9);
            assert_eq!(found, width, "{places}");
        }
    }

    #[test]
    fn a_number_of_the_whole_state_is_that_of_every_row() {
        let text = "[columns]\ny = \"y\"\np = \"p\"\nu_y = \"\"\nvolume = \"v\"\n".to_owned();
        let source = StudySource { name: "map.toml".to_owned(), text };
        let mapping = Mapping::read(&source).expect("a mapping");
        let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 1.0 };
        let array = |name: &str, on: Association, values: &[f64]| Array {
            name: name.to_owned(),
            on,
            components: 1,
            tuples: values.len(),
            values: values.to_vec(),
            shape: Vec::new(),
        };
        let arrays = vec![
            array("y", Association::Points, &[0.25, 0.75]),
            array("p", Association::Points, &[3.0, 5.0]),
            array("v", Association::Whole, &[0.5]),
        ];
        let frame = Frame { arrays, ..Frame::default() };
        let found = FrameRows::find(&frame, Path::new("f.npz"), &mapping, body).expect("its columns");
        let mut rows = Vec::new();
        found.take_rows(1.0, &|_| Origin::default(), None, &mut rows).expect("two rows");
        let told: Vec<[f64; 3]> =
            rows.iter().map(|row| [row.initial_height, row.pressure, row.volume]).collect();
        assert_eq!(told, [[0.25, 3.0, 0.5], [0.75, 5.0, 0.5]]);
    }

    fn array(name: &str, on: Association, components: usize, values: &[f64]) -> Array {
        let tuples = values.len() / components;
        Array { name: name.to_owned(), on, components, tuples, values: values.to_vec(), shape: Vec::new() }
    }

    /// Two squares on each other: six nodes, two cells, and arrays on both.
    fn squares() -> Frame {
        let coordinates = [0.0, 1.0, 2.0].into_iter().flat_map(|y| [[0.0, y, 5.0], [3.0, y, 7.0]]).collect();
        let cells = Cells { types: vec![9, 9], ends: vec![4, 8], connectivity: vec![0, 1, 3, 2, 2, 3, 5, 4] };
        let arrays = vec![
            array("p", Association::Points, 1, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            array("p", Association::Cells, 1, &[10.0, 20.0]),
            array("u", Association::Points, 2, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2]),
            array("m", Association::Cells, 1, &[7.0, 8.0]),
            array("WATER_PRESSURE", Association::Whole, 1, &[9.0]),
        ];
        Frame { coordinates, cells: Some(cells), arrays, ..Frame::default() }
    }

    #[test]
    fn columns_are_found_by_their_place_component_or_alternative_and_the_first_quantity_chooses_the_rows() {
        let body = SolvedBody { height: 2.0, length: None, seconds_per_time_factor: 1.0 };
        let frame = squares();
        let found = |columns: &str| {
            let text = format!("columns = {{ {columns} }}");
            let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
            let rows = FrameRows::find(&frame, Path::new("f.vtu"), &mapping, body)
                .map_err(|error| error.to_string())?;
            let mut all = Vec::new();
            rows.take_rows(1.0, &|_| Origin::default(), None, &mut all).map_err(|error| error.to_string())?;
            let [pressure, up, height] = [
                all.iter().map(|row| row.pressure).sum::<f64>(),
                all.iter().map(|row| row.displacement).sum::<f64>(),
                all.iter().map(|row| row.initial_height).sum::<f64>(),
            ];
            let round = |value: f64| if value.is_nan() { -1.0 } else { (1e6 * value).round() / 1e6 };
            Ok((rows.notes.join(" / "), [pressure, up, height].map(round), rows.width()))
        };
        let there = "the file has `p` on points, `p` on cells, `u` on points, `m` on cells, `WATER_PRESSURE` on the whole";
        let there = there.replace("the whole", Association::Whole.name());
        let y = "y = 'coordinates[1]'";
        for (columns, notes, sums) in [
            (
                format!("{y}, p = 'p', u_y = 'u[1]'"),
                "p = p on points, u_y = u[1] on points, y = coordinates[1]",
                [21.0, 4.2, 6.0],
            ),
            (
                format!("{y}, p = 'cells:p', u_y = ''"),
                "p = p on cells, y = coordinates[1]",
                [30.0, -1.0, 2.0],
            ),
            (
                format!("{y}, p = 'none|m|p', u_y = ''"),
                "p = m on cells, y = coordinates[1]",
                [15.0, -1.0, 2.0],
            ),
            (
                format!("{y}, p = 'points:m|p[0]', u_y = ''"),
                "p = p on points, y = coordinates[1]",
                [21.0, -1.0, 6.0],
            ),
            (
                "y = 'coordinates', p = '', u_y = 'u[0]'".to_owned(),
                "u_y = u[0] on points, y = coordinates[1]",
                [-1.0, 3.6, 6.0],
            ),
        ] {
            let told = found(&columns).unwrap_or_else(|told| panic!("{columns}: {told}"));
            assert_eq!(told, (format!("f.vtu: {notes}"), sums, Some(3.0)), "{columns}");
        }
        for (columns, told) in [
            (
                format!("{y}, p = 'u', u_y = ''"),
                "`u`: the array `u` has 2 components: choose one, from `u[0]` to `u[1]`".to_owned(),
            ),
            (
                format!("{y}, p = 'u[2]', u_y = ''"),
                "`u[2]`: the array `u` has 2 components: choose one, from `u[0]` to `u[1]`".to_owned(),
            ),
            (
                "y = 'coordinates[3]', p = 'p', u_y = ''".to_owned(),
                "`coordinates[3]`: places have the components 0, 1 and 2".to_owned(),
            ),
            (format!("{y}, p = 'q', u_y = ''"), format!("there is no array `q` for `p`; {there}")),
            (format!("{y}, p = 'p', u_y = 'n'"), format!("there is no array `n` for `u_y`; {there}")),
            (
                "y = 'coordy', p = 'p', u_y = ''".to_owned(),
                format!(
                    "there is no array `coordy` for `y`; {there}; its places are `coordinates[0]`, `[1]` and `[2]`"
                ),
            ),
            (
                format!("{y}, p = 'p', u_y = '', volume = 'cells:m'"),
                "`m` has 2 tuples on cells, and the rows are 6 points: take both from one of them".to_owned(),
            ),
        ] {
            assert_eq!(found(&columns), Err(format!("f.vtu: {told}")), "{columns}");
        }
    }

    #[test]
    fn a_time_that_is_named_wrongly_need_not_be_named_where_the_file_has_it() {
        let body = SolvedBody { height: 2.0, length: None, seconds_per_time_factor: 1.0 };
        let text = "columns = { y = 'coordinates[1]', t = 'time_whole', p = 'p', u_y = '' }".to_owned();
        let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
        for (time, is_told) in [(None, false), (Some(3.0), true)] {
            let frame = Frame { time, ..squares() };
            let rows = FrameRows::find(&frame, Path::new("f.vtu"), &mapping, body).expect("columns");
            let why = rows.time_of_array().expect_err("no such array").to_string();
            assert_eq!(why.ends_with("leave `t` out"), is_told, "{why}");
        }
    }

    #[test]
    fn quantities_on_cells_stand_beside_those_at_nodes_and_weigh_by_volume() {
        let body = SolvedBody { height: 2.0, length: None, seconds_per_time_factor: 1.0 };
        let found = |frame: &Frame, columns: &str, more: &str| -> Result<[Vec<[f64; 3]>; 2], String> {
            let text = format!("{more}\ncolumns = {{ y = 'coordinates[1]', {columns} }}");
            let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
            let rows = FrameRows::find(frame, Path::new("f.vtu"), &mapping, body)
                .map_err(|error| error.to_string())?;
            let beside = rows.beside().map_err(|error| error.to_string())?;
            let taken = |rows: Option<&FrameRows>| {
                let mut all = Vec::new();
                rows.map_or(Ok(()), |rows| rows.take_rows(1.0, &|_| Origin::default(), None, &mut all))
                    .expect("rows");
                let value = |row: &SampleRow| [row.pressure, row.displacement, row.effective_stress];
                let value = |row: &SampleRow| value(row).into_iter().find(|value| !value.is_nan());
                all.iter().map(|row| [row.initial_height, value(row).expect("a value"), row.volume]).collect()
            };
            Ok([taken(Some(&rows)), taken(beside.as_ref())])
        };
        let mut frame = squares();
        let [nodes, cells] =
            found(&frame, "p = 'points:p', u_y = '', effective_stress = 'm'", "").expect("both");
        assert_eq!((nodes.len(), &cells[..]), (6, &[[0.5, -7.0, 1.0], [1.5, -8.0, 1.0]][..]));
        let [cells, nodes] = found(&frame, "p = 'cells:p', u_y = 'u[1]'", "").expect("both");
        assert_eq!((cells.len(), nodes.len()), (2, 6));
        // A graded mesh, with an edge and a point of no cell among its cells.
        for place in &mut frame.coordinates[2..4] {
            place[1] = 0.5;
        }
        frame.coordinates.push([9.0, 9.0, 9.0]);
        let cells = frame.cells.as_mut().expect("cells");
        (cells.types, cells.ends) = (vec![9, 9, 3], vec![4, 8, 10]);
        cells.connectivity.extend([0, 1]);
        frame.arrays = vec![
            array("p", Association::Points, 1, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 99.0]),
            array("m", Association::Cells, 1, &[7.0, 8.0, 99.0]),
        ];
        let [nodes, cells] = found(&frame, "p = 'p', u_y = '', effective_stress = 'm'", "").expect("both");
        assert_eq!((nodes.len(), cells.len()), (6, 2), "neither the edge nor the loose point");
        let volumes: Vec<f64> = cells.iter().map(|row| row[2]).collect();
        assert!((volumes[1] / volumes[0] - 3.0).abs() < 0.1, "{volumes:?}");
        for (columns, more, told) in [
            (
                "p = 'p', u_y = '', effective_stress = 'm'",
                "stress.is = 'total'",
                "needs the pressure at its place",
            ),
            ("p = 'm', u_y = 'p'", "position.y = 'current'", "needs the displacement there"),
            ("p = 'p', u_y = 'm'", "position.y = 'current'", "needs the displacement there"),
        ] {
            let refused = found(&frame, columns, more);
            assert!(refused.is_err_and(|why| why.contains(told)), "{columns}");
        }
    }

    #[test]
    fn the_body_lies_along_the_axis_that_the_height_has_and_its_cells_are_counted_there() {
        let frame = squares();
        let body = SolvedBody { height: 3.0, length: None, seconds_per_time_factor: 1.0 };
        for (y, width, cells) in [
            ("coordinates[0]", Some(2.0), Some(1)),
            ("coordinates[1]", Some(3.0), Some(2)),
            ("coordinates[2]", Some(3.0), Some(1)),
            ("y|coordinates[0]", Some(2.0), Some(1)),
        ] {
            let text = format!("columns = {{ y = '{y}', p = 'p', u_y = '' }}");
            let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
            let rows = FrameRows::find(&frame, Path::new("f.vtu"), &mapping, body).expect("its columns");
            assert_eq!((rows.width(), cells_over_height(&frame, &mapping, 3.0)), (width, cells), "{y}");
        }
    }
}
