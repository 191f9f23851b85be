//! The states of an XDMF document and the mesh of each: its own, one that it refers to, or that of the state before.
//!
//! A state refers to a mesh by an `XInclude` or, as XDMF itself does, by a `Reference` with a path (`xpath`). Programs that
//! write one temporal collection per function have several grids for a time: they are one state. Grids of a spatial
//! collection are its parts.

use crate::bytes::{excerpt, numbers_of_text};
use crate::collections::time_of;
use crate::xml::{all, attribute, child};
use crate::xpath::Pointers;
use roxmltree::{Document, Node, NodeId};
use std::collections::HashMap;

/// Parts of a mesh.
const PARTS: [&str; 2] = ["Geometry", "Topology"];
/// Most times of a collection.
const MOST_TIMES: usize = 1_000_000;
/// Deepest nesting of collections.
const DEEPEST: usize = 64;

/// A state.
#[derive(Clone, Debug)]
pub(crate) struct State<'a> {
    /// Its time, if it has one.
    pub time: Option<f64>,
    /// Its parts, one unless a spatial collection has several.
    pub parts: Vec<Part<'a>>,
    /// Other functions of the state, with their meshes.
    pub beside: Vec<Part<'a>>,
    /// Collections that its grids are of.
    collections: Vec<Option<NodeId>>,
}

/// A mesh with the grids that have arrays on it.
#[derive(Clone, Debug)]
pub(crate) struct Part<'a> {
    /// The grids.
    pub grids: Vec<Node<'a, 'a>>,
    /// The places of its points, if there are any.
    pub geometry: Option<Node<'a, 'a>>,
    /// Its cells, if there are any.
    pub topology: Option<Node<'a, 'a>>,
}

/// A grid without grids in it.
struct Leaf<'a> {
    grid: Node<'a, 'a>,
    time: Option<f64>,
    /// The collection of times that it is of.
    collection: Option<NodeId>,
    /// The spatial collection that it is a part of.
    body: Option<NodeId>,
}

/// The states of a document, in its order. Each reference must point at a mesh.
pub(crate) fn states_of<'a>(document: &'a Document<'a>) -> Result<Vec<State<'a>>, String> {
    let mut leaves = Vec::new();
    for domain in document.root_element().children().filter(|node| node.has_tag_name("Domain")) {
        for grid in grids_in(domain) {
            add_leaves(grid, None, None, None, 0, &mut leaves)?;
        }
    }
    // meshio writes the mesh as a grid of its own beside the collection.
    let has_times = leaves.iter().any(|leaf| leaf.time.is_some());
    let only = PARTS.map(|name| {
        let mut parts = all(document.root(), name);
        parts.next().filter(|_| parts.next().is_none())
    });
    let mut pointers = Pointers::of(document);
    let mut found_before = HashMap::new();
    let mut latest = [None, None];
    let mut states: Vec<State> = Vec::new();
    let mut by_time: HashMap<u64, usize> = HashMap::new();
    for leaf in leaves {
        for part in mesh_parts(leaf.grid, &mut pointers, &mut found_before)? {
            latest[usize::from(part.has_tag_name(PARTS[1]))] = Some(part);
        }
        if has_times && leaf.time.is_none() {
            continue;
        }
        let [geometry, topology] = [0, 1].map(|part| latest[part].or(only[part]));
        let part = Part { grids: vec![leaf.grid], geometry, topology };
        let known = leaf.time.and_then(|time| by_time.get(&time.to_bits())).copied();
        match known.map(|place| &mut states[place]) {
            Some(state) if leaf.body.is_some() || !state.collections.contains(&leaf.collection) => {
                state.add(part, &leaf);
            }
            _ => {
                if let Some(time) = leaf.time {
                    by_time.insert(time.to_bits(), states.len());
                }
                let collections = vec![leaf.collection];
                states.push(State { time: leaf.time, parts: vec![part], beside: Vec::new(), collections });
            }
        }
    }
    if states.is_empty() { Err("it has no grid".to_owned()) } else { Ok(states) }
}

impl<'a> State<'a> {
    /// Adds a grid of the same time: to the part of its mesh, as a part of a spatial collection, or beside them.
    fn add(&mut self, part: Part<'a>, leaf: &Leaf<'a>) {
        let is_same = |known: &&mut Part| (known.geometry, known.topology) == (part.geometry, part.topology);
        if !self.collections.contains(&leaf.collection) {
            self.collections.push(leaf.collection);
        }
        match self.parts.iter_mut().chain(&mut self.beside).find(is_same) {
            Some(known) => known.grids.extend(part.grids),
            None if leaf.body.is_some() => self.parts.push(part),
            None => self.beside.push(part),
        }
    }
}

