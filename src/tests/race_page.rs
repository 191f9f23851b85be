//! The committed page of the race against its own tables: whoever has `race.csv` comes to the same sentences and profiles,
//! and no situation says what another says.

use crate::case::contender::CONTENDERS;
use crate::race::correlation::correlations;
use crate::race::finish::Question;
use crate::race::finish::RaceQuantity;
use crate::race::profile::{CostRow, CostTable, TIE};
use crate::race::sensitivity::{Change, THRESHOLD, variants};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

/// Two situations that correlate more say the same.
const ALIKE: f64 = 0.99;

/// A row of `tables/race.csv`, as far as sentences rest on it.
#[derive(Clone, Deserialize)]
struct Row {
    family: String,
    situation: String,
    contender: String,
    integrator: String,
    cost_half_percent: Option<f64>,
    cost_1_percent: Option<f64>,
    cost_2_percent: Option<f64>,
    cost_3_percent: Option<f64>,
    cost_pressure: Option<f64>,
    cost_stress: Option<f64>,
    cost_settlement: Option<f64>,
    error_pressure: Option<f64>,
    error_stress: Option<f64>,
    error_settlement: Option<f64>,
}

/// A row of `tables/profile.csv`.
#[derive(Deserialize)]
struct Step {
    answer: String,
    quantity: String,
    contender: String,
    tau: f64,
    share: f64,
}

impl Row {
    fn cost_to(&self, quantity: RaceQuantity, threshold: f64) -> Option<f64> {
        match quantity {
            RaceQuantity::Pressure => self.cost_pressure,
            RaceQuantity::Stress => self.cost_stress,
            RaceQuantity::Settlement => self.cost_settlement,
            RaceQuantity::All if threshold < THRESHOLD => self.cost_half_percent,
            RaceQuantity::All if threshold == THRESHOLD => self.cost_1_percent,
            RaceQuantity::All if threshold < 0.025 => self.cost_2_percent,
            RaceQuantity::All => self.cost_3_percent,
        }
    }

    fn largest_error(&self) -> Option<f64> {
        RaceQuantity::All.error_in(&[self.error_pressure, self.error_stress, self.error_settlement])
    }
}

fn text_of(file: &str) -> String {
    fs::read_to_string(format!("{}/report/{file}", env!("CARGO_MANIFEST_DIR"))).expect(file)
}

fn table_in<T: for<'a> Deserialize<'a>>(file: &str) -> Vec<T> {
    let text = text_of(file);
    csv::Reader::from_reader(text.as_bytes()).deserialize().collect::<Result<_, _>>().expect(file)
}

/// A share as the page writes it.
fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// The rows of each situation, in the order of the table.
fn situations(rows: &[Row]) -> Vec<&[Row]> {
    rows.chunk_by(|a, b| a.situation == b.situation).collect()
}

fn costs(rows: &[Row], quantity: RaceQuantity, threshold: f64) -> CostTable {
    let row = |entries: &&[Row]| CostRow {
        family: entries[0].family.clone(),
        situation: entries[0].situation.clone(),
        costs: entries.iter().map(|entry| entry.cost_to(quantity, threshold)).collect(),
    };
    CostTable {
        contenders: situations(rows)[0].iter().map(|entry| entry.contender.clone()).collect(),
        rows: situations(rows).iter().map(row).collect(),
    }
}

