//! Numbers of neighbouring points side by side: what a loop without a branch works out for all of them at once.

use crate::soil::tensor::Vector;

/// Points whose numbers are worked out side by side: enough for a loop that the compiler turns into one over the lanes
/// of whatever registers there are.
pub const LANES: usize = 16;

/// One number of each of some points.
pub type Lanes = [f64; LANES];

/// One component of up to [`LANES`] vectors side by side; a place without a vector has a number in its stead.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn lanes_of<const D: usize>(vectors: &[Vector<D>], component: usize, instead: f64) -> Lanes {
    let mut lanes = [instead; LANES];
    for (lane, vector) in lanes.iter_mut().zip(vectors) {
        *lane = vector[component];
    }
    lanes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_take_one_component_and_fill_up() {
        let lanes = lanes_of(&[[1.0, 2.0], [3.0, 4.0]], 1, -1.0);
        assert_eq!(lanes[..3], [2.0, 4.0, -1.0]);
        assert_eq!(lanes_of(&[[5.0]; LANES + 3], 0, -1.0), [5.0; LANES]);
    }
}
