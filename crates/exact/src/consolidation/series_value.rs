//! The value of a truncated series and its bound.

/// A truncated sum, with what was left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesValue {
    /// The sum.
    pub value: f64,
    /// Number of terms in it.
    pub terms: usize,
    /// Rigorous bound on the absolute value of the omitted terms' sum.
    pub tail_bound: f64,
}

impl SeriesValue {
    /// A value that needs no sum.
    pub fn closed_form(value: f64) -> Self {
        Self { value, terms: 0, tail_bound: 0.0 }
    }
}
