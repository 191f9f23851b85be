//! A study compared with its expectations, its golden values, and what must hold for any record; and what seems to be wrong
//! with the results of other programs, as `score` tells it of files.

use crate::campaign::runner::RunError;
use crate::campaign::taken_over::TakenOver;
use crate::case::grouping::grouped;
use crate::case::{Case, Tier};
use crate::foreign::reading::mapping_of;
use crate::golden::compare::{
    CaseChange, Change, Difference, DifferenceGroup, case_changes, compare, groups_of,
};
use crate::golden::inputs::InputChange;
use crate::golden::measure::{GoldenKey, Measure, TimeFactor};
use crate::golden::{GoldenError, GoldenFile, values_of};
use crate::import::SampledState;
use crate::import::mapping::Axes;
use crate::judge::error_place::place_in_kept;
use crate::judge::paths::StudyPaths;
use crate::judge::proposals::proposals;
use crate::judge::verdict::{Absent, Judgement, VerdictOutcome, differing_repeats, judge_paths};
use crate::measure::soundness::{self, PoorOutput};
use crate::record::{ErrorRow, Record, Status};
use crate::score::diagnosis::diagnosis;
use crate::study::check::Study;
use crate::study::file::GoldenRule;
use oedometer_convergence::Class;
use oedometer_exact::ReferenceKind;
use oedometer_problem::snapshot::Snapshot;
use oedometer_scenes::column::column_parameters;
use oedometer_wording::{count_of, first_few};
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::collections::BTreeMap;

/// A case with a sentence about it.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct CaseNote {
    /// Label of the case.
    pub case: String,
    /// A sentence.
    pub sentence: String,
}

/// Everything found about one study.
#[derive(Debug, Default)]
pub struct StudyCheck {
    /// Name of the study.
    pub study: String,
    /// Cases that failed, with their sentences.
    pub failed_cases: Vec<CaseNote>,
    /// Records that cannot be right, whatever the study expects.
    pub unsound: Vec<CaseNote>,
    /// Verdicts on expectations.
    pub judgements: Vec<Judgement>,
    /// Labels of the cases whose inputs are others than those of their golden values.
    pub other_inputs: Vec<String>,
    /// What differs in them, where it is known.
    pub input_changes: Vec<InputChange>,
    /// Expectations that the records meet, as TOML, for a study that has none.
    pub proposals: Vec<String>,
    /// Whether golden values are compared; the study may leave the verdict to its expectations.
    pub compares_golden: bool,
    /// Why there are no golden values to compare with.
    pub golden_problem: Option<GoldenError>,
    /// Differences from the golden values.
    pub differences: Vec<Difference>,
    /// The differences by kind, with what those of a kind have in common.
    pub groups: Vec<DifferenceGroup>,
    /// Cases with such differences: accuracy and cost together, the case with the worst first.
    pub changes: Vec<CaseChange>,
    /// Golden values that agree.
    pub agreeing: usize,
    /// Expectations of the study.
    pub expected: usize,
    /// Expectations of this tier that are not judged, because none of their cases was run.
    pub unjudged: usize,
    /// Cases that were not begun, because nobody allowed their programs to start.
    pub held_back: usize,
    /// Results that were not made for this check.
    pub taken_over: Vec<TakenOver>,
    /// Warnings, which fail nothing.
    pub warnings: Vec<String>,
    /// What seems to be wrong with the results of other programs; it stands before all else.
    pub diagnoses: Vec<String>,
}

/// Something that fails, told once: all series or cases that fail one line of a study in the same checks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objection<'a> {
    /// Line of the expectation in the study's file; none of a run that fails whatever the study expects.
    pub line: Option<usize>,
    /// The first series or case.
    pub subject: &'a str,
    /// How many others fail alike.
    pub alike: usize,
    /// Why, without what only follows from another reason.
    pub reasons: Vec<&'a str>,
}

/// Inputs that differ that one sentence names.
const MOST_INPUTS: usize = 3;

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CheckEnd {
    /// All as expected.
    Pass,
    /// A verdict failed, a record is unsound, or a value moved.
    Failed,
    /// A case failed.
    CaseFailed,
    /// A golden value is missing or stale, or of other inputs.
    Golden,
    /// There are no golden values, and there cannot be any before all cases are run.
    HeldBack,
}

