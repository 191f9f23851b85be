//! The groups of situations and methods that are compared with each other, and their costs.

use crate::case::contender::CONTENDERS;
use crate::race::finish::Terms;
use crate::race::profile::{CostRow, CostTable};
use crate::race::situation::Situation;
use crate::record::race_errors::ReadOut;
use serde::{Deserialize, Serialize};

/// The methods of some situations that are compared with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// Points move through the mesh.
    Moving,
    /// Points stay where they are, to first order: every mesh follows them.
    Rest,
    /// The mesh follows the soil, in the situations in which it moves.
    Total,
}

impl Group {
    /// Each.
    pub const EACH: [Self; 3] = [Self::Moving, Self::Rest, Self::Total];

    /// Its word in tables.
    pub fn name(self) -> &'static str {
        ["moving", "rest", "total"][self as usize]
    }

    /// Whether a situation is of the group.
    pub fn has(self, situation: &Situation) -> bool {
        situation.moves == (self != Self::Rest)
    }

    /// Whether a method is of the group.
    pub fn takes(self, method: &str) -> bool {
        let is_total = CONTENDERS.iter().any(|one| one.name == method && one.is_total());
        is_total == (self == Self::Total)
    }
}

/// A group with where its fields are read.
pub fn races() -> impl Iterator<Item = (Group, ReadOut)> {
    Group::EACH.into_iter().flat_map(|group| ReadOut::BOTH.map(|read_out| (group, read_out)))
}

/// Costs of all methods of a group in all of its situations.
pub fn cost_table(situations: &[Situation], group: Group, terms: &Terms) -> CostTable {
    let methods: Vec<&str> =
        CONTENDERS.iter().map(|one| one.name).filter(|method| group.takes(method)).collect();
    let row = |situation: &Situation| CostRow {
        family: situation.family.clone(),
        costs: methods
            .iter()
            .map(|method| Some(situation.arrival(situation.entry(method)?, terms)?.cost))
            .collect(),
    };
    CostTable {
        rows: situations.iter().filter(|one| group.has(one)).map(row).collect(),
        methods: methods.into_iter().map(str::to_owned).collect(),
    }
}
