//! Where a ladder of runs reaches a tolerance: one rule for every recommendation.

/// The run that reaches a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reached {
    /// The coarsest run from which on every finer one is within the tolerance.
    pub place: usize,
    /// Whether a finer run confirms it.
    pub confirmed: bool,
}

/// Where runs from coarse to fine, or from long to short steps, reach a tolerance; `None` where the finest is not within it.
/// A run is within where it ended well, all its checks pass and every error that is asked is a number of at most the
/// tolerance.
pub fn reached(is_within: &[bool]) -> Option<Reached> {
    let place = (0..is_within.len()).rev().take_while(|place| is_within[*place]).last()?;
    Some(Reached { place, confirmed: place + 1 < is_within.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_finer_run_undoes_was_not_reached_and_the_finest_alone_is_not_confirmed() {
        let told = |within: &[bool]| reached(within).map(|one| (one.place, one.confirmed));
        assert_eq!(told(&[false, true, true]), Some((1, true)));
        assert_eq!(told(&[true, false, true]), Some((2, false)));
        assert_eq!((told(&[true, true, false]), told(&[])), (None, None));
    }
}
