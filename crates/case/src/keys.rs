//! The inputs of a case by the keys of study files: one table.
//!
//! What a key means, its unit, its range and its place in a case stand here once. Parsing, checks, sweeps,
//! selections of expectations, the JSON Schema and the columns of tables follow from it.

use crate::{Case, SolverName};
use oedometer_exact::parameters::{Base, Drainage};
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::settings::Drag;
use oedometer_problem::settings::Scheme;
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::{Shape, Undrained};
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;
use std::fmt;

/// More cells than a column is ever given on purpose.
pub const MOST_CELLS: i64 = 100_000;
/// More points per cell and direction than any scheme uses.
pub const MOST_POINTS: i64 = 16;

/// One input of a case.
pub struct Key {
    /// Name in study files.
    pub name: &'static str,
    /// Tables of a study file that take it. What a `sweep` takes, expectations may name too.
    pub tables: &'static [&'static str],
    /// What values it takes.
    pub kind: Kind,
    /// Unit of a number, empty where it has none.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// The key that it gives in other words and stands in the place of, empty of most: a case has the other.
    pub in_place_of: &'static str,
    get: fn(&Case) -> Value,
    set: fn(&mut Case, Value),
}

/// What values a key takes.
#[derive(Clone, Copy)]
pub enum Kind {
    /// A method, by name or by its choices.
    Method,
    /// A rule of the time step.
    TimeStep,
    /// One of several words.
    Word(&'static [&'static str]),
    /// True or false.
    Flag,
    /// A whole number from 1 to this.
    Count(i64),
    /// A number.
    Number(Range),
}

/// Which numbers a key takes.
#[derive(Clone, Copy)]
pub enum Range {
    /// Positive and finite.
    Positive,
    /// Zero, or positive and finite.
    NotNegative,
    /// Between two numbers, both excluded.
    Between(f64, f64),
    /// Between two numbers, both included; with what is said of another one (`{}`), and what would be right.
    Within(f64, f64, &'static str, &'static str),
}

/// The value of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// What solves the case.
    Method(SolverName),
    /// A rule of the time step.
    TimeStep(TimeStep),
    /// A word among its choices.
    Word(&'static str),
    /// True or false.
    Flag(bool),
    /// A whole number.
    Count(usize),
    /// A number, in SI units.
    Number(f64),
    /// Nothing: the body of the case has no such input.
    Absent,
}

/// A type of the fields of a case: its value as an input, and back.
trait Field: Sized {
    fn value(self) -> Value;
    fn from_value(value: Value) -> Option<Self>;
}

macro_rules! fields {
    ($($kind:ty: $variant:ident),+) => { $(
        impl Field for $kind {
            fn value(self) -> Value {
                Value::$variant(self)
            }
            fn from_value(value: Value) -> Option<Self> {
                if let Value::$variant(value) = value { Some(value) } else { None }
            }
        }
    )+ };
}

fields!(SolverName: Method, TimeStep: TimeStep, bool: Flag, usize: Count, f64: Number);

macro_rules! word_fields {
    ($($kind:ty),+) => { $(
        impl Field for $kind {
            fn value(self) -> Value {
                Value::Word(self.name())
            }
            fn from_value(value: Value) -> Option<Self> {
                if let Value::Word(word) = value { Self::named(word) } else { None }
            }
        }
    )+ };
}

word_fields!(
    Base,
    ConductivityMean,
    Continuity,
    Drag,
    Drainage,
    Formulation,
    IntegratorKind,
    Law,
    Scheme,
    Undrained
);

/// Reads or writes the field of a case that a key stands for: a path of fields, or a field of one shape of the body.
macro_rules! field {
    (get $case:ident, by $get:ident $set:ident) => { Value::Number($get($case)) };
    (set $case:ident, $value:ident, by $get:ident $set:ident) => { $set($case, $value) };
    (get $case:ident, shape $shape:ident $first:ident $(. $rest:ident)*) => {
        match $case.column.shape {
            Shape::$shape { $first, .. } => $first $(. $rest)*.value(),
            _ => Value::Absent,
        }
    };
    (get $case:ident, $($field:ident).+) => { $case.$($field).+.value() };
    (set $case:ident, $value:ident, shape $shape:ident $first:ident $(. $rest:ident)*) => {
        if let Shape::$shape { $first, .. } = &mut $case.column.shape {
            (*$first) $(. $rest)* = $value;
        }
    };
    (set $case:ident, $value:ident, $($field:ident).+) => { $case.$($field).+ = $value };
}

