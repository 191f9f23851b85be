//! Tables and figures of records in which every number is another one: each cell has the number that its column names.

use crate::campaign::runner::records_of;
use crate::case::quantity::Norm;
use crate::golden::compare::{Change, Difference};
use crate::questions::{outside_runs, stability};
use crate::record::csv::tidy::{header_line, rows_of};
use crate::record::{CriticalStep, Record, WallSample};
use crate::render::table::{Cell, Table};
use crate::report::tables::{golden_changes, measures};

/// A column of no unit number: height, load, stiffness, density and gravity are another each, and so are the ratios of its
/// meshes.
const STUDY: &str = r#"title = "Distinct"
scene = "terzaghi"
column = { height = 2.5, load = 40.0 }
timing.repeats = 3

[material]
youngs_modulus = 3.2e6
poissons_ratio = 0.22
porosity = 0.37
grain_density = 2710.0
water_density = 1030.0
hydraulic_conductivity = 4.1e-5
gravity = 9.7

[output]
time_factors = [0.07, 0.3]

[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [4, 6, 11]
points_per_cell = [3]
"#;

/// A number of things as a counter holds it.
fn counted(value: f64) -> u64 {
    format!("{value:.0}").parse().expect("a whole number")
}

/// Numbers that are all different, and no multiples of each other by a power of ten.
struct Distinct(f64);

impl Distinct {
    fn next(&mut self) -> f64 {
        self.0 += 1.0;
        1e-3 * (self.0 + 1.0 / (self.0 + 7.0))
    }

    fn count(&mut self) -> u64 {
        self.0 += 1.0;
        1009 * counted(self.0)
    }
}

/// Records of the study, each number of them another.
fn records() -> Vec<Record> {
    let mut records = records_of(STUDY);
    let mut numbers = Distinct(0.0);
    for record in &mut records {
        for row in &mut record.errors {
            (row.value, row.absolute) = (numbers.next(), numbers.next());
        }
        record.counters.steps = numbers.count();
        record.counters.point_updates = numbers.count();
        record.step_sizes.largest = numbers.next();
        let groups = &mut record.groups;
        (groups.storage, groups.finite_strain, groups.inertia) =
            (numbers.next(), numbers.next(), numbers.next());
        let start = record.start.as_mut().expect("a start");
        (start.volume_error, start.undrained_pressure_error, start.unbalanced_force) =
            (numbers.next(), numbers.next(), numbers.next());
        for balance in &mut record.balance {
            balance.solid_mass_drift = numbers.next();
            balance.water_imbalance = numbers.next();
            balance.internal_force_imbalance = numbers.next();
            balance.equilibrium_residual = numbers.next();
            balance.settlement_curve_gap = numbers.next();
        }
        // The middle one is neither the first nor the last, nor near the mean.
        let [a, b, c] = [numbers.next(), numbers.next(), 40.0 * numbers.next()];
        record.wall = [b, c, a]
            .map(|seconds| WallSample {
                seconds,
                alone: true,
                cpu_seconds: Some(numbers.next()),
                ..WallSample::default()
            })
            .to_vec();
    }
    records
}

/// The cell of a row under a heading.
fn under<'a>(table: &'a Table, row: usize, header: &str) -> &'a Cell {
    let place = table.columns.iter().position(|column| column.header == header);
    &table.rows[row][place.unwrap_or_else(|| panic!("no column `{header}` in {:?}", table.columns))]
}

fn text(cell: &Cell) -> &str {
    match cell {
        Cell::Text(text) | Cell::Code(text) => text,
        other => panic!("{other:?} is no text"),
    }
}

