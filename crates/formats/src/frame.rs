//! The form that every format is read into: points, cells, and named arrays on them.

use crate::bytes::whole;
use crate::cells::Cells;
use std::collections::{BTreeMap, BTreeSet};

/// Arrays that mark points and cells of another piece, or hidden ones.
const GHOSTS: [&str; 2] = ["vtkGhostType", "vtkGhostLevels"];
/// Arrays of the places of points, where the format does not say which they are.
pub(crate) const PLACES: [&str; 5] = ["geometry", "coordinates", "points", "nodes", "vertices"];
/// Bits of `vtkGhostType` that hide a point: duplicate, hidden.
const HIDDEN_POINT: u8 = 1 | 2;
/// Bits of `vtkGhostType` that hide a cell: duplicate, refined, hidden.
const HIDDEN_CELL: u8 = 1 | 8 | 32;

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
    /// Lengths of its axes, if the file has more to say of them than tuples and components.
    pub shape: Vec<usize>,
}

impl Array {
    /// Whether a name is its own: the last part of a path is enough.
    pub fn is_named(&self, name: &str) -> bool {
        self.name == name || last_part(&self.name) == name
    }

    /// Lengths of its axes.
    pub fn axes(&self) -> Vec<usize> {
        match (&self.shape[..], self.components) {
            ([], 1) => vec![self.tuples],
            ([], _) => vec![self.tuples, self.components],
            (shape, _) => shape.to_vec(),
        }
    }
}

/// The part of a path behind its last `/`; units like `[m/s]` are not a path.
fn last_part(path: &str) -> &str {
    let end = path.find('[').unwrap_or(path.len());
    path[..end].rfind('/').map_or(path, |slash| &path[slash + 1..])
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
    /// Points that belong to another piece, or are hidden: they shape cells but are not samples. Empty if there are none.
    pub ghosts: Vec<bool>,
    /// Times that the file lists beside its arrays: one axis of an array may run over them.
    pub times: Vec<f64>,
    /// Units that the file states for arrays, by their names.
    pub units: BTreeMap<String, String>,
    /// Numbers that stand for no value in arrays, by their names; the arrays have NaN there.
    pub fills: BTreeMap<String, f64>,
    /// One sentence for each thing that was left out.
    pub notes: Vec<String>,
    /// One sentence for each thing that the file says in two ways.
    pub doubts: Vec<String>,
}

/// A file has other points than the one that it is joined to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("its points ({points}) differ from those of the file that it is joined to ({known})")]
pub struct OtherPoints {
    /// Points that it has.
    pub points: usize,
    /// Points of the file that it is joined to.
    pub known: usize,
}

impl Frame {
    /// The array of a name, on what is asked for or on anything. Of several whose path ends with it, the first.
    pub fn array(&self, name: &str, on: Option<Association>) -> Option<&Array> {
        let mut there = self.arrays.iter().filter(|array| on.is_none_or(|on| array.on == on));
        there.clone().find(|array| array.name == name).or_else(|| there.find(|array| array.is_named(name)))
    }

    /// The arrays whose path ends with a name that is none's whole name, if they are several.
    pub fn namesakes(&self, name: &str) -> Vec<&Array> {
        let is_whole = self.arrays.iter().any(|array| array.name == name);
        let alike: Vec<&Array> = self.arrays.iter().filter(|array| array.is_named(name)).collect();
        if is_whole || alike.len() < 2 { Vec::new() } else { alike }
    }

