//! Every printed bound holds: random parameters of every problem, against a second route of 31 digits.
//!
//! The second route is another formula wherever there is one: the Laplace transform where the solution is a series, the
//! matrix exponential where it is made of residues, closed forms in numbers of 31 digits. `OEDOMETER_RANDOM_DRAWS` asks for
//! more draws, `OEDOMETER_RANDOM_SEED` for others.

#![expect(
    clippy::unnecessary_wraps,
    clippy::large_types_passed_by_value,
    clippy::missing_panics_doc,
    reason = "every route has the type of the table of routes; a test panics"
)]

mod double;
mod routes;

use oedometer_exact::large_strain::diffusion::{LargeStrainModel, Water};
use oedometer_exact::manufactured::motion::{ManufacturedModel, Motion};
use oedometer_exact::{Base, ColumnParameters, MotionParameters, Reference, ReferenceKind, TextbookProblem};
use oedometer_soil::material::Material;
use std::fmt::Write as _;
use std::io::Write as _;

/// Draws of a problem of a call that asks for no other number.
const DRAWS: u64 = 12;

/// Numbers without pattern (splitmix64; Steele, Lea & Flood 2014).
pub struct Numbers(u64);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Between two numbers.
    pub fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between two powers of ten.
    pub fn decades(&mut self, least: f64, most: f64) -> f64 {
        10_f64.powf(self.between(least, most))
    }
}

/// A column in which no two numbers are equal.
fn column(numbers: &mut Numbers) -> ColumnParameters {
    let youngs_modulus = numbers.decades(4.0, 9.0);
    let poissons_ratio = if numbers.between(0.0, 1.0) < 0.2 {
        numbers.between(0.45, 0.4995)
    } else {
        numbers.between(-0.3, 0.45)
    };
    let soil = Material {
        youngs_modulus,
        poissons_ratio,
        porosity: numbers.between(0.1, 0.7),
        grain_density: numbers.between(1500.0, 4000.0),
        water_density: numbers.between(700.0, 1300.0),
        water_bulk_modulus: youngs_modulus * numbers.decades(-0.5, 4.0),
        hydraulic_conductivity: numbers.decades(-10.0, -3.0),
        gravity: numbers.between(1.0, 30.0),
        ..Material::default()
    };
    ColumnParameters {
        height: numbers.decades(-1.0, 1.5),
        length: numbers.decades(-0.5, 1.5),
        load: soil.oedometric_modulus() * numbers.decades(-6.0, -1.5),
        base: if numbers.between(0.0, 1.0) < 0.5 { Base::Rough } else { Base::Smooth },
        soil,
        ..ColumnParameters::default()
    }
}

