//! Numbers as they are written in the sentences of verdicts.

/// A number with four significant digits at most, without trailing zeros.
pub fn short(value: f64) -> String {
    // No sign at zero.
    let value = value + 0.0;
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

/// A number as a person types it; with a power of ten if it would need a line of zeros.
pub fn typed(value: f64) -> String {
    let text = format!("{}", value + 0.0);
    if text.len() > LONGEST { format!("{value:e}") } else { text }
}

/// Most characters of a number without a power of ten: all digits of a double, sign and point.
const LONGEST: usize = 24;

/// A time as a person says it: two digits, in the unit that fits.
pub fn duration(seconds: f64) -> String {
    const UNITS: [(f64, &str); 4] =
        [(365.25 * 86400.0, "years"), (86400.0, "days"), (3600.0, "h"), (60.0, "min")];
    let two_digits = |value: f64| {
        let rounded: f64 = format!("{value:.1e}").parse().unwrap_or(value);
        if rounded >= 1e4 { format!("{rounded:e}") } else { format!("{rounded}") }
    };
    // A unit from two of it on: 90 s and 36 h say more than 1.5 min and 1.5 days.
    match UNITS.into_iter().find(|(unit, _)| seconds >= 2.0 * unit) {
        Some((unit, name)) => format!("{} {name}", two_digits(seconds / unit)),
        None if (1e-6..1e-3).contains(&seconds) => format!("{} µs", two_digits(1e6 * seconds)),
        None => format!("{} s", two_digits(seconds)),
    }
}

/// A time on the clock as a person types it: in the largest unit of which it is a whole number, or else with four digits in
/// the unit that fits.
pub fn clock_time(seconds: f64) -> String {
    const UNITS: [(f64, &str, &str); 4] = [
        (365.25 * 86400.0, "year", "years"),
        (86400.0, "day", "days"),
        (3600.0, "h", "h"),
        (60.0, "min", "min"),
    ];
    for (unit, singular, plural) in UNITS {
        let count = (seconds / unit).round();
        if (1.0..1e4).contains(&count) && (seconds / (count * unit) - 1.0).abs() < 1e-9 {
            return format!("{} {}", short(count), if count == 1.0 { singular } else { plural });
        }
    }
    match UNITS.into_iter().find(|(unit, ..)| seconds >= 2.0 * unit) {
        Some((unit, _, plural)) => format!("{} {plural}", short(seconds / unit)),
        None => format!("{} s", short(seconds)),
    }
}

/// A number of things: `1 case`, `3 cases`.
pub fn count_of(count: usize, singular: &str, plural: &str) -> String {
    format!("{count} {}", if count == 1 { singular } else { plural })
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

/// Whether a field has its default: files leave it out then.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Names the choices of an enumeration in one place: `ALL` and `NAMES` in the order of tables, `name` and `named`, and
/// the same names in files (serde) and in their JSON Schemas.
#[macro_export]
macro_rules! words {
    ($kind:ident: $($variant:ident $word:literal),+ $(,)?) => {
        #[allow(dead_code, reason = "few enumerations need all of them")]
        impl $kind {
            /// All choices, in the order of tables.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            /// The names of all, in the order of tables.
            pub const NAMES: [&'static str; Self::ALL.len()] = [$($word),+];

            /// Name in files, records and tables.
            #[inline]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }

            /// The choice with a name.
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|choice| choice.name() == name)
            }
        }

        impl $crate::wording::serde::Serialize for $kind {
            fn serialize<S: $crate::wording::serde::Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
                out.serialize_str(self.name())
            }
        }

        impl<'de> $crate::wording::serde::Deserialize<'de> for $kind {
            fn deserialize<D: $crate::wording::serde::Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
                use $crate::wording::serde::de::Error;
                let name = <String as $crate::wording::serde::Deserialize>::deserialize(input)?;
                Self::named(&name).ok_or_else(|| D::Error::unknown_variant(&name, &Self::NAMES))
            }
        }

        impl $crate::wording::schemars::JsonSchema for $kind {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($kind).into()
            }
            fn json_schema(_: &mut $crate::wording::schemars::SchemaGenerator) -> $crate::wording::schemars::Schema {
                $crate::wording::schemars::json_schema!({ "type": "string", "enum": Self::NAMES })
            }
        }
    };
}
pub use words;
#[doc(hidden)]
pub use {schemars, serde};

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
        assert_eq!(short(-0.0), "0");
        assert_eq!(short(f64::NAN), "NaN");
        assert_eq!([0.05, 1e-4, -0.0, 50.0].map(typed), ["0.05", "0.0001", "0", "50"]);
        assert_eq!(
            [3.6e-5, 0.0123, 90.0, 130.0, 216e3, 36.0 * 3600.0, 40.0 * 86400.0, 1e12].map(duration),
            ["36 µs", "0.012 s", "90 s", "2.2 min", "2.5 days", "36 h", "40 days", "3.2e4 years"]
        );
        let days =
            [365.0, 30.0, 1.0, 365.25, 730.5, 1.5, 400.0, 100.25].map(|days| clock_time(86400.0 * days));
        assert_eq!(days, ["365 days", "30 days", "1 day", "1 year", "2 years", "36 h", "400 days", "2406 h"]);
        let seconds = [90.0, 60.0, 7.3575, 86400.0 * 1234.5, 0.0].map(clock_time);
        assert_eq!(seconds, ["90 s", "1 min", "7.357 s", "3.38 years", "0 s"]);
        assert_eq!([1, 0, 2].map(|n| count_of(n, "study", "studies")), ["1 study", "0 studies", "2 studies"]);
        assert_eq!([1e-300, 1e300].map(typed), ["1e-300", "1e300"]);
        assert_eq!(orders(&[2.0, -0.001, 1.234]), "2.00, 0.00, 1.23");
    }
}
