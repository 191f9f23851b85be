//! Everything that a page, a table or a terminal says about a study, as one value: the findings with the verdicts, and the
//! words that the study brings along. Pages take nothing else.

use crate::case::Task;
use crate::case::grouping::distinct;
use crate::judge::verdict::Judgement;
use crate::measure::statistics::larger;
use crate::questions::findings::Findings;
use crate::questions::study_results::StudyResults;
use crate::record::provenance::{Origins, Provenance};
use crate::study::check::Study;
use oedometer_exact::ExactError;
use oedometer_scenes::scene::Question;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A study with everything that is found about it.
#[derive(Clone, Debug)]
pub struct StudyFindings {
    /// Its name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What it asks and answers, in its words.
    pub summary: String,
    /// The command that runs it again.
    pub run_command: String,
    /// Whether it has a page of its own.
    pub has_page: bool,
    /// What it asks.
    pub question: StudyQuestion,
    /// Whether its page begins with a verdict: a situation of the race is judged by its answer.
    pub shows_verdict: bool,
    /// The findings that are written beside its page.
    pub plain: Findings,
    /// Its runs.
    pub runs: usize,
    /// Names of its methods.
    pub methods: Vec<String>,
    /// Its expectations, judged.
    pub judgements: Vec<Judgement>,
    /// How many of them are met.
    pub met: usize,
    /// Whether all are, by records that are sound.
    pub passes: bool,
    /// Records that cannot be right: the case and a sentence.
    pub unsound: Vec<(String, String)>,
    /// What seems to be wrong with the results of other programs, as sentences.
    pub diagnoses: Vec<String>,
    /// What made its records.
    pub origins: Origins,
}

/// What studies ask, in the order of a reader's questions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StudyQuestion {
    /// Which method reaches 1 %, and at what cost?
    Race,
    /// How fast does the error fall at small strain?
    SmallStrain,
    /// At large strain?
    LargeStrain,
    /// Where points move through the mesh?
    MovingPoints,
    /// What locks in the plane?
    Locking,
    /// Do layers and yielding soils converge?
    Layers,
    /// Do waves keep their speed and height?
    Waves,
    /// Does a body under its own weight stay at rest?
    Rest,
    /// Which steps are stable?
    Stability,
}

impl StudyQuestion {
    /// The question of a study, by its task and scene.
    fn new(study: &Study) -> Self {
        let is_stability = study.planned.iter().any(|planned| planned.case.task == Task::Stability);
        match study.scene.question {
            _ if study.is_race => Self::Race,
            _ if is_stability => Self::Stability,
            Question::SmallStrain => Self::SmallStrain,
            Question::LargeStrain => Self::LargeStrain,
            Question::MovingPoints => Self::MovingPoints,
            Question::Locking => Self::Locking,
            Question::Layers => Self::Layers,
            Question::Waves => Self::Waves,
            Question::Rest => Self::Rest,
        }
    }
}

impl StudyFindings {
    /// Everything about a study, from its records and verdicts.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(results: &StudyResults<'_>) -> Result<Self, ExactError> {
        let StudyResults { study, records, check, .. } = results;
        let mut origins = Origins::default();
        for record in *records {
            origins.add(&record.provenance);
        }
        Ok(Self {
            name: study.name.clone(),
            title: study.title.clone(),
            summary: study.summary.clone(),
            run_command: results.run_command(),
            has_page: results.has_page,
            question: StudyQuestion::new(study),
            shows_verdict: !study.is_race || !check.judgements.is_empty() || !check.meets_all(),
            plain: Findings::new(results)?,
            runs: records.len(),
            methods: distinct(records.iter().map(|record| record.case.method.to_string())),
            judgements: check.judgements.clone(),
            met: check.met(),
            passes: check.meets_all(),
            unsound: check.unsound.iter().map(|note| (note.case.clone(), note.sentence.clone())).collect(),
            diagnoses: check.diagnoses.clone(),
            origins,
        })
    }
}

/// The studies of a report, and what is said of all of them.
#[derive(Clone, Debug)]
pub struct AllStudies {
    /// The studies.
    pub studies: Vec<StudyFindings>,
    /// The references of all records by name.
    pub references: Vec<UsedReference>,
    /// What made the first record.
    pub first_origin: Option<Provenance>,
    /// What made the records.
    pub origins: Origins,
    /// Records of all studies.
    pub records: usize,
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

impl AllStudies {
    /// What is found about some studies.
    ///
    /// # Errors
    /// When a reference refuses a case: that of the first study, on any number of threads.
    pub fn new(results: &[StudyResults<'_>]) -> Result<Self, ExactError> {
        let studies: Vec<Result<StudyFindings, ExactError>> =
            results.par_iter().map(StudyFindings::new).collect();
        let studies: Vec<StudyFindings> = studies.into_iter().collect::<Result<_, _>>()?;
        let mut origins = Origins::default();
        for study in &studies {
            origins.join(&study.origins);
        }
        let first = results.iter().flat_map(|one| one.records).next();
        Ok(Self {
            references: used_references(results),
            first_origin: first.map(|record| record.provenance.clone()),
            origins,
            records: results.iter().map(|one| one.records.len()).sum(),
            studies,
        })
    }
}

/// The references of all records by name.
fn used_references(results: &[StudyResults<'_>]) -> Vec<UsedReference> {
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
