//! Numbers as they are written in the sentences of verdicts.

/// A number with four significant digits at most, without trailing zeros.
pub fn short(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-3..1e5).contains(&magnitude) {
        let rounded = format!("{value:.3e}").parse().unwrap_or(value);
        return format!("{rounded}");
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
    fn numbers_are_short_and_never_lose_their_magnitude() {
        assert_eq!(short(0.00625), "0.00625");
        assert_eq!(short(1.0 / 3.0), "0.3333");
        assert_eq!(short(160.0), "160");
        assert_eq!(short(2.345_67e-7), "2.35e-7");
        assert_eq!(short(-2e-4), "-2e-4");
        assert_eq!(short(0.0), "0");
        assert_eq!(short(f64::NAN), "NaN");
        assert_eq!(orders(&[2.0, -0.001, 1.234]), "2.00, 0.00, 1.23");
    }
}
