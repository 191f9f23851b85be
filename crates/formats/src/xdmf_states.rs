//! The states of an XDMF document, each with its mesh: the one that it holds or names, or that of the state before it.
//!
//! A mesh is named as `OpenGeoSys` and meshio do, by an `XInclude` with the places of its elements
//! (`element(/1/1/2/1/2)`) or the name of a grid (`xpointer(//Grid[@Name="mesh"]/*[self::Topology or self::Geometry])`),
//! or as XDMF itself does, by a `Reference` with a path (`/Xdmf/Domain/Grid[1]/Geometry`).

use crate::bytes::short;
use crate::xml::Element;
use std::collections::HashMap;

/// Places among children, from the root on.
type Place = Vec<usize>;

/// A state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Its grid.
    pub grid: Place,
    /// The places of its points, where there are some.
    pub geometry: Option<Place>,
    /// Its cells, where there are some.
    pub topology: Option<Place>,
}

/// The states of a document, in its order.
///
/// # Errors
/// When there is none, or one names a mesh that is not there.
pub fn states_of(root: &Element) -> Result<Vec<State>, String> {
    let mut grids = Vec::new();
    grids_below(root, &mut Vec::new(), &mut grids);
    let mut by_name = HashMap::new();
    for place in &grids {
        if let Some(grid) = root.at(place) {
            by_name.entry(grid.attribute("Name")).or_insert(place);
        }
    }
    let meshes = Meshes { root, by_name };
    let is_collection = |grid: &Element| ["Collection", "Tree"].contains(&grid.attribute("GridType"));
    let singles: Vec<(&Place, &Element)> = grids
        .iter()
        .filter_map(|place| Some((place, root.at(place)?)))
        .filter(|(_, grid)| !is_collection(grid))
        .collect();
    // meshio keeps the mesh as a grid of its own beside the collection.
    let has_times = singles.iter().any(|(_, grid)| grid.child("Time").is_some());
    let alone = [meshes.only("Geometry"), meshes.only("Topology")];
    let mut before: [Option<Place>; 2] = [None, None];
    let mut states = Vec::new();
    for (place, grid) in singles {
        let own = meshes.of(place, grid)?;
        for (own, before) in own.into_iter().zip(&mut before) {
            *before = own.or_else(|| before.take());
        }
        if has_times && grid.child("Time").is_none() {
            continue;
        }
        let [geometry, topology] = [0, 1].map(|part| before[part].clone().or_else(|| alone[part].clone()));
        states.push(State { grid: place.clone(), geometry, topology });
    }
    if states.is_empty() { Err("it has no grid".to_owned()) } else { Ok(states) }
}

/// Places of all grids, in the order of the document.
fn grids_below(element: &Element, at: &mut Place, all: &mut Vec<Place>) {
    for (number, child) in element.children.iter().enumerate() {
        at.push(number);
        if child.name == "Grid" {
            all.push(at.clone());
        }
        grids_below(child, at, all);
        at.pop();
    }
}

/// Where meshes are found.
struct Meshes<'a> {
    root: &'a Element,
    by_name: HashMap<&'a str, &'a Place>,
}

