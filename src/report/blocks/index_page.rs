//! The page that lists all studies by what they ask, and how their numbers were made.

use crate::case::grouping::{distinct, grouped};
use crate::case::method_words::method_words;
use crate::case::quantity::Norm;
use crate::questions::study_findings::{AllStudies, StudyFindings, StudyQuestion};
use crate::record::provenance::Provenance;
use crate::render::page::{Block, Page, Section, slug};
use crate::render::table::{Cell, Mood, Table, columns};
use oedometer_soil::wording::count_of;

/// The list of studies, and how their numbers were made.
pub fn index_page(all: &AllStudies) -> Page {
    let groups = groups(&all.studies);
    let mut sections: Vec<Section> = groups
        .iter()
        .map(|(question, studies)| Section {
            heading: words_of(*question).to_owned(),
            id: slug(words_of(*question)),
            mood: Some(Mood::of(studies.iter().all(|study| study.passes))),
            blocks: vec![Block::Table(studies_table(studies))],
        })
        .collect();
    sections.push(numbers_section(all));
    sections.push(names_section(&all.studies));
    let link = |words: &str, target: &str| (words.to_owned(), target.to_owned());
    Page {
        title: "All studies".to_owned(),
        links: vec![
            link("All answers", "../index.html"),
            link("Method names", "#names"),
            link("How to read", "#how"),
        ],
        lead: format!(
            "{} of {}.",
            count_of(all.studies.len(), "study", "studies"),
            count_of(groups.len(), "question", "questions")
        ),
        sections,
        footer: all.first_origin.as_ref().map_or(String::new(), footer),
        filter: Some("Words that a study has".to_owned()),
        files: Some("studies".to_owned()),
        ..Page::default()
    }
}

/// Studies by what they ask, in the order of a reader's questions.
fn groups(studies: &[StudyFindings]) -> Vec<(StudyQuestion, Vec<&StudyFindings>)> {
    let mut groups = grouped(studies, |study| study.question);
    groups.sort_by_key(|(question, _)| *question);
    groups
}

/// What studies ask.
fn words_of(question: StudyQuestion) -> &'static str {
    match question {
        StudyQuestion::Race => "Which method reaches 1 % at the least cost?",
        StudyQuestion::SmallStrain => "How fast does the error fall at small strain?",
        StudyQuestion::LargeStrain => "How fast does the error fall at large strain?",
        StudyQuestion::MovingPoints => "Do points that move through the mesh converge?",
        StudyQuestion::Locking => "Do layers, slabs and footings in the plane lock?",
        StudyQuestion::Layers => "Do layered and yielding soils converge?",
        StudyQuestion::Waves => "Do waves keep their speed and height?",
        StudyQuestion::Rest => "Does a body under its own weight stay at rest?",
        StudyQuestion::Stability => "Which steps are stable?",
    }
}

/// One row per study: how many of its expectations are met, and what runs it.
fn studies_table(studies: &[&StudyFindings]) -> Table {
    let rows = studies.iter().map(|one| {
        vec![
            if one.has_page {
                Cell::Link { words: one.title.clone(), target: format!("{}.html", slug(&one.name)) }
            } else {
                Cell::Text(one.title.clone())
            },
            Cell::Count(one.runs as u64),
            met_cell(one),
            Cell::Code(one.run_command.clone()),
        ]
    });
    Table::of("", columns("study | > runs | expectations met | run it again"), rows)
}

/// How many expectations are met; without a mark if the study has none.
fn met_cell(one: &StudyFindings) -> Cell {
    let mood = if one.judgements.is_empty() && one.passes { Mood::Note } else { Mood::of(one.passes) };
    let words = match one.judgements.len() {
        0 => "no expectations".to_owned(),
        all => format!("{} of {all}", one.met),
    };
    Cell::Verdict(mood, words)
}

