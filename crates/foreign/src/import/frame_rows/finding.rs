//! Finds the columns of a state among its arrays and coordinates, on the points or the cells that the first quantity is on.

use super::{COORDINATES, FrameRows, IDS, QUANTITIES, Source, said_unit};
use crate::import::mapping::units::{StatedPlace, StressKind};
use crate::import::mapping::{Column, Mapping};
use crate::import::raw_row::SolvedBody;
use crate::import::said_units::SaidUnit;
use crate::import::samples::PlaceSet;
use crate::import::spelling::spellings;
use oedometer_case::quantity::Sample;
use oedometer_formats::{Array, Association, Cells, Frame, ImportError, linked};
use std::path::Path;

/// Volumes that differ by less than this share are equal.
const SAME_VOLUME: f64 = 1e-9;
/// Cells whose volumes differ by less than this share are even: round-off of single precision.
const EVEN: f64 = 1e-3;

impl<'a> FrameRows<'a> {
    /// Finds the columns of a state. The first quantity decides what the rows lie on; others may be elsewhere.
    ///
    /// # Errors
    /// When a column is missing that must be there, or belongs to something else than the rows.
    pub fn find(
        frame: &'a Frame,
        path: &'a Path,
        mapping: &'a Mapping,
        body: SolvedBody,
    ) -> Result<Self, ImportError> {
        Self::of_places(frame, path, mapping, body, &QUANTITIES, None)
    }

    /// The rows of the quantities that lie on something else: stresses in cells beside pressures at nodes.
    ///
    /// # Errors
    /// Those of [`find`](Self::find), and where a quantity is needed there that is not.
    pub fn beside(&self) -> Result<Option<Self>, ImportError> {
        if self.elsewhere.is_empty() {
            return Ok(None);
        }
        let on = if self.on == Association::Cells { Association::Points } else { Association::Cells };
        let Self { frame, path, mapping, body, .. } = *self;
        let mut rows = Self::of_places(frame, path, mapping, body, &self.elsewhere, Some(on))?;
        let has = |column: Column| self.elsewhere.contains(&column);
        let refused = |what: &str| {
            self.refused(format!(
                "{what}, but the file has it only on {}: leave one of them out",
                self.on.name()
            ))
        };
        if mapping.stress.is == StressKind::Total && has(Column::EffectiveStress) != has(Column::Pressure) {
            return Err(refused("a total stress needs the pressure at its place to become effective"));
        }
        if mapping.position.y == StatedPlace::Current {
            return Err(refused("a current place needs the displacement there to become the initial one"));
        }
        rows.set = (1, Some(if on == Association::Cells { Sample::Centres } else { Sample::Nodes }));
        Ok(Some(rows))
    }

    /// Finds the columns of some quantities, on what is asked for or on what the first of them is on.
    fn of_places(
        frame: &'a Frame,
        path: &'a Path,
        mapping: &'a Mapping,
        body: SolvedBody,
        quantities: &[Column],
        mut on: Option<Association>,
    ) -> Result<Self, ImportError> {
        let mut rows = Self {
            frame,
            path,
            mapping,
            body,
            on: Association::Points,
            count: 0,
            columns: [None; Column::ALL.len()],
            along: None,
            equals: Vec::new(),
            id: None,
            factors: [1.0; Column::ALL.len()],
            doubts: Vec::new(),
            elsewhere: Vec::new(),
            set: PlaceSet::default(),
            centres: Vec::new(),
            volumes: Vec::new(),
            notes: Vec::new(),
        };
        let mut notes = Vec::new();
        let columns = &mapping.columns;
        for column in quantities.iter().copied() {
            if rows.is_elsewhere(columns.get(column), on) {
                rows.elsewhere.push(column);
                continue;
            }
            let source = rows.source(column.name(), columns.get(column), on, &mut notes)?;
            if let Some(Source::Array(array, _)) = source
                && array.on != Association::Whole
                && rows.count == 0
            {
                (on, rows.count) = (Some(array.on), array.tuples);
            }
            rows.columns[column as usize] = source;
        }
        if rows.columns.iter().all(Option::is_none) && mapping.displacement.is_none() {
            return Err(rows.refused(format!(
                "there is nothing to score: the file has no array of the mapping, but {}; name one with --mapping{}",
                frame.names(),
                rows.hint_of_program()
            )));
        }
        rows.on = on.unwrap_or(Association::Points);
        rows.find_others(&mut notes)?;
        if rows.on == Association::Cells
            && let Some(cells) = &frame.cells
        {
            rows.centres = (0..cells.count()).map(|cell| cells.centre(cell, &frame.coordinates)).collect();
            if columns.volume.is_none() {
                notes.extend(rows.weigh(cells));
            }
        }
        if rows.on == Association::Points
            && columns.volume.is_none()
            && let Some(cells) = &frame.cells
        {
            notes.extend(rows.weigh_nodes(cells));
        }
        rows.check_lengths()?;
        rows.take_units(&mut notes);
        rows.note(notes);
        Ok(rows)
    }

