//! Share of the products of choices that the checker refuses: method, integrator, scene, point sets and an option.

use crate::options::Options;
use oedometer::Column;
use oedometer_problem::method::Method;
use oedometer_soil::material::Material;
use std::collections::BTreeMap;
use std::io::Write as _;

/// Every so many products are asked: a number without a factor in common with any of the choices'.
const EVERY: usize = 7;
/// An option, the key that a study sets for it, and its value.
const OPTIONS: [(&str, &str, &str); 6] = [
    ("none", "", ""),
    ("affine", "integrator.affine", "true"),
    ("stress slopes", "integrator.stress_slopes", "true"),
    ("chord mean", "material.conductivity_mean", "chord"),
    ("jitter", "points.jitter", "0.1"),
    ("offset", "points.offset", "0.2"),
];
/// Most of the products that may be refused; at c83d707d, by this count, 0.79 were.
const MOST: f64 = 0.4;

#[test]
fn refused_products_of_choices_are_few() {
    let (mut asked, mut refused, mut reasons) = (0, 0, BTreeMap::<String, usize>::new());
    let mut number = 0;
    for scene in oedometer::scenes::SCENES {
        for method in Method::names() {
            for (integrator, step) in [
                ("explicit", ("courant", 0.4)),
                ("semi-implicit", ("growth", 0.05)),
                ("implicit", ("growth", 0.05)),
            ] {
                for sets in [1, 2] {
                    for (_, key, value) in OPTIONS {
                        number += 1;
                        if number % EVERY != 0 {
                            continue;
                        }
                        let mut options = Options {
                            scene: scene.name,
                            method: method.clone(),
                            integrator,
                            cells: 10,
                            points_per_cell: 2,
                            time_step: Some(step),
                            time_factors: (scene.outputs)(&Column::default(), &Material::default())[..1]
                                .to_vec(),
                            settings: Vec::new(),
                        };
                        if sets == 2 {
                            options.set("points.sets", sets);
                        }
                        if !key.is_empty() {
                            options.set(key, value);
                        }
                        asked += 1;
                        if let Err(told) = options.study() {
                            refused += 1;
                            let first = told.lines().next().unwrap_or_default().to_owned();
                            *reasons.entry(first).or_default() += 1;
                        }
                    }
                }
            }
        }
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let share = f64::from(refused) / f64::from(asked);
    let mut out = std::io::stdout();
    let _ = writeln!(out, "refused: {refused} of {asked} products of choices, {share:.3}");
    for (reason, count) in reasons {
        let _ = writeln!(out, "{count:6} {reason}");
    }
    assert!(share < MOST, "{share:.3} of the products of choices are refused");
}
