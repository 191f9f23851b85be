//! Four-wide registers, where the processor has them.
//!
//! The program is compiled for every 64-bit machine, whose registers hold two numbers. A loop that is handed to
//! [`wide!`] is compiled a second time for registers of four, and which of the two runs is asked at run time. Both do
//! the same operations in the same order, none of them fused, and give the same bits.

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use fearless_simd::{Level, Simd};
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use std::sync::LazyLock;

/// Numbers of a wide register: neighbouring points that are worked out side by side, by loops over them.
pub const LANES: usize = 4;

/// Whether [`LANES`] neighbours from one on are there, and of one number.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn are_alike(numbers: &[u8], first: usize) -> bool {
    numbers.get(first..first + LANES).is_some_and(|some| *some == [some[0]; LANES])
}

/// `N` neighbours of a field from one on.
///
/// # Panics
/// Where the field ends before them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn some_of<T, const N: usize>(field: &[T], first: usize) -> &[T; N] {
    field[first..].first_chunk().expect("a field that holds them all")
}

/// The same, to be written.
///
/// # Panics
/// Where the field ends before them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn some_mut<T, const N: usize>(field: &mut [T], first: usize) -> &mut [T; N] {
    field[first..].first_chunk_mut().expect("a field that holds them all")
}

/// What the processor has: asked once, for a step asks many times.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
static LEVEL: LazyLock<Level> = LazyLock::new(Level::new);

#[cfg(any(test, feature = "narrow-registers"))]
thread_local! {
    static IS_NARROW: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// Does a work of this thread in registers of two numbers, whatever the processor has: for the tests that hold both
/// together.
#[cfg(any(test, feature = "narrow-registers"))]
pub fn in_narrow_registers<T>(work: impl FnOnce() -> T) -> T {
    IS_NARROW.set(true);
    let result = work();
    IS_NARROW.set(false);
    result
}

/// Does a work in registers of four numbers where there are such. What it calls must be inlined into it: a function
/// of its own stays with two.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn in_wide_registers<T>(work: impl FnOnce() -> T) -> T {
    #[cfg(any(test, feature = "narrow-registers"))]
    if IS_NARROW.get() {
        return work();
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(four) = LEVEL.as_avx2() {
        return four.vectorize(work);
    }
    work()
}

/// Evaluates an expression in registers of four numbers where there are such.
#[doc(hidden)]
#[macro_export]
macro_rules! evaluate_wide {
    ($work:expr) => {
        $crate::wide::in_wide_registers(
            #[inline(always)]
            || $work,
        )
    };
}
pub use crate::evaluate_wide as wide;

#[cfg(test)]
mod tests {
    use super::wide;

    #[inline(never)]
    fn sums(numbers: &[f64], factor: f64) -> Vec<f64> {
        numbers
            .iter()
            .scan(0.0, |sum, number| {
                *sum += factor * number;
                Some(*sum)
            })
            .collect()
    }

    #[test]
    fn a_work_gives_the_same_bits_in_registers_of_two_and_of_four() {
        let numbers: Vec<f64> = (0..1000).map(|i| 1.0 / f64::from(3 + 7 * i)).collect();
        let mapped = |numbers: &[f64]| -> Vec<f64> {
            numbers.iter().map(|x| x * x + 0.1 * x / (1.0 + x) - 1e-3).collect()
        };
        assert_eq!(wide!(mapped(&numbers)), mapped(&numbers));
        assert_eq!(wide!(sums(&numbers, 0.3)), sums(&numbers, 0.3));
    }
}
