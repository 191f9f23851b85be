//! Grid convergence index and Richardson extrapolation, for values without an exact one.
//!
//! Tools that compute first and classify never report an order of 2 and an index of 4 % for a
//! diverging sequence; here the behaviour is decided first, and only a monotonically converging
//! one gets an estimate. The procedure for many grids is in
//! [`eca_hoekstra`](crate::uncertainty::eca_hoekstra).

use serde::{Deserialize, Serialize};

use crate::series::Undefined;
use oedometer_soil::elementary;

/// Safety factor of the index for three grids and an order that agrees with the formal one, or
/// where no formal order is known (Roache 1998; Celik et al. 2008).
pub const SAFETY_OBSERVED: f64 = 1.25;

/// Safety factor for an observed order off the formal one.
pub const SAFETY_ASSUMED: f64 = 3.0;

/// Largest order looked for.
const LARGEST_ORDER: f64 = 50.0;

/// How three values behave under refinement, from `R = (φ2 − φ1)/(φ3 − φ2)`, fine to coarse 1, 2, 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Behaviour {
    /// `R > 0`, and the differences fall as for a positive order.
    Monotone,
    /// `R < 0`: the value goes to and fro.
    Oscillatory,
    /// The differences do not fall.
    Divergent,
    /// Two neighbouring values are equal to round-off: there is no order to be had.
    Equal,
}

/// What three grids tell of a value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThreeGrids {
    /// The behaviour.
    pub behaviour: Behaviour,
    /// `R · ln r32 / ln r21`, which is `R` for equal ratios of sizes and below 1 exactly when a
    /// positive order exists. `None` where `φ3 = φ2`.
    pub convergence_ratio: Option<f64>,
    /// Range of the three values, `max |φi − φj|`, in the unit of the value. Three times that is the uncertainty of values
    /// that do not converge monotonically (Eça & Hoekstra 2009, *Computers & Fluids* 38, 1580–1591). Half of it, after Stern
    /// et al. (2001), is one only of values that swing about their limit by no more than they did, and does not cover
    /// those whose differences go to and fro on a way that is not at its end.
    pub range: f64,
    /// The estimate, for monotone convergence only.
    pub estimate: Option<GridConvergence>,
}

/// An extrapolated value and the indices of the grids.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GridConvergence {
    /// Observed order.
    pub order: f64,
    /// Order that the extrapolation and the indices use.
    pub order_used: f64,
    /// Richardson's `φ1 + (φ1 − φ2)/(r21^p − 1)`.
    pub extrapolated: f64,
    /// Safety factor in the indices.
    pub safety_factor: f64,
    /// `F_s |φ1 − φ2| / (r21^p − 1)`, in the unit of the value.
    pub index_fine: f64,
    /// `F_s |φ2 − φ3| / (r32^p − 1)`, in the unit of the value.
    pub index_medium: f64,
    /// `index_fine / |φ1|`; `None` where `φ1` is zero.
    pub relative_index_fine: Option<f64>,
    /// `GCI_32 / (r21^p GCI_21)` with the *formal* order: 1 in the asymptotic range. (With the
    /// observed order it is 1 whatever the values, and checks nothing.)
    pub asymptotic_ratio: Option<f64>,
}

