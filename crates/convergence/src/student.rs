//! Student's t: the one quantile that bands of 95 % and tests at 5 % need.

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use oedometer_soil::elementary;

/// 97.5 % quantile for a number of degrees of freedom: `|t|` stays below it with 95 %.
///
/// Nothing for none. Its square is the 95 % quantile of Fisher's F with one degree over as many.
pub fn quantile_975(freedom: usize) -> Option<f64> {
    if freedom == 0 {
        return None;
    }
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return Some((freedom as f64).sqrt() * elementary::tan(middle));
        }
        if chance_within(freedom, middle) < 0.95 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// `P(|t| < √ν tan θ)`, in closed form for a whole number of degrees (Abramowitz & Stegun 26.7.3 and 4).
fn chance_within(freedom: usize, angle: f64) -> f64 {
    let (sine, cosine) = (elementary::sin(angle), elementary::cos(angle));
    let odd = freedom % 2 == 1;
    let mut term = if odd { cosine } else { 1.0 };
    let mut sum = 0.0;
    // Odd: cos θ + 2/3 cos³ θ + …; even: 1 + 1/2 cos² θ + 1·3/(2·4) cos⁴ θ + …
    let mut factor = if odd { 2.0 } else { 1.0 };
    for _ in 0..freedom / 2 {
        sum += term;
        term *= cosine * cosine * factor / (factor + 1.0);
        factor += 2.0;
    }
    if odd { FRAC_2_PI * (angle + sine * sum) } else { sine * sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(
        clippy::unreadable_literal,
        clippy::excessive_precision,
        reason = "values as they were computed"
    )]
    fn the_quantile_matches_high_precision_values() {
        // mpmath, 40 digits: root of the regularised incomplete beta function.
        for (freedom, exact) in [
            (1, 12.706204736174705),
            (2, 4.3026527297494639),
            (3, 3.1824463052837096),
            (4, 2.7764451051977944),
            (5, 2.5705818356363155),
            (6, 2.44691185114497),
            (7, 2.3646242515927853),
            (10, 2.2281388519862747),
            (17, 2.1098155778333171),
            (40, 2.0210753903062734),
            (201, 1.9718365067798593),
        ] {
            let found = quantile_975(freedom).unwrap();
            assert!((found / exact - 1.0).abs() < 1e-13, "{freedom}: {found} for {exact}");
        }
        assert_eq!(quantile_975(0), None);
    }

    #[test]
    fn the_quantile_is_that_of_another_implementation() {
        use statrs::distribution::{ContinuousCDF, StudentsT};
        for freedom in 1..60 {
            let theirs = StudentsT::new(0.0, 1.0, freedom as f64).unwrap().inverse_cdf(0.975);
            let ours = quantile_975(freedom).unwrap();
            assert!((ours / theirs - 1.0).abs() < 1e-9, "{freedom}: {ours} for {theirs}");
        }
    }
}