macro_rules! keys {
    ($($name:ident in $tables:expr, $kind:expr, $unit:literal, [$($field:tt)+] $(, for $other:literal)? $(, then $then:expr)?;
       $meaning:literal)+) => {
        /// Every input of a case that a study file names; those of a sweep in the order in which it turns them,
        /// the slowest first.
        pub static KEYS: &[Key] = &[$(Key {
            name: stringify!($name),
            tables: $tables,
            kind: $kind,
            unit: $unit,
            meaning: $meaning,
            in_place_of: [$($other,)? ""][0],
            get: |case| field!(get case, $($field)+),
            set: |case, value| {
                if let Some(value) = Field::from_value(value) {
                    field!(set case, value, $($field)+);
                    $(let then: fn(&mut Case) = $then; then(case);)?
                }
            },
        }),+];
    };
}

const POSITIVE: Kind = Kind::Number(Range::Positive);

/// What follows from inputs, to as many digits as one types: those of round-off would make another value of it.
fn derived(value: f64) -> f64 {
    format!("{value:.13e}").parse().unwrap_or(value)
}

fn oedometric_modulus(case: &Case) -> f64 {
    derived(case.material.oedometric_modulus())
}

/// Young's modulus of an oedometric one, by Poisson's ratio of the case.
fn set_oedometric_modulus(case: &mut Case, modulus: f64) {
    let ratio = case.material.poissons_ratio;
    case.material.youngs_modulus = modulus * ((1.0 + ratio) * (1.0 - 2.0 * ratio) / (1.0 - ratio));
}

fn coefficient_of_consolidation(case: &Case) -> f64 {
    derived(case.material.coefficient_of_consolidation())
}

/// Conductivity of a coefficient of consolidation, by modulus and unit weight of the case.
fn set_coefficient_of_consolidation(case: &mut Case, coefficient: f64) {
    let soil = &mut case.material;
    soil.hydraulic_conductivity = coefficient * soil.unit_weight_of_water() / soil.oedometric_modulus();
}

const SHIFT: Kind = Kind::Number(Range::Within(
    -0.5,
    0.5,
    "points shifted by {} spacings",
    "it lies between -0.5 and 0.5 point spacings",
));
const SHARE_OF_FLIP: Kind =
    Kind::Number(Range::Within(0.0, 1.0, "a FLIP share of {}", "it lies between 0 (PIC) and 1 (FLIP)"));
const FILLING: Kind = Kind::Number(Range::Within(
    f64::MIN_POSITIVE,
    1.0,
    "`points.filling` is {}",
    "it is the filled fraction of the top cell: more than 0, at most 1",
));

const STRETCH: Kind = Kind::Number(Range::Within(
    -0.99,
    0.99,
    "a prescribed stretch of {}",
    "from 1 on it folds the body: it lies between -0.99 and 0.99",
));
const TURN: Kind = Kind::Number(Range::Within(
    -4.0,
    4.0,
    "a prescribed angle of {}",
    "larger angles need finer meshes than are feasible: it lies between -4 and 4 rad",
));

