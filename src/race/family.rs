//! Work and precision of a family: the error below which a contender stays in most of the family's situations, for as much
//! work in each.

use crate::case::grouping::distinct;
use crate::race::finish::RaceQuantity;
use crate::race::situation::{Entry, Situation};
use oedometer_soil::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The curve of a contender over a family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FamilyCurve {
    /// The family.
    pub family: String,
    /// The contender.
    pub contender: String,
    /// Counted work in each situation, s, and the largest error in most of the situations.
    pub points: Vec<(f64, f64)>,
}

/// Error over work in one situation: `[level] = (cost, error)`, costs rising.
struct Curve {
    points: Vec<(f64, f64)>,
    /// Whether its last run failed, so that more work gives no error.
    breaks: bool,
}

impl Curve {
    fn new(entry: &Entry) -> Option<Self> {
        let measured = |error: Option<f64>| error.filter(|error| error.is_finite() && *error > 0.0);
        let points: Vec<(f64, f64)> = entry
            .levels
            .iter()
            .filter_map(|level| Some((level.cost, measured(RaceQuantity::All.error_in(&level.errors))?)))
            .collect();
        let breaks =
            entry.levels.last().is_some_and(|level| RaceQuantity::All.error_in(&level.errors).is_none());
        (!points.is_empty()).then_some(Self { points, breaks })
    }

    /// The error for some work, between meshes by powers; beyond the finest mesh it stays. `None` before the coarsest mesh, and
    /// where more work gives no error.
    fn at(&self, work: f64) -> Option<f64> {
        let after = self.points.partition_point(|(cost, _)| *cost < work);
        let Some(&(above, fine)) = self.points.get(after) else {
            return self.points.last().filter(|_| !self.breaks).map(|(_, error)| *error);
        };
        let Some(&(below, coarse)) = after.checked_sub(1).map(|before| &self.points[before]) else {
            return (above <= work).then_some(fine);
        };
        let share = elementary::ln(work / below) / elementary::ln(above / below);
        Some(coarse * elementary::powf(fine / coarse, share))
    }
}

/// The curves of all contenders over a family; one without a run in the family has none.
pub fn family_curves(family: &str, situations: &[&Situation]) -> Vec<FamilyCurve> {
    let entries = situations.iter().flat_map(|situation| &situation.entries);
    let contenders = distinct(entries.map(|entry| entry.contender.as_str()));
    let curve = |contender: &str| {
        let entries = situations.iter().flat_map(|situation| &situation.entries);
        let curves: Vec<Curve> =
            entries.filter(|entry| entry.contender == contender).filter_map(Curve::new).collect();
        let points = in_most(&curves, situations.len());
        (!points.is_empty()).then(|| FamilyCurve {
            family: family.to_owned(),
            contender: contender.to_owned(),
            points,
        })
    };
    contenders.into_iter().filter_map(curve).collect()
}

/// The largest error in more than half of so many situations, at the costs of all curves. A situation without an error for
/// that work is worse than any other.
fn in_most(curves: &[Curve], situations: usize) -> Vec<(f64, f64)> {
    let mut costs: Vec<f64> =
        curves.iter().flat_map(|curve| curve.points.iter().map(|(cost, _)| *cost)).collect();
    costs.sort_by(f64::total_cmp);
    costs.dedup();
    let error = |cost: f64| {
        let mut errors: Vec<f64> = curves.iter().filter_map(|curve| curve.at(cost)).collect();
        errors.sort_by(f64::total_cmp);
        errors.get(situations / 2).copied()
    };
    costs.into_iter().filter_map(|cost| Some((cost, error(cost)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_has_the_error_below_which_most_of_its_situations_stay_for_as_much_work_in_each() {
        let curve = |points: &[(f64, f64)], breaks: bool| Curve { points: points.to_vec(), breaks };
        let falls = || curve(&[(1.0, 0.1), (100.0, 0.001)], false);
        assert_eq!(
            [0.5, 1.0, 100.0, 1e3].map(|work| falls().at(work)),
            [None, Some(0.1), Some(0.001), Some(0.001)]
        );
        let between = falls().at(10.0).expect("an error");
        assert!((between - 0.01).abs() < 1e-15, "by powers: {between}");
        assert_eq!(in_most(&[falls()], 1), [(1.0, 0.1), (100.0, 0.001)]);
        // Two of two: the one that begins later and stalls decides.
        let stalls = || curve(&[(10.0, 0.02), (50.0, 0.015)], false);
        assert_eq!(in_most(&[falls(), stalls()], 2), [(10.0, 0.02), (50.0, 0.015), (100.0, 0.015)]);
        // Two of three: the worst does not count, nor does it where it has no error at all.
        let worst = || curve(&[(1.0, 3.0), (100.0, 2.0)], false);
        let two_of_three = in_most(&[falls(), stalls(), worst()], 3);
        assert_eq!(two_of_three, [(1.0, 3.0), (10.0, 0.02), (50.0, 0.015), (100.0, 0.015)]);
        assert_eq!(in_most(&[falls(), stalls()], 3), in_most(&[falls(), stalls()], 2));
        // Where a run fails, more work gives no error.
        let fails = curve(&[(10.0, 0.02), (50.0, 0.015)], true);
        assert_eq!(in_most(&[falls(), fails], 2), [(10.0, 0.02), (50.0, 0.015)]);
        assert_eq!(in_most(&[falls()], 2), []);
    }
}
