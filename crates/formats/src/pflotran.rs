//! PFLOTRAN's HDF5: a group per time (`Time:  4.08750E+00 s`), with values in the cells of a grid whose planes stand in
//! `Coordinates/X [m]`, `Y [m]` and `Z [m]`.

use crate::frame::{Array, Association, Frame, Wanted};
use crate::hdf5::Store;

/// Begin of the groups of a time.
const GROUP: &str = "Time:";
/// Planes of the grid along each axis.
const PLANES: [&str; 3] = ["Coordinates/X [m]", "Coordinates/Y [m]", "Coordinates/Z [m]"];

/// The groups of times with their times in the file's unit, by time.
fn groups(store: &Store) -> Vec<(f64, String)> {
    let mut groups: Vec<(f64, String)> = Vec::new();
    for path in store.paths() {
        let Some((group, _)) = path.split_once('/') else { continue };
        let Some(time) =
            group.strip_prefix(GROUP).and_then(|rest| rest.split_whitespace().next()?.parse().ok())
        else {
            continue;
        };
        if groups.last().is_none_or(|(_, last)| last != group) {
            groups.push((time, group.to_owned()));
        }
    }
    groups.sort_by(|a, b| a.0.total_cmp(&b.0));
    groups
}

/// Whether the file has planes of a grid and groups of times.
pub(crate) fn is_layout(store: &Store) -> bool {
    PLANES.iter().all(|name| store.has(name)) && !groups(store).is_empty()
}

/// The times of the states.
pub(crate) fn times(store: &Store) -> Vec<Option<f64>> {
    groups(store).into_iter().map(|(time, _)| Some(time)).collect()
}

/// A state: the centres of the cells are its points.
pub(crate) fn frame(store: &mut Store, place: usize, wanted: Wanted) -> Result<Frame, String> {
    let (time, group) = groups(store).into_iter().nth(place).ok_or("it has no such time")?;
    let mut centres = Vec::new();
    for name in PLANES {
        let planes = store.numbers(name, None)?;
        centres.push(planes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect::<Vec<f64>>());
    }
    let [x, y, z] = [0, 1, 2].map(|axis| centres[axis].len());
    let all = x.checked_mul(y).and_then(|all| all.checked_mul(z)).filter(|all| *all <= 100_000_000);
    let all = all.ok_or("its grid has more cells than any file")?;
    // The last axis is the fastest.
    let at = |cell: usize| [centres[0][cell / (y * z)], centres[1][cell / z % y], centres[2][cell % z]];
    let coordinates: Vec<[f64; 3]> = (0..all).map(at).collect();
    let array = |name: &str, on, values: Vec<f64>| Array {
        name: name.to_owned(),
        on,
        components: 1,
        tuples: if on == Association::Whole { 1 } else { all },
        values,
        shape: Vec::new(),
    };
    let mut arrays = vec![array("Time", Association::Whole, vec![time])];
    for (axis, name) in PLANES.into_iter().enumerate() {
        let values = coordinates.iter().map(|place| place[axis]).collect();
        arrays.push(array(name, Association::Points, values));
    }
    let begin = format!("{group}/");
    let own: Vec<String> =
        store.paths().filter_map(|path| path.strip_prefix(&begin).map(str::to_owned)).collect();
    for name in own {
        let mut values = Vec::new();
        if wanted.has(&name) {
            values = store.numbers(&format!("{begin}{name}"), None)?;
            if values.len() != all {
                return Err(format!("`{name}` has {} numbers, and the grid has {all} cells", values.len()));
            }
        }
        arrays.push(array(&name, Association::Points, values));
    }
    Ok(Frame { time: Some(time), coordinates, arrays, ..Frame::default() })
}
