//! What the records of a situation of the race come to: per contender its meshes, its costs and why it does not arrive, and
//! its measures on the finest mesh that all share.

use crate::campaign::refinement::{Refinement, finest_mesh};
use crate::case::contender::{CONTENDERS, Contender};
use crate::case::{Quantity, Sample, Task};
use crate::judge::path_context;
use crate::judge::paths::{Path, first_error, first_measure};
use crate::measure::statistics::median;
use crate::race::finish::Question;
use crate::race::finish::{Level, RaceQuantity, Reason, cost_to, reason_of, seconds_to};
use crate::race::sensitivity::{OTHER_THRESHOLDS, THRESHOLD};
use crate::record::calibration::cost_of;
use crate::record::race_errors::{NEGLIGIBLE, ROUGH, RunErrors, errors_of, largest_error};
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_convergence::{Class, Classification};
use oedometer_problem::method::Configuration;
use oedometer_problem::wave_speeds;
use oedometer_scenes::SceneKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Thresholds to which the race tells the cost.
pub const THRESHOLDS: [f64; 3] = [ROUGH, THRESHOLD, NEGLIGIBLE];

/// A situation: a study whose sweeps name the race.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Situation {
    /// Its family: the first word of its name.
    pub family: String,
    /// Its name: that of its study, without the word `race`.
    pub name: String,
    /// The title of its study, without the word `Race`.
    pub title: String,
    /// Its study.
    pub study: String,
    /// Whether the soil moves far enough that points leave their cells.
    pub moves: bool,
    /// The integrator, by its name.
    pub integrator: String,
    /// Whether it judges a property, not an error: no row of the profiles.
    pub is_property: bool,
    /// Cells of the finest mesh that a contender may take.
    pub budget: usize,
    /// Cells of the finest mesh that every contender that can run here has run.
    pub common_cells: usize,
    /// One entry per contender, in their order.
    pub entries: Vec<Entry>,
}

/// A contender in a situation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Entry {
    /// The contender.
    pub contender: String,
    /// Its runs, from coarse to fine, up to the first that arrives at 0.1 %.
    pub levels: Vec<Level>,
    /// Counted cost to 10 %, 1 % and 0.1 % of all quantities, s.
    pub costs: [Option<f64>; 3],
    /// Measured seconds to 1 %.
    pub seconds: Option<f64>,
    /// Why it does not arrive at 1 %; none where it does.
    pub reason: Option<Reason>,
    /// What the program says of the failure or the refusal.
    pub detail: String,
    /// Errors on the common mesh.
    pub errors: RunErrors,
    /// Counted cost on the common mesh, s.
    pub cost: Option<f64>,
    /// Order of the pressure at the output of its largest error.
    pub order: Option<f64>,
    /// Class of that series, by its name.
    pub class: Option<String>,
    /// Relative change of the largest error by half the step.
    pub scatter: Option<f64>,
    /// Oscillation index of the pressure.
    pub oscillation: Option<f64>,
    /// Computed over exact settlement; of a plane one minus the error of the displacement.
    pub locking: Option<f64>,
    /// Critical step over the formula's: observed where the study observes it, predicted in other explicit runs.
    pub step_ratio: Option<f64>,
    /// Asymmetry of the stiffness of skeleton and water, where the study observes the critical step: round-off where
    /// the forces do the power of the stresses.
    pub asymmetry: Option<[f64; 2]>,
    /// Largest velocity over the conductivity where nothing may move.
    pub spurious_velocity: Option<f64>,
}

/// What a contender costs to other ends than 10 %, 1 % and 0.1 % of all quantities, s.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherCosts {
    /// To 1 % of each quantity alone.
    pub alone: [Option<f64>; 3],
    /// To the other thresholds of all quantities.
    pub thresholds: [Option<f64>; OTHER_THRESHOLDS.len()],
}