/// The keys of `check --format json`.
impl Serialize for StudyCheck {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut out = serializer.serialize_struct("StudyCheck", 15)?;
        out.serialize_field("study", &self.study)?;
        out.serialize_field("end", &self.end())?;
        out.serialize_field("judgements", &self.judgements)?;
        out.serialize_field("failed_cases", &self.failed_cases)?;
        out.serialize_field("unsound_records", &self.unsound)?;
        out.serialize_field("golden_values_that_agree", &self.agreeing)?;
        out.serialize_field("golden_problem", &self.golden_problem.as_ref().map(ToString::to_string))?;
        out.serialize_field("proposed_expectations", &self.proposals)?;
        out.serialize_field("cases_of_other_inputs", &self.other_inputs)?;
        out.serialize_field("groups", &self.groups)?;
        out.serialize_field("differences", &self.differences)?;
        out.serialize_field("accuracy_and_cost", &self.changes)?;
        out.serialize_field("taken_over", &self.taken_over)?;
        out.serialize_field("warnings", &self.warnings)?;
        out.serialize_field("diagnoses", &self.diagnoses)?;
        out.end()
    }
}

impl StudyCheck {
    /// Judges records and compares them.
    pub fn new(
        study: &Study,
        records: &[Record],
        tier: Tier,
        golden: Result<GoldenFile, GoldenError>,
    ) -> Self {
        Self::along(&StudyPaths::of(records), study, records, tier, golden)
    }

    /// Judges records by their paths and compares them.
    pub fn along(
        paths: &StudyPaths<'_>,
        study: &Study,
        records: &[Record],
        tier: Tier,
        golden: Result<GoldenFile, GoldenError>,
    ) -> Self {
        let absent = Absent::among(records);
        let compares_golden = study.golden != GoldenRule::None;
        let unused = (golden.is_ok() && !compares_golden).then(|| {
            "the golden values of this study are not compared, because it has `golden = \"none\"`".to_owned()
        });
        let cases: Vec<&Case> = records.iter().map(|record| &record.case).collect();
        let compared = match golden {
            _ if !compares_golden => Self::default(),
            Err(problem) => Self { golden_problem: Some(problem), ..Self::default() },
            Ok(golden) => {
                let (golden, other_inputs) = absent.without(golden.allowing(study.golden)).beside(&cases);
                let golden =
                    if study.has_dates { golden.at_the_times_of(&cases, &other_inputs) } else { golden };
                let compared = Self::of_values(&values_of(records), &golden).with_places(records);
                Self { other_inputs, ..compared }
            }
        };
        let notes = |of: &dyn Fn(&Record) -> Vec<String>| {
            let of_record = |record: &Record| {
                let label = record.case.label();
                let note = move |sentence| CaseNote { case: label.clone(), sentence };
                of(record).into_iter().map(note).collect::<Vec<_>>()
            };
            records.iter().flat_map(of_record).collect::<Vec<_>>()
        };
        Self {
            study: study.name.clone(),
            failed_cases: notes(&|record| {
                let is_foreseen = record.status.is_skipped() || study.foresees(record);
                let failure = record.status.failure().filter(|_| !is_foreseen);
                failure.map(ToString::to_string).into_iter().collect()
            }),
            proposals: proposals(study, paths),
            // Partial results of a failed run are not judged.
            unsound: notes(&|record| match record.status {
                Status::Ok if !study.foresees_complaints(record) => soundness::complaints(record),
                _ => Vec::new(),
            }),
            judgements: judge_paths(study, records, paths, tier),
            expected: study.expectations.len() + study.case_expectations.len(),
            unjudged: absent.unjudged(study, tier),
            held_back: absent.held_back(study),
            warnings: (unused.into_iter())
                .chain(unjudged_outputs(study, records))
                .chain(absent.warnings())
                .chain(differing_repeats(records))
                .collect(),
            diagnoses: diagnoses(study, records),
            compares_golden,
            ..compared
        }
    }

