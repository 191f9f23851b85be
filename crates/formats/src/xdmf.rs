//! XDMF: states over time whose numbers are in the document itself or in HDF5 beside it.
//!
//! Format: "XDMF Model and Format", xdmf.org. Which state has which mesh: `xdmf_states`.

use crate::bytes::{Budget, excerpt, numbers_of_text, whole};
use crate::cells::Cells;
use crate::collections::beside;
use crate::frame::{Array, Association, Frame, Wanted, points_of};
use crate::hdf5::Store;
use crate::xdmf_states::{Part, State, states_of, text_of};
use crate::xml::{attribute, child};
use crate::xpath::Pointers;
use roxmltree::{Document, Node};
use std::path::{Path, PathBuf};

/// Most HDF5 files that stay open: a state refers to a few, and each is in memory.
const MOST_STORES: usize = 4;

/// Deepest chain of references from one item to another.
const MOST_REFERENCES: usize = 8;

/// Cells: name, code among mixed cells, points (0: as the topology says), type of VTK.
const TOPOLOGIES: [(&str, u32, usize, u8); 28] = [
    ("polyvertex", 1, 0, 2),
    ("polyline", 2, 0, 4),
    ("polygon", 3, 0, 7),
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
    ("pyramid_13", 39, 13, 27),
    ("wedge_15", 40, 15, 26),
    ("wedge_18", 41, 18, 32),
    ("hexahedron_20", 48, 20, 25),
    ("hexahedron_24", 49, 24, 33),
    ("hexahedron_27", 50, 27, 29),
    // Names that writers use as well.
    ("quadrilateral9", 0, 9, 28),
    ("triangle6", 0, 6, 22),
    ("quadrilateral8", 0, 8, 23),
    ("tetrahedron10", 0, 10, 24),
    ("hexahedron20", 0, 20, 25),
    ("hexahedron27", 0, 27, 29),
    ("interval", 0, 2, 3),
    ("intervalquadratic", 0, 3, 21),
];

/// Times of the states of a document, in its order.
pub(crate) fn times_of(document: &Document) -> Result<Vec<Option<f64>>, String> {
    Ok(states_of(document)?.iter().map(|state| state.time).collect())
}

/// Reads the states of a document.
pub(crate) struct Reader<'a> {
    path: &'a Path,
    states: Vec<State<'a>>,
    pointers: Pointers<'a>,
    /// Open HDF5 files, the last used one first.
    pub(super) stores: Vec<(PathBuf, Store)>,
    budget: Budget,
    size: usize,
}

impl<'a> Reader<'a> {
    /// A reader of a document in a file.
    pub(crate) fn of(path: &'a Path, document: &'a Document<'a>) -> Result<Self, String> {
        let size = document.input_text().len();
        let states = states_of(document)?;
        let (pointers, budget) = (Pointers::of(document), Budget::of_file(size));
        Ok(Self { path, states, pointers, stores: Vec::new(), budget, size })
    }

    /// Reads the state of a place in the list of times.
    pub(crate) fn frame(&mut self, place: usize, wanted: Wanted) -> Result<Frame, String> {
        let state = self.states.get(place).cloned();
        let state = state.ok_or_else(|| format!("it has {} states", self.states.len()))?;
        self.budget = Budget::of_file(self.size);
        for (_, store) in &mut self.stores {
            store.renew_budget();
        }
        let mut whole: Option<Frame> = None;
        for part in &state.parts {
            let frame = self.part(part, wanted)?;
            match &mut whole {
                Some(whole) => whole.append(frame)?,
                None => whole = Some(frame),
            }
        }
        let mut whole = whole.ok_or("a state has no grid")?;
        for part in &state.beside {
            let frame = self.part(part, wanted)?;
            whole.join(frame).map_err(|why| {
                format!("functions of one time have different meshes: {why}; write each to a separate file")
            })?;
        }
        whole.time = state.time;
        whole.leave_out_ghosts()?;
        Ok(whole)
    }

    /// Reads a mesh with the arrays of its grids.
    fn part(&mut self, part: &Part<'a>, wanted: Wanted) -> Result<Frame, String> {
        let mut frame = Frame::default();
        if let Some(geometry) = part.geometry {
            frame.coordinates = self.coordinates(geometry)?;
        }
        if let Some(topology) = part.topology {
            frame.cells = self.cells(topology, frame.coordinates.len())?;
        }
        for grid in &part.grids {
            for node in grid.children().filter(|node| node.has_tag_name("Attribute")) {
                let array = self.array(node, wanted, frame.coordinates.len())?;
                let is_new = |array: &Array| frame.array(&array.name, Some(array.on)).is_none();
                frame.arrays.extend(array.filter(is_new));
            }
        }
        Ok(frame)
    }

