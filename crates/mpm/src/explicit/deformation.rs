//! Deformation of a point over a step: its volume, its domain, and the turning of its stress.

use crate::state::grid::SIXTH;
use oedometer_soil::elementary;
use oedometer_soil::tensor::{Tensor, Vector, identity, inverse, product};

/// What follows the deformation of a point beside its volume.
#[derive(Clone, Copy)]
pub enum Following {
    /// Its domain.
    Domain,
    /// Its inverse deformation gradient.
    InverseDeformation,
    /// Both of them.
    Both,
    /// Nothing else.
    Nothing,
}

impl Following {
    /// Whether the domain follows.
    #[inline]
    pub fn takes_domain(self) -> bool {
        matches!(self, Self::Domain | Self::Both)
    }

    /// Whether the inverse deformation gradient follows.
    #[inline]
    pub fn takes_inverse(self) -> bool {
        matches!(self, Self::InverseDeformation | Self::Both)
    }
}

/// Strains so small that four terms of their exponential are exact to round-off.
const SMALL: f64 = 1e-4;
const PER_24: f64 = 1.0 / 24.0;

/// `exp(ε)`: a step's strain is small.
#[inline]
pub fn stretch_of(strain: f64) -> f64 {
    if strain.abs() < SMALL { four_terms(strain) } else { elementary::exp(strain) }
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn four_terms(strain: f64) -> f64 {
    1.0 + strain * (1.0 + strain * (0.5 + strain * (SIXTH + strain * PER_24)))
}

/// Stretches of some points along each direction from their strains, `[point][direction]`, as [`stretch_of`] has them:
/// where all strains are small, without a branch for each.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn stretches_of<const D: usize, const N: usize>(strains: &[Vector<D>; N]) -> [Vector<D>; N] {
    let mut stretches = *strains;
    let (strains, of_strains) = (strains.as_flattened(), stretches.as_flattened_mut());
    if strains.iter().fold(true, |all, strain| all & (strain.abs() < SMALL)) {
        for (stretch, strain) in of_strains.iter_mut().zip(strains) {
            *stretch = four_terms(*strain);
        }
    } else {
        for (stretch, strain) in of_strains.iter_mut().zip(strains) {
            *stretch = stretch_of(*strain);
        }
    }
    stretches
}

/// Stresses of some points turned with the material over a step of displacement gradient `A`: `Q σ Qᵀ` with the
/// rotation `Q = (I − W/2)⁻¹(I + W/2)`, `W = skew A` (Hughes & Winget 1980). Together with the rate
/// form it is Jaumann's stress rate, and exactly objective under a rigid rotation.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn rotated<const D: usize, const N: usize>(
    stresses: &[Tensor<D>; N],
    increments: &[Tensor<D>; N],
) -> [Tensor<D>; N] {
    let mut turned = *stresses;
    if D != 2 {
        return turned;
    }
    let [mut cosine, mut sine] = [[0.0; N]; 2];
    for point in 0..N {
        sine[point] = 0.25 * (increments[point][1][0] - increments[point][0][1]);
    }
    for point in 0..N {
        let half = sine[point];
        let per = 1.0 / (1.0 + half * half);
        (cosine[point], sine[point]) = ((1.0 - half * half) * per, 2.0 * half * per);
    }
    // `Q σ`, by rows of `σ`, and that by `Qᵀ`: `[component][point]`.
    let mut rows = [[[0.0; N]; 2]; 2];
    for j in 0..2 {
        for point in 0..N {
            let [above, below] = [stresses[point][0][j], stresses[point][1][j]];
            rows[0][j][point] = cosine[point] * above - sine[point] * below;
            rows[1][j][point] = sine[point] * above + cosine[point] * below;
        }
    }
    for i in 0..2 {
        for point in 0..N {
            let [left, right] = [rows[i][0][point], rows[i][1][point]];
            turned[point][i][0] = left * cosine[point] - right * sine[point];
            turned[point][i][1] = left * sine[point] + right * cosine[point];
        }
    }
    turned
}

/// `F⁻¹ exp(−A)` for a step's strain `A`, to third order in it.
#[inline]
pub fn relaxed<const D: usize>(inverse: &Tensor<D>, increment: &Tensor<D>) -> Tensor<D> {
    let once = product(inverse, increment);
    let twice = product(&once, increment);
    std::array::from_fn(|i| std::array::from_fn(|j| inverse[i][j] - once[i][j] + 0.5 * twice[i][j]))
}

/// `(I + Δt L/2)⁻¹` of a velocity gradient `L` at the start of a step.
#[inline]
pub fn to_middle<const D: usize>(gradient: &Tensor<D>, dt: f64) -> Tensor<D> {
    let unit = identity::<D>();
    let forth = std::array::from_fn(|i| std::array::from_fn(|j| unit[i][j] + 0.5 * dt * gradient[i][j]));
    inverse(&forth).0
}

