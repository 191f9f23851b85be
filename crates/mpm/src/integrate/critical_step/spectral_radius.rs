//! The critical time step, from the spectral radius of the method's own step operator.

use crate::direct_solver::dense::subtract_product;
use crate::integrate::assembled::step::AssembledStep;
use crate::integrate::critical_step::parts::parts;
use nalgebra::DMatrix;
use oedometer_problem::settings::ExplicitSettings;
use oedometer_soil::elementary;

/// Growth per step that counts as none: eigenvalues of exactly one scatter by round-off, and the null modes of FLIP grow
/// linearly.
pub const GROWTH_TOLERANCE: f64 = 1e-6;
/// Squarings of the step operator. Growth is judged over `2^30` steps: a displacement that grows linearly, as all do where
/// nothing holds them for the first million steps, still counts as `30 ln 2/2^30` per step.
const SQUARINGS: u32 = 30;
/// Share of the formula's step below which the search for a limit ends.
const LEAST_SHARE: f64 = 0.01;
/// Bisections of the bracket: a thousandth of a percent.
const BISECTIONS: u32 = 24;

/// Powers `A^m` of a square matrix by repeated squaring, which bound its spectral radius `ρ` from both sides:
/// `(|tr A^m|/n)^(1/m) ≤ ρ ≤ ‖A^m‖^(1/m)`, and the upper bound tends to `ρ`.
///
/// The work is bounded whatever the spectrum: a Schur iteration can hang on a step operator with hundreds of
/// eigenvalues that are exactly one.
struct Powers {
    /// `A^m` over a norm, which is kept in `log_scale`.
    power: DMatrix<f64>,
    squared: DMatrix<f64>,
    /// `ln(scale)/m`.
    log_scale: f64,
    /// `1/m`.
    share: f64,
}

impl Powers {
    fn new(operator: &DMatrix<f64>) -> Self {
        Self { power: operator.clone(), squared: operator.clone(), log_scale: 0.0, share: 1.0 }
    }

    /// Upper bound of the spectral radius.
    fn most(&self) -> f64 {
        self.bound(self.power.norm())
    }

    /// Lower bound of the spectral radius.
    fn least(&self) -> f64 {
        self.bound(self.power.trace().abs() / self.power.nrows() as f64)
    }

    fn bound(&self, size: f64) -> f64 {
        if size == 0.0 { 0.0 } else { elementary::exp(self.log_scale + self.share * elementary::ln(size)) }
    }

    /// Replaces `A^m` by `A^(2m)`; false where that is zero or not finite.
    fn square(&mut self) -> bool {
        let norm = self.power.norm();
        if norm == 0.0 || !norm.is_finite() {
            return false;
        }
        self.log_scale += self.share * elementary::ln(norm);
        self.share *= 0.5;
        let scale = 1.0 / norm;
        self.squared.fill(0.0);
        let (squared, power) = (&mut self.squared.as_view_mut(), self.power.as_view());
        subtract_product(squared, power, power);
        self.squared *= -scale * scale;
        std::mem::swap(&mut self.power, &mut self.squared);
        true
    }
}

/// Spectral radius of a square matrix, `lim ‖A^m‖^(1/m)`; infinite where it is not finite.
pub fn spectral_radius(operator: &DMatrix<f64>) -> f64 {
    let mut powers = Powers::new(operator);
    for _ in 0..SQUARINGS {
        if !powers.square() {
            break;
        }
    }
    let radius = powers.most();
    if radius.is_finite() { radius } else { f64::INFINITY }
}

/// Whether the spectral radius of a square matrix is at most `most`, by as few powers as tell.
fn is_within(operator: &DMatrix<f64>, most: f64) -> bool {
    let mut powers = Powers::new(operator);
    for _ in 0..SQUARINGS {
        if powers.most() <= most || powers.least() > most || !powers.square() {
            break;
        }
    }
    powers.most() <= most
}

/// Unknowns of the largest operator that is squared: a plane of eight by eight cells.
pub const MOST_SQUARED: usize = 640;
/// Growth per step that counts as none in a plane, at the formula's step: a doubling takes 70 000 steps. Smaller steps are
/// allowed the same growth per time, for growth of the spatial equations does not depend on the step.
pub const SLOW_GROWTH: f64 = 1e-5;
/// Factor by which a search upwards increases the step.
const NEAR: f64 = 1.04;

/// Largest growth per step of any mode under steps of a size; none where the operator is too large to be squared.
pub fn growth<const D: usize>(step: &AssembledStep<D>, dt: f64, settings: &ExplicitSettings) -> Option<f64> {
    (step.unknowns() <= MOST_SQUARED).then(|| spectral_radius(&step.operator(dt, settings)))
}

