//! Zeros where none can be: what programs write at nodes that have no pressure.

use crate::import::table::SampledState;
use crate::judge::score::completeness::{Finding, Lack};
use oedometer_exact::parameters::ColumnParameters;
use oedometer_soil::wording::short;

/// Share of the height within which a sample lies on the surface or the base.
const RIM: f64 = 1e-6;

/// Whether a state has pressures of exactly 0 inside the body beside others; the first such state.
pub fn interior_zeros(parameters: &ColumnParameters, states: &[SampledState]) -> Option<Finding> {
    states.iter().find_map(|state| {
        let inside = |place: &usize| {
            let ratio = state.initial_height[*place] / parameters.height;
            ratio > RIM && ratio < 1.0 - RIM
        };
        let all: Vec<usize> = (0..state.pressure.len()).filter(inside).collect();
        let zeros = all.iter().filter(|place| state.pressure[**place] == 0.0).count();
        (zeros > 0 && zeros < all.len()).then(|| Finding {
            name: Lack::ZerosInside,
            sentence: format!(
                "at T_v = {}, {zeros} of {} pressures inside are exactly 0 and the others are not: programs write 0 at \
                 the middle of sides; keep the corners of the cells ([rows] corners = true in the mapping) or take an \
                 interpolated array",
                short(parameters.time_factor(state.time)),
                all.len()
            ),
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_at_the_middle_of_sides_are_told_and_those_of_the_surface_are_not() {
        let column = ColumnParameters::default();
        let heights: Vec<f64> = (0..=4).map(|node| f64::from(node) / 4.0).collect();
        let state = |pressure: [f64; 5]| SampledState {
            time: column.time(0.1),
            initial_height: heights.clone(),
            pressure: pressure.to_vec(),
            ..SampledState::default()
        };
        let found = interior_zeros(&column, &[state([1.0, 0.0, 0.8, 0.0, 0.0])]).expect("a finding");
        assert!(found.sentence.contains("2 of 3"), "{}", found.sentence);
        assert_eq!(interior_zeros(&column, &[state([1.0, 0.9, 0.8, 0.4, 0.0])]), None);
        assert_eq!(interior_zeros(&column, &[state([0.0; 5])]), None, "nothing but zeros is another mistake");
    }
}
