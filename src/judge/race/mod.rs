//! The race: every contender in every situation, by the same study. A situation is a study whose sweeps name the race;
//! a contender has one cell in each, and what is measured of its runs stands there.

pub mod grid;

use crate::case::contender::{CONTENDERS, Contender};
use crate::case::{Quantity, Sample};
use crate::judge::paths::{Path, first_error, first_measure};
use crate::judge::race::grid::{Grid, GridRow, Score};
use crate::judge::{path_context, soundness};
use crate::measure::statistics::{largest, median};
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_convergence::{Class, Classification};
use oedometer_mpm::critical_step::formula;
use oedometer_mpm::scene::SceneKind;
use oedometer_soil::elementary;
use std::collections::BTreeSet;

/// An error of the size of the result itself is no usable result: a body that locks, a pressure that jumps.
pub const USELESS: f64 = 1.0;

/// A situation with one cell per contender.
#[derive(Clone, Debug)]
pub struct RaceRow<'a> {
    /// Its study.
    pub study: &'a Study,
    /// Its group: the first word of its name.
    pub group: &'a str,
    /// The finest mesh that every contender that can run here has run: cells over the height.
    pub cells: usize,
    /// One cell per contender, in their order.
    pub contenders: Vec<RaceCell>,
}

/// How a contender did in a situation; `None` where something was not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct RaceCell {
    /// The contender.
    pub name: &'static str,
    /// Largest errors over the outputs on the common mesh: of pressure, effective stress, and settlement or displacement.
    pub errors: [Option<f64>; 3],
    /// Largest errors on every mesh, with the cell size, m, from coarse to fine.
    pub levels: Vec<(f64, [Option<f64>; 3])>,
    /// Order of the pressure at the output of its largest error, with its class.
    pub order: Option<f64>,
    /// Class of that series.
    pub class: Option<Class>,
    /// Processor seconds to an error of 1 % and of 0.1 %, between meshes by powers.
    pub cost: [Option<f64>; 2],
    /// Oscillation index of the pressure.
    pub oscillation: Option<f64>,
    /// Computed over exact settlement; of a plane one minus the error of the displacement.
    pub locking: Option<f64>,
    /// Critical step over the formula's: observed where the study observes it, predicted in other explicit runs.
    pub step_ratio: Option<f64>,
    /// Asymmetry of the stiffness of skeleton and water, where the study observes the critical step: round-off where the
    /// forces do the power of the stresses.
    pub asymmetry: Option<[f64; 2]>,
    /// What the cell is ranked by: smaller is better. The largest of its errors, what moves at rest, or the formula's step
    /// over the observed one.
    pub score: Option<f64>,
    /// Relative change of the score by half the step.
    pub scatter: Option<f64>,
    /// How the runs ended.
    pub ended: Ended,
    /// What is wrong with a balance of the run on the common mesh, where something is.
    pub complaint: Option<String>,
}

/// How the runs of a cell ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// With a result on every mesh.
    Well,
    /// A run failed: the failure by its name, and the sentence of the run.
    Failed(&'static str, String),
    /// The method cannot do it by its definition, with the reason.
    NotApplicable(String),
}

impl RaceCell {
    /// `ok`, the failure by its name, or `n/a`; and the reason, of a run that ended well what is wrong with its balances.
    pub fn ending(&self) -> (&str, &str) {
        match &self.ended {
            Ended::Well => ("ok", self.complaint.as_deref().unwrap_or_default()),
            Ended::Failed(name, why) => (name, why),
            Ended::NotApplicable(why) => ("n/a", why),
        }
    }
}

