//! Requirements on every record, whatever a study expects: a lost point, or a reference no more accurate than the
//! result, invalidates any verdict.

use crate::case::Quantity;
use crate::judge::proposals;
use crate::measure::record_checks;
use crate::record::{Record, Status};
use crate::study::check::Study;
use oedometer_exact::solution::ROUND_OFF;

/// A reference must be more accurate than this share of the smallest error against it.
const TAIL_SHARE: f64 = 0.1;

/// What is wrong with the start and the balances of a record, as sentences.
pub fn complaints_of_run(record: &Record) -> Vec<String> {
    record_checks::complaints(record)
}

/// What is wrong with a record, as sentences; empty where it is sound.
pub fn complaints(record: &Record) -> Vec<String> {
    let mut found = complaints_of_run(record);
    found.extend(record.references.iter().filter_map(|reference| reference.does_not_hold.clone()));
    if let Some(row) = record.errors.iter().find(|row| !row.value.is_finite()) {
        found.push(format!("the error of {} is {}", row.quantity.name(), row.value));
    }
    for reference in &record.references {
        let pressures = record
            .errors
            .iter()
            .filter(|row| row.quantity == Quantity::Pressure && row.reference == reference.name);
        let smallest = pressures.map(|row| row.absolute).fold(f64::INFINITY, f64::min);
        // No reference is better than its round-off, whatever a result at round-off asks.
        let is_enough = reference.tail_bound <= (TAIL_SHARE * smallest).max(ROUND_OFF);
        if !is_enough {
            found.push(format!(
                "the reference {} is only accurate to {:.1e}, and the smallest error against it is {smallest:.1e}",
                reference.name, reference.tail_bound
            ));
        }
    }
    found
}

/// Drops from a record what no verdict of its study needs, because whole records of a hundred thousand cases do not
/// fit into memory: fields and history, and where no expectation selects the record its errors and balances too.
/// Records with complaints stay whole, and those that cannot be made again.
pub fn thin(study: &Study, record: &mut Record) {
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

    const STUDY: &str = r#"title = "Sound"
scene = "terzaghi"
output = { time_factors = [0.05, 0.2] }

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [10]
time_step = [{ growth = 0.05 }]
"#;

    fn sound() -> Record {
        records_of(STUDY).remove(0)
    }

    /// What is said of a record that differs from a sound one.
    fn said(change: impl Fn(&mut Record)) -> String {
        let mut record = sound();
        assert_eq!(complaints(&record), Vec::<String>::new());
        change(&mut record);
        complaints(&record).join("; ")
    }

    #[test]
    fn a_reference_must_be_ten_times_better_than_the_least_pressure_error() {
        let smallest = |record: &Record| {
            let own = record.references[0].name.clone();
            let pressures =
                record.errors.iter().filter(|row| row.quantity == Quantity::Pressure && row.reference == own);
            pressures.map(|row| row.absolute).fold(f64::INFINITY, f64::min)
        };
        let bound = |share: f64| said(|record| record.references[0].tail_bound = share * smallest(record));
        assert_eq!(bound(0.09), "");
        let (least, told) = (smallest(&sound()), bound(0.11));
        let wanted = format!(
            "the reference terzaghi is only accurate to {:.1e}, and the smallest error against it is {least:.1e}",
            0.11 * least
        );
        assert_eq!(told, wanted);
        // Of two references the poor one is named.
        let second = said(|record| record.references[1].tail_bound = 1.0);
        assert!(second.contains("the reference terzaghi-incompressible"), "{second}");
    }

    #[test]
    fn a_reference_at_round_off_serves_results_at_round_off_and_no_worse_one_does() {
        let told = |bound: f64| {
            said(|record| {
                record.references.iter_mut().for_each(|reference| reference.tail_bound = bound);
                record.errors.iter_mut().for_each(|row| row.absolute = 0.0);
            })
        };
        assert_eq!(told(ROUND_OFF), "");
        assert!(told(f64::NAN).contains("is only accurate to NaN"), "{}", told(f64::NAN));
        assert!(told(1.1 * ROUND_OFF).contains("is only accurate to 1.1e-14"), "{}", told(1.1 * ROUND_OFF));
    }

    #[test]
    fn lost_points_drifts_and_gaps_are_told_with_their_bounds() {
        let lost = said(|record| record.start.as_mut().expect("a start").points -= 1);
        assert_eq!(lost, "19 points at the start instead of 20");
        for drift in [2e-9, -2e-9, f64::NAN] {
            let mass = said(|record| record.balance[1].solid_mass_drift = drift);
            assert!(mass.contains("mass of solids, drift is") && mass.contains("at T_v = 0.2"), "{mass}");
            let forces = said(|record| record.balance[0].internal_force_imbalance = drift);
            assert!(
                forces.contains("sum of internal forces") && forces.contains("at T_v = 0.05"),
                "{forces}"
            );
        }
        assert_eq!(said(|record| record.balance[0].solid_mass_drift = 0.9e-9), "");
        let gap = said(|record| record.balance[0].settlement_curve_gap = 2.1e-3);
        assert!(gap.contains("final settlement against settlement curve is 2.10e-3"), "{gap}");
        assert_eq!(said(|record| record.balance[0].settlement_curve_gap = 1.9e-3), "");
        let nonsense = said(|record| record.errors[0].value = f64::NAN);
        assert!(nonsense.contains("is NaN"), "{nonsense}");
    }

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
            thin(&study, record);
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
        thin(&study, &mut thinned);
        assert_eq!(thinned, record);
    }
}
