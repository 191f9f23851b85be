//! What the records of a situation of the race come to: per method its meshes with their errors and costs, or why it has
//! none, and the properties that are no errors.

use crate::campaign::refinement::{Refinement, halvings, judged_errors, steps_of};
use crate::case::contender::{CONTENDERS, Contender};
use crate::case::grouping::grouped;
use crate::case::{Quantity, Sample, Task};
use crate::judge::paths::first_error;
use crate::measure::statistics::median;
use crate::race::finish::{Arrival, Budget, Level, RaceQuantity, Reason, Terms, arrival, reason_of};
use crate::record::calibration::cost_of;
use crate::record::race_errors::{ReadOut, RunErrors};
use crate::record::{Record, Status};
use crate::study::check::Study;
use oedometer_problem::method::Configuration;
use oedometer_problem::wave_speeds;
use oedometer_scenes::scene::Question;

/// A situation: a study whose sweeps name the race.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// Names of its outputs.
    pub outputs: Vec<String>,
    /// Cells of its meshes: the last but one is the budget, the last twice that.
    pub meshes: Vec<usize>,
    /// One entry per method that may run in it, in their order.
    pub entries: Vec<Entry>,
}

/// A method in a situation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// The method.
    pub contender: String,
    /// Its meshes, from coarse to fine.
    pub levels: Vec<Level>,
    /// What the program says of a refusal.
    pub refused: Option<String>,
    /// What the finest mesh settles over what the soil does.
    pub stiffness: Option<f64>,
    /// Critical step over the formula's: observed where the study observes it, predicted in other explicit runs.
    pub step_ratio: Option<f64>,
    /// Asymmetry of the stiffness of skeleton and water, where the study observes the critical step: round-off where
    /// the forces do the power of the stresses.
    pub asymmetry: Option<[f64; 2]>,
    /// Largest velocity over the conductivity where nothing may move.
    pub spurious_velocity: Option<f64>,
}

impl Situation {
    /// The situation of a study and its records; `None` where the study is not of the race or nothing has run.
    pub fn from_records(study: &Study, records: &[Record]) -> Option<Self> {
        let case = &records.first().filter(|_| study.is_race)?.case;
        let name = study.name.strip_prefix("race-").unwrap_or(&study.name);
        let moves = study.scene.configuration() == Configuration::Updated;
        let is_property = study.scene.question == Question::Rest || case.task == Task::Stability;
        // Where nothing moves a mesh that follows is the same mesh.
        let runs = |one: &&Contender| moves || is_property || !one.is_total();
        let mut situation = Self {
            family: name.split('-').next().unwrap_or_default().to_owned(),
            name: name.to_owned(),
            title: study.title.strip_prefix("Race: ").unwrap_or(&study.title).to_owned(),
            study: study.name.clone(),
            moves,
            integrator: case.integrator.name().to_owned(),
            is_property,
            outputs: case.time_factors.iter().map(f64::to_string).collect(),
            meshes: steps_of(study).into_keys().collect(),
            entries: CONTENDERS.iter().filter(runs).map(|one| entry(study, one, records)).collect(),
        };
        situation.share_costs();
        Some(situation)
    }

    /// Runs that agree to the last bit are one run: each costs what the cheapest of them does.
    fn share_costs(&mut self) {
        let levels = || self.entries.iter().flat_map(|entry| &entry.levels);
        let least = |level: &Level| {
            let alike = levels().filter(|other| (other.cells, &other.errors) == (level.cells, &level.errors));
            let alike = alike.filter(|_| level.errors.is_whole);
            alike.map(|other| other.cost).fold(level.cost, f64::min)
        };
        let costs: Vec<f64> = levels().map(least).collect();
        let levels = self.entries.iter_mut().flat_map(|entry| &mut entry.levels);
        levels.zip(costs).for_each(|(level, cost)| level.cost = cost);
    }

    /// Cells of the finest mesh that a budget allows.
    pub fn most_cells(&self, budget: Budget) -> usize {
        let unused = [2, 1, 0][budget as usize];
        let place = self.meshes.len().saturating_sub(1 + unused);
        self.meshes.get(place).copied().unwrap_or(0)
    }

    /// Where a method reaches the tolerance.
    pub fn arrival(&self, entry: &Entry, terms: &Terms) -> Option<Arrival> {
        arrival(&entry.levels, terms, self.most_cells(terms.budget))
    }

    /// Why a method does not reach the tolerance; `None` where it does.
    pub fn reason(&self, entry: &Entry, terms: &Terms) -> Option<Reason> {
        if entry.refused.is_some() {
            return Some(Reason::NotApplicable);
        }
        let is_missed = self.arrival(entry, terms).is_none();
        is_missed.then(|| reason_of(&entry.levels, terms, entry.stiffness))
    }