impl<'a> RaceRow<'a> {
    /// Its name: that of its study, without the first word `race`.
    pub fn name(&self) -> &'a str {
        self.study.name.strip_prefix("race-").unwrap_or(&self.study.name)
    }

    /// The title of its study, without the word `Race`.
    pub fn title(&self) -> &'a str {
        self.study.title.strip_prefix("Race: ").unwrap_or(&self.study.title)
    }

    /// The situation of a study and its records; `None` where the study is not of the race or nothing has run.
    pub fn of(study: &'a Study, records: &[Record]) -> Option<Self> {
        if !study.is_race || records.is_empty() {
            return None;
        }
        let runs: Vec<(&Contender, Runs<'_>)> =
            CONTENDERS.iter().map(|contender| (contender, Runs::of(study, contender, records))).collect();
        let meshes =
            |runs: &Runs<'_>| runs.path.iter().map(|record| record.case.cells).collect::<BTreeSet<_>>();
        let common = runs.iter().map(|(_, runs)| meshes(runs)).filter(|own| !own.is_empty());
        let cells = common.reduce(|one, other| &one & &other)?.into_iter().next_back()?;
        let contenders =
            runs.iter().map(|(contender, runs)| cell_of(study, contender, runs, cells)).collect();
        let name = study.name.strip_prefix("race-").unwrap_or(&study.name);
        let group = name.split('-').next().unwrap_or_default();
        Some(Self { study, group, cells, contenders })
    }
}

fn cell_of(study: &Study, contender: &Contender, runs: &Runs<'_>, cells: usize) -> RaceCell {
    let refused = study.not_applicable.iter().find(|(name, _)| *name == contender.name);
    let on_mesh = runs.path.iter().copied().find(|record| record.case.cells == cells);
    let ended = match (refused, runs.failure()) {
        (Some((_, why)), _) => Ended::NotApplicable(why.clone()),
        (None, Some((name, why))) => Ended::Failed(name, why),
        (None, None) if on_mesh.is_none() => Ended::NotApplicable("it has not been run".to_owned()),
        (None, None) => Ended::Well,
    };
    let classified = runs.classified();
    RaceCell {
        name: contender.name,
        errors: on_mesh.map_or([None; 3], errors_of),
        levels: runs.path.iter().map(|one| (one.case.cell_size(), errors_of(one))).collect(),
        order: classified.as_ref().and_then(|found| found.order),
        class: classified.as_ref().map(|found| found.class),
        cost: [1e-2, 1e-3].map(|tolerance| runs.cost_to(tolerance)),
        oscillation: on_mesh.and_then(oscillation_of),
        locking: on_mesh.and_then(locking_of),
        step_ratio: on_mesh.and_then(step_ratio_of),
        asymmetry: on_mesh.and_then(|record| record.stability.as_ref()?.asymmetry),
        score: on_mesh.and_then(score_of),
        scatter: runs.two_steps.and_then(|(one, other)| scatter_of(one, other)),
        ended,
        complaint: on_mesh.and_then(complaint_of),
    }
}

/// The scores of situations, to be ranked.
pub fn grid_of(situations: &[RaceRow<'_>]) -> Grid {
    let score = |cell: &RaceCell| match (&cell.ended, cell.score) {
        (Ended::NotApplicable(_), _) => Score::NotApplicable,
        (Ended::Well, Some(value)) if value < USELESS => {
            Score::Value { value, scatter: cell.scatter.unwrap_or(0.0) }
        }
        _ => Score::Failed,
    };
    let row = |one: &RaceRow<'_>| GridRow {
        situation: one.title().to_owned(),
        group: one.group.to_owned(),
        scores: one.contenders.iter().map(score).collect(),
    };
    Grid {
        contenders: CONTENDERS.iter().map(|one| one.name.to_owned()).collect(),
        rows: situations.iter().map(row).collect(),
    }
}

/// The runs of a contender: one path over the mesh, and one of its meshes again with another step.
pub struct Runs<'a> {
    /// From coarse to fine.
    pub path: Vec<&'a Record>,
    /// The run on a mesh, and that with half its step.
    pub two_steps: Option<(&'a Record, &'a Record)>,
}

