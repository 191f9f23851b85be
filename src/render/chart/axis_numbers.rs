//! Numbers on axes.
use crate::render::number::minus;
use crate::render::script::exponent;
use oedometer_soil::elementary;

/// A number as `1.5·10⁻³`, down to the decimal place `digits` if that is given.
pub(crate) fn power(value: f64, digits: Option<f64>) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let mut n = elementary::log10(value.abs()).floor();
    if (value.abs() / elementary::powf(10.0, n)) >= 9.999_999_99 {
        n += 1.0;
    }
    let mantissa = value / elementary::powf(10.0, n);
    let text = match digits {
        Some(d) => {
            let decimals = decimals(d - n);
            format!("{mantissa:.decimals$}")
        }
        None => format!("{}", (mantissa * 1e3).round() / 1e3),
    };
    let ten = format!("10{}", exponent(whole(n)));
    match text.as_str() {
        "1" => ten,
        "-1" => minus(format!("-{ten}")),
        _ => minus(format!("{text}·{ten}")),
    }
}

/// Decimals that the place of the last digit asks for.
pub(crate) fn decimals(digit: f64) -> usize {
    usize::try_from(whole(-digit)).unwrap_or(0).min(15)
}

#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and exponents are small")]
pub(crate) fn whole(x: f64) -> i32 {
    x.round() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_powers() {
        assert_eq!(power(1.5e-3, None), "1.5·10⁻³");
        assert_eq!(power(1e-3, None), "10⁻³");
        assert_eq!(power(-1e5, None), "−10⁵");
        assert_eq!(power(0.0, None), "0");
        assert_eq!(power(2e6, Some(5.0)), "2.0·10⁶");
    }
}
