//! Golden values: results of a study that were reviewed and accepted with a reason.
//!
//! A comparison reports what moved, what is missing and what is new; better than the golden beyond
//! the tolerance is stale, not wrong.
//!
//! # The file
//!
//! `golden/STUDY.csv` has a header, whose lines begin with `#` and which is TOML behind that, and a table:
//!
//! ```text
//! # schema = 3
//! # study = "terzaghi-mesh"
//! # reason = "why these values were taken"
//! # relative_tolerance = 1e-9
//! # …
//! # [provenance]
//! # …
//! # [inputs]
//! # youngs_modulus = "1e6 Pa"
//! # …
//! case,T_v,point updates,pressure points l2 terzaghi,…,steps,…,spread of pressure,…,input cells
//! MPM implicit cells=4 points=2,,800,,…,100,…,,…,4
//! MPM implicit cells=4 points=2,0.1,,0.0213,…,,…,2.1e-11,…,
//! ```
//!
//! The header has the inputs that all cases share, the columns `input KEY` those that differ. Layout 2, which knows no
//! inputs, is read too.
//!
//! A row per case and time factor, by label and then by time; counters and inputs stand in a row without a time. Columns
//! are in the order of their names; a cell is empty where nothing was measured. A number has the digits that its
//! tolerance compares and one more. `spread of X` is the largest change by round-off of all values of the row whose
//! first word is `X`, where it is large enough to widen a tolerance. `git diff --word-diff-regex='[^,]+' golden/` shows which numbers changed.

pub mod compare;
mod file_text;
pub mod inputs;
mod output_times;
pub mod text_error;
pub mod tolerance;

use crate::golden::compare::compare;
use crate::golden::inputs::{CaseInputs, Pairing};
use crate::golden::tolerance::{ABSOLUTE_FLOOR, BASIS, RELATIVE_FLOOR, spread_group};
use crate::record::whole_file::{StoreError, write_whole};
use crate::record::{ErrorRow, Provenance, Record};
use include_dir::{Dir, include_dir};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Version of the file's layout.
const SCHEMA: u32 = 3;
/// Older version that is read too: it has no inputs.
const WITHOUT_INPUTS: u32 = 2;
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
    /// Change relative to the larger of the values that is always allowed; 1e-9 at least, whatever the file has.
    pub relative_tolerance: f64,
    /// Absolute change that is always allowed; 1e-12 at least, whatever the file has.
    pub absolute_tolerance: f64,
    /// Where the tolerances come from.
    pub basis: String,
    /// Wall time of all cases together when the values were taken, s: it warns and never fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// What made the values.
    pub provenance: Provenance,
    /// Inputs of the cases; empty where they are not known.
    #[serde(default, skip_serializing_if = "CaseInputs::is_unknown")]
    pub inputs: CaseInputs,
    /// Largest change by round-off that was measured, by case, quantity and time: a tolerance is ten
    /// times as wide.
    #[serde(skip)]
    pub spread: BTreeMap<String, f64>,
    /// Signed errors and work counters by case and measure.
    #[serde(skip)]
    pub values: BTreeMap<String, f64>,
    /// Change of each value, and of the part of 1 that it is, that the study lets pass.
    #[serde(skip)]
    pub wider: f64,
}

/// An error behind another one.
type Cause = Box<dyn std::error::Error + Send + Sync>;

/// Why golden values could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GoldenError {
    /// The file does not exist.
    #[error("there is no golden file {0}: look at the results, then `oedometer accept` them with a reason")]
    Missing(PathBuf),
    /// The file cannot be read or written, or allows what no golden file may.
    #[error("the golden file {path} {what}: {reason}")]
    Refused {
        /// Which.
        path: PathBuf,
        /// What is wrong with it.
        what: &'static str,
        /// Why, and what to do.
        reason: String,
        /// The error behind it, where there is one.
        source: Option<Cause>,
    },
    /// The file system refuses.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// What is said of a file that cannot be read.
const UNREADABLE: &str = "cannot be read";

impl GoldenError {
    /// Whether there is no file.
    pub fn is_missing(&self) -> bool {
        matches!(self, Self::Missing(_))
    }

    fn refused(path: &Path, what: &'static str, reason: String) -> Self {
        Self::Refused { path: path.to_owned(), what, reason, source: None }
    }

    /// The same, for an error of a text or of the file system, with what to do if that is more than the error says.
    fn caused(path: &Path, what: &'static str, error: impl Into<Cause>, remedy: Option<String>) -> Self {
        let error = error.into();
        let reason = remedy.unwrap_or_else(|| error.to_string());
        Self::Refused { path: path.to_owned(), what, reason, source: Some(error) }
    }
}

