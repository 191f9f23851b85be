//! One mode of the column: a damped oscillator of two degrees of freedom.

use core::f64::consts::TAU;

use nalgebra::Complex;

use super::super::parameters::ColumnParameters;
use super::quartic;

/// Roots closer than this, relative to their size, are treated as one cluster.
const CLUSTER: f64 = 0.05;
/// Points of the trapezoidal rule on the contour around a cluster.
const CONTOUR_POINTS: usize = 32;

/// Coefficients of a mode: solid `u`, and `ψ = (1 − n) u + n U_w`, whose gradient is the pressure's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Amplitude {
    /// Of the solid's displacement, m.
    pub solid: f64,
    /// Of `ψ`, m.
    pub mixture: f64,
    /// Of the solid's velocity, m/s.
    pub solid_rate: f64,
    /// Of `ψ̇`, m/s.
    pub mixture_rate: f64,
    /// Bound on the pressure and stress of this mode, Pa.
    pub envelope: f64,
}

/// State from which a mode is let go, without any load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialState {
    /// Displacement of the solid, of the water, m.
    pub displacement: [f64; 2],
    /// Velocity of the solid, of the water, m/s.
    pub velocity: [f64; 2],
}

/// What drives a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Departure from the final state after a step of the modal force, N/m³.
    Step {
        /// Modal force on the solid.
        force: f64,
    },
    /// Departure from the steadily loaded state under a force that grows by `rate`, N/(m³ s).
    Ramp {
        /// Growth of the modal force on the solid.
        rate: f64,
    },
    /// Free motion.
    Release(InitialState),
}

/// `diag(m_s, m_w) z̈ + d [[1, −1], [−1, 1]] ż + K z = f`, per volume of mixture, with
/// `K = m² [[E_oed + Q(1−n)², Qn(1−n)], [Qn(1−n), Qn²]]` and the wave number `m = M_j/H`.
#[derive(Clone, Copy, Debug)]
pub struct Mode {
    wave_number: f64,
    porosity: f64,
    /// `(1 − n) ρ_s` and `n ρ_w`, kg/m³.
    solid_mass: f64,
    water_mass: f64,
    /// `d = n² γ_w/k`, N s/m⁴.
    drag: f64,
    modulus: f64,
    coupling: f64,
    characteristic: [f64; 5],
    roots: [Complex<f64>; 4],
}

impl Mode {
    /// The mode of a wave number, 1/m.
    pub fn new(column: &ColumnParameters, wave_number: f64) -> Self {
        let porosity = column.porosity;
        let solid_mass = (1.0 - porosity) * column.grain_density;
        let water_mass = porosity * column.water_density;
        let drag =
            porosity * porosity * column.unit_weight_of_water() / column.hydraulic_conductivity;
        let (modulus, coupling) = (column.oedometric_modulus(), column.coupling_modulus());
        let squared = wave_number * wave_number;
        let (skeleton, water) = (squared * modulus, squared * coupling);
        let dry = 1.0 - porosity;
        // det(M s² + D s + K), expanded so that nothing cancels.
        let mass = solid_mass * water_mass;
        let characteristic = [
            skeleton * water * porosity * porosity / mass,
            drag * (skeleton + water) / mass,
            porosity * porosity * water / water_mass + (skeleton + dry * dry * water) / solid_mass,
            drag * (1.0 / solid_mass + 1.0 / water_mass),
            1.0,
        ];
        Self {
            wave_number,
            porosity,
            solid_mass,
            water_mass,
            drag,
            modulus,
            coupling,
            characteristic,
            roots: quartic::roots(&characteristic),
        }
    }

