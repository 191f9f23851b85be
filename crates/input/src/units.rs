//! Numbers with a unit, like `"50 kPa"`: read as numbers in SI units where a key has a unit.

use crate::nearest::nearest;
use oedometer_wording::{DAY, HOUR, MINUTE, MONTH, WEEK, YEAR};
use std::f64::consts::PI;

/// A unit that a number may stand with: its names, the prefixes that it takes, the exponents of kilogram, metre and
/// second, and its size in these as a power of ten times a factor.
type Symbol = (&'static [&'static str], &'static str, [i32; 3], i32, f64);

/// Unlikely prefixes are left out: an `mPa` is a mistyped `MPa`.
const SYMBOLS: [Symbol; 14] = [
    (&["Pa"], "kMG", [1, -1, -2], 0, 1.0),
    (&["bar"], "", [1, -1, -2], 5, 1.0),
    (&["N"], "kM", [1, 1, -2], 0, 1.0),
    (&["m"], "kcmµu", [0, 1, 0], 0, 1.0),
    (&["g"], "kM", [1, 0, 0], -3, 1.0),
    (&["t"], "", [1, 0, 0], 3, 1.0),
    (&["s", "second", "seconds", "sec"], "mµun", [0, 0, 1], 0, 1.0),
    (&["min", "minute", "minutes"], "", [0, 0, 1], 0, MINUTE),
    (&["h", "hour", "hours", "hr"], "", [0, 0, 1], 0, HOUR),
    (&["d", "day", "days"], "", [0, 0, 1], 0, DAY),
    (&["week", "weeks"], "", [0, 0, 1], 0, WEEK),
    (&["month", "months"], "", [0, 0, 1], 0, MONTH),
    (&["a", "year", "years", "yr"], "", [0, 0, 1], 0, YEAR),
    (&["rad", "deg"], "", [0, 0, 0], 0, 1.0),
];

const PREFIXES: [(char, i32); 8] =
    [('G', 9), ('M', 6), ('k', 3), ('c', -2), ('m', -3), ('µ', -6), ('u', -6), ('n', -9)];

/// Digits and signs above the line, and signs of other keyboards, with the plain ones.
const PLAIN: [(char, char); 15] = [
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '-'),
    ('⁺', '+'),
    ('−', '-'),
    ('μ', 'µ'),
    ('\u{a0}', ' '),
];
/// How many of them stand above the line.
const ABOVE: usize = 12;
/// Signs of a product before a power of ten.
const TIMES: [char; 5] = ['x', 'X', '×', '*', '·'];

