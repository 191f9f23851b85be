//! Tables, figures and exports of a report made from stored records in which every number is another one: each cell has the
//! number of the method, mesh, time, quantity and reference that its row and column name.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counters made of distinct numbers"
)]

use crate::program::call;
use oedometer::{Record, RecordStore, RunOptions, Study, StudySource, Tier, run_study};
use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use tempfile::TempDir;

/// A column in which no number is one, on meshes of unequal ratios, at three times.
const STUDY: &str = r#"title = "Distinct"
scene = "terzaghi"
column = { height = 2.5, load = 40.0 }

[material]
youngs_modulus = 3.2e6
poissons_ratio = 0.22
porosity = 0.37
grain_density = 2710.0
water_density = 1030.0
hydraulic_conductivity = 4.1e-5
gravity = 9.7

[output]
time_factors = [0.02, 0.07, 0.3]

[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [5, 8, 10, 23]
points_per_cell = [3]
"#;
const HEIGHT: f64 = 2.5;
const LAST: f64 = 0.3;

/// Another study, so that there is a front page.
const OTHER: &str = r#"title = "Other"
scene = "terzaghi"
output.time_factors = [0.1]

[[sweep]]
method = ["MPM"]
integrator = ["implicit"]
cells = [3]
"#;

/// What a report calls a quantity at its places, and what records call them.
const QUANTITIES: [(&str, &str, &str, &str); 4] = [
    ("pore pressure at the points", "pressure", "points", "l2"),
    ("pore pressure at the cell centres", "pressure", "centres", "l2"),
    ("effective stress at the points", "effective_stress", "points", "l2"),
    ("settlement of the surface", "settlement", "surface", "relative"),
];

/// Numbers that are all different.
struct Distinct(f64);

impl Distinct {
    fn next(&mut self) -> f64 {
        self.0 += 1.0;
        1.0 + self.0 / 997.0 + 1.0 / (self.0 + 7.0)
    }
}

fn records_of(name: &str, text: &str) -> Vec<Record> {
    let source = StudySource { name: format!("{name}.toml"), text: text.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {}).records
}

/// Records of the column with errors of `c h^p (1 + 0.4 h)`, `c` and `p` of their own for every method and row.
fn distinct_records() -> Vec<Record> {
    let mut records = records_of("distinct", STUDY);
    let mut numbers = Distinct(0.0);
    for record in &mut records {
        let h = HEIGHT / record.case.cells as f64;
        let of_method = if record.case.method.to_string() == "MPM" { 0.0 } else { 41.0 };
        for (place, row) in record.errors.iter_mut().enumerate() {
            let k = of_method + place as f64;
            let error = (0.03 + 3e-4 * k) * h.powf(1.3 + 0.011 * k) * (1.0 + 0.4 * h);
            row.value = error.copysign(row.value);
            row.absolute = (0.31 + 1e-3 * k) * row.value;
        }
        record.counters.steps = (1e3 * numbers.next()) as u64;
        record.counters.point_updates = (1e6 * numbers.next()) as u64;
        let groups = &mut record.groups;
        for group in [&mut groups.storage, &mut groups.finite_strain, &mut groups.inertia] {
            *group = 1e-5 * numbers.next();
        }
        let start = record.start.as_mut().expect("a start");
        for value in
            [&mut start.volume_error, &mut start.undrained_pressure_error, &mut start.unbalanced_force]
        {
            *value = 1e-10 * numbers.next();
        }
        for balance in &mut record.balance {
            for value in [
                &mut balance.solid_mass_drift,
                &mut balance.water_imbalance,
                &mut balance.internal_force_imbalance,
                &mut balance.settlement_curve_gap,
                &mut balance.equilibrium_residual,
            ] {
                *value = 1e-10 * numbers.next();
            }
        }
    }
    records
}

/// A report of both, made once, and the records of the first.
struct Reported {
    folder: TempDir,
    records: Vec<Record>,
}

static REPORTED: LazyLock<Reported> = LazyLock::new(|| {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let (records, others) = (distinct_records(), records_of("other", OTHER));
    for (name, text, records) in [("distinct", STUDY, &records), ("other", OTHER, &others)] {
        fs::write(at.join(format!("{name}.toml")), text).expect("a file");
        let store = RecordStore::new(&at.join("res"), name);
        for record in records {
            store.write(record).expect("written");
        }
    }
    let told = call(
        at,
        &[
            "report",
            "distinct.toml",
            "other.toml",
            "--from-records",
            "--records",
            "res",
            "--golden",
            "none",
            "--out",
            "rep",
        ],
    );
    assert_eq!(told.code, 0, "{}", told.err);
    Reported { folder, records }
});

impl Reported {
    fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join("rep").join(name)
    }

    fn record(&self, method: &str, cells: usize) -> &Record {
        let mut meant = self
            .records
            .iter()
            .filter(|record| record.case.method.to_string() == method && record.case.cells == cells);
        meant.next().unwrap_or_else(|| panic!("no record of {method} on {cells} cells"))
    }

    /// Size of an error of a method on a mesh.
    fn error(&self, method: &str, cells: usize, label: &str, reference: &str, time_factor: f64) -> f64 {
        let (_, quantity, sample, norm) =
            QUANTITIES.iter().find(|named| named.0 == label).unwrap_or_else(|| panic!("no {label}"));
        let rows = &self.record(method, cells).errors;
        let row = rows.iter().find(|row| {
            (row.quantity.name(), row.sample.name(), row.norm.name()) == (*quantity, *sample, *norm)
                && row.reference == reference
                && row.time_factor == time_factor
        });
        row.unwrap_or_else(|| panic!("no {label} against {reference}")).value.abs()
    }

    /// Errors of a method on meshes of these numbers of cells.
    fn errors(
        &self,
        method: &str,
        cells: &[usize],
        label: &str,
        reference: &str,
        time_factor: f64,
    ) -> Vec<f64> {
        cells.iter().map(|cells| self.error(method, *cells, label, reference, time_factor)).collect()
    }
}

