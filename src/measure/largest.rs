//! The largest of numbers of which none may get lost: `f64::max` drops what is no number, and a run without an answer would
//! pass by those that have one.

/// The larger of two; what is no number is larger than any.
pub fn larger(one: f64, other: f64) -> f64 {
    if one > other || one.is_nan() { one } else { other }
}

/// The largest of numbers, or the one that is none; nothing of nothing.
pub fn largest(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    numbers.into_iter().reduce(larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_and_what_is_no_number_are_found_wherever_they_stand() {
        for worst in [9.0, f64::INFINITY, f64::NAN] {
            for place in 0..3 {
                let mut numbers = [1.0, -20.0, 3.0];
                numbers[place] = worst;
                let found = largest(numbers).expect("three numbers");
                assert!(found == worst || found.is_nan() && worst.is_nan(), "{numbers:?}: {found}");
            }
        }
        assert_eq!(largest([]), None);
    }
}
