//! What a scene is: a physical problem as data, with what a study may say of it and what comes out.

use crate::column::{Column, column_parameters};
use crate::limit::{Limit, MethodLimit};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::manufactured::Manufactured;
use oedometer_exact::manufactured::motion::ManufacturedModel;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_problem::formulation::Formulation;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{Configuration, Method};
use oedometer_problem::problem::{Start, Strain};
use oedometer_problem::quantity::Quantity;
use oedometer_problem::settings::ExplicitSettings;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;
use std::fmt;

/// A physical problem.
pub struct Scene {
    /// Name in files and at the command line.
    pub name: &'static str,
    /// Description in one line.
    pub summary: &'static str,
    /// What a solver has to know of the sides of the body, and whoever writes its result of the axes.
    pub axes: &'static str,
    /// Question that its studies answer.
    pub question: Question,

    /// The body of soil.
    pub body: Body,
    /// Size of the strains that its theory holds for.
    pub strain: Strain,
    /// Whether waves run in it.
    pub waves: bool,
    /// Whether methods may lock in it, so that runs differ by the stiffness of water and soil.
    pub locks: bool,
    /// What loads it.
    pub load: LoadKind,
    /// Whether no water leaves it.
    pub sealed: bool,
    /// State from which it starts.
    pub start: StartOf,
    /// Pore pressure at the start, written out independently of the solver.
    pub start_pressure: StartPressure,
    /// The motion that body forces make, with its law where nobody names one.
    pub motion: Option<ManufacturedModel>,

    /// The body that it has where a study names nothing.
    pub column: fn() -> Column,
    /// Its soil where a study names nothing.
    pub soil: fn() -> Material,
    /// Choices of the explicit integrator where a study names none.
    pub settings: fn() -> ExplicitSettings,
    /// Keys of geometry, history and points that a study of it may have, beside those that all have.
    pub takes: &'static [&'static str],
    /// Laws that its theory holds for.
    pub laws: Laws,
    /// Integrators that can solve it, the usual one first.
    pub integrators: Allowed<IntegratorKind>,
    /// Formulations that keep what it is about, the usual one first.
    pub formulations: Allowed<Formulation>,
    /// Methods that it cannot take.
    pub methods: &'static [MethodLimit],
    /// What else cannot be together.
    pub limits: &'static [Limit],

    /// What its time factors count.
    pub clock: Clock,
    /// Time factors where a study names none.
    pub outputs: fn(&Column, &Material) -> Vec<f64>,
    /// What the surface settles by in the end, m, where a study tells of it.
    pub final_settlement: Option<fn(&Column, &Material) -> f64>,
    /// References that hold, its own first: the one whose equations the solver solves.
    pub references: &'static [SceneReference],
    /// Quantities that are measured.
    pub quantities: &'static [Quantity],
    /// Checks that say nothing here, and why.
    pub unjudged: &'static [(Check, &'static str)],
}

/// A question of the front page that studies answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// What is accurate at small strain?
    SmallStrain,
    /// What is accurate at large strain?
    LargeStrain,
    /// What do points do that cross cells?
    MovingPoints,
    /// What locks?
    Locking,
    /// What happens where the soil changes?
    Layers,
    /// What becomes of waves?
    Waves,
    /// What moves where nothing may?
    Rest,
}

/// The body of soil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// A column, in one dimension or in two.
    Column,
    /// A slab between two rigid plates, in two dimensions only; its fields vary as a column's do.
    Slab,
    /// A plane layer, in two dimensions only.
    Layer,
    /// A square between rollers on all sides, in two dimensions only, whose motion is chosen.
    Square,
}

impl Body {
    /// Whether fields vary along it too, so that there is no profile over the depth.
    pub fn is_plane(self) -> bool {
        matches!(self, Self::Layer | Self::Square)
    }

    /// Keys of a study that every problem of such a body has.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Column | Self::Slab => &["height", "width", "load", "dimensions"],
            Self::Layer => &["length", "height", "base"],
            Self::Square => &["frequency", "pressure"],
        }
    }

    /// The table of a study that has its geometry, and what is done to it.
    pub fn table(self) -> &'static str {
        match self {
            Self::Column | Self::Slab => "column",
            Self::Layer => "layer",
            Self::Square => "manufactured",
        }
    }
}

/// What loads a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// Nothing.
    None,
    /// A uniform pressure on the surface, at once or growing over a time.
    Uniform,
    /// A uniform pressure, at once, by rigid plates across the body: its surface is free.
    Plates,
    /// A cosine along the surface, at once: its mean is zero, and what one half of the body takes in, the other gives.
    Cosine,
    /// A plate that is pushed into the surface: the load is the result.
    Pushed,
}

/// Origin of the points' state at the start.
pub enum StartOf {
    /// A function of the depth.
    OverDepth(fn(&Column, &Material) -> Result<Start, ExactError>),
    /// The undrained equilibrium that the body finds by its own operators.
    Undrained,
}

