//! Numbers of two `f64` each, real and complex: about 31 digits, by Dekker (1971) and Hida, Li & Bailey (2001).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A sum of two numbers that do not overlap.
#[derive(Clone, Copy, Debug, Default)]
pub struct Double {
    high: f64,
    low: f64,
}

pub const PI: Double = Double { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };
const LN_2: Double = Double { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };
/// Euler's constant.
pub const GAMMA: Double = Double { high: 0.577_215_664_901_532_9, low: -4.942_915_152_430_645e-18 };
pub const ONE: Double = Double { high: 1.0, low: 0.0 };
pub const ZERO: Double = Double { high: 0.0, low: 0.0 };

/// A whole number or another `f64`, exactly.
pub fn d(value: f64) -> Double {
    Double { high: value, low: 0.0 }
}

fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let part = high - a;
    Double { high, low: (a - (high - part)) + (b - part) }
}

fn quick_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let first = quick_sum(high.high, high.low + low.high);
        quick_sum(first.high, first.low + low.low)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let rest = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        quick_sum(high, rest)
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * d(first);
        let second = rest.high / other.high;
        let rest = rest - other * d(second);
        quick_sum(first, second) + d(rest.high / other.high)
    }
}

impl Double {
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    pub fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return ZERO;
        }
        let first = d(self.high.sqrt());
        let better = (first + self / first) * d(0.5);
        (better + self / better) * d(0.5)
    }

    fn scaled(self, power: i32) -> Self {
        let factor = 2.0_f64.powi(power);
        Self { high: self.high * factor, low: self.low * factor }
    }

    pub fn exp(self) -> Self {
        if self.high < -700.0 {
            return ZERO;
        }
        let turns = (self.high / LN_2.high).round();
        let reduced = (self - LN_2 * d(turns)).scaled(-9);
        let (mut term, mut sum) = (reduced, reduced);
        for k in 2..12 {
            term = term * reduced / d(f64::from(k));
            sum = sum + term;
        }
        for _ in 0..9 {
            sum = sum.scaled(1) + sum * sum;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a thousand at most")]
        (sum + ONE).scaled(turns as i32)
    }

    pub fn ln(self) -> Self {
        let first = d(self.high.ln());
        let better = first + self * (-first).exp() - ONE;
        better + self * (-better).exp() - ONE
    }

    /// Sine and cosine.
    pub fn sincos(self) -> [Self; 2] {
        let quarter = PI * d(0.5);
        let turns = (self.high / quarter.high).round();
        let reduced = self - quarter * d(turns);
        let series = |first: Self, start: u32| {
            let (mut term, mut sum) = (first, first);
            for k in 0..16 {
                let (a, b) = (f64::from(start + 2 * k + 1), f64::from(start + 2 * k + 2));
                term = -(term * reduced * reduced) / d(a * b);
                sum = sum + term;
            }
            sum
        };
        let (sine, cosine) = (series(reduced, 1), series(ONE, 0));
        match turns.rem_euclid(4.0) {
            0.0 => [sine, cosine],
            1.0 => [cosine, -sine],
            2.0 => [-sine, -cosine],
            _ => [-cosine, sine],
        }
    }

    /// `2/√π e^{−x²} Σ 2ⁿ x²ⁿ⁺¹/(2n + 1)!!`: all terms of a sign.
    pub fn erf(self) -> Self {
        let (mut term, mut sum) = (self, self);
        for n in 1..400 {
            term = term * self * self * d(2.0) / d(f64::from(2 * n + 1));
            sum = sum + term;
        }
        d(2.0) / PI.sqrt() * (-(self * self)).exp() * sum
    }

    pub fn erfc(self) -> Self {
        if self.high > 12.0 { ZERO } else { ONE - self.erf() }
    }
}

/// A complex number.
#[derive(Clone, Copy, Debug, Default)]
pub struct Complex {
    pub re: Double,
    pub im: Double,
}

pub fn c(re: Double) -> Complex {
    Complex { re, im: ZERO }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let size = other.size();
        self * Self { re: other.re / size, im: -other.im / size }
    }
}

impl Complex {
    /// Square of the modulus.
    pub fn size(self) -> Double {
        self.re * self.re + self.im * self.im
    }

    pub fn exp(self) -> Self {
        let ([sine, cosine], size) = (self.im.sincos(), self.re.exp());
        Self { re: size * cosine, im: size * sine }
    }

    /// The root with a real part that is not negative.
    pub fn sqrt(self) -> Self {
        let modulus = self.size().sqrt();
        if modulus.value() == 0.0 {
            return Self::default();
        }
        if self.re.value() >= 0.0 {
            let re = ((modulus + self.re) * d(0.5)).sqrt();
            return Self { re, im: self.im / (re * d(2.0)) };
        }
        let im = ((modulus - self.re) * d(0.5)).sqrt();
        let im = if self.im.value() < 0.0 { -im } else { im };
        Self { re: self.im / (im * d(2.0)), im }
    }

    pub fn ln(self) -> Self {
        let angle = d(self.im.value().atan2(self.re.value()));
        // One step of Newton's iteration on the direction.
        let [sine, cosine] = angle.sincos();
        let modulus = self.size().sqrt();
        let missing = (self.im * cosine - self.re * sine) / modulus;
        Self { re: modulus.ln(), im: angle + missing }
    }

    /// `cosh z h/cosh z` for `0 ≤ h ≤ 1`.
    pub fn cosh_ratio(self, h: Double) -> Self {
        let unit = c(ONE);
        (self * c(h - ONE)).exp() * (unit + (self * c(d(-2.0) * h)).exp())
            / (unit + (self * c(d(-2.0))).exp())
    }

