//! Exodus II in netCDF-4, which is HDF5: nodes, blocks of elements, variables at both.
//!
//! Format: "EXODUS: A Finite Element Data Model", SAND2022-0004.

use crate::bytes::whole;
use crate::cells::Cells;
use crate::frame::{Array, Association, Frame, Wanted};
use crate::hdf5::Store;

/// Most blocks of elements that are looked for.
const MOST_BLOCKS: usize = 10_000;

/// Elements in a plane by their number of nodes: type of VTK.
const FLAT: [(usize, u8); 7] = [(1, 1), (2, 3), (3, 5), (4, 9), (6, 22), (8, 23), (9, 28)];
/// Elements in space.
const SOLID: [(usize, u8); 11] =
    [(1, 1), (2, 3), (4, 10), (5, 14), (6, 13), (8, 12), (10, 24), (13, 27), (15, 26), (20, 25), (27, 29)];

/// Whether the data sets are those of Exodus.
pub(crate) fn is_layout(store: &Store) -> bool {
    let has_places = store.has("coordx") || store.has("coordy") || store.has("coord");
    has_places && (store.has("time_whole") || store.has("connect1"))
}

/// The times of the states.
pub(crate) fn times(store: &mut Store) -> Result<Vec<Option<f64>>, String> {
    let times = if store.has("time_whole") { store.numbers("time_whole", None)? } else { Vec::new() };
    Ok(if times.is_empty() { vec![None] } else { times.into_iter().map(Some).collect() })
}

/// A state.
pub(crate) fn frame(store: &mut Store, place: usize, wanted: Wanted) -> Result<Frame, String> {
    let time = times(store)?.get(place).copied().flatten();
    let coordinates = coordinates(store)?;
    let is_flat = coordinates.iter().all(|place| place[2] == 0.0);
    let mut frame = Frame { time, coordinates, ..Frame::default() };
    let nodes = frame.coordinates.len();
    let blocks: Vec<usize> =
        (1..=MOST_BLOCKS).take_while(|block| store.has(&format!("connect{block}"))).collect();
    let mut cells = Cells::default();
    let mut lengths = Vec::new();
    for block in &blocks {
        let part = block_of(store, *block, is_flat)?;
        lengths.push(part.count());
        cells.append(&part, 0);
    }
    cells.check(nodes)?;
    frame.cells = (cells.count() > 0).then_some(cells);
    at_nodes(store, place, wanted, &mut frame)?;
    at_elements(store, place, wanted, &blocks, &lengths, &mut frame)?;
    Ok(frame)
}

fn coordinates(store: &mut Store) -> Result<Vec<[f64; 3]>, String> {
    let mut axes = Vec::new();
    if let Some(shape) = store.shape("coord").map(<[u64]>::to_vec) {
        let [count, _] = shape[..] else { return Err("`coord` does not have two axes".to_owned()) };
        for axis in 0..count.min(3) {
            axes.push(store.numbers("coord", Some((axis, 1)))?);
        }
    } else {
        for name in ["coordx", "coordy", "coordz"] {
            axes.push(if store.has(name) { store.numbers(name, None)? } else { Vec::new() });
        }
    }
    let nodes = axes.iter().map(Vec::len).max().unwrap_or(0);
    let at =
        |axis: usize, node: usize| axes.get(axis).and_then(|axis| axis.get(node)).copied().unwrap_or(0.0);
    Ok((0..nodes).map(|node| [at(0, node), at(1, node), at(2, node)]).collect())
}

/// The elements of a block, whose nodes are counted from 1.
fn block_of(store: &mut Store, block: usize, is_flat: bool) -> Result<Cells, String> {
    let name = format!("connect{block}");
    let shape = store.shape(&name).map(<[u64]>::to_vec).unwrap_or_default();
    let list: Vec<u32> = whole(&store.numbers(&name, None)?)?;
    let own = shape.get(1).and_then(|own| usize::try_from(*own).ok()).filter(|own| *own > 0);
    let own = own.ok_or_else(|| format!("`{name}` lacks the number of nodes per element"))?;
    let known = if is_flat { &FLAT[..] } else { &SOLID[..] };
    let types = known.iter().find(|(nodes, _)| *nodes == own).map(|(_, types)| *types);
    let types = types.ok_or_else(|| format!("`{name}` has elements of {own} nodes, which are not read"))?;
    let count = list.len() / own;
    let connectivity: Option<Vec<u32>> = list.iter().map(|node| node.checked_sub(1)).collect();
    Ok(Cells {
        types: vec![types; count],
        ends: (1..=count).map(|cell| cell * own).collect(),
        connectivity: connectivity.ok_or_else(|| format!("`{name}` names the node 0"))?,
    })
}

/// The variables at nodes.
fn at_nodes(store: &mut Store, place: usize, wanted: Wanted, frame: &mut Frame) -> Result<(), String> {
    if !store.has("name_nod_var") {
        return Ok(());
    }
    let names = store.texts("name_nod_var")?;
    let nodes = frame.coordinates.len();
    for (number, name) in names.into_iter().enumerate() {
        let own = format!("vals_nod_var{}", number + 1);
        let mut values = Vec::new();
        let mut components = 1;
        if store.has(&own) {
            components = store.shape(&own).and_then(|shape| shape.get(2)).map_or(1, |count| *count);
            if wanted.has(&name) {
                values = store.numbers(&own, Some((place as u64, 1)))?;
            }
        } else if store.has("vals_nod_var") && wanted.has(&name) {
            // Of all variables in one, as older files have it.
            let all = store.numbers("vals_nod_var", Some((place as u64, 1)))?;
            values = all.get(number * nodes..(number + 1) * nodes).unwrap_or_default().to_vec();
        }
        let components = usize::try_from(components).unwrap_or(1).max(1);
        if !values.is_empty() && values.len() != nodes * components {
            return Err(format!("the variable `{name}` has {} numbers at {nodes} nodes", values.len()));
        }
        frame.arrays.push(Array {
            name,
            on: Association::Points,
            components,
            tuples: nodes,
            values,
            shape: Vec::new(),
        });
    }
    Ok(())
}

/// The variables of elements, one block behind the other; a block may lack one.
fn at_elements(
    store: &mut Store,
    place: usize,
    wanted: Wanted,
    blocks: &[usize],
    lengths: &[usize],
    frame: &mut Frame,
) -> Result<(), String> {
    if !store.has("name_elem_var") {
        return Ok(());
    }
    for (number, name) in store.texts("name_elem_var")?.into_iter().enumerate() {
        let mut values = Vec::new();
        for (block, length) in blocks.iter().zip(lengths).filter(|_| wanted.has(&name)) {
            let own = format!("vals_elem_var{}eb{block}", number + 1);
            if store.has(&own) {
                let part = store.numbers(&own, Some((place as u64, 1)))?;
                if part.len() != *length {
                    return Err(format!("`{own}` has {} numbers for {length} elements", part.len()));
                }
                values.extend(part);
            } else {
                values.resize(values.len() + length, f64::NAN);
            }
        }
        let tuples = lengths.iter().sum();
        frame.arrays.push(Array {
            name,
            on: Association::Cells,
            components: 1,
            tuples,
            values,
            shape: Vec::new(),
        });
    }
    Ok(())
}
