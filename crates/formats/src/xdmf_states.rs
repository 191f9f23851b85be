//! The states of an XDMF document and the mesh of each: its own, one that it refers to, or that of the state before.
//!
//! A state refers to a mesh as `OpenGeoSys` and meshio do, by an `XInclude` with the position of its elements
//! (`element(/1/1/2/1/2)`) or the name of a grid (`xpointer(//Grid[@Name="mesh"]/*[self::Topology or self::Geometry])`),
//! or as XDMF itself does, by a `Reference` with a path (`/Xdmf/Domain/Grid[1]/Geometry`).

use crate::bytes::excerpt;
use crate::xml::{all, attribute, child};
use roxmltree::{Document, Node};
use std::collections::HashMap;

/// Parts of a mesh.
const PARTS: [&str; 2] = ["Geometry", "Topology"];

/// A state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State<'a> {
    /// Its grid.
    pub grid: Node<'a, 'a>,
    /// The places of its points, if there are any.
    pub geometry: Option<Node<'a, 'a>>,
    /// Its cells, if there are any.
    pub topology: Option<Node<'a, 'a>>,
}

/// The states of a document, in its order. Each reference must point at a mesh.
pub(crate) fn states_of<'a>(document: &'a Document<'a>) -> Result<Vec<State<'a>>, String> {
    let is_state = |grid: &Node| !["Collection", "Tree"].contains(&attribute(*grid, "GridType"));
    let grids: Vec<Node> = all(document.root(), "Grid").filter(is_state).collect();
    // meshio writes the mesh as a grid of its own beside the collection.
    let has_times = grids.iter().any(|grid| child(*grid, "Time").is_some());
    let only = PARTS.map(|name| {
        let mut parts = all(document.root(), name);
        parts.next().filter(|_| parts.next().is_none())
    });
    let mut found_before = HashMap::new();
    let mut latest = [None, None];
    let mut states = Vec::new();
    for grid in grids {
        for part in mesh_parts(grid, &mut found_before)? {
            latest[usize::from(part.has_tag_name(PARTS[1]))] = Some(part);
        }
        if !has_times || child(grid, "Time").is_some() {
            let [geometry, topology] = [0, 1].map(|part| latest[part].or(only[part]));
            states.push(State { grid, geometry, topology });
        }
    }
    if states.is_empty() { Err("it has no grid".to_owned()) } else { Ok(states) }
}

/// Geometry and topology that a grid contains or refers to.
fn mesh_parts<'a>(
    grid: Node<'a, 'a>,
    found_before: &mut HashMap<&'a str, Vec<Node<'a, 'a>>>,
) -> Result<Vec<Node<'a, 'a>>, String> {
    let mut parts = Vec::new();
    for element in grid.children().filter(Node::is_element) {
        let pointer = if element.has_tag_name("include") {
            attribute(element, "xpointer")
        } else if !is_part(&element) {
            continue;
        } else {
            match element.attribute("Reference") {
                None => {
                    parts.push(element);
                    continue;
                }
                Some("XML") => element.text().unwrap_or_default().trim(),
                Some(path) => path,
            }
        };
        if !found_before.contains_key(pointer) {
            let found = referenced(grid.document(), pointer).map(parts_of).unwrap_or_default();
            found_before.insert(pointer, found);
        }
        let found = &found_before[pointer];
        if found.is_empty() {
            return Err(format!("a state refers to the mesh `{}`, which is missing", excerpt(pointer)));
        }
        parts.extend(found);
    }
    Ok(parts)
}

/// The element that a pointer or a path leads to.
fn referenced<'a>(document: &'a Document<'a>, pointer: &str) -> Option<Node<'a, 'a>> {
    let inside = |function: &str| pointer.strip_prefix(function)?.strip_suffix(')');
    if let Some(places) = inside("element(") {
        // `/1/1/2`: counted from 1, the root first.
        let step = |element: Node<'a, 'a>, place: &str| {
            let place = place.parse::<usize>().ok()?.checked_sub(1)?;
            element.children().filter(Node::is_element).nth(place)
        };
        return places.strip_prefix('/')?.split('/').try_fold(document.root(), step);
    }
    let path = inside("xpointer(").unwrap_or(pointer);
    let (start, rest) = match path.strip_prefix("//") {
        Some(path) => {
            let end = path.find(']').map_or(path.len(), |end| end + 1);
            let (step, rest) = path.split_at(end);
            (select(document.root().descendants(), step)?, rest)
        }
        None => (document.root(), path),
    };
    let steps = rest.split('/').filter(|step| !step.is_empty()).take_while(|step| !step.starts_with('*'));
    steps.into_iter().try_fold(start, |element, step| select(element.children(), step))
}