const CELLS: [usize; 4] = [5, 8, 10, 23];

/// Header and rows of a table of a report.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader =
        csv::Reader::from_path(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let fields = |row: &csv::StringRecord| row.iter().map(str::to_owned).collect::<Vec<_>>();
    let header = fields(reader.headers().expect("a header"));
    (header, reader.records().map(|row| fields(&row.expect("a row"))).collect())
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("`{text}` is not a number"))
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{what}: {found} for {expected}");
}

/// Slope of a line through logarithms, and half of its 95 % interval where there are four points (`t` of two degrees of
/// freedom: 4.302652730).
fn slope(cells: &[usize], errors: &[f64]) -> (f64, f64) {
    let x: Vec<f64> = cells.iter().map(|cells| (HEIGHT / *cells as f64).ln()).collect();
    let y: Vec<f64> = errors.iter().map(|error| error.ln()).collect();
    let n = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let sxx: f64 = x.iter().map(|x| (x - mx) * (x - mx)).sum();
    let slope = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>() / sxx;
    let rest: f64 = x.iter().zip(&y).map(|(x, y)| (y - my - slope * (x - mx)).powi(2)).sum();
    (slope, 4.302_652_729_696_142 * (rest / (n - 2.0) / sxx).sqrt())
}

#[test]
fn refinement_tables_have_the_errors_and_orders_of_the_last_output() {
    let reported = &*REPORTED;
    for path in ["studies/tables/distinct-convergence.csv", "tables/answers-convergence.csv"] {
        let (header, rows) = table(&reported.path(path));
        assert_eq!(header[2..7], ["5 cells", "8", "10", "23", "order"], "{path}");
        assert_eq!(rows.len(), 2 * 3, "{path}");
        let mut orders = 0;
        for row in rows {
            let is_of = |one: &&(&str, &str, &str, &str)| one.0.starts_with(&row[1]) && one.2 != "centres";
            let quantity = QUANTITIES.iter().find(is_of).expect("a quantity").0;
            let errors = reported.errors(&row[0], &CELLS, quantity, "terzaghi", LAST);
            let what = format!("{path}: {} {}", row[0], row[1]);
            for (cell, error) in row[2..6].iter().zip(&errors) {
                assert_near(number(cell), *error, 1e-12, &what);
            }
            // A word where the order is not settled.
            if let Ok(told) = row[6].parse::<f64>() {
                assert_near(told, slope(&CELLS[1..], &errors[1..]).0, 1e-9, &what);
                orders += 1;
            }
        }
        assert!(orders >= 2, "{path}: {orders} orders");
    }
}

#[test]
fn figures_over_the_mesh_have_the_points_of_their_cases() {
    let reported = &*REPORTED;
    let mut seen = 0;
    for (label, quantity, sample, _) in QUANTITIES {
        let name = format!("studies/figures/distinct-cells-{quantity}-{sample}.csv");
        let (_, rows) = table(&reported.path(&name));
        assert_eq!(rows.len(), 2 * CELLS.len());
        for (place, row) in rows.iter().enumerate() {
            let cells = CELLS[place % CELLS.len()];
            assert_near(number(&row[1]), HEIGHT / cells as f64, 1e-12, label);
            let error = reported.error(&row[0], cells, label, "terzaghi", LAST);
            assert_near(number(&row[2]), error, 1e-12, &format!("{label} {}", row[0]));
            seen += 1;
        }
    }
    assert_eq!(seen, 32);
}

