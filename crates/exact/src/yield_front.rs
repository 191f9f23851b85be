//! A preconsolidated column in which a front of yielding moves in from the drained top.
//!
//! The soil has the oedometric modulus `E₁` where the effective stress is at its largest value so far and beyond the
//! preconsolidation, and `E₂ > E₁` below. Undrained it stays elastic; as water leaves, places yield from the top on.
//! With `S_j = 1/E_j + n/K_w`, `c_j = k/(γ_w S_j)` and depth `z`, for a half-space
//!
//! ```text
//! z < λ√t   p = p_y erf(z/2√(c₁t))/erf(a)                   a = λ/2√c₁
//! z > λ√t   p = p_0 − (p_0 − p_y) erfc(z/2√(c₂t))/erfc(b)   b = λ/2√c₂
//! λ         p_y exp(−a²)/(erf(a)√c₁) = (p_0 − p_y) exp(−b²)/(erfc(b)√c₂)
//! ```
//!
//! Stefan's problem of two phases without latent heat (Neumann; Carslaw & Jaeger 1959, section 11.2), for stress and
//! strain are continuous at the front. It holds for a column as long as the front has not affected the base.

use core::f64::consts::PI;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor, normal, positive};
use crate::inputs::{COLUMN_KEYS, LAW_KEY, WATER_KEYS};
use crate::numerics::bisected;
use crate::parameters::ColumnParameters;
use crate::row::Row;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary::{erf, erfc, exp};

/// The row of the solution.
pub(crate) static YIELD_FRONT: Row = Row {
    name: "yield-front",
    words: "the exact yield front",
    inputs: &[COLUMN_KEYS, WATER_KEYS, LAW_KEY, &["reload_modulus", "preconsolidation", "initial_stress"]],
    ..Row::COLUMN
};

/// Relative difference below which two moduli count as equal.
const EQUAL: f64 = 1e-9;

/// The exact solution of a column of a preconsolidated soil under a load that acts at once. Stresses here are compression
/// positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YieldFront {
    column: ColumnParameters,
    /// Oedometric modulus `E₁` of first loading, Pa.
    virgin: f64,
    /// Oedometric modulus `E₂` of unloading and reloading, Pa.
    reload: f64,
    /// `κ = k/γ_w`, m²/(Pa s).
    mobility: f64,
    /// `√c₁` and `√c₂`, m/√s.
    speeds: [f64; 2],
    /// Pressure `p_0` of the undrained start, Pa.
    start: f64,
    /// Pressure `p_y` at which a place yields, Pa.
    yielding: f64,
    /// `λ`, m/√s.
    front: f64,
}

impl YieldFront {
    /// The front of a column.
    ///
    /// # Errors
    /// When a parameter is impossible, the modulus of reloading below that of first loading, or the stress at the end
    /// not beyond the preconsolidation, so that nothing yields, or the undrained start beyond it already.
    pub fn new(column: &ColumnParameters) -> Result<Self, ExactError> {
        column.validate()?;
        let ColumnParameters { soil, load, uniform_stress, .. } = *column;
        let virgin = soil.oedometric_modulus();
        let reload = normal("oedometric modulus of reloading", soil.reload_modulus)?;
        // Equal moduli may be typed as Young's and Poisson's numbers.
        if reload < virgin * (1.0 - EQUAL) {
            return Err(ExactError::ReloadModulus { reload, virgin });
        }
        if !(uniform_stress.is_finite() && uniform_stress >= 0.0) {
            return Err(ExactError::NotPositive { quantity: "initial stress", value: uniform_stress });
        }
        let preconsolidation = positive("preconsolidation", soil.preconsolidation)?;
        let mobility =
            normal("mobility of the water", soil.hydraulic_conductivity / soil.unit_weight_of_water())?;
        let of_water = soil.porosity / soil.water_bulk_modulus;
        let [storage, elastic_storage] = [1.0 / virgin + of_water, 1.0 / reload + of_water];
        let speeds = [(mobility / storage).sqrt(), (mobility / elastic_storage).sqrt()];
        let start = load / (reload * elastic_storage);
        let end = uniform_stress + load;
        let yielding = end - preconsolidation;
        if yielding <= 0.0 || yielding >= start {
            return Err(ExactError::NoYieldFront { preconsolidation, start: end - start, end });
        }
        // Water arrives at the front faster than it leaves while the front is near the top: the flux that leaves falls
        // from infinity to nothing, the one that arrives rises.
        let missing = |a: f64| {
            let b = a * speeds[0] / speeds[1];
            let leaves = yielding * exp(-a * a) / (erf(a) * speeds[0]);
            (start - yielding) * exp(-b * b) / (erfc(b) * speeds[1]) - leaves
        };
        let front = 2.0 * speeds[0] * bisected(0.0, 26.0, missing);
        Ok(Self { column: *column, virgin, reload, mobility, speeds, start, yielding, front })
    }

