//! The page that lists all studies by what they ask, and how their numbers were made.

use crate::case::Task;
use crate::case::grouping::{distinct, grouped};
use crate::case::method_words::method_words;
use crate::case::quantity::Norm;
use crate::judge::study_results::StudyResults;
use crate::render::page::{Block, Page, Section, slug};
use crate::render::table::{Cell, Mood, Table, columns};
use crate::report::answers::program_of;
use crate::report::study_page::mood_of;
use crate::study::check::Study;
use oedometer_scenes::scene::Question;
use oedometer_wording::count_of;

/// The list of studies, and how their numbers were made.
pub fn studies_page(all: &[StudyResults<'_>]) -> Page {
    let groups = groups(all);
    let mut sections: Vec<Section> = groups
        .iter()
        .map(|(question, studies)| Section {
            heading: ASKED[*question].to_owned(),
            id: slug(ASKED[*question]),
            mood: Some(Mood::of(studies.iter().all(|one| one.check.meets_all()))),
            blocks: vec![Block::Table(studies_table(studies))],
        })
        .collect();
    sections.push(numbers_section());
    sections.push(names_section(all));
    let link = |words: &str, target: &str| (words.to_owned(), target.to_owned());
    let first = all.iter().flat_map(|one| one.records).next();
    Page {
        title: "All studies".to_owned(),
        links: vec![
            link("All answers", "../index.html"),
            link("Method names", "#names"),
            link("How to read", "#how"),
        ],
        lead: format!(
            "{} of {}.",
            count_of(all.len(), "study", "studies"),
            count_of(groups.len(), "question", "questions")
        ),
        sections,
        footer: first.map_or(String::new(), |record| program_of(&record.provenance)),
        filter: Some("Filter studies by keyword".to_owned()),
        files: Some("studies".to_owned()),
        ..Page::default()
    }
}

/// What studies ask, in the order of a reader's questions.
const ASKED: [&str; 9] = [
    "Which method reaches 1 % at the least cost?",
    "How fast does the error fall at small strain?",
    "How fast does the error fall at large strain?",
    "Do points that move through the mesh converge?",
    "Do layers, slabs and footings in the plane lock?",
    "Do layered and yielding soils converge?",
    "Do waves keep their speed and height?",
    "Does a body under its own weight stay at rest?",
    "Which steps are stable?",
];

/// What a study asks, by its task and scene: its place in [`ASKED`].
fn asked(study: &Study) -> usize {
    if study.is_race {
        return 0;
    }
    if study.planned.iter().any(|planned| planned.case.task == Task::Stability) {
        return ASKED.len() - 1;
    }
    match study.scene.question {
        Question::SmallStrain => 1,
        Question::LargeStrain => 2,
        Question::MovingPoints => 3,
        Question::Locking => 4,
        Question::Layers => 5,
        Question::Waves => 6,
        Question::Rest => 7,
    }
}

/// Studies by what they ask.
fn groups<'r, 'a>(all: &'r [StudyResults<'a>]) -> Vec<(usize, Vec<&'r StudyResults<'a>>)> {
    let mut groups = grouped(all, |one| asked(one.study));
    groups.sort_by_key(|(question, _)| *question);
    groups
}

/// One row per study: how many of its expectations are met, and what runs it.
fn studies_table(studies: &[&StudyResults<'_>]) -> Table {
    let rows = studies.iter().map(|one| {
        let title = one.study.title.clone();
        vec![
            if one.has_page {
                Cell::Link { words: title, target: format!("{}.html", slug(&one.study.name)) }
            } else {
                Cell::Text(title)
            },
            Cell::Count(one.records.len() as u64),
            met_cell(one),
            Cell::Code(one.run_command()),
        ]
    });
    Table::of("", columns("study | > runs | expectations met | run it again"), rows)
}

/// How many expectations are met; without a mark if the study has none.
fn met_cell(one: &StudyResults<'_>) -> Cell {
    let words = match one.check.judgements.len() {
        0 => "no expectations".to_owned(),
        all => format!("{} of {all}", one.check.met()),
    };
    Cell::Verdict(mood_of(one), words)
}

/// The norms.
fn numbers_section() -> Section {
    let norms = Norm::ALL.iter().map(|norm| vec![Cell::Code(norm.name().to_owned()), norm.formula().into()]);
    let norms =
        Table::of("Norms", columns("norm | formula: x computed, x̂ exact, V volume of a sample"), norms)
            .note("the exact field is evaluated at the Lagrangian place of the sample");
    Section::new("How the numbers were made", "how", vec![Block::Table(norms)])
}

/// What the names of the methods stand for.
fn names_section(all: &[StudyResults<'_>]) -> Section {
    let records = all.iter().flat_map(|one| one.records);
    let names = distinct(records.map(|record| record.case.method.to_string()));
    let rows = names.into_iter().filter_map(|name| {
        let words = method_words(&name)?;
        Some(vec![Cell::Code(name), Cell::Text(words)])
    });
    Section::new(
        "Method names",
        "names",
        vec![Block::Table(Table::of("", columns("method | what it is"), rows))],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::Tier;
    use crate::judge::study_check::CaseNote;

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

    #[test]
    fn studies_stand_by_what_they_ask() {
        let text = |name: &str| {
            let scene = if name.starts_with("mesh") { "layered" } else { "terzaghi" };
            format!(
                "title = '{name}'\nscene = '{scene}'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                 integrator = ['implicit']\ncells = [2]\n"
            )
        };
        let mut all: Vec<(Study, _)> =
            ["zeta", "race-a", "mesh-a", "race-b", "mesh-b"].map(|name| solved(name, &text(name))).into();
        all[0].1[0].provenance.version = "0.0.1".to_owned();
        let results: Vec<StudyResults<'_>> =
            all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
        let page = studies_page(&results);
        let told = |section: &Section| {
            let Block::Table(table) = &section.blocks[0] else { panic!("{section:?}") };
            (
                section.heading.clone(),
                table.rows.iter().map(|row| row[0].show()).collect::<Vec<_>>().join(" "),
            )
        };
        let is = |heading: &str, studies: &str| (heading.to_owned(), studies.to_owned());
        let groups: Vec<_> = page.sections[..2].iter().map(told).collect();
        assert_eq!(groups, [is(ASKED[1], "zeta race-a race-b"), is(ASKED[5], "mesh-a mesh-b")]);
        assert_eq!(page.lead, "5 studies of 2 questions.");
        assert_eq!(studies_page(&results[..1]).lead, "1 study of 1 question.");
        assert!(
            page.footer.starts_with("oedometer 0.0.1 · commit `"),
            "that of the first record: {}",
            page.footer
        );
    }
}
