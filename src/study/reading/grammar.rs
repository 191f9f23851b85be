//! Lines that are no TOML: what was meant, in the words of a study file, and what to write.
//!
//! The parser says where it stopped and which of its own rules is broken; a person wants to know what to type. The
//! parser's sentence only chooses the rule here, and the line itself says the rest.

use crate::case::keys::KEYS;
use crate::study::diagnostic::{Diagnostic, nearest};
use std::ops::Range;

/// Complaints of the parser about a value, by how they begin.
const OF_VALUES: [&str; 14] = [
    "string values must be quoted",
    "invalid float",
    "invalid integer",
    "invalid boolean",
    "invalid date-time",
    "invalid mantissa",
    "invalid fraction",
    "invalid exponent",
    "invalid value",
    "missing value",
    "unexpected leading zero",
    "unexpected sign",
    "redundant",
    "`_` may only",
];

/// How lines of a file look.
const A_LINE: &str = "a line is `key = value`; words stand in quotes, lists in [ ], remarks behind #";

/// The place where the parser stopped, and the line that it lies in.
struct Stop<'a> {
    text: &'a str,
    place: Range<usize>,
    line: Range<usize>,
}

/// The parser's complaint about the grammar of a text as a person reads it; none where it is about something else.
pub fn explained(message: &str, span: Option<&Range<usize>>, text: &str) -> Option<Diagnostic> {
    let stop = Stop::at(text, span?);
    let is = |start: &str| message.starts_with(start);
    if is("duplicate key") {
        Some(stop.twice())
    } else if is("unclosed table") || is("unclosed array table") {
        Some(stop.open_header(is("unclosed array")))
    } else if is("missing comma between array elements") || is("unclosed array") {
        Some(stop.list())
    } else if is("key with no value") || is("missing assignment") || is("invalid key-value pair") {
        Some(stop.without_equals_sign())
    } else if is("unexpected key or value") || is("unexpected content") {
        Some(stop.behind_a_value())
    } else if OF_VALUES.iter().any(|start| is(start)) {
        Some(stop.value())
    } else if is("invalid basic string") || is("invalid literal string") || is("invalid multi-line") {
        Some(stop.here(
            "a text in quotes has no end",
            "a text ends with the quote that it began with, in the same line",
        ))
    } else if is("missing escaped value") || is("too few unicode") {
        Some(stop.here("a backslash in a text", "write it twice, \\\\, or put the text into single quotes"))
    } else if is("invalid unquoted key") || is("unquoted keys") {
        Some(stop.key())
    } else if message.contains("inline table") || message.contains("between key-value pairs") {
        Some(stop.braces())
    } else if is("cannot extend") {
        Some(stop.here("a value stands where a table is begun", "put its keys together under one [header]"))
    } else {
        None
    }
}

/// What is said where nothing else fits: the parser's sentence without its list of tokens.
pub fn in_short(message: &str) -> (String, String) {
    (message.split(", expected").next().unwrap_or(message).to_owned(), A_LINE.to_owned())
}

impl<'a> Stop<'a> {
    fn at(text: &'a str, span: &Range<usize>) -> Self {
        let boundary = |mut at: usize| {
            at = at.min(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let place = boundary(span.start)..boundary(span.end);
        let start = text[..place.start].rfind('\n').map_or(0, |newline| newline + 1);
        let end = text[place.start..].find('\n').map_or(text.len(), |length| place.start + length);
        Self { text, place, line: start..end }
    }

    fn line(&self) -> &'a str {
        self.text[self.line.clone()].trim_end()
    }

    fn here(&self, message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
        Diagnostic::at(self.place.clone(), message, help)
    }

    /// The key of the line: what stands before its first `=`, or its first word.
    fn key_of_line(&self) -> &'a str {
        let line = self.line().trim_start();
        let head = line.split_once('=').map_or(line, |(head, _)| head);
        head.split([' ', '\t', ':', '[', '{', '(']).next().unwrap_or_default()
    }

