//! Integrals by Gauss–Legendre quadrature on panels, and roots by bisection.

/// Positive places and weights of the ten-point rule on [−1, 1] (Abramowitz & Stegun 1964,
/// table 25.4).
const TEN_POINTS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Integral of `f` from `from` to `to` by the ten-point rule on each of `panels` equal panels.
pub fn integrate(f: impl Fn(f64) -> f64, from: f64, to: f64, panels: u32) -> f64 {
    let half = 0.5 * (to - from) / f64::from(panels);
    let sum: f64 = (0..panels)
        .map(|panel| {
            let middle = from + half * f64::from(2 * panel + 1);
            TEN_POINTS
                .iter()
                .map(|(place, weight)| weight * (f(middle - half * place) + f(middle + half * place)))
                .sum::<f64>()
        })
        .sum();
    half * sum
}

/// The root of a function that is negative at `low` and positive at `high`, to the last bit.
pub(crate) fn bisected(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if function(middle) < 0.0 { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_nineteen_are_exact() {
        for degree in 0..20 {
            let exact = 1.0 / f64::from(degree + 1);
            assert!((integrate(|x| x.powi(degree), 0.0, 1.0, 1) - exact).abs() < 1e-15);
        }
        assert!((integrate(f64::exp, -1.0, 2.0, 3) - (2.0_f64.exp() - (-1.0_f64).exp())).abs() < 1e-14);
    }
}
