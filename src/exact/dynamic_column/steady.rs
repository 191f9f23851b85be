//! The states in closed form that the modes depart from.

use super::super::parameters::ColumnParameters;
use super::Start;

/// Fields of the solid and of `ψ = (1 − n) u + n U_w`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Steady {
    pub solid: f64,
    pub mixture: f64,
    pub solid_rate: f64,
    pub mixture_rate: f64,
    pub solid_strain: f64,
    pub pressure: f64,
}

/// State that the modes depart from, at a time in s and a height over the base in m.
pub fn steady(column: &ColumnParameters, start: Start, time: f64, y: f64) -> Steady {
    let modulus = column.oedometric_modulus();
    let strain = -column.load / modulus;
    match start {
        Start::Mode | Start::StandingWave => Steady::default(),
        Start::Ramp { duration } if time <= duration => {
            // Steady growth: every height passes on the water that its base squeezes out.
            let height = column.height;
            let resistance = column.unit_weight_of_water() / column.hydraulic_conductivity;
            let slope = -strain * resistance / duration;
            let pressure = slope * 0.5 * (height - y) * (height + y);
            let impulse = slope * y * (0.5 * height * height - y * y / 6.0);
            let share = time / duration;
            Steady {
                solid: share * strain * y + impulse / modulus,
                mixture: -impulse / column.coupling_modulus(),
                solid_rate: strain * y / duration,
                mixture_rate: 0.0,
                solid_strain: share * strain + pressure / modulus,
                pressure,
            }
        }
        Start::Step | Start::Ramp { .. } => {
            Steady { solid: strain * y, solid_strain: strain, ..Steady::default() }
        }
    }
}
