//! Whether the repeats of a run gave the same result.

use crate::import::table::SampledState;

/// Largest difference of two results, over the largest value of its field; infinite where they have not the same
/// places.
pub fn difference(first: &[SampledState], second: &[SampledState]) -> f64 {
    let same_places = first.len() == second.len()
        && first.iter().zip(second).all(|(a, b)| a.initial_height == b.initial_height);
    if !same_places {
        return f64::INFINITY;
    }
    let fields: [fn(&SampledState) -> &Vec<f64>; 4] = [
        |state| &state.pressure,
        |state| &state.effective_stress,
        |state| &state.displacement,
        |state| &state.horizontal_displacement,
    ];
    fields.into_iter().map(|field| difference_of_field(first, second, field)).fold(0.0, f64::max)
}

fn difference_of_field(
    first: &[SampledState],
    second: &[SampledState],
    field: fn(&SampledState) -> &Vec<f64>,
) -> f64 {
    let (a, b) = (first.iter().flat_map(field), second.iter().flat_map(field));
    let largest = a.clone().fold(0.0_f64, |most, value| most.max(value.abs()));
    let off = a.zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if off == 0.0 { 0.0 } else { off / largest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_relative_to_the_field_and_of_other_places_infinite() {
        let state = |pressure: f64| SampledState {
            initial_height: vec![0.0, 1.0],
            pressure: vec![4.0, pressure],
            displacement: vec![1e-9, 0.0],
            ..SampledState::default()
        };
        assert_eq!(difference(&[state(1.0)], &[state(1.0)]), 0.0);
        assert_eq!(difference(&[state(1.0)], &[state(1.5)]), 0.125);
        let elsewhere = SampledState { initial_height: vec![0.0, 0.5], ..state(1.0) };
        assert_eq!(difference(&[state(1.0)], &[elsewhere]), f64::INFINITY);
        assert_eq!(difference(&[state(1.0)], &[]), f64::INFINITY);
    }
}