    /// Depth of the front, m.
    pub fn front_depth(&self, seconds: f64) -> f64 {
        self.front * seconds.sqrt()
    }

    /// Water that has left through the top, m³ per m².
    pub fn water_out(&self, seconds: f64) -> f64 {
        let a = self.front / (2.0 * self.speeds[0]);
        let root = (seconds / PI).sqrt();
        2.0 * self.mobility * self.yielding * root / (erf(a) * self.speeds[0])
    }

    /// Pressure at a depth in m, Pa.
    fn pressure(&self, seconds: f64, depth: f64) -> f64 {
        if seconds == 0.0 {
            return if depth == 0.0 { 0.0 } else { self.start };
        }
        let [first, second] = self.speeds;
        let root = seconds.sqrt();
        if depth < self.front_depth(seconds) {
            self.yielding * erf(depth / (2.0 * first * root)) / erf(self.front / (2.0 * first))
        } else {
            let reached = erfc(depth / (2.0 * second * root)) / erfc(self.front / (2.0 * second));
            self.start - (self.start - self.yielding) * reached
        }
    }

    /// `∫ (p_0 − p) dz` from a depth to far below, Pa m.
    fn lost_pressure(&self, seconds: f64, depth: f64) -> f64 {
        let [first, second] = self.speeds;
        let root = seconds.sqrt();
        if root == 0.0 {
            return 0.0;
        }
        let front = self.front_depth(seconds);
        // ∫ erfc from x on, and ∫ erf from 0 to x.
        let tail = |x: f64| exp(-x * x) / PI.sqrt() - x * erfc(x);
        let risen = |x: f64| x * erf(x) - (1.0 - exp(-x * x)) / PI.sqrt();
        let below = depth.max(front);
        let (length, scale) = (2.0 * second * root, self.front / (2.0 * second));
        let elastic = (self.start - self.yielding) * length * tail(below / length) / erfc(scale);
        if depth >= front {
            return elastic;
        }
        let (length, scale) = (2.0 * first * root, self.front / (2.0 * first));
        let held = self.yielding * length * (risen(front / length) - risen(depth / length)) / erf(scale);
        elastic + self.start * (front - depth) - held
    }

    /// Shortening of the column below a depth, m, since before the load.
    fn shortening_below(&self, seconds: f64, depth: f64) -> f64 {
        let Self { column, start, yielding, .. } = *self;
        let elastic = (column.load - start) / self.reload * (column.height - depth);
        let base = self.lost_pressure(seconds, column.height);
        let front = self.front_depth(seconds);
        if depth >= front {
            return elastic + (self.lost_pressure(seconds, depth) - base) / self.reload;
        }
        // Above the front the stress rose by p_0 − p_y elastically and by the rest at the virgin modulus.
        let at_front = self.lost_pressure(seconds, front);
        let yielded = self.lost_pressure(seconds, depth) - at_front - (start - yielding) * (front - depth);
        elastic
            + (at_front - base + (start - yielding) * (front - depth)) / self.reload
            + yielded / self.virgin
    }

    /// Pressure, effective stress with the initial one, and displacement since before the load, at the relative depth
    /// `zeta`, `seconds` after the load.
    ///
    /// # Errors
    /// When `seconds` is negative or not finite, or `zeta` outside [0, 1].
    pub fn fields_after(&self, seconds: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let seconds = checked_time_factor(seconds)?;
        let depth = checked_depth(zeta)? * self.column.height;
        let pressure = self.pressure(seconds, depth);
        Ok(FieldValues {
            pressure,
            effective_stress: pressure - self.column.load - self.column.uniform_stress,
            displacement: -self.shortening_below(seconds, depth),
        })
    }

