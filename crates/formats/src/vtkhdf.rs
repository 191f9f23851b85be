//! VTKHDF: unstructured grids, one or over time.
//!
//! Format: "VTKHDF File Format", docs.vtk.org. A state consists of parts, each with its own points, cells and offsets;
//! over time all stand one behind the other, and `Steps` says where each begins.

use crate::bytes::whole;
use crate::cells::Cells;
use crate::frame::{Array, Association, Frame, Wanted, points_of};
use crate::hdf5::Store;

/// Begin of every path.
const ROOT: &str = "VTKHDF/";

/// Whether the file has the group.
pub(crate) fn is_layout(store: &Store) -> bool {
    store.paths().any(|path| path.starts_with(ROOT))
}

/// The times of the states.
pub(crate) fn times(store: &mut Store) -> Result<Vec<Option<f64>>, String> {
    let values = format!("{ROOT}Steps/Values");
    let times = if store.has(&values) { store.numbers(&values, None)? } else { Vec::new() };
    Ok(if times.is_empty() { vec![None] } else { times.into_iter().map(Some).collect() })
}

/// Where the parts of a state begin in each list.
#[derive(Clone, Copy, Debug, Default)]
struct Begin {
    part: u64,
    points: u64,
    cells: u64,
    connectivity: u64,
}

/// A state.
pub(crate) fn frame(store: &mut Store, place: usize, wanted: Wanted) -> Result<Frame, String> {
    if !store.has(&format!("{ROOT}Points")) || !store.has(&format!("{ROOT}NumberOfPoints")) {
        return Err("its VTKHDF has no unstructured grid: image data and poly data are not read; write VTU"
            .to_owned());
    }
    let time = times(store)?.get(place).copied().flatten();
    let step = time.map(|_| place as u64);
    let begin = Begin {
        part: of_step(store, "PartOffsets", step)?,
        points: of_step(store, "PointOffsets", step)?,
        cells: of_step(store, "CellOffsets", step)?,
        connectivity: of_step(store, "ConnectivityIdOffsets", step)?,
    };
    let all_parts = store.shape(&format!("{ROOT}NumberOfPoints")).and_then(|shape| shape.first().copied());
    let parts = match step {
        Some(_) if store.has(&format!("{ROOT}Steps/NumberOfParts")) => of_step(store, "NumberOfParts", step)?,
        Some(_) => 1,
        None => all_parts.unwrap_or(0),
    };
    let mut frame = Frame { time, ..Frame::default() };
    let mut cells = Cells::default();
    let counts = |store: &mut Store, name: &str| -> Result<Vec<u64>, String> {
        whole(&store.numbers(&format!("{ROOT}{name}"), Some((begin.part, parts)))?)
    };
    let points = counts(store, "NumberOfPoints")?;
    let (cell_counts, ids) = (counts(store, "NumberOfCells")?, counts(store, "NumberOfConnectivityIds")?);
    let mut at = begin;
    for ((points, count), ids) in points.iter().zip(&cell_counts).zip(&ids) {
        let places = store.numbers(&format!("{ROOT}Points"), Some((at.points, *points)))?;
        let shift = u32::try_from(frame.coordinates.len()).map_err(|_| "too many points")?;
        let part = part_of(store, at, *count, *ids)?;
        part.check(places.len() / 3)?;
        frame.coordinates.extend(points_of(&places, 3));
        cells.append(&part, shift);
        at.part += 1;
        at.points = at.points.saturating_add(*points);
        at.cells = at.cells.saturating_add(*count);
        at.connectivity = at.connectivity.saturating_add(*ids);
    }
    frame.cells = (cells.count() > 0).then_some(cells);
    let totals = [points.iter().sum(), cell_counts.iter().sum()];
    arrays(store, step, begin, totals, wanted, &mut frame)?;
    Ok(frame)
}

/// A number of a step; 0 without a list of it.
fn of_step(store: &mut Store, name: &str, step: Option<u64>) -> Result<u64, String> {
    let path = format!("{ROOT}Steps/{name}");
    match step.filter(|_| store.has(&path)) {
        Some(step) => {
            let found: Vec<u64> = whole(&store.numbers(&path, Some((step, 1)))?)?;
            found.first().copied().ok_or_else(|| format!("`{path}` is empty"))
        }
        None => Ok(0),
    }
}

/// The cells of a part.
fn part_of(store: &mut Store, at: Begin, count: u64, ids: u64) -> Result<Cells, String> {
    // Each part before has one offset more than cells.
    let first = at.cells.saturating_add(at.part);
    let offsets = store.numbers(&format!("{ROOT}Offsets"), Some((first, count.saturating_add(1))))?;
    let offsets: Vec<usize> = whole(&offsets)?;
    Ok(Cells {
        types: whole(&store.numbers(&format!("{ROOT}Types"), Some((at.cells, count)))?)?,
        ends: offsets.get(1..).unwrap_or_default().to_vec(),
        connectivity: whole(&store.numbers(&format!("{ROOT}Connectivity"), Some((at.connectivity, ids)))?)?,
    })
}

/// The arrays at points and cells.
fn arrays(
    store: &mut Store,
    step: Option<u64>,
    begin: Begin,
    totals: [u64; 2],
    wanted: Wanted,
    frame: &mut Frame,
) -> Result<(), String> {
    let [points, cells] = totals;
    for (group, on, first, count) in [
        ("PointData", Association::Points, begin.points, points),
        ("CellData", Association::Cells, begin.cells, cells),
    ] {
        let folder = format!("{ROOT}{group}/");
        let names: Vec<String> =
            store.paths().filter_map(|path| path.strip_prefix(&folder).map(str::to_owned)).collect();
        for name in names {
            let path = format!("{folder}{name}");
            let components = store.shape(&path).and_then(|shape| shape.get(1)).copied().unwrap_or(1).max(1);
            let mut values = Vec::new();
            if wanted.has(&name) {
                let offsets = format!("{group}Offsets/{name}");
                let has_own = step.is_some() && store.has(&format!("{ROOT}Steps/{offsets}"));
                let first = if has_own { of_step(store, &offsets, step)? } else { first };
                values = store.numbers(&path, Some((first, count)))?;
            }
            frame.arrays.push(Array {
                name,
                on,
                components: usize::try_from(components).map_err(|_| "it declares more than it can hold")?,
                tuples: usize::try_from(count).map_err(|_| "it declares more than it can hold")?,
                values,
                shape: Vec::new(),
            });
        }
    }
    Ok(())
}