impl Meshes<'_> {
    /// Geometry and topology that a grid holds or names.
    fn of(&self, place: &Place, grid: &Element) -> Result<[Option<Place>; 2], String> {
        let mut own = [None, None];
        for (number, child) in grid.children.iter().enumerate() {
            let named = if child.name.ends_with("include") {
                self.named(child.attribute("xpointer"))?
            } else if part_of(child).is_some() && child.attributes.contains_key("Reference") {
                let typed = Some(child.attribute("Reference")).filter(|typed| *typed != "XML");
                self.named(typed.unwrap_or(child.text.trim()))?
            } else {
                vec![[&place[..], &[number]].concat()]
            };
            for place in named {
                if let Some(part) = self.root.at(&place).and_then(part_of) {
                    own[part] = Some(place);
                }
            }
        }
        Ok(own)
    }

    /// The only element of a name in the document.
    fn only(&self, name: &str) -> Option<Place> {
        let mut all = Vec::new();
        self.root.all(name, &mut all);
        let [element] = all[..] else { return None };
        find(self.root, element, &mut Vec::new())
    }

    /// The elements that a text names.
    fn named(&self, text: &str) -> Result<Vec<Place>, String> {
        let inside = |function: &str| text.strip_prefix(function).and_then(|rest| rest.strip_suffix(')'));
        let found = match (inside("element("), inside("xpointer(")) {
            (Some(places), _) => self.by_places(places),
            (None, Some(path)) => self.by_path(path),
            (None, None) => self.by_path(text),
        };
        let is_mesh = |places: &Vec<Place>| !places.is_empty();
        found
            .filter(is_mesh)
            .ok_or_else(|| format!("a state names its mesh by `{}`, which is not there", short(text)))
    }

    /// `/1/1/2/1/2`: counted from 1, the root first.
    fn by_places(&self, text: &str) -> Option<Vec<Place>> {
        let numbers: Option<Place> = text
            .strip_prefix('/')?
            .split('/')
            .map(|typed| typed.parse::<usize>().ok()?.checked_sub(1))
            .collect();
        let numbers = numbers?;
        let place = numbers.strip_prefix(&[0])?.to_vec();
        self.root.at(&place).map(|element| parts_of(&place, element))
    }

    /// `/Xdmf/Domain/Grid[2]/Geometry`, or `//Grid[@Name="mesh"]` and on.
    fn by_path(&self, text: &str) -> Option<Vec<Place>> {
        let (mut place, rest) = match text.strip_prefix("//Grid[@Name=") {
            Some(rest) => {
                let quote = rest.chars().next().filter(|quote| ['"', '\''].contains(quote))?;
                let (name, rest) = rest.get(1..)?.split_once(quote)?;
                ((*self.by_name.get(name)?).clone(), rest.strip_prefix(']')?)
            }
            None => (Vec::new(), text.strip_prefix(&format!("/{}", self.root.name))?),
        };
        for step in rest.split('/').filter(|step| !step.is_empty()) {
            let element = self.root.at(&place)?;
            if step.starts_with('*') {
                return Some(parts_of(&place, element));
            }
            place.push(child_of(element, step)?);
        }
        let element = self.root.at(&place)?;
        Some(parts_of(&place, element))
    }
}

/// An element that is a part of a mesh, or those parts in it.
fn parts_of(place: &Place, element: &Element) -> Vec<Place> {
    if part_of(element).is_some() {
        return vec![place.clone()];
    }
    let parts = element.children.iter().enumerate().filter(|(_, child)| part_of(child).is_some());
    parts.map(|(number, _)| [&place[..], &[number]].concat()).collect()
}

/// Which part of a mesh an element is.
fn part_of(element: &Element) -> Option<usize> {
    ["Geometry", "Topology"].iter().position(|name| *name == element.name)
}

/// The child that a step of a path names: `Grid`, `Grid[2]`, `Grid[@Name="mesh"]`.
fn child_of(element: &Element, step: &str) -> Option<usize> {
    let (name, which) = step.split_once('[').map_or((step, None), |(name, which)| (name, Some(which)));
    let mut alike = element.children.iter().enumerate().filter(|(_, child)| child.name == name);
    let found = match which.map(|which| which.trim_end_matches(']')) {
        None => alike.next(),
        Some(which) => match which.strip_prefix("@Name=") {
            Some(quoted) => {
                alike.find(|(_, child)| child.attribute("Name") == quoted.trim_matches(['"', '\'']))
            }
            None => alike.nth(which.parse::<usize>().ok()?.checked_sub(1)?),
        },
    };
    found.map(|(number, _)| number)
}

/// The place of an element below another.
fn find(below: &Element, wanted: &Element, at: &mut Place) -> Option<Place> {
    for (number, child) in below.children.iter().enumerate() {
        at.push(number);
        if std::ptr::eq(child, wanted) {
            return Some(at.clone());
        }
        if let Some(found) = find(child, wanted, at) {
            return Some(found);
        }
        at.pop();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::xml::tree_of;

    /// Of each state the words of its geometry and of its topology.
    fn meshes(grids: &str) -> Result<Vec<[String; 2]>, String> {
        let text = format!("<Xdmf><Domain><Information/>{grids}</Domain></Xdmf>");
        let root = tree_of(text.as_bytes()).expect("sound XML");
        let words = |place: &Option<Place>| {
            place.as_ref().map_or("none".to_owned(), |place| root.at(place).expect("an element").text.clone())
        };
        states_of(&root)
            .map(|states| states.iter().map(|one| [words(&one.geometry), words(&one.topology)]).collect())
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
            assert!(meshes(&grids).is_err_and(|why| why.contains("which is not there")), "{absent}");
        }
    }
}
