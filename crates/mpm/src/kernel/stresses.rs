//! Step 6: from nodal velocities to the deformation of the points, and to the stresses that the law makes of it.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::kernel::body::Body;
use crate::operators::stencil::with_stencils;
use crate::operators::strain_gradient::{CompositeRows, StrainOperator};
use crate::state::grid::SIXTH;
use crate::state::points::Points;
use crate::wide::{LANES, are_alike, some_mut, some_of, wide};
use oedometer_problem::method::Configuration;
use oedometer_soil::elementary;
use oedometer_soil::law::{History, StrainIncrement, StressLaw};
use oedometer_soil::tensor::{Tensor, Vector, identity, inverse, product};
use std::array;
use std::hint::black_box;

/// What follows the deformation of the points beside their volumes.
#[derive(Clone, Copy)]
struct Following {
    /// Their domains.
    domain: bool,
    /// Their inverse deformation gradients.
    inverse: bool,
}

/// How a step strains points.
#[derive(Clone, Copy)]
struct Straining<'a> {
    laws: &'a [StressLaw],
    /// Volumetric rates at the points, 1/s, where the method is B-bar.
    dilation_rates: &'a [f64],
    following: Following,
    deforms: bool,
    /// Whether gradients are pushed forward from the initial configuration.
    is_total: bool,
    is_forced: bool,
    /// Duration, s.
    dt: f64,
}

impl<const D: usize> Body<D> {
    /// Step 6: effective stress by the method's strain gradient; at finite strain also volume and
    /// domain.
    pub(crate) fn update_effective_stress(&mut self, dt: f64) {
        if self.method.strain.is_bbar() {
            self.recover_dilation_rates();
        }
        self.take_velocity_gradients();
        let straining = Straining {
            laws: &self.stress_laws,
            dilation_rates: &self.dilation_rates,
            following: self.following(),
            deforms: self.configuration.deforms(),
            is_total: self.configuration == Configuration::Total,
            is_forced: self.actions.forcing.is_some(),
            dt,
        };
        wide!(straining.strain_points(&mut self.points, &self.velocity_gradients));
        self.turn_domains();
    }

    /// The method's gradients of the skeleton's velocity at the points.
    fn take_velocity_gradients(&mut self) {
        let (stride, field) = (*self.grid.node_stride(), &self.nodes.solid_velocity[..]);
        let gradients = &mut self.velocity_gradients[..];
        match &self.operators.strain {
            StrainOperator::Basis => with_stencils!(&self.operators.basis, stencils => {
                wide!(stencils.take_gradients(&stride, field, gradients));
            }),
            // Of points that move each row is taken once: right where it is made.
            StrainOperator::Composite(_) if self.configuration.moves_points() => {
                let rows = CompositeRows::new(&self.grid, &self.cells, gradients.len());
                wide!(rows.take_gradients(&stride, field, gradients));
            }
            StrainOperator::Composite(stencils) => wide!(stencils.take_gradients(&stride, field, gradients)),
            StrainOperator::BetweenEnds(stencils) => {
                wide!(stencils.take_gradients(&stride, field, gradients));
            }
        }
    }

    /// Volume ratio, exact in the logarithmic strain, and the domain where it follows.
    pub(crate) fn deform(&mut self, point: usize, increment: &Tensor<D>) {
        let (following, points) = (self.following(), &mut self.points);
        following.deform(
            array::from_ref(increment),
            array::from_mut(&mut points.volume_ratio[point]),
            array::from_mut(&mut points.half_length[point]),
            array::from_mut(&mut points.inverse_deformation[point]),
        );
    }

    fn following(&self) -> Following {
        let moves = self.configuration.moves_points();
        // A hyperelastic law asks for the whole deformation, and so do domains that turn.
        let needs_deformation = self.material.law.is_hyperelastic() || self.operators.domains.is_some();
        Following {
            domain: moves && self.method.domains_follow(),
            inverse: self.configuration == Configuration::Total || moves && needs_deformation,
        }
    }
}

