//! The race to one per cent: every method refines its mesh in every situation until it reaches the tolerance. What the records come
//! to, as numbers and names; pages make sentences of it.

pub mod answer;
pub mod finish;
pub mod group;
pub mod profile;
pub mod situation;

use crate::race::answer::{Answer, answers};
use crate::race::finish::{RaceQuantity, Terms};
use crate::race::group::{Group, cost_table, races};
use crate::race::profile::Profile;
use crate::race::situation::Situation;
use crate::record::Record;
use crate::record::race_errors::ReadOut;
use crate::study::check::Study;

/// The ladder: each method has one operator more than the one before, which its word names.
pub const LADDER: [(&str, &str); 5] = [
    ("GIMP", ""),
    ("GIMP-SRI", "SRI"),
    ("GIMP-SRI-patch", "patch"),
    ("GC-SRI-patch", "CMPM"),
    ("GC-Bbar-patch", "B-bar"),
];

/// What the race has found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RaceFindings {
    /// The answers: of each group and read-out the best method, and those that tie with it.
    pub answers: Vec<Answer>,
    /// Every situation with every method.
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
        Self {
            answers: races().flat_map(|(group, read_out)| answers(&situations, group, read_out)).collect(),
            situations,
            properties: Vec::new(),
        }
    }

    /// The performance profiles of a group to 1 %, by a read-out and of a quantity: one per method.
    pub fn profiles(&self, group: Group, read_out: ReadOut, quantity: RaceQuantity) -> Vec<Profile> {
        cost_table(&self.situations, group, &Terms { quantity, ..Terms::usual(read_out) }).profiles()
    }

    /// The situations in which a method of the ladder reaches the tolerance; `None` where it is not of the group. Total Lagrangian
    /// methods are those of the ladder with weights that stay.
    pub fn reached(&self, method: &str, group: Group, read_out: ReadOut) -> Option<usize> {
        let name = if group == Group::Total { format!("TL-{method}") } else { method.to_owned() };
        let table = cost_table(&self.situations, group, &Terms::usual(read_out));
        let place = table.methods.iter().position(|method| *method == name)?;
        Some(table.rows.iter().filter(|row| row.costs[place].is_some()).count())
    }

    /// The best method of a group and read-out, where one reaches the tolerance.
    pub fn best(&self, group: Group, read_out: ReadOut) -> Option<&Answer> {
        self.answers.iter().find(|answer| (answer.group, answer.read_out) == (group, read_out))
    }
}

#[cfg(test)]
mod tests;
