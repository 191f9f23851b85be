//! Motions of the unit square that are written down: where a point of the skeleton is, and which.

use crate::exact::manufactured::jet::{Jet, TIME};
use crate::exact::parameters::MotionParameters;
use std::f64::consts::PI;

/// Corrections after which a place is found or never is.
const MOST_CORRECTIONS: usize = 50;
/// Distance, m, at which a place is found.
const FOUND: f64 = 1e-14;
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

    /// Place of the point `X` of the skeleton at a time, m, with all its derivatives; `g = sin²(ωt)`.
    pub fn place(self, parameters: &MotionParameters, [x, y]: [f64; 2], time: f64) -> [Jet; 2] {
        let (x, y) = (Jet::coordinate(0, x), Jet::coordinate(1, y));
        let growth = (Jet::coordinate(TIME, time) * parameters.frequency).sin().squared();
        let [along, up] = [parameters.amplitude_x, parameters.amplitude_y].map(|a| growth * (a / PI));
        match self {
            Self::Box => [x + along * (x * PI).sin(), y + up * (y * PI).sin()],
            Self::Shear => {
                [x + along * (x * PI).sin() * (y * PI).cos(), y + up * (x * PI).cos() * (y * PI).sin()]
            }
            Self::Vortex => {
                let [dx, dy] = [x + -MIDDLE, y + -MIDDLE];
                let share = (dx.squared() + dy.squared()) * -4.0 + 1.0;
                if share.value <= 0.0 {
                    return [x, y];
                }
                let angle = growth * parameters.amplitude * share.squared().squared();
                let (sine, cosine) = (angle.sin(), angle.cos());
                [cosine * dx - sine * dy + MIDDLE, sine * dx + cosine * dy + MIDDLE]
            }
        }
    }

    /// The point `X` of the skeleton that is at a place at a time, m, looked for from a guess by Newton's iteration;
    /// not a number where the place is no point's.
    pub fn material_place(
        self,
        parameters: &MotionParameters,
        place: [f64; 2],
        time: f64,
        guess: [f64; 2],
    ) -> [f64; 2] {
        let mut found = guess;
        for _ in 0..MOST_CORRECTIONS {
            let [x, y] = self.place(parameters, found, time);
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
                    2.0 * radius * crate::elementary::sin(0.5 * angle).abs()
                })
                .fold(0.0, f64::max),
        }
    }
}
