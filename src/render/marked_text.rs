//! Lightly marked text, taken apart and written as HTML and Markdown.
use crate::case::method_words::method_words;
use crate::render::escape::{html, markdown, markdown_target, plain_html};

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

/// A blank at which no line is broken.
const UNBROKEN: char = '\u{a0}';

/// A text in lines of a width, the first and the others after their own margin; a longer word stays whole.
pub(crate) fn wrapped(text: &str, first: &str, others: &str, width: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut line = first.to_owned();
    let mut is_empty = true;
    for word in text.split(|c: char| c.is_whitespace() && c != UNBROKEN).filter(|word| !word.is_empty()) {
        let letters = word.chars().count();
        // What fits no line stays where it is.
        let fits_below = others.chars().count() + letters <= width;
        if !is_empty && fits_below && line.chars().count() + 1 + letters > width {
            lines.push(std::mem::replace(&mut line, others.to_owned()));
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        let shown = word.chars().filter(|c| !c.is_control());
        line.extend(shown.map(|c| if c == UNBROKEN { ' ' } else { c }));
        is_empty = false;
    }
    lines.push(line);
    lines.join("\n") + "\n"
}

/// Marked text without its marks; code is not broken over lines.
pub(crate) fn to_plain(text: &str) -> String {
    write(text, &PLAIN)
}

/// How a format writes the pieces of a text.
struct Format {
    text: fn(&str) -> String,
    code: fn(&str) -> String,
    strong: [&'static str; 2],
    stressed: [&'static str; 2],
    /// From the words, written already, and the target.
    link: fn(&str, &str) -> String,
}

const HTML: Format = Format {
    text: html,
    code: html_code,
    strong: ["<strong>", "</strong>"],
    stressed: ["<em>", "</em>"],
    link: |words, target| format!("<a href=\"{}\">{words}</a>", plain_html(target)),
};

const MARKDOWN: Format = Format {
    text: markdown,
    code: |code| format!("`{code}`"),
    strong: ["**"; 2],
    stressed: ["*"; 2],
    link: |words, target| {
        format!("[{words}]({})", markdown_target(target).replace('<', "%3C").replace('>', "%3E"))
    },
};

const PLAIN: Format = Format {
    text: str::to_owned,
    code: |code| code.replace(' ', "\u{a0}"),
    strong: [""; 2],
    stressed: [""; 2],
    link: |words, _| words.to_owned(),
};

/// A word of code; the name of a method explains itself when one points at it.
pub(crate) fn html_code(code: &str) -> String {
    let code_html = format!("<code>{}</code>", plain_html(code));
    match method_words(code) {
        Some(words) => format!("<abbr title=\"{}\">{code_html}</abbr>", plain_html(&words)),
        None => code_html,
    }
}

/// Marked text as HTML.
pub(crate) fn to_html(text: &str) -> String {
    write(text, &HTML)
}

/// Marked text as Markdown, with everything escaped that is not a mark.
pub(crate) fn to_markdown(text: &str) -> String {
    write(text, &MARKDOWN)
}

/// Text of a table as HTML: names between back quotes are its only marks.
pub(crate) fn html_with_code(text: &str) -> String {
    with_code(text, html, html_code)
}

/// Text of a table as Markdown; the bars of a table are escaped even within back quotes.
pub(crate) fn markdown_with_code(text: &str) -> String {
    with_code(text, markdown, |code| format!("`{}`", code.replace('|', "\\|")))
}

fn with_code(text: &str, plain: fn(&str) -> String, code: fn(&str) -> String) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('`') {
        let Some((name, after)) = after.split_once('`').filter(|(name, _)| !name.is_empty()) else { break };
        out += &plain(before);
        out += &code(name);
        rest = after;
    }
    out + &plain(rest)
}

/// The text in a format. A mark without its partner is text.
fn write(text: &str, format: &Format) -> String {
    let mut out = String::new();
    let mut plain = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if let Some((piece, after)) = marked(rest, plain.chars().next_back(), format) {
            out += &(format.text)(&std::mem::take(&mut plain));
            out += &piece;
            rest = after;
        } else {
            plain.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    out + &(format.text)(&plain)
}

/// The marked piece at the start of `text` in a format, and what follows it.
fn marked<'t>(text: &'t str, before: Option<char>, format: &Format) -> Option<(String, &'t str)> {
    if let Some(inside) = text.strip_prefix('`') {
        let (code, after) = inside.split_once('`')?;
        return (!code.is_empty()).then(|| ((format.code)(code), after));
    }
    if let Some(inside) = text.strip_prefix('[') {
        let (words, after) = inside.split_once("](")?;
        let (target, after) = after.split_once(')')?;
        // Only targets that can do no harm are links.
        let is_safe = ["https://", "http://", "#"].iter().any(|start| target.starts_with(start))
            || !(target.is_empty() || target.contains(':') || target.starts_with('/'));
        let is_clean = !words.contains(['[', ']']) && !target.contains(char::is_whitespace);
        return (is_safe && is_clean).then(|| ((format.link)(&write(words, format), target), after));
    }
    // A star inside a word, or with space on its inner side, is a star.
    if before.is_some_and(char::is_alphanumeric) {
        return None;
    }
    let (mark, [start, end]) =
        if text.starts_with("**") { ("**", format.strong) } else { ("*", format.stressed) };
    let inside = text.strip_prefix(mark).filter(|inside| !inside.starts_with([' ', '*']))?;
    let close = inside.match_indices(mark).map(|(at, _)| at).find(|&at| {
        let after = inside[at + mark.len()..].chars().next();
        inside[..at].ends_with(|c| c != ' ' && c != '*')
            && !after.is_some_and(|c| c.is_alphanumeric() || c == '*')
    })?;
    let words = write(&inside[..close], format);
    Some((format!("{start}{words}{end}"), &inside[close + mark.len()..]))
}

#[cfg(test)]
mod tests {
    use super::{html_with_code, markdown_with_code};

    #[test]
    fn lines_fit_a_terminal_and_lose_no_word() {
        let text = "order 1.01 outside 1.90 … 2.10, ".repeat(20);
        let lines = wrapped(&text, "  ", "    ", 80);
        assert!(lines.lines().count() > 5 && lines.lines().all(|line| line.chars().count() <= 80));
        assert!(lines.starts_with("  order") && lines.lines().skip(1).all(|line| line.starts_with("    ")));
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&lines), words(&text));
        let long = "x".repeat(100);
        assert_eq!(wrapped(&long, "", "  ", 80), format!("{long}\n"), "a name stays whole");
        assert_eq!(wrapped("a\u{1b}[31m", "", "", 80), "a[31m\n", "nothing steers the terminal");
        let marked = "**next:** `oedometer explain \"a b\"` and [words](x.html)";
        assert_eq!(wrapped(&to_plain(marked), "", " ", 20), "next: oedometer explain \"a b\"\n and words\n");
    }

    #[test]
    fn names_between_back_quotes_are_the_only_marks_of_a_tables_text() {
        for (text, in_html, in_markdown) in [
            ("all with `cells=4`, *a*", "all with <code>cells=4</code>, *a*", "all with `cells=4`, \\*a\\*"),
            ("`a|b`", "<code>a|b</code>", "`a\\|b`"),
            ("`<b>` & `", "<code>&lt;b&gt;</code> &amp; `", "`<b>` &amp; \\`"),
            ("``", "``", "\\`\\`"),
        ] {
            assert_eq!([html_with_code(text), markdown_with_code(text)], [in_html, in_markdown], "{text}");
        }
    }

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
            assert_eq!(to_html(text), html(text), "{text}");
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
