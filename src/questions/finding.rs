//! A question of a reader, and what is found: facts, sentences, tables and figures, from which every view is written.

use crate::judge::study_results::StudyResults;
use crate::questions::sentence;
use crate::render::RenderError;
use crate::render::page::{Block, tables_in};
use crate::render::table::Table;
use oedometer_exact::ExactError;
use serde::ser::Error;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// Where an answer stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the terminal, below the verdict on a study.
    Terminal,
    /// On the page of a study.
    Study,
    /// In the report, which asks all studies together.
    Report,
}

/// A question of a reader: a plain function over studies, and the words of its answer.
#[derive(Debug)]
pub struct Question {
    /// Anchor of its section, and its name in `findings.json`.
    pub id: &'static str,
    /// Heading of its section.
    pub heading: &'static str,
    /// The sentence of its answer, filled with the facts.
    pub template: &'static str,
    /// Where it is answered.
    pub places: &'static [Place],
    /// Asks studies: those of a report together, a study alone for its own page and the terminal.
    pub ask: fn(&[StudyResults<'_>]) -> Result<Option<Finding>, ExactError>,
}

/// An answer as plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The question.
    pub question: &'static Question,
    /// Names of the studies that show it.
    pub studies: Vec<String>,
    /// Every number and name that its sentences may use.
    pub facts: Value,
    /// What stands below the sentence.
    pub parts: Vec<Block>,
}

impl PartialEq for Question {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Question {
    /// The answer, with what shows it.
    pub fn answer<'s>(
        &'static self,
        studies: impl IntoIterator<Item = &'s str>,
        facts: &impl Serialize,
    ) -> Finding {
        let facts = serde_json::to_value(facts).expect("facts are plain data");
        let studies = studies.into_iter().map(str::to_owned).collect();
        Finding { question: self, studies, facts, parts: Vec::new() }
    }

    /// Whether it is answered at a place.
    pub fn stands_at(&self, place: Place) -> bool {
        self.places.contains(&place)
    }
}

impl Finding {
    /// Adds a part.
    #[must_use]
    pub fn with(mut self, part: Block) -> Self {
        self.parts.push(part);
        self
    }

    /// The answer in words, lightly marked.
    ///
    /// # Errors
    /// If the template needs what is no fact.
    pub fn sentence(&self) -> Result<String, RenderError> {
        sentence::filled(self.question.template, &self.facts)
    }

    /// Its tables in order, those that the reader opens among them.
    pub fn tables(&self) -> Vec<&Table> {
        tables_in(&self.parts)
    }
}

/// The answer for programs, as `findings.json` has it.
impl Serialize for Finding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { question, studies, facts, .. } = self;
        let answer = self.sentence().map_err(S::Error::custom)?;
        let tables: Vec<Value> = self.tables().into_iter().map(Table::to_json).collect();
        let id = question.id;
        json!({ "question": id, "studies": studies, "answer": answer, "facts": facts, "tables": tables })
            .serialize(serializer)
    }
}

/// Version of the layout of `findings.json`; it rises when a key goes or changes its meaning.
const SCHEMA: u32 = 4;

/// What `findings.json` has beside a report, and beside the page of a study.
pub fn findings_json(findings: &[Finding]) -> Value {
    json!({ "schema": SCHEMA, "findings": findings })
}

/// The study that has most of what answers a question, the first of equals. A race answers elsewhere.
///
/// # Errors
/// The first of an answer.
pub fn best<'b, 'a, T, W: PartialOrd>(
    studies: &'b [StudyResults<'a>],
    worth: impl Fn(&'b StudyResults<'a>) -> Result<Option<(W, T)>, ExactError>,
) -> Result<Option<(&'b StudyResults<'a>, T)>, ExactError> {
    let mut most: Option<(W, (&StudyResults<'a>, T))> = None;
    for one in studies.iter().filter(|one| !one.study.is_race) {
        if let Some((worth, answer)) = worth(one)?
            && most.as_ref().is_none_or(|(known, _)| worth > *known)
        {
            most = Some((worth, (one, answer)));
        }
    }
    Ok(most.map(|(_, answer)| answer))
}
