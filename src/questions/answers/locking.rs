//! Which method locks, from which Poisson's ratio, and by how much? Answered where a study sweeps it in the plane.

use crate::questions::comparison::stiffness_sweep::{KEPT, StiffnessSweep, SweepRow, SweptStiffness};
use crate::questions::study_results::StudyResults;
use crate::record::Record;
use crate::study::check::Study;
use oedometer_exact::ExactError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Errors of every method over Poisson's ratio, in the study that sweeps it with most methods.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LockingFinding {
    /// Study.
    pub study: String,
    /// Cells over the height.
    pub cells: usize,
    /// Time factor, the last of the outputs.
    pub time_factor: f64,
    /// A result is kept where displacement and pressure are off by less than this.
    pub kept_within: f64,
    /// Smallest and largest Poisson's ratio.
    pub poissons_ratios: [f64; 2],
    /// Methods, those that keep their result first.
    pub methods: Vec<LockingMethod>,
}

/// A method over Poisson's ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LockingMethod {
    /// Method.
    pub method: String,
    /// What becomes of its result.
    pub result: LockingResult,
    /// Relative L2 errors of the nodal displacement at the smallest and the largest ratio.
    pub displacement: [Option<f64>; 2],
    /// Relative L2 errors of the pressure at the points at these.
    pub pressure: [Option<f64>; 2],
}

/// What becomes of a result as the soil gets harder to compress.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum LockingResult {
    /// Kept at every ratio.
    Kept,
    /// Lost from a ratio on.
    Lost {
        /// The ratio.
        from: f64,
    },
    /// A run failed.
    Failed {
        /// The ratio.
        at: f64,
        /// How, with its step.
        ending: String,
    },
    /// No run at the largest ratio.
    Unknown,
}

impl LockingFinding {
    /// The study that sweeps Poisson's ratio with most methods, the first of equals.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub(super) fn new(results: &[StudyResults<'_>]) -> Result<Option<Self>, ExactError> {
        let mut widest: Option<(&str, StiffnessSweep)> = None;
        for one in results.iter().filter(|one| one.study.scene.shows_locking() && !one.study.is_race) {
            let sweep = StiffnessSweep::of(one.study, one.records, SweptStiffness::Skeleton)?;
            let is_wider = |sweep: &StiffnessSweep| {
                widest.as_ref().is_none_or(|(_, other)| sweep.rows.len() > other.rows.len())
            };
            if let Some(sweep) = sweep.filter(is_wider) {
                widest = Some((&one.study.name, sweep));
            }
        }
        Ok(widest.and_then(|(study, sweep)| Self::from_sweep(study, &sweep)))
    }

    /// What one study says, where it sweeps Poisson's ratio.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn of_study(study: &Study, records: &[Record]) -> Result<Option<Self>, ExactError> {
        if !study.scene.shows_locking() {
            return Ok(None);
        }
        let sweep = StiffnessSweep::of(study, records, SweptStiffness::Skeleton)?;
        Ok(sweep.and_then(|sweep| Self::from_sweep(&study.name, &sweep)))
    }

    fn from_sweep(study: &str, sweep: &StiffnessSweep) -> Option<Self> {
        let (smallest, largest) = (*sweep.values.first()?, *sweep.values.last()?);
        let time_factor = *sweep.time_factors.last()?;
        let mut rows: Vec<&SweepRow> = sweep.at(time_factor).collect();
        rows.sort_by_key(|row| std::cmp::Reverse(row.lost_from().unwrap_or(usize::MAX)));
        let last = sweep.values.len() - 1;
        let method = |row: &&SweepRow| {
            let errors = |which: usize| [0, last].map(|place| row.errors(place)[which]);
            LockingMethod {
                method: row.method.to_string(),
                result: LockingResult::new(row, &sweep.values),
                displacement: errors(0),
                pressure: errors(1),
            }
        };
        Some(Self {
            study: study.to_owned(),
            cells: sweep.cells,
            time_factor,
            kept_within: KEPT,
            poissons_ratios: [smallest, largest],
            methods: rows.iter().map(method).collect(),
        })
    }
}

