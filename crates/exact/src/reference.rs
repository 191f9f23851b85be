//! Entry point: a reference by its name, with its fields by time factor and depth.

use core::fmt;
use core::str::FromStr;
use std::sync::Arc;

use crate::cosine_layer::{self, CosineLayer, LayerState};
use crate::dynamic_column::{self, DynamicColumn, Start};
use crate::exact_error::{ExactError, checked_time_factor};
use crate::footing::{self, Footing};
use crate::inputs::{AddedKey, WEIGHT_STRESS_KEYS};
use crate::large_strain::diffusion::LargeStrainModel;
use crate::large_strain::{self, LargeStrain};
use crate::layered::{self, LayeredColumn};
use crate::mandel::{self, Mandel};
use crate::manufactured::motion::{ManufacturedModel, Motion};
use crate::manufactured::{self, Manufactured};
use crate::mirrored::Mirrored;
use crate::parameters::{ColumnParameters, Drainage, Water};
use crate::row::Row;
use crate::single_mode::{self, SingleMode};
use crate::solution::{Accuracy, FieldValues, Solution};
use crate::terzaghi::{self, Terzaghi};
use crate::textbook::TextbookProblem;
use crate::unchanging::{self, Unchanging};
use crate::xie_leo::{self, XieLeo};
use crate::yield_front::{self, YieldFront};
use oedometer_soil::material::Material;

/// Which exact solution a run is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ReferenceKind {
    /// Terzaghi's column with compressible water.
    Terzaghi,
    /// Terzaghi's column of the textbooks, with incompressible water.
    TerzaghiIncompressible,
    /// Decay of the slowest mode, with compressible water.
    SingleMode,
    /// Large strain after Xie & Leo, with incompressible water.
    XieLeo,
    /// Terzaghi's column with compressible water and the inertia of both phases, the load at once or
    /// over the column's loading time.
    DynamicColumn,
    /// The slowest mode with compressible water and the inertia of both phases.
    DynamicSingleMode,
    /// An undrained wave that stands in the column, with the inertia of both phases: smooth.
    StandingWave,
    /// Large strain for a soil law, a continuity and a water of choice.
    LargeStrain(LargeStrainModel),
    /// Plane-strain layer under a cosine load, with compressible water.
    CosineLayer,
    /// Plane-strain layer under a cosine load, with incompressible water.
    CosineLayerIncompressible,
    /// Mandel's slab between rigid plates, with compressible water.
    Mandel,
    /// Nothing moves.
    AtRest,
    /// A column of layers, with compressible water.
    Layered,
    /// A yield front in a preconsolidated column, with compressible water.
    YieldFront,
    /// A column that no water leaves.
    SealedElement,
    /// A strip footing on undrained soil at collapse.
    Footing,
    /// A motion in the plane that is exact because body forces and a source make it so.
    Manufactured(ManufacturedModel),
    /// A problem that no scene solves.
    Textbook(TextbookProblem),
}

impl ReferenceKind {
    /// All kinds that a scene solves, in the order of the documentation; large strain and motions with their default
    /// models. [`TextbookProblem::ALL`] has the others.
    pub const ALL: [Self; 19] = [
        Self::Terzaghi,
        Self::TerzaghiIncompressible,
        Self::SingleMode,
        Self::XieLeo,
        Self::DynamicColumn,
        Self::DynamicSingleMode,
        Self::StandingWave,
        Self::LargeStrain(LargeStrainModel::XIE_LEO),
        Self::CosineLayer,
        Self::CosineLayerIncompressible,
        Self::Mandel,
        Self::AtRest,
        Self::Layered,
        Self::YieldFront,
        Self::SealedElement,
        Self::Footing,
        Self::Manufactured(ManufacturedModel::with_default_law(Motion::Box)),
        Self::Manufactured(ManufacturedModel::with_default_law(Motion::Shear)),
        Self::Manufactured(ManufacturedModel::with_default_law(Motion::Vortex)),
    ];

