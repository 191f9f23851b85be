//! Pairs of cases that theory makes equal: two kernels, two dimensions, two formulations, two units of length.

use crate::draw::{self, Soil};
use crate::laws::Violation;
use crate::numbers::Numbers;
use crate::options::{Options, rounded};
use crate::solved::{End, Solved};
use oedometer::{Kernel, Record};
use oedometer_scenes::scene::Question;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Point by point, and as one sparse map.
    Kernels,
    /// In one dimension on the start lattice GIMP's weights are the hat's, whatever the domains follow.
    HatAndGimp,
    /// There constant recovery from the cells is full integration.
    CellsAndPoints,
    /// A column in the plane, and in one dimension.
    Dimensions,
    /// Weights on the initial configuration at a strain of nothing, and points that stay.
    TotalAndFrozen,
    /// Metres, seconds and kilograms of another size: powers of two, so that no digit is rounded otherwise.
    Units,
    /// A load of a quarter of the size in a linear soil.
    Load,
    /// Layers of one soil, and that soil.
    Layers,
}

const RELATIONS: [Relation; 8] = [
    Relation::Kernels,
    Relation::HatAndGimp,
    Relation::CellsAndPoints,
    Relation::Dimensions,
    Relation::TotalAndFrozen,
    Relation::Units,
    Relation::Load,
    Relation::Layers,
];

/// A pair.
pub struct Related {
    pub relation: Relation,
    pub base: Options,
    other: Options,
}

/// The pair of an index.
pub fn drawn(seed: u64, index: u64) -> Related {
    let numbers = &mut Numbers::of(!seed, index);
    let relation = numbers.one_of(&RELATIONS);
    // Draws until one fits: most do.
    for attempt in 0.. {
        let base = draw::drawn(!seed, index.wrapping_mul(1000) + attempt);
        if let Some((base, other)) = pair(relation, base, numbers) {
            return Related { relation, base, other };
        }
    }
    unreachable!("some case fits every relation")
}

