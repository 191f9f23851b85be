//! Situations: what makes a run hard, derived from its inputs, and how each method of a study performed in them.

use crate::case::{Quantity, Sample, Task};
use crate::judge::comparison::locking::{Standing, standings};
use crate::judge::paths::{first_error, grouped};
use crate::record::{Record, Status};
use crate::study::check::Study;
use oedometer_convergence::Class;
use oedometer_exact::ExactError;
use oedometer_mpm::run::TimeStepRule;
use oedometer_mpm::run::results::outcome::FailureKind;
use oedometer_soil::elementary;

/// Final strain from which on the loss of height dominates everything else.
const MUCH_OF_THE_HEIGHT: f64 = 0.4;
/// Heights, m, of a usual column.
const USUAL_HEIGHTS: [f64; 2] = [0.05, 500.0];
/// Porosities of a usual soil.
const USUAL_POROSITIES: [f64; 2] = [0.1, 0.8];
/// `n E_oed/K_w` of a usual soil in water: from stiff rock to soft clay with some air.
const USUAL_STORAGE: [f64; 2] = [1e-6, 1e-1];
/// `c_v/(H V)` below which the water cannot move in any time that a run with inertia can wait for.
const USUAL_INERTIA: f64 = 1e-9;
/// A last output before this time factor is a very early one.
const EARLY: f64 = 1e-3;
/// Excess variation of the pressure over that of the exact one from which on it counts as oscillating.
const OSCILLATES: f64 = 1.0;
/// A displacement with a larger error than this counts as locked.
const LOCKS: f64 = 0.5;

/// What makes a run hard, in the order of a report: the easy ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Situation {
    /// Small strain in a usual soil, points on their lattice.
    Usual,
    /// Small strain with points off their lattice, or one a cell.
    OutOfPlace,
    /// Small strain in an unusual soil, size or time.
    Extreme,
    /// Waves.
    Waves,
    /// A layer at its undrained start: how far it moves.
    LayerDisplacement,
    /// A layer at its undrained start: its pressure.
    LayerPressure,
    /// A layer whose skeleton hardly compresses at its undrained start: how far it moves.
    StiffSkeleton,
    /// Large strain under a load that is applied at once.
    LoadAtOnce,
    /// Large strain under a load that grows.
    GrowingLoad,
    /// Large strain that takes much of the height.
    MuchOfTheHeight,
    /// Large strain without a load on the surface.
    BodyForces,
}

/// Name in tables of every situation, and what its runs have in common, in the order of the enumeration.
const NAMES_AND_MEANINGS: [[&str; 2]; 11] = [
    ["Small strain, usual soil", "points on their lattice, soil and water of the seed column or near it"],
    [
        "Small strain, points out of place",
        "points jittered, on cell faces, one per cell, or in a top cell that is partly filled",
    ],
    [
        "Small strain, extreme soil, size or time",
        "water or pores far stiffer or softer than usual, columns of a micrometre or of kilometres, hardly any \
         permeability, or outputs before a thousandth of the consolidation time",
    ],
    ["Waves", "columns with the inertia of both phases, compared with solutions that have it too"],
    [
        "Undrained layer in the plane: displacement",
        "a layer under a cosine load before any water has left: does it move as it should?",
    ],
    [
        "Undrained layer in the plane: pressure",
        "the same layer: is its pressure right, or does it jump from cell to cell?",
    ],
    [
        "Undrained layer, skeleton nearly incompressible: displacement",
        "the layer with the largest Poisson's ratio that was tried",
    ],
    [
        "Large strain, load at once",
        "the whole load at once, points that cross cells where the method lets them",
    ],
    ["Large strain, load that grows", "the same column under a load that is applied gradually"],
    ["Large strain of 40 % and more", "columns that lose 40 % of their height or more"],
    ["Large strain under body forces", "forces and sources that make a known motion"],
];

impl Situation {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        NAMES_AND_MEANINGS[self as usize][0]
    }

    /// What its runs have in common, in a sentence without its full stop.
    pub fn meaning(self) -> &'static str {
        NAMES_AND_MEANINGS[self as usize][1]
    }

    /// The situation of a run.
    pub fn of(record: &Record) -> Self {
        let within = |value: f64, range: [f64; 2]| (range[0]..=range[1]).contains(&value);
        let (case, groups) = (&record.case, &record.groups);
        let column = &case.column;
        let last = case.time_factors.last().copied().unwrap_or(0.0);
        if case.scene.is_large_strain() {
            return match 1.0 - elementary::exp(-groups.finite_strain) {
                _ if !case.scene.is_loaded() => Self::BodyForces,
                strain if strain >= MUCH_OF_THE_HEIGHT => Self::MuchOfTheHeight,
                _ if column.loading_time > 0.0 => Self::GrowingLoad,
                _ => Self::LoadAtOnce,
            };
        }
        let is_usual = within(column.height, USUAL_HEIGHTS)
            && within(case.material.porosity, USUAL_POROSITIES)
            && within(groups.storage, USUAL_STORAGE)
            && groups.inertia >= USUAL_INERTIA
            && last >= EARLY;
        match () {
            () if case.scene.has_waves() => Self::Waves,
            () if !column.points.is_regular() || case.points_per_cell == 1 => Self::OutOfPlace,
            () if !is_usual => Self::Extreme,
            () => Self::Usual,
        }
    }
}

