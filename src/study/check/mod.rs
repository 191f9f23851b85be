//! From what was typed to what will run: every value judged, every complaint at its place.

pub mod check_layers;
pub mod check_material;
pub mod check_method;
pub mod check_result;
pub mod check_solver;
pub mod check_sweep;
pub mod checker;
pub mod default_integrator;
pub mod distinct_labels;
pub mod end_state;
pub mod expectations;
pub mod geometry;
pub mod step_rule;
pub mod value;

use crate::case::keys::{Key, Value};
use crate::case::planned::{PlannedCase, Planner};
use crate::case::shared::Shared;
use crate::case::tier::Tier;
use crate::case::{Case, Task};
use crate::record::Record;
use crate::study::case_expectation::CaseExpectation;
use crate::study::check::checker::{Checker, Common, Purpose};
use crate::study::check::end_state::load_of;
use crate::study::choice_tables::Placed;
use crate::study::diagnostic::StudyError;
use crate::study::expectation::SeriesExpectation;
use crate::study::file::{OutputTable, StudyFile, StudySource};
use crate::study::name::name_of;
use crate::study::solver::Solver;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::run::integrator::Formulation;
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::Column;
use toml::Spanned;

/// Time factors where a study names none.
const DEFAULT_TIME_FACTORS: [f64; 5] = [0.05, 0.1, 0.2, 0.5, 1.0];
/// Time factor before which nothing has moved and steps no longer advance the time.
const LEAST_TIME_FACTOR: f64 = 1e-15;
/// Longest wall time of a case, s, where a study names none.
const DEFAULT_CASE_SECONDS: f64 = 3600.0;
/// A study that can run.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// File stem, the name of its results.
    pub name: String,
    /// Title.
    pub title: String,
    /// What question it answers.
    pub summary: String,
    /// Scene.
    pub scene: SceneKind,
    /// References its results are held against.
    pub references: Vec<ReferenceKind>,
    /// Cases in the order of the sweeps, each once.
    pub planned: Vec<PlannedCase>,
    /// What it expects of its results.
    pub expectations: Vec<SeriesExpectation>,
    /// What it expects of single cases.
    pub case_expectations: Vec<CaseExpectation>,
    /// Longest wall time of a case, s.
    pub case_seconds: f64,
    /// Solvers of somebody else's that it attaches.
    pub solvers: Vec<Solver>,
    /// Whether those may be started: no file can say so of itself, only whoever calls this program.
    pub may_start_solvers: bool,
    /// Times each case is run alone for its wall time; 0 where it is not timed.
    pub timing_repeats: usize,
    /// What is odd and runs all the same, as a person reads it.
    pub warnings: Vec<String>,
}

impl Study {
    /// Checks a study.
    ///
    /// # Errors
    /// Every complaint with its place.
    pub fn check(source: &StudySource) -> Result<Self, StudyError> {
        Self::check_for(source, Purpose::Solving)
    }

    /// Checks a study for a purpose.
    ///
    /// # Errors
    /// Every complaint with its place.
    pub fn check_for(source: &StudySource, purpose: Purpose) -> Result<Self, StudyError> {
        let file: StudyFile = source.read()?;
        let mut checker = Checker {
            source,
            diagnostics: Vec::new(),
            column_height: None,
            multiplied_out: 0,
            purpose,
            solvers: Vec::new(),
            warnings: Vec::new(),
        };
        let study = checker.study(&file);
        match study {
            Some(study) if checker.diagnostics.is_empty() => Ok(study),
            _ => Err(source.error(checker.diagnostics)),
        }
    }

    /// Whether a case would start a program that may not be started.
    pub fn holds_back(&self, case: &Case) -> bool {
        !self.may_start_solvers && self.solver_of(case).is_some_and(|solver| !solver.is_given())
    }

    /// The solver that a case is given to, where that is not this program.
    pub fn solver_of(&self, case: &Case) -> Option<&Solver> {
        let attached = case.method.attached?;
        self.solvers.iter().find(|solver| solver.attached == attached)
    }

    /// Whether an expectation says that a record is to end as it did.
    pub fn foresees(&self, record: &Record) -> bool {
        self.case_expectations.iter().any(|expectation| expectation.foresees(record))
    }

