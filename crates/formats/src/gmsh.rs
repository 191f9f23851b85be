//! gmsh's text formats: meshes with data (`.msh`, versions 2 and 4), and views (`.pos`).
//!
//! Format: "Gmsh 4 reference manual", chapter "Gmsh file formats".

use crate::bytes::{Budget, excerpt, number_of_word};
use crate::cells::Cells;
use crate::frame::{Array, Association, Frame, Wanted};
use std::collections::HashMap;
use std::str::SplitAsciiWhitespace;

/// Elements: number in gmsh, nodes, type of VTK. Corners come first in both.
const ELEMENTS: [(u32, usize, u8); 19] = [
    (1, 2, 3),
    (2, 3, 5),
    (3, 4, 9),
    (4, 4, 10),
    (5, 8, 12),
    (6, 6, 13),
    (7, 5, 14),
    (8, 3, 21),
    (9, 6, 22),
    (10, 9, 28),
    (11, 10, 24),
    (12, 27, 29),
    (13, 18, 32),
    (14, 14, 37),
    (15, 1, 1),
    (16, 8, 23),
    (17, 20, 25),
    (18, 15, 26),
    (19, 13, 27),
];
/// Elements of views: name without the sort of their values, nodes, type of VTK.
const SHAPES: [(&str, usize, u8); 8] = [
    ("P", 1, 1),
    ("L", 2, 3),
    ("T", 3, 5),
    ("Q", 4, 9),
    ("S", 4, 10),
    ("H", 8, 12),
    ("I", 6, 13),
    ("Y", 5, 14),
];
/// Sorts of values: letter, components.
const SORTS: [(char, usize); 3] = [('S', 1), ('V', 3), ('T', 9)];

/// Whether a text begins like a file of views.
pub(crate) fn are_views(text: &str) -> bool {
    let mut rest = text.trim_start();
    // Comments and options stand before the first view.
    loop {
        if let Some(comment) = rest.strip_prefix("/*") {
            rest = comment.split_once("*/").map_or("", |(_, after)| after).trim_start();
        } else if let Some(comment) = rest.strip_prefix("//") {
            rest = comment.split_once('\n').map_or("", |(_, after)| after).trim_start();
        } else if rest.starts_with("General.") || rest.starts_with("View.") {
            rest = rest.split_once(';').map_or("", |(_, after)| after).trim_start();
        } else {
            return rest.starts_with("View \"") || rest.starts_with("View\"");
        }
    }
}

/// The words of a section.
struct Words<'a> {
    words: SplitAsciiWhitespace<'a>,
    section: &'a str,
}

impl<'a> Words<'a> {
    fn word(&mut self) -> Result<&'a str, String> {
        self.words.next().ok_or_else(|| format!("its section {} is cut", self.section))
    }

    fn number(&mut self) -> Result<f64, String> {
        number_of_word(self.word()?)
    }

    fn count<T: std::str::FromStr>(&mut self) -> Result<T, String> {
        let word = self.word()?;
        word.parse().map_err(|_| {
            format!("`{}` in its section {} is invalid: expected a whole number", excerpt(word), self.section)
        })
    }
}

/// The text of each section, by its name in their order.
fn sections(text: &str) -> Result<Vec<(&str, &str)>, String> {
    let mut sections = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find('$') {
        let (name, after) = rest[start..].split_once('\n').unwrap_or((&rest[start..], ""));
        let name = name.trim();
        let end = format!("$End{}", name.trim_start_matches('$'));
        let (inside, after) = after
            .split_once(&end)
            .ok_or_else(|| format!("its section {} does not end: the file is cut", excerpt(name)))?;
        sections.push((name, inside));
        rest = after;
    }
    Ok(sections)
}

/// Reads a mesh with data.
pub(crate) fn read_mesh(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(100)]).into_owned();
    let mut format = head.split_ascii_whitespace().skip(1);
    let (version, kind) = (format.next().unwrap_or_default().to_owned(), format.next().unwrap_or_default());
    if kind != "0" {
        return Err("it is a binary mesh of gmsh, which is not read: write text (Mesh.Binary = 0; meshio: \
                    `binary=False`) or VTU"
            .to_owned());
    }
    let is_old = version.starts_with("2.");
    if !is_old && !version.starts_with("4.1") {
        return Err(format!("it is gmsh's version {}: expected 2.2 or 4.1", excerpt(&version)));
    }
    let text = std::str::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())?;
    let mut mesh = Mesh { budget: Budget::of_file(bytes.len()), ..Mesh::default() };
    let mut frame = Frame::default();
    let mut cells = Cells::default();
    for (section, inside) in sections(text)? {
        let mut words = Words { words: inside.split_ascii_whitespace(), section };
        match section {
            "$Nodes" if is_old => mesh.nodes_2(&mut words, &mut frame)?,
            "$Nodes" => mesh.nodes_4(&mut words, &mut frame)?,
            "$Elements" if is_old => mesh.elements_2(&mut words, &mut cells)?,
            "$Elements" => mesh.elements_4(&mut words, &mut cells)?,
            "$NodeData" => mesh.data(inside, Association::Points, wanted, &mut frame)?,
            "$ElementData" => mesh.data(inside, Association::Cells, wanted, &mut frame)?,
            _ => {}
        }
    }
    if frame.coordinates.is_empty() {
        return Err("it has no nodes".to_owned());
    }
    cells.check(frame.coordinates.len())?;
    frame.cells = (cells.count() > 0).then_some(cells);
    Ok(frame)
}

