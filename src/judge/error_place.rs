//! The place that carries most of an error.

use crate::measure::fields::error_contributions::largest_contribution;
use crate::measure::fields::exact_fields::exact_samples;
use crate::measure::known_references::known_reference;
use crate::record::{ErrorRow, Record};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::wording::{short, typed};

/// A place with what stands there.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ErrorPlace {
    /// Initial depth over the height.
    pub zeta: f64,
    /// Share of the squared L2 error.
    pub share: f64,
    /// Computed value, SI.
    pub computed: f64,
    /// Exact value, SI.
    pub exact: f64,
}

/// The place that carries most of an error; none where the quantity has one place only.
///
/// # Errors
/// When a reference refuses the case.
pub fn place_of(record: &Record, row: &ErrorRow) -> Result<Option<ErrorPlace>, ExactError> {
    let case = &record.case;
    let samples = record.snapshot(row.time_factor).and_then(|snapshot| row.sample.of(snapshot));
    let (Some(samples), Ok(kind)) = (samples, row.reference.parse::<ReferenceKind>()) else {
        return Ok(None);
    };
    let reference = known_reference(case, kind.of_soil(&case.material), &[row.time_factor])?;
    let exact = exact_samples(case, &reference, row.time_factor, samples)?;
    let fields = row.quantity.field(samples).zip(row.quantity.field(&exact));
    Ok(fields.and_then(|(computed, exact)| {
        let worst = largest_contribution(computed, exact, &samples.volume)?;
        Some(ErrorPlace {
            zeta: 1.0 - samples.initial_height[worst.index] / case.column.height,
            share: worst.share,
            computed: computed[worst.index],
            exact: exact[worst.index],
        })
    }))
}

/// Where most of an error of somebody else's result is, as a sentence: who sees a gate fail has no other way to look.
/// None for a case of this program, which `explain` runs again.
pub fn place_of_attached(record: &Record, row: &ErrorRow) -> Option<String> {
    record.attached.as_ref()?;
    let place = place_of(record, row).ok()??;
    Some(format!(
        "most of the error of {} at T_v = {} lies at ζ = {} (height {} m): {} for {}, {:.0} % of the squared error",
        row.quantity.name(),
        typed(row.time_factor),
        short(place.zeta),
        short((1.0 - place.zeta) * record.case.column.height),
        short(place.computed),
        short(place.exact),
        100.0 * place.share
    ))
}
