//! Numbers with a unit, like `"50 kPa"`: read as numbers in SI units where a key has a unit.

use crate::diagnostic::nearest;
use std::f64::consts::PI;

/// A unit that a number may stand with: its names, the prefixes that it takes, the exponents of kilogram, metre and
/// second, and its size in these as a power of ten times a factor.
type Symbol = (&'static [&'static str], &'static str, [i32; 3], i32, f64);

/// Unlikely prefixes are left out: an `mPa` is a mistyped `MPa`.
const SYMBOLS: [Symbol; 12] = [
    (&["Pa"], "kMG", [1, -1, -2], 0, 1.0),
    (&["bar"], "", [1, -1, -2], 5, 1.0),
    (&["N"], "kM", [1, 1, -2], 0, 1.0),
    (&["m"], "kcmµu", [0, 1, 0], 0, 1.0),
    (&["g"], "kM", [1, 0, 0], -3, 1.0),
    (&["t"], "", [1, 0, 0], 3, 1.0),
    (&["s", "second", "seconds"], "mµu", [0, 0, 1], 0, 1.0),
    (&["min", "minute", "minutes"], "", [0, 0, 1], 0, 60.0),
    (&["h", "hour", "hours"], "", [0, 0, 1], 0, 3600.0),
    (&["d", "day", "days"], "", [0, 0, 1], 0, 86_400.0),
    (&["a", "year", "years"], "", [0, 0, 1], 0, 365.25 * 86_400.0),
    (&["rad", "deg"], "", [0, 0, 0], 0, 1.0),
];

const PREFIXES: [(char, i32); 7] = [('G', 9), ('M', 6), ('k', 3), ('c', -2), ('m', -3), ('µ', -6), ('u', -6)];

/// Units as messages name them.
const USUAL: [&str; 24] = [
    "kPa", "MPa", "GPa", "Pa", "kN/m²", "bar", "m", "cm", "mm", "s", "min", "h", "days", "years", "m/s",
    "cm/s", "m/day", "m/year", "kg/m³", "g/cm³", "kN/m³", "m/s²", "rad", "rad/s",
];

/// The unit of a key that is a share of something: a plain number, or a percentage in quotes.
pub const SHARE: &str = "%";

/// What a unit is of, and how large it is in SI units: `10^tens · up / down`.
#[derive(Clone, Copy, PartialEq)]
struct Unit {
    dimension: [i32; 3],
    tens: i32,
    up: f64,
    down: f64,
}

impl Unit {
    /// Reads a product of powers of symbols, like `kN/m³` or `m/day`.
    fn read(text: &str) -> Option<Self> {
        let text = text.replace('²', "2").replace('³', "3");
        let mut unit = Self { dimension: [0; 3], tens: 0, up: 1.0, down: 1.0 };
        for (number, product) in text.split('/').enumerate() {
            // Neither `m/` nor `/` is a unit.
            if product.trim_matches([' ', '*', '·']).is_empty() {
                return None;
            }
            for power in product.split([' ', '*', '·']).filter(|power| !power.is_empty()) {
                let end = power.find(|letter: char| letter.is_ascii_digit() || "^-".contains(letter));
                let (symbol, exponent) = power.split_at(end.unwrap_or(power.len()));
                let exponent: i32 =
                    if exponent.is_empty() { 1 } else { exponent.trim_start_matches('^').parse().ok()? };
                if !(-9..=9).contains(&exponent) {
                    return None;
                }
                unit.multiply(symbol, if number == 0 { exponent } else { -exponent })?;
            }
        }
        Some(unit)
    }

    fn multiply(&mut self, symbol: &str, exponent: i32) -> Option<()> {
        let plain = |names: &[&str], symbol: &str| names.contains(&symbol).then_some(0);
        let prefixed = |(names, prefixes, ..): &Symbol| {
            let (prefix, tens) = PREFIXES.iter().find(|(prefix, _)| symbol.starts_with(*prefix))?;
            let rest = symbol.strip_prefix(*prefix)?;
            (prefixes.contains(*prefix) && names.first() == Some(&rest)).then_some(*tens)
        };
        let whole = SYMBOLS.iter().find_map(|one| Some((one, plain(one.0, symbol)?)));
        let found = whole.or_else(|| SYMBOLS.iter().find_map(|one| Some((one, prefixed(one)?))));
        let ((_, _, dimension, own, factor), prefix) = found?;
        for (sum, one) in self.dimension.iter_mut().zip(dimension) {
            *sum += exponent * one;
        }
        self.tens += exponent * (own + prefix);
        let factor = if symbol == "deg" { PI / 180.0 } else { *factor };
        let side = if exponent < 0 { &mut self.down } else { &mut self.up };
        *side *= (0..exponent.abs()).map(|_| factor).product::<f64>();
        Some(())
    }
}

