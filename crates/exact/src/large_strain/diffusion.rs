//! The coefficients that a soil's law and continuity give the diffusion of pressure at large strain
//! (docs/theory.md, Eq. 15), and how the load comes on: at once, or linearly over a time.

use crate::exact_error::{ExactError, positive};
use crate::numerics::bisected;
use crate::parameters::ColumnParameters;
pub use crate::parameters::Water;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::elementary;
use oedometer_soil::law::Law;

/// Step in `p/q` of the differences that Newton's matrices are made of.
const STEP: f64 = 1e-5;

/// What a large-strain reference solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LargeStrainModel {
    /// Law of the skeleton and its conductivity.
    pub law: Law,
    /// Form of the water's continuity.
    pub continuity: Continuity,
    /// Compressibility of the water.
    pub water: Water,
}

impl LargeStrainModel {
    /// The material of Xie & Leo in water that can be compressed.
    pub const XIE_LEO: Self =
        Self { law: Law::LogLinear, continuity: Continuity::Conservative, water: Water::Compressible };
}

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

impl Diffusion {
    /// The diffusion of a column's pressure under `share` of its load.
    ///
    /// # Errors
    /// When the parameters are impossible or the load would close the pores.
    pub fn new(model: LargeStrainModel, column: &ColumnParameters, share: f64) -> Result<Self, ExactError> {
        column.validate()?;
        if !model.law.is_for_columns() {
            return Err(ExactError::LawOfColumn { law: model.law.name() });
        }
        let load = positive(
            "load over the oedometric modulus",
            share * column.load / column.soil.oedometric_modulus(),
        )?;
        let compliance = match model.water {
            Water::Compressible => column.soil.oedometric_modulus() / column.soil.water_bulk_modulus,
            Water::Incompressible => 0.0,
        };
        let diffusion = Self { model, load, porosity: column.soil.porosity, compliance };
        let shrinkage = diffusion.shrinkage(0.0);
        if model.law != Law::Linear && shrinkage >= column.soil.porosity {
            return Err(ExactError::PoresClose { shrinkage, porosity: column.soil.porosity });
        }
        Ok(diffusion)
    }

    /// `1 − J` where the skeleton lacks the share `lacking` of the full load, `σ' = q(lacking − 1)`:
    /// the pressure ratio under the full load.
    pub fn shrinkage(&self, lacking: f64) -> f64 {
        self.model.law.shrinkage(self.load * (1.0 - lacking))
    }

    /// `C`, `C_s` and `κ` of `C r_T − C_s λ_T = (κ r_ζ)_ζ` where the skeleton lacks the share `lacking` of the full load:
    /// storage of skeleton and water, and of the skeleton alone, over the compliance of the unstrained skeleton, and the
    /// conductance `k/(k_0 J)`. Where the gradient of the porosity is dropped all three are over the porosity, which stands
    /// within the divergence then.
    pub fn coefficients(&self, lacking: f64) -> [f64; 3] {
        if self.model.law == Law::Linear {
            return [1.0 + self.porosity * self.compliance, 1.0, 1.0];
        }
        let volume = 1.0 - self.shrinkage(lacking);
        // dσ'/dJ over E_oed, of the modulus against dJ/J.
        let tangent = self.model.law.modulus_ratio(volume, volume) / volume;
        let pores = volume - (1.0 - self.porosity);
        let divided = match self.model.continuity {
            Continuity::Conservative => 1.0,
            Continuity::ConstantPorosityGradient => self.porosity * volume / pores,
        };
        // k = k_0 J² of every law for columns but the linear one.
        [divided * (tangent.recip() + pores * self.compliance), divided / tangent, divided * volume]
    }

    /// The coefficients, and how they change with the share that the skeleton lacks: for Newton's matrices.
    pub fn with_slopes(&self, lacking: f64) -> [[f64; 3]; 2] {
        let (before, after) = (self.coefficients(lacking - STEP), self.coefficients(lacking + STEP));
        let slope = |i: usize| (after[i] - before[i]) / (2.0 * STEP);
        [self.coefficients(lacking), [slope(0), slope(1), slope(2)]]
    }

    /// Pressure ratio of the undrained start: `p_0 = −K_w ln(1 − (1 − J_0)/n_0) = q + σ'(J_0)`,
    /// at small strain `B`.
    pub fn undrained_ratio(&self) -> f64 {
        if self.model.law == Law::Linear {
            return 1.0 / (1.0 + self.porosity * self.compliance);
        }
        if self.compliance == 0.0 {
            return 1.0;
        }
        // The water's pressure falls and the total one grows with r.
        bisected(0.0, 1.0, |ratio| {
            self.load * ratio + elementary::ln_1p(-self.shrinkage(ratio) / self.porosity) / self.compliance
        })
    }
}