impl<'a> Runs<'a> {
    /// Those of a contender among the records of a study. Where it has two steps on a mesh, the longer one is the race's.
    pub fn of(study: &Study, contender: &Contender, records: &'a [Record]) -> Self {
        let is_refused = study.not_applicable.iter().any(|(name, _)| *name == contender.name);
        let mut own: Vec<&Record> =
            records.iter().filter(|record| !is_refused && contender.runs(&record.case)).collect();
        let step = |record: &Record| record.step_sizes.target;
        own.sort_by(|a, b| a.case.cells.cmp(&b.case.cells).then(step(b).total_cmp(&step(a))));
        let (mut path, mut two_steps) = (Vec::<&Record>::new(), None);
        for record in own {
            match path.last() {
                // Of several shorter steps the longest.
                Some(last) if last.case.cells == record.case.cells => {
                    let is_known = |pair: &(&Record, &Record)| std::ptr::eq(pair.0, *last);
                    two_steps = two_steps.filter(is_known).or(Some((*last, record)));
                }
                _ => path.push(record),
            }
        }
        Self { path, two_steps }
    }

    /// The failure of the coarsest run that failed: its name, and where and why.
    pub fn failure(&self) -> Option<(&'static str, String)> {
        self.path.iter().find_map(|record| {
            let failure = record.status.failure()?;
            Some((failure.kind.name(), format!("on {} cells: {}", record.case.cells, failure.reason)))
        })
    }

    /// The class of the pressure's series, of a footing of its load's, at the output of its largest error on the finest mesh.
    pub fn classified(&self) -> Option<Classification> {
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

    /// Processor seconds to a score: between two meshes by powers of both; those of the coarsest mesh where it is good
    /// enough; none where the finest is not.
    pub fn cost_to(&self, tolerance: f64) -> Option<f64> {
        let level = |record: &&Record| {
            let seconds: Vec<f64> = record.wall.iter().filter_map(|sample| sample.cpu_seconds).collect();
            Some((score_of(record)?, median(&seconds).filter(|seconds| *seconds > 0.0)?))
        };
        let levels: Vec<(f64, f64)> = self.path.iter().filter_map(level).collect();
        let place = levels.iter().position(|(error, _)| *error <= tolerance)?;
        let (error, cost) = levels[place];
        let Some((coarse_error, coarse_cost)) = place.checked_sub(1).map(|before| levels[before]) else {
            return Some(cost);
        };
        let share = elementary::ln(coarse_error / tolerance) / elementary::ln(coarse_error / error);
        Some(coarse_cost * elementary::powf(cost / coarse_cost, share))
    }
}

/// Largest errors over the outputs, of pressure and effective stress at the points and of the settlement; of a plane, of
/// the displacement at the nodes; of a footing, of its load.
pub fn errors_of(record: &Record) -> [Option<f64>; 3] {
    let Some(reference) = record.references.first().filter(|_| record.status == Status::Ok) else {
        return [None; 3];
    };
    let largest_of = |quantity, sample| {
        let errors = record.case.time_factors.iter();
        largest(errors.filter_map(|time| first_error(record, quantity, sample, &reference.name, *time)))
    };
    let settlement = largest_of(Quantity::Settlement, Sample::Surface);
    [
        largest_of(Quantity::Pressure, Sample::Points),
        largest_of(Quantity::EffectiveStress, Sample::Points),
        settlement
            .or_else(|| largest_of(Quantity::Displacement, Sample::Nodes))
            .or_else(|| largest_of(Quantity::LoadFactor, Sample::Surface)),
    ]
}

/// What a run is ranked by: the largest of its errors; where nothing may move, what moves; where the critical step was
/// asked for, the formula's step over the observed one.
pub fn score_of(record: &Record) -> Option<f64> {
    if record.stability.is_some() {
        return step_ratio_of(record).map(f64::recip);
    }
    if record.case.scene.is_at_rest() && record.status == Status::Ok {
        return largest(record.balance.iter().filter_map(|balance| balance.spurious_velocity));
    }
    largest(errors_of(record).into_iter().flatten())
}

/// Relative change of the score from one run to another.
pub fn scatter_of(one: &Record, other: &Record) -> Option<f64> {
    let (one, other) = (score_of(one)?, score_of(other)?);
    Some((other / one - 1.0).abs())
}

/// The first complaint about the balances of a run that ended well.
pub fn complaint_of(record: &Record) -> Option<String> {
    if record.status == Status::Ok { soundness::complaints(record).into_iter().next() } else { None }
}

/// Oscillation index of the pressure at the last output.
pub fn oscillation_of(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.last()?);
    let measure = first_measure(Quantity::Pressure, Sample::Points, &reference.name, time);
    path_context::oscillation_of(record, &measure)
}

