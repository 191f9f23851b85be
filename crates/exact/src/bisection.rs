//! Roots of functions, by bisection.

/// The root of a function that is negative at `low` and positive at `high`, to the last bit.
pub(crate) fn bisected(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if function(middle) < 0.0 { low = middle } else { high = middle }
    }
}
