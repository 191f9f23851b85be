//! Reads on after misspelt keys and words, so that all mistakes of a study are reported at once.

use crate::study::check::{Purpose, Study};
use crate::study::diagnostic::{Diagnostic, StudyError};
use crate::study::file::StudySource;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Words before the name of what was probably meant.
const MEANT: [&str; 2] = ["did you mean `", "it is called `"];
/// Words about a key in a wrong table: what its right one lacks then is not known.
const MISPLACED: &str = "` belongs to ";
/// A mistake of an expectation that no other key of it makes or hides.
const TIMELESS: &str = "names no time factor";
/// Words of mistakes that follow from the time factors of a body.
const OF_TIMES: [&str; 2] = [" is T_v = ", "no case has an output at T_v = "];
/// Tables of the body, whose keys change what the time factors of all outputs are.
const BODY: [&str; 3] = ["column", "layer", "material"];
/// Words before a line as it would be right, and before an example of one.
const RIGHT: [&str; 3] = ["write `", "without quotes: `", "like `"];

/// A text whose wrong lines are mended or left out.
struct Mended {
    text: String,
    /// Numbers of the wrong lines.
    lines: BTreeSet<usize>,
    /// Those whose value is not known now.
    unknown: BTreeMap<usize, Unknown>,
}

/// A key that was left out.
struct Unknown {
    key: String,
    /// The table that it belongs to.
    table: String,
    kind: UnknownKind,
}

/// Why a key was left out.
#[derive(Clone, Copy, PartialEq, Eq)]
enum UnknownKind {
    /// Its value cannot be read.
    Value,
    /// It stands in another table than the one it belongs to.
    Misplaced,
    /// No key has its name: which one was meant is not known.
    Name,
}

/// Adds to the mistakes that kept a study from being read those that show once these are mended: a misspelt word is taken
/// for the one that it was probably meant to be, and any other wrong line is left out.
pub fn with_later_mistakes(mut error: StudyError, purpose: Purpose) -> StudyError {
    let Some(mended) = mended(&error) else { return error };
    let source = StudySource { name: error.name.clone(), text: mended.text.clone() };
    let Err(later) = Study::check_read(&source, purpose) else { return error };
    let moved = later.diagnostics.into_iter().filter_map(|mistake| {
        let (line, columns) = place(&source.text, mistake.span.as_ref()?)?;
        let span = mended.is_sure(line, &mistake.message).then(|| bytes(&error.source, line, columns))??;
        Some(Diagnostic { span: Some(span), ..mistake })
    });
    let moved: Vec<Diagnostic> = moved.filter(|mistake| !error.diagnostics.contains(mistake)).collect();
    error.diagnostics.extend(moved);
    error
}

impl Mended {
    /// Whether a mistake at a line does not follow from a line that was left out: it lies in another block;
    /// expectations depend on sweeps and outputs, and these on the values before them.
    fn is_sure(&self, line: usize, message: &str) -> bool {
        let lines: Vec<&str> = self.text.split('\n').collect();
        let here = block(&lines, line);
        let table_here = table_of(&lines, line);
        let is_timeless = message.ends_with(TIMELESS);
        let is_sure = |(number, unknown): (&usize, &Unknown)| {
            let is_expected = table_here.starts_with("expect");
            if is_timeless {
                return !unknown.key.starts_with("time");
            }
            let is_same = match unknown.kind {
                UnknownKind::Misplaced => unknown.table == table_here,
                UnknownKind::Value => block(&lines, *number) == here && here.is_some(),
                UnknownKind::Name if unknown.table == table_here => return true,
                UnknownKind::Name => false,
            };
            !is_same
                && match unknown.table.as_str() {
                    "sweep" | "output" => !is_expected,
                    table if table.starts_with("expect") => true,
                    // The times of a body of unknown size or soil are unknown too.
                    _ if OF_TIMES.iter().any(|words| message.contains(words)) => false,
                    // What is said of a key of another table by its name is true whatever the value.
                    _ => is_expected || message.starts_with(&format!("`{table_here}.")),
                }
        };
        !self.lines.contains(&line) && self.unknown.iter().all(is_sure)
    }
}

