//! Finds room for words and triangles among the data.
use crate::render::chart::canvas::Px;
use crate::render::chart::layout::clip::PixelFrame;
use oedometer_soil::elementary;
use std::collections::HashMap;

/// Width of a bin, px: about that of a word's height, so that a room covers some bins whole.
const BIN: f64 = 16.0;
/// Largest half-width of a marker or of a piece of a line, px: how far it reaches into other bins.
const REACH: f64 = 6.0;
/// Offers that are weighed: of more, every so manieth. A curve across a figure makes some hundreds.
const MOST_OFFERS: usize = 4000;

/// What is in the way, and how much it matters. Markers and lines lie in bins, so that a room is held
/// against what is near it alone.
#[derive(Debug, Default)]
pub(crate) struct Space {
    frame: Option<PixelFrame>,
    bins: HashMap<(i64, i64), Bin>,
    taken: Vec<PixelFrame>,
}

/// The obstacles whose middle lies in one bin.
#[derive(Debug, Default)]
struct Bin {
    weight: f64,
    obstacles: Vec<Obstacle>,
}

#[derive(Debug, Clone, Copy)]
struct Obstacle {
    room: PixelFrame,
    weight: f64,
}

/// A box that would do, and what speaks against it from the start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Offer {
    pub room: PixelFrame,
    pub penalty: f64,
}

impl Space {
    pub fn within(frame: PixelFrame) -> Self {
        Self { frame: Some(frame), ..Self::default() }
    }

    /// A marker.
    pub fn add_marker(&mut self, at: Px) {
        self.add(at, Obstacle { room: around(at, REACH, REACH), weight: 3.0 });
    }

    /// A curve, as a trail of small boxes.
    pub fn add_line(&mut self, piece: &[Px]) {
        for at in trail(piece, 4.0) {
            self.add(at, Obstacle { room: around(at, 1.5, 1.5), weight: 1.0 });
        }
    }

    fn add(&mut self, at: Px, obstacle: Obstacle) {
        let bin = self.bins.entry((bin_of(at.0), bin_of(at.1))).or_default();
        bin.weight += obstacle.weight;
        bin.obstacles.push(obstacle);
    }

    /// Something that nothing else may touch.
    pub fn take(&mut self, room: PixelFrame) {
        self.taken.push(room);
    }

    /// Whether a room meets nothing that is taken.
    pub fn is_free(&self, room: &PixelFrame) -> bool {
        !self.taken.iter().any(|taken| taken.meets(room))
    }

    /// The offer with the least in its way; the first of equals. Offers that leave the frame count only
    /// if there is no other.
    pub fn best(&self, offers: &[Offer]) -> Option<usize> {
        let cost = |offer: &Offer| {
            let outside = self.frame.is_some_and(|f| {
                let corners = [(offer.room.left, offer.room.top), (offer.room.right, offer.room.bottom)];
                !corners.iter().all(|&c| f.holds(c))
            });
            self.met(&offer.room) + offer.penalty + if outside { 1e4 } else { 0.0 }
        };
        let every = offers.len().div_ceil(MOST_OFFERS).max(1);
        let costs = offers.iter().enumerate().step_by(every).map(|(place, offer)| (place, cost(offer)));
        costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
    }

    /// Weight of all that a room meets.
    fn met(&self, room: &PixelFrame) -> f64 {
        let mut met = 60.0 * self.taken.iter().filter(|taken| taken.meets(room)).count() as f64;
        for x in bin_of(room.left - REACH)..=bin_of(room.right + REACH) {
            for y in bin_of(room.top - REACH)..=bin_of(room.bottom + REACH) {
                let Some(bin) = self.bins.get(&(x, y)) else { continue };
                met += if is_within(x, y, room) { bin.weight } else { bin.met(room) };
            }
        }
        met
    }
}

impl Bin {
    fn met(&self, room: &PixelFrame) -> f64 {
        self.obstacles.iter().filter(|one| one.room.meets(room)).map(|one| one.weight).sum()
    }
}

/// Number of the bin that a coordinate lies in.
#[expect(clippy::cast_possible_truncation, reason = "a figure has some thousand pixels")]
fn bin_of(coordinate: f64) -> i64 {
    (coordinate / BIN).floor() as i64
}