    /// Numerators over `det/(m_s m_w)` of the transforms of `u` and `ψ`.
    ///
    /// Written so that the large coupling modulus never cancels: `Q ψ` must keep its digits.
    fn numerators(&self, s: Complex<f64>, drive: Drive) -> [Complex<f64>; 2] {
        let n = self.porosity;
        let (d, squared) = (self.drag, self.wave_number * self.wave_number);
        let mass = self.solid_mass * self.water_mass;
        let loaded = |factor: Complex<f64>| {
            let solid = s * (s * self.water_mass + d) + squared * self.coupling * n * n;
            let mixture = s * (s * ((1.0 - n) * self.water_mass) + d);
            [solid * factor / mass, mixture * factor / mass]
        };
        match drive {
            Drive::Step { force } => loaded(force / s),
            Drive::Ramp { rate } => loaded(rate / (s * s)),
            Drive::Release(start) => {
                let [u, w] = start.displacement;
                let solid = (s * u + start.velocity[0]) * self.solid_mass;
                let water = (s * w + start.velocity[1]) * self.water_mass;
                let momentum = solid + water;
                let (solid, water) = (solid + d * (u - w), water - d * (u - w));
                let [skeleton, coupling] = [squared * self.modulus, squared * self.coupling];
                [
                    (s * s * self.water_mass * solid
                        + s * d * momentum
                        + (solid * n - water * (1.0 - n)) * (coupling * n))
                        / mass,
                    (s * s
                        * (solid * ((1.0 - n) * self.water_mass) + water * (n * self.solid_mass))
                        + s * d * momentum
                        + water * (n * skeleton))
                        / mass,
                ]
            }
        }
    }

    /// Coefficients of the mode at time `t` in s.
    pub fn amplitude(&self, drive: Drive, time: f64) -> Amplitude {
        let mut amplitude = Amplitude::default();
        let cluster = self.cluster();
        for k in 0..4 {
            if cluster.is_some_and(|(a, b)| k == a || k == b) {
                continue;
            }
            let s = self.roots[k];
            let others: Complex<f64> = (0..4)
                .filter(|&other| other != k)
                .map(|other| s - self.roots[other])
                .product();
            self.add(&mut amplitude, drive, time, s, others.inv());
        }
        if let Some((a, b)) = cluster {
            self.add_cluster(&mut amplitude, drive, time, a, b);
        }
        amplitude
    }

    /// Adds `weight · N(s) exp(s t)` and what belongs to it.
    fn add(
        &self,
        amplitude: &mut Amplitude,
        drive: Drive,
        time: f64,
        s: Complex<f64>,
        weight: Complex<f64>,
    ) {
        let factor = weight * (s * time).exp();
        let [solid, mixture] = self
            .numerators(s, drive)
            .map(|numerator| numerator * factor);
        amplitude.solid += solid.re;
        amplitude.mixture += mixture.re;
        amplitude.solid_rate += (solid * s).re;
        amplitude.mixture_rate += (mixture * s).re;
        amplitude.envelope +=
            self.wave_number * (self.coupling * mixture.norm()).max(self.modulus * solid.norm());
    }

    /// The pair of roots that lie too close together for their residues to be told apart.
    fn cluster(&self) -> Option<(usize, usize)> {
        let distance = |a: usize, b: usize| {
            (self.roots[a] - self.roots[b]).norm() / self.roots[a].norm().max(self.roots[b].norm())
        };
        let mut closest = (0, 1);
        for a in 0..4 {
            for b in a + 1..4 {
                if distance(a, b) < distance(closest.0, closest.1) {
                    closest = (a, b);
                }
            }
        }
        (distance(closest.0, closest.1) < CLUSTER).then_some(closest)
    }