#[test]
fn every_error_stands_under_its_time_beside_its_reference_quantity_and_sample() {
    for record in records() {
        let table = measures::errors_table(&record);
        let mut seen = 0;
        for (place, row) in table.rows.iter().enumerate() {
            let [reference, quantity, sample] = [0, 1, 2].map(|column| text(&row[column]));
            for factor in record.case.time_factors.iter() {
                let mut meant = record.errors.iter().filter(|row| {
                    row.reference == reference
                        && row.quantity.name() == quantity
                        && row.sample.name() == sample
                        && matches!(row.norm, Norm::L2 | Norm::Relative)
                        && row.time_factor == *factor
                });
                let meant = meant.next().expect("it was measured");
                let expected = if quantity == "settlement" {
                    Cell::Percent(meant.value)
                } else {
                    Cell::Error(meant.value)
                };
                assert_eq!(
                    *under(&table, place, &format!("T_v {factor}")),
                    expected,
                    "{reference} {quantity}"
                );
                seen += 1;
            }
        }
        assert_eq!(seen, 2 * 2 * 5, "references, times, measures");
        let note = table.notes.last().expect("of the work");
        let [steps, updates] = [record.counters.steps, record.counters.point_updates];
        assert!(note.starts_with(&format!("{steps} steps of at most {:.3e} s", record.step_sizes.largest)));
        assert!(note.contains(&format!("{updates} point updates")), "{note}");
    }
}

#[test]
fn every_check_and_group_has_its_own_number() {
    for record in records() {
        let table = measures::checks_table(&record);
        let (start, last) = (record.start.expect("a start"), *record.balance.last().expect("an output"));
        let expected = [
            ("points at the start", Cell::Count(start.points as u64)),
            ("volume at the start, relative error", Cell::Measured(start.volume_error)),
            (
                "undrained pressure at the start, relative error",
                Cell::Measured(start.undrained_pressure_error),
            ),
            ("unbalanced force at the start, over the load", Cell::Measured(start.unbalanced_force)),
            ("mass of solids, drift", Cell::Measured(last.solid_mass_drift)),
            ("water-mass error / expelled water", Cell::Measured(last.water_imbalance)),
            ("sum of internal forces, relative", Cell::Measured(last.internal_force_imbalance)),
            ("final settlement against settlement curve", Cell::Measured(last.settlement_curve_gap)),
            ("storage n E_oed/K_w", Cell::Measured(record.groups.storage)),
            ("finite strain m_vl q", Cell::Measured(record.groups.finite_strain)),
            ("inertia c_v/(H V)", Cell::Measured(record.groups.inertia)),
        ];
        for (name, value) in expected {
            let row = table.rows.iter().find(|row| text(&row[0]) == name);
            assert_eq!(row.unwrap_or_else(|| panic!("no row `{name}`"))[1], value, "{name}");
        }
    }
}

#[test]
fn critical_steps_spreads_and_phases_stand_under_their_names() {
    let mut record = records().remove(0);
    record.stability = Some(CriticalStep {
        predicted: 0.011,
        creeping_from: Some(0.007),
        observed: Some(0.013),
        wave_limit: 0.017,
        drag_limit: 0.019,
        combined_limit: 0.023,
        ..CriticalStep::default()
    });
    let table = stability::table(&[record.clone()]);
    for (header, value) in [
        ("predicted", Cell::Error(0.011)),
        ("observed", Cell::Error(0.013)),
        ("over h/c", Cell::Measured(0.011 / 0.017)),
        ("slow growth from", Cell::Error(0.007)),
    ] {
        assert_eq!(*under(&table, 0, header), value, "{header}");
    }
    let Cell::Percent(difference) = under(&table, 0, "difference") else { panic!("a share") };
    assert!((difference - (0.013 / 0.011 - 1.0)).abs() < 1e-12, "{difference}: observed over predicted");
}