    /// The entry that reaches the tolerance at the least cost, with that.
    pub fn cheapest(&self, terms: &Terms) -> Option<(&Entry, f64)> {
        let costs = self.entries.iter().filter_map(|entry| Some((entry, self.arrival(entry, terms)?.cost)));
        costs.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The cost of an entry over the least of all, where it reaches the tolerance.
    pub fn ratio(&self, entry: &Entry, terms: &Terms) -> Option<f64> {
        Some(self.arrival(entry, terms)?.cost / self.cheapest(terms)?.1)
    }

    /// The entry of a method.
    pub fn entry(&self, contender: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.contender == contender)
    }
}

fn entry(study: &Study, contender: &Contender, records: &[Record]) -> Entry {
    let refused = study.not_applicable.iter().find(|(name, _)| *name == contender.name);
    let runs: Vec<&Record> =
        records.iter().filter(|record| refused.is_none() && contender.runs(&record.case)).collect();
    let ladder = ladder_of(study, runs);
    let finest = ladder.last().map(|runs| runs[0]);
    Entry {
        contender: contender.name.to_owned(),
        levels: ladder.iter().map(|runs| level(runs)).collect(),
        refused: refused.map(|(_, why)| why.clone()),
        stiffness: finest.and_then(stiffness_of),
        step_ratio: finest.and_then(step_ratio_of),
        asymmetry: finest.and_then(|record| record.stability.as_ref()?.asymmetry),
        spurious_velocity: finest
            .filter(|record| record.case.scene.question == Question::Rest)
            .and_then(spurious_velocity_of),
    }
}

/// The runs of a method that the race asks for, whoever ran others too: by mesh, the longest step first.
fn ladder_of<'a>(study: &Study, mut runs: Vec<&'a Record>) -> Vec<Vec<&'a Record>> {
    let steps = steps_of(study);
    runs.sort_by_key(|record| (halvings(&steps, &record.case), record.case.cells));
    let mut refinement = Refinement::of(study);
    let mut wanted: Vec<&Record> = Vec::new();
    for record in runs {
        if refinement.wants(&record.case) {
            refinement.add(record);
            wanted.push(record);
        }
    }
    grouped(wanted, |record| record.case.cells).into_iter().map(|(_, runs)| runs).collect()
}

fn level(runs: &[&Record]) -> Level {
    let seconds: Vec<f64> = runs[0].wall.iter().filter_map(|sample| sample.cpu_seconds).collect();
    Level {
        cells: runs[0].case.cells,
        step: runs[0].case.time_step.to_string(),
        cost: cost_of(runs[0]),
        seconds: median(&seconds),
        errors: judged_errors(runs[0]),
        shorter: runs[1..].iter().map(|record| judged_errors(record)).collect(),
    }
}

/// Computed over exact settlement at the first output.
fn settlement_ratio(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.first()?);
    let row = record.errors.iter().find(|row| {
        row.reference == reference.name && row.time_factor == time && row.quantity == Quantity::Settlement
    })?;
    Some(1.0 + row.value)
}

/// One minus the error of the displacement at the first output.
fn displacement_kept(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.first()?);
    Some(1.0 - first_error(record, Quantity::Displacement, Sample::Points, &reference.name, time)?)
}

/// By how much the load of a footing is too large at its worst output.
fn load_error(record: &Record) -> Option<f64> {
    let errors = RunErrors::of(record);
    errors.largest(ReadOut::Points, Some(RaceQuantity::Displacement as usize), None)
}

