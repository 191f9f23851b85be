//! One layer of material points or two? Runs that differ in that alone, by their situation.

use crate::case::keys::{Key, Value};
use crate::judge::comparison::twins::{Twins, TwinsOfSituation, by_situation, twins};
use crate::measure::record_checks::has_burst;
use crate::render::answers::question::{Answer, Links, Question, links_to, short};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};
use crate::render::tables::golden_changes::count_of;

/// The question.
pub const QUESTION: Question = Question { heading: "One layer of material points, or two?", id: "layers" };

/// The key that says how many, and the table of a study file that has it.
const KEY: [&str; 2] = ["sets", "points"];

/// Error, robustness and cost of two layers beside one.
pub fn answer(results: &[StudyResults<'_>], links: Links<'_>) -> Answer {
    let needed = "runs that differ in `points.sets` alone";
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
        let ratio =
            |place: usize| Cell::of(one.ratios.map(|all| all[place]), Cell::Number, "no pair has an error");
        vec![
            one.situation.name().into(),
            one.method.map_or(Cell::Text(others(&told, one)), |method| Cell::Code(method.to_string())),
            Cell::Count(one.pairs as u64),
            ratio(0),
            ratio(1),
            ratio(2),
            Cell::Count(one.failed[0] as u64),
            Cell::Count(one.failed[1] as u64),
            Cell::of(one.cost, Cell::Number, "not timed"),
        ]
    });
    let header = "situation | method | > pairs of runs | > error of two over that of one: least | > median | > largest \
                  | > failed, one layer | > two layers | > time of two over one";
    let bursts = bursts(results);
    let table = Table::of("", columns(header), rows)
        .note("pairs of runs that differ in the layers alone; error of the pressure at the points, at every output of a pair")
        .note(burst_note(&bursts));
    let sentence = format!("{} Evidence: {}.", sentence(&told, bursts.len()), links_to(links, studies));
    Some(QUESTION.told(sentence, vec![Block::Table(short(table, "in the studies"))]))
}

/// Runs of two layers, with a twin or without, in which a pressure burst: what ended them, or what was seen between
/// outputs.
fn bursts(results: &[StudyResults<'_>]) -> Vec<String> {
    let records = results.iter().flat_map(|one| one.records);
    records.filter(|record| has_burst(record)).map(|record| record.case.label()).collect()
}

fn burst_note(bursts: &[String]) -> String {
    match bursts {
        [] => "in no run of two layers did a pressure leave what the load can make".to_owned(),
        _ => format!("a pressure burst in {}: {}", count_of(bursts.len(), "run", "runs"), bursts.join("; ")),
    }
}

/// What a row of all methods with the same errors is called, beside rows of methods that differ or alone.
fn others(told: &[TwinsOfSituation], row: &TwinsOfSituation) -> String {
    let is_differing = |one: &TwinsOfSituation| one.situation == row.situation && one.method.is_some();
    if told.iter().any(is_differing) { "every other method" } else { "every method" }.to_owned()
}

/// What the pairs say: where the layers are one, where two are better and where worse, and what they cost.
fn sentence(told: &[TwinsOfSituation], bursts: usize) -> String {
    let pairs: usize = told.iter().map(|one| one.pairs).sum();
    let failed = [0, 1].map(|side| told.iter().map(|one| one.failed[side]).sum::<usize>());
    let mut parts: Vec<String> = Vec::new();
    for one in told {
        let Some([least, median, largest]) = one.ratios else { continue };
        let situation = one.situation.name().to_lowercase();
        parts.push(match &one.method {
            None => format!(
                "{situation}, {}: the same error within {:.0e}",
                others(told, one),
                (largest - 1.0).abs().max((least - 1.0).abs()).max(1e-16)
            ),
            Some(method) => format!(
                "{situation}, `{method}`: two layers have {} times the error of one ({} to {})",
                number::number(median),
                number::number(least),
                number::number(largest)
            ),
        });
    }
    let costs: Vec<f64> = told.iter().filter_map(|one| one.cost).collect();
    let cost = match (costs.iter().copied().reduce(f64::min), costs.iter().copied().reduce(f64::max)) {
        (Some(least), Some(most)) => {
            format!(", and two take {} to {} times as long", number::number(least), number::number(most))
        }
        _ => String::new(),
    };
    format!(
        "Over {pairs} pairs of runs: {}. {} of these runs with one layer and {} with two ended before their last output{cost}; \
         in {} of two layers a pressure burst.",
        parts.join("; "),
        failed[0],
        failed[1],
        count_of(bursts, "run", "runs"),
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
            sentence.starts_with(
                "Over 2 pairs of runs: small strain, points out of place, `GC-SRI-patch`: two layers have "
            ),
            "{sentence}"
        );
        assert!(
            sentence.ends_with("in 0 runs of two layers a pressure burst. Evidence: [`s`](s.html)."),
            "{sentence}"
        );
        let dimensions = Key::named("dimensions", "column").expect("a key");
        assert!(compare(&results, dimensions, &links).is_none());
    }
}
