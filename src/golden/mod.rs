//! Golden values: results of a study that were reviewed and accepted with a reason.
//!
//! A comparison reports what moved, what is missing and what is new; better than the golden beyond
//! the tolerance is stale, not wrong.
//!
//! # The file
//!
//! `golden/STUDY.csv` has two lines that begin with `#` and a table; what made the values is said by the commit:
//!
//! ```text
//! # golden 4 · terzaghi-mesh
//! # reason: why these values were taken
//! case,hash,T_v,steps,…,pressure points terzaghi,…,spread of pressure
//! MPM implicit cells=4 points=2,1f0c5a7e90b3d842,,100,…,,…,
//! MPM implicit cells=4 points=2,,0.1,,…,2.130512e-2,…,2.1e-11
//! ```
//!
//! A row per case and time factor, by label and then by time; the hash of its inputs and what a case has once stand in the
//! row without a time. An error is kept in the norm that its quantity is reported in first, `l2` or `relative`, with seven
//! digits; a cell is empty where nothing was measured. `spread of X` is the largest change by round-off of the errors of X at
//! that time, where it is large enough to widen a tolerance. Layouts 2 and 3 are read too (`older`).
//! `git diff --word-diff-regex='[^,]+' golden/` shows which numbers changed.

pub mod compare;
mod file_text;
pub mod inputs;
pub mod measure;
mod older;
pub mod text_error;
pub mod tolerance;

use crate::case::Case;
use crate::golden::compare::compare;
use crate::golden::measure::{GoldenKey, Measure, SpreadKey, TimeFactor, WaterBalance};
use crate::record::Record;
use crate::record::atomic_file::{StoreError, write_atomically};
use include_dir::{Dir, include_dir};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Version of the file's layout.
const LAYOUT: u32 = 4;

/// Golden values of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct GoldenFile {
    /// Study.
    pub study: String,
    /// Why these values were taken.
    pub reason: String,
    /// The cases by their labels, with the hashes of their inputs; empty where that is not known.
    pub cases: BTreeMap<Arc<str>, String>,
    /// Signed errors, balances, steps and critical steps.
    pub values: BTreeMap<GoldenKey, f64>,
    /// Largest change by round-off that was measured: a tolerance is ten times as wide.
    pub spread: BTreeMap<SpreadKey, f64>,
    /// Change of each value, and of the part of 1 that it is, that the study lets pass.
    pub wider: f64,
}

/// An error behind another one.
type Cause = Box<dyn std::error::Error + Send + Sync>;

