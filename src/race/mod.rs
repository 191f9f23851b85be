//! The race to one per cent: every contender refines its mesh in every situation until it arrives. What the records come
//! to, as numbers and names; pages make sentences of it.

pub mod correlation;
pub mod family;
pub mod finish;
pub mod profile;
pub mod sensitivity;
pub mod situation;
pub mod trade;

use crate::case::grouping::grouped;
use crate::race::correlation::{Correlation, correlations};
use crate::race::family::{FamilyCurve, family_curves};
use crate::race::finish::{Question, RaceQuantity, Reason};
use crate::race::profile::{Choice, CostRow, CostTable, Profile};
use crate::race::sensitivity::{THRESHOLD, Variant, variants};
use crate::race::situation::{Entry, OtherCosts, Situation};
use crate::race::trade::{Sample, Trade, trades};
use crate::record::Record;
use crate::study::check::Study;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Pairs of situations that are told as the most alike.
const MOST_PAIRS: usize = 10;

/// What no situation of the race tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Untested {
    /// Contact of bodies.
    Contact,
    /// Soil that parts.
    Separation,
    /// Soil that flows.
    Flow,
}

/// Where the method of an answer does not arrive, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Missed {
    /// The situation.
    pub situation: String,
    /// The reason.
    pub reason: Reason,
}

/// The choice in one family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FamilyChoice {
    /// The family.
    pub family: String,
    /// The choice; none where nobody arrives.
    pub choice: Option<Choice>,
}

/// The answer to a question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// The question.
    pub question: Question,
    /// The method to take.
    pub method: String,
    /// The integrator of most situations, by its name.
    pub integrator: String,
    /// Every integrator with the number of its situations.
    pub integrators: BTreeMap<String, usize>,
    /// Share of situations in which the method reaches 1 %, families weighing the same.
    pub reached: f64,
    /// Share in which it does within twice the best cost.
    pub within_two: f64,
    /// Situations that the answer rests on.
    pub situations: usize,
    /// Those of them in which the soil moves.
    pub moving: usize,
    /// Families of situations.
    pub families: usize,
    /// Contenders that were compared.
    pub contenders: usize,
    /// Where the method does not arrive.
    pub missed: Vec<Missed>,
    /// All contenders by their score, the best first.
    pub ranked: Vec<Choice>,
    /// The choice in each family.
    pub by_family: Vec<FamilyChoice>,
    /// What holds and what turns when the race is changed.
    pub variants: Vec<Variant>,
    /// What no situation tests.
    pub untested: [Untested; 3],
}

/// The profile of each contender for one question and quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuestionProfiles {
    /// The question.
    pub answer: Question,
    /// The quantity.
    pub quantity: RaceQuantity,
    /// One per contender.
    pub profiles: Vec<Profile>,
}

/// What the race has found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RaceFindings {
    /// The answers.
    pub answers: Vec<Answer>,
    /// Performance profiles to 1 %.
    pub profiles: Vec<QuestionProfiles>,
    /// Error over work in each family, a curve per contender.
    pub families: Vec<FamilyCurve>,
    /// What each operator buys and costs.
    pub trades: Vec<Trade>,
    /// The pairs of situations that are most alike.
    pub correlations: Vec<Correlation>,
    /// Every situation with every contender.
    pub situations: Vec<Situation>,
    /// What is no error: critical step, rest and power.
    pub properties: Vec<Situation>,
}

