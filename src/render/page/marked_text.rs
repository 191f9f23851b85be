//! Lightly marked text.
use crate::render::escape::{html, markdown, plain_html};

/// A piece of running text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Inline {
    Text(String),
    Code(String),
    Strong(Vec<Inline>),
    Stressed(Vec<Inline>),
    Link(Vec<Inline>, String),
}

/// The paragraphs of a text, each on one line.
pub(crate) fn paragraphs(text: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut open = false;
    for line in text.lines().map(str::trim) {
        if line.is_empty() {
            open = false;
        } else if let Some(last) = out.last_mut().filter(|_| open) {
            last.push(' ');
            last.push_str(line);
        } else {
            out.push(line.to_owned());
            open = true;
        }
    }
    out
}

/// Takes the marks of a text apart. A mark without its partner is text.
pub(crate) fn parse(text: &str) -> Vec<Inline> {
    let mut out = Vec::new();
    let mut plain = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let before = plain.chars().next_back();
        if let Some((piece, after)) = marked(rest, before) {
            if !plain.is_empty() {
                out.push(Inline::Text(std::mem::take(&mut plain)));
            }
            out.push(piece);
            rest = after;
        } else {
            plain.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    if !plain.is_empty() {
        out.push(Inline::Text(plain));
    }
    out
}

/// A marked piece at the start of `text`, and what follows it.
fn marked(text: &str, before: Option<char>) -> Option<(Inline, &str)> {
    if let Some(inside) = text.strip_prefix('`') {
        let (code, after) = inside.split_once('`')?;
        return (!code.is_empty()).then(|| (Inline::Code(code.to_owned()), after));
    }
    if let Some(inside) = text.strip_prefix('[') {
        let (words, after) = inside.split_once("](")?;
        let (target, after) = after.split_once(')')?;
        // Only what can do no harm is a link.
        let safe = ["https://", "http://", "#"].iter().any(|s| target.starts_with(s))
            || !(target.is_empty() || target.contains(':') || target.starts_with('/'));
        let clean = !words.contains(['[', ']']) && !target.contains(char::is_whitespace);
        return (safe && clean).then(|| (Inline::Link(parse(words), target.to_owned()), after));
    }
    // A star inside a word, or with space on its inner side, is a star.
    if before.is_some_and(char::is_alphanumeric) {
        return None;
    }
    for mark in ["**", "*"] {
        let Some(inside) = text.strip_prefix(mark) else {
            continue;
        };
        let end = closing(inside, mark)?;
        let (words, after) = (&inside[..end], &inside[end + mark.len()..]);
        let pieces = parse(words);
        let piece = if mark == "**" { Inline::Strong(pieces) } else { Inline::Stressed(pieces) };
        return Some((piece, after));
    }
    None
}

/// Where the mark that ends a stressed piece stands.
fn closing(inside: &str, mark: &str) -> Option<usize> {
    if inside.starts_with([' ', '*']) {
        return None;
    }
    inside.match_indices(mark).map(|(i, _)| i).find(|&i| {
        let before = inside[..i].chars().next_back();
        let after = inside[i + mark.len()..].chars().next();
        before.is_some_and(|c| c != ' ' && c != '*')
            && !after.is_some_and(|c| c.is_alphanumeric() || c == '*')
    })
}

/// Marked text as HTML.
pub(crate) fn to_html(text: &str) -> String {
    write_html(&parse(text))
}

fn write_html(pieces: &[Inline]) -> String {
    pieces
        .iter()
        .map(|piece| match piece {
            Inline::Text(text) => html(text),
            Inline::Code(code) => format!("<code>{}</code>", plain_html(code)),
            Inline::Strong(inside) => format!("<strong>{}</strong>", write_html(inside)),
            Inline::Stressed(inside) => format!("<em>{}</em>", write_html(inside)),
            Inline::Link(words, target) => {
                format!("<a href=\"{}\">{}</a>", plain_html(target), write_html(words))
            }
        })
        .collect()
}

/// Marked text as Markdown, with everything escaped that is not a mark.
pub(crate) fn to_markdown(text: &str) -> String {
    write_markdown(&parse(text))
}

fn write_markdown(pieces: &[Inline]) -> String {
    pieces
        .iter()
        .map(|piece| match piece {
            Inline::Text(text) => markdown(text),
            Inline::Code(code) => format!("`{code}`"),
            Inline::Strong(inside) => format!("**{}**", write_markdown(inside)),
            Inline::Stressed(inside) => format!("*{}*", write_markdown(inside)),
            Inline::Link(words, target) => {
                format!("[{}]({})", write_markdown(words), target.replace('<', "%3C").replace('>', "%3E"))
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_become_elements() {
        assert_eq!(
            to_html("**bold `x_y`** and *T_v*, [here](#a) & `<b>`"),
            "<strong>bold <code>x_y</code></strong> and <em>T<sub>v</sub></em>, <a href=\"#a\">here</a> &amp; <code>&lt;b&gt;</code>"
        );
    }

    #[test]
    fn marks_without_partner_are_text() {
        for text in ["2*3*4", "a * b", "`open", "[a]", "**", "* *", "*", "[a](b", "``"] {
            assert_eq!(parse(text), vec![Inline::Text(text.to_owned())], "{text}");
        }
        assert_eq!(to_html("2*3 < 4"), "2*3 &lt; 4");
    }

    #[test]
    fn harmful_links_stay_text() {
        for target in ["javascript:alert(1)", "data:text/html,x", "//evil", "/etc", "a b", ""] {
            assert!(!to_html(&format!("[x]({target})")).contains("<a"), "{target}");
        }
        assert!(to_html("[x](figures/a.svg)").contains("<a href=\"figures/a.svg\""));
        assert!(to_html("[x](https://a.org/?q=\"b\")").contains("href=\"https://a.org/?q=&quot;b&quot;\""));
    }

    #[test]
    fn markdown_reads_back_the_same() {
        let text = "**bold** *T_v* `code` a\\*b [x](#y) 1 < 2 | 3";
        assert_eq!(to_markdown(text), "**bold** *T_v* `code` a\\\\\\*b [x](#y) 1 &lt; 2 \\| 3");
    }

    #[test]
    fn blank_lines_part_paragraphs() {
        assert_eq!(paragraphs("a\n  b\n\n\nc\n"), ["a b", "c"]);
        assert!(paragraphs(" \n").is_empty());
    }
}