#[test]
fn every_column_of_the_tidy_table_is_the_field_of_its_name() {
    for record in records() {
        let csv = header_line() + &rows_of("its study", &record).expect("rows");
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let header = reader.headers().expect("a header").clone();
        let case = &record.case;
        for (line, row) in reader.records().zip(&record.errors) {
            let line = line.expect("a row");
            let at = |name: &str| {
                let place = header.iter().position(|column| column == name);
                line[place.unwrap_or_else(|| panic!("no column {name}"))].to_owned()
            };
            let quickest = record.wall.iter().min_by(|a, b| a.seconds.total_cmp(&b.seconds)).expect("a time");
            for (name, number) in [
                ("time_factor", row.time_factor),
                ("value", row.value),
                ("absolute_error", row.absolute),
                ("steps", record.counters.steps as f64),
                ("point_updates", record.counters.point_updates as f64),
                ("largest_step_seconds", record.step_sizes.largest),
                ("wall_seconds", quickest.seconds),
                ("cpu_seconds", quickest.cpu_seconds.expect("told")),
                ("cells", case.cells as f64),
                ("points_per_cell", 3.0),
                ("cell_size", 2.5 / case.cells as f64),
                ("height", 2.5),
                ("load", 40.0),
                ("youngs_modulus", 3.2e6),
                ("poissons_ratio", 0.22),
                ("porosity", 0.37),
                ("grain_density", 2710.0),
                ("water_density", 1030.0),
                ("water_bulk_modulus", 2.2e9),
                ("hydraulic_conductivity", 4.1e-5),
                ("gravity", 9.7),
            ] {
                let found: f64 = at(name).parse().expect("a number");
                assert!((found / number - 1.0).abs() < 1e-12, "{name}: {found} for {number}");
            }
            for (name, word) in [
                ("study", "its study"),
                ("case", record.hash.as_str()),
                ("quantity", row.quantity.name()),
                ("sample", row.sample.name()),
                ("norm", row.norm.name()),
                ("reference", &row.reference),
                ("scene", "terzaghi"),
                ("status", "ok"),
            ] {
                assert_eq!(at(name), word, "{name}");
            }
        }
    }
}

#[test]
fn times_of_an_attached_run_are_the_least_and_the_median_and_the_processor_s_own() {
    let mut record = records().remove(0);
    record = record.made_outside(crate::record::AttachedRun::default());
    for (sample, own) in record.wall.iter_mut().zip([5.5, 7.5, 6.5]) {
        (sample.own_seconds, sample.peak_memory) = (Some(own), Some(counted(1e6 * own)));
    }
    for (sample, (seconds, cpu)) in record.wall.iter_mut().zip([(3.0, 2.5), (41.0, 40.5), (2.0, 1.5)]) {
        (sample.seconds, sample.cpu_seconds) = (seconds, Some(cpu));
    }
    let table = outside_runs::table(std::slice::from_ref(&record));
    for (header, cell) in [
        ("wall, least", Cell::Measured(2.0)),
        ("wall, median", Cell::Measured(3.0)),
        ("processor", Cell::Measured(2.5)),
        ("memory", Cell::Number(7.5)),
        ("by its own account", Cell::Measured(6.5)),
    ] {
        assert_eq!(*under(&table, 0, header), cell, "{header}");
    }
}

#[test]
fn a_golden_value_that_moved_stands_with_both_values_and_what_it_grew_by() {
    let difference = |golden: Option<f64>, found: Option<f64>| Difference {
        key: crate::golden::measure::key("its case", None, "steps"),
        change: Change::Moved,
        golden,
        found,
        tolerance: 1e-5,
    };
    let table = golden_changes::differences_table(&[difference(Some(0.5), Some(0.25))]);
    for (header, cell) in [
        ("change", Cell::Text("moved".to_owned())),
        ("value", Cell::Text("its case | steps".to_owned())),
        ("golden", Cell::Text("0.5".to_owned())),
        ("now", Cell::Text("0.25".to_owned())),
        ("difference", Cell::Error(-0.25)),
        ("tolerance", Cell::Error(1e-5)),
    ] {
        assert_eq!(*under(&table, 0, header), cell, "{header}");
    }
    let table = golden_changes::differences_table(&[difference(None, Some(0.25))]);
    assert!(matches!(under(&table, 0, "golden"), Cell::Missing(_)));
    assert!(matches!(under(&table, 0, "difference"), Cell::Missing(_)));
}
