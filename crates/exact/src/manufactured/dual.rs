//! Automatic differentiation of the formulas of a motion, at four places at once.
//!
//! A manufactured motion is written down once, as a formula; accelerations, divergences and sources follow from it to
//! round-off. [`Dual`] is a number with its derivatives along X, Y and t; a dual number of dual numbers ([`Jet`]) has the
//! second derivatives too. [`Four`] holds the numbers of four places side by side, so that the compiler uses registers of
//! four numbers; every operation is that of single numbers, place by place, with the same bits.
//!
//! `num-dual` has such numbers too, but for one place at a time, and takes sines from the platform's library, whose last
//! digits differ from machine to machine.

use oedometer_soil::elementary;
use std::ops::{Add, Mul, Sub};

/// Directions of derivatives: X, Y (1/m) and t (1/s).
pub const DIRECTIONS: usize = 3;
/// The direction of time.
pub const TIME: usize = 2;

/// A number that can be differentiated.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
    /// A number that does not vary.
    fn constant(value: f64) -> Self;

    /// One over it.
    #[must_use]
    fn recip(self) -> Self;

    /// The natural logarithm.
    #[must_use]
    fn ln(self) -> Self;

    /// The sine and the cosine.
    fn sincos(self) -> [Self; 2];

    /// `inside` where a number is positive, elsewhere `outside`.
    fn where_positive(number: Four, inside: Self, outside: Self) -> Self;
}

/// A number with its derivatives along X, Y and t.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Dual<T> {
    /// The value.
    pub value: T,
    /// Derivatives along X, Y and t.
    pub slope: [T; DIRECTIONS],
}

/// A value with its first derivatives.
pub type Slope = Dual<Four>;
/// A value with its first and second derivatives: value and slopes, each with its own slopes.
pub type Jet = Dual<Slope>;

/// An array from its places.
#[inline(always)]
fn each<T>(of: impl Fn(usize) -> T) -> [T; DIRECTIONS] {
    [of(0), of(1), of(2)]
}

impl<T: Number> Dual<T> {
    /// A function of it, given the function's value and derivative there.
    #[inline(always)]
    fn chain(self, value: T, derivative: T) -> Self {
        Self { value, slope: each(|i| derivative * self.slope[i]) }
    }

    /// The coordinate of a direction, at a value.
    #[inline(always)]
    pub fn coordinate(direction: usize, value: T) -> Self {
        Self { value, slope: each(|i| T::constant(if i == direction { 1.0 } else { 0.0 })) }
    }
}

impl Slope {
    /// The slopes of the natural logarithm alone, about a value of zero: where only they are asked for, the logarithm
    /// need not be taken.
    #[inline(always)]
    pub fn ln_slopes(self) -> Self {
        self.chain(Four::all(0.0), self.value.recip())
    }
}

impl Jet {
    /// A function of the place times one of the time, as value and two derivatives: most of a product's terms are
    /// zero.
    #[inline(always)]
    pub fn growing(shape: &Shape, [now, rate, bend]: [f64; 3]) -> Self {
        let Shape { value, slope: [x, y], bend: [xx, xy, yy] } = *shape;
        let dual = |value: Four, slope: [Four; DIRECTIONS]| Dual { value, slope };
        Self {
            value: dual(value * now, [x * now, y * now, value * rate]),
            slope: [
                dual(x * now, [xx * now, xy * now, x * rate]),
                dual(y * now, [xy * now, yy * now, y * rate]),
                dual(value * rate, [x * rate, y * rate, value * bend]),
            ],
        }
    }

    /// Adds a coordinate in a direction.
    #[inline(always)]
    pub fn from_place(self, direction: usize, coordinate: Four) -> Self {
        self + Self::coordinate(direction, Slope::coordinate(direction, coordinate))
    }
}