/// The text with its wrong lines mended; `None` where a mistake has no place.
fn mended(error: &StudyError) -> Option<Mended> {
    let source: Vec<&str> = error.source.split('\n').collect();
    let mut lines: Vec<String> = source.iter().map(|&line| line.to_owned()).collect();
    let (mut numbers, mut unknown) = (BTreeSet::new(), BTreeMap::new());
    for mistake in &error.diagnostics {
        let (number, columns) = place(&error.source, mistake.span.as_ref()?)?;
        let line = lines.get_mut(number)?;
        let is_entry = line.contains('=') && !line.trim_start().starts_with(['[', '#']);
        if !is_entry || !numbers.insert(number) {
            return None;
        }
        let word = line.get(columns.clone())?.to_owned();
        let quoted =
            |words: &str| mistake.help.as_deref()?.split_once(words)?.1.split_once('`').map(|(text, _)| text);
        let key = line[..line.find('=')?].trim().to_owned();
        let unknown_in = |table: String, kind| Unknown { key: key.clone(), table, kind };
        if let Some((_, home)) = mistake.help.as_deref().and_then(|help| help.split_once(MISPLACED)) {
            let home = home.split(':').next().unwrap_or_default().trim_matches(['[', ']']).to_owned();
            line.insert(0, '#');
            unknown.insert(number, unknown_in(home, UnknownKind::Misplaced));
            continue;
        }
        let right = RIGHT.iter().find_map(|words| quoted(words).map(|text| (text, *words)));
        let right = right.filter(|(text, _)| text.split_once(" =").is_some_and(|(name, _)| name == key));
        match (MEANT.iter().find_map(|words| quoted(words)), right) {
            // A value in quotes; a key keeps its line only by its right name.
            (Some(meant), _) if word.starts_with(['"', '\'']) => {
                line.replace_range(columns, &format!("\"{meant}\""));
            }
            (Some(meant), _) if columns.end <= line.find('=')? && !has_key(&source, number, meant) => {
                line.replace_range(columns, meant);
            }
            (None, Some((right, words))) => {
                right.clone_into(line);
                if words == RIGHT[2] {
                    unknown.insert(number, unknown_in(table_of(&source, number), UnknownKind::Value));
                }
            }
            _ => {
                line.insert(0, '#');
                let table = table_of(&source, number);
                if !mistake.message.starts_with("unknown key") {
                    unknown.insert(number, unknown_in(table, UnknownKind::Value));
                } else if BODY.contains(&table.as_str()) {
                    unknown.insert(number, unknown_in(table, UnknownKind::Name));
                }
            }
        }
    }
    (!numbers.is_empty()).then(|| Mended { text: lines.join("\n"), lines: numbers, unknown })
}

/// Whether the block of a line has a key already.
fn has_key(lines: &[&str], number: usize, key: &str) -> bool {
    let here = block(lines, number);
    let is_key = |line: &str| line.split_once('=').is_some_and(|(name, _)| name.trim() == key);
    (0..lines.len()).any(|place| block(lines, place) == here && is_key(lines[place]))
}

/// Number of the header above a line, or its own; `None` before the first one.
fn block(lines: &[&str], number: usize) -> Option<usize> {
    (0..=number).rev().find(|place| lines.get(*place).is_some_and(|line| line.trim_start().starts_with('[')))
}

/// The table in which a line stands: its header, or the first part of its key.
fn table_of(lines: &[&str], number: usize) -> String {
    let header = block(lines, number).and_then(|place| lines.get(place));
    let name = header.map_or_else(
        || lines.get(number).and_then(|line| line.trim_start_matches('#').split(['=', '.']).next()),
        |header| header.split(['#', '.']).next(),
    );
    name.unwrap_or_default().trim().trim_matches(['[', ']', ' ']).to_owned()
}

