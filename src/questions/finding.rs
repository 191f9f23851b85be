//! A question of a reader, and what is found: facts, sentences, tables and figures, from which every view is written.

use crate::questions::sentence;
use crate::questions::study_results::StudyResults;
use crate::render::RenderError;
use crate::render::page::Figure;
use crate::render::table::Table;
use oedometer_exact::ExactError;
use schemars::{Schema, SchemaGenerator};
use serde::de::IgnoredAny;
use serde::ser::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
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
    /// What the facts of its answer are.
    pub facts: fn(&mut SchemaGenerator) -> Schema,
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
    pub parts: Vec<Part>,
}

/// A part of an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// A further template, filled with the same facts.
    Sentence(&'static str),
    /// A table.
    Table(Table),
    /// Figures side by side; none on the terminal.
    Figures(Vec<Figure>),
    /// Parts of which one is shown at a time, each with the word that shows it; the first on the terminal.
    Views(Vec<(String, Vec<Part>)>),
    /// Parts that the reader opens; none on the terminal.
    Details(String, Vec<Part>),
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
    pub fn with(mut self, part: Part) -> Self {
        self.parts.push(part);
        self
    }

    /// The answer in words, lightly marked.
    ///
    /// # Errors
    /// If the template needs what is no fact.
    pub fn sentence(&self) -> Result<String, RenderError> {
        self.words(self.question.template)
    }

    /// A template filled with the facts.
    ///
    /// # Errors
    /// If the template needs what is no fact.
    pub fn words(&self, template: &str) -> Result<String, RenderError> {
        sentence::filled(template, &self.facts)
    }

    /// Its tables in order, those inside other parts among them.
    pub fn tables(&self) -> Vec<&Table> {
        let mut tables = Vec::new();
        each(&self.parts, &mut |part| {
            if let Part::Table(table) = part {
                tables.push(table);
            }
        });
        tables
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

/// No finding is read again: whoever has the records asks the question.
///
/// # Errors
/// If the text is no JSON.
pub fn unread<'d, D: Deserializer<'d>>(from: D) -> Result<Vec<Finding>, D::Error> {
    IgnoredAny::deserialize(from).map(|_| Vec::new())
}

fn each<'p>(parts: &'p [Part], look: &mut impl FnMut(&'p Part)) {
    for part in parts {
        look(part);
        match part {
            Part::Views(views) => views.iter().for_each(|(_, parts)| each(parts, look)),
            Part::Details(_, parts) => each(parts, look),
            _ => {}
        }
    }
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