impl Straining<'_> {
    /// Strains points by their velocity gradients, those neighbours side by side that are of one soil.
    #[inline(always)]
    fn strain_points<const D: usize>(self, points: &mut Points<D>, gradients: &[Tensor<D>]) {
        let count = gradients.len();
        let mut strained = Strained {
            volume_ratio: &mut points.volume_ratio[..count],
            half_length: &mut points.half_length[..count],
            inverse_deformation: &mut points.inverse_deformation[..count],
            effective_stress: &mut points.effective_stress[..count],
            history: &mut points.history,
        };
        let soil = &points.soil[..count];
        let mut point = 0;
        while point < count {
            let law = &self.laws[usize::from(soil[point])];
            if are_alike(soil, point) {
                self.strain::<D, LANES>(&mut strained, law, point, *some_of(gradients, point));
                point += LANES;
            } else {
                self.strain(&mut strained, law, point, [gradients[point]]);
                point += 1;
            }
        }
    }

    /// Strains `N` neighbours of one soil by their velocity gradients: each line of the algorithm is a loop over them.
    #[inline(always)]
    fn strain<const D: usize, const N: usize>(
        &self,
        points: &mut Strained<'_, D>,
        law: &StressLaw,
        first: usize,
        mut gradients: [Tensor<D>; N],
    ) {
        let dt = self.dt;
        let back = some_mut::<_, N>(points.inverse_deformation, first);
        if self.is_total {
            for p in 0..N {
                gradients[p] = product(&gradients[p], &back[p]);
            }
        }
        let mut traces = [0.0; N];
        for p in 0..N {
            traces[p] = (0..D).map(|d| gradients[p][d][d]).sum();
        }
        // A motion compared with exact fields is followed at the middle of the step, to second order.
        if self.is_forced {
            for gradient in &mut gradients {
                *gradient = middle_gradient(gradient, dt);
            }
        }
        let mut increments = gradients;
        for rate in increments.as_flattened_mut().as_flattened_mut() {
            *rate *= dt;
        }
        let before = *some_mut::<_, N>(points.volume_ratio, first);
        let mut ratios = before;
        if self.deforms {
            let half_lengths = some_mut(points.half_length, first);
            self.following.deform(&increments, &mut ratios, half_lengths, back);
        }
        let (mut dilations, has_dilation) = ([0.0; N], !self.dilation_rates.is_empty());
        if has_dilation {
            // Of the kinematics only the volume goes the way of the water's.
            for p in 0..N {
                dilations[p] = dt * (self.dilation_rates[first + p] - traces[p]);
                for d in 0..D {
                    increments[p][d][d] += dilations[p] / D as f64;
                }
                if self.deforms {
                    ratios[p] *= stretch_of(dilations[p]);
                }
            }
        }
        *some_mut(points.volume_ratio, first) = ratios;
        let mut strains =
            [StrainIncrement { gradient: [[0.0; D]; D], dilation: 0.0, volume_ratio: [1.0; 2] }; N];
        for p in 0..N {
            let volume_ratio = [before[p], ratios[p]];
            strains[p] = StrainIncrement { gradient: increments[p], dilation: dilations[p], volume_ratio };
        }
        let stresses = some_mut(points.effective_stress, first);
        if self.deforms {
            *stresses = rotated(stresses, &increments);
        }
        let mut none = [History::default(); N];
        let histories = points.history.get_mut(first..).and_then(<[_]>::first_chunk_mut).unwrap_or(&mut none);
        law.update_each(
            stresses,
            histories,
            &strains,
            #[inline(always)]
            |p| {
                let (deformation, per_volume) = inverse(&back[p]);
                if has_dilation { assumed(&deformation, ratios[p] * per_volume) } else { deformation }
            },
        );
    }
}

/// What a strain changes at the points, as slices of one length; none of histories where the law has none.
struct Strained<'a, const D: usize> {
    volume_ratio: &'a mut [f64],
    half_length: &'a mut [Vector<D>],
    inverse_deformation: &'a mut [Tensor<D>],
    effective_stress: &'a mut [Tensor<D>],
    history: &'a mut [History],
}

impl Following {
    /// Deforms points by a step's displacement gradients: their volumes, exact in the logarithmic strain, and what follows
    /// them.
    #[inline(always)]
    fn deform<const D: usize, const N: usize>(
        self,
        increments: &[Tensor<D>; N],
        volume_ratios: &mut [f64; N],
        half_lengths: &mut [Vector<D>; N],
        inverse_deformations: &mut [Tensor<D>; N],
    ) {
        let mut stretches = [[0.0; D]; N];
        for p in 0..N {
            for d in 0..D {
                stretches[p][d] = increments[p][d][d];
            }
        }
        stretch(&mut stretches);
        for p in 0..N {
            for d in 0..D {
                volume_ratios[p] *= stretches[p][d];
            }
        }
        if self.domain {
            for p in 0..N {
                for d in 0..D {
                    half_lengths[p][d] *= stretches[p][d];
                }
            }
        }
        if self.inverse {
            for p in 0..N {
                inverse_deformations[p] = relaxed(&inverse_deformations[p], &increments[p]);
            }
        }
    }
}

/// `F̄ = (J̄/J)^(1/3) F` of F-bar (de Souza Neto et al. 1996; Coombs et al. 2018 for material points), from `F` and `J̄/J`: the
/// deformation gradient with the volume of the method's own divergence, shared by three directions, as [`StrainIncrement::components`]
/// shares it, also by those in which nothing is displaced.
#[inline]
pub(crate) fn assumed<const D: usize>(deformation: &Tensor<D>, volume_share: f64) -> Tensor<D> {
    let stretch = elementary::powf(volume_share, 1.0 / 3.0);
    deformation.map(|row| row.map(|component| stretch * component))
}

