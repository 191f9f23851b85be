//! Motions of the unit square that are written down: where a point of the skeleton is, and which.
//!
//! What the formulas take of a place ([`Spot`]) and of a time ([`Moment`]) is made once for a point and once a step:
//! no sine is left where points and times meet, but those of an angle that is of both.

use crate::elementary;
use crate::exact::manufactured::jet::{Jet, Shape};
use crate::exact::parameters::MotionParameters;
use std::f64::consts::PI;

/// Corrections after which a place is found or never is.
const MOST_CORRECTIONS: usize = 50;
/// Correction, m, after which a place is found to round-off: what it leaves is of its square.
const FOUND: f64 = 1e-9;
/// Middle of the square, m.
const MIDDLE: f64 = 0.5;

/// A motion of the unit square by its form. All four walls stay where they are and are free of shear: every
/// boundary condition of rollers is met by the motion itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Motion {
    /// Stretch along the axes: `x = X + A g sin(πX)/π`, `y = Y + B g sin(πY)/π`.
    Box,
    /// With shear inside: `x = X + A g sin(πX) cos(πY)/π`, `y = Y + B g cos(πX) sin(πY)/π`.
    Shear,
    /// A disc that turns, the more the nearer its middle: by `α = A g (1 − 4r²)⁴`, `r < 1/2`. Volumes stay.
    Vortex,
}

/// A point `X` of the skeleton, m, with the sines and cosines of `πX` and `πY`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The point, m.
    pub place: [f64; 2],
    sine: [f64; 2],
    cosine: [f64; 2],
}

impl Spot {
    /// Of a point, m.
    #[inline]
    pub fn of(place: [f64; 2]) -> Self {
        let [(sine_x, cosine_x), (sine_y, cosine_y)] = place.map(|along| elementary::sincos(PI * along));
        Self { place, sine: [sine_x, sine_y], cosine: [cosine_x, cosine_y] }
    }

    /// `sin(πX)` or `sin(πY)`, with two derivatives.
    #[inline]
    fn sine(&self, d: usize) -> [f64; 3] {
        [self.sine[d], PI * self.cosine[d], -(PI * PI) * self.sine[d]]
    }

    /// `cos(πX)` or `cos(πY)`, with two derivatives.
    #[inline]
    fn cosine(&self, d: usize) -> [f64; 3] {
        [self.cosine[d], -PI * self.sine[d], -(PI * PI) * self.cosine[d]]
    }

    /// `cos(πX) cos(πY)`: how the pressure varies over the square.
    #[inline]
    pub fn pressure_shape(&self) -> Shape {
        Shape::product(self.cosine(0), self.cosine(1))
    }
}

/// A time with what the formulas take of it, each as value and two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// `sin²(ωt)`: how much of the motion is there.
    pub growth: [f64; 3],
    /// `sin(2ωt)`: how much of the pressure is there.
    pub beat: [f64; 3],
}

impl Moment {
    /// Of a time, s, at a frequency, rad/s.
    pub fn of(frequency: f64, time: f64) -> Self {
        let (sine, _) = elementary::sincos(frequency * time);
        let double = 2.0 * frequency;
        let (beat, cosine) = elementary::sincos(double * time);
        Self {
            growth: [sine * sine, frequency * beat, double * frequency * cosine],
            beat: [beat, double * cosine, -double * double * beat],
        }
    }
}

/// A factor of all three.
#[inline]
fn times(factor: f64, function: [f64; 3]) -> [f64; 3] {
    function.map(|value| factor * value)
}

impl Motion {
    /// Every motion.
    pub const ALL: [Self; 3] = [Self::Box, Self::Shear, Self::Vortex];

