//! The race to one per cent: every method refines its mesh in every situation until it reaches the tolerance. What the records come
//! to, as numbers and names; pages make sentences of it.

pub mod answer;
pub mod finish;
pub mod group;
pub mod profile;
pub mod situation;

use crate::case::contender::CONTENDERS;
use crate::race::answer::{Answer, answers};
use crate::race::finish::{RaceQuantity, Terms};
use crate::race::group::{Group, cost_table, races};
use crate::race::profile::Profile;
use crate::race::situation::Situation;
use crate::record::Record;
use crate::record::race_errors::ReadOut;
use crate::study::check::Study;
use serde::{Deserialize, Serialize};

/// The profile of each method of a group for one read-out and quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupProfiles {
    /// The group.
    pub group: Group,
    /// The read-out.
    #[serde(rename = "readout")]
    pub read_out: ReadOut,
    /// The quantity.
    pub quantity: RaceQuantity,
    /// One per method.
    pub profiles: Vec<Profile>,
}

/// What an operator does to the number of situations that reach the tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Operator {
    /// Its word.
    #[expect(clippy::struct_field_names, reason = "a key of findings.json")]
    pub operator: String,
    /// The methods without and with it.
    pub methods: [String; 2],
    /// Per group and read-out the situations that reach the tolerance without and with it; none where no method of the pair is of
    /// the group.
    pub arrivals: Vec<Option<[usize; 2]>>,
}

/// The ladder: each method has one operator more than the one before, which its word names.
const LADDER: [(&str, &str); 5] = [
    ("GIMP", ""),
    ("GIMP-SRI", "SRI"),
    ("GIMP-SRI-patch", "patch"),
    ("GC-SRI-patch", "CMPM"),
    ("GC-Bbar-patch", "B-bar"),
];

/// What the race has found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RaceFindings {
    /// The answers: of each group and read-out the best method, and those that tie with it.
    pub answers: Vec<Answer>,
    /// Performance profiles to 1 %.
    pub profiles: Vec<GroupProfiles>,
    /// What each operator changes.
    pub operators: Vec<Operator>,
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
        let profiles_of = |(group, read_out): (Group, ReadOut)| {
            RaceQuantity::EACH.map(|quantity| {
                let table = cost_table(&situations, group, &Terms { quantity, ..Terms::usual(read_out) });
                GroupProfiles { group, read_out, quantity, profiles: table.profiles() }
            })
        };
        Self {
            answers: races().flat_map(|(group, read_out)| answers(&situations, group, read_out)).collect(),
            profiles: races().flat_map(profiles_of).collect(),
            operators: LADDER.windows(2).map(|pair| operator(&situations, pair[0].0, pair[1])).collect(),
            situations,
            properties: Vec::new(),
        }
    }

    /// The profiles for a group, a read-out and a quantity.
    pub fn profiles(&self, group: Group, read_out: ReadOut, quantity: RaceQuantity) -> &[Profile] {
        let is_it =
            |one: &&GroupProfiles| (one.group, one.read_out, one.quantity) == (group, read_out, quantity);
        self.profiles.iter().find(is_it).map_or(&[], |one| &one.profiles)
    }

    /// The best method of a group and read-out, where one reaches the tolerance.
    pub fn best(&self, group: Group, read_out: ReadOut) -> Option<&Answer> {
        self.answers.iter().find(|answer| (answer.group, answer.read_out) == (group, read_out))
    }
}

fn operator(situations: &[Situation], without: &str, (with, operator): (&str, &str)) -> Operator {
    let arrivals = |(group, read_out): (Group, ReadOut)| {
        // Total Lagrangian methods are those of the ladder with weights that stay.
        let names = [without, with]
            .map(|name| if group == Group::Total { format!("TL-{name}") } else { name.to_owned() });
        let is_known = |name: &String| CONTENDERS.iter().any(|one| one.name == name);
        let table = cost_table(situations, group, &Terms::usual(read_out));
        let count = |name: &String| {
            let place = table.methods.iter().position(|method| method == name)?;
            Some(table.rows.iter().filter(|row| row.costs[place].is_some()).count())
        };
        names.iter().all(is_known).then(|| Some([count(&names[0])?, count(&names[1])?]))?
    };
    Operator {
        operator: operator.to_owned(),
        methods: [without, with].map(str::to_owned),
        arrivals: races().map(arrivals).collect(),
    }
}

#[cfg(test)]
mod tests;