    /// Finds the columns that are not quantities.
    fn find_others(&mut self, notes: &mut Vec<String>) -> Result<(), ImportError> {
        let (mapping, frame) = (self.mapping, self.frame);
        let on = Some(self.on);
        self.columns[Column::Y as usize] = self.source("y", Some(&mapping.columns.y), on, notes)?;
        let Some(y) = self.columns[Column::Y as usize] else {
            let reason =
                format!("there is no height `{}`; the file has {}", mapping.columns.y, frame.names());
            return Err(self.refused(reason));
        };
        for (name, value) in &mapping.rows.equals {
            let source = self.source(name, Some(name), on, notes)?;
            self.equals.extend(source.map(|source| (source, *value)));
        }
        for column in [Column::X, Column::Volume] {
            let source = self.source(column.name(), mapping.columns.get(column), on, notes)?;
            self.columns[column as usize] = source;
        }
        self.along = self.columns[Column::X as usize];
        if self.along.is_none() && mapping.rows.x.is_some() {
            self.along = self.source("x", Some(&format!("{COORDINATES}[0]")), on, notes)?;
        }
        let id = mapping.displacement.as_ref().and_then(|source| source.id.as_ref());
        self.id = self.source("id", id, on, notes)?;
        if self.id.is_none() && mapping.displacement.is_some() {
            self.id = self.numbering(notes);
        }
        if self.count == 0 {
            self.count = match (self.on, y) {
                (Association::Cells, _) => frame.cells.as_ref().map_or(0, Cells::count),
                (_, Source::Array(array, _)) if frame.coordinates.is_empty() => array.tuples,
                _ => frame.coordinates.len(),
            };
        }
        Ok(())
    }