    /// The cases of a tier.
    pub fn cases(&self, tier: Tier) -> Vec<&Case> {
        self.planned.iter().filter(|planned| planned.tier <= tier).map(|planned| &planned.case).collect()
    }
}

/// The height that all cases have, or that of the study where there are none; none where they have several.
fn common_height(planned: &[PlannedCase], of_the_study: f64) -> Option<f64> {
    let height = planned.first().map_or(of_the_study, |planned| planned.case.column.height);
    planned.iter().all(|planned| planned.case.column.height == height).then_some(height)
}

impl Checker<'_> {
    fn study(&mut self, file: &StudyFile) -> Option<Study> {
        let scene = self.named(&file.scene, "scene")?;
        let task = self.choice(file.task.as_deref(), "task", Task::default())?;
        let case_seconds =
            self.positive(file.case_seconds.as_deref(), "case_seconds", "s", DEFAULT_CASE_SECONDS);
        self.task_fits(file, task, scene);
        self.solvers = self.solvers(file, case_seconds);
        let common = self.common(file, Case::seed(task, scene));
        let mut base = common.base();
        let strain = self.given_strain(file, &base);
        if let Some(strain) = strain {
            base.column.load = load_of(strain, &base);
        }
        self.porosity_at_the_end(file, &base);
        let time_factors = Shared::from(match &file.output.time_factors {
            Some(list) => self.time_factors(list),
            None => DEFAULT_TIME_FACTORS.to_vec(),
        });
        let references = self.references(&file.output, scene, &base.column);
        let given = self.results(file);
        self.sweep_is_there(file);
        let mut planner = Planner::default();
        for block in &file.sweep {
            let table = block.get_ref();
            base.time_factors = match &table.time_factors {
                Some(list) => self.time_factors(list).into(),
                None => time_factors.clone(),
            };
            let Some(mut sweep) = self.sweep(table, block.span(), &common, &base) else { continue };
            if self.purpose == Purpose::Solving {
                self.cells_fill_the_width(table, sweep.cases(&base).filter(|case| !case.is_attached()));
                self.memory_fits(table, sweep.cases(&base).filter(|case| !case.is_attached()));
                self.default_integrator(table, block.span().start, &common, &base, &mut sweep);
            }
            let tier = self.choice(table.tier.as_deref(), "tier", Tier::default()).unwrap_or_default();
            self.layers_fit(file, table, block.span().start, || sweep.cases(&base).map(Case::for_attached));
            let loaded = |case: Case| {
                let mut case = case.for_attached();
                case.column.points.name_water_points(case.points_per_cell);
                if let Some(strain) = strain {
                    case.column.load = load_of(strain, &case);
                }
                case
            };
            let start = block.span().start;
            self.attached_are_solved(start, sweep.cases(&base));
            self.pores_stay_open(start..start + 1, sweep.cases(&base).map(loaded));
            planner.reserve(sweep.count().unwrap_or(0));
            for case in sweep.cases(&base).map(loaded) {
                planner.put(case, tier);
            }
        }
        base.time_factors = time_factors;
        for meshes in given {
            for case in meshes.cases(&base) {
                planner.put(case, meshes.tier);
            }
        }
        let mut planned = planner.into_cases();
        Self::tell_apart(&mut planned);
        self.large_for_small_strain(file, &planned);
        self.column_height = common_height(&planned, base.column.height);
        let (expectations, case_expectations) = self.expectations(file, scene, &references, &planned);
        Some(Study {
            name: name_of(&self.source.name).to_owned(),
            title: file.title.get_ref().clone(),
            summary: file.summary.clone().unwrap_or_default(),
            scene,
            references,
            planned,
            expectations,
            case_expectations,
            case_seconds,
            solvers: std::mem::take(&mut self.solvers),
            may_start_solvers: false,
            timing_repeats: self
                .count(file.timing.repeats.as_deref(), "timing.repeats", 0..=1000)
                .unwrap_or(0),
            warnings: std::mem::take(&mut self.warnings),
        })
    }

    /// Complains where a critical step is to be observed of a body that is not left alone.
    fn task_fits(&mut self, file: &StudyFile, task: Task, scene: SceneKind) {
        if let Some(typed) = file.task.as_ref().filter(|_| task == Task::Stability && scene.is_manufactured())
        {
            self.complain(
                typed.span(),
                "what acts on a manufactured motion hides what grows by itself: its critical step is predicted and \
                 not observed",
                "leave `task` out, or take a scene that is left alone",
            );
        }
    }

    /// Complains at the end of a study without a case.
    fn sweep_is_there(&mut self, file: &StudyFile) {
        if file.sweep.is_empty() && file.result.is_empty() {
            let end = self.source.text.trim_end().len();
            let last_line = self.source.text[..end].rfind('\n').map_or(0, |newline| newline + 1);
            self.complain(
                last_line..end,
                "the study ends here without a [[sweep]] block",
                "add one with at least `method` and `cells`",
            );
        }
    }

    /// What the study expects of its series and of single cases; each must have something to judge.
    fn expectations(
        &mut self,
        file: &StudyFile,
        scene: SceneKind,
        references: &[ReferenceKind],
        planned: &[PlannedCase],
    ) -> (Vec<SeriesExpectation>, Vec<CaseExpectation>) {
        let (mut of_series, mut of_cases) = (Vec::new(), Vec::new());
        for entry in &file.expect {
            if let Some(found) = self.expectation(entry, scene, references) {
                self.series_is_there(entry, &found, planned);
                of_series.push(found);
            }
        }
        for entry in &file.expect_case {
            if let Some(found) = self.case_expectation(entry, scene, references) {
                self.case_is_there(entry, &found, planned);
                of_cases.push(found);
            }
        }
        (of_series, of_cases)
    }

    /// What the tables of the study give its cases.
    fn common(&mut self, file: &StudyFile, seed: Case) -> Common {
        let mut given = self.geometry(file, &seed);
        given.extend(self.inputs("points", &file.points.inputs, &seed));
        given.extend(self.inputs("material", &file.material.inputs, &seed));
        self.units_of_thought(&file.material);
        given.extend(self.inputs("integrator", &file.integrator.inputs, &seed));
        if seed.scene.needs_inertia() && file.integrator.typed("formulation").is_none() {
            let waves = Value::Word(Formulation::VW.name());
            given.extend(Key::named("formulation", "integrator").map(|key| (key, waves)));
        }
        Common { seed, given }
    }

    fn time_factors(&mut self, list: &Spanned<Vec<Placed<f64>>>) -> Vec<f64> {
        if list.get_ref().is_empty() {
            self.complain(list.span(), "no time factor", "name at least one, like [0.05, 0.1, 0.2]");
        }
        let mut factors = Vec::new();
        for typed in list.get_ref() {
            let factor = *typed.get_ref();
            if factor == 0.0 || (LEAST_TIME_FACTOR..=100.0).contains(&factor) {
                factors.push(factor + 0.0);
                continue;
            }
            let help = if factor > 0.0 && factor < 1.0 {
                format!(
                    "nothing has moved by then and steps no longer advance the time: 0, or {LEAST_TIME_FACTOR:e} and later"
                )
            } else {
                "T_v = c_v t/H² lies between 0 and 100; the column is consolidated at 2".to_owned()
            };
            let is_short = (1e-6..1e16).contains(&factor.abs());
            let size = if is_short { factor.to_string() } else { format!("{factor:?}") };
            self.complain(typed.span(), format!("a time factor of {size}"), help);
        }
        factors.sort_by(f64::total_cmp);
        factors.dedup();
        factors
    }

    /// The references that runs are held against, in the order of the scene, whose own comes first: a list of them is a
    /// set.
    fn references(&mut self, table: &OutputTable, scene: SceneKind, column: &Column) -> Vec<ReferenceKind> {
        let own = scene.references_of(column);
        let Some(list) = &table.references else { return own.to_vec() };
        let names: Vec<&str> = scene.references().iter().map(|kind| kind.name()).collect();
        let mut references = Vec::new();
        for typed in list.get_ref() {
            let Some(index) = self.word(typed, "reference", &names) else { continue };
            let kind = scene.references()[index];
            if references.contains(&kind) {
                self.complain(typed.span(), format!("\"{kind}\" is listed twice"), "leave one of them out");
            } else if own.contains(&kind) {
                references.push(kind);
            } else {
                self.complain(
                    typed.span(),
                    format!("the load of `{kind}` acts at once, and this column's grows"),
                    format!("hold it against \"{}\"", own[0]),
                );
            }
        }
        references.sort_by_key(|kind| own.iter().position(|one| one == kind));
        references
    }
}