/// Computed over exact settlement at the first output; of a plane one minus the error of the displacement.
pub fn locking_of(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.first()?);
    let of_reference =
        |row: &&crate::record::ErrorRow| row.reference == reference.name && row.time_factor == time;
    let rows = || record.errors.iter().filter(of_reference);
    let settlement = rows().find(|row| row.quantity == Quantity::Settlement).map(|row| 1.0 + row.value);
    settlement.or_else(|| {
        let error = first_error(record, Quantity::Displacement, Sample::Nodes, &reference.name, time)?;
        Some(1.0 - error)
    })
}

/// Critical step over the formula's: observed, or else predicted for an explicit run.
pub fn step_ratio_of(record: &Record) -> Option<f64> {
    if let Some(found) = &record.stability {
        return Some(found.observed? / found.combined_limit);
    }
    let case = &record.case;
    let limit = formula::combined_limit(&case.material, case.cell_size(), case.settings.drag);
    let ratio = record.step_sizes.predicted_critical / limit;
    // The formula itself stands where no limit is known.
    (case.is_explicit() && ratio.is_finite() && ratio > 0.0 && ratio != 1.0).then_some(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;
    use crate::study::file::StudySource;
    use oedometer_mpm::run::TimeStepRule;
    use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

    fn records(integrator: &str) -> Vec<Record> {
        records_of(&format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [1e-3]\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['{integrator}']\ncells = [2, 4, 8]\n"
        ))
    }

    #[test]
    fn the_cost_of_an_error_lies_between_its_meshes_by_powers() {
        let mut records = records("implicit");
        for (record, (error, seconds)) in records.iter_mut().zip([(0.1, 1.0), (0.01, 8.0), (0.004, 27.0)]) {
            record.errors.iter_mut().for_each(|row| row.value = error);
            record.wall = [0.5, 1.0, 40.0]
                .map(|times| WallSample { cpu_seconds: Some(times * seconds), ..WallSample::default() })
                .to_vec();
        }
        let runs = Runs { path: records.iter().collect(), two_steps: None };
        let cost = |tolerance: f64| runs.cost_to(tolerance).expect("a mesh reaches it");
        assert_eq!(cost(0.2), 1.0, "the coarsest mesh is good enough");
        // From 0.1 at 1 s to 0.01 at 8 s: a share of log10 2 of the way.
        assert!((cost(0.05) / 8.0_f64.powf(2.0_f64.log10()) - 1.0).abs() < 1e-12, "{}", cost(0.05));
        assert!((cost(0.01) - 8.0).abs() < 1e-12 && (cost(0.004) - 27.0).abs() < 1e-12);
        assert_eq!(runs.cost_to(0.003), None);
    }

    #[test]
    fn a_step_is_over_the_formula_s_only_where_a_limit_is_known() {
        let mut record = records("explicit").remove(0);
        let case = &record.case;
        let limit = formula::combined_limit(&case.material, case.cell_size(), case.settings.drag);
        record.step_sizes.predicted_critical = 1.5 * limit;
        let ratio = step_ratio_of(&record).expect("a limit");
        assert!((ratio - 1.5).abs() < 1e-12);
        record.step_sizes.predicted_critical = limit;
        assert_eq!(step_ratio_of(&record), None, "the formula stands where no limit is known");
    }

    #[test]
    fn locking_is_of_the_first_output_and_of_a_plane_what_the_displacement_lacks() {
        let mut record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.5]\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [4]\n",
        )
        .remove(0);
        for row in &mut record.errors {
            row.value = match row.quantity {
                Quantity::Settlement if row.time_factor == 0.1 => -0.25,
                Quantity::Displacement if row.time_factor == 0.1 => 0.125,
                _ => 0.5,
            };
        }
        assert_eq!(locking_of(&record), Some(0.75));
        record.errors.retain(|row| row.quantity != Quantity::Settlement);
        assert_eq!(locking_of(&record), Some(0.875));
        // A pressure that goes up and down at the last output alone.
        let heights = record.snapshots[1].points.pressure.len();
        record.snapshots[1].points.pressure =
            (0..heights).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(oscillation_of(&record).is_some_and(|index| index > 0.5), "{:?}", oscillation_of(&record));
    }

    #[test]
    fn of_two_steps_on_a_mesh_the_longer_one_is_the_race_s_in_any_order() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP', 'MPM']\n\
                    integrator = ['implicit']\ncells = [8, 2, 4]\ntime_step = [{ growth = 0.1 }, { growth = 0.05 }]\n";
        let source = StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
        let mut study = Study::check(&source).expect("a sound study");
        let contender = CONTENDERS.iter().find(|one| one.name == "GIMP").expect("a contender");
        let mut all = records_of(text);
        for record in &mut all {
            // The longer step with twice the error of the shorter one.
            let times = if record.case.time_step == TimeStepRule::Growth(0.1) { 2.0 } else { 1.0 };
            record.step_sizes.target = times;
            record.errors.iter_mut().for_each(|row| row.value = 0.1 * times / record.case.cells as f64);
        }
        for (twice, shorter) in [(2, None), (4, None), (8, None), (8, Some(2)), (0, None)] {
            for _ in 0..2 {
                // Both steps on one mesh; on another one the shorter step alone; on the others the longer one alone.
                let is_kept = |record: &&Record| {
                    let is_long = record.step_sizes.target == 2.0;
                    record.case.cells == twice || is_long != (shorter == Some(record.case.cells))
                };
                let records: Vec<Record> = all.iter().filter(is_kept).cloned().collect();
                let runs = Runs::of(&study, contender, &records);
                let found: Vec<(usize, f64)> =
                    runs.path.iter().map(|one| (one.case.cells, one.step_sizes.target)).collect();
                let step = |cells: usize| if shorter == Some(cells) { 1.0 } else { 2.0 };
                assert_eq!(found, [2, 4, 8].map(|cells| (cells, step(cells))), "{twice} {shorter:?}");
                assert!(runs.path.iter().all(|one| one.case.method.to_string() == "GIMP"));
                let two = runs.two_steps.map(|pair| {
                    <[&Record; 2]>::from(pair).map(|one| (one.case.cells, one.step_sizes.target))
                });
                assert_eq!(two, (twice > 0).then_some([(twice, 2.0), (twice, 1.0)]));
                // Of the race's run half is lost: the other way round it would be as much again.
                let scatter = runs.two_steps.and_then(|(one, other)| scatter_of(one, other));
                assert_eq!(scatter, (twice > 0).then_some(0.5));
                all.reverse();
            }
        }
        let mut three: Vec<Record> = all.iter().filter(|record| record.case.cells == 8).cloned().collect();
        let mut shortest = three.clone();
        for record in &mut shortest {
            record.step_sizes.target *= 0.25;
        }
        three.splice(0..0, shortest.into_iter().filter(|record| record.step_sizes.target < 0.5));
        let steps = Runs::of(&study, contender, &three)
            .two_steps
            .map(|pair| <[&Record; 2]>::from(pair).map(|one| one.step_sizes.target));
        assert_eq!(steps, Some([2.0, 1.0]), "of three steps the next shorter one");
        study.not_applicable.push(("GIMP", "a test".to_owned()));
        let runs = Runs::of(&study, contender, &all);
        assert!(runs.path.is_empty() && runs.two_steps.is_none(), "what is refused has no runs");
    }

    #[test]
    fn a_row_has_the_finest_common_mesh_and_each_cell_ends_in_its_own_words() {
        let text = "title = 'Race: a front'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
                    method = ['GIMP', 'MPM']\nintegrator = ['implicit']\ncells = [8, 2, 4]\n";
        let source = StudySource { name: "race-early-front.toml".to_owned(), text: text.to_owned() };
        let mut study = Study::check(&source).expect("a sound study");
        let mut records = records_of(text);
        records.retain(|record| (record.case.cells, &*record.case.method.to_string()) != (8, "MPM"));
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
            match (record.case.cells, &*record.case.method.to_string()) {
                (4, "GIMP") => record.balance[1].settlement_curve_gap = 0.5,
                (2 | 4, "MPM") => {
                    let failure = Failure::of_attached(FailureKind::Unstable, "it grew".to_owned());
                    record.status = Status::Failed(failure);
                }
                _ => {}
            }
        }
        assert!(RaceRow::of(&study, &records).is_none(), "no race");
        study.is_race = true;
        study.not_applicable.push(("VP", "it cannot".to_owned()));
        assert!(RaceRow::of(&study, &[]).is_none(), "nothing has run");
        let row = RaceRow::of(&study, &records).expect("a row");
        assert_eq!((row.cells, row.group, row.name(), row.title()), (4, "early", "early-front", "a front"));
        let cell = |name: &str| row.contenders.iter().find(|one| one.name == name).expect("a contender");
        let gap = "settlement off the settlement curve is 5.00e-1 at T_v = 0.2, more than 2.0e-3";
        for (name, ending) in [
            ("GIMP", ("ok", gap)),
            ("MPM", ("unstable", "on 2 cells: it grew")),
            ("VP", ("n/a", "it cannot")),
            ("PPP", ("n/a", "it has not been run")),
        ] {
            assert_eq!(cell(name).ending(), ending, "{name}");
        }
        let errors = |cells: f64| [0.25, 0.125, 1.0].map(|error| Some(error / cells));
        let gimp = cell("GIMP");
        assert_eq!((gimp.errors, gimp.score), (errors(4.0), Some(0.25)));
        assert_eq!(gimp.levels, [2.0, 4.0, 8.0].map(|cells| (1.0 / cells, errors(cells))));
        assert_eq!((cell("MPM").errors, cell("MPM").score, cell("PPP").levels.len()), ([None; 3], None, 0));
        // To be ranked: a result that is off by less than itself.
        let scored = |score: Option<f64>, scatter: Option<f64>, ended: Ended| RaceCell {
            score,
            scatter,
            ended,
            ..gimp.clone()
        };
        let value = |value: f64, scatter: f64| Score::Value { value, scatter };
        let cells = [
            (scored(Some(0.999), Some(0.1), Ended::Well), value(0.999, 0.1)),
            (scored(Some(0.25), None, Ended::Well), value(0.25, 0.0)),
            (scored(Some(1.0), None, Ended::Well), Score::Failed),
            (scored(Some(f64::NAN), None, Ended::Well), Score::Failed),
            (scored(None, None, Ended::Well), Score::Failed),
            (scored(Some(0.1), None, Ended::Failed("unstable", String::new())), Score::Failed),
            (scored(Some(0.1), None, Ended::NotApplicable(String::new())), Score::NotApplicable),
        ];
        let (contenders, scores): (Vec<RaceCell>, Vec<Score>) = cells.into_iter().unzip();
        let grid = grid_of(&[RaceRow { contenders, ..row.clone() }]);
        let wanted = GridRow { situation: "a front".to_owned(), group: "early".to_owned(), scores };
        assert_eq!(grid.rows, [wanted]);
        assert!(grid.contenders.iter().zip(CONTENDERS.iter()).all(|(name, one)| name == one.name));
    }
}