impl<T: Number> Number for Dual<T> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value: T::constant(value), slope: [T::constant(0.0); DIRECTIONS] }
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let recip = self.value.recip();
        self.chain(recip, recip * -1.0 * recip)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }

    #[inline(always)]
    fn sincos(self) -> [Self; 2] {
        let [sine, cosine] = self.value.sincos();
        [self.chain(sine, cosine), self.chain(cosine, sine * -1.0)]
    }

    #[inline(always)]
    fn where_positive(number: Four, inside: Self, outside: Self) -> Self {
        let pick = |inside, outside| T::where_positive(number, inside, outside);
        Self {
            value: pick(inside.value, outside.value),
            slope: each(|i| pick(inside.slope[i], outside.slope[i])),
        }
    }
}

impl<T: Number> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: each(|i| self.slope[i] + other.slope[i]) }
    }
}

impl<T: Number> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: each(|i| self.slope[i] - other.slope[i]) }
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "the rule of a product's derivative")]
impl<T: Number> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slope = each(|i| self.value * other.slope[i] + other.value * self.slope[i]);
        Self { value: self.value * other.value, slope }
    }
}

impl<T: Number> Mul<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { value: self.value * factor, slope: each(|i| self.slope[i] * factor) }
    }
}

impl<T: Number> Add<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, constant: f64) -> Self {
        self + Self::constant(constant)
    }
}

/// A function of the place alone: its value with first and second derivatives along X and Y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Shape {
    /// The value.
    pub value: Four,
    /// Derivatives along X and Y.
    pub slope: [Four; 2],
    /// Second derivatives: along X, mixed, and along Y.
    pub bend: [Four; 3],
}

impl Shape {
    /// The product of a function of X and one of Y, each as value and two derivatives.
    #[inline(always)]
    pub fn product(along: [Four; 3], up: [Four; 3]) -> Self {
        Self {
            value: along[0] * up[0],
            slope: [along[1] * up[0], along[0] * up[1]],
            bend: [along[2] * up[0], along[1] * up[1], along[0] * up[2]],
        }
    }
}

/// Places that are taken at a time.
pub const PLACES: usize = 4;

/// A number of each of four places.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Four(pub [f64; PLACES]);

/// The numbers of four places from those of each.
#[inline(always)]
fn four(of: impl Fn(usize) -> f64) -> Four {
    Four([of(0), of(1), of(2), of(3)])
}

impl Four {
    /// One number for all places.
    #[inline(always)]
    pub fn all(number: f64) -> Self {
        Self([number; PLACES])
    }

    /// The number of the first place.
    #[inline(always)]
    pub fn first(self) -> f64 {
        self.0[0]
    }

    /// Their quotients.
    #[inline(always)]
    pub fn over(self, divisor: Self) -> Self {
        four(|place| self.0[place] / divisor.0[place])
    }
}

impl Number for Four {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::all(value)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        four(|place| 1.0 / self.0[place])
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Self(elementary::ln_of_each(&self.0))
    }

    #[inline]
    fn sincos(self) -> [Self; 2] {
        let of_each = self.0.map(elementary::sincos);
        [Self(of_each.map(|(sine, _)| sine)), Self(of_each.map(|(_, cosine)| cosine))]
    }

    #[inline(always)]
    fn where_positive(number: Four, inside: Self, outside: Self) -> Self {
        four(|place| if number.0[place] > 0.0 { inside.0[place] } else { outside.0[place] })
    }
}

impl Add for Four {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        four(|place| self.0[place] + other.0[place])
    }
}

impl Add<f64> for Four {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        four(|place| self.0[place] + other)
    }
}

impl Sub for Four {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        four(|place| self.0[place] - other.0[place])
    }
}

impl Mul for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        four(|place| self.0[place] * other.0[place])
    }
}

