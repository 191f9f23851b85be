//! Numbers that know their derivatives along X, Y and t: of first order ([`Slope`]) and of second ([`Jet`]).
//!
//! A manufactured motion is written down once, as a formula; everything that follows from it, accelerations,
//! divergences and sources, comes out of the arithmetic to round-off and without a formula of its own.

use crate::elementary;
use std::ops::{Add, Div, Mul, Sub};

/// Directions of derivatives: X, Y (1/m) and t (1/s).
pub const DIRECTIONS: usize = 3;
/// The direction of time.
pub const TIME: usize = 2;

/// A value with its first derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Slope {
    /// The value.
    pub value: f64,
    /// Derivatives along X, Y and t.
    pub slope: [f64; DIRECTIONS],
}

/// A value with its first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// Derivatives along X, Y and t.
    pub slope: [f64; DIRECTIONS],
    /// Second derivatives, `[direction][direction]`, symmetric.
    pub bend: [[f64; DIRECTIONS]; DIRECTIONS],
}

/// A function of the place alone: its value with first and second derivatives along X and Y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Shape {
    /// The value.
    pub value: f64,
    /// Derivatives along X and Y.
    pub slope: [f64; 2],
    /// Second derivatives, `[direction][direction]`, symmetric.
    pub bend: [[f64; 2]; 2],
}

impl Shape {
    /// The product of a function of X and one of Y, each as value and two derivatives.
    #[inline]
    pub fn product(along: [f64; 3], up: [f64; 3]) -> Self {
        let mixed = along[1] * up[1];
        Self {
            value: along[0] * up[0],
            slope: [along[1] * up[0], along[0] * up[1]],
            bend: [[along[2] * up[0], mixed], [mixed, along[0] * up[2]]],
        }
    }
}

/// An array from its places.
#[inline]
fn each<T>(of: impl Fn(usize) -> T) -> [T; DIRECTIONS] {
    std::array::from_fn(of)
}

impl Slope {
    /// A number that does not vary.
    #[inline]
    pub fn constant(value: f64) -> Self {
        Self { value, slope: [0.0; DIRECTIONS] }
    }

    /// A function of it, given its value and derivative there.
    #[inline]
    fn chain(self, [value, derivative]: [f64; 2]) -> Self {
        Self { value, slope: self.slope.map(|slope| derivative * slope) }
    }

    /// The product, by its rule.
    #[inline]
    fn times(self, other: Self) -> Self {
        let slope = each(|i| self.value * other.slope[i] + other.value * self.slope[i]);
        Self { value: self.value * other.value, slope }
    }

    /// The natural logarithm.
    #[inline]
    pub fn ln(self) -> Self {
        self.chain([elementary::ln(self.value), 1.0 / self.value])
    }

    /// The slopes of the natural logarithm alone, about a value of zero: where only they are asked for, the logarithm
    /// need not be taken.
    #[inline]
    pub fn ln_slopes(self) -> Self {
        self.chain([0.0, 1.0 / self.value])
    }

    /// One over it.
    #[inline]
    pub fn recip(self) -> Self {
        let recip = 1.0 / self.value;
        self.chain([recip, -recip * recip])
    }
}

impl Jet {
    /// The coordinate of a direction, at a value.
    #[inline]
    pub fn coordinate(direction: usize, value: f64) -> Self {
        let slope = each(|i| if i == direction { 1.0 } else { 0.0 });
        Self { value, slope, bend: [[0.0; DIRECTIONS]; DIRECTIONS] }
    }

    /// A function of the place times one of the time, as value and two derivatives: most of a product's terms are
    /// zero.
    #[inline]
    pub fn growing(shape: &Shape, [now, rate, bend]: [f64; 3]) -> Self {
        let Shape { value, slope: [x, y], bend: [[xx, xy], [_, yy]] } = *shape;
        Self {
            value: now * value,
            slope: [now * x, now * y, rate * value],
            bend: [
                [now * xx, now * xy, rate * x],
                [now * xy, now * yy, rate * y],
                [rate * x, rate * y, bend * value],
            ],
        }
    }

    /// It and a coordinate, in whose direction it is.
    #[inline]
    pub fn from_place(mut self, direction: usize, coordinate: f64) -> Self {
        self.value += coordinate;
        self.slope[direction] += 1.0;
        self
    }

    /// A function of it, given its value and first two derivatives there.
    #[inline]
    fn chain(self, [value, first, second]: [f64; 3]) -> Self {
        Self {
            value,
            slope: self.slope.map(|slope| first * slope),
            bend: each(|i| each(|j| first * self.bend[i][j] + second * self.slope[i] * self.slope[j])),
        }
    }