/// Growth of the load, in units of the time factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loading {
    /// Time factor at which the load is full; 0 where it acts at once.
    duration: f64,
}

/// The load at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadAt {
    /// Share of the full load that does not act yet, `1 − λ`.
    pub absent: f64,
    /// `dλ/dT_v`.
    pub rate: f64,
}

/// Steps begin as if this share of the loading had passed since the growth last changed.
const FIRST_AGE: f64 = 1e-6;

impl Loading {
    /// A load that is full at the time factor `duration`.
    pub fn over(duration: f64) -> Self {
        Self { duration }
    }

    /// Whether it takes time.
    pub fn is_gradual(self) -> bool {
        self.duration > 0.0
    }

    /// Share `λ` of the full load at a time factor.
    pub fn share(self, time_factor: f64) -> f64 {
        if time_factor < self.duration { time_factor / self.duration } else { 1.0 }
    }

    /// `dλ/dT_v` from a time factor on.
    pub fn rate(self, time_factor: f64) -> f64 {
        if time_factor < self.duration { self.duration.recip() } else { 0.0 }
    }

    /// The load `later` after a time factor, with the growth that it has there: a step may end where
    /// the growth does.
    pub fn within_step(self, time_factor: f64, later: f64) -> LoadAt {
        LoadAt { absent: 1.0 - self.share(time_factor + later), rate: self.rate(time_factor) }
    }

    /// The time factor strictly between two at which the growth changes.
    pub fn kink_between(self, from: f64, to: f64) -> Option<f64> {
        (from < self.duration && self.duration < to).then_some(self.duration)
    }

    /// Time since the growth last changed, from which the size of a step follows.
    pub fn age(self, time_factor: f64) -> f64 {
        let since = if time_factor < self.duration { 0.0 } else { self.duration };
        (time_factor - since).max(FIRST_AGE * self.duration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diffusion(law: Law) -> Diffusion {
        let column = ColumnParameters { load: 2.0e5, ..ColumnParameters::default() };
        let model = LargeStrainModel { law, ..LargeStrainModel::XIE_LEO };
        Diffusion::new(model, &column, 1.0).unwrap()
    }

    #[test]
    fn laws_end_where_they_should() {
        let end = |law| diffusion(law).shrinkage(0.0);
        assert!((end(Law::LogLinear) - 0.153_518_275_109_386).abs() < 1e-15);
        assert!((end(Law::PorosityDependent) - 1.0 / 7.0).abs() < 1e-15);
        assert_eq!(end(Law::Engineering), end(Law::LogLinear));
    }

    #[test]
    fn coefficients_are_the_laws_derivatives() {
        // −dJ/dr = d(shrinkage)/dr must be −q/(dσ'/dJ), which storage at compliance 0 holds.
        for law in Law::for_columns() {
            let diffusion = Diffusion { compliance: 0.0, ..diffusion(law) };
            let step = 1e-6;
            let slope = (diffusion.shrinkage(0.4 + step) - diffusion.shrinkage(0.4 - step)) / (2.0 * step);
            let [storage, skeleton, _] = diffusion.coefficients(0.4);
            assert!((-slope / diffusion.load - storage).abs() < 1e-9 && storage == skeleton);
        }
    }

    #[test]
    fn undrained_start_is_nearly_the_storage_ratio() {
        let column = ColumnParameters::default();
        for law in Law::for_columns() {
            let ratio = diffusion(law).undrained_ratio();
            assert!((ratio - column.storage_ratio()).abs() < 1e-4, "{ratio}");
        }
    }

    #[test]
    fn closing_pores_are_refused() {
        let column = ColumnParameters { load: 6.0e5, ..ColumnParameters::default() };
        let error = Diffusion::new(LargeStrainModel::XIE_LEO, &column, 1.0).unwrap_err();
        assert!(error.to_string().contains("more water than the pores hold"), "{error}");
    }

    #[test]
    fn a_load_grows_to_its_full_value_and_stays() {
        let loading = Loading::over(0.2);
        assert!(loading.is_gradual() && !Loading::over(0.0).is_gradual());
        assert_eq!([0.0, 0.05, 0.2, 7.0].map(|time| loading.share(time)), [0.0, 0.25, 1.0, 1.0]);
        assert_eq!(Loading::over(0.0).share(0.0), 1.0);
        // The last stage of a step that ends with the growth still has it.
        assert_eq!(loading.within_step(0.1, 0.1), LoadAt { absent: 0.0, rate: 5.0 });
        assert_eq!(loading.within_step(0.2, 0.1), LoadAt { absent: 0.0, rate: 0.0 });
        assert_eq!(loading.kink_between(0.0, 0.3), Some(0.2));
        assert_eq!(loading.kink_between(0.0, 0.2), None);
        assert!((loading.age(0.25) - 0.05).abs() < 1e-15 && loading.age(0.0) > 0.0);
    }
}
