//! One mode of the column: a damped oscillator of two degrees of freedom.

use core::f64::consts::TAU;

use nalgebra::Complex;

use oedometer_soil::elementary;
use oedometer_soil::elementary::modulus;

use crate::dynamic_column::quartic;
use crate::parameters::ColumnParameters;

/// Roots closer than this, relative to their size, are treated as one cluster.
const CLUSTER: f64 = 0.05;
/// Roots up to this many times the smallest count as the slowest: a conjugate pair is one.
const SLOWEST: f64 = 1.01;
/// Relative error of a root times the time: of the root itself, of the moduli and masses in it, and of the time in seconds.
const PHASE_ROUND_OFF: f64 = 8.0 * f64::EPSILON;
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
    /// The part of the envelope due to all roots but the slowest, Pa.
    pub rest: f64,
    /// Bound on the effect of round-off in the frequencies and the time, Pa.
    pub phase_error: f64,
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
    /// Free motion.
    Release(InitialState),
}

/// Response of a root, `exp(s t)` under a sudden load, when the load grows over a time.
///
/// The response to a load that grows is the mean of those to steps (Duhamel), and all means are
/// written so that nothing cancels, however short the time or slow the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Growth {
    /// The whole load at once: `exp(s t)`.
    None,
    /// While the load grows over `duration` in s, from the start: `(exp(s t) − 1)/(s T)`.
    FromStart {
        /// `T`, s.
        duration: f64,
    },
    /// While the load grows, as the departure from steady growth once the slowest root has died: `exp(s t)/(s T)`.
    ToSteady {
        /// `T`, s.
        duration: f64,
    },
    /// After it has grown, with the time since: `exp(s t) (exp(s T) − 1)/(s T)`.
    Over {
        /// `T`, s.
        duration: f64,
    },
}

impl Growth {
    /// The factor of a root's response and its rate.
    fn factor(self, s: Complex<f64>, time: f64) -> [Complex<f64>; 2] {
        let response = elementary::exp_complex(s * time);
        match self {
            Self::None => [response, s * response],
            Self::FromStart { duration } => {
                [elementary::exp_m1_complex(s * time) / (s * duration), response / duration]
            }
            Self::ToSteady { duration } => [response / (s * duration), response / duration],
            Self::Over { duration } => {
                let grown = response * elementary::exp_m1_complex(s * duration) / duration;
                [grown / s, grown]
            }
        }
    }
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
        let porosity = column.soil.porosity;
        let solid_mass = (1.0 - porosity) * column.soil.grain_density;
        let water_mass = porosity * column.soil.water_density;
        let drag =
            porosity * porosity * column.soil.unit_weight_of_water() / column.soil.hydraulic_conductivity;
        let (modulus, coupling) = (column.soil.oedometric_modulus(), column.soil.coupling_modulus());
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
                    (s * s * (solid * ((1.0 - n) * self.water_mass) + water * (n * self.solid_mass))
                        + s * d * momentum
                        + water * (n * skeleton))
                        / mass,
                ]
            }
        }
    }

    /// Coefficients of the mode at time `t` in s.
    pub fn amplitude(&self, drive: Drive, growth: Growth, time: f64) -> Amplitude {
        let mut amplitude = Amplitude::default();
        let cluster = self.cluster();
        for k in 0..4 {
            if cluster.is_some_and(|(a, b)| k == a || k == b) {
                continue;
            }
            let s = self.roots[k];
            let others: Complex<f64> =
                (0..4).filter(|&other| other != k).map(|other| s - self.roots[other]).product();
            let before = amplitude.envelope;
            self.add(&mut amplitude, drive, growth.factor(s, time), s, others.inv());
            amplitude.phase_error += (amplitude.envelope - before) * PHASE_ROUND_OFF * modulus(s) * time;
        }
        if let Some((a, b)) = cluster {
            self.add_cluster(&mut amplitude, drive, growth, time, (a, b));
        }
        amplitude
    }

    /// Adds `weight · N(s) · factor` and its rate.
    fn add(
        &self,
        amplitude: &mut Amplitude,
        drive: Drive,
        [factor, rate]: [Complex<f64>; 2],
        s: Complex<f64>,
        weight: Complex<f64>,
    ) {
        let residues = self.numerators(s, drive).map(|numerator| numerator * weight);
        let [solid, mixture] = residues.map(|residue| residue * factor);
        amplitude.solid += solid.re;
        amplitude.mixture += mixture.re;
        amplitude.solid_rate += (residues[0] * rate).re;
        amplitude.mixture_rate += (residues[1] * rate).re;
        let size = self.size(modulus(solid), modulus(mixture));
        amplitude.envelope += size;
        if modulus(s) > SLOWEST * self.slowest() {
            amplitude.rest += size;
        }
    }

    /// Magnitude of the slowest root, 1/s.
    pub fn slowest(&self) -> f64 {
        self.roots.iter().map(|root| modulus(*root)).fold(f64::INFINITY, f64::min)
    }

    /// Bound on the pressure and stress of coefficients, Pa.
    pub fn size(&self, solid: f64, mixture: f64) -> f64 {
        self.wave_number * (self.coupling * mixture.abs()).max(self.modulus * solid.abs())
    }

    /// The pair of roots that lie too close together for their residues to be told apart.
    fn cluster(&self) -> Option<(usize, usize)> {
        let distance = |a: usize, b: usize| {
            modulus(self.roots[a] - self.roots[b]) / modulus(self.roots[a]).max(modulus(self.roots[b]))
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
    fn add_cluster(
        &self,
        amplitude: &mut Amplitude,
        drive: Drive,
        growth: Growth,
        time: f64,
        (a, b): (usize, usize),
    ) {
        let centre = (self.roots[a] + self.roots[b]) * 0.5;
        let nearest = (0..4)
            .filter(|&other| other != a && other != b)
            .map(|other| modulus(self.roots[other] - centre))
            .fold(modulus(centre), f64::min);
        // Far from the pair inside and from the other roots and the pole at 0 outside.
        let inner = 0.5 * modulus(self.roots[a] - self.roots[b]);
        let radius = (inner * nearest).sqrt().max(0.15 * nearest);
        for point in 0..CONTOUR_POINTS {
            let angle = TAU * (point as f64 + 0.5) / CONTOUR_POINTS as f64;
            let arm = elementary::polar(radius, angle);
            let s = centre + arm;
            let (value, _) = quartic::evaluate(&self.characteristic, s);
            self.add(amplitude, drive, growth.factor(s, time), s, arm / value / CONTOUR_POINTS as f64);
        }
    }
}

/// Modal coefficients of the departure at one time.
#[derive(Clone, Debug)]
pub struct ModeState {
    pub time_factor: f64,
    pub amplitudes: Vec<Amplitude>,
    /// Bound on the omitted modes' pressure and stress, Pa.
    pub tail: f64,
}

#[cfg(test)]
mod tests;
