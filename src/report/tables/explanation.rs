//! Tables of an explained case: where its errors are, its levels, and its golden values.

use crate::case::quantity::Quantity;
use crate::judge::explanation::{Carrier, Explanation, LevelSeries};
use crate::record::Record;
use crate::render::number;
use crate::render::table::{Cell, Mood, Table, columns};
use crate::report::tables::golden_changes::differences_table;
use crate::report::tables::runs::attached_notes;

/// Places of the errors, levels and changes of a case.
pub fn tables_of(record: &Record, explanation: &Explanation) -> Vec<Table> {
    let mut tables = Vec::new();
    tables.push(carriers_table(record, explanation));
    if let Some(first) = explanation.carriers.first() {
        tables.extend(explanation.levels.iter().map(|series| levels_table(first, series)));
    }
    if !explanation.differences.is_empty() {
        tables.push(differences_table(&explanation.differences));
    }
    tables
}

/// One sentence on the golden values of a case, and another one where its inputs are not those of then.
pub fn golden_sentence(explanation: &Explanation) -> String {
    let values = match (explanation.has_golden, explanation.differences.len(), explanation.agreeing) {
        (false, ..) => "there are no golden values to compare the case with".to_owned(),
        (true, 0, 0) => "this case has no golden values: it is not in the CI tier".to_owned(),
        (true, 0, agreeing) => format!("all {agreeing} golden values of the case agree"),
        (true, differing, agreeing) => {
            format!("{differing} values differ from the golden ones, {agreeing} agree")
        }
    };
    let inputs = if explanation.has_other_inputs { ". Its inputs are others than theirs" } else { "" };
    values + inputs
}

fn carriers_table(record: &Record, explanation: &Explanation) -> Table {
    let optional = |value: Option<f64>| Cell::of(value, Cell::Error, "");
    let rows = explanation.carriers.iter().map(|carrier| {
        let row = &carrier.row;
        let main = match row.quantity {
            Quantity::Settlement | Quantity::LoadFactor => Cell::Percent(row.value),
            _ => Cell::Error(row.value),
        };
        let mut cells = vec![
            row.quantity.name().into(),
            row.sample.name().into(),
            Cell::Number(row.time_factor),
            optional(carrier.l1),
            main,
            optional(carrier.linf),
        ];
        cells.extend(match carrier.place {
            Some(place) => [
                Cell::Number(place.zeta),
                Cell::Percent(place.share),
                Cell::Error(place.computed),
                Cell::Error(place.exact),
            ],
            None => std::array::from_fn(|_| Cell::missing("")),
        });
        cells
    });
    let failure = record.status.failure();
    let status = failure.map_or(String::new(), |failure| format!(" ({})", failure.name_with_step()));
    let reference = record.references.first().map_or("no reference", |used| used.name.as_str());
    let table = Table::of(
        format!("{}: {}{status}", record.case.scene.name, record.case.label()),
        columns(
            "quantity | sample | > largest at T_v | > L1 | > L2 | > Linf | > worst at ζ | > its share \
                 | > computed | > exact",
        ),
        rows,
    )
    .note(format!(
        "relative errors against {reference}, the largest first; settlement as s/s_exact − 1; share of the \
             squared L2 error; values in Pa and m"
    ));
    table.notes(attached_notes(record, explanation.outside_run.as_ref()))
}