    /// Settlement of the top, downward positive, since before the load, m.
    ///
    /// # Errors
    /// When `seconds` is negative or not finite.
    pub fn settlement_after(&self, seconds: f64) -> Result<f64, ExactError> {
        Ok(self.shortening_below(checked_time_factor(seconds)?, 0.0))
    }

    /// Bound on the effect of the base, which a half-space does not have, on the pressure over the load: twice the
    /// contribution of an image of the elastic part.
    ///
    /// # Errors
    /// When `seconds` is negative or not finite.
    pub fn accuracy_after(&self, seconds: f64) -> Result<Accuracy, ExactError> {
        let seconds = checked_time_factor(seconds)?;
        if seconds == 0.0 {
            return Ok(Accuracy::new(1, 0.0));
        }
        let second = 2.0 * self.speeds[1];
        let reached = erfc(self.column.height / (second * seconds.sqrt())) / erfc(self.front / second);
        let tail = (2.0 * reached * (self.start - self.yielding) / self.column.load).min(1.0);
        // e^{−x²} is known to 2x² times the round-off of x.
        let [a, b] = self.speeds.map(|speed| self.front / (2.0 * speed));
        Ok(Accuracy { phase_bound: 8.0 * f64::EPSILON * (1.0 + a * a + b * b), ..Accuracy::new(1, tail) })
    }
}

