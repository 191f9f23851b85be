//! What each operator of the ladder buys and costs, quantity by quantity, on equal cells.

use crate::race::finish::{NEGLIGIBLE, RaceQuantity};
use oedometer_soil::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ladder: each method has one operator more than the one before, which its word names.
pub const LADDER: [(&str, &str); 6] = [
    ("GIMP", ""),
    ("GIMP-SRI", "SRI"),
    ("GIMP-SRI-patch", "patch"),
    ("GC-SRI-patch", "CMPM"),
    ("GC-Bbar-patch", "B-bar"),
    ("TL-GC-Bbar-patch", "TL"),
];

/// A contender in a situation, as far as a trade needs it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Its family, whose situations weigh as much as those of another.
    pub family: &'a str,
    /// The situation.
    pub situation: &'a str,
    /// The contender.
    pub contender: &'a str,
    /// Errors of each quantity on the mesh that all share.
    pub errors: [Option<f64>; 3],
    /// Whether each quantity arrives, and all of them.
    pub arrives: [bool; 4],
    /// Cost of the run on that mesh, s.
    pub cost: Option<f64>,
}

/// What an operator does to one quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Effect {
    /// The quantity.
    pub quantity: RaceQuantity,
    /// Error with the operator over that without it: geometric mean over the families. Errors below 0.1 % are equal.
    pub error_ratio: Option<f64>,
    /// Situations that arrive with it and not without it.
    pub won: usize,
    /// Situations that arrive without it and not with it.
    pub lost: usize,
}

/// One step of the ladder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Trade {
    /// The operator.
    pub operator: String,
    /// The methods without and with it.
    pub methods: [String; 2],
    /// Situations in which both ran.
    pub situations: usize,
    /// Cost on equal cells with it over that without it: geometric mean over the families.
    pub cost_ratio: Option<f64>,
    /// Per quantity, and all together.
    pub effects: Vec<Effect>,
}

/// The steps of the ladder.
pub fn trades(samples: &[Sample<'_>]) -> Vec<Trade> {
    LADDER.windows(2).map(|pair| trade(samples, pair[0].0, pair[1])).collect()
}

fn trade(samples: &[Sample<'_>], without: &str, (with, operator): (&str, &str)) -> Trade {
    let of =
        |contender: &'_ str| samples.iter().filter(move |one| one.contender == contender).collect::<Vec<_>>();
    let (before, after) = (of(without), of(with));
    let partner = |one: &&Sample<'_>| before.iter().find(|other| other.situation == one.situation).copied();
    let pairs: Vec<(&Sample<'_>, &Sample<'_>)> =
        after.iter().filter_map(|one| Some((partner(one)?, *one))).collect();
    let effect = |(place, quantity): (usize, RaceQuantity)| {
        let error = |one: &Sample<'_>| quantity.error_in(&one.errors).map(|error| error.max(NEGLIGIBLE));
        let count = |wins: [bool; 2]| {
            pairs.iter().filter(|(a, b)| [a.arrives[place], b.arrives[place]] == wins).count()
        };
        Effect {
            quantity,
            error_ratio: mean_ratio(&pairs, &error),
            won: count([false, true]),
            lost: count([true, false]),
        }
    };
    Trade {
        operator: operator.to_owned(),
        methods: [without, with].map(str::to_owned),
        situations: pairs.len(),
        cost_ratio: mean_ratio(&pairs, &|one| one.cost),
        effects: RaceQuantity::EACH.into_iter().enumerate().map(effect).collect(),
    }
}

/// Geometric mean over the families of the geometric means over their situations.
fn mean_ratio(
    pairs: &[(&Sample<'_>, &Sample<'_>)],
    value: &dyn Fn(&Sample<'_>) -> Option<f64>,
) -> Option<f64> {
    let mut families: Vec<(&str, Vec<f64>)> = Vec::new();
    for (before, after) in pairs {
        let Some((before_value, after_value)) = value(before).zip(value(after)) else { continue };
        let ratio = elementary::ln(after_value / before_value);
        match families.iter_mut().find(|(family, _)| *family == after.family) {
            Some((_, ratios)) => ratios.push(ratio),
            None => families.push((after.family, vec![ratio])),
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let of_families: Vec<f64> = families.iter().map(|(_, ratios)| mean(ratios)).collect();
    (!of_families.is_empty()).then(|| elementary::exp(mean(&of_families)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_operator_s_effect_is_the_mean_over_families_and_what_it_wins_and_loses_is_counted() {
        let sample =
            |situation: &'static str, contender: &'static str, error: f64, arrives: bool, cost: f64| Sample {
                family: &situation[..1],
                situation,
                contender,
                // Of the second both are negligible.
                errors: [Some(error), Some(if contender == "GIMP" { 1e-9 } else { 1e-5 }), None],
                arrives: [arrives, true, false, arrives],
                cost: Some(cost),
            };
        let samples = [
            sample("p1", "GIMP", 0.4, false, 1.0),
            sample("p2", "GIMP", 0.4, false, 1.0),
            sample("q", "GIMP", 0.4, true, 1.0),
            sample("p1", "GIMP-SRI", 0.1, true, 4.0),
            sample("p2", "GIMP-SRI", 0.1, false, 4.0),
            sample("q", "GIMP-SRI", 0.4, false, 1.0),
            sample("r", "GIMP-SRI", 0.4, false, 1.0),
        ];
        let all = trades(&samples);
        let first = &all[0];
        assert_eq!((first.operator.as_str(), first.situations), ("SRI", 3));
        // Family p: a quarter; family q: as before. The root of a quarter is a half.
        let ratio = |value: Option<f64>| value.map(|value| (1e12 * value).round() * 1e-12);
        assert_eq!(ratio(first.effects[0].error_ratio), Some(0.5));
        assert_eq!((ratio(first.effects[1].error_ratio), first.effects[2].error_ratio), (Some(1.0), None));
        assert_eq!(ratio(first.cost_ratio), Some(2.0));
        let counts: Vec<(usize, usize)> = first.effects.iter().map(|one| (one.won, one.lost)).collect();
        assert_eq!(counts, [(1, 1), (0, 0), (0, 0), (1, 1)]);
        assert_eq!((all.len(), all[1].situations, all[1].cost_ratio), (5, 0, None));
    }
}
