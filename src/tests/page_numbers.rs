//! Every number in a table of a study's page stands in its `findings.json`, to the last bit.

use crate::campaign::runner::solved;
use crate::case::Tier;
use crate::judge::study_results::StudyResults;
use crate::render::page::Block;
use crate::render::table::{Cell, Table};
use crate::study_page;
use serde_json::Value;

/// All numbers of a JSON value, without their signs.
fn collect(value: &Value, numbers: &mut Vec<u64>) {
    match value {
        Value::Number(number) => numbers.extend(number.as_f64().map(|number| number.abs().to_bits())),
        Value::Array(all) => all.iter().for_each(|one| collect(one, numbers)),
        Value::Object(all) => all.values().for_each(|one| collect(one, numbers)),
        _ => {}
    }
}

fn numbers_of(cell: &Cell) -> Vec<f64> {
    match cell {
        Cell::Error(value)
        | Cell::Number(value)
        | Cell::Percent(value)
        | Cell::Seconds(value)
        | Cell::Order(value) => vec![*value],
        Cell::OrderWithin(order, half) => vec![*order, *half],
        Cell::Count(count) => vec![*count as f64],
        _ => Vec::new(),
    }
}

fn tables<'a>(blocks: &'a [Block], found: &mut Vec<&'a Table>) {
    for block in blocks {
        match block {
            Block::Table(table) => found.push(table),
            Block::Details { blocks, .. } => tables(blocks, found),
            Block::Switch(views) => views.iter().for_each(|(_, blocks)| tables(blocks, found)),
            _ => {}
        }
    }
}

/// Numbers of the tables, and those that the findings lack, each with its table.
fn lacking(text: &str, change: impl Fn(&mut Value)) -> (usize, Vec<String>) {
    let (study, records) = solved("s", text);
    let results = StudyResults::new(&study, &records, Tier::Full);
    let found = results.findings().expect("sound cases");
    let mut findings = serde_json::to_value(&found.plain).expect("plain data");
    change(&mut findings);
    let mut known = Vec::new();
    collect(&findings, &mut known);
    known.sort_unstable();
    let page = study_page(&found).expect("a page");
    let mut found = Vec::new();
    page.sections.iter().for_each(|section| tables(&section.blocks, &mut found));
    let numbers: Vec<(&Table, f64)> = found
        .iter()
        .flat_map(|table| table.rows.iter().flatten().flat_map(numbers_of).map(|number| (*table, number)))
        .collect();
    let lacks = |number: &f64| known.binary_search(&number.abs().to_bits()).is_err();
    let lacking = numbers.iter().filter(|(_, number)| number.is_finite() && lacks(number));
    (numbers.len(), lacking.map(|(table, number)| format!("{}: {number:e}", table.title)).collect())
}

const COLUMN: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
    method = ['GIMP-SRI', 'GC-SRI-patch']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n";

#[test]
fn every_number_of_a_table_stands_in_the_findings() {
    let step = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
        integrator = ['implicit']\ncells = [4]\ntime_step = [{ seconds = 0.2 }, { seconds = 0.1 }, { seconds = 0.05 }]\n";
    let layer = "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['GIMP-SRI', 'GIMP']\nintegrator = ['implicit']\ncells = [2, 4, 8]\n\
        time_step = [{ growth = 0.5 }]\n[[sweep]]\nmethod = ['GIMP']\nintegrator = ['implicit']\ncells = [8]\n\
        time_step = [{ growth = 0.5 }]\npoissons_ratio = [0.3, 0.4, 0.49]\n";
    let peak = "title = 't'\nscene = 'mandel'\noutput.time_factors = [0.0645, 0.07]\n[[sweep]]\n\
        method = ['GIMP-SRI']\nintegrator = ['implicit']\ncells = [20]\n[[expect_case]]\nstatus = 'ok'\n";
    for (text, least) in [(COLUMN, 60), (step, 15), (layer, 40), (peak, 10)] {
        let (count, lacking) = lacking(text, |_| ());
        assert!(lacking.is_empty(), "{} of {count}:\n{}", lacking.len(), lacking.join("\n"));
        assert!(count >= least, "{count} numbers");
    }
}

#[test]
fn a_number_that_the_findings_lack_is_named() {
    let (_, lacking) = lacking(COLUMN, |findings| findings["blocks"]["checks"] = Value::Null);
    assert!(lacking.iter().any(|one| one.starts_with("Start checks")), "{lacking:?}");
}
