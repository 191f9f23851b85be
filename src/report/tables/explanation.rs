//! Tables of an explained case: where its errors are, and its golden values.

use crate::case::quantity::Quantity;
use crate::judge::explanation::Explanation;
use crate::record::Record;
use crate::render::table::{Cell, Table, columns};
use crate::report::tables::golden_changes::differences_table;
use oedometer_wording::rounded;

/// Places of the errors and changes of a case.
pub fn tables_of(record: &Record, explanation: &Explanation) -> Vec<Table> {
    let changes = differences_table(&explanation.differences).unless_empty();
    std::iter::once(carriers_table(record, explanation)).chain(changes).collect()
}

/// One sentence on the golden values of a case, and another one where its inputs are not those of then.
pub fn golden_sentence(explanation: &Explanation) -> String {
    let values = match (explanation.has_golden, explanation.differences.len(), explanation.agreeing) {
        (false, ..) => "there are no golden values to compare the case with".to_owned(),
        (true, 0, 0) => "this case has no golden values: it is not at the test level `ci`".to_owned(),
        (true, 0, agreeing) => format!("all {agreeing} golden values of the case agree"),
        (true, differing, agreeing) => {
            format!("{differing} values differ from the golden ones, {agreeing} agree")
        }
    };
    let inputs = if explanation.has_other_inputs { ". Its inputs differ from theirs" } else { "" };
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
                Cell::Measured(place.computed),
                Cell::Measured(place.exact),
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
            "quantity | sample | > largest at T_v | > L1 | > L2 | > Linf | > worst at ζ | > share of squared error \
                 | > computed | > exact",
        ),
        rows,
    )
    .note(format!(
        "relative errors against {reference}, largest first; settlement as s/s_exact − 1; values in Pa and m"
    ));
    table.notes(attached_notes(record))
}

/// Sentences on the run of an attached solver: how it failed, and what it is; none for other cases.
pub fn attached_notes(record: &Record) -> Vec<String> {
    let Some(about) = record.outside_run() else { return Vec::new() };
    let mut notes: Vec<String> = record.status.failure().map(ToString::to_string).into_iter().collect();
    let version = about.version.as_ref().map_or(String::new(), |version| format!(", version {version}"));
    notes.push(if about.command.is_empty() {
        "read from existing files; nothing was run".to_owned()
    } else {
        format!("run by `{}`{version}", about.command.join(" "))
    });
    let most = about.repeats_differ_by;
    notes.extend(most.map(|most| format!("results of repeated runs differ by at most {}", rounded(most))));
    notes.extend(about.notes.iter().cloned());
    notes.extend(about.taken.iter().map(|taken| format!("taken: {taken}")));
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of};
    use crate::case::quantity::{Norm, Sample};
    use crate::golden::compare::{Change, Difference};
    use crate::judge::error_place::ErrorPlace;
    use crate::judge::explanation::Carrier;
    use crate::record::ErrorRow;
    use crate::record::{AttachedRun, Status};
    use oedometer_problem::outcome::{Failure, FailureKind};

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
            ("share of squared error", Cell::Percent(0.4)),
            ("computed", Cell::Measured(5.0)),
            ("exact", Cell::Measured(6.0)),
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
        assert_eq!(of(true, 0, 0), "this case has no golden values: it is not at the test level `ci`");
        assert_eq!(of(true, 0, 3), "all 3 golden values of the case agree");
        assert_eq!(of(true, 2, 3), "2 values differ from the golden ones, 3 agree");
        assert_eq!(of(true, 2, 0), "2 values differ from the golden ones, 0 agree");
        let other =
            Explanation { has_golden: true, agreeing: 3, has_other_inputs: true, ..Explanation::default() };
        let told = "all 3 golden values of the case agree. Its inputs differ from theirs";
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

    #[test]
    fn a_run_of_a_solver_is_told_with_its_command_or_why_it_failed() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2]\n";
        let mut record = records_of(text).remove(0);
        assert_eq!(attached_notes(&record), [""; 0]);
        record.outside = Some(AttachedRun::default());
        let mut failed = record.clone();
        let (kind, reason) = (FailureKind::TimedOut, "why".to_owned());
        failed.status = Status::Failed(Failure { kind, step: 0, time: 0.0, growth: None, reason });
        let about = record.outside.as_mut().expect("another program's");
        (about.command, about.version) = (["sh", "{case}"].map(str::to_owned).into(), Some("2.1".to_owned()));
        (about.repeats_differ_by, about.notes) = (Some(1e-9), vec!["a note".to_owned()]);
        about.taken = vec!["p from pressure".to_owned()];
        assert_eq!(
            attached_notes(&record),
            [
                "run by `sh {case}`, version 2.1",
                "results of repeated runs differ by at most 1e-9",
                "a note",
                "taken: p from pressure"
            ]
        );
        let [why, how] = &attached_notes(&failed)[..] else { panic!("two notes") };
        assert!(why.contains("why"), "{why}");
        assert_eq!(how, "read from existing files; nothing was run");
    }
}
