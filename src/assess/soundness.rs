//! What must hold of every record, whatever it is expected to show and whatever the golden values
//! say: a lost point or a reference that is no better than the result spoils any verdict.

use super::wording::typed;
use crate::record::{Quantity, Record};

/// Drift of conserved quantities that round-off explains.
const ROUND_OFF: f64 = 1e-9;
/// Gap between outputs and settlement curve that a smooth curve explains.
const CURVE_GAP: f64 = 2e-3;
/// A reference must be better than this share of the smallest error held against it.
const TAIL_SHARE: f64 = 0.1;

/// What is wrong with a record, as sentences; none where it is sound.
pub fn complaints(record: &Record) -> Vec<String> {
    let mut found = Vec::new();
    if let Some(start) = &record.start
        && start.points != start.points_expected
    {
        found.push(format!("{} points at the start instead of {}", start.points, start.points_expected));
    }
    for balance in &record.balance {
        let mut hold = |what: &str, value: f64, bound: f64| {
            // Written so that what is no number is told.
            let holds = value.abs() <= bound;
            if !holds {
                let time_factor = typed(balance.time_factor);
                found.push(format!("{what} is {value:.2e} at T_v = {time_factor}, more than {bound:.0e}"));
            }
        };
        hold("the drift of the mass of solids", balance.solid_mass_drift, ROUND_OFF);
        hold("the sum of the internal forces", balance.internal_force_imbalance, ROUND_OFF);
        hold(
            "the gap between the settlement and the settlement curve",
            balance.settlement_curve_gap,
            CURVE_GAP,
        );
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
