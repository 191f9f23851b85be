//! Arrays that run over times: which axis is the time, and the state at each.
//!
//! A file with a list of times has arrays `[time][place]`, `[place][time]` or, as a table, one row for each place and time.
//! The axis with the length of the list is that of the times; where two have it, the mapping must say which.

use crate::frame::{Array, Association, Frame};

/// An axis of an array, as a mapping names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Times.
    Time,
    /// Points or cells.
    Place,
    /// Components, of which this one counts.
    Component(usize),
}

/// How a mapping uses an array.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Use {
    /// Its axes, if the mapping names them.
    pub axes: Option<Vec<Axis>>,
    /// Whether the mapping chooses a component of the last axis.
    pub has_component: bool,
    /// Whether it is a quantity, which must have a value at each time and place.
    pub is_quantity: bool,
}

/// Where the times of an array stand.
#[derive(Clone, Debug, PartialEq)]
enum Over {
    /// It is the same at all times.
    Same,
    /// As [`Self::Same`], as a matrix with one row, of all places.
    Row,
    /// Along this axis; the places are along the other one, if there is one.
    Axis(usize),
    /// As [`Self::Axis`], or at all times alike, with components before the places.
    ComponentsFirst(Option<usize>),
    /// Each row has its own time.
    Rows,
}

/// States by time: a frame, the times, and for each array of use where its times stand.
pub struct States<'a> {
    frame: &'a Frame,
    /// Each state's time, and its rows where each row has its own.
    groups: Vec<(f64, Vec<usize>)>,
    over: Vec<(&'a Array, Over)>,
}

/// Finds the states of a frame whose arrays run over a list of times, in the shape of the list; `used` says how the mapping
/// uses an array.
///
/// # Errors
/// Where no axis has the length of the list, or several do, or an array has another shape than it is said to have.
pub fn states_by_time<'a>(
    frame: &'a Frame,
    times: &[f64],
    used: &dyn Fn(&Array) -> Option<Use>,
) -> Result<States<'a>, String> {
    let arrays: Vec<(&Array, Use)> =
        frame.arrays.iter().filter_map(|array| Some((array, used(array)?))).collect();
    if are_rows(&arrays, times) {
        let over = arrays.iter().map(|(array, _)| (*array, rows_of(array, times.len()))).collect();
        return Ok(States { frame, groups: grouped(times), over });
    }
    let places = places_of(frame, &arrays, times.len());
    let mut over = Vec::new();
    for (array, usage) in &arrays {
        over.push((*array, axis_of(array, usage, times.len(), places)?));
    }
    let groups = times.iter().map(|time| (*time, Vec::new())).collect();
    Ok(States { frame, groups, over })
}

/// Whether the arrays are the columns of a table: each as long as the list of times, and of one place each row. A matrix with
/// as many times as places looks alike: its times all differ, and its quantities have a second axis.
fn are_rows(arrays: &[(&Array, Use)], times: &[f64]) -> bool {
    let count = times.len();
    let is_row = |array: &Array| array.on == Association::Whole || array.tuples == count;
    let is_matrix = |(array, usage): &(&Array, Use)| {
        let axes = trimmed(&array.axes());
        usage.axes.is_some() || axes.len() > 2 || (axes.len() == 2 && !usage.has_component)
    };
    let has_flat = arrays.iter().any(|(_, usage)| usage.is_quantity);
    let is_one_each = {
        let mut sorted: Vec<u64> = times.iter().map(|time| time.to_bits()).collect();
        sorted.sort_unstable();
        sorted.dedup();
        sorted.len() == count
    };
    let has_second_axis =
        |(array, usage): &(&Array, Use)| usage.is_quantity && trimmed(&array.axes()).len() > 1;
    has_flat
        && count > 1
        && arrays.iter().all(|(array, _)| is_row(array))
        && !arrays.iter().any(is_matrix)
        && !(is_one_each && arrays.iter().any(has_second_axis))
}

fn rows_of(array: &Array, count: usize) -> Over {
    if array.on != Association::Whole && array.tuples == count { Over::Rows } else { Over::Same }
}

/// Rows of each time, in the order of their first.
fn grouped(times: &[f64]) -> Vec<(f64, Vec<usize>)> {
    let mut known = std::collections::HashMap::new();
    let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
    for (row, time) in times.iter().enumerate() {
        let place = *known.entry(time.to_bits()).or_insert_with(|| {
            groups.push((*time, Vec::new()));
            groups.len() - 1
        });
        groups[place].1.push(row);
    }
    groups
}