/// The element that a step of a path selects: `Grid`, `Grid[2]`, `Grid[@Name="mesh"]`.
fn select<'a>(mut elements: impl Iterator<Item = Node<'a, 'a>>, step: &str) -> Option<Node<'a, 'a>> {
    let (name, which) = step.trim_end_matches(']').split_once('[').unwrap_or((step, "1"));
    let mut alike = elements.by_ref().filter(|element| element.has_tag_name(name));
    match which.strip_prefix("@Name=") {
        Some(quoted) => {
            let wanted = quoted.trim_matches(['"', '\'']);
            alike.find(|element| attribute(*element, "Name") == wanted)
        }
        None => alike.nth(which.parse::<usize>().ok()?.checked_sub(1)?),
    }
}

/// An element that is a part of a mesh, or those of its children that are.
fn parts_of<'a>(element: Node<'a, 'a>) -> Vec<Node<'a, 'a>> {
    if is_part(&element) { vec![element] } else { element.children().filter(is_part).collect() }
}

fn is_part(element: &Node) -> bool {
    PARTS.iter().any(|name| element.has_tag_name(*name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::xml::parse;

    /// The texts of the geometry and the topology of each state.
    fn meshes(grids: &str) -> Result<Vec<[String; 2]>, String> {
        let text = format!("<Xdmf xmlns:xi=\"x\"><Domain><Information/>{grids}</Domain></Xdmf>");
        let document = parse(&text).expect("XML");
        let text = |part: Option<Node>| part.map_or("none", |part| part.text().expect("a text")).to_owned();
        let states = states_of(&document)?;
        Ok(states.iter().map(|state| [text(state.geometry), text(state.topology)]).collect())
    }

    const HELD: &str = "<Grid Name=\"one\"><Time Value=\"1\"/><Geometry>a</Geometry><Topology>A</Topology></Grid>\
                        <Grid Name=\"two\"><Time Value=\"2\"/><Geometry>b</Geometry><Topology>B</Topology></Grid>";

    #[test]
    fn a_state_has_the_mesh_that_it_names_or_that_of_the_state_before() {
        for (third, mesh) in [
            ("", ["b", "B"]),
            (
                "<xi:include xpointer=\"element(/1/1/2/2)\"/><xi:include xpointer=\"element(/1/1/2/3)\"/>",
                ["a", "A"],
            ),
            ("<xi:include xpointer=\"element(/1/1/3/2)\"/>", ["b", "B"]),
            (
                "<xi:include xpointer='xpointer(//Grid[@Name=\"one\"]/*[self::Topology or self::Geometry])'/>",
                ["a", "A"],
            ),
            ("<Geometry Reference=\"XML\">/Xdmf/Domain/Grid[1]/Geometry</Geometry>", ["a", "B"]),
            ("<Geometry Reference=\"/Xdmf/Domain/Grid[@Name='one']/Geometry\"/>", ["a", "B"]),
            ("<Topology>C</Topology>", ["b", "C"]),
        ] {
            let grids =
                format!("{HELD}<Grid><Time Value=\"3\"/>{third}</Grid><Grid><Time Value=\"4\"/></Grid>");
            let found = meshes(&grids).expect("states");
            assert_eq!(found[..2], [["a", "A"], ["b", "B"]].map(|pair| pair.map(str::to_owned)), "{third}");
            assert_eq!(found[2], mesh, "{third}");
            assert_eq!(found[3], mesh, "the one before it: {third}");
        }
    }

    #[test]
    fn a_mesh_behind_its_states_is_theirs_where_it_is_the_only_one_or_named() {
        let state = "<Grid GridType=\"Collection\"><Grid><Time Value=\"1\"/></Grid></Grid>";
        let mesh = "<Grid Name=\"mesh\"><Geometry>a</Geometry><Topology>A</Topology></Grid>";
        assert_eq!(meshes(&format!("{state}{mesh}")).expect("a state"), [["a", "A"]]);
        let two = format!("{state}{mesh}{}", mesh.replace("mesh", "other"));
        assert_eq!(meshes(&two).expect("a state"), [["none", "none"]], "nobody says which");
        let named = state.replace(
            "</Grid></Grid>",
            "<xi:include xpointer=\"xpointer(//Grid[@Name='mesh']/*)\"/></Grid></Grid>",
        );
        let named = format!("{named}{mesh}{}", mesh.replace("mesh", "other"));
        assert_eq!(meshes(&named).expect("a state"), [["a", "A"]]);
        for absent in ["element(/1/1/9/2)", "xpointer(//Grid[@Name='mash']/*)", "range(1)", "element(/2/1)"] {
            let grids = format!("{HELD}<Grid><Time Value=\"3\"/><xi:include xpointer=\"{absent}\"/></Grid>");
            assert!(meshes(&grids).is_err_and(|why| why.contains("which is missing")), "{absent}");
        }
    }
}
