//! Curves cut at the frame.
use crate::render::chart::canvas::Px;

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PixelFrame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl PixelFrame {
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub fn holds(&self, (x, y): Px) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }

    pub fn meets(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// The same frame, `by` wider on every side.
    pub fn grown(&self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    /// The nearest place inside.
    pub fn nearest(&self, (x, y): Px) -> Px {
        (x.clamp(self.left, self.right), y.clamp(self.top, self.bottom))
    }
}

/// The pieces of a curve inside the frame. A missing point breaks the curve.
pub(crate) fn pieces(points: &[Option<Px>], frame: &PixelFrame) -> Vec<Vec<Px>> {
    let mut out: Vec<Vec<Px>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let (Some(a), Some(b)) = (pair[0], pair[1]) else {
            open = false;
            continue;
        };
        let Some((a, b, reaches_end)) = segment(a, b, frame) else {
            open = false;
            continue;
        };
        match out.last_mut() {
            Some(piece) if open => piece.push(b),
            _ => out.push(vec![a, b]),
        }
        open = reaches_end;
    }
    out
}

/// The part of a segment inside the frame, and whether it reaches its own end (Liang and Barsky).
fn segment(a: Px, b: Px, frame: &PixelFrame) -> Option<(Px, Px, bool)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let sides =
        [(-dx, a.0 - frame.left), (dx, frame.right - a.0), (-dy, a.1 - frame.top), (dy, frame.bottom - a.1)];
    for (outwards, distance) in sides {
        if outwards == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if outwards < 0.0 {
            enter = enter.max(distance / outwards);
        } else {
            leave = leave.min(distance / outwards);
        }
    }
    // Round-off grows with the distance of the far end; the frame holds whatever comes of it.
    let at = |t: f64| frame.nearest((a.0 + t * dx, a.1 + t * dy));
    (enter <= leave).then(|| {
        let end = if leave >= 1.0 { b } else { at(leave) };
        (if enter <= 0.0 { a } else { at(enter) }, end, leave >= 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: PixelFrame = PixelFrame { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn a_curve_that_leaves_and_returns_is_in_two_pieces() {
        let curve =
            [Some((5.0, 5.0)), Some((5.0, 15.0)), Some((8.0, 15.0)), Some((8.0, 5.0)), Some((9.0, 5.0))];
        assert_eq!(
            pieces(&curve, &FRAME),
            vec![vec![(5.0, 5.0), (5.0, 10.0)], vec![(8.0, 10.0), (8.0, 5.0), (9.0, 5.0)]]
        );
    }

    #[test]
    fn a_missing_point_breaks_the_curve() {
        let curve = [Some((1.0, 1.0)), Some((2.0, 2.0)), None, Some((3.0, 3.0)), Some((4.0, 4.0))];
        assert_eq!(pieces(&curve, &FRAME).len(), 2);
        assert!(pieces(&[Some((1.0, 1.0)), None], &FRAME).is_empty());
    }

    #[test]
    fn what_is_far_outside_stays_outside() {
        for far in [16.0, 1e9, 1e150] {
            let curve = [Some((-far, 5.0)), Some((far, 5.0))];
            let pieces = pieces(&curve, &FRAME);
            assert!(pieces.iter().flatten().all(|&p| FRAME.holds(p)), "{pieces:?}");
        }
        let curve = [Some((-16.0, 5.0)), Some((16.0, 5.0))];
        assert_eq!(pieces(&curve, &FRAME), vec![vec![(0.0, 5.0), (10.0, 5.0)]]);
        assert!(pieces(&[Some((20.0, 20.0)), Some((30.0, 25.0))], &FRAME).is_empty());
    }
}
