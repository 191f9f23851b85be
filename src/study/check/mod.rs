//! Checks a study as typed, reports every mistake at its place, and plans its cases.

mod expectations;
mod geometry;
pub mod outputs;
mod repaired;
pub mod solvers;
mod sweeps;
mod values;

use crate::case::contender::Contender;
use crate::case::work_estimate::{READING_SECONDS, estimated_seconds};
use crate::case::{Case, Key, PlannedCase, Planner, Task, Tier, Value};
use crate::record::Record;
use crate::study::check::expectations::Subject;
use crate::study::check::geometry::load_of;
use crate::study::check::outputs::Outputs;
use crate::study::check::sweeps::{start_of, tell_apart};
use crate::study::diagnostic::{Diagnostic, StudyError};
use crate::study::expectation::{CaseExpectation, SeriesExpectation};
use crate::study::file::{GoldenRule, OutputTable, StudyFile, StudySource, SweepTable};
use crate::study::reading::Placed;
use crate::study::shipped::name_of;
use crate::study::solver::ExternalSolver;
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::integrator::Formulation;
use oedometer_problem::method::Configuration;
use oedometer_scenes::Scene;
use oedometer_scenes::column::Column;
use oedometer_scenes::scene::{LoadKind, Question};
use std::ops::Range;

/// What a study is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Its cases are to be solved.
    Solving,
    /// Only its problem is wanted, for an exact solution: no grid has to fit it.
    Theory,
}

/// Longest wall time of a case, s, where a study names none.
const DEFAULT_CASE_SECONDS: f64 = 3600.0;

/// Largest tolerance of golden values: errors are compared, which are of this size themselves.
pub const MOST_TOLERANCE: f64 = 1e-2;

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
    pub scene: &'static Scene,
    /// References that its results are compared with.
    pub references: Vec<ReferenceKind>,
    /// Cases in the order of the sweeps, each once.
    pub planned: Vec<PlannedCase>,
    /// What it expects of its results.
    pub expectations: Vec<SeriesExpectation>,
    /// What it expects of single cases.
    pub case_expectations: Vec<CaseExpectation>,
    /// Longest wall time of a case, s.
    pub case_seconds: f64,
    /// External solvers that it attaches.
    pub solvers: Vec<ExternalSolver>,
    /// Whether those may be started: no file can say so of itself, only whoever calls this program.
    pub may_start_solvers: bool,
    /// Whether some of its outputs are asked for as times.
    pub has_dates: bool,
    /// Times each case is run alone for its wall time; 0 where it is not timed.
    pub timing_repeats: usize,
    /// Whether its values are compared with golden ones.
    pub golden: GoldenRule,
    /// Whether all contenders of the race are among its methods.
    pub is_race: bool,
    /// Contenders that cannot run here, by their names, each with the reason.
    pub not_applicable: Vec<(&'static str, String)>,
    /// Warnings, as text.
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
        if let Err(error) = StudyFile::read(source) {
            return Err(repaired::with_later_mistakes(error, purpose));
        }
        Self::check_read(source, purpose)
    }

    /// Checks a study that can be read.
    fn check_read(source: &StudySource, purpose: Purpose) -> Result<Self, StudyError> {
        let file = StudyFile::read(source)?;
        let mut checker = Checker {
            source,
            diagnostics: Vec::new(),
            multiplied_out: 0,
            purpose,
            solvers: Vec::new(),
            is_race: false,
            not_applicable: Vec::new(),
            warnings: Vec::new(),
        };
        let study = checker.study(file);
        if checker.diagnostics.is_empty() { Ok(study) } else { Err(source.error(checker.diagnostics)) }
    }

    /// Whether a case would start a program that may not be started.
    pub fn holds_back(&self, case: &Case) -> bool {
        !self.may_start_solvers && self.solver_of(case).is_some_and(|solver| !solver.is_given())
    }

    /// Time that a case will take on one core, s: 0 for an existing result.
    pub fn estimated_seconds(&self, case: &Case) -> f64 {
        let is_given = self.solver_of(case).is_some_and(ExternalSolver::is_given);
        if is_given { READING_SECONDS } else { estimated_seconds(case) }
    }

    /// The solver that a case is given to, where that is not this program.
    pub fn solver_of(&self, case: &Case) -> Option<&ExternalSolver> {
        self.solvers.iter().find(|solver| case.method == solver.method())
    }

    /// Whether an expectation says that a record is to end as it did. How a contender of a race ends is a result.
    pub fn foresees(&self, record: &Record) -> bool {
        self.is_race || self.case_expectations.iter().any(|expectation| expectation.foresees(record))
    }

    /// Whether an expectation says that a check of a record is to fail. How sound a contender's runs are is a result of the race.
    pub fn foresees_complaints(&self, record: &Record) -> bool {
        self.is_race
            || self.case_expectations.iter().any(|expectation| expectation.foresees_complaints(record))
    }

    /// The cases of a tier.
    pub fn cases(&self, tier: Tier) -> Vec<&Case> {
        self.planned.iter().filter(|planned| planned.tier <= tier).map(|planned| &planned.case).collect()
    }
}

