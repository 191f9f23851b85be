//! Numbers of four places side by side: the formulas of a motion take four places at a time, so that registers of
//! four numbers hold one number of each.
//!
//! Every operation is that of single numbers, place by place and in one order: four places have the bits of each alone.

#![expect(clippy::inline_always, reason = "formulas run in registers of four only where they are inlined")]

use oedometer_soil::elementary;
use std::ops::{Add, Mul, Sub};

/// Places that are taken at a time.
pub const PLACES: usize = 4;

/// A number of each of four places.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Four(pub [f64; PLACES]);

/// The numbers of four places from those of each.
#[inline(always)]
fn each(of: impl Fn(usize) -> f64) -> Four {
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

    /// One over them.
    #[inline(always)]
    pub fn recip(self) -> Self {
        each(|place| 1.0 / self.0[place])
    }

    /// Their quotients.
    #[inline(always)]
    pub fn over(self, divisor: Self) -> Self {
        each(|place| self.0[place] / divisor.0[place])
    }

    /// Their natural logarithms.
    #[inline(always)]
    pub fn ln(self) -> Self {
        Self(elementary::ln_of_each(&self.0))
    }

    /// Their sines and cosines.
    #[inline]
    pub fn sincos(self) -> [Self; 2] {
        let of_each = self.0.map(elementary::sincos);
        [Self(of_each.map(|(sine, _)| sine)), Self(of_each.map(|(_, cosine)| cosine))]
    }

    /// Where a number is positive that of one, elsewhere that of another.
    #[inline(always)]
    pub fn where_positive(self, inside: Self, outside: Self) -> Self {
        each(|place| if self.0[place] > 0.0 { inside.0[place] } else { outside.0[place] })
    }
}

impl Add for Four {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        each(|place| self.0[place] + other.0[place])
    }
}

impl Add<f64> for Four {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        each(|place| self.0[place] + other)
    }
}

impl Sub for Four {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        each(|place| self.0[place] - other.0[place])
    }
}

impl Mul for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        each(|place| self.0[place] * other.0[place])
    }
}

impl Mul<f64> for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        each(|place| self.0[place] * factor)
    }
}
