//! Sums of numbers that lie side by side, two at a time: every processor of the baseline has registers of two, and a
//! loop that is written so is compiled to them. The operations and their order are those of the loop over single
//! numbers, and so are the bits.

/// Adds a weight times some numbers to others.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn add_weighted(sums: &mut [f64], weight: f64, numbers: &[f64]) {
    let ((sums, last_sum), (numbers, last)) = (sums.as_chunks_mut::<2>(), numbers.as_chunks::<2>());
    for (sum, pair) in sums.iter_mut().zip(numbers) {
        *sum = [sum[0] + weight * pair[0], sum[1] + weight * pair[1]];
    }
    for (sum, number) in last_sum.iter_mut().zip(last) {
        *sum += weight * number;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_and_a_last_one_are_added_as_single_numbers_are() {
        for count in 0..6 {
            let numbers: Vec<f64> = (0..count).map(|i| 1.0 / (1.0 + f64::from(i))).collect();
            let mut sums: Vec<f64> = (0..count).map(f64::from).collect();
            let expected: Vec<f64> =
                sums.iter().zip(&numbers).map(|(sum, number)| sum + 0.3 * number).collect();
            add_weighted(&mut sums, 0.3, &numbers);
            assert_eq!(sums, expected);
        }
    }
}
