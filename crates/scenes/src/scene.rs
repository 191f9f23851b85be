//! A scene is a physical problem: geometry, load, start, the physics it needs and the references that hold for it. The
//! definitions of the scenes are in `columns`, `plane` and `manufactured`; what they have in common is asked here.

use crate::column::{Column, column_parameters};
use crate::definition::{SceneBody, SceneDefinition, SceneLoad, SceneStart, StartPressure};
use crate::{columns, manufactured, plane};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::manufactured::Manufactured;
use oedometer_exact::manufactured::motion::ManufacturedModel;
use oedometer_exact::manufactured::motion::Motion;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{Configuration, Method};
use oedometer_problem::problem::Strain;
use oedometer_problem::settings::{Drag, ExplicitSettings, Scheme};
use oedometer_problem::wave_speeds;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;
use oedometer_soil::wording::words;

/// A physical problem by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SceneKind {
    /// A column loaded at once and drained at its top, at small strain.
    Terzaghi,
    /// The slowest mode of an unloaded column.
    SingleMode,
    /// A column loaded and drained at its top, at large strain.
    XieLeo,
    /// A plane layer loaded at once by a cosine and drained at its top.
    CosineLayer,
    /// A column at rest, loaded at once or over a time, with all its waves.
    DynamicColumn,
    /// The slowest mode of an unloaded column, with its inertia.
    DynamicSingleMode,
    /// An undrained wave that stands in an unloaded column.
    StandingWave,
    /// A slab loaded at once between rigid plates and drained at its sides.
    Mandel,
    /// A column at rest under its own weight.
    AtRest,
    /// A column of layers, loaded at once and drained at its top.
    Layered,
    /// A preconsolidated column in which a front of yielding runs in from its drained top.
    YieldFront,
    /// A column that no water leaves.
    SealedElement,
    /// A strip footing on undrained soil that yields.
    Footing,
    /// A square stretched along its axes by body forces, at large strain.
    ManufacturedBox,
    /// A square with shear inside, at large strain.
    ManufacturedShear,
    /// A square with a disc inside that turns, at large strain.
    ManufacturedVortex,
}

words!(
    SceneKind: Terzaghi "terzaghi", SingleMode "single-mode", XieLeo "xie-leo", CosineLayer "cosine-layer",
    DynamicColumn "dynamic-column", DynamicSingleMode "dynamic-single-mode", StandingWave "standing-wave",
    Mandel "mandel", AtRest "at-rest", Layered "layered", YieldFront "yield-front",
    SealedElement "sealed-element", Footing "footing", ManufacturedBox "manufactured-box", ManufacturedShear "manufactured-shear",
    ManufacturedVortex "manufactured-vortex"
);

