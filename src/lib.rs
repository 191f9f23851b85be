//! `oedometer` verifies coupled material point solvers: its own, and external ones.
//!
//! # The map
//!
//! Crates (`crates/`), each of which uses only those above it:
//!
//! | crate | what it is |
//! | :-- | :-- |
//! | `oedometer-wording` | how numbers, times and names of choices are written and said |
//! | `oedometer-soil` | material, stress–strain laws, continuity; elementary functions with the same bits on every machine |
//! | `oedometer-exact` | exact solutions with bounds on their own errors ([`exact`]) |
//! | `oedometer-problem` | plain data between scenes and solvers: a problem, methods, integrators, steps, and what a run leaves |
//! | `oedometer-mpm` | the material point method: state, operators, steps, runs; knows no scene and no exact solution |
//! | `oedometer-scenes` | the physical problems by name, which solver they have unknown |
//! | `oedometer-convergence` | numbers only: series, orders, fits, classes, uncertainty |
//! | `oedometer-formats` | files of other programs, each format read into one form |
//! | `oedometer-case` | what scenes, solvers and records share: a case as plain data with its inputs, hash and label; what solves it ([`Solver`]), and what that leaves ([`Outcome`]) |
//! | `oedometer-input` | what people type: TOML with every mistake at its place, units, which key is meant |
//! | `oedometer-foreign` | other programs as solvers: case file, processes, mapping files, results turned into samples |
//! | `oedometer` | the harness: what follows |
//!
//! Folders of `src/`, each of which uses only those above it (`src/tests/source_order.rs`):
//!
//! | folder | what it is |
//! | :-- | :-- |
//! | `render/` | tables, charts and pages as text, Markdown, HTML and SVG; knows no study |
//! | `record/` | what is kept of a case, and its store on disk |
//! | `measure/` | from an outcome to its record: errors, balances, oscillation, checks |
//! | `study/` | study files: keys, sweeps, expectations, every mistake reported at its place |
//! | `campaign/` | runs the cases of a study: parallel, resumable, in shards |
//! | `golden/` | accepted values, their tolerances, and what changed |
//! | `history/` | results over time: two states beside each other, and golden values over commits |
//! | `score/` | external results compared with exact solutions, and what seems to be wrong with them |
//! | `judge/` | verdicts on studies |
//! | `race/` | the race to one per cent, as numbers |
//! | `questions/` | what readers ask of studies, answered as plain data |
//! | `report/` | composes tables and pages of verdicts and answers |
//! | [`api`] | the interface for other languages: names and lists in, lists out |
//! | `cli/` | one file per subcommand |
//!
//! # The equations
//!
//! Numbers are those of `docs/theory.md`; the paper is Zheng et al. (2021).
//!
//! | equation | what it is | place |
//! | :-- | :-- | :-- |
//! | 1, 2 (Zheng et al. Eqs 1, 2) | accelerations of water and mixture | `crates/mpm/src/drag/mod.rs:accelerations` |
//! | 3, 5 | porosity | `crates/soil/src/material.rs:porosity_at` |
//! | 4, 4' (Zheng et al. Eq. 6) | rate of the pressure | `crates/mpm/src/kernel/body.rs:volume_rate` |
//! | 6, 7 (Zheng et al. Eqs 7, 8) | stress–strain laws and conductivity | `crates/soil/src/law.rs:uniaxial_stress_ratio`, `crates/soil/src/law.rs:conductivity` |
//! | 8 | selective reduced integration | `crates/mpm/src/kernel/step.rs:update_pressure` |
//! | 9, 10, 11 | time-step limits by formula | `crates/problem/src/wave_speeds.rs:fastest_wave_speed`, `crates/problem/src/wave_speeds.rs:drag_limit`, `crates/problem/src/wave_speeds.rs:combined_limit` |
//! | 12 | consolidation | `crates/exact/src/consolidation/mod.rs:isochrone` |
//! | 13 | Xie & Leo's column | `crates/exact/src/xie_leo.rs:fields` |
//! | 14 | modes of the dynamic column | `crates/exact/src/dynamic_column/modes.rs:amplitude` |
//! | 15 | large strain in general | `crates/exact/src/large_strain/diffusion.rs:coefficients` |
//! | 16 | Mandel's slab | `crates/exact/src/mandel/sums.rs:sum`, `crates/exact/src/mandel/sums.rs:ratios` |
//! | 17 | chord mean of the conductivity | `crates/mpm/src/kernel/chord_mean.rs:take_chord_drag`, `crates/soil/src/law.rs:flow_potential` |
//! | 18 | rigid plate | `crates/mpm/src/actions/rigid_plate.rs:tie`, `crates/mpm/src/direct_solver/system.rs:solve` |
//! | 19 | own weight, free water | `crates/mpm/src/kernel/weighing_body.rs:add_weight` |
//! | 20 | pressure as a nodal field | `crates/mpm/src/operators/recovery/nodal.rs:fit` |
//! | 21 | domains of water points | `crates/mpm/src/integrate/double_point/following_water.rs:take_domains` |
//! | 22 | balances of double-point MPM | `crates/mpm/src/integrate/double_point/mod.rs:map_water_masses`, `crates/mpm/src/integrate/double_point/mod.rs:map_forces` |
//! | 23 | pressure along the water | `crates/mpm/src/integrate/double_point/water_pressure.rs:update_pressure` |
//! | 24, 25, 26, 27 | manufactured motions, and what acts on them | `crates/exact/src/manufactured/motion.rs:place`, `crates/exact/src/manufactured/motion_state.rs:new`, `crates/exact/src/manufactured/motion_state.rs:body_forces`, `crates/exact/src/manufactured/motion_state.rs:source` |
//! | 28 | neo-Hookean stress | `crates/soil/src/stiffness.rs:neo_hookean_stress` |
//! | 29 | the middle of a step | `crates/mpm/src/kernel/forced_body.rs:update_forced_pressure`, `crates/mpm/src/kernel/stresses.rs:middle_gradient` |
//! | 30 | shape functions of domains that turn | `crates/mpm/src/operators/corners.rs:build_corners`, `crates/mpm/src/operators/corners.rs:follow` |
//! | 32 | forces of cells with one rate | `crates/mpm/src/integrate/double_point/water_pressure.rs:add_cell_forces`, `crates/mpm/src/integrate/double_point/water_pressure.rs:keep_cell_rates` |
//! | 33 | velocities with their gradients (APIC) | `crates/mpm/src/actions/apic.rs:add_momenta` |
//! | 34 | lines that pressures fade to | `crates/mpm/src/integrate/double_point/pressure_lines.rs:fade_beyond_lines` |
//! | 35 | slopes of stresses | `crates/mpm/src/actions/stress_slopes.rs:add_forces`, `crates/mpm/src/actions/stress_slopes.rs:fit` |
//!
//! # The step
//!
//! Section 4 of the paper, read in `crates/mpm/src/kernel/step.rs:step_by_step`.
//!
//! | step | place |
//! | :-- | :-- |
//! | 1, grid | `crates/mpm/src/kernel/step.rs:reset_grid`, `crates/mpm/src/kernel/points_to_nodes.rs:build_basis_and_sum_points` |
//! | 2, accelerations | `crates/mpm/src/kernel/step.rs:nodal_accelerations`, `crates/mpm/src/kernel/points_to_nodes.rs:take_forces` |
//! | 3, nodal velocities | `crates/mpm/src/kernel/step.rs:nodal_velocities` |
//! | 4, points | `crates/mpm/src/kernel/nodes_to_points.rs:advance_points` |
//! | 5, mapping back | `crates/mpm/src/kernel/points_to_nodes.rs:take_velocities` |
//! | 6, effective stress | `crates/mpm/src/kernel/stresses.rs:update_effective_stress` |
//! | 7, pressure | `crates/mpm/src/kernel/step.rs:update_pressure`, `crates/mpm/src/operators/recovery/mod.rs:recover` |
//! | 8, next step | `crates/mpm/src/run/driver.rs:solve` |
//!
//! # A study from Rust
//!
//! What `oedometer check` does with a file, on the text of README's study: run its cases, judge what it expects. Where a solver of
//! your own in Rust takes the place of a method, [`run_study_with`] runs it.
//!
//! ```
//! use oedometer::{GoldenError, RunOptions, Study, StudyCheck, StudySource, Tier, run_study};
//!
//! let text = r#"
//! title = "my-study: how fast the error falls with the mesh"
//! scene = "terzaghi"
//!
//! [column]
//! height = 1.0
//! load = 1.0
//!
//! [material]
//! youngs_modulus = 1.0e6
//! poissons_ratio = 0.3
//! porosity = 0.3
//! hydraulic_conductivity = 1.0e-4
//! water_bulk_modulus = 2.2e9
//!
//! [output]
//! time_factors = [0.05, 0.1, 0.2, 0.5, 1.0]
//!
//! [[sweep]]
//! method = ["MPM", "GC-SRI-patch"]
//! integrator = ["implicit"]
//! cells = [5, 10, 20, 40]
//! points_per_cell = [2]
//! time_step = [{ growth = 0.01 }]
//!
//! [[expect]]
//! method = "GC-SRI-patch"
//! quantity = "pressure"
//! time_factor = 0.1
//! order = { value = 2.0, minus = 0.2, plus = 0.2 }
//! at = { cells = 10, below = 1.0e-2 }
//! "#;
//! let source = StudySource { name: "my-study.toml".to_owned(), text: text.to_owned() };
//! let study = Study::check(&source)?;
//! let report = run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {});
//!
//! let golden = Err(GoldenError::Missing("golden/my-study.csv".into()));
//! let check = StudyCheck::new(&study, &report.records, Tier::Full, golden);
//! let verdict = &check.judgements[0].verdict;
//! assert!(verdict.pass, "{}", verdict.reason);
//! let order = verdict.classification.order.expect("a converging series has an order");
//! assert!((order - 2.0).abs() < 0.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
// Tests and benches may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod api;
mod campaign;
mod cli;
mod golden;
mod history;
mod judge;
mod measure;
mod questions;
mod race;
mod record;
mod render;
mod report;
mod score;
mod study;