    /// Adds the places with the largest errors of records that cannot be made again.
    fn with_places(mut self, records: &[Record]) -> Self {
        for group in &mut self.groups {
            let key = &group.worst.key;
            let record = records.iter().find(|record| record.case.label() == *key.case);
            group.place = record.and_then(|record| {
                let is_it = |row: &&ErrorRow| {
                    key.time == Some(TimeFactor(row.time_factor))
                        && Measure::of_error(row).as_ref() == Some(&key.measure)
                };
                place_in_kept(record, record.errors.iter().find(is_it)?)
            });
        }
        self
    }

    /// Adds the cases that have no record, because a reference refused or a run crashed: they failed.
    #[must_use]
    pub fn with_errors(mut self, errors: &[RunError]) -> Self {
        let notes = errors.iter().filter_map(RunError::of_case);
        self.failed_cases.extend(notes.map(|(case, sentence)| CaseNote { case: case.to_owned(), sentence }));
        self
    }

    /// Adds the results that were taken over.
    #[must_use]
    pub fn with_taken_over(mut self, taken_over: &[TakenOver]) -> Self {
        self.taken_over = taken_over.to_vec();
        self
    }

    /// Expectations that are not met.
    pub fn unmet(&self) -> impl Iterator<Item = &Judgement> {
        self.judgements.iter().filter(|judgement| !judgement.verdict.pass)
    }

    /// How many expectations are met.
    pub fn met(&self) -> usize {
        self.judgements.len() - self.unmet().count()
    }

    /// Whether every expectation is met, by records that are sound.
    pub fn meets_all(&self) -> bool {
        self.unsound.is_empty() && self.met() == self.judgements.len()
    }

    /// Compares values alone.
    fn of_values(values: &BTreeMap<GoldenKey, f64>, golden: &GoldenFile) -> Self {
        let differences = compare(golden, values);
        let new = values.keys().filter(|key| !golden.values.contains_key(*key));
        Self {
            agreeing: values.len() - differences.iter().filter(|one| one.found.is_some()).count(),
            groups: groups_of(&differences, golden.values.keys().chain(new)),
            changes: case_changes(&differences),
            differences,
            ..Self::default()
        }
    }

    /// A sentence on the cases whose inputs are others than those of their golden values, with what differs where that is known;
    /// none where there are no such cases.
    pub fn sentence_on_inputs(&self) -> Option<String> {
        let first = self.other_inputs.first()?;
        let (has, their) = if self.other_inputs.len() == 1 { ("has", "its") } else { ("have", "their") };
        let which = match self.input_changes.as_slice() {
            [] => "`git diff` of the study shows which".to_owned(),
            changes => first_few(changes.iter().map(InputChange::sentence).collect(), MOST_INPUTS).join(", "),
        };
        Some(format!(
            "{} {has} other inputs than {their} golden values, like `{first}`: {which}",
            count_of(self.other_inputs.len(), "case", "cases")
        ))
    }

    /// The same, with what differs in the inputs of its cases.
    #[must_use]
    pub fn with_input_changes(self, input_changes: Vec<InputChange>) -> Self {
        Self { input_changes, ..self }
    }

