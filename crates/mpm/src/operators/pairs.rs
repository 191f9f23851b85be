//! Sums of numbers that lie side by side, four or two at a time: a loop that is written so is compiled to whatever
//! registers there are. The operations and their order are those of the loop over single numbers, and so are the
//! bits.

/// Adds a weight times some numbers to others.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn add_weighted(sums: &mut [f64], weight: f64, numbers: &[f64]) {
    let ((sums, last_sums), (numbers, last)) = (sums.as_chunks_mut::<4>(), numbers.as_chunks::<4>());
    for (sum, four) in sums.iter_mut().zip(numbers) {
        *sum = std::array::from_fn(|i| sum[i] + weight * four[i]);
    }
    let ((sums, last_sum), (numbers, last)) = (last_sums.as_chunks_mut::<2>(), last.as_chunks::<2>());
    for (sum, pair) in sums.iter_mut().zip(numbers) {
        *sum = [sum[0] + weight * pair[0], sum[1] + weight * pair[1]];
    }
    for (sum, number) in last_sum.iter_mut().zip(last) {
        *sum += weight * number;
    }
}

/// Sum of some numbers of nodes that follow each other with their weights.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn weighted_sum<const M: usize, const N: usize, const W: usize>(
    weights: &[f64; W],
    nodes: &[[[f64; N]; M]],
) -> [[f64; N]; M] {
    let nodes = &nodes[..W];
    let mut sum = nodes[0];
    for number in sum.as_flattened_mut() {
        *number *= weights[0];
    }
    for k in 1..W {
        add_weighted(sum.as_flattened_mut(), weights[k], nodes[k].as_flattened());
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fours_pairs_and_a_last_one_are_added_as_single_numbers_are() {
        for count in 0..12 {
            let numbers: Vec<f64> = (0..count).map(|i| 1.0 / (1.0 + f64::from(i))).collect();
            let mut sums: Vec<f64> = (0..count).map(f64::from).collect();
            let expected: Vec<f64> =
                sums.iter().zip(&numbers).map(|(sum, number)| sum + 0.3 * number).collect();
            add_weighted(&mut sums, 0.3, &numbers);
            assert_eq!(sums, expected);
        }
    }

    #[test]
    fn a_weighted_sum_takes_each_node_with_its_weight() {
        let nodes = [[[1.0, 2.0]], [[10.0, 20.0]], [[100.0, 200.0]], [[1e9, 1e9]]];
        assert_eq!(weighted_sum(&[0.5, 0.25, 2.0], &nodes), [[203.0, 406.0]]);
    }
}
