//! Elementary functions that are the same to the last bit on every machine.
//!
//! The methods of `f64` call the platform's C library, whose `exp` or `sin` may differ by a unit in
//! the last place between versions, vendors and processors, and the compiler may fold them with its
//! host's. Golden values would then hold on one machine only. All of the program calls the functions
//! below instead (`clippy.toml` refuses the others); they are plain arithmetic, which IEEE 754 fixes.
//! Roots, remainders and fused products need no place here: they are correctly rounded everywhere.

use nalgebra::Complex;

pub use libm::{
    acos, asin, atan, atan2, cos, erf, erfc, exp, exp2, expm1 as exp_m1, hypot, j0, j1, log as ln,
    log1p as ln_1p, log2, log10, pow as powf, sin, sincos, tan, y0, y1,
};

/// `xⁿ` by repeated squaring, in this order of products.
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut power, mut square, mut left) = (1.0, x, n.unsigned_abs());
    while left > 0 {
        if left & 1 == 1 {
            power *= square;
        }
        square *= square;
        left >>= 1;
    }
    if n < 0 { 1.0 / power } else { power }
}

/// [`ln`] of `N` numbers at once, with the same bits; without a branch for each if all are positive and normal.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
pub fn ln_of_each<const N: usize>(numbers: &[f64; N]) -> [f64; N] {
    let is_normal = |x: &f64| (f64::MIN_POSITIVE..f64::INFINITY).contains(x);
    if !numbers.iter().fold(true, |all, x| all & is_normal(x)) {
        return numbers.map(ln);
    }
    let mut logarithms = *numbers;
    for x in &mut logarithms {
        *x = ln_of_normal(*x);
    }
    logarithms
}

/// The logarithm of a positive normal number, operation by operation as `libm` has it (Sun Microsystems 1993,
/// `e_log.c`): `x = 2ᵏ m` with `m` between `√½` and `√2`, and a polynomial in `s = f/(2 + f)`, `f = m − 1`.
#[inline(always)]
fn ln_of_normal(x: f64) -> f64 {
    const LN2: [f64; 2] = [f64::from_bits(0x3fe6_2e42_fee0_0000), f64::from_bits(0x3dea_39ef_3579_3c76)];
    const ODD: [f64; 4] = [
        f64::from_bits(0x3fe5_5555_5555_5593),
        f64::from_bits(0x3fd2_4924_9422_9359),
        f64::from_bits(0x3fc7_4664_96cb_03de),
        f64::from_bits(0x3fc2_f112_df3e_5244),
    ];
    const EVEN: [f64; 3] = [
        f64::from_bits(0x3fd9_9999_9997_fa04),
        f64::from_bits(0x3fcc_71c5_1d8e_78af),
        f64::from_bits(0x3fc3_9a09_d078_c69f),
    ];
    /// High half of `√½`, and the difference from that of 1.
    const ROOT_HALF: u64 = 0x3fe6_a09e_0000_0000;
    const TO_ONE: u64 = 0x3ff0_0000_0000_0000 - ROOT_HALF;
    /// `2⁵²`, whose last bits count in ones.
    const COUNTER: u64 = 0x4330_0000_0000_0000;
    let shifted = x.to_bits().wrapping_add(TO_ONE);
    let k = f64::from_bits(COUNTER | (shifted >> 52)) - (f64::from_bits(COUNTER) + 1023.0);
    let mantissa = (shifted & 0x000f_ffff_ffff_ffff).wrapping_add(ROOT_HALF);
    let f = f64::from_bits(mantissa) - 1.0;
    let half_square = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (EVEN[0] + w * (EVEN[1] + w * EVEN[2]));
    let odd = z * (ODD[0] + w * (ODD[1] + w * (ODD[2] + w * ODD[3])));
    s * (half_square + (odd + even)) + k * LN2[1] - half_square + f + k * LN2[0]
}

/// `|z|`.
pub fn modulus(z: Complex<f64>) -> f64 {
    hypot(z.re, z.im)
}

/// `r (cos θ + i sin θ)`.
pub fn polar(radius: f64, angle: f64) -> Complex<f64> {
    Complex::new(radius * cos(angle), radius * sin(angle))
}

/// `exp z`.
pub fn exp_complex(z: Complex<f64>) -> Complex<f64> {
    polar(exp(z.re), z.im)
}

/// `exp z − 1`, which keeps its digits where `z` is small.
pub fn exp_m1_complex(z: Complex<f64>) -> Complex<f64> {
    let half = sin(0.5 * z.im);
    Complex::new(exp_m1(z.re) * cos(z.im) - 2.0 * half * half, exp(z.re) * sin(z.im))
}

/// The square root with a positive real part; on the negative real axis the sign of the zero imaginary part selects the
/// side of the cut.
pub fn sqrt_complex(z: Complex<f64>) -> Complex<f64> {
    if z.re == 0.0 && z.im == 0.0 {
        return Complex::new(0.0, z.im);
    }
    // The half of the larger sum; the other part follows from it without cancellation.
    let large = (0.5 * (z.re.abs() + modulus(z))).sqrt();
    let small = 0.5 * z.im.abs() / large;
    if z.re >= 0.0 {
        Complex::new(large, small.copysign(z.im))
    } else {
        Complex::new(small, large.copysign(z.im))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn integer_powers_are_products() {
        assert_eq!(powi(3.0, 5), 243.0);
        assert_eq!(powi(-2.0, -3), -0.125);
        assert_eq!(powi(0.0, 0), 1.0);
        assert_eq!(powi(2.0, i32::MIN), 0.0);
        assert_eq!(powi(0.1, 3), 0.1 * (0.1 * 0.1), "the smallest bit first");
    }

    #[test]
    fn logarithms_of_several_numbers_have_the_bits_of_single_logarithms() {
        let special = [1.0, 0.0, -0.0, -1.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, f64::NAN];
        for x in special {
            let [a, b] = ln_of_each(&[x, 0.7]);
            assert!(a.to_bits() == ln(x).to_bits() || (a.is_nan() && ln(x).is_nan()), "{x}");
            assert_eq!(b.to_bits(), ln(0.7).to_bits());
        }
        let near_one = (-40..40).map(|i| 1.0 + f64::from(i) * f64::EPSILON);
        let powers =
            (-1022..1024).flat_map(|k| [powi(2.0, k), std::f64::consts::SQRT_2 * powi(2.0, k.min(1022))]);
        let volumes = (1..20_000).map(|i| f64::from(i) * 1.003_7e-4);
        for x in near_one.chain(powers).chain(volumes) {
            assert_eq!(ln_of_each(&[x])[0].to_bits(), ln(x).to_bits(), "{x:e}");
        }
    }

    proptest! {
        #[test]
        fn logarithms_of_random_numbers_have_the_bits_of_single_logarithms(bits in any::<[u64; 8]>()) {
            let numbers = bits.map(|bits| f64::from_bits(bits >> 1));
            for (x, got) in numbers.iter().zip(ln_of_each(&numbers)) {
                prop_assert!(got.to_bits() == ln(*x).to_bits() || got.is_nan() && x.is_nan(), "{:e}", x);
            }
        }

        #[test]
        fn complex_functions_keep_their_identities(re in -20.0..20.0_f64, im in -20.0..20.0_f64) {
            let z = Complex::new(re, im);
            let root = sqrt_complex(z);
            prop_assert!(root.re >= 0.0);
            prop_assert!(modulus(root * root - z) <= 4.0 * f64::EPSILON * modulus(z));
            let product = exp_complex(z) * exp_complex(-z);
            prop_assert!(modulus(product - 1.0) < 1e-15);
        }
    }
}
