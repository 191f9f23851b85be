//! Nodes that a file shows without cells: the length that each stands for, and how many cells they have.

use crate::import::samples::SampledState;

/// Places closer than this share of the extent are one.
pub const SAME_PLACE: f64 = 1e-6;
/// Gaps that differ by less than this share are even.
pub(crate) const EVEN: f64 = 1e-3;
/// Largest ratio of neighbouring gaps of a mesh that grows finer: others are places of some choice.
const GRADED: f64 = 4.0;
/// Fewest levels that have a spacing.
const FEWEST: usize = 3;

/// The different places along a direction, in rising order.
pub fn levels(places: &[f64], extent: f64) -> Vec<f64> {
    let mut levels = places.to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|later, earlier| *later - *earlier <= SAME_PLACE * extent);
    levels
}

/// Whether places reach both ends of a body, as nodes do.
fn reach_both_ends(levels: &[f64], extent: f64) -> bool {
    let is_near =
        |place: Option<&f64>, end: f64| place.is_some_and(|place| (place - end).abs() <= SAME_PLACE * extent);
    is_near(levels.first(), 0.0) && is_near(levels.last(), extent)
}

/// The length that each level of a graded mesh stands for; none where all stand for the same, or where they are no mesh.
fn lengths(levels: &[f64]) -> Option<Vec<f64>> {
    let gaps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let widest = gaps.iter().copied().fold(0.0, f64::max);
    let is_even = gaps.iter().all(|gap| *gap >= (1.0 - EVEN) * widest);
    let is_smooth = gaps.windows(2).all(|pair| (1.0 / GRADED..=GRADED).contains(&(pair[0] / pair[1])));
    if levels.len() < FEWEST || is_even || !is_smooth {
        return None;
    }
    let half = |gap: Option<&f64>| gap.map_or(0.0, |gap| 0.5 * gap);
    Some(
        (0..levels.len())
            .map(|at| half(at.checked_sub(1).and_then(|at| gaps.get(at))) + half(gaps.get(at)))
            .collect(),
    )
}

/// Gives the nodes of a graded mesh the weights of the lengths that they stand for, along `y` and, in a layer, along `x`; false
/// where they weigh alike. Samples inside the body are points or centres.
pub fn weigh(state: &mut SampledState, height: f64, length: Option<f64>) -> bool {
    let up = levels(&state.initial_height, height);
    let is_weighed = state.volume.windows(2).any(|pair| pair[0] != pair[1]);
    if is_weighed || !reach_both_ends(&up, height) {
        return false;
    }
    let along = length.map_or(Vec::new(), |length| levels(&state.initial_distance, length));
    let [of_heights, of_distances] = [&up, &along].map(|levels| lengths(levels));
    // In a layer each crossing of the lines has a node.
    let is_lattice = length.is_none() || up.len() * along.len() == state.initial_height.len();
    if (of_heights.is_none() && of_distances.is_none()) || !is_lattice {
        return false;
    }
    let level = |levels: &[f64], place: f64, extent: f64| {
        levels.partition_point(|level| *level <= place + SAME_PLACE * extent).saturating_sub(1)
    };
    let mut counts = vec![0_usize; up.len()];
    state.initial_height.iter().for_each(|place| counts[level(&up, *place, height)] += 1);
    for at in 0..state.volume.len() {
        let row = level(&up, state.initial_height[at], height);
        // Columns of nodes side by side share the length of their level.
        let side_by_side = if length.is_none() { counts[row] as f64 } else { 1.0 };
        let of_height = of_heights.as_ref().map_or(1.0, |lengths| lengths[row]) / side_by_side;
        let of_distance = of_distances
            .as_ref()
            .zip(length)
            .map_or(1.0, |(lengths, length)| lengths[level(&along, state.initial_distance[at], length)]);
        state.volume[at] *= of_height * of_distance;
    }
    true
}

/// What is wrong with a number of cells over the height, where nodes or centres show another one: nodes counted as cells, or
/// all cells of a mesh in the plane.
pub fn counted_otherwise(cells: usize, places: &[f64], height: f64) -> Option<String> {
    let levels = levels(places, height);
    let count = levels.len();
    if reach_both_ends(&levels, height) && count >= FEWEST {
        let own = count - 1;
        return if cells == count {
            Some(format!("{count} nodes lie between base and surface: this makes {own} cells, not {cells}"))
        } else if cells == own * own || cells == count * count {
            Some(format!(
                "{count} nodes lie between base and surface, which makes {own} cells over the height: is \
                 {cells} the number of all cells?"
            ))
        } else {
            None
        };
    }
    (count >= FEWEST && cells == count * count).then(|| {
        format!("samples lie at {count} heights: is {cells} the number of all cells, not of those over the height?")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(heights: &[f64], distances: &[f64]) -> SampledState {
        SampledState {
            initial_height: heights.to_vec(),
            initial_distance: distances.to_vec(),
            volume: vec![1.0; heights.len()],
            ..SampledState::default()
        }
    }

    #[test]
    fn nodes_of_a_graded_mesh_weigh_as_much_as_the_length_that_they_stand_for() {
        let weighed = |heights: &[f64], distances: &[f64], length: Option<f64>| {
            let mut state = state(heights, distances);
            weigh(&mut state, 4.0, length).then_some(state.volume)
        };
        assert_eq!(weighed(&[0.0, 2.0, 3.0, 4.0], &[], None), Some(vec![1.0, 1.5, 1.0, 0.5]));
        assert_eq!(weighed(&[4.0, 0.0, 3.0, 2.0], &[], None), Some(vec![0.5, 1.0, 1.0, 1.5]), "in any order");
        let twice = weighed(&[0.0, 0.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0], &[], None);
        assert_eq!(twice.map(|weights| weights[2]), Some(0.75), "two columns of nodes share a level");
        let lattice = weighed(&[0.0, 0.0, 0.0, 4.0, 4.0, 4.0], &[0.0, 1.0, 3.0, 0.0, 1.0, 3.0], Some(3.0));
        assert_eq!(lattice, Some(vec![0.5, 1.5, 1.0, 0.5, 1.5, 1.0]));
        for even in [
            &[0.0, 2.0, 4.0][..],
            &[0.0, 1.0, 2.0, 3.0, 4.0],
            &[0.5, 1.5, 3.0, 3.8],
            &[0.0, 0.1, 4.0],
            &[0.0, 4.0],
        ] {
            assert_eq!(weighed(even, &[], None), None, "{even:?}");
        }
    }

    #[test]
    fn a_number_of_nodes_is_none_of_cells() {
        let nodes = |cells: usize| (0..=cells).map(|at| 4.0 * at as f64 / cells as f64).collect::<Vec<f64>>();
        let centres: Vec<f64> = (0..5).map(|at| 0.4 + 0.8 * f64::from(at)).collect();
        for (cells, places, told) in [
            (10, nodes(10), None),
            (11, nodes(10), Some("this makes 10 cells, not 11")),
            (100, nodes(10), Some("is 100 the number of all cells?")),
            (121, nodes(10), Some("which makes 10 cells over the height")),
            (5, nodes(10), None),
            (20, nodes(10), None),
            (5, centres.clone(), None),
            (25, centres, Some("at 5 heights: is 25 the number of all cells")),
            (2, nodes(1), None),
        ] {
            let found = counted_otherwise(cells, &places, 4.0);
            assert!(
                found
                    .as_deref()
                    .map_or(told.is_none(), |found| told.is_some_and(|told| found.contains(told))),
                "{cells}: {found:?}"
            );
        }
    }
}