/// Pore pressure expected at the start.
pub enum StartPressure {
    /// A uniform pressure, Pa.
    Uniform(fn(&Column, &Material) -> f64),
    /// Its mean is zero, and nothing else is known.
    ZeroMean,
    /// The pressure of the scene's own reference.
    OfReference,
}

/// Laws that a scene takes.
#[derive(Clone, Copy)]
pub enum Laws {
    /// The linear law: at small strain every law is.
    Linear,
    /// Those of a column at large strain.
    OfColumns,
    /// One, which no other scene has.
    Only(Law),
    /// Those whose stresses are known in closed form along the motion.
    AlongMotion,
}

/// Choices that a scene allows, the usual one first.
pub struct Allowed<T: 'static> {
    /// The choices.
    pub list: &'static [T],
    /// Why not the others.
    pub why: &'static str,
    /// What to do instead.
    pub instead: &'static str,
}

impl<T: PartialEq> Allowed<T> {
    /// Whether a choice is allowed.
    pub fn has(&self, choice: &T) -> bool {
        self.list.contains(choice)
    }
}

/// What the time factors of a scene count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Consolidation of the whole body.
    Consolidation,
    /// Consolidation near the surface: it ends where the base is felt.
    HalfSpace,
    /// The settlement of a plate over its width.
    Push,
    /// Periods of a wave, which last little of a consolidation.
    Wave,
    /// Half periods of a motion.
    Motion,
    /// Consolidation in which nothing is pressed out.
    Nothing,
}

impl Clock {
    /// What a time factor is called: that of consolidation, or the settlement of a plate over its width.
    pub fn factor_name(self) -> &'static str {
        if self == Self::Push { "u/B" } else { "T_v" }
    }
}

/// A reference that holds for a scene.
pub struct SceneReference {
    /// Kind of it.
    pub kind: ReferenceKind,
    /// What the scene has that it leaves out, where it is a second one: the floor of errors against it.
    pub differs: fn(&Material) -> Option<&'static str>,
    /// Whether it holds under a load that grows.
    pub holds_growing: bool,
}

impl SceneReference {
    /// The scene's own.
    pub const fn own(kind: ReferenceKind) -> Self {
        Self { kind, differs: |_| None, holds_growing: true }
    }

    /// A second one, of another model.
    pub const fn beside(kind: ReferenceKind, differs: fn(&Material) -> Option<&'static str>) -> Self {
        Self { kind, differs, holds_growing: true }
    }
}

/// A check of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// Forces that nothing balances at the start.
    Unbalanced,
    /// Balance of the stresses at the outputs.
    Equilibrium,
    /// Pressures that nothing can reach.
    Pressure,
    /// Balance of the water.
    Water,
}

const OF_A_COLUMN: &str = "y is measured upward from the base, fixed and impermeable, to the drained surface, which carries a \
                           uniform load; along x there is neither flow nor motion";
/// Fields of a body, and the settlement of its surface.
const FIELDS: &[Quantity] =
    &[Quantity::Pressure, Quantity::EffectiveStress, Quantity::Displacement, Quantity::Settlement];
/// What is said of a list that lacks nothing.
const ALL: &str = "";

impl Scene {
    /// A column without load, at rest and at small strain. A scene names how it differs from this or from
    /// [`LOADED`](Self::LOADED); the snapshot `scenes_with_all_their_fields` shows every field of all.
    pub(crate) const COLUMN: Self = Self {
        name: "",
        summary: "",
        axes: OF_A_COLUMN,
        question: Question::SmallStrain,
        body: Body::Column,
        strain: Strain::Small,
        waves: false,
        locks: false,
        load: LoadKind::None,
        sealed: false,
        start: StartOf::OverDepth(|_, _| Ok(Start::unloaded())),
        start_pressure: StartPressure::Uniform(|_, _| 0.0),
        motion: None,
        column: Column::default,
        soil: || Material { law: Law::Linear, ..Material::default() },
        settings: ExplicitSettings::default,
        takes: &["points"],
        laws: Laws::Linear,
        integrators: Allowed {
            list: &[IntegratorKind::Explicit, IntegratorKind::SemiImplicit, IntegratorKind::Implicit],
            why: ALL,
            instead: ALL,
        },
        formulations: Allowed {
            list: &[Formulation::QuasiStatic, Formulation::UP, Formulation::VW],
            why: ALL,
            instead: ALL,
        },
        methods: &[],
        limits: &[],
        clock: Clock::Nothing,
        outputs: |_, _| vec![0.05, 0.1, 0.2, 0.5, 1.0],
        final_settlement: None,
        references: &[],
        quantities: FIELDS,
        unjudged: &[],
    };
    /// The same column under a sudden load, from the undrained equilibrium of its own operators.
    pub(crate) const LOADED: Self = Self {
        load: LoadKind::Uniform,
        start: StartOf::Undrained,
        start_pressure: StartPressure::OfReference,
        clock: Clock::Consolidation,
        ..Self::COLUMN
    };
    /// The formulations of a scene that is about waves.
    pub(crate) const WITH_INERTIA: Allowed<Formulation> = Allowed {
        list: &[Formulation::VW, Formulation::UP],
        why: "the quasi-static formulation neglects the waves that this problem is about",
        instead: "use \"v-w\" or \"u-p\", or the problem \"terzaghi\"",
    };

