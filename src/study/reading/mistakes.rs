//! The parser's complaints in the words of study files: what was written, what the key takes, what to write.

use crate::case::keys::{Key, Kind};
use std::ops::Range;

/// What a key takes, by what the parser says it expected: in words, and as an example.
const TAKES: [(&str, &str, &str); 10] = [
    ("struct OrderTable", "a band about an order", "{ value = 2.0, minus = 0.1, plus = 0.1 }"),
    ("struct TimeStepTable", "a rule of the step", "[{ seconds = 1e-5 }]"),
    ("struct LevelTable", "a bound at a level", "{ cells = 10, below = 5.0e-3 }"),
    ("struct RangeTable", "bounds", "{ above = 1e-4, below = 1e-3 }"),
    ("struct BelowTable", "an upper bound", "{ below = 1e-3 }"),
    ("struct XfailTable", "a reason", "{ reason = \"why it fails\" }"),
    ("i64", "a whole number", "10"),
    ("f64", "a number", "0.1"),
    ("a boolean", "true or false", "true"),
    ("the name of a method or a table of its choices", "the name of a method", "[\"GC-SRI-patch\"]"),
];

/// A complaint about a wrong kind of value as a sentence with what to write; none where the parser complains of
/// something else.
pub fn explained(message: &str, span: Option<&Range<usize>>, text: &str) -> Option<(String, String)> {
    let span = span?;
    if let Some(field) = message.strip_prefix("missing field `") {
        return Some(without(field.trim_end_matches('`'), span, text));
    }
    let wrong = message.strip_prefix("invalid type: ").or_else(|| message.strip_prefix("invalid length "));
    let (_, expected) = wrong?.split_once(", expected ")?;
    let expected = expected.split(" with ").next().unwrap_or(expected);
    let written = written_at(text, span);
    let Some(key) = key_before(text, span.start) else {
        return Some((format!("`{written}` stands where a table belongs"), of_a_header(expected, &written)));
    };
    let told = |takes: &str| format!("`{key}` takes {takes}, and `{written}` is none");
    let write = |value: &str| format!("write `{key} = {value}`");
    let bare = written.trim_matches('"');
    let is_number = bare.parse::<f64>().is_ok();
    if expected == "a sequence" {
        let inner = match Key::named(key, "sweep").map(|key| key.kind) {
            Some(Kind::TimeStep) if is_number => format!("{{ seconds = {bare} }}"),
            Some(Kind::Count(_) | Kind::Number(_)) if is_number => bare.to_owned(),
            _ => written.clone(),
        };
        return Some((told("a list"), write(&format!("[{inner}]"))));
    }
    if expected == "a string" {
        let word = written.trim_matches(['[', ']', '"', ' ']);
        return Some((told("a word in quotes"), write(&format!("\"{word}\""))));
    }
    if ["i64", "f64"].contains(&expected) && written.starts_with('[') && Key::named(key, "sweep").is_some() {
        return Some((
            told("one value here"),
            format!("several values stand in a [[sweep]]: `{key} = {written}`"),
        ));
    }
    if ["i64", "f64"].contains(&expected) && is_number && bare != written {
        return Some((told("a number"), format!("numbers stand without quotes: `{bare}`")));
    }
    let (_, takes, example) = TAKES.iter().find(|(word, _, _)| *word == expected)?;
    let help = match expected {
        "struct OrderTable" if is_number => {
            write(&format!("{{ value = {written}, minus = 0.1, plus = 0.1 }}"))
        }
        "struct TimeStepTable" if is_number => format!(
            "write `time_step = [{{ seconds = {written} }}]`, or `[{{ stable = 0.8 }}]`, `[{{ growth = 0.05 }}]`"
        ),
        _ => format!("write it like `{key} = {example}`"),
    };
    Some((told(takes), help))
}

/// A key that a table cannot do without.
fn without(field: &str, span: &Range<usize>, text: &str) -> (String, String) {
    let Some(key) = key_before(text, span.start).filter(|_| text[span.start..].starts_with('{')) else {
        let example = if field == "scene" { "\"terzaghi\"" } else { "\"what the study is about\"" };
        return (
            format!("the study has no `{field}`"),
            format!(
                "it needs `title`, `scene` and one [[sweep]] block or [[result]]: add `{field} = {example}` at the top"
            ),
        );
    };
    let takes = TAKES.iter().map(|(_, _, example)| *example);
    let example = takes.rev().find(|example| example.contains(&format!("{{ {field} =")));
    (
        format!("`{key}` has no `{field}`"),
        format!("write it like `{key} = {}`", example.unwrap_or("{ below = 1e-3 }")),
    )
}

/// What to write where a whole table is of the wrong kind.
fn of_a_header(expected: &str, written: &str) -> String {
    let name = written.trim_matches(['[', ']']);
    if expected == "a sequence" {
        format!("a block that can stand several times has two brackets: [[{name}]]")
    } else {
        format!("a table that stands once has one bracket: [{name}]")
    }
}

