//! The class of a steadily falling error, judged on its finest window.

use crate::class::evaluable_series::{EvaluableSeries, FLOOR_LEVELS};
use crate::class::{Class, Classification};
use crate::fit::bending_order::{Bend, explain};
use oedometer_wording::{order, orders, rounded};

/// An observed order this close to the formal one counts as the formal one.
const FORMAL_TOLERANCE: f64 = 0.25;

/// An order that changes by no more than this per halving of the size has settled. The change is measured per halving
/// because closer levels change the order by less from pair to pair, however far it still is from its limit.
const SETTLED: f64 = 0.1;

/// A second term with a smaller share of the finest error than this does not govern it.
const GOVERNS: f64 = 0.2;

/// No method here has an order above this.
const ABSURD: f64 = 6.0;

/// Judges a series that falls steadily.
pub fn judge_window(case: &EvaluableSeries) -> Classification {
    let [.., coarse, fine] = *case.pairs.as_slice() else {
        return Classification::new(Class::NotEvaluable, "fewer than two pairs of levels");
    };
    let window =
        format!("order {} on the three finest levels ({})", order(case.order), orders(&[coarse, fine]));
    let classification = match case.formal {
        Some(formal) => with_formal(case, &window, formal, coarse, fine),
        None => without_formal(case, &window, fine),
    };
    let counts = classification.class != Class::FloorLimited && classification.class != Class::NotEvaluable;
    if counts { Classification { order: Some(case.order), ..classification } } else { classification }
}

fn with_formal(case: &EvaluableSeries, window: &str, formal: f64, coarse: f64, fine: f64) -> Classification {
    let wanted = order(formal);
    let drift = case.drift;
    // An order below 1 is bent by a floor in proportion: its drift goes with its square.
    let tolerance = FORMAL_TOLERANCE * formal.min(1.0);
    let falls_away = fine < formal - 0.1 * formal.min(1.0)
        && (drift < -0.5 * SETTLED || case.floor_that_would_bend() > 0.5 * GOVERNS);
    let stays_below = case.order < formal - tolerance && drift < 0.5 * SETTLED;
    let bend = || explain(case.points, Some(formal));
    if falls_away || stays_below {
        if let Some(classification) = bend().and_then(|bend| governed(case, &bend, window)) {
            return classification;
        }
        if stays_below && drift.abs() <= SETTLED {
            let reason = format!("{window}: settled below the formal {wanted}");
            return contaminated(reason, "a term of that order dominates every level");
        }
    }
    let near = |value: f64| (value - formal).abs() <= tolerance;
    // Orders that are both near the formal one are where they go, whatever they do between close levels.
    if near(coarse) && near(fine) && near(case.order) && (fine - coarse).abs() <= FORMAL_TOLERANCE {
        return Classification::new(Class::Asymptotic, format!("{window}, formal {wanted}"));
    }
    if case.order > formal {
        let dying = matches!(bend(), Some(Bend::Higher(terms)) if terms.low_share(case.finest().0) > 0.1);
        if drift.abs() <= SETTLED && !dying {
            let reason = format!("{window}: steady and above the formal {wanted}");
            return Classification::new(Class::Superconvergent, reason).advise(
                "check whether the problem is too easy or the samples lie at superconvergent points",
            );
        }
        let why = if drift > 0.0 { "still rising, as if two terms cancelled" } else { "still falling" };
        return unsettled(format!("{window}: above the formal {wanted} and {why}"));
    }
    unsettled(format!("{window}: not settled at the formal {wanted}"))
}

fn without_formal(case: &EvaluableSeries, window: &str, fine: f64) -> Classification {
    if case.order > ABSURD {
        return Classification::new(
            Class::Superconvergent,
            format!("{window}: no method here has an order above {ABSURD}"),
        );
    }
    let drift = case.drift;
    let fall = case.pairs.first().map_or(0.0, |first| first - fine);
    let may_be_floor = case.floor_that_would_bend() > GOVERNS;
    if fall > 0.3 || drift < -SETTLED || may_be_floor {
        let bend = explain(case.points, None);
        let settled = |bend: &Bend| (fine - bend.terms().low).abs() <= SETTLED;
        let classification = bend
            .filter(|bend| matches!(bend, Bend::Floor(_)) || !settled(bend))
            .and_then(|bend| governed(case, &bend, window));
        if let Some(classification) = classification {
            return classification;
        }
    }
    if drift.abs() <= SETTLED && !may_be_floor {
        return Classification::new(Class::Asymptotic, window);
    }
    unsettled(format!("{window}: not settled"))
}

/// The class where a second term governs the finest level.
fn governed(case: &EvaluableSeries, bend: &Bend, window: &str) -> Option<Classification> {
    let size = case.finest().0;
    let terms = bend.terms();
    let share = terms.low_share(size);
    if share < GOVERNS {
        return None;
    }
    let percent = 100.0 * share;
    match bend {
        // Without a formal order a lower power on four levels looks like a floor, unless the floor fits by far.
        Bend::Floor(_)
            if case.points.len() < FLOOR_LEVELS || case.formal.is_none() && !case.has_significant_floor() =>
        {
            Some(case.may_be_limited(window, terms.low_coefficient))
        }
        Bend::Floor(_) => {
            Some(case.limited(&format!(
                "{window}, and an error plateau makes up {percent:.0} % of the finest error"
            )))
        }
        Bend::Lower(_) => Some(contaminated(
            format!(
                "{window}, and a term of order {} makes up {percent:.0} % of the finest error",
                order(terms.low)
            ),
            &terms.crossover().map_or_else(
                || "it dominates every level".to_owned(),
                |at| format!("the term of lower order dominates below size {}", rounded(at)),
            ),
        )),
        Bend::Higher(_) => None,
    }
}

fn contaminated(reason: String, note: &str) -> Classification {
    let advice =
        format!("{note}: look for a boundary, a recovery, an integrator or a refinement path of lower order");
    Classification::new(Class::Contaminated, reason).advise(advice)
}

fn unsettled(reason: String) -> Classification {
    Classification::new(Class::PreAsymptotic, reason).advise("add a finer level and check again")
}
