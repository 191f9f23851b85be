//! Orders, classes and verdicts of a series of errors.

use crate::api::error::ApiError;
use crate::judge::verdict::{Beside, Verdict, judge};
use crate::measure::round_off::{ROUND_OFF, SINGLE_PRECISION};
use crate::study::diagnostic::one_of;
use oedometer_convergence::{
    Class, Classification, Context, ErrorBound, ErrorSeries, OrderBand, SeriesDemand, SeriesLevel, classify,
    pair_orders,
};

/// The orders and class of a series.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Found {
    /// Sizes of the levels, coarse to fine.
    pub sizes: Vec<f64>,
    /// Absolute errors at them.
    pub errors: Vec<f64>,
    /// Orders between neighbouring levels, one fewer than levels; `None` where undefined.
    pub pair_orders: Vec<Option<f64>>,
    /// Class with its reason, order, floor and advice.
    pub classification: Classification,
}

/// Demands on a series; what is left out is not judged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Demand {
    /// The order, and how far below and above it may lie.
    pub order: Option<(f64, f64, f64)>,
    /// The size of a level and the bound on its error.
    pub at: Option<(f64, f64)>,
    /// The class; `asymptotic` where an order is demanded and no class is named.
    pub class: Option<String>,
}

/// A series of errors with its context.
fn series_of(
    sizes: &[f64],
    errors: &[f64],
    formal_order: Option<f64>,
) -> Result<(ErrorSeries, Context), ApiError> {
    if sizes.len() != errors.len() {
        let (sizes, errors) = (sizes.len(), errors.len());
        let why = format!("there are {sizes} sizes and {errors} errors: give one of each per level");
        return Err(ApiError::Unfit(why));
    }
    let level = |(size, error): (&f64, &f64)| SeriesLevel { size: *size, error: Some(error.abs()) };
    let series = ErrorSeries::new(sizes.iter().zip(errors).map(level).collect());
    let mut signed: Vec<(f64, f64)> = sizes.iter().copied().zip(errors.iter().copied()).collect();
    signed.sort_by(|a, b| b.0.total_cmp(&a.0));
    // Norms have no sign, so signs carry no information here.
    let has_signs = errors.iter().any(|error| *error < 0.0);
    let signed = if has_signs { signed.into_iter().map(|(_, error)| error).collect() } else { Vec::new() };
    let (round_off, tolerance) = (Some(ROUND_OFF), Some(SINGLE_PRECISION));
    Ok((series, Context { formal_order, round_off, tolerance, signed, ..Context::default() }))
}

/// Class, order and pair orders of errors over the sizes of their levels, in any order. Errors are relative ones: those
/// up to 1e-6 that do not fall are taken for the digits of single precision, and those up to 1e-12 for round-off.
///
/// ```
/// let found = oedometer::api::convergence::convergence(&[0.1, 0.05, 0.025], &[4e-2, 1e-2, 2.5e-3], None);
/// assert_eq!(found.expect("a series").pair_orders, [Some(2.0), Some(2.0)]);
/// ```
///
/// # Errors
/// When the lists differ in length.
pub fn convergence(sizes: &[f64], errors: &[f64], formal_order: Option<f64>) -> Result<Found, ApiError> {
    let (series, context) = series_of(sizes, errors, formal_order)?;
    Ok(Found {
        sizes: series.levels().iter().map(|level| level.size).collect(),
        errors: series.levels().iter().map(|level| level.error.unwrap_or(f64::NAN)).collect(),
        pair_orders: pair_orders(&series).into_iter().map(Result::ok).collect(),
        classification: classify(&series, &context),
    })
}

