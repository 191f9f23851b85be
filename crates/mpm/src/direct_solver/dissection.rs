//! Nested dissection of unknowns by their places (George 1973).
//!
//! A set of unknowns is cut across its longest direction; those of the lower half that touch the upper half
//! are its separator and are eliminated after both. So a matrix of the plane fills in as `N log N`, and its
//! factors cost `N^1.5`, where a band costs `N^2`.

use crate::direct_solver::sparse_matrix::SparseMatrix;

/// Unknowns of a set that is cut no further: a front of some hundred rows is as fast as two of half of them.
const SMALLEST_SET: usize = 96;

/// Unknowns that are eliminated together, and the sets that are before them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Separator {
    /// The unknowns.
    pub unknowns: Vec<usize>,
    /// Numbers of the separators of its halves, all smaller than its own.
    pub children: Vec<usize>,
}

/// The unknowns of a matrix in separators, in the order of elimination.
pub fn dissect(matrix: &SparseMatrix) -> Vec<Separator> {
    let mut separators = Vec::new();
    let count = matrix.positions().len();
    cut((0..count).collect(), matrix, &mut vec![false; count], &mut separators);
    separators
}

/// Cuts a set and its parts; the number of its separator, where it has unknowns. `upper` is all false
/// between the cuts.
fn cut(
    mut set: Vec<usize>,
    matrix: &SparseMatrix,
    upper: &mut [bool],
    separators: &mut Vec<Separator>,
) -> Option<usize> {
    if set.is_empty() {
        return None;
    }
    let mut children = Vec::new();
    if set.len() > SMALLEST_SET {
        let direction = longest_direction(&set, matrix.positions());
        let place = |unknown: &usize| matrix.positions()[*unknown][direction];
        let mut places: Vec<f64> = set.iter().map(place).collect();
        let middle = places.len() / 2;
        let level = *places.select_nth_unstable_by(middle, f64::total_cmp).1;
        let (mut low, high): (Vec<usize>, Vec<usize>) =
            set.iter().partition(|unknown| place(unknown) < level);
        for unknown in &high {
            upper[*unknown] = true;
        }
        let (between, apart): (Vec<usize>, Vec<usize>) = low
            .iter()
            .partition(|unknown| matrix.row(**unknown).1.iter().any(|other| upper[*other as usize]));
        for unknown in &high {
            upper[*unknown] = false;
        }
        // A set that is all separator is not worth cutting.
        if !apart.is_empty() {
            low = apart;
            for half in [low, high] {
                children.extend(cut(half, matrix, upper, separators));
            }
            set = between;
        }
    }
    separators.push(Separator { unknowns: set, children });
    Some(separators.len() - 1)
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

    #[test]
    fn halves_are_apart_and_every_unknown_is_eliminated_once() {
        // A square of unknowns, each tied to those within two of it.
        let side = 24;
        let positions: Vec<[f64; 2]> =
            (0..side * side).map(|unknown| [(unknown % side) as f64, (unknown / side) as f64]).collect();
        let is_tied = |a: usize, b: usize| {
            let far = |d: usize| (positions[a][d] - positions[b][d]).abs();
            far(0) <= 2.0 && far(1) <= 2.0
        };
        let matrix = SparseMatrix::spanning(&positions, |visitor| {
            for a in 0..positions.len() {
                for b in (0..positions.len()).filter(|b| is_tied(a, *b)) {
                    visitor(a, b);
                }
            }
        });
        let separators = dissect(&matrix);
        let mut eliminated: Vec<usize> = separators.iter().flat_map(|s| s.unknowns.clone()).collect();
        eliminated.sort_unstable();
        assert_eq!(eliminated, (0..positions.len()).collect::<Vec<_>>());
        // All unknowns of a separator and of the parts below it.
        let below = |number: usize| {
            let (mut waiting, mut found) = (vec![number], Vec::new());
            while let Some(number) = waiting.pop() {
                found.extend(separators[number].unknowns.iter().copied());
                waiting.extend(&separators[number].children);
            }
            found
        };
        let last = separators.last().expect("there are unknowns");
        assert_eq!(last.children.len(), 2);
        let [low, high] = [0, 1].map(|child| below(last.children[child]));
        assert!(low.iter().all(|a| high.iter().all(|b| !is_tied(*a, *b))));
        assert_eq!(last.unknowns.len(), 2 * side, "two rows of the square part it");
    }
}