/// Three-grid procedure of Celik et al. (2008), classification first.
///
/// `grids` are (size, value) pairs in any order. Where a formal order is given, an observed one
/// within 10 % of it is replaced by it with a safety factor of 1.25, and any other is limited to
/// between 0.5 and it with a factor of 3 (Oberkampf & Roy 2010, section 8.7).
///
/// # Errors
/// [`Undefined`] for bad or equal sizes, values or a formal order that are no numbers, and an order
/// beyond 50.
pub fn three_grids(grids: [(f64, f64); 3], formal_order: Option<f64>) -> Result<ThreeGrids, Undefined> {
    let mut grids = grids;
    check(&grids)?;
    if formal_order.is_some_and(|order| !order.is_finite() || order <= 0.0) {
        return Err(Undefined::NotDetermined);
    }
    grids.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(h1, f1), (h2, f2), (h3, f3)] = grids;
    if h2 <= h1 * (1.0 + 1e-9) || h3 <= h2 * (1.0 + 1e-9) {
        return Err(Undefined::SameSize { size: h2 });
    }
    let (r21, r32) = (h2 / h1, h3 / h2);
    let (fine, coarse) = (f2 - f1, f3 - f2);
    let range = f1.max(f2).max(f3) - f1.min(f2).min(f3);
    if !fine.is_finite() || !coarse.is_finite() {
        return Err(Undefined::NotFinite { size: h1 });
    }
    let round_off = 8.0 * f64::EPSILON * f1.abs().max(f2.abs()).max(f3.abs());
    let ratio = fine / coarse * elementary::ln(r32) / elementary::ln(r21);
    let mut found = ThreeGrids {
        behaviour: Behaviour::Equal,
        convergence_ratio: ratio.is_finite().then_some(ratio),
        range,
        estimate: None,
    };
    if fine.abs() <= round_off || coarse.abs() <= round_off {
        return Ok(found);
    }
    found.behaviour = match ratio {
        ratio if ratio < 0.0 => Behaviour::Oscillatory,
        ratio if ratio < 1.0 => Behaviour::Monotone,
        _ => Behaviour::Divergent,
    };
    if found.behaviour == Behaviour::Monotone {
        let order = order_of(coarse / fine, r21, r32).ok_or(Undefined::NotDetermined)?;
        found.estimate = Some(estimate([f1, f2, f3], r21, r32, order, formal_order));
    }
    Ok(found)
}

fn estimate(values: [f64; 3], r21: f64, r32: f64, order: f64, formal_order: Option<f64>) -> GridConvergence {
    let [f1, f2, f3] = values;
    let (order_used, safety_factor) = match formal_order {
        Some(formal) if (order - formal).abs() <= 0.1 * formal => (formal, SAFETY_OBSERVED),
        Some(formal) => (order.max(0.5).min(formal), SAFETY_ASSUMED),
        None => (order, SAFETY_OBSERVED),
    };
    let fine = |p: f64| (f1 - f2).abs() / power_less_one(r21, p);
    let medium = |p: f64| (f2 - f3).abs() / power_less_one(r32, p);
    GridConvergence {
        order,
        order_used,
        extrapolated: f1 + (f1 - f2) / power_less_one(r21, order_used),
        safety_factor,
        index_fine: safety_factor * fine(order_used),
        index_medium: safety_factor * medium(order_used),
        relative_index_fine: (f1 != 0.0).then(|| safety_factor * fine(order_used) / f1.abs()),
        asymptotic_ratio: formal_order.map(|p| medium(p) / (elementary::powf(r21, p) * fine(p))),
    }
}

/// `r^p − 1` without cancellation.
fn power_less_one(ratio: f64, order: f64) -> f64 {
    elementary::exp_m1(order * elementary::ln(ratio))
}

/// The order `p` at which `r21^p (r32^p − 1)/(r21^p − 1)` is the given ratio of differences;
/// the left side rises with `p` from `ln r32/ln r21`, so bisection finds it.
fn order_of(differences: f64, r21: f64, r32: f64) -> Option<f64> {
    let (a, b) = (elementary::ln(r21), elementary::ln(r32));
    // The logarithm of the left side, which stays in range for large orders.
    let side = |p: f64| {
        b * p + elementary::ln(-elementary::exp_m1(-b * p)) - elementary::ln(-elementary::exp_m1(-a * p))
    };
    let wanted = elementary::ln(differences);
    let (mut low, mut high) = (0.0, LARGEST_ORDER);
    if side(high) <= wanted {
        return None;
    }
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if side(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(f64::midpoint(low, high))
}

/// Refuses sizes and values that are no numbers.
///
/// # Errors
/// [`Undefined`] with the first of them.
pub fn check(grids: &[(f64, f64)]) -> Result<(), Undefined> {
    for (index, (size, value)) in grids.iter().enumerate() {
        if !size.is_normal() || *size < 0.0 {
            return Err(Undefined::BadSize { number: index + 1 });
        }
        if !value.is_finite() {
            return Err(Undefined::NotFinite { size: *size });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