    /// Takes the places of the points from an array that is named like them, if there are none.
    pub(crate) fn place_from_array(&mut self) {
        let is_place = |array: &&Array| {
            let name = last_part(&array.name).to_ascii_lowercase();
            let axes = array.axes();
            // Written once, for all times.
            let axes = if axes.len() == 3 && axes[0] == 1 { &axes[1..] } else { &axes[..] };
            PLACES.contains(&name.as_str())
                && axes.len() == 2
                && (2..=3).contains(&axes[1])
                && array.values.len() == axes[0] * axes[1]
        };
        if self.coordinates.is_empty()
            && let Some(array) = self.arrays.iter().find(is_place)
        {
            let components = array.axes().last().copied().unwrap_or(3);
            self.coordinates = points_of(&array.values, components);
        }
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
    pub fn join(&mut self, other: Self) -> Result<(), OtherPoints> {
        if self.coordinates != other.coordinates {
            return Err(OtherPoints { points: other.coordinates.len(), known: self.coordinates.len() });
        }
        let is_new = |array: &Array| self.array(&array.name, Some(array.on)).is_none();
        let new: Vec<Array> = other.arrays.into_iter().filter(is_new).collect();
        // What is said of an array that is left aside is not said of the one that stays.
        let is_of_new = |name: &String| new.iter().any(|array| array.name == *name);
        let (units, fills) = (other.units.into_iter(), other.fills.into_iter());
        for (name, unit) in units.filter(|(name, _)| is_of_new(name)) {
            self.units.entry(name).or_insert(unit);
        }
        for (name, fill) in fills.filter(|(name, _)| is_of_new(name)) {
            self.fills.entry(name).or_insert(fill);
        }
        self.arrays.extend(new);
        self.cells = self.cells.take().or(other.cells);
        self.time = self.time.or(other.time);
        self.notes.extend(other.notes);
        self.doubts.extend(other.doubts);
        Ok(())
    }

    /// Leaves out the cells that another piece has as well, or that are hidden, and marks such points.
    pub(crate) fn leave_out_ghosts(&mut self) -> Result<(), String> {
        for name in GHOSTS {
            for on in [Association::Points, Association::Cells] {
                let is_it = |array: &Array| array.name == name && array.on == on;
                let Some(place) = self.arrays.iter().position(is_it) else { continue };
                let array = self.arrays.remove(place);
                let flags: Vec<u8> = whole(&array.values).map_err(|why| format!("`{name}`: {why}"))?;
                let bits = match (name, on) {
                    ("vtkGhostType", Association::Points) => HIDDEN_POINT,
                    ("vtkGhostType", _) => HIDDEN_CELL,
                    _ => u8::MAX,
                };
                let are_ghosts: Vec<bool> = flags.iter().map(|flag| flag & bits != 0).collect();
                if !are_ghosts.contains(&true) {
                    continue;
                }
                if on == Association::Points {
                    self.ghosts = are_ghosts;
                } else {
                    self.keep_cells(&are_ghosts.iter().map(|is_ghost| !is_ghost).collect::<Vec<bool>>());
                }
            }
        }
        Ok(())
    }

    /// Keeps the cells that a list says, and their data.
    fn keep_cells(&mut self, is_kept: &[bool]) {
        if let Some(cells) = &mut self.cells {
            cells.keep(is_kept);
        }
        let kept = |tuple: usize| is_kept.get(tuple).copied().unwrap_or(true);
        for array in self.arrays.iter_mut().filter(|array| array.on == Association::Cells) {
            let components = array.components;
            let mut tuple = 0;
            array.values.retain(|_| {
                tuple += 1;
                kept((tuple - 1) / components)
            });
            array.tuples = (0..array.tuples).filter(|tuple| kept(*tuple)).count();
        }
    }

    /// Appends the points, cells and arrays of another part of the same state. The parts must have the same arrays, but
    /// for one without points.
    pub(crate) fn append(&mut self, part: Self) -> Result<(), String> {
        if part.coordinates.is_empty() && !self.coordinates.is_empty() {
            return Ok(());
        }
        if self.coordinates.is_empty() && !part.coordinates.is_empty() {
            let (notes, time) = (std::mem::take(&mut self.notes), self.time);
            *self = part;
            self.notes.splice(0..0, notes);
            self.time = self.time.or(time);
            return Ok(());
        }
        let before = self.coordinates.len();
        let shift = u32::try_from(before).map_err(|_| "too many points".to_owned())?;
        let mut others = part.arrays;
        for own in &mut self.arrays {
            let is_same = |other: &Array| {
                (&own.name, own.on, own.components) == (&other.name, other.on, other.components)
            };
            let Some(place) = others.iter().position(is_same) else {
                return Err(format!("its parts have different arrays: one lacks `{}`", own.name));
            };
            let other = others.swap_remove(place);
            if own.on != Association::Whole {
                own.tuples += other.tuples;
                own.values.extend(other.values);
            }
        }
        if let Some(other) = others.first() {
            return Err(format!("its parts have different arrays: one lacks `{}`", other.name));
        }
        if !(self.ghosts.is_empty() && part.ghosts.is_empty()) {
            self.ghosts.resize(before, false);
            self.ghosts.extend(part.ghosts);
            self.ghosts.resize(before + part.coordinates.len(), false);
        }
        self.coordinates.extend(part.coordinates);
        match (&mut self.cells, part.cells) {
            (Some(cells), Some(others)) => cells.append(&others, shift),
            (None, Some(others)) => {
                let mut cells = Cells::default();
                cells.append(&others, shift);
                self.cells = Some(cells);
            }
            (_, None) => {}
        }
        self.time = self.time.or(part.time);
        let other = |(name, unit): &(&String, &String)| self.units.get(*name).is_some_and(|own| own != *unit);
        if let Some((name, unit)) = part.units.iter().find(other) {
            return Err(format!("its parts have `{name}` in {} and in {unit}", self.units[name]));
        }
        self.units.extend(part.units);
        self.fills.extend(part.fills);
        self.notes.extend(part.notes);
        self.doubts.extend(part.doubts);
        Ok(())
    }
}

/// Names of the arrays to decode; of the others only names and sizes are kept.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a>(pub &'a BTreeSet<String>);

impl Wanted<'_> {
    /// Whether the values of an array are wanted.
    pub(crate) fn has(self, name: &str) -> bool {
        self.0.contains(name) || self.0.contains(last_part(name)) || GHOSTS.contains(&name)
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
                shape: Vec::new(),
            }],
            ..Frame::default()
        };
        let mut whole = part(0.0);
        whole.append(part(1.0)).expect("alike");
        assert_eq!(whole.cells.as_ref().expect("cells").points(1), [2, 3]);
        assert_eq!(whole.arrays[0].values, [0.0, 0.0, 1.0, 1.0]);
        let bare = Frame { arrays: Vec::new(), ..part(2.0) };
        assert!(whole.append(bare).is_err());
        let stated = |unit: &str| {
            let units = [("p".to_owned(), unit.to_owned())].into_iter().collect();
            Frame { units, ..part(3.0) }
        };
        let mut whole = part(0.0);
        // Said by any of them, and by none otherwise.
        for unit in ["kPa", "kPa"] {
            whole.append(stated(unit)).expect("alike");
            whole.append(part(4.0)).expect("alike");
        }
        let refused = whole.append(stated("Pa"));
        assert_eq!(refused, Err("its parts have `p` in kPa and in Pa".to_owned()));
        // What any of three parts says of itself is said of the whole.
        for odd in 0..3 {
            let mut parts = [0.0, 1.0, 2.0].map(part);
            let said = &mut parts[odd];
            (said.notes, said.doubts) = (vec!["a note".to_owned()], vec!["a doubt".to_owned()]);
            said.fills.insert("p".to_owned(), -999.0);
            let [mut whole, second, third] = parts;
            for part in [second, third] {
                whole.append(part).expect("alike");
            }
            let told = (&whole.notes[..], &whole.doubts[..], whole.fills.get("p"));
            assert_eq!(
                told,
                (&["a note".to_owned()][..], &["a doubt".to_owned()][..], Some(&-999.0)),
                "{odd}"
            );
        }
    }

    #[test]
    fn a_joined_file_adds_what_has_another_name_or_stands_elsewhere() {
        let array = |name: &str, on: Association, value: f64| Array {
            name: name.to_owned(),
            on,
            components: 1,
            tuples: 1,
            values: vec![value],
            shape: Vec::new(),
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
        // A unit that is said of an array which is left aside is not that of the one that stays.
        let units = [("p", "kPa"), ("u", "mm")].map(|(name, unit)| (name.to_owned(), unit.to_owned()));
        let mut own = frame(vec![array("p", Association::Points, 1.0)]);
        let other = frame(vec![array("p", Association::Points, 2.0), array("u", Association::Points, 4.0)]);
        own.join(Frame {
            units: units.into_iter().collect(),
            fills: [("p".to_owned(), 1.0)].into(),
            ..other
        })
        .expect("the same points");
        let kept: Vec<(&str, &str)> = own.units.iter().map(|(name, unit)| (&**name, &**unit)).collect();
        assert_eq!((&kept[..], own.fills.len()), (&[("u", "mm")][..], 0));
        let elsewhere = Frame { coordinates: vec![[1.0; 3]], ..Frame::default() };
        assert!(own.join(elsewhere).is_err());
    }
}