/// The text at a place, on one line and not too long.
fn written_at(text: &str, span: &Range<usize>) -> String {
    const LONGEST: usize = 40;
    let line = text.get(span.clone()).unwrap_or_default().lines().next().unwrap_or_default().trim();
    if line.chars().count() > LONGEST {
        line.chars().take(LONGEST).chain(['…']).collect()
    } else {
        line.to_owned()
    }
}

/// The key whose value stands at a place, or around it: the word before the last `=` outside the value.
fn key_before(text: &str, place: usize) -> Option<&str> {
    let before = text.get(..place)?;
    let line = before.trim_end_matches([' ', '\t']);
    if (line.is_empty() || line.ends_with('\n')) && text[place..].starts_with('[') {
        return None;
    }
    let statement = before.rfind("]\n").map_or(before, |end| &before[end + 1..]);
    let line = if before.ends_with(['=', ' ', '[', ',', '{', '\n']) { statement } else { "" };
    let (head, _) = line.rsplit_once('=')?;
    let key = head.trim_end().rsplit([' ', '\t', '\n', '{', ',', '.']).next()?;
    (!key.is_empty()).then_some(key)
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    /// What is said of a study with some lines in place of others.
    fn said(from: &str, to: &str) -> String {
        let text = "title = \"t\"\nscene = \"terzaghi\"\n\n[material]\nporosity = 0.3\n\n[[sweep]]\n\
                    method = [\"MPM\"]\ncells = [4, 8]\nmapping_back = [true]\n\n[[expect]]\nmethod = \"MPM\"\n\
                    time_factor = 0.1\norder = { value = 2.0 }\n";
        assert!(text.contains(from), "{from}");
        let source = StudySource { name: "t.toml".to_owned(), text: text.replacen(from, to, 1) };
        Study::check(&source).expect_err("refused").to_string()
    }

    #[test]
    fn the_commonest_mistakes_are_answered_with_what_to_write() {
        for (from, to, parts) in [
            (
                "order = { value = 2.0 }",
                "order = 2",
                ["`order` takes a band about an order", "`order = { value = 2, minus"],
            ),
            (
                "cells = [4, 8]",
                "cells = [4]\ntime_step = [1e-5]",
                ["`time_step` takes a rule", "[{ seconds = 1e-5 }]"],
            ),
            (
                "cells = [4, 8]",
                "cells = [4]\ntime_step = 1e-5",
                ["`time_step` takes a list", "[{ seconds = 1e-5 }]"],
            ),
            (
                "method = [\"MPM\"]",
                "method = \"MPM\"",
                ["`method` takes a list", "write `method = [\"MPM\"]`"],
            ),
            ("cells = [4, 8]", "cells = 4", ["`cells` takes a list", "write `cells = [4]`"]),
            ("cells = [4, 8]", "cells = [2.5]", ["`cells` takes a whole number", "`2.5` is none"]),
            ("porosity = 0.3", "porosity = \"0.3\"", ["`porosity` takes a number", "without quotes: `0.3`"]),
            ("porosity = 0.3", "porosity = \"a\"", ["`porosity` takes a number", "like `porosity = 0.1`"]),
            (
                "porosity = 0.3",
                "porosity = [0.3, 0.4]",
                ["one value here", "[[sweep]]: `porosity = [0.3, 0.4]`"],
            ),
            (
                "scene = \"terzaghi\"",
                "scene = [\"terzaghi\"]",
                ["a word in quotes", "`scene = \"terzaghi\"`"],
            ),
            ("cells = [4, 8]", "cells = \"4\"", ["`cells` takes a list", "write `cells = [4]`"]),
            ("[true]", "[\"yes\"]", ["`mapping_back` takes true or false", "`\"yes\"` is none"]),
            ("method = [\"MPM\"]", "method = [3]", ["`method` takes the name of a method", "GC-SRI-patch"]),
            (
                "time_factor = 0.1",
                "quantity = 3\ntime_factor = 0.1",
                ["`quantity` takes a word in quotes", "\"3\""],
            ),
            (
                "time_factor = 0.1",
                "time_factor = 0.1\nat = 1e-3",
                ["`at` takes a bound at a level", "cells = 10"],
            ),
            ("[[sweep]]", "[sweep]", ["stands where a table belongs", "[[sweep]]"]),
        ] {
            let said = said(from, to);
            for part in parts {
                assert!(said.contains(part), "`{to}`: no `{part}` in\n{said}");
            }
            for word in ["struct", "i64", "f64", "sequence", "invalid type", "boolean", "map,"] {
                assert!(!said.contains(word), "`{to}`: the parser's `{word}` in\n{said}");
            }
        }
    }
}