impl OtherCosts {
    /// Those of an entry.
    pub fn new(entry: &Entry) -> Self {
        let alone = [RaceQuantity::Pressure, RaceQuantity::Stress, RaceQuantity::Settlement];
        Self {
            alone: alone.map(|quantity| entry.cost_to(quantity, THRESHOLD)),
            thresholds: OTHER_THRESHOLDS.map(|threshold| entry.cost_to(RaceQuantity::All, threshold)),
        }
    }
}

impl Entry {
    /// Cost to a threshold of a quantity, s.
    pub fn cost_to(&self, quantity: RaceQuantity, threshold: f64) -> Option<f64> {
        cost_to(&self.levels, quantity, threshold)
    }

    /// The largest of its errors on the common mesh.
    pub fn largest_error(&self) -> Option<f64> {
        RaceQuantity::All.error_in(&self.errors)
    }
}

impl Situation {
    /// The situation of a study and its records; `None` where the study is not of the race or nothing has run.
    pub fn from_records(study: &Study, records: &[Record]) -> Option<Self> {
        if !study.is_race || records.is_empty() {
            return None;
        }
        let runs: Vec<(&Contender, Runs<'_>)> =
            CONTENDERS.iter().map(|contender| (contender, Runs::new(study, contender, records))).collect();
        let meshes =
            |runs: &Runs<'_>| runs.path.iter().map(|record| record.case.cells).collect::<BTreeSet<_>>();
        let common = runs.iter().map(|(_, runs)| meshes(runs)).filter(|meshes| !meshes.is_empty());
        let common_cells = common.reduce(|one, other| &one & &other)?.into_iter().next_back()?;
        let name = study.name.strip_prefix("race-").unwrap_or(&study.name);
        let case = &records[0].case;
        Some(Self {
            family: name.split('-').next().unwrap_or_default().to_owned(),
            name: name.to_owned(),
            title: study.title.strip_prefix("Race: ").unwrap_or(&study.title).to_owned(),
            study: study.name.clone(),
            moves: study.scene.configuration() == Configuration::Updated,
            integrator: case.integrator.name().to_owned(),
            is_property: study.scene.is_at_rest() || case.task == Task::Stability,
            budget: finest_mesh(study),
            common_cells,
            entries: runs
                .iter()
                .map(|(contender, runs)| entry(study, contender, runs, common_cells))
                .collect(),
        })
    }
}

/// What a reader asks first of a situation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Arrivals {
    /// Contenders that reach 1 %.
    pub arrived: usize,
    /// Contenders of the race.
    pub contenders: usize,
    /// The cheapest to 1 % for each question, where one arrives.
    pub cheapest: Vec<Cheapest>,
}

/// The cheapest contender to 1 % for a question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cheapest {
    /// The question.
    pub question: Question,
    /// The contender.
    pub method: String,
    /// Its counted cost, s.
    pub cost: f64,
}

impl Situation {
    /// Who arrives, and who at the least cost.
    pub fn arrivals(&self) -> Arrivals {
        let arrived = || self.entries.iter().filter_map(|entry| Some((entry, entry.costs[1]?)));
        let cheapest = |question: Question| {
            let own = arrived().filter(|(entry, _)| question.takes(&entry.contender));
            let (entry, cost) = own.min_by(|a, b| a.1.total_cmp(&b.1))?;
            Some(Cheapest { question, method: entry.contender.clone(), cost })
        };
        Arrivals {
            arrived: arrived().count(),
            contenders: self.entries.len(),
            cheapest: Question::BOTH.into_iter().filter_map(cheapest).collect(),
        }
    }
}

