//! The table of values without an exact solution, with their numerical uncertainty.

use crate::judge::verdict::Judgement;
use crate::render::table::{Cell, Table, columns};
use oedometer_convergence::{Behaviour, ErrorModel};

/// One row per requested value; `None` without such values.
pub fn table_of(judgements: &[Judgement]) -> Option<Table> {
    let rows: Vec<Vec<Cell>> = judgements.iter().filter_map(row_of).collect();
    (!rows.is_empty()).then(|| {
        Table::of(
            "values without a reference and their numerical uncertainty",
            columns(
                "value | > levels | > finest | behaviour | > order | > extrapolated | > index, \
             3 levels | > least squares | error model | > uncertainty",
            ),
            rows,
        )
        .note(
            "settlement over the final one of small strain, pressure and stress over the \
                      load; behaviour, order and grid convergence index (Celik et al. 2008) of the \
                      finest three levels; uncertainty by least squares over four levels and more \
                      (Eça & Hoekstra 2014); all uncertainties over the finest value",
        )
    })
}

/// Why the finest three levels have no estimate.
const OSCILLATES: &str = "the finest three levels oscillate";
/// Why a fit is missing.
const FEW: &str = "fewer than four levels";

fn row_of(judgement: &Judgement) -> Option<Vec<Cell>> {
    let found = judgement.uncertainty.as_ref()?;
    let share =
        |value: Option<f64>, why| Cell::of(value.map(|it| it / found.finest().abs()), Cell::Error, why);
    let index = found.finest_three.estimate;
    let fit = found.least_squares.as_ref();
    let of_fit = fit.and_then(|fit| fit.grids.last());
    Some(vec![
        judgement.subject.as_str().into(),
        Cell::Count(found.values.len() as u64),
        digits(found.finest()),
        behaviour_name(found.finest_three.behaviour).into(),
        Cell::of(found.order, Cell::Number, OSCILLATES),
        Cell::of(found.extrapolated, digits, OSCILLATES),
        share(index.map(|index| index.index_fine), OSCILLATES),
        share(of_fit.map(|grid| grid.uncertainty), FEW),
        fit.map_or_else(|| Cell::missing(FEW), |fit| model_name(fit.model).into()),
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

fn model_name(model: ErrorModel) -> &'static str {
    match model {
        ErrorModel::PowerLaw => "α h^p",
        ErrorModel::FirstOrder => "α h",
        ErrorModel::SecondOrder => "α h²",
        ErrorModel::FirstAndSecondOrder => "α₁ h + α₂ h²",
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
        for column in [6, 7, 9] {
            let [Cell::Error(one), Cell::Error(eight)] = [&one[column], &eight[column]] else {
                panic!("{one:?} {eight:?}")
            };
            assert!((eight / one - 1.0).abs() < 1e-6, "column {column}: {one} {eight}");
        }
    }

    #[test]
    fn three_levels_have_an_index_alone_and_those_that_oscillate_not_even_an_order() {
        use ErrorModel::{FirstAndSecondOrder, FirstOrder, PowerLaw, SecondOrder};
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
        let start =
            ["s", "3", "2.062500", "monotone", "2", "2.000000", share.as_str(), "–", "–", share.as_str()];
        assert_eq!((row, why.as_str()), (start.map(str::to_owned).to_vec(), FEW));
        // Three times the range of the values.
        let (row, why) = told(&[(1.0, 2.0), (0.5, 2.2), (0.25, 2.1)]);
        let share = crate::render::number::error(3.0 * 0.2 / 2.1);
        let start = ["s", "3", "2.100000", "oscillatory", "–", "–", "–", "–", "–", share.as_str()];
        assert_eq!((row, why), (start.map(str::to_owned).to_vec(), format!("{OSCILLATES}; {FEW}")));
        assert!(table_of(&[]).is_none());
        let models = [PowerLaw, FirstOrder, SecondOrder, FirstAndSecondOrder].map(model_name);
        assert_eq!(models, ["α h^p", "α h", "α h²", "α₁ h + α₂ h²"]);
    }
}
