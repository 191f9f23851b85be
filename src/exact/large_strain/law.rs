//! Soil laws at large strain, and the coefficients they give the diffusion of pressure.

use core::fmt;
use core::str::FromStr;

use crate::elementary;
use crate::exact::error::{ExactError, positive};
use crate::exact::parameters::ColumnParameters;

/// Relation of vertical effective stress and conductivity to the volume ratio `J`.
///
/// `σ'` is Cauchy's, tension positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum SoilLaw {
    /// Small strain: `σ' = E_oed (J − 1)`, constant `k`, geometry and porosity as at the start.
    Linear,
    /// `σ' = E_oed ln J`, `k = k_0 J²`: the material of Xie & Leo (2004).
    #[default]
    LogLinear,
    /// `E = E_0/J` in the rate form `dσ' = E dJ/J`, so `σ' = E_oed (1 − 1/J)`, and `k = k_0 J²`
    /// (Zheng et al. 2021, Eqs 7 and 8, taken as rates).
    PorosityDependent,
    /// The same `E = E_0/J` with the engineering strain that it belongs to, `dσ' = E dJ`: again
    /// `σ' = E_oed ln J`, and `k = k_0 J²`, the material of Xie & Leo by another way.
    Engineering,
}

/// How the water's continuity treats a porosity that varies in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Continuity {
    /// `ṗ = −(K_w/n) [∇·v_s + ∇·(n(v_w − v_s))]`.
    #[default]
    Conservative,
    /// `ṗ = −(K_w/n) [(1 − n)∇·v_s + n∇·v_w]`, which drops `(v_w − v_s)·∇n`
    /// (Zheng et al. 2021, Eq. 6).
    ConstantPorosityGradient,
}

/// Whether the water itself can be compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Water {
    /// With the bulk modulus `K_w` of the column.
    #[default]
    Compressible,
    /// `K_w → ∞`.
    Incompressible,
}

/// What a large-strain reference solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct LargeStrainModel {
    /// Law of the skeleton and its conductivity.
    pub law: SoilLaw,
    /// Form of the water's continuity.
    pub continuity: Continuity,
    /// Compressibility of the water.
    pub water: Water,
}

/// Names of an enumeration in study files, both ways.
macro_rules! names {
    ($kind:ident { $($variant:ident => $name:literal),+ $(,)? }) => {
        impl $kind {
            /// All of them, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Name in study files.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }
        }

        impl fmt::Display for $kind {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.pad(self.name())
            }
        }

        impl FromStr for $kind {
            type Err = ExactError;

            fn from_str(name: &str) -> Result<Self, ExactError> {
                match name {
                    $($name => Ok(Self::$variant),)+
                    other => Err(ExactError::UnknownModel(other.to_owned())),
                }
            }
        }
    };
}

names!(SoilLaw {
    Linear => "linear",
    LogLinear => "log-linear",
    PorosityDependent => "porosity-dependent",
    Engineering => "engineering",
});
names!(Continuity {
    Conservative => "conservative",
    ConstantPorosityGradient => "constant-porosity-gradient",
});
names!(Water {
    Compressible => "compressible",
    Incompressible => "incompressible",
});

/// Everything in units of the column: pressure `r = p/q`, depth over `H`, time as `T_v`, stress
/// over `E_oed`.
#[derive(Clone, Copy, Debug)]
pub struct Diffusion {
    model: LargeStrainModel,
    /// `m = q/E_oed`.
    load: f64,
    porosity: f64,
    /// `E_oed/K_w`, 0 for incompressible water.
    compliance: f64,
}

/// Coefficients of `β r_T = r_ζζ − G r_ζ² + β_s λ_T` under the share `λ` of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Storage over conductance, `β = (E_oed/(dσ'/dJ) + nJ E_oed/K_w)/κ` with `κ = k/(k_0 J)`.
    pub storage: f64,
    /// The skeleton's part of it, `β_s`, the first term.
    pub skeleton_storage: f64,
    /// `G = [−κ_J/κ + n_J/n] dJ/dr`, the last term with (4') only.
    pub steepening: f64,
}

impl Diffusion {
    /// The diffusion of a column's pressure under `share` of its load.
    ///
    /// # Errors
    /// When the parameters are impossible or the load would close the pores.
    pub fn new(model: LargeStrainModel, column: &ColumnParameters, share: f64) -> Result<Self, ExactError> {
        column.validate()?;
        let load =
            positive("load over the oedometric modulus", share * column.load / column.oedometric_modulus())?;
        let compliance = match model.water {
            Water::Compressible => column.oedometric_modulus() / column.water_bulk_modulus,
            Water::Incompressible => 0.0,
        };
        let diffusion = Self { model, load, porosity: column.porosity, compliance };
        let shrinkage = diffusion.shrinkage(0.0);
        if model.law != SoilLaw::Linear && shrinkage >= column.porosity {
            return Err(ExactError::PoresClose { shrinkage, porosity: column.porosity });
        }
        Ok(diffusion)
    }

