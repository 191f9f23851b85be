//! What follows from a law, and the update of stresses by it, docs/theory.md, section 2: `dσ'/dt = C(E, ν) : sym ∇v_s` on the
//! current configuration. Every integrator updates stresses by [`StressLaw::update`].

use crate::elementary;
use crate::law_data::{Conductivity, Modulus, PointUpdate, Stress, Uniaxial};
pub use crate::laws::Law;
use crate::plasticity::{Components, PointState, Tangent};
use crate::stiffness::Stiffness;
use crate::tensor::Tensor;
use std::array;

impl Law {
    /// The laws of columns: a rate against the logarithmic strain, which a uniaxial compression integrates in closed
    /// form.
    pub fn for_columns() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|law| law.is_for_columns())
    }

    /// Whether it is one of them: whether it has a [stress of a uniaxial compression](Self::uniaxial_stress_ratio).
    pub fn is_for_columns(self) -> bool {
        self.data().uniaxial.is_some()
    }

    /// Whether the stress is a function of the deformation gradient, and no rate is integrated.
    #[inline]
    pub fn is_hyperelastic(self) -> bool {
        matches!(self.data().stress, Stress::NeoHookean)
    }

    /// Whether it has one modulus up to the largest stress so far, and another one for first loading.
    #[inline]
    pub fn is_preconsolidated(self) -> bool {
        matches!(self.data().stress, Stress::Preconsolidated(_))
    }

    /// Whether the stress depends on a [`History`], so that every update has to read and to keep one, and no stiffness of
    /// the start serves for a whole run.
    #[inline]
    pub fn has_history(self) -> bool {
        matches!(self.data().stress, Stress::Preconsolidated(_) | Stress::Yields(_))
    }

    /// Modulus over the initial one against the logarithmic strain `dJ/J` of the rate form, over
    /// a step from one volume ratio to another: at their geometric mean, of second order. For a hyperelastic law,
    /// whose stress is not integrated from a rate, it is 1.
    #[inline]
    pub fn modulus_ratio(self, before: f64, after: f64) -> f64 {
        match self.data().stress {
            Stress::Rate(Modulus::InverseOfVolume) => 1.0 / (before * after).sqrt(),
            _ => 1.0,
        }
    }

    /// Vertical effective stress over the oedometric modulus of a uniaxial compression to the
    /// engineering strain `J − 1`, which may be tiny: the integral of the rate form. NaN for laws that are not
    /// [for columns](Self::for_columns), because their stress depends on Poisson's ratio too.
    #[inline]
    pub fn uniaxial_stress_ratio(self, strain: f64) -> f64 {
        self.uniaxial(|uniaxial| uniaxial.stress_ratio, strain)
    }

    /// Loss of volume `1 − J` under a uniaxial compression `−σ'/E_oed`; for the linear law its small-strain value.
    /// NaN for laws that are not for columns.
    #[inline]
    pub fn shrinkage(self, compression: f64) -> f64 {
        if self == Self::Linear { compression } else { -self.strain_under(compression) }
    }

    /// The engineering strain `J − 1` at which a uniaxial compression reaches `−σ'/E_oed`: the inverse of
    /// [`uniaxial_stress_ratio`](Self::uniaxial_stress_ratio). NaN for laws that are not for columns.
    #[inline]
    pub fn strain_under(self, compression: f64) -> f64 {
        self.uniaxial(|uniaxial| uniaxial.strain_under, compression)
    }

    /// Hydraulic conductivity, m/s, at volume ratio `J` from the initial one (docs/theory.md, section 2).
    #[inline]
    pub fn conductivity(self, initial: f64, volume_ratio: f64) -> f64 {
        let [conductivity] = self.conductivities(initial, &[volume_ratio]);
        conductivity
    }

    /// The same at some volume ratios: the law is asked once.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loops of the step")]
    pub fn conductivities<const N: usize>(self, initial: f64, volume_ratios: &[f64; N]) -> [f64; N] {
        let mut conductivities = [initial; N];
        match self.data().conductivity {
            Conductivity::Constant => {}
            Conductivity::SquareOfVolume => {
                for p in 0..N {
                    conductivities[p] = initial * volume_ratios[p] * volume_ratios[p];
                }
            }
        }
        conductivities
    }

    /// `κ(J) = k/J` over the initial conductivity: the flux that a pressure gradient with respect to the initial
    /// coordinates drives.
    #[inline]
    pub fn mobility_ratio(self, volume_ratio: f64) -> f64 {
        self.conductivity(1.0, volume_ratio) / volume_ratio
    }

    /// Kirchhoff's potential `Φ` at the engineering strain `J − 1`, `dΦ = κ dσ'` over `k_0 E_oed`, zero in the
    /// initial state; in closed form for every law for columns, NaN for others.
    #[inline]
    pub fn flow_potential(self, strain: f64) -> f64 {
        self.uniaxial(|uniaxial| uniaxial.flow_potential, strain)
    }

    /// A function of the uniaxial compression; NaN without one.
    #[inline]
    fn uniaxial(self, of: impl Fn(&Uniaxial) -> fn(f64) -> f64, at: f64) -> f64 {
        self.data().uniaxial.as_ref().map_or(f64::NAN, |uniaxial| of(uniaxial)(at))
    }
}