    /// Adds the joint residue of two close roots, by Cauchy's integral around both.
    fn add_cluster(&self, amplitude: &mut Amplitude, drive: Drive, time: f64, a: usize, b: usize) {
        let centre = (self.roots[a] + self.roots[b]) * 0.5;
        let nearest = (0..4)
            .filter(|&other| other != a && other != b)
            .map(|other| (self.roots[other] - centre).norm())
            .fold(centre.norm(), f64::min);
        // Far from the pair inside and from the other roots and the pole at 0 outside.
        let inner = 0.5 * (self.roots[a] - self.roots[b]).norm();
        let radius = (inner * nearest).sqrt().max(0.15 * nearest);
        for point in 0..CONTOUR_POINTS {
            let angle = TAU * (point as f64 + 0.5) / CONTOUR_POINTS as f64;
            let arm = Complex::from_polar(radius, angle);
            let s = centre + arm;
            let (value, _) = quartic::evaluate(&self.characteristic, s);
            self.add(
                amplitude,
                drive,
                time,
                s,
                arm / value / CONTOUR_POINTS as f64,
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix4, Vector4};
    use proptest::prelude::*;

    /// `exp(A t) x` of the mode's first-order system, by scaling and squaring.
    fn by_matrix_exponential(mode: &Mode, start: InitialState, time: f64) -> Vector4<f64> {
        let n = mode.porosity;
        let squared = mode.wave_number * mode.wave_number;
        let (ms, mw, d) = (mode.solid_mass, mode.water_mass, mode.drag);
        let kss = squared * (mode.modulus + mode.coupling * (1.0 - n) * (1.0 - n));
        let ksw = squared * mode.coupling * n * (1.0 - n);
        let kww = squared * mode.coupling * n * n;
        #[rustfmt::skip]
        let system = Matrix4::new(
            0.0, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
            -kss / ms, -ksw / ms, -d / ms, d / ms,
            -ksw / mw, -kww / mw, d / mw, -d / mw,
        );
        let [u, w] = start.displacement;
        let [v, vw] = start.velocity;
        (system * time).exp() * Vector4::new(u, w, v, vw)
    }

    proptest! {
        #[test]
        fn free_motion_is_the_matrix_exponential(
            exponent in -3.0..0.0_f64,
            stiffness in 1.0..1e3_f64,
            porosity in 0.1..0.9_f64,
            periods in 0.0..3.0_f64,
            u in -1.0..1.0_f64, w in -1.0..1.0_f64, v in -1.0..1.0_f64, vw in -1.0..1.0_f64,
        ) {
            // Around the passage from over- to underdamped slow waves.
            let column = ColumnParameters {
                porosity,
                water_bulk_modulus: stiffness * 1e6,
                hydraulic_conductivity: 10.0_f64.powf(exponent),
                ..ColumnParameters::default()
            };
            let mode = Mode::new(&column, 1.5);
            let frequency = mode.roots.iter().map(|s| s.im).fold(1.0, f64::max);
            let start = InitialState {
                displacement: [u, w],
                velocity: [v * frequency, vw * frequency],
            };
            let time = periods / frequency;
            let expected = by_matrix_exponential(&mode, start, time);
            let found = mode.amplitude(Drive::Release(start), time);
            let mixture = (1.0 - porosity) * expected[0] + porosity * expected[1];
            prop_assert!((found.solid - expected[0]).abs() < 1e-10);
            prop_assert!((found.mixture - mixture).abs() < 1e-10);
            prop_assert!((found.solid_rate - expected[2]).abs() < 1e-10 * frequency);
        }
    }

    #[test]
    fn confluent_roots_are_no_exception() {
        // Bisect the conductivity onto the double root of the slow waves.
        let mode = |k: f64| {
            let column = ColumnParameters {
                hydraulic_conductivity: k,
                ..ColumnParameters::default()
            };
            Mode::new(&column, 1.5)
        };
        let waves = |k: f64| {
            mode(k)
                .roots
                .iter()
                .filter(|s| s.im > 1e-6 * s.norm())
                .count()
        };
        let (mut over, mut under) = (1e-4, 1.0);
        assert_eq!((waves(over), waves(under)), (1, 2));
        while under / over > 1.0 + 1e-15 {
            let middle = (over * under).sqrt();
            if middle <= over || middle >= under {
                break;
            }
            if waves(middle) == 1 {
                over = middle;
            } else {
                under = middle;
            }
        }
        let start = InitialState {
            displacement: [1.0, -0.5],
            velocity: [10.0, 3.0],
        };
        for k in [over, over * (1.0 + 1e-9), over * 1.001, over * 1.01] {
            let critical = mode(k);
            assert!(k > over * 1.0001 || critical.cluster().is_some());
            for time in [1e-4, 1e-3, 1e-2] {
                let expected = by_matrix_exponential(&critical, start, time);
                let found = critical.amplitude(Drive::Release(start), time);
                assert!((found.solid - expected[0]).abs() < 1e-9, "{k} {time}");
                let mixture = 0.7 * expected[0] + 0.3 * expected[1];
                assert!((found.mixture - mixture).abs() < 1e-9, "{k} {time}");
            }
        }
    }
}
