//! What does the soil change? Of every number of the soil and the body that a study varies: by what factor the error, the
//! settlement in the end and the time of consolidation change from its smallest value to its largest.

use crate::case::Case;
use crate::case::keys::{Key, Kind, Value};
use crate::case::quantity::Quantity;
use crate::judge::paths::{first_error, grouped};
use crate::judge::study_results::StudyResults;
use crate::record::{Record, Status};
use crate::render::answers::{Answer, Question, study_with_most};
use crate::render::report::setting;
use oedometer_soil::wording;

const QUESTION: Question = Question { heading: "What does the soil change?", id: "soil" };

/// Two runs that differ in one key alone, with its smallest and its largest value.
type Pair<'a> = [&'a Record; 2];

/// A key that a study varies.
struct Varied<'a> {
    key: &'static Key,
    pairs: Vec<Pair<'a>>,
}

/// What is compared: its words, and its value in a run.
type Compared = (&'static str, fn(&Record, &str) -> Option<f64>);

const COMPARED: [Compared; 3] = [
    ("error of the pressure", last_error),
    ("settlement in the end", |record, _| setting::final_settlement(&record.case)),
    ("time of consolidation", |record, _| setting::unit_of_time(&record.case)),
];

/// The study that varies most keys of the soil; of a layer the section on locking says more.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let (one, keys) = study_with_most(results, |one| {
        let keys = varied(one.records);
        (!one.study.scene.shows_locking()).then_some((keys.len(), keys))
    })?;
    let reference = one.study.references.first()?.name();
    let told: Vec<String> = keys.iter().filter_map(|varied| sentence(varied, reference)).collect();
    if told.is_empty() {
        return None;
    }
    let sentence = format!("From the smallest value to the largest, all else equal: {}.", told.join("; "));
    Some(QUESTION.told(&sentence, [one.study.name.as_str()], Vec::new()))
}

/// The numbers of soil and body that differ between runs which are alike in everything else.
fn varied(records: &[Record]) -> Vec<Varied<'_>> {
    let is_ok = |record: &&Record| record.status == Status::Ok;
    let sweeps = Key::of("sweep").filter(|key| matches!(key.kind, Kind::Number(_)) && is_of_soil(key));
    let keys = sweeps.map(|key| {
        let alike = grouped(records.iter().filter(is_ok), |record| without(key, &record.case));
        let pairs = alike.into_iter().filter_map(|(_, alike)| ends(key, &alike));
        Varied { key, pairs: pairs.collect() }
    });
    keys.filter(|varied| !varied.pairs.is_empty()).collect()
}

fn is_of_soil(key: &Key) -> bool {
    ["material", "column", "layer"].iter().any(|table| key.tables.contains(table))
}

/// A number for all inputs of a case but a key.
fn without(key: &Key, case: &Case) -> u64 {
    let seed = Case::seed(case.task, case.scene);
    case.number_with(|case| key.set(case, key.get(&seed)))
}

fn number(key: &Key, record: &Record) -> Option<f64> {
    if let Value::Number(number) = key.get(&record.case) { Some(number) } else { None }
}

/// The runs with the smallest and the largest value, where these differ.
fn ends<'a>(key: &Key, alike: &[&'a Record]) -> Option<Pair<'a>> {
    let mut known: Vec<_> = alike.iter().filter_map(|record| Some((number(key, record)?, *record))).collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, last) = (known.first()?, known.last()?);
    (first.0 < last.0).then_some([first.1, last.1])
}

/// The error of the pressure at the last output.
fn last_error(record: &Record, reference: &str) -> Option<f64> {
    let time = *record.case.time_factors.last()?;
    first_error(record, Quantity::Pressure, record.main_sample(), reference, time)
}