    /// What fails, golden values aside, each once: unmet expectations, failed cases, and records that break a balance or a bound.
    pub fn objections(&self) -> Vec<Objection<'_>> {
        let failing = |judgement: &Judgement| {
            let checks = judgement.verdict.checks.iter().filter(|check| !check.pass && !check.follows);
            checks.map(|check| check.name.clone()).collect::<Vec<_>>()
        };
        let unmet = grouped(self.unmet(), |judgement| (judgement.line, failing(judgement)));
        let mut objections: Vec<Objection<'_>> = Vec::new();
        for ((line, _), all) in unmet {
            let (first, alike) = (all[0], all.len() - 1);
            let (subject, reasons) = (first.subject.as_str(), reasons_of(first));
            objections.push(Objection { line: Some(line), subject, alike, reasons });
        }
        // That a case failed is told by the expectation of its end, where there is one.
        let is_told = |case: &str| {
            let of_end = |one: &&Judgement| {
                one.verdict.checks.iter().any(|check| check.name == "status" && !check.pass)
            };
            self.judgements.iter().filter(of_end).any(|one| one.subject.starts_with(case))
        };
        let failed = self.failed_cases.iter().filter(|note| !is_told(&note.case));
        for notes in [failed.collect::<Vec<_>>(), self.unsound.iter().collect()] {
            for (case, notes) in grouped(notes, |note| note.case.as_str()) {
                let reasons: Vec<&str> = notes.into_iter().map(|note| note.sentence.as_str()).collect();
                match objections.iter_mut().find(|one| one.line.is_none() && one.reasons == reasons) {
                    Some(alike) => alike.alike += 1,
                    None => objections.push(Objection { line: None, subject: case, alike: 0, reasons }),
                }
            }
        }
        objections
    }

    /// Whether a value moved that no better accuracy or lower cost of its case makes up for.
    fn has_moved(&self) -> bool {
        let excused = |case: &str| self.changes.iter().any(|change| change.case == case && change.is_stale());
        self.differences.iter().any(|one| one.change == Change::Moved && !excused(&one.key.case))
    }

    /// How the check came out, the worst first: a verdict, an unsound record or a value that moved,
    /// a failed case, a golden value that is missing, stale, or of other inputs.
    pub fn end(&self) -> CheckEnd {
        if self.unmet().next().is_some() || !self.unsound.is_empty() || self.has_moved() {
            CheckEnd::Failed
        } else if !self.failed_cases.is_empty() {
            CheckEnd::CaseFailed
        } else if self.held_back > 0
            && (!self.compares_golden || self.golden_problem.as_ref().is_some_and(GoldenError::is_missing))
        {
            CheckEnd::HeldBack
        } else if self.golden_problem.is_some()
            || !self.differences.is_empty()
            || !self.other_inputs.is_empty()
        {
            CheckEnd::Golden
        } else {
            CheckEnd::Pass
        }
    }
}

/// Why an expectation is not met: each failed check, of a class no more than which it is.
fn reasons_of(judgement: &Judgement) -> Vec<&str> {
    let verdict = &judgement.verdict;
    if verdict.outcome == VerdictOutcome::UnexpectedPass {
        return vec![&verdict.reason];
    }
    let failed = verdict.checks.iter().filter(|check| !check.pass && !check.follows);
    failed
        .map(|check| match check.name.as_str() {
            "class" if verdict.classification.class != Class::NotEvaluable => {
                check.reason.split(':').next().unwrap_or_default()
            }
            _ => &check.reason,
        })
        .collect()
}

/// One sentence for each reference that is too inaccurate at some outputs, of the record that it suits least.
fn unjudged_outputs(study: &Study, records: &[Record]) -> Vec<String> {
    let ended = records.iter().filter(|record| record.status == Status::Ok && !study.is_race);
    let sound = ended.filter(|record| soundness::complaints(record).is_empty());
    let poor = sound.flat_map(|record| {
        soundness::unjudged_outputs(record).into_iter().map(move |output| (record, output))
    });
    let groups = grouped(poor, |(_, output)| (output.reference.clone(), output.time_factor.to_bits()));
    let sentence = |(_, cases): (_, Vec<(&Record, PoorOutput)>)| {
        let (record, output) = cases.iter().min_by(|a, b| a.1.error.total_cmp(&b.1.error))?;
        let more = match cases.len() - 1 {
            0 => String::new(),
            more => format!(" (and {} more)", count_of(more, "case", "cases")),
        };
        Some(format!("{}{more}: {}; this output is not judged", record.case.label(), output.sentence()))
    };
    groups.into_iter().filter_map(sentence).collect()
}

/// Sentences on the other programs among records; of each with the same soil and body the finest mesh is looked at.
pub fn diagnoses(study: &Study, records: &[Record]) -> Vec<String> {
    let mut finest: BTreeMap<String, &Record> = BTreeMap::new();
    for record in records.iter().filter(|record| record.outside_run().is_some()) {
        let rest = Case { cells: 0, ..record.case.clone() };
        let known = finest.entry(rest.label()).or_insert(record);
        if known.case.cells < record.case.cells {
            *known = record;
        }
    }
    let labelled = |record: &Record| {
        let label = record.case.label();
        of_record(study, record).into_iter().map(move |sentence| format!("{label}: {sentence}"))
    };
    finest.into_values().flat_map(labelled).collect()
}

