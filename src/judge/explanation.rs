//! Explains the error of one case: the dominant norm and place, and changes from the golden values.

use crate::case::Norm;
use crate::case::grouping::grouped;
use crate::golden::compare::{Difference, compare};
use crate::golden::{GoldenFile, values_of};
use crate::judge::error_place::{ErrorPlace, place_of};
use crate::record::{ErrorRow, Record};
use oedometer_exact::ExactError;

/// The error of one quantity at one kind of sample, at the output where it is largest.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Carrier {
    /// Its L2 error, or the relative one of a settlement.
    pub row: ErrorRow,
    /// Mean and largest error at the same output.
    pub l1: Option<f64>,
    /// Largest error at the same output.
    pub linf: Option<f64>,
    /// The place with the largest share of it; `None` where the quantity has a single place.
    pub place: Option<ErrorPlace>,
}

/// The explanation of a case.
#[derive(Default, Clone, Debug, PartialEq, serde::Serialize)]
pub struct Explanation {
    /// Carriers, the largest error first.
    pub carriers: Vec<Carrier>,
    /// Whether its inputs are others than those of its golden values.
    pub has_other_inputs: bool,
    /// Differences from the golden values of this case.
    pub differences: Vec<Difference>,
    /// Golden values of this case that agree.
    pub agreeing: usize,
    /// Whether there are golden values.
    pub has_golden: bool,
}

/// Explains a record. `focus`, a quantity and a sample as they begin the name of a golden value, puts their carrier first.
/// Golden values are those beside the cases of the study, with the cases that have other inputs ([`GoldenFile::beside`]).
///
/// # Errors
/// When a reference refuses the case.
pub fn explain(
    record: &Record,
    golden: Option<&(GoldenFile, Vec<String>)>,
    focus: Option<&str>,
) -> Result<Explanation, ExactError> {
    let mut carriers = carriers_of(record)?;
    carriers.sort_by(|a, b| b.row.value.abs().total_cmp(&a.row.value.abs()));
    if let Some(focus) = focus {
        let words: Vec<&str> = focus.split(' ').take(2).collect();
        carriers.sort_by_key(|carrier| words != [carrier.row.quantity.name(), carrier.row.sample.name()]);
    }
    let label = record.case.label();
    let has_other_inputs = golden.is_some_and(|(_, others)| others.contains(&label));
    let golden = golden.map(|(golden, _)| golden);
    let (differences, agreeing) = golden.map_or((Vec::new(), 0), |golden| differences_of(record, golden));
    Ok(Explanation { carriers, has_other_inputs, differences, agreeing, has_golden: golden.is_some() })
}

/// Against the first reference, the output with the largest error of every quantity and place.
fn carriers_of(record: &Record) -> Result<Vec<Carrier>, ExactError> {
    let Some(own) = record.references.first() else { return Ok(Vec::new()) };
    let main = |row: &&ErrorRow| row.reference == own.name && matches!(row.norm, Norm::L2 | Norm::Relative);
    let groups = grouped(record.errors.iter().filter(main), |row| (row.quantity, row.sample));
    groups
        .into_iter()
        .filter_map(|(_, rows)| rows.into_iter().rev().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs())))
        .map(|row| {
            let error = |norm| record.error(row.quantity, row.sample, norm, &row.reference, row.time_factor);
            let norm = |norm| error(norm).map(|row| row.value);
            let place = place_of(record, row)?;
            Ok(Carrier { row: row.clone(), l1: norm(Norm::L1), linf: norm(Norm::Linf), place })
        })
        .collect()
}

/// Differences from the golden values of this case alone, and how many agree.
fn differences_of(record: &Record, golden: &GoldenFile) -> (Vec<Difference>, usize) {
    let label = record.case.label();
    let mut of_case = golden.clone();
    of_case.values.retain(|key, _| *key.case == *label);
    let differences = compare(&of_case, &values_of(std::slice::from_ref(record)));
    let there = differences.iter().filter(|one| one.golden.is_some()).count();
    let agreeing = of_case.values.len() - there;
    (differences, agreeing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::quantity::Quantity;
    use crate::golden::measure::GoldenKey;

    #[test]
    fn golden_values_of_a_case_differ_or_agree_and_are_counted_once() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\ncells = [2, 3]\n\
             integrator = ['implicit']\ntime_step = [{ growth = 0.5 }]\n",
        );
        let mut golden = GoldenFile { values: values_of(&records), ..GoldenFile::of("t", &[], "test") };
        let of_first = values_of(&records[..1]).len();
        let errors: Vec<GoldenKey> =
            golden.values.keys().filter(|key| key.to_string().contains("pressure points")).cloned().collect();
        for key in &errors {
            *golden.values.get_mut(key).expect("there") *= 1.5;
        }
        // Labels that begin or end like that of the case are of others.
        let label = records[0].case.label();
        for other in [format!("{label} (E = 5e6)"), format!("{label}5"), format!("VP, {label}")] {
            golden.values.insert(crate::golden::measure::key(&other, None, "steps"), 1.0);
        }
        let (differences, agreeing) = differences_of(&records[0], &golden);
        assert_eq!((2 * differences.len(), differences.len() + agreeing), (errors.len(), of_first));
        assert!(!differences.is_empty() && agreeing > 0);
    }

    #[test]
    fn the_largest_error_of_all_outputs_carries_wherever_it_stands() {
        let mut record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2, 0.4]\n[[sweep]]\nmethod = ['MPM']\n\
             cells = [3]\nintegrator = ['implicit']\n",
        )
        .remove(0);
        let mut errors = [3e-2, -1e-2, 2e-2];
        for _ in 0..3 {
            for row in record.errors.iter_mut().filter(|row| row.quantity == Quantity::Settlement) {
                let place =
                    [0.1, 0.2, 0.4].iter().position(|time| *time == row.time_factor).expect("an output");
                row.value = errors[place];
            }
            let carriers = carriers_of(&record).expect("a theory");
            let own =
                carriers.iter().find(|one| one.row.quantity == Quantity::Settlement).expect("a carrier");
            assert_eq!(own.row.value, 3e-2, "{errors:?}");
            errors.rotate_left(1);
        }
    }
}
