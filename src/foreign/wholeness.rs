//! Checks that a result is complete: a state at every output, samples over the whole height, and equal results of
//! repeated runs.

use crate::case::Case;
use crate::import::SampledState;
use oedometer_soil::wording::{short, typed};

/// How far, relative, a state may lie from the output that it stands for.
const SAME_TIME: f64 = 1e-3;
/// Distance between neighbouring samples, over the cell size, from which on a cell between them has none.
const GAP: f64 = 1.5;
/// Distance of the last samples from base and surface, over the cell size, from which on the last cell has none.
const END: f64 = 0.75;
/// Share of a distance that round-off may add.
const ROUND_OFF: f64 = 1e-6;
/// Most outputs that a message names.
const MOST_TIMES: usize = 6;

/// The states at the outputs of a case, one an output.
///
/// # Errors
/// What is missing, a sentence.
pub fn states_at_outputs(case: &Case, states: &[SampledState]) -> Result<Vec<SampledState>, String> {
    let unit = case.seconds_per_time_factor();
    let nearest = |factor: f64| {
        let off = |state: &&SampledState| (state.time / unit - factor).abs();
        let near = states.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        near.filter(|state| off(state) <= SAME_TIME * factor)
    };
    let found: Vec<Option<&SampledState>> = case.time_factors.iter().map(|factor| nearest(*factor)).collect();
    let missing: Vec<f64> = (case.time_factors.iter().zip(&found))
        .filter_map(|(factor, state)| state.is_none().then_some(*factor))
        .collect();
    if !missing.is_empty() {
        let listed = |factors: &mut dyn Iterator<Item = f64>| {
            factors.take(MOST_TIMES).map(short).collect::<Vec<_>>().join(", ")
        };
        let there = if states.is_empty() {
            "it has none".to_owned()
        } else {
            format!("it has {}", listed(&mut states.iter().map(|state| state.time / unit)))
        };
        return Err(format!(
            "there is no state at T_v = {} (within {SAME_TIME} of it); {there}",
            listed(&mut missing.into_iter())
        ));
    }
    let states: Vec<SampledState> = found.into_iter().flatten().cloned().collect();
    match case.time_factors.iter().zip(&states).find_map(|(factor, state)| lack(case, *factor, state)) {
        Some(lack) => Err(lack),
        None => same_counts(case, &states).map_or(Ok(states), Err),
    }
}

/// What the samples of a state leave bare.
fn lack(case: &Case, time_factor: f64, state: &SampledState) -> Option<String> {
    let when = format!("at T_v = {}", typed(time_factor));
    if state.repeated > 0 {
        return Some(format!("{when}, {} samples stand twice", state.repeated));
    }
    if state.initial_height.is_empty() {
        return Some(format!("{when}, there is no sample"));
    }
    let column = &case.column;
    let size = case.cell_size();
    // A top cell that is partly filled has its surface where the case puts it.
    let is_held = column.points.is_regular();
    let stretch = bare(&state.initial_height, column.height, size, is_held);
    let of_height = stretch.map(|stretch| ("heights", stretch));
    let is_plane = case.scene.has_plane_fields();
    let along = || bare(&state.initial_distance, column.extent(), size, true);
    let of_length = || along().filter(|_| is_plane).map(|stretch| ("distances", stretch));
    let (places, [from, to]) = of_height.or_else(of_length)?;
    Some(format!(
        "{when}, no sample lies between the {places} {} m and {} m, with cells of {} m",
        short(from),
        short(to),
        short(size)
    ))
}

/// The first stretch between 0 and `extent` in which a cell of a size has no sample; the end counts where it is held.
fn bare(places: &[f64], extent: f64, size: f64, is_end_held: bool) -> Option<[f64; 2]> {
    let mut places = places.to_vec();
    places.sort_by(f64::total_cmp);
    let (lowest, highest) = (*places.first()?, *places.last()?);
    let beyond = |distance: f64, share: f64| distance > share * size * (1.0 + ROUND_OFF);
    if beyond(lowest, END) {
        return Some([0.0, lowest]);
    }
    if is_end_held && beyond(extent - highest, END) {
        return Some([highest, extent]);
    }
    places.windows(2).find(|pair| beyond(pair[1] - pair[0], GAP)).map(|pair| [pair[0], pair[1]])
}

