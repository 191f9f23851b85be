//! The form that every format is read into: points, cells, and named arrays on them.

use std::collections::BTreeSet;

/// What an array belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Association {
    /// One tuple per point.
    Points,
    /// One tuple per cell.
    Cells,
    /// One tuple for the whole file.
    Whole,
}

impl Association {
    /// Its name in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Cells => "cells",
            Self::Whole => "the whole file",
        }
    }
}

/// A named array.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Its name, as the file spells it.
    pub name: String,
    /// What it belongs to.
    pub on: Association,
    /// Numbers per tuple.
    pub components: usize,
    /// Tuples.
    pub tuples: usize,
    /// `[tuple][component]`; empty if the array was not asked for.
    pub values: Vec<f64>,
}

/// Cells as lists of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// Type of each cell, as VTK numbers them.
    pub types: Vec<u8>,
    /// End of each cell in `connectivity`.
    pub ends: Vec<usize>,
    /// Points of the cells, one cell after the other, corners first.
    pub connectivity: Vec<u32>,
}

impl Cells {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Points of a cell.
    pub fn points(&self, cell: usize) -> &[u32] {
        let start = if cell == 0 { 0 } else { self.ends[cell - 1] };
        &self.connectivity[start..self.ends[cell]]
    }

    /// Corners of a cell: its first points, without those at the middle of sides.
    pub fn corners(&self, cell: usize) -> &[u32] {
        let points = self.points(cell);
        let corners = match self.types.get(cell) {
            Some(21 | 35) => 2,
            Some(22 | 34) => 3,
            Some(23 | 24 | 28 | 30) => 4,
            Some(27 | 37) => 5,
            Some(26 | 31 | 32) => 6,
            Some(25 | 29 | 33) => 8,
            _ => points.len(),
        };
        &points[..corners.min(points.len())]
    }

    /// For each of a number of points, whether it is a corner of a cell.
    pub fn are_corners(&self, points: usize) -> Vec<bool> {
        let mut are_corners = vec![false; points];
        for cell in 0..self.count() {
            for corner in self.corners(cell) {
                if let Some(is_corner) = are_corners.get_mut(*corner as usize) {
                    *is_corner = true;
                }
            }
        }
        are_corners
    }

    /// Highest dimension of the cells.
    pub fn dimension(&self) -> usize {
        let dimension = |kind: &u8| match kind {
            1 | 2 => 0,
            3 | 4 | 21 | 35 => 1,
            5..=9 | 22 | 23 | 28 | 30 | 34 | 36 => 2,
            _ => 3,
        };
        self.types.iter().map(dimension).max().unwrap_or(0)
    }

    /// Checks that the lists fit each other and a number of points.
    pub(crate) fn check(&self, points: usize) -> Result<(), String> {
        if self.types.len() != self.ends.len() {
            return Err(format!("there are {} cells and types for {}", self.ends.len(), self.types.len()));
        }
        if self.ends.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err("the offsets of the cells decrease".to_owned());
        }
        let end = self.ends.last().copied().unwrap_or(0);
        if end != self.connectivity.len() {
            return Err(format!(
                "the cells have {} points, and their offsets end at {end}",
                self.connectivity.len()
            ));
        }
        match self.connectivity.iter().find(|point| **point as usize >= points) {
            Some(point) => Err(format!("a cell names the point {point} of {points}")),
            None => Ok(()),
        }
    }
}

/// One state of a result, as a file holds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Time in the file, in the file's own unit.
    pub time: Option<f64>,
    /// Places of the points; empty if the format keeps them in an array like others.
    pub coordinates: Vec<[f64; 3]>,
    /// Cells, if there are any.
    pub cells: Option<Cells>,
    /// Arrays.
    pub arrays: Vec<Array>,
    /// One sentence for each thing that was left out.
    pub notes: Vec<String>,
}

impl Frame {
    /// The array of a name, on what is asked for or on anything.
    pub fn array(&self, name: &str, on: Option<Association>) -> Option<&Array> {
        self.arrays.iter().find(|array| array.name == name && on.is_none_or(|on| array.on == on))
    }