/// Axes without those of length 1 at the end.
fn trimmed(axes: &[usize]) -> Vec<usize> {
    let end = axes.iter().rposition(|axis| *axis != 1).map_or(0, |last| last + 1);
    axes[..end.max(1).min(axes.len())].to_vec()
}

/// Number of places, if an array has it: of two axes one has the length of the list of times.
fn places_of(frame: &Frame, arrays: &[(&Array, Use)], count: usize) -> Option<usize> {
    if !frame.coordinates.is_empty() {
        return Some(frame.coordinates.len());
    }
    let of = |(array, usage): &(&Array, Use)| {
        let axes = trimmed(&array.axes());
        let spelled =
            usage.axes.as_ref().and_then(|names| names.iter().position(|axis| *axis == Axis::Place));
        if let Some(place) = spelled {
            return axes.get(place).copied();
        }
        match axes[..] {
            [first, second, ..] if usage.is_quantity && first == count && second != count => Some(second),
            [first, second, ..] if usage.is_quantity && second == count && first != count => Some(first),
            _ => None,
        }
    };
    arrays.iter().find_map(of)
}

/// Where the times of an array stand.
fn axis_of(array: &Array, usage: &Use, count: usize, places: Option<usize>) -> Result<Over, String> {
    let axes = array.axes();
    let name = &array.name;
    if let Some(names) = &usage.axes {
        let of = |is_meant: fn(&Axis) -> bool| names.iter().position(is_meant);
        let component = of(|axis| matches!(axis, Axis::Component(_)));
        let is_first =
            component.is_some_and(|at| of(|axis| *axis == Axis::Place).is_some_and(|place| at < place));
        let Some(place) = of(|axis| *axis == Axis::Time) else {
            return Ok(if is_first { Over::ComponentsFirst(None) } else { Over::Same });
        };
        if trimmed(&axes).len() > names.len() || axes.get(place) != Some(&count) {
            return Err(format!(
                "`{name}` has the shape {}, which is not what the mapping says for {count} times",
                shape_told(&axes)
            ));
        }
        return Ok(if is_first { Over::ComponentsFirst(Some(place)) } else { Over::Axis(place) });
    }
    if array.on == Association::Whole {
        return Ok(Over::Same);
    }
    let lengths = trimmed(&axes);
    // Of an array with a component the last axis is none of time and place; nor is the third.
    let open = if usage.has_component { lengths.len().saturating_sub(1) } else { lengths.len() };
    let are_times: Vec<usize> = (0..open.min(2)).filter(|axis| lengths[*axis] == count).collect();
    // A list of places, of which there are as many as times.
    let is_flat_place = open.max(1) == 1 && places == Some(count) && !usage.is_quantity;
    let is_row = !usage.is_quantity
        && count > 1
        && lengths.first() == Some(&1)
        && lengths.get(1).copied() == places.filter(|places| *places > 1);
    match (&are_times[..], usage.is_quantity) {
        _ if is_flat_place => Ok(Over::Same),
        _ if is_row => Ok(Over::Row),
        ([axis], true) if usage.has_component && lengths.len() == 2 && *axis == 0 && count > 1 => {
            Err(format!(
                "`{name}` has the shape {} for {count} times, and the mapping uses one of its columns: \
                 state which axis is which, \
             `{name}[time, node]` or `{name}[node, time]`",
                shape_told(&axes)
            ))
        }
        ([axis], _) => Ok(Over::Axis(*axis)),
        // A single time leaves nothing to choose.
        ([first, _], _) if count == 1 => Ok(Over::Axis(*first)),
        ([_, _], _) => Err(format!(
            "`{name}` has the shape {} for {count} times and as many places: state which axis is which, \
             `{name}[time, node]` or \
             `{name}[node, time]`",
            shape_told(&axes)
        )),
        (_, true) if count > 1 => {
            let later = lengths.iter().rposition(|axis| *axis == count).filter(|axis| *axis > 0);
            let why = match later {
                Some(axis) if lengths.len() > 2 || usage.has_component => format!(
                    "their number is that of axis {}: state which axis is which, like `{name}[1, node, time]`",
                    axis + 1
                ),
                _ => "no axis has their number".to_owned(),
            };
            Err(format!("`{name}` has the shape {}, and there are {count} times: {why}", shape_told(&axes)))
        }
        _ => Ok(Over::Same),
    }
}

fn shape_told(axes: &[usize]) -> String {
    axes.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ")
}

