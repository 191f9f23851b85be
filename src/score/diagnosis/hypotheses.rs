//! The table of hypotheses: what a column, or all of them, would hold with one mistake, and the question to ask.
//!
//! A row names at most one number. [`READINGS`] concern one column; [`CHANGES`] and [`FAMILIES`] are other worlds, which
//! concern all of them.

use super::columns::{Field, Given};
use super::readings::{Exact, Held, negative, whole};
use super::world::{Ends, World, with_soils};
use crate::import::mapping::units::{StressUnit, TimeUnit};
use oedometer_exact::row::Axis;
use oedometer_exact::{Reference, ReferenceKind};
use oedometer_soil::elementary::powi;

/// Units of stress, length and time, in SI.
const STRESSES: [(&str, f64); 7] = [
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("bar", 1e5),
    ("atm", 101_325.0),
    ("psi", 6_894.757),
];
const LENGTHS: [(&str, f64); 7] =
    [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("µm", 1e-6), ("km", 1e3), ("in", 0.0254), ("ft", 0.3048)];
const TIMES: [(&str, f64); 9] = [
    ("s", 1.0),
    ("min", 60.0),
    ("h", 3_600.0),
    ("d", 86_400.0),
    ("weeks", 604_800.0),
    ("a", 365.25 * 86_400.0),
    ("ms", 1e-3),
    ("µs", 1e-6),
    ("ns", 1e-9),
];
/// Standard atmosphere and a bar, Pa.
const ATMOSPHERES: [f64; 2] = [101_325.0, 1e5];
/// Viscosity of water at 20 °C, Pa s.
const VISCOSITY: f64 = 1.0e-3;
/// Share by which a number may miss the one that has a name.
pub const NAME: f64 = 2e-3;
/// A time factor before anything drains.
const EARLY: f64 = 1e-6;

/// A factor that all values of a column have.
#[derive(Clone, Debug)]
pub struct Scale {
    /// What the file holds over the exact value.
    pub factor: f64,
    pub asked: Vec<String>,
    /// What several columns may share as one mistake.
    pub key: String,
    pub is_head: bool,
}

/// The factors of a column: its own, other units and no unit, each with either sign.
pub fn scales(field: Field, given: &Given<'_>) -> Vec<Scale> {
    let (units, parameters) = (&given.mapping.units, given.parameters);
    let scale = |factor: f64, asked: String, key: &str| Scale {
        factor,
        asked: Some(asked).filter(|asked| !asked.is_empty()).into_iter().collect(),
        key: key.to_owned(),
        is_head: key.starts_with("head"),
    };
    let mut all = vec![scale(1.0, String::new(), "")];
    let mut add = |factor: f64, asked: String, key: &str| {
        if all.iter().all(|other| (factor / other.factor - 1.0).abs() > NAME) {
            all.push(scale(factor, asked, key));
        }
    };
    let (table, own, name): (&[(&str, f64)], f64, &str) = if field.is_stress() {
        let unit = units.stress.unwrap_or(StressUnit::Pascal);
        (&STRESSES, unit.pascals(), unit.name())
    } else {
        let unit = units.displacement.unwrap_or(units.length);
        (&LENGTHS, unit.metres(), unit.name())
    };
    for (unit, si) in table {
        add(own / si, format!("is it in {unit} where {name} is declared?"), unit);
    }
    if field == Field::Pressure {
        let weight = parameters.soil.unit_weight_of_water();
        for (unit, metres) in [("m", 1.0), ("cm", 0.01), ("mm", 1e-3)] {
            let asked = format!("is it a head in {unit}, p/γ_w, where {name} is declared?");
            add(own / metres / weight, asked, &format!("head in {unit}"));
        }
    }
    if field.is_stress() {
        add(own / parameters.load, "is it divided by the load, p/q?".to_owned(), "dimensionless");
    } else {
        let settled = parameters.final_settlement();
        add(own / settled, "is it divided by the final settlement?".to_owned(), "dimensionless");
    }
    let turned = |scale: &Scale| {
        let mut scale = scale.clone();
        scale.factor = -scale.factor;
        scale.asked.push("is the sign declared wrongly?".to_owned());
        scale.key += " turned";
        scale
    };
    let turned: Vec<Scale> = all.iter().map(turned).collect();
    all.into_iter().chain(turned).collect()
}