    /// `1 − J` where the skeleton lacks the share `lacking` of the full load, `σ' = q(lacking − 1)`:
    /// the pressure ratio under the full load.
    pub fn shrinkage(&self, lacking: f64) -> f64 {
        let compression = self.load * (1.0 - lacking);
        match self.model.law {
            SoilLaw::LogLinear | SoilLaw::Engineering => -elementary::exp_m1(-compression),
            SoilLaw::PorosityDependent => compression / (1.0 + compression),
            SoilLaw::Linear => compression,
        }
    }

    /// Coefficients where the skeleton lacks the share `lacking` of the full load.
    pub fn coefficients(&self, lacking: f64) -> Coefficients {
        let volume = 1.0 - self.shrinkage(lacking);
        // dσ'/dJ over E_oed, k/(k_0 J) and its logarithmic derivative.
        let (tangent, conductance, growth) = match self.model.law {
            SoilLaw::Linear => {
                return Coefficients {
                    storage: 1.0 + self.porosity * self.compliance,
                    skeleton_storage: 1.0,
                    steepening: 0.0,
                };
            }
            SoilLaw::LogLinear | SoilLaw::Engineering => (volume.recip(), volume, volume.recip()),
            SoilLaw::PorosityDependent => ((volume * volume).recip(), volume, volume.recip()),
        };
        let pores = volume - (1.0 - self.porosity);
        let dropped = match self.model.continuity {
            Continuity::Conservative => 0.0,
            Continuity::ConstantPorosityGradient => (1.0 - self.porosity) / (volume * pores),
        };
        Coefficients {
            storage: (tangent.recip() + pores * self.compliance) / conductance,
            skeleton_storage: (tangent * conductance).recip(),
            steepening: (dropped - growth) * self.load / tangent,
        }
    }

    /// Pressure ratio of the undrained start: `p_0 = −K_w ln(1 − (1 − J_0)/n_0) = q + σ'(J_0)`,
    /// at small strain `B`.
    pub fn undrained_ratio(&self) -> f64 {
        if self.model.law == SoilLaw::Linear {
            return 1.0 / (1.0 + self.porosity * self.compliance);
        }
        // Bisection: the water's pressure falls and the total one grows with r. Enough to be exact.
        let (mut low, mut high) = (0.0, 1.0);
        if self.compliance == 0.0 {
            return high;
        }
        while {
            let middle = 0.5 * (low + high);
            let water = -elementary::ln_1p(-self.shrinkage(middle) / self.porosity) / self.compliance;
            if water > self.load * middle {
                low = middle;
            } else {
                high = middle;
            }
            high - low > f64::EPSILON * high
        } {}
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diffusion(law: SoilLaw) -> Diffusion {
        let column = ColumnParameters { load: 2.0e5, ..ColumnParameters::default() };
        let model = LargeStrainModel { law, ..LargeStrainModel::default() };
        Diffusion::new(model, &column, 1.0).unwrap()
    }

    #[test]
    fn laws_end_where_they_should() {
        let end = |law| diffusion(law).shrinkage(0.0);
        assert!((end(SoilLaw::LogLinear) - 0.153_518_275_109_386).abs() < 1e-15);
        assert!((end(SoilLaw::PorosityDependent) - 1.0 / 7.0).abs() < 1e-15);
        assert_eq!(end(SoilLaw::Engineering), end(SoilLaw::LogLinear));
    }

    #[test]
    fn coefficients_are_the_laws_derivatives() {
        // −dJ/dr = d(shrinkage)/dr must be −q/(dσ'/dJ), which storage at compliance 0 holds.
        for &law in SoilLaw::ALL {
            let diffusion = Diffusion { compliance: 0.0, ..diffusion(law) };
            let step = 1e-6;
            let slope = (diffusion.shrinkage(0.4 + step) - diffusion.shrinkage(0.4 - step)) / (2.0 * step);
            let conductance = match law {
                SoilLaw::Linear => 1.0,
                _ => 1.0 - diffusion.shrinkage(0.4),
            };
            let storage = diffusion.coefficients(0.4).storage;
            assert!((-slope / diffusion.load / conductance - storage).abs() < 1e-9);
        }
    }

    #[test]
    fn undrained_start_is_nearly_the_storage_ratio() {
        let column = ColumnParameters::default();
        for &law in SoilLaw::ALL {
            let ratio = diffusion(law).undrained_ratio();
            assert!((ratio - column.storage_ratio()).abs() < 1e-4, "{ratio}");
        }
    }

    #[test]
    fn names_parse_back_and_closing_pores_are_refused() {
        for &law in SoilLaw::ALL {
            assert_eq!(law.name().parse(), Ok(law));
        }
        for &continuity in Continuity::ALL {
            assert_eq!(continuity.name().parse(), Ok(continuity));
        }
        assert!("compressed".parse::<Water>().is_err());
        let column = ColumnParameters { load: 6.0e5, ..ColumnParameters::default() };
        let error = Diffusion::new(LargeStrainModel::default(), &column, 1.0).unwrap_err();
        assert!(error.to_string().contains("more water than the pores hold"), "{error}");
    }
}