// One row per key: name, tables, values, unit, field of the case; meaning.
keys! {
    method in &["sweep"], Kind::Method, "", [method]; "Method, by name or by its choices"
    integrator in &["sweep"], Kind::Word(&IntegratorKind::NAMES), "", [integrator], then |case| {
        case.formulation = case.integrator.default_formulation();
        case.time_step = case.integrator.default_rule();
    }; "Integrator in time"
    cells in &["sweep"], Kind::Count(MOST_CELLS), "", [cells]; "Cells over the height"
    points_per_cell in &["sweep"], Kind::Count(MOST_POINTS), "", [points_per_cell];
        "Material points per cell and direction"
    time_step in &["sweep"], Kind::TimeStep, "", [time_step]; "Rule of the time step"
    drag in &["sweep", "integrator"], Kind::Word(&Drag::NAMES), "", [settings.drag];
        "Time level of the velocities in the drag"
    flip in &["sweep", "integrator"], SHARE_OF_FLIP, "", [settings.flip];
        "FLIP fraction of the velocity update; the rest is PIC"
    mapping_back in &["sweep", "integrator"], Kind::Flag, "", [settings.mapping_back];
        "Update stresses with velocities mapped back from the points (MUSL)"
    affine in &["sweep", "integrator"], Kind::Flag, "", [settings.affine];
        "Moving points carry gradients of their velocities to the nodes (APIC)"
    stress_slopes in &["sweep", "integrator"], Kind::Flag, "", [settings.stress_slopes];
        "Stresses vary linearly over the domains of moving points"
    formulation in &["sweep", "integrator"], Kind::Word(&Formulation::NAMES), "", [formulation];
        "Accelerations in the balances"
    scheme in &["sweep", "integrator"], Kind::Word(&Scheme::NAMES), "", [settings.scheme];
        "Time levels of velocities and stresses in the explicit step"
    law in &["sweep", "material"], Kind::Word(&Law::NAMES), "", [material.law]; "Stress–strain law of the skeleton"
    youngs_modulus in &["sweep", "material"], POSITIVE, "Pa", [material.youngs_modulus];
        "Young's modulus of the skeleton"
    poissons_ratio in &["sweep", "material"], Kind::Number(Range::Between(-1.0, 0.5)), "", [material.poissons_ratio];
        "Poisson's ratio of the skeleton"
    porosity in &["sweep", "material"], Kind::Number(Range::Between(0.0, 1.0)), "", [material.porosity];
        "Initial porosity"
    grain_density in &["sweep", "material"], POSITIVE, "kg/m³", [material.grain_density]; "Density of the grains"
    water_density in &["sweep", "material"], POSITIVE, "kg/m³", [material.water_density]; "Density of the water"
    water_bulk_modulus in &["sweep", "material"], POSITIVE, "Pa", [material.water_bulk_modulus];
        "Bulk modulus of the water"
    hydraulic_conductivity in &["sweep", "material"], POSITIVE, "m/s", [material.hydraulic_conductivity];
        "Initial hydraulic conductivity"
    gravity in &["sweep", "material"], POSITIVE, "m/s²", [material.gravity]; "Gravity, in the drag and in `column.self_weight`"
    oedometric_modulus in &["sweep", "material"], POSITIVE, "Pa", [by oedometric_modulus set_oedometric_modulus],
        for "youngs_modulus";
        "Oedometric modulus E_oed = 1/m_v, in place of `youngs_modulus`: E = E_oed(1 + ν)(1 − 2ν)/(1 − ν)"
    coefficient_of_consolidation in &["sweep", "material"], POSITIVE, "m²/s",
        [by coefficient_of_consolidation set_coefficient_of_consolidation], for "hydraulic_conductivity";
        "Coefficient of consolidation c_v, in place of `hydraulic_conductivity`: k = c_v γ_w/E_oed"
    continuity in &["sweep", "material"], Kind::Word(&Continuity::NAMES), "", [material.continuity];
        "Form of the water's continuity"
    conductivity_mean in &["sweep", "material"], Kind::Word(&ConductivityMean::NAMES), "", [material.conductivity_mean];
        "Mean of the hydraulic conductivity at a node"
    offset in &["sweep", "points"], SHIFT, "", [column.points.offset];
        "Shift of all points upward, in point spacings"
    jitter in &["sweep", "points"], SHIFT, "", [column.points.jitter], then |case| {
        case.column.points.jitter = case.column.points.jitter.abs();
    }; "Largest shift of a row of points up or down, in point spacings"
    filling in &["sweep", "points"], FILLING, "", [column.points.filling]; "Filled share of the top cell"
    alternating in &["sweep", "points"], Kind::Flag, "", [column.points.alternating];
        "Every second cell of a column has one more point"
    sets in &["sweep", "points"], Kind::Count(2), "", [column.points.sets], then |case| {
        // One set has no points of the water's own.
        case.column.points.water_per_cell *= usize::from(case.column.points.sets == 2);
    };
        "Point sets: 1 for skeleton and water together, 2 for one of each (double-point MPM)"
    water_per_cell in &["sweep", "points"], Kind::Count(MOST_POINTS), "", [column.points.water_per_cell];
        "Water points per cell and direction in double-point MPM; by default as many as of the skeleton"
    length in &["sweep", "layer"], POSITIVE, "m", [shape Layer length]; "Length"
    height in &["sweep", "column", "layer"], POSITIVE, "m", [column.height]; "Initial height H"
    width in &["sweep", "column"], POSITIVE, "m", [shape Column width]; "Width; no effect in one dimension"
    plate_width in &["sweep", "layer"], POSITIVE, "m", [column.footing.width];
        "Width B of a footing, half of which is solved"
    plate in &["sweep", "layer"], Kind::Word(&Base::NAMES), "", [column.footing.contact];
        "Contact of soil and footing"
    undrained in &["sweep", "layer"], Kind::Word(&Undrained::NAMES), "", [column.footing.undrained];
        "Model of the undrained soil under a footing"
    base in &["sweep", "layer"], Kind::Word(&Base::NAMES), "", [shape Layer base]; "Contact of layer and base"
    load in &["sweep", "column", "layer"], POSITIVE, "Pa", [column.load]; "Load q on the surface"
    dimensions in &["column"], Kind::Count(2), "", [column.dimensions]; "Dimensions that are solved"
    loading_time in &["column"], Kind::Number(Range::NotNegative), "s", [column.loading_time];
        "Time over which the load grows; 0: sudden load"
    initial_stress in &["sweep", "column"], Kind::Number(Range::NotNegative), "Pa", [column.initial_stress];
        "Initial vertical effective stress of a preconsolidated soil, compression positive"
    reload_modulus in &["sweep", "material"], POSITIVE, "Pa", [material.reload_modulus];
        "Unloading–reloading modulus of a preconsolidated soil (oedometric)"
    undrained_strength in &["sweep", "material"], POSITIVE, "Pa", [material.undrained_strength];
        "Undrained shear strength of the law `von-mises`"
    preconsolidation in &["sweep", "material"], POSITIVE, "Pa", [material.preconsolidation];
        "Largest vertical effective stress in the past of a preconsolidated soil, compression positive"
    amplitude_x in &["sweep", "manufactured"], STRETCH, "", [shape Square motion.amplitude_x];
        "Amplitude A of the stretch along x"
    amplitude_y in &["sweep", "manufactured"], STRETCH, "", [shape Square motion.amplitude_y];
        "Amplitude B of the stretch along y"
    amplitude in &["sweep", "manufactured"], TURN, "rad", [shape Square motion.amplitude];
        "Amplitude of the vortex: its largest angle"
    frequency in &["sweep", "manufactured"], POSITIVE, "rad/s", [shape Square motion.frequency];
        "Frequency ω of the motion: largest at ωt = π/2, back at π"
    pressure in &["sweep", "manufactured"], POSITIVE, "Pa", [shape Square pressure];
        "Amplitude P of the pressure; also the scale of absolute errors of pressure and stress"
    self_weight in &["column"], Kind::Flag, "", [column.self_weight];
        "Skeleton and water have weight; pressures are in excess of the hydrostatic one"
    drainage in &["column"], Kind::Word(&Drainage::NAMES), "", [column.drainage];
        "Drained ends: the top, or top and base; then T_v = c_v t/(H/2)²"
}