    /// Name of its scene and of its exact solution.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Box => "manufactured-box",
            Self::Shear => "manufactured-shear",
            Self::Vortex => "manufactured-vortex",
        }
    }

    /// Place of a point of the skeleton at a time, m, with all its derivatives; `g = sin²(ωt)`.
    #[inline]
    pub fn place(self, parameters: &MotionParameters, spot: &Spot, moment: &Moment) -> [Jet; 2] {
        /// A function that does not vary.
        const ONE: [f64; 3] = [1.0, 0.0, 0.0];
        let [x, y] = spot.place;
        let [along, up] = match self {
            Self::Box => [Shape::product(spot.sine(0), ONE), Shape::product(ONE, spot.sine(1))],
            Self::Shear => {
                [Shape::product(spot.sine(0), spot.cosine(1)), Shape::product(spot.cosine(0), spot.sine(1))]
            }
            Self::Vortex => return turned(parameters.amplitude, spot, moment),
        };
        let grown = |amplitude: f64, shape: &Shape| Jet::growing(shape, times(amplitude / PI, moment.growth));
        [
            grown(parameters.amplitude_x, &along).from_place(0, x),
            grown(parameters.amplitude_y, &up).from_place(1, y),
        ]
    }

    /// The point `X` of the skeleton that is at a place at a time, m, looked for from a guess by Newton's iteration;
    /// not a number where the place is no point's.
    pub fn material_place(
        self,
        parameters: &MotionParameters,
        place: [f64; 2],
        moment: &Moment,
        guess: [f64; 2],
    ) -> [f64; 2] {
        let mut found = guess;
        for _ in 0..MOST_CORRECTIONS {
            let [x, y] = self.place(parameters, &Spot::of(found), moment);
            let [off_x, off_y] = [place[0] - x.value, place[1] - y.value];
            let determinant = x.slope[0] * y.slope[1] - x.slope[1] * y.slope[0];
            let correction = [
                (y.slope[1] * off_x - x.slope[1] * off_y) / determinant,
                (x.slope[0] * off_y - y.slope[0] * off_x) / determinant,
            ];
            found = [found[0] + correction[0], found[1] + correction[1]];
            if correction[0].abs() + correction[1].abs() < FOUND {
                return found;
            }
        }
        [f64::NAN; 2]
    }

    /// Largest displacement of a point, m: what displacements are measured by.
    pub fn largest_displacement(self, parameters: &MotionParameters) -> f64 {
        match self {
            Self::Box | Self::Shear => parameters.amplitude_x.abs().max(parameters.amplitude_y.abs()) / PI,
            // Of the chord 2 r sin(α/2), on a fine row of radii.
            Self::Vortex => (1..500)
                .map(|i| {
                    let radius = 1e-3 * f64::from(i);
                    let share = 1.0 - 4.0 * radius * radius;
                    let angle = parameters.amplitude * share * share * share * share;
                    2.0 * radius * elementary::sin(0.5 * angle).abs()
                })
                .fold(0.0, f64::max),
        }
    }
}

/// Place of a point of the disc that turns by `A g (1 − 4r²)⁴`; outside it nothing moves.
#[inline]
fn turned(amplitude: f64, spot: &Spot, moment: &Moment) -> [Jet; 2] {
    let [dx, dy] = spot.place.map(|along| along - MIDDLE);
    let [x, y] = [Jet::coordinate(0, spot.place[0]), Jet::coordinate(1, spot.place[1])];
    let share = 1.0 - 4.0 * (dx * dx + dy * dy);
    if share <= 0.0 {
        return [x, y];
    }
    // S = s⁴, s = 1 − 4 r²
    let square = share * share;
    let (first, second) = (4.0 * square * share, 12.0 * square);
    let [by_x, by_y] = [-8.0 * dx, -8.0 * dy];
    let mixed = second * by_x * by_y;
    let shape = Shape {
        value: square * square,
        slope: [first * by_x, first * by_y],
        bend: [[second * by_x * by_x - 8.0 * first, mixed], [mixed, second * by_y * by_y - 8.0 * first]],
    };
    let [sine, cosine] = Jet::growing(&shape, times(amplitude, moment.growth)).sine_and_cosine();
    let [x, y] = [x + -MIDDLE, y + -MIDDLE];
    [cosine * x - sine * y + MIDDLE, sine * x + cosine * y + MIDDLE]
}