impl States<'_> {
    /// Number of states.
    pub fn count(&self) -> usize {
        self.groups.len()
    }

    /// The rows of a state, where each row has its own time.
    pub fn rows_of(&self, place: usize) -> &[usize] {
        self.groups.get(place).map_or(&[], |(_, rows)| rows)
    }

    /// A state and its time.
    pub fn state(&self, place: usize) -> Option<(f64, Frame)> {
        let (time, rows) = self.groups.get(place)?;
        let mut frame = Frame {
            time: Some(*time),
            coordinates: self.frame.coordinates.clone(),
            cells: self.frame.cells.clone(),
            ghosts: self.frame.ghosts.clone(),
            units: self.frame.units.clone(),
            fills: self.frame.fills.clone(),
            notes: self.frame.notes.clone(),
            doubts: self.frame.doubts.clone(),
            ..Frame::default()
        };
        for array in &self.frame.arrays {
            let over = self.over.iter().find(|(known, _)| std::ptr::eq(*known, array));
            frame.arrays.push(match over {
                Some((_, Over::Axis(axis))) => at_time(array, *axis, place),
                Some((_, Over::ComponentsFirst(Some(axis)))) => places_first(at_time(array, *axis, place)),
                Some((_, Over::ComponentsFirst(None))) => places_first(array.clone()),
                Some((_, Over::Row)) => at_time(array, 0, 0),
                Some((_, Over::Rows)) => of_rows(array, rows),
                _ => array.clone(),
            });
        }
        frame.place_from_array();
        Some((*time, frame))
    }
}

/// Rows of an array.
fn of_rows(array: &Array, rows: &[usize]) -> Array {
    let tuple = |row: &usize| {
        let from = row * array.components;
        array.values.get(from..from + array.components).unwrap_or_default().to_vec()
    };
    Array {
        values: rows.iter().flat_map(tuple).collect(),
        tuples: rows.len(),
        shape: Vec::new(),
        name: array.name.clone(),
        ..*array
    }
}

/// An array of `[component][place]` as `[place][component]`.
fn places_first(array: Array) -> Array {
    let (components, tuples) = (array.tuples, array.components);
    let value = |at: usize| array.values.get(at % components * tuples + at / components).copied();
    let values = (0..array.values.len()).filter_map(value).collect();
    Array { values, tuples, components, shape: Vec::new(), ..array }
}

