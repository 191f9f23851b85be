//! The table of hypotheses: what a column, or all of them, would hold with one mistake, and what to ask.
//!
//! A row has at most one number. [`scales`] are factors of a column; [`READINGS`] are other contents of one column;
//! [`WORLDS`] concern all of them.

use super::columns::{Column, Field, Given};
use super::readings::{Exact, is_timed};
use super::world::{EDGES, Ends, World};
use super::{digits, shown};
use crate::import::mapping::units::{StressUnit, TimeUnit};
use oedometer_exact::{Drainage, Reference, ReferenceKind};
use oedometer_soil::elementary::powi;
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;
use oedometer_soil::stiffness::Stiffness;
use oedometer_wording::{DAY, HOUR, MINUTE, WEEK, YEAR};

/// Units of stress and length, in SI.
const STRESSES: [(&str, f64); 6] =
    [("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("bar", 1e5), ("atm", 101_325.0), ("psi", 6_894.757)];
const LENGTHS: [(&str, f64); 7] =
    [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("µm", 1e-6), ("km", 1e3), ("in", 0.0254), ("ft", 0.3048)];
/// Units of time, s, with the word that they have in a velocity.
#[rustfmt::skip]
const TIMES: [(&str, f64, &str); 9] = [
    ("s", 1.0, ""), ("min", MINUTE, "min"), ("h", HOUR, "hour"), ("d", DAY, "day"), ("weeks", WEEK, ""), ("a", YEAR, "year"), ("ms", 1e-3, ""),
    ("µs", 1e-6, ""), ("ns", 1e-9, ""),
];
/// Viscosity of water at 20 °C, Pa s.
const VISCOSITY: f64 = 1.0e-3;
/// Share by which a number may miss the one that has a name.
pub const NAME: f64 = 2e-3;

/// A factor that all values of a column have.
#[derive(Clone)]
pub struct Scale {
    /// What the file holds over the exact value.
    pub factor: f64,
    /// What to ask, in turn; nothing of the column's own unit.
    pub asked: Vec<String>,
    /// Whether it is of this column alone, and goes with no other mistake.
    pub is_alone: bool,
}

/// The factors of a column: its own, other units, no unit, and those that another modulus or component makes.
pub fn scales(field: Field, given: &Given<'_>) -> Vec<Scale> {
    let (units, parameters) = (&given.mapping.units, &given.own.parameters);
    let (soil, weight) = (&parameters.soil, parameters.soil.unit_weight_of_water());
    let mut all: Vec<Scale> = Vec::new();
    let mut add = |factor: f64, asked: &str, is_alone: bool| {
        let is_new = all.iter().all(|other| (factor / other.factor - 1.0).abs() > NAME);
        for (factor, sign) in
            [(factor, ""), (-factor, SIGN)].into_iter().filter(|_| is_new && factor.is_normal())
        {
            let mut asked = vec![asked.to_owned(), sign.to_owned()];
            asked.retain(|asked| !asked.is_empty());
            all.push(Scale { factor, asked, is_alone });
        }
    };
    add(1.0, "", false);
    let (table, own, name, whole) = if field.is_stress() {
        let unit = units.stress.unwrap_or(StressUnit::Pascal);
        (&STRESSES[..], unit.pascals(), unit.name(), ("load, p/q", parameters.load))
    } else {
        let unit = units.displacement.unwrap_or(units.length);
        (&LENGTHS[..], unit.metres(), unit.name(), ("final settlement", parameters.final_settlement()))
    };
    for (unit, si) in table {
        add(own / si, &format!("is it in {unit} where {name} is declared"), false);
    }
    for (unit, metres) in LENGTHS.iter().take(3).filter(|_| field == Field::Pressure) {
        let asked = format!("is it a head in {unit}, p/γ_w, where {name} is declared");
        add(own / metres / weight, &asked, false);
    }
    add(own / whole.1, &format!("is it divided by the {}", whole.0), false);
    add(2.0, "is it doubled where it is written", true);
    add(0.5, "is it halved where it is written", true);
    let (ratio, nu) = (soil.oedometric_modulus() / soil.youngs_modulus, soil.poissons_ratio);
    if field == Field::EffectiveStress {
        add(nu / (1.0 - nu), "is it the horizontal component, σ_xx = ν/(1 − ν) σ_yy", true);
    } else if field != Field::Pressure && parameters.soils.is_empty() {
        add(ratio, "is E taken for E_oed where displacements are computed", true);
        add(1.0 / ratio, "is E_oed taken for E where displacements are computed", true);
    }
    all
}

/// The number of a row.
#[derive(Clone, Copy, PartialEq)]
pub enum Number {
    None,
    /// Numbers that have a name.
    Named(&'static [f64]),
    /// A fitted number in which the values are linear.
    Linear,
    /// A fitted time, s.
    Time,
}

/// Which units and signs a row goes with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Units {
    All,
    /// No other unit or sign.
    Own,
    /// All, with a sign that no column tells, because it is another quantity.
    AnySign,
}

/// A hypothesis about one column.
pub struct Row {
    pub of: &'static [Field],
    /// What the column would be, and the question; `{}` is the number. Nothing is asked of the column itself.
    pub said: &'static str,
    pub asked: &'static str,
    /// What varies as the exact solution does, the yardstick of its error, and what is added to each value of it.
    pub holds: fn(&Exact<'_>, f64) -> Vec<f64>,
    pub plus: Option<fn(&Exact<'_>, usize, f64) -> f64>,
    pub number: Number,
    /// Single mistakes in it.
    pub count: usize,
    pub units: Units,
    pub is_possible: fn(&Exact<'_>) -> bool,
}

/// What to ask of a sign, and words of questions about a factor that may be the load's.
pub const SIGN: &str = "is the sign declared wrongly";
pub const WHERE_WRITTEN: &str = "where it is written";
const P: &[Field] = &[Field::Pressure];
const STRESS: &[Field] = &[Field::Pressure, Field::EffectiveStress];
const MOVED: &[Field] = &[Field::Up, Field::Along, Field::Settlement];
const NOT_STRESS: &[Field] = &[Field::Pressure, Field::Up, Field::Along, Field::Settlement];
/// The standard atmosphere and a bar, Pa.
const ATMOSPHERES: Number = Number::Named(&[101_325.0, 1e5]);
/// A row with nothing to fit and nothing that it needs.
#[rustfmt::skip]
const ROW: Row = Row { of: P, said: "the exact one", asked: "", holds: |x, _| x.own.clone(), plus: None, number: Number::None, count: 1, units: Units::All,
    is_possible: |_| true };
/// A row of other times, which are computed at no great cost.
const LATER: Row = Row { units: Units::Own, is_possible: is_timed, ..ROW };
/// The same of a column beside one that is right.
const BESIDE: Row = Row { of: &Field::ALL, is_possible: |x| is_timed(x) && x.column.is_other_right, ..LATER };

/// What one column may hold.
#[rustfmt::skip]
pub const READINGS: &[Row] = &[
    Row { of: &Field::ALL, ..ROW },
    Row { of: &Field::ALL, said: "{} × the exact one at all times and places", asked: "is a factor missing where it is written",
        holds: |x, factor| x.each(|at| factor * x.own[at]), number: Number::Linear, count: 2, units: Units::Own, ..ROW },
    Row { said: "the exact effective stress", asked: "is it given instead of the pore pressure",
        holds: |x, _| x.each(|at| -x.stress[at]), units: Units::AnySign, ..ROW },
    Row { said: "the exact total stress", asked: "is it given instead of the pore pressure",
        holds: |x, _| x.each(|at| x.pressure[at] - x.stress[at]), units: Units::AnySign, ..ROW },
    Row { of: &[Field::EffectiveStress], said: "the exact pore pressure", asked: "is it given instead of the effective stress",
        holds: |x, _| x.pressure.clone(), units: Units::AnySign, ..ROW },
    Row { of: &[Field::EffectiveStress], said: "the exact total stress", asked: "is the pore pressure left in",
        holds: |x, _| x.each(|at| x.stress[at] - x.pressure[at]), ..ROW },
    Row { said: "1 − p/q of the exact one", asked: "is a degree of consolidation given instead",
        holds: |x, _| x.each(|at| -x.own[at] / x.parameters.load), plus: Some(|_, _, _| 1.0), ..ROW },
    Row { of: STRESS, said: "the exact strain", asked: "is the strain given instead",
        holds: |x, _| x.each(|at| x.strain(at)), units: Units::AnySign, ..ROW },
    Row { of: STRESS, said: "the exact porosity", asked: "is the porosity given instead, as it changes with the strain",
        holds: |x, _| x.each(|at| (1.0 - x.parameters.soil.porosity) * x.strain(at)), plus: Some(|x, _, _| x.parameters.soil.porosity), ..ROW },
    Row { of: STRESS, said: "the exact void ratio", asked: "is the void ratio given instead",
        holds: |x, _| x.each(|at| x.strain(at) / (1.0 - x.parameters.soil.porosity)), plus: Some(|x, _, _| x.parameters.soil.porosity / (1.0 - x.parameters.soil.porosity)), ..ROW },
    Row { said: "the exact one plus {} Pa", asked: "is it an absolute pressure, with that of the atmosphere left in",
        plus: Some(|_, _, constant| constant), number: ATMOSPHERES, ..ROW },
    Row { said: "the exact one with the weight of the water", asked: "is the hydrostatic part left in",
        plus: Some(|x, at, _| x.weight_above(at)), ..ROW },
    Row { said: "the exact one with the weight of the water", asked: "is the hydrostatic part left in",
        plus: Some(|x, at, _| x.weight_above(at) - x.weight() * x.up[at]), ..ROW },
    Row { said: "the exact one less the weight of the water", asked: "is the hydrostatic part subtracted twice",
        plus: Some(|x, at, _| -x.weight_above(at)), ..ROW },
    Row { said: "the exact one with the weight of the water and {} Pa",
        asked: "is the hydrostatic part left in, and is it an absolute pressure, with that of the atmosphere left in",
        plus: Some(|x, at, constant| x.weight_above(at) + constant), number: ATMOSPHERES, count: 2, ..ROW },
    Row { said: "the exact one with the weight of the water and {} Pa", asked: "is the hydrostatic part left in",
        plus: Some(|x, at, constant| x.weight_above(at) + constant), number: Number::Linear, ..ROW },
    Row { said: "the exact one with the elevation", asked: "is it a total head, with the elevation",
        plus: Some(|x, at, _| x.weight() * x.column.heights[at]), ..ROW },
    Row { said: "the exact one plus {} Pa", asked: "is a constant of {} Pa left in",
        plus: Some(|_, _, constant| constant), number: Number::Linear, ..ROW },
    Row { of: &[Field::Up], said: "the exact one plus the same at all times, {} m at the top",
        asked: "is the displacement of an earlier stage, such as self-weight, left in",
        plus: Some(|x, at, top| top * x.column.heights[at] / x.parameters.height), number: Number::Linear, ..LATER },
    Row { of: MOVED, said: "the exact one less that of {} s", asked: "is it counted from a later time, {} s, instead of the start of loading",
        holds: |x, moment| x.less(&x.at(|_| moment), |_| false), number: Number::Time, ..LATER },
    Row { of: MOVED, said: "the exact one less that of the first output", asked: "is it reset after the first output, as by a restart or a new stage",
        holds: |x, _| x.less(&x.at(|_| x.given.times[0]), |output| output == 0), ..LATER },
    Row { of: NOT_STRESS, said: "what the exact one gains from output to output", asked: "is it the increment since the previous output, not the total",
        holds: |x, _| x.less(&x.at(|output| x.given.before[output]), |output| x.given.before[output] == 0.0), ..LATER },
    Row { said: "the exact one of the previous output", asked: "is it that of the previous output",
        holds: |x, _| x.at(|output| x.given.before[output]), ..BESIDE },
    Row { said: "the exact one {} s earlier", asked: "does it lag {} s behind the other columns, as by one step or half a step",
        holds: |x, late| x.at(|output| (x.given.times[output] - late).max(0.0)), number: Number::Time, ..BESIDE },
    Row { said: "the exact one of {} s at all outputs", asked: "is it the same state at all outputs, that of {} s",
        holds: |x, moment| x.at(|_| moment), number: Number::Time, ..BESIDE },
    Row { of: STRESS, said: "the integral of the exact one over time", asked: "is it integrated over time",
        holds: |x, _| x.mean(|seconds| seconds), ..LATER },
    Row { of: STRESS, said: "the mean of the exact one since the start", asked: "is it the mean over time since the start",
        holds: |x, _| x.mean(|_| 1.0), ..LATER },
    Row { of: NOT_STRESS, said: "the rate of the exact one", asked: "is it the rate (velocity), not the total",
        holds: |x, _| x.rate(), ..LATER },
    Row { of: &Field::ALL, said: "the exact one upside down", asked: "is only this column written from the other end",
        holds: |x, _| x.of_world(&World { ends: Ends::UpsideDown, ..x.world.clone() }, &x.given.times), units: Units::Own, is_possible: |x| x.column.is_other_right, ..ROW },
];

/// Numbers with the questions that name them.
pub type Names = Vec<(f64, String)>;

/// A hypothesis about all columns.
pub struct Cause {
    /// How a sentence goes on after "the exact one", and the question; `{}` is the number.
    pub said: &'static str,
    pub asked: &'static str,
    pub is_possible: fn(&Given<'_>) -> bool,
    pub of: fn(&Given<'_>, World, f64) -> World,
    /// Where a number is looked for, between the first and the last time; by decades where it is positive.
    pub range: Option<fn(&Given<'_>) -> [f64; 2]>,
    pub names: fn(&Given<'_>) -> Names,
    /// What else to ask of a number without a name.
    pub asked_of: fn(&Given<'_>, f64) -> String,
    /// Whether it concerns times alone: some of the outputs may have it, and it goes with other units.
    pub is_of_times: bool,
}

#[rustfmt::skip]
const CAUSE: Cause = Cause { said: "", asked: "", is_possible: |_| true, of: |_, own, _| own, range: None, names: |_| Vec::new(),
    asked_of: |_, _| String::new(), is_of_times: false };
/// A cause with a factor.
const FACTOR: Cause = Cause { range: Some(|_| [1e-6, 1e6]), ..CAUSE };

/// Times before anything has drained, and after all has.
#[rustfmt::skip]
pub const START: Cause = Cause { said: " of the start: nothing has drained at the last time",
    asked: "is the surface closed, so that nothing drains, or is k, or are the times, far too small",
    is_possible: |given| given.own.is_slow(), of: |_, own, _| World { clock: [0.0, 0.0], ..own }, ..CAUSE };
#[rustfmt::skip]
pub const END: Cause = Cause { said: " of the end",
    asked: "has everything drained before the first time (is k, or are the times, far too large)", is_possible: |given| given.own.is_slow(), is_of_times: true,
    of: |given, own, _| World { clock: [0.0, given.own.parameters.time(EDGES[1])], ..own }, ..CAUSE };

/// One state at all outputs.
#[rustfmt::skip]
pub const ONE_STATE: Cause = Cause { said: " of {} s at all outputs",
    is_possible: |given| given.own.is_slow() && !given.own.kind.row().is_prepared && given.columns.iter().all(Column::stands_still),
    of: |_, own, moment| World { clock: [0.0, moment], ..own }, range: Some(|given| [1e-6, 10.0].map(|factor| given.own.parameters.time(factor))),
    asked: "is the same state written, or read, every time", ..CAUSE };

/// What all columns may share.
#[rustfmt::skip]
pub const WORLDS: &[Cause] = &[
    Cause { said: " upside down", asked: "is `y` counted from the other end",
        is_possible: |given| !given.own.is_slab(), of: |_, own, _| World { ends: Ends::UpsideDown, ..own }, ..CAUSE },
    Cause { said: " with x turned", asked: "does `x` count from the drained side", is_possible: |given| given.own.is_slab(),
        of: |_, own, _| World { ends: Ends::UpsideDown, ..own }, ..CAUSE },
    Cause { said: " with x turned", asked: "does `x` count from the other end", is_possible: is_plane,
        of: |_, own, _| World { ends: Ends::OtherSide, ..own }, ..CAUSE },
    Cause { said: " with x and y exchanged", asked: "are the axes exchanged (of `mandel` x runs along the drained direction, from the middle, and y across)",
        is_possible: |given| given.own.is_slab(), of: |_, own, _| World { ends: Ends::AxesExchanged, ..own }, ..CAUSE },
    Cause { said: " of a column that drains at its base", asked: "is the base drained instead of the surface",
        is_possible: |given| given.own.is_column(), of: drained_at_its_base, ..CAUSE },
    Cause { said: " of a column that drains at both ends", asked: "is the base drained too",
        is_possible: |given| given.own.is_column() && given.own.parameters.drainage == Drainage::Top,
        of: |_, mut own, _| { own.parameters.drainage = Drainage::Both; own }, ..CAUSE },
    Cause { said: " of incompressible water", asked: "is the storage of the water, n/K_w, missing from the mass balance",
        of: |_, own, _| own.with_soils(|soil| soil.water_bulk_modulus *= 1e9), ..CAUSE },
    Cause { said: " of water softer by n", asked: "is K_w taken for K_w/n",
        of: |_, own, _| own.with_soils(|soil| soil.water_bulk_modulus *= soil.porosity), ..CAUSE },
    Cause { said: " of compressible water", asked: "is the water of your solver compressible, so that the reference without `-incompressible` is the right one",
        is_possible: |given| matches!(given.own.kind, ReferenceKind::TerzaghiIncompressible | ReferenceKind::CosineLayerIncompressible),
        of: |given, own, _| World { kind: if is_plane(given) { ReferenceKind::CosineLayer } else { ReferenceKind::Terzaghi }, ..own }, ..CAUSE },
    START,
    END,
    Cause { said: " of a slab whose load does not move to its middle", asked: "is the top held plane by a rigid plate",
        is_possible: |given| given.own.is_slab() && !given.moves(), of: without_plate, ..CAUSE },
    Cause { said: " of another stiffness", asked: "are λ and μ exchanged", is_possible: |given| is_plane(given) || given.own.is_slab(),
        of: |_, own, _| own.with_soils(exchange_moduli), ..CAUSE },
    Cause { said: " of {} × the load", of: |_, mut own, factor| { own.parameters.load *= factor; own },
        is_possible: |given| (given.moves() && given.columns[0].field.is_stress() || matches!(given.own.kind, ReferenceKind::LargeStrain(_) | ReferenceKind::XieLeo)) && !given.own.kind.is_manufactured(),
        names: |_| [2.0, 0.5].map(|factor| (factor, is_load(factor))).to_vec(), asked: "is the load {} × that of the problem", ..FACTOR },
    ONE_STATE,
    Cause { said: " at {} × the time", is_possible: |given| given.own.is_slow(), is_of_times: true,
        of: |_, own, factor| World { clock: [factor, 0.0], ..own }, names: clocks, asked_of: is_clock,
        range: Some(|given| [EDGES[0] / given.own.parameters.time_factor(given.span()[1]), EDGES[1] / given.own.parameters.time_factor(given.span()[0])]), ..CAUSE },
    Cause { said: " with {} × the stiffness", of: |_, own, factor| own.with_soils(|soil| soil.youngs_modulus *= factor),
        is_possible: |given| given.own.is_slow() && given.moves() && !matches!(given.own.kind, ReferenceKind::LargeStrain(_)),
        names: |given| [moduli(given), tens(3, "is E off by a power of ten, or in another unit")].concat(), asked_of: is_stiffness, ..FACTOR },
    Cause { said: " {} s {side}", is_of_times: true, of: |_, own, moment| World { clock: [1.0, moment], ..own },
        is_possible: |given| given.own.is_slow() && !given.own.kind.row().is_prepared, range: Some(|given| [-0.95 * given.span()[0], given.span()[1]]),
        asked: "do your times start at another moment, so that all are {} s too {late}", ..CAUSE },
    Cause { said: " under a load that rises over {} s", of: |_, own, ramp| World { ramp, ..own },
        is_possible: |given| given.own.kind.row().adds_up && !given.own.parameters.self_weight, range: Some(|given| [0.05 * given.span()[0], 10.0 * given.span()[1]]),
        asked: "does your load rise over {} s, in a ramp, whereas that of the problem is sudden", ..CAUSE },
    Cause { said: " of a skeleton without the pressure",
        asked: "is the pore pressure missing from the momentum balance, so that the skeleton carries the load at once",
        is_possible: |given| given.own.is_slow() && given.moves(), of: |_, own, _| World { is_coupled: false, ..own }, ..CAUSE },
];

/// What to ask of a number of the soil that is off by a factor.
fn is_number(given: &Given<'_>, number: f64, factor: f64, unit: &str) -> String {
    if given.own.parameters.soils.is_empty() {
        format!("{} {unit} for {}", digits(factor * number), digits(number))
    } else {
        format!("of each layer {} × that of the problem", shown(factor))
    }
}

fn is_clock(given: &Given<'_>, factor: f64) -> String {
    // A stiffness shows in displacements, too; without any it may be meant.
    let or = if given.moves() { String::new() } else { format!(", or {}", is_stiffness(given, factor)) };
    let k = given.own.parameters.soil.hydraulic_conductivity;
    format!("is k {}{or}, or are the times off", is_number(given, k, factor, "m/s"))
}

fn is_stiffness(given: &Given<'_>, factor: f64) -> String {
    let modulus = given.own.parameters.soil.oedometric_modulus();
    format!("is E_oed {}", is_number(given, modulus, factor, "Pa"))
}

pub fn is_load(factor: f64) -> String {
    format!("is the load {} × that of the problem", shown(factor))
}

fn is_plane(given: &Given<'_>) -> bool {
    matches!(given.own.kind, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible)
}

/// A column on its head, with its layers.
fn drained_at_its_base(_: &Given<'_>, mut own: World, _: f64) -> World {
    let turned: Vec<SoilLayer> = own.parameters.soils.iter().rev().copied().collect();
    own.parameters.soils = SoilLayers::from_slice(&turned).unwrap_or(own.parameters.soils);
    World { ends: Ends::DrainedBase, ..own }
}

/// λ for μ and μ for λ.
fn exchange_moduli(soil: &mut Material) {
    let Stiffness { lame, shear } = soil.stiffness();
    soil.youngs_modulus = lame * (3.0 * shear + 2.0 * lame) / (shear + lame);
    soil.poissons_ratio = shear / (2.0 * (shear + lame));
}

/// A slab of which every part carries its own load: a column under the slab's pressure at the start.
fn without_plate(_: &Given<'_>, mut own: World, _: f64) -> World {
    let slab = Reference::new(ReferenceKind::Mandel, &own.parameters, &[]).ok();
    let start = slab.and_then(|slab| slab.fields(1e-6, 1.0).ok());
    own.parameters.load = start.map_or(0.0, |start| start.pressure);
    World { kind: ReferenceKind::TerzaghiIncompressible, ..own }
}

/// Factors of the time that have a name, each with its question.
fn clocks(given: &Given<'_>) -> Names {
    let parameters = &given.own.parameters;
    let (weight, gravity, n) =
        (parameters.soil.unit_weight_of_water(), parameters.soil.gravity, parameters.soil.porosity);
    let declared = given.mapping.units.time;
    let seconds = declared.seconds(1.0, parameters.time(1.0));
    let is_time = |unit: &str| format!("are times in {unit} where {} is declared", declared.name());
    let mut all: Names = Vec::new();
    for (unit, si, word) in TIMES {
        if unit != declared.name() {
            all.push((si / seconds, is_time(unit)));
        }
        if !word.is_empty() {
            all.push((si, format!("is k in m/{word} taken for m/s")));
            all.push((1.0 / si, format!("is k in m/s taken for m/{word}")));
        }
    }
    if declared != TimeUnit::TimeFactor {
        all.push((parameters.time(1.0) / seconds, is_time("T_v")));
    }
    let others = [
        (gravity, "is γ_w taken as ρ_w, without g"),
        (1.0 / gravity, "is γ_w multiplied by g once too often"),
        (1.0 / VISCOSITY, "is k/μ taken for the hydraulic conductivity k"),
        (VISCOSITY, "is k divided by μ where it should not be"),
        (weight, "is k taken for k/γ_w"),
        (1.0 / weight, "is k/γ_w, or k/μ in place of it, taken for the hydraulic conductivity k"),
        (1.0 / n, "is k divided by the porosity, or are the times off"),
        (n, "is k multiplied by the porosity, or are the times off"),
    ];
    all.extend(others.map(|(factor, asked)| (factor, asked.to_owned())));
    let mut or = ", or c_v,";
    if !given.moves() {
        or = ", or c_v or E_oed,";
        all.extend(moduli(given));
    }
    all.extend(tens(9, &format!("is k{or} off by a power of ten")));
    all
}

/// Powers of ten.
fn tens(most: i32, asked: &str) -> Names {
    let powers = (1..=most).flat_map(|power| [power, -power]);
    powers.map(|power| (powi(10.0, power), asked.to_owned())).collect()
}

/// Ratios of moduli that people take for one another, over the right one.
fn moduli(given: &Given<'_>) -> Names {
    let soil = &given.own.parameters.soil;
    let (young, nu, right) = (soil.youngs_modulus, soil.poissons_ratio, soil.oedometric_modulus());
    let Stiffness { lame, shear } = soil.stiffness();
    let all = [
        (right * right / young, "is E_oed given as E"),
        (young, "is E taken for E_oed"),
        (lame + 2.0 * shear / 3.0, "is the bulk modulus K taken for E_oed"),
        (shear + 2.0 * lame, "are λ and μ exchanged"),
        (young / (1.0 - nu * nu), "is the modulus of plane stress, E/(1 − ν²), taken for E_oed"),
        (shear, "is the shear modulus G taken for E_oed"),
        (2.0 * shear, "is 2G taken for E_oed"),
    ];
    all.map(|(modulus, asked)| (modulus / right, asked.to_owned())).to_vec()
}