#[test]
fn checks_are_the_worst_of_all_runs() {
    let reported = &*REPORTED;
    let (_, rows) = table(&reported.path("studies/tables/distinct-checks.csv"));
    let worst = |value: &dyn Fn(&Record) -> Vec<f64>| {
        reported.records.iter().flat_map(value).fold(0.0, |worst: f64, value| worst.max(value.abs()))
    };
    let start = |value: fn(&oedometer::Record) -> f64| worst(&move |record: &Record| vec![value(record)]);
    let at_outputs = |name: &str| {
        worst(&|record: &Record| {
            record
                .balance
                .iter()
                .map(|balance| match name {
                    "mass of solids, drift" => balance.solid_mass_drift,
                    "water-mass error / expelled water" => balance.water_imbalance,
                    "sum of internal forces, relative" => balance.internal_force_imbalance,
                    "final settlement against settlement curve" => balance.settlement_curve_gap,
                    _ => balance.equilibrium_residual,
                })
                .collect()
        })
    };
    let mut seen = 0;
    for row in rows {
        let expected = match &*row[0] {
            "points missing at the start" => continue,
            "volume at the start, relative error" => start(|one| one.start.expect("a start").volume_error),
            "undrained pressure at the start, relative error" => {
                start(|one| one.start.expect("a start").undrained_pressure_error)
            }
            "unbalanced force at the start, over the load" => {
                start(|one| one.start.expect("a start").unbalanced_force)
            }
            "largest pressure, over the load" => worst(&|record: &Record| {
                let judged = record.balance.iter().filter_map(|one| record.snapshot(one.time_factor));
                judged.flat_map(|one| one.points.pressures().0).map(|p| p / record.case.column.load).collect()
            }),
            name if name.starts_with("storage") => start(|one| one.groups.storage),
            name if name.starts_with("finite strain") => start(|one| one.groups.finite_strain),
            name if name.starts_with("inertia") => start(|one| one.groups.inertia),
            name => at_outputs(name),
        };
        assert_near(number(&row[1]), expected, 1e-12, &row[0]);
        seen += 1;
    }
    assert_eq!(seen, 12);
}

#[test]
fn printed_profiles_histories_and_rows_are_those_of_the_records() {
    let reported = &*REPORTED;
    let at = reported.folder.path();
    let rows_of = |arguments: &[&str]| -> Vec<csv::StringRecord> {
        let told = call(at, arguments);
        assert_eq!(told.code, 0, "{}", told.err);
        csv::Reader::from_reader(told.out.as_bytes()).records().map(|row| row.expect("a row")).collect()
    };
    let of = |hash: &str| {
        let mut meant = reported.records.iter().filter(|record| record.hash == hash);
        meant.next().expect("a record of that hash")
    };
    let profiles = rows_of(&["records", "res/distinct", "--profiles"]);
    let places: usize = CELLS.iter().map(|cells| 3 * cells + cells + cells + 1).sum();
    assert_eq!(profiles.len(), 2 * 3 * places);
    let mut next = std::collections::HashMap::new();
    for row in &profiles {
        let record = of(&row[0]);
        let snapshot = record.snapshot(number(&row[1])).expect("an output");
        assert_near(number(&row[2]), snapshot.time, 1e-15, "time");
        let samples = match &row[3] {
            "points" => &snapshot.points,
            "centres" => &snapshot.centres,
            _ => &snapshot.nodes,
        };
        let place: &mut usize =
            next.entry((row[0].to_owned(), row[1].to_owned(), row[3].to_owned())).or_default();
        let heights = samples.displacement_height.as_ref().unwrap_or(&samples.initial_height);
        for (column, field) in [
            (5, &samples.initial_height),
            (6, &samples.pressure),
            (7, &samples.effective_stress),
            (8, heights),
            (9, &samples.displacement),
        ] {
            assert_eq!(number(&row[column]), field[*place], "column {column} of {row:?}");
        }
        *place += 1;
    }
    let history = rows_of(&["records", "res/distinct", "--history"]);
    let mut next = std::collections::HashMap::new();
    for row in &history {
        let place: &mut usize = next.entry(row[0].to_owned()).or_default();
        let meant = &of(&row[0]).history[*place];
        assert_eq!([number(&row[1]), number(&row[2])], [meant.time_factor, meant.degree_of_consolidation]);
        *place += 1;
    }
    assert_eq!(history.len(), reported.records.iter().map(|record| record.history.len()).sum::<usize>());
}
