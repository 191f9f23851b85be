//! Numbers in tables and sentences of reports.

use oedometer_wording::typed;
pub use oedometer_wording::{order, rounded};

/// An error: three digits, `5.62e-3`, and a power of ten unless it lies between one and a thousand.
pub fn error(value: f64) -> String {
    finite(value, |v| match v.abs() {
        0.0 => "0".to_owned(),
        1.0..999.5 => three_digits(v),
        _ => format!("{v:.2e}"),
    })
}

/// An error with a power of ten: `5.62e-3`, `5.19e1`.
pub fn error_with_power(value: f64) -> String {
    finite(value, |v| if v == 0.0 { "0".to_owned() } else { format!("{v:.2e}") })
}

/// A measured value with so many significant digits, its trailing zeros among them: `0.193`, `1.00`, `349`.
pub fn significant(value: f64, digits: usize) -> String {
    finite(value, |v| {
        // The power of ten after rounding: 9.996 with three digits is 10.0.
        let rounded = format!("{v:.*e}", digits.saturating_sub(1));
        let power = rounded.split_once('e').and_then(|(_, power)| power.parse::<i32>().ok()).unwrap_or(0);
        let places = power.unsigned_abs() as usize;
        match power {
            _ if v == 0.0 => "0".to_owned(),
            0..6 => format!("{v:.*}", digits.saturating_sub(1 + places)),
            -3..0 => format!("{v:.*}", digits.saturating_sub(1) + places),
            _ => rounded,
        }
    })
}

/// Two errors with three digits, or with as many as show their difference.
pub fn told_apart(values: [f64; 2]) -> [String; 2] {
    let [one, two] = values.map(error);
    if one != two || values[0] == values[1] {
        return [one, two];
    }
    let with = |digits: usize| values.map(|value| finite(value, |v| format!("{v:.digits$e}")));
    (3..17).map(with).find(|[one, two]| one != two).unwrap_or([one, two])
}

/// A number with so many decimals, with a proper minus and no sign at zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    finite(value, |v| minus(format!("{v:.decimals$}")))
}

/// A time factor: as it was typed, and of more than four significant digits these.
pub fn time_factor(value: f64) -> String {
    let text = typed(value);
    let digits = text.chars().filter(char::is_ascii_digit).collect::<String>();
    match digits.trim_matches('0').len() {
        0..=4 => text,
        _ if value.abs() >= 1e-3 => rounded(value),
        _ => format!("{value:.3e}"),
    }
}

/// A share as a percentage: `0.012` is `1.20 %`.
pub fn percent(share: f64) -> String {
    finite(share * 100.0, |v| {
        let text = match v.abs() {
            a if a == 0.0 || a >= 0.0995 => three_digits(v),
            a if a >= 0.000_995 => format!("{v:.4}"),
            _ => format!("{v:.2e}"),
        };
        format!("{text} %")
    })
}

/// A share that someone set, as a percentage without more digits than it has: `0.001` is `0.1 %`.
pub fn bound(share: f64) -> String {
    format!("{} %", rounded(100.0 * share))
}

/// A share as a whole percentage: `0.847` is `85 %`.
pub fn rounded_percent(share: f64) -> String {
    finite(100.0 * share, |v| format!("{v:.0} %"))
}

/// A size with two digits: `0.012`, `3.4`, `160`.
pub fn two_digits(value: f64) -> String {
    significant(value, 2)
}

/// A count, in groups of three from five digits on.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

/// A value for a program: the shortest text that reads back as the same bits.
pub fn exact(value: f64) -> String {
    finite(value, |v| format!("{v:?}"))
}

fn finite(value: f64, show: impl Fn(f64) -> String) -> String {
    match value {
        v if v.is_nan() => "NaN".to_owned(),
        f64::INFINITY => "inf".to_owned(),
        f64::NEG_INFINITY => "-inf".to_owned(),
        v => show(v),
    }
}

fn three_digits(v: f64) -> String {
    match v.abs() {
        0.0 => "0".to_owned(),
        a if a >= 99.95 => format!("{v:.0}"),
        a if a >= 9.995 => format!("{v:.1}"),
        _ => format!("{v:.2}"),
    }
}

/// The typographic minus, and no minus before a zero.
pub(crate) fn minus(text: String) -> String {
    unsigned_zero(text).replacen('-', "−", 1)
}

fn unsigned_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_owned(),
        _ => text,
    }
}