/// Why golden values could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GoldenError {
    /// The file does not exist.
    #[error(
        "there are no golden values yet ({0}): if the results look right, accept them with `oedometer \
         accept` and a reason"
    )]
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
            study: study.to_owned(),
            reason: reason.to_owned(),
            cases: records.iter().map(|record| (record.case.label().into(), record.case.hash())).collect(),
            values: values_of(records),
            spread: BTreeMap::new(),
            wider: 0.0,
        }
    }

    /// The file beside the cases of now: a case that has another label now stands under that one, where its inputs are the
    /// same. And the labels of the cases with other inputs.
    #[must_use]
    pub fn beside(mut self, cases: &[&Case]) -> (Self, Vec<String>) {
        let present: BTreeMap<Arc<str>, String> =
            cases.iter().map(|case| (case.label().into(), case.hash())).collect();
        let is_new = |(label, _): &(&Arc<str>, &String)| !self.cases.contains_key(*label);
        let mut new: BTreeMap<&String, &Arc<str>> =
            present.iter().filter(is_new).map(|(label, hash)| (hash, label)).collect();
        let gone = self.cases.iter().filter(|(label, _)| !present.contains_key(*label));
        let renamed = gone.filter_map(|(label, hash)| Some((label.clone(), new.remove(hash)?.clone())));
        let renamed: BTreeMap<Arc<str>, Arc<str>> = renamed.collect();
        let is_other = |(label, hash): &(&Arc<str>, &String)| {
            !hash.is_empty() && present.get(*label).is_some_and(|now| now != *hash)
        };
        let others = self.cases.iter().filter(is_other).map(|(label, _)| label.to_string()).collect();
        self.put_at(|case, time| (renamed.get(&case).cloned().unwrap_or(case), time));
        (self, others)
    }

    /// Puts what is kept of each case and output under another label and another time factor.
    fn put_at(&mut self, place: impl Fn(Arc<str>, Option<TimeFactor>) -> (Arc<str>, Option<TimeFactor>)) {
        let cases = std::mem::take(&mut self.cases).into_iter();
        self.cases = cases.map(|(case, hash)| (place(case, None).0, hash)).collect();
        let values = std::mem::take(&mut self.values).into_iter().map(|(key, value)| {
            let (case, time) = place(key.case, key.time);
            (GoldenKey { case, time, ..key }, value)
        });
        self.values = values.collect();
        let spread = std::mem::take(&mut self.spread).into_iter().map(|(key, value)| {
            let (case, time) = place(key.case, key.time);
            (SpreadKey { case, time, ..key }, value)
        });
        self.spread = spread.collect();
    }

    /// The file of a study that names times: the outputs of a case whose inputs are others stand under the time factors of
    /// now, one by one, for they are at the same times.
    #[must_use]
    pub fn at_the_times_of(mut self, cases: &[&Case], others: &[String]) -> Self {
        for case in cases.iter().filter(|case| others.contains(&case.label())) {
            let label: Arc<str> = case.label().into();
            let of_case = self.values.keys().filter(|key| key.case == label);
            let before: BTreeSet<TimeFactor> = of_case.filter_map(|key| key.time).collect();
            let now: BTreeSet<TimeFactor> = case.time_factors.iter().copied().map(TimeFactor).collect();
            if before.len() == now.len() {
                let moved: BTreeMap<TimeFactor, TimeFactor> = before.into_iter().zip(now).collect();
                let at = |time: TimeFactor| moved.get(&time).copied().unwrap_or(time);
                self.put_at(|case, time| {
                    let time = if case == label { time.map(at) } else { time };
                    (case, time)
                });
            }
        }
        self
    }

    /// The file with the values and spreads of an older one wherever these agree: what is written again differs where
    /// something moved, and nowhere else.
    #[must_use]
    pub fn keeping(mut self, older: &Self) -> Self {
        let differences = compare(older, &self.values);
        let moved: BTreeSet<&GoldenKey> = differences.iter().map(|one| &one.key).collect();
        let moved_groups: BTreeSet<SpreadKey> = moved.iter().filter_map(|key| key.spread()).collect();
        let has_moved = |key: &GoldenKey| match key.spread() {
            Some(group) => moved_groups.contains(&group),
            // Steps share a spread with nothing.
            None => moved.contains(key),
        };
        for (key, value) in &mut self.values {
            let Some(before) = older.values.get(key).filter(|_| !has_moved(key)) else { continue };
            *value = *before;
            let Some(group) = key.spread() else { continue };
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
            return Err(GoldenError::refused(
                &path,
                UNREADABLE,
                format!("it is for the study `{}`", file.study),
            ));
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
        write_atomically(&path, text.as_bytes())?;
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
        format!("{error}; restore it with `git checkout HEAD -- {path}`, or fix it", path = path.display())
    }
}

/// The golden files inside the program.
static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/golden");

