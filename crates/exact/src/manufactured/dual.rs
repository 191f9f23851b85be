//! Automatic differentiation of the formulas of a motion, at four places at once.
//!
//! A manufactured motion is written down once, as a formula; accelerations, divergences and sources follow from it to
//! round-off. [`Dual`] is a number with its derivatives along X, Y and t; a [`Jet`] has the second derivatives too, each of
//! the mixed ones once. [`Four`] holds the numbers of four places side by side, so that the compiler uses registers of four
//! numbers; every operation is that of single numbers, place by place, with the same bits.
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

    /// Reciprocal.
    #[must_use]
    fn recip(self) -> Self;

    /// The natural logarithm.
    #[must_use]
    fn ln(self) -> Self;

    /// The sine and the cosine.
    fn sincos(self) -> [Self; 2];
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

/// A value with its first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Jet {
    /// The value.
    pub value: Four,
    /// Derivatives along X, Y and t.
    pub slope: [Four; DIRECTIONS],
    /// Second derivatives along the [`PAIRS`] of directions.
    bend: [Four; PAIRS.len()],
}

/// Unordered pairs of directions.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];
/// Number of each pair, `[direction][direction]`.
const PAIR_OF: [[usize; DIRECTIONS]; DIRECTIONS] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

/// An array of a component per direction.
#[inline(always)]
fn each<T>(component: impl Fn(usize) -> T) -> [T; DIRECTIONS] {
    [component(0), component(1), component(2)]
}

impl<T: Number> Dual<T> {
    /// A function of the number by the chain rule, from the value and derivative of the function.
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
    /// The slopes of the natural logarithm, with a value of zero: no logarithm is evaluated.
    #[inline(always)]
    pub fn ln_slopes(self) -> Self {
        self.chain(Four::all(0.0), self.value.recip())
    }
}

impl Jet {
    /// A jet from its value, its slopes by direction and its second derivatives by number and pair.
    #[inline(always)]
    fn from_parts(
        value: Four,
        slope: impl Fn(usize) -> Four,
        bend: impl Fn(usize, [usize; 2]) -> Four,
    ) -> Self {
        let pair = |number: usize| bend(number, PAIRS[number]);
        let bend = [pair(0), pair(1), pair(2), pair(3), pair(4), pair(5)];
        Self { value, slope: each(slope), bend }
    }

    /// A function of the place times one of the time, as value and two derivatives.
    #[inline(always)]
    pub fn growing(shape: &Shape, [now, rate, bend]: [f64; 3]) -> Self {
        let Shape { value, slope: [x, y], bend: [xx, xy, yy] } = *shape;
        Self {
            value: value * now,
            slope: [x * now, y * now, value * rate],
            bend: [xx * now, xy * now, x * rate, yy * now, y * rate, value * bend],
        }
    }

    /// The coordinate of a direction, at a value.
    #[inline(always)]
    pub fn coordinate(direction: usize, value: Four) -> Self {
        let zero = Four::all(0.0);
        let Slope { value, slope } = Slope::coordinate(direction, value);
        Self { value, slope, bend: [zero; PAIRS.len()] }
    }

    /// Product with the coordinate of a direction, at a value.
    #[inline(always)]
    pub fn times_coordinate(self, direction: usize, value: Four) -> Self {
        let along =
            |i: usize, part: Four, by: Four| if i == direction { part * value + by } else { part * value };
        Self::from_parts(
            self.value * value,
            #[inline(always)]
            |i| along(i, self.slope[i], self.value),
            #[inline(always)]
            |number, [i, j]| {
                let bend = along(i, self.bend[number], self.slope[j]);
                if j == direction { bend + self.slope[i] } else { bend }
            },
        )
    }

    /// Derivative along a direction.
    #[inline(always)]
    pub fn derivative(&self, direction: usize) -> Slope {
        Slope { value: self.slope[direction], slope: each(|i| self.bend[PAIR_OF[direction][i]]) }
    }

    /// A function of the jet by the chain rule, from the value and the first two derivatives of the function.
    #[inline(always)]
    fn chain(self, value: Four, first: Four, second: Four) -> Self {
        Self::from_parts(
            value,
            #[inline(always)]
            |i| first * self.slope[i],
            #[inline(always)]
            |number, [i, j]| first * self.bend[number] + second * self.slope[i] * self.slope[j],
        )
    }

    /// The sine and the cosine.
    #[inline(always)]
    pub fn sincos(self) -> [Self; 2] {
        let [sine, cosine] = self.value.sincos();
        let [less_sine, less_cosine] = [sine * -1.0, cosine * -1.0];
        [self.chain(sine, cosine, less_sine), self.chain(cosine, less_sine, less_cosine)]
    }

