//! Checks a study as typed, reports every mistake at its place, and plans its cases.

mod doubts;
mod expectations;
mod geometry;
pub mod outputs;
pub mod solvers;
mod sweeps;
mod values;

use crate::case::contender::Contender;
use crate::case::work_estimate::{READING_SECONDS, estimated_seconds};
use crate::case::{Case, Key, PlannedCase, Planner, Task, Tier, Value};
use crate::record::Record;
use crate::study::check::doubts::{Basis, Complaint, Doubts};
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
use oedometer_input::mending::{Rest, Unread};
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
    /// Whether all methods of the benchmark are among its methods.
    pub is_race: bool,
    /// Methods that cannot run here, by their names, each with the reason.
    pub not_applicable: Vec<(&'static str, String)>,
    /// Warnings, as text.
    pub warnings: Vec<String>,
}

impl Study {
    /// Checks a study.
    ///
    /// # Errors
    /// Every diagnostic with its place.
    pub fn check(source: &StudySource) -> Result<Self, StudyError> {
        Self::check_for(source, Purpose::Solving)
    }

    /// Checks a study for a purpose.
    ///
    /// # Errors
    /// Every diagnostic with its place.
    pub fn check_for(source: &StudySource, purpose: Purpose) -> Result<Self, StudyError> {
        let checked = |file: StudyFile| {
            let mut checker = Checker {
                source,
                complaints: Vec::new(),
                multiplied_out: 0,
                purpose,
                solvers: Vec::new(),
                refused_solvers: Vec::new(),
                is_race: false,
                not_applicable: Vec::new(),
                warnings: Vec::new(),
            };
            (checker.study(file), checker.complaints)
        };
        match StudyFile::read(source) {
            Ok(file) => match checked(file) {
                (study, complaints) if complaints.is_empty() => Ok(study),
                (_, complaints) => {
                    Err(source.error(complaints.into_iter().map(|complaint| complaint.diagnostic).collect()))
                }
            },
            Err(unread) => {
                let Unread { mut error, rest } = *unread;
                if let Some(Rest { read, places, left_out }) = rest {
                    let doubts = Doubts { text: &source.text, places, left_out };
                    error.diagnostics.extend(doubts.sure(checked(read).1));
                }
                Err(error)
            }
        }
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

    /// Whether an expectation says that a record is to end as it did. How a method of the benchmark ends is a result.
    pub fn foresees(&self, record: &Record) -> bool {
        self.is_race || self.case_expectations.iter().any(|expectation| expectation.foresees(record))
    }

    /// Whether an expectation says that a check of a record is to fail. How sound a method's runs are is a result of the race.
    pub fn foresees_complaints(&self, record: &Record) -> bool {
        self.is_race
            || self.case_expectations.iter().any(|expectation| expectation.foresees_complaints(record))
    }

    /// The cases of a tier.
    pub fn cases(&self, tier: Tier) -> Vec<&Case> {
        self.planned.iter().filter(|planned| planned.tier <= tier).map(|planned| &planned.case).collect()
    }
}

/// Diagnostics as they come up; every method gives a usable value or none.
struct Checker<'a> {
    source: &'a StudySource,
    complaints: Vec<Complaint>,
    /// Cases that the sweeps seen so far multiply out to.
    multiplied_out: usize,
    purpose: Purpose,
    /// Attached solvers, whose names are methods too.
    solvers: Vec<ExternalSolver>,
    /// Names of solvers and results that are refused: who names them makes no other mistake.
    refused_solvers: Vec<String>,
    /// Whether a sweep names the race.
    is_race: bool,
    /// Methods of the benchmark that the study refuses, with the reason.
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
    /// A case of the study before anything is swept.
    base: Case,
    /// The strain that it gives in place of a load.
    strain: Option<f64>,
}

impl Common {
    /// A case of a sweep with what follows from its inputs: its points of water, its load and its outputs.
    fn complete(&self, case: Case, outputs: &Outputs) -> Case {
        let mut case = case.as_its_solver_knows();
        case.column.points.name_water_points(case.points_per_cell);
        if let Some(strain) = self.strain {
            case.column.load = load_of(strain, &case);
        } else if case.scene.load == LoadKind::Pushed {
            // What the soil bears is what pressures are measured by.
            case.column.load = case.material.undrained_strength;
        }
        case.time_factors = outputs.of_case(&case);
        case
    }
}

