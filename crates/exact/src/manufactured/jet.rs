//! Numbers that know their derivatives along X, Y and t: of first order ([`Slope`]) and of second ([`Jet`]).
//!
//! A manufactured motion is written down once, as a formula; everything that follows from it, accelerations,
//! divergences and sources, comes out of the arithmetic to round-off and without a formula of its own. Each number is
//! that of four places.

#![expect(clippy::inline_always, reason = "formulas run in registers of four only where they are inlined")]

use crate::manufactured::four::Four;
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
    pub value: Four,
    /// Derivatives along X, Y and t.
    pub slope: [Four; DIRECTIONS],
}

/// A value with its first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Jet {
    /// The value.
    pub value: Four,
    /// Derivatives along X, Y and t.
    pub slope: [Four; DIRECTIONS],
    /// Second derivatives, `[direction][direction]`, symmetric.
    pub bend: [[Four; DIRECTIONS]; DIRECTIONS],
}

/// A function of the place alone: its value with first and second derivatives along X and Y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Shape {
    /// The value.
    pub value: Four,
    /// Derivatives along X and Y.
    pub slope: [Four; 2],
    /// Second derivatives, `[direction][direction]`, symmetric.
    pub bend: [[Four; 2]; 2],
}

impl Shape {
    /// The product of a function of X and one of Y, each as value and two derivatives.
    #[inline(always)]
    pub fn product(along: [Four; 3], up: [Four; 3]) -> Self {
        let mixed = along[1] * up[1];
        Self {
            value: along[0] * up[0],
            slope: [along[1] * up[0], along[0] * up[1]],
            bend: [[along[2] * up[0], mixed], [mixed, along[0] * up[2]]],
        }
    }
}

/// An array from its places.
#[inline(always)]
fn each<T>(of: impl Fn(usize) -> T) -> [T; DIRECTIONS] {
    [of(0), of(1), of(2)]
}

impl Slope {
    /// A number that does not vary.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Self { value: Four::all(value), slope: [Four::all(0.0); DIRECTIONS] }
    }

    /// A function of it, given its value and derivative there.
    #[inline(always)]
    fn chain(self, [value, derivative]: [Four; 2]) -> Self {
        Self { value, slope: each(|i| derivative * self.slope[i]) }
    }

    /// The product, by its rule.
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let slope = each(|i| self.value * other.slope[i] + other.value * self.slope[i]);
        Self { value: self.value * other.value, slope }
    }

    /// The natural logarithm.
    #[inline(always)]
    pub fn ln(self) -> Self {
        self.chain([self.value.ln(), self.value.recip()])
    }

    /// The slopes of the natural logarithm alone, about a value of zero: where only they are asked for, the logarithm
    /// need not be taken.
    #[inline(always)]
    pub fn ln_slopes(self) -> Self {
        self.chain([Four::all(0.0), self.value.recip()])
    }

    /// One over it.
    #[inline(always)]
    pub fn recip(self) -> Self {
        let recip = self.value.recip();
        self.chain([recip, recip * -1.0 * recip])
    }
}

impl Jet {
    /// The coordinate of a direction, at a value.
    #[inline(always)]
    pub fn coordinate(direction: usize, value: Four) -> Self {
        let slope = each(|i| Four::all(if i == direction { 1.0 } else { 0.0 }));
        Self { value, slope, bend: [[Four::all(0.0); DIRECTIONS]; DIRECTIONS] }
    }

    /// A function of the place times one of the time, as value and two derivatives: most of a product's terms are
    /// zero.
    #[inline(always)]
    pub fn growing(shape: &Shape, [now, rate, bend]: [f64; 3]) -> Self {
        let Shape { value, slope: [x, y], bend: [[xx, xy], [_, yy]] } = *shape;
        Self {
            value: value * now,
            slope: [x * now, y * now, value * rate],
            bend: [
                [xx * now, xy * now, x * rate],
                [xy * now, yy * now, y * rate],
                [x * rate, y * rate, value * bend],
            ],
        }
    }

    /// It and a coordinate, in whose direction it is.
    #[inline(always)]
    pub fn from_place(mut self, direction: usize, coordinate: Four) -> Self {
        self.value = self.value + coordinate;
        self.slope[direction] = self.slope[direction] + 1.0;
        self
    }

    /// A function of it, given its value and first two derivatives there.
    #[inline(always)]
    fn chain(self, [value, first, second]: [Four; 3]) -> Self {
        let mut chained = Self { value, ..self };
        for i in 0..DIRECTIONS {
            chained.slope[i] = first * self.slope[i];
            for j in 0..DIRECTIONS {
                chained.bend[i][j] = first * self.bend[i][j] + second * self.slope[i] * self.slope[j];
            }
        }
        chained
    }