/// The pair that a relation makes of a drawn case, where it fits.
fn pair(relation: Relation, mut base: Options, numbers: &mut Numbers) -> Option<(Options, Options)> {
    let is_small = !matches!(base.scene, "xie-leo" | "footing") && !base.scene.starts_with("manufactured");
    let is_column = !base.scene.starts_with("manufactured")
        && !matches!(base.scene, "cosine-layer" | "mandel" | "footing");
    let is_line = is_column && base.value("column.dimensions").is_none();
    let is_lattice = ["points.jitter", "points.offset", "points.filling", "points.sets"]
        .iter()
        .all(|key| base.value(key).is_none());
    let bare =
        !base.method.starts_with("TL-") && !base.method.starts_with('u') && !base.method.ends_with("-cells");
    let has_weight = base.value("column.self_weight").is_some();
    let mut other = base.clone();
    let deforms = base.scene == "xie-leo" || !bare;
    // Steps by an estimated error are taken or not by its last digit.
    let has_same_steps = !matches!(base.time_step, Some(("tolerance", _)));
    let fits = match relation {
        Relation::Kernels => is_small && bare && base.integrator == "explicit",
        Relation::HatAndGimp => {
            "MPM".clone_into(&mut base.method);
            "GIMP".clone_into(&mut other.method);
            is_small && is_line && is_lattice
        }
        Relation::CellsAndPoints => {
            "GIMP".clone_into(&mut base.method);
            "GIMP-SRI".clone_into(&mut other.method);
            // In a cell that an interface cuts, points of several soils differ.
            let fits = is_line && is_lattice && base.value("column.soils").is_none();
            is_small && fits && (has_same_steps || base.scene != "yield-front")
        }
        Relation::Dimensions => {
            let height: f64 = base.number("column.height").unwrap_or(1.0);
            take_seconds(&mut base, height);
            other = base.clone();
            other.set("column.dimensions", 2);
            let across = numbers.count(1, 3);
            other.set_number("column.width", across as f64 * base.cell_size(height));
            for options in [&mut base, &mut other] {
                strain_by(options, 1e-6);
            }
            // B-bar shares a volume out among the directions that there are, cells that remember fit their parabolas
            // over them: other methods in each dimension.
            let is_same = !(deforms && (base.method.contains("Bbar") || base.method.ends_with("-cells")));
            // Off the lattice, where points move too, and in a cell that an interface cuts, a cell of the plane beside
            // another feels slopes of its pressures along the height, by forces across it: one of a line does not, and
            // filters them.
            let has_slopes = !(is_lattice && is_small) || base.value("column.soils").is_some();
            let is_same = is_same && !(has_slopes && base.method.ends_with("null-space"));
            // The chord mean gives way to the node's own mobility where round-off hides its slope.
            let is_same = is_same && !(deforms && base.value("material.conductivity_mean") == Some("chord"));
            // One point integrates no shear of a plane's cell: without it nodes go to and fro beside each other, and where
            // points move a lattice does not stay one.
            let is_held = base.points_per_cell > 1 || (is_lattice && is_small);
            // Points do not integrate the slopes of splines exactly: at a side wall forces across remain, less with more
            // points per cell (`B2` with 2, 4, 8 on a column of 13 cells: 62 %, 3.2 %, 0.2 % apart).
            let is_exact = !base.method.trim_start_matches("TL-").starts_with('B');
            is_line && is_same && is_exact && is_held && base.cells <= 12 && has_same_steps
        }
        Relation::TotalAndFrozen => {
            other.method = format!("TL-{}", base.method);
            for options in [&mut base, &mut other] {
                strain_by(options, 1e-6);
            }
            is_small
                && bare
                && base.scene != "mandel"
                && base.scene != "at-rest"
                && !has_weight
                && has_same_steps
        }
        Relation::Units => {
            rescale(&mut other, numbers);
            // A footing leaves a part of its soil to the scene, in the scene's units.
            Soil::of(&base).is_some() && base.value("column.soils").is_none()
        }
        Relation::Load => {
            for key in ["column.load", "layer.load"] {
                if let Some(load) = base.number(key) {
                    other.set_number(key, 0.25 * load);
                }
            }
            let yields = base.scene == "yield-front";
            is_small && bare && !yields && base.scene != "at-rest" && !has_weight
        }
        Relation::Layers => {
            split_in_layers(&mut base, &mut other, numbers);
            let takes_layers = matches!(base.scene, "terzaghi" | "xie-leo");
            // A patch that keeps to the soil of its point keeps to the layer, whatever the soils are.
            let looks_across = !base.method.contains("patch-soils");
            // Off the lattice, and under splines, the start of layers is balanced, and that of one soil is as its formula
            // says.
            let is_exact = is_lattice && !["B2", "B3"].iter().any(|splines| base.method.contains(splines));
            takes_layers && is_exact && looks_across && !has_weight && base.value("column.soils").is_none()
        }
    };
    fits.then_some((base, other))
}

/// Makes two layers of the soil of a case, which takes the same steps.
fn split_in_layers(base: &mut Options, other: &mut Options, numbers: &mut Numbers) {
    let height = base.number("column.height").unwrap_or(1.0);
    // The stable step is of a formula for one soil, and of the step's own eigenvalues for layers.
    take_seconds(base, height);
    other.time_step = base.time_step;
    if base.scene == "terzaghi" {
        other.scene = "layered";
    }
    let lower = rounded(height * numbers.between(0.1, 0.9));
    other.set("column.soils", format!("[{{thickness={lower:e}}},{{thickness={:e}}}]", height - lower));
}

/// The pair that a relation makes of the case of a command.
///
/// # Panics
/// Where the relation is unknown or does not fit the case.
pub fn named(relation: &str, base: Options) -> Related {
    let relation = RELATIONS.into_iter().find(|one| format!("{one:?}") == relation);
    let relation = relation.unwrap_or_else(|| panic!("no relation is named so: {}", base.command()));
    let numbers = &mut Numbers::of(0, 0);
    let (base, other) = pair(relation, base, numbers).expect("it fits");
    Related { relation, base, other }
}

/// Steps in seconds for explicit skeletons, where the critical step of the other case differs.
fn take_seconds(options: &mut Options, height: f64) {
    let cell = height / options.cells as f64;
    let (Some(soil), Some((_, share))) = (Soil::of(options), options.time_step) else { return };
    let limit = match options.integrator {
        "explicit" => soil.explicit_step(cell, options.value("integrator.drag") == Some("explicit")),
        "semi-implicit" => soil.skeleton_step(cell),
        _ => return,
    };
    options.time_step = Some(("seconds", rounded(0.5 * share * limit)));
}