    /// What is known of the solution whatever its parameters, and whatever the model.
    pub const fn row(self) -> &'static Row {
        match self {
            Self::Terzaghi => &terzaghi::TERZAGHI,
            Self::TerzaghiIncompressible => &terzaghi::TERZAGHI_INCOMPRESSIBLE,
            Self::SingleMode => &single_mode::SINGLE_MODE,
            Self::XieLeo => &xie_leo::XIE_LEO,
            Self::DynamicColumn => &dynamic_column::DYNAMIC_COLUMN,
            Self::DynamicSingleMode => &dynamic_column::DYNAMIC_SINGLE_MODE,
            Self::StandingWave => &dynamic_column::STANDING_WAVE,
            Self::LargeStrain(_) => &large_strain::LARGE_STRAIN,
            Self::CosineLayer => &cosine_layer::COSINE_LAYER,
            Self::CosineLayerIncompressible => &cosine_layer::COSINE_LAYER_INCOMPRESSIBLE,
            Self::Mandel => &mandel::MANDEL,
            Self::AtRest => &unchanging::AT_REST,
            Self::Layered => &layered::LAYERED,
            Self::YieldFront => &yield_front::YIELD_FRONT,
            Self::SealedElement => &unchanging::SEALED_ELEMENT,
            Self::Footing => &footing::FOOTING,
            Self::Manufactured(model) => &manufactured::ROWS[model.motion as usize],
            Self::Textbook(problem) => problem.row(),
        }
    }

    /// Name in study files and tables; the same for large strain with any model.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Study keys that affect the solution, by their names without tables; some only with self-weight.
    pub fn inputs(self, has_weight: bool) -> Vec<&'static str> {
        let of_weight = if has_weight { WEIGHT_STRESS_KEYS } else { &[] };
        self.row().inputs.iter().copied().flatten().chain(of_weight).copied().collect()
    }

    /// Whether the solution reads a key that no scene has.
    pub fn takes(self, added: &AddedKey) -> bool {
        matches!(self, Self::Textbook(_) | Self::Mandel) && self.inputs(false).contains(&added.name())
    }

    /// Whether a time in seconds belongs to a time factor.
    pub fn has_time(self) -> bool {
        self.inputs(false).iter().any(|name| ["hydraulic_conductivity", "frequency"].contains(name))
    }

    /// All kinds, with those that no scene solves.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().chain(TextbookProblem::ALL.map(Self::Textbook))
    }

    /// Whether the solution is a prescribed motion instead of a body under a load.
    pub const fn is_manufactured(self) -> bool {
        matches!(self, Self::Manufactured(_))
    }

    /// The reference for a soil: large strain takes the law and the continuity of the soil, so that it solves the equations
    /// of the solver; a motion takes the law.
    #[must_use]
    pub fn for_soil(self, soil: &Material) -> Self {
        let Material { law, continuity, .. } = *soil;
        match self {
            Self::LargeStrain(model) => Self::LargeStrain(LargeStrainModel { law, continuity, ..model }),
            Self::Manufactured(model) => Self::Manufactured(ManufacturedModel { law, ..model }),
            other => other,
        }
    }
}

impl fmt::Display for ReferenceKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for ReferenceKind {
    type Err = ExactError;

    fn from_str(name: &str) -> Result<Self, ExactError> {
        Self::all()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| ExactError::UnknownReference(name.to_owned()))
    }
}

/// A solution in the plane.
#[derive(Clone, Copy, Debug)]
enum Plane {
    Layer(CosineLayer),
    Motion(Manufactured),
}

/// An exact solution for one set of parameters.
#[derive(Clone, Debug)]
pub struct Reference {
    kind: ReferenceKind,
    solution: Arc<dyn Solution>,
    /// The solution itself, where its fields vary along a layer too.
    plane: Option<Plane>,
    /// Vertical effective stress of the weight at the base, Pa; it grows with the depth.
    initial_stress: f64,
}

