//! Where most of an error lies.

use crate::measure::fields::{exact_samples, largest_contribution};
use crate::measure::theory::known_reference;
use crate::record::{ErrorRow, Record};
use crate::render::number;
use oedometer_exact::{ExactError, ReferenceKind};
use oedometer_wording::{rounded, typed};

/// A place with its computed and exact value.
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

/// The place with the largest share of an error; `None` where the quantity has a single place.
///
/// # Errors
/// When a reference refuses the case.
pub fn place_of(record: &Record, row: &ErrorRow) -> Result<Option<ErrorPlace>, ExactError> {
    let case = &record.case;
    let samples = record.snapshot(row.time_factor).and_then(|snapshot| row.sample.samples(snapshot));
    let (Some(samples), Ok(kind)) = (samples, row.reference.parse::<ReferenceKind>()) else {
        return Ok(None);
    };
    let reference = known_reference(case, kind.for_soil(&case.material), &[row.time_factor])?;
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

/// Where most of an error lies, as a sentence, in a record that `explain` cannot make again.
pub fn place_in_kept(record: &Record, row: &ErrorRow) -> Option<String> {
    if record.can_be_made_again() {
        return None;
    }
    let place = place_of(record, row).ok()??;
    Some(format!(
        "most of the error of {} at T_v = {} lies at ζ = {} (height {} m): {} for {}, {} of the squared error",
        row.quantity.name(),
        typed(row.time_factor),
        rounded(place.zeta),
        rounded((1.0 - place.zeta) * record.case.column.height),
        rounded(place.computed),
        rounded(place.exact),
        number::rounded_percent(place.share)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::quantity::Quantity;

    #[test]
    fn the_place_of_an_attached_solver_s_error_is_told_with_both_values() {
        let mut record = records_of(
            "title = 't'\nscene = 'terzaghi'\ncolumn = { height = 2.0, load = 40.0 }\noutput.time_factors = [0.1]\n[[sweep]]\n\
             method = ['GIMP']\nintegrator = ['implicit']\ncells = [4]\n",
        )
        .remove(0);
        let reference = known_reference(&record.case, ReferenceKind::Terzaghi, &[0.1]).expect("a theory");
        let exact = |height: f64| reference.fields(0.1, 1.0 - height / 2.0).expect("inside").pressure;
        let points = &mut record.snapshots[0].points;
        points.pressure = points.initial_height.iter().map(|height| exact(*height)).collect();
        // Three and one of 5 Pa: nine tenths of the squares at the height of 1.375 m.
        (points.pressure[5], points.pressure[2]) = (exact(1.375) - 15.0, exact(0.625) + 5.0);
        let (computed, exact) = (rounded(exact(1.375) - 15.0), rounded(exact(1.375)));
        let rows = record.errors.clone();
        let is_meant =
            |row: &&ErrorRow| (row.quantity, row.sample) == (Quantity::Pressure, crate::case::Sample::Points);
        let row = rows.iter().find(is_meant).expect("an error");
        assert_eq!(place_in_kept(&record, row), None, "a run of this program can be made again");
        record = record.made_outside(crate::record::AttachedRun::default());
        let told = format!(
            "most of the error of pressure at T_v = 0.1 lies at ζ = 0.3125 (height 1.375 m): {computed} for {exact}, 90 % of \
             the squared error"
        );
        assert_eq!(place_in_kept(&record, row), Some(told));
        let settlement = rows.iter().find(|row| row.quantity == Quantity::Settlement).expect("an error");
        assert_eq!(place_in_kept(&record, settlement), None, "a settlement has a single place");
        assert_eq!(place_in_kept(&record, &ErrorRow { time_factor: 0.2, ..row.clone() }), None);
    }
}