/// A load that strains a small-strain scene by so much: of far less, positions and volumes have no digits.
fn strain_by(options: &mut Options, strain: f64) {
    if let Some(soil) = Soil::of(options).filter(|_| !matches!(options.scene, "xie-leo" | "yield-front")) {
        let key = if options.scene == "cosine-layer" { "layer.load" } else { "column.load" };
        options.set_rounded(key, strain * soil.oedometric_modulus());
    }
}

/// The same problem in other units: lengths, times and masses by powers of two.
fn rescale(options: &mut Options, numbers: &mut Numbers) {
    let power = |numbers: &mut Numbers| 2_f64.powi(i32::try_from(numbers.count(0, 4)).expect("small") - 2);
    let (length, time, mass) = (power(numbers), power(numbers), power(numbers));
    let stress = mass / (length * time * time);
    let density = mass / (length * length * length);
    for (key, factor) in [
        ("column.height", length),
        ("column.width", length),
        ("layer.height", length),
        ("layer.length", length),
        ("column.load", stress),
        ("layer.load", stress),
        ("layer.plate_width", length),
        ("column.initial_stress", stress),
        ("material.reload_modulus", stress),
        ("material.preconsolidation", stress),
        ("material.undrained_strength", stress),
        ("material.youngs_modulus", stress),
        ("material.water_bulk_modulus", stress),
        ("material.grain_density", density),
        ("material.water_density", density),
        ("material.hydraulic_conductivity", length / time),
        ("material.gravity", length / (time * time)),
    ] {
        if let Some(value) = options.number(key) {
            options.set_number(key, factor * value);
        }
    }
    if let Some(("seconds", seconds)) = options.time_step {
        options.time_step = Some(("seconds", time * seconds));
    }
}

/// Difference over load and final settlement that rounding explains.
fn tolerance(related: &Related) -> f64 {
    // A pressure is the water's stiffness times strains that cancel.
    let stiffness = Soil::of(&related.base).map_or(1.0, |soil| soil.stiffness_ratio());
    let round_off = 1e-6 + 1e5 * f64::EPSILON * stiffness;
    // Inertia of an implicit step divides differences of positions by its square.
    let has_inertia =
        related.base.integrator == "implicit" && related.base.value("integrator.formulation").is_some();
    let round_off = if has_inertia { 100.0 * round_off } else { round_off };
    // Soils of several moduli beside each other: strains of the soft one make stresses of the stiff one.
    let round_off = if related.base.value("column.soils").is_some() { 10.0 * round_off } else { round_off };
    match related.relation {
        Relation::Units | Relation::Load => 1e-8,
        // The curve of a standing wave is a share of what is left of it in the end.
        Relation::TotalAndFrozen if related.base.scene == "standing-wave" => 1e-2 + round_off,
        // Strains of 1e-6 over the share of a stiff skeleton's shear, and Newton's tolerance in every step.
        Relation::TotalAndFrozen => 1e-3 + round_off,
        _ => round_off,
    }
}

/// Solves both and compares them.
pub fn held(related: &Related) -> (String, Vec<Violation>) {
    let Related { relation, base, other } = related;
    let one = Solved::of(base);
    if !matches!(one.end, End::Sound | End::Warned(_)) {
        return (one.end.kind(), Vec::new());
    }
    let second = match relation {
        Relation::Kernels => Solved::by(base, Kernel::PointWise),
        _ => Solved::of(other),
    };
    let kind = format!("{relation:?}");
    let with = if *relation == Relation::Kernels { "--point-wise".to_owned() } else { other.command() };
    let violation =
        |said: String| vec![Violation::of("relation", format!("{relation:?}: {said}; with\n    {with}"))];
    match (&one.record, &second.record, &second.end) {
        (Some(a), Some(b), End::Sound | End::Warned(_)) => {
            let (difference, what) = largest_difference(a, b);
            if difference <= tolerance(related) {
                (kind, Vec::new())
            } else {
                (kind, violation(format!("{what} differs by {difference:.2e}")))
            }
        }
        (_, _, End::Refused(_) | End::TooLong) => (second.end.kind(), Vec::new()),
        // One of two may be nearer to the end of its pores or of Newton's patience, and says so.
        (_, _, End::Failed(why))
            if base.scene == "xie-leo"
                || *relation == Relation::TotalAndFrozen
                || why.starts_with("not-converged") =>
        {
            (second.end.kind(), Vec::new())
        }
        (_, _, end) => (kind, violation(format!("the second ends {end:?}"))),
    }
}