/// How runs of a method ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// With this largest error.
    Error(f64),
    /// With a pressure whose variation is this multiple of that of the exact one.
    Oscillates(f64),
    /// Hardly moved.
    Locked,
    /// Failed.
    Failed {
        /// Name of the most frequent failure.
        name: &'static str,
        /// Runs that failed.
        failed: usize,
        /// All runs.
        of: usize,
    },
}

impl End {
    /// How bad it is: no answer is worst, then a useless answer, then the size of the error. NaN is as bad as an
    /// error can be.
    fn badness(&self) -> (u8, f64) {
        match self {
            Self::Error(error) => (0, error.abs()),
            Self::Oscillates(times) => (1, *times),
            Self::Locked => (2, 0.0),
            Self::Failed { failed, of, .. } => (3, *failed as f64 / (*of).max(1) as f64),
        }
    }

    /// Whether it is worse than another.
    pub fn is_worse_than(&self, other: &Self) -> bool {
        let (own, other) = (self.badness(), other.badness());
        own.0.cmp(&other.0).then(own.1.total_cmp(&other.1)).is_gt()
    }
}

/// How a method performed in one situation of one study.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended<'a> {
    /// The situation.
    pub situation: Situation,
    /// The method, by its name.
    pub method: String,
    /// The study.
    pub study: &'a Study,
    /// The worst end of its runs on the finest mesh, each with the best of its time steps.
    pub end: End,
}

/// How every method of a study performed in every situation that the study has.
///
/// # Errors
/// When a reference refuses a case.
pub fn ends_of<'a>(study: &'a Study, records: &[Record]) -> Result<Vec<Ended<'a>>, ExactError> {
    if study.scene.shows_locking() {
        let of_method = |one: &Standing| {
            let of = |(situation, end)| Ended { situation, method: one.method.to_string(), study, end };
            of_layer(one).into_iter().map(of).collect::<Vec<_>>()
        };
        return Ok(standings(study, records)?.iter().flat_map(of_method).collect());
    }
    let Some(reference) = study.references.first() else { return Ok(Vec::new()) };
    let solved = records.iter().filter(|record| record.case.task == Task::Solve);
    let groups = grouped(solved, |record| (Situation::of(record), record.case.method.to_string()));
    let end = |((situation, method), group): ((Situation, String), Vec<&Record>)| {
        Some(Ended { situation, method, study, end: end_of(&group, reference.name())? })
    };
    Ok(groups.into_iter().filter_map(end).collect())
}