/// Deformation of the skeleton at a point over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainIncrement<const D: usize> {
    /// Displacement gradient whose symmetric part is the strain, with the volume of B-bar shared by its diagonal.
    pub gradient: Tensor<D>,
    /// Volume that B-bar adds to the strain; zero without it.
    pub dilation: f64,
    /// Volume ratio `J` before and after the step.
    pub volume_ratio: [f64; 2],
}

impl<const D: usize> StrainIncrement<D> {
    /// Components `xx, yy, zz, xy` of the strain. The volume that B-bar adds is shared by all three directions, including
    /// those without displacement (Hughes 1980, Eq. 12).
    #[inline]
    pub fn components(&self) -> Components {
        let (gradient, third) = (&self.gradient, self.dilation / 3.0);
        let normal = |d: usize| gradient[d][d] - self.dilation / D as f64 + third;
        if D == 1 {
            return [third, normal(0), third, 0.0];
        }
        [normal(0), normal(D - 1), third, 0.5 * (gradient[0][D - 1] + gradient[D - 1][0])]
    }
}

/// History variables of a point beside its stresses in the plane of the problem, for laws that
/// [have a history](Law::has_history).
///
/// A stress update starts from the history of an accepted state and stores the new history with the new stress: an
/// implicit stage starts from its anchored points, an explicit step from the points themselves. A rejected trial is
/// discarded together with its points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct History {
    /// Effective stress normal to the plane of the problem, Pa, tension positive; only laws that yield have it.
    pub lateral_stress: f64,
    /// Present yield stress, Pa: for [`Law::Preconsolidated`] the largest vertical effective stress so far, compression
    /// positive.
    pub yield_stress: f64,
    /// Equivalent plastic strain; only [`Law::VonMises`] has it.
    pub plastic_strain: f64,
}

/// A law with the parameters of a soil from which effective stresses are computed.
#[derive(Clone, Copy, Debug)]
pub struct StressLaw {
    /// How the stress follows the strain.
    pub stress: Stress,
    /// Stiffness in the initial state.
    pub stiffness: Stiffness,
    /// Modulus of first loading over that of the initial state: 1 if they are equal, less otherwise.
    pub virgin_share: f64,
    /// Shear strength, Pa, of [`Law::VonMises`].
    pub strength: f64,
}

impl StressLaw {
    /// Stress, Pa, of a small strain in the initial state, with the volume that B-bar adds to it.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loops of every integrator")]
    pub fn elastic_stress<const D: usize>(&self, gradient: &Tensor<D>, dilation: f64) -> Tensor<D> {
        let mut stress = self.stiffness.stress(gradient);
        let shared = self.stiffness.shared_dilation_stress::<D>(dilation);
        for d in 0..D {
            stress[d][d] += shared;
        }
        stress
    }

    /// Updates the effective stress, Pa, at a point over a step, and the history if the law has one. `deformation` returns
    /// the deformation gradient since the start; only hyperelastic laws call it.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loops of every integrator")]
    pub fn update<const D: usize>(
        &self,
        stress: &mut Tensor<D>,
        history: &mut History,
        strain: &StrainIncrement<D>,
        deformation: impl Fn() -> Tensor<D>,
    ) {
        let (stresses, histories) = (array::from_mut(stress), array::from_mut(history));
        self.update_each(stresses, histories, array::from_ref(strain), |_| deformation());
    }

