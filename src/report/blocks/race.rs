//! The page of a situation of the race: errors of every contender against its cost, and all its measures; and the tables of
//! all situations for programs.

use crate::questions::blocks::race::RaceBlock;
use crate::questions::study_findings::StudyFindings;
use crate::race::RaceFindings;
use crate::race::finish::Question;
use crate::race::finish::RaceQuantity;
use crate::race::sensitivity::THRESHOLD;
use crate::race::situation::{Entry, OtherCosts, Situation};
use crate::render::RenderError;
use crate::render::chart::{Chart, ChartAxis, Naming, Rule, Series, Size, Style, slots};
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Table, columns};
use crate::report::blocks::figure_of;
use crate::report::templates;

/// Contenders that are named and coloured.
const NAMED: usize = 6;
/// Words of an entry that arrives.
const ARRIVES: &str = "arrives";

/// Answer, figures and table of a situation; empty for any other study.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let Some(RaceBlock { situation, is_plane, arrivals }) = &study.plain.blocks.race else {
        return Ok(Vec::new());
    };
    let last = if *is_plane { "displacement" } else { "settlement" };
    let quantities = [
        (RaceQuantity::All, "largest error"),
        (RaceQuantity::Pressure, "pressure"),
        (RaceQuantity::Stress, "effective stress"),
        (RaceQuantity::Settlement, last),
    ];
    let mut blocks = vec![Block::Heading("Every contender".to_owned())];
    if let Some(arrivals) = arrivals {
        blocks.push(Block::Paragraph(templates::sentence("race-situation", arrivals)?));
    }
    let views = quantities.into_iter().filter_map(|(quantity, words)| {
        let figure = figure(&study.name, &situation.entries, quantity, words)?;
        Some((words.to_owned(), vec![Block::Figure(figure)]))
    });
    let views: Vec<(String, Vec<Block>)> = views.collect();
    if !views.is_empty() {
        blocks.push(Block::Switch(views));
    }
    let note = templates::sentence("race-table", situation)?;
    blocks.push(Block::Table(table_of(situation).note(note)));
    Ok(blocks)
}