/// Norms and references of all records.
fn numbers_section(all: &AllStudies) -> Section {
    let norms = Norm::ALL.iter().map(|norm| vec![Cell::Code(norm.name().to_owned()), norm.formula().into()]);
    let references = all.references.iter().map(|used| {
        vec![Cell::Code(used.name.clone()), Cell::Count(used.terms as u64), Cell::Error(used.tail_bound)]
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
                 single-mode: first eigenmode, with the water's compressibility",
            ),
        ),
    ];
    Section::new("How the numbers were made", "how", blocks)
}

/// What the names of the methods stand for.
fn names_section(studies: &[StudyFindings]) -> Section {
    let names = distinct(studies.iter().flat_map(|study| study.methods.iter().map(String::as_str)));
    let rows = names
        .into_iter()
        .filter_map(|name| Some(vec![Cell::Code(name.to_owned()), Cell::Text(method_words(name)?)]));
    Section::new(
        "Method names",
        "names",
        vec![Block::Table(Table::of("", columns("method | what it is"), rows))],
    )
}

/// The program that made the records.
fn footer(origin: &Provenance) -> String {
    format!(
        "oedometer {}, sources {}, {}, {}, {} profile",
        origin.version, origin.sources, origin.compiler, origin.target, origin.profile
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::Tier;
    use crate::judge::study_check::CaseNote;
    use crate::questions::study_results::StudyResults;
    use crate::study::check::Study;

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
            let (study, records) = solved("s", &text);
            let mut results = StudyResults::new(&study, &records, Tier::Full);
            let (case, sentence) = ("a case".to_owned(), "why".to_owned());
            results.check.unsound = vec![CaseNote { case, sentence }; wrong];
            met_cell(&results.findings().expect("sound cases"))
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

    #[test]
    fn studies_stand_by_what_they_ask_and_norms_and_references_once() {
        let text = |name: &str| {
            let scene = if name.starts_with("mesh") { "layered" } else { "terzaghi" };
            format!(
                "title = '{name}'\nscene = '{scene}'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                 integrator = ['implicit']\ncells = [2]\n"
            )
        };
        let mut all: Vec<(Study, _)> =
            ["zeta", "race-a", "mesh-a", "race-b", "mesh-b"].map(|name| solved(name, &text(name))).into();
        // The largest of each, wherever they stand.
        for ((_, records), (terms, tail)) in
            all.iter_mut().zip([(3, 1e-9), (9, 1e-12), (5, 1e-8), (1, 0.0), (2, 0.0)])
        {
            (records[0].references[0].terms, records[0].references[0].tail_bound) = (terms, tail);
            records[0].references.truncate(1);
        }
        all[0].1[0].provenance.version = "0.0.1".to_owned();
        let results: Vec<StudyResults<'_>> =
            all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
        let index =
            |results: &[StudyResults<'_>]| index_page(&AllStudies::new(results).expect("sound cases"));
        let page = index(&results);
        let told = |section: &Section| {
            let Block::Table(table) = &section.blocks[0] else { panic!("{section:?}") };
            (
                section.heading.clone(),
                table.rows.iter().map(|row| row[0].show()).collect::<Vec<_>>().join(" "),
            )
        };
        let is = |heading: &str, studies: &str| (heading.to_owned(), studies.to_owned());
        let groups: Vec<_> = page.sections[..2].iter().map(told).collect();
        assert_eq!(
            groups,
            [
                is(words_of(StudyQuestion::SmallStrain), "zeta race-a race-b"),
                is(words_of(StudyQuestion::Layers), "mesh-a mesh-b")
            ]
        );
        assert_eq!(page.lead, "5 studies of 2 questions.");
        assert_eq!(index(&results[..1]).lead, "1 study of 1 question.");
        assert!(
            page.footer.starts_with("oedometer 0.0.1, sources "),
            "that of the first record: {}",
            page.footer
        );
        let Block::Table(references) = &page.sections[2].blocks[1] else { panic!("norms, then references") };
        let row = |name: &str, terms: u64, tail: f64| {
            vec![Cell::Code(name.to_owned()), Cell::Count(terms), Cell::Error(tail)]
        };
        assert_eq!(references.rows, [row("layered", 5, 1e-8), row("terzaghi", 9, 1e-9)]);
    }
}