    /// [`update`](Self::update) for `N` points of the same soil at once; `deformation` takes the index of a point.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loops of every integrator")]
    pub fn update_each<const D: usize, const N: usize>(
        &self,
        stresses: &mut [Tensor<D>; N],
        histories: &mut [History; N],
        strains: &[StrainIncrement<D>; N],
        deformation: impl Fn(usize) -> Tensor<D>,
    ) {
        match self.stress {
            Stress::NeoHookean => {
                let mut ratios = [1.0; N];
                for point in 0..N {
                    ratios[point] = strains[point].volume_ratio[1];
                }
                let logarithms = elementary::ln_of_each(&ratios);
                for point in 0..N {
                    let deformation = deformation(point);
                    stresses[point] =
                        self.stiffness.neo_hookean_stress(&deformation, ratios[point], logarithms[point]);
                }
                return;
            }
            Stress::Yields(update) => {
                for point in 0..N {
                    let components = strains[point].components();
                    self.yielded(update, &mut stresses[point], &mut histories[point], &components);
                }
                return;
            }
            Stress::Rate(_) | Stress::Preconsolidated(_) => {}
        }
        let mut changes = [[[0.0; D]; D]; N];
        for point in 0..N {
            changes[point] = self.elastic_stress(&strains[point].gradient, strains[point].dilation);
        }
        match self.stress {
            Stress::Rate(Modulus::InverseOfVolume) => {
                for point in 0..N {
                    let [before, after] = strains[point].volume_ratio;
                    scale(&mut changes[point], 1.0 / (before * after).sqrt());
                }
            }
            Stress::Preconsolidated(secant_share) => {
                for point in 0..N {
                    let share = secant_share(
                        -stresses[point][D - 1][D - 1],
                        -changes[point][D - 1][D - 1],
                        self.virgin_share,
                        &mut histories[point].yield_stress,
                    );
                    scale(&mut changes[point], share);
                }
            }
            _ => {}
        }
        for point in 0..N {
            for i in 0..D {
                for j in 0..D {
                    stresses[point][i][j] += changes[point][i][j];
                }
            }
        }
    }
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "the innermost loops of every integrator")]
fn scale<const D: usize>(stress: &mut Tensor<D>, share: f64) {
    for component in stress.as_flattened_mut() {
        *component *= share;
    }
}

impl StressLaw {
    /// Updates stress and history of a point for a strain increment `xx, yy, zz, xy`, and returns the consistent tangent, Pa; none
    /// for laws that do not yield, which leave both as they are.
    pub fn update_plastic<const D: usize>(
        &self,
        stress: &mut Tensor<D>,
        history: &mut History,
        strain: &Components,
    ) -> Option<Tangent> {
        let Stress::Yields(update) = self.stress else { return None };
        Some(self.yielded(update, stress, history, strain))
    }

