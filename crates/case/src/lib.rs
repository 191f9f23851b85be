//! A case: everything that decides a run, as plain data with an identity.

pub mod complete_states;
pub mod contender;
pub mod grouping;
pub mod keys;
pub mod label;
pub mod limits;
pub mod machine;
pub mod method_words;
pub mod outcome;
pub mod planned;
pub mod solver;
pub mod work_estimate;

pub use keys::{KEYS, Key, Kind, Value};
use oedometer_problem::integrator::Formulation;
pub use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{Configuration, Memory, Method};
pub use oedometer_problem::quantity::{self, Norm, Quantity, Sample};
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::time_step::{StepScales, TimeStep};
use oedometer_problem::wave_speeds;
use oedometer_scenes::Scene;
use oedometer_scenes::column::{Column, column_parameters};
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use oedometer_wording::{is_default, words};
pub use planned::{PlannedCase, Planner, Shared, Tier};
use serde::{Deserialize, Serialize};
pub use solver::{Attached, SolverName};
use std::cell::RefCell;
use std::sync::Arc;

/// State and operators of a point, bytes.
const BYTES_A_POINT: f64 = 500.0;

/// Points a cell and direction where a study names none.
const USUAL_POINTS: usize = 2;
/// Memory of the factors of one unknown for each halving of the body, bytes: 0.6 GB for the 49 666 unknowns of a
/// layer of 128 by 128 cells, of which 7 halvings make single cells.
const BYTES_A_HALVING: f64 = 1800.0;

/// Hexadecimal digits of a case's hash: enough that a million cases do not meet.
const HASH_DIGITS: usize = 16;

/// What is done with a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Task {
    /// It is solved and compared with the references of its scene.
    #[default]
    Solve,
    /// Its critical step is predicted and observed.
    Stability,
}

words!(Task: Solve "solve", Stability "stability");

/// All inputs of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Case {
    /// What is done with it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub task: Task,
    /// Physical problem.
    pub scene: &'static Scene,
    /// Geometry and load.
    #[schemars(with = "Column")]
    pub column: Shared<Column>,
    /// Soil.
    #[schemars(with = "Material")]
    pub material: Shared<Material>,
    /// What solves it.
    pub method: SolverName,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Accelerations that the balances keep.
    pub formulation: Formulation,
    /// Choices of the explicit integrator.
    pub settings: ExplicitSettings,
    /// Cells over the height.
    pub cells: usize,
    /// Points a cell and direction.
    pub points_per_cell: usize,
    /// Step size.
    pub time_step: TimeStep,
    /// Time factors of the outputs, ascending.
    #[schemars(with = "Vec<f64>")]
    pub time_factors: Shared<Vec<f64>>,
    /// Inputs by their keys that its label names, for other cases of the same study have all else in common. They are
    /// the study's business, neither part of the identity of a case nor kept in its record.
    #[serde(skip)]
    pub swept: Arc<[&'static str]>,
}

impl Case {
    /// The seed values of a scene on one cell, by the plain method: what a study does not name.
    pub fn seed(task: Task, scene: &'static Scene) -> Self {
        let integrator = scene.integrators.list[0];
        Self {
            task,
            scene,
            column: (scene.column)().into(),
            material: (scene.soil)().into(),
            method: SolverName::Own(Method::STANDARD),
            integrator,
            formulation: integrator.default_formulation(),
            settings: (scene.settings)(),
            cells: 1,
            points_per_cell: USUAL_POINTS,
            time_step: integrator.default_rule(),
            time_factors: Shared::default(),
            swept: Arc::default(),
        }
    }

    /// Identity over the meaning: equal for equal inputs, whatever file or path they came from.
    pub fn hash(&self) -> String {
        format!("{:0digits$x}", self.number(), digits = HASH_DIGITS)
    }

    /// The hash as the number that its digits are.
    pub fn number(&self) -> u64 {
        let hash = canonical_hash(self);
        hash.as_bytes().iter().take(HASH_DIGITS / 2).fold(0, |number, byte| (number << 8) | u64::from(*byte))
    }

    /// The number that the case would have with some inputs made the same: equal for cases that differ in these
    /// alone.
    pub fn number_with(&self, make_same: impl FnOnce(&mut Self)) -> u64 {
        let mut case = self.clone();
        make_same(&mut case);
        case.number()
    }

    /// Whether an integrator of this program solves it, by steps and points that are known and with work that is counted.
    pub fn has_integrator(&self) -> bool {
        self.method.built_in().is_some()
    }