impl Key {
    /// The key of a table by its name.
    pub fn named(name: &str, table: &str) -> Option<&'static Self> {
        Self::in_table(table).find(|key| key.name == name)
    }

    /// The keys of a table.
    pub fn in_table(table: &str) -> impl Iterator<Item = &'static Self> {
        KEYS.iter().filter(move |key| key.tables.contains(&table))
    }

    /// Whether it is the integrator or one of its options.
    pub fn is_of_integrator(&self) -> bool {
        self.name == "integrator" || self.tables.contains(&"integrator")
    }

    /// Whether it says something of a case: what only this program's integrators take says nothing to others.
    pub fn counts_for(&self, case: &Case) -> bool {
        let is_rule = self.name == "time_step" && !matches!(case.time_step, TimeStep::Seconds(_));
        case.has_integrator() || !(is_rule || self.is_of_integrator())
    }

    /// The value in a case.
    pub fn get(&self, case: &Case) -> Value {
        (self.get)(case)
    }

    /// Gives a case the value. An integrator brings its own formulation and step rule.
    pub fn set(&self, case: &mut Case, value: Value) {
        (self.set)(case, value);
    }

    /// What it means, with its unit: a sentence.
    pub fn description(&self) -> String {
        let comma = if self.unit.is_empty() { "" } else { ", " };
        format!("{}{comma}{}.", self.meaning, self.unit)
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        (self.name, self.tables) == (other.name, other.tables)
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name)
    }
}