    /// The item that another one refers to, or itself.
    fn item_of(&mut self, mut item: Node<'a, 'a>) -> Result<Node<'a, 'a>, String> {
        for _ in 0..MOST_REFERENCES {
            let path = match item.attribute("Reference") {
                None => return Ok(item),
                Some("XML") => text_of(item).trim().to_owned(),
                Some(path) => path.to_owned(),
            };
            let found = self.pointers.elements(&path).first().copied();
            item = found.ok_or_else(|| format!("it refers to `{}`, which is missing", excerpt(&path)))?;
        }
        Err("its items of data refer to each other".to_owned())
    }

    /// The item of data in an element.
    fn item_in(&mut self, node: Node<'a, 'a>) -> Result<Option<Node<'a, 'a>>, String> {
        child(node, "DataItem").map(|item| self.item_of(item)).transpose()
    }

    /// An array, with its values if they are wanted; nothing if it has no data.
    fn array(&mut self, node: Node<'a, 'a>, wanted: Wanted, points: usize) -> Result<Option<Array>, String> {
        let on = match attribute(node, "Center").to_ascii_lowercase().as_str() {
            "cell" => Association::Cells,
            "grid" => Association::Whole,
            _ => Association::Points,
        };
        let name = attribute(node, "Name").to_owned();
        let Some(item) = self.item_in(node)? else { return Ok(None) };
        let mut shape = shape_of(item)?;
        // One row of a list over time.
        if shape.len() > 1 && shape[0] == 1 && (on != Association::Points || points == shape[1]) {
            shape.remove(0);
        }
        let components = shape.get(1..).unwrap_or_default().iter().product::<usize>().max(1);
        let tuples = shape.first().copied().unwrap_or(1);
        let mut array = Array { name, on, components, tuples, values: Vec::new(), shape: Vec::new() };
        if wanted.has(&array.name) {
            array.values = self.numbers(item).map_err(|why| format!("the array `{}`: {why}", array.name))?;
        }
        Ok(Some(array))
    }

    fn coordinates(&mut self, geometry: Node<'a, 'a>) -> Result<Vec<[f64; 3]>, String> {
        let kind = type_of(geometry, "GeometryType");
        if kind == "x_y_z" || kind == "x_y" {
            let items: Vec<Node> = geometry.children().filter(|item| item.has_tag_name("DataItem")).collect();
            let mut axes = Vec::new();
            for item in items {
                let item = self.item_of(item)?;
                axes.push(self.numbers(item)?);
            }
            let points = axes.first().map_or(0, Vec::len);
            let at = |axis: usize, point: usize| axes.get(axis).and_then(|axis| axis.get(point)).copied();
            let place = |point: usize| [0, 1, 2].map(|axis| at(axis, point).unwrap_or(0.0));
            return Ok((0..points).map(place).collect());
        }
        let item = self.item_in(geometry)?.ok_or("its geometry has no data")?;
        let numbers = self.numbers(item)?;
        match kind.as_str() {
            "xyz" | "" => Ok(points_of(&numbers, 3)),
            "xy" => Ok(points_of(&numbers, 2)),
            other => Err(format!("a geometry of the type `{other}` is not read")),
        }
    }

    fn cells(&mut self, topology: Node<'a, 'a>, points: usize) -> Result<Option<Cells>, String> {
        let Some(item) = self.item_in(topology)? else { return Ok(None) };
        let kind = type_of(topology, "TopologyType");
        let list: Vec<u32> = whole(&self.numbers(item)?)?;
        let mut cells = Cells::default();
        if kind == "mixed" {
            let mut rest = list.as_slice();
            while let Some((code, after)) = rest.split_first() {
                let Some((.., own, vtk)) =
                    TOPOLOGIES.iter().find(|(_, other, ..)| other == code && *code > 0)
                else {
                    return Err(format!("the cell type {code} is not read"));
                };
                // Of vertices, lines and polygons the number of points follows.
                let (own, after) = match (own, after.split_first()) {
                    (0, Some((own, after))) => (*own as usize, after),
                    _ => (*own, after),
                };
                let points = after.get(..own).ok_or("the list of cells ends inside a cell")?;
                cells.connectivity.extend(points);
                cells.ends.push(cells.connectivity.len());
                cells.types.push(*vtk);
                rest = &after[own..];
            }
        } else {
            let Some((.., own, vtk)) = TOPOLOGIES.iter().find(|(name, ..)| *name == kind) else {
                return Ok(None);
            };
            let own = if *own > 0 { *own } else { points_per_element(topology, item, &kind)? };
            let count = list.len() / own;
            cells = Cells {
                connectivity: list,
                ends: (1..=count).map(|cell| cell * own).collect(),
                types: vec![*vtk; count],
            };
        }
        cells.check(points)?;
        Ok(Some(cells))
    }

