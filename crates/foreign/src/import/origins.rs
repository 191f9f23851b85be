//! Where the rows of a result were read, and how a message names their places and values.

use crate::import::mapping::{Column, Mapping};
use crate::import::samples::SampleRow;
use oedometer_wording::{rounded, typed};
use std::path::{Path, PathBuf};

/// Where a row was read: its part of the result, and its place there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Origin {
    /// The file, or the state of a file.
    pub part: u32,
    /// The line of a table, or the row of a list of records, from 1.
    pub line: u32,
}

/// What a part is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// Lines of a table.
    Lines,
    /// Rows of records, each with its time.
    Records,
    /// A state: the only one of its file, or the one of this number.
    State(Option<usize>),
}

/// A file, or a state of it.
#[derive(Clone, Debug)]
struct Part {
    file: PathBuf,
    kind: PartKind,
    /// Place of the file that lists its times in their order.
    source: usize,
}

/// The parts of a result in the order in which they were read, and the words of its mapping.
#[derive(Clone, Debug)]
pub struct Origins {
    parts: Vec<Part>,
    sources: Vec<PathBuf>,
    axis: [&'static str; 2],
    names: [&'static str; 4],
}

impl Origins {
    /// None yet, of files with a mapping.
    pub fn new(mapping: &Mapping) -> Self {
        Self {
            parts: Vec::new(),
            sources: Vec::new(),
            axis: [Column::Y, Column::X].map(|column| mapping.shown(column).name()),
            names: SampleRow::COLUMNS.map(|column| mapping.shown(column).name()),
        }
    }

    /// The same for a settlement curve, which stands for the displacement of the surface.
    pub fn of_curve(mapping: &Mapping) -> Self {
        let mut origins = Self::new(mapping);
        origins.names[2] = "s";
        origins
    }

    /// Adds a part of a file, whose times the file `source` has in their order; returns its number.
    pub fn add(&mut self, file: &Path, source: &Path, kind: PartKind) -> u32 {
        let known = self.sources.iter().position(|known| known == source);
        let place = known.unwrap_or_else(|| {
            self.sources.push(source.to_owned());
            self.sources.len() - 1
        });
        // Records of a file are one list, whatever their times.
        let is_same = |part: &Part| kind == PartKind::Records && part.kind == kind && part.file == file;
        if !self.parts.last().is_some_and(is_same) {
            self.parts.push(Part { file: file.to_owned(), kind, source: place });
        }
        u32::try_from(self.parts.len() - 1).unwrap_or(u32::MAX)
    }

    /// Number of files that list times.
    pub fn sources(&self) -> usize {
        self.sources.len()
    }

    /// The place of the file that lists the time of a row.
    pub fn source_of(&self, origin: Origin) -> Option<usize> {
        self.parts.get(origin.part as usize).map(|part| part.source)
    }

    /// Where a row was read, as a message names it.
    pub fn place(&self, origin: Origin) -> String {
        let Some(Part { file, kind, .. }) = self.parts.get(origin.part as usize) else {
            return format!("row {}", origin.line);
        };
        let file = file.display();
        match kind {
            PartKind::Lines => format!("{file}:{}", origin.line),
            PartKind::Records => format!("{file}, row {}", origin.line),
            PartKind::State(None) => file.to_string(),
            PartKind::State(Some(number)) => format!("{file}, state {number}"),
        }
    }

    /// Two values of a quantity at one place, each with where it was read.
    pub fn two_values(&self, quantity: usize, [one, other]: [&SampleRow; 2]) -> String {
        let [a, b] = Self::values(quantity, [one, other]);
        let [here, there] = [one, other].map(|row| self.place(row.origin));
        format!("{}: {} is {a} ({here}) and {b} ({there})", self.at(one), self.names[quantity])
    }

    /// Two values of a quantity at neighbouring places, each with where it was read.
    pub fn two_places(&self, quantity: usize, [one, other]: [&SampleRow; 2]) -> String {
        let [a, b] = Self::values(quantity, [one, other]);
        let [here, there] = [one, other].map(|row| self.place(row.origin));
        format!(
            "{} is {a} at {} ({here}) and {b} at {} ({there})",
            self.names[quantity],
            self.at(one),
            self.at(other)
        )
    }

    /// The initial place of a row.
    fn at(&self, row: &SampleRow) -> String {
        let [up, along] = self.axis;
        let across = match row.initial_distance {
            distance if distance.is_nan() => String::new(),
            distance => format!(", {along} = {} m", rounded(distance)),
        };
        format!("{up} = {} m{across}", rounded(row.initial_height))
    }

    /// Two values with their unit and as many digits as show that they differ.
    fn values(quantity: usize, rows: [&SampleRow; 2]) -> [String; 2] {
        let unit = if quantity < 2 { "Pa" } else { "m" };
        let values = rows.map(|row| row.values()[quantity]);
        let rounded = values.map(rounded);
        let shown = if rounded[0] == rounded[1] { values.map(typed) } else { rounded };
        shown.map(|value| format!("{value} {unit}"))
    }
}