/// The solution of a column of one soil that a function solves on an impermeable base, with the drainage of the column.
fn drained<S: Solution + 'static>(
    parameters: &ColumnParameters,
    solve: impl FnOnce(&ColumnParameters) -> Result<S, ExactError>,
) -> Result<Arc<dyn Solution>, ExactError> {
    Ok(match parameters.drainage {
        Drainage::Top => Arc::new(solve(parameters)?),
        Drainage::Both if parameters.soils.is_empty() => Arc::new(Mirrored::new(parameters, solve)?),
        Drainage::Both => {
            return Err(ExactError::Layers(
                "that is drained at both ends is not symmetric, and has a solution only at small strain: \
                 use the problem `layered`",
            ));
        }
    })
}

impl Reference {
    /// The reference `kind` of a column; references that must be computed in advance are computed for `time_factors`.
    ///
    /// # Errors
    /// When the parameters are impossible or outside the solution's range, or a time factor is
    /// negative or not finite.
    pub fn new(
        kind: ReferenceKind,
        parameters: &ColumnParameters,
        time_factors: &[f64],
    ) -> Result<Self, ExactError> {
        for &time_factor in time_factors {
            checked_time_factor(time_factor)?;
        }
        if parameters.drainage == Drainage::Both && !kind.inputs(false).contains(&"drainage") {
            return Err(ExactError::Drainage(kind.name()));
        }
        let mut plane = None;
        let mut layer = |water| -> Result<Arc<dyn Solution>, ExactError> {
            let layer = CosineLayer::new(parameters, parameters.length, parameters.base, water)?;
            plane = Some(Plane::Layer(layer));
            Ok(Arc::new(layer))
        };
        let dynamic = |start| DynamicColumn::new(parameters, start, time_factors);
        let solution: Arc<dyn Solution> = match kind {
            ReferenceKind::Terzaghi => drained(parameters, Terzaghi::compressible)?,
            ReferenceKind::TerzaghiIncompressible => drained(parameters, Terzaghi::incompressible)?,
            ReferenceKind::SingleMode => Arc::new(SingleMode::compressible(parameters)?),
            ReferenceKind::XieLeo => drained(parameters, XieLeo::new)?,
            ReferenceKind::DynamicColumn => Arc::new(dynamic(match parameters.loading_time {
                0.0 => Start::Step,
                duration => Start::Ramp { duration },
            })?),
            ReferenceKind::DynamicSingleMode => Arc::new(dynamic(Start::Mode)?),
            ReferenceKind::StandingWave => Arc::new(dynamic(Start::StandingWave)?),
            ReferenceKind::LargeStrain(model) => {
                drained(parameters, |column| LargeStrain::new(column, model, time_factors))?
            }
            ReferenceKind::CosineLayer => layer(Water::Compressible)?,
            ReferenceKind::CosineLayerIncompressible => layer(Water::Incompressible)?,
            ReferenceKind::Mandel => Arc::new(Mandel::new(parameters)?),
            ReferenceKind::AtRest => Arc::new(Unchanging::at_rest(parameters)?),
            ReferenceKind::Layered => Arc::new(LayeredColumn::from_parameters(parameters)?),
            ReferenceKind::YieldFront => Arc::new(YieldFront::new(parameters)?),
            ReferenceKind::SealedElement => Arc::new(Unchanging::sealed(parameters)?),
            ReferenceKind::Footing => Arc::new(Footing::new(parameters)?),
            ReferenceKind::Manufactured(model) => {
                let motion = Manufactured::new(model, parameters)?;
                plane = Some(Plane::Motion(motion));
                Arc::new(motion)
            }
            ReferenceKind::Textbook(problem) => problem.solution(parameters)?,
        };
        Ok(Self { kind, solution, plane, initial_stress: parameters.initial_stress(1.0) })
    }