/// The same by the parts of the operator that do not mix, which costs a quarter where the body is its own mirror image.
pub fn growth_by_parts<const D: usize>(
    step: &AssembledStep<D>,
    dt: f64,
    settings: &ExplicitSettings,
) -> Option<f64> {
    let of_parts =
        || parts(step.operator(dt, settings), &step.images()).iter().map(spectral_radius).fold(0.0, f64::max);
    (step.unknowns() <= MOST_SQUARED).then(of_parts)
}

/// Largest step, s, of a frozen body under which no mode grows by more than `growth` per step, by bisection of the
/// spectral radius between a step known to be safe and multiples of it. None where a mode grows under any step: the
/// equations in space are unstable then.
///
/// In a plane squaring is expensive. There the limit is where a disturbance of all wavelengths begins to grow within some
/// hundred steps, and the spectral radius only confirms that nothing grows slowly there: by `growth`, or by a doubling in
/// 70 000 steps where that is more. A `sharp` limit is searched by the spectral radius beyond it, too.
pub fn critical_step<const D: usize>(
    step: &AssembledStep<D>,
    settings: &ExplicitSettings,
    safe: f64,
    growth: f64,
    sharp: bool,
) -> Option<f64> {
    let images = step.images();
    let is_within = |dt: f64, growth: f64| {
        parts(step.operator(dt, settings), &images).iter().all(|part| is_within(part, 1.0 + growth))
    };
    if D == 1 {
        return bracketed([safe, 2.0, 1e-4], &mut |dt| is_within(dt, growth));
    }
    let mut disturbed = step.clone();
    let mut is_bounded = |dt: f64, steps: usize| stays_bounded(&mut disturbed, dt, settings, steps);
    let (start, mut known, mut candidates) = ([safe, 2.0, 1e-3], Known::default(), Vec::new());
    // Beyond the limit waves grow by several per cent a step: few steps find it.
    let early = bracketed(start, &mut |dt| {
        let is_bounded = is_bounded(dt, LOOK_INTERVAL);
        if is_bounded {
            candidates.push(dt);
        } else {
            known.learn(dt, false);
        }
        is_bounded
    });
    // The spectral radius confirms it, or many steps where that cannot be had.
    let has_radius = step.unknowns() <= MOST_SQUARED;
    let most = |dt: f64| if growth > SLOW_GROWTH { growth } else { SLOW_GROWTH * (dt / safe).min(1.0) };
    let mut is_stable = |dt: f64| is_within(dt, most(dt));
    if has_radius && !sharp && early.is_some_and(&mut is_stable) {
        return early;
    }
    candidates.sort_unstable_by(f64::total_cmp);
    for dt in candidates.into_iter().rev() {
        let is_bounded = is_bounded(dt, GROWTH_STEPS);
        known.learn(dt, is_bounded);
        if is_bounded {
            break;
        }
    }
    let soon = bracketed(start, &mut |dt| known.answer(dt).unwrap_or_else(|| is_bounded(dt, GROWTH_STEPS)));
    match soon {
        _ if !has_radius => soon,
        Some(dt) if !sharp && soon != early && is_stable(dt) => soon,
        unconfirmed => bracketed([unconfirmed.unwrap_or(safe), NEAR, 2e-3], &mut is_stable),
    }
}

/// Steps, s, of which it is known whether they are stable: those up to a stable one are, and those from an unstable one on
/// are not.
struct Known {
    stable: f64,
    unstable: f64,
}

impl Default for Known {
    fn default() -> Self {
        Self { stable: 0.0, unstable: f64::INFINITY }
    }
}

impl Known {
    fn learn(&mut self, dt: f64, is_stable: bool) {
        if is_stable {
            self.stable = self.stable.max(dt);
        } else {
            self.unstable = self.unstable.min(dt);
        }
    }

    /// Whether a step is stable, where that is known.
    fn answer(&self, dt: f64) -> Option<bool> {
        if dt <= self.stable {
            Some(true)
        } else if dt >= self.unstable {
            Some(false)
        } else {
            None
        }
    }
}

/// Largest step, s, not beyond `safe`, under which nothing grows faster than `rate`, 1/s. None where the operator is too large
/// to be squared or everything grows faster.
pub fn step_of_growth<const D: usize>(
    step: &AssembledStep<D>,
    settings: &ExplicitSettings,
    safe: f64,
    rate: f64,
) -> Option<f64> {
    if step.unknowns() > MOST_SQUARED || !rate.is_finite() {
        return None;
    }
    let grows_slowly = |dt: f64| is_within(&step.operator(dt, settings), elementary::exp(rate * dt));
    bracketed([safe, 1.0, 1e-2], &mut { grows_slowly })
}

