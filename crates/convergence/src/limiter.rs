//! Possible causes of a floor under an error, which of them fits, and what to do about it.

use serde::{Deserialize, Serialize};

use oedometer_soil::elementary;
use oedometer_soil::wording::short;

/// Kinds of limits that refining the mesh does not move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LimiterKind {
    /// The time step.
    Step,
    /// The cell size, in a series over something else.
    Mesh,
    /// The number of points per cell.
    PointsPerCell,
    /// The accuracy of the reference solution.
    Reference,
    /// The equations solved are not those of the reference.
    Model,
    /// Round-off.
    RoundOff,
}

/// A candidate for the cause of a floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limiter {
    /// Its kind.
    pub kind: LimiterKind,
    /// Its name in words, such as "the water's storage"; for a step rule, what one would lower.
    pub name: String,
    /// The floor it is known to cause, in the unit of the errors.
    pub magnitude: Option<f64>,
    /// The order at which the floor falls when the cause is refined; 1 where unknown.
    pub order: Option<f64>,
}

impl Limiter {
    /// A candidate of unknown height and order.
    pub fn new(kind: LimiterKind, name: &str) -> Self {
        Self { kind, name: name.to_owned(), magnitude: None, order: None }
    }
}

/// A floor and a candidate agree when they are within this factor.
const AGREEMENT: f64 = 3.0;

/// The candidate that fits a floor: the nearest in height, or the only one of unknown height.
pub(crate) fn identify(floor: f64, candidates: &[Limiter]) -> Option<&Limiter> {
    let distance = |candidate: &&Limiter| {
        let ratio = elementary::ln(candidate.magnitude? / floor).abs();
        ratio.is_finite().then_some(ratio)
    };
    let near = candidates
        .iter()
        .filter_map(|candidate| Some((distance(&candidate)?, candidate)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(distance, _)| *distance <= elementary::ln(AGREEMENT));
    if let Some((_, candidate)) = near {
        return Some(candidate);
    }
    let mut unknown = candidates.iter().filter(|candidate| candidate.magnitude.is_none());
    match (unknown.next(), unknown.next()) {
        (Some(only), None) => Some(only),
        _ => None,
    }
}

/// What to change so that the floor falls to `target`, or how to find out what causes it.
pub(crate) fn advice(
    floor: f64,
    target: Option<f64>,
    limiter: Option<&Limiter>,
    candidates: &[Limiter],
) -> String {
    let Some(limiter) = limiter else {
        let names: Vec<_> = candidates.iter().map(|candidate| candidate.name.as_str()).collect();
        let suspects = if names.is_empty() {
            "the time step, the points per cell, the reference and the model".to_owned()
        } else {
            names.join(", ")
        };
        return format!("no known cause fits: vary {suspects}, one at a time");
    };
    let order = limiter.order.filter(|order| order.is_finite() && *order > 0.0).unwrap_or(1.0);
    let factor = target.map_or(4.0, |target| elementary::powf(floor / target, 1.0 / order));
    // Rounded up to a power of two, as people halve things.
    let factor = elementary::exp2(elementary::log2(factor.clamp(2.0, 1e9)).ceil());
    match limiter.kind {
        LimiterKind::Step => format!("lower {} by {factor}", limiter.name),
        LimiterKind::Mesh => format!("refine the mesh by {factor}"),
        LimiterKind::PointsPerCell => format!("raise the points per cell by {factor}"),
        LimiterKind::Reference => {
            let accuracy = short(target.unwrap_or(0.1 * floor));
            format!("use a reference that is accurate to {accuracy}, or stop refining")
        }
        LimiterKind::Model => format!(
            "compare the run with the reference of its own equations: {} makes the difference",
            limiter.name
        ),
        LimiterKind::RoundOff => "drop the finest levels: they show round-off".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(kind: LimiterKind, magnitude: Option<f64>) -> Limiter {
        Limiter { kind, name: format!("{kind:?}"), magnitude, order: None }
    }

    #[test]
    fn the_nearest_candidate_is_taken_and_a_far_one_is_not() {
        let step = candidate(LimiterKind::Step, Some(2e-4));
        let model = candidate(LimiterKind::Model, Some(5e-5));
        let both = [step.clone(), model.clone()];
        assert_eq!(identify(1.5e-4, &both), Some(&step));
        assert_eq!(identify(6e-5, &both), Some(&model));
        assert_eq!(identify(1e-2, &both), None);
        let unknown = candidate(LimiterKind::PointsPerCell, None);
        assert_eq!(identify(1e-2, &[step.clone(), unknown.clone()]), Some(&unknown));
        assert_eq!(identify(1e-2, &[unknown.clone(), unknown]), None);
        let nonsense = candidate(LimiterKind::Step, Some(f64::NAN));
        assert_eq!(identify(1e-2, &[nonsense]), None);
    }

    #[test]
    fn the_advice_counts_with_the_order_of_the_cause() {
        let mut step = candidate(LimiterKind::Step, None);
        step.name = "the time step".to_owned();
        assert_eq!(advice(4e-4, Some(1e-4), Some(&step), &[]), "lower the time step by 4");
        assert_eq!(advice(5e-4, Some(1e-4), Some(&step), &[]), "lower the time step by 8");
        step.order = Some(2.0);
        assert_eq!(advice(4e-4, Some(1e-4), Some(&step), &[]), "lower the time step by 2");
        assert_eq!(advice(4e-4, None, Some(&step), &[]), "lower the time step by 4");
        assert!(advice(1.0, None, None, &[step]).contains("the time step"));
    }
}