    /// The reference with the accuracy of a line in a figure: a millionth of the load if that is much cheaper.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn for_lines(
        kind: ReferenceKind,
        parameters: &ColumnParameters,
        time_factors: &[f64],
    ) -> Result<Self, ExactError> {
        let ReferenceKind::LargeStrain(model) = kind else {
            return Self::new(kind, parameters, time_factors);
        };
        let solution = drained(parameters, |column| LargeStrain::for_lines(column, model, time_factors))?;
        Ok(Self { kind, solution, plane: None, initial_stress: parameters.initial_stress(1.0) })
    }

    /// Which solution this is.
    pub fn kind(&self) -> ReferenceKind {
        self.kind
    }

    /// Name in study files and tables.
    pub fn name(&self) -> &'static str {
        self.kind.name()
    }

    /// Excess pressure, effective stress with that of the weight, and displacement at the Lagrangian depth `zeta`.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    pub fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let fields = self.solution.fields(time_factor, zeta)?;
        if self.initial_stress == 0.0 {
            return Ok(fields);
        }
        let effective_stress = fields.effective_stress + self.initial_stress * zeta;
        Ok(FieldValues { effective_stress, ..fields })
    }

    /// Whether its fields depend on the place along a layer too.
    pub fn is_plane(&self) -> bool {
        self.plane.is_some()
    }

    /// The manufactured solution, if the reference is a prescribed motion; its fields vary in both directions.
    pub fn manufactured(&self) -> Option<&Manufactured> {
        if let Some(Plane::Motion(motion)) = &self.plane { Some(motion) } else { None }
    }

    /// The whole field of a layer whose fields vary along it too, at a time factor.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn plane_state(&self, time_factor: f64) -> Result<Option<LayerState>, ExactError> {
        if let Some(Plane::Layer(layer)) = &self.plane { layer.at(time_factor).map(Some) } else { Ok(None) }
    }

    /// Strain across the body, as [`Solution::strain_across`].
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn strain_across(&self, time_factor: f64) -> Result<f64, ExactError> {
        self.solution.strain_across(time_factor)
    }

    /// Settlement of the surface, downward positive, m.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        self.solution.settlement(time_factor)
    }

    /// Scale of displacements, m, as [`Solution::displacement_scale`].
    ///
    /// # Errors
    /// When the solution has no end.
    pub fn displacement_scale(&self) -> Result<f64, ExactError> {
        self.solution.displacement_scale()
    }

    /// Degree of consolidation by settlement, `s(t)/s(∞)`; of a motion the share of its largest displacement.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        self.solution.degree_of_consolidation(time_factor)
    }

    /// Least porosity of all places and times, as [`Solution::least_porosity`].
    pub fn least_porosity(&self) -> Option<f64> {
        self.solution.least_porosity()
    }

    /// Whether the degree of consolidation is meaningful, as [`Solution::has_degree`].
    pub fn has_degree(&self) -> bool {
        self.solution.has_degree()
    }

    /// Highest pressure at the impermeable end, as [`Solution::pressure_peak`].
    pub fn pressure_peak(&self) -> Option<(f64, f64)> {
        self.solution.pressure_peak()
    }

    /// Terms used at a time factor and the bound on what they leave out.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        self.solution.accuracy(time_factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_parse_back() {
        for kind in ReferenceKind::ALL {
            assert_eq!(kind.name().parse(), Ok(kind));
        }
        let error = "terzagi".parse::<ReferenceKind>().unwrap_err();
        assert_eq!(error.to_string(), "there is no reference named `terzagi`");
    }

    #[test]
    fn a_weight_adds_its_stress_and_changes_no_pressure() {
        let light = ColumnParameters { height: 2.0, load: 1.0e4, ..ColumnParameters::default() };
        let heavy = ColumnParameters { self_weight: true, ..light };
        for kind in [ReferenceKind::Terzaghi, ReferenceKind::XieLeo] {
            let [light, heavy] = [&light, &heavy].map(|column| Reference::new(kind, column, &[0.2]).unwrap());
            for zeta in [0.0, 0.4, 1.0] {
                let (light, heavy) = (light.fields(0.2, zeta).unwrap(), heavy.fields(0.2, zeta).unwrap());
                // Under water grains of 2650 and water of 1000 kg/m³ at n = 0.3 weigh (1 − n)(ρ_s − ρ_w) g.
                let weight = -0.7 * 1650.0 * 9.81 * 2.0 * zeta;
                assert!((heavy.effective_stress - light.effective_stress - weight).abs() < 1e-9, "{kind}");
                assert_eq!(heavy.pressure, light.pressure);
            }
        }
    }

    #[test]
    fn a_slab_is_pressed_together_and_its_pressure_peaks_above_that_of_the_start() {
        let column = ColumnParameters { height: 2.0, load: 1.0e5, ..ColumnParameters::default() };
        let slab = Reference::new(ReferenceKind::Mandel, &column, &[0.1]).unwrap();
        let strains = [0.0, 0.1, 1.0].map(|time| slab.strain_across(time).unwrap());
        assert!(0.0 > strains[0] && strains[0] > strains[1] && strains[1] > strains[2], "{strains:?}");
        assert!(slab.settlement(0.1).unwrap() > 0.0);
        // The peak is the pressure in the middle at its time, and the highest of all.
        let middle = |time: f64| slab.fields(time, 1.0).unwrap().pressure;
        let (time, height) = slab.pressure_peak().expect("it rises before it falls");
        let ratio = middle(time) / column.load / height;
        assert!((ratio - 1.0).abs() < 1e-9, "{ratio}");
        assert!(middle(0.9 * time) < middle(time) && middle(1.1 * time) < middle(time));
        let other = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1]).unwrap();
        assert_eq!(other.pressure_peak(), None);
    }

    #[test]
    fn displacements_are_measured_by_the_settlement_long_after() {
        let column = ColumnParameters { height: 2.0, load: 1.0e5, ..ColumnParameters::default() };
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1]).unwrap();
        let expected = column.load / column.soil.oedometric_modulus() * column.height;
        let computed = reference.displacement_scale().unwrap();
        assert!((computed / expected - 1.0).abs() < 1e-9, "{computed:e} for {expected:e}");
    }

    #[test]
    fn every_reference_agrees_with_itself() {
        let column = ColumnParameters { height: 2.0, load: 1.0e5, ..ColumnParameters::default() };
        let times = [0.05, 0.3, 1.0];
        // A yield front wants a soil that yields, and its own tests have one; a footing has a load and no fields.
        let is_other =
            |kind: &ReferenceKind| matches!(kind, ReferenceKind::YieldFront | ReferenceKind::Footing);
        let is_plain = |kind: &ReferenceKind| !kind.is_manufactured() && !is_other(kind);
        for kind in ReferenceKind::ALL.into_iter().filter(is_plain) {
            let reference = Reference::new(kind, &column, &times).unwrap();
            assert_eq!(reference.name(), kind.name());
            for time_factor in times {
                let surface = reference.fields(time_factor, 0.0).unwrap();
                let settlement = reference.settlement(time_factor).unwrap();
                let degree = reference.degree_of_consolidation(time_factor).unwrap();
                let settled = match kind {
                    // The plate's: a strain, and not the drained side.
                    ReferenceKind::Mandel => -reference.strain_across(time_factor).unwrap() * column.length,
                    _ => -surface.displacement,
                };
                assert!((settled - settlement).abs() <= 1e-12 * settlement.abs());
                assert!(surface.pressure.abs() < 1e-9 || kind == ReferenceKind::SealedElement);
                let overshoot = if kind == ReferenceKind::StandingWave { 1e-3 } else { 1e-12 };
                assert!((0.0..=1.0 + overshoot).contains(&degree), "{kind} {time_factor}: {degree}");
                assert!(reference.accuracy(time_factor).unwrap().tail_bound < 1e-9);
                let base = reference.fields(time_factor, 1.0).unwrap();
                assert!(base.displacement.abs() < 1e-15);
            }
            assert!(reference.fields(-1.0, 0.5).is_err());
            assert!(reference.fields(f64::NAN, 0.5).is_err());
            assert!(reference.fields(0.1, 1.5).is_err());
            assert!(reference.fields(0.1, f64::NAN).is_err());
            assert!(reference.settlement(-0.1).is_err());
            assert!(reference.accuracy(f64::INFINITY).is_err());
            assert!(Reference::new(kind, &column, &[-1.0]).is_err());
        }
    }
}
