//! Finds room for words and triangles among the data.
use super::canvas::Px;
use super::clip::Frame;
use crate::elementary;

/// What is in the way, and how much it matters.
#[derive(Debug, Default)]
pub(super) struct Space {
    frame: Option<Frame>,
    obstacles: Vec<(Frame, f64, usize)>,
}

/// A box that would do, and what speaks against it from the start.
#[derive(Debug, Clone, Copy)]
pub(super) struct Offer {
    pub room: Frame,
    pub penalty: f64,
}

impl Space {
    pub fn within(frame: Frame) -> Self {
        Self { frame: Some(frame), obstacles: Vec::new() }
    }

    /// A marker of the series `owner`.
    pub fn add_marker(&mut self, at: Px, owner: usize) {
        self.obstacles.push((around(at, 6.0, 6.0), 3.0, owner));
    }

    /// The curve of the series `owner`, as a trail of small boxes.
    pub fn add_line(&mut self, piece: &[Px], owner: usize) {
        for at in trail(piece, 4.0) {
            self.obstacles.push((around(at, 1.5, 1.5), 1.0, owner));
        }
    }

    /// Something that nothing else may touch.
    pub fn take(&mut self, room: Frame) {
        self.obstacles.push((room, 60.0, usize::MAX));
    }

    /// The offer with the least in its way; the first of equals. The line of `owner` is no
    /// obstacle to its own words. Offers that leave the frame count only if there is no other.
    pub fn best(&self, offers: &[Offer], owner: Option<usize>) -> Option<usize> {
        let cost = |offer: &Offer| {
            let outside = self.frame.is_some_and(|f| {
                let corners = [(offer.room.left, offer.room.top), (offer.room.right, offer.room.bottom)];
                !corners.iter().all(|&c| f.holds(c))
            });
            let met: f64 = self
                .obstacles
                .iter()
                .filter(|(room, weight, o)| !(owner == Some(*o) && *weight < 2.0) && room.meets(&offer.room))
                .map(|(_, weight, _)| weight)
                .sum();
            met + offer.penalty + if outside { 1e4 } else { 0.0 }
        };
        let costs: Vec<f64> = offers.iter().map(cost).collect();
        (0..offers.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b]))
    }
}

/// Half a width and half a height around a place.
pub(super) fn around(at: Px, half_width: f64, half_height: f64) -> Frame {
    Frame {
        left: at.0 - half_width,
        right: at.0 + half_width,
        top: at.1 - half_height,
        bottom: at.1 + half_height,
    }
}

/// Places along a curve, about `step` apart, its first and last point included.
pub(super) fn trail(piece: &[Px], step: f64) -> Vec<Px> {
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
        let mut space = Space::within(Frame { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 });
        space.add_line(&[(0.0, 50.0), (100.0, 50.0)], 0);
        let offer = |x, y| Offer { room: around((x, y), 10.0, 5.0), penalty: 0.0 };
        let offers = [offer(50.0, 50.0), offer(50.0, 20.0), offer(99.0, 20.0)];
        assert_eq!(space.best(&offers, None), Some(1));
        assert_eq!(space.best(&offers, Some(0)), Some(0));
        let others = [offers[1], offer(20.0, 80.0)];
        assert_eq!(space.best(&others, None), Some(0));
        space.take(offers[1].room);
        assert_eq!(space.best(&others, None), Some(1));
        assert_eq!(space.best(&[], None), None);
    }

    #[test]
    fn a_trail_has_no_gaps() {
        let places = trail(&[(0.0, 0.0), (30.0, 40.0)], 4.0);
        assert_eq!(places.len(), 14);
        assert_eq!(places.last(), Some(&(30.0, 40.0)));
    }
}
