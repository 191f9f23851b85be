//! Isotropic elasticity: the stiffness that every law of the skeleton starts from.

use crate::plasticity::{Components, MULTIPLICITY, PointLaw, PointState, Tangent, UNIT, mean};
use crate::tensor::{Tensor, product_with_transpose};

/// Isotropic elastic stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Lamé's first parameter `λ`, Pa.
    pub lame: f64,
    /// Shear modulus `G`, Pa.
    pub shear: f64,
}

impl Stiffness {
    /// Stress `λ tr(ε) I + 2 G ε` of a small strain, with `ε` the symmetric part of the displacement gradient; the strain
    /// is zero in directions beyond `D`.
    #[inline]
    pub fn stress<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D> {
        let volumetric: f64 = (0..D).map(|d| gradient[d][d]).sum();
        let mut stress = [[0.0; D]; D];
        for i in 0..D {
            for j in 0..D {
                stress[i][j] = self.shear * (gradient[i][j] + gradient[j][i]);
            }
            stress[i][i] += self.lame * volumetric;
        }
        stress
    }

    /// Neo-Hookean Cauchy stress `[μ (F Fᵀ − I) + λ ln J I]/J` of a deformation gradient, its determinant and the
    /// determinant's logarithm, in plane strain (docs/theory.md, Eq. 28).
    #[inline]
    pub fn neo_hookean_stress<const D: usize>(
        &self,
        deformation: &Tensor<D>,
        volume_ratio: f64,
        log_volume: f64,
    ) -> Tensor<D> {
        let left = product_with_transpose(deformation, deformation);
        let volumetric = self.lame * log_volume - self.shear;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let kirchhoff = self.shear * left[i][j] + if i == j { volumetric } else { 0.0 };
                kirchhoff / volume_ratio
            })
        })
    }

    /// Normal stress that the gradient `(b/D) I` of B-bar lacks: the volume `b` that B-bar adds to a
    /// strain is shared by three directions, `b/3` each (Hughes 1980, Eq. 12), in whatever dimension
    /// the problem is solved.
    #[inline]
    pub fn shared_dilation_stress<const D: usize>(&self, dilation: f64) -> f64 {
        2.0 * self.shear * dilation * (1.0 / 3.0 - 1.0 / D as f64)
    }

    /// Bulk modulus, Pa.
    #[inline]
    pub fn bulk(&self) -> f64 {
        self.lame + 2.0 / 3.0 * self.shear
    }

    /// Stress components of elastic strain components, Pa.
    #[inline]
    pub fn component_stress(&self, strain: &Components) -> Components {
        let volumetric = 3.0 * self.lame * mean(strain);
        std::array::from_fn(|i| 2.0 * self.shear * strain[i] + volumetric * UNIT[i])
    }

    /// `K 1 ⊗ 1 + 2 G (shear_share I_dev − direction_share n ⊗ n)` for a unit deviator `n`: the tangent of every isotropic
    /// law whose plastic flow is isochoric. The shares 1 and 0 give the elastic tangent.
    #[inline]
    pub fn tangent(&self, shear_share: f64, direction_share: f64, direction: &Components) -> Tangent {
        let (bulk, twice_shear) = (self.bulk(), 2.0 * self.shear);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let kept = if i == j { 1.0 } else { 0.0 };
                let deviatoric = kept - UNIT[i] * UNIT[j] / 3.0;
                let along = direction[i] * direction[j] * MULTIPLICITY[j];
                bulk * UNIT[i] * UNIT[j] + twice_shear * (shear_share * deviatoric - direction_share * along)
            })
        })
    }
}

/// An elastic soil, which has no history.
impl PointLaw for Stiffness {
    #[inline]
    fn update(&self, state: &PointState, strain: &Components) -> (PointState, Tangent) {
        let change = self.component_stress(strain);
        let stress = std::array::from_fn(|i| state.stress[i] + change[i]);
        (PointState { stress, ..*state }, self.tangent(1.0, 0.0, &[0.0; 4]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;

    #[test]
    fn a_uniaxial_strain_meets_the_oedometric_modulus() {
        let soil = Material { poissons_ratio: 0.31, ..Material::default() };
        let expected = soil.oedometric_modulus() * 1e-3;
        assert!((soil.stiffness().stress(&[[1e-3]])[0][0] / expected - 1.0).abs() < 1e-14);
        let plane = soil.stiffness().stress(&[[0.0, 0.0], [0.0, 1e-3]]);
        assert!((plane[1][1] / expected - 1.0).abs() < 1e-14);
        let lateral = plane[0][0] / plane[1][1];
        assert!((lateral - 0.31 / 0.69).abs() < 1e-14, "earth pressure at rest ν/(1−ν)");
    }

    #[test]
    fn a_neo_hookean_stress_turns_with_the_body_and_is_hookes_at_small_strain() {
        let stiffness = Stiffness { lame: 0.7, shear: 0.4 };
        // Uniaxial: σ_yy = [μ (J² − 1) + λ ln J]/J and σ_xx = λ ln J/J.
        let ratio = 0.8_f64;
        let stress = stiffness.neo_hookean_stress(&[[1.0, 0.0], [0.0, ratio]], ratio, ratio.ln());
        assert!((stress[1][1] - (0.4 * (ratio * ratio - 1.0) + 0.7 * ratio.ln()) / ratio).abs() < 1e-15);
        assert!((stress[0][0] - 0.7 * ratio.ln() / ratio).abs() < 1e-15);
        // Turned by 90° after the stretch, the stresses change places.
        let turned = stiffness.neo_hookean_stress(&[[0.0, -ratio], [1.0, 0.0]], ratio, ratio.ln());
        assert!((turned[0][0] - stress[1][1]).abs() < 1e-15 && (turned[1][1] - stress[0][0]).abs() < 1e-15);
        let small = [[1e-7, 3e-7], [-1e-7, 2e-7]];
        let deformation = [[1.0 + 1e-7, 3e-7], [-1e-7, 1.0 + 2e-7]];
        let determinant = deformation[0][0] * deformation[1][1] - deformation[0][1] * deformation[1][0];
        let (finite, hookes) = (
            stiffness.neo_hookean_stress(&deformation, determinant, determinant.ln()),
            stiffness.stress(&small),
        );
        for (finite, hookes) in finite.iter().flatten().zip(hookes.iter().flatten()) {
            assert!((finite - hookes).abs() < 1e-12, "{finite} for {hookes}");
        }
    }
}
