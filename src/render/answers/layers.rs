//! One layer of material points or two? Runs that differ in that alone, by their situation.

use crate::case::keys::{Key, Value};
use crate::judge::comparison::twins::{Twins, TwinsOfSituation, by_situation, twins};
use crate::render::answers::question::{Answer, Links, Question, links_to, short};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};

/// The question.
pub const QUESTION: Question = Question { heading: "One layer of material points, or two?", id: "layers" };

/// The key that says how many, and the table of a study file that has it.
const KEY: [&str; 2] = ["layers", "points"];

/// Error, robustness and cost of two layers beside one.
pub fn answer(results: &[StudyResults<'_>], links: Links<'_>) -> Answer {
    let needed = "runs that differ in `points.layers` alone";
    Key::named(KEY[0], KEY[1])
        .and_then(|key| compare(results, key, links))
        .unwrap_or_else(|| QUESTION.open(needed))
}

/// The comparison by a key of two values, one and two; none where no study has twins.
fn compare(results: &[StudyResults<'_>], key: &Key, links: Links<'_>) -> Option<Answer> {
    let mut all: Vec<Twins<'_>> = Vec::new();
    let mut studies: Vec<&str> = Vec::new();
    for one in results {
        let own = twins(one.records, key, (Value::Count(1), Value::Count(2)));
        if !own.is_empty() {
            studies.push(&one.study.name);
        }
        all.extend(own);
    }
    let told = by_situation(&all);
    if told.is_empty() {
        return None;
    }
    let rows = told.iter().map(|one| {
        let error =
            |side: usize| Cell::of(one.errors.map(|both| both[side]), Cell::Error, "no pair has an error");
        vec![
            one.situation.name().into(),
            Cell::Count(one.pairs as u64),
            error(0),
            error(1),
            Cell::Count(one.failed[0] as u64),
            Cell::Count(one.failed[1] as u64),
            Cell::of(one.cost, Cell::Number, "not timed"),
        ]
    });
    let header = "situation | > pairs of runs | > largest error, one layer | > two layers | > failed, one layer | > two layers \
                  | > time of two over one";
    let table = Table::of("", columns(header), rows)
        .note("pairs of runs that differ in the layers alone; error of the pressure at the points at the last output");
    let sentence = format!("{} Evidence: {}.", sentence(&told), links_to(links, studies));
    Some(QUESTION.told(sentence, vec![Block::Table(short(table, "in the studies"))]))
}

fn sentence(told: &[TwinsOfSituation]) -> String {
    let pairs: usize = told.iter().map(|one| one.pairs).sum();
    let failed = [0, 1].map(|side| told.iter().map(|one| one.failed[side]).sum::<usize>());
    let ratios: Vec<f64> = told.iter().filter_map(|one| one.errors).map(|[one, two]| two / one).collect();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(0.0, f64::max);
    let errors = match ratios.as_slice() {
        [] => String::new(),
        _ => format!(
            "the largest error of two layers is {} to {} times that of one, by situation; ",
            number::number(least),
            number::number(most)
        ),
    };
    format!(
        "Over {pairs} pairs of runs {errors}{} runs with one layer and {} with two ended before their last output.",
        failed[0], failed[1]
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::tier::Tier;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    #[test]
    fn two_are_held_against_one_by_situation_and_nothing_is_said_without_both() {
        let text = "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
                    integrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = [1, 2]\n";
        let source = StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
        let study = Study::check(&source).expect("a sound study");
        let records = records_of(text);
        let results = [StudyResults::new(&study, &records, Tier::Full)];
        let links = |study: &str| format!("{study}.html");
        // Any key of one and two will do.
        let key = Key::named("points_per_cell", "sweep").expect("a key");
        let Some(Answer::Told(section)) = compare(&results, key, &links) else { panic!("both are there") };
        let Some(Block::Paragraph(sentence)) = section.blocks.first() else { panic!("a sentence first") };
        assert!(
            sentence.starts_with("Over 2 pairs of runs the largest error of two layers is "),
            "{sentence}"
        );
        assert!(sentence.ends_with("0 runs with one layer and 0 with two ended before their last output. Evidence: [`s`](s.html)."), "{sentence}");
        let dimensions = Key::named("dimensions", "column").expect("a key");
        assert!(compare(&results, dimensions, &links).is_none());
    }
}