#[test]
fn the_committed_page_says_what_its_own_table_comes_to() {
    let (rows, page, matrix) = (table_in::<Row>("tables/race.csv"), text_of("README.md"), text_of("race.md"));
    for question in Question::BOTH {
        let table = |quantity: RaceQuantity, threshold: f64| {
            costs(&rows, quantity, threshold).only(|name| question.takes(name))
        };
        let best = table(RaceQuantity::All, THRESHOLD).best().expect("somebody arrives");
        let [reached, nearly] = [best.reached, best.within_two].map(percent);
        let mut integrators: BTreeMap<&str, usize> = BTreeMap::new();
        for one in situations(&rows) {
            *integrators.entry(&one[0].integrator).or_default() += 1;
        }
        let (integrator, count) = integrators.iter().max_by_key(|(_, count)| **count).expect("a situation");
        let method = &best.method;
        let sentence = match question {
            Question::Moving => [
                format!(
                    "take `{method}`:** it reaches 1 % of pressure, effective stress and settlement in {reached}"
                ),
                format!("in {nearly} at no more than twice the cost of the fastest method"),
                format!("({count} {integrator})"),
            ],
            Question::Total => [
                format!("take `{method}`:** it reaches 1 % in {reached}"),
                format!("in {nearly} at no more than twice the cost of the fastest of"),
                format!("{} situations (", situations(&rows).len()),
            ],
        };
        let missed = table(RaceQuantity::All, THRESHOLD).missed(method).len();
        let misses = match question {
            Question::Moving => format!("`{method}` misses 1 % in {missed}, "),
            Question::Total => format!(", `{method}` in {missed}."),
        };
        for part in sentence.into_iter().chain([misses]) {
            assert!(page.contains(&part), "{part}");
        }
        for variant in variants(table) {
            let (Some(choice), Change::Threshold(threshold)) = (variant.choice, variant.change) else {
                continue;
            };
            let line = matrix.lines().find(|line| line.starts_with(&format!("| At {} %", 100.0 * threshold)));
            let told = format!("{} ({})", choice.method, percent(choice.reached));
            assert!(line.is_some_and(|line| line.contains(&told)), "{told}: {line:?}");
        }
    }
}

#[test]
fn the_committed_profiles_are_those_of_the_committed_costs() {
    let (rows, steps) = (table_in::<Row>("tables/race.csv"), table_in::<Step>("tables/profile.csv"));
    let mut checked = 0;
    for question in Question::BOTH {
        for quantity in RaceQuantity::EACH {
            let table = costs(&rows, quantity, THRESHOLD).only(|name| question.takes(name));
            for profile in table.profiles() {
                let is_it = |step: &&Step| {
                    (step.answer.as_str(), step.quantity.as_str()) == (question.name(), quantity.name())
                        && step.contender == profile.contender
                };
                for step in steps.iter().filter(is_it) {
                    assert!((profile.share(step.tau) - step.share).abs() < 1e-12, "{}", step.contender);
                    checked += 1;
                }
            }
        }
    }
    assert!(checked == steps.len() && checked > 0, "{checked} of {}", steps.len());
}

#[test]
fn no_situation_of_the_committed_race_says_what_another_says() {
    let rows = table_in::<Row>("tables/race.csv");
    let all = situations(&rows);
    assert!((16..=26).contains(&all.len()), "{}", all.len());
    let names: BTreeSet<&str> = rows.iter().map(|row| row.contender.as_str()).collect();
    assert_eq!(names, CONTENDERS.iter().map(|one| one.name).collect());
    let errors = |one: &&[Row]| one.iter().map(Row::largest_error).collect();
    let named: Vec<(&str, Vec<Option<f64>>)> =
        all.iter().map(|one| (one[0].situation.as_str(), errors(one))).collect();
    let most = &correlations(&named)[0];
    assert!(most.value < ALIKE, "{most:?}");
}

#[test]
fn ties_are_as_wide_as_measured_seconds_scatter_about_the_calibration() {
    let text = include_str!("../record/calibration.csv");
    let column = |line: &str| line.split(',').nth(5).and_then(|field| field.parse::<f64>().ok());
    let mut scatters: Vec<f64> = text.lines().skip(1).map(|line| column(line).expect("a scatter")).collect();
    scatters.sort_by(f64::total_cmp);
    let median = scatters[scatters.len() / 2];
    assert!((TIE.ln() - median).abs() < 0.1, "{median}");
}