impl RaceFindings {
    /// What the situations of some studies come to; `None` where no study is of the race.
    pub fn from_studies<'a>(studies: impl IntoIterator<Item = (&'a Study, &'a [Record])>) -> Option<Self> {
        let all = studies.into_iter().filter_map(|(study, records)| Situation::from_records(study, records));
        let (mut properties, situations): (Vec<Situation>, Vec<Situation>) =
            all.partition(|one| one.is_property);
        properties.sort_by(|a, b| a.name.cmp(&b.name));
        let is_empty = properties.is_empty() && situations.is_empty();
        (!is_empty).then(|| Self { properties, ..Self::from_situations(situations) })
    }

    /// What situations come to, in the order of their names: sentences do not depend on the order of studies.
    pub fn from_situations(mut situations: Vec<Situation>) -> Self {
        situations.sort_by(|a, b| a.name.cmp(&b.name));
        let profiles_of = |answer: Question, quantity: RaceQuantity| {
            let table = cost_table(&situations, quantity, THRESHOLD).only(|name| answer.takes(name));
            QuestionProfiles { answer, quantity, profiles: table.profiles() }
        };
        let profiles = Question::BOTH
            .into_iter()
            .flat_map(|answer| RaceQuantity::EACH.map(|quantity| profiles_of(answer, quantity)))
            .collect();
        let errors: Vec<(&str, Vec<Option<f64>>)> = situations
            .iter()
            .map(|one| (one.name.as_str(), one.entries.iter().map(Entry::largest_error).collect()))
            .collect();
        let mut correlations = correlations(&errors);
        correlations.truncate(MOST_PAIRS);
        Self {
            answers: Question::BOTH
                .into_iter()
                .filter_map(|question| answer(question, &situations))
                .collect(),
            profiles,
            families: by_family(&situations)
                .into_iter()
                .flat_map(|(family, situations)| family_curves(family, &situations))
                .collect(),
            trades: trades(&samples(&situations)),
            correlations,
            situations,
            properties: Vec::new(),
        }
    }

    /// What each contender costs to other ends, in the order of situations and entries.
    pub fn other_costs(&self) -> Vec<Vec<OtherCosts>> {
        self.situations.iter().map(|one| one.entries.iter().map(OtherCosts::new).collect()).collect()
    }

    /// The answer to a question, where somebody arrives.
    pub fn answer(&self, question: Question) -> Option<&Answer> {
        self.answers.iter().find(|answer| answer.question == question)
    }

    /// The profiles for a question and a quantity.
    pub fn profiles(&self, question: Question, quantity: RaceQuantity) -> &[Profile] {
        let is_it = |one: &&QuestionProfiles| (one.answer, one.quantity) == (question, quantity);
        self.profiles.iter().find(is_it).map_or(&[], |one| &one.profiles)
    }

    /// The families of its situations, each once, with their situations.
    pub fn families(&self) -> Vec<(&str, Vec<&Situation>)> {
        by_family(&self.situations)
    }

    /// The curves of a family.
    pub fn curves<'a>(&'a self, family: &'a str) -> impl Iterator<Item = &'a FamilyCurve> {
        self.families.iter().filter(move |curve| curve.family == family)
    }
}

/// Situations by their families, both in the order of their first appearance.
fn by_family(situations: &[Situation]) -> Vec<(&str, Vec<&Situation>)> {
    grouped(situations, |situation| situation.family.as_str())
}

/// Costs of all contenders to a threshold of a quantity.
pub fn cost_table(situations: &[Situation], quantity: RaceQuantity, threshold: f64) -> CostTable {
    let row = |situation: &Situation| CostRow {
        family: situation.family.clone(),
        situation: situation.name.clone(),
        costs: situation.entries.iter().map(|entry| entry.cost_to(quantity, threshold)).collect(),
    };
    let names = situations.first().map_or(&[][..], |one| &one.entries);
    CostTable {
        contenders: names.iter().map(|entry| entry.contender.clone()).collect(),
        rows: situations.iter().map(row).collect(),
    }
}

fn answer(question: Question, situations: &[Situation]) -> Option<Answer> {
    let table = |quantity: RaceQuantity, threshold: f64| {
        cost_table(situations, quantity, threshold).only(|name| question.takes(name))
    };
    let whole = table(RaceQuantity::All, THRESHOLD);
    let best = whole.best()?;
    let mut integrators: BTreeMap<String, usize> = BTreeMap::new();
    for situation in situations {
        *integrators.entry(situation.integrator.clone()).or_default() += 1;
    }
    let missed = whole.missed(&best.method);
    let reason = |situation: &Situation| {
        let entry = situation.entries.iter().find(|entry| entry.contender == best.method)?;
        let reason = entry.reason.clone()?;
        missed
            .contains(&situation.name.as_str())
            .then(|| Missed { situation: situation.name.clone(), reason })
    };
    let of_family = |family: &str| FamilyChoice {
        family: family.to_owned(),
        choice: whole.of_families(|other| other == family).best(),
    };
    Some(Answer {
        question,
        integrator: integrators.iter().max_by_key(|(_, count)| **count).map(|(name, _)| name.clone())?,
        integrators,
        reached: best.reached,
        within_two: best.within_two,
        situations: situations.len(),
        moving: situations.iter().filter(|one| one.moves).count(),
        families: whole.families().len(),
        contenders: whole.contenders.len(),
        missed: situations.iter().filter_map(reason).collect(),
        ranked: whole.ranked(),
        by_family: whole.families().into_iter().map(of_family).collect(),
        variants: variants(table),
        untested: [Untested::Contact, Untested::Separation, Untested::Flow],
        method: best.method,
    })
}

fn samples(situations: &[Situation]) -> Vec<Sample<'_>> {
    situations
        .iter()
        .flat_map(|situation| {
            situation.entries.iter().filter(|entry| !entry.levels.is_empty()).map(move |entry| Sample {
                family: &situation.family,
                situation: &situation.name,
                contender: &entry.contender,
                errors: entry.errors,
                arrives: RaceQuantity::EACH.map(|quantity| entry.cost_to(quantity, THRESHOLD).is_some()),
                cost: entry.cost,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests;