impl Mul<f64> for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        four(|place| self.0[place] * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// X, Y and t of four places.
    const PLACES_AND_TIMES: [[f64; PLACES]; DIRECTIONS] =
        [[0.7, -0.2, 1.1, 0.3], [-0.4, 0.6, 0.1, -1.2], [1.3, 0.2, -0.7, 0.9]];

    fn coordinates() -> [Jet; DIRECTIONS] {
        each(|direction| Jet::constant(0.0).from_place(direction, Four(PLACES_AND_TIMES[direction])))
    }

    fn single(place: usize) -> [f64; DIRECTIONS] {
        PLACES_AND_TIMES.map(|of_places| of_places[place])
    }

    /// `sin(x y) cos(t) + (x − y t)²` by its own derivatives.
    #[test]
    fn a_jet_has_the_derivatives_of_its_formula() {
        let [jx, jy, jt] = coordinates();
        let rest = jx - jy * jt;
        let jet = (jx * jy).sincos()[0] * jt.sincos()[1] + rest * rest;
        for place in 0..PLACES {
            let [x, y, t] = single(place);
            let (s, c, rest) = ((x * y).sin(), (x * y).cos(), x - y * t);
            let slope = [
                y * c * t.cos() + 2.0 * rest,
                x * c * t.cos() - 2.0 * t * rest,
                -s * t.sin() - 2.0 * y * rest,
            ];
            for (got, exact) in jet.value.slope.iter().zip(slope) {
                assert!((got.0[place] - exact).abs() < 1e-15, "{got:?} for {exact}");
            }
            let bend = [
                (0, 0, -y * y * s * t.cos() + 2.0),
                (0, 1, (c - x * y * s) * t.cos() - 2.0 * t),
                (1, 2, -x * c * t.sin() - 2.0 * rest + 2.0 * t * y),
                (2, 2, -s * t.cos() + 2.0 * y * y),
            ];
            for (i, j, exact) in bend {
                assert!(
                    (jet.slope[i].slope[j].0[place] - exact).abs() < 1e-14,
                    "{i}{j}: {jet:?} for {exact}"
                );
                assert!(
                    (jet.slope[j].slope[i].0[place] - exact).abs() < 1e-14,
                    "{i}{j}: {jet:?} for {exact}"
                );
            }
        }
    }

    /// `x + sin(x) y² · t³`: what grows is the product of its parts.
    #[test]
    fn what_grows_is_the_product_of_a_shape_and_of_a_time() {
        let [x, y, _] = PLACES_AND_TIMES.map(Four);
        let t = 1.3;
        let [sine, cosine] = x.sincos();
        let shape = Shape::product([sine, cosine, sine * -1.0], [y * y, y * 2.0, Four::all(2.0)]);
        let grown = Jet::growing(&shape, [t * t * t, 3.0 * t * t, 6.0 * t]).from_place(0, x);
        let [jx, jy, _] = coordinates();
        let jt = Jet::constant(0.0).from_place(TIME, Four::all(t));
        let product = jx + jx.sincos()[0] * jy * jy * jt * jt * jt;
        let is_near = |a: Four, b: Four| (a - b).0.iter().all(|off| off.abs() < 1e-14);
        assert!(is_near(grown.value.value, product.value.value));
        for i in 0..DIRECTIONS {
            assert!(is_near(grown.value.slope[i], product.value.slope[i]), "{i}");
            for j in 0..DIRECTIONS {
                assert!(is_near(grown.slope[i].slope[j], product.slope[i].slope[j]), "{i}{j}");
            }
        }
    }

    #[test]
    fn a_slope_has_the_derivative_of_a_quotient_and_of_a_logarithm() {
        let [a, b] = [[2.0, 3.0, 0.5, 1.0], [5.0, 0.25, 2.0, 7.0]].map(|values| {
            let value = Four(values);
            Slope { value, slope: [Four::all(1.0), value * 0.5, Four::all(-3.0)] }
        });
        let (quotient, logarithm) = (a * b.recip(), b.ln());
        for place in 0..PLACES {
            let value = |of: Four| of.0[place];
            let divisor = value(b.value);
            assert!((value(logarithm.value) - divisor.ln()).abs() < 1e-15);
            for i in 0..DIRECTIONS {
                let over = value(a.slope[i]) * divisor - value(a.value) * value(b.slope[i]);
                let exact = over / (divisor * divisor);
                assert!((value(quotient.slope[i]) - exact).abs() < 1e-14 * (1.0 + exact.abs()));
                assert!((value(logarithm.slope[i]) - value(b.slope[i]) / divisor).abs() < 1e-15);
            }
        }
    }
}