use oedometer_case as case;
use oedometer_foreign as foreign;
use oedometer_foreign::import;

pub use measure::soundness;
/// Exact solutions, by one door:
///
/// ```
/// use oedometer::exact::{ColumnParameters, Reference, ReferenceKind};
///
/// let column = ColumnParameters::default();
/// let terzaghi = Reference::new(ReferenceKind::TerzaghiIncompressible, &column, &[0.1])?;
/// let at_the_base = terzaghi.fields(0.1, 1.0)?.pressure / column.load;
/// // Terzaghi & Peck's chart; 50 digits in crates/exact/tests/reference/consolidation.csv.
/// assert!((at_the_base - 0.949_3).abs() < 1e-4);
/// # Ok::<(), oedometer::exact::ExactError>(())
/// ```
pub use oedometer_exact as exact;

// What a study is, and how it is run and judged.
pub use campaign::case_run::{column_problem, run_case};
pub use campaign::case_runner::run_study_with;
pub use campaign::runner::{RunOptions, Selected, run_studies, run_study};
pub use case::outcome::{Course, Outcome, Solver};
pub use case::planned::Tier;
pub use case::quantity::{Norm, Quantity, Sample};
pub use case::solver::SolverName;
pub use case::{Case, Task};
pub use cli::{main, main_with};
pub use golden::compare::compare;
pub use golden::measure::{GoldenKey, Measure};
pub use golden::tolerance::{LastDigit, spread_by_group};
pub use golden::{GoldenError, GoldenFile, values_of};
pub use import::SampledState;
pub use judge::study_check::{CheckEnd, StudyCheck};
pub use judge::study_results::StudyResults;
pub use measure::record_checks::{balance_checks, start_checks};
pub use questions::answers;
pub use questions::finding::Place;
pub use race::RaceFindings;
pub use record::provenance::{Origins, Provenance};
pub use record::store::RecordStore;
pub use record::{ErrorRow, Record, Status, WallSample};
pub use render::page::{Block, Page, figures, render_html, render_markdown};
pub use render::table::Table;
pub use report::answers::{Answers, Making, answer_page, matrix_page};
pub use report::check_page;
pub use report::junit::junit;
pub use report::studies_page::studies_page;
pub use report::study_page::study_page;
pub use report::tables::measures;
pub use score::score;
pub use study::check::Study;
pub use study::file::StudySource;

