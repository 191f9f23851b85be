//! What it takes to come within a bound, in sentences from their template.

use crate::judge::findings::QuantityWithin;
use crate::render::{RenderError, templates};
use serde::Serialize;

/// What the template is filled with.
#[derive(Serialize)]
struct Quantities<'a> {
    quantities: &'a [QuantityWithin],
}

/// Lightly marked paragraphs, one per quantity.
///
/// # Errors
/// If the template cannot be filled.
pub fn sentences(quantities: &[QuantityWithin]) -> Result<String, RenderError> {
    templates::sentence("within", &Quantities { quantities })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Quantity, Sample};
    use crate::judge::findings::within::{BoundWithin, WithinFinding};

    #[test]
    fn a_quantity_is_told_with_method_mesh_step_and_time_or_with_the_least_error() {
        let choice = |error: f64, largest_step: f64| WithinFinding {
            method: "GC-SRI-patch".to_owned(),
            integrator: "implicit".to_owned(),
            cells: 10,
            points_per_cell: 2,
            largest_step,
            is_longest_tried: false,
            error,
            time_factor: 0.152_190_825_688_073_4,
            seconds: 180.0 * 86400.0,
            cost: 1e-3,
            case: "abc".to_owned(),
        };
        let told = |bounds: [Option<f64>; 2], step: f64| {
            let bounds = [0.01, 0.001].into_iter().zip(bounds);
            let bounds = bounds.map(|(bound, error)| BoundWithin {
                bound,
                choice: error.map(|error| choice(error, step)),
                others: Vec::new(),
            });
            let quantity = QuantityWithin {
                quantity: Quantity::Settlement,
                sample: Sample::Surface,
                reference: "terzaghi".to_owned(),
                problems: 1,
                bounds: bounds.collect(),
                best: choice(0.02, step),
            };
            sentences(&[quantity]).expect("filled").trim().to_owned()
        };
        let within = "**Settlement** within 1 % at every output: `GC-SRI-patch`, implicit, 10 cells";
        let largest = "(largest 0.40 %, at T_v = 0.1522, 180 days)";
        assert_eq!(
            told([Some(0.004), None], 864_000.0),
            format!("{within}, steps up to 10 days {largest}; no run reaches 0.1 %.")
        );
        assert_eq!(told([Some(0.004), None], 0.0), format!("{within} {largest}; no run reaches 0.1 %."));
        assert_eq!(
            told([None, None], 0.0),
            "**Settlement**: no run reaches 1 %; no run reaches 0.1 %. The smallest error is 2.00 %, of `GC-SRI-patch`, implicit, \
             on 10 cells."
        );
    }
}