/// Nodes and elements by their tags.
#[derive(Default)]
struct Mesh {
    nodes: HashMap<u64, u32>,
    elements: HashMap<u64, usize>,
    budget: Budget,
}

impl Mesh {
    fn node(&mut self, tag: u64, words: &mut Words, frame: &mut Frame) -> Result<(), String> {
        let place = u32::try_from(frame.coordinates.len()).map_err(|_| "too many nodes")?;
        self.budget.take(64)?;
        self.nodes.insert(tag, place);
        frame.coordinates.push([words.number()?, words.number()?, words.number()?]);
        Ok(())
    }

    fn nodes_2(&mut self, words: &mut Words, frame: &mut Frame) -> Result<(), String> {
        for _ in 0..words.count::<u64>()? {
            let tag = words.count()?;
            self.node(tag, words, frame)?;
        }
        Ok(())
    }

    fn nodes_4(&mut self, words: &mut Words, frame: &mut Frame) -> Result<(), String> {
        let blocks: u64 = words.count()?;
        for _ in 0..3 {
            words.word()?;
        }
        for _ in 0..blocks {
            let dimension: u64 = words.count()?;
            words.word()?;
            let (parametric, count): (u64, u64) = (words.count()?, words.count()?);
            let mut tags: Vec<u64> = Vec::new();
            for _ in 0..count {
                self.budget.take(8)?;
                tags.push(words.count()?);
            }
            for tag in tags {
                self.node(tag, words, frame)?;
                for _ in 0..if parametric == 1 { dimension } else { 0 } {
                    words.word()?;
                }
            }
        }
        Ok(())
    }

    fn element(&mut self, tag: u64, kind: u32, words: &mut Words, cells: &mut Cells) -> Result<(), String> {
        let known = ELEMENTS.iter().find(|(number, ..)| *number == kind);
        let (_, nodes, vtk) = known.ok_or_else(|| format!("gmsh's element type {kind} is not read"))?;
        self.budget.take(64)?;
        for _ in 0..*nodes {
            let node: u64 = words.count()?;
            let place = self.nodes.get(&node).ok_or_else(|| format!("an element names the node {node}"))?;
            cells.connectivity.push(*place);
        }
        self.elements.insert(tag, cells.ends.len());
        cells.ends.push(cells.connectivity.len());
        cells.types.push(*vtk);
        Ok(())
    }

    fn elements_2(&mut self, words: &mut Words, cells: &mut Cells) -> Result<(), String> {
        for _ in 0..words.count::<u64>()? {
            let (tag, kind, tags): (u64, u32, u64) = (words.count()?, words.count()?, words.count()?);
            for _ in 0..tags {
                words.word()?;
            }
            self.element(tag, kind, words, cells)?;
        }
        Ok(())
    }

    fn elements_4(&mut self, words: &mut Words, cells: &mut Cells) -> Result<(), String> {
        let blocks: u64 = words.count()?;
        for _ in 0..3 {
            words.word()?;
        }
        for _ in 0..blocks {
            words.word()?;
            words.word()?;
            let (kind, count): (u32, u64) = (words.count()?, words.count()?);
            for _ in 0..count {
                let tag = words.count()?;
                self.element(tag, kind, words, cells)?;
            }
        }
        Ok(())
    }

    /// Data at nodes or elements: texts, numbers (the time first), whole numbers (step, components, count), values by tag.
    fn data(
        &mut self,
        inside: &str,
        on: Association,
        wanted: Wanted,
        frame: &mut Frame,
    ) -> Result<(), String> {
        let mut lines = inside.lines().map(str::trim).filter(|line| !line.is_empty());
        let cut = || "its data are cut".to_owned();
        let mut list = || -> Result<Vec<&str>, String> {
            let count: usize = lines.next().and_then(|line| line.parse().ok()).ok_or_else(cut)?;
            (0..count.min(1000)).map(|_| lines.next().ok_or_else(cut)).collect()
        };
        let (texts, reals, integers) = (list()?, list()?, list()?);
        let name = texts.first().map_or("", |name| name.trim_matches('"')).to_owned();
        let time = reals.first().map(|time| number_of_word(time)).transpose()?;
        let integer =
            |place: usize| integers.get(place).and_then(|word| word.parse::<usize>().ok()).ok_or_else(cut);
        let (components, count) = (integer(1)?, integer(2)?);
        if let (Some(one), Some(other)) = (frame.time, time)
            && one != other
        {
            return Err(format!(
                "its data are of several times, {one} and {other}: write each to a file of its own"
            ));
        }
        frame.time = time;
        let tuples = if on == Association::Points { self.nodes.len() } else { self.elements.len() };
        if !(1..=9).contains(&components) {
            return Err(format!("the data `{name}` have {components} components"));
        }
        let mut values = Vec::new();
        if wanted.has(&name) {
            self.budget.take(8 * (tuples * components) as u64)?;
            values = vec![f64::NAN; tuples * components];
            for _ in 0..count {
                let mut words = lines.next().ok_or_else(cut)?.split_ascii_whitespace();
                let tag: u64 = words.next().and_then(|word| word.parse().ok()).ok_or_else(cut)?;
                let place = match on {
                    Association::Points => self.nodes.get(&tag).map(|place| *place as usize),
                    _ => self.elements.get(&tag).copied(),
                };
                let place =
                    place.ok_or_else(|| format!("the data `{name}` name {tag}, which is not there"))?;
                for component in 0..components {
                    values[place * components + component] = number_of_word(words.next().ok_or_else(cut)?)?;
                }
            }
        }
        frame.arrays.push(Array { name, on, components, tuples, values, shape: Vec::new() });
        Ok(())
    }
}