    /// Memory of its numbers, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let numbers: usize = self.arrays.iter().map(|array| array.values.len()).sum();
        let of_cells =
            self.cells.as_ref().map_or(0, |cells| 9 * cells.count() + 4 * cells.connectivity.len());
        (8 * numbers + 24 * self.coordinates.len() + of_cells) as u64
    }

    /// Names of all arrays, for a message.
    pub fn names(&self) -> String {
        let named = |array: &Array| format!("`{}` on {}", array.name, array.on.name());
        let all: Vec<String> = self.arrays.iter().map(named).collect();
        if all.is_empty() { "no array".to_owned() } else { all.join(", ") }
    }

    /// Adds the arrays of a file that has other arrays at the same points.
    ///
    /// # Errors
    /// When its points are others.
    pub fn join(&mut self, other: Self) -> Result<(), String> {
        if self.coordinates != other.coordinates {
            let (own, others) = (self.coordinates.len(), other.coordinates.len());
            return Err(format!("it has other points ({others}) than the file that it is joined to ({own})"));
        }
        let is_new = |array: &Array| self.array(&array.name, Some(array.on)).is_none();
        let new: Vec<Array> = other.arrays.into_iter().filter(is_new).collect();
        self.arrays.extend(new);
        self.cells = self.cells.take().or(other.cells);
        self.time = self.time.or(other.time);
        self.notes.extend(other.notes);
        Ok(())
    }

    /// Appends the points, cells and arrays of another part of the same state. The parts must have the same arrays.
    pub(crate) fn append(&mut self, part: Self) -> Result<(), String> {
        let shift = u32::try_from(self.coordinates.len()).map_err(|_| "too many points".to_owned())?;
        if self.arrays.len() != part.arrays.len() {
            return Err(format!("its parts have different arrays: {} and {}", self.names(), part.names()));
        }
        for (own, other) in self.arrays.iter_mut().zip(part.arrays) {
            if (&own.name, own.on, own.components) != (&other.name, other.on, other.components) {
                return Err(format!("its parts have different arrays: `{}` and `{}`", own.name, other.name));
            }
            if own.on != Association::Whole {
                own.tuples += other.tuples;
                own.values.extend(other.values);
            }
        }
        self.coordinates.extend(part.coordinates);
        match (&mut self.cells, part.cells) {
            (Some(cells), Some(others)) => {
                let end = cells.connectivity.len();
                cells.types.extend(others.types);
                cells.ends.extend(others.ends.iter().map(|other| end + other));
                cells
                    .connectivity
                    .extend(others.connectivity.iter().map(|point| point.saturating_add(shift)));
            }
            (own, others) => *own = own.take().or(others),
        }
        self.notes.extend(part.notes);
        Ok(())
    }
}

/// Names of the arrays to decode; of the others only names and sizes are kept.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a>(pub &'a BTreeSet<String>);

impl Wanted<'_> {
    /// Whether the values of an array are wanted.
    pub(crate) fn has(self, name: &str) -> bool {
        self.0.contains(name)
    }
}

/// Places from numbers with two or three components each; a third component that is missing is 0.
pub(crate) fn points_of(numbers: &[f64], components: usize) -> Vec<[f64; 3]> {
    let place = |at: &[f64]| [at[0], at[1], at.get(2).copied().unwrap_or(0.0)];
    numbers.chunks_exact(components).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_a_quadratic_cell_are_its_first_points() {
        let cells = Cells { types: vec![23, 9], ends: vec![8, 12], connectivity: (0..12).collect() };
        assert_eq!(cells.corners(0), [0, 1, 2, 3]);
        assert_eq!(cells.corners(1), [8, 9, 10, 11]);
        assert_eq!((cells.dimension(), cells.check(12)), (2, Ok(())));
        assert!(cells.check(11).is_err_and(|why| why.contains("the point 11 of 11")));
    }

    #[test]
    fn parts_of_a_state_are_joined_with_their_cells() {
        let part = |height: f64| Frame {
            coordinates: vec![[0.0, height, 0.0]; 2],
            cells: Some(Cells { types: vec![3], ends: vec![2], connectivity: vec![0, 1] }),
            arrays: vec![Array {
                name: "p".to_owned(),
                on: Association::Points,
                components: 1,
                tuples: 2,
                values: vec![height; 2],
            }],
            ..Frame::default()
        };
        let mut whole = part(0.0);
        whole.append(part(1.0)).expect("alike");
        assert_eq!(whole.cells.as_ref().expect("cells").points(1), [2, 3]);
        assert_eq!(whole.arrays[0].values, [0.0, 0.0, 1.0, 1.0]);
        let bare = Frame { arrays: Vec::new(), ..part(2.0) };
        assert!(whole.append(bare).is_err());
    }

    #[test]
    fn a_joined_file_adds_what_has_another_name_or_stands_elsewhere() {
        let array = |name: &str, on: Association, value: f64| Array {
            name: name.to_owned(),
            on,
            components: 1,
            tuples: 1,
            values: vec![value],
        };
        let frame = |arrays: Vec<Array>| Frame { coordinates: vec![[0.0; 3]], arrays, ..Frame::default() };
        let mut own = frame(vec![array("p", Association::Points, 1.0)]);
        let other = [
            array("p", Association::Points, 2.0),
            array("p", Association::Cells, 3.0),
            array("u", Association::Points, 4.0),
        ];
        own.join(frame(other.to_vec())).expect("the same points");
        let values: Vec<f64> = own.arrays.iter().map(|array| array.values[0]).collect();
        assert_eq!(values, [1.0, 3.0, 4.0], "an array that is there stays as it is");
        let elsewhere = Frame { coordinates: vec![[1.0; 3]], ..Frame::default() };
        assert!(own.join(elsewhere).is_err());
    }
}