fn entry(study: &Study, contender: &Contender, runs: &Runs<'_>, common_cells: usize) -> Entry {
    let levels: Vec<Level> = runs.path.iter().copied().map(level).collect();
    let on_mesh = runs.path.iter().copied().find(|record| record.case.cells == common_cells);
    let finest = runs.path.last().copied();
    let failure = finest.and_then(|record| record.status.failure());
    let refused = study.not_applicable.iter().find(|(name, _)| *name == contender.name);
    let stiffness = finest.and_then(stiffness_of);
    let reason = match refused {
        Some(_) => Some(Reason::ByDefinition),
        None if cost_to(&levels, RaceQuantity::All, THRESHOLD).is_some() => None,
        None => Some(reason_of(&levels, failure.map(|failure| failure.kind.name()), stiffness)),
    };
    let told = |record: &Record| record.status.failure().map(|failure| failure.reason.clone());
    let classified = runs.classified();
    Entry {
        contender: contender.name.to_owned(),
        costs: THRESHOLDS.map(|threshold| cost_to(&levels, RaceQuantity::All, threshold)),
        seconds: seconds_to(&levels, RaceQuantity::All, THRESHOLD),
        detail: refused.map(|(_, why)| why.clone()).or_else(|| finest.and_then(told)).unwrap_or_default(),
        reason,
        errors: on_mesh.map_or([None; 3], errors_of),
        cost: on_mesh.map(cost_of),
        order: classified.as_ref().and_then(|classified| classified.order),
        class: classified.as_ref().map(|classified| Class::name(classified.class).to_owned()),
        scatter: runs.two_steps.and_then(|(long, short)| scatter_of(long, short)),
        oscillation: on_mesh.and_then(oscillation_of),
        locking: on_mesh.and_then(locking_of),
        step_ratio: on_mesh.and_then(step_ratio_of),
        asymmetry: on_mesh.and_then(|record| record.stability.as_ref()?.asymmetry),
        spurious_velocity: on_mesh
            .filter(|record| record.case.scene.is_at_rest())
            .and_then(spurious_velocity_of),
        levels,
    }
}

fn level(record: &Record) -> Level {
    let seconds: Vec<f64> = record.wall.iter().filter_map(|sample| sample.cpu_seconds).collect();
    Level {
        cells: record.case.cells,
        cost: cost_of(record),
        seconds: median(&seconds),
        errors: errors_of(record),
    }
}

/// The runs of a contender: one path over the mesh, and one of its meshes again with half its step.
#[derive(Clone, Debug)]
pub struct Runs<'a> {
    /// From coarse to fine, up to the first that arrives.
    pub path: Vec<&'a Record>,
    /// The run on a mesh, and that with half its step.
    pub two_steps: Option<(&'a Record, &'a Record)>,
}

impl<'a> Runs<'a> {
    /// Those of a contender among the records of a study. Where it has two steps on a mesh, the longer one is the race's.
    /// Meshes that the race would not have run are left out, whoever ran them.
    pub fn new(study: &Study, contender: &Contender, records: &'a [Record]) -> Self {
        let is_refused = study.not_applicable.iter().any(|(name, _)| *name == contender.name);
        let mut runs: Vec<&Record> =
            records.iter().filter(|record| !is_refused && contender.runs(&record.case)).collect();
        let step = |record: &Record| record.step_sizes.target;
        runs.sort_by(|a, b| a.case.cells.cmp(&b.case.cells).then(step(b).total_cmp(&step(a))));
        let (mut path, mut two_steps) = (Vec::<&Record>::new(), None);
        let mut refinement = Refinement::of(study);
        for record in runs {
            match path.last() {
                // Of several shorter steps the longest.
                Some(last) if last.case.cells == record.case.cells => {
                    let is_known = |pair: &(&Record, &Record)| std::ptr::eq(pair.0, *last);
                    two_steps = two_steps.filter(is_known).or(Some((*last, record)));
                }
                _ if !refinement.wants(&record.case) => break,
                _ => {
                    refinement.add(record);
                    path.push(record);
                }
            }
        }
        Self { path, two_steps }
    }

    /// The class of the pressure's series, of a footing of its load's, at the output of its largest error on the finest mesh.
    fn classified(&self) -> Option<Classification> {
        let finest = *self.path.last()?;
        let reference = finest.references.first()?.name.as_str();
        let (quantity, sample) = match finest.case.scene {
            SceneKind::Footing => (Quantity::LoadFactor, Sample::Surface),
            _ => (Quantity::Pressure, Sample::Points),
        };
        let error = |time: f64| first_error(finest, quantity, sample, reference, time);
        let times = finest.case.time_factors.iter().copied().filter(|time| error(*time).is_some());
        let time = times.max_by(|a, b| error(*a).unwrap_or(0.0).total_cmp(&error(*b).unwrap_or(0.0)))?;
        let path = Path { axis: Axis::Cells, records: self.path.clone(), smaller_step: None };
        let measure = first_measure(quantity, sample, reference, time);
        Some(path.summary(&measure).classification)
    }
}

