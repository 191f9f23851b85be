//! The page that lists all studies, and how their numbers were made.

use crate::case::quantity::Norm;
use crate::render::page::{Block, Page, Section, slug};
use crate::render::report::StudyResults;
use crate::render::report::labels::{capitalised, grouped};
use crate::render::table::{Cell, Mood, Table, columns};
use std::collections::BTreeMap;

/// The list of studies, and how their numbers were made.
pub fn index_page(results: &[StudyResults<'_>]) -> Page {
    let groups = groups(results);
    let mut sections: Vec<Section> = groups
        .iter()
        .map(|(name, studies)| Section {
            heading: capitalised(name),
            id: slug(name),
            mood: Some(Mood::of(studies.iter().all(|one| one.passes()))),
            blocks: vec![Block::Table(studies_table(studies))],
        })
        .collect();
    sections.push(numbers_section(results));
    Page {
        title: "All studies".to_owned(),
        lead: format!("{} studies in {} groups. [The answers](../index.html).", results.len(), groups.len()),
        sections,
        footer: footer(results),
        filter: Some("Words that a study has".to_owned()),
        files: Some("studies".to_owned()),
        ..Page::default()
    }
}

/// Studies by the first word of their names where several share it; the others together, last.
fn groups<'b, 'a>(results: &'b [StudyResults<'a>]) -> Vec<(&'b str, Vec<&'b StudyResults<'a>>)> {
    let first_word = |one: &'b StudyResults<'_>| one.study.name.split('-').next().unwrap_or_default();
    let mut groups = grouped(results.iter().map(|one| {
        let word = first_word(one);
        let is_shared = results.iter().filter(|other| first_word(other) == word).count() > 1;
        (if is_shared { word } else { "other" }, one)
    }));
    groups.sort_by_key(|(name, _)| *name == "other");
    groups
}

/// One row per study: how many of its expectations are met, and what runs it.
fn studies_table(studies: &[&StudyResults<'_>]) -> Table {
    let rows = studies.iter().map(|one| {
        vec![
            Cell::Link { words: one.study.title.clone(), target: format!("{}.html", slug(&one.study.name)) },
            Cell::Count(one.records.len() as u64),
            met_cell(one),
            Cell::Code(one.run_command()),
        ]
    });
    Table::of("", columns("study | > runs | expectations met | run it again"), rows)
}

/// How many expectations are met; without a mark if the study has none.
fn met_cell(one: &StudyResults<'_>) -> Cell {
    let mood = if one.judgements.is_empty() && one.passes() { Mood::Note } else { Mood::of(one.passes()) };
    let words = match one.judgements.len() {
        0 => "no expectations".to_owned(),
        all => format!("{} of {all}", one.met()),
    };
    Cell::Verdict(mood, words)
}

/// Norms and references of all records.
fn numbers_section(results: &[StudyResults<'_>]) -> Section {
    let norms = Norm::ALL.iter().map(|norm| vec![Cell::Code(norm.name().to_owned()), norm.formula().into()]);
    let mut used: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for reference in results.iter().flat_map(|one| one.records).flat_map(|record| &record.references) {
        let entry = used.entry(reference.name.as_str()).or_default();
        entry.0 = entry.0.max(reference.terms);
        entry.1 = entry.1.max(reference.tail_bound);
    }
    let references = used.iter().map(|(name, (terms, tail))| {
        vec![Cell::Code((*name).to_owned()), Cell::Count(*terms as u64), Cell::Error(*tail)]
    });
    let blocks = vec![
        Block::Table(
            Table::of("Norms", columns("norm | formula: x computed, x̂ exact, V volume of a sample"), norms)
                .note("the exact field is evaluated at the Lagrangian place of the sample"),
        ),
        Block::Table(
            Table::of(
                "References",
                columns("reference | > terms at most | > tail bound, over the load"),
                references,
            )
            .note(
                "terzaghi: with the water's compressibility; terzaghi-incompressible: the textbook's; \
                 single-mode: slowest mode, with the water's compressibility",
            ),
        ),
    ];
    Section::new("How the numbers were made", "how", blocks)
}

/// The program that made the records.
fn footer(results: &[StudyResults<'_>]) -> String {
    let provenance = results.iter().flat_map(|one| one.records).map(|record| &record.provenance).next();
    provenance.map_or(String::new(), |origin| {
        format!(
            "oedometer {}, sources {}, {}, {}, {} profile",
            origin.version, origin.sources, origin.compiler, origin.target, origin.profile
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::Tier;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    #[test]
    fn a_study_is_marked_by_what_is_met_and_by_what_is_wrong_with_its_records() {
        let of = |bounds: &[f64], wrong: usize| {
            let expect = |below: &f64| {
                format!("[[expect_case]]\ntime_factor = 0.2\nerror = {{ below = {below:e} }}\n")
            };
            let text =
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = ['GIMP']\n\
                        integrator = ['implicit']\ncells = [4]\n"
                    .to_owned() + &bounds.iter().map(expect).collect::<String>();
            let source = StudySource { name: "s.toml".to_owned(), text: text.clone() };
            let (study, records) = (Study::check(&source).expect("sound"), records_of(&text));
            let mut results = StudyResults::new(&study, &records, Tier::Full);
            results.unsound = vec![("a case".to_owned(), "why".to_owned()); wrong];
            met_cell(&results)
        };
        for (bounds, wrong, mood, words) in [
            (&[0.9, 0.8][..], 0, Mood::Pass, "2 of 2"),
            (&[0.9, 1e-9], 0, Mood::Fail, "1 of 2"),
            (&[0.9], 1, Mood::Fail, "1 of 1"),
            (&[], 0, Mood::Note, "no expectations"),
            (&[], 1, Mood::Fail, "no expectations"),
        ] {
            assert_eq!(of(bounds, wrong), Cell::Verdict(mood, words.to_owned()), "{bounds:?}");
        }
    }
}
