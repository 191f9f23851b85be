//! XML documents: parsed with a bound on their size, and attributes that may be missing.

use roxmltree::{Document, Node, ParsingOptions};

/// Most nodes of a document.
const MOST_NODES: u32 = 5_000_000;

/// Parses a document.
pub(crate) fn parse(text: &str) -> Result<Document<'_>, String> {
    // XDMF documents name a DTD; external ones are not loaded.
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| match error {
        roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode => {
            "its XML ends inside an element: the file is cut".to_owned()
        }
        error => format!("its XML is damaged: {error}"),
    })
}

/// An attribute without the spaces around it; empty if it is missing.
pub(crate) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or_default().trim()
}

/// The first child element of a name.
pub(crate) fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// All elements of a name below a node, in the order of the document.
pub(crate) fn all<'a, 'input: 'a>(
    node: Node<'a, 'input>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    node.descendants().filter(move |below| below.has_tag_name(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_unescaped_and_elements_found_at_any_depth() {
        let text = "<?xml version=\"1.0\"?>\n<!DOCTYPE a SYSTEM \"a.dtd\" []>\n<a b=' 1 &amp; 2'><c>3</c><d><c>4</c></d></a>";
        let document = parse(text).expect("XML");
        let root = document.root_element();
        assert_eq!((attribute(root, "b"), attribute(root, "e")), ("1 & 2", ""));
        assert_eq!(all(root, "c").map(|one| one.text()).collect::<Vec<_>>(), [Some("3"), Some("4")]);
        assert!(child(root, "d").is_some() && child(root, "e").is_none());
        assert!(parse("").is_err());
    }

    #[test]
    fn a_cut_a_bomb_and_a_deep_document_are_no_more_than_an_error_or_a_tree() {
        assert!(parse("<a><b>").is_err_and(|why| why.contains("cut")));
        let laughs = (1..20).map(|level| {
            let entity = format!("&l{};", level - 1).repeat(10);
            format!("<!ENTITY l{level} \"{entity}\">")
        });
        let laughs = laughs.collect::<String>();
        assert!(parse(&format!("<!DOCTYPE a [<!ENTITY l0 \"ha\">{laughs}]><a>&l19;</a>")).is_err());
        let deep = format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000));
        assert!(parse(&deep).is_ok());
    }
}
