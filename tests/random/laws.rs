//! What must hold of any record that ends `ok` without a warning: numbers, physical bounds, and an error that is none
//! of another problem.

use crate::solved::{End, Solved};
use oedometer::scenes::scene::{Body, Clock, LoadKind, Question};
use oedometer::{Basis, Case, Configuration, IntegratorKind, Norm, Quantity, Record, Sample};

/// Something that must hold and does not.
#[derive(Clone, Debug)]
pub struct Violation {
    /// Its name: one of a few.
    pub rule: &'static str,
    /// What was found, and what would hold.
    pub said: String,
}

impl Violation {
    pub fn of(rule: &'static str, said: String) -> Self {
        Self { rule, said }
    }
}

/// All that does not hold of a solved case.
pub fn violations_of(solved: &Solved) -> Vec<Violation> {
    match (&solved.end, &solved.record) {
        (End::Panicked, _) => vec![Violation::of("panic", "it panicked".to_owned())],
        (End::Sound, Some(record)) => {
            let mut found = numbers_are_finite(record);
            found.extend(pressures_are_bounded(record));
            found.extend(settlements_are_bounded(record));
            found.extend(errors_are_bounded(record));
            found
        }
        (End::Impossible(told), _) if told.contains("outside") || told.contains("depth") => {
            vec![Violation::of("false refusal", told.clone())]
        }
        _ => Vec::new(),
    }
}

/// Every number of every field, and every error.
fn numbers_are_finite(record: &Record) -> Vec<Violation> {
    let mut wrong = Vec::new();
    for snapshot in &record.snapshots {
        for (place, samples) in
            [("points", &snapshot.points), ("centres", &snapshot.centres), ("nodes", &snapshot.nodes)]
        {
            for (name, field) in [
                ("pressure", &samples.pressure),
                ("effective stress", &samples.effective_stress),
                ("displacement", &samples.displacement),
                ("volume", &samples.volume),
            ] {
                if let Some(value) = field.iter().find(|value| !value.is_finite()) {
                    wrong.push(format!("{name} {value} at {place}, t = {} s", snapshot.time));
                }
            }
        }
        if !snapshot.settlement.is_finite() {
            wrong.push(format!("settlement {} at t = {} s", snapshot.settlement, snapshot.time));
        }
    }
    if record.snapshots.len() != record.case.time_factors.len() {
        wrong.push(format!("{} states at {} times", record.snapshots.len(), record.case.time_factors.len()));
    }
    wrong.into_iter().map(|said| Violation::of("number", said)).collect()
}

/// Whether the whole pressure of a method locks under a load that keeps the volume: full integration does, and says so
/// in every study of it.
fn may_lock(record: &Record) -> bool {
    let case = &record.case;
    case.scene.body == Body::Layer
        && case.method.built_in().is_some_and(|method| !method.pressure.is_by_cells())
}

fn is_footing(case: &Case) -> bool {
    case.scene.load == LoadKind::Pushed
}

/// Whether skeleton and water keep an inertia that the problem is about.
fn has_waves(record: &Record) -> bool {
    record.case.scene.waves || record.groups.inertia > 1e-3
}

/// Pressure over the load that consolidation or waves can reach.
///
/// Undrained it is at most the load, consolidation makes it less, a wave doubles it where it is thrown back, and a mesh
/// overshoots a front by half. A slab's rises by a fifth; a layer's oscillates under a rough base. Under a plate it is up to
/// 1 + π times the strength, and oscillates by several times of it.
fn pressures_are_bounded(record: &Record) -> Vec<Violation> {
    if may_lock(record) || record.case.scene.motion.is_some() || record.case.scene.question == Question::Rest
    {
        return Vec::new();
    }
    let most = match () {
        () if is_footing(&record.case) => 20.0,
        () if has_waves(record) => 3.0,
        () => 1.6,
    };
    let mut found = Vec::new();
    for snapshot in &record.snapshots {
        let (pressures, _) = snapshot.points.pressures();
        let largest = pressures.iter().fold(0.0, |most: f64, p| most.max(p.abs())) / record.case.column.load;
        if largest > most {
            found.push(Violation::of(
                "pressure",
                format!("a pressure of {largest:.3} loads at t = {:.4e} s: at most {most}", snapshot.time),
            ));
        }
    }
    found
}

