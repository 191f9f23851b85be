//! Elementary functions that are the same to the last bit on every machine.
//!
//! The methods of `f64` call the platform's C library, whose `exp` or `sin` may differ by a unit in
//! the last place between versions, vendors and processors, and the compiler may fold them with its
//! host's. Golden values would then hold on one machine only. All of the program calls the functions
//! below instead (`clippy.toml` refuses the others); they are plain arithmetic, which IEEE 754 fixes.
//! Roots, remainders and fused products need no place here: they are correctly rounded everywhere.

use nalgebra::Complex;

pub use libm::{
    acos, asin, atan, cos, erf, erfc, exp, exp2, expm1 as exp_m1, hypot, log as ln, log1p as ln_1p, log2,
    log10, pow as powf, sin, sincos, tan,
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

/// The square root with a positive real part; along the negative real axis the limit from the side
/// that the sign of zero tells.
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

    proptest! {
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
