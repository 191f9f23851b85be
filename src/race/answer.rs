//! The answer of a group: the method to take, by where fields are read, and whether it holds wherever else one looks.

use crate::race::finish::{Budget, OTHER_TOLERANCES, Terms};
use crate::race::group::{Group, cost_table};
use crate::race::profile::Shares;
use crate::race::situation::Situation;
use crate::record::race_errors::ReadOut;
use serde::{Deserialize, Serialize};

/// Whether a method is still the best, or ties with it, on other terms.
#[expect(clippy::struct_excessive_bools, reason = "each is a kind of terms")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holds {
    /// At each single output.
    pub time: bool,
    /// For half and for twice the budget.
    pub budget: bool,
    /// At 0.5, 2 and 5 %.
    pub tolerance: bool,
    /// Read the other way.
    #[serde(rename = "readout")]
    pub read_out: bool,
}

impl Holds {
    /// Whether it holds wherever one looks.
    pub fn everywhere(self) -> bool {
        self.time && self.budget && self.tolerance && self.read_out
    }
}

/// A method to take in a group for a read-out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The group.
    pub group: Group,
    /// Where fields are read.
    #[serde(rename = "readout")]
    pub read_out: ReadOut,
    /// The method.
    pub method: String,
    /// Situations in which it reaches 1 %.
    pub reached: usize,
    /// Situations of the group.
    pub of: usize,
    /// Their share, families weighing the same.
    pub share: f64,
    /// Share in which it does within twice the least cost of the group.
    pub within_two: f64,
    /// Nine tenths of resampled shares of situations reached lie in it.
    pub interval: [f64; 2],
    /// Its largest work over the least of any group, where it reaches 1 %.
    pub dearest: f64,
    /// Other terms.
    pub holds: Holds,
    /// Methods that these situations do not tell from it: the intervals of both shares overlap.
    pub alike: Vec<String>,
}

/// The answers of a group and read-out, the best first; none where no method reaches the tolerance.
pub fn answers(situations: &[Situation], group: Group, read_out: ReadOut) -> Vec<Answer> {
    let usual = Terms::usual(read_out);
    let best = |terms: &Terms| -> Vec<String> {
        cost_table(situations, group, terms).best().into_iter().map(str::to_owned).collect()
    };
    let variants = |terms: Vec<Terms>| -> Vec<Vec<String>> { terms.iter().map(best).collect() };
    let outputs = situations.iter().map(|one| one.outputs.len()).min().unwrap_or(0);
    let times = variants((0..outputs).map(|output| Terms { output: Some(output), ..usual }).collect());
    let budgets = variants([Budget::Half, Budget::Twice].map(|budget| Terms { budget, ..usual }).to_vec());
    let tolerances = variants(OTHER_TOLERANCES.map(|tolerance| Terms { tolerance, ..usual }).to_vec());
    let other = ReadOut::BOTH.into_iter().filter(|other| *other != read_out);
    let read_outs = variants(other.map(Terms::usual).collect());
    let table = cost_table(situations, group, &usual);
    let (ranked, best_of_all) = (table.ranked(), table.best());
    let answer = |shares: Shares| {
        let holds = |variants: &[Vec<String>]| variants.iter().all(|best| best.contains(&shares.method));
        Answer {
            group,
            read_out,
            reached: shares.count,
            of: table.rows.len(),
            share: shares.reached,
            within_two: shares.within_two,
            interval: shares.intervals[0],
            dearest: dearest(situations, group, &shares.method, &usual),
            holds: Holds {
                time: holds(&times),
                budget: holds(&budgets),
                tolerance: holds(&tolerances),
                read_out: holds(&read_outs),
            },
            alike: ranked
                .iter()
                .filter(|other| other.method != shares.method && other.is_like(&shares))
                .map(|other| other.method.clone())
                .collect(),
            method: shares.method,
        }
    };
    let of_best = ranked.iter().filter(|one| best_of_all.contains(&one.method.as_str()));
    of_best.cloned().map(answer).collect()
}

/// The largest work of a method over the least of any group.
fn dearest(situations: &[Situation], group: Group, method: &str, terms: &Terms) -> f64 {
    let of_group = situations.iter().filter(|one| group.has(one));
    of_group.filter_map(|one| one.ratio(one.entry(method)?, terms)).fold(1.0, f64::max)
}