/// Numbers with their questions.
type Names = fn(&Given<'_>, Field) -> Vec<(f64, String)>;

/// The number of a row.
#[derive(Clone, Copy)]
pub enum Number {
    None,
    /// Numbers with questions of their own.
    Named(Names),
    /// Fitted: a constant, what grows with the height, a factor, or a time, s.
    Constant,
    Slope,
    Factor,
    Time,
}

/// What a row needs beside its column.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// Another column that is right.
    OtherRight,
    /// Two outputs.
    TwoOutputs,
    /// A solution that answers at any time.
    AnyTime,
    /// Outputs that are all alike.
    Still,
    /// One soil that strains along the height alone, in proportion to its stress.
    OneSoil,
    /// Large strain.
    Large,
    /// A pressure head.
    Head,
    /// Another unit or sign, or none.
    Scale,
    NoScale,
    /// No other cause: a factor that of one column alone may be the load's.
    MaybeLoad,
    /// A sign that no column tells, because it is another quantity.
    AnySign,
}

use Need::{
    AnySign, AnyTime, Head, Large, MaybeLoad, NoScale, OneSoil, OtherRight, Scale as Scaled, Still,
    TwoOutputs,
};

/// A hypothesis about one column.
pub struct Row {
    pub name: &'static str,
    pub of: &'static [Field],
    pub number: Number,
    /// Single mistakes in it.
    pub count: usize,
    pub needs: &'static [Need],
    pub holds: Holds,
    /// What the column does, and the question; `{}` is the number.
    pub said: &'static str,
    pub asked: &'static str,
}

const P: &[Field] = &[Field::Pressure];
const S: &[Field] = &[Field::EffectiveStress];
const STRESS: &[Field] = &[Field::Pressure, Field::EffectiveStress];
const UP: &[Field] = &[Field::Up];
const MOVED: &[Field] = &[Field::Up, Field::Along, Field::Settlement];
const PLACED: &[Field] = &[Field::Pressure, Field::EffectiveStress, Field::Up, Field::Along];
const ANY: &[Field] = &[Field::Pressure, Field::EffectiveStress, Field::Up, Field::Along, Field::Settlement];
const INCREASE: &[Field] = &[Field::Pressure, Field::Up, Field::Along, Field::Settlement];

