//! Grid convergence index and Richardson extrapolation, for values without an exact one.
//!
//! The behaviour is decided first, and only monotonically converging values get an estimate: computed without
//! that check, a diverging sequence can report an order of 2 and an index of 4 %. The procedure for many grids is
//! in `eca_hoekstra`.

use serde::{Deserialize, Serialize};

use crate::fit::order_of_differences;
use crate::series::{Undefined, finite_levels};
use oedometer_soil::elementary::{exp_m1, ln, powf};

/// Safety factor of the index for three grids and an order that agrees with the formal one, or
/// where no formal order is known (Roache 1998; Celik et al. 2008).
pub(crate) const SAFETY_OBSERVED: f64 = 1.25;

/// Safety factor for an observed order off the formal one.
pub(crate) const SAFETY_ASSUMED: f64 = 3.0;

/// How three values behave under refinement, from `R = (φ2 − φ1)/(φ3 − φ2)`, fine to coarse 1, 2, 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Behaviour {
    /// `R > 0`, and the differences fall as for a positive order.
    Monotone,
    /// `R < 0`: the value goes up and down.
    Oscillatory,
    /// The differences do not fall.
    Divergent,
    /// Two neighbouring values are equal to round-off, so the order is undefined.
    Equal,
}

/// The behaviour of a value on three grids.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThreeGrids {
    /// The behaviour.
    pub behaviour: Behaviour,
    /// `R · ln r32 / ln r21`, which is `R` for equal ratios of sizes and below 1 exactly when a
    /// positive order exists. `None` where `φ3 = φ2`.
    pub convergence_ratio: Option<f64>,
    /// Range of the three values, `max |φi − φj|`, in the unit of the value. Three times the range is the uncertainty of
    /// values that do not converge monotonically (Eça & Hoekstra 2009, *Computers & Fluids* 38, 1580–1591). Half the
    /// range (Stern et al. 2001) covers only values that oscillate about their limit with an amplitude that does not
    /// grow, not those that oscillate about a trend.
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

/// Three-grid procedure of Celik et al. (2008); classifies first.
///
/// `grids` are (size, value) pairs in any order. Where a formal order is given, an observed one
/// within 10 % of it is replaced by it with a safety factor of 1.25, and any other is limited to
/// between 0.5 and it with a factor of 3 (Oberkampf & Roy 2010, section 8.7).
///
/// # Errors
/// [`Undefined`] for bad or equal sizes, a value or formal order that is not finite, and an order above 50.
pub(crate) fn three_grids(
    grids: [(f64, f64); 3],
    formal_order: Option<f64>,
) -> Result<ThreeGrids, Undefined> {
    let grids = finite_levels(&grids)?;
    if formal_order.is_some_and(|order| !order.is_finite() || order <= 0.0) {
        return Err(Undefined::NotDetermined);
    }
    let [(h1, f1), (h2, f2), (h3, f3)] = [grids[2], grids[1], grids[0]];
    let (r21, r32) = (h2 / h1, h3 / h2);
    let (fine, coarse) = (f2 - f1, f3 - f2);
    if !fine.is_finite() || !coarse.is_finite() {
        return Err(Undefined::NotFinite { size: h1 });
    }
    let round_off = 8.0 * f64::EPSILON * f1.abs().max(f2.abs()).max(f3.abs());
    let ratio = fine / coarse * ln(r32) / ln(r21);
    let behaviour = match ratio {
        _ if fine.abs() <= round_off || coarse.abs() <= round_off => Behaviour::Equal,
        ratio if ratio < 0.0 => Behaviour::Oscillatory,
        ratio if ratio < 1.0 => Behaviour::Monotone,
        _ => Behaviour::Divergent,
    };
    let estimate = if behaviour == Behaviour::Monotone {
        let order = order_of_differences(coarse / fine, r21, r32).ok_or(Undefined::NotDetermined)?;
        Some(estimate([f1, f2, f3], r21, r32, order, formal_order))
    } else {
        None
    };
    let range = f1.max(f2).max(f3) - f1.min(f2).min(f3);
    let convergence_ratio = ratio.is_finite().then_some(ratio);
    Ok(ThreeGrids { behaviour, convergence_ratio, range, estimate })
}

fn estimate(values: [f64; 3], r21: f64, r32: f64, order: f64, formal_order: Option<f64>) -> GridConvergence {
    let [f1, f2, f3] = values;
    let (order_used, safety_factor) = match formal_order {
        Some(formal) if (order - formal).abs() <= 0.1 * formal => (formal, SAFETY_OBSERVED),
        Some(formal) => (order.max(0.5).min(formal), SAFETY_ASSUMED),
        None => (order, SAFETY_OBSERVED),
    };
    // `r^p − 1` without cancellation.
    let power_minus_one = |ratio: f64, p: f64| exp_m1(p * ln(ratio));
    let fine = |p: f64| (f1 - f2).abs() / power_minus_one(r21, p);
    let medium = |p: f64| (f2 - f3).abs() / power_minus_one(r32, p);
    GridConvergence {
        order,
        order_used,
        extrapolated: f1 + (f1 - f2) / power_minus_one(r21, order_used),
        safety_factor,
        index_fine: safety_factor * fine(order_used),
        index_medium: safety_factor * medium(order_used),
        relative_index_fine: (f1 != 0.0).then(|| safety_factor * fine(order_used) / f1.abs()),
        asymptotic_ratio: formal_order.map(|p| medium(p) / (powf(r21, p) * fine(p))),
    }
}

#[cfg(test)]
mod tests;
