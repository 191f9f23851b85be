//! Spheres, cylinders, slabs and an infinite body.

use crate::double::{Complex, Double, GAMMA, ONE, PI, c, d, inverse};
use crate::routes::{Biot, columns::with_grains};
use crate::{Compared, Numbers, compared, solution};
use oedometer_exact::mandel::Mandel;
use oedometer_exact::{ColumnParameters, ReferenceKind, Solution, TextbookProblem};

/// From `C = −qE/(Ks) + 4Gα p̄/(3K)` and `P = −α C/(E S) (1 − sinh √s r/(r sinh √s))`.
pub fn cryer(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let column = with_grains(numbers, column);
    let soil = Biot::new(&column);
    let zeta = numbers.between(0.0, 0.999);
    let radius = ONE - d(zeta);
    let time = numbers.decades(-4.0, 0.5);
    let [pressure, mean] = inverse(d(time) * soil.diffusivity_ratio(), |s| {
        let root = s.sqrt();
        let drained = c(ONE) - c(d(3.0)) * (root / root.tanh() - c(ONE)) / s;
        let share = d(4.0) * soil.shear * soil.alpha * soil.alpha
            / (d(3.0) * soil.bulk * soil.modulus * soil.storage);
        let sides = c(soil.modulus / soil.bulk) / (s * (c(ONE) + c(share) * drained));
        let scale = c(soil.alpha * soil.diffusivity_ratio());
        [scale * sides * (c(ONE) - root.sinh_ratio(radius) / c(radius)), scale * sides * drained]
    });
    let kind = ReferenceKind::Textbook(TextbookProblem::Cryer);
    Some(compared(kind, &column, [time, zeta], [pressure, 1.0 - soil.alpha.value() * mean]))
}

/// A cylinder: inner radius over the outer one, and `c_v t/r_e²`.
fn cylinder(numbers: &mut Numbers, column: &mut ColumnParameters, time: f64) -> [Double; 2] {
    column.textbook.drain_radius = column.height * numbers.decades(-1.5, 0.3);
    let (drain, height) = (d(column.textbook.drain_radius), d(column.height));
    let outer = drain + height;
    [drain / outer, d(time) * height * height / (outer * outer)]
}

pub fn barron(numbers: &mut Numbers, mut column: ColumnParameters) -> Option<Compared> {
    let [time, zeta] = [numbers.decades(-4.0, 0.5), numbers.between(0.0, 1.0)];
    let [inner, reached] = cylinder(numbers, &mut column, time);
    let (n, four) = (ONE / inner, d(4.0));
    let square = n * n;
    let spacing = square / (square - ONE) * n.ln() - (d(3.0) * square - ONE) / (four * square);
    let mean = (-(d(2.0) * reached / spacing)).exp();
    // ζ = 0 is the drain.
    let radius = inner + (ONE - inner) * d(zeta);
    let profile = (radius / inner).ln() - (radius * radius - inner * inner) * d(0.5);
    let pressure = mean * profile / spacing;
    let kind = ReferenceKind::Textbook(TextbookProblem::Barron);
    Some(compared(kind, &column, [time, zeta], [pressure.value(), (ONE - mean).value()]))
}

/// `I₀`, `I₁`, `K₀` and `K₁` by their series and the Wronskian.
fn bessel(z: Complex) -> [Complex; 4] {
    let quarter = z * z * c(d(0.25));
    let (mut term, mut harmonic) = (c(ONE), d(0.0));
    let (mut even, mut odd, mut second) = (c(ONE), c(ONE), c(d(0.0)));
    for k in 1..120 {
        let number = d(f64::from(k));
        term = term * quarter / c(number * number);
        harmonic = harmonic + ONE / number;
        even = even + term;
        odd = odd + term / c(number + ONE);
        second = second + term * c(harmonic);
    }
    let first = odd * z * c(d(0.5));
    let zeroth = second - ((z * c(d(0.5))).ln() + c(GAMMA)) * even;
    [even, first, zeroth, (c(ONE) / z - first * zeroth) / even]
}

