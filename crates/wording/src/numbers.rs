//! Numbers as sentences write them.

/// A number with four significant digits at most, and three beside a power of ten, without trailing zeros.
pub fn rounded(value: f64) -> String {
    // No sign at zero.
    let value = value + 0.0;
    let magnitude = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-3..1e5).contains(&magnitude) {
        let four_digits: f64 = format!("{value:.3e}").parse().unwrap_or(value);
        return format!("{four_digits}");
    }
    let text = format!("{value:.2e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
            format!("{mantissa}e{exponent}")
        }
        None => text,
    }
}

/// A number as a person types it; with a power of ten if it would need a line of zeros.
pub fn typed(value: f64) -> String {
    let text = format!("{}", value + 0.0);
    if text.len() > LONGEST { format!("{value:e}") } else { text }
}

/// Most characters of a number without a power of ten: all digits of a double, sign and point.
const LONGEST: usize = 24;

/// A number of things: `1 case`, `3 cases`.
pub fn count_of(count: usize, singular: &str, plural: &str) -> String {
    format!("{count} {}", if count == 1 { singular } else { plural })
}

/// The first parts of a list, and how many more there are.
pub fn first_few(mut parts: Vec<String>, most: usize) -> Vec<String> {
    let rest = parts.len().saturating_sub(most);
    if rest > 0 {
        parts.truncate(most);
        parts.push(format!("and {rest} more"));
    }
    parts
}

/// An order of convergence with two decimals; -0.00 is written 0.00.
pub fn order(value: f64) -> String {
    let text = format!("{value:.2}");
    if text == "-0.00" { "0.00".to_owned() } else { text }
}

/// Orders in a row, from coarse to fine.
pub fn orders(values: &[f64]) -> String {
    values.iter().map(|value| order(*value)).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_and_never_lose_their_magnitude() {
        assert_eq!(rounded(0.00625), "0.00625");
        assert_eq!(rounded(1.0 / 3.0), "0.3333");
        assert_eq!(rounded(160.0), "160");
        assert_eq!(rounded(2.345_67e-7), "2.35e-7");
        assert_eq!(rounded(-2e-4), "-2e-4");
        assert_eq!(rounded(0.0), "0");
        assert_eq!(rounded(-0.0), "0");
        assert_eq!(rounded(f64::NAN), "NaN");
        assert_eq!([0.05, 1e-4, -0.0, 50.0].map(typed), ["0.05", "0.0001", "0", "50"]);
        assert_eq!([1, 0, 2].map(|n| count_of(n, "study", "studies")), ["1 study", "0 studies", "2 studies"]);
        assert_eq!([1e-300, 1e300].map(typed), ["1e-300", "1e300"]);
        assert_eq!(orders(&[2.0, -0.001, 1.234]), "2.00, 0.00, 1.23");
    }
}
