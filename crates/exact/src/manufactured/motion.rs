//! Prescribed motions of the unit square.
//!
//! The functions of the place alone ([`Spot`]) are evaluated once per point, those of the time alone ([`Moment`]) once per
//! step. The only sines left per point and step are those of an angle that depends on both.

#![expect(clippy::inline_always, reason = "formulas run in registers of four only where they are inlined")]

use crate::manufactured::dual::{Four, Jet, PLACES, Shape};
use crate::parameters::MotionParameters;
use oedometer_soil::elementary;
use oedometer_soil::law::Law;
use oedometer_wording::words;
use std::f64::consts::PI;

/// Most iterations for the inverse of a motion.
const MOST_CORRECTIONS: usize = 50;
/// Correction, m, below which the inverse has converged to round-off: the remaining error is quadratic in it.
const CORRECTION_TOLERANCE: f64 = 1e-7;
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

/// A motion with the law of its soil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ManufacturedModel {
    /// Form of the motion.
    pub motion: Motion,
    /// Stress–strain law.
    pub law: Law,
}

impl ManufacturedModel {
    /// A motion with its default law: log-linear if nothing shears, neo-Hookean otherwise.
    pub const fn with_default_law(motion: Motion) -> Self {
        let law = match motion {
            Motion::Box => Law::LogLinear,
            Motion::Shear | Motion::Vortex => Law::NeoHookean,
        };
        Self { motion, law }
    }

    /// Whether stresses of the law follow from this motion in closed form: a rate of the constant modulus does where
    /// nothing shears or turns.
    pub fn has_law(self) -> bool {
        self.law == Law::NeoHookean || self.law == Law::LogLinear && self.motion == Motion::Box
    }
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
    /// The functions of a point, m.
    #[inline]
    pub fn new(place: [f64; 2]) -> Self {
        let [(sine_x, cosine_x), (sine_y, cosine_y)] = place.map(|along| elementary::sincos(PI * along));
        Self { place, sine: [sine_x, sine_y], cosine: [cosine_x, cosine_y] }
    }
}

/// Four points of the skeleton, as the formulas take them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spots {
    place: [Four; 2],
    sine: [Four; 2],
    cosine: [Four; 2],
}

impl Spots {
    /// Four points side by side.
    #[inline(always)]
    pub fn new(spots: &[Spot; PLACES]) -> Self {
        let lanes = |vector: fn(&Spot) -> [f64; 2], d: usize| {
            Four([vector(&spots[0])[d], vector(&spots[1])[d], vector(&spots[2])[d], vector(&spots[3])[d]])
        };
        let axes = |vector: fn(&Spot) -> [f64; 2]| [lanes(vector, 0), lanes(vector, 1)];
        Self {
            place: axes(|spot| spot.place),
            sine: axes(|spot| spot.sine),
            cosine: axes(|spot| spot.cosine),
        }
    }

    /// `sin(πX)` or `sin(πY)`, with two derivatives.
    #[inline(always)]
    fn sine(&self, d: usize) -> [Four; 3] {
        [self.sine[d], self.cosine[d] * PI, self.sine[d] * -(PI * PI)]
    }

    /// `cos(πX)` or `cos(πY)`, with two derivatives.
    #[inline(always)]
    fn cosine(&self, d: usize) -> [Four; 3] {
        [self.cosine[d], self.sine[d] * -PI, self.cosine[d] * -(PI * PI)]
    }

    /// `cos(πX) cos(πY)`: how the pressure varies over the square.
    #[inline(always)]
    pub fn pressure_shape(&self) -> Shape {
        Shape::product(self.cosine(0), self.cosine(1))
    }
}

/// The functions of the time alone, each as value and two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// `sin²(ωt)`: how much of the motion is there.
    pub growth: [f64; 3],
    /// `sin(2ωt)`: how much of the pressure is there.
    pub beat: [f64; 3],
}

impl Moment {
    /// The functions of a time, s, at a frequency, rad/s.
    pub fn new(frequency: f64, time: f64) -> Self {
        let (sine, _) = elementary::sincos(frequency * time);
        let double = 2.0 * frequency;
        let (beat, cosine) = elementary::sincos(double * time);
        Self {
            growth: [sine * sine, frequency * beat, double * frequency * cosine],
            beat: [beat, double * cosine, -double * double * beat],
        }
    }
}

/// Product of a factor with a value and its two derivatives.
#[inline]
fn times(factor: f64, function: [f64; 3]) -> [f64; 3] {
    function.map(|value| factor * value)
}