    /// Configuration of the shape functions of this program's method: the method's own, or the scene's.
    pub fn configuration(&self) -> Configuration {
        let scene = self.scene.configuration();
        self.method.built_in().map_or(scene, |method| method.configuration_in(scene))
    }

    /// The choices of the case that change nothing, because nothing moves in it: each as a sentence for the reader. The run is
    /// that of the case [without them](Self::without_idle_choices), to the bit.
    pub fn idle_choices(&self) -> Vec<&'static str> {
        let plain = self.without_idle_choices();
        let is_still = self.configuration() == Configuration::Frozen;
        let method = self.method.built_in().filter(|_| is_still);
        let said = [
            (
                method.is_some_and(|method| method.configuration == Some(Configuration::Total)),
                "nothing moves here, so shape functions on the initial configuration (`TL-`) are the same as without",
            ),
            (
                method.is_some_and(|method| method.memory == Memory::Cells),
                "nothing moves here, so points stay in their cells and `-cells` changes nothing",
            ),
            (
                plain.settings.affine != self.settings.affine,
                "nothing moves here, so APIC (`affine`) changes nothing",
            ),
            (
                plain.settings.stress_slopes != self.settings.stress_slopes,
                "nothing moves here, so there are no stress slopes (`stress_slopes`)",
            ),
            (
                plain.material.conductivity_mean != self.material.conductivity_mean,
                "at small strain the conductivity is uniform, so the chord mean is the mean of the points",
            ),
            (
                plain.column.points.sets != self.column.points.sets,
                "nothing moves here and the two point sets are identical, so they are solved as one",
            ),
        ];
        said.into_iter().filter_map(|(is_idle, sentence)| is_idle.then_some(sentence)).collect()
    }

    /// The case without choices that have nothing to act on: APIC, stress slopes and a mean of the conductivity where nothing
    /// moves, and there a second point set that lies where the first one does, but for the explicit step, which shows that
    /// both are equal (docs/theory.md).
    #[must_use]
    pub fn without_idle_choices(&self) -> Self {
        let mut case = self.clone();
        if !self.has_integrator() || self.configuration() != Configuration::Frozen {
            return case;
        }
        (case.settings.affine, case.settings.stress_slopes) = (false, false);
        case.material.conductivity_mean = ConductivityMean::Points;
        let points = &mut case.column.points;
        let is_alike = points.water_per_cell == 0 || points.water_per_cell == self.points_per_cell;
        let is_uniform = self.column.soils.is_empty();
        if points.has_two_sets() && is_alike && is_uniform && self.integrator != IntegratorKind::Explicit {
            (points.sets, points.water_per_cell) = (1, 0);
        }
        case
    }

    /// The case as its solver knows it: another program has no use for what only this program's integrators take, and cases
    /// that differ in nothing else are one. A step in seconds stays, for it is a step that can be suggested.
    #[must_use]
    pub fn as_its_solver_knows(mut self) -> Self {
        if !self.has_integrator() {
            self.integrator = IntegratorKind::Implicit;
            self.formulation = self.integrator.default_formulation();
            self.settings = ExplicitSettings::default();
            if !matches!(self.time_step, TimeStep::Seconds(_)) {
                self.time_step = self.integrator.default_rule();
            }
        }
        self
    }

    /// Whether its shape functions are splines.
    pub fn is_spline(&self) -> bool {
        self.method.built_in().is_some_and(|method| method.basis.is_spline())
    }

    /// Whether it is integrated explicitly.
    pub fn is_explicit(&self) -> bool {
        self.integrator == IntegratorKind::Explicit
    }

    /// Its soils with their thicknesses, m, from the base up: one, or those of its layers.
    pub fn soils(&self) -> Vec<(f64, Material)> {
        if self.column.soils.is_empty() {
            return vec![(self.column.height, *self.material)];
        }
        self.column.soils.iter().map(|layer| (layer.thickness, layer.soil(&self.material))).collect()
    }

    /// What its rule measures steps by, with a critical step in s.
    pub fn step_scales(&self, critical: f64) -> StepScales {
        let soils = self.soils();
        let most = |of: fn(&Material) -> f64| soils.iter().map(|(_, soil)| of(soil)).fold(0.0, f64::max);
        StepScales {
            critical,
            cell_size: self.cell_size(),
            wave_speed: most(|soil| wave_speeds::fastest_wave_speed(soil, soil.porosity)),
            consolidation: most(Material::coefficient_of_consolidation),
        }
    }

    /// Cell size, m.
    pub fn cell_size(&self) -> f64 {
        self.column.cell_size(self.cells)
    }

    /// Points there are to be, in all sets that the case is solved with: cells times points per cell, in every direction.
    pub fn expected_points(&self) -> usize {
        let water_per_cell = self.without_idle_choices().column.points.water_per_cell;
        let of_set = |per_cell: usize| {
            let along = self.column.points.points_up(self.column.cells_up(self.cells), per_cell);
            match self.column.dimensions {
                1 => along,
                _ => along * self.column.cells_across(self.cells).unwrap_or(1) * per_cell,
            }
        };
        of_set(self.points_per_cell) + of_set(water_per_cell)
    }

    /// Whether some motion moves skeleton and water together, so that no drag damps it: what limits semi-implicit steps.
    pub fn has_undamped_motions(&self) -> bool {
        self.column.dimensions > 1 || self.method.built_in().is_some_and(|method| method.has_projection())
    }

    /// Time, s, at which `T_v = 1`; of a motion half its period.
    pub fn seconds_per_time_factor(&self) -> f64 {
        column_parameters(&self.column, &self.material).time(1.0)
    }

    /// Memory that a run may take, bytes, to an order of magnitude: its points, and the factors of the direct
    /// solver, which the undrained start of an explicit run needs too: those of a band, or of fronts.
    pub fn estimated_bytes(&self) -> f64 {
        let across = self.column.cells_across(self.cells).unwrap_or(1);
        let up = self.column.cells_up(self.cells);
        let (short, long) = (across.min(up) as f64, across.max(up) as f64);
        let dimensions = self.column.dimensions as f64;
        let points_a_cell = elementary::powf(self.points_per_cell as f64, dimensions);
        let is_by_cells = self.method.built_in().is_some_and(|method| method.pressure.is_by_cells());
        let sites = if is_by_cells { 1.0 } else { points_a_cell };
        // Unknowns of one row of cells across the layer; a node couples to four rows above and below.
        let row = short * (dimensions + sites);
        let band = 12.0 * row;
        // Each halving of the body adds as much to the factors of its fronts.
        let halvings = f64::from(across.min(up).max(2).ilog2());
        let factors = (16.0 * band).min(BYTES_A_HALVING * halvings);
        let solves = !self.is_explicit() || self.scene.start_is_solved();
        let solver = if solves { long * row * factors } else { 0.0 };
        solver + BYTES_A_POINT * short * long * points_a_cell
    }
}