    /// The numbers of an item.
    fn numbers(&mut self, item: Node<'a, 'a>) -> Result<Vec<f64>, String> {
        let expected: usize = shape_of(item)?.iter().product();
        let text = text_of(item);
        let text = text.as_str();
        if attribute(item, "ItemType") == "HyperSlab" {
            let parts: Vec<Node> = item.children().filter(|part| part.has_tag_name("DataItem")).collect();
            let [slab, source] = parts[..] else { return Err("a slab needs two items of data".to_owned()) };
            let (slab, source) = (self.item_of(slab)?, self.item_of(source)?);
            let slab: Vec<u64> = whole(&numbers_of_text(&text_of(slab), 64)?)?;
            let (start, rest) = slab.split_at(slab.len() / 3);
            let (stride, size) = rest.split_at(start.len());
            return self.slab(&text_of(source), [start, stride, size], expected);
        }
        match attribute(item, "Format").to_ascii_uppercase().as_str() {
            "XML" | "" => {
                self.budget.take((expected as u64).saturating_mul(8))?;
                let numbers = numbers_of_text(text, expected)?;
                if numbers.len() != expected {
                    return Err(format!("it holds {} numbers, and {expected} are declared", numbers.len()));
                }
                Ok(numbers)
            }
            "HDF" => {
                let Some((place, slab)) = text.split_once('|') else {
                    return self.slab(text, [&[]; 3], expected);
                };
                let part = |text: &str| numbers_of_text(text, 16).and_then(|list| whole(&list));
                let parts: Vec<Vec<u64>> = slab.split(':').map(part).collect::<Result<_, _>>()?;
                let [start, stride, size, ..] = &parts[..] else {
                    return Err(format!("`{slab}` is not a slab of start:stride:count:size"));
                };
                self.slab(place, [start, stride, size], expected)
            }
            other => Err(format!("data in the format `{other}` are not read: expected XML or HDF")),
        }
    }

    /// A slab of a data set by start, stride and size: all of it, or consecutive whole rows.
    fn slab(
        &mut self,
        place: &str,
        [start, stride, size]: [&[u64]; 3],
        expected: usize,
    ) -> Result<Vec<f64>, String> {
        let place = place.trim();
        let (file, inside) = place.split_once(":/").ok_or_else(|| format!("`{place}` names no data set"))?;
        let are_whole_rows =
            start.iter().skip(1).all(|start| *start == 0) && stride.iter().all(|stride| *stride == 1);
        if !are_whole_rows {
            return Err("a slab is read only if it consists of consecutive whole rows".to_owned());
        }
        let rows = start.first().zip(size.first()).map(|(start, size)| (*start, *size));
        let numbers = self.store(beside(self.path, file.trim()))?.numbers(inside, rows)?;
        if numbers.len() != expected {
            return Err(format!("`{place}` has {} numbers, and {expected} are declared", numbers.len()));
        }
        Ok(numbers)
    }

    /// An HDF5 file, opened if it is not open yet.
    fn store(&mut self, file: PathBuf) -> Result<&mut Store, String> {
        if let Some(known) = self.stores.iter().position(|(open, _)| *open == file) {
            self.stores[..=known].rotate_right(1);
        } else {
            let store = Store::open(&file).map_err(|why| format!("{}: {why}", file.display()))?;
            self.stores.truncate(MOST_STORES - 1);
            self.stores.insert(0, (file, store));
        }
        Ok(&mut self.stores[0].1)
    }
}

/// Points of each element of a topology whose name does not say it: as it says itself, or as the shape of its list does.
fn points_per_element(topology: Node, item: Node, kind: &str) -> Result<usize, String> {
    let typed = attribute(topology, "NodesPerElement").parse().ok();
    let of_shape = shape_of(item)?.get(1).copied();
    let usual = if kind == "polyvertex" { Some(1) } else { None };
    let own = typed.or(of_shape).or(usual).filter(|own| *own > 0);
    own.ok_or_else(|| format!("a topology of the type `{kind}` does not state its points per element"))
}

/// The type of a geometry or topology in small letters; older files name the attribute otherwise.
fn type_of(node: Node, older: &str) -> String {
    let newer = attribute(node, "Type");
    (if newer.is_empty() { attribute(node, older) } else { newer }).to_ascii_lowercase()
}

/// Dimensions of an item.
fn shape_of(item: Node) -> Result<Vec<usize>, String> {
    let typed = attribute(item, "Dimensions");
    let shape: Option<Vec<usize>> = typed.split_whitespace().map(|entry| entry.parse().ok()).collect();
    let is_countable =
        |shape: &Vec<usize>| shape.iter().try_fold(1_usize, |all, one| all.checked_mul(*one)).is_some();
    shape.filter(is_countable).ok_or_else(|| format!("the dimensions `{typed}` are invalid: expected counts"))
}