// Names of its scene and of its exact solution.
words!(Motion: Box "manufactured-box", Shear "manufactured-shear", Vortex "manufactured-vortex");

impl Motion {
    /// Place of a point of the skeleton at a time, m, with all its derivatives; `g = sin²(ωt)`.
    #[inline(always)]
    pub fn place(self, parameters: &MotionParameters, spots: &Spots, moment: &Moment) -> [Jet; 2] {
        /// A function that does not vary.
        const ONE: [Four; 3] = [Four([1.0; PLACES]), Four([0.0; PLACES]), Four([0.0; PLACES])];
        let [x, y] = spots.place;
        let [along, up] = match self {
            Self::Box => [Shape::product(spots.sine(0), ONE), Shape::product(ONE, spots.sine(1))],
            Self::Shear => [
                Shape::product(spots.sine(0), spots.cosine(1)),
                Shape::product(spots.cosine(0), spots.sine(1)),
            ],
            Self::Vortex => return turned(parameters.amplitude, spots, moment),
        };
        let grown = |amplitude: f64, shape: &Shape| Jet::growing(shape, times(amplitude / PI, moment.growth));
        [
            grown(parameters.amplitude_x, &along) + Jet::coordinate(0, x),
            grown(parameters.amplitude_y, &up) + Jet::coordinate(1, y),
        ]
    }

    /// The points `X` of the skeleton that are at four places at a time, m, by Newton's iteration from guesses; NaN if no
    /// point is at the place.
    #[inline(always)]
    pub fn material_places(
        self,
        parameters: &MotionParameters,
        places: &[[f64; 2]; PLACES],
        moment: &Moment,
        guesses: &[[f64; 2]; PLACES],
    ) -> [[f64; 2]; PLACES] {
        let (mut at, mut points) = (*guesses, [[f64::NAN; 2]; PLACES]);
        let mut has_converged = [false; PLACES];
        for _ in 0..MOST_CORRECTIONS {
            let [x, y] = self.place(parameters, &Spots::new(&at.map(Spot::new)), moment);
            let off = |d: usize, jet: &Jet| {
                Four([places[0][d], places[1][d], places[2][d], places[3][d]]) - jet.value
            };
            let [off_x, off_y] = [off(0, &x), off(1, &y)];
            let ([xx, xy, _], [yx, yy, _]) = (x.slope, y.slope);
            let determinant = xx * yy - xy * yx;
            let correction_x = (yy * off_x - xy * off_y).over(determinant);
            let correction_y = (xx * off_y - yx * off_x).over(determinant);
            for place in 0..PLACES {
                let correction = [correction_x.0[place], correction_y.0[place]];
                at[place] = [at[place][0] + correction[0], at[place][1] + correction[1]];
                if !has_converged[place] && correction[0].abs() + correction[1].abs() < CORRECTION_TOLERANCE {
                    (points[place], has_converged[place]) = (at[place], true);
                }
            }
            if has_converged == [true; PLACES] {
                break;
            }
        }
        points
    }

    /// Largest displacement of a point, m: the scale of displacements.
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

/// Places of points of the disc that turns by `A g (1 − 4r²)⁴`; outside it nothing moves.
#[inline(always)]
fn turned(amplitude: f64, spots: &Spots, moment: &Moment) -> [Jet; 2] {
    let [dx, dy] = [spots.place[0] + -MIDDLE, spots.place[1] + -MIDDLE];
    let share = (dx * dx + dy * dy) * -4.0 + 1.0;
    // S = s⁴, s = 1 − 4 r²
    let square = share * share;
    let (first, second) = (square * 4.0 * share, square * 12.0);
    let [by_x, by_y] = [dx * -8.0, dy * -8.0];
    let mixed = second * by_x * by_y;
    let shape = Shape {
        value: square * square,
        slope: [first * by_x, first * by_y],
        bend: [second * by_x * by_x - first * 8.0, mixed, second * by_y * by_y - first * 8.0],
    };
    let [sine, cosine] = Jet::growing(&shape, times(amplitude, moment.growth)).sincos();
    let turned_x = cosine.times_coordinate(0, dx) - sine.times_coordinate(1, dy);
    let turned_y = sine.times_coordinate(0, dx) + cosine.times_coordinate(1, dy);
    let still = |d: usize| Jet::coordinate(d, spots.place[d]);
    [
        Jet::where_positive(share, turned_x + MIDDLE, still(0)),
        Jet::where_positive(share, turned_y + MIDDLE, still(1)),
    ]
}
