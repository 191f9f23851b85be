//! Tables of records, by runs of small studies.

use crate::campaign::runner::records_of;
use crate::record::Record;
use crate::record::csv::long_tables::{LongTable, columns_csv};
use crate::record::csv::tidy;
use crate::record::csv::tidy::{columns, header_line, rows_of};

const STUDY: &str = "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
                     method = [\"MPM\"]\nintegrator = [\"implicit\"]\ncells = [3]\npoisson_ratio = []\n";

fn table(table: LongTable, records: &[Record]) -> String {
    let rows: String = records.iter().map(|record| table.rows_of(record).expect("rows")).collect();
    table.header_line() + &rows
}

fn rows(text: &str) -> Vec<csv::StringRecord> {
    csv::Reader::from_reader(text.as_bytes()).records().map(|row| row.expect("a row")).collect()
}

#[test]
fn every_place_of_every_output_has_a_row_and_every_column_a_meaning() {
    let records = records_of(&STUDY.replace("poisson_ratio = []\n", "poissons_ratio = [0.1, 0.4]\n"));
    let profiles = rows(&table(LongTable::Profiles, &records));
    // Two cases of 6 points, 3 centres and 4 nodes.
    assert_eq!(profiles.len(), 2 * (6 + 3 + 4));
    let snapshot = &records[0].snapshots[0];
    assert_eq!(profiles[0][6].parse::<f64>().ok(), Some(snapshot.points.pressure[0]));
    assert_eq!(rows(&table(LongTable::History, &records)).len(), 2 * records[0].history.len());
    let meanings = rows(&columns_csv().expect("a table"));
    for column in tidy::columns() {
        let found = meanings.iter().filter(|row| row[0].is_empty() && &row[1] == column).count();
        assert_eq!(found, 1, "{column}");
    }
    assert!(meanings.iter().all(|row| !row[3].is_empty()));
    let modulus = meanings.iter().find(|row| &row[1] == "youngs_modulus").expect("a row");
    assert_eq!(&modulus[2], "Pa");
}

#[test]
fn what_is_swept_tells_the_rows_apart() {
    let records = records_of(&STUDY.replace("poisson_ratio = []\n", "poissons_ratio = [0.1, 0.4]\n"));
    let all: String = records.iter().map(|one| tidy::rows_of("s", one).expect("rows")).collect();
    let table = tidy::header_line() + &all;
    let place = |name: &str| tidy::columns().iter().position(|column| *column == name).expect("a column");
    let all = rows(&table);
    let values: std::collections::BTreeSet<&str> =
        all.iter().map(|row| &row[place("poissons_ratio")]).collect();
    assert_eq!(values.into_iter().collect::<Vec<_>>(), ["0.1", "0.4"]);
    let row = &all[0];
    assert_eq!((&row[place("scene")], &row[place("task")]), ("terzaghi", "solve"));
    assert_eq!(row[place("cell_size")].parse::<f64>().ok(), Some(1.0 / 3.0));
    assert!(row[place("wall_seconds")].parse::<f64>().is_ok_and(|seconds| seconds > 0.0));
    let error = &records[0].errors[0];
    assert_eq!(row[place("absolute_error")].parse::<f64>().ok(), Some(error.absolute));
    assert_eq!(row[place("value")].parse::<f64>().ok(), Some(error.value));
}

#[test]
fn rows_are_what_the_usual_writer_makes_of_the_same_fields() {
    let mut records = records_of(
        "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
         method = [\"GIMP-SRI-patch\", { basis = \"hat\", strain = \"cmpm\", pressure = \"sri\", recovery = \"patch\" }]\n\
         integrator = [\"implicit\"]\ncells = [2]\n",
    );
    records[1].errors.clear();
    records[1].measures.clear();
    for (record, rows) in records.iter().zip([2 * 56, 1]) {
        let text = header_line() + &rows_of("a \"b\", c", record).expect("rows");
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let read: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
        assert!(read.len() <= rows && !read.is_empty(), "{} rows", read.len());
        let mut again = csv::Writer::from_writer(Vec::new());
        again.write_record(columns()).expect("in memory");
        for row in &read {
            again.write_record(row).expect("in memory");
        }
        assert_eq!(String::from_utf8(again.into_inner().expect("bytes")).expect("text"), text);
        let names = columns();
        let at =
            |row: usize, name: &str| &read[row][names.iter().position(|one| *one == name).expect("a column")];
        assert_eq!((at(0, "study"), at(0, "scene")), ("a \"b\", c", "terzaghi"));
        if let Some(first) = record.errors.first() {
            assert_eq!(read.len(), record.errors.len() + record.measures.len());
            assert_eq!(at(0, "value").parse(), Ok(first.value));
            assert_eq!(at(0, "absolute_error").parse(), Ok(first.absolute));
        } else {
            assert_eq!([at(0, "quantity"), at(0, "absolute_error")], ["", ""]);
        }
    }
}

#[test]
fn a_measure_stands_with_its_error_and_the_size_of_its_difference() {
    let mut record = records_of(&STUDY.replace("poisson_ratio = []\n", "")).remove(0);
    record.errors.clear();
    let measure = |name: &str, time_factor: Option<f64>, found: f64, exact: f64| crate::record::MeasureRow {
        name: name.to_owned(),
        time_factor,
        reference: "theirs".to_owned(),
        found,
        exact,
    };
    record.measures = vec![measure("low", Some(0.1), 2.0, 5.0), measure("still", None, -3.0, 0.0)];
    let table = tidy::header_line() + &tidy::rows_of("s", &record).expect("rows");
    let place = |name: &str| tidy::columns().iter().position(|column| *column == name).expect("a column");
    let all = rows(&table);
    let at = |row: usize, name: &str| all[row][place(name)].to_owned();
    let number = |row: usize, name: &str| at(row, name).parse::<f64>().expect("a number");
    assert_eq!([at(0, "quantity"), at(0, "time_factor"), at(0, "norm")], ["low", "0.1", "relative"]);
    assert!((number(0, "value") + 0.6).abs() < 1e-15 && number(0, "absolute_error") == 3.0, "{table}");
    assert_eq!([at(1, "quantity"), at(1, "time_factor"), at(1, "norm")], ["still", "", "absolute"]);
    assert_eq!([number(1, "value"), number(1, "absolute_error")], [-3.0, 3.0]);
    assert_eq!(at(0, "reference"), "theirs");
}
