//! `oedometer` verifies coupled material point solvers: its own, and external ones.
//!
//! # The map
//!
//! A folder imports only folders of the lines above its own; `tests/unit/architecture.rs` holds the table.
//!
//! | folder | what it is |
//! | :-- | :-- |
//! | `elementary`, `wording`, `sorting` | elementary functions with the same bits everywhere; numbers in sentences; sorts |
//! | `soil/` | material, stress–strain laws, continuity |
//! | [`exact`] | series solutions with bounds on their own errors |
//! | `convergence/` | numbers only: series, orders, fits, classes, uncertainty |
//! | `mpm/` | the material point method: state, operators, explicit, assembled and implicit steps, runs |
//! | `scene/` | physical problems: geometry, load, start, references that hold |
//! | `case/` | a case as plain data: its inputs, hash, label; quantities, samples, norms |
//! | `record/` | what is kept of a case, and its store on disk |
//! | `measure/` | from an outcome to its record: errors, balances, oscillation, checks |
//! | `formats/` | files of other programs, each format read into one form |
//! | `study/` | study files: keys, sweeps, expectations, every complaint at its place |
//! | `import/` | external results: mapping files, and tables and frames turned into samples |
//! | `foreign/` | attached solvers: what they are told, how they are run and ended, how their results are taken |
//! | `campaign/` | runs the cases of a study: parallel, resumable, by shards |
//! | `golden/` | accepted values, their tolerances, and what changed |
//! | `judge/` | verdicts on studies, scores of external results, comparisons of methods |
//! | `render/` | tables, charts, pages; sees records and verdicts, and never a solver |
//! | `cli/` | one file per subcommand |
//! | [`api`] | the door for other languages: names and lists in, lists out |
//!
//! `elementary`, `wording`, `sorting`, `soil/`, [`exact`], `mpm/` and `scene/` are a crate of their own, `oedometer-solver`
//! (`src/solver.rs`), compiled with every optimisation; `convergence/`, `case/`, `record/`, `measure/` and `formats/` are
//! another,
//! `oedometer-records` (`src/records.rs`), with some; the rest only leads there and has none.
//!
//! # The equations
//!
//! Numbers are those of `docs/theory.md`; the paper is Zheng et al. (2021).
//!
//! | equation | what it is | place |
//! | :-- | :-- | :-- |
//! | 1, 2 (Zheng et al. Eqs 1, 2) | accelerations of water and mixture | `src/mpm/momentum.rs:accelerations` |
//! | 3, 5 | porosity | `src/soil/material.rs:porosity_at` |
//! | 4, 4' (Zheng et al. Eq. 6) | rate of the pressure | `src/mpm/body.rs:volume_rate` |
//! | 6, 7 (Zheng et al. Eqs 7, 8) | stress–strain laws and conductivity | `src/soil/law.rs:uniaxial_stress_ratio`, `src/soil/law.rs:conductivity` |
//! | 8 | selective reduced integration | `src/mpm/explicit/mod.rs:update_pressure` |
//! | 9, 10, 11 | time-step limits by formula | `src/mpm/critical_step/formula.rs:fastest_wave_speed`, `src/mpm/critical_step/formula.rs:combined_limit` |
//! | 12 | consolidation | `src/exact/consolidation/mod.rs:isochrone` |
//! | 13 | Xie & Leo's column | `src/exact/xie_leo.rs:fields` |
//! | 14 | modes of the dynamic column | `src/exact/dynamic_column/modes.rs:amplitude` |
//! | 15 | large strain in general | `src/exact/large_strain/diffusion.rs:coefficients` |
//! | 16 | Mandel's slab | `src/exact/mandel/eigenmode_series.rs:sum`, `src/exact/mandel/early.rs:ratios` |
//! | 17 | chord mean of the conductivity | `src/mpm/operators/chord_mean.rs:take_chord_drag`, `src/soil/conductivity_mean.rs:flow_potential` |
//! | 18 | rigid plate | `src/mpm/operators/rigid_plate.rs:tie`, `src/mpm/direct_solver/bordered.rs:solve` |
//! | 19 | own weight, free water | `src/mpm/weighing_body.rs:add_weight` |
//! | 20 | pressure as a nodal field | `src/mpm/operators/recovery/nodal_field.rs:fit` |
//! | 21 | domains of water points | `src/mpm/layers/water_domains.rs:take_domains` |
//! | 22 | balances of two layers | `src/mpm/layers/water_to_nodes.rs:map_water_masses`, `src/mpm/layers/water_to_nodes.rs:map_forces` |
//! | 23 | pressure along the water | `src/mpm/layers/water_pressure.rs:update_pressure` |
//! | 24, 25, 26, 27 | manufactured motions, and what acts on them | `src/exact/manufactured/motion.rs:place`, `src/exact/manufactured/motion_state.rs:of`, `src/exact/manufactured/motion_state.rs:body_forces`, `src/exact/manufactured/motion_state.rs:source` |
//! | 28 | neo-Hookean stress | `src/soil/law.rs:neo_hookean_stress` |
//! | 29 | the middle of a step | `src/mpm/forced_body.rs:update_forced_pressure`, `src/mpm/explicit/deformation.rs:middle_gradient` |
//! | 30 | weights of domains that turn | `src/mpm/operators/corners.rs:build_corners`, `src/mpm/state/domains.rs:follow` |
//! | 31 | cells that remember a confined soil | `src/mpm/state/confined_points.rs:share_out`, `src/mpm/state/cell_memory.rs:spread_over_points` |
//! | 32 | forces of cells with one rate | `src/mpm/layers/cell_forces.rs:map_cell_forces`, `src/mpm/layers/cell_pressures.rs:keep_cell_rates` |
//! | 33 | slopes of velocities | `src/mpm/explicit/affine.rs:add_slopes` |
//! | 34 | lines that pressures fade to | `src/mpm/layers/pressure_lines.rs:fade_beyond_lines` |
//! | 35 | slopes of stresses | `src/mpm/explicit/stress_slopes.rs:add_stress_slopes`, `src/mpm/state/stress_planes.rs:fit` |
//!
//! # The step
//!
//! Section 4 of the paper, read in `src/mpm/explicit/mod.rs:kick_and_drift`.
//!
//! | step | place |
//! | :-- | :-- |
//! | 1, grid | `src/mpm/explicit/mod.rs:reset_grid`, `src/mpm/explicit/points_to_nodes.rs:map_masses_velocities_and_forces` |
//! | 2, accelerations | `src/mpm/explicit/points_to_nodes.rs:map_forces`, `src/mpm/explicit/mod.rs:nodal_accelerations` |
//! | 3, nodal velocities | `src/mpm/explicit/nodal_step.rs:nodal_velocities` |
//! | 4, points | `src/mpm/explicit/nodes_to_points.rs:advance_points` |
//! | 5, mapping back | `src/mpm/explicit/nodes_to_points.rs:advance_points_and_map_back`, `src/mpm/explicit/points_to_nodes.rs:map_velocities` |
//! | 6, effective stress | `src/mpm/explicit/stresses.rs:update_effective_stress` |
//! | 7, pressure | `src/mpm/explicit/mod.rs:update_pressure`, `src/mpm/operators/recovery/mod.rs:recover` |
//! | 8, next step | `src/mpm/run/driver.rs:solve` |
//!
//! # A study from Rust
//!
//! What `oedometer check` does with a file, on a text: run its cases, judge what it expects.
//!
//! ```
//! use oedometer::{GoldenError, RunOptions, Study, StudyCheck, StudySource, Tier, run_study};
//!
//! let text = r#"
//! title = "How fast the error falls with the mesh"
//! scene = "terzaghi"
//! output = { time_factors = [0.1] }
//!
//! [[sweep]]
//! method = ["GC-SRI-patch"]
//! integrator = ["implicit"]
//! cells = [10, 20, 40]
//! time_step = [{ growth = 0.005 }]
//!
//! [[expect]]
//! method = "GC-SRI-patch"
//! integrator = "implicit"
//! quantity = "pressure"
//! time_factor = 0.1
//! order = { value = 2.0, minus = 0.2, plus = 0.2 }
//! "#;
//! let source = StudySource { name: "first.toml".to_owned(), text: text.to_owned() };
//! let study = Study::check(&source).expect("a sound study");
//! let report = run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {});
//!
//! let golden = Err(GoldenError::Missing("golden/first.csv".into()));
//! let check = StudyCheck::new(&study, &report.records, Tier::Full, golden);
//! let verdict = &check.judgements[0].verdict;
//! assert!(verdict.pass, "{}", verdict.reason);
//! let order = verdict.classification.order.expect("a converging series has an order");
//! assert!((order - 2.0).abs() < 0.2);
//! ```
// Tests and benches may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod api;
mod campaign;
mod cli;
mod foreign;
mod golden;
mod import;
mod judge;
mod render;
mod schema;
mod study;