impl GoldenFile {
    /// The values of records as golden, for a reason.
    pub fn of(study: &str, records: &[Record], reason: &str) -> Self {
        Self {
            schema: SCHEMA,
            study: study.to_owned(),
            reason: reason.to_owned(),
            relative_tolerance: RELATIVE_FLOOR,
            absolute_tolerance: ABSOLUTE_FLOOR,
            basis: BASIS.to_owned(),
            provenance: Provenance::of_this_program(),
            seconds: Some(seconds_of(records)),
            inputs: CaseInputs::of(records.iter().map(|record| &record.case)),
            spread: BTreeMap::new(),
            values: values_of(records),
            wider: 0.0,
        }
    }

    /// The file beside cases with other inputs: the values of a case that has another label now are under that one. And
    /// how the cases belong together.
    #[must_use]
    pub fn beside(mut self, inputs: &CaseInputs) -> (Self, Pairing) {
        let pairing = Pairing::of(&self.inputs, inputs);
        self.values = pairing.rename(self.values);
        self.spread = pairing.rename(self.spread);
        self.inputs.own = pairing.rename(self.inputs.own);
        (self, pairing)
    }

    /// The file with the values and spreads of an older one wherever these agree: what is written again differs where
    /// something moved, and nowhere else.
    #[must_use]
    pub fn keeping(mut self, older: &Self) -> Self {
        let differences = compare(older, &self.values);
        // Counters share a spread with nothing: each is a group of its own.
        let group_of = |name: &str| spread_group(name).unwrap_or_else(|| name.to_owned());
        let moved: BTreeSet<String> = differences.iter().map(|one| group_of(&one.name)).collect();
        for (name, value) in &mut self.values {
            let group = group_of(name);
            let Some(before) = older.values.get(name).filter(|_| !moved.contains(&group)) else { continue };
            *value = *before;
            match older.spread.get(&group) {
                Some(spread) => self.spread.insert(group, *spread),
                None => self.spread.remove(&group),
            };
        }
        self
    }

    /// Path of a study's golden file in a folder.
    pub fn path(folder: &Path, study: &str) -> PathBuf {
        folder.join(format!("{study}.csv"))
    }