/// Whether a comma before these words may separate thousands.
pub(crate) fn is_thousands(after: &str) -> bool {
    after.chars().take_while(char::is_ascii_digit).count() == 3
}

/// The number in SI units of a text like `50 kPa`, for a key with this SI unit; or what is wrong and what would be
/// right.
///
/// Decimal units shift the decimal point and round nothing: `"1.1 kPa"` is the number `1100`.
///
/// # Errors
/// Where the text is not a number with a unit, or where the unit is of another kind.
pub fn in_si(text: &str, si: &str) -> Result<f64, (String, String)> {
    let number = leading_number(text);
    let symbol = text[number.len()..].trim();
    if si == SHARE {
        return share(text, number, symbol);
    }
    let wanted = Unit::read(si).map(|unit| unit.dimension);
    let fits = |name: &&str| Unit::read(name).map(|unit| unit.dimension) == wanted;
    let usual: Vec<&str> = USUAL.into_iter().filter(fits).collect();
    let example = usual.first().unwrap_or(&si);
    let help = |near: &str| {
        format!(
            "write a plain number in {si}, or one with its unit in quotes, like \"10 {near}\": {}",
            usual.join(", ")
        )
    };
    if let Some(decimals) =
        symbol.strip_prefix(',').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    {
        let thousands = if is_thousands(decimals) {
            format!(", or no separator: \"{number}{decimals}\"")
        } else {
            String::new()
        };
        return Err((
            format!("`{text}` has a comma in its number"),
            format!("write a decimal point: \"{number}.{decimals}\"{thousands}"),
        ));
    }
    if number.is_empty() || symbol.is_empty() {
        return Err((format!("`{text}` is not a number with a unit"), help(example)));
    }
    let Some(unit) = Unit::read(symbol) else {
        let near = nearest(symbol, usual.iter().copied()).unwrap_or(example);
        return Err((format!("the unit `{symbol}` is not known"), help(near)));
    };
    if Some(unit.dimension) != wanted {
        return Err((format!("`{symbol}` is not a unit of what is measured in {si}"), help(example)));
    }
    let value = number.parse::<f64>().unwrap_or(f64::NAN) * unit.up / unit.down;
    match shifted(value, unit.tens) {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err((format!("`{text}` is not a finite number"), help(example))),
    }
}

/// The share that a percentage is: `1 %` is `0.01`.
fn share(text: &str, number: &str, symbol: &str) -> Result<f64, (String, String)> {
    let help =
        "write a share as a plain number, like 0.01, or a percentage in quotes, like \"1 %\"".to_owned();
    let value = number.parse::<f64>().ok().filter(|_| symbol == SHARE).and_then(|value| shifted(value, -2));
    match value {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err((format!("`{text}` is not a percentage"), help)),
    }
}

/// A number with its decimal point moved: nothing is rounded.
fn shifted(value: f64, tens: i32) -> Option<f64> {
    let scaled = format!("{value:e}");
    let (digits, exponent) = scaled.split_once('e')?;
    format!("{digits}e{}", exponent.parse::<i32>().ok()? + tens).parse().ok()
}

/// The number that a text begins with.
pub fn leading_number(text: &str) -> &str {
    let mut ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
    let end = ends.rfind(|end| text[..*end].trim_end().parse::<f64>().is_ok()).unwrap_or(0);
    text[..end].trim_end()
}

