//! The sums in Mandel's fields.

use crate::porous_soil::PorousSoil;
use oedometer_soil::elementary;

/// Dimensionless groups of the problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groups {
    /// Poisson's ratio `ν`, drained.
    pub poissons_ratio: f64,
    /// `κ = (ν_u − ν)/(1 − ν)`: between 0, where the skeleton keeps its volume or the water carries
    /// nothing, and 3/4.
    pub kappa: f64,
    /// Pressure at once over the mean stress, `B (1 + ν_u)/3`.
    pub start: f64,
    /// `B_1 = 1/(E_oed S) = c/c_v`.
    pub storage_ratio: f64,
}

/// Dimensionless fields.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MandelRatios {
    /// `p a/F`.
    pub pressure: f64,
    /// `−σ_yy a/F`, of the total stress across the plates.
    pub stress: f64,
    /// `u_x G/F`, towards the drained sides.
    pub displacement: f64,
    /// `−ε_yy G a/F`, uniform: the approach of the plates.
    pub strain: f64,
}

/// Sums over the roots at one time and place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// `Σ sin α cos α/d e^{−α²T}`.
    pub mean: f64,
    /// `Σ sin α/d cos(α x) e^{−α²T}`.
    pub wave: f64,
    /// `Σ cos α/d sin(α x) e^{−α²T}`.
    pub slope: f64,
}

impl Groups {
    /// Written so that nothing cancels, with `1/M` for the water's and the grains' storage and
    /// `d = 3(K/M + α²) + G/M`, which is `(3K_u + G)/M`:
    ///
    /// ```text
    /// κ = 9Gα²/((3K + 4G) d)     B (1 + ν_u)/3 = 3α/(2d)     B_1 = 1/(E_oed S)
    /// ```
    pub fn new(soil: &PorousSoil, poissons_ratio: f64) -> Self {
        let PorousSoil { bulk, shear, alpha, fixed_storage, .. } = *soil;
        let squared = alpha * alpha;
        let undrained = 3.0 * (bulk * fixed_storage + squared) + shear * fixed_storage;
        Self {
            poissons_ratio,
            kappa: 9.0 * shear * squared / ((3.0 * bulk + 4.0 * shear) * undrained),
            start: 1.5 * alpha / undrained,
            storage_ratio: soil.diffusivity_ratio(),
        }
    }

    /// `1 − ν_u` over `1 − ν`.
    pub fn undrained_share(&self) -> f64 {
        1.0 - self.kappa
    }
}

impl MandelRatios {
    /// The ratios from the sums over the roots, docs/theory.md, Eq. 16.
    pub fn from_sums(groups: &Groups, distance: f64, sums: Sums) -> Self {
        let Groups { poissons_ratio: nu, kappa, start, .. } = *groups;
        let undrained = nu + kappa * (1.0 - nu);
        Self {
            pressure: 2.0 * start * (sums.wave - sums.mean),
            stress: 1.0 + 2.0 * kappa * sums.wave - 2.0 * sums.mean,
            displacement: (0.5 * nu - undrained * sums.mean) * distance + sums.slope,
            strain: (1.0 - nu) * (0.5 - groups.undrained_share() * sums.mean),
        }
    }
}

pub mod early {
    //! Mandel's slab at short times, in closed form.
    //!
    //! In the Laplace domain, `r = √s`, the strain of the plates is `1/(r (r − κ tanh r))` of its undrained
    //! value and the pressure follows it through `1 − cosh(r x)/cosh r`. As long as neither side feels the
    //! other, `tanh r = 1`, and what is left is the transform of `e^{κ²T} erfc` (Abramowitz & Stegun 29.3.90):
    //! no series that creeps, however short the time.

    use super::{Groups, MandelRatios, elementary};

    /// Inverse of `e^{−k r}/(r (r − κ))`: `e^{κ²T − κk} erfc(k/(2√T) − κ√T)`.
    fn felt_from(kappa: f64, time: f64, way: f64) -> f64 {
        if time == 0.0 {
            return if way > 0.0 { 0.0 } else { 1.0 };
        }
        let root = time.sqrt();
        elementary::exp(kappa * (kappa * time - way)) * elementary::erfc(0.5 * way / root - kappa * root)
    }

    /// Inverse of `e^{−k r}/r²`, without the plates.
    fn diffused(time: f64, way: f64) -> f64 {
        if time == 0.0 {
            return if way > 0.0 { 0.0 } else { 1.0 };
        }
        elementary::erfc(0.5 * way / time.sqrt())
    }

    /// The ratios at `T = c t/a²`; at 0 the undrained start, in which the drained side has its pressure yet.
    pub fn ratios(groups: &Groups, time: f64, distance: f64) -> MandelRatios {
        let Groups { poissons_ratio: nu, kappa, start, .. } = *groups;
        let plates = felt_from(kappa, time, 0.0);
        let strain = 0.5 * (1.0 - nu) * groups.undrained_share() * plates;
        let (near, far) = (1.0 - distance, 1.0 + distance);
        let is_start = time == 0.0;
        let (from_near, from_far) =
            if is_start { (0.0, 0.0) } else { (felt_from(kappa, time, near), felt_from(kappa, time, far)) };
        let drained = if is_start { 0.0 } else { from_near + from_far };
        // ∫ of what has drained, from the middle outward, times κ.
        let drained_within =
            if is_start { 0.0 } else { from_near - diffused(time, near) - (from_far - diffused(time, far)) };
        MandelRatios {
            pressure: start * (plates - drained),
            stress: plates - kappa * drained,
            displacement: 0.5 * (kappa * plates * distance - drained_within)
                + nu / (1.0 - nu) * strain * distance,
            strain,
        }
    }