/// What one draw of a problem comes to.
pub struct Compared {
    /// What is compared, found and by the second route, each over the load or the final settlement.
    pub pairs: Vec<(&'static str, f64, f64)>,
    /// The printed bound.
    pub bound: f64,
}

/// A problem's reference with its printed bound, at a time factor.
pub fn solution(kind: ReferenceKind, column: &ColumnParameters, time_factor: f64) -> (Reference, f64) {
    let reference = Reference::new(kind, column, &[time_factor])
        .unwrap_or_else(|error| panic!("{kind} of {column:?} at {time_factor}: {error}"));
    let accuracy = reference.accuracy(time_factor).expect("a time");
    (reference, accuracy.tail_bound + accuracy.round_off())
}

/// Pressure over the load and settlement over the final one, beside those of a second route.
pub fn compared(
    kind: ReferenceKind,
    column: &ColumnParameters,
    [time_factor, zeta]: [f64; 2],
    [pressure, settled]: [f64; 2],
) -> Compared {
    let (reference, bound) = solution(kind, column, time_factor);
    let computed = reference.fields(time_factor, zeta).expect("inside").pressure / column.load;
    let degree = reference.degree_of_consolidation(time_factor).expect("a time");
    Compared { pairs: vec![("pressure", computed, pressure), ("settlement", degree, settled)], bound }
}

type Route = fn(&mut Numbers, ColumnParameters) -> Option<Compared>;

const ROUTES: [(&str, Route); 27] = [
    ("terzaghi", |numbers, column| routes::columns::terzaghi(ReferenceKind::Terzaghi, numbers, &column)),
    ("terzaghi-incompressible", |numbers, column| {
        routes::columns::terzaghi(ReferenceKind::TerzaghiIncompressible, numbers, &column)
    }),
    ("biot-column", |numbers, column| {
        routes::columns::terzaghi(ReferenceKind::Textbook(TextbookProblem::BiotColumn), numbers, &column)
    }),
    ("single-mode", routes::columns::single_mode),
    ("xie-leo", |numbers, column| routes::columns::xie_leo(ReferenceKind::XieLeo, numbers, column)),
    ("large-strain", |numbers, column| {
        let model = LargeStrainModel { water: Water::Incompressible, ..LargeStrainModel::XIE_LEO };
        routes::columns::xie_leo(ReferenceKind::LargeStrain(model), numbers, column)
    }),
    ("davis-raymond", routes::columns::davis_raymond),
    ("seabed", routes::columns::seabed),
    ("sealed-element", routes::columns::sealed),
    ("at-rest", |numbers, column| {
        let place = [numbers.between(0.0, 9.0), numbers.between(0.0, 1.0)];
        let (reference, bound) = solution(ReferenceKind::AtRest, &column, place[0]);
        let fields = reference.fields(place[0], place[1]).expect("inside");
        Some(Compared { pairs: vec![("pressure", fields.pressure / column.load, 0.0)], bound })
    }),
    ("yield-front", routes::columns::yield_front),
    ("layered", routes::columns::layered),
    ("layered, early", routes::columns::layered_early),
    ("cryer", routes::bodies::cryer),
    ("barron", routes::bodies::barron),
    ("barron-free-strain", routes::bodies::free_strain),
    ("injection", routes::bodies::injection),
    ("mandel", routes::bodies::mandel),
    ("mandel, Biot", |numbers, column| {
        let column = routes::columns::with_grains(numbers, column);
        routes::bodies::mandel(numbers, column)
    }),
    ("cosine-layer", |numbers, column| {
        routes::layer::cosine_layer(ReferenceKind::CosineLayer, numbers, &column)
    }),
    ("cosine-layer-incompressible", |numbers, column| {
        routes::layer::cosine_layer(ReferenceKind::CosineLayerIncompressible, numbers, &column)
    }),
    ("dynamic-single-mode", |numbers, column| {
        routes::waves::released(ReferenceKind::DynamicSingleMode, numbers, &column)
    }),
    ("standing-wave", |numbers, column| {
        routes::waves::released(ReferenceKind::StandingWave, numbers, &column)
    }),
    ("dynamic-column", routes::waves::loaded),
    ("manufactured-box", |numbers, column| motion(Motion::Box, numbers, column)),
    ("manufactured-shear", |numbers, column| motion(Motion::Shear, numbers, column)),
    ("manufactured-vortex", |numbers, column| motion(Motion::Vortex, numbers, column)),
];

/// The pressure of a motion, docs/theory.md, Eq. 24.
fn motion(motion: Motion, numbers: &mut Numbers, mut column: ColumnParameters) -> Option<Compared> {
    use double::{PI, d};
    let [time, zeta] = [numbers.between(0.0, 2.0), numbers.between(0.0, 1.0)];
    let mut size = || numbers.between(-0.08, 0.08);
    let [amplitude_x, amplitude_y, amplitude] = [size(), size(), size()];
    column.motion =
        MotionParameters { amplitude_x, amplitude_y, amplitude, frequency: numbers.decades(-1.0, 1.0) };
    column.soil.porosity = 0.4;
    let kind = ReferenceKind::Manufactured(ManufacturedModel::with_default_law(motion));
    let (reference, bound) = solution(kind, &column, time);
    let computed = reference.fields(time, zeta).expect("inside").pressure / column.load;
    let [[sine, _], [_, cosine]] = [(PI * d(2.0 * time)).sincos(), (PI * (d(1.0) - d(zeta))).sincos()];
    Some(Compared { pairs: vec![("pressure", computed, (sine * cosine).value())], bound })
}

#[test]
fn every_printed_bound_holds() {
    let asked = |variable: &str, otherwise: u64| {
        std::env::var(variable).map_or(otherwise, |typed| typed.parse().expect("a whole number"))
    };
    let (draws, seed) = (asked("OEDOMETER_RANDOM_DRAWS", DRAWS), asked("OEDOMETER_RANDOM_SEED", 62));
    let (mut table, mut wrong) = (String::new(), Vec::new());
    for (name, route) in ROUTES {
        let (mut compared, mut worst, mut largest) = (0, 0.0_f64, 0.0_f64);
        for draw in 0..draws {
            let hash = name.bytes().fold(seed, |hash, byte| hash.wrapping_mul(31).wrapping_add(byte.into()));
            let mut numbers = Numbers(hash.wrapping_add(draw.wrapping_mul(0xd1b5_4a32_d192_ed03)));
            let column = column(&mut numbers);
            let Some(Compared { pairs, bound }) = route(&mut numbers, column) else { continue };
            compared += 1;
            for (what, computed, second) in pairs {
                let difference = (computed - second).abs();
                worst = worst.max(difference / bound);
                largest = largest.max(difference);
                if difference.is_nan() || difference > bound {
                    wrong.push(format!(
                        "{name}, draw {draw}: the {what} {computed:e} is {second:e} by the second route, off by \
                         {difference:.1e}, and {bound:.1e} is printed"
                    ));
                }
            }
        }
        assert!(compared * 3 >= draws, "{name}: {compared} of {draws} draws are compared");
        writeln!(table, "{name:28} {compared:5} {largest:9.1e} {worst:9.3} of the bound").expect("memory");
    }
    let _ = writeln!(std::io::stdout(), "{table}");
    assert!(wrong.is_empty(), "{}\n{table}", wrong.join("\n"));
}