thread_local! {
    /// Text of a case: every one of a large study is hashed several times.
    static CANONICAL: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Hash over all inputs of a case, as JSON.
fn canonical_hash(case: &Case) -> blake3::Hash {
    CANONICAL.with_borrow_mut(|canonical| {
        canonical.clear();
        // Serialising plain numbers and words cannot fail; were it to, what there is still hashes.
        let _ = serde_json::to_writer(&mut *canonical, case);
        blake3::hash(canonical)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::Attached;
    use oedometer_exact::parameters::MotionParameters;
    use oedometer_problem::settings::Drag;
    use oedometer_problem::settings::Scheme;
    use oedometer_scenes::column::Shape;
    use oedometer_scenes::{TERZAGHI, XIE_LEO};
    use oedometer_soil::conductivity::ConductivityMean;
    use oedometer_soil::continuity::Continuity;
    use oedometer_soil::law::Law;

    fn seed() -> Case {
        Case {
            method: Method::named("GC-SRI-patch").expect("the paper's method").into(),
            cells: 10,
            time_step: TimeStep::Stable(0.5),
            time_factors: vec![0.1].into(),
            ..Case::seed(Task::Solve, &TERZAGHI)
        }
    }

    fn foreign(name: &str, digest: &str) -> SolverName {
        SolverName::Attached(Attached::new(name, digest).expect("a plain name"))
    }

    #[test]
    fn inputs_of_integrators_alone_do_not_change_an_attached_case() {
        let foreign = Case { method: foreign("ogs", "0123456789abcdef"), ..seed() };
        let explicit = foreign.clone().as_its_solver_knows();
        let mut implicit = foreign.clone();
        implicit.integrator = IntegratorKind::Implicit;
        implicit.time_step = TimeStep::Growth(0.05);
        implicit.settings.drag = Drag::Implicit;
        assert_eq!(implicit.as_its_solver_knows().hash(), explicit.hash());
        assert_eq!(explicit.label(), "ogs cells=10");
        let stepped = Case { time_step: TimeStep::Seconds(0.5), ..foreign }.as_its_solver_knows();
        assert_ne!(stepped.hash(), explicit.hash());
        assert_eq!(stepped.label(), "ogs cells=10 seconds=5e-1");
        assert_eq!(seed().as_its_solver_knows(), seed(), "a method of this program keeps all");
    }

    #[test]
    fn the_hash_follows_the_meaning() {
        let case = seed();
        assert_eq!(case.hash(), seed().hash());
        assert_eq!(case.hash().len(), HASH_DIGITS);
        for change in [
            |case: &mut Case| case.cells = 11,
            |case: &mut Case| case.material.porosity = 0.300_000_000_000_000_04,
            |case: &mut Case| case.settings.mapping_back = false,
            |case: &mut Case| case.time_factors.push(0.2),
        ] {
            let mut other = seed();
            change(&mut other);
            assert_ne!(other.hash(), case.hash());
        }
    }

    #[test]
    fn a_case_without_self_weight_keeps_the_hash_from_before_the_key() {
        let text = serde_json::to_string(&seed()).expect("plain data");
        assert!(!text.contains("self_weight"), "{text}");
    }

    #[test]
    fn the_hash_follows_every_input() {
        fn square(change: fn(&mut MotionParameters)) -> Shape {
            let mut motion = MotionParameters::default();
            change(&mut motion);
            Shape::Square { motion, pressure: 1.0 }
        }
        let mut hashes = vec![seed().hash()];
        let changes: [fn(&mut Case); 51] = [
            |case| case.task = Task::Stability,
            |case| case.scene = &XIE_LEO,
            |case| case.column.height = 2.0,
            |case| *case.column = case.column.with_extent(2.0),
            |case| case.column.load = 2.0,
            |case| case.column.dimensions = 2,
            |case| *case.column = Column::layer(),
            |case| case.column.loading_time = 2.0,
            |case| case.column.self_weight = true,
            |case| case.column.drainage = oedometer_soil::base::Drainage::Both,
            |case| case.column.shape = square(|motion| motion.amplitude_x = 0.1),
            |case| case.column.shape = square(|motion| motion.amplitude_y = 0.1),
            |case| case.column.shape = square(|motion| motion.amplitude = 0.1),
            |case| case.column.shape = square(|motion| motion.frequency = 0.1),
            |case| case.column.points.offset = 0.1,
            |case| case.column.points.jitter = 0.1,
            |case| case.column.points.filling = 0.5,
            |case| case.column.points.alternating = true,
            |case| case.column.points.sets = 2,
            |case| case.column.points.water_per_cell = 3,
            |case| case.material.law = Law::LogLinear,
            |case| case.material.youngs_modulus = 2.0,
            |case| case.material.poissons_ratio = 0.1,
            |case| case.material.porosity = 0.1,
            |case| case.material.grain_density = 2.0,
            |case| case.material.water_density = 2.0,
            |case| case.material.water_bulk_modulus = 2.0,
            |case| case.material.hydraulic_conductivity = 2.0,
            |case| case.material.gravity = 2.0,
            |case| case.material.continuity = Continuity::ConstantPorosityGradient,
            |case| case.material.conductivity_mean = ConductivityMean::Chord,
            |case| case.method = Method::named("GIMP").expect("a method").into(),
            |case| case.method = Method::named("GIMP-SRI").expect("a method").into(),
            |case| case.method = foreign("ogs", "0123456789abcdef"),
            |case| case.method = foreign("ogs", "0123456789abcdee"),
            |case| case.integrator = IntegratorKind::Implicit,
            |case| case.formulation = Formulation::UP,
            |case| case.settings.scheme = Scheme::Leapfrog,
            |case| case.settings.drag = Drag::Centred,
            |case| case.settings.flip = 0.5,
            |case| case.settings.mapping_back = false,
            |case| case.settings.affine = true,
            |case| case.settings.stress_slopes = true,
            |case| case.cells = 11,
            |case| case.points_per_cell = 3,
            |case| case.time_step = TimeStep::Stable(0.6),
            |case| case.time_step = TimeStep::Courant(0.5),
            |case| case.time_step = TimeStep::Seconds(0.5),
            |case| case.time_step = TimeStep::Growth(0.5),
            |case| case.time_factors = vec![0.2].into(),
            |case| case.time_factors = vec![0.1, 0.2].into(),
        ];
        for change in changes {
            let mut other = seed();
            change(&mut other);
            hashes.push(other.hash());
        }
        let all = hashes.len();
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), all, "every change is another case");
    }
}