/// Sentences on one record: none where its result is missing, or no reference is known for it.
fn of_record(study: &Study, record: &Record) -> Vec<String> {
    let case = &record.case;
    let reference = record.references.first().and_then(|used| used.name.parse::<ReferenceKind>().ok());
    let mapping = study.solver_of(case).and_then(|solver| mapping_of(solver, Axes::of(study.scene)).ok());
    let (Some(reference), Some(mapping)) = (reference, mapping) else { return Vec::new() };
    let states: Vec<SampledState> =
        record.snapshots.iter().map(|snapshot| state_of(snapshot, record)).collect();
    let parameters = column_parameters(&case.column, &case.material);
    diagnosis(&parameters, reference.for_soil(&case.material), &states, &mapping)
}

/// A snapshot as the state that it was made of.
fn state_of(snapshot: &Snapshot, record: &Record) -> SampledState {
    let Some(samples) = record.main_sample().samples(snapshot) else { return SampledState::default() };
    let plane = samples.plane.clone().unwrap_or_default();
    SampledState {
        time: snapshot.time,
        initial_distance: plane.initial_distance,
        initial_height: samples.initial_height.clone(),
        volume: samples.volume.clone(),
        pressure: samples.pressure.clone(),
        effective_stress: samples.effective_stress.clone(),
        displacement: samples.displacement.clone(),
        horizontal_displacement: plane.horizontal_displacement,
        ..SampledState::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_convergence::ParetoChange;

    #[test]
    fn a_check_ends_by_the_worst_that_it_found() {
        let named = |case: &str| crate::golden::measure::key(case, 0.1, "pressure points terzaghi");
        let difference = |case: &str, change: Change| {
            let (golden, found) = (Some(1.0), Some(2.0));
            Difference { key: named(case), change, golden, found, tolerance: 1e-9 }
        };
        let changed = |case: &str, change: ParetoChange| {
            let case = case.to_owned();
            CaseChange { case, change, cost_ratio: 1.0, worse: 0, better: 1, unpaired: 0 }
        };
        let (one, two) = (difference("a", Change::Moved), difference("b", Change::Moved));
        let better = vec![changed("a", ParetoChange::Better)];
        for (differences, changes, end) in [
            (vec![], vec![], CheckEnd::Pass),
            (vec![difference("a", Change::Extra)], vec![], CheckEnd::Golden),
            (vec![one.clone()], vec![], CheckEnd::Failed),
            (vec![one.clone()], better.clone(), CheckEnd::Golden),
            (vec![one.clone()], vec![changed("a", ParetoChange::Dominated)], CheckEnd::Failed),
            (vec![two.clone()], better.clone(), CheckEnd::Failed),
            (vec![one, two], better, CheckEnd::Failed),
        ] {
            let told = format!("{differences:?} {changes:?}");
            let check = StudyCheck { differences, changes, ..StudyCheck::default() };
            assert_eq!(check.end(), end, "{told}");
            let note = || vec![CaseNote { case: "a".to_owned(), sentence: "it failed".to_owned() }];
            let failed = StudyCheck { failed_cases: note(), ..check };
            assert_eq!(
                failed.end(),
                if end == CheckEnd::Failed { end } else { CheckEnd::CaseFailed },
                "{told}"
            );
            assert_eq!(StudyCheck { unsound: note(), ..failed }.end(), CheckEnd::Failed, "{told}");
        }
        // Values that agree are those that are in both files and no difference.
        let values = |list: [(&str, f64); 3]| list.map(|(name, value)| (named(name), value)).into();
        let golden: BTreeMap<GoldenKey, f64> = values([("same", 1.0), ("moved", 2.0), ("gone", 1.0)]);
        let file = GoldenFile { values: golden, ..GoldenFile::of("t", &[], "a test") };
        let values = values([("same", 1.0), ("moved", 9.0), ("new", 1.0)]);
        let check = StudyCheck::of_values(&values, &file);
        assert_eq!((check.agreeing, check.differences.len()), (1, 3));
        let missing = Some(GoldenError::Missing("t.csv".into()));
        assert_eq!(StudyCheck { golden_problem: missing, ..StudyCheck::default() }.end(), CheckEnd::Golden);
    }
}