/// A value in the unit that suits it.
pub fn with_unit(value: f64, unit: &str) -> String {
    let scaled = |scale: f64| format!("{:.3e}", value / scale).parse::<f64>().unwrap_or(value);
    let prefixes: &[(f64, &str)] = match unit {
        "Pa" => &[(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")],
        _ => &[],
    };
    if let Some((scale, name)) = prefixes.iter().find(|(scale, _)| value.abs() >= *scale) {
        return format!("{} {name}", scaled(*scale));
    }
    let is_plain = (1e-3..1e4).contains(&value.abs());
    let number = if is_plain { format!("{}", scaled(1.0)) } else { format!("{:e}", scaled(1.0)) };
    format!("{number} {unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_numbers_have_the_digits_that_tell_them_apart() {
        assert_eq!(told_apart([2.371e-5, 2.372e-5]), ["2.371e-5", "2.372e-5"]);
        assert_eq!(told_apart([2.37e-5, 2.41e-5]), ["2.37e-5", "2.41e-5"]);
        assert_eq!(told_apart([1.0, 1.0 + f64::EPSILON]), ["1.0000000000000000e0", "1.0000000000000002e0"]);
        assert_eq!(told_apart([0.5, 0.5]), ["5.00e-1"; 2]);
        assert_eq!(told_apart([0.0, 1e-30]), ["0", "1.00e-30"]);
    }

    #[test]
    fn a_time_factor_of_a_time_in_days_has_four_digits() {
        let told = [0.05, 0.0002, 1e-12, 0.123_456, 0.152_190_825_688_073_4, 2.0].map(time_factor);
        assert_eq!(told, ["0.05", "0.0002", "0.000000000001", "0.1235", "0.1522", "2"]);
    }

    #[test]
    fn errors_have_three_digits() {
        assert_eq!([5.62e-3, 1.0, 0.0, -2.5e-10].map(error), ["5.62e-3", "1.00", "0", "-2.50e-10"]);
        assert_eq!([5.62e-3, 51.9, 0.0].map(error_with_power), ["5.62e-3", "5.19e1", "0"]);
    }

    #[test]
    fn measured_values_keep_their_trailing_zeros() {
        assert_eq!(
            [1.0, 0.192_47, 9.996, 348.9, 12_345.6, 0.001_234, 1.2e-7, 0.0, -2.5].map(|v| significant(v, 3)),
            ["1.00", "0.192", "10.0", "349", "12346", "0.00123", "1.20e-7", "0", "-2.50"]
        );
        assert_eq!([33.8, 33.462].map(|v| significant(v, 4)), ["33.80", "33.46"]);
    }

    #[test]
    fn fixed_decimals_have_no_sign_at_zero() {
        assert_eq!([-0.001, -0.05, 156.178].map(|value| fixed(value, 2)), ["0.00", "−0.05", "156.18"]);
        assert_eq!(fixed(-0.0001, 3), "0.000");
    }

    #[test]
    fn what_is_not_finite_is_said_in_every_format() {
        for show in [error, order, percent, rounded, exact] {
            assert_eq!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(show), ["NaN", "inf", "-inf"]);
        }
    }

    #[test]
    fn orders_percentages_and_counts() {
        assert_eq!([1.998, 2.0, -0.001].map(order), ["2.00", "2.00", "0.00"]);
        assert_eq!(
            [-0.012, 0.5, 1.0, 1.4e-4, 1e-9].map(percent),
            ["-1.20 %", "50.0 %", "100 %", "0.0140 %", "1.00e-7 %"]
        );
        assert_eq!(
            [9.96e-6, 9.94e-6, 0.000_996, 0.000_994, 12.34].map(percent),
            ["0.0010 %", "9.94e-4 %", "0.10 %", "0.0994 %", "1234 %"]
        );
        assert_eq!([0, 9999, 10_000, 82_000_000].map(count), ["0", "9999", "10,000", "82,000,000"]);
        assert_eq!(
            [0.25, 1e6, 2.2e9, 12_345.678, 1e-6].map(rounded),
            ["0.25", "1e6", "2.2e9", "12350", "1e-6"]
        );
    }

    #[test]
    fn machine_numbers_read_back() {
        for v in [0.1, 1.0 / 3.0, 5e-324, f64::MAX, -0.0] {
            assert_eq!(exact(v).parse::<f64>().map(f64::to_bits), Ok(v.to_bits()));
        }
    }

    #[test]
    fn numbers_have_the_unit_that_suits_them() {
        for (value, unit, words) in [
            (1e9, "Pa", "1 GPa"),
            (9.99e8, "Pa", "999 MPa"),
            (1e6, "Pa", "1 MPa"),
            (-2500.0, "Pa", "-2.5 kPa"),
            (1.0, "Pa", "1 Pa"),
            (0.5, "Pa", "0.5 Pa"),
            (1e-3, "m/s", "0.001 m/s"),
            (9.9e-4, "m/s", "9.9e-4 m/s"),
            (9999.0, "m", "9999 m"),
            (1e4, "m", "1e4 m"),
            (0.123_456, "", "0.1235"),
        ] {
            assert_eq!(with_unit(value, unit), words);
        }
    }
}