/// Strains so small that four terms of their exponential are exact to round-off.
const SMALL: f64 = 1e-4;
const PER_24: f64 = 1.0 / 24.0;

/// `exp(ε)`: a step's strain is small.
#[inline(always)]
fn stretch_of(strain: f64) -> f64 {
    if strain.abs() < SMALL { four_terms(strain) } else { elementary::exp(strain) }
}

#[inline(always)]
fn four_terms(strain: f64) -> f64 {
    1.0 + strain * (1.0 + strain * (0.5 + strain * (SIXTH + strain * PER_24)))
}

/// Takes the exponential of strains, `[point][direction]`: where all are small, without a branch for each.
#[inline(always)]
fn stretch<const D: usize, const N: usize>(strains: &mut [Vector<D>; N]) {
    let mut are_small = true;
    for p in 0..N {
        for d in 0..D {
            are_small &= strains[p][d].abs() < SMALL;
        }
    }
    for p in 0..N {
        for d in 0..D {
            strains[p][d] = if are_small { four_terms(strains[p][d]) } else { stretch_of(strains[p][d]) };
        }
    }
}

/// Stresses turned with the material over a step of displacement gradients `A`: `Q σ Qᵀ` with the
/// rotation `Q = (I − W/2)⁻¹(I + W/2)`, `W = skew A` (Hughes & Winget 1980). Together with the rate
/// form it is Jaumann's stress rate, and exactly objective under a rigid rotation.
#[inline(always)]
fn rotated<const D: usize, const N: usize>(
    stresses: &[Tensor<D>; N],
    increments: &[Tensor<D>; N],
) -> [Tensor<D>; N] {
    let mut turned = *stresses;
    if D != 2 {
        return turned;
    }
    let [mut cosine, mut sine] = [[0.0; N]; 2];
    for p in 0..N {
        let half = 0.25 * (increments[p][1][0] - increments[p][0][1]);
        let per = 1.0 / (1.0 + half * half);
        (cosine[p], sine[p]) = ((1.0 - half * half) * per, 2.0 * half * per);
    }
    // In memory: otherwise the compiler divides point by point.
    let [cosine, sine] = black_box([cosine, sine]);
    // `Q σ`, and that by `Qᵀ`: `[component][point]`.
    let mut rows = [[[0.0; N]; 2]; 2];
    for j in 0..D {
        for p in 0..N {
            let [above, below] = [stresses[p][0][j], stresses[p][1][j]];
            rows[0][j][p] = cosine[p] * above - sine[p] * below;
            rows[1][j][p] = sine[p] * above + cosine[p] * below;
        }
    }
    for i in 0..D {
        for p in 0..N {
            let [left, right] = [rows[i][0][p], rows[i][1][p]];
            turned[p][i][0] = left * cosine[p] - right * sine[p];
            turned[p][i][1] = left * sine[p] + right * cosine[p];
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
    use oedometer_soil::law::Law;
    use oedometer_soil::material::Material;

    #[test]
    fn a_stretch_is_the_exponential() {
        for strain in [-0.3_f64, -9e-5, -1e-7, 0.0, 3e-6, 9.9e-5, 0.2] {
            assert!((stretch_of(strain) / strain.exp() - 1.0).abs() < 3e-16);
        }
    }

    /// Points of a law strained side by side, and one by one.
    fn strained<const D: usize>(law: Law, dilation_rates: &[f64]) -> [Points<D>; 2] {
        let soil = Material { law, preconsolidation: 1.0, reload_modulus: 5e6, ..Material::default() };
        let mut points = Points::<D>::lattice(0.5, [3; D], 2);
        points.history = vec![History { yield_stress: 1.0, ..History::default() }; points.len()];
        for (point, stress) in points.effective_stress.iter_mut().enumerate() {
            *stress = array::from_fn(|i| array::from_fn(|j| (point as f64 + 2.0 * (i + j) as f64).cos()));
        }
        let straining = Straining {
            laws: &[soil.stress_law(); 2],
            dilation_rates,
            following: Following { domain: true, inverse: true },
            deforms: true,
            is_total: false,
            is_forced: false,
            dt: 1e-3,
        };
        // One strain that is not small.
        let size = |point: usize| if point == 1 { 3.0 } else { 0.03 };
        let gradient = |point: usize| -> Tensor<D> {
            array::from_fn(|i| {
                array::from_fn(|j| size(point) * (3.0 * point as f64 + (2 * i + j) as f64).sin())
            })
        };
        let gradients: Vec<Tensor<D>> = (0..points.len()).map(gradient).collect();
        // Soils that take turns are strained one by one.
        let mut in_turn = points.clone();
        in_turn.soil.iter_mut().step_by(2).for_each(|soil| *soil = 1);
        [points, in_turn].map(|mut points| {
            straining.strain_points(&mut points, &gradients);
            points.soil.fill(0);
            points
        })
    }

    #[test]
    fn one_large_strain_among_small_ones_is_stretched_by_the_exponential() {
        for large in [0.5, -0.3, 1e-4] {
            let strains = [[1e-6, 0.0], [2e-5, large], [0.0, -1e-5]];
            let mut stretches = strains;
            stretch(&mut stretches);
            for (stretch, strain) in stretches.as_flattened().iter().zip(strains.as_flattened()) {
                assert!((stretch / elementary::exp(*strain) - 1.0).abs() < 1e-15, "{strain}: {stretch}");
            }
        }
    }

    #[test]
    fn points_are_strained_side_by_side_as_one_by_one() {
        for law in
            [Law::LogLinear, Law::PorosityDependent, Law::NeoHookean, Law::Preconsolidated, Law::VonMises]
        {
            let dilating: [f64; 36] = array::from_fn(|point| 0.02 + 0.1 * point as f64);
            for rates in [&[][..], &dilating] {
                let [together, in_turn] = strained::<1>(law, rates);
                assert_eq!(together, in_turn, "{law:?} on a line");
                let [together, in_turn] = strained::<2>(law, rates);
                assert_eq!(together, in_turn, "{law:?} in the plane");
            }
        }
    }

    #[test]
    fn the_rate_form_of_b_bar_is_f_bar_step_by_step() {
        // Steps exp(A) of a motion, and the volumes exp(a) that a divergence makes of them: F-bar multiplies
        // (exp(a)/det exp(A))^(1/3) exp(A), B-bar adds (a − tr A)/3 to the diagonal of A and a − tr A to ln J.
        let exponential = |a: &Tensor<2>| inverse(&relaxed(&identity(), a)).0;
        let (mut motion, mut f_bar, mut log_volume) = (identity::<2>(), identity::<2>(), 0.0);
        for step in 0..20 {
            let size = 1e-4 * f64::from(step - 7);
            let increment = [[size, -0.7 * size], [0.4 * size, -0.3 * size]];
            let volume = 0.5 * size;
            let stretch = exponential(&increment);
            motion = product(&stretch, &motion);
            let share = volume.exp() / inverse(&stretch).1;
            let step_stretch = stretch.map(|row| row.map(|entry| share.cbrt() * entry));
            f_bar = product(&step_stretch, &f_bar);
            log_volume += volume;
            let mut b_bar = increment;
            let dilation = volume - inverse(&stretch).1.ln();
            (b_bar[0][0], b_bar[1][1]) = (b_bar[0][0] + dilation / 3.0, b_bar[1][1] + dilation / 3.0);
            for (got, exact) in exponential(&b_bar).as_flattened().iter().zip(step_stretch.as_flattened()) {
                assert!((got - exact).abs() < 1e-9, "{got} for {exact}");
            }
        }
        let (_, volume) = inverse(&motion);
        let share = log_volume.exp() / volume;
        let at_once = assumed(&motion, share);
        for (got, exact) in at_once.as_flattened().iter().zip(f_bar.as_flattened()) {
            assert!((got - exact).abs() < 1e-13, "{got} for {exact}");
        }
        let volume = share.cbrt() * inverse(&at_once).1;
        assert!((volume / log_volume.exp() - 1.0).abs() < 1e-13, "its volume is the divergence's");
        assert_eq!(assumed(&motion, 1.0), motion, "no correction without a difference of volumes");
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
    fn a_stress_turns_by_the_rotation_of_hughes_and_winget() {
        let (stress, increment) = ([[1.1, -0.4], [0.3, 0.9]], [[0.7, -0.6], [0.8, 0.2]]);
        // Q σ Qᵀ with Q = (I − W/2)⁻¹ (I + W/2).
        let half = 0.25 * (increment[1][0] - increment[0][1]);
        let turn = product(&inverse(&[[1.0, half], [-half, 1.0]]).0, &[[1.0, -half], [half, 1.0]]);
        let back = [[turn[0][0], turn[1][0]], [turn[0][1], turn[1][1]]];
        let exact = product(&product(&turn, &stress), &back);
        for (got, exact) in
            rotated(&[stress], &[increment])[0].as_flattened().iter().zip(exact.as_flattened())
        {
            assert!((got - exact).abs() < 1e-14, "{got} for {exact}");
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
            let remainder = product(&back, &moved);
            (remainder[0][0] - 1.0).abs()
                + remainder[0][1].abs()
                + remainder[1][0].abs()
                + (remainder[1][1] - 1.0).abs()
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