/// Every value of records that is kept.
pub fn values_of(records: &[Record]) -> BTreeMap<GoldenKey, f64> {
    let mut values = BTreeMap::new();
    for record in records {
        let case: Arc<str> = record.case.label().into();
        let mut keep = |time: Option<f64>, measure: Measure, value: f64| {
            values.insert(GoldenKey { case: case.clone(), time: time.map(TimeFactor), measure }, value);
        };
        if record.case.has_integrator() {
            keep(None, Measure::Steps, record.counters.steps as f64);
        }
        if let Some(found) = &record.stability {
            keep(None, Measure::CriticalStep { is_observed: false }, found.predicted);
            keep(None, Measure::CriticalStep { is_observed: true }, found.observed.unwrap_or(-1.0));
        }
        for row in &record.errors {
            if let Some(measure) = Measure::of_error(row) {
                keep(Some(row.time_factor), measure, row.value);
            }
        }
        for balance in &record.balance {
            let at = Some(balance.time_factor);
            keep(at, Measure::Water(WaterBalance::Body), balance.water_imbalance);
            if let Some(layers) = &balance.layers {
                keep(at, Measure::Water(WaterBalance::Pores), layers.pore_water);
                keep(at, Measure::Water(WaterBalance::WhatLeft), layers.water_left_error);
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Norm;
    use crate::golden::measure::key;

    #[test]
    fn the_program_has_the_golden_values_of_the_repository_to_the_bit() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
        let nowhere = Path::new("nowhere");
        for study in ["terzaghi-mesh", "work-precision", "column-in-the-plane"] {
            let own = GoldenFile::read_or_embedded(nowhere, study).expect("inside the program");
            assert_eq!(own, GoldenFile::read(&root, study).expect("in the repository"), "{study}");
        }
        let told = GoldenFile::read_or_embedded(nowhere, "no-such-study").expect_err("no file").to_string();
        let what = "if the results look right, accept them with `oedometer accept` and a reason";
        assert_eq!(told, format!("there are no golden values yet (nowhere/no-such-study.csv): {what}"));
        // A file of one's own goes before the one inside, and one of another name is refused.
        let folder = tempfile::TempDir::new().expect("a folder");
        let own = GoldenFile::of("terzaghi-mesh", &[], "one's own");
        let path = own.write(folder.path()).expect("written");
        assert_eq!(GoldenFile::read_or_embedded(folder.path(), "terzaghi-mesh").expect("read"), own);
        let other = GoldenFile::path(folder.path(), "work-precision");
        std::fs::rename(path, &other).expect("renamed");
        let told =
            GoldenFile::read_or_embedded(folder.path(), "work-precision").expect_err("refused").to_string();
        let wanted = format!(
            "the golden file {} cannot be read: it is for the study `terzaghi-mesh`",
            other.display()
        );
        assert_eq!(told, wanted);
    }

    /// Cases of a study in times, with a soil.
    fn cases(soil: &str, methods: &str) -> Vec<Case> {
        let text = format!(
            "title = 't'\nscene = 'terzaghi'\noutput.times = ['10 s', '20 s']\n{soil}\n[[sweep]]\nmethod = [{methods}]\n\
             integrator = ['implicit']\ncells = [2, 3]\n"
        );
        crate::campaign::runner::study_of("t", &text)
            .planned
            .into_iter()
            .map(|planned| planned.case)
            .collect()
    }

    /// A file of cases, with values and spreads that are their numbers.
    fn file_of(cases: &[&Case], label: impl Fn(&Case) -> String) -> GoldenFile {
        let mut file = GoldenFile::of("t", &[], "test");
        for (case, number) in cases.iter().zip([1.0, 2.0, 3.0, 4.0]) {
            let label = label(case);
            file.cases.insert(label.as_str().into(), case.hash());
            for time in case.time_factors.iter() {
                let key = key(&label, *time, "pressure points terzaghi");
                file.spread.insert(key.spread().expect("a spread"), number);
                file.values.insert(key, number);
            }
        }
        file
    }

    #[test]
    fn a_renamed_case_of_the_same_inputs_is_under_its_label_of_now_and_other_inputs_are_named() {
        let cases = cases("", "'MPM'");
        let all: Vec<&Case> = cases.iter().collect();
        let (two, three) = (cases[0].label(), cases[1].label());
        let now = file_of(&all, Case::label);
        // The first case had another name, or all had.
        for (name, then) in [("cells=2", "coarse"), ("cells", "meshes")] {
            let then = file_of(&all, |case| case.label().replace(name, then));
            assert_eq!(then.beside(&all), (now.clone(), vec![]));
        }
        // One that is gone has no partner, and each at most one.
        let (found, _) = file_of(&all, |case| case.label().replace("cells", "meshes")).beside(&all[..1]);
        let labels: Vec<String> = found.cases.keys().map(ToString::to_string).collect();
        assert_eq!(labels, [two.clone(), three.replace("cells", "meshes")]);
        // The label of one case stands for another now.
        let mut other = cases[0].clone();
        other.material.porosity = 0.4;
        let (found, others) = now.clone().beside(&[&other, all[1]]);
        assert_eq!((found, others), (now.clone(), vec![two.clone()]));
        let mut unknown = now.clone();
        unknown.cases.insert(two.as_str().into(), String::new());
        assert_eq!(unknown.clone().beside(&[&other, all[1]]), (unknown, vec![]));
    }

    #[test]
    fn the_outputs_of_a_study_in_times_are_those_of_other_time_factors_where_its_soil_is_another() {
        let then = cases("", "'MPM'");
        let now = cases("material.hydraulic_conductivity = 2e-4", "'MPM'");
        let [then, now]: [Vec<&Case>; 2] = [then.iter().collect(), now.iter().collect()];
        assert_ne!(then[0].time_factors, now[0].time_factors);
        let (file, others) = file_of(&then, Case::label).beside(&now);
        assert_eq!(others.len(), 2);
        let wanted = GoldenFile { cases: file.cases.clone(), ..file_of(&now, Case::label) };
        assert_eq!(file.clone().at_the_times_of(&now, &others), wanted);
        assert_eq!(file.clone().at_the_times_of(&now, &[]), file, "of the same inputs");
        let fewer = Case { time_factors: vec![0.1].into(), ..now[0].clone() };
        assert_eq!(file.clone().at_the_times_of(&[&fewer], &others), file, "another number of outputs");
    }

    #[test]
    fn what_agrees_stays_as_it_was_written_and_what_moved_is_taken_with_its_spread() {
        let value = |case: &str, sample: &str| key(case, 0.1, &format!("pressure {sample} terzaghi"));
        let file = |values: [f64; 3], spread: [f64; 2]| GoldenFile {
            values: [
                (value("a", "points"), values[0]),
                (value("a", "nodes"), values[1]),
                (value("b", "nodes"), values[2]),
            ]
            .into(),
            spread: ["a", "b"]
                .map(|case| value(case, "points").spread().expect("a spread"))
                .into_iter()
                .zip(spread)
                .collect(),
            ..GoldenFile::of("s", &[], "test")
        };
        let older = file([0.1, 0.2, 0.3], [1e-8, 2e-8]);
        let (round_off, moved) = (1e-11, 1e-3);
        let written = file([0.1 + round_off, 0.2, 0.3 + moved], [3e-8, 4e-8]).keeping(&older);
        assert_eq!(written, file([0.1, 0.2, 0.3 + moved], [1e-8, 4e-8]));
        // Steps have no spread to share: they are taken when they moved.
        let counted = |steps: f64| GoldenFile {
            values: [(key("a", None, "steps"), steps)].into(),
            ..GoldenFile::of("s", &[], "test")
        };
        assert_eq!(counted(101.0).keeping(&counted(100.0)), counted(101.0));
    }

    #[test]
    fn values_are_of_the_whole_record_in_the_norm_that_is_reported_first() {
        use crate::record::LayerBalance;
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
        let of =
            |time: f64, measure: &str| values.get(&key(&records[1].case.label(), time, measure)).copied();
        assert_eq!(of(0.3, "water balance of pores"), Some(3.0));
        assert_eq!(of(0.3, "water balance of what left"), Some(7.0));
        for (row, title) in
            [(Norm::L2, "pressure points terzaghi"), (Norm::Relative, "settlement surface terzaghi")].map(
                |(norm, title)| {
                    (records[1].errors.iter().find(|row| row.norm == norm).expect("a row"), title)
                },
            )
        {
            assert_eq!(of(row.time_factor, title), Some(row.value));
        }
        // Steps; at each of two times three fields at three samples, a settlement and a balance; what the second set adds.
        assert_eq!(values.len(), 2 * (1 + 2 * (9 + 1 + 1)) + 2);
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
            let step = |which: &str| values[&key(&label, None, &format!("{which} critical step"))];
            assert_eq!((step("predicted"), step("observed")), (2.0, stored));
        }
    }
}