/// One error of all contenders against their cost.
fn figure(study: &str, ranked: &[Entry], quantity: RaceQuantity, words: &str) -> Option<Figure> {
    let points = |entry: &Entry| -> Vec<(f64, f64)> {
        let point =
            |level: &crate::race::finish::Level| Some((level.cost, quantity.error_in(&level.errors)?));
        entry.levels.iter().filter_map(point).collect()
    };
    let drawn: Vec<(&str, Vec<(f64, f64)>)> = ranked
        .iter()
        .map(|entry| (entry.contender.as_str(), points(entry)))
        .filter(|(_, points)| points.len() > 1)
        .collect();
    let title = if quantity == RaceQuantity::All {
        "The largest error".to_owned()
    } else {
        format!("Error of the {words}")
    };
    let mut chart = Chart::new(
        format!("{title} against the cost"),
        ChartAxis::log10("counted work (s)"),
        ChartAxis::log10("relative error (–)"),
    );
    chart.size = Size { width: 860.0, plot_height: 380.0, equal_units: false };
    chart.naming = Naming::Ends;
    let is_drawn = !drawn.is_empty();
    let named = &drawn[..drawn.len().min(NAMED)];
    let slots = slots(&named.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    let named: Vec<Series> = named
        .iter()
        .zip(slots)
        .map(|((name, points), slot)| Series::new(*name, points.clone()).slot(slot))
        .collect();
    let others = drawn.into_iter().skip(NAMED);
    chart.series.extend(others.map(|(name, points)| Series::new(name, points).style(Style::Context)));
    chart.series.extend(named);
    chart.rules.push(Rule { at: THRESHOLD, label: "1 %".to_owned() });
    let caption = "In colour: the first six of the table; grey: the others. Each marker is a mesh, twice as fine as the one before. \
                   Counted work is in seconds of the calibration.";
    is_drawn.then(|| figure_of(study, &format!("race-{}", quantity.name()), chart, caption))
}

/// Every contender with its measures, the best first.
fn table_of(situation: &Situation) -> Table {
    let number = |value: Option<f64>, kind: fn(f64) -> Cell| Cell::of(value, kind, "");
    let rows = situation.entries.iter().map(|entry| {
        let reason = entry.reason.as_ref().map_or(ARRIVES, |reason| reason.words());
        let reason =
            if entry.detail.is_empty() { reason.to_owned() } else { format!("{reason}: {}", entry.detail) };
        let mut cells: Vec<Cell> = vec![Cell::Code(entry.contender.clone())];
        cells.extend(entry.costs.map(|cost| number(cost, Cell::Seconds)));
        cells.push(number(entry.seconds, Cell::Seconds));
        cells.extend(entry.errors.map(|error| number(error, Cell::Error)));
        cells.push(number(entry.order, Cell::Order));
        cells.push(number(entry.scatter, Cell::Percent));
        cells.extend(
            [entry.oscillation, entry.locking, entry.step_ratio].map(|value| number(value, Cell::Number)),
        );
        cells.push(reason.into());
        cells
    });
    let heads = "contender | > 10 % | > 1 % | > 0.1 % | > 1 % measured | > pressure | > effective stress | \
                 > settlement or displacement | > order | > half the step | > oscillation | > locking | > critical step | arrives";
    Table::of("Cost to an error, and what each is on equal cells", columns(heads), rows)
}

/// The columns of the race's table, for everybody who reads it by name.
const HEADER: &str = "family|situation|contender|moves|cost_10_percent|cost_1_percent|cost_tenth_percent|reason|cells|\
                      error_pressure|error_stress|error_settlement|order|class|scatter|oscillation|locking|seconds_1_percent|\
                      cost_pressure|cost_stress|cost_settlement|integrator|cost_half_percent|cost_2_percent|cost_3_percent|\
                      cost_equal_cells";

/// Every contender in every situation, with what it costs to other ends.
pub fn whole_table(findings: &RaceFindings, costs: &[Vec<OtherCosts>]) -> Table {
    let rows = findings.situations.iter().zip(costs).flat_map(|(situation, costs)| {
        situation.entries.iter().zip(costs).map(move |(entry, costs)| row(situation, entry, costs))
    });
    Table::of("", columns(HEADER), rows)
}

fn row(situation: &Situation, entry: &Entry, other: &OtherCosts) -> Vec<Cell> {
    let number = |value: Option<f64>| Cell::of(value, Cell::Number, "");
    let reason = entry.reason.as_ref().map_or(ARRIVES, |reason| reason.words());
    let mut row: Vec<Cell> = vec![
        situation.family.as_str().into(),
        situation.name.as_str().into(),
        entry.contender.as_str().into(),
        if situation.moves { "true" } else { "false" }.into(),
    ];
    row.extend(entry.costs.map(number));
    row.push(reason.into());
    row.push(Cell::Count(situation.common_cells as u64));
    row.extend(entry.errors.map(number));
    row.push(number(entry.order));
    row.push(entry.class.as_deref().unwrap_or_default().into());
    row.extend([entry.scatter, entry.oscillation, entry.locking, entry.seconds].map(number));
    row.extend(other.alone.map(number));
    row.push(situation.integrator.as_str().into());
    row.extend(other.thresholds.map(number));
    row.push(number(entry.cost));
    row
}

/// The performance profiles: for each question, quantity and contender the share at each multiple of the best cost.
pub fn profile_table(findings: &RaceFindings) -> Table {
    let rows = Question::BOTH.into_iter().flat_map(|question| {
        RaceQuantity::EACH.into_iter().flat_map(move |quantity| {
            findings.profiles(question, quantity).iter().flat_map(move |profile| {
                profile.steps.iter().map(move |(tau, share)| {
                    vec![
                        question.name().into(),
                        quantity.name().into(),
                        profile.contender.as_str().into(),
                        Cell::Number(*tau),
                        Cell::Number(*share),
                    ]
                })
            })
        })
    });
    Table::of("", columns("answer|quantity|contender|tau|share"), rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::contender::CONTENDERS;

    const SMALL: &str = "title = 'Race: small'\nscene = 'mandel'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [10, 20, 40]\ntime_step = [{ growth = 0.2 }]\n";

    #[test]
    fn the_tables_have_the_columns_of_the_contract_and_a_row_for_every_contender() {
        let (study, records) = solved("race-layer-small", SMALL);
        let findings = RaceFindings::from_studies([(&study, records.as_slice())]).expect("a race");
        let csv = whole_table(&findings, &findings.other_costs()).to_plain_csv().expect("a table");
        let lines: Vec<&str> = csv.lines().collect();
        assert!(
            lines[0].starts_with(
                "family,situation,contender,moves,cost_10_percent,cost_1_percent,cost_tenth_percent,reason,cells,\
                 error_pressure,error_stress,error_settlement,order,class,scatter,oscillation,locking"
            ),
            "{}",
            lines[0]
        );
        assert_eq!(lines.len(), 1 + CONTENDERS.len());
        let of = |method: &str| {
            let start = format!("layer,layer-small,{method},false,");
            *lines.iter().find(|line| line.starts_with(&start)).expect("a row")
        };
        assert!(of("B2-Bbar-patch").contains(",,,,by definition,"), "{}", of("B2-Bbar-patch"));
        let profile = profile_table(&findings).to_plain_csv().expect("a table");
        assert!(
            profile.starts_with("answer,quantity,contender,tau,share\nmoving,pressure,MPM,1.0,"),
            "{profile}"
        );
        for tau in ["1.0", "1.3", "2.0", "5.0", "10.0", "100.0"] {
            assert!(profile.contains(&format!("total,all,TL-GC-SRI-patch,{tau},")), "{tau}");
        }
    }
}
