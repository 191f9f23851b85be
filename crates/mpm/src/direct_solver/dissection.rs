//! The order of elimination of a sparse matrix: nested dissection of the places of its unknowns (George 1973).
//!
//! A set is cut across its longest direction, and those of the lower half that touch the upper half are its separator,
//! eliminated after both halves. So a matrix of the plane fills in as `N log N`, and its factors cost `N^1.5`.

use crate::direct_solver::sparse_matrix::SparseMatrix;

/// Unknowns of a set that is cut no further: smaller fronts fill in less, but each costs some calls and copies.
const SMALLEST_SET: usize = 48;
/// Share of a set below which no cut begins and beyond which none ends.
const MIDDLE: [usize; 2] = [2, 3];
/// Parts of the whole that the shares are counted in.
const PARTS: usize = 5;

/// Unknowns that are eliminated together, after those of the parts below: the separator of a set, or a set that was not
/// cut.
#[derive(Debug)]
pub(crate) struct Part {
    /// Both halves of the set, without the separator; none where it was not cut.
    pub halves: Option<Box<[Part; 2]>>,
    /// Place of its first unknown in the order of elimination.
    pub first: usize,
    /// Number of its unknowns.
    pub count: usize,
}

/// The order of elimination of all unknowns, and its parts.
pub(crate) fn dissected(matrix: &SparseMatrix) -> (Vec<usize>, Part) {
    let count = matrix.positions().len();
    let mut dissection =
        Dissection { matrix, is_within: vec![false; count], order: Vec::with_capacity(count) };
    let root = dissection.ordered((0..count).collect());
    (dissection.order, root)
}

struct Dissection<'a> {
    matrix: &'a SparseMatrix,
    /// Which unknowns belong to the set that is being cut; false between the cuts.
    is_within: Vec<bool>,
    /// Unknown at each place so far.
    order: Vec<usize>,
}

impl Dissection<'_> {
    /// Orders the unknowns of a set, half by half and the separator last.
    fn ordered(&mut self, set: Vec<usize>) -> Part {
        let (mut rest, mut halves) = (set, None);
        if rest.len() > SMALLEST_SET
            && let Some(Halves { low, high, separator }) = self.cut(&rest)
        {
            halves = Some(Box::new([low, high].map(|half| self.ordered(half))));
            rest = separator;
        }
        let (first, count) = (self.order.len(), rest.len());
        self.order.extend(rest);
        Part { halves, first, count }
    }

    /// Cuts a set where its separator is smallest, not far from the middle; `None` where all of the lower half would be
    /// separator.
    fn cut(&mut self, set: &[usize]) -> Option<Halves> {
        let positions = self.matrix.positions();
        let direction = longest_direction(set, positions);
        let place = |unknown: usize| positions[unknown][direction];
        for unknown in set {
            self.is_within[*unknown] = true;
        }
        let reach = |unknown: &usize| {
            let mut furthest = f64::NEG_INFINITY;
            for other in self.matrix.row(*unknown).1 {
                let other = *other as usize;
                if self.is_within[other] && place(other) > furthest {
                    furthest = place(other);
                }
            }
            furthest
        };
        let reaches: Vec<f64> = set.iter().map(reach).collect();
        for unknown in set {
            self.is_within[*unknown] = false;
        }
        let level = best_level(set.iter().map(|unknown| place(*unknown)).collect(), reaches.clone())?;
        let mut halves = Halves { low: Vec::new(), high: Vec::new(), separator: Vec::new() };
        for (unknown, reach) in set.iter().zip(reaches) {
            let part = match place(*unknown) < level {
                true if reach < level => &mut halves.low,
                true => &mut halves.separator,
                false => &mut halves.high,
            };
            part.push(*unknown);
        }
        Some(halves)
    }
}

/// A set that was cut.
struct Halves {
    low: Vec<usize>,
    high: Vec<usize>,
    separator: Vec<usize>,
}

/// Place of the cut that the fewest unknowns reach across from below, and of several the most even, by the place of each
/// unknown and the furthest that it reaches; `None` where none leaves any below.
fn best_level(mut places: Vec<f64>, mut reaches: Vec<f64>) -> Option<f64> {
    places.sort_unstable_by(f64::total_cmp);
    reaches.sort_unstable_by(f64::total_cmp);
    let count = places.len();
    let [first, last] = MIDDLE.map(|share| count * share / PARTS);
    let mut levels = places[first..=last].to_vec();
    levels.dedup();
    let halves = levels.into_iter().map(|level| {
        let below = |of_each: &[f64]| of_each.partition_point(|value| *value < level);
        (below(&reaches), below(&places), level)
    });
    let separator = |(low, below, _): &(usize, usize, f64)| (below - low, (count - below).abs_diff(*low));
    halves.filter(|(low, ..)| *low > 0).min_by_key(separator).map(|(.., level)| level)
}