/// The least and the largest factor over some pairs.
fn factors(pairs: &[Pair<'_>], value: impl Fn(&Record) -> Option<f64>) -> Option<[f64; 2]> {
    let factor = |[first, last]: &Pair<'_>| Some(value(last)? / value(first)?).filter(|one| one.is_finite());
    let all = || pairs.iter().filter_map(factor);
    Some([all().reduce(f64::min)?, all().reduce(f64::max)?])
}

fn in_words([least, most]: [f64; 2]) -> String {
    let [least, most] =
        [least, most].map(|factor| wording::short(format!("{factor:.2e}").parse().unwrap_or(factor)));
    if least == most { least } else { format!("{least} … {most}") }
}

fn sentence(varied: &Varied<'_>, reference: &str) -> Option<String> {
    let told = COMPARED.iter().filter_map(|(words, value)| {
        let factors = factors(&varied.pairs, |record| value(record, reference))?;
        let changes = factors.iter().any(|factor| (factor - 1.0).abs() > CHANGES);
        changes.then(|| format!("the {words} by {}", in_words(factors)))
    });
    let told = told.collect::<Vec<_>>();
    factors(&varied.pairs, |record| last_error(record, reference))?;
    let told = match told.as_slice() {
        [] => "changes nothing by more than 1 %".to_owned(),
        told => format!("multiplies {}", told.join(", ")),
    };
    Some(format!("`{}` {told}", varied.key.name))
}

/// A factor this near to one is no change.
const CHANGES: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of};

    fn records(sweep: &str) -> Vec<Record> {
        records_of(&format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.1, 0.2]\n[[sweep]]\n\
             method = ['GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [4]\n{sweep}\n"
        ))
    }

    fn told(records: &[Record]) -> Vec<String> {
        varied(records).iter().filter_map(|varied| sentence(varied, "terzaghi")).collect()
    }

    #[test]
    fn a_soil_multiplies_the_error_at_the_last_output_from_its_smallest_value_to_its_largest() {
        let mut records = records("hydraulic_conductivity = [1e-4, 1e-5, 1e-3]");
        for record in &mut records {
            let is_first = record.case.method.to_string() == "MPM";
            // At the last output three and four times the error, at the others something else.
            let last = match record.case.material.hydraulic_conductivity {
                1e-5 => 0.01,
                1e-4 => 0.5,
                _ if is_first => 0.04,
                _ => 0.03,
            };
            for row in &mut record.errors {
                row.value = match row.time_factor {
                    0.05 => last * last,
                    0.1 => 1.0 / last,
                    _ => last,
                };
            }
        }
        let ends = "`hydraulic_conductivity` multiplies the error of the pressure by 3 … 4, the time of consolidation by 0.01";
        assert_eq!(told(&records), [ends]);
        records.reverse();
        assert_eq!(told(&records), [ends], "in any order");
        // A run that failed is no end.
        for record in records.iter_mut().filter(|one| one.case.material.hydraulic_conductivity == 1e-3) {
            record.status = failed_at(1);
        }
        let middle = "`hydraulic_conductivity` multiplies the error of the pressure by 50, the time of consolidation by 0.1";
        assert_eq!(told(&records), [middle]);
        records.retain(|record| record.status != Status::Ok);
        assert_eq!(told(&records), [""; 0]);
    }

    #[test]
    fn a_stiffness_changes_settlement_and_time_and_a_change_below_a_percent_is_none() {
        let with = |sweep: &str, factor: f64| {
            let mut records = records(sweep);
            let least = records[0].case.clone();
            for record in &mut records {
                let error = if record.case.material == least.material { 0.01 } else { 0.01 * factor };
                record.errors.iter_mut().for_each(|row| row.value = error);
            }
            told(&records)
        };
        let ends = "the settlement in the end by 0.1, the time of consolidation by 0.1";
        let sweep = "youngs_modulus = [1e6, 1e7]";
        for factor in [1.0, 1.009, 0.991] {
            assert_eq!(with(sweep, factor), [format!("`youngs_modulus` multiplies {ends}")], "{factor}");
        }
        for (factor, word) in [(1.02, "1.02"), (0.98, "0.98")] {
            let error = format!("`youngs_modulus` multiplies the error of the pressure by {word}, {ends}");
            assert_eq!(with(sweep, factor), [error]);
        }
        let nothing = "`grain_density` changes nothing by more than 1 %";
        assert_eq!(with("grain_density = [2600.0, 2700.0]", 1.0), [nothing]);
    }
}