impl LockingResult {
    fn new(row: &SweepRow, values: &[f64]) -> Self {
        match (row.lost_from(), row.failed_from()) {
            (Some(place), _) => Self::Lost { from: values[place] },
            (None, Some((place, ending))) => Self::Failed { at: values[place], ending: ending.to_owned() },
            (None, None) if row.errors(values.len() - 1).iter().all(Option::is_some) => Self::Kept,
            (None, None) => Self::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::SolverName;
    use crate::case::planned::Tier;
    use oedometer_problem::method::Method;

    /// Oscillation does not count.
    fn row(name: &str, errors: [[Option<f64>; 2]; 3]) -> SweepRow {
        SweepRow {
            method: SolverName::Own(Method::named(name).expect("a method")),
            time_factor: 0.1,
            found: errors.map(|[displacement, pressure]| [displacement, pressure, Some(9.0)]).to_vec(),
            failed: vec![None; 3],
        }
    }

    fn found(rows: Vec<SweepRow>) -> Vec<LockingMethod> {
        let sweep = StiffnessSweep {
            stiffness: SweptStiffness::Skeleton,
            cells: 4,
            values: vec![0.2, 0.4, 0.49],
            time_factors: vec![0.1],
            rows,
        };
        LockingFinding::from_sweep("s", &sweep).expect("methods").methods
    }

    #[test]
    fn a_result_is_lost_with_either_quantity_from_the_first_ratio_on() {
        let (kept, lost) = (Some(0.05), Some(0.2));
        let sound = [[kept; 2]; 3];
        assert_eq!(row("MPM", sound).lost_from(), None);
        assert_eq!(row("MPM", [[Some(0.099), Some(0.0)]; 3]).lost_from(), None);
        for bad in [
            [lost, kept],
            [kept, lost],
            [lost, lost],
            [None, kept],
            [kept, None],
            [Some(f64::NAN), kept],
            [kept, Some(f64::NAN)],
            [Some(KEPT), kept],
            [kept, Some(KEPT)],
        ] {
            for place in 0..3 {
                let mut errors = sound;
                errors[place] = bad;
                assert_eq!(row("MPM", errors).lost_from(), Some(place), "{errors:?}");
                errors[2] = [lost; 2];
                assert_eq!(row("MPM", errors).lost_from(), Some(place), "{errors:?}");
            }
        }
        let mut failed = row("B2", [[kept, kept], [kept, kept], [None, None]]);
        failed.failed[2] = Some("unstable at step 3".to_owned());
        let methods = found(vec![
            row("MPM", [[kept, kept], [kept, Some(0.25)], [Some(3.2), kept]]),
            row("GIMP", sound),
            row("GIMP-SRI", [[kept, kept], [kept, kept], [Some(4.6), Some(0.1)]]),
            row("VP", [[kept, kept], [Some(0.5), kept], [kept, kept]]),
            failed,
            row("GIMP-mean", [[kept, kept], [kept, kept], [None, None]]),
        ]);
        let told: Vec<_> = methods.iter().map(|one| (one.method.as_str(), one.result.clone())).collect();
        let wanted = [
            ("GIMP", LockingResult::Kept),
            ("B2", LockingResult::Failed { at: 0.49, ending: "unstable at step 3".to_owned() }),
            ("GIMP-mean", LockingResult::Unknown),
            ("GIMP-SRI", LockingResult::Lost { from: 0.49 }),
            ("MPM", LockingResult::Lost { from: 0.4 }),
            ("VP", LockingResult::Lost { from: 0.4 }),
        ];
        assert_eq!(told, wanted, "those that keep it first");
    }

    #[test]
    fn every_error_stands_under_its_quantity_and_ratio() {
        let errors = [[0.01, 0.02], [0.03, 0.04], [0.05, 0.06]].map(|both| both.map(Some));
        let method = &found(vec![row("MPM", errors)])[0];
        assert_eq!(method.displacement, [Some(0.01), Some(0.05)]);
        assert_eq!(method.pressure, [Some(0.02), Some(0.06)]);
    }

    #[test]
    fn of_several_studies_the_one_with_most_methods_answers_and_at_its_last_time() {
        let study = |name: &str, methods: &str| {
            let text = format!(
                "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\nmethod = {methods}\n\
                 integrator = ['implicit']\ncells = [2]\npoissons_ratio = [0.25, 0.3, 0.4]\ntime_step = [{{ growth = 0.5 }}]\n"
            );
            solved(name, &text)
        };
        let all = [
            study("one", "['GIMP']"),
            study("two", "['GIMP', 'GIMP-SRI']"),
            study("as-many", "['MPM', 'GIMP']"),
        ];
        for places in [&[0, 1, 2][..], &[1, 0], &[1, 2, 0]] {
            let results: Vec<StudyResults<'_>> = places
                .iter()
                .map(|place| StudyResults::new(&all[*place].0, &all[*place].1, Tier::Full))
                .collect();
            let found = LockingFinding::new(&results).expect("sound cases").expect("who locks");
            assert_eq!((found.study.as_str(), found.methods.len(), found.cells), ("two", 2, 2));
            assert_eq!(found.time_factor, 0.2);
        }
        assert_eq!(LockingFinding::new(&[]).expect("no case"), None);
    }
}
