//! The square of a dense matrix: what the spectral radius of a step operator is made of.

use crate::wide::wide;

/// Rows and columns of the blocks whose sums stay in registers.
const ROWS: usize = 8;
const COLUMNS: usize = 4;

/// Squares a matrix of `size` rows, `[column][row]`, into another. Each entry is the sum of its products in order,
/// whatever the registers.
pub fn square(matrix: &[f64], size: usize, into: &mut [f64]) {
    wide!(square_blocks(matrix, size, into));
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn square_blocks(matrix: &[f64], size: usize, into: &mut [f64]) {
    if size == 0 {
        return;
    }
    let columns = matrix.chunks(COLUMNS * size).zip(into.chunks_mut(COLUMNS * size));
    for (right, into) in columns {
        let mut row = 0;
        while row + ROWS <= size && right.len() == COLUMNS * size {
            let mut sums = [[0.0; ROWS]; COLUMNS];
            for (k, left) in matrix.chunks_exact(size).enumerate() {
                let left: &[f64] = &left[row..row + ROWS];
                for (column, sums) in sums.iter_mut().enumerate() {
                    let factor = right[column * size + k];
                    for (sum, left) in sums.iter_mut().zip(left) {
                        *sum += left * factor;
                    }
                }
            }
            for (column, sums) in sums.iter().enumerate() {
                into[column * size + row..][..ROWS].copy_from_slice(sums);
            }
            row += ROWS;
        }
        // What no block covers: the last rows, or the last columns whole.
        for (right, into) in right.chunks_exact(size).zip(into.chunks_exact_mut(size)) {
            into[row..].fill(0.0);
            for (left, factor) in matrix.chunks_exact(size).zip(right) {
                for (sum, left) in into[row..].iter_mut().zip(&left[row..]) {
                    *sum += left * factor;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn a_square_is_nalgebras_to_the_bit_with_and_without_whole_blocks() {
        for size in [0, 1, 3, 4, 7, 8, 9, 12, 31, 32] {
            let matrix = DMatrix::from_fn(size, size, |row, column| {
                1.0 / (1.5 + 3.0 * row as f64 - 7.0 * column as f64) - 0.1
            });
            let mut into = vec![f64::NAN; size * size];
            square(matrix.as_slice(), size, &mut into);
            assert_eq!(into, (&matrix * &matrix).as_slice(), "{size}");
        }
    }
}
