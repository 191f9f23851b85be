//! XDMF: states over time whose numbers stand in the file itself or in HDF5 beside it.
//!
//! Format: "XDMF Model and Format", xdmf.org. Which mesh is whose is told by `xdmf_states`.

use crate::bytes::{Budget, count, counts, numbers_of_text};
use crate::collections::{beside, time_of};
use crate::frame::{Array, Association, Cells, Frame, Wanted};
use crate::hdf5::Store;
use crate::vtu::places;
use crate::xdmf_states::{State, states_of};
use crate::xml::{Element, tree_of};
use std::path::{Path, PathBuf};

/// Most stores that stay open: a state names a few, and each is in memory.
const MOST_STORES: usize = 4;

/// Cells: name, code among mixed cells, points, type of VTK.
const TOPOLOGIES: [(&str, usize, usize, u8); 15] = [
    ("triangle", 4, 3, 5),
    ("quadrilateral", 5, 4, 9),
    ("tetrahedron", 6, 4, 10),
    ("pyramid", 7, 5, 14),
    ("wedge", 8, 6, 13),
    ("hexahedron", 9, 8, 12),
    ("edge_3", 34, 3, 21),
    ("quadrilateral_9", 35, 9, 28),
    ("triangle_6", 36, 6, 22),
    ("quadrilateral_8", 37, 8, 23),
    ("tetrahedron_10", 38, 10, 24),
    ("hexahedron_20", 48, 20, 25),
    ("hexahedron_27", 50, 27, 29),
    ("polyvertex", 1, 1, 1),
    ("polyline", 2, 2, 3),
];

/// A document with its states, and the stores that these name.
pub struct Document {
    path: PathBuf,
    root: Element,
    states: Vec<State>,
    /// Stores that are open, with their files: those that were asked for last.
    stores: Vec<(PathBuf, Store)>,
    /// How often a store was read.
    pub(super) opened: usize,
    /// Bytes of the document.
    size: usize,
}

impl Document {
    /// The document of a file.
    ///
    /// # Errors
    /// When it is no sound XML, has no state, or a state names a mesh that is not there.
    pub fn of(path: &Path, bytes: &[u8]) -> Result<Self, String> {
        let root = tree_of(bytes)?;
        let states = states_of(&root)?;
        Ok(Self { path: path.to_owned(), root, states, stores: Vec::new(), opened: 0, size: bytes.len() })
    }

    /// Times of the states, in order.
    ///
    /// # Errors
    /// When one is no number.
    pub fn times(&self) -> Result<Vec<Option<f64>>, String> {
        self.states.iter().map(|state| self.time(state)).collect()
    }

    fn time(&self, state: &State) -> Result<Option<f64>, String> {
        let time = self.root.at(&state.grid).and_then(|grid| grid.child("Time"));
        time.map(|time| time_of(time.attribute("Value"))).transpose()
    }

    /// Reads the state of a place in the list of times.
    ///
    /// # Errors
    /// What is damaged, cut or claims too much.
    pub fn frame(&mut self, place: usize, wanted: Wanted) -> Result<Frame, String> {
        let state = self.states.get(place).ok_or_else(|| format!("it has {} states", self.states.len()))?;
        let mut frame = Frame { time: self.time(state)?, ..Frame::default() };
        for (_, store) in &mut self.stores {
            store.renew_budget();
        }
        let budget = Budget::of_file(self.size);
        let (path, stores, opened) = (&self.path, &mut self.stores, &mut self.opened);
        let mut reading = Reading { path, stores, opened, budget };
        let element = |path: &Option<Vec<usize>>| path.as_ref().and_then(|path| self.root.at(path));
        if let Some(geometry) = element(&state.geometry) {
            frame.coordinates = reading.coordinates(geometry)?;
        }
        if let Some(topology) = element(&state.topology) {
            frame.cells = reading.cells(topology, frame.coordinates.len())?;
        }
        let children = self.root.at(&state.grid).map_or(&[][..], |grid| &grid.children);
        for attribute in children.iter().filter(|child| child.name == "Attribute") {
            frame.arrays.extend(reading.array(attribute, wanted)?);
        }
        Ok(frame)
    }
}