    pub fn tanh(self) -> Self {
        let fall = (self * c(d(-2.0))).exp();
        (c(ONE) - fall) / (c(ONE) + fall)
    }

    /// `sinh z h/sinh z` for `0 ≤ h ≤ 1`.
    pub fn sinh_ratio(self, h: Double) -> Self {
        let unit = c(ONE);
        (self * c(h - ONE)).exp() * (unit - (self * c(d(-2.0) * h)).exp())
            / (unit - (self * c(d(-2.0))).exp())
    }
}

/// Nodes of the contour: it leaves out `e^{−1.36 N}`, 1e-26.
const NODES: u32 = 44;

/// The inverse of a transform at a time, on Talbot's contour (Trefethen, Weideman & Schmelzer 2006, Eq. 4.1).
pub fn inverse<const N: usize>(time: Double, transform: impl Fn(Complex) -> [Complex; N]) -> [f64; N] {
    let mut sum = [ZERO; N];
    let count = d(f64::from(NODES));
    for k in 0..NODES / 2 {
        let angle = d(f64::from(2 * k + 1)) * PI / count;
        let scaled = d(0.6407) * angle;
        let [sine, cosine] = scaled.sincos();
        let cotangent = cosine / sine;
        let z = Complex {
            re: count * (d(0.5017) * angle * cotangent - d(0.6122)),
            im: count * d(0.2645) * angle,
        };
        let slope = Complex {
            re: count * d(0.5017) * (cotangent - scaled * (ONE + cotangent * cotangent)),
            im: count * d(0.2645),
        };
        let weight = z.exp() * slope * Complex { re: ZERO, im: d(-2.0) / count } / c(time);
        for (sum, image) in sum.iter_mut().zip(transform(z / c(time))) {
            *sum = *sum + (weight * image).re;
        }
    }
    sum.map(Double::value)
}

/// A square matrix.
pub type Matrix<const N: usize> = [[Complex; N]; N];

pub fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let mut product = [[Complex::default(); N]; N];
    for i in 0..N {
        for j in 0..N {
            for k in 0..N {
                product[i][j] = product[i][j] + a[i][k] * b[k][j];
            }
        }
    }
    product
}

/// `e^A` by Taylor's series of `A/2ᵏ`, squared `k` times.
pub fn exponential<const N: usize>(matrix: &Matrix<N>) -> Matrix<N> {
    let norm = matrix.iter().flatten().map(|entry| entry.size().value().sqrt()).fold(0.0, f64::max);
    #[expect(clippy::cast_possible_truncation, reason = "a hundred at most")]
    let halvings = (norm * N as f64).log2().ceil().max(0.0) as i32 + 4;
    let small = matrix.map(|row| row.map(|entry| entry * c(d(2.0_f64.powi(-halvings)))));
    let mut sum = [[Complex::default(); N]; N];
    for (i, row) in sum.iter_mut().enumerate() {
        row[i] = c(ONE);
    }
    let mut term = sum;
    for k in 1..18 {
        term = product(&term, &small).map(|row| row.map(|entry| entry / c(d(f64::from(k)))));
        for (row, added) in sum.iter_mut().zip(&term) {
            for (entry, added) in row.iter_mut().zip(added) {
                *entry = *entry + *added;
            }
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

/// Solves a linear system by elimination with pivots.
pub fn solved<const N: usize>(mut matrix: Matrix<N>, mut right: [Complex; N]) -> [Complex; N] {
    for column in 0..N {
        let size = |row: &usize| matrix[*row][column].size().value();
        let pivot = (column..N).max_by(|a, b| size(a).total_cmp(&size(b))).expect("a row");
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        for row in column + 1..N {
            let factor = matrix[row][column] / matrix[column][column];
            for k in column..N {
                matrix[row][k] = matrix[row][k] - factor * matrix[column][k];
            }
            right[row] = right[row] - factor * right[column];
        }
    }
    for row in (0..N).rev() {
        for k in row + 1..N {
            right[row] = right[row] - matrix[row][k] * right[k];
        }
        right[row] = right[row] / matrix[row][row];
    }
    right
}

#[test]
fn functions_have_thirty_digits() {
    let close = |computed: Double, high: f64, low: f64| {
        let missing = (computed - Double { high, low }).value().abs();
        assert!(missing < 1e-29 * high.abs(), "{computed:?} for {high}");
    };
    // e and √2 to 34 digits.
    close(ONE.exp(), std::f64::consts::E, 1.445_646_891_729_250_2e-16);
    close(d(2.0).sqrt(), std::f64::consts::SQRT_2, -9.667_293_313_452_913e-17);
    close(d(2.0).ln(), LN_2.high, LN_2.low);
    let [sine, cosine] = d(1.3).sincos();
    close(sine * sine + cosine * cosine, 1.0, 0.0);
    close((PI / d(6.0)).sincos()[0], 0.5, 0.0);
    let (x, y) = (Complex { re: d(0.3), im: d(-2.0) }, Complex { re: d(-1.5), im: d(0.7) });
    for round in [x.sqrt() * x.sqrt() - x, y.sqrt() * y.sqrt() - y, x.ln().exp() - x, y.ln().exp() - y] {
        assert!(round.size().value().sqrt() < 1e-29, "{round:?}");
    }
    // e^{−t} and 1 − e^{−t}.
    let [falls, rises] = inverse(d(0.7), |s| [c(ONE) / (s + c(ONE)), c(ONE) / (s * (s + c(ONE)))]);
    assert!(
        (falls - (-0.7_f64).exp()).abs() < 1e-16 && (falls + rises - 1.0).abs() < 2e-16,
        "{falls} {rises}"
    );
}