/// Relative change of the largest error from one run to another.
fn scatter_of(long: &Record, short: &Record) -> Option<f64> {
    Some((largest_error(short)? / largest_error(long)? - 1.0).abs())
}

/// Oscillation index of the pressure at the last output.
fn oscillation_of(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.last()?);
    let measure = first_measure(Quantity::Pressure, Sample::Points, &reference.name, time);
    path_context::oscillation_of(record, &measure)
}

/// Computed over exact settlement at the first output; of a plane one minus the error of the displacement.
fn locking_of(record: &Record) -> Option<f64> {
    settlement_ratio(record).or_else(|| {
        let (reference, time) = (record.references.first()?, *record.case.time_factors.first()?);
        let error = first_error(record, Quantity::Displacement, Sample::Nodes, &reference.name, time)?;
        Some(1.0 - error)
    })
}

/// Computed over exact settlement at the first output.
fn settlement_ratio(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.first()?);
    let row = record.errors.iter().find(|row| {
        row.reference == reference.name && row.time_factor == time && row.quantity == Quantity::Settlement
    })?;
    Some(1.0 + row.value)
}

/// What tells a body that locks: how much of the exact settlement it reaches, under a footing of the soil's load over its
/// own, in a layer of water and soil that hardly compress one minus the error of its displacement.
fn stiffness_of(record: &Record) -> Option<f64> {
    match record.case.scene {
        SceneKind::Footing => Some(1.0 / (1.0 + errors_of(record)[2]?)),
        scene if scene.shows_locking() => locking_of(record),
        _ => settlement_ratio(record).filter(|_| record.status == Status::Ok),
    }
}

/// Largest velocity over the conductivity of a run in which nothing may move.
fn spurious_velocity_of(record: &Record) -> Option<f64> {
    record.balance.iter().filter_map(|balance| balance.spurious_velocity).max_by(f64::total_cmp)
}

