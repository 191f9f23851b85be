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
