//! Text made safe for the document it goes into. Titles, names of files and headers of tables come from anywhere, so
//! characters that control a terminal, or turn or break a line, are never passed on.
use crate::render::script::{ScriptLevel, runs};
use std::borrow::Cow;

/// Replaces a character that would not be seen.
const UNSEEN: char = '\u{fffd}';

/// Whether a character acts on the text around it: controls other than line end and tab, changes of the writing
/// direction, separators of lines and paragraphs, byte order marks, and tags.
fn is_unseen(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        || matches!(c, '\u{feff}' | '\u{e0000}'..='\u{e007f}')
        || (c.is_control() && c != '\n' && c != '\t')
}

/// A whole text for a terminal, a page or a file.
pub(crate) fn document(text: &str) -> Cow<'_, str> {
    if text.contains(is_unseen) { text.replace(is_unseen, "\u{fffd}").into() } else { text.into() }
}

/// Text on one line.
pub(crate) fn one_line(text: &str) -> String {
    text.chars().map(of_one_line).collect()
}

fn of_one_line(c: char) -> char {
    match c {
        '\n' | '\t' => ' ',
        c if is_unseen(c) => UNSEEN,
        c => c,
    }
}

/// A field of CSV with words. A spreadsheet reads a field that begins with `=`, `+`, `-` or `@` as a formula, and one after
/// an apostrophe as words. Numbers stay as they are.
pub(crate) fn csv_field(text: &str) -> Cow<'_, str> {
    let is_of_numbers = |rest: &str| rest.chars().all(|c| c.is_ascii_digit() || ".eE+- %±".contains(c));
    let is_formula = match text.chars().next() {
        Some('=' | '@' | '\t' | '\r' | '\n' | '＝' | '＋' | '－' | '＠') => true,
        Some('+' | '-') => !is_of_numbers(&text[1..]) && text.parse::<f64>().is_err(),
        _ => false,
    };
    if is_formula { format!("'{text}").into() } else { text.into() }
}

/// Text for HTML, with real subscripts and superscripts.
pub(crate) fn html(text: &str) -> String {
    runs(text)
        .into_iter()
        .map(|run| {
            let text = plain_html(&run.text);
            match run.level {
                ScriptLevel::Base => text,
                ScriptLevel::Sub => format!("<sub>{text}</sub>"),
                ScriptLevel::Super => format!("<sup>{text}</sup>"),
            }
        })
        .collect()
}

/// Text for HTML without scripts, also fit for attributes.
pub(crate) fn plain_html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if is_unseen(c) => out.push(UNSEEN),
            c => out.push(c),
        }
    }
    out
}

/// Text for one line of GitHub's Markdown.
pub(crate) fn markdown(text: &str) -> String {
    let chars: Vec<char> = text.chars().map(of_one_line).collect();
    let mut out = String::with_capacity(text.len());
    for (i, &c) in chars.iter().enumerate() {
        let inside_word =
            |j: Option<usize>| j.and_then(|j| chars.get(j)).is_some_and(|c| c.is_alphanumeric());
        match c {
            '\\' | '`' | '*' | '[' | ']' | '|' | '~' | '$' => out.extend(['\\', c]),
            '_' if !(inside_word(i.checked_sub(1)) && inside_word(Some(i + 1))) => {
                out.push_str("\\_");
            }
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            // At the start of a line these would make a heading or a list.
            '#' | '-' | '+' if i == 0 => out.extend(['\\', c]),
            c => out.push(c),
        }
    }
    out
}

/// The target of a link in Markdown: pages of the report lead to their Markdown form, lists of pages to `README.md`.
pub(crate) fn markdown_target(target: &str) -> Cow<'_, str> {
    let place = target.find('#').unwrap_or(target.len());
    let (file, anchor) = target.split_at(place);
    match file.strip_suffix(".html").filter(|_| !target.contains("://")) {
        Some(page) => match page.strip_suffix("index") {
            Some(folder) if folder.is_empty() || folder.ends_with('/') => {
                format!("{folder}README.md{anchor}").into()
            }
            _ => format!("{page}.md{anchor}").into(),
        },
        None => target.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_text_stays_text() {
        assert_eq!(
            html("<a href=\"x\">T_v & 10⁻³"),
            "&lt;a href=&quot;x&quot;&gt;T<sub>v</sub> &amp; 10<sup>−3</sup>"
        );
        assert_eq!(plain_html("a\u{0}'b"), "a\u{fffd}&#39;b");
        assert_eq!(markdown("a|b *c* <i> T_v _x_"), "a\\|b \\*c\\* &lt;i&gt; T_v \\_x\\_");
        assert_eq!(markdown("a\u{1b}[2J\u{202e}b"), "a\u{fffd}\\[2J\u{fffd}b");
        assert_eq!(markdown("# not a heading\n- nor a list"), "\\# not a heading - nor a list");
    }

    #[test]
    fn links_between_pages_lead_to_their_markdown_form() {
        for (html, markdown) in [
            ("studies/a.html", "studies/a.md"),
            ("../index.html", "../README.md"),
            ("index.html", "README.md"),
            ("studies/an-index.html", "studies/an-index.md"),
            ("https://a.org/b.html", "https://a.org/b.html"),
            ("tables/a.csv", "tables/a.csv"),
            ("#a", "#a"),
            ("race.html#a", "race.md#a"),
            ("studies/index.html#a", "studies/README.md#a"),
        ] {
            assert_eq!(markdown_target(html), markdown);
        }
    }

    #[test]
    fn no_document_has_what_is_not_seen() {
        for unseen in
            ['\u{1b}', '\u{7}', '\r', '\u{7f}', '\u{9b}', '\u{202e}', '\u{2066}', '\u{200f}', '\u{2028}']
        {
            let text = format!("a{unseen}[31m\n\tb");
            assert_eq!(document(&text), "a\u{fffd}[31m\n\tb", "{unseen:?}");
            let shown = [one_line(&text), html(&text), plain_html(&text), markdown(&text)];
            assert!(shown.iter().all(|shown| !shown.contains(unseen)), "{unseen:?}: {shown:?}");
        }
        let plain = "T_v = 0.1 − σ′ über 水 👩\u{200d}🔬\n\t";
        assert!(matches!(document(plain), Cow::Borrowed(text) if text == plain), "words stay");
        assert_eq!(one_line("a\tb\nc"), "a b c");
        for unseen in ['\u{61c}', '\u{200e}', '\u{202a}', '\u{2069}', '\u{feff}', '\u{e0000}', '\u{e007f}'] {
            assert_eq!(document(&format!("a{unseen}b")), "a\u{fffd}b", "{unseen:?}");
        }
        assert_eq!(markdown("a\\b~c$d`e+ -"), r"a\\b\~c\$d\`e+ -");
    }

    #[test]
    fn words_that_a_spreadsheet_would_compute_stay_words_and_numbers_numbers() {
        for formula in ["=1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "-2+3+A1", "\t=1", "-x", "＝1"] {
            assert_eq!(csv_field(formula), format!("'{formula}"));
        }
        for number in ["-1.5e-3", "+2", "-inf", "-NaN", "-0.48 %", "-1.0 ± 0.1", "-", "1=2", "a@b", "", "−3"]
        {
            assert_eq!(csv_field(number), number);
        }
    }
}