// What a problem is, and how it is solved.
pub use oedometer_mpm::run::{Kernel, Schedule};
pub use oedometer_mpm::time_limit::TimeLimit;
pub use oedometer_problem::integrator::IntegratorKind;
pub use oedometer_problem::method::{Basis, Configuration, Method};
pub use oedometer_problem::outcome::{Counters, Failure, FailureKind, StepSizes};
pub use oedometer_problem::settings::{Drag, ExplicitSettings};
pub use oedometer_problem::snapshot::Snapshot;
pub use oedometer_problem::time_step::TimeStep;
pub use oedometer_scenes as scenes;
pub use oedometer_scenes::Scene;
pub use oedometer_scenes::column::{Column, Shape};
pub use oedometer_soil::continuity::Continuity;
pub use oedometer_soil::law::Law;
pub use oedometer_soil::material::Material;

// What the benches time one by one, and what a random sweep asks before it runs a case.
#[doc(hidden)]
pub use case::work_estimate::estimated_seconds;
#[doc(hidden)]
pub use oedometer_mpm::integrate::assembled::step::AssembledStep;
#[doc(hidden)]
pub use oedometer_mpm::integrate::critical_step::predicted::predicted_critical_step;
#[doc(hidden)]
pub use oedometer_mpm::integrate::implicit::linear::LinearStepper;
#[doc(hidden)]
pub use oedometer_mpm::kernel::body::{Body, Discrete};
#[doc(hidden)]
pub use oedometer_mpm::run::{
    run_plan::Plan,
    stepper::{EqualSteps, Stepper},
};

#[cfg(test)]
mod tests;