impl Solution for YieldFront {
    /// Stresses are counted from that of the start.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let fields = self.fields_after(self.column.time(checked_time_factor(time_factor)?), zeta)?;
        let effective_stress = fields.effective_stress + self.column.uniform_stress;
        Ok(FieldValues { effective_stress, ..fields })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        self.settlement_after(self.column.time(checked_time_factor(time_factor)?))
    }

    /// Settlement of a fully yielded column; the half-space of the solution itself settles without limit.
    fn final_settlement(&self) -> Result<f64, ExactError> {
        let Self { column, yielding, .. } = self;
        let strain = (column.load - yielding) / self.reload + yielding / self.virgin;
        Ok(column.height * strain)
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        self.accuracy_after(self.column.time(checked_time_factor(time_factor)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::material::Material;

    fn column(
        [virgin, reload, conductivity, porosity, initial, preconsolidation]: [f64; 6],
    ) -> ColumnParameters {
        // Without Poisson's ratio the oedometric modulus is Young's.
        let soil = Material {
            youngs_modulus: virgin,
            poissons_ratio: 0.0,
            reload_modulus: reload,
            hydraulic_conductivity: conductivity,
            porosity,
            preconsolidation,
            ..Material::default()
        };
        ColumnParameters { load: 1e5, uniform_stress: initial, soil, ..ColumnParameters::default() }
    }

    #[test]
    fn pressures_fronts_and_flows_match_thirty_digits() {
        let columns = [
            ("stiff-until-yield", column([1.2e6, 1.2e7, 1e-7, 0.5, 2e4, 6e4])),
            ("late-yield", column([1.2e6, 6e6, 1e-8, 0.4, 0.0, 9e4])),
            ("early-yield", column([2e6, 1e7, 1e-8, 0.4, 3e4, 3.1e4])),
        ];
        for (name, column) in columns {
            let solution = YieldFront::new(&column).unwrap();
            let rows: Vec<Vec<&str>> = include_str!("../tests/reference/yield_front.csv")
                .lines()
                .map(|line| line.split(',').collect::<Vec<_>>())
                .filter(|row| row[0] == name)
                .collect();
            assert_eq!(rows.len(), 14);
            for row in rows {
                let [seconds, depth, pressure, front, out] =
                    [1, 2, 3, 4, 5].map(|cell| row[cell].parse::<f64>().unwrap());
                let computed = solution.fields_after(seconds, depth).unwrap().pressure;
                assert!((computed - pressure).abs() < 1e-12 * column.load, "{row:?}: {computed}");
                assert!((solution.front_depth(seconds) / front - 1.0).abs() < 1e-12, "{row:?}");
                assert!((solution.water_out(seconds) / out - 1.0).abs() < 1e-12, "{row:?}");
                assert!(solution.accuracy_after(seconds).unwrap().bound() < 1e-12);
            }
        }
    }

    #[test]
    fn the_settlement_is_the_water_that_left_less_what_the_water_gave_back() {
        let column = column([1.2e6, 6e6, 1e-8, 0.4, 2e4, 6e4]);
        let solution = YieldFront::new(&column).unwrap();
        let undrained = solution.settlement_after(0.0).unwrap();
        for seconds in [1.0, 30.0, 400.0] {
            let lost = solution.lost_pressure(seconds, 0.0) - solution.lost_pressure(seconds, 1.0);
            let expected =
                solution.water_out(seconds) - column.soil.porosity / column.soil.water_bulk_modulus * lost;
            let computed = solution.settlement_after(seconds).unwrap() - undrained;
            assert!((computed / expected - 1.0).abs() < 1e-11, "{seconds}: {computed:e} {expected:e}");
            // The displacement's slope is the strain of the stress at the place.
            for depth in [0.3 * solution.front_depth(seconds), 2.0 * solution.front_depth(seconds)] {
                let step = 1e-6;
                let at = |depth: f64| solution.fields_after(seconds, depth).unwrap().displacement;
                let strain = (at(depth + step) - at(depth - step)) / (2.0 * step);
                let stress = column.load - solution.pressure(seconds, depth);
                let in_all = solution.fields_after(seconds, depth).unwrap().effective_stress;
                assert!((in_all + stress + column.uniform_stress).abs() < 1e-9 * column.load, "{in_all:e}");
                let elastic = stress.min(column.soil.preconsolidation - column.uniform_stress);
                let expected = elastic / 6e6 + (stress - elastic) / 1.2e6;
                assert!((strain / expected - 1.0).abs() < 1e-6, "{seconds} {depth}: {strain:e} {expected:e}");
            }
        }
    }

    #[test]
    fn equal_moduli_are_terzaghis_half_space() {
        let column = column([2e6, 2e6, 1e-8, 0.4, 3e4, 8e4]);
        let solution = YieldFront::new(&column).unwrap();
        let seconds: f64 = 120.0;
        let speed = solution.speeds[0];
        for depth in [0.0, 0.01, 0.05, 0.2] {
            let expected = solution.start * erf(depth / (2.0 * speed * seconds.sqrt()));
            let computed = solution.fields_after(seconds, depth).unwrap().pressure;
            assert!((computed - expected).abs() < 1e-12 * column.load);
        }
    }

    #[test]
    fn columns_without_a_front_are_refused_in_sentences() {
        let refused = |values| YieldFront::new(&column(values)).unwrap_err().to_string();
        assert!(refused([2e6, 1e6, 1e-8, 0.4, 3e4, 8e4]).contains("below the modulus of first loading"));
        // Never reached, and reached by the undrained start.
        assert!(refused([2e6, 4e6, 1e-8, 0.4, 3e4, 1.4e5]).contains("yield"));
        assert!(refused([2e6, 4e6, 1e-8, 0.4, 3e4, 3.0e4]).contains("yield"));
        // The front has reached the base long ago.
        let solution = YieldFront::new(&column([2e6, 4e6, 1e-6, 0.4, 3e4, 8e4])).unwrap();
        assert!(solution.accuracy_after(1e4).unwrap().bound() > 0.1);
    }

    #[test]
    fn long_after_the_stress_up_to_the_preconsolidation_was_elastic_and_the_rest_virgin() {
        let mut column = column([1.2e6, 6e6, 1e-8, 0.4, 2e4, 6e4]);
        column.height = 3.0;
        // From 20 to 60 kPa with 6 MPa, to 120 kPa with 1.2 MPa.
        let strain = 4e4 / 6e6 + 6e4 / 1.2e6;
        let computed = YieldFront::new(&column).unwrap().final_settlement().unwrap();
        assert!((computed / (3.0 * strain) - 1.0).abs() < 1e-14, "{computed}");
    }
}