    /// The product, by its rule.
    #[inline]
    fn times(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self {
            value: a.value * b.value,
            slope: each(|i| a.value * b.slope[i] + b.value * a.slope[i]),
            bend: each(|i| {
                each(|j| {
                    a.value * b.bend[i][j]
                        + b.value * a.bend[i][j]
                        + a.slope[i] * b.slope[j]
                        + a.slope[j] * b.slope[i]
                })
            }),
        }
    }

    /// The sine and the cosine.
    #[inline]
    pub fn sine_and_cosine(self) -> [Self; 2] {
        let (sine, cosine) = elementary::sincos(self.value);
        [self.chain([sine, cosine, -sine]), self.chain([cosine, -sine, -cosine])]
    }

    /// The derivative along a direction, with its own first derivatives.
    #[inline]
    pub fn along(&self, direction: usize) -> Slope {
        Slope { value: self.slope[direction], slope: self.bend[direction] }
    }
}

impl Add for Slope {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: each(|i| self.slope[i] + other.slope[i]) }
    }
}

impl Sub for Slope {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Slope {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.times(other)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
impl Div for Slope {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        self * other.recip()
    }
}

impl Mul<f64> for Slope {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self { value: factor * self.value, slope: self.slope.map(|slope| factor * slope) }
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: each(|i| self.slope[i] + other.slope[i]),
            bend: each(|i| each(|j| self.bend[i][j] + other.bend[i][j])),
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Jet {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.times(other)
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        self.chain([factor * self.value, factor, 0.0])
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    #[inline]
    fn add(self, constant: f64) -> Self {
        Self { value: self.value + constant, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `sin(x y) cos(t) + (x − y t)²` by its own derivatives.
    #[test]
    fn a_jet_has_the_derivatives_of_its_formula() {
        let [x, y, t] = [0.7, -0.4, 1.3];
        let [jx, jy, jt] = [Jet::coordinate(0, x), Jet::coordinate(1, y), Jet::coordinate(TIME, t)];
        let rest = jx - jy * jt;
        let jet = (jx * jy).sine_and_cosine()[0] * jt.sine_and_cosine()[1] + rest * rest;
        let (s, c, rest) = ((x * y).sin(), (x * y).cos(), x - y * t);
        let slope =
            [y * c * t.cos() + 2.0 * rest, x * c * t.cos() - 2.0 * t * rest, -s * t.sin() - 2.0 * y * rest];
        for (got, exact) in jet.slope.iter().zip(slope) {
            assert!((got - exact).abs() < 1e-15, "{got} for {exact}");
        }
        let bend = [
            (0, 0, -y * y * s * t.cos() + 2.0),
            (0, 1, (c - x * y * s) * t.cos() - 2.0 * t),
            (1, 2, -x * c * t.sin() - 2.0 * rest + 2.0 * t * y),
            (2, 2, -s * t.cos() + 2.0 * y * y),
        ];
        for (i, j, exact) in bend {
            assert!((jet.bend[i][j] - exact).abs() < 1e-14, "{i}{j}: {} for {exact}", jet.bend[i][j]);
            assert_eq!(jet.bend[i][j], jet.bend[j][i]);
        }
    }

    /// `x + sin(x) y² · t³`: what grows is the product of its parts.
    #[test]
    fn what_grows_is_the_product_of_a_shape_and_of_a_time() {
        let [x, y, t] = [0.7_f64, -0.4, 1.3];
        let shape = Shape::product([x.sin(), x.cos(), -x.sin()], [y * y, 2.0 * y, 2.0]);
        let grown = Jet::growing(&shape, [t * t * t, 3.0 * t * t, 6.0 * t]).from_place(0, x);
        let [jx, jy, jt] = [Jet::coordinate(0, x), Jet::coordinate(1, y), Jet::coordinate(TIME, t)];
        let product = jx + jx.sine_and_cosine()[0] * jy * jy * jt * jt * jt;
        assert!((grown.value - product.value).abs() < 1e-15);
        for i in 0..DIRECTIONS {
            assert!((grown.slope[i] - product.slope[i]).abs() < 1e-14, "{i}");
            for j in 0..DIRECTIONS {
                assert!((grown.bend[i][j] - product.bend[i][j]).abs() < 1e-14, "{i}{j}");
            }
        }
    }

    #[test]
    fn a_slope_has_the_derivative_of_a_quotient_and_of_a_logarithm() {
        let [a, b] = [2.0, 5.0].map(|value| Slope { value, slope: [1.0, 0.5 * value, -3.0] });
        let quotient = a / b;
        for i in 0..DIRECTIONS {
            let exact = (a.slope[i] * b.value - a.value * b.slope[i]) / 25.0;
            assert!((quotient.slope[i] - exact).abs() < 1e-15);
            assert!((b.ln().slope[i] - b.slope[i] / 5.0).abs() < 1e-15);
        }
    }
}