    /// Bound on what any of the ratios loses for `tanh r = 1`.
    ///
    /// With `q = e^{−2r}` all that is left out is a sum of terms `± c e^{−kr}/r^m`, `m ≥ 2`, whose inverses
    /// with every sign positive only grow; and `f(T) ≤ s e^{sT} F(s)` for what grows, at `s = 1/T²`.
    pub fn bound(groups: &Groups, time: f64) -> f64 {
        if time == 0.0 {
            return 0.0;
        }
        let (kappa, r) = (groups.kappa, 1.0 / time);
        // e^{sT} q = e^{1/T − 2/T}; q itself underflows beside the rest.
        let left = elementary::exp(-r);
        let echo = 2.0 * kappa / (-elementary::exp_m1(-2.0 * r));
        let shifted = r - kappa;
        let plates = echo / (shifted * (shifted - echo * elementary::exp(-2.0 * r)));
        let drained = 3.0 * plates + 4.0 / shifted;
        4.0 * left * r * (plates + drained)
    }
}

pub mod series {
    //! Mandel's series, over the roots of `tan α/α = 1/κ` (Mandel 1953; Cheng & Detournay 1988, Eqs 41–46).

    use super::{Groups, MandelRatios, Sums, elementary};
    use core::f64::consts::{FRAC_PI_2, PI};

    /// Bound on the sum of the omitted terms.
    const NEGLIGIBLE: f64 = 1e-18;
    /// More terms than the shortest time needs: a dozen are enough from `T = 0.02` on, two thousand at 1e-6.
    const MOST_TERMS: usize = 10_000;
    /// Newton's iterations for a root: it gains twice its digits from each, and begins with one.
    const MOST_ITERATIONS: usize = 60;

    /// `(i + ½)π − α_i` of the root in `(iπ, (i + ½)π)`.
    ///
    /// `δ = atan(κ/((i + ½)π − δ))`, whose right side bends upward: Newton's iteration from 0 rises to the
    /// root and never beyond it, whatever `κ < 1`.
    pub fn gap_below_pole(kappa: f64, index: usize) -> f64 {
        let pole = (index as f64 + 0.5) * PI;
        let mut gap = 0.0;
        for _ in 0..MOST_ITERATIONS {
            let root = pole - gap;
            let excess = gap - elementary::atan(kappa / root);
            let change = -excess / (1.0 - kappa / (root * root + kappa * kappa));
            gap += change;
            if change.abs() <= f64::EPSILON * gap.abs() {
                break;
            }
        }
        gap.clamp(0.0, FRAC_PI_2)
    }

    /// Terms after which the rest is negligible.
    pub fn terms(time: f64) -> usize {
        (1..MOST_TERMS).find(|terms| bound(time, *terms) <= NEGLIGIBLE).unwrap_or(MOST_TERMS)
    }

    /// Bound on what any of the ratios loses without the terms from `terms` on.
    ///
    /// With `α_i ≥ iπ` and `d ≥ α − ½` a term of any sum is at most `e^{−(iπ)²T}/(iπ − ½)`, from one to the
    /// next it falls by `e^{−(2i + 1)π²T}` at least, and a ratio has less than eight of the sums.
    pub fn bound(time: f64, terms: usize) -> f64 {
        let first = terms as f64 * PI;
        let fall = -elementary::exp_m1(-(2.0 * first + PI) * PI * time);
        8.0 * elementary::exp(-first * first * time) / ((first - 0.5) * fall)
    }

    /// The ratios at `T = c t/a²`.
    pub fn ratios(groups: &Groups, time: f64, distance: f64) -> MandelRatios {
        sum(groups, time, distance, terms(time))
    }

    /// The ratios from a number of terms.
    pub fn sum(groups: &Groups, time: f64, distance: f64, terms: usize) -> MandelRatios {
        let mut sums = Sums::default();
        // The small ones first.
        for index in (0..terms).rev() {
            let gap = gap_below_pole(groups.kappa, index);
            let root = (index as f64 + 0.5) * PI - gap;
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            let (sine, cosine) = (sign * elementary::cos(gap), sign * elementary::sin(gap));
            let weight = elementary::exp(-root * root * time) / (root - sine * cosine);
            sums.mean += sine * cosine * weight;
            sums.wave += sine * elementary::cos(root * distance) * weight;
            sums.slope += cosine * elementary::sin(root * distance) * weight;
        }
        let mut ratios = MandelRatios::from_sums(groups, distance, sums);
        if distance == 1.0 {
            // cos(αx) = cos α, to the last digit.
            ratios.pressure = 0.0;
        }
        ratios
    }
}
