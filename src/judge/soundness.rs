//! What must hold of every record, whatever it is expected to show and whatever the golden values
//! say: a lost point or a reference that is no better than the result spoils any verdict.

use crate::case::quantity::Quantity;
use crate::measure::record_checks;
use crate::record::Record;

/// A reference must be better than this share of the smallest error held against it.
const TAIL_SHARE: f64 = 0.1;

/// What is wrong with a record, as sentences; none where it is sound.
pub fn complaints(record: &Record) -> Vec<String> {
    let mut found = record_checks::complaints(record);
    for reference in &record.references {
        found.extend(reference.does_not_hold.clone());
    }
    if let Some(row) = record.errors.iter().find(|row| !row.value.is_finite()) {
        found.push(format!("the error of {} is {}", row.quantity.name(), row.value));
    }
    for reference in &record.references {
        let pressures = record
            .errors
            .iter()
            .filter(|row| row.quantity == Quantity::Pressure && row.reference == reference.name);
        let smallest = pressures.map(|row| row.absolute).fold(f64::INFINITY, f64::min);
        if reference.tail_bound > TAIL_SHARE * smallest {
            found.push(format!(
                "the reference {} is good to {:.1e}, and the smallest error held against it is {smallest:.1e}",
                reference.name, reference.tail_bound
            ));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

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
        assert!(bound(0.11).contains("the reference terzaghi is good to"), "{}", bound(0.11));
        // Of two references the poor one is named.
        let second = said(|record| record.references[1].tail_bound = 1.0);
        assert!(second.contains("the reference terzaghi-incompressible"), "{second}");
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
        assert!(gap.contains("settlement off the settlement curve is 2.10e-3"), "{gap}");
        assert_eq!(said(|record| record.balance[0].settlement_curve_gap = 1.9e-3), "");
        let nonsense = said(|record| record.errors[0].value = f64::NAN);
        assert!(nonsense.contains("is NaN"), "{nonsense}");
    }
}