/// What to say of states with different numbers of samples.
fn same_counts(case: &Case, states: &[SampledState]) -> Option<String> {
    let first = states.first()?;
    let differs = |state: &SampledState| state.initial_height.len() != first.initial_height.len();
    let place = states.iter().position(differs)?;
    Some(format!(
        "there are {} samples at T_v = {}, and {} at {}",
        states[place].initial_height.len(),
        typed(case.time_factors[place]),
        first.initial_height.len(),
        typed(case.time_factors[0])
    ))
}

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
    use crate::case::Task;
    use oedometer_mpm::scene::SceneKind;

    fn case() -> Case {
        Case {
            cells: 10,
            time_factors: vec![0.05, 0.1].into(),
            ..Case::seed(Task::Solve, SceneKind::Terzaghi)
        }
    }

    /// States at the outputs with samples at heights.
    fn states(heights: &[f64]) -> Vec<SampledState> {
        let state = |factor: f64| SampledState {
            time: factor * case().seconds_per_time_factor(),
            initial_height: heights.to_vec(),
            ..SampledState::default()
        };
        vec![state(0.05), state(0.1)]
    }

    fn lattice(count: usize, first: f64, spacing: f64) -> Vec<f64> {
        (0..count).map(|place| first + spacing * place as f64).collect()
    }

    fn said(states: &[SampledState]) -> String {
        states_at_outputs(&case(), states).expect_err("something is missing")
    }

    #[test]
    fn nodes_centres_and_points_are_whole() {
        for heights in [lattice(11, 0.0, 0.1), lattice(10, 0.05, 0.1), lattice(20, 0.025, 0.05)] {
            assert!(states_at_outputs(&case(), &states(&heights)).is_ok(), "{heights:?}");
        }
    }

    #[test]
    fn a_missing_half_every_other_row_and_a_hole_are_told_with_their_heights() {
        let nodes = lattice(11, 0.0, 0.1);
        let told = said(&states(&nodes[..6]));
        assert!(told.contains("between the heights 0.5 m and 1 m"), "{told}");
        assert!(said(&states(&nodes[5..])).contains("between the heights 0 m and 0.5 m"));
        let every_other: Vec<f64> = nodes.iter().copied().step_by(2).collect();
        assert!(said(&states(&every_other)).contains("between the heights 0 m and 0.2 m"));
        assert!(said(&states(&[])).contains("no sample"));
    }

    #[test]
    fn a_stretch_of_a_layers_length_that_is_missing_is_told_with_its_distances() {
        let case = Case {
            cells: 10,
            time_factors: vec![0.05, 0.1].into(),
            ..Case::seed(Task::Solve, SceneKind::CosineLayer)
        };
        let nodes = lattice(11, 0.0, 0.1);
        let of = |distances: &[f64]| {
            let places = distances.iter().flat_map(|x| nodes.iter().map(move |y| (*x, *y)));
            let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
            let state = |factor: f64| SampledState {
                time: factor * case.seconds_per_time_factor(),
                initial_distance: x.clone(),
                initial_height: y.clone(),
                ..SampledState::default()
            };
            states_at_outputs(&case, &[state(0.05), state(0.1)])
        };
        assert!(of(&nodes).is_ok());
        let told = of(&nodes[..2]).expect_err("nine tenths are missing");
        assert!(told.contains("between the distances 0.1 m and 1 m"), "{told}");
        assert!(of(&[&nodes[..4], &nodes[6..]].concat()).is_err_and(|told| told.contains("0.3 m and 0.6 m")));
    }

    #[test]
    fn missing_times_and_uneven_ones_are_told() {
        let mut all = states(&lattice(11, 0.0, 0.1));
        let late = all.remove(1);
        let told = said(&all);
        assert!(told.contains("no state at T_v = 0.1") && told.contains("it has 0.05"), "{told}");
        let near = SampledState { time: late.time * 1.0009, ..late.clone() };
        assert!(states_at_outputs(&case(), &[all[0].clone(), near]).is_ok());
        let far = SampledState { time: late.time * 1.0011, ..late.clone() };
        assert!(states_at_outputs(&case(), &[all[0].clone(), far]).is_err());
        let more = SampledState { initial_height: lattice(21, 0.0, 0.05), ..late.clone() };
        assert_eq!(said(&[all[0].clone(), more]), "there are 21 samples at T_v = 0.1, and 11 at 0.05");
        let twice = SampledState { repeated: 3, ..late };
        assert!(said(&[all[0].clone(), twice]).contains("3 samples stand twice"));
    }

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