/// The situations there are, the easy ones first.
pub fn situations_of(ends: &[Ended<'_>]) -> Vec<Situation> {
    let mut all: Vec<Situation> = ends.iter().map(|one| one.situation).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The failures of runs, or else the largest error of the pressure at the points at the last output on the finest
/// mesh; `None` where no run has one. Of runs that differ in their step alone the best counts: a study of steps has long
/// ones, and some beyond the limit.
fn end_of(records: &[&Record], reference: &str) -> Option<End> {
    let groups = grouped(records.iter().copied(), |record| {
        record.case.number_with(|case| case.time_step = TimeStepRule::Stable(1.0))
    });
    let failures: Vec<FailureKind> = groups
        .iter()
        .filter(|(_, group)| group.iter().all(|record| record.status != Status::Ok))
        .flat_map(|(_, group)| group.iter().filter_map(|record| Some(record.status.failure()?.kind)))
        .collect();
    let count = |kind: FailureKind| failures.iter().filter(|one| **one == kind).count();
    // In reverse, because the last of equal maxima is taken: the first kind, whatever the order of the runs.
    let most = FailureKind::ALL.into_iter().rev().max_by_key(|kind| count(*kind))?;
    if !failures.is_empty() {
        return Some(End::Failed { name: most.name(), failed: failures.len(), of: records.len() });
    }
    let finest = records.iter().map(|record| record.case.cells).max()?;
    let best = |group: &[&Record]| {
        let sound = group.iter().filter(|one| one.case.cells == finest && one.status == Status::Ok);
        sound.filter_map(|record| last_error(record, reference)).min_by(f64::total_cmp)
    };
    groups.iter().filter_map(|(_, group)| best(group)).max_by(f64::total_cmp).map(End::Error)
}

/// Error of the pressure at the points at the last output.
fn last_error(record: &Record, reference: &str) -> Option<f64> {
    let time = *record.case.time_factors.last()?;
    first_error(record, Quantity::Pressure, Sample::Points, reference, time)
}

/// A layer at its undrained start: displacement and pressure in the usual soil, displacement in a stiff one.
fn of_layer(one: &Standing) -> Vec<(Situation, End)> {
    let moved = |error: f64| if error > LOCKS { End::Locked } else { End::Error(error) };
    let usual = one.displacement.map(|error| {
        let end = if one.class == Some(Class::Locked) { End::Locked } else { moved(error) };
        (Situation::LayerDisplacement, end)
    });
    let pressure = one.pressure.map(|error| {
        let oscillates = one.oscillation.filter(|index| *index > OSCILLATES);
        (Situation::LayerPressure, oscillates.map_or(End::Error(error), |index| End::Oscillates(1.0 + index)))
    });
    let stiff = one.stiff_skeleton.map(|error| (Situation::StiffSkeleton, moved(error)));
    [usual, pressure, stiff].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::study::file::StudySource;

    fn study_of(text: &str) -> (Study, Vec<Record>) {
        let source = StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
        (Study::check(&source).expect("a sound study"), records_of(text))
    }

    fn situations(table: &str, sweep: &str) -> Vec<(Situation, End)> {
        let text = format!(
            "title = 't'\n{table}\n[output]\ntime_factors = [0.05]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
             integrator = ['implicit']\ncells = [4]\n{sweep}"
        );
        let (study, records) = study_of(&text);
        ends_of(&study, &records).expect("sound").iter().map(|one| (one.situation, one.end)).collect()
    }

    #[test]
    fn a_situation_is_read_off_the_inputs() {
        let one = |table: &str, sweep: &str| situations(table, sweep)[0].0;
        assert_eq!(one("scene = 'terzaghi'", ""), Situation::Usual);
        assert_eq!(one("scene = 'terzaghi'\npoints.jitter = 0.1", ""), Situation::OutOfPlace);
        assert_eq!(one("scene = 'terzaghi'", "points_per_cell = [1]"), Situation::OutOfPlace);
        assert_eq!(one("scene = 'terzaghi'\ncolumn.height = 1e-6", ""), Situation::Extreme);
        assert_eq!(one("scene = 'xie-leo'\ncolumn.load = 2e5", ""), Situation::LoadAtOnce);
        let growing = "scene = 'xie-leo'\ncolumn = { load = 2e5, loading_time = 1.0 }";
        assert_eq!(one(growing, ""), Situation::GrowingLoad);
        let much = "scene = 'xie-leo'\ncolumn.load = 8.4e5\nmaterial.porosity = 0.7";
        assert_eq!(one(much, ""), Situation::MuchOfTheHeight);
    }

    #[test]
    fn of_runs_alike_but_for_their_step_the_best_counts_and_of_others_the_worst() {
        let of_step = |rule: &str| situations("scene = 'terzaghi'", &format!("time_step = [{rule}]"));
        let error = |rule: &str| match of_step(rule)[..] {
            [(Situation::Usual, End::Error(error))] => error,
            ref other => panic!("{other:?}"),
        };
        let (fine, coarse) = ("{ growth = 0.01 }", "{ growth = 0.5 }");
        assert_ne!(error(fine), error(coarse));
        assert_eq!(error(&format!("{fine}, {coarse}")), error(fine).min(error(coarse)));
        // A step beyond the limit is not a failure of the method if another step below it succeeds.
        let explicit = |rule: &str| {
            let sweep = format!("time_step = [{rule}]");
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.05]\n[[sweep]]\n\
                 method = ['GC-SRI-patch']\nintegrator = ['explicit']\ncells = [4]\n{sweep}"
            );
            let (study, records) = study_of(&text);
            ends_of(&study, &records).expect("sound")[0].end
        };
        assert!(matches!(explicit("{ stable = 1.3 }"), End::Failed { failed: 1, of: 1, .. }));
        assert!(matches!(explicit("{ stable = 0.8 }, { stable = 1.3 }"), End::Error(_)));
        let points = situations("scene = 'terzaghi'", "points_per_cell = [2, 3]");
        assert_eq!(points.len(), 1, "one method, one situation");
    }

    #[test]
    fn a_failure_is_worse_than_any_error_and_no_number_worse_than_any_number() {
        let failed = End::Failed { name: "unstable", failed: 1, of: 2 };
        assert!(failed.is_worse_than(&End::Locked) && End::Locked.is_worse_than(&End::Error(f64::NAN)));
        assert!(End::Error(f64::NAN).is_worse_than(&End::Error(f64::INFINITY)));
        assert!(End::Error(-0.2).is_worse_than(&End::Error(0.1)));
        assert!(!End::Error(0.1).is_worse_than(&End::Error(0.1)));
    }
}
