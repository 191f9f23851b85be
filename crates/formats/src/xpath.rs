//! The part of `XPath` that writers of XDMF use to refer to elements of the same document.
//!
//! `/Xdmf/Domain/Grid[@GridType='Uniform'][1]/*[self::Topology or self::Geometry]`, `//Grid[@Name="mesh"]/Geometry`,
//! `Grid[last()]`, and `element(/1/1/2)`, which counts elements from 1. Grammar: "XML Path Language 1.0", w3.org/TR/xpath-10.

use roxmltree::{Document, Node};

/// Most elements that one document's pointers may look at.
const MOST_VISITS: usize = 20_000_000;

/// The elements that pointers of a document lead to; looking at them is bounded.
pub(crate) struct Pointers<'a> {
    document: &'a Document<'a>,
    visits: usize,
}

/// A condition on an element.
enum Condition<'p> {
    /// The so manieth of those before it, from 1.
    Number(usize),
    /// The last of those before it.
    Last,
    /// An attribute of a value, or of any.
    Attribute(&'p str, Option<&'p str>),
    /// One of these names.
    Names(Vec<&'p str>),
}

impl<'a> Pointers<'a> {
    /// Those of a document.
    pub fn of(document: &'a Document<'a>) -> Self {
        Self { document, visits: 0 }
    }

    /// The elements of a pointer; none if it is not understood.
    pub fn elements(&mut self, pointer: &str) -> Vec<Node<'a, 'a>> {
        let pointer = pointer.trim();
        let inside =
            |function: &str| Some(pointer.strip_prefix(function)?.trim_end().strip_suffix(')')?.trim());
        if let Some(places) = inside("element(") {
            return self.counted(places).into_iter().collect();
        }
        self.path(inside("xpointer(").unwrap_or(pointer)).unwrap_or_default()
    }

    /// The element of `/1/1/2`: counted from 1, the root first.
    fn counted(&self, places: &str) -> Option<Node<'a, 'a>> {
        let step = |element: Node<'a, 'a>, place: &str| {
            let place = place.parse::<usize>().ok()?.checked_sub(1)?;
            element.children().filter(Node::is_element).nth(place)
        };
        places.strip_prefix('/')?.split('/').try_fold(self.document.root(), step)
    }

    fn path(&mut self, path: &str) -> Option<Vec<Node<'a, 'a>>> {
        let mut here = vec![self.document.root()];
        let mut rest = path.strip_prefix('/')?;
        loop {
            let is_deep = rest.starts_with('/');
            rest = rest.strip_prefix('/').unwrap_or(rest);
            let (step, after) = split_step(rest);
            let (name, conditions) = conditions_of(step)?;
            let mut found = Vec::new();
            for element in here {
                let parents: Vec<Node> = if is_deep {
                    element.descendants().filter(|below| !below.is_text()).collect()
                } else {
                    vec![element]
                };
                for parent in parents {
                    found.extend(self.selected(parent, name, &conditions)?);
                }
            }
            here = found;
            match after {
                Some(after) => rest = after,
                None => return Some(here),
            }
        }
    }

    /// The children of an element that have a name and meet the conditions, one after the other.
    fn selected(
        &mut self,
        parent: Node<'a, 'a>,
        name: &str,
        conditions: &[Condition],
    ) -> Option<Vec<Node<'a, 'a>>> {
        let children = parent.children().filter(Node::is_element);
        let children: Vec<Node> = children.collect();
        self.visits += 1 + children.len();
        if self.visits > MOST_VISITS {
            return None;
        }
        let mut found: Vec<Node> =
            children.into_iter().filter(|child| name == "*" || child.has_tag_name(name)).collect();
        for condition in conditions {
            found = match condition {
                Condition::Number(number) => found.get(number.checked_sub(1)?).copied().into_iter().collect(),
                Condition::Last => found.last().copied().into_iter().collect(),
                Condition::Attribute(key, wanted) => {
                    let has = |node: &Node| {
                        node.attribute(*key).is_some_and(|value| wanted.is_none_or(|wanted| wanted == value))
                    };
                    found.into_iter().filter(has).collect()
                }
                Condition::Names(names) => found
                    .into_iter()
                    .filter(|node| names.iter().any(|name| node.has_tag_name(*name)))
                    .collect(),
            };
        }
        Some(found)
    }
}

/// The first step of a path, and what follows its slash; slashes in quotes and brackets are its own.
fn split_step(path: &str) -> (&str, Option<&str>) {
    let (mut quote, mut depth) = (None, 0_usize);
    for (at, symbol) in path.char_indices() {
        match (symbol, quote) {
            ('\'' | '"', None) => quote = Some(symbol),
            (_, Some(open)) if open == symbol => quote = None,
            ('[', None) => depth += 1,
            (']', None) => depth = depth.saturating_sub(1),
            ('/', None) if depth == 0 => return (&path[..at], Some(&path[at + 1..])),
            _ => {}
        }
    }
    (path, None)
}

