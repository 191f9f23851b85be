//! Stretches of a column or layer without samples, and samples of its top.

use crate::import::SampledState;
use crate::import::nodes::{SAME_PLACE, levels};
use oedometer_exact::ColumnParameters;
use oedometer_wording::rounded;

/// A gap of more than this many times the spacing around it counts as bare.
const BARE: f64 = 1.5;
/// [`BARE`] for a gap at an end of the column: samples stand half a spacing from
/// it, or a whole one where the value at the end is prescribed.
const BARE_AT_END: f64 = 1.25;
/// Spacings closer than this, relative, are equal.
const SAME_SPACING: f64 = 0.02;
/// Share of the next spacing from which on a gap at an end is a whole spacing: cells shrink by less than a quarter from one to
/// the next, and points stand within half a spacing from an end.
const WHOLE_SPACING: f64 = 0.75;
/// Fewest gaps that have a spacing.
const FEWEST_GAPS: usize = 2;
/// Neighbours on either side of a gap that define the spacing around it.
const AROUND: usize = 4;
/// Samples that a band has on average where they have no order.
const PER_INTERVAL: usize = 8;

/// Difference over the final settlement from which on the top of a column is not plane.
const UNEVEN_TOP: f64 = 0.02;

/// A stretch without samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bare {
    /// Where it begins, in the unit of the places.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

/// The longest bare stretch between 0 and `extent`, if there is one: larger than 1.5 times the
/// spacing around it, so that a mesh that grows finer towards one end has none.
pub fn bare(lines: &[f64], extent: f64) -> Option<Bare> {
    let gaps: Vec<f64> = lines.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if gaps.is_empty() {
        return Some(Bare { from: 0.0, to: extent });
    }
    let stretches: Vec<Bare> = if has_order(&gaps) {
        between(lines, &gaps).chain(at_ends(lines, &gaps, extent)).collect()
    } else {
        // So many bands that several samples lie in each on average.
        empty_bands(lines, extent, (lines.len() / PER_INTERVAL).max(2))
    };
    longest(stretches)
}

/// An end of the height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Where places are 0.
    Bottom,
    /// Where places are the extent.
    Top,
    /// One end and the other.
    Both,
}

/// The end at which nodes lack their outermost row: the last place is a whole spacing away from it, and the other end has a
/// place. Points in cells and centres stand half a spacing away, or less, from both. Places that are declared to be nodes reach
/// both ends.
pub fn open_end(lines: &[f64], extent: f64, are_nodes: bool) -> Option<End> {
    let gaps: Vec<f64> = lines.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if gaps.len() < FEWEST_GAPS || bare(lines, extent).is_some() {
        return None;
    }
    let [first, last] = [lines[0], extent - lines[lines.len() - 1]];
    let is_reached = |gap: f64| gap.abs() <= SAME_PLACE * extent;
    if are_nodes {
        return match [first, last].map(is_reached) {
            [true, true] => None,
            [true, false] => Some(End::Top),
            [false, true] => Some(End::Bottom),
            [false, false] => Some(End::Both),
        };
    }
    // The gap at an end, with the two next to it: spacings that change slowly.
    let is_whole = |gap: f64, next: f64, after: f64| {
        gap >= WHOLE_SPACING * next && (1.0 / BARE..=BARE).contains(&(next / after))
    };
    let count = gaps.len();
    if is_reached(first) && is_whole(last, gaps[count - 1], gaps[count - 2]) {
        Some(End::Top)
    } else if is_reached(last) && is_whole(first, gaps[0], gaps[1]) {
        Some(End::Bottom)
    } else {
        None
    }
}

/// The longest of bare stretches.
pub(crate) fn longest(stretches: Vec<Bare>) -> Option<Bare> {
    stretches.into_iter().max_by(|a, b| (a.to - a.from).total_cmp(&(b.to - b.from)))
}

/// Whether the places have an order: neighbouring gaps are similar, or all are multiples of one, as
/// on a lattice with holes.
fn has_order(gaps: &[f64]) -> bool {
    let pairs = gaps.windows(2);
    let alike = |pair: &&[f64]| {
        let ratio = pair[0] / pair[1];
        // A growing mesh changes slowly; points in a cell repeat a pattern of few gaps.
        (1.0 / BARE..=BARE).contains(&ratio)
    };
    let smallest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let is_multiple = |gap: &f64| {
        let ratio = gap / smallest;
        (ratio - ratio.round()).abs() <= SAME_SPACING
    };
    gaps.len() < PER_INTERVAL
        || gaps.iter().all(is_multiple)
        || 5 * pairs.clone().filter(alike).count() >= 4 * pairs.count()
}