impl fmt::Display for Value {
    /// As tables have it.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Method(method) => method.fmt(out),
            Self::TimeStep(time_step) => time_step.fmt(out),
            Self::Word(word) => out.write_str(word),
            Self::Flag(flag) => flag.fmt(out),
            Self::Count(count) => count.fmt(out),
            Self::Number(number) => number.fmt(out),
            Self::Absent => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Task;
    use oedometer_problem::method::Method;
    use oedometer_scenes::{COSINE_LAYER, MANUFACTURED_BOX, TERZAGHI};

    /// A value that the seed does not have.
    fn another(key: &Key, seed: &Case) -> Value {
        let others = match key.kind {
            Kind::Method => vec![Value::Method(Method::named("GIMP").expect("a method").into())],
            Kind::TimeStep => vec![Value::TimeStep(TimeStep::Seconds(0.1))],
            Kind::Word(words) => words.iter().copied().map(Value::Word).collect(),
            Kind::Flag => [true, false].map(Value::Flag).to_vec(),
            Kind::Count(_) => [1, 2].map(Value::Count).to_vec(),
            Kind::Number(_) => vec![Value::Number(0.125)],
        };
        others.into_iter().find(|value| *value != key.get(seed)).expect("another value")
    }

    #[test]
    fn every_key_has_a_place_of_its_own_in_a_case_and_in_its_identity() {
        for key in KEYS {
            let scene = match key.tables.last() {
                Some(&"manufactured") => &MANUFACTURED_BOX,
                Some(&"layer") => &COSINE_LAYER,
                _ => &TERZAGHI,
            };
            let seed = Case::seed(Task::Solve, scene);
            let mut case = seed.clone();
            key.set(&mut case, another(key, &seed));
            assert_eq!(key.get(&case), another(key, &seed), "{key:?}");
            assert_ne!(case.hash(), seed.hash(), "{key:?}");
            let same = |other: &&Key| other.get(&case) != other.get(&seed);
            let changed: Vec<&str> = KEYS.iter().filter(same).map(|other| other.name).collect();
            let derived = ["oedometric_modulus", "coefficient_of_consolidation"];
            let expected: &[&str] = match key.name {
                "integrator" => &["integrator", "time_step"],
                "youngs_modulus" | "poissons_ratio" => &[key.name, derived[0], derived[1]],
                "water_density" | "hydraulic_conductivity" | "gravity" => &[key.name, derived[1]],
                "oedometric_modulus" => &["youngs_modulus", derived[0], derived[1]],
                "coefficient_of_consolidation" => &["hydraulic_conductivity", derived[1]],
                name => &[name],
            };
            assert_eq!(changed, expected, "{key:?}");
        }
    }

    #[test]
    fn every_key_of_the_material_the_points_and_the_integrator_can_be_swept_and_most_of_the_geometry() {
        for key in
            KEYS.iter().filter(|key| !key.tables.iter().any(|table| ["column", "layer"].contains(table)))
        {
            assert!(key.tables.contains(&"sweep"), "{key:?}");
        }
        // Of the geometry all but what changes the references or the kind of the problem.
        let stays: Vec<&str> =
            KEYS.iter().filter(|key| !key.tables.contains(&"sweep")).map(|key| key.name).collect();
        assert_eq!(stays, ["dimensions", "loading_time", "self_weight", "drainage"]);
    }

    #[test]
    fn an_oedometer_s_inputs_are_those_that_they_stand_for_whatever_comes_first_in_a_file() {
        let set = |given: &[(&str, f64)]| {
            let mut case = Case::seed(Task::Solve, &TERZAGHI);
            // In the order of the table, as studies set them.
            for key in Key::in_table("material") {
                let typed = given.iter().find(|(name, _)| *name == key.name);
                if let Some((_, value)) = typed {
                    key.set(&mut case, Value::Number(*value));
                }
            }
            case
        };
        let typed =
            [("coefficient_of_consolidation", 2e-7), ("oedometric_modulus", 5e6), ("poissons_ratio", 0.3)];
        let case = set(&typed);
        let soil = &case.material;
        assert!((soil.oedometric_modulus() / 5e6 - 1.0).abs() < 1e-14);
        assert!((soil.coefficient_of_consolidation() / 2e-7 - 1.0).abs() < 1e-14);
        assert!((soil.youngs_modulus / (5e6 * 1.3 * 0.4 / 0.7) - 1.0).abs() < 1e-14);
        // Read back they are the numbers that were typed.
        for (name, value) in typed {
            let key = Key::named(name, "sweep").expect("a key");
            assert_eq!(key.get(&case), Value::Number(value), "{name}");
        }
    }

