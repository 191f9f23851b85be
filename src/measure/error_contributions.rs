//! Which places carry an error.

use crate::elementary;

/// One place's part in the error of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Place in the list of samples, from 0.
    pub index: usize,
    /// Computed less exact, in the unit of the field.
    pub error: f64,
    /// Share of the squared L2 error, from 0 to 1.
    pub share: f64,
}

/// The parts of all places, the largest share first; none where the error vanishes or is no number.
pub fn contributions(computed: &[f64], exact: &[f64], volumes: &[f64]) -> Vec<Contribution> {
    // Scaled by the largest, so that the squares of tiny errors do not vanish.
    let errors: Vec<f64> = computed.iter().zip(exact).map(|(computed, exact)| computed - exact).collect();
    let largest = errors.iter().fold(0.0_f64, |largest, error| largest.max(error.abs()));
    let weight = |index: usize| volumes[index] * elementary::powi(errors[index] / largest, 2);
    let total: f64 = (0..errors.len().min(volumes.len())).map(weight).sum();
    if !(total.is_finite() && total > 0.0) {
        return Vec::new();
    }
    let mut parts: Vec<Contribution> = (0..errors.len())
        .map(|index| Contribution { index, error: errors[index], share: weight(index) / total })
        .collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_that_is_off_comes_first_and_shares_sum_to_one() {
        let parts = contributions(&[1.0, 2.0, 3.5], &[1.1, 2.0, 3.0], &[1.0, 1.0, 2.0]);
        assert_eq!((parts[0].index, parts[0].error), (2, 0.5));
        assert!((parts[0].share - 0.5 / 0.51).abs() < 1e-12);
        assert!((parts.iter().map(|part| part.share).sum::<f64>() - 1.0).abs() < 1e-12);
        let tiny = contributions(&[1e-200, 0.0], &[0.0, 0.0], &[1.0, 1.0]);
        assert_eq!(tiny[0].share, 1.0);
    }

    #[test]
    fn no_error_and_no_number_have_no_place() {
        assert!(contributions(&[1.0], &[1.0], &[1.0]).is_empty());
        assert!(contributions(&[f64::NAN], &[1.0], &[1.0]).is_empty());
        assert!(contributions(&[], &[], &[]).is_empty());
    }
}