fn between<'a>(lines: &'a [f64], gaps: &'a [f64]) -> impl Iterator<Item = Bare> + 'a {
    (0..gaps.len())
        .filter(|&place| is_bare(gaps, place))
        .map(|place| Bare { from: lines[place], to: lines[place + 1] })
}

/// Whether a gap is larger than its neighbours and than most around it. In the pattern of the centres of triangles, at thirds
/// of each row of cells, a third of the gaps around, and a gap itself, are twice as large as their neighbours.
fn is_bare(gaps: &[f64], place: usize) -> bool {
    let next = place + 1..(place + 2).min(gaps.len());
    let neighbours = gaps[place.saturating_sub(1)..place].iter().chain(&gaps[next]);
    let largest = neighbours.copied().fold(0.0, f64::max);
    let before = place.saturating_sub(AROUND)..place;
    let after = place + 1..(place + 1 + AROUND).min(gaps.len());
    let mut around: Vec<f64> = gaps[before].iter().chain(&gaps[after]).copied().collect();
    around.sort_by(f64::total_cmp);
    let as_large = around.iter().filter(|gap| **gap >= (1.0 - SAME_SPACING) * gaps[place]).count();
    let is_third = 3 * (as_large + 1) > around.len() && gaps[place] <= (2.0 + SAME_SPACING) * largest;
    if is_third || 3 * as_large >= around.len() {
        return false;
    }
    let Some(median) = around.get(around.len() / 2) else { return false };
    gaps[place] > BARE * largest.max(*median)
}

fn at_ends<'a>(lines: &'a [f64], gaps: &'a [f64], extent: f64) -> impl Iterator<Item = Bare> + 'a {
    let near = |gaps: &[f64]| gaps.iter().copied().fold(0.0, f64::max);
    let count = gaps.len().min(AROUND - 1);
    let (first, last) = (lines[0], lines[lines.len() - 1]);
    let low = (first > BARE_AT_END * near(&gaps[..count])).then_some(Bare { from: 0.0, to: first });
    let high = (extent - last > BARE_AT_END * near(&gaps[gaps.len() - count..]))
        .then_some(Bare { from: last, to: extent });
    low.into_iter().chain(high)
}

/// Runs of empty bands among some of equal length over an extent.
pub(crate) fn empty_bands(places: &[f64], extent: f64, count: usize) -> Vec<Bare> {
    let length = extent / count as f64;
    let is_empty = |band: usize| {
        let ends = band as f64 * length..=(band + 1) as f64 * length;
        !places.iter().any(|place| ends.contains(place))
    };
    let mut stretches: Vec<Bare> = Vec::new();
    for band in (0..count).filter(|band| is_empty(*band)) {
        let (from, to) = (band as f64 * length, (band + 1) as f64 * length);
        match stretches.last_mut() {
            Some(before) if before.to == from => before.to = to,
            _ => stretches.push(Bare { from, to }),
        }
    }
    stretches
}

/// The numbers of samples and of crossings of their lines, where samples lie on few lines in both directions and some
/// crossings are empty without a reason in the mesh: nodes of elements with mid-side nodes, and a checkerboard, have
/// two kinds of rows.
pub fn incomplete_lattice(distances: &[f64], heights: &[f64], extent: [f64; 2]) -> Option<[usize; 2]> {
    let samples = heights.len();
    let across = levels(distances, extent[0]).len();
    let up = levels(heights, extent[1]);
    let crossings = across * up.len();
    if samples < 4 || samples >= crossings || 4 * samples < crossings {
        return None;
    }
    let mut counts = vec![0_usize; up.len()];
    for height in heights {
        let row = up.partition_point(|line| *line <= height + SAME_PLACE * extent[1]);
        if let Some(count) = counts.get_mut(row.saturating_sub(1)) {
            *count += 1;
        }
    }
    counts.sort_unstable();
    counts.dedup();
    // Rows of mid-side nodes, and those of a checkerboard, have half of the crossings.
    let has_reason = match counts.as_slice() {
        [_] => true,
        [fewer, _] => 2 * fewer <= across + 1,
        _ => false,
    };
    (!has_reason).then_some([samples, crossings])
}