/// An array at one place of its axis of times: `[place][component]`.
fn at_time(array: &Array, axis: usize, time: usize) -> Array {
    let axes = array.axes();
    let (before, after) = (&axes[..axis], &axes[axis + 1..]);
    let inner: usize = after.iter().product();
    let outer: usize = before.iter().product();
    let mut values = Vec::with_capacity(if array.values.is_empty() { 0 } else { outer * inner });
    for block in 0..outer {
        let from = (block * axes[axis] + time) * inner;
        values.extend_from_slice(array.values.get(from..from + inner).unwrap_or_default());
    }
    let rest = [before, after].concat();
    let on = if rest.is_empty() { Association::Whole } else { array.on };
    Array {
        name: array.name.clone(),
        on,
        tuples: rest.first().copied().unwrap_or(1),
        components: rest.iter().skip(1).product::<usize>().max(1),
        values,
        shape: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(name: &str, shape: &[usize]) -> Array {
        let count: usize = shape.iter().product();
        Array {
            name: name.to_owned(),
            on: if shape.is_empty() { Association::Whole } else { Association::Points },
            components: shape.iter().skip(1).product::<usize>().max(1),
            tuples: shape.first().copied().unwrap_or(1),
            values: (0..count).map(|number| number as f64).collect(),
            shape: shape.to_vec(),
        }
    }

    /// Values of `p` and `y` at each time, or what is asked.
    fn told(y: &[usize], p: &[usize], times: &[f64], p_use: &Use) -> Result<Vec<[Vec<f64>; 2]>, String> {
        let frame = Frame { arrays: vec![array("y", y), array("p", p)], ..Frame::default() };
        let used = |array: &Array| Some(if array.name == "p" { p_use.clone() } else { Use::default() });
        let states = states_by_time(&frame, times, &used)?;
        let values = |frame: &Frame, name: &str| frame.array(name, None).expect("there").values.clone();
        Ok((0..states.count())
            .map(|place| {
                let (time, frame) = states.state(place).expect("a state");
                assert_eq!(frame.time, Some(time));
                [values(&frame, "y"), values(&frame, "p")]
            })
            .collect())
    }

    #[test]
    fn the_axis_with_the_length_of_the_times_is_theirs_wherever_it_stands() {
        let quantity = || Use { is_quantity: true, ..Use::default() };
        let two = [1.0, 2.0];
        let first = |y: &[f64], p: &[f64]| [y.to_vec(), p.to_vec()];
        for (y, p, at_second) in [
            (&[3][..], &[2, 3][..], first(&[0.0, 1.0, 2.0], &[3.0, 4.0, 5.0])),
            (&[3], &[3, 2], first(&[0.0, 1.0, 2.0], &[1.0, 3.0, 5.0])),
            (&[3], &[2, 3, 1], first(&[0.0, 1.0, 2.0], &[3.0, 4.0, 5.0])),
            (&[2, 3], &[2, 3], first(&[3.0, 4.0, 5.0], &[3.0, 4.0, 5.0])),
            (&[1, 3], &[2, 3], first(&[0.0, 1.0, 2.0], &[3.0, 4.0, 5.0])),
            (&[3], &[3, 2, 2], first(&[0.0, 1.0, 2.0], &[2.0, 3.0, 6.0, 7.0, 10.0, 11.0])),
        ] {
            let found = told(y, p, &two, &quantity()).expect("two states");
            assert_eq!(found.len(), 2, "{p:?}");
            assert_eq!(found[1], at_second, "{y:?} {p:?}");
        }
        // A table: each row has its time.
        let rows = told(&[4], &[4], &[1.0, 2.0, 1.0, 2.0], &quantity()).expect("a table");
        assert_eq!(rows[0], first(&[0.0, 2.0], &[0.0, 2.0]));
        assert_eq!(rows[1], first(&[1.0, 3.0], &[1.0, 3.0]));
        let component = Use { has_component: true, ..quantity() };
        let rows = told(&[4], &[4, 2], &[1.0, 2.0, 1.0, 2.0], &component).expect("a table of vectors");
        assert_eq!(rows[1], first(&[1.0, 3.0], &[2.0, 3.0, 6.0, 7.0]));
        // Where both have it, the mapping must say.
        for (shape, usage) in [(&[2, 2][..], quantity()), (&[2, 2], component), (&[2, 2, 2], quantity())] {
            let asked = told(&[2], shape, &two, &usage);
            assert!(
                asked.as_ref().is_err_and(|why| why.contains("`p[time, node]` or `p[node, time]`")),
                "{asked:?}"
            );
        }
        let said = |axes: &[Axis]| Use { axes: Some(axes.to_vec()), ..quantity() };
        let by_time = told(&[2], &[2, 2], &two, &said(&[Axis::Time, Axis::Place])).expect("said");
        assert_eq!(by_time[1], first(&[0.0, 1.0], &[2.0, 3.0]));
        let by_place = told(&[2], &[2, 2], &two, &said(&[Axis::Place, Axis::Time])).expect("said");
        assert_eq!(by_place[1], first(&[0.0, 1.0], &[1.0, 3.0]));
        // And where none has it, nothing is cut.
        for shape in [&[3][..], &[3, 4], &[1]] {
            let none = told(&[3], shape, &two, &quantity());
            assert!(none.as_ref().is_err_and(|why| why.contains("there are 2 times")), "{none:?}");
        }
        // Components before the places: of two components at three places and two times.
        let axes = [Axis::Component(1), Axis::Place, Axis::Time];
        let turned = told(&[3], &[2, 3, 2], &two, &said(&axes)).expect("said");
        assert_eq!(turned[1], first(&[0.0, 1.0, 2.0], &[1.0, 7.0, 3.0, 9.0, 5.0, 11.0]));
        let constant = told(&[3], &[2, 3], &two, &said(&axes[..2])).expect("said");
        assert_eq!(constant[0][1], [0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
        let component = Use { has_component: true, ..quantity() };
        for (shape, component) in [(&[2, 9, 3][..], &component), (&[4, 9, 3], &quantity())] {
            let asked = told(&[9], shape, &[1.0, 2.0, 3.0], component);
            let is_asked = |why: &String| {
                why.contains("that of axis 3: state which axis is which, like `p[1, node, time]`")
            };
            assert!(asked.as_ref().is_err_and(is_asked), "{asked:?}");
        }
        let wrong = told(&[3], &[3, 2], &two, &said(&[Axis::Time, Axis::Place]));
        assert!(wrong.is_err_and(|why| why.contains("3 x 2")));
        let single = told(&[3], &[1, 3], &[5.0], &quantity()).expect("a single time");
        assert_eq!(single, [first(&[0.0, 1.0, 2.0], &[0.0, 1.0, 2.0])]);
    }
}
