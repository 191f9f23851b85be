//! How certain are values without an exact solution? Their numerical uncertainty from three levels and more.

use crate::judge::study_results::StudyResults;
use crate::judge::verdict::Judgement;
use crate::questions::finding::{Finding, Place, Question};
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};
use oedometer_convergence::{Behaviour, NumericalUncertainty};

/// How certain are values without an exact solution?
pub static UNCERTAINTY: Question = Question {
    id: "uncertainty",
    heading: "How certain are values without an exact solution?",
    template: include_str!("uncertainty.md"),
    places: &[Place::Terminal, Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Values that the study asks for.
    values: usize,
    /// The largest of their uncertainties, over the finest value.
    largest: f64,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let table = table_of(&one.check.judgements)?;
    let found = one.check.judgements.iter().filter_map(|judgement| judgement.uncertainty.as_ref());
    let largest = found.map(NumericalUncertainty::relative).fold(0.0, f64::max);
    let facts = Facts { values: table.rows.len(), largest };
    Some(UNCERTAINTY.answer([one.study.name.as_str()], &facts).with(Block::Table(table)))
}

/// One row per requested value; `None` without such values.
fn table_of(judgements: &[Judgement]) -> Option<Table> {
    let header = "value | > levels | > finest | behaviour | > order | > extrapolated | > uncertainty";
    let rows = judgements.iter().filter_map(row_of);
    let title = "Values without a reference, and their numerical uncertainty";
    let table = Table::of(title, columns(header), rows).file("uncertainty").note(
        "settlement over the final small-strain one, pressure and stress over the load; behaviour and order \
         of the finest three levels; uncertainty over the finest value: the grid convergence index for \
         three levels (Celik et al. 2008), least squares for four and more (Eça & Hoekstra 2014)",
    );
    table.unless_empty()
}

/// Why the finest three levels have no estimate.
const OSCILLATES: &str = "the finest three levels oscillate";

fn row_of(judgement: &Judgement) -> Option<Vec<Cell>> {
    let found = judgement.uncertainty.as_ref()?;
    Some(vec![
        judgement.subject.as_str().into(),
        Cell::Count(found.values.len() as u64),
        digits(found.finest()),
        behaviour_name(found.finest_three.behaviour).into(),
        Cell::of(found.order, Cell::Order, OSCILLATES),
        Cell::of(found.extrapolated, digits, OSCILLATES),
        Cell::Error(found.relative()),
    ])
}

/// A value with enough digits for the uncertainties beside it.
fn digits(value: f64) -> Cell {
    Cell::Text(format!("{value:.6}"))
}

fn behaviour_name(behaviour: Behaviour) -> &'static str {
    match behaviour {
        Behaviour::Monotone => "monotone",
        Behaviour::Oscillatory => "oscillatory",
        Behaviour::Divergent => "divergent",
        Behaviour::Equal => "equal",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::verdict::{Beside, judge};
    use oedometer_convergence::{Context, ErrorSeries, SeriesDemand, ValueSeries};

    #[test]
    fn every_uncertainty_is_a_share_of_the_finest_value() {
        let level = |cells: f64, scale: f64| {
            let size = 1.0 / cells;
            (size, Some(scale * (1.0 + 0.3 * size.powf(1.7) + 0.01 * size)))
        };
        let row = |scale: f64| {
            let levels = [4.0, 7.0, 11.0, 23.0].map(|cells| level(cells, scale)).to_vec();
            let uncertainty = ValueSeries::new(levels).uncertainty(2.0).expect("four levels");
            let verdict = judge(
                &SeriesDemand::default(),
                &ErrorSeries::default(),
                &Context::default(),
                &Beside::default(),
            );
            let judgement =
                Judgement { line: 1, subject: "s".to_owned(), verdict, uncertainty: Some(uncertainty) };
            row_of(&judgement).expect("a row")
        };
        let (one, eight) = (row(1.0), row(8.0));
        let [Cell::Error(one), Cell::Error(eight)] = [&one[6], &eight[6]] else {
            panic!("{one:?} {eight:?}")
        };
        assert!((eight / one - 1.0).abs() < 1e-6, "{one} {eight}");
    }

    #[test]
    fn three_levels_have_an_index_and_those_that_oscillate_no_order() {
        let told = |levels: &[(f64, f64)]| {
            let levels = levels.iter().map(|(size, value)| (*size, Some(*value))).collect();
            let uncertainty = ValueSeries::new(levels).uncertainty(2.0).expect("three levels");
            let (demand, series) = (SeriesDemand::default(), ErrorSeries::default());
            let verdict = judge(&demand, &series, &Context::default(), &Beside::default());
            let judgement =
                Judgement { line: 1, subject: "s".to_owned(), verdict, uncertainty: Some(uncertainty) };
            let table = table_of(&[judgement]).expect("a table");
            (table.rows[0].iter().map(Cell::show).collect::<Vec<_>>(), table.footnotes().join("; "))
        };
        // 2 + h²: the index is 1.25 (φ₁ − φ₂)/(2² − 1), over the finest value.
        let (row, why) = told(&[(1.0, 3.0), (0.5, 2.25), (0.25, 2.0625)]);
        let share = crate::render::number::error(1.25 * 0.0625 / 2.0625);
        let start = ["s", "3", "2.062500", "monotone", "2.00", "2.000000", share.as_str()];
        assert_eq!((row, why.as_str()), (start.map(str::to_owned).to_vec(), ""));
        // Three times the range of the values.
        let (row, why) = told(&[(1.0, 2.0), (0.5, 2.2), (0.25, 2.1)]);
        let share = crate::render::number::error(3.0 * 0.2 / 2.1);
        let start = ["s", "3", "2.100000", "oscillatory", "–", "–", share.as_str()];
        assert_eq!((row, why.as_str()), (start.map(str::to_owned).to_vec(), OSCILLATES));
        assert!(table_of(&[]).is_none());
    }
}