fn grids_in<'a>(node: Node<'a, 'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(|child| child.has_tag_name("Grid"))
}

/// Adds the grids in a grid, each with its time: its own, that of its collection's list, or that of the collection.
fn add_leaves<'a>(
    grid: Node<'a, 'a>,
    time: Option<f64>,
    collection: Option<NodeId>,
    body: Option<NodeId>,
    depth: usize,
    leaves: &mut Vec<Leaf<'a>>,
) -> Result<(), String> {
    if depth > DEEPEST {
        return Err("its collections are too deep".to_owned());
    }
    let kind = attribute(grid, "GridType");
    if !["Collection", "Tree"].contains(&kind) {
        let own = time_in(grid)?.first().copied();
        leaves.push(Leaf { grid, time: own.or(time), collection, body });
        return Ok(());
    }
    let is_body = attribute(grid, "CollectionType") == "Spatial" || kind == "Tree";
    let times = time_in(grid)?;
    for (place, inside) in grids_in(grid).enumerate() {
        if is_body {
            let own = times.first().copied().or(time);
            add_leaves(inside, own, collection, Some(grid.id()), depth + 1, leaves)?;
        } else {
            let own = times.get(place).copied().or(time);
            add_leaves(inside, own, Some(grid.id()), None, depth + 1, leaves)?;
        }
    }
    Ok(())
}

/// The times that a grid declares: one, a list, or a start, a step and a count.
fn time_in(grid: Node) -> Result<Vec<f64>, String> {
    let Some(time) = child(grid, "Time") else { return Ok(Vec::new()) };
    if time.has_attribute("Value") {
        return Ok(vec![time_of(attribute(time, "Value"))?]);
    }
    let text = child(time, "DataItem").map_or_else(|| text_of(time), text_of);
    let numbers = numbers_of_text(&text, MOST_TIMES)?;
    if numbers.iter().any(|time| !time.is_finite()) {
        return Err("one of its times is not finite".to_owned());
    }
    if attribute(time, "TimeType") != "HyperSlab" {
        return Ok(numbers);
    }
    let [start, step, count] = numbers[..] else {
        return Err("a slab of times needs a start, a step and a count".to_owned());
    };
    if !(0.0..=MOST_TIMES as f64).contains(&count) {
        return Err(format!("a slab of {count} times is invalid"));
    }
    Ok((0..=MOST_TIMES)
        .map(|place| place as f64)
        .take_while(|place| *place < count)
        .map(|place| start + step * place)
        .collect())
}

/// All of the text in an element, also where an entity stands in it.
pub(crate) fn text_of(node: Node) -> String {
    node.children().filter(Node::is_text).filter_map(|part| part.text()).collect()
}

/// Geometry and topology that a grid contains or refers to.
fn mesh_parts<'a>(
    grid: Node<'a, 'a>,
    pointers: &mut Pointers<'a>,
    found_before: &mut HashMap<String, Vec<Node<'a, 'a>>>,
) -> Result<Vec<Node<'a, 'a>>, String> {
    let mut parts = Vec::new();
    for element in grid.children().filter(Node::is_element) {
        let pointer = if element.has_tag_name("include") {
            if !attribute(element, "href").is_empty() {
                let file = excerpt(attribute(element, "href"));
                return Err(format!(
                    "a state refers to the mesh in another file, `{file}`, which is not read"
                ));
            }
            attribute(element, "xpointer").to_owned()
        } else if !is_part(&element) {
            continue;
        } else {
            match element.attribute("Reference") {
                None => {
                    parts.push(element);
                    continue;
                }
                Some("XML") => text_of(element).trim().to_owned(),
                Some(path) => path.to_owned(),
            }
        };
        if !found_before.contains_key(&pointer) {
            let found = pointers.elements(&pointer);
            found_before.insert(pointer.clone(), parts_of(&found));
        }
        let found = &found_before[&pointer];
        if found.is_empty() {
            return Err(format!("a state refers to the mesh `{}`, which is missing", excerpt(&pointer)));
        }
        parts.extend(found);
    }
    Ok(parts)
}

/// The elements that are parts of a mesh, or those of their children that are. Of several meshes the first.
fn parts_of<'a>(elements: &[Node<'a, 'a>]) -> Vec<Node<'a, 'a>> {
    let inside = |element: &Node<'a, 'a>| -> Vec<Node<'a, 'a>> {
        if is_part(element) { vec![*element] } else { element.children().filter(is_part).collect() }
    };
    let all: Vec<Node> = elements.iter().flat_map(inside).collect();
    PARTS.iter().filter_map(|name| all.iter().find(|part| part.has_tag_name(*name)).copied()).collect()
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
        Ok(states
            .iter()
            .map(|state| [text(state.parts[0].geometry), text(state.parts[0].topology)])
            .collect())
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
