//! Cases that were not run, for their solver is not installed here: they are told, and nothing is judged by them.

use crate::case::Case;
use crate::golden::GoldenFile;
use crate::record::Record;
use std::collections::BTreeMap;

/// The skipped cases among records, and the others.
pub struct Absent<'a> {
    skipped: Vec<&'a Record>,
    others: Vec<&'a Record>,
}

impl<'a> Absent<'a> {
    /// Those among records.
    pub fn among(records: &'a [Record]) -> Self {
        let (skipped, others) = records.iter().partition(|record| record.status.is_skipped());
        Self { skipped, others }
    }

    /// Whether cases are selected, and all of them were skipped.
    pub fn holds_all(&self, is_selected: impl Fn(&Case) -> bool) -> bool {
        self.skipped.iter().any(|record| is_selected(&record.case))
            && !self.others.iter().any(|record| is_selected(&record.case))
    }

    /// Golden values without those of skipped cases.
    pub fn without(&self, mut golden: GoldenFile) -> GoldenFile {
        let labels: Vec<String> = self.skipped.iter().map(|record| record.case.label()).collect();
        golden.values.retain(|name, _| {
            name.split_once(" | ").is_none_or(|(case, _)| !labels.iter().any(|label| label == case))
        });
        golden
    }

    /// A sentence a solver that is not here.
    pub fn warnings(&self) -> Vec<String> {
        let mut by_solver: BTreeMap<String, Vec<&Record>> = BTreeMap::new();
        for record in &self.skipped {
            by_solver.entry(record.case.method.to_string()).or_default().push(record);
        }
        let sentence = |(solver, records): (&String, &Vec<&Record>)| {
            let why = records[0].status.failure().map_or("", |failure| failure.reason.as_str());
            format!("{solver}: {} cases were skipped and nothing is judged by them: {why}", records.len())
        };
        by_solver.iter().map(sentence).collect()
    }
}

/// A sentence a solver whose repeats do not give the same result.
pub fn differing_repeats(records: &[Record]) -> Vec<String> {
    let notes = |record: &Record| {
        let about = record.attached.as_ref()?;
        let told = about.notes.first()?;
        Some(format!("{}: {told}", record.case.label()))
    };
    records.iter().filter_map(notes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::Status;
    use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

    fn records() -> Vec<Record> {
        let mut records = records_of(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = [\"MPM\"]\n\
             integrator = [\"implicit\"]\ncells = [2, 4]\n",
        );
        let reason = "it says that it cannot run here".to_owned();
        records[0].status = Status::Failed(Failure::of_attached(FailureKind::Skipped, reason));
        records
    }

    #[test]
    fn a_selection_is_absent_only_where_all_of_it_was_skipped() {
        let records = records();
        let absent = Absent::among(&records);
        assert!(absent.holds_all(|case| case.cells == 2));
        assert!(!absent.holds_all(|case| case.cells == 4));
        assert!(!absent.holds_all(|_| true), "half of it was run and is judged");
        assert!(!absent.holds_all(|_| false), "what selects nothing must fail");
        let told = absent.warnings();
        assert!(told.len() == 1 && told[0].contains("MPM: 1 cases were skipped"), "{told:?}");
    }
}