/// Reads views: elements with their places and the values there, so that points repeat for each element. Views on the same
/// places are arrays of one state.
pub(crate) fn read_views(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())?;
    let mut budget = Budget::of_file(bytes.len());
    let mut whole: Option<Frame> = None;
    let mut rest = text;
    while let Some((_, after)) = rest.split_once("View") {
        let after = after.trim_start();
        let Some(quoted) = after.strip_prefix('"') else {
            rest = after;
            continue;
        };
        let cut = || "a view does not end: the file is cut".to_owned();
        let (name, after) = quoted.split_once('"').ok_or_else(cut)?;
        let (_, after) = after.split_once('{').ok_or_else(cut)?;
        let (view, after) = view_of(name, after, wanted, &mut budget)?;
        match &mut whole {
            Some(whole) => whole.join(view).map_err(|why| why.to_string())?,
            None => whole = Some(view),
        }
        rest = after;
    }
    whole.ok_or_else(|| "it has no view".to_owned())
}

/// A view, and the text behind it.
fn view_of<'a>(
    name: &str,
    mut rest: &'a str,
    wanted: Wanted,
    budget: &mut Budget,
) -> Result<(Frame, &'a str), String> {
    let cut = || format!("the view `{}` is cut", excerpt(name));
    let mut frame = Frame::default();
    let mut cells = Cells::default();
    let (mut values, mut sort) = (Vec::new(), None);
    loop {
        rest = rest.trim_start_matches(|symbol: char| symbol.is_whitespace() || symbol == ';');
        if let Some(after) = rest.strip_prefix('}') {
            rest = after;
            break;
        }
        let (kind, after) = rest.split_once('(').ok_or_else(cut)?;
        let kind = kind.trim();
        if kind == "TIME" {
            return Err("its views have several times: write each to a file of its own".to_owned());
        }
        let letter = kind.chars().next().and_then(|letter| SORTS.iter().find(|(known, _)| *known == letter));
        let shape = SHAPES.iter().find(|(known, ..)| Some(*known) == kind.get(1..));
        let (Some((_, components)), Some((_, nodes, vtk))) = (letter, shape) else {
            return Err(format!("the element `{}` of a view is not read", excerpt(kind)));
        };
        if sort.is_some_and(|sort| sort != *components) {
            return Err(format!("the view `{}` mixes scalars and vectors", excerpt(name)));
        }
        sort = Some(*components);
        let (places, after) = after.split_once(')').ok_or_else(cut)?;
        let (_, after) = after.split_once('{').ok_or_else(cut)?;
        let (numbers, after) = after.split_once('}').ok_or_else(cut)?;
        budget.take(((nodes * (3 + components)) * 8 + 16) as u64)?;
        let places = listed(places, 3 * nodes)?;
        let first = u32::try_from(frame.coordinates.len()).map_err(|_| "too many points")?;
        frame.coordinates.extend(places.chunks_exact(3).map(|place| [place[0], place[1], place[2]]));
        values.extend(listed(numbers, nodes * components)?);
        cells.connectivity.extend((0_u32..).map(|node| first + node).take(*nodes));
        cells.ends.push(cells.connectivity.len());
        cells.types.push(*vtk);
        rest = after;
    }
    let tuples = frame.coordinates.len();
    let values = if wanted.has(name) { values } else { Vec::new() };
    frame.cells = (cells.count() > 0).then_some(cells);
    frame.arrays.push(Array {
        name: name.to_owned(),
        on: Association::Points,
        components: sort.unwrap_or(1),
        tuples,
        values,
        shape: Vec::new(),
    });
    Ok((frame, rest))
}

/// So many numbers, separated by commas.
fn listed(text: &str, count: usize) -> Result<Vec<f64>, String> {
    let numbers = text.split(',').take(count + 1).map(|word| number_of_word(word.trim()));
    let numbers = numbers.collect::<Result<Vec<f64>, String>>()?;
    if numbers.len() == count {
        Ok(numbers)
    } else {
        Err(format!("an element of a view has other than {count} numbers: views of one time are read"))
    }
}