/// Line of a span, counted from 0, and its bytes in that line.
fn place(text: &str, span: &Range<usize>) -> Option<(usize, Range<usize>)> {
    let before = text.get(..span.start)?;
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[span.start..].find('\n').map_or(text.len(), |newline| span.start + newline);
    Some((before.matches('\n').count(), span.start - start..span.end.min(end) - start))
}

/// The bytes of a part of a line.
fn bytes(text: &str, line: usize, columns: Range<usize>) -> Option<Range<usize>> {
    let start = text.split_inclusive('\n').take(line).map(str::len).sum::<usize>();
    let end = start + columns.end;
    (end <= text.len()).then_some(start + columns.start..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_of_all_kinds_are_told_at_once_each_at_its_place() {
        let text = "title = \"t\"\nscene = \"terzagi\"\n[material]\nporosity = 3.0\n[[sweep]]\nmethod = [\"GC-SRI-pach\"]\ncells = [2]\n\
                    [[expect]]\nmethod = \"GC-SRI-patch\"\nquantity = \"presure\"\nordr = { value = 2.0 }\n";
        let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
        let error = Study::check(&source).expect_err("five mistakes");
        let at: Vec<&str> =
            error.diagnostics.iter().filter_map(|mistake| text.get(mistake.span.clone()?)).collect();
        let told = error.to_string();
        for place in ["\"terzagi\"", "\"presure\"", "3.0", "\"GC-SRI-pach\""] {
            assert!(at.contains(&place), "{place}: {at:?}\n{told}");
        }
        assert!(told.contains("names no time factor") && told.contains("`ordr`"), "{told}");
        // What is sound but for its spelling has that mistake alone.
        let sound =
            "title = \"t\"\nscene = \"terzagi\"\n[[sweep]]\nmethod = [\"GC-SRI-patch\"]\ncells = [2]\n";
        let source = StudySource { name: "t.toml".to_owned(), text: sound.to_owned() };
        assert_eq!(Study::check(&source).expect_err("one mistake").diagnostics.len(), 1);
    }

    #[test]
    fn what_is_left_out_makes_no_mistake_elsewhere() {
        let sound = "title = \"t\"\nscene = \"terzaghi\"\n[output]\ntime_factors = [0.1]\n[column]\nheight = 1.0\n[[sweep]]\n\
                     method = [\"GC-SRI-patch\"]\ncells = [4, 8, 16]\n[[expect]]\nmethod = \"GC-SRI-patch\"\nquantity = \"pressure\"\n\
                     time_factor = 0.1\norder = { value = 2.0 }\n";
        let count = |old: &str, new: &str| {
            assert!(sound.contains(old), "{old}");
            let source = StudySource { name: "t.toml".to_owned(), text: sound.replacen(old, new, 1) };
            Study::check(&source).expect_err(new).diagnostics.len()
        };
        for (old, new) in [
            ("[0.1]", "[\"late\"]"),
            ("[0.1]", "\"late\""),
            ("1.0", "\"tall\""),
            ("[\"GC-SRI-patch\"]", "\"GC-SRI-patch\""),
            ("[\"GC-SRI-patch\"]", "[3]"),
            ("[4, 8, 16]", "[4, 8, 16.5]"),
            ("{ value = 2.0 }", "2.0"),
            ("time_factor = 0.1", "time_factor = true"),
        ] {
            assert_eq!(count(old, new), 1, "{new}");
        }
        // A key twice, once misspelt; a key in a table that is not its own; and what else is wrong.
        for (old, new, count_of_all) in [
            ("cells = [4, 8, 16]", "cells = [4, 8, 16]\ncellz = 3", 1),
            ("height = 1.0", "height = 1.0\nporosity = 3.0\ncells = [3]", 2),
            ("cells = [4, 8, 16]", "", 1),
            ("title = \"t\"", "title = \"t\"\ncells = [4]", 1),
        ] {
            assert_eq!(count(old, new), count_of_all, "{new}");
            let timeless = sound.replace("time_factor = 0.1\n", "");
            let source = StudySource { name: "t.toml".to_owned(), text: timeless.replacen(old, new, 1) };
            let told = Study::check(&source).expect_err(new).to_string();
            assert!(told.contains("names no time factor"), "{new}: {told}");
        }
        // A wrong value in another table than that of a misplaced key is told with it.
        let misplaced = sound.replace("[output]", "height = 2.0\n[material]\nporosity = 4.0\n[output]");
        let source = StudySource { name: "t.toml".to_owned(), text: misplaced };
        let told = Study::check(&source).expect_err("two mistakes").to_string();
        assert!(told.contains("`height` belongs to") && told.contains("`material.porosity` is 4"), "{told}");
        // A second mistake elsewhere is told with each of them.
        let wrong = sound.replace("\"pressure\"", "\"presure\"");
        for (old, new) in [("[\"GC-SRI-patch\"]", "\"GC-SRI-patch\""), ("1.0", "\"tall\"")] {
            let source = StudySource { name: "t.toml".to_owned(), text: wrong.replacen(old, new, 1) };
            assert_eq!(Study::check(&source).expect_err(new).diagnostics.len(), 2, "{new}");
        }
    }

    /// A soft clay: an unknown key of its soil leaves the default soil, in which the times and the load are impossible.
    #[test]
    fn an_unknown_key_of_the_soil_makes_no_mistake_of_times_and_hides_no_other() {
        let clay = |soil: &str, rest: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n[column]\nheight = 5.0\nload = '50 kPa'\n[material]\n\
                 youngs_modulus = '2 MPa'\n{soil}\n[output]\ntimes = ['30 days', '1 year']\n[[sweep]]\n\
                 method = ['MPM']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n[[expect]]\nmethod = 'MPM'\n\
                 quantity = 'settlement'\ntime = '1 year'\nat = {{ cells = 10, below = '1 %' }}\n{rest}"
            );
            Study::check(&StudySource { name: "t.toml".to_owned(), text }).map(|study| study.planned.len())
        };
        assert_eq!(clay("hydraulic_conductivity = 1e-9", "").expect("sound"), 3);
        for (soil, rest, said) in [
            ("permeability = 1e-9", "", &["did you mean `hydraulic_conductivity`?"][..]),
            ("seepage = 1e-9", "", &["unknown key `seepage`"]),
            ("void_ratio = 1.0", "", &["n = e/(1 + e): `porosity`"]),
            (
                "permeability = 1e-9\nporosity = 3.0",
                "",
                &["hydraulic_conductivity", "`material.porosity` is 3"],
            ),
            ("seepage = 1e-9\nporosity = 3.0", "", &["seepage", "`material.porosity` is 3"]),
            ("seepage = 1e-9", "clas = 'locked'", &["seepage", "did you mean `class`?"]),
        ] {
            let error = clay(soil, rest).expect_err(soil);
            assert_eq!(error.diagnostics.len(), said.len(), "{error}");
            assert!(said.iter().all(|words| error.to_string().contains(words)), "{error}");
        }
    }

    #[test]
    fn an_expectation_tells_all_that_it_lacks() {
        let text = "title = 't'\nscene = 'terzaghi'\n[[sweep]]\nmethod = ['GC-SRI-patch']\ncells = [2]\n\
                    [[expect]]\nmethod = 'GC-SRI-patch'\nquantity = 'settlement'\nsample = 'nodes'\nreference = 'xie-leo'\n";
        let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
        let told = Study::check(&source).expect_err("three mistakes").to_string();
        for words in ["a settlement", "xie-leo", "names no time factor"] {
            assert!(told.contains(words), "{words}: {told}");
        }
    }
}
