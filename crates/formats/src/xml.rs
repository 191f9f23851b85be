//! A small tree of XML, bounded in depth and number: for collections and XDMF.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// Deepest nesting that is read.
const DEEPEST: usize = 64;
/// Most elements that are read.
const MOST: usize = 2_000_000;

/// An element with what is in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Element {
    /// Its name.
    pub name: String,
    /// Its attributes.
    pub attributes: BTreeMap<String, String>,
    /// Elements in it.
    pub children: Vec<Element>,
    /// Text in it.
    pub text: String,
}

impl Element {
    /// An attribute, or an empty text.
    pub fn attribute(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }

    /// The first child of a name.
    pub fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|child| child.name == name)
    }

    /// The element at the end of places among children, one after the other.
    pub fn at(&self, path: &[usize]) -> Option<&Self> {
        path.iter().try_fold(self, |element, place| element.children.get(*place))
    }

    /// All elements of a name in it, in order, at any depth.
    pub fn all<'a>(&'a self, name: &str, into: &mut Vec<&'a Self>) {
        for child in &self.children {
            if child.name == name {
                into.push(child);
            }
            child.all(name, into);
        }
    }
}

/// Attributes of a tag.
///
/// # Errors
/// When the tag is damaged.
pub fn attributes_of(tag: &BytesStart) -> Result<BTreeMap<String, String>, String> {
    let mut attributes = BTreeMap::new();
    for attribute in tag.attributes() {
        let attribute = attribute.map_err(|error| format!("a tag is damaged: {error}"))?;
        let name = String::from_utf8_lossy(attribute.key.as_ref()).into_owned();
        let value = String::from_utf8_lossy(&attribute.value);
        attributes.insert(name, unescaped(&value));
    }
    Ok(attributes)
}

/// A text with the five entities of XML replaced.
fn unescaped(text: &str) -> String {
    if !text.contains('&') {
        return text.trim().to_owned();
    }
    let text = text.trim().replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"");
    text.replace("&apos;", "'").replace("&amp;", "&")
}

/// The root element of a text.
///
/// # Errors
/// When it is no XML, or too deep.
pub fn tree_of(bytes: &[u8]) -> Result<Element, String> {
    let mut reader = Reader::from_reader(bytes);
    let mut open: Vec<Element> = vec![Element::default()];
    let mut count = 0;
    loop {
        let event = reader.read_event().map_err(|error| {
            format!("it is no sound XML near its byte {}: {error}", reader.buffer_position())
        })?;
        match event {
            Event::Start(tag) => {
                if open.len() > DEEPEST {
                    return Err(format!("its elements lie deeper than {DEEPEST} in each other"));
                }
                open.push(element_of(&tag, &mut count)?);
            }
            Event::Empty(tag) => {
                let element = element_of(&tag, &mut count)?;
                if let Some(parent) = open.last_mut() {
                    parent.children.push(element);
                }
            }
            Event::End(_) => {
                let Some(done) = open.pop() else { break };
                match open.last_mut() {
                    Some(parent) => parent.children.push(done),
                    None => return Err("it ends an element that did not begin".to_owned()),
                }
            }
            Event::Text(text) => {
                if let Some(element) = open.last_mut() {
                    element.text.push_str(&String::from_utf8_lossy(&text));
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if open.len() > 1 {
        return Err("it ends inside an element: the file is cut".to_owned());
    }
    let root = open.pop().unwrap_or_default();
    root.children.into_iter().next().ok_or_else(|| "it has no element".to_owned())
}

fn element_of(tag: &BytesStart, count: &mut usize) -> Result<Element, String> {
    *count += 1;
    if *count > MOST {
        return Err(format!("it has more than {MOST} elements"));
    }
    let name = String::from_utf8_lossy(tag.name().as_ref()).into_owned();
    Ok(Element { name, attributes: attributes_of(tag)?, ..Element::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_has_attributes_texts_and_an_end() {
        let root = tree_of(b"<?xml version=\"1.0\"?>\n<a b='1 &amp; 2'><c>3</c><d/><e><c>4</c></e></a>")
            .expect("xml");
        assert_eq!((root.name.as_str(), root.attribute("b")), ("a", "1 & 2"));
        let mut all = Vec::new();
        root.all("c", &mut all);
        assert_eq!(all.iter().map(|one| one.text.as_str()).collect::<Vec<_>>(), ["3", "4"]);
        assert!(tree_of(b"<a><b>").is_err_and(|why| why.contains("cut")));
        assert!(tree_of("<a>".repeat(100).as_bytes()).is_err_and(|why| why.contains("deeper")));
        assert!(tree_of(b"").is_err());
    }
}
