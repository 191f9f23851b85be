//! What the blocks of a study's page print, block by block: every number is computed here and `render` only writes it.

pub mod checks;
pub mod drawn;
pub mod error_figure;
pub mod fields;
pub mod number;
pub mod profiles;
pub mod refinement;
pub mod setting;
pub mod soil_map;
pub mod stability;
pub mod timing;
pub mod work;

use crate::judge::outside_runs::{OutsideRunFinding, outside_runs};
use crate::questions::study_results::StudyResults;
use crate::race::situation::Situation;
use checks::{EndFinding, GroupFinding, MeasureFinding, WorstCheck};
use fields::{FieldsFinding, LoadCurves};
use oedometer_exact::ExactError;
use profiles::ProfilesFinding;
use refinement::RefinementFinding;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use setting::SettingFinding;
use soil_map::MapFinding;
use stability::StabilityFinding;
use timing::TimingFinding;
use work::{WallTimeFinding, WorkFinding};

/// A point of a line, `[x, y]`.
pub type Point = (f64, f64);

/// What the blocks of a study's page print, beside runs, series and expectations.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct StudyBlocks {
    /// Geometry and soil.
    pub setting: Option<SettingFinding>,
    /// Isochrones and consolidation of a column with theory's.
    pub profiles: Option<ProfilesFinding>,
    /// Pressure fields of a plane.
    pub fields: Option<FieldsFinding>,
    /// Load over settlement of a footing.
    pub loads: Option<LoadCurves>,
    /// Errors along every axis that is refined.
    pub refinements: Vec<RefinementFinding>,
    /// A situation of the race.
    pub race: Option<Situation>,
    /// Critical steps, predicted and observed.
    pub stability: Option<StabilityFinding>,
    /// How each case ended, where the study expects how.
    pub ends: Vec<EndFinding>,
    /// Measures beside the errors, the worst output of each run.
    pub measures: Vec<MeasureFinding>,
    /// Start checks and balances, the worst of all runs.
    pub checks: Vec<WorstCheck>,
    /// Dimensionless groups, the largest of all runs.
    pub groups: Vec<GroupFinding>,
    /// Wall times of runs that had the machine to themselves.
    pub timing: Vec<TimingFinding>,
    /// Error over counted work.
    pub work: Option<WorkFinding>,
    /// Error over wall time, of a study of several integrators.
    pub wall_time: Option<WallTimeFinding>,
    /// Methods over a map of soils.
    pub map: Option<MapFinding>,
    /// Runs of other programs.
    pub outside_runs: Vec<OutsideRunFinding>,
}

impl StudyBlocks {
    /// Everything for the page of a study.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(results: &StudyResults<'_>) -> Result<Self, ExactError> {
        // The page of a race has a table of its own in their place.
        let drawn = !results.study.is_race;
        Ok(Self {
            setting: SettingFinding::new(results.records),
            profiles: if drawn { ProfilesFinding::new(results)? } else { None },
            fields: if drawn { FieldsFinding::new(results)? } else { None },
            loads: if drawn { LoadCurves::new(results) } else { None },
            refinements: if drawn { RefinementFinding::along_all_axes(results) } else { Vec::new() },
            race: Situation::from_records(results.study, results.records),
            stability: StabilityFinding::new(results.records),
            ends: checks::ends(results),
            measures: checks::measures(results.records),
            checks: checks::worst_checks(results.records),
            groups: checks::largest_groups(results.records),
            timing: timing::timed_runs(results),
            work: WorkFinding::new(results).filter(|_| drawn),
            wall_time: WallTimeFinding::of_study(results),
            map: MapFinding::new(&soil_map::soils_of(results)).filter(|_| drawn),
            outside_runs: outside_runs(results.records),
        })
    }
}
