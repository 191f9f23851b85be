//! Columns at 30 to 50 % strain whose implicit steps are halved three times: none leaves the exact solution in silence.

use crate::laws::Violation;
use crate::numbers::Numbers;
use crate::options::Options;
use crate::solved::{End, Solved};
use oedometer::{Method, Norm, Quantity, Record, Sample};

/// Error over load or final settlement that a halved step may add to twice that of the first.
const MORE: f64 = 0.02;

/// The column of an index, with its first step.
pub fn drawn(seed: u64, index: u64) -> Options {
    let numbers = &mut Numbers::of(seed.wrapping_add(7), index);
    let methods: Vec<String> = Method::names().into_iter().filter(|name| !name.contains("uG")).collect();
    let mut options = Options {
        scene: "xie-leo",
        // Updated B-bar with a patch, which once grew, more often than the others.
        method: if numbers.chance(0.3) {
            numbers.one_of(&["GC-Bbar-patch", "GIMP-Bbar-patch"]).to_owned()
        } else {
            methods[numbers.count(0, methods.len() - 1)].clone()
        },
        integrator: "implicit",
        cells: numbers.one_of(&[16, 24, 32, 48]),
        points_per_cell: numbers.count(2, 4),
        time_step: Some(("growth", 0.04)),
        time_factors: vec![0.05, 0.2, 1.0],
        ..Options::default()
    };
    let strain = options.set_rounded("column.strain", numbers.between(0.3, 0.5));
    // 0.2 more than what is pressed out.
    options.set_rounded("material.porosity", strain + 0.2);
    if numbers.chance(0.5) {
        options.set_rounded("column.loading_time", numbers.between(2.0, 20.0));
    }
    options
}

/// Largest error of the cells' pressures over the load, and of the settlement over the final one.
fn largest_error(record: &Record) -> f64 {
    let reference = record.case.scene.references.first().map_or("", |own| own.kind.name());
    let own = |name: &str| name == "large-strain" || name == reference;
    let rows = record.errors.iter().filter(|row| own(&row.reference));
    let judged = rows.filter(|row| match row.quantity {
        Quantity::Pressure => row.sample == Sample::Centres && row.norm == Norm::L2,
        quantity => quantity == Quantity::Settlement,
    });
    judged.fold(0.0, |most: f64, row| {
        if row.absolute.abs() > most || row.absolute.is_nan() { row.absolute.abs() } else { most }
    })
}

/// What its halved steps come to: where they end without a warning, their error is at most twice that of the first.
pub fn held(options: &Options) -> (String, Vec<Violation>) {
    let (mut first, mut violations, mut kind) = (f64::NAN, Vec::new(), "all warned".to_owned());
    for halvings in 0..4 {
        let growth = 0.04 / f64::from(1 << halvings);
        let solved = Solved::of(&Options { time_step: Some(("growth", growth)), ..options.clone() });
        let (End::Sound, Some(record)) = (&solved.end, &solved.record) else { continue };
        let error = largest_error(record);
        if first.is_nan() {
            first = error;
            "steps halved".clone_into(&mut kind);
        }
        let stays = error <= 2.0 * first + MORE;
        if !stays {
            let said = format!("an error of {error:.3} with growth={growth}, {first:.3} with longer steps");
            violations.push(Violation::of("halved steps", said));
        }
    }
    (kind, violations)
}