    /// A key or a table that stands a second time.
    fn twice(&self) -> Diagnostic {
        let name = &self.text[self.place.clone()];
        let help = if self.line().trim_start().starts_with('[') {
            format!(
                "put its keys under one [{name}]; only blocks like [[sweep]] and [[expect]] can stand several times"
            )
        } else {
            format!("leave one of them out; several values of a swept key are one list: `{name} = [A, B]`")
        };
        self.here(format!("`{name}` stands twice"), help)
    }

    fn open_header(&self, is_block: bool) -> Diagnostic {
        let name = self.line().split('#').next().unwrap_or_default().trim().trim_matches(['[', ']']).trim();
        let right = if is_block { format!("[[{name}]]") } else { format!("[{name}]") };
        let whole = self.line.start..self.line.start + self.line().len();
        Diagnostic::at(whole, "the header of a table is not closed", format!("write {right}"))
    }

    /// A list that does not end, or whose values stand side by side.
    fn list(&self) -> Diagnostic {
        let before = &self.text[..self.place.start];
        let opened = before.rfind('[').unwrap_or(self.place.start);
        let rest = self.text[opened..].lines().next().unwrap_or_default().trim_end();
        if before[opened..].contains('\n') || self.place.start == self.text.len() {
            let line = Stop::at(self.text, &(opened..opened));
            let written = rest.split('#').next().unwrap_or_default().trim_end().trim_end_matches(',');
            return Diagnostic::at(
                opened..opened + rest.len(),
                format!("the list of `{}` has no end", line.key_of_line()),
                format!("close it: `{} = {written}]`", line.key_of_line()),
            );
        }
        self.here(SIDE_BY_SIDE, "part them by a comma, like [5, 10, 20]")
    }

    /// A line of a key and a value with something else between them, or of no value at all.
    fn without_equals_sign(&self) -> Diagnostic {
        let line = self.line().trim();
        if line.starts_with('{') {
            let help = format!("{A_LINE}; `oedometer new NAME` writes a study to start from");
            return self.here("this is JSON, and a study file is TOML", help);
        }
        let key = self.key_of_line();
        let rest = line.strip_prefix(key).unwrap_or_default().trim_start_matches([':', ' ', '\t']);
        let help = if key.is_empty() || rest.is_empty() || rest.contains(['=', ':']) {
            A_LINE.to_owned()
        } else {
            format!("write `{key} = {}`", quoted_where_a_word(rest))
        };
        let name = if key.is_empty() { "the line".to_owned() } else { format!("`{}`", cut(key)) };
        self.here(format!("{name} has no `=` and a value behind it"), help)
    }

    /// Something behind a complete value.
    fn behind_a_value(&self) -> Diagnostic {
        let (key, value) = (self.key_of_line(), self.value_of_line());
        let parts: Vec<&str> = value.split(',').map(str::trim).collect();
        if parts.len() > 1 && parts.iter().all(|part| !part.is_empty()) {
            let list = format!("a list stands in brackets: `{key} = [{}]`", parts.join(", "));
            let number = parts.join(".");
            let is_number = parts.len() == 2 && !value.contains(", ") && number.parse::<f64>().is_ok();
            let help =
                if is_number { format!("a number has a point: `{key} = {number}`; {list}") } else { list };
            return self.here(format!("`{}` is neither a number nor a list", cut(value)), help);
        }
        self.here("something stands behind the value", A_LINE)
    }