/// Whether every place of a bin lies in a room.
fn is_within(x: i64, y: i64, room: &PixelFrame) -> bool {
    let (left, top) = (x as f64 * BIN, y as f64 * BIN);
    left > room.left && left + BIN < room.right && top > room.top && top + BIN < room.bottom
}

/// Half a width and half a height around a place.
pub(crate) fn around(at: Px, half_width: f64, half_height: f64) -> PixelFrame {
    PixelFrame {
        left: at.0 - half_width,
        right: at.0 + half_width,
        top: at.1 - half_height,
        bottom: at.1 + half_height,
    }
}

/// Places along a curve, about `step` apart, its first and last point included.
pub(crate) fn trail(piece: &[Px], step: f64) -> Vec<Px> {
    let mut out: Vec<Px> = piece.first().copied().into_iter().collect();
    for pair in piece.windows(2) {
        let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
        let n = (elementary::hypot(dx, dy) / step).ceil().clamp(1.0, 2000.0);
        let mut i = 1.0;
        while i <= n {
            out.push((pair[0].0 + dx * i / n, pair[0].1 + dy * i / n));
            i += 1.0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_emptier_place_wins_and_the_frame_is_kept() {
        let mut space = Space::within(PixelFrame { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 });
        space.add_line(&[(0.0, 50.0), (100.0, 50.0)]);
        let offer = |x, y| Offer { room: around((x, y), 10.0, 5.0), penalty: 0.0 };
        let offers = [offer(50.0, 50.0), offer(50.0, 20.0), offer(99.0, 20.0)];
        assert_eq!(space.best(&offers), Some(1));
        let others = [offers[1], offer(20.0, 80.0)];
        assert_eq!(space.best(&others), Some(0));
        space.take(offers[1].room);
        assert_eq!(space.best(&others), Some(1));
        assert_eq!(space.best(&[]), None);
    }

    #[test]
    fn a_trail_has_no_gaps() {
        let places = trail(&[(0.0, 0.0), (30.0, 40.0)], 4.0);
        assert_eq!(places.len(), 14);
        assert_eq!(places.last(), Some(&(30.0, 40.0)));
    }

    /// What `best` promises, with every offer held against every obstacle.
    fn best_of_all_pairs(all: &[Obstacle], offers: &[Offer]) -> Option<usize> {
        let cost = |offer: &Offer| {
            let met = |one: &&Obstacle| one.room.meets(&offer.room);
            all.iter().filter(met).map(|one| one.weight).sum::<f64>() + offer.penalty
        };
        (0..offers.len()).min_by(|&a, &b| cost(&offers[a]).total_cmp(&cost(&offers[b])))
    }

    #[test]
    fn bins_find_the_same_place_as_all_pairs() {
        // Places without a pattern, in a figure of 700 by 400 pixels and a little beyond.
        let mut seed = 12_345_u32;
        let mut number = |most: f64| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24) * (most + 20.0) - 10.0
        };
        let mut space = Space::default();
        for _ in 0..6 {
            let curve: Vec<Px> = (0..8).map(|_| (number(700.0), number(400.0))).collect();
            space.add_line(&curve);
            for at in curve {
                space.add_marker(at);
            }
        }
        let all: Vec<Obstacle> = space.bins.values().flat_map(|bin| bin.obstacles.clone()).collect();
        for size in [(12.0, 6.0), (60.0, 7.0), (90.0, 70.0)] {
            let offers: Vec<Offer> = (0..200)
                .map(|_| around((number(700.0), number(400.0)), size.0, size.1))
                .map(|room| Offer { room, penalty: 0.001 * room.left.abs() })
                .collect();
            assert_eq!(space.best(&offers), best_of_all_pairs(&all, &offers), "{size:?}");
        }
    }

    #[test]
    fn of_very_many_offers_some_are_weighed_and_the_free_one_among_them_wins() {
        let mut space = Space::default();
        space.add_line(&[(0.0, 50.0), (600.0, 50.0)]);
        let offer = |y| Offer { room: around((300.0, y), 10.0, 5.0), penalty: 0.0 };
        let mut offers = vec![offer(50.0); 10 * MOST_OFFERS];
        offers[70] = offer(80.0);
        assert_eq!(space.best(&offers), Some(70));
    }
}
