//! How a mapping spells an array: `displacement[1]`, `cells:pressure`, `pressure[time, node]`, alternatives behind `|`.

use oedometer_formats::{Association, Axis};

/// Words for the axis of the times.
const TIMES: [&str; 4] = ["time", "times", "t", "step"];
/// Words for the axis of the places.
const PLACES: [&str; 9] =
    ["node", "nodes", "point", "points", "cell", "cells", "element", "elements", "place"];

/// One way to spell a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Spelling<'a> {
    /// What the array is on, if that is said.
    pub on: Option<Association>,
    /// The name of the array.
    pub name: &'a str,
    /// The component that counts, if one is chosen.
    pub component: Option<usize>,
    /// The axes, if they are named.
    pub axes: Option<Vec<Axis>>,
}

/// The alternatives of a name, separated by `|`.
pub fn spellings(typed: &str) -> impl Iterator<Item = Spelling<'_>> {
    typed.split('|').map(|spelled| {
        let (on, rest) = match spelled.split_once(':') {
            Some(("points", rest)) => (Some(Association::Points), rest),
            Some(("cells", rest)) => (Some(Association::Cells), rest),
            _ => (None, spelled),
        };
        // The root of an HDF5.
        let rest = rest.strip_prefix('/').unwrap_or(rest);
        let indexed = rest.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
        let found = indexed.and_then(|(name, inside)| Some((name, axes_of(inside)?)));
        let Some((name, axes)) = found else {
            return Spelling { on, name: rest, component: None, axes: None };
        };
        let component = axes.iter().find_map(|axis| match axis {
            Axis::Component(component) => Some(*component),
            Axis::Time | Axis::Place => None,
        });
        let are_named = axes.iter().any(|axis| matches!(axis, Axis::Time | Axis::Place));
        Spelling { on, name, component, axes: are_named.then_some(axes) }
    })
}

/// The axes in brackets; none where the brackets are a part of the name, as of `Pressure [Pa]`.
fn axes_of(inside: &str) -> Option<Vec<Axis>> {
    let axis = |word: &str| match word.trim() {
        word if TIMES.contains(&word) => Some(Axis::Time),
        word if PLACES.contains(&word) => Some(Axis::Place),
        word => word.parse().ok().map(Axis::Component),
    };
    let axes: Vec<Axis> = inside.split(',').map(axis).collect::<Option<_>>()?;
    let counts = |is_it: fn(&Axis) -> bool| axes.iter().filter(|axis| is_it(axis)).count() <= 1;
    let is_sound = counts(|axis| matches!(axis, Axis::Time))
        && counts(|axis| matches!(axis, Axis::Place))
        && counts(|axis| matches!(axis, Axis::Component(_)));
    is_sound.then_some(axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_what_it_is_on_its_axes_and_its_component() {
        use Axis::{Component, Place, Time};
        for (typed, on, name, component, axes) in [
            ("p", None, "p", None, None),
            ("cells:p", Some(Association::Cells), "p", None, None),
            ("points:u[1]", Some(Association::Points), "u", Some(1), None),
            ("p[time, node]", None, "p", None, Some(vec![Time, Place])),
            ("p[node,time]", None, "p", None, Some(vec![Place, Time])),
            ("u[time, node, 1]", None, "u", Some(1), Some(vec![Time, Place, Component(1)])),
            ("Pressure [Pa]", None, "Pressure [Pa]", None, None),
            ("Z [m]", None, "Z [m]", None, None),
            ("a:b", None, "a:b", None, None),
            ("/fields/u[1]", None, "fields/u", Some(1), None),
            ("p[time, time]", None, "p[time, time]", None, None),
        ] {
            let found = spellings(typed).next().expect("a name");
            assert_eq!(found, Spelling { on, name, component, axes }, "{typed}");
        }
        assert_eq!(spellings("a|b[0]").map(|one| one.name).collect::<Vec<_>>(), ["a", "b"]);
    }
}