/// The name of a step and its conditions.
fn conditions_of(step: &str) -> Option<(&str, Vec<Condition<'_>>)> {
    let start = step.find('[').unwrap_or(step.len());
    let name = step[..start].trim();
    let name = name.strip_prefix("child::").unwrap_or(name);
    let is_name = name == "*"
        || (!name.is_empty()
            && name.chars().all(|symbol| symbol.is_alphanumeric() || "_-.".contains(symbol)));
    let mut conditions = Vec::new();
    let mut rest = step[start..].trim();
    while let Some(inside) = rest.strip_prefix('[') {
        let end = end_of_bracket(inside)?;
        for part in inside[..end].split(" and ") {
            conditions.push(condition_of(part.trim())?);
        }
        rest = inside[end + 1..].trim_start();
    }
    (is_name && rest.is_empty()).then_some((name, conditions))
}

fn end_of_bracket(text: &str) -> Option<usize> {
    let mut quote = None;
    for (at, symbol) in text.char_indices() {
        match (symbol, quote) {
            ('\'' | '"', None) => quote = Some(symbol),
            (_, Some(open)) if open == symbol => quote = None,
            (']', None) => return Some(at),
            _ => {}
        }
    }
    None
}

fn condition_of(text: &str) -> Option<Condition<'_>> {
    if let Some(attribute) = text.strip_prefix('@') {
        let Some((key, value)) = attribute.split_once('=') else {
            return Some(Condition::Attribute(attribute.trim(), None));
        };
        let value = value.trim();
        let quote = value.chars().next().filter(|symbol| "'\"".contains(*symbol))?;
        let value = value.strip_prefix(quote)?.strip_suffix(quote)?;
        return Some(Condition::Attribute(key.trim(), Some(value)));
    }
    if text == "last()" || text == "position()=last()" {
        return Some(Condition::Last);
    }
    if text.starts_with("self::") {
        let names = text.split(" or ").map(|part| part.trim().strip_prefix("self::").map(str::trim));
        return names.collect::<Option<Vec<&str>>>().map(Condition::Names);
    }
    let number =
        text.strip_prefix("position()").map_or(text, |rest| rest.trim_start().trim_start_matches('='));
    number.trim().parse().ok().map(Condition::Number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_of_writers_lead_to_their_elements() {
        let text = "<Xdmf><Domain><Grid Name=\"m/[1]\" GridType=\"Uniform\"><Topology/><Geometry/><Time/></Grid>\
                    <Grid Name=\"s\" GridType=\"Collection\"><Grid Name=\"a\"><Geometry/></Grid>\
                    <Grid Name=\"b\"><Topology/></Grid></Grid><Grid Name=\"n\" GridType=\"Uniform\"/></Domain></Xdmf>";
        let document = crate::xml::parse(text).expect("XML");
        let mut pointers = Pointers::of(&document);
        for (pointer, found) in [
            (
                "xpointer(/Xdmf/Domain/Grid[@GridType='Uniform'][1]/*[self::Topology or self::Geometry])",
                "Topology Geometry",
            ),
            ("xpointer(//Grid[@Name=\"s\"]/Grid[1]/*[self::Topology or self::Geometry])", "Geometry"),
            ("xpointer(//Grid[@Name='m/[1]']/Geometry)", "Geometry"),
            ("xpointer( /Xdmf/Domain/Grid[@GridType='Uniform' and @Name='n'] )", "n"),
            ("/Xdmf/Domain/Grid[@GridType='Uniform'][2]", "n"),
            ("/Xdmf/Domain/Grid[2][@GridType='Uniform']", ""),
            ("/Xdmf/Domain/Grid[last()]", "n"),
            ("/Xdmf/Domain/Grid[position()=2]/Grid", "a b"),
            ("//Grid[@GridType]", "m/[1] s n"),
            ("//Topology", "Topology Topology"),
            ("/Xdmf/*/Grid[2]//Grid[2]/*", "Topology"),
            ("element(/1/1/2/1)", "a"),
            ("element(/1/1/9)", ""),
            ("/Xdmf/Domain/Grid[0]", ""),
            ("/Xdmf/Domain/Grid[@Name=s]", ""),
            ("id('a')", ""),
            ("range(1)", ""),
            ("", ""),
        ] {
            let elements = pointers.elements(pointer);
            let told: Vec<&str> = elements
                .iter()
                .map(|element| element.attribute("Name").unwrap_or(element.tag_name().name()))
                .collect();
            assert_eq!(told.join(" "), found, "{pointer}");
        }
    }
}