impl Checker<'_> {
    /// Notes a diagnostic that rests on the values of its block and those before it.
    fn complain(&mut self, span: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        self.complain_by(Basis::Values, span, message, help);
    }

    /// Notes a diagnostic, with what it rests on.
    fn complain_by(
        &mut self,
        basis: Basis,
        span: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.complaints.push(Complaint { diagnostic: Diagnostic::at(span, message, help), basis });
    }

    /// Notes a warning, with which the study still runs.
    fn warn(&mut self, diagnostic: &Diagnostic) {
        self.warnings.push(diagnostic.warning(&self.source.name, &self.source.text));
    }

    fn study(&mut self, file: StudyFile) -> Study {
        let (scene, task) = (*file.scene, file.task.as_deref().copied().unwrap_or_default());
        let case_seconds =
            self.positive(file.case_seconds.as_ref(), "case_seconds", "s", DEFAULT_CASE_SECONDS);
        self.task_fits(&file, task);
        self.attach_solvers(&file, case_seconds);
        self.given_once(&file);
        let common = self.common(&file, Case::seed(task, scene));
        let outputs = self.outputs(&file.output.time_factors, &file.output.times);
        let outputs = outputs.unwrap_or_else(|| {
            Outputs::at_factors((scene.outputs)(&common.base.column, &common.base.material))
        });
        let references = self.references(&file.output, scene, &common.base.column);
        let planned = self.planned(&file, &common, &outputs);
        self.warn_of_unusual(&file, &planned);
        let subject = Subject::of(scene, &references, &planned, &common.base.column);
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
            has_dates: file.output.times.is_some() || file.sweep.iter().any(|table| table.times.is_some()),
            timing_repeats: timing_repeats.unwrap_or(0),
            golden,
            is_race: self.is_race,
            not_applicable: std::mem::take(&mut self.not_applicable),
            warnings: std::mem::take(&mut self.warnings),
        }
    }

    /// Complains of a search for the critical step where the motion is prescribed.
    fn task_fits(&mut self, file: &StudyFile, task: Task) {
        let is_prescribed = task == Task::Stability && file.scene.motion.is_some();
        if let Some(typed) = file.task.as_ref().filter(|_| is_prescribed) {
            self.complain(
                typed.span(),
                "the body forces of a manufactured solution hide what grows by itself: its critical step is \
                 predicted, not observed",
                "leave `task` out, or use another problem",
            );
        }
    }

    /// The cases of all sweeps and of all attached results, in the order of the file.
    fn planned(&mut self, file: &StudyFile, common: &Common, outputs: &Outputs) -> Vec<PlannedCase> {
        let given = self.attach_results(file);
        if file.sweep.is_empty() && file.result.is_empty() {
            let end = self.source.text.trim_end().len();
            let last_line = self.source.text[..end].rfind('\n').map_or(0, |newline| newline + 1);
            self.complain(
                last_line..end,
                "the study ends here without a [[sweep]] block",
                "add one with at least `method` and `cells`",
            );
        }
        let mut planner = Planner::default();
        for table in &file.sweep {
            let swept = self.outputs(&table.time_factors, &table.times);
            let outputs = swept.as_ref().unwrap_or(outputs);
            self.for_each_entry(table, |checker, entry| {
                checker.plan_block(file, table, (common, outputs), entry, &mut planner);
            });
        }
        let base = Case { time_factors: outputs.of_case(&common.base), ..common.base.clone() };
        if !given.is_empty() {
            self.times_are_possible(outputs, std::iter::once(base.clone()));
        }
        for meshes in given {
            for case in meshes.cases(&base) {
                planner.put(case, meshes.tier);
            }
        }
        let mut planned = planner.into_cases();
        tell_apart(&mut planned);
        planned
    }

    /// Plans the cases of a sweep, with the methods of an entry where it is a race.
    fn plan_block(
        &mut self,
        file: &StudyFile,
        table: &Placed<SweepTable>,
        (common, outputs): (&Common, &Outputs),
        entry: Option<&Contender>,
        planner: &mut Planner,
    ) {
        let Case { scene, task, .. } = common.base;
        // Where nothing moves a mesh that follows the soil is the same mesh.
        let moves = scene.configuration() == Configuration::Updated || task == Task::Stability;
        if entry.is_some_and(Contender::is_total) && !moves && scene.question != Question::Rest {
            return;
        }
        let (start, before) = (start_of(table), self.complaints.len());
        let Some(mut sweep) = self.sweep(table, &start, common, entry) else { return };
        let complete = |case: Case| common.complete(case, outputs);
        self.default_integrator((table, &start), common, &complete, &mut sweep);
        let cases = || sweep.cases(&common.base).map(complete);
        let unfit = entry.and_then(|entry| Some((entry, cases().find_map(|case| entry.unfit(&case))?)));
        if let Some((entry, why)) = unfit {
            self.leave_out(entry.name, why);
            return;
        }
        self.times_are_possible(outputs, cases());
        self.cases_are_possible(file, (table, &start), cases());
        planner.reserve(sweep.count().unwrap_or(0));
        // What cannot be fails the study, or is left out of a race.
        if entry.is_none() || self.complaints.len() == before {
            cases().for_each(|case| planner.put(case, table.tier));
        }
    }

    /// Warns of inputs that are likely to be meant otherwise.
    fn warn_of_unusual(&mut self, file: &StudyFile, planned: &[PlannedCase]) {
        self.units_are_meant(file, planned);
        self.large_for_small_strain(file, planned);
        self.unlike_any_soil(file, planned);
        self.projection_slows_waves(file, planned);
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
            // An expectation with a mistake in it has its own diagnostic.
            GoldenRule::None if !expects && self.complaints.is_empty() => self.complain(
                typed.span(),
                "nothing would be judged: the study has neither golden values nor expectations",
                "add an `[[expect]]`, or leave `golden` out",
            ),
            GoldenRule::Within(tolerance) if !(0.0..=MOST_TOLERANCE).contains(&tolerance) => self.complain(
                typed.span(),
                format!("a tolerance of {tolerance} of golden values is not between 0 and {MOST_TOLERANCE}"),
                "values that scatter more cannot be golden: use `golden = \"none\"` and expectations",
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
        given.extend(self.inputs("integrator", &file.integrator.inputs, &seed));
        if !seed.scene.formulations.has(&Formulation::QuasiStatic)
            && file.integrator.inputs.typed("formulation").is_none()
        {
            let waves = Value::Word(Formulation::VW.name());
            given.extend(Key::named("formulation", "integrator").map(|key| (key, waves)));
        }
        let mut base = seed.clone();
        for (key, value) in &given {
            key.set(&mut base, *value);
        }
        let strain = self.given_strain(file, &base);
        if let Some(strain) = strain {
            base.column.load = load_of(strain, &base);
        }
        base.column.soils = self.soils(file, &base);
        Common { seed, given, base, strain }
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
                    format!("the load of `{kind}` is sudden, but this column's grows"),
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