fn levels_table(first: &Carrier, series: &LevelSeries) -> Table {
    let rows = series.labels.iter().zip(&series.errors).enumerate().map(|(place, (label, error))| {
        let own = place == series.own;
        vec![
            label.as_str().into(),
            Cell::of(*error, Cell::Error, "no golden value"),
            if own { Cell::Verdict(Mood::Note, "this case".to_owned()) } else { "golden".into() },
        ]
    });
    Table::of(
        format!(
            "{} {} at T_v = {} over {}",
            first.row.quantity.name(),
            first.row.sample.name(),
            number::number(first.row.time_factor),
            series.axis.name().replace('_', " ")
        ),
        columns("level | > error | from"),
        rows,
    )
    .note(format!("{}: {}", series.class, series.reason))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of};
    use crate::case::quantity::{Norm, Sample};
    use crate::golden::compare::{Change, Difference};
    use crate::judge::error_place::ErrorPlace;
    use crate::record::ErrorRow;

    #[test]
    fn every_number_of_a_carrier_stands_under_its_name() {
        let record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [3]\n",
        )
        .remove(0);
        let row = ErrorRow { time_factor: 0.7, value: 0.02, absolute: 0.11, ..record.errors[0].clone() };
        let place = ErrorPlace { zeta: 0.3, share: 0.4, computed: 5.0, exact: 6.0 };
        let carrier = Carrier { row, l1: Some(0.01), linf: Some(0.03), place: Some(place) };
        let table =
            carriers_table(&record, &Explanation { carriers: vec![carrier], ..Explanation::default() });
        let under = |header: &str| {
            let column = table.columns.iter().position(|column| column.header == header).expect("a column");
            format!("{:?}", table.rows[0][column])
        };
        for (header, cell) in [
            ("largest at T_v", Cell::Number(0.7)),
            ("L1", Cell::Error(0.01)),
            ("L2", Cell::Error(0.02)),
            ("Linf", Cell::Error(0.03)),
            ("worst at ζ", Cell::Number(0.3)),
            ("its share", Cell::Percent(0.4)),
            ("computed", Cell::Error(5.0)),
            ("exact", Cell::Error(6.0)),
        ] {
            assert_eq!(under(header), format!("{cell:?}"), "{header}");
        }
    }

    #[test]
    fn golden_values_of_a_case_are_counted_and_a_failure_stands_in_the_title() {
        let of = |has_golden: bool, differing: usize, agreeing: usize| {
            let one = Difference {
                key: crate::golden::measure::key("n", None, "steps"),
                change: Change::Moved,
                golden: None,
                found: None,
                tolerance: 1e-9,
            };
            golden_sentence(&Explanation {
                differences: vec![one; differing],
                agreeing,
                has_golden,
                ..Explanation::default()
            })
        };
        assert_eq!(of(false, 0, 0), "there are no golden values to compare the case with");
        assert_eq!(of(true, 0, 0), "this case has no golden values: it is not in the CI tier");
        assert_eq!(of(true, 0, 3), "all 3 golden values of the case agree");
        assert_eq!(of(true, 2, 3), "2 values differ from the golden ones, 3 agree");
        assert_eq!(of(true, 2, 0), "2 values differ from the golden ones, 0 agree");
        let other =
            Explanation { has_golden: true, agreeing: 3, has_other_inputs: true, ..Explanation::default() };
        let told = "all 3 golden values of the case agree. Its inputs are others than theirs";
        assert_eq!(golden_sentence(&other), told);
        let row = |quantity: Quantity| ErrorRow {
            time_factor: 0.5,
            quantity,
            sample: Sample::Surface,
            norm: Norm::Relative,
            reference: "r".to_owned(),
            value: 0.02,
            absolute: 0.1,
        };
        let carrier = |quantity: Quantity| Carrier { row: row(quantity), l1: None, linf: None, place: None };
        let mut record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [3]\n",
        )
        .remove(0);
        record.status = failed_at(7);
        let carriers = [Quantity::Settlement, Quantity::LoadFactor, Quantity::Pressure].map(carrier).into();
        let table = carriers_table(&record, &Explanation { carriers, ..Explanation::default() });
        let main: Vec<&Cell> = table.rows.iter().map(|row| &row[4]).collect();
        assert_eq!(main, [&Cell::Percent(0.02), &Cell::Percent(0.02), &Cell::Error(0.02)]);
        assert!(table.title.ends_with(" (unstable at step 7)"), "{}", table.title);
        assert!(table.notes[0].starts_with("relative errors against terzaghi, "), "{:?}", table.notes);
    }
}