    /// `inside` at places with a positive number, `outside` at the others.
    #[inline(always)]
    pub fn where_positive(number: Four, inside: Self, outside: Self) -> Self {
        let pick = |inside: Four, outside: Four| {
            four(|place| if number.0[place] > 0.0 { inside.0[place] } else { outside.0[place] })
        };
        Self::from_parts(
            pick(inside.value, outside.value),
            #[inline(always)]
            |i| pick(inside.slope[i], outside.slope[i]),
            #[inline(always)]
            |number, _| pick(inside.bend[number], outside.bend[number]),
        )
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::from_parts(
            self.value + other.value,
            #[inline(always)]
            |i| self.slope[i] + other.slope[i],
            #[inline(always)]
            |number, _| self.bend[number] + other.bend[number],
        )
    }
}

impl Sub for Jet {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::from_parts(
            self.value - other.value,
            #[inline(always)]
            |i| self.slope[i] - other.slope[i],
            #[inline(always)]
            |number, _| self.bend[number] - other.bend[number],
        )
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    #[inline(always)]
    fn add(self, constant: f64) -> Self {
        Self { value: self.value + constant, ..self }
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

/// The numbers of four places from a function of the place.
#[inline(always)]
fn four(value: impl Fn(usize) -> f64) -> Four {
    Four([value(0), value(1), value(2), value(3)])
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

    /// A dual number of dual numbers: second derivatives by the rules of the first ones alone.
    type Nested = Dual<Slope>;

    /// The coordinate of a direction.
    fn nested(direction: usize, value: Four) -> Nested {
        Nested::coordinate(direction, Slope::coordinate(direction, value))
    }

    fn coordinates() -> [Nested; DIRECTIONS] {
        each(|direction| nested(direction, Four(PLACES_AND_TIMES[direction])))
    }

    fn single(place: usize) -> [f64; DIRECTIONS] {
        PLACES_AND_TIMES.map(|of_places| of_places[place])
    }

    /// `sin(x y) cos(t) + (x − y t)²` by its own derivatives.
    #[test]
    fn a_dual_number_of_dual_numbers_has_the_derivatives_of_its_formula() {
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

    /// Holds a jet against nested dual numbers.
    fn assert_same(jet: &Jet, nested: &Nested) {
        let is_near =
            |a: Four, b: Four| (0..PLACES).all(|p| (a.0[p] - b.0[p]).abs() < 1e-14 * (1.0 + b.0[p].abs()));
        assert!(is_near(jet.value, nested.value.value));
        for i in 0..DIRECTIONS {
            assert!(is_near(jet.slope[i], nested.value.slope[i]), "{i}");
            for j in 0..DIRECTIONS {
                assert!(is_near(jet.derivative(i).slope[j], nested.slope[i].slope[j]), "{i}{j}");
            }
        }
    }

    /// `x + sin(x) y² · t³`, its sine and cosine, and those times coordinates.
    #[test]
    fn a_jet_has_the_derivatives_of_nested_dual_numbers() {
        let [x, y, _] = PLACES_AND_TIMES.map(Four);
        let t = 1.3;
        let [sine, cosine] = x.sincos();
        let shape = Shape::product([sine, cosine, sine * -1.0], [y * y, y * 2.0, Four::all(2.0)]);
        let grown = Jet::growing(&shape, [t * t * t, 3.0 * t * t, 6.0 * t]) + Jet::coordinate(0, x);
        let [nx, ny, _] = coordinates();
        let nt = nested(TIME, Four::all(t));
        let product = nx + nx.sincos()[0] * ny * ny * nt * nt * nt;
        assert_same(&grown, &product);
        let ([sine, cosine], [nested_sine, nested_cosine]) = (grown.sincos(), product.sincos());
        assert_same(&sine, &nested_sine);
        assert_same(&(cosine + 0.5), &(nested_cosine + 0.5));
        let turned = cosine.times_coordinate(0, x) - sine.times_coordinate(1, y);
        let expected = nested_cosine * nx - nested_sine * ny;
        assert_same(&turned, &expected);
        let picked = Jet::where_positive(x, turned, sine);
        for place in 0..PLACES {
            let mixed_derivative = |jet: &Jet| jet.derivative(0).slope[TIME].0[place];
            assert_eq!(
                mixed_derivative(&picked),
                mixed_derivative(if x.0[place] > 0.0 { &turned } else { &sine }),
                "{place}"
            );
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
            let value = |numbers: Four| numbers.0[place];
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