/// A velocity gradient `L` at the start of a step, on the configuration of its middle: `L (I + Δt L/2)⁻¹`. Its
/// exponential is `I + Δt L` to second order, which is what points that are moved by `Δt v` undergo.
#[inline]
pub fn middle_gradient<const D: usize>(gradient: &Tensor<D>, dt: f64) -> Tensor<D> {
    product(gradient, &to_middle(gradient, dt))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_is_the_exponential() {
        for strain in [-0.3_f64, -9e-5, -1e-7, 0.0, 3e-6, 9.9e-5, 0.2] {
            assert!((stretch_of(strain) / strain.exp() - 1.0).abs() < 3e-16);
        }
        for last in [3e-6, 0.2, f64::NAN] {
            let mut strains = [[-1e-7, 9.9e-5]; 4];
            strains[3][1] = last;
            for (stretches, strains) in stretches_of(&strains).iter().zip(&strains) {
                assert_eq!(stretches.map(f64::to_bits), strains.map(|strain| stretch_of(strain).to_bits()));
            }
        }
    }

    #[test]
    fn a_stress_turns_with_the_material_and_keeps_its_invariants() {
        // A quarter turn in a thousand steps takes the stress along x to one along y.
        let angle = std::f64::consts::FRAC_PI_2 / 1000.0;
        let mut stress = [[5.0, 1.0], [1.0, -2.0]];
        // Q with tan(θ/2) = w/2 turns by θ.
        let spin = 2.0 * (0.5 * angle).tan();
        for _ in 0..1000 {
            [stress] = rotated(&[stress], &[[[0.0, -spin], [spin, 0.0]]]);
        }
        for (got, exact) in stress.iter().flatten().zip([-2.0, -1.0, -1.0, 5.0]) {
            assert!((got - exact).abs() < 1e-12, "{got} for {exact}");
        }
        let [stretched] = rotated(&[stress], &[[[0.1, 0.3], [0.3, -0.2]]]);
        assert_eq!(stretched, stress, "a strain without spin turns nothing");
    }

    #[test]
    fn stresses_turn_side_by_side_as_one_by_one() {
        let tensor =
            |seed: f64| [[(1.1 * seed).sin(), (2.3 * seed).cos()], [(0.7 * seed).cos(), (1.9 * seed).sin()]];
        let stresses: [Tensor<2>; 4] = std::array::from_fn(|point| tensor(1.0 + point as f64));
        let increments: [Tensor<2>; 4] = std::array::from_fn(|point| tensor(7.0 - point as f64));
        for (point, turned) in rotated(&stresses, &increments).iter().enumerate() {
            assert_eq!([*turned], rotated(&[stresses[point]], &[increments[point]]));
            // Q σ Qᵀ with Q = (I − W/2)⁻¹ (I + W/2).
            let half = 0.25 * (increments[point][1][0] - increments[point][0][1]);
            let forth = [[1.0, -half], [half, 1.0]];
            let turn = product(&inverse(&[[1.0, half], [-half, 1.0]]).0, &forth);
            let back = [[turn[0][0], turn[1][0]], [turn[0][1], turn[1][1]]];
            let exact = product(&product(&turn, &stresses[point]), &back);
            for (got, exact) in turned.as_flattened().iter().zip(exact.as_flattened()) {
                assert!((got - exact).abs() < 1e-14, "{got} for {exact}");
            }
        }
        assert_eq!(rotated(&[[[3.0]]], &[[[0.5]]]), [[[3.0]]], "a line does not turn");
    }

    #[test]
    fn a_step_at_its_middle_is_that_of_points_moved_along_straight_lines() {
        // exp of the middle gradient is I + Δt L but for third order.
        let gradient = [[0.3, -0.8], [0.5, -0.4]];
        let off = |dt: f64| {
            let increment = middle_gradient(&gradient, dt).map(|row| row.map(|rate| dt * rate));
            let back = relaxed(&identity::<2>(), &increment);
            let moved: Tensor<2> = std::array::from_fn(|i| {
                std::array::from_fn(|j| f64::from(u8::from(i == j)) + dt * gradient[i][j])
            });
            let whole = product(&back, &moved);
            (whole[0][0] - 1.0).abs() + whole[0][1].abs() + whole[1][0].abs() + (whole[1][1] - 1.0).abs()
        };
        assert!(off(1e-2) < 1e-6 && (7.5..8.5).contains(&(off(2e-2) / off(1e-2))), "{}", off(1e-2));
    }

    #[test]
    fn the_inverse_deformation_keeps_to_the_volume() {
        let mut inverse = [[1.0, 0.0], [0.0, 1.0]];
        let increment = [[1e-6, 3e-6], [-2e-6, -4e-6]];
        for _ in 0..50_000 {
            inverse = relaxed(&inverse, &increment);
        }
        let determinant: f64 = inverse[0][0] * inverse[1][1] - inverse[0][1] * inverse[1][0];
        assert!((determinant.ln() - 50_000.0 * 3e-6).abs() < 1e-10, "det F⁻¹ = exp(−tr ε)");
    }
}