type Holds = fn(&Exact<'_>, f64) -> Option<Held>;

const fn row(
    name: &'static str,
    of: &'static [Field],
    needs: &'static [Need],
    said: &'static str,
    asked: &'static str,
    holds: Holds,
) -> Row {
    Row { name, of, needs, said, asked, holds, number: Number::None, count: 1 }
}

impl Row {
    const fn fitted(self, number: Number) -> Self {
        Self { number, ..self }
    }

    const fn named(self, names: Names) -> Self {
        Self { number: Number::Named(names), ..self }
    }

    const fn counts(self, count: usize) -> Self {
        Self { count, ..self }
    }
}

/// What one column may hold: name, columns, needs, what it does, the question, and the values with the part of them that
/// varies as the exact solution does.
#[rustfmt::skip]
pub const READINGS: &[Row] = &[
    row("", ANY, &[Scaled], "", "", |x, _| whole(x.own.clone())),
    row("factor", ANY, &[NoScale, MaybeLoad], "is {} × the exact one", "", |x, factor| whole(x.times(factor))).named(twice),
    row("modulus", ANY, &[NoScale], "is {} × the exact one", "", |x, factor| whole(x.times(factor))).named(moduli_of_one),
    row("effective stress", P, &[AnySign], "matches the exact effective stress",
        "is it given instead of the pore pressure?", |x, _| whole(negative(&x.stress()))),
    row("total stress", P, &[AnySign], "matches the exact total stress",
        "is it given instead of the pore pressure?", |x, _| whole(x.total())),
    row("pressure", S, &[AnySign], "matches the exact pore pressure",
        "is it given instead of the effective stress?", |x, _| whole(x.pressure())),
    row("pressure left in", S, &[AnySign], "matches the exact total stress", "is the pore pressure left in?",
        |x, _| whole(negative(&x.total()))),
    row("degree", P, &[], "matches 1 − p/q of the exact one", "is a degree of consolidation given instead?",
        |x, _| Some(x.offset(-1.0, 1.0, &x.dimensionless()))),
    row("strain", STRESS, &[OneSoil, AnySign], "matches the exact strain",
        "is the strain given instead?", |x, _| whole(x.strain())),
    row("porosity", STRESS, &[OneSoil], "matches the exact porosity",
        "is the porosity given instead, as it changes with the strain?",
        |x, _| Some(x.offset(1.0 - x.porosity(), x.porosity(), &x.strain()))),
    row("void ratio", STRESS, &[OneSoil], "matches the exact void ratio",
        "is the void ratio given instead?",
        |x, _| Some(x.offset(1.0 / (1.0 - x.porosity()), x.porosity() / (1.0 - x.porosity()), &x.strain()))),
    row("absolute", P, &[], "differs from the exact one by a constant of {} Pa", "",
        |x, constant| Some(x.beside(|_| constant, true))).named(|_, _| atmospheres("")),
    row("hydrostatic", P, &[], "differs from the exact one by a constant gradient of {} Pa/m", "",
        |x, weight| Some(x.beside(|place| weight * x.depth(place), false))).named(hydrostatic),
    row("hydrostatic of the present depth", P, &[Large], "differs from the exact one by a constant gradient of {} Pa/m",
        "", |x, weight| Some(x.beside(|place| weight * x.present_depth(place), false))).named(hydrostatic),
    row("hydrostatic and absolute", P, &[], "differs from the exact one by a hydrostatic part and {} Pa", "",
        |x, constant| Some(x.beside(|place| x.weight() * x.depth(place) + constant, true))).named(|_, _| atmospheres("is the hydrostatic part left in? And ")).counts(2),
    row("elevation", P, &[Head], "differs from the exact one by a constant gradient",
        "is it a total head, with the elevation?",
        |x, _| Some(x.beside(|place| x.weight() * (x.given.parameters.height - x.depth(place)), false))),
    row("hydrostatic of another level", P, &[], "differs from the exact one by a hydrostatic part and {} Pa",
        "is the hydrostatic part left in?",
        |x, constant| Some(x.beside(|place| x.weight() * x.depth(place) + constant, true))).fitted(Number::Constant),
    row("constant", P, &[], "differs from the exact one by a constant of {} Pa", "is a constant of {} Pa left in?",
        |x, constant| Some(x.beside(|_| constant, true))).fitted(Number::Constant),
    row("earlier stage", UP, &[TwoOutputs], "differs from the exact one by the same amount at all times, {} \
         m at the top",
        "is the displacement of an earlier stage, such as self-weight, left in?",
        |x, top| Some(x.beside(|place| top * x.column.heights[place] / x.given.parameters.height, true))).fitted(Number::Slope),
    row("later moment", MOVED, &[AnyTime, TwoOutputs], "matches the exact one less that of {} s",
        "is it counted from a later time, {} s, instead of the start of loading?",
        |x, moment| whole(x.less(&x.at(|_| moment)?, |_| false))).fitted(Number::Time),
    row("restart", MOVED, &[AnyTime, TwoOutputs], "matches the exact one less that of the first output",
        "is it reset after the first output, as by a restart or a new stage?",
        |x, _| whole(x.less(&x.at(|_| x.given.times[0])?, |output| output == 0))),
    row("per output", INCREASE, &[AnyTime, TwoOutputs], "matches what the exact one gains from output to output",
        "is it the increment since the previous output, not the total?",
        |x, _| whole(x.less(&x.at(|output| x.given.before[output])?, |output| x.given.before[output] == 0.0))),
    row("output behind", ANY, &[AnyTime, TwoOutputs, OtherRight], "matches the exact one of the previous output",
        "is it that of the previous output?", |x, _| whole(x.at(|output| x.given.before[output]))),
    row("steps behind", ANY, &[AnyTime, TwoOutputs, OtherRight], "matches the exact one {} s earlier",
        "does it lag {} s behind the other columns, as by one step or half a step?",
        |x, late| whole(x.at(|output| (x.given.times[output] - late).max(0.0)))).fitted(Number::Time),
    row("one state", ANY, &[AnyTime, Still, OtherRight], "matches the exact one of {} s at all outputs",
        "is it the same state at all outputs, that of {} s?", |x, moment| whole(x.at(|_| moment))).fitted(Number::Time),
    row("integral", STRESS, &[AnyTime, TwoOutputs], "matches the integral of the exact one over time",
        "is it integrated over time?", |x, _| whole(x.integral())),
    row("mean over time", STRESS, &[AnyTime, TwoOutputs], "matches the mean of the exact one since the start",
        "is it the mean over time since the start?",
        |x, _| whole(x.mean_over_time())),
    row("rate", INCREASE, &[AnyTime, TwoOutputs], "matches the rate of the exact one",
        "is it the rate (velocity), not the total?", |x, _| whole(x.rate())),
    row("turned alone", PLACED, &[OtherRight], "matches the exact one upside down",
        "is only this column written from the other end?", |x, _| whole(x.turned())),
    row("unnamed factor", ANY, &[NoScale, MaybeLoad], "is {} × the exact one at all times and places",
        "is a factor missing where it is written?", |x, factor| whole(x.times(factor))).fitted(Number::Factor).counts(2),
];

/// A column that is written twice as large, or half.
fn twice(_: &Given<'_>, _: Field) -> Vec<(f64, String)> {
    let all = [(2.0, "is it doubled where it is written?"), (0.5, "is it halved where it is written?")];
    all.map(|(factor, asked)| (factor, asked.to_owned())).to_vec()
}

/// Factors of one column that another modulus makes, or another component.
fn moduli_of_one(given: &Given<'_>, field: Field) -> Vec<(f64, String)> {
    let soil = &given.parameters.soil;
    let (ratio, nu) = (soil.oedometric_modulus() / soil.youngs_modulus, soil.poissons_ratio);
    let all = match field {
        Field::EffectiveStress => {
            vec![(nu / (1.0 - nu), "is it the horizontal component, σ_xx = ν/(1 − ν) σ_yy?")]
        }
        Field::Pressure => Vec::new(),
        _ if !given.parameters.soils.is_empty() => Vec::new(),
        _ => vec![
            (ratio, "is E taken for E_oed where displacements are computed?"),
            (1.0 / ratio, "is E_oed taken for E where displacements are computed?"),
        ],
    };
    let is_other = |(factor, _): &(f64, &str)| *factor != 0.0 && (factor - 1.0).abs() > NAME;
    all.into_iter().filter(is_other).map(|(factor, asked)| (factor, asked.to_owned())).collect()
}

/// The pressures of the atmosphere, each with its question.
fn atmospheres(before: &str) -> Vec<(f64, String)> {
    let asked = format!("{before}is it an absolute pressure, with that of the atmosphere left in?");
    ATMOSPHERES.map(|pressure| (pressure, asked.clone())).to_vec()
}

/// The weight of water at rest, left in or taken off once more than it should be.
fn hydrostatic(given: &Given<'_>, _: Field) -> Vec<(f64, String)> {
    let weight = given.parameters.soil.unit_weight_of_water();
    let once = (weight, "is the hydrostatic part left in?".to_owned());
    vec![once, (-weight, "is the hydrostatic part subtracted twice?".to_owned())]
}

/// Whether a constant has a name, so that it need not be fitted.
pub fn is_named_constant(constant: f64) -> bool {
    ATMOSPHERES.iter().any(|named| (constant / named - 1.0).abs() <= NAME)
}

/// Another world with nothing fitted.
pub struct Change {
    /// Whether it is possible.
    pub is_possible: fn(&Given<'_>, &World) -> bool,
    pub said: &'static str,
    pub asked: &'static str,
    pub of: fn(&Given<'_>, World) -> World,
}

const fn change(
    said: &'static str,
    asked: &'static str,
    is_possible: fn(&Given<'_>, &World) -> bool,
    of: fn(&Given<'_>, World) -> World,
) -> Change {
    Change { is_possible, said, asked, of }
}

fn is_slab(given: &Given<'_>) -> bool {
    given.kind.row().axis == Axis::AlongSlab
}

/// What all columns may share.
#[rustfmt::skip]
pub const CHANGES: &[Change] = &[
    change(" upside down", "is `y` counted from the other end?",
        |given, _| !is_slab(given), |_, own| World { ends: Ends::UpsideDown, ..own }),
    change(" with x turned", "does `x` count from the drained side?",
        |given, _| is_slab(given), |_, own| World { ends: Ends::UpsideDown, ..own }),
    change(" of a column that drains at its base", "is the base drained instead of the surface?",
        |_, own| own.is_a_column(), |_, own| World { ends: Ends::DrainedBase, ..own }),
    change(" of a column that drains at both ends", "is the base drained too?",
        |given, own| own.is_a_column() && given.parameters.soils.is_empty(), |_, own| World { ends: Ends::BothDrained, ..own }),
    change(" with x and y exchanged",
        "are the axes exchanged? Of `mandel` x runs along the drained direction, from the middle, and y across",
        |given, _| is_slab(given), |_, own| World { ends: Ends::AxesExchanged, ..own }),
    change(" with x turned", "does `x` count from the other end?",
        |given, _| given.is_plane(), |_, own| World { ends: Ends::OtherSide, ..own }),
    change(" of incompressible water", "is the storage of the water, n/K_w, missing from the mass balance?",
        |_, _| true, |_, own| with_water(own, 1e9)),
    change(" of water softer by n", "is K_w taken for K_w/n?",
        |_, _| true, |given, own| with_water(own, given.parameters.soil.porosity)),
    change(" of compressible water",
        "is the water of your solver compressible, so that `--reference terzaghi` is the right one?",
        |_, own| own.kind == ReferenceKind::TerzaghiIncompressible, |_, own| World { kind: ReferenceKind::Terzaghi, ..own }),
    change(" of compressible water",
        "is the water of your solver compressible, so that `--reference cosine-layer` is the right one?",
        |_, own| own.kind == ReferenceKind::CosineLayerIncompressible, |_, own| World { kind: ReferenceKind::CosineLayer, ..own }),
    change(" of the start at all times", "is the surface closed, so that nothing drains?",
        |_, own| own.is_slow(), |_, own| World { clock: [0.0, 0.0], ..own }),
    change(" of the start at all times", "is the surface closed, so that nothing drains?",
        |_, own| own.is_slow(), |_, own| World { clock: [0.0, 0.0], ends: Ends::Closed, ..own }),
    change(" of a skeleton without the pressure",
        "is the pore pressure missing from the momentum balance, so that the skeleton carries the load at once?",
        |given, own| own.is_slow() && given.moves() && given.has_pressure(), |_, own| World { is_coupled: false, ..own }),
    change(" of a slab whose load does not move to its middle", "is the top held plane by a rigid plate?",
        |given, _| is_slab(given) && !given.moves(), without_plate),
    change(" of another stiffness", "are λ and μ exchanged?",
        |given, _| given.is_plane() || is_slab(given), |_, own| with_moduli_exchanged(own)),
];

/// A slab of which every part carries its own load: a column of the slab's pressure at the start.
fn without_plate(given: &Given<'_>, own: World) -> World {
    let slab = Reference::new(ReferenceKind::Mandel, given.parameters, &[]).ok();
    let start = slab.and_then(|slab| slab.fields(EARLY, 1.0).ok()).map_or(0.0, |start| start.pressure);
    World { kind: ReferenceKind::TerzaghiIncompressible, pressure: start / given.parameters.load, ..own }
}

/// A world of λ for μ and μ for λ.
fn with_moduli_exchanged(own: World) -> World {
    let parameters = with_soils(&own.parameters, |layer| {
        let (young, nu) = (layer.youngs_modulus.unwrap_or(1.0), layer.poissons_ratio.unwrap_or(0.25));
        let shear = young / (2.0 * (1.0 + nu));
        let lame = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        layer.youngs_modulus = Some(lame * (3.0 * shear + 2.0 * lame) / (shear + lame));
        layer.poissons_ratio = Some(shear / (2.0 * (shear + lame)));
    });
    World { parameters, ..own }
}

/// A world whose water is stiffer by a factor.
fn with_water(own: World, factor: f64) -> World {
    let parameters = with_soils(&own.parameters, |layer| {
        layer.water_bulk_modulus = layer.water_bulk_modulus.map(|modulus| factor * modulus);
    });
    World { parameters, ..own }
}

/// A number of all columns that is fitted, with the names of some of its values.
pub struct Family {
    pub kind: Fitted,
    pub is_possible: fn(&Given<'_>, &World) -> bool,
    pub names: fn(&Given<'_>) -> Vec<(f64, String)>,
    /// The world of a number.
    pub of: fn(&Given<'_>, World, f64) -> World,
}

/// What the number of a family is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fitted {
    /// Factor of all times.
    Clock,
    /// Time that is added to all, s.
    Moment,
    /// Time over which the load rises, s.
    Ramp,
    /// Factor of the stiffness.
    Stiffness,
    /// Factor of the load.
    Load,
}

pub const FAMILIES: &[Family] = &[
    Family {
        kind: Fitted::Clock,
        is_possible: |_, own| own.is_slow(),
        names: clocks,
        of: |_, own, factor| World { clock: [factor, 0.0], ..own },
    },
    Family {
        kind: Fitted::Stiffness,
        is_possible: |given, own| {
            own.is_slow() && given.moves() && !matches!(own.kind, ReferenceKind::LargeStrain(_))
        },
        names: moduli,
        of: |_, own, factor| own.stiffer(factor),
    },
    Family {
        kind: Fitted::Load,
        // At small strain one column alone cannot tell the load from a factor of its own.
        is_possible: |given, own| {
            let tells = !given.is_linear() || (given.moves() && given.is_stressed());
            tells && !own.kind.is_manufactured()
        },
        names: |given| {
            let asked =
                |factor: f64| format!("is the load {} × that of the problem?", super::fits::shown(factor));
            let all = [2.0, 0.5, 10.0, 0.1, 1e3, 1e-3, 1e6, 1e-6].map(|factor| (factor, asked(factor)));
            all[..if given.moves() && given.is_stressed() { 8 } else { 2 }].to_vec()
        },
        of: |given, own, factor| own.loaded(factor, given),
    },
    Family {
        kind: Fitted::Moment,
        is_possible: |given, own| own.is_slow() && !given.kind.row().is_prepared,
        names: |_| Vec::new(),
        of: |_, own, moment| World { clock: [1.0, moment], ..own },
    },
    Family {
        kind: Fitted::Ramp,
        is_possible: |_, own| own.adds_up() && !own.parameters.self_weight,
        names: |_| Vec::new(),
        of: |_, own, ramp| World { ramp, ..own },
    },
];

/// Factors of the time that have a name, each with its question.
fn clocks(given: &Given<'_>) -> Vec<(f64, String)> {
    let soil = &given.parameters.soil;
    let (weight, gravity, n) = (soil.unit_weight_of_water(), soil.gravity, soil.porosity);
    let declared = given.mapping.units.time;
    let seconds = declared.seconds(1.0, given.parameters.time(1.0));
    let mut all: Vec<(f64, String)> = Vec::new();
    let mut unit = |name: &str, factor: f64| {
        all.push((factor, format!("are times in {name} where {} is declared?", declared.name())));
    };
    for (name, si) in TIMES.into_iter().filter(|(name, _)| *name != declared.name()) {
        unit(name, si / seconds);
    }
    if declared != TimeUnit::TimeFactor {
        unit("T_v", given.parameters.time(1.0) / seconds);
    }
    for (word, seconds) in [("min", 60.0), ("hour", 3_600.0), ("day", 86_400.0), ("year", 365.25 * 86_400.0)]
    {
        all.push((seconds, format!("is k in m/{word} taken for m/s?")));
        all.push((1.0 / seconds, format!("is k in m/s taken for m/{word}?")));
    }
    // With a porosity of a half both mistakes look alike.
    let [divided, multiplied] = if (n - 0.5).abs() < 0.01 {
        [
            "is k twice as large, or divided by the porosity?",
            "is k half as large, or multiplied by the porosity?",
        ]
    } else {
        ["is k divided by the porosity?", "is k multiplied by the porosity?"]
    };
    let others = [
        (gravity, "is γ_w taken as ρ_w, without g?"),
        (1.0 / gravity, "is γ_w multiplied by g once too often?"),
        (1.0 / VISCOSITY, "is k/μ taken for the hydraulic conductivity k?"),
        (VISCOSITY, "is k divided by μ where it should not be?"),
        (weight, "is k taken for k/γ_w?"),
        (1.0 / weight, "is k/γ_w, or k/μ in place of it, taken for the hydraulic conductivity k?"),
        (1.0 / n, divided),
        (n, multiplied),
    ];
    all.extend(others.map(|(factor, asked)| (factor, asked.to_owned())));
    if !given.moves() {
        // A stiffness shows in displacements, too; without any it may be meant.
        all.extend(moduli(given).into_iter().filter(|(_, asked)| !asked.contains("power of ten")));
    }
    let or_stiffness = if given.moves() { ", or c_v," } else { ", or c_v or E_oed," };
    let tens = (1..=9).flat_map(|power| [power, -power]);
    all.extend(tens.map(|power| (powi(10.0, power), format!("is k{or_stiffness} off by a power of ten?"))));
    all
}

/// Ratios of moduli that people take for one another, over the right one.
fn moduli(given: &Given<'_>) -> Vec<(f64, String)> {
    let soil = &given.parameters.soil;
    let (young, nu, oedometric) = (soil.youngs_modulus, soil.poissons_ratio, soil.oedometric_modulus());
    let bulk = young / (3.0 * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + nu));
    let lame = bulk - 2.0 * shear / 3.0;
    let mut all = vec![(oedometric / young, "is E_oed given as E?")];
    if !(given.is_plane() || is_slab(given)) {
        all.extend([
            (young / oedometric, "is E taken for E_oed?"),
            (bulk / oedometric, "is the bulk modulus K taken for E_oed?"),
            ((shear + 2.0 * lame) / oedometric, "are λ and μ exchanged?"),
            (
                young / (1.0 - nu * nu) / oedometric,
                "is the modulus of plane stress, E/(1 − ν²), taken for E_oed?",
            ),
            (shear / oedometric, "is the shear modulus G taken for E_oed?"),
            (2.0 * shear / oedometric, "is 2G taken for E_oed?"),
        ]);
    }
    let ten = "is E off by a power of ten, or in another unit?";
    all.extend([-6, -3, -2, -1, 1, 2, 3, 6].map(|power| (powi(10.0, power), ten)));
    let is_other = |(ratio, _): &(f64, &str)| *ratio > 0.0 && (ratio - 1.0).abs() > NAME;
    all.into_iter().filter(is_other).map(|(ratio, asked)| (ratio, asked.to_owned())).collect()
}
