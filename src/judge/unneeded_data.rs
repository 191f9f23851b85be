//! Drops from records what no verdict needs.

use crate::judge::proposals;
use crate::measure::soundness::complaints;
use crate::record::{Record, Status};
use crate::study::check::Study;

/// Drops from a record what no verdict of its study needs, because whole records of a hundred thousand cases do not
/// fit into memory: fields and history, and where no expectation selects the record its errors and balances too.
/// Records with warnings stay whole, and those that cannot be made again.
pub fn drop_unneeded(study: &Study, record: &mut Record) {
    // What is proposed to a study without expectations comes from its errors and fields.
    if proposals::are_wanted(study) {
        return;
    }
    let has_complaints = || !complaints(record).is_empty();
    if record.status != Status::Ok || !record.can_be_made_again() || has_complaints() {
        return;
    }
    record.history = Vec::new();
    // A double-point case is compared with one that its expectation does not name.
    let compares = study.case_expectations.iter().any(|one| one.demand.one_set_within.is_some());
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
    use crate::case::planned::Tier;
    use crate::golden::GoldenError;
    use crate::judge::study_check::StudyCheck;
    use crate::study::file::StudySource;

    const THREE_METHODS: &str = "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = [\"MPM\", \"GIMP\", \"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [4, 8, 16]\n\
        [[expect]]\nmethod = \"GC-SRI-patch\"\nquantity = \"pressure\"\ntime_factor = 0.1\noscillation = { below = 0.5 }\n\
        order = { value = 2.0, minus = 0.2, plus = 0.2 }\n\
        [[expect_case]]\nmethod = \"GIMP\"\ncells = 8\nwater_drift_below = 1e-6\n";

    #[test]
    fn thin_records_are_judged_like_whole_ones() {
        let source = StudySource { name: "t.toml".to_owned(), text: THREE_METHODS.to_owned() };
        let study = Study::check(&source).expect("sound");
        let mut records = records_of(THREE_METHODS);
        let judged = |records: &[Record]| {
            let none = Err(GoldenError::Missing("golden/t.csv".into()));
            let check = StudyCheck::new(&study, records, Tier::Full, none);
            assert!(check.judgements.iter().all(|one| one.verdict.pass), "{:?}", check.judgements);
            format!("{:?} {:?} {:?}", check.judgements, check.unsound, check.failed_cases)
        };
        let whole = judged(&records);
        for record in &mut records {
            drop_unneeded(&study, record);
        }
        assert_eq!(judged(&records), whole);
        let held = records.iter().filter(|record| !record.errors.is_empty()).count();
        assert_eq!(held, 3 + 1, "three levels of the series and one case");
    }

    #[test]
    fn a_record_that_is_complained_of_stays_whole() {
        let source = StudySource { name: "t.toml".to_owned(), text: THREE_METHODS.to_owned() };
        let study = Study::check(&source).expect("sound");
        let mut record = records_of(THREE_METHODS).remove(0);
        record.balance[0].solid_mass_drift = 1.0;
        let mut thinned = record.clone();
        drop_unneeded(&study, &mut thinned);
        assert_eq!(thinned, record);
    }
}
