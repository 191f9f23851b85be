//! The states of files whose arrays run over times: which array has the times, and which of the others follow them.

use crate::import::frame_rows::said_unit;
use crate::import::mapping::{Column, Mapping};
use crate::import::said_units::SaidUnit;
use crate::import::spelling::spellings;
use oedometer_formats::{Array, Association, Axis, Frame, ImportError, Step, Use, states_by_time};

/// A state of a frame whose arrays run over times.
pub(super) struct Listed<'a> {
    pub time: f64,
    /// Its place among the times, from 1.
    pub number: usize,
    /// Its rows, where each has its own time.
    pub rows: &'a [usize],
}

/// What is done with a state: its place in a list of times, its frame and how many there are.
pub(super) type TakeState<'a> = dyn FnMut(Option<Listed>, &Frame, usize) -> Result<(), ImportError> + 'a;

/// Hands over the states of a frame, with their time where its arrays run over times, and how many there are.
pub(super) fn each_time(
    step: &Step,
    frame: &Frame,
    mapping: &Mapping,
    notes: &mut Vec<String>,
    take: &mut TakeState<'_>,
) -> Result<(), ImportError> {
    let refused = |why: String| ImportError::content(&step.file, why);
    let times = times_in(frame, mapping, notes);
    if times.is_empty() {
        let names_time = |column: Column| {
            let spelled = mapping.columns.get(column).into_iter().flat_map(|typed| spellings(typed));
            spelled.filter_map(|spelled| spelled.axes).any(|axes| axes.contains(&Axis::Time))
        };
        if Column::ALL.into_iter().any(names_time) {
            return Err(refused("its times are not known: name their array as `t` in [columns]".to_owned()));
        }
        return take(None, frame, 1);
    }
    let used = |array: &Array| use_of(array, frame, mapping);
    let states = states_by_time(frame, &times, &used).map_err(refused)?;
    for place in 0..states.count() {
        if let Some((time, frame)) = states.state(place) {
            let listed = Listed { time, number: place + 1, rows: states.rows_of(place) };
            take(Some(listed), &frame, states.count())?;
        }
    }
    Ok(())
}

/// The times over which the arrays of a frame run, in the mapping's unit: those of the array that the mapping names, or of the
/// file's own list.
fn times_in(frame: &Frame, mapping: &Mapping, notes: &mut Vec<String>) -> Vec<f64> {
    let mut in_unit = |array: &str, times: Vec<f64>| match said_unit(frame, array, Column::Time, mapping) {
        SaidUnit::Factor(factor, note) => {
            notes.push(note);
            times.into_iter().map(|time| time * factor).collect()
        }
        SaidUnit::AsMapped | SaidUnit::Unfit(_) => times,
    };
    let spelled = mapping.columns.t.as_deref().into_iter().flat_map(spellings);
    let of_array = |array: &Array, component: Option<usize>| -> Vec<f64> {
        array
            .values
            .iter()
            .skip(component.unwrap_or(0))
            .step_by(component.map_or(1, |_| array.components))
            .copied()
            .collect()
    };
    let named = spelled
        .filter_map(|spelled| Some((frame.array(spelled.name, spelled.on)?, spelled.component)))
        .find(|(array, _)| !array.values.is_empty());
    match named {
        // Each point of a mesh has the time of its state.
        Some((array, _)) if array.on != Association::Whole && frame.cells.is_some() => Vec::new(),
        Some((array, component)) => {
            let times = of_array(array, component);
            if times.len() > 1 || !frame.times.is_empty() { in_unit(&array.name, times) } else { Vec::new() }
        }
        None => {
            let is_list =
                |array: &&Array| array.values == frame.times && frame.units.contains_key(&array.name);
            let name = frame.arrays.iter().find(is_list).map_or("", |array| &array.name);
            in_unit(name, frame.times.clone())
        }
    }
}

/// How the mapping uses an array, if it does.
fn use_of(array: &Array, frame: &Frame, mapping: &Mapping) -> Option<Use> {
    let mut found: Option<Use> = None;
    let id = mapping.displacement.as_ref().and_then(|source| source.id.as_ref());
    let columns = Column::ALL.into_iter().filter(|column| *column != Column::Time);
    let columns =
        columns.filter_map(|column| Some((mapping.columns.get(column)?, column.quantity().is_some())));
    let others = id.into_iter().chain(mapping.rows.equals.keys()).map(|typed| (typed, false));
    for (typed, is_quantity) in columns.chain(others) {
        // The first alternative that is there is the one that is read.
        let first = spellings(typed).find(|spelled| frame.array(spelled.name, spelled.on).is_some());
        let Some(spelled) = first.filter(|spelled| {
            frame.array(spelled.name, spelled.on).is_some_and(|named| std::ptr::eq(named, array))
        }) else {
            continue;
        };
        let usage = found.get_or_insert_default();
        usage.is_quantity |= is_quantity;
        usage.has_component |= spelled.component.is_some();
        usage.axes = usage.axes.take().or(spelled.axes);
    }
    found
}
