//! Which places carry an error.

use oedometer_soil::elementary;

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

/// The largest part of all places, the first of several alike; none where the error vanishes or is no number.
pub fn largest_contribution(computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<Contribution> {
    // Scaled by the largest, so that the squares of tiny errors do not vanish.
    let errors = || computed.iter().zip(exact).map(|(computed, exact)| computed - exact);
    let largest = errors().fold(0.0_f64, |largest, error| largest.max(error.abs()));
    let weights =
        || errors().zip(volumes).map(|(error, volume)| volume * elementary::powi(error / largest, 2));
    let total: f64 = weights().sum();
    if !(total.is_finite() && total > 0.0) {
        return None;
    }
    let (index, weight) = weights()
        .enumerate()
        .reduce(|most, one| if one.1.total_cmp(&most.1).is_gt() { one } else { most })?;
    Some(Contribution { index, error: computed[index] - exact[index], share: weight / total })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_that_is_off_most_is_found_with_its_share() {
        let part =
            largest_contribution(&[1.0, 2.0, 3.5], &[1.1, 2.0, 3.0], &[1.0, 1.0, 2.0]).expect("an error");
        assert_eq!((part.index, part.error), (2, 0.5));
        assert!((part.share - 0.5 / 0.51).abs() < 1e-12);
        let tiny = largest_contribution(&[1e-200, 0.0], &[0.0, 0.0], &[1.0, 1.0]).expect("an error");
        assert_eq!(tiny.share, 1.0);
        let alike = largest_contribution(&[0.0, 1.0, 1.0], &[0.0; 3], &[1.0; 3]).expect("an error");
        assert_eq!((alike.index, alike.share), (1, 0.5));
    }

    #[test]
    fn no_error_and_no_number_have_no_place() {
        assert!(largest_contribution(&[1.0], &[1.0], &[1.0]).is_none());
        assert!(largest_contribution(&[f64::NAN], &[1.0], &[1.0]).is_none());
        assert!(largest_contribution(&[], &[], &[]).is_none());
    }
}