use oedometer_records::{case, convergence, formats, measure, record};
/// Exact solutions, by one door:
///
/// ```
/// use oedometer::exact::{ColumnParameters, Reference, ReferenceKind};
///
/// let column = ColumnParameters::default();
/// let terzaghi = Reference::new(ReferenceKind::TerzaghiIncompressible, &column, &[0.1])?;
/// let at_the_base = terzaghi.fields(0.1, 1.0)?.pressure / column.load;
/// // Terzaghi & Peck's chart; 50 digits in tests/reference/consolidation.csv.
/// assert!((at_the_base - 0.949_3).abs() < 1e-4);
/// # Ok::<(), oedometer::exact::ExactError>(())
/// ```
pub use oedometer_solver::exact;
use oedometer_solver::{elementary, mpm, scene, soil, sorting, wording};

// What a study is, and how it is run and judged.
pub use campaign::case_run::run_case;
pub use campaign::run_options::{RunOptions, Selected};
pub use campaign::runner::{run_studies, run_study};
pub use case::norm::Norm;
pub use case::quantity::{Quantity, Sample};
pub use case::tier::Tier;
pub use case::{Case, Task};
pub use cli::{main, main_with};
pub use golden::compare::compare;
pub use golden::tolerance::spread_by_group;
pub use golden::{GoldenError, GoldenFile, values_of};
pub use import::table::SampledState;
pub use judge::comparison::situation::{Ended, ends_of};
pub use judge::score::score;
pub use judge::soundness;
pub use judge::study_check::{CheckEnd, StudyCheck};
pub use measure::record_checks::{balance_checks, start_checks};
pub use record::origins::Origins;
pub use record::provenance::Provenance;
pub use record::store::RecordStore;
pub use record::{ErrorRow, Record, Status, WallSample};
pub use render::answers::making::Making;
pub use render::answers::{Answers, answer_page};
pub use render::checks::{junit, verdicts};
pub use render::page::html_page::render_html;
pub use render::page::markdown_page::render_markdown;
pub use render::page::{Block, Page, figures};
pub use render::report::StudyResults;
pub use render::report::pages::index_page;
pub use render::report::situations::situations_page;
pub use render::report::study_page::study_page;
pub use render::table::Table;
pub use render::tables::measures;
pub use study::check::Study;
pub use study::file::StudySource;
pub use study::perturbed::LastDigit;

