//! The table of values that have no exact one, with what refinement tells of them.

use crate::convergence::uncertainty::eca_hoekstra::ErrorModel;
use crate::convergence::uncertainty::grid_convergence::Behaviour;
use crate::judge::paths::Judgement;
use crate::render::table::{Cell, Table, TableColumn};

/// One row a value that was asked for; none where none was.
pub fn table_of(judgements: &[Judgement]) -> Option<Table> {
    let rows: Vec<Vec<Cell>> = judgements.iter().filter_map(row_of).collect();
    (!rows.is_empty()).then(|| Table {
        title: "values without a reference and their numerical uncertainty".to_owned(),
        columns: vec![
            TableColumn::text("value"),
            TableColumn::number("levels"),
            TableColumn::number("finest"),
            TableColumn::text("behaviour"),
            TableColumn::number("order"),
            TableColumn::number("extrapolated"),
            TableColumn::number("index, 3 levels"),
            TableColumn::number("least squares"),
            TableColumn::text("error model"),
            TableColumn::number("uncertainty"),
        ],
        rows,
        notes: vec![
            "settlement over the final one of small strain, pressure and stress over the load; behaviour, order and \
             grid convergence index (Celik et al. 2008) of the finest three levels; uncertainty by least squares over \
             four levels and more (Eça & Hoekstra 2014); all uncertainties over the finest value"
                .to_owned(),
        ],
    })
}

fn row_of(judgement: &Judgement) -> Option<Vec<Cell>> {
    let found = judgement.uncertainty.as_ref()?;
    let missing = |why: &str| Cell::Missing(why.to_owned());
    let share = |value: f64| Cell::Error(value / found.finest().abs());
    let index = found.finest_three.estimate;
    let fit = found.least_squares.as_ref();
    let of_fit = fit.and_then(|fit| fit.grids.last());
    Some(vec![
        judgement.subject.as_str().into(),
        Cell::Count(found.values.len() as u64),
        digits(found.finest()),
        behaviour_name(found.finest_three.behaviour).into(),
        found.order.map_or_else(|| missing("the finest three go to and fro"), Cell::Number),
        found.extrapolated.map_or_else(|| missing("the finest three go to and fro"), digits),
        index.map_or_else(|| missing("the finest three go to and fro"), |index| share(index.index_fine)),
        of_fit.map_or_else(|| missing("fewer than four levels"), |grid| share(grid.uncertainty)),
        fit.map_or_else(|| missing("fewer than four levels"), |fit| model_name(fit.model).into()),
        Cell::Error(found.relative()),
    ])
}

/// A value with digits enough for the uncertainties that stand beside it.
fn digits(value: f64) -> Cell {
    Cell::Text(format!("{value:.6}"))
}

fn behaviour_name(behaviour: Behaviour) -> &'static str {
    match behaviour {
        Behaviour::Monotone => "monotone",
        Behaviour::Oscillatory => "to and fro",
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