/// Critical step over the formula's: observed, or else predicted for an explicit run.
fn step_ratio_of(record: &Record) -> Option<f64> {
    if let Some(stability) = &record.stability {
        return Some(stability.observed? / stability.combined_limit);
    }
    let case = &record.case;
    let limit = wave_speeds::combined_limit(&case.material, case.cell_size(), case.settings.drag);
    let ratio = record.step_sizes.predicted_critical / limit;
    // The formula itself stands where no limit is known.
    (case.is_explicit() && ratio.is_finite() && ratio > 0.0 && ratio != 1.0).then_some(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{solved, study_of};
    use oedometer_problem::outcome::{Failure, FailureKind};

    const TEXT: &str = "title = 'Race: a front'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [8, 2, 4]\ntime_step = [{ growth = 0.1 }]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [4]\ntime_step = [{ growth = 0.05 }]\n";

    /// A race of two contenders; their errors are 1/cells times a factor per quantity, half of it at the first output.
    fn race() -> (Study, Vec<Record>) {
        let (study, mut records) = solved("race-early-front", TEXT);
        records.retain(|record| ["GIMP", "MPM"].contains(&&*record.case.method.to_string()));
        for record in &mut records {
            for row in &mut record.errors {
                let share = if row.time_factor == 0.2 { 1.0 } else { 0.5 };
                row.value = share / record.case.cells as f64
                    * match (row.quantity, row.sample) {
                        (Quantity::Pressure, Sample::Points) => 0.25,
                        (Quantity::EffectiveStress, Sample::Points) => 0.125,
                        (Quantity::Settlement, _) => -1.0,
                        _ => 9.0,
                    };
            }
        }
        (study, records)
    }

    #[test]
    fn an_entry_has_its_meshes_costs_and_reason_and_what_it_is_on_the_common_mesh() {
        let (study, mut records) = race();
        let longer = |record: &Record| record.case.label().contains("growth=0.1");
        for record in &mut records {
            match (record.case.cells, &*record.case.method.to_string()) {
                // Of the race's run a quarter is lost by half the step.
                (4, "GIMP") if !longer(record) => record.errors.iter_mut().for_each(|row| row.value *= 0.75),
                (4 | 8, "MPM") => {
                    let failure = Failure::of_attached(FailureKind::Unstable, "it grew".to_owned());
                    record.status = Status::Failed(failure);
                }
                _ => {}
            }
        }
        for _ in 0..2 {
            let situation = Situation::from_records(&study, &records).expect("a race");
            assert_eq!((situation.family.as_str(), situation.name.as_str()), ("early", "early-front"));
            assert_eq!(
                (situation.title.as_str(), situation.budget, situation.common_cells),
                ("a front", 8, 8)
            );
            assert!(!situation.moves && !situation.is_property);
            let of =
                |name: &str| situation.entries.iter().find(|one| one.contender == name).expect("an entry");
            let gimp = of("GIMP");
            let errors = |cells: f64| [0.25, 0.125, 1.0].map(|error| Some(error / cells));
            assert_eq!(gimp.levels.iter().map(|one| one.cells).collect::<Vec<_>>(), [2, 4, 8]);
            assert_eq!((gimp.levels[0].errors, gimp.errors), (errors(2.0), errors(8.0)));
            assert_eq!((gimp.largest_error(), gimp.scatter), (Some(0.125), Some(0.25)));
            // The settlement is one eighth off at the last output, at the first one sixteenth.
            assert_eq!((gimp.reason.clone(), gimp.locking), (Some(Reason::Budget), Some(1.0 - 1.0 / 16.0)));
            assert_eq!(gimp.costs, [None; 3]);
            assert_eq!(gimp.cost_to(RaceQuantity::Stress, 0.02).map(|cost| cost > 0.0), Some(true));
            let mpm = of("MPM");
            assert_eq!(mpm.reason, Some(Reason::Failed("unstable".to_owned())));
            assert_eq!((mpm.detail.as_str(), mpm.errors), ("it grew", [None; 3]));
            assert_eq!(of("PPP").reason, Some(Reason::NotRun));
            records.reverse();
        }
        let plain = study_of("plain", &TEXT.replace("'race'", "'GIMP'"));
        assert!(Situation::from_records(&plain, &records).is_none(), "no race");
        assert!(Situation::from_records(&study, &[]).is_none(), "nothing has run");
    }

    #[test]
    fn meshes_beyond_the_first_that_arrives_do_not_count_whoever_ran_them() {
        let (study, mut records) = race();
        for record in records.iter_mut().filter(|record| record.case.cells == 4) {
            record.errors.iter_mut().for_each(|row| row.value = 1e-4);
        }
        let situation = Situation::from_records(&study, &records).expect("a race");
        assert!(
            situation.entries.iter().all(|entry| entry.levels.last().is_none_or(|level| level.cells == 4))
        );
        let gimp = situation.entries.iter().find(|one| one.contender == "GIMP").expect("an entry");
        assert!(gimp.reason.is_none() && gimp.costs.iter().all(Option::is_some));
    }

    #[test]
    fn a_contender_that_the_program_refuses_has_the_reason_and_no_alias_runs_for_it() {
        let text = TEXT.replace("terzaghi", "mandel").replace("[8, 2, 4]", "[10]").replace("[4]", "[10]");
        let (study, records) = solved("race-layer-small", &text);
        let situation = Situation::from_records(&study, &records).expect("a race");
        let refused: Vec<&Entry> =
            situation.entries.iter().filter(|one| one.reason == Some(Reason::ByDefinition)).collect();
        assert!(refused.iter().any(|one| one.contender == "B2-Bbar-patch"));
        assert!(refused.iter().all(|one| one.levels.is_empty() && !one.detail.is_empty()));
        let locks = |entry: &&Entry| entry.reason == Some(Reason::Locks);
        assert_eq!(situation.entries.iter().filter(locks).count(), 0);
    }
}
