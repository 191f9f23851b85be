//! Stable sorts of lists that are short beside what they cost the compiler.
//!
//! The standard library's sort is some 2500 instructions for every type and every closure that it is called with. Here
//! one sort of places serves all; what is compiled for a type is the swaps. Long tables (`import`) call the library's.

use std::cmp::Ordering;

/// Sorts by an order; what is equal stays in its own.
pub fn sort_by<T>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let order = order_of(items.len(), &|one, other| compare(&items[one], &items[other]));
    for (here, there) in swaps_of(&order) {
        items.swap(here, there);
    }
}

/// Sorts by a key; what is equal stays in its own order.
pub fn sort_by_key<T, K: Ord>(items: &mut [T], key: impl Fn(&T) -> K) {
    sort_by(items, |one, other| key(one).cmp(&key(other)));
}

/// The places of a list in the order in which they are to stand.
fn order_of(count: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|one, other| compare(*one, *other));
    order
}

/// Swaps that bring a list into an order, at most one an entry.
fn swaps_of(order: &[usize]) -> Vec<(usize, usize)> {
    let mut place_of = vec![0; order.len()];
    for (place, item) in order.iter().enumerate() {
        place_of[*item] = place;
    }
    let mut swaps = Vec::new();
    for here in 0..order.len() {
        while place_of[here] != here {
            let there = place_of[here];
            swaps.push((here, there));
            place_of.swap(here, there);
        }
    }
    swaps
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_sort_is_the_librarys_stable_one(keys in prop::collection::vec(0_u8..20, 0..60)) {
            let items: Vec<(u8, usize)> = keys.into_iter().zip(0..).collect();
            let (mut expected, mut sorted, mut down) = (items.clone(), items.clone(), items);
            expected.sort_by_key(|item| item.0);
            super::sort_by_key(&mut sorted, |item| item.0);
            prop_assert_eq!(&sorted, &expected);
            expected.sort_by_key(|item| std::cmp::Reverse(item.0));
            super::sort_by(&mut down, |one, other| other.0.cmp(&one.0));
            prop_assert_eq!(down, expected);
        }
    }
}
