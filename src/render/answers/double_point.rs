//! One set of material points or two? Runs of single-point and double-point MPM that differ in nothing else, by their
//! situation.

use crate::case::keys::{Key, Value};
use crate::judge::comparison::twins::{Twins, TwinsOfSituation, by_situation, twins};
use crate::judge::study_results::StudyResults;
use crate::measure::record_checks::has_burst;
use crate::render::answers::{Answer, Question, short};
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};
use oedometer_soil::wording::count_of;

const QUESTION: Question = Question { heading: "One set of material points, or two?", id: "double-point" };

/// The key of the number of point sets, and its table in a study file.
const KEY: [&str; 2] = ["sets", "points"];

/// Error, robustness and cost of double-point MPM beside single-point MPM.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    Key::named(KEY[0], KEY[1]).and_then(|key| compare(results, key))
}

/// The comparison by a key with the values one and two; `None` where no study has such pairs.
fn compare(results: &[StudyResults<'_>], key: &Key) -> Answer {
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
            one.method
                .map_or_else(|| Cell::Text(others(&told, one)), |method| Cell::Code(method.to_string())),
            Cell::Count(one.pairs as u64),
            ratio(0),
            ratio(1),
            ratio(2),
            Cell::Count(one.failed[0] as u64),
            Cell::Count(one.failed[1] as u64),
            Cell::of(one.cost, Cell::Number, "not timed"),
        ]
    });
    let header = "situation | method | > pairs of runs | > error of double-point over single-point: least | > median \
                  | > largest | > failed, single-point | > failed, double-point | > time of double-point over single-point";
    let bursts = bursts(results);
    let table = Table::of("", columns(header), rows)
        .note("pairs of runs that differ in the point sets alone; error of the pressure at the points, at every output")
        .note(burst_note(&bursts));
    Some(QUESTION.told(
        &sentence(&told, bursts.len()),
        studies,
        vec![Block::Table(short(table, "in the studies"))],
    ))
}