    /// References that hold, its own first.
    pub fn reference_kinds(&self) -> Vec<ReferenceKind> {
        self.references.iter().map(|reference| reference.kind).collect()
    }

    /// References that hold for a column, whose load may grow.
    pub fn references_of(&self, column: &Column) -> Vec<ReferenceKind> {
        let holds = |reference: &&SceneReference| column.loading_time <= 0.0 || reference.holds_growing;
        self.references.iter().filter(holds).map(|reference| reference.kind).collect()
    }

    /// Why a reference is not the scene's own, where it is a second one.
    pub fn model_difference(&self, kind: ReferenceKind, soil: &Material) -> Option<&'static str> {
        let reference = self.references.iter().find(|reference| reference.kind == kind)?;
        (reference.differs)(soil)
    }

    /// Whether a study of it may have a key of geometry, history or points.
    pub fn takes(&self, key: &str) -> bool {
        self.body.keys().contains(&key) || self.takes.contains(&key)
    }

    /// Whether a quantity is measured in it.
    pub fn measures(&self, quantity: Quantity) -> bool {
        self.quantities.contains(&quantity)
    }

    /// Whether a load acts on its surface, so that `σ' − p = −q` at rest.
    pub fn is_loaded(&self) -> bool {
        !matches!(self.load, LoadKind::None | LoadKind::Pushed)
    }

    /// Whether its strains are large: degree of consolidation, not time, measures its progress.
    pub fn is_large_strain(&self) -> bool {
        self.strain == Strain::Large
    }

    /// Whether the solver finds its start, an undrained equilibrium of its own operators.
    pub fn start_is_solved(&self) -> bool {
        matches!(self.start, StartOf::Undrained)
    }

    /// Why a check says nothing here, where it does not.
    pub fn unjudged(&self, check: Check) -> Option<&'static str> {
        self.unjudged.iter().find(|(unjudged, _)| *unjudged == check).map(|(_, why)| *why)
    }

    /// Configuration of the weights where the method leaves it open: small strain moves nothing.
    pub fn configuration(&self) -> Configuration {
        self.strain.configuration()
    }

    /// Why the scene cannot take a configuration, where it cannot.
    pub fn refuses_configuration(&self, configuration: Configuration) -> Option<&'static str> {
        (self.is_large_strain() && configuration == Configuration::Frozen)
            .then_some("nothing moves in a `frozen` configuration, but this problem is about large strain")
    }

    /// Why the scene cannot take a method, where it cannot.
    pub fn refuses_method(&self, method: Method) -> Option<&'static str> {
        self.methods.iter().find(|limit| (limit.refuses)(method)).map(|limit| limit.why)
    }

    /// Why the scene cannot take a law, where it cannot.
    pub fn refuses_law(&self, law: Law) -> Option<String> {
        if let Some(model) = self.motion {
            return (!ManufacturedModel { law, ..model }.has_law()).then(|| {
                "the stresses of this law are not known in closed form along the motion of this problem"
                    .to_owned()
            });
        }
        // A law that belongs to one scene without it, or that scene without its law.
        let broken = crate::SCENES.into_iter().find_map(|scene| match scene.laws {
            Laws::Only(only) if (only == law) != (scene == self) => Some(only_of(scene, only)),
            _ => None,
        });
        match (self.laws, broken) {
            (_, Some(told)) => Some(told),
            (Laws::OfColumns, _) if !law.is_for_columns() => Some(
                "this law has no closed form in a column: it belongs to the manufactured solutions"
                    .to_owned(),
            ),
            (Laws::OfColumns, _) if law == Law::Linear => Some(
                "the law `linear` is for small strain: its conductivity ignores that the pores close"
                    .to_owned(),
            ),
            (Laws::Linear, _) if law != Law::Linear => Some(
                "this problem is at small strain, where every law is linear: the one named would be ignored"
                    .to_owned(),
            ),
            _ => None,
        }
    }

    /// Why its parameters make no problem, where the motion that was chosen cannot be.
    pub fn refuses_motion(&self, column: &Column, soil: &Material) -> Option<ExactError> {
        let model = ManufacturedModel { law: soil.law, ..self.motion? };
        Manufactured::new(model, &column_parameters(column, soil)).err()
    }

    /// The initial pore pressures, Pa, of points at heights, m; `pressures` are those that the points have already.
    ///
    /// # Errors
    /// When the scene's own reference, the first of its references, refuses a depth.
    pub fn expected_start_pressures(
        &self,
        column: &Column,
        soil: &Material,
        reference: Option<&Reference>,
        (heights, pressures): (&[f64], &[f64]),
    ) -> Result<Vec<f64>, ExactError> {
        match (&self.start_pressure, reference) {
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
}

/// Says that a law belongs to one scene.
fn only_of(scene: &Scene, law: Law) -> String {
    format!("the law of the problem `{}` is `{}`, which belongs to no other problem", scene.name, law.name())
}

impl fmt::Debug for Scene {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name)
    }
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Scene {}
