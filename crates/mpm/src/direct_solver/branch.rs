//! Parts of an elimination that know nothing of each other, and may be worked on side by side.

use crate::direct_solver::elimination::Elimination;
use std::ops::Range;

/// Halvings of the whole: four parts at most.
const HALVINGS: usize = 2;
/// Entries of the factors of a half below which a thread of its own costs more than it saves.
pub const SMALLEST_HALF: usize = 1 << 20;

/// A front with all that comes before it in the tree of fronts.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Its fronts but those of its halves: one where it has halves.
    pub fronts: Range<usize>,
    /// Places in the order of elimination that it eliminates, its halves' among them.
    pub places: Range<usize>,
    /// Entries of the factors of all its fronts.
    pub entries: Range<usize>,
    /// What comes before its one front, in two parts that are not tied to each other.
    pub halves: Option<Box<[Branch; 2]>>,
    /// The first place behind it that it is tied to.
    pub first_behind: usize,
    /// Values from that place to the last one that it is tied to: what it adds to a right-hand side there, or
    /// the solution.
    pub behind: Vec<f64>,
}

impl Branch {
    /// The whole of an elimination, whose fronts begin at `starts` among the entries of the factors. It is parted
    /// where both halves have so many of them, whoever is there to work on it.
    pub fn whole(elimination: &Elimination, starts: &[usize], smallest_half: usize) -> Self {
        match elimination.fronts.len().checked_sub(1) {
            Some(top) => Self::below(elimination, (starts, smallest_half), top, HALVINGS),
            None => Self {
                fronts: 0..0,
                places: 0..0,
                entries: 0..0,
                halves: None,
                first_behind: 0,
                behind: Vec::new(),
            },
        }
    }

    fn below(
        elimination: &Elimination,
        (starts, smallest_half): (&[usize], usize),
        top: usize,
        halvings: usize,
    ) -> Self {
        let fronts = &elimination.fronts;
        let first_of = |top: usize| {
            let mut first = top;
            while let Some(child) = fronts[first].children.first() {
                first = *child;
            }
            first
        };
        let entries_of = |top: usize| starts[first_of(top)]..starts[top] + fronts[top].factor_entries();
        let is_large = |child: &usize| entries_of(*child).len() >= smallest_half;
        let halves = match fronts[top].children[..] {
            [low, high] if halvings > 0 && [low, high].iter().all(is_large) => {
                let half = |top| Self::below(elimination, (starts, smallest_half), top, halvings - 1);
                Some(Box::new([low, high].map(half)))
            }
            _ => None,
        };
        let (shape, first) = (&fronts[top], first_of(top));
        let first_behind = shape.boundary.first().copied().unwrap_or(elimination.order.len());
        let last_behind = shape.boundary.last().map_or(first_behind, |last| last + 1);
        Self {
            fronts: if halves.is_some() { top..top + 1 } else { first..top + 1 },
            places: fronts[first].first..shape.first + shape.count,
            entries: entries_of(top),
            halves,
            first_behind,
            behind: vec![0.0; last_behind - first_behind],
        }
    }

    /// Its front that comes last.
    pub fn top(&self) -> Option<usize> {
        self.fronts.clone().next_back()
    }

    /// How many parts may be worked on side by side.
    pub fn parts(&self) -> usize {
        self.halves.as_ref().map_or(1, |halves| halves.iter().map(Self::parts).sum())
    }
}
