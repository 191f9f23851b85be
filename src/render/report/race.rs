//! The page of a situation of the race: the errors of every contender against the mesh, and all its measures; and the
//! table of all of them for programs.

use crate::judge::race::{Ended, RaceCell, RaceRow};
use crate::render::chart::{Chart, ChartAxis, Series, Size};
use crate::render::page::{Block, Figure};
use crate::render::report::StudyResults;
use crate::render::report::labels::ticks;
use crate::render::table::{Cell, Table, columns};

/// Figures and the table of a situation; empty for any other study.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let Some(row) = RaceRow::of(results.study, results.records) else { return Vec::new() };
    let ranked = ranked(&row.contenders);
    let last = if results.study.scene.has_plane_fields() { "displacement" } else { "settlement" };
    let figures = ["pressure", "effective stress", last].into_iter().enumerate();
    let figures: Vec<Figure> =
        figures.filter_map(|(place, quantity)| figure(results, &ranked, place, quantity)).collect();
    let mut blocks = vec![Block::Heading("Every contender".to_owned())];
    blocks.extend(figures.into_iter().map(Block::Figure));
    blocks.push(Block::Table(table_of(&row, &ranked)));
    blocks
}

/// The best first, then those without a result, then those that cannot have one.
fn ranked(contenders: &[RaceCell]) -> Vec<&RaceCell> {
    let score = |cell: &RaceCell| match cell.ended {
        Ended::Well => cell.score.unwrap_or(f64::INFINITY),
        Ended::Failed(..) => f64::INFINITY,
        Ended::NotApplicable(_) => f64::NAN,
    };
    let mut ranked: Vec<&RaceCell> = contenders.iter().collect();
    ranked.sort_by(|a, b| score(a).total_cmp(&score(b)));
    ranked
}

/// The figure of one error of all contenders.
fn figure(results: &StudyResults<'_>, ranked: &[&RaceCell], place: usize, quantity: &str) -> Option<Figure> {
    let points = |cell: &RaceCell| -> Vec<(f64, f64)> {
        cell.levels.iter().filter_map(|(size, errors)| Some((*size, errors[place]?))).collect()
    };
    let drawn: Vec<(&str, Vec<(f64, f64)>)> =
        ranked.iter().map(|cell| (cell.name, points(cell))).filter(|(_, points)| points.len() > 1).collect();
    let sizes = drawn.iter().flat_map(|(_, points)| points).map(|(size, _)| *size);
    let mut chart = Chart::new(
        format!("Error of the {quantity}"),
        ChartAxis::log10("cell size h (m)").with_ticks(ticks(sizes)),
        ChartAxis::log10(format!("relative L_2 error, {quantity} (–)")),
    );
    chart.size = Size::PANEL;
    let is_drawn = !drawn.is_empty();
    chart.series.extend(drawn.into_iter().map(|(name, points)| Series::new(name, points)));
    let caption = "All contenders, the smallest largest error on the finest mesh first.";
    is_drawn.then(|| results.figure(&format!("race-{place}"), chart, caption))
}

/// Every contender with its measures, the best first.
fn table_of(row: &RaceRow<'_>, ranked: &[&RaceCell]) -> Table {
    let number = |value: Option<f64>, kind: fn(f64) -> Cell| Cell::of(value, kind, "");
    let rows = ranked.iter().map(|cell| {
        let (ended, why) = cell.ending();
        let ended = if why.is_empty() { ended.to_owned() } else { format!("{ended}: {why}") };
        let mut cells: Vec<Cell> = vec![Cell::Code(cell.name.to_owned())];
        cells.extend(cell.errors.map(|error| number(error, Cell::Error)));
        cells.push(number(cell.order, Cell::Order));
        cells.push(cell.class.map_or("", |class| class.name()).into());
        cells.extend(cell.cost.map(|cost| number(cost, Cell::Seconds)));
        cells.extend([cell.oscillation, cell.locking, cell.step_ratio].map(|one| number(one, Cell::Number)));
        cells.extend([0, 1].map(|part| number(cell.asymmetry.map(|one| one[part]), Cell::Error)));
        cells.push(number(cell.scatter, Cell::Percent));
        cells.push(ended.into());
        cells
    });
    let heads = "contender | > pressure | > effective stress | > settlement or displacement | > order | class | > 1 % | > 0.1 % \
                 | > oscillation | > locking | > critical step | > skeleton | > water | > half the step | ended";
    Table::of(format!("Errors on {} cells", row.cells), columns(heads), rows).note(
        "order and class of the pressure; 1 %, 0.1 %: processor time to that largest error; oscillation: variation of the \
         pressure beyond the exact one's; locking: computed over exact settlement, in the plane one minus the error of the \
         displacement; critical step over the formula's; skeleton, water: asymmetry of the stiffness, round-off where the forces do the \
         power of the stresses; half the step: change of the largest error by it",
    )
}