/// The verdict of a demand on a series: whether it passes, and the sentence that says why.
///
/// # Errors
/// When the lists differ in length, or the class does not exist.
pub fn verdict(sizes: &[f64], errors: &[f64], demand: &Demand) -> Result<(bool, String), ApiError> {
    let (series, context) = series_of(sizes, errors, demand.order.map(|(value, ..)| value))?;
    let class = demand.class.as_deref().map(|word| {
        let unknown = || format!("unknown class `{word}`: {}", one_of(word, &Class::NAMES));
        Class::named(word).ok_or_else(|| ApiError::UnknownName(unknown()))
    });
    let demand = SeriesDemand {
        order: demand.order.map(|(value, minus, plus)| OrderBand { value, minus, plus }),
        at: demand.at.map(|(size, below)| ErrorBound { size, below, above: 0.0 }),
        class: class.transpose()?,
        ..SeriesDemand::default()
    };
    let Verdict { pass, reason, .. } = judge(&demand, &series, &context, &Beside::default());
    Ok((pass, reason))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_come_in_any_order_and_signs_count() {
        let found = convergence(&[0.025, 0.1, 0.05], &[2.5e-3, 4e-2, 1e-2], Some(2.0)).expect("a series");
        assert_eq!(found.sizes, [0.1, 0.05, 0.025]);
        assert_eq!(found.classification.class, Class::Asymptotic);
        assert!((found.classification.order.expect("an order") - 2.0).abs() < 1e-9);
        let told = "there are 1 sizes and 0 errors: give one of each per level";
        assert_eq!(convergence(&[0.1], &[], None).expect_err("no pairs").to_string(), told);
        let lacking = convergence(&[0.1, 0.05, 0.025], &[4e-2, f64::NAN, 2.5e-3], None).expect("a series");
        assert_eq!((lacking.pair_orders, lacking.errors[2]), (vec![None, None], 2.5e-3));
        // 0.171, −0.145, −0.223 % go to a limit, and their sizes alone would grow.
        let of = |errors: [f64; 4]| {
            let found = convergence(&[0.1, 0.05, 0.025, 0.0125], &errors, None);
            found.expect("a series").classification
        };
        let errors = [1.71e-3, -1.45e-3, -2.23e-3, -2.43e-3];
        let signed = of(errors);
        assert_eq!(signed.class, Class::FloorLimited);
        assert!((signed.order.expect("an order") - 2.0).abs() < 0.3, "{signed:?}");
        assert_ne!(signed, of(errors.map(f64::abs)));
    }

    #[test]
    fn a_demand_is_met_or_told() {
        let (sizes, errors) = ([0.1, 0.05, 0.025], [4e-2, 1e-2, 2.5e-3]);
        let demand = Demand { order: Some((2.0, 0.1, 0.1)), at: Some((0.1, 5e-2)), class: None };
        assert!(verdict(&sizes, &errors, &demand).expect("a series").0);
        let first = Demand { order: Some((1.0, 0.1, 0.1)), ..Demand::default() };
        let (pass, reason) = verdict(&sizes, &errors, &first).expect("a series");
        assert!(!pass && reason.contains("2.0"), "{reason}");
        let nonsense = verdict(&sizes, &[4e-2, f64::NAN, 2.5e-3], &demand).expect("a series");
        assert!(!nonsense.0, "{}", nonsense.1);
        let unknown = Demand { class: Some("asymptotics".to_owned()), ..Demand::default() };
        let told = verdict(&sizes, &errors, &unknown).expect_err("no class").to_string();
        assert!(told.starts_with("unknown class `asymptotics`: ") && told.contains("`asymptotic`"), "{told}");
    }

    #[test]
    fn the_order_in_which_levels_are_given_changes_neither_signs_nor_verdict() {
        // A sign that changes between the first two levels, and one that changes at the finest.
        for errors in [[1.71e-3, -1.45e-3, -2.23e-3, -2.43e-3], [4e-2, 1e-2, 1.5e-3, -6e-4]] {
            let levels: Vec<(f64, f64)> = [0.1, 0.05, 0.025, 0.0125].into_iter().zip(errors).collect();
            let turned = |order: [usize; 4]| -> (Vec<f64>, Vec<f64>) {
                order.into_iter().map(|place| levels[place]).unzip()
            };
            let (sizes, errors) = turned([0, 1, 2, 3]);
            let found = convergence(&sizes, &errors, Some(2.0)).expect("a series");
            let demand = Demand { order: Some((2.0, 0.3, 0.3)), ..Demand::default() };
            let judged = verdict(&sizes, &errors, &demand).expect("a series");
            for order in [[3, 2, 1, 0], [1, 0, 2, 3], [0, 1, 3, 2], [2, 3, 0, 1]] {
                let (sizes, errors) = turned(order);
                assert_eq!(convergence(&sizes, &errors, Some(2.0)).expect("a series"), found, "{order:?}");
                assert_eq!(verdict(&sizes, &errors, &demand).expect("a series"), judged, "{order:?}");
            }
            let sizes_alone =
                convergence(&sizes, &errors.iter().map(|one| one.abs()).collect::<Vec<_>>(), Some(2.0));
            assert_ne!(sizes_alone.expect("a series").classification, found.classification, "signs count");
        }
    }

    #[test]
    fn each_demand_is_judged_at_its_level_and_on_both_sides_of_its_bound() {
        let (sizes, errors) = ([0.1, 0.05, 0.025], [4e-2, 1e-2, 2.5e-3]);
        let passes = |demand: Demand| verdict(&sizes, &errors, &demand).expect("a series").0;
        for (size, error) in sizes.into_iter().zip(errors) {
            for (share, is_met) in [(1.01, true), (0.99, false)] {
                let demand = Demand { at: Some((size, share * error)), ..Demand::default() };
                assert_eq!(passes(demand), is_met, "{size} {share}");
            }
        }
        for (order, is_met) in [
            ((2.05, 0.1, 0.01), true),
            ((2.05, 0.01, 0.1), false),
            ((1.95, 0.01, 0.1), true),
            ((1.95, 0.1, 0.01), false),
        ] {
            assert_eq!(passes(Demand { order: Some(order), ..Demand::default() }), is_met, "{order:?}");
        }
        for (class, is_met) in [("asymptotic", true), ("floor-limited", false)] {
            assert_eq!(
                passes(Demand { class: Some(class.to_owned()), ..Demand::default() }),
                is_met,
                "{class}"
            );
        }
    }
}