/// The limit between stable and unstable steps, by bisection from a safe step to a relative tolerance; a search upwards goes
/// by `factor`. None where no step down to a hundredth of the first is stable.
fn bracketed([safe, factor, tolerance]: [f64; 3], is_stable: &mut dyn FnMut(f64) -> bool) -> Option<f64> {
    let mut low = safe;
    let mut high = factor * low;
    // The formula is an estimate: go down where it is too large.
    while !is_stable(low) {
        high = low;
        low *= 0.5;
        if low < LEAST_SHARE * safe {
            return None;
        }
    }
    while high > safe && is_stable(high) && high < 1e3 * safe {
        low = high;
        high *= factor;
    }
    for _ in 0..BISECTIONS {
        if high - low < tolerance * low {
            break;
        }
        let middle = 0.5 * (low + high);
        if is_stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

/// Steps over which the growth of a disturbance is judged: a multiple of the interval between two looks.
const GROWTH_STEPS: usize = 512;
/// Growth of the velocities over these steps that no stable step reaches: null modes of FLIP double.
const MOST_GROWTH: f64 = 4.0;
/// Steps between two looks at a disturbance.
const LOOK_INTERVAL: usize = 64;
/// Velocity, m/s, that no node reaches under a stable step from at most 0.5 m/s.
const LOST: f64 = 1e12;

/// Whether a disturbance of all wavelengths does not grow over so many steps after the same number of first ones.
fn stays_bounded<const D: usize>(
    step: &mut AssembledStep<D>,
    dt: f64,
    settings: &ExplicitSettings,
    steps: usize,
) -> bool {
    step.set_step(dt, settings);
    step.disturb();
    let mut sizes = [0.0; 2];
    for size in &mut sizes {
        for _ in 0..steps / LOOK_INTERVAL {
            for _ in 0..LOOK_INTERVAL {
                step.step(dt, settings);
            }
            *size = step.largest_velocity();
            if *size > LOST {
                return false;
            }
        }
    }
    sizes[1] <= MOST_GROWTH * sizes[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::body::Body;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::Drag;
    use oedometer_problem::wave_speeds;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, XIE_LEO};
    use oedometer_soil::material::Material;

    #[test]
    fn the_limit_of_a_plane_too_large_to_square_is_confirmed_by_many_steps() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        // Beyond the limit waves grow too slowly for few steps to show it.
        let soil = Material { hydraulic_conductivity: 1e-7, ..Material::default() };
        let method = Method::named("GIMP").expect("a known method");
        let problem =
            column_problem::<2>(&COSINE_LAYER, &Column::layer(), &soil, method, 9, 2).expect("a layer");
        let safe = wave_speeds::combined_limit(&soil, problem.grid.cell_size, settings.drag);
        let mut step = AssembledStep::new(&Body::new(problem));
        assert!(step.unknowns() > MOST_SQUARED);
        let limit = critical_step(&step, &settings, safe, GROWTH_TOLERANCE, false).expect("a limit");
        assert!(limit > safe && stays_bounded(&mut step, limit, &settings, GROWTH_STEPS), "{limit}");
    }

    #[test]
    fn what_few_steps_leave_in_doubt_comes_to_what_many_find() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        let (column, soil) = (Column { dimensions: 2, ..Column::default() }, Material::default());
        let method = Method::named("GC-SRI-patch").expect("a known method");
        let problem = column_problem::<2>(&XIE_LEO, &column, &soil, method, 10, 4).expect("a column");
        let safe = wave_speeds::combined_limit(&soil, problem.grid.cell_size, settings.drag);
        let mut step = AssembledStep::new(&Body::new(problem));
        let limit = critical_step(&step, &settings, safe, GROWTH_TOLERANCE, false);
        let mut limit_by = |steps: usize| {
            bracketed([safe, 2.0, 1e-3], &mut |dt| stays_bounded(&mut step, dt, &settings, steps))
        };
        assert_eq!(limit, limit_by(GROWTH_STEPS));
        assert!(limit < limit_by(LOOK_INTERVAL), "few steps find another");
    }

    #[test]
    fn the_spectral_radius_of_known_matrices() {
        let rotation = DMatrix::from_row_slice(2, 2, &[0.0, -1.1, 1.1, 0.0]);
        assert!((spectral_radius(&rotation) - 1.1).abs() < 1e-6);
        let jordan = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 0.0, 1.0]);
        assert!((spectral_radius(&jordan) - 1.0).abs() < 2e-6, "linear growth is no growth rate");
        let spread = DMatrix::from_row_slice(2, 2, &[0.5, 100.0, 0.0, 0.25]);
        assert!((spectral_radius(&spread) - 0.5).abs() < 1e-6);
        assert_eq!(spectral_radius(&DMatrix::zeros(3, 3)), 0.0);
        assert_eq!(spectral_radius(&DMatrix::from_element(2, 2, f64::NAN)), f64::INFINITY);
        for (matrix, radius) in [(rotation, 1.1), (jordan, 1.0), (spread, 0.5)] {
            assert!(is_within(&matrix, radius + 1e-5) && !is_within(&matrix, radius - 1e-5));
        }
        assert!(!is_within(&DMatrix::from_element(2, 2, f64::NAN), 1.0));
    }
}