    /// What the line has behind its first `=`, without a remark.
    fn value_of_line(&self) -> &'a str {
        let value = self.line().split_once('=').map_or("", |(_, value)| value);
        value.split('#').next().unwrap_or_default().trim()
    }

    /// The value in which the parser stopped, alone: one of a list or of a table in braces.
    fn value_here(&self) -> Range<usize> {
        let line_end = self.line.start + self.line().len();
        let stop = self.place.start.clamp(self.line.start, line_end);
        let head = &self.text[self.line.start..stop];
        let start = head.rfind(['=', '[', ',', '{']).map_or(self.line.start, |at| self.line.start + at + 1);
        let rest = &self.text[start..line_end];
        let is_listed = head[..start - self.line.start].trim_end().ends_with(['[', ',', '{'])
            || self.text[self.line.start..start].contains('{');
        let ends: &[char] = if is_listed { &[',', ']', '}', '#'] } else { &['#'] };
        let value = &rest[..rest.find(ends).unwrap_or(rest.len())];
        let from = start + (value.len() - value.trim_start().len());
        from..from + value.trim().len()
    }

    fn value(&self) -> Diagnostic {
        let place = self.value_here();
        let value = &self.text[place.clone()];
        let before = self.text[..place.start].trim_end();
        // A value alone in a list or a table is told alone, for its neighbours may be as they should.
        let key = before
            .strip_suffix('=')
            .and_then(|head| head.trim_end().rsplit([' ', '\t', '\n', '{', ',']).next());
        if value.is_empty() {
            let name = key.map_or("the list".to_owned(), |key| format!("`{key}`"));
            return self.here(
                format!("{name} has no value"),
                "write one behind the `=`, or leave the key out for its default",
            );
        }
        let are_numbers = value.split_whitespace().all(|part| part.parse::<f64>().is_ok());
        if key.is_none() && are_numbers && value.contains(' ') {
            return Diagnostic::at(place, SIDE_BY_SIDE, "part them by a comma, like [5, 10, 20]");
        }
        let write = |right: &str| match key {
            Some(key) => format!("write `{key} = {right}`"),
            None => format!("write `{right}`"),
        };
        let Some((what, right)) = meant(value) else {
            let message = format!("`{}` stands without quotes", cut(value));
            return Diagnostic::at(place, message, write(&quoted_where_a_word(value)));
        };
        let help = right.map_or_else(|| NUMBERS.to_owned(), |right| write(&right));
        Diagnostic::at(place, what.replace("{}", cut(value)), help)
    }

    fn key(&self) -> Diagnostic {
        let written = self.line().split('=').next().unwrap_or_default().trim();
        let help = match nearest(written, KEYS.iter().map(|key| key.name)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "keys are words of letters, digits and `_`".to_owned(),
        };
        self.here(format!("`{}` is no key", cut(written)), help)
    }

    fn braces(&self) -> Diagnostic {
        let (key, value) = (self.key_of_line(), self.value_of_line());
        if let Some(inside) = value.strip_prefix('{').filter(|inside| !inside.contains('=')) {
            let inside = inside.trim_end_matches('}').trim();
            let help = format!("a list stands in square brackets: `{key} = [{inside}]`");
            return self.here("braces hold keys with values", help);
        }
        self.here(
            "a table in braces has no end, or no comma between its keys",
            "write it like { cells = 10, below = 5.0e-3 }",
        )
    }
}

/// What is said of a list without a comma.
const SIDE_BY_SIDE: &str = "two values of a list stand side by side";
/// How numbers are written.
const NUMBERS: &str = "numbers are written like 0.3, 1.0e6 or 2.5e-4";

/// What is wrong with something that was to be a number, and how it is written, where that is clear; none where it is
/// a word. `{}` stands for the value.
fn meant(value: &str) -> Option<(&'static str, Option<String>)> {
    if !value.starts_with(|c: char| c.is_ascii_digit() || "+-.(".contains(c)) {
        return None;
    }
    if let Some((number, remark)) = value.split_once("//") {
        let right = format!("{} # {}", number.trim(), remark.trim());
        return Some(("a remark begins with #", Some(right)));
    }
    let number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite).then(|| with_zeros(text));
    let bare = value.trim_end_matches(';').trim_matches(['(', ')']).trim();
    if bare != value {
        return Some(("`{}` is no number", number(bare)));
    }
    if let Some((base, exponent)) = value.split_once('^').or_else(|| value.split_once("**")) {
        let (factor, base) = base.rsplit_once(['*', '·']).unwrap_or(("1", base));
        let right = format!("{}e{}", factor.trim(), exponent.trim_matches(['(', ')', ' ']));
        let is_ten = base.trim() == "10";
        return Some(("a power of ten is written with an e", is_ten.then(|| number(&right)).flatten()));
    }
    let together: String = value.chars().filter(|c| !"' _".contains(*c)).collect();
    if let Some(right) = number(&together) {
        return Some(("`{}` is no number of a study file", Some(right)));
    }
    let digits = before_unit(value);
    let unit = value[digits.len()..].trim_start();
    if let Ok(share) = digits.parse::<f64>()
        && unit == "%"
    {
        return Some(("a share is written as a number, not in percent", Some((share / 100.0).to_string())));
    }
    if unit.starts_with(|c: char| c.is_alphabetic() || c == '°') && !digits.is_empty() {
        return Some(("a number stands without its unit, in SI: metres, seconds, pascals", number(digits)));
    }
    Some(("`{}` is no number", None))
}

