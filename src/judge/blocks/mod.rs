//! What the blocks of a study's page print, block by block: every number is computed here and `render` only writes it.

pub mod checks;
pub mod fields;
pub mod floors;
pub mod outside_runs;
pub mod profiles;
pub mod setting;
pub mod soil_map;
pub mod timing;

use crate::judge::study_results::StudyResults;
use crate::measure::statistics::larger;
use checks::{EndFinding, GroupFinding, MeasureFinding, WorstCheck};
use fields::{FieldsFinding, LoadCurves};
use oedometer_exact::ExactError;
use outside_runs::OutsideRunFinding;
use profiles::ProfilesFinding;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use setting::SettingFinding;
use soil_map::MapFinding;
use std::collections::BTreeMap;
use timing::TimingFinding;

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
            ends: checks::ends(results),
            measures: checks::measures(results.records),
            checks: checks::worst_checks(results.records),
            groups: checks::largest_groups(results.records),
            timing: timing::timed_runs(results),
            map: MapFinding::new(&soil_map::soils_of(results)).filter(|_| drawn),
            outside_runs: outside_runs::outside_runs(results.records),
        })
    }
}

/// A reference over all studies of a report.
#[derive(Clone, Debug, PartialEq)]
pub struct UsedReference {
    /// Name.
    pub name: String,
    /// Most terms of its series.
    pub terms: usize,
    /// Largest bound of what its series leaves out, over the load.
    pub tail_bound: f64,
}

/// The references of all records by name.
pub fn used_references(results: &[StudyResults<'_>]) -> Vec<UsedReference> {
    let mut used: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for reference in results.iter().flat_map(|one| one.records).flat_map(|record| &record.references) {
        let (terms, tail_bound) = used.entry(reference.name.as_str()).or_default();
        *terms = (*terms).max(reference.terms);
        *tail_bound = larger(*tail_bound, reference.tail_bound);
    }
    let used = used.into_iter().map(|(name, (terms, tail_bound))| UsedReference {
        name: name.to_owned(),
        terms,
        tail_bound,
    });
    used.collect()
}