    /// The array that numbers the points, where the mapping names none: each has a number of its own.
    fn numbering(&self, notes: &mut Vec<String>) -> Option<Source<'a>> {
        let numbers_all = |array: &&Array| {
            let mut numbers: Vec<u64> = array.values.iter().map(|number| number.to_bits()).collect();
            numbers.sort_unstable();
            numbers.dedup();
            array.components == 1
                && numbers.len() == array.tuples
                && array.values.iter().all(|id| id.fract() == 0.0)
        };
        let on = Some(self.on);
        let array = IDS.iter().filter_map(|name| self.frame.array(name, on)).find(numbers_all)?;
        notes.push(format!("points identified by {}", array.name));
        Some(Source::Array(array, 0))
    }

    /// Takes as weights of nodes their shares of the cells around them, where the cells differ; a note says so.
    fn weigh_nodes(&mut self, cells: &Cells) -> Option<String> {
        let highest = cells.dimension();
        let mut shares = vec![0.0; self.count];
        let mut range = [f64::INFINITY, 0.0_f64];
        for cell in (0..cells.count()).filter(|cell| cells.dimension_of(*cell) == highest) {
            let volume = cells.volume(cell, &self.frame.coordinates);
            let nodes = if self.mapping.rows.corners { cells.corners(cell) } else { cells.points(cell) };
            for node in nodes {
                *shares.get_mut(*node as usize)? += volume / nodes.len() as f64;
            }
            range = [range[0].min(volume), range[1].max(volume)];
        }
        // A volume that is no number makes a share that is none.
        let are_known = shares.iter().all(|share| share.is_finite());
        if highest == 0 || !are_known || range[0] <= 0.0 || range[0] >= (1.0 - EVEN) * range[1] {
            return None;
        }
        self.volumes = shares;
        Some("weight = each node's share of the cells around it".to_owned())
    }

    /// Takes the volumes of the cells as weights, where they differ; a note says so.
    fn weigh(&mut self, cells: &Cells) -> Option<String> {
        let highest = cells.dimension();
        let bodies = (0..cells.count()).filter(|cell| cells.dimension_of(*cell) == highest);
        let of_cell = |cell: usize| cells.volume(cell, &self.frame.coordinates);
        let known: Vec<f64> = bodies.map(of_cell).collect();
        if known.iter().any(|volume| !(volume.is_finite() && *volume > 0.0)) {
            return Some("each cell weighs the same, because some have no volume".to_owned());
        }
        let largest = known.iter().copied().fold(0.0, f64::max);
        if known.iter().all(|volume| *volume >= (1.0 - SAME_VOLUME) * largest) {
            return None;
        }
        self.volumes = (0..cells.count()).map(of_cell).collect();
        Some("weight = the volumes of the cells".to_owned())
    }

    /// Whether the array of a quantity lies on something else than the rows, and on that alone.
    fn is_elsewhere(&self, typed: Option<&String>, on: Option<Association>) -> bool {
        let (Some(typed), Some(on)) = (typed, on) else { return false };
        let mut first =
            spellings(typed).filter(|spelled| self.frame.array(spelled.name, spelled.on).is_some());
        let is_here = |spelled: &crate::import::spelling::Spelling| {
            let whole = || self.frame.array(spelled.name, Some(Association::Whole));
            let here = || self.frame.array(spelled.name, Some(on)).or_else(whole);
            spelled.on.is_none_or(|asked| asked == on) && here().is_some()
        };
        let any = spellings(typed).any(|spelled| is_here(&spelled));
        !any && first.next().is_some()
    }

    /// Takes the units that the file states for the arrays of its columns.
    fn take_units(&mut self, notes: &mut Vec<String>) {
        for column in Column::ALL {
            let Some(Source::Array(array, _)) = self.columns[column as usize] else { continue };
            match said_unit(self.frame, &array.name, column, self.mapping) {
                SaidUnit::AsMapped => {}
                SaidUnit::Factor(factor, note) => {
                    self.factors[column as usize] = factor;
                    notes.push(note);
                }
                SaidUnit::Unfit(doubt) => self.doubts.push(doubt),
            }
        }
    }

    fn note(&mut self, mut notes: Vec<String>) {
        let path = self.path.display();
        if self.mapping.displacement.is_some() {
            notes.push("displacement = position minus that of the first state".to_owned());
        }
        self.notes.push(format!("{path}: {}", notes.join(", ")));
        if self.mapping.rows.corners && self.frame.cells.is_none() {
            self.notes.push(format!(
                "{path}: it has no cells, so corners cannot be distinguished from mid-side nodes (an XDMF beside it has them)"
            ));
        }
    }

    /// The source of a column, if it is named and there. Only columns that the user names must be there.
    pub(super) fn source(
        &self,
        key: &str,
        typed: Option<&String>,
        on: Option<Association>,
        notes: &mut Vec<String>,
    ) -> Result<Option<Source<'a>>, ImportError> {
        let Some(typed) = typed else { return Ok(None) };
        for spelled in spellings(typed) {
            if spelled.name == COORDINATES && !self.frame.coordinates.is_empty() {
                let component = spelled.component.unwrap_or(1);
                if component > 2 {
                    return Err(self.refused(format!("`{typed}`: places have the components 0, 1 and 2")));
                }
                notes.push(format!("{key} = {COORDINATES}[{component}]"));
                return Ok(Some(Source::Coordinates(component)));
            }
            let whole = || self.frame.array(spelled.name, Some(Association::Whole));
            let here = |on: Option<Association>| self.frame.array(spelled.name, on);
            // What the mapping asks for goes before what the rows lie on.
            let Some(array) = here(spelled.on.or(on)).or_else(whole) else { continue };
            let alike = self.frame.namesakes(spelled.name);
            if alike.len() > 1 && alike.iter().any(|other| other.name != array.name) {
                let names: Vec<String> =
                    alike.iter().take(4).map(|array| format!("`{}`", array.name)).collect();
                return Err(
                    self.refused(format!("`{typed}` matches {}: give the whole path", names.join(", ")))
                );
            }
            let Array { name, components, .. } = array;
            let (component, index) = match spelled.component {
                Some(component) if component < *components => (component, format!("[{component}]")),
                None if *components == 1 => (0, String::new()),
                _ => {
                    return Err(self.refused(format!(
                        "`{typed}`: the array `{name}` has {components} components: choose one, from `{name}[0]` to \
                         `{name}[{}]`",
                        components - 1
                    )));
                }
            };
            let index = if *components > 1 { index } else { String::new() };
            notes.push(format!("{key} = {name}{index} on {}", array.on.name()));
            return Ok(Some(Source::Array(array, component)));
        }
        if self.mapping.optional.iter().any(|optional| optional == key) {
            return Ok(None);
        }
        let link = spellings(typed).find_map(|spelled| linked(self.path, spelled.name.rsplit('/').next()?));
        if let Some((file, path)) = link {
            return Err(self.refused(format!(
                "`{typed}` is a link to `{path}` of {file}, which does not lie beside it: score a file that has the \
                 numbers, as h5repack or `f[\"{typed}\"][:]` of h5py gives them"
            )));
        }
        let is_state = |array: &&Array| {
            let (above, number) = array.name.rsplit_once('/').unwrap_or_default();
            number.parse::<usize>().is_ok()
                && spellings(typed)
                    .any(|spelled| above == spelled.name || above.ends_with(&format!("/{}", spelled.name)))
        };
        let states: Vec<&Array> = self.frame.arrays.iter().filter(is_state).collect();
        if let [first, .., last] = &states[..] {
            return Err(self.refused(format!(
                "`{}` to `{}` are the states of `{typed}` by their numbers, and their times are in the XDMF beside them: score that",
                first.name, last.name
            )));
        }
        let has_times = self.frame.time.is_some() || !self.frame.times.is_empty();
        let otherwise = match key {
            "x" | "y" if !self.frame.coordinates.is_empty() => {
                "; its places are `coordinates[0]`, `[1]` and `[2]`"
            }
            "t" if has_times => "; its times are read without a name: leave `t` out",
            _ => "",
        };
        let there = self.frame.names();
        Err(self.refused(format!("there is no array `{typed}` for `{key}`; the file has {there}{otherwise}")))
    }
}
