//! Numbers of neighbouring points side by side: what a loop without a branch works out for all of them at once.

use oedometer_soil::tensor::Vector;
use std::ops::Range;

/// Points whose numbers are worked out side by side: enough for a loop that the compiler turns into one over the lanes
/// of whatever registers there are.
pub const LANES: usize = 16;

/// Points that are taken from their nodes to their stresses side by side: all that they have of it stays in registers,
/// which it does for so many. What is left of them is taken one by one, by the same function.
pub const FOUR: usize = 4;

/// One number of each of some points.
pub type Lanes = [f64; LANES];

/// One component of up to [`LANES`] vectors side by side; a place without a vector has a number in its stead.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn lanes_of<const D: usize>(vectors: &[Vector<D>], component: usize, instead: f64) -> Lanes {
    let mut lanes = [instead; LANES];
    if let Some(whole) = vectors.first_chunk::<LANES>() {
        for lane in 0..LANES {
            lanes[lane] = whole[lane][component];
        }
        return lanes;
    }
    for (lane, vector) in lanes.iter_mut().zip(vectors) {
        *lane = vector[component];
    }
    lanes
}

/// So many points, block by block.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn blocks_of(points: usize) -> impl Iterator<Item = Range<usize>> {
    (0..points).step_by(LANES).map(move |start| start..points.min(start + LANES))
}

/// What some neighbouring points have of a field, and something in the stead of those that there are not: loops over
/// it have a length that is known, and nothing else that they write.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn block_of<T: Copy>(field: &[T], points: &Range<usize>, instead: T) -> [T; LANES] {
    let field = &field[points.clone()];
    if let Some(whole) = field.first_chunk() { *whole } else { part_of(field, instead) }
}

/// The same of fewer points; on its own, so that the copy of the others keeps its known length.
#[inline(never)]
fn part_of<T: Copy>(field: &[T], instead: T) -> [T; LANES] {
    let mut block = [instead; LANES];
    block[..field.len()].copy_from_slice(field);
    block
}

/// Puts what a block of points has into its places in a field.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn put_block<T: Copy>(field: &mut [T], points: &Range<usize>, block: &[T; LANES]) {
    let field = &mut field[points.clone()];
    if let Some(whole) = field.first_chunk_mut() {
        *whole = *block;
    } else {
        put_part(field, block);
    }
}

#[inline(never)]
fn put_part<T: Copy>(field: &mut [T], block: &[T; LANES]) {
    field.copy_from_slice(&block[..field.len()]);
}

/// `N` neighbours of a field from one on, all of which there are: their number is known to the loops over them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn some_of<T, const N: usize>(field: &[T], first: usize) -> &[T; N] {
    field[first..].first_chunk().expect("a field that holds them all")
}

/// The same, to be written.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn some_mut<T, const N: usize>(field: &mut [T], first: usize) -> &mut [T; N] {
    field[first..].first_chunk_mut().expect("a field that holds them all")
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

    #[test]
    fn a_block_is_taken_and_put_back_whole_and_in_part() {
        let field: Vec<f64> = (0..LANES + 3).map(|i| i as f64).collect();
        for points in [0..LANES, LANES..LANES + 3, 2..3] {
            let mut block = block_of(&field, &points, -1.0);
            assert_eq!(block[..points.len()], field[points.clone()]);
            assert!(block[points.len()..].iter().all(|instead| *instead == -1.0));
            block = block.map(|number| number + 100.0);
            let mut moved = field.clone();
            put_block(&mut moved, &points, &block);
            for (point, number) in moved.iter().enumerate() {
                let expected = point as f64 + if points.contains(&point) { 100.0 } else { 0.0 };
                assert_eq!(*number, expected);
            }
        }
    }
}
