//! What must hold of every record, whatever it is expected to show and whatever the golden values
//! say: a lost point or a reference that is no better than the result spoils any verdict.

use super::record_checks;
use crate::record::{Quantity, Record};

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