/// All double-point runs with a pressure burst: a pressure beyond what the load can make.
fn bursts(results: &[StudyResults<'_>]) -> Vec<String> {
    let records = results.iter().flat_map(|one| one.records);
    records.filter(|record| has_burst(record)).map(|record| record.case.label()).collect()
}

fn burst_note(bursts: &[String]) -> String {
    match bursts {
        [] => "in no double-point run did the pressure exceed what the load can cause".to_owned(),
        _ => format!("{} had a pressure burst: {}", runs(bursts.len()), bursts.join("; ")),
    }
}

/// The name of a row of all methods with the same errors.
fn others(told: &[TwinsOfSituation], row: &TwinsOfSituation) -> String {
    let is_differing = |one: &TwinsOfSituation| one.situation == row.situation && one.method.is_some();
    if told.iter().any(is_differing) { "every other method" } else { "every method" }.to_owned()
}

/// `no double-point run`, `2 double-point runs`.
fn runs(count: usize) -> String {
    if count == 0 {
        "no double-point run".to_owned()
    } else {
        count_of(count, "double-point run", "double-point runs")
    }
}

/// The least and the largest ratio, in words; `None` without any.
fn range(ratios: impl Iterator<Item = f64> + Clone) -> Option<String> {
    let ends = [ratios.clone().reduce(f64::min)?, ratios.reduce(f64::max)?];
    let [least, most] = ends.map(|ratio| format!("{ratio:.2}"));
    Some(if least == most { least } else { format!("{least} to {most}") })
}

/// How far the errors of double-point MPM are from the others, how the runs ended, and what it costs.
fn sentence(told: &[TwinsOfSituation], bursts: usize) -> String {
    let pairs: usize = told.iter().map(|one| one.pairs).sum();
    let errors = range(told.iter().filter_map(|one| one.ratios).flat_map(|[least, _, most]| [least, most]))
        .map_or(String::new(), |ratios| format!(": double-point MPM has {ratios} times the error"));
    let cost = range(told.iter().filter_map(|one| one.cost))
        .map_or(String::new(), |ratios| format!(" A double-point run takes {ratios} times as long."));
    let failed = [0, 1].map(|side| told.iter().map(|one| one.failed[side]).sum::<usize>());
    let ended = match failed {
        [0, 0] => "All of them reached their last output".to_owned(),
        [single, double] => format!(
            "{} and {} of them ended before their last output",
            count_of(single, "single-point run", "single-point runs"),
            runs(double)
        ),
    };
    format!(
        "{} that differ in the point sets alone{errors}. {ended}; {} had a pressure burst.{cost}",
        count_of(pairs, "pair of runs", "pairs of runs"),
        runs(bursts)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::SolverName;
    use crate::case::planned::Tier;
    use crate::judge::comparison::twins::Situation;
    use oedometer_mpm::method::Method;

    #[test]
    fn double_point_runs_are_compared_by_situation_and_nothing_is_said_without_pairs() {
        let text = "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
                    integrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = [1, 2]\n";
        let (study, records) = solved("s", text);
        let results = [StudyResults::new(&study, &records, Tier::Full)];
        // Any key of one and two will do.
        let key = Key::named("points_per_cell", "sweep").expect("a key");
        let Some(section) = compare(&results, key) else { panic!("both are there") };
        let Some(Block::Paragraph(sentence)) = section.blocks.first() else { panic!("a sentence first") };
        let start = "2 pairs of runs that differ in the point sets alone: double-point MPM has ";
        assert!(sentence.starts_with(start), "{sentence}");
        let end = "All of them reached their last output; no double-point run had a pressure burst.";
        assert!(sentence.contains(end), "{sentence}");
        let Some(Block::Table(table)) = section.blocks.get(1) else { panic!("then a table") };
        let [row] = &table.rows[..] else { panic!("one situation: {table:?}") };
        let [Cell::Number(least), Cell::Number(median), Cell::Number(largest)] = &row[3..6] else {
            panic!("{row:?}")
        };
        assert!(least < median && median < largest, "{row:?}");
        assert_eq!([&row[2], &row[6], &row[7]], [&Cell::Count(2), &Cell::Count(0), &Cell::Count(0)]);
        assert_eq!(table.notes[1], "in no double-point run did the pressure exceed what the load can cause");
        let dimensions = Key::named("dimensions", "column").expect("a key");
        assert!(compare(&results, dimensions).is_none());
    }

    #[test]
    fn bursts_are_named_and_a_row_of_several_methods_says_whether_others_have_rows_of_their_own() {
        let bursts = ["a", "b"].map(str::to_owned);
        assert_eq!(burst_note(&bursts[..1]), "1 double-point run had a pressure burst: a");
        assert_eq!(burst_note(&bursts), "2 double-point runs had a pressure burst: a; b");
        let row = |situation: Situation, method: Option<&str>| TwinsOfSituation {
            situation,
            method: method.map(|name| SolverName::Own(Method::named(name).expect("a method"))),
            pairs: 1,
            ratios: None,
            failed: [0; 2],
            cost: None,
        };
        let (usual, waves) = (Situation::Usual, Situation::Waves);
        let told = [row(usual, Some("MPM")), row(usual, None), row(waves, None)];
        assert_eq!(others(&told, &told[1]), "every other method");
        assert_eq!(others(&told, &told[2]), "every method", "of its own situation there is no other row");
    }

    #[test]
    fn the_sentence_tells_the_ends_of_all_ratios_and_counts_each_side() {
        let row = |ratios: Option<[f64; 3]>, failed: [usize; 2], cost: Option<f64>| TwinsOfSituation {
            situation: Situation::Usual,
            method: None,
            pairs: 3,
            ratios,
            failed,
            cost,
        };
        let [wide, narrow, none] =
            [Some([0.5, 1.0, 10.0]), Some([0.8, 0.9, 1.1]), None].map(|ratios| row(ratios, [0, 0], None));
        let times = |errors: &str| {
            format!(
                "pairs of runs that differ in the point sets alone{errors}. All of them reached their last output; no \
                 double-point run had a pressure burst."
            )
        };
        let range = ": double-point MPM has 0.50 to 10.00 times the error";
        for told in [[&wide, &narrow, &none], [&none, &wide, &narrow], [&narrow, &none, &wide]] {
            assert_eq!(sentence(&told.map(Clone::clone), 0), format!("9 {}", times(range)));
        }
        // The least in one row and the largest in another.
        let low = row(Some([0.25, 1.0, 1.0]), [0, 0], None);
        let high = row(Some([1.0, 1.0, 4.0]), [0, 0], None);
        let apart = ": double-point MPM has 0.25 to 4.00 times the error";
        assert_eq!(sentence(&[low.clone(), high.clone()], 0), format!("6 {}", times(apart)));
        assert_eq!(sentence(&[high, low], 0), format!("6 {}", times(apart)));
        let same = row(Some([1.0; 3]), [0, 0], None);
        let equal = ": double-point MPM has 1.00 times the error";
        assert_eq!(sentence(&[same], 0), format!("3 {}", times(equal)));
        assert_eq!(sentence(&[none], 0), format!("3 {}", times("")));
        let failed = [row(None, [1, 0], Some(2.0)), row(None, [0, 2], None), row(None, [0, 1], Some(3.5))];
        assert_eq!(
            sentence(&failed, 2),
            "9 pairs of runs that differ in the point sets alone. 1 single-point run and 3 double-point runs of them \
             ended before their last output; 2 double-point runs had a pressure burst. A double-point run takes 2.00 to \
             3.50 times as long."
        );
    }
}