    /// The product, by its rule.
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let (a, b) = (self, other);
        let mut product = Self { value: a.value * b.value, ..a };
        for i in 0..DIRECTIONS {
            product.slope[i] = a.value * b.slope[i] + b.value * a.slope[i];
            for j in 0..DIRECTIONS {
                product.bend[i][j] = a.value * b.bend[i][j]
                    + b.value * a.bend[i][j]
                    + a.slope[i] * b.slope[j]
                    + a.slope[j] * b.slope[i];
            }
        }
        product
    }

    /// The sine and the cosine.
    #[inline(always)]
    pub fn sine_and_cosine(self) -> [Self; 2] {
        let [sine, cosine] = self.value.sincos();
        let [minus_sine, minus_cosine] = [sine * -1.0, cosine * -1.0];
        [self.chain([sine, cosine, minus_sine]), self.chain([cosine, minus_sine, minus_cosine])]
    }

    /// Where a number is positive one jet, elsewhere another.
    #[inline(always)]
    pub fn where_positive(number: Four, inside: &Self, outside: &Self) -> Self {
        let pick = |inside, outside| number.where_positive(inside, outside);
        Self {
            value: pick(inside.value, outside.value),
            slope: each(|i| pick(inside.slope[i], outside.slope[i])),
            bend: each(|i| each(|j| pick(inside.bend[i][j], outside.bend[i][j]))),
        }
    }

    /// The derivative along a direction, with its own first derivatives.
    #[inline(always)]
    pub fn along(&self, direction: usize) -> Slope {
        Slope { value: self.slope[direction], slope: self.bend[direction] }
    }
}

impl Add for Slope {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: each(|i| self.slope[i] + other.slope[i]) }
    }
}

impl Sub for Slope {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Slope {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.times(other)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
impl Div for Slope {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self * other.recip()
    }
}

impl Mul<f64> for Slope {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { value: self.value * factor, slope: each(|i| self.slope[i] * factor) }
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline(always)]
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
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Jet {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.times(other)
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.chain([self.value * factor, Four::all(factor), Four::all(0.0)])
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    #[inline(always)]
    fn add(self, constant: f64) -> Self {
        Self { value: self.value + constant, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manufactured::four::PLACES;

    /// X, Y and t of four places.
    const PLACES_AND_TIMES: [[f64; PLACES]; DIRECTIONS] =
        [[0.7, -0.2, 1.1, 0.3], [-0.4, 0.6, 0.1, -1.2], [1.3, 0.2, -0.7, 0.9]];

    fn coordinates() -> [Jet; DIRECTIONS] {
        each(|direction| Jet::coordinate(direction, Four(PLACES_AND_TIMES[direction])))
    }

    fn single(place: usize) -> [f64; DIRECTIONS] {
        PLACES_AND_TIMES.map(|of_places| of_places[place])
    }

    /// `sin(x y) cos(t) + (x − y t)²` by its own derivatives.
    #[test]
    fn a_jet_has_the_derivatives_of_its_formula() {
        let [jx, jy, jt] = coordinates();
        let rest = jx - jy * jt;
        let jet = (jx * jy).sine_and_cosine()[0] * jt.sine_and_cosine()[1] + rest * rest;
        for place in 0..PLACES {
            let [x, y, t] = single(place);
            let (s, c, rest) = ((x * y).sin(), (x * y).cos(), x - y * t);
            let slope = [
                y * c * t.cos() + 2.0 * rest,
                x * c * t.cos() - 2.0 * t * rest,
                -s * t.sin() - 2.0 * y * rest,
            ];
            for (got, exact) in jet.slope.iter().zip(slope) {
                assert!((got.0[place] - exact).abs() < 1e-15, "{got:?} for {exact}");
            }
            let bend = [
                (0, 0, -y * y * s * t.cos() + 2.0),
                (0, 1, (c - x * y * s) * t.cos() - 2.0 * t),
                (1, 2, -x * c * t.sin() - 2.0 * rest + 2.0 * t * y),
                (2, 2, -s * t.cos() + 2.0 * y * y),
            ];
            for (i, j, exact) in bend {
                assert!((jet.bend[i][j].0[place] - exact).abs() < 1e-14, "{i}{j}: {jet:?} for {exact}");
                assert_eq!(jet.bend[i][j], jet.bend[j][i]);
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
        let jt = Jet::coordinate(TIME, Four::all(t));
        let product = jx + jx.sine_and_cosine()[0] * jy * jy * jt * jt * jt;
        let is_near = |a: Four, b: Four| (a - b).0.iter().all(|off| off.abs() < 1e-14);
        assert!(is_near(grown.value, product.value));
        for i in 0..DIRECTIONS {
            assert!(is_near(grown.slope[i], product.slope[i]), "{i}");
            for j in 0..DIRECTIONS {
                assert!(is_near(grown.bend[i][j], product.bend[i][j]), "{i}{j}");
            }
        }
    }

    #[test]
    fn a_slope_has_the_derivative_of_a_quotient_and_of_a_logarithm() {
        let [a, b] = [[2.0, 3.0, 0.5, 1.0], [5.0, 0.25, 2.0, 7.0]].map(|values| {
            let value = Four(values);
            Slope { value, slope: [Four::all(1.0), value * 0.5, Four::all(-3.0)] }
        });
        let (quotient, logarithm) = (a / b, b.ln());
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