/// Dimensions of an item.
fn shape_of(item: &Element) -> Result<Vec<usize>, String> {
    let typed = item.attribute("Dimensions");
    let shape: Option<Vec<usize>> = typed.split_whitespace().map(|entry| entry.parse().ok()).collect();
    let shape =
        shape.filter(|shape| shape.iter().try_fold(1_usize, |all, one| all.checked_mul(*one)).is_some());
    shape.ok_or_else(|| format!("the dimensions `{typed}` are no counts"))
}

struct Reading<'a> {
    path: &'a Path,
    stores: &'a mut Vec<(PathBuf, Store)>,
    opened: &'a mut usize,
    budget: Budget,
}

impl Reading<'_> {
    /// An array, with its values where they are wanted; none where it has no data.
    fn array(&mut self, attribute: &Element, wanted: Wanted) -> Result<Option<Array>, String> {
        let on = match attribute.attribute("Center").to_ascii_lowercase().as_str() {
            "cell" => Association::Cells,
            "grid" => Association::Whole,
            _ => Association::Points,
        };
        let name = attribute.attribute("Name").to_owned();
        let Some(item) = attribute.child("DataItem") else { return Ok(None) };
        let shape = shape_of(item)?;
        let components = shape.get(1..).unwrap_or_default().iter().product::<usize>().max(1);
        let tuples = shape.first().copied().unwrap_or(1);
        let mut array = Array { name, on, components, tuples, values: Vec::new() };
        if wanted.has(&array.name) {
            array.values = self.numbers(item).map_err(|why| format!("the array `{}`: {why}", array.name))?;
        }
        Ok(Some(array))
    }

    fn coordinates(&mut self, geometry: &Element) -> Result<Vec<[f64; 3]>, String> {
        let item = geometry.child("DataItem").ok_or("its geometry has no data")?;
        let numbers = self.numbers(item)?;
        let kind = geometry.attribute("Type").to_owned() + geometry.attribute("GeometryType");
        match kind.to_ascii_uppercase().as_str() {
            "XYZ" | "" => Ok(numbers.chunks_exact(3).map(|at| [at[0], at[1], at[2]]).collect()),
            "XY" => Ok(numbers.chunks_exact(2).map(|at| [at[0], at[1], 0.0]).collect()),
            other => Err(format!("a geometry of the type `{other}` is not read")),
        }
    }

    fn cells(&mut self, topology: &Element, points: usize) -> Result<Option<Cells>, String> {
        let Some(item) = topology.child("DataItem") else { return Ok(None) };
        let kind =
            (topology.attribute("Type").to_owned() + topology.attribute("TopologyType")).to_ascii_lowercase();
        let numbers = self.numbers(item)?;
        let mut cells = Cells::default();
        if kind == "mixed" {
            let codes = counts(&numbers)?;
            let mut rest = codes.as_slice();
            while let Some((code, after)) = rest.split_first() {
                let Some((.., own, vtk)) = TOPOLOGIES.iter().find(|(_, other, ..)| other == code) else {
                    return Err(format!("the cell type {code} is not read"));
                };
                let (own, after) = match (code, after.split_first()) {
                    (1 | 2, Some((own, after))) => (*own, after),
                    _ => (*own, after),
                };
                let list = after.get(..own).ok_or("the list of cells ends inside a cell")?;
                let list: Result<Vec<u32>, _> = list.iter().map(|point| u32::try_from(*point)).collect();
                cells.connectivity.extend(list.map_err(|_| "a cell names no point")?);
                cells.ends.push(cells.connectivity.len());
                cells.types.push(*vtk);
                rest = &after[own..];
            }
        } else {
            let Some((.., own, vtk)) = TOPOLOGIES.iter().find(|(name, ..)| *name == kind) else {
                return Ok(None);
            };
            cells.connectivity = places(&numbers)?;
            let all = cells.connectivity.len() / own;
            cells.ends = (1..=all).map(|cell| cell * own).collect();
            cells.types = vec![*vtk; all];
        }
        cells.check(points)?;
        Ok(Some(cells))
    }

    /// The numbers of an item.
    fn numbers(&mut self, item: &Element) -> Result<Vec<f64>, String> {
        let expected: usize = shape_of(item)?.iter().product();
        if item.attribute("ItemType") == "HyperSlab" {
            let parts: Vec<&Element> =
                item.children.iter().filter(|child| child.name == "DataItem").collect();
            let [slab, source] = parts[..] else { return Err("a slab needs two items of data".to_owned()) };
            let slab = counts(&numbers_of_text(slab.text.as_bytes(), 64)?)?;
            let rank = slab.len() / 3;
            let (start, rest) = slab.split_at(rank);
            let (stride, size) = rest.split_at(rank);
            return self.slab(source.text.trim(), start, stride, size, expected);
        }
        match item.attribute("Format").to_ascii_uppercase().as_str() {
            "XML" | "" => {
                self.budget.take(8 * expected as u64)?;
                let numbers = numbers_of_text(item.text.as_bytes(), expected)?;
                if numbers.len() != expected {
                    return Err(format!("it holds {} numbers, and {expected} are declared", numbers.len()));
                }
                Ok(numbers)
            }
            "HDF" => {
                let text = item.text.trim();
                let Some((place, slab)) = text.split_once('|') else {
                    return self.slab(text, &[], &[], &[], expected);
                };
                let part = |text: &str| numbers_of_text(text.as_bytes(), 16).and_then(|list| counts(&list));
                let parts: Vec<Vec<usize>> = slab.split(':').map(part).collect::<Result<_, _>>()?;
                let [start, stride, size, ..] = &parts[..] else {
                    return Err(format!("`{slab}` is no slab of start:stride:count:size"));
                };
                self.slab(place, start, stride, size, expected)
            }
            other => Err(format!("data in the format `{other}` are not read; XML and HDF are")),
        }
    }

    /// A slab of a data set: all of it, or one whose first index alone has a range.
    fn slab(
        &mut self,
        place: &str,
        start: &[usize],
        stride: &[usize],
        size: &[usize],
        expected: usize,
    ) -> Result<Vec<f64>, String> {
        let (file, inside) = place.split_once(":/").ok_or_else(|| format!("`{place}` names no data set"))?;
        let file = beside(self.path, file.trim());
        let is_open = |(open, _): &(PathBuf, Store)| *open == file;
        let known = self.stores.iter().position(is_open);
        if let Some(known) = known {
            self.stores[..=known].rotate_right(1);
        } else {
            let store = Store::open(&file).map_err(|why| format!("{}: {why}", file.display()))?;
            self.stores.truncate(MOST_STORES - 1);
            *self.opened += 1;
            self.stores.insert(0, (file, store));
        }
        let store = &mut self.stores[0].1;
        let rows = match (start.first(), size.first()) {
            (Some(start), Some(size)) => Some((*start as u64, *size as u64)),
            _ => None,
        };
        let is_whole =
            start.iter().skip(1).all(|start| *start == 0) && stride.iter().all(|stride| *stride == 1);
        if !is_whole {
            return Err("a slab is read where it takes whole rows, one after the other".to_owned());
        }
        let numbers = store.numbers(inside, rows)?.1;
        if numbers.len() != expected || count(expected as f64).is_none() {
            return Err(format!(
                "`{place}` has {} numbers there, and {expected} are declared",
                numbers.len()
            ));
        }
        Ok(numbers)
    }
}