    /// Reads a study's golden file.
    ///
    /// # Errors
    /// When it is missing, unreadable or out of bounds.
    pub fn read(folder: &Path, study: &str) -> Result<Self, GoldenError> {
        let path = Self::path(folder, study);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(GoldenError::Missing(path));
            }
            Err(error) => return Err(GoldenError::caused(&path, UNREADABLE, error, None)),
        };
        let file = Self::from_text(&text).map_err(|error| {
            let remedy = remedy(&text, &path, &error);
            GoldenError::caused(&path, UNREADABLE, error, Some(remedy))
        })?;
        if file.study != study {
            return Err(GoldenError::refused(&path, UNREADABLE, format!("it is of study `{}`", file.study)));
        }
        match file.out_of_bounds() {
            Some(reason) => Err(GoldenError::refused(&path, "is refused", reason)),
            None => Ok(file),
        }
    }

    /// Reads a shipped study's golden file from a folder, or takes the one inside the program where the folder has
    /// none.
    ///
    /// # Errors
    /// As [`GoldenFile::read`].
    pub fn read_or_embedded(folder: &Path, study: &str) -> Result<Self, GoldenError> {
        match Self::read(folder, study) {
            Err(GoldenError::Missing(path)) => {
                match FILES.get_file(format!("{study}.csv")).and_then(|file| file.contents_utf8()) {
                    Some(text) => Self::from_text(text).map_err(|error| {
                        GoldenError::caused(&path, "inside the program cannot be read", error, None)
                    }),
                    None => Err(GoldenError::Missing(path)),
                }
            }
            found => found,
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When the values or tolerances are out of bounds, or the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, GoldenError> {
        let path = Self::path(folder, &self.study);
        if let Some(reason) = self.out_of_bounds() {
            return Err(GoldenError::refused(&path, "is refused", reason));
        }
        let text =
            self.to_text().map_err(|error| GoldenError::caused(&path, "cannot be written", error, None))?;
        write_whole(&path, text.as_bytes())?;
        Ok(path)
    }
}

/// Why a text is not a golden file, and what to do.
fn remedy(text: &str, path: &Path, error: &text_error::GoldenTextError) -> String {
    let marks = ["<<<<<<<", "=======", ">>>>>>>", "|||||||"];
    let mark = text.lines().position(|line| marks.iter().any(|mark| line.starts_with(mark)));
    if text.starts_with("version https://git-lfs") {
        "it is a Git LFS pointer, not the file: fetch the file with `git lfs pull`".to_owned()
    } else if let Some(line) = mark {
        format!(
            "it has conflict markers of git (line {}): take one side with `git checkout --ours {path}` or `--theirs`, and check \
             again",
            line + 1,
            path = path.display()
        )
    } else {
        format!(
            "{error}; take it from a commit by `git checkout HEAD -- {path}`, or mend it",
            path = path.display()
        )
    }
}

/// The golden files inside the program.
static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/golden");

/// Wall time of the first run of every record together, s.
pub fn seconds_of(records: &[Record]) -> f64 {
    // A sum of nothing is −0: of results that were there already none took any time.
    records.iter().filter_map(|record| record.wall.first()).map(|sample| sample.seconds).sum::<f64>() + 0.0
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

/// Case and measure of a golden value's name.
pub(crate) fn parts(name: &str) -> (&str, &str) {
    name.rsplit_once(" | ").unwrap_or((name, ""))
}

/// Whether a measure counts work: a whole number, exact, and better where it is less.
pub(crate) fn is_counter(measure: &str) -> bool {
    matches!(measure, "steps" | "point updates")
}

/// Whether a measure is an error at a time, and no balance.
pub(crate) fn is_error(measure: &str) -> bool {
    measure.contains(" T_v=") && !measure.starts_with("water")
}

/// Every measured error and work counter of records, by name.
pub fn values_of(records: &[Record]) -> BTreeMap<String, f64> {
    let mut values = BTreeMap::new();
    for record in records {
        let label = record.case.label();
        if record.case.counts_work() {
            values.insert(format!("{label} | steps"), record.counters.steps as f64);
            values.insert(format!("{label} | point updates"), record.counters.point_updates as f64);
        }
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
            if let Some(layers) = &balance.layers {
                let at = balance.time_factor;
                values.insert(format!("{label} | water balance of pores T_v={at}"), layers.pore_water);
                values.insert(
                    format!("{label} | water balance of what left T_v={at}"),
                    layers.water_left_error,
                );
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_has_the_golden_values_of_the_repository_to_the_bit() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
        let nowhere = Path::new("nowhere");
        for study in ["terzaghi-mesh", "work-precision", "column-in-the-plane"] {
            let own = GoldenFile::read_or_embedded(nowhere, study).expect("inside the program");
            assert_eq!(own, GoldenFile::read(&root, study).expect("in the repository"), "{study}");
        }
        let told = GoldenFile::read_or_embedded(nowhere, "no-such-study").expect_err("no file").to_string();
        let what = "look at the results, then `oedometer accept` them with a reason";
        assert_eq!(told, format!("there is no golden file nowhere/no-such-study.csv: {what}"));
        // A file of one's own goes before the one inside, and one of another name is refused.
        let folder = tempfile::TempDir::new().expect("a folder");
        let own = GoldenFile::of("terzaghi-mesh", &[], "one's own");
        let path = own.write(folder.path()).expect("written");
        assert_eq!(GoldenFile::read_or_embedded(folder.path(), "terzaghi-mesh").expect("read"), own);
        let other = GoldenFile::path(folder.path(), "work-precision");
        std::fs::rename(path, &other).expect("renamed");
        let told =
            GoldenFile::read_or_embedded(folder.path(), "work-precision").expect_err("refused").to_string();
        let wanted =
            format!("the golden file {} cannot be read: it is of study `terzaghi-mesh`", other.display());
        assert_eq!(told, wanted);
    }

    #[test]
    fn values_spreads_and_inputs_of_a_renamed_case_are_all_under_its_label_of_now() {
        // Labels tell the number of cells, which is that of now in a label and that of then in the inputs.
        let inputs = |now: [u32; 3], then: [u32; 3]| {
            let case = |place: usize| {
                let inputs = [("cells".to_owned(), then[place].to_string())].into();
                (format!("cells={}", now[place]), inputs)
            };
            let shared = [("scene".to_owned(), "terzaghi".to_owned())].into();
            CaseInputs { shared, own: [case(0), case(1), case(2)].into() }
        };
        let file = |now: [u32; 3], then: [u32; 3]| {
            let of = |measure: &str| {
                let named = now.iter().zip([1.0, 2.0, 3.0]);
                named.map(|(cells, value)| (format!("cells={cells} | {measure}"), value)).collect()
            };
            let (values, spread) = (of("pressure points l2 terzaghi T_v=0.1"), of("pressure T_v=0.1"));
            GoldenFile { values, spread, inputs: inputs(now, then), ..GoldenFile::of("s", &[], "test") }
        };
        let then = [4, 8, 16];
        for (now, changes) in [([5, 8, 16], 1), ([4, 9, 16], 1), ([4, 8, 17], 1), (then, 0)] {
            let (found, pairing) = file(then, then).beside(&inputs(now, now));
            assert_eq!((found, pairing.changes.len()), (file(now, then), changes));
        }
    }

    #[test]
    fn what_agrees_stays_as_it_was_written_and_what_moved_is_taken_with_its_spread() {
        let name =
            |cells: u32, norm: &str| format!("MPM cells={cells} | pressure points {norm} terzaghi T_v=0.1");
        let file = |values: [f64; 3], spread: [f64; 2]| GoldenFile {
            values: [(name(4, "l1"), values[0]), (name(4, "l2"), values[1]), (name(8, "l2"), values[2])]
                .into(),
            spread: [4, 8]
                .map(|cells| format!("MPM cells={cells} | pressure T_v=0.1"))
                .into_iter()
                .zip(spread)
                .collect(),
            ..GoldenFile::of("s", &[], "test")
        };
        let older = file([0.1, 0.2, 0.3], [1e-12, 2e-12]);
        let (round_off, moved) = (1e-11, 1e-3);
        let written = file([0.1 + round_off, 0.2, 0.3 + moved], [3e-12, 4e-12]).keeping(&older);
        assert_eq!(written, file([0.1, 0.2, 0.3 + moved], [1e-12, 4e-12]));
        // A counter has no spread to share: it is taken when it moved.
        let counted = |steps: f64| GoldenFile {
            values: [("MPM cells=4 | steps".to_owned(), steps)].into(),
            ..GoldenFile::of("s", &[], "test")
        };
        assert_eq!(counted(101.0).keeping(&counted(100.0)), counted(101.0));
    }

    #[test]
    fn values_are_of_the_whole_record_and_its_seconds_those_of_its_first_run() {
        use crate::record::{LayerBalance, WallSample};
        let mut records = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput = { time_factors = [0.1, 0.3], references = ['terzaghi'] }\n[[sweep]]\n\
             method = ['MPM']\nintegrator = ['implicit']\ncells = [2, 3]\n",
        );
        let layers = LayerBalance {
            pore_water: 3.0,
            water_left: 5.0,
            water_left_error: 7.0,
            water_points: 11,
            largest_pressure: Some(13.0),
        };
        records[1].balance[1].layers = Some(layers);
        let values = values_of(&records);
        let of = |record: &Record, measure: &str| {
            values.get(&format!("{} | {measure}", record.case.label())).copied()
        };
        assert_eq!(of(&records[1], "water balance of pores T_v=0.3"), Some(3.0));
        assert_eq!(of(&records[1], "water balance of what left T_v=0.3"), Some(7.0));
        let count = records.iter().map(|record| 2 + record.errors.len() + 2).sum::<usize>();
        assert_eq!(values.len(), count + 2, "and nothing else");
        let wall = |seconds: &[f64]| -> Vec<WallSample> {
            seconds.iter().map(|seconds| WallSample { seconds: *seconds, ..WallSample::default() }).collect()
        };
        (records[0].wall, records[1].wall) = (wall(&[3.0, 1.0]), wall(&[4.0, 9.0, 1.0]));
        assert_eq!(seconds_of(&records), 7.0);
        records[0].wall.clear();
        assert_eq!(seconds_of(&records), 4.0);
        assert_eq!(seconds_of(&[]).to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn a_critical_step_that_nobody_observed_is_no_number_of_seconds() {
        let mut records = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\n",
        );
        for (observed, stored) in [(None, -1.0), (Some(3.0), 3.0)] {
            records[0].stability = Some(crate::record::CriticalStep {
                predicted: 2.0,
                observed,
                wave_limit: 4.0,
                drag_limit: 8.0,
                combined_limit: 5.0,
                ..crate::record::CriticalStep::default()
            });
            let label = records[0].case.label();
            let values = values_of(&records);
            let step = |which: &str| values[&format!("{label} | {which} critical step")];
            assert_eq!((step("predicted"), step("observed")), (2.0, stored));
        }
    }
}