/// A sentence about the top of a column that does not stay plane: samples of its highest row that settle differently.
pub fn uneven_top(parameters: &ColumnParameters, states: &[SampledState]) -> Option<String> {
    // Places that are repeated are of several states.
    let is_whole =
        |state: &&SampledState| state.repeated == 0 && state.displacement.len() == state.initial_height.len();
    let last = states.last().filter(is_whole)?;
    let highest = last.initial_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let is_top = |(y, _): &(&f64, &f64)| highest - **y <= SAME_PLACE * parameters.height;
    let top = || last.initial_height.iter().zip(&last.displacement).filter(is_top).map(|(_, up)| *up);
    let (least, most) = (top().reduce(f64::min)?, top().reduce(f64::max)?);
    let [y, from, to] = [highest, least, most].map(rounded);
    (most - least > UNEVEN_TOP * parameters.final_settlement().abs()).then(|| {
        format!(
            "your top is not plane: at y = {y} m u_y lies between {from} and {to} m: are the sides on rollers, and does the \
             load press evenly?"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Middles of cells, or points at shares of each cell.
    fn points(cells: usize, shares: &[f64]) -> Vec<f64> {
        let place = |cell: usize| shares.iter().map(move |share| (cell as f64 + share) / cells as f64);
        (0..cells).flat_map(place).collect()
    }

    #[test]
    fn centres_of_triangles_cover_their_cells_and_a_row_of_cells_that_is_missing_shows() {
        let thirds = [1.0 / 3.0, 2.0 / 3.0];
        for cells in [2, 3, 4, 8, 16] {
            assert_eq!(bare(&points(cells, &thirds), 1.0), None, "{cells} cells");
        }
        for cells in [8, 16] {
            for missing in [0, 1, cells / 2, cells - 1] {
                let mut places = points(cells, &thirds);
                places.drain(2 * missing..2 * missing + 2);
                assert!(bare(&places, 1.0).is_some(), "{missing} of {cells}");
            }
        }
    }

    /// Places without order, the same in every run.
    fn scattered(count: usize) -> Vec<f64> {
        let mut seed = 1_u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        levels(&(0..count).map(|_| next()).collect::<Vec<f64>>(), 1.0)
    }

    #[test]
    fn the_longest_stretch_is_found_wherever_it_stands() {
        let mut stretches = [(0.0, 0.1), (0.3, 0.6), (0.7, 0.9)].map(|(from, to)| Bare { from, to }).to_vec();
        for _ in 0..3 {
            assert_eq!(longest(stretches.clone()), Some(Bare { from: 0.3, to: 0.6 }));
            stretches.rotate_left(1);
        }
        assert_eq!(longest(Vec::new()), None);
    }

    #[test]
    fn what_codes_write_has_no_bare_stretch() {
        let nodes: Vec<f64> = (0..=20).map(|node| f64::from(node) / 20.0).collect();
        assert_eq!(bare(&nodes, 1.0), None, "nodes");
        assert_eq!(bare(&nodes[..20], 1.0), None, "without the surface, where p is known");
        let gauss = [
            vec![0.5],
            vec![0.211_325, 0.788_675],
            vec![0.112_702, 0.5, 0.887_298],
            vec![0.069_432, 0.330_009, 0.669_991, 0.930_568],
        ];
        for shares in &gauss {
            assert_eq!(bare(&points(10, shares), 1.0), None, "{shares:?}");
        }
        assert_eq!(bare(&points(2, &[0.5]), 1.0), None);
        for ratio in [1.1_f64, 1.3] {
            let gaps: Vec<f64> = (0..15).map(|cell| ratio.powi(cell)).collect();
            let total: f64 = gaps.iter().sum();
            let mut at = 0.0;
            let graded: Vec<f64> = std::iter::once(0.0)
                .chain(gaps.iter().map(|gap| {
                    at += gap / total;
                    at
                }))
                .collect();
            assert_eq!(bare(&graded, 1.0), None, "growing by {ratio}");
        }
        let jittered: Vec<f64> = points(20, &[0.25, 0.75])
            .iter()
            .zip(scattered(40).iter().cycle().step_by(7))
            .map(|(place, chance)| place + 0.01 * (chance - 0.5))
            .collect();
        assert_eq!(bare(&jittered, 1.0), None, "points that were moved by chance");
        assert_eq!(bare(&scattered(400), 1.0), None, "no order at all");
    }

    #[test]
    fn nodes_without_their_row_at_one_end_are_told_from_points_and_centres() {
        let nodes = |ratio: f64| {
            let gaps: Vec<f64> = (0..10).map(|cell| ratio.powi(cell)).collect();
            let total: f64 = gaps.iter().sum();
            let sums = gaps.iter().scan(0.0, |at, gap| {
                *at += gap / total;
                Some(*at)
            });
            [0.0].into_iter().chain(sums).collect::<Vec<f64>>()
        };
        for ratio in [0.8, 1.0, 1.25] {
            let all = nodes(ratio);
            assert_eq!(open_end(&all, 1.0, false), None, "{ratio}");
            assert_eq!(open_end(&all[..10], 1.0, false), Some(End::Top), "{ratio}");
            assert_eq!(open_end(&all[1..], 1.0, false), Some(End::Bottom), "{ratio}");
            assert_eq!(open_end(&all[1..10], 1.0, false), None, "places of some choice: {ratio}");
        }
        for shares in
            [&[0.5][..], &[0.25, 0.75], &[1.0 / 3.0, 2.0 / 3.0], &[0.211_325, 0.788_675], &[0.45, 0.95]]
        {
            assert_eq!(open_end(&points(10, shares), 1.0, false), None, "{shares:?}");
        }
        assert_eq!(open_end(&[0.0, 0.5], 1.0, true), None, "one gap has no spacing beside it");
    }

    #[test]
    fn a_lost_sample_and_a_lost_half_are_seen() {
        let all = points(20, &[0.25, 0.75]);
        for lost in [0, 1, 17, 39] {
            let without: Vec<f64> =
                all.iter().enumerate().filter(|(place, _)| *place != lost).map(|(_, at)| *at).collect();
            let found = bare(&without, 1.0);
            assert!(found.is_some_and(|bare| (bare.from..bare.to).contains(&all[lost])), "{lost}: {found:?}");
        }
        assert_eq!(bare(&all[2..], 1.0).map(|bare| bare.from), Some(0.0));
        let half = bare(&all[..20], 1.0).expect("the upper half is bare");
        assert!((half.from - 0.4875).abs() < 1e-12 && half.to == 1.0);
        let chance = scattered(400);
        let random: Vec<f64> = all
            .iter()
            .zip(&chance)
            .enumerate()
            .filter(|(place, _)| place % 5 != 1 && place % 7 != 2)
            .map(|(_, (at, _))| *at)
            .collect();
        assert!(bare(&random, 1.0).is_some());
        let upper: Vec<f64> = chance.iter().copied().filter(|place| *place > 0.5).collect();
        assert_eq!(bare(&upper, 1.0).map(|bare| bare.from), Some(0.0));
        assert!(bare(&[0.3], 1.0).is_some());
    }

    #[test]
    fn a_gap_at_an_end_is_held_against_the_spacing_at_that_end() {
        // Cells that shrink by a fifth each towards the surface, without the last four rows.
        let mut towards_surface = vec![0.0];
        let mut cell = 1.0;
        for _ in 0..13 {
            towards_surface.push(towards_surface[towards_surface.len() - 1] + cell);
            cell *= 0.8;
        }
        let extent = towards_surface[13];
        let cut = &towards_surface[..10];
        assert!(extent - cut[9] < towards_surface[1], "shorter than the spacing at the base");
        assert_eq!(bare(cut, extent), Some(Bare { from: cut[9], to: extent }));
        let towards_base: Vec<f64> = cut.iter().rev().map(|place| extent - place).collect();
        assert_eq!(bare(&towards_base, extent), Some(Bare { from: 0.0, to: towards_base[0] }));
    }

    #[test]
    fn a_lattice_with_holes_is_told_from_elements_with_mid_side_nodes() {
        let lattice = |keep: &dyn Fn(usize, usize) -> bool| {
            let places = (0..21).flat_map(|i| (0..21).map(move |j| (i, j))).filter(|(i, j)| keep(*i, *j));
            let (x, y): (Vec<f64>, Vec<f64>) =
                places.map(|(i, j)| (i as f64 / 20.0, j as f64 / 20.0)).unzip();
            incomplete_lattice(&x, &y, [1.0, 1.0])
        };
        assert_eq!(lattice(&|_, _| true), None);
        assert_eq!(lattice(&|i, j| i % 2 == 0 || j % 2 == 0), None, "eight nodes an element");
        assert_eq!(lattice(&|i, j| (i + j) % 2 == 0), None, "a checkerboard");
        let holes = lattice(&|i, j| (i, j) != (7, 9)).expect("one is missing");
        assert_eq!(holes, [440, 441]);
        assert!(lattice(&|i, j| (31 * i * i + 17 * j * j + 7 * i * j) % 13 > 6).is_some());
    }
}