/// Settlement over the final one of a column: from nothing to all of it, twice that in a wave.
fn settlements_are_bounded(record: &Record) -> Vec<Violation> {
    let case = &record.case;
    let is_column = case.scene.body == Body::Column;
    if !is_column || !case.scene.is_loaded() {
        return Vec::new();
    }
    let strain = case.column.load / case.material.oedometric_modulus();
    // The softest that a preconsolidated soil and layers may be is the soil that they vary.
    let is_varied = case.scene.clock == Clock::HalfSpace || !case.column.soils.is_empty();
    let whole = case.column.height * if is_varied { strain } else { case.material.law.shrinkage(strain) };
    // Points that cross cells under hats make stresses jump by a quarter of the load.
    let is_hat = case.method.built_in().is_some_and(|method| method.basis == Basis::Hat);
    let jumps = if is_hat && case.configuration() == Configuration::Updated { 0.25 } else { 0.0 };
    // Points out of place make a cell softer by a share of it, and a column of few cells with it.
    let softer = 2.0 * case.column.points.jitter / case.cells as f64;
    let (least, most) = if has_waves(record) { (-0.5, 2.5) } else { (-0.05, 1.1 + jumps + softer) };
    let mut found = Vec::new();
    for snapshot in &record.snapshots {
        let share = snapshot.settlement / whole;
        if !(least..=most).contains(&share) {
            let time = snapshot.time;
            found.push(Violation::of(
                "settlement",
                format!("a settlement of {share:.4} of the final one at t = {time:.4e} s: {least} to {most}"),
            ));
        }
    }
    found
}

/// The largest error of pressure and settlement, over load and final settlement, that a situation explains; none where
/// it explains any.
fn explained_error(record: &Record) -> Option<f64> {
    let case = &record.case;
    let points = &case.column.points;
    if case.cells < 16
        || may_lock(record)
        || case.scene.motion.is_some()
        || case.scene.question == Question::Rest
    {
        return None;
    }
    // What numerical viscosity does is FLIP's business: a share of one percent shows.
    if case.settings.flip < 1.0 || (has_waves(record) && !case.scene.waves) {
        return None;
    }
    let method = case.method.built_in()?;
    let mut most = if method.recovery.name() == "patch" { 0.05 } else { 0.12 };
    // A front within its first way through the column; steps of first order; what runs longer has another phase.
    if case.scene.waves {
        let soil = &case.material;
        let density = (1.0 - soil.porosity) * soil.grain_density + soil.porosity * soil.water_density;
        let speed = ((soil.oedometric_modulus() + soil.water_bulk_modulus / soil.porosity) / density).sqrt();
        let last = case.seconds_per_time_factor() * case.time_factors.last()?;
        // A projection that stores more than the water slows its waves, and the study is warned.
        if last * speed > 2.0 * case.column.height || method.has_projection() {
            return None;
        }
        most = 0.5;
        // Steps of first order in the pressure damp waves, and u-p has no waves of the water against the skeleton: what
        // is left out is of the size of the load (docs/scenes.md), and of twice the final settlement, that of a wave.
        if case.formulation.name() == "u-p" {
            most = 2.1;
        } else if case.integrator == IntegratorKind::SemiImplicit {
            most = 1.1;
        }
    }
    if case.integrator == IntegratorKind::SemiImplicit {
        most += 0.1;
    }
    let configuration = case.configuration();
    if configuration == Configuration::Updated && matches!(method.basis, Basis::Hat | Basis::Ugimp) {
        return None;
    }
    if points.has_two_sets() {
        most += 0.1;
    }
    // Soils that differ by a factor of a thousand beside each other: a patch that looks across the interface, and a layer of
    // two cells.
    if !case.column.soils.is_empty() {
        most += 0.15;
    }
    // Rows off their lattice by a share of their spacing: an error of that share which no mesh removes.
    most += 2.0 * points.jitter.abs() + 0.5 * points.offset.abs() + 0.1 * (1.0 - points.filling);
    Some(most)
}

fn errors_are_bounded(record: &Record) -> Vec<Violation> {
    let Some(most) = explained_error(record) else { return Vec::new() };
    let Some(own) = record.references.first().filter(|own| own.does_not_hold.is_none()) else {
        return Vec::new();
    };
    let first = 4.0 / (record.case.cells * record.case.cells) as f64;
    let judged = |quantity, sample, norm| match quantity {
        Quantity::Pressure => sample == Sample::Points && norm == Norm::L2,
        Quantity::Settlement => true,
        _ => false,
    };
    let rows = record.errors.iter().filter(|row| {
        row.reference == own.name
            && (row.time_factor >= first || record.case.scene.waves)
            && judged(row.quantity, row.sample, row.norm)
    });
    rows.filter(|row| row.absolute.is_nan() || row.absolute.abs() > most)
        .map(|row| {
            Violation::of(
                "error",
                format!(
                    "an error of {:.3} in the {} at T_v = {:e}: its situation explains {most:.3}",
                    row.absolute,
                    row.quantity.name(),
                    row.time_factor
                ),
            )
        })
        .collect()
}