/// The number that a text begins with, up to what is no part of one.
fn before_unit(value: &str) -> &str {
    let mut ends = value.char_indices().map(|(at, _)| at).chain([value.len()]);
    let longest = ends.rfind(|end| value[..*end].trim_end().parse::<f64>().is_ok()).unwrap_or(0);
    value[..longest].trim_end()
}

/// A number with the zeros that TOML wants on both sides of the point, and none in front.
fn with_zeros(number: &str) -> String {
    let (sign, rest) = match number.strip_prefix(['-', '+']) {
        Some(rest) => (if number.starts_with('-') { "-" } else { "" }, rest),
        None => ("", number),
    };
    let split = rest.find(['e', 'E']).unwrap_or(rest.len());
    let (mantissa, exponent) = rest.split_at(split);
    let (whole, part) =
        mantissa.split_once('.').map_or((mantissa, None), |(whole, part)| (whole, Some(part)));
    let whole = whole.trim_start_matches('0');
    let whole = if whole.is_empty() { "0" } else { whole };
    let part = part.map_or(String::new(), |part| format!(".{}", if part.is_empty() { "0" } else { part }));
    format!("{sign}{whole}{part}{exponent}")
}

/// A value as it may stand: a word in quotes, everything else as it is.
fn quoted_where_a_word(value: &str) -> String {
    if value.starts_with(char::is_alphabetic) && !["true", "false", "inf", "nan"].contains(&value) {
        format!("\"{}\"", cut(value).trim_end_matches(['"', '\'']))
    } else {
        cut(value).to_owned()
    }
}