// What a problem is, and how it is solved.
pub use mpm::explicit::{Drag, ExplicitSettings};
pub use mpm::method::{Basis, Configuration, Method};
pub use mpm::run::integrator::IntegratorKind;
pub use mpm::run::results::outcome::{Counters, Failure, FailureKind, StepSizes};
pub use mpm::run::results::snapshot::Snapshot;
pub use mpm::run::{Kernel, Schedule, TimeStepRule};
pub use mpm::time_limit::TimeLimit;
pub use scene::SceneKind;
pub use scene::column::Column;
pub use scene::problem::column_problem;
pub use soil::continuity::Continuity;
pub use soil::law::Law;
pub use soil::material::Material;

// What the benches time one by one, and what a random sweep asks before it runs a case.
#[doc(hidden)]
pub use case::work_estimate::estimated_seconds;
#[doc(hidden)]
pub use mpm::assembled::step::AssembledStep;
#[doc(hidden)]
pub use mpm::body::{Body, Problem};
#[doc(hidden)]
pub use mpm::critical_step::predicted::predicted_critical_step;
#[doc(hidden)]
pub use mpm::implicit::linear::LinearStepper;
#[doc(hidden)]
pub use mpm::run::{
    run_plan::Plan,
    stepper::{EqualSteps, Stepper},
};
#[doc(hidden)]
pub use scene::stepped_column::SteppedColumn;

#[cfg(test)]
#[path = "../tests/unit/mod.rs"]
mod tests;