    fn yielded<const D: usize>(
        &self,
        update: PointUpdate,
        stress: &mut Tensor<D>,
        history: &mut History,
        strain: &Components,
    ) -> Tangent {
        let (up, zz) = (D - 1, history.lateral_stress);
        let before = if D == 1 {
            [zz, stress[up][up], zz, 0.0]
        } else {
            [stress[0][0], stress[up][up], zz, stress[0][up]]
        };
        let state =
            PointState { stress: before, plastic_strain: history.plastic_strain, ..PointState::default() };
        let (after, tangent) = update(&self.stiffness, self.strength, &state, strain);
        let [xx, yy, zz, xy] = after.stress;
        if D > 1 {
            (stress[0][0], stress[0][up], stress[up][0]) = (xx, xy, xy);
        }
        stress[up][up] = yy;
        (history.lateral_stress, history.plastic_strain) = (zz, after.plastic_strain);
        tangent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;

    #[test]
    fn a_preconsolidated_soil_is_stiff_up_to_its_largest_stress_whatever_the_steps() {
        let soil = Material {
            law: Law::Preconsolidated,
            reload_modulus: 4.8e6,
            preconsolidation: 3e4,
            ..Material::default()
        };
        // E_oed = 1.2 MPa: strains to 30 and on to 60 kPa, back to 20 and on to 80 kPa.
        let path = [3e4 / 4.8e6 + 3e4 / 1.2e6, -4e4 / 4.8e6, 4e4 / 4.8e6 + 2e4 / 1.2e6];
        for steps in [1, 7] {
            let mut history = History { yield_stress: soil.preconsolidation, ..History::default() };
            let mut stress = [[0.0; 2]; 2];
            for (strain, expected) in path.into_iter().zip([6e4, 2e4, 8e4]) {
                let mut gradient = [[0.0; 2]; 2];
                gradient[1][1] = -strain / f64::from(steps);
                let increment = StrainIncrement { gradient, dilation: 0.0, volume_ratio: [1.0; 2] };
                for _ in 0..steps {
                    soil.stress_law().update(&mut stress, &mut history, &increment, || gradient);
                }
                assert!((stress[1][1] + expected).abs() < 1e-8, "{steps}: {stress:?} for {expected}");
            }
            assert!((history.yield_stress - 8e4).abs() < 1e-8);
        }
    }

    #[test]
    fn the_published_modulus_belongs_to_engineering_strain() {
        // Under q/E_oed = 1/6 the two readings of Eq. 8 end apart: docs/theory.md, section 2.
        let end = |law: Law| {
            let (mut low, mut high): (f64, f64) = (0.5, 1.0);
            while high - low > 1e-15 {
                let middle = 0.5 * (low + high);
                if law.uniaxial_stress_ratio(middle - 1.0) < -1.0 / 6.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            1.0 - low
        };
        assert!((end(Law::Engineering) - 0.153_518_275_1).abs() < 1e-9);
        assert!((end(Law::PorosityDependent) - 1.0 / 7.0).abs() < 1e-9);
    }

    /// `∫ κ dσ'` by Gauss's rule of two points on many intervals of the stress.
    fn potential_by_quadrature(law: Law, compression: f64) -> f64 {
        let intervals = 400;
        let width = compression / f64::from(intervals);
        let mut sum = 0.0;
        for interval in 0..intervals {
            for along in [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8] {
                let stress = (f64::from(interval) + 0.5 + 0.5 * along) * width;
                sum -= 0.5 * width * law.mobility_ratio(1.0 + law.strain_under(stress));
            }
        }
        sum
    }

    #[test]
    fn the_potential_is_the_integral_of_the_mobility_over_the_stress() {
        for law in Law::for_columns() {
            for compression in [-0.2, 1e-6, 0.1, 0.7] {
                let strain = law.strain_under(compression);
                assert!((law.uniaxial_stress_ratio(strain) + compression).abs() < 1e-15, "{law:?}");
                let exact = potential_by_quadrature(law, compression);
                assert!(
                    (law.flow_potential(strain) - exact).abs() < 1e-12 * exact.abs(),
                    "{law:?} {compression}"
                );
            }
        }
    }

    #[test]
    fn the_chord_of_the_published_material_is_the_logarithmic_mean() {
        // J from 1 to 1/2: 0.721 where the mean of the drags is 0.667.
        let law = Law::LogLinear;
        let chord = law.flow_potential(-0.5) / law.uniaxial_stress_ratio(-0.5);
        assert!((chord - 0.721_347_520_444_481_7).abs() < 1e-15);
    }

    proptest::proptest! {
        #[test]
        fn the_rate_form_integrates_to_the_closed_form(end in 0.6..1.4_f64) {
            let steps = 20_000;
            let strain = end.ln() / f64::from(steps);
            for law in Law::for_columns() {
                let (mut ratio, mut stress) = (1.0, 0.0);
                for _ in 0..steps {
                    let before = ratio;
                    ratio *= strain.exp();
                    stress += law.modulus_ratio(before, ratio) * strain;
                }
                let closed = law.uniaxial_stress_ratio(end - 1.0);
                proptest::prop_assert!((stress - closed).abs() < 1e-9, "{law:?}: {stress} for {closed}");
            }
        }
    }
}