/// Largest difference of any error and of any state, over load and final settlement, and where it is.
fn largest_difference(a: &Record, b: &Record) -> (f64, String) {
    let mut largest = (0.0, String::new());
    let mut see = |difference: f64, what: String| {
        if difference.is_nan() || difference > largest.0 {
            largest = (difference, what);
        }
    };
    // What is a share of the load is known to a share of the weight, where the weight acts and is more.
    let scale = a.case.column.load / load_of(a);
    for row in &a.errors {
        let same = b.errors.iter().find(|other| {
            (other.quantity, other.sample, other.norm) == (row.quantity, row.sample, row.norm)
                && other.reference == row.reference
                && (other.time_factor / row.time_factor - 1.0).abs() < 1e-12
        });
        // Layers are compared with another reference than one soil.
        let unmatched = if a.case.column.soils.is_empty() == b.case.column.soils.is_empty() {
            f64::INFINITY
        } else {
            0.0
        };
        let difference = same.map_or(unmatched, |same| scale * (same.absolute - row.absolute).abs());
        let (quantity, sample) = (row.quantity.name(), row.sample.name());
        see(difference, format!("the error of the {quantity} at {sample}, T_v = {:e},", row.time_factor));
    }
    for (index, (one, other)) in states(a).into_iter().zip(states(b)).enumerate() {
        for (what, one, other) in [("settlement", one.0, other.0), ("largest pressure", one.1, other.1)] {
            see((one - other).abs(), format!("the {what} at output {index}"));
        }
    }
    let same_nodes = a.case.column.dimensions == b.case.column.dimensions;
    for (what, one, other) in
        shares(a).into_iter().zip(shares(b)).map(|((what, one), (_, other))| (what, one, other))
    {
        // The largest force on a node is another share of the load where its cells lie on one side alone.
        if what.starts_with("unbalanced force") && !same_nodes {
            continue;
        }
        // A force that rounding leaves is a share of no load.
        see((scale * (one - other).abs()).min(relative(one, other)), format!("the {what}"));
    }
    see((a.snapshots.len() as f64 - b.snapshots.len() as f64).abs(), "the number of outputs".to_owned());
    largest
}

/// The load, Pa, or the weight where that acts and is more.
fn load_of(record: &Record) -> f64 {
    let case = &record.case;
    let weight = case.material.grain_density * case.material.gravity * case.column.height;
    let has_weight = case.column.self_weight || case.scene.question == Question::Rest;
    if has_weight { case.column.load.max(weight) } else { case.column.load }
}

/// Settlement over `m_v q H`, and the largest pressure over the load, at every output.
fn states(record: &Record) -> Vec<(f64, f64)> {
    let (case, load) = (&record.case, load_of(record));
    let whole = load / case.material.oedometric_modulus() * case.column.height;
    let of = |snapshot: &oedometer::Snapshot| {
        let largest = snapshot.points.pressures().0.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        (snapshot.settlement / whole, largest / load)
    };
    record.snapshots.iter().map(of).collect()
}

/// Difference of two numbers over the larger one.
fn relative(one: f64, other: f64) -> f64 {
    (one - other).abs() / one.abs().max(other.abs()).max(f64::MIN_POSITIVE)
}

/// What a record tells beside errors that has no unit: the settlement curve, balances, the start.
fn shares(record: &Record) -> Vec<(String, f64)> {
    let curve = record
        .history
        .iter()
        .map(|row| (format!("settlement curve at T_v = {:e}", row.time_factor), row.degree_of_consolidation));
    let balances = record.balance.iter().flat_map(|balance| {
        let when = balance.time_factor;
        [
            (format!("water balance at T_v = {when:e}"), balance.water_imbalance),
            (format!("gap of the settlement curve at T_v = {when:e}"), balance.settlement_curve_gap),
            (format!("equilibrium residual at T_v = {when:e}"), balance.equilibrium_residual),
        ]
    });
    let start = record.start.iter().flat_map(|start| {
        [
            ("volume at the start".to_owned(), start.volume_error),
            ("unbalanced force at the start".to_owned(), start.unbalanced_force),
        ]
    });
    curve.chain(balances).chain(start).collect()
}
