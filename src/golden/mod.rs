//! Golden values: what a study gave when somebody last looked and said why it is right.
//!
//! A golden file carries values, the tolerance with its basis, the reason and the provenance. A
//! comparison reports what moved, what is missing and what is new; better than the golden beyond
//! the tolerance is stale, not wrong.

pub mod bounds;
pub mod case_changes;
pub mod compare;
pub mod difference_groups;
pub mod references;
pub mod tolerance;

use crate::exact::error::ExactError;
use crate::golden::references::{REFERENCES, perturbed_reference_values, reference_values};
use crate::golden::tolerance::spread_by_group;
use crate::record::provenance::Provenance;
use crate::record::store::StoreError;
use crate::record::whole_file::write_whole;
use crate::record::{ErrorRow, Record};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Version of the file's layout.
const SCHEMA: u32 = 1;
/// Allowed relative change where no spread was measured.
const RELATIVE_TOLERANCE: f64 = 1e-8;
/// Allowed absolute change of an error where no spread was measured.
const ABSOLUTE_TOLERANCE: f64 = 1e-12;
/// Where those tolerances come from.
const BASIS: &str = "no spread was measured: the point-wise and the assembled kernel, which differ in every rounding, \
                     agree to better than a tenth of it over a million steps";

/// Golden values of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoldenFile {
    /// Version of this layout.
    pub schema: u32,
    /// Study.
    pub study: String,
    /// Why these values were taken.
    pub reason: String,
    /// Change relative to the larger of the values that is always allowed.
    pub relative_tolerance: f64,
    /// Absolute change that is always allowed.
    pub absolute_tolerance: f64,
    /// Where the tolerances come from.
    pub basis: String,
    /// What made the values.
    pub provenance: Provenance,
    /// Wall time of all cases together when the values were taken, s: it warns and never fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Largest change by round-off that was measured, by case, quantity and time: a tolerance is ten
    /// times as wide.
    #[serde(default)]
    pub spread: BTreeMap<String, f64>,
    /// Signed errors and work counters by case and measure.
    pub values: BTreeMap<String, f64>,
}

/// Why golden values could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    /// There is no file.
    #[error("there is no golden file {0}: look at the results, then `oedometer accept` them with a reason")]
    Missing(PathBuf),
    /// The file cannot be read.
    #[error("the golden file {path} cannot be read: {reason}")]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The file allows what no golden file may.
    #[error("the golden file {path} is refused: {reason}")]
    OutOfBounds {
        /// Which.
        path: PathBuf,
        /// What is out of bounds.
        reason: String,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl GoldenFile {
    /// The values of records as golden, for a reason.
    pub fn of(study: &str, records: &[Record], reason: &str) -> Self {
        Self {
            schema: SCHEMA,
            study: study.to_owned(),
            reason: reason.to_owned(),
            relative_tolerance: RELATIVE_TOLERANCE,
            absolute_tolerance: ABSOLUTE_TOLERANCE,
            basis: BASIS.to_owned(),
            provenance: Provenance::of_this_program(),
            seconds: Some(seconds_of(records)),
            spread: BTreeMap::new(),
            values: values_of(records),
        }
    }

    /// The present values of the exact solutions as golden, for a reason.
    ///
    /// # Errors
    /// When a solution refuses its column: a fault of this program.
    pub fn of_references(reason: &str) -> Result<Self, ExactError> {
        let values = reference_values()?;
        let spread = spread_by_group(&values, &perturbed_reference_values()?);
        let golden = Self { seconds: None, values, ..Self::of(REFERENCES, &[], reason) };
        Ok(golden.with_spread(spread))
    }

    /// Path of a study's golden file in a folder.
    pub fn path(folder: &Path, study: &str) -> PathBuf {
        folder.join(format!("{study}.json"))
    }

    /// Reads a study's golden file.
    ///
    /// # Errors
    /// When it is missing, unreadable or out of bounds.
    pub fn read(folder: &Path, study: &str) -> Result<Self, GoldenError> {
        let path = Self::path(folder, study);
        let unreadable = |path: PathBuf, reason: String| GoldenError::Unreadable { path, reason };
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(GoldenError::Missing(path));
            }
            Err(error) => return Err(unreadable(path, error.to_string())),
        };
        let file: Self =
            serde_json::from_str(&text).map_err(|error| unreadable(path.clone(), error.to_string()))?;
        if file.schema != SCHEMA || file.study != study {
            return Err(unreadable(
                path,
                format!("it is of study `{}` and layout {}", file.study, file.schema),
            ));
        }
        match file.out_of_bounds() {
            Some(reason) => Err(GoldenError::OutOfBounds { path, reason }),
            None => Ok(file),
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When the values or tolerances are out of bounds, or the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, GoldenError> {
        let path = Self::path(folder, &self.study);
        if let Some(reason) = self.out_of_bounds() {
            return Err(GoldenError::OutOfBounds { path, reason });
        }
        let text = serde_json::to_string_pretty(self)
            .map_err(|source| StoreError::Json { path: path.clone(), source })?;
        write_whole(&path, (text + "\n").as_bytes())?;
        Ok(path)
    }
}

/// Wall time of the first run of every record together, s.
pub fn seconds_of(records: &[Record]) -> f64 {
    records.iter().filter_map(|record| record.wall.first()).map(|sample| sample.seconds).sum()
}

/// Name of a measured error within its case.
pub fn measure_name(row: &ErrorRow) -> String {
    format!(
        "{} {} {} {} T_v={}",
        row.quantity.name(),
        row.sample.name(),
        row.norm,
        row.reference,
        row.time_factor
    )
}

/// Every measured error and work counter of records, by name.
pub fn values_of(records: &[Record]) -> BTreeMap<String, f64> {
    let mut values = BTreeMap::new();
    for record in records {
        let label = record.case.label();
        values.insert(format!("{label} | steps"), record.counters.steps as f64);
        values.insert(format!("{label} | point updates"), record.counters.point_updates as f64);
        if let Some(found) = &record.stability {
            values.insert(format!("{label} | predicted critical step"), found.predicted);
            let observed = found.observed.unwrap_or(-1.0);
            values.insert(format!("{label} | observed critical step"), observed);
        }
        for row in &record.errors {
            values.insert(format!("{label} | {}", measure_name(row)), row.value);
        }
        for balance in &record.balance {
            values.insert(
                format!("{label} | water balance T_v={}", balance.time_factor),
                balance.water_imbalance,
            );
        }
    }
    values
}
