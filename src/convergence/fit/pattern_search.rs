//! Least value of a function of a few bounded variables: pattern search (Hooke & Jeeves 1961)
//! from the best of a coarse grid.

/// Points of the coarse grid along each variable.
const STARTS: u32 = 6;

/// Step at which the search ends.
const FINEST_STEP: f64 = 1e-10;

/// Where `value` is least within the ranges; a range of no width holds its variable fixed.
pub(crate) fn least(ranges: &[(f64, f64)], value: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let clamp = |j: usize, order: f64| order.max(ranges[j].0).min(ranges[j].1);
    let mut starts = vec![Vec::new()];
    for (from, to) in ranges {
        let places = if from == to { 1 } else { STARTS };
        let place = |k: u32| from + (to - from) * (f64::from(k) + 0.5) / f64::from(places);
        let extend = |start: &Vec<f64>| {
            (0..places).map(|k| [start.as_slice(), &[place(k)]].concat()).collect::<Vec<_>>()
        };
        starts = starts.iter().flat_map(extend).collect();
    }
    let first = starts.into_iter().min_by(|a, b| value(a).total_cmp(&value(b)));
    let mut best = first.unwrap_or_default();
    let mut least = value(&best);
    let mut step = 0.25;
    while step > FINEST_STEP {
        let before = best.clone();
        for j in 0..best.len() {
            for direction in [step, -step] {
                let mut trial = best.clone();
                trial[j] = clamp(j, trial[j] + direction);
                let found = value(&trial);
                if found < least {
                    (best, least) = (trial, found);
                    break;
                }
            }
        }
        if best == before {
            step *= 0.5;
            continue;
        }
        // On along the way just gone, as far as it pays.
        loop {
            let on = |j: usize| clamp(j, best[j] + (best[j] - before[j]));
            let trial: Vec<_> = (0..best.len()).map(on).collect();
            let found = value(&trial);
            if found >= least {
                break;
            }
            (best, least) = (trial, found);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_valley_is_followed_to_its_end() {
        let valley = |x: &[f64]| (x[0] + x[1] - 3.0).powi(2) + 1e-3 * (x[0] - x[1] - 1.0).powi(2);
        let found = least(&[(0.0, 5.0), (0.0, 5.0)], valley);
        assert!((found[0] - 2.0).abs() < 1e-5 && (found[1] - 1.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn bounds_hold_and_a_fixed_variable_stays() {
        let found = least(&[(2.0, 4.0), (1.5, 1.5)], |x| x[0] * x[0] + x[1]);
        assert_eq!(found, [2.0, 1.5]);
        assert_eq!(least(&[(1.0, 1.0)], |_| f64::NAN), [1.0]);
    }
}
