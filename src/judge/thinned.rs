//! What a check holds of a record when no golden value is to be compared with it: of a hundred thousand cases whole
//! records do not fit into a memory.

use crate::judge::soundness;
use crate::record::{Record, Status};
use crate::study::check::Study;

/// Drops from a record what no verdict of its study can ask for: its fields and history, where no expectation is of it
/// its errors and balances too. A record that is complained of stays whole, and so does one of an attached solver.
pub fn thin(study: &Study, record: &mut Record) {
    let is_complained_of = || !soundness::complaints(record).is_empty();
    if record.status != Status::Ok || record.attached.is_some() || is_complained_of() {
        return;
    }
    record.history = Vec::new();
    // A case of two layers is held against one that its expectation does not name.
    let compares = study.case_expectations.iter().any(|one| one.demand.one_layer_within.is_some());
    let case = &record.case;
    let of_series = study.expectations.iter().any(|one| one.selection.fits_along(one.axis.name(), case));
    let of_cases = study.case_expectations.iter().any(|one| one.selection.fits(case));
    if compares || of_series || of_cases {
        return;
    }
    record.snapshots = Vec::new();
    record.errors = Vec::new();
    record.measures = Vec::new();
    record.balance = Vec::new();
    record.references = Vec::new();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::tier::Tier;
    use crate::golden::GoldenError;
    use crate::judge::study_check::StudyCheck;
    use crate::study::file::StudySource;

    const STUDY: &str = "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = [\"MPM\", \"GIMP\", \"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [4, 8, 16]\n\
        [[expect]]\nmethod = \"GC-SRI-patch\"\nquantity = \"pressure\"\ntime_factor = 0.1\noscillation = { below = 0.5 }\n\
        order = { value = 2.0, minus = 0.2, plus = 0.2 }\n\
        [[expect_case]]\nmethod = \"GIMP\"\ncells = 8\nwater_drift_below = 1e-6\n";

    #[test]
    fn thin_records_are_judged_like_whole_ones() {
        let source = StudySource { name: "t.toml".to_owned(), text: STUDY.to_owned() };
        let study = Study::check(&source).expect("sound");
        let mut records = records_of(STUDY);
        let judged = |records: &[Record]| {
            let none = Err(GoldenError::Missing("golden/t.csv".into()));
            let check = StudyCheck::new(&study, records, Tier::Full, none);
            assert!(check.judgements.iter().all(|one| one.verdict.pass), "{:?}", check.judgements);
            format!("{:?} {:?} {:?}", check.judgements, check.unsound, check.failed_cases)
        };
        let whole = judged(&records);
        for record in &mut records {
            thin(&study, record);
        }
        assert_eq!(judged(&records), whole);
        let held = records.iter().filter(|record| !record.errors.is_empty()).count();
        assert_eq!(held, 3 + 1, "three levels of the series and one case");
    }

    #[test]
    fn a_record_that_is_complained_of_stays_whole() {
        let source = StudySource { name: "t.toml".to_owned(), text: STUDY.to_owned() };
        let study = Study::check(&source).expect("sound");
        let mut record = records_of(STUDY).remove(0);
        record.balance[0].solid_mass_drift = 1.0;
        let mut thinned = record.clone();
        thin(&study, &mut thinned);
        assert_eq!(thinned, record);
    }
}
