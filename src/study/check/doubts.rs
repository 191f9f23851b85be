//! Diagnostics that follow from keys which were left out: of a study with mistakes in its text the rest is checked too, and what
//! rests on an unknown value is not said.

use crate::study::diagnostic::Diagnostic;
use oedometer_input::mending::{Block, LeftOut};
use std::ops::Range;
use toml::de::DeTable;

/// What a diagnostic rests on, besides the text at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Basis {
    /// Nothing.
    Text,
    /// No key whose name begins so stands beside it.
    Lack(&'static str),
    /// The times of the cases, and so all inputs of the body.
    Times,
    /// Values of its own block, and of the blocks that this one rests on.
    Values,
}

/// A diagnostic and what it rests on.
#[derive(Debug)]
pub(super) struct Complaint {
    pub(super) diagnostic: Diagnostic,
    pub(super) basis: Basis,
}

/// Places of the mistakes of a text, and keys that were left out for them.
pub(super) struct Doubts<'a> {
    pub(super) text: &'a str,
    pub(super) places: Vec<Range<usize>>,
    pub(super) left_out: Vec<LeftOut>,
}

impl Doubts<'_> {
    /// The diagnostics that do not follow from what was left out.
    pub(super) fn sure(&self, complaints: Vec<Complaint>) -> impl Iterator<Item = Diagnostic> {
        let root = DeTable::parse(self.text).ok();
        let is_sure = move |complaint: &Complaint| {
            let Some(place) = &complaint.diagnostic.span else { return false };
            let here = root.as_ref().and_then(|root| Block::at(root.get_ref(), place.start));
            let is_mistake = |known: &Range<usize>| known.start < place.end && place.start < known.end;
            !self.places.iter().any(is_mistake)
                && self.left_out.iter().all(|key| !hides(key, here.as_ref(), complaint.basis))
        };
        complaints.into_iter().filter(is_sure).map(|complaint| complaint.diagnostic)
    }
}

/// Whether a diagnostic in a block may follow from a key that was left out: expectations rest on sweeps and outputs, these on the
/// body, and all of them on their own block.
fn hides(key: &LeftOut, here: Option<&Block>, basis: Basis) -> bool {
    let table = here.map_or("", |block| block.table.as_str());
    let is_same = match &key.block {
        Some(block) => here == Some(block),
        None => key.table == table,
    };
    let is_expected = table.starts_with("expect");
    match basis {
        Basis::Text => false,
        Basis::Lack(name) => key.key.starts_with(name),
        _ if is_same => true,
        Basis::Times | Basis::Values => match key.table.as_str() {
            "sweep" | "output" => is_expected,
            expect if expect.starts_with("expect") => false,
            _ => basis == Basis::Times || !is_expected,
        },
    }
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

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