pub fn free_strain(numbers: &mut Numbers, mut column: ColumnParameters) -> Option<Compared> {
    let zeta = numbers.between(0.0, 1.0);
    column.textbook.drain_radius = column.height * numbers.decades(-1.0, 0.3);
    // Late enough for the series of K₀.
    let (drain, height) = (d(column.textbook.drain_radius), d(column.height));
    let outer = drain + height;
    let time = numbers.between(0.3, 1.5) * (outer * outer / (height * height)).value();
    let inner = drain / outer;
    let reached = d(time) * height * height / (outer * outer);
    let radius = inner + (ONE - inner) * d(zeta);
    let [pressure, mean] = inverse(reached, |s| {
        let root = s.sqrt();
        let ([_, i1, _, k1], [at_drain, at_radius]) =
            (bessel(root), [inner, radius].map(|at| bessel(root * c(at))));
        let within = at_drain[0] * k1 + at_drain[2] * i1;
        let pressure = (c(ONE) - (at_radius[0] * k1 + at_radius[2] * i1) / within) / s;
        // What has left through the drain.
        let flux = (at_drain[1] * k1 - at_drain[3] * i1) * root / within;
        let left = -(flux * c(d(2.0) * inner / (ONE - inner * inner))) / (s * s);
        [pressure, c(ONE) / s - left]
    });
    let kind = ReferenceKind::Textbook(TextbookProblem::BarronFreeStrain);
    Some(compared(kind, &column, [time, zeta], [pressure, 1.0 - mean]))
}

/// Closed form; near the source the pressure is many loads, and is compared with itself.
pub fn injection(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let column = with_grains(numbers, column);
    let (time, distance) = (numbers.decades(-2.0, 2.0), numbers.decades(-1.5, 0.0));
    let soil = Biot::new(&column);
    let zeta = 1.0 - distance;
    let distance = ONE - d(zeta);
    let root = (soil.diffusivity_ratio() * d(time)).sqrt();
    let [near, far] = [distance, ONE].map(|at| at / (d(2.0) * root));
    let pushed = far.erfc() * d(0.5) + far.erf() / (d(4.0) * far * far)
        - (-(far * far)).exp() / (d(2.0) * PI.sqrt() * far);
    let kind = ReferenceKind::Textbook(TextbookProblem::Injection);
    let (reference, bound) = solution(kind, &column, time);
    let computed = reference.fields(time, zeta).expect("inside").pressure / column.load * distance.value();
    let degree = reference.degree_of_consolidation(time).expect("a time");
    let pairs =
        vec![("pressure", computed, near.erfc().value()), ("settlement", degree, (d(2.0) * pushed).value())];
    Some(Compared { pairs, bound })
}

/// The slab's transform from its balances: no stress at the sides, `ε_yy` the same everywhere.
pub fn mandel(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let soil = Biot::new(&column);
    let (time, distance) = (numbers.decades(-4.0, 0.7), numbers.between(0.0, 1.0));
    let Biot { modulus, lame, shear, alpha, .. } = soil;
    let two = d(2.0);
    let coupled = two * shear * alpha * soil.diffusivity_ratio();
    let second = inverse(d(time) * soil.diffusivity_ratio(), |s| {
        let root = s.sqrt();
        let drained = c(ONE) - root.tanh() / root;
        let stiff = c((modulus * modulus - lame * lame) / modulus);
        let strain = c(ONE) / (s * (stiff + c(two * shear * alpha / modulus * coupled) * drained));
        let place = d(distance);
        let pressure = c(coupled) * strain * (c(ONE) - root.cosh_ratio(place));
        let within = c(place) - root.sinh_ratio(place) * root.tanh() / root;
        let moved = (c(alpha * coupled) * strain * within + c(lame * place) * strain) / c(modulus);
        let stress = stiff * strain + c(two * shear * alpha / modulus) * pressure;
        [pressure, stress, moved * c(shear), strain * c(shear)]
    });
    let ratios = Mandel::new(&column).expect("possible").ratios(time, distance).expect("inside");
    let bound = {
        let accuracy = Mandel::new(&column).expect("possible").accuracy(time).expect("a time");
        accuracy.tail_bound + accuracy.round_off()
    };
    let computed = [ratios.pressure, ratios.stress, ratios.displacement, ratios.strain];
    let names = ["pressure", "stress", "displacement", "strain"];
    let pairs = (0..4).map(|part| (names[part], computed[part], second[part])).collect();
    Some(Compared { pairs, bound })
}
