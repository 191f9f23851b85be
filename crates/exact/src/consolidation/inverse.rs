//! The time factor at which a degree of consolidation is reached.

use core::f64::consts::PI;

use crate::consolidation::{SWITCH, images, sine_series};
use crate::exact_error::ExactError;
use oedometer_soil::elementary;

/// Newton's iteration converges quadratically from both starts; this is far more than it takes.
const MOST_STEPS: usize = 60;

/// Time factor `T` with `U(T) = degree`, to about `1e-14` relative.
///
/// Early consolidation starts from `T = π U²/4`, late consolidation from the first mode,
/// `1 − U = (8/π²) exp(−π² T/4)` (Terzaghi 1943).
///
/// # Errors
/// When `degree` is outside [0, 1).
pub fn time_factor_for_degree(degree: f64) -> Result<f64, ExactError> {
    if !(0.0..1.0).contains(&degree) {
        return Err(ExactError::Degree(degree));
    }
    if degree == 0.0 {
        return Ok(0.0);
    }
    if degree < images::consolidated_below(0.0, SWITCH).value {
        Ok(early(degree))
    } else {
        Ok(late(1.0 - degree))
    }
}

/// Newton in `√T`, in which `U` is nearly linear.
fn early(degree: f64) -> f64 {
    let mut root = 0.5 * PI.sqrt() * degree;
    for _ in 0..MOST_STEPS {
        let time_factor = root * root;
        // A degree whose time factor underflows has the limit's closed form.
        if time_factor < f64::MIN_POSITIVE {
            break;
        }
        let misfit = images::consolidated_below(0.0, time_factor).value - degree;
        let step = misfit / (2.0 * root * images::consolidation_rate(time_factor));
        root -= step;
        if step.abs() <= f64::EPSILON * root {
            break;
        }
    }
    root * root
}

/// Newton in `ln(1 − U)`, which is nearly linear in `T`.
fn late(remaining: f64) -> f64 {
    let mut time_factor = (-4.0 / (PI * PI) * elementary::ln(remaining * PI * PI / 8.0)).max(SWITCH / 2.0);
    for _ in 0..MOST_STEPS {
        let value = sine_series::isochrone_integral(0.0, time_factor).value;
        let step = value * elementary::ln(value / remaining) / sine_series::consolidation_rate(time_factor);
        time_factor += step;
        if step.abs() <= f64::EPSILON * time_factor {
            break;
        }
    }
    time_factor
}