    #[test]
    fn values_read_as_tables_have_them_and_keys_with_their_units() {
        let ogs = crate::Attached::new("ogs", "0123456789abcdef").map(SolverName::Attached).expect("plain");
        let values = [Value::Method(ogs), Value::TimeStep(TimeStep::Tolerance(0.5)), Value::Word("explicit")];
        assert_eq!(values.map(|value| value.to_string()), ["ogs", "tolerance=5e-1", "explicit"]);
        let values = [Value::Flag(true), Value::Count(3), Value::Number(0.25), Value::Absent];
        assert_eq!(values.map(|value| value.to_string()), ["true", "3", "0.25", ""]);
        let named = |name: &str, table: &str| Key::named(name, table).expect("a key");
        assert_eq!(named("load", "layer").description(), "Load q on the surface, Pa.");
        assert_eq!(named("cells", "sweep").description(), "Cells over the height.");
        assert!(Key::named("dimensions", "sweep").is_none() && Key::named("load", "points").is_none());
        let within = |name: &str| match named(name, "sweep").kind {
            Kind::Number(Range::Within(low, high, said, right)) => (low, high, said, right),
            _ => panic!("{name} has other values"),
        };
        let half = "it lies between -0.5 and 0.5 point spacings";
        let filled = "it is the filled fraction of the top cell: more than 0, at most 1";
        let fold = "from 1 on it folds the body: it lies between -0.99 and 0.99";
        for (name, low, high, said, right) in [
            ("offset", -0.5, 0.5, "points shifted by {} spacings", half),
            ("jitter", -0.5, 0.5, "points shifted by {} spacings", half),
            ("flip", 0.0, 1.0, "a FLIP share of {}", "it lies between 0 (PIC) and 1 (FLIP)"),
            ("filling", f64::MIN_POSITIVE, 1.0, "`points.filling` is {}", filled),
            ("amplitude_x", -0.99, 0.99, "a prescribed stretch of {}", fold),
            ("amplitude_y", -0.99, 0.99, "a prescribed stretch of {}", fold),
        ] {
            assert_eq!(within(name), (low, high, said, right), "{name}");
        }
    }

    #[test]
    fn setting_an_input_sets_its_dependents_and_counts_for_solvers_that_read_it() {
        let mut case = Case::seed(Task::Solve, &TERZAGHI);
        let set = |case: &mut Case, name: &str, value: Value| {
            Key::named(name, "sweep").expect("a key").set(case, value);
        };
        (case.column.points.sets, case.column.points.water_per_cell) = (2, 3);
        set(&mut case, "jitter", Value::Number(-0.25));
        set(&mut case, "sets", Value::Count(1));
        assert_eq!((case.column.points.jitter, case.column.points.water_per_cell), (0.25, 0));
        let before = case.clone();
        set(&mut case, "cells", Value::Number(4.0));
        set(&mut case, "length", Value::Number(4.0));
        assert_eq!(case, before, "a value of another kind, or of another body, changes nothing");
        // What only this program's integrators take says nothing to others.
        let idle = |case: &Case| -> Vec<&str> {
            KEYS.iter().filter(|key| !key.counts_for(case)).map(|key| key.name).collect()
        };
        assert_eq!(idle(&case), [""; 0]);
        case.method =
            crate::Attached::new("ogs", "0123456789abcdef").map(SolverName::Attached).expect("plain");
        let idle_options =
            ["drag", "flip", "mapping_back", "affine", "stress_slopes", "formulation", "scheme"];
        assert_eq!(idle(&case), [&["integrator", "time_step"], &idle_options[..]].concat());
        case.time_step = TimeStep::Seconds(1.0);
        assert_eq!(idle(&case), [&["integrator"], &idle_options[..]].concat());
    }
}