/// What tells a body that locks: how much of the exact settlement it reaches, under a footing of the soil's load over its
/// own, in a layer of water and soil that hardly compress one minus the error of its displacement.
fn stiffness_of(record: &Record) -> Option<f64> {
    match record.case.scene {
        scene if scene.measures(Quantity::LoadFactor) => Some(1.0 / (1.0 + load_error(record)?)),
        scene if scene.locks => settlement_ratio(record).or_else(|| displacement_kept(record)),
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
        method = ['race']\nintegrator = ['implicit']\ncells = [2, 8, 4, 16]\ntime_step = [{ growth = 0.1 }, { growth = 0.05 }]\n";

    /// A race of two methods; their errors are 1/cells times a factor per quantity, half of it at the first output.
    fn race() -> (Study, Vec<Record>) {
        let study = study_of("race-early-front", TEXT);
        let (_, mut records) = solved("race-early-front", &TEXT.replace("'race'", "'GIMP', 'MPM'"));
        for record in &mut records {
            for row in &mut record.errors {
                let share = if row.time_factor == 0.2 { 1.0 } else { 0.5 };
                row.value = share / record.case.cells as f64
                    * match (row.quantity, row.sample) {
                        (Quantity::Pressure, Sample::Points) => 0.04,
                        (Quantity::Displacement, Sample::Points) => -0.02,
                        _ => 0.01,
                    };
            }
        }
        (study, records)
    }

    #[test]
    fn an_entry_has_its_meshes_and_shorter_steps_and_runs_alike_to_the_bit_cost_the_same() {
        let (study, mut records) = race();
        for record in &mut records {
            if record.case.method.to_string() == "MPM" && record.case.cells >= 8 {
                record.status =
                    Status::Failed(Failure::of_attached(FailureKind::Unstable, "it grew".to_owned()));
            }
        }
        for _ in 0..2 {
            let situation = Situation::from_records(&study, &records).expect("a race");
            assert_eq!((situation.family.as_str(), situation.name.as_str()), ("early", "early-front"));
            assert_eq!(
                (situation.title.as_str(), &situation.outputs[..]),
                ("a front", &["0.1", "0.2"].map(str::to_owned)[..])
            );
            assert_eq!(
                [Budget::Half, Budget::Whole, Budget::Twice].map(|one| situation.most_cells(one)),
                [4, 8, 16]
            );
            assert!(
                !situation.moves && !situation.is_property && situation.entry("TL-GC-SRI-patch").is_none()
            );
            let [gimp, mpm] = ["GIMP", "MPM"].map(|name| situation.entry(name).expect("it runs"));
            assert_eq!(gimp.levels.iter().map(|one| one.cells).collect::<Vec<_>>(), [2, 4, 8, 16]);
            // Within 1 % from four cells on, read at the centres from two: there and on the next mesh half the step is taken.
            assert_eq!(gimp.levels.iter().map(|one| one.shorter.len()).collect::<Vec<_>>(), [1, 1, 1, 0]);
            let terms = Terms::usual(ReadOut::Points);
            let told = situation.arrival(gimp, &terms).map(|one| (one.cells, one.step, one.confirmed));
            assert_eq!(told, Some((4, "growth=0.1".to_owned(), true)));
            // In the cells all is small on the coarsest mesh, but the displacement is read at the points.
            let centres = Terms::usual(ReadOut::Centres);
            assert_eq!(situation.arrival(gimp, &centres).map(|one| one.cells), Some(2));
            let early = Terms { output: Some(0), ..terms };
            assert_eq!(situation.arrival(gimp, &early).map(|one| one.cells), Some(2));
            assert_eq!(gimp.levels[1].cost, mpm.levels[1].cost);
            // It fails on 8 and 16 cells, having had small errors, and with half the step on the finest.
            assert_eq!(mpm.levels.len(), 4);
            assert_eq!((mpm.levels[3].shorter.len(), situation.reason(gimp, &terms)), (1, None));
            assert_eq!(situation.reason(mpm, &terms), Some(Reason::Inaccurate), "no quarter was tried");
            assert_eq!(
                situation.reason(situation.entry("PPP").expect("an entry"), &terms),
                Some(Reason::NotRun)
            );
            records.reverse();
        }
        assert!(
            Situation::from_records(&study_of("plain", &TEXT.replace("'race'", "'GIMP'")), &records)
                .is_none()
        );
        assert!(Situation::from_records(&study, &[]).is_none(), "nothing has run");
    }

    #[test]
    fn a_run_that_fails_a_check_reaches_nothing() {
        let (study, mut records) = race();
        for record in
            records.iter_mut().filter(|one| one.case.method.to_string() == "GIMP" && one.case.cells == 16)
        {
            record.start.as_mut().expect("a start").volume_error = 0.5;
        }
        let situation = Situation::from_records(&study, &records).expect("a race");
        let [gimp, mpm] = ["GIMP", "MPM"].map(|name| situation.entry(name).expect("it runs"));
        let terms = Terms::usual(ReadOut::Points);
        assert_eq!([gimp, mpm].map(|one| situation.arrival(one, &terms).is_some()), [false, true]);
    }

    #[test]
    fn meshes_beyond_two_within_the_smallest_tolerance_do_not_count_whoever_ran_them() {
        let (study, mut records) = race();
        for row in records.iter_mut().flat_map(|record| &mut record.errors) {
            row.value *= 0.1;
        }
        let situation = Situation::from_records(&study, &records).expect("a race");
        let gimp = situation.entry("GIMP").expect("it runs");
        assert_eq!(gimp.levels.iter().map(|one| one.cells).collect::<Vec<_>>(), [2, 4]);
    }

    #[test]
    fn a_contender_that_the_program_refuses_has_the_reason() {
        let text = TEXT.replace("terzaghi", "mandel").replace("[2, 8, 4, 16]", "[10, 20]");
        let (study, records) = solved("race-layer-small", &text);
        let situation = Situation::from_records(&study, &records).expect("a race");
        let refused = situation.entry("B2-Bbar-patch").expect("an entry");
        assert!(refused.levels.is_empty() && refused.refused.as_ref().is_some_and(|why| !why.is_empty()));
        assert_eq!(situation.reason(refused, &Terms::usual(ReadOut::Points)), Some(Reason::NotApplicable));
    }
}