/// Direction in which a set extends furthest.
fn longest_direction(set: &[usize], positions: &[[f64; 3]]) -> usize {
    let extent = |direction: usize| {
        let places = set.iter().map(|unknown| positions[*unknown][direction]);
        let (low, high) = places
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| (low.min(place), high.max(place)));
        high - low
    };
    (0..3).max_by(|a, b| extent(*a).total_cmp(&extent(*b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unknowns at places on a line, each tied to those within reach.
    fn line(places: &[f64], reach: f64) -> SparseMatrix {
        let positions: Vec<[f64; 1]> = places.iter().map(|place| [*place]).collect();
        SparseMatrix::spanning(&positions, |visitor| {
            for (a, place) in places.iter().enumerate() {
                let tied = places.iter().enumerate().filter(|(_, other)| (*other - place).abs() <= reach);
                tied.for_each(|(b, _)| visitor(a, b));
            }
        })
    }

    #[test]
    fn halves_are_apart_and_every_unknown_is_eliminated_once() {
        let side = 24_u32;
        let positions: Vec<[f64; 2]> =
            (0..side * side).map(|unknown| [f64::from(unknown % side), f64::from(unknown / side)]).collect();
        let near = |a: usize, b: usize| (0..2).all(|d| (positions[a][d] - positions[b][d]).abs() <= 2.0);
        let count = positions.len();
        let matrix = SparseMatrix::spanning(&positions, |visitor| {
            (0..count).for_each(|a| (0..count).filter(|b| near(a, *b)).for_each(|b| visitor(a, b)));
        });
        let (order, root) = dissected(&matrix);
        let mut eliminated = order.clone();
        eliminated.sort_unstable();
        assert_eq!(eliminated, (0..count).collect::<Vec<_>>());
        let Some([low, high]) = root.halves.as_deref() else { panic!("two halves") };
        let places = |part: &Part, from: usize| order[from..part.first + part.count].to_vec();
        let (low_unknowns, high_unknowns) = (places(low, 0), places(high, low.first + low.count));
        for unknown in low_unknowns {
            let (_, tied) = matrix.row(unknown);
            assert!(!tied.iter().any(|other| high_unknowns.contains(&(*other as usize))));
        }
        assert_eq!(root.count, 2 * side as usize, "two rows of the square separate its halves");
    }

    #[test]
    fn a_cut_is_where_the_fewest_reach_across_it() {
        // Two at each place but three, of which a cut in the middle would meet more: 4, where the least is 3.
        let mut places: Vec<f64> = (0..40).map(|unknown| f64::from(unknown / 2)).collect();
        places.remove(17);
        let matrix = line(&places, 2.0);
        let mut dissection =
            Dissection { matrix: &matrix, is_within: vec![false; places.len()], order: Vec::new() };
        let set: Vec<usize> = (0..places.len()).collect();
        let halves = dissection.cut(&set).expect("two halves");
        assert_eq!(halves.separator.len(), 3);
        assert_eq!(halves.low.len() + halves.high.len() + 3, places.len());
        assert!(dissection.is_within.iter().all(|within| !within));
    }

    #[test]
    fn what_reaches_beyond_the_set_alone_is_no_separator() {
        // The lowest is tied to the one beside it, and to one far above that is not of the set.
        let positions: Vec<[f64; 1]> = (0..80).map(|unknown| [f64::from(unknown)]).collect();
        let matrix = SparseMatrix::spanning(&positions, |visitor| {
            for unknown in 0..79 {
                visitor(unknown, unknown + 1);
                visitor(unknown + 1, unknown);
            }
            visitor(0, 79);
            visitor(79, 0);
        });
        let mut dissection = Dissection { matrix: &matrix, is_within: vec![false; 80], order: Vec::new() };
        let halves = dissection.cut(&(0..60).collect::<Vec<_>>()).expect("two halves");
        assert_eq!((halves.separator.len(), halves.low[0]), (1, 0));
    }

    #[test]
    fn a_set_that_is_all_separator_is_not_cut() {
        let places: Vec<f64> = (0..60).map(f64::from).collect();
        let (order, root) = dissected(&line(&places, 60.0));
        assert_eq!((order.len(), root.count, root.halves.is_none()), (60, 60, true));
    }
}