/// Units as messages name them.
const USUAL: [&str; 25] = [
    "kPa", "MPa", "GPa", "Pa", "kN/m²", "bar", "m", "cm", "mm", "s", "min", "h", "days", "months", "years",
    "m/s", "cm/s", "m/day", "m/year", "kg/m³", "g/cm³", "kN/m³", "m/s²", "rad", "rad/s",
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
        let text = plain(text);
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
        let found = known(symbol).or_else(|| {
            // In other letters, where only one unit is meant: of `mpa` it may be the first letter that is wrong.
            let mut alike = spelled_otherwise(symbol);
            let only = alike.next().filter(|found| !is_doubtful(symbol, found))?;
            if alike.next().is_none() { known(&only) } else { None }
        });
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

/// A text without signs that stand for others; digits above the line are an exponent.
fn plain(text: &str) -> String {
    let mut found = String::with_capacity(text.len());
    let mut is_above = false;
    for letter in text.chars() {
        let known = PLAIN.iter().position(|(other, _)| *other == letter);
        let is_exponent = known.is_some_and(|place| place < ABOVE);
        if is_exponent && !is_above && !found.ends_with('^') {
            found.push('^');
        }
        is_above = is_exponent;
        found.push(known.map_or(letter, |place| PLAIN[place].1));
    }
    found
}

/// A symbol in its own letters, and the power of ten of its prefix.
fn known(symbol: &str) -> Option<(&'static Symbol, i32)> {
    let whole = SYMBOLS.iter().find(|one| one.0.contains(&symbol)).map(|one| (one, 0));
    let prefixed = |(names, prefixes, ..): &Symbol| {
        let (prefix, tens) = PREFIXES.iter().find(|(prefix, _)| symbol.starts_with(*prefix))?;
        let rest = symbol.strip_prefix(*prefix)?;
        (prefixes.contains(*prefix) && names.first() == Some(&rest)).then_some(*tens)
    };
    whole.or_else(|| SYMBOLS.iter().find_map(|one| Some((one, prefixed(one)?))))
}

/// The symbols that differ from a text by capitals alone.
fn spelled_otherwise(symbol: &str) -> impl Iterator<Item = String> {
    let names = SYMBOLS.iter().flat_map(|(names, ..)| names.iter().map(|name| (*name).to_owned()));
    let prefixed = SYMBOLS.iter().flat_map(|(names, prefixes, ..)| {
        prefixes.chars().filter_map(|prefix| Some(format!("{prefix}{}", names.first()?)))
    });
    let lower = symbol.to_lowercase();
    names.chain(prefixed).filter(move |name| name.to_lowercase() == lower)
}

/// Whether a text may mean another unit than the symbol that it differs from by capitals: milli or mega, a prefix alone.
fn is_doubtful(typed: &str, symbol: &str) -> bool {
    let first = |text: &str| text.chars().next().filter(|letter| letter.eq_ignore_ascii_case(&'m'));
    let is_word = SYMBOLS.iter().any(|one| one.0.contains(&symbol)) && symbol.len() > 1;
    !is_word && (first(typed).is_some() && first(typed) != first(symbol) || symbol == "m")
}

/// The number that a text begins with as a decimal number, and the rest: `10^-9`, `1x10-9` and `1·10⁻⁹` are `1e-9`.
fn number_and_rest(text: &str) -> (String, String) {
    let number = leading_number(text);
    let own = &text[number.len()..];
    let rest = plain(own);
    // A power of ten behind a factor, or alone.
    let base =
        rest.trim_start().strip_prefix(TIMES).map(str::trim_start).and_then(|rest| rest.strip_prefix("10"));
    let power = match base {
        Some(after) if !number.is_empty() => Some((number, after)),
        None if number == "10" && rest.starts_with(['^', '*']) => Some(("1", rest.as_str())),
        _ => None,
    };
    let exponent = power.and_then(|(factor, after)| {
        let after = after.trim_start_matches(['^', '*']);
        let digits = after.strip_prefix(['+', '-']).unwrap_or(after);
        let end = after.len() - digits.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
        after[..end]
            .parse::<i32>()
            .ok()
            .map(|exponent| (format!("{factor}e{exponent}"), after[end..].to_owned()))
    });
    exponent.unwrap_or_else(|| (number.to_owned(), own.to_owned()))
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
    let (number, rest) = number_and_rest(text);
    let (number, symbol) = (number.as_str(), rest.trim());
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
    let meant = |right: &str| format!("did you mean {right}? {}", help(example));
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
        let is_power =
            symbol.is_empty() && number.parse::<f64>().is_ok() && leading_number(text) != text.trim();
        let help = if is_power { meant(&format!("{number}, without quotes")) } else { help(example) };
        return Err((format!("`{text}` is not a number with a unit"), help));
    }
    let Some(unit) = Unit::read(symbol) else {
        let near = nearest(symbol, usual.iter().copied());
        let help = near.map_or_else(|| help(example), |near| meant(&format!("\"{number} {near}\"")));
        return Err((format!("the unit `{symbol}` is not known"), help));
    };
    if Some(unit.dimension) != wanted {
        return Err((format!("`{symbol}` is not a unit for a quantity in {si}"), help(example)));
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
        "write a fraction as a plain number, like 0.01, or a percentage in quotes, like \"1 %\"".to_owned();
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
    let (number, rest) = number_and_rest(text);
    !number.is_empty() && Unit::read(rest.trim()).is_some()
}

/// Whether a text is a unit, as this program or another writes it.
pub fn is_unit(text: &str) -> bool {
    Unit::read(&in_symbols(text)).is_some()
}

/// Units in words, as other programs write them, with their symbols; words of a prefix may stand before them.
const WORDS: [(&str, &str); 8] = [
    ("metre", "m"),
    ("meter", "m"),
    ("pascal", "Pa"),
    ("second", "s"),
    ("newton", "N"),
    ("gram", "g"),
    ("minute", "min"),
    ("hour", "h"),
];
/// Prefixes in words.
const PREFIX_WORDS: [(&str, &str); 7] = [
    ("nano", "n"),
    ("micro", "µ"),
    ("milli", "m"),
    ("centi", "c"),
    ("kilo", "k"),
    ("mega", "M"),
    ("giga", "G"),
];

/// A unit that is written in words in symbols: `kPa` for `kilopascals`; of `days since 1970-01-01` the unit.
fn in_symbols(text: &str) -> String {
    let text = text.split(" since ").next().unwrap_or_default().trim();
    let lower = text.to_lowercase();
    let (rest, prefix) = PREFIX_WORDS
        .iter()
        .find_map(|(word, prefix)| Some((lower.strip_prefix(word)?, *prefix)))
        .unwrap_or((&lower, ""));
    let word = WORDS.iter().find(|(word, _)| rest == *word || rest.strip_suffix('s') == Some(word));
    word.map_or_else(|| text.to_owned(), |(_, symbol)| format!("{prefix}{symbol}"))
}

/// How many SI units one unit of a name is, where it is of the same kind as another: 1000 of `kPa` for `Pa`.
pub fn size_of(unit: &str, si: &str) -> Option<f64> {
    let (found, wanted) = (Unit::read(&in_symbols(unit))?, Unit::read(si)?);
    (found.dimension == wanted.dimension).then(|| shifted(found.up / found.down, found.tens)).flatten()
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
            // Other letters, other ways to write a power of ten.
            ("50 kpa", "Pa", 50e3),
            ("50 KPA", "Pa", 50e3),
            ("2 Mpa", "Pa", 2e6),
            ("3 KN/m2", "Pa", 3e3),
            ("1e-9 m/Day", "m/s", 1e-9 / 86_400.0),
            ("5 Years", "s", 5.0 * 31_557_600.0),
            ("6 months", "s", 15_778_800.0),
            ("10^-9 m/s", "m/s", 1e-9),
            ("10**-9 m/s", "m/s", 1e-9),
            ("10⁻⁹ m/s", "m/s", 1e-9),
            ("1x10-9 m/s", "m/s", 1e-9),
            ("1.1 × 10^-9 m/s", "m/s", 1.1e-9),
            ("2·10⁻⁹ m·s⁻¹", "m/s", 2e-9),
            ("2*10^3 kPa", "Pa", 2e6),
        ] {
            assert_eq!(in_si(text, si), Ok(value), "{text}");
        }
    }

    #[test]
    fn a_unit_of_another_kind_and_an_unknown_one_are_refused_with_what_would_be_right() {
        for (text, si, message, help) in [
            ("5 m", "Pa", "`m` is not a unit for a quantity in Pa", "\"10 kPa\""),
            (
                "5 mpa",
                "Pa",
                "the unit `mpa` is not known",
                "did you mean \"5 MPa\"? write a plain number in Pa",
            ),
            ("10^-9", "m/s", "`10^-9` is not a number with a unit", "did you mean 1e-9, without quotes?"),
            ("3 KN/M2", "Pa", "the unit `KN/M2` is not known", "did you mean \"3 kN/m²\"?"),
            ("5 M", "m", "the unit `M` is not known", "did you mean \"5 m\"?"),
            ("1,5 kPa", "Pa", "has a comma in its number", "write a decimal point: \"1.5 kPa\""),
            ("1,500 kPa", "Pa", "has a comma in its number", "\"1.500 kPa\", or no separator: \"1500 kPa\""),
            ("5 mPa", "Pa", "the unit `mPa` is not known", "\"5 MPa\""),
            ("5 m/s2", "m/s", "`m/s2` is not a unit for a quantity in m/s", "\"10 m/s\""),
            ("kPa", "Pa", "`kPa` is not a number with a unit", "\"10 kPa\""),
            ("5", "s", "`5` is not a number with a unit", "\"10 s\""),
            ("1e400 kPa", "Pa", "is not a finite number", ""),
            ("1 kPa", "%", "`1 kPa` is not a percentage", "\"1 %\""),
            ("%", "%", "`%` is not a percentage", "0.01"),
            ("5 %", "Pa", "the unit `%` is not known", "\"10 kPa\""),
            ("10-9 m/s", "m/s", "the unit `-9 m/s` is not known", "m/s"),
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
    fn units_of_files_are_read_in_words_too() {
        for (unit, si, size) in [
            ("nanoseconds", "s", Some(1e-9)),
            ("ms", "s", Some(1e-3)),
            ("days since 1970-01-01 00:00:00", "s", Some(86_400.0)),
            ("hours", "s", Some(3600.0)),
            ("kilopascal", "Pa", Some(1e3)),
            ("KPa", "Pa", Some(1e3)),
            ("millimetres", "m", Some(1e-3)),
            ("meters", "m", Some(1.0)),
            ("m", "Pa", None),
            ("degC", "Pa", None),
        ] {
            assert_eq!(size_of(unit, si), size, "{unit}");
        }
        assert!(is_unit("kN/m²") && !is_unit("clay") && !is_unit(""));
    }

    #[test]
    fn prefixes_that_nobody_means_and_powers_beyond_all_sense_are_no_units() {
        for symbol in [
            "mPa", "cPa", "µPa", "kbar", "mbar", "mN", "GN", "Mm", "Gm", "mg", "cg", "Gg", "kt", "Mt", "ks",
            "cs", "Ms", "kh", "md", "ma", "mmin", "mseconds", "krad", "mdeg", "mpa", "MM", "M", "k", "m^10",
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
