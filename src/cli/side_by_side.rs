//! The same for many things on all cores, in the order of the things.

use crate::sorting;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What `of` makes of every thing, with as many of them at once as there are cores. A panic of one is one here.
pub fn side_by_side<T: Sync, R: Send>(things: &[T], of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let workers = std::thread::available_parallelism().map_or(1, usize::from).min(things.len());
    let next = AtomicUsize::new(0);
    let made: Mutex<Vec<(usize, R)>> = Mutex::new(Vec::with_capacity(things.len()));
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some((place, thing)) = {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    things.get(place).map(|thing| (place, thing))
                } {
                    let result = of(thing);
                    // A lock is poisoned by a panic alone, which ends the scope.
                    if let Ok(mut made) = made.lock() {
                        made.push((place, result));
                    }
                }
            });
        }
    });
    let mut made = made.into_inner().unwrap_or_default();
    sorting::sort_by_key(&mut made, |(place, _)| *place);
    made.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_things_and_none_is_lost() {
        let things: Vec<u64> = (0..1000).collect();
        let squares = side_by_side(&things, |thing| thing * thing);
        assert_eq!(squares, things.iter().map(|thing| thing * thing).collect::<Vec<_>>());
        assert!(side_by_side(&[] as &[u64], |thing| *thing).is_empty());
    }
}