/// Complaints as they come up; every method gives a usable value or none.
struct Checker<'a> {
    source: &'a StudySource,
    diagnostics: Vec<Diagnostic>,
    /// Cases that the sweeps seen so far multiply out to.
    multiplied_out: usize,
    purpose: Purpose,
    /// Attached solvers, whose names are methods too.
    solvers: Vec<ExternalSolver>,
    /// Whether a sweep names the race.
    is_race: bool,
    /// Contenders of a race that the study refuses, with the reason.
    not_applicable: Vec<(&'static str, String)>,
    /// Warnings, ready to print.
    warnings: Vec<String>,
}

/// What the cases of a study share where a sweep does not say otherwise.
struct Common {
    /// The seed values of the scene.
    seed: Case,
    /// What the study gives by its own tables.
    given: Vec<(&'static Key, Value)>,
}

impl Common {
    /// A case of the study before anything is swept.
    fn base(&self) -> Case {
        let mut case = self.seed.clone();
        for (key, value) in &self.given {
            key.set(&mut case, *value);
        }
        case
    }
}

impl Checker<'_> {
    /// Notes a complaint.
    fn complain(&mut self, span: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::at(span, message, help));
    }

    /// Notes a warning, with which the study still runs.
    fn warn(&mut self, diagnostic: &Diagnostic) {
        self.warnings.push(diagnostic.warning(&self.source.name, &self.source.text));
    }

    fn study(&mut self, file: StudyFile) -> Study {
        let (scene, task) = (*file.scene, file.task.as_deref().copied().unwrap_or_default());
        let case_seconds =
            self.positive(file.case_seconds.as_ref(), "case_seconds", "s", DEFAULT_CASE_SECONDS);
        if let Some(typed) = file.task.as_ref().filter(|_| task == Task::Stability && scene.motion.is_some())
        {
            self.complain(
                typed.span(),
                "the body forces of a manufactured solution hide what grows by itself: its critical step is predicted and \
                 not observed",
                "leave `task` out, or take another problem",
            );
        }
        self.attach_solvers(&file, case_seconds);
        self.given_once(&file);
        let common = self.common(&file, Case::seed(task, scene));
        let mut base = common.base();
        let strain = self.given_strain(&file, &base);
        if let Some(strain) = strain {
            base.column.load = load_of(strain, &base);
        }
        base.column.soils = self.soils(&file, &base);
        let has_dates = file.output.times.is_some() || file.sweep.iter().any(|table| table.times.is_some());
        let outputs = self.outputs(&file.output.time_factors, &file.output.times);
        let outputs =
            outputs.unwrap_or_else(|| Outputs::at_factors((scene.outputs)(&base.column, &base.material)));
        let references = self.references(&file.output, scene, &base.column);
        let given = self.attach_results(&file);
        self.has_cases(&file);
        let mut planner = Planner::default();
        for table in &file.sweep {
            self.plan(&file, table, (&common, &base, strain), &outputs, &mut planner);
        }
        base.time_factors = outputs.of_case(&base);
        if !given.is_empty() {
            self.times_are_possible(&outputs, std::iter::once(base.clone()));
        }
        for meshes in given {
            for case in meshes.cases(&base) {
                planner.put(case, meshes.tier);
            }
        }
        let mut planned = planner.into_cases();
        tell_apart(&mut planned);
        self.units_are_meant(&file, &planned);
        self.large_for_small_strain(&file, &planned);
        self.unlike_any_soil(&file, &planned);
        self.projection_slows_waves(&file, &planned);
        let height = planned.first().map_or(base.column.height, |planned| planned.case.column.height);
        let is_common = planned.iter().all(|planned| planned.case.column.height == height);
        let height = is_common.then_some(height);
        let plate_width = (scene.load == LoadKind::Pushed).then_some(base.column.footing.width);
        let subject = Subject { scene, references: &references, planned: &planned, height, plate_width };
        let expectations: Vec<SeriesExpectation> =
            file.expect.iter().filter_map(|table| self.expectation(table, &subject)).collect();
        let case_expectations: Vec<CaseExpectation> =
            file.expect_case.iter().filter_map(|table| self.case_expectation(table, &subject)).collect();
        let golden = self.golden_rule(file.golden.as_ref(), &expectations, &case_expectations);
        let timing_repeats = self.count(file.timing.repeats.as_ref(), "timing.repeats", 0..=1000);
        Study {
            name: name_of(&self.source.name),
            title: file.title,
            summary: file.summary,
            scene,
            references,
            planned,
            expectations,
            case_expectations,
            case_seconds,
            solvers: std::mem::take(&mut self.solvers),
            may_start_solvers: false,
            has_dates,
            timing_repeats: timing_repeats.unwrap_or(0),
            golden,
            is_race: self.is_race,
            not_applicable: std::mem::take(&mut self.not_applicable),
            warnings: std::mem::take(&mut self.warnings),
        }
    }

    /// Complains of a study without cases.
    fn has_cases(&mut self, file: &StudyFile) {
        if !file.sweep.is_empty() || !file.result.is_empty() {
            return;
        }
        let end = self.source.text.trim_end().len();
        let last_line = self.source.text[..end].rfind('\n').map_or(0, |newline| newline + 1);
        self.complain(
            last_line..end,
            "the study ends here without a [[sweep]] block",
            "add one with at least `method` and `cells`",
        );
    }

    /// Plans the cases of a sweep, with the load of a strain that is given, at its own outputs or those of the study.
    fn plan(
        &mut self,
        file: &StudyFile,
        table: &Placed<SweepTable>,
        (common, base, strain): (&Common, &Case, Option<f64>),
        outputs: &Outputs,
        planner: &mut Planner,
    ) {
        let (start, scene) = (start_of(table), base.scene);
        let swept = self.outputs(&table.time_factors, &table.times);
        let outputs = swept.as_ref().unwrap_or(outputs);
        let loaded = |case: Case| {
            let mut case = case.as_its_solver_knows();
            case.column.points.name_water_points(case.points_per_cell);
            if let Some(strain) = strain {
                case.column.load = load_of(strain, &case);
            } else if scene.load == LoadKind::Pushed {
                // What the soil bears is what pressures are measured by.
                case.column.load = case.material.undrained_strength;
            }
            case.time_factors = outputs.of_case(&case);
            case
        };
        self.for_each_entry(table, |checker, entry| {
            // Where nothing moves a mesh that follows the soil is the same mesh.
            let moves = scene.configuration() == Configuration::Updated || base.task == Task::Stability;
            if entry.is_some_and(Contender::is_total) && !moves && scene.question != Question::Rest {
                return;
            }
            let before = checker.diagnostics.len();
            let Some(mut sweep) = checker.sweep(table, &start, common, base, entry) else { return };
            checker.default_integrator((table, &start), common, (base, &loaded), &mut sweep);
            let unfit =
                |entry: &Contender| sweep.cases(base).map(&loaded).find_map(|case| entry.unfit(&case));
            if let Some((entry, why)) = entry.and_then(|entry| Some((entry, unfit(entry)?))) {
                checker.leave_out(entry.name, why);
                return;
            }
            checker.times_are_possible(outputs, sweep.cases(base).map(&loaded));
            checker.cases_are_possible(file, (table, &start), sweep.cases(base).map(&loaded));
            // What cannot be fails the study, or is left out of a race.
            let is_kept = entry.is_none() || checker.diagnostics.len() == before;
            planner.reserve(sweep.count().unwrap_or(0));
            for case in sweep.cases(base).map(&loaded).filter(|_| is_kept) {
                planner.put(case, table.tier);
            }
        });
    }

    /// Whether there are golden values: what expects nothing is judged by them, and a wide tolerance judges nothing.
    fn golden_rule(
        &mut self,
        typed: Option<&Placed<GoldenRule>>,
        expectations: &[SeriesExpectation],
        case_expectations: &[CaseExpectation],
    ) -> GoldenRule {
        let Some(typed) = typed else { return GoldenRule::default() };
        let rule = **typed;
        let expects = !expectations.is_empty() || !case_expectations.is_empty();
        match rule {
            // An expectation with a mistake in it has its own complaint.
            GoldenRule::None if !expects && self.diagnostics.is_empty() => self.complain(
                typed.span(),
                "nothing would be judged: the study has neither golden values nor expectations",
                "add an `[[expect]]`, or leave `golden` out",
            ),
            GoldenRule::Within(tolerance) if !(0.0..=MOST_TOLERANCE).contains(&tolerance) => self.complain(
                typed.span(),
                format!("a tolerance of {tolerance} of golden values is not between 0 and {MOST_TOLERANCE}"),
                "values that scatter by more have no golden ones: `golden = \"none\"`, and expectations",
            ),
            _ => {}
        }
        rule
    }

    /// What the tables of the study give its cases.
    fn common(&mut self, file: &StudyFile, seed: Case) -> Common {
        let mut given = self.geometry(file, &seed);
        given.extend(self.inputs("points", &file.points.inputs, &seed));
        given.extend(self.inputs("material", &file.material.inputs, &seed));
        self.units_are_si(&file.material.inputs);
        self.soil_remembers(&file.material.inputs, seed.scene);
        given.extend(self.inputs("integrator", &file.integrator.inputs, &seed));
        if !seed.scene.formulations.has(&Formulation::QuasiStatic)
            && file.integrator.inputs.typed("formulation").is_none()
        {
            let waves = Value::Word(Formulation::VW.name());
            given.extend(Key::named("formulation", "integrator").map(|key| (key, waves)));
        }
        Common { seed, given }
    }

    /// The references that runs are compared with, in the order of the scene, whose own comes first.
    fn references(
        &mut self,
        table: &OutputTable,
        scene: &'static Scene,
        column: &Column,
    ) -> Vec<ReferenceKind> {
        let of_problem = scene.references_of(column);
        let Some(list) = &table.references else { return of_problem };
        let names: Vec<&str> = scene.reference_kinds().iter().map(|kind| kind.name()).collect();
        let mut references = Vec::new();
        for typed in list.iter() {
            let Some(index) = self.word(typed, "reference", &names) else { continue };
            let kind = scene.references[index].kind;
            if references.contains(&kind) {
                self.complain(typed.span(), format!("\"{kind}\" is listed twice"), "leave one of them out");
            } else if of_problem.contains(&kind) {
                references.push(kind);
            } else {
                self.complain(
                    typed.span(),
                    format!("the load of `{kind}` acts at once, and this column's grows"),
                    format!("compare it with \"{}\"", of_problem[0]),
                );
            }
        }
        references.sort_by_key(|kind| of_problem.iter().position(|known| known == kind));
        references
    }
}

#[cfg(test)]
mod tests;