impl SceneKind {
    /// The scene's own file.
    pub(crate) fn definition(self) -> &'static SceneDefinition {
        match self {
            Self::Terzaghi => &columns::TERZAGHI,
            Self::SingleMode => &columns::SINGLE_MODE,
            Self::XieLeo => &columns::XIE_LEO,
            Self::CosineLayer => &plane::COSINE_LAYER,
            Self::DynamicColumn => &columns::DYNAMIC_COLUMN,
            Self::DynamicSingleMode => &columns::DYNAMIC_SINGLE_MODE,
            Self::StandingWave => &columns::STANDING_WAVE,
            Self::Mandel => &plane::MANDEL,
            Self::AtRest => &columns::AT_REST,
            Self::Layered => &columns::LAYERED,
            Self::YieldFront => &columns::YIELD_FRONT,
            Self::SealedElement => &columns::SEALED_ELEMENT,
            Self::Footing => &plane::FOOTING,
            Self::ManufacturedBox => &manufactured::BOX,
            Self::ManufacturedShear => &manufactured::SHEAR,
            Self::ManufacturedVortex => &manufactured::VORTEX,
        }
    }

    /// Description in one line.
    pub fn summary(self) -> &'static str {
        self.definition().summary
    }

    /// References that hold for the scene, the one whose equations the solver solves first.
    pub fn references(self) -> &'static [ReferenceKind] {
        self.definition().references
    }

    /// References that hold for a column, whose load may grow.
    pub fn references_of(self, column: &Column) -> &'static [ReferenceKind] {
        match self.definition().load {
            SceneLoad::SuddenOrGrowing(references) if column.loading_time > 0.0 => references,
            _ => self.references(),
        }
    }

    /// Why a reference is not the scene's own, where it is a second one.
    pub fn model_difference(self, reference: ReferenceKind, soil: &Material) -> Option<&'static str> {
        (self.definition().model_difference)(reference, soil)
    }

    /// Law of the soil where a study names none.
    pub fn default_law(self) -> Law {
        match self.model() {
            Some(model) => model.law,
            None if self.is_large_strain() => Law::LogLinear,
            None if self == Self::YieldFront => Law::Preconsolidated,
            None if self == Self::Footing => Law::VonMises,
            None => Law::Linear,
        }
    }

    /// Soil where a study names nothing.
    pub fn default_material(self) -> Material {
        let law = self.default_law();
        if self.is_manufactured() {
            Material { law, ..manufactured::soil() }
        } else if self == Self::YieldFront {
            // A clay, five times as stiff up to half of the load.
            let clay = Material { law, hydraulic_conductivity: 1e-7, porosity: 0.5, ..Material::default() };
            Material { reload_modulus: 6e6, preconsolidation: 0.5, ..clay }
        } else if self == Self::Footing {
            // A clay of 10 kPa that yields long before the first output.
            let clay = Material { law, undrained_strength: 1e4, ..Material::default() };
            Material { youngs_modulus: 1e7, poissons_ratio: 0.4999, ..clay }
        } else {
            Material { law, ..Material::default() }
        }
    }

    /// Time factors where a study names none; a yield front has none once the base is felt, and those of a footing are
    /// its settlements over its width. A standing wave dies out within few periods, whose length in time factors follows from
    /// soil and height.
    pub fn default_time_factors(self, column: &Column, soil: &Material) -> Vec<f64> {
        let factors: &[f64] = match self {
            Self::YieldFront => &[0.0005, 0.001, 0.002, 0.004],
            Self::Footing => &[0.01, 0.02, 0.05],
            // Between the zeros of the wave, of its stress, and of the motions.
            Self::StandingWave => &[1e-5, 5e-5, 1e-4],
            Self::ManufacturedBox | Self::ManufacturedShear | Self::ManufacturedVortex => {
                &[0.1, 0.2, 0.3, 0.4]
            }
            // Later the pressure has drained along the layer, too.
            Self::CosineLayer => &[0.05, 0.1, 0.2, 0.5],
            _ => &[0.05, 0.1, 0.2, 0.5, 1.0],
        };
        let period = |column: &Column, soil: &Material| {
            soil.coefficient_of_consolidation() / (column.height * wave_speeds::undrained_wave_speed(soil))
        };
        let longer = if self == Self::StandingWave {
            period(column, soil) / period(&Column::default(), &Material::default())
        } else {
            1.0
        };
        // To three digits, as one types them.
        let plain = |factor: f64| format!("{factor:.2e}").parse().unwrap_or(factor);
        factors.iter().map(|factor| plain(longer * factor)).collect()
    }

    /// Integrator where a study names none.
    pub fn default_integrator(self) -> IntegratorKind {
        if self == Self::Footing { IntegratorKind::Implicit } else { IntegratorKind::Explicit }
    }

    /// Choices of the explicit integrator where a study names none: the paper's, but of second order in the step
    /// where a smooth motion is compared with exact fields.
    pub fn default_settings(self) -> ExplicitSettings {
        if self.is_manufactured() {
            ExplicitSettings { scheme: Scheme::Leapfrog, drag: Drag::Centred, ..ExplicitSettings::default() }
        } else if self == Self::SealedElement {
            // Water that does not leave would bound the step without limit.
            ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() }
        } else {
            ExplicitSettings::default()
        }
    }

    /// The motion that was chosen, and its law where nobody names one; none where a load or a start moves the body.
    pub(crate) fn model(self) -> Option<ManufacturedModel> {
        match self.references().first() {
            Some(ReferenceKind::Manufactured(model)) => Some(*model),
            _ => None,
        }
    }

    /// Whether its motion is one that was chosen, and body forces and a source make it.
    pub fn is_manufactured(self) -> bool {
        self.definition().body == SceneBody::Square
    }

    /// Says why the scene has no such input of a motion, where it has not.
    pub fn refuses_input_of_motion(self, name: &str) -> Option<&'static str> {
        match (self.model()?.motion, name) {
            (Motion::Vortex, "amplitude_x" | "amplitude_y") => {
                Some("a vortex has one amplitude, its largest angle: `amplitude`")
            }
            (Motion::Box | Motion::Shear, "amplitude") => {
                Some("this motion has two amplitudes: `amplitude_x` and `amplitude_y`")
            }
            _ => None,
        }
    }

    /// Why the scene cannot be solved by an integrator, where it cannot.
    pub fn refuses_integrator(self, integrator: IntegratorKind) -> Option<&'static str> {
        if self == Self::Footing && integrator != IntegratorKind::Implicit {
            return Some(
                "the plate is pushed so slowly that nothing has inertia: the integrator is `implicit`",
            );
        }
        (self.is_manufactured() && integrator == IntegratorKind::SemiImplicit).then_some(
            "body forces and source of a manufactured motion act at the stages of explicit and implicit steps: a \
             semi-implicit one takes stress and pressure at times of their own",
        )
    }

    /// Why the scene cannot take a law, where it cannot.
    pub fn refuses_law(self, law: Law) -> Option<&'static str> {
        if let Some(model) = self.model() {
            return (!ManufacturedModel { law, ..model }.has_law()).then_some(
                "the stresses of this law are not known in closed form along the motion of this scene",
            );
        }
        if (self == Self::YieldFront) != (law == Law::Preconsolidated) {
            return Some("the law of the scene `yield-front` is `preconsolidated`, and of no other scene");
        }
        if (self == Self::Footing) != (law == Law::VonMises) {
            return Some("the law of the scene `footing` is `von-mises`, and of no other scene");
        }
        if matches!(self, Self::YieldFront | Self::Footing) {
            return None;
        }
        if self.is_large_strain() && !law.is_for_columns() {
            return Some("this law has no closed form in a column: it belongs to the manufactured scenes");
        }
        match (self.is_large_strain(), law == Law::Linear) {
            (true, true) => {
                Some("the law `linear` is of small strain: its conductivity ignores that the pores close")
            }
            (false, false) => Some(
                "this scene is of small strain, where every law is linear: the one named would be ignored",
            ),
            _ => None,
        }
    }

    /// Whether its strains are large: degree of consolidation, not time, measures its progress.
    pub fn is_large_strain(self) -> bool {
        self.definition().strain == Strain::Large
    }

    /// Why the scene cannot take a configuration, where it cannot.
    pub fn refuses_configuration(self, configuration: Configuration) -> Option<&'static str> {
        (self.is_large_strain() && configuration == Configuration::Frozen)
            .then_some("nothing moves in a `frozen` configuration, and this scene is about large strain")
    }

    /// Why the scene cannot take a method, where it cannot.
    pub fn refuses_method(self, method: Method) -> Option<&'static str> {
        if self == Self::Footing && method.has_projection() {
            return Some(
                "a pressure projection has unknown pressures at the nodes, and the footing's follow from displacements",
            );
        }
        let is_frozen = method.configuration_in(self.configuration()) == Configuration::Frozen;
        ((self.has_plates() || self == Self::Footing) && (method.basis.is_spline() || !is_frozen)).then_some(
            "a rigid plate holds the nodes of a face: it takes weights that stay (`frozen`), of hats or domains and \
             not of splines, whose coefficients are no values there",
        )
    }

    /// Configuration of the weights where the method leaves it open: small strain moves nothing.
    pub fn configuration(self) -> Configuration {
        if self.is_large_strain() { Configuration::Updated } else { Configuration::Frozen }
    }

    /// Whether its load may take time to come on.
    pub fn takes_loading_time(self) -> bool {
        matches!(self.definition().load, SceneLoad::SuddenOrGrowing(_))
    }

    /// Whether its soil may lie in layers.
    pub fn takes_layers(self) -> bool {
        matches!(self, Self::Layered | Self::XieLeo)
    }

    /// Whether a load acts, so that `σ' − p = −q` at rest.
    pub fn is_loaded(self) -> bool {
        self.definition().load != SceneLoad::None
    }

    /// Whether rigid plates load it across, and not its surface.
    pub fn has_plates(self) -> bool {
        self.definition().load == SceneLoad::Plates
    }

    /// Whether nothing happens in it but by the method's own fault.
    pub fn is_at_rest(self) -> bool {
        self == Self::AtRest
    }

    /// The column that it has where a study names nothing.
    pub fn default_column(self) -> Column {
        match self.definition().body {
            SceneBody::Column => Column { self_weight: self.is_at_rest(), ..Column::default() },
            SceneBody::Layer => Column::layer(),
            SceneBody::Slab => Column::slab(),
            SceneBody::Footing => Column::under_footing(),
            SceneBody::Square => manufactured::square(self.model().map(|model| model.motion)),
        }
    }

    /// Whether its soil may have a weight: columns that are loaded or at rest, and no modes or waves of their own.
    pub fn takes_self_weight(self) -> bool {
        matches!(self, Self::Terzaghi | Self::XieLeo | Self::DynamicColumn | Self::AtRest)
    }

    /// Whether the mean of its load is zero: what one half of the body takes in, the other gives.
    pub fn presses_out_no_water(self) -> bool {
        self.definition().load == SceneLoad::Cosine
    }

    /// Whether balances without inertia leave out what it is about; a motion that was chosen is made in any balances.
    pub fn needs_inertia(self) -> bool {
        self.has_waves() && !self.is_manufactured()
    }

    /// Whether waves run in it.
    pub fn has_waves(self) -> bool {
        self.definition().has_waves
    }

    /// Whether it cannot be solved in one dimension.
    pub fn needs_two_dimensions(self) -> bool {
        self.definition().body != SceneBody::Column
    }

    /// Whether a study has its geometry in the table `[layer]`.
    pub fn is_a_layer(self) -> bool {
        self.definition().body == SceneBody::Layer
    }

    /// The table of a study that has its geometry, and what is done to it.
    pub fn table_of_geometry(self) -> &'static str {
        match self.definition().body {
            SceneBody::Column | SceneBody::Slab => "column",
            SceneBody::Layer | SceneBody::Footing => "layer",
            SceneBody::Square => "manufactured",
        }
    }

    /// Why its parameters make no problem, where the motion that was chosen cannot be.
    pub fn refuses_motion(self, column: &Column, soil: &Material) -> Option<ExactError> {
        let model = ManufacturedModel { law: soil.law, ..self.model()? };
        Manufactured::new(model, &column_parameters(column, soil)).err()
    }

    /// Whether its exact fields vary along the body too, so that there is no profile over the depth.
    pub fn has_plane_fields(self) -> bool {
        self.is_a_layer() || self.is_manufactured() || self == Self::Footing
    }

    /// Whether the scene is about locking, so that runs differ by the stiffness of water and soil.
    pub fn shows_locking(self) -> bool {
        self.is_a_layer() || self == Self::Footing
    }

    /// Whether the solver finds its start, an undrained equilibrium of its own operators.
    pub fn start_is_solved(self) -> bool {
        matches!(self.definition().start, SceneStart::Solved)
    }

    /// The initial pore pressures, Pa, of points at heights, m; `pressures` are those that the points have already.
    ///
    /// # Errors
    /// When the scene's own reference, the first of its references, refuses a depth.
    pub fn expected_start_pressures(
        self,
        column: &Column,
        soil: &Material,
        reference: Option<&Reference>,
        (heights, pressures): (&[f64], &[f64]),
    ) -> Result<Vec<f64>, ExactError> {
        match (&self.definition().start_pressure, reference) {
            (StartPressure::Uniform(pressure), _) => Ok(vec![pressure(column, soil); pressures.len()]),
            (StartPressure::ZeroMean, _) => {
                let mean = pressures.iter().sum::<f64>() / pressures.len() as f64;
                Ok(pressures.iter().map(|pressure| pressure - mean).collect())
            }
            (StartPressure::OfReference, None) => Ok(pressures.to_vec()),
            (StartPressure::OfReference, Some(reference)) => {
                let at = |height: &f64| Ok(reference.fields(0.0, 1.0 - height / column.height)?.pressure);
                heights.iter().map(at).collect()
            }
        }
    }

    /// The scene in whose words the parameters of a solution are given at the command line.
    pub fn of_solution(kind: ReferenceKind) -> Self {
        match kind {
            ReferenceKind::XieLeo | ReferenceKind::LargeStrain(_) => Self::XieLeo,
            ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible => Self::CosineLayer,
            // The one whose load may grow.
            ReferenceKind::DynamicColumn => Self::DynamicColumn,
            ReferenceKind::Mandel => Self::Mandel,
            ReferenceKind::AtRest => Self::AtRest,
            ReferenceKind::Layered => Self::Layered,
            ReferenceKind::YieldFront => Self::YieldFront,
            ReferenceKind::SealedElement => Self::SealedElement,
            ReferenceKind::Footing => Self::Footing,
            ReferenceKind::Manufactured(model) => match model.motion {
                Motion::Box => Self::ManufacturedBox,
                Motion::Shear => Self::ManufacturedShear,
                Motion::Vortex => Self::ManufacturedVortex,
            },
            _ => Self::Terzaghi,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_outputs_of_a_standing_wave_follow_its_period() {
        let times = |height: f64, conductivity: f64, water: f64| {
            let column = Column { height, ..Column::default() };
            let soil = Material {
                hydraulic_conductivity: conductivity,
                water_bulk_modulus: water,
                ..Material::default()
            };
            SceneKind::StandingWave.default_time_factors(&column, &soil)
        };
        let usual = times(1.0, 1e-4, 2.2e9);
        assert_eq!(usual, [1e-5, 5e-5, 1e-4]);
        // T_v of a period is c_v/(H V): in proportion to k, and less in a higher column or a stiffer water.
        assert_eq!(times(1.0, 1e-6, 2.2e9), [1e-7, 5e-7, 1e-6]);
        assert_eq!(times(4.0, 1e-4, 2.2e9), [2.5e-6, 1.25e-5, 2.5e-5]);
        let stiffer = times(1.0, 1e-4, 8.8e9);
        assert!(stiffer.iter().zip(&usual).all(|(a, b)| (2.0 * a / b - 1.0).abs() < 0.01), "{stiffer:?}");
    }

    #[test]
    fn a_motion_has_the_amplitudes_of_its_kind_and_no_other() {
        let (vortex, stretches) = (["amplitude"], ["amplitude_x", "amplitude_y"]);
        for scene in SceneKind::ALL {
            let refused = |names: &[&str]| {
                let all: Vec<_> = names.iter().map(|name| scene.refuses_input_of_motion(name)).collect();
                assert!(all.iter().all(|refusal| refusal.is_some() == all[0].is_some()), "{}", scene.name());
                all[0].is_some()
            };
            let is_vortex = scene == SceneKind::ManufacturedVortex;
            let expected = (scene.is_manufactured() && !is_vortex, is_vortex);
            assert_eq!((refused(&vortex), refused(&stretches)), expected, "{}", scene.name());
            assert_eq!(scene.refuses_input_of_motion("pressure"), None);
        }
    }

    #[test]
    fn a_scene_has_one_name_in_files_and_at_the_command_line() {
        for scene in SceneKind::ALL {
            let written = serde_json::to_value(scene).expect("a name");
            assert_eq!((written.as_str(), SceneKind::named(scene.name())), (Some(scene.name()), Some(scene)));
        }
    }

    #[test]
    fn the_references_of_a_scene_are_found_by_their_names() {
        for reference in SceneKind::ALL.into_iter().flat_map(SceneKind::references) {
            let found: Result<ReferenceKind, _> = reference.name().parse();
            assert_eq!(found.map(ReferenceKind::name), Ok(reference.name()));
        }
    }
}