/// A text that is not too long for a sentence.
fn cut(text: &str) -> &str {
    const LONGEST: usize = 40;
    text.char_indices().nth(LONGEST).map_or(text, |(end, _)| &text[..end])
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    const TEXT: &str = "title = \"t\"\nscene = \"terzaghi\"\n\n[column]\nheight = 1.0\n\n[[sweep]]\n\
                        method = [\"MPM\"]\ncells = [4, 8]\ntime_factors = [0.1]\n\n[[expect]]\nmethod = \"MPM\"\n\
                        time_factor = 0.1\norder = { value = 2.0 }\n";

    fn said(from: &str, to: &str) -> String {
        assert!(TEXT.contains(from), "{from}");
        let source = StudySource { name: "t.toml".to_owned(), text: TEXT.replacen(from, to, 1) };
        Study::check(&source).expect_err(to).to_string()
    }

    /// What was typed in place of what, and what must be said of it.
    const MISTAKES: &[(&str, &str, &[&str])] = &[
        (
            "cells = [4, 8]",
            "cells = [4, 8",
            &["t.toml:9:9", "the list of `cells` has no end", "`cells = [4, 8]`"],
        ),
        ("cells = [4, 8]", "cells = [4 8]", &["side by side", "part them by a comma"]),
        ("cells = [4, 8]", "cells = 4, 8", &["neither a number nor a list", "`cells = [4, 8]`"]),
        ("cells = [4, 8]", "cells [4, 8]", &["`cells` has no `=`", "write `cells = [4, 8]`"]),
        ("cells = [4, 8]", "cells = {4, 8}", &["braces hold keys", "`cells = [4, 8]`"]),
        ("cells = [4, 8]", "cells =", &["`cells` has no value"]),
        ("cells = [4, 8]", "cells = [4]\ncells = [8]", &["t.toml:10:1", "`cells` stands twice", "one list"]),
        ("height = 1.0", "height = 1,0", &["`height = 1.0`", "`height = [1, 0]`"]),
        ("height = 1.0", "height = 1 m", &["without its unit", "write `height = 1`"]),
        ("height = 1.0", "height = 1.5e1m # tall", &["without its unit", "write `height = 1.5e1`"]),
        ("height = 1.0", "height = 30 %", &["not in percent", "write `height = 0.3`"]),
        ("height = 1.0", "height = 1.0.0", &["`1.0.0` is no number", "numbers are written like"]),
        ("height = 1.0", "height: 1.0", &["`height` has no `=`", "write `height = 1.0`"]),
        ("height = 1.0", "height = 1'000'000", &["write `height = 1000000`"]),
        ("height = 1.0", "height = 2*10^6", &["written with an e", "write `height = 2e6`"]),
        ("height = 1.0", "height = 1.0;", &["write `height = 1.0`"]),
        ("height = 1.0", "height = .5", &["write `height = 0.5`"]),
        ("height = 1.0", "height = 1.", &["write `height = 1.0`"]),
        ("height = 1.0", "height = 01.5", &["write `height = 1.5`"]),
        ("height = 1.0", "height = (1.0)", &["write `height = 1.0`"]),
        ("height = 1.0", "height = 1.0 // m", &["begins with #", "write `height = 1.0 # m`"]),
        ("height = 1.0", "heigh't = 1.0", &["`heigh't` is no key", "did you mean `height`?"]),
        ("[column]", "[column", &["not closed", "write [column]"]),
        ("[[sweep]]", "[[sweep]", &["not closed", "write [[sweep]]"]),
        ("[[sweep]]", "[column]\n[[sweep]]", &["`column` stands twice", "under one [column]"]),
        ("title = \"t\"", "title = t", &["`t` stands without quotes", "write `title = \"t\"`"]),
        ("title = \"t\"", "title = \"t", &["has no end"]),
        ("title = \"t\"", "title = \"a\\q\"", &["backslash"]),
        ("title = \"t\"", "{ \"title\": \"t\" }", &["JSON", "oedometer new"]),
        ("title = \"t\"\n", "", &["the study has no `title`", "title = "]),
        ("scene = \"terzaghi\"", "scene = terzaghi", &["write `scene = \"terzaghi\"`"]),
        ("method = [\"MPM\"]", "method = [MPM]", &["`MPM` stands without quotes", "write `\"MPM\"`"]),
        ("method = [\"MPM\"]", "method = [\"MPM\" \"GIMP\"]", &["side by side"]),
        (
            "order = { value = 2.0 }",
            "order = { minus = 0.2 }",
            &["`order` has no `value`", "order = { value = 2.0"],
        ),
        ("order = { value = 2.0 }", "order = [2.0, 0.1]", &["`order` takes a band", "order = { value = 2.0"]),
        ("order = { value = 2.0 }", "order = { value = 2.0 minus = 0.1 }", &["no comma", "{ cells = 10"]),
        ("order = { value = 2.0 }", "xfail = {}", &["`xfail` has no `reason`"]),
    ];

    #[test]
    fn what_is_no_toml_is_answered_with_what_to_write() {
        for (from, to, parts) in MISTAKES {
            let said = said(from, to);
            for part in *parts {
                assert!(said.contains(part), "`{to}`: no `{part}` in\n{said}");
            }
            assert!(
                said.contains("t.toml:") && said.contains('^') && said.contains("help: "),
                "`{to}`:\n{said}"
            );
            for word in
                ["expected", "invalid", "missing field", "literal", "struct", "duplicate", "unexpected"]
            {
                assert!(!said.contains(word), "`{to}`: the parser's `{word}` in\n{said}");
            }
        }
    }
}
