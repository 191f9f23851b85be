//! Times as a person says and types them, and the units that they have.

use crate::numbers::rounded;

/// Seconds of a minute.
pub const MINUTE: f64 = 60.0;
/// Seconds of an hour.
pub const HOUR: f64 = 60.0 * MINUTE;
/// Seconds of a day.
pub const DAY: f64 = 24.0 * HOUR;
/// Seconds of a week.
pub const WEEK: f64 = 7.0 * DAY;
/// Seconds of a month, a twelfth of a year.
pub const MONTH: f64 = YEAR / 12.0;
/// Seconds of a year of 365.25 days.
pub const YEAR: f64 = 365.25 * DAY;

/// Units in which people say times: seconds of each, its name after one and after several.
const UNITS: [(f64, &str, &str); 4] =
    [(YEAR, "year", "years"), (DAY, "day", "days"), (HOUR, "h", "h"), (MINUTE, "min", "min")];

/// The number and the unit that fits: from two of it on, as 90 s and 36 h say more than 1.5 min and 1.5 days.
fn in_fitting_unit(seconds: f64) -> (f64, &'static str) {
    let fitting = UNITS.into_iter().find(|(unit, ..)| seconds >= 2.0 * unit);
    fitting.map_or((seconds, "s"), |(unit, _, plural)| (seconds / unit, plural))
}

/// A time as a person says it: two digits, in the unit that fits.
pub fn duration(seconds: f64) -> String {
    let (value, unit) = match in_fitting_unit(seconds) {
        (value, "s") if (1e-3..0.1).contains(&value) => (1e3 * value, "ms"),
        (value, "s") if (1e-6..1e-3).contains(&value) => (1e6 * value, "µs"),
        (value, "s") if (1e-9..1e-6).contains(&value) => (1e9 * value, "ns"),
        fitting => fitting,
    };
    let two_digits: f64 = format!("{value:.1e}").parse().unwrap_or(value);
    if two_digits >= 1e4 { format!("{two_digits:e} {unit}") } else { format!("{two_digits} {unit}") }
}

/// A time on the clock as a person types it: in the largest unit of which it is a whole number, or else with four digits in
/// the unit that fits.
pub fn clock_time(seconds: f64) -> String {
    for (unit, singular, plural) in UNITS {
        let count = (seconds / unit).round();
        if (1.0..1e4).contains(&count) && (seconds / (count * unit) - 1.0).abs() < 1e-9 {
            return format!("{} {}", rounded(count), if count == 1.0 { singular } else { plural });
        }
    }
    let (value, unit) = in_fitting_unit(seconds);
    format!("{} {unit}", rounded(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_unit_that_fits() {
        assert_eq!(
            [5e-9, 3.6e-5, 0.0123, 0.123, 90.0, 130.0, 216e3, 36.0 * HOUR, 40.0 * DAY, 1e12].map(duration),
            [
                "5 ns",
                "36 µs",
                "12 ms",
                "0.12 s",
                "90 s",
                "2.2 min",
                "2.5 days",
                "36 h",
                "40 days",
                "3.2e4 years"
            ]
        );
        let days = [365.0, 30.0, 1.0, 365.25, 730.5, 1.5, 400.0, 100.25].map(|days| clock_time(DAY * days));
        assert_eq!(days, ["365 days", "30 days", "1 day", "1 year", "2 years", "36 h", "400 days", "2406 h"]);
        let seconds = [90.0, 60.0, 7.3575, DAY * 1234.5, 0.0].map(clock_time);
        assert_eq!(seconds, ["90 s", "1 min", "7.357 s", "3.38 years", "0 s"]);
    }
}