/// Whether a text is a number with a unit, of whatever kind.
pub fn has_unit(text: &str) -> bool {
    let number = leading_number(text);
    !number.is_empty() && Unit::read(text[number.len()..].trim()).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_with_a_unit_is_the_number_that_one_would_type_in_si() {
        for (text, si, value) in [
            ("50 kPa", "Pa", 50e3),
            ("1.1 kPa", "Pa", 1100.0),
            ("2 GPa", "Pa", 2e9),
            ("2.2e3 MPa", "Pa", 2.2e9),
            ("3 kN/m2", "Pa", 3e3),
            ("3 N/mm²", "Pa", 3e6),
            ("1 bar", "Pa", 1e5),
            ("5 m", "m", 5.0),
            ("12.5cm", "m", 0.125),
            ("1e-9 m/s", "m/s", 1e-9),
            ("8.64 m/day", "m/s", 1e-4),
            ("36 cm/h", "m/s", 1e-4),
            ("2 days", "s", 172_800.0),
            ("0.5 h", "s", 1800.0),
            ("2 min", "s", 120.0),
            ("20 kN/m3", "N/m³", 20e3),
            ("2.65 g/cm³", "kg/m³", 2650.0),
            ("9.81 m/s^2", "m/s²", 9.81),
            ("180 deg", "rad", PI),
            ("1 %", "%", 0.01),
            ("0.7%", "%", 0.007),
        ] {
            assert_eq!(in_si(text, si), Ok(value), "{text}");
        }
    }

    #[test]
    fn a_unit_of_another_kind_and_an_unknown_one_are_refused_with_what_would_be_right() {
        for (text, si, message, help) in [
            ("5 m", "Pa", "`m` is not a unit of what is measured in Pa", "\"10 kPa\""),
            ("5 kpa", "Pa", "the unit `kpa` is not known", "\"10 kPa\""),
            ("1,5 kPa", "Pa", "has a comma in its number", "write a decimal point: \"1.5 kPa\""),
            ("1,500 kPa", "Pa", "has a comma in its number", "\"1.500 kPa\", or no separator: \"1500 kPa\""),
            ("5 mPa", "Pa", "the unit `mPa` is not known", "\"10 MPa\""),
            ("5 m/s2", "m/s", "`m/s2` is not a unit of what is measured in m/s", "\"10 m/s\""),
            ("kPa", "Pa", "`kPa` is not a number with a unit", "\"10 kPa\""),
            ("5", "s", "`5` is not a number with a unit", "\"10 s\""),
            ("1e400 kPa", "Pa", "is not a finite number", ""),
            ("1 kPa", "%", "`1 kPa` is not a percentage", "\"1 %\""),
            ("%", "%", "`%` is not a percentage", "0.01"),
            ("5 %", "Pa", "the unit `%` is not known", "\"10 kPa\""),
            ("5 m^99999999999", "m", "is not known", ""),
            ("5 m^-2147483648", "m", "is not known", ""),
        ] {
            let (told, right) = in_si(text, si).expect_err(text);
            assert!(told.contains(message) && right.contains(help), "{text}: {told}; {right}");
        }
    }

    /// Symbols of one letter or two, with their sizes.
    const SYMBOLS: [(&str, &str, f64); 25] = [
        ("Pa", "Pa", 1.0),
        ("kPa", "Pa", 1e3),
        ("MPa", "Pa", 1e6),
        ("GPa", "Pa", 1e9),
        ("bar", "Pa", 1e5),
        ("N", "N", 1.0),
        ("kN", "N", 1e3),
        ("MN", "N", 1e6),
        ("m", "m", 1.0),
        ("km", "m", 1e3),
        ("cm", "m", 1e-2),
        ("mm", "m", 1e-3),
        ("µm", "m", 1e-6),
        ("g", "kg", 1e-3),
        ("kg", "kg", 1.0),
        ("Mg", "kg", 1e3),
        ("t", "kg", 1e3),
        ("s", "s", 1.0),
        ("ms", "s", 1e-3),
        ("µs", "s", 1e-6),
        ("min", "s", 60.0),
        ("h", "s", 3600.0),
        ("d", "s", 86_400.0),
        ("a", "s", 31_557_600.0),
        ("deg", "rad", PI / 180.0),
    ];

    #[test]
    fn every_symbol_with_every_prefix_has_its_literal_size() {
        let more = [
            ("N/m2", "Pa", 1.0),
            ("kN/m2", "Pa", 1e3),
            ("MN/m2", "Pa", 1e6),
            ("um", "m", 1e-6),
            ("g/m3", "kg/m³", 1e-3),
            ("kg/m3", "kg/m³", 1.0),
            ("Mg/m3", "kg/m³", 1e3),
            ("t/m3", "kg/m³", 1e3),
            ("second", "s", 1.0),
            ("seconds", "s", 1.0),
            ("us", "s", 1e-6),
            ("minute", "s", 60.0),
            ("minutes", "s", 60.0),
            ("hour", "s", 3600.0),
            ("hours", "s", 3600.0),
            ("day", "s", 86_400.0),
            ("days", "s", 86_400.0),
            ("year", "s", 31_557_600.0),
            ("years", "s", 31_557_600.0),
            ("rad", "rad", 1.0),
        ];
        for (symbol, si, size) in SYMBOLS.into_iter().chain(more) {
            let found = in_si(&format!("3 {symbol}"), si).unwrap_or_else(|told| panic!("{symbol}: {told:?}"));
            assert!((found / (3.0 * size) - 1.0).abs() < 1e-15, "{symbol}: {found}");
            assert!(has_unit(&format!("3 {symbol}")), "{symbol}");
        }
        // A quotient of several symbols, and powers of either sign.
        for (text, si, value) in [
            ("6 kg/m/s2", "Pa", 6.0),
            ("6 kg m^-1 s^-2", "Pa", 6.0),
            ("6 m/s/s", "m/s²", 6.0),
            ("6 cm/min", "m/s", 1e-3),
            ("31557.6 km/year", "m/s", 1.0),
            ("6 deg/min", "rad/s", PI / 1800.0),
        ] {
            let found = in_si(text, si).unwrap_or_else(|told| panic!("{text}: {told:?}"));
            assert!((found / value - 1.0).abs() < 1e-15, "{text}: {found}");
        }
    }

    #[test]
    fn every_symbol_at_every_power_is_its_size_to_that_power() {
        for (symbol, si, size) in SYMBOLS {
            for power in [1, 2, 3, -1, -2, -3] {
                let size = f64::powi(size, power);
                let digits = power.abs();
                let of_si = format!("{si}^{power}");
                let mut spellings = vec![format!("7 {symbol}^{power}"), format!("7 {symbol}{power}")];
                if power < 0 {
                    // Below a fraction bar the power is positive, and the product above it is none of its business.
                    spellings = vec![format!("7 {symbol}^{power}"), format!("7 s^2/{symbol}^{digits}/s/s")];
                }
                for text in spellings {
                    let found = in_si(&text, &of_si).unwrap_or_else(|told| panic!("{text}: {told:?}"));
                    assert!((found / (7.0 * size) - 1.0).abs() < 2e-15, "{text}: {found:e} for {size:e}");
                }
                // Another power is of another kind, but of an angle.
                assert!(
                    si == "rad" || in_si(&format!("7 {symbol}^{}", power + 1), &of_si).is_err(),
                    "{symbol}^{power}"
                );
            }
        }
    }

    #[test]
    fn prefixes_that_nobody_means_and_powers_beyond_all_sense_are_no_units() {
        for symbol in [
            "mPa", "cPa", "µPa", "kbar", "mbar", "mN", "GN", "Mm", "Gm", "mg", "cg", "Gg", "kt", "Mt", "ks",
            "cs", "Ms", "kh", "md", "ma", "mmin", "mseconds", "krad", "mdeg", "pa", "PA", "M", "k", "m^10",
            "m-10", "m^x", "m/", "/", "/s", "m//s", "*", "1/s",
        ] {
            assert!(!has_unit(&format!("3 {symbol}")), "{symbol}");
        }
        assert!(has_unit("3 m^9") && has_unit("3 m-9"));
        // The same kind by other symbols, and one exponent off.
        for (text, si) in [
            ("3 m²", "m"),
            ("3 kg m/s", "N/m³"),
            ("3 m/", "m"),
            ("3 /", "rad"),
            ("3 s²", "s"),
            ("3 N/m", "Pa"),
        ] {
            assert!(in_si(text, si).is_err(), "{text} as {si}");
        }
    }
}