/// The columns of the table, for everybody who reads it by name.
const HEADER: &str = "situation|method|cells|error_pressure|error_stress|error_settlement|order|class|cost_1_percent|\
                      cost_tenth_percent|oscillation|locking|step_ratio|ended|reason";

/// Every cell of the race.
pub fn whole_table(situations: &[RaceRow<'_>]) -> Table {
    let rows = situations.iter().flat_map(|one| one.contenders.iter().map(|cell| row(one, cell)));
    Table::of("", columns(HEADER), rows)
}

fn row(situation: &RaceRow<'_>, cell: &RaceCell) -> Vec<Cell> {
    let number = |value: Option<f64>| Cell::of(value, Cell::Number, "");
    let (ended, reason) = cell.ending();
    let mut row: Vec<Cell> =
        vec![situation.name().into(), cell.name.into(), Cell::Count(situation.cells as u64)];
    row.extend(cell.errors.map(number));
    row.push(number(cell.order));
    row.push(cell.class.map_or("", |class| class.name()).into());
    row.extend(cell.cost.map(number));
    row.extend([cell.oscillation, cell.locking, cell.step_ratio].map(number));
    row.extend([ended.into(), reason.into()]);
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{solved, study_of};
    use oedometer_convergence::Class;

    const SMALL: &str = "title = 'Race: small'\nscene = 'mandel'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [10, 20, 40]\ntime_step = [{ growth = 0.2 }]\n";

    #[test]
    fn the_header_is_that_of_the_contract_and_every_cell_has_a_row() {
        let (study, records) = solved("race-layer-small", SMALL);
        let row = RaceRow::of(&study, &records).expect("a race");
        let csv = whole_table(&[row]).to_plain_csv().expect("a table");
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(
            lines[0],
            "situation,method,cells,error_pressure,error_stress,error_settlement,order,class,cost_1_percent,\
             cost_tenth_percent,oscillation,locking,step_ratio,ended,reason"
        );
        assert_eq!(lines.len(), 1 + crate::case::contender::CONTENDERS.len());
        let of = |method: &str| {
            let start = format!("layer-small,{method},");
            *lines.iter().find(|line| line.starts_with(&start)).expect("a row")
        };
        assert!(of("GC-SRI-patch").starts_with("layer-small,GC-SRI-patch,40,"), "{}", of("GC-SRI-patch"));
        assert!(of("GC-SRI-patch").ends_with(",ok,"), "{}", of("GC-SRI-patch"));
        assert!(of("B2").contains(",n/a,\"a rigid plate holds the nodes of a face"), "{}", of("B2"));
        // At small strain a method on the initial configuration is the one without the prefix, to the bit.
        let numbers = |method: &str| of(method).splitn(9, ',').skip(2).take(6).collect::<Vec<_>>().join(",");
        assert_eq!(numbers("TL-GC-SRI-patch"), numbers("GC-SRI-patch"));
    }

    #[test]
    fn every_measure_of_a_contender_stands_under_its_name_and_the_best_first() {
        let study = study_of("race-layer-small", SMALL);
        let cell = |name: &'static str, score: Option<f64>, ended: Ended| RaceCell {
            name,
            errors: [Some(0.1), Some(0.2), Some(0.3)],
            levels: Vec::new(),
            order: Some(1.5),
            class: Some(Class::PreAsymptotic),
            cost: [Some(4.0), Some(5.0)],
            oscillation: Some(0.6),
            locking: Some(0.7),
            step_ratio: Some(0.8),
            asymmetry: Some([0.01, 0.02]),
            score,
            scatter: Some(0.03),
            ended,
            complaint: Some("odd".to_owned()),
        };
        let row = RaceRow {
            study: &study,
            group: "layer",
            cells: 40,
            contenders: vec![cell("a", Some(0.3), Ended::Well)],
        };
        let own = table_of(&row, &[&row.contenders[0]]).to_plain_csv().expect("a table");
        assert!(
            own.ends_with("a,0.1,0.2,0.3,1.5,pre-asymptotic,4.0,5.0,0.6,0.7,0.8,0.01,0.02,0.03,ok: odd\n"),
            "{own}"
        );
        let whole = whole_table(std::slice::from_ref(&row)).to_plain_csv().expect("a table");
        let line = "layer-small,a,40,0.1,0.2,0.3,1.5,pre-asymptotic,4.0,5.0,0.6,0.7,0.8,ok,odd\n";
        assert!(whole.ends_with(line), "{whole}");
        let cells = [
            cell("never", Some(0.0), Ended::NotApplicable("no plate".to_owned())),
            cell("failed", Some(0.1), Ended::Failed("unstable", "it grew".to_owned())),
            cell("bare", None, Ended::Well),
            cell("second", Some(0.2), Ended::Well),
            cell("best", Some(0.1), Ended::Well),
        ];
        let order: Vec<&str> = ranked(&cells).iter().map(|cell| cell.name).collect();
        assert_eq!(order, ["best", "second", "failed", "bare", "never"]);
    }
}
