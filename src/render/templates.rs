//! Sentences from templates: files in `templates/`, filled with findings. Findings hold numbers and names, templates words.

use crate::case::Quantity;
use crate::render::report::labels;
use crate::render::{RenderError, number};
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value};
use oedometer_soil::wording::{count_of, duration, typed};
use serde::Serialize;

/// The templates by their names.
const TEMPLATES: [(&str, &str); 15] = [
    ("audit", include_str!("../../templates/audit.md")),
    ("changes", include_str!("../../templates/changes.md")),
    ("converges", include_str!("../../templates/converges.md")),
    ("cost", include_str!("../../templates/cost.md")),
    ("double-point", include_str!("../../templates/double-point.md")),
    ("locking", include_str!("../../templates/locking.md")),
    ("mapping-back", include_str!("../../templates/mapping-back.md")),
    ("paper", include_str!("../../templates/paper.md")),
    ("peers", include_str!("../../templates/peers.md")),
    ("printed-equations", include_str!("../../templates/printed-equations.md")),
    ("race-answers", include_str!("../../templates/race-answers.md")),
    ("race-limits", include_str!("../../templates/race-limits.md")),
    ("time-step", include_str!("../../templates/time-step.md")),
    ("verdict", include_str!("../../templates/verdict.md")),
    ("within", include_str!("../../templates/within.md")),
];

/// An environment that knows every template and the filters that all share.
pub(crate) fn environment() -> Result<Environment<'static>, RenderError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("bound", |bound: f64| format!("{} %", number::number(100.0 * bound)));
    environment.add_filter("capital_quantity", |quantity: Serde<Quantity>| {
        labels::capitalised(labels::quantity(quantity.0))
    });
    environment.add_filter("count", |count: usize, singular: String, plural: String| {
        count_of(count, &singular, &plural)
    });
    environment.add_filter("duration", duration);
    environment.add_filter("error", number::error);
    environment.add_filter("error_percent", number::percent);
    environment.add_filter("order", number::order);
    environment.add_filter("percent", number::rounded_percent);
    environment.add_filter("ratio", |ratio: f64| number::fixed(ratio, 2));
    environment.add_filter("seconds", number::seconds);
    environment.add_filter("signed_percent", |share: f64| {
        let sign = if share < 0.0 { "−" } else { "+" };
        format!("{sign}{:.1} %", 100.0 * share.abs())
    });
    environment.add_filter("solution", |reference: String| labels::solution(&reference));
    environment.add_filter("step", |label: String| {
        let seconds = label.strip_prefix("seconds=").and_then(|text| text.parse().ok());
        seconds.map_or(label, |seconds| format!("Δt = {} s", number::number(seconds)))
    });
    environment.add_filter("time_factor", number::time_factor);
    environment.add_filter("typed", typed);
    for (name, text) in TEMPLATES {
        environment.add_template(name, text)?;
    }
    Ok(environment)
}

/// A template filled with findings: lightly marked paragraphs.
pub(crate) fn render(
    environment: &Environment<'_>,
    name: &str,
    findings: &impl Serialize,
) -> Result<String, RenderError> {
    Ok(environment.get_template(name)?.render(Value::from(Serde(findings)))?.trim().to_owned())
}

/// A template that needs no more than the shared filters.
pub(crate) fn sentence(name: &str, findings: &impl Serialize) -> Result<String, RenderError> {
    render(&environment()?, name, findings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value as Json, json};

    #[test]
    fn a_template_without_its_finding_is_an_error() {
        let environment = environment().expect("templates of this program");
        // What needs no finding says the same on every page.
        let filled = TEMPLATES.map(|(name, _)| name).into_iter().filter(|name| *name != "mapping-back");
        for name in filled.chain(["no such template"]) {
            let told = render(&environment, name, &()).expect_err(name).to_string();
            assert!(told.starts_with("a sentence of the page cannot be written: "), "{told}");
        }
    }

    /// Every branch of the templates whose findings come from several studies: findings, and the sentence.
    #[test]
    fn every_branch_of_a_template_reads_as_a_sentence() {
        let run = json!({"method": "A", "integrator": "implicit", "cells": 10, "points_per_cell": 2, "seconds": 0.02});
        let cheapest = |tolerance: f64, run: &Json| json!({"tolerance": tolerance, "run": run});
        let figure = json!({
            "number": 3, "cells": 10, "method": "A", "error": 0.0066, "reference": "terzaghi", "time_factor": 1.0
        });
        let locking = |kinds: &[&str]| {
            let method = |(place, kind): (usize, &&str)| json!({"method": format!("M{place}"), "result": {"kind": kind}});
            let methods: Vec<Json> = kinds.iter().enumerate().map(method).collect();
            json!({"methods": methods, "cells": 16, "kept_within": 0.1, "poissons_ratios": [0.25, 0.4999], "time_factor": 0.2})
        };
        let verdict = |expectations: usize, met: usize, unsound: usize, failing: &[&str]| json!({"expectations": expectations, "met": met, "studies": 1, "runs": 2, "unsound": unsound, "failing": failing});
        let order = |class: &str, order: Option<f64>, runs: &[&str]| json!({"class": class, "order": order, "is_settled": class == "asymptotic", "runs": runs, "error": 0.003});
        let steps = |orders: &[Json], unstable: &[Json], most: Option<bool>| {
            let change = |is_of_step| {
                json!({
                    "run": "A", "steps": ["courant=0.8", "courant=0.1"], "errors": [0.3, 0.1], "is_of_step": is_of_step
                })
            };
            json!({"time_factor": 0.1, "orders": orders, "unstable": unstable, "most": most.map(change)})
        };
        let pairing = |law: &str, is_printed: bool, agrees: bool, error: Option<f64>| {
            let largest = error.map(|error| json!({"error": error, "time_factor": 0.5}));
            json!({"law": law, "continuity": "c", "is_printed": is_printed, "agrees": agrees, "largest": largest})
        };
        let audit = |pairings: &[Json]| json!({"cells": 40, "agrees_within": 0.01, "pairings": pairings});
        let double = |ratios: Option<[f64; 2]>,
                      failed: [usize; 2],
                      bursts: &[&str],
                      times: Option<[f64; 2]>| {
            json!({"pairs": 2, "error_ratios": ratios, "failed": failed, "bursts": bursts, "time_ratios": times})
        };
        let column = |strain: Option<f64>, better: &Json, within: &[Json]| {
            let orders = [("asymptotic", Some(2.02)), ("pre-asymptotic", Some(1.5)), ("locked", None)];
            let orders: Vec<Json> = orders.iter().map(|(class, value)| order(class, *value, &[])).collect();
            json!({
                "final_strain": strain, "method": "A", "is_papers": strain.is_some(), "is_settled": strain.is_none(),
                "reference": "terzaghi", "orders": orders, "better": better, "within": within, "time_factor": 0.1
            })
        };
        let converges =
            |columns: &[Json], is_alone: bool| json!({"cells": 10, "is_alone": is_alone, "columns": columns});
        let better = json!({"method": "B", "cells": 20, "error": 0.1, "instead_of": 0.2});
        let coarsest = json!({"method": "B", "cells": 40, "seconds": 0.1});
        let [two, half] =
            [order("asymptotic", Some(2.0), &["A", "B"]), order("pre-asymptotic", Some(0.5), &["C"])];
        let [few, five] =
            [order("not-evaluable", None, &["D"]), order("divergent", None, &["A", "B", "C", "D", "E"])];
        let fails = json!({"run": "B", "ending": "unstable", "step": "seconds=4e-2"});
        let (wrong, printed) =
            (pairing("w", false, false, Some(0.03)), pairing("p", true, false, Some(-0.05)));
        let rows = [
            (
                "cost",
                json!({"cheapest": [cheapest(0.01, &run), cheapest(0.001, &Json::Null)]}),
                "A pressure within 1 % takes 20.0 ms (`A`, implicit, 10 cells); within 0.1 %: no timed run.",
            ),
            (
                "peers",
                json!({"method": "A", "ahead": []}),
                "On equal cells and with like time steps no other program has a smaller pressure error than `A`.",
            ),
            (
                "peers",
                json!({"method": "A", "ahead": [{"program": "P 1", "cells": 10, "error": 1e-3, "papers_error": 2e-3, "time_factor": 0.05}]}),
                "**On equal cells and with like time steps mixed elements have a smaller pressure error than `A`**: P 1 on 10 cells \
              1.00e-3 against 2.00e-3 at T_v = 0.05. The figure shows the time that an error costs.",
            ),
            (
                "paper",
                json!({"figures": [figure]}),
                "Figs 3a and 3b: on 10 cells the pressure of `A` is within 0.66 % of Terzaghi's solution with compressible water at \
              every output (relative L_2 error at the points; the largest at T_v = 1.0).",
            ),
            (
                "locking",
                locking(&["kept", "lost", "kept", "failed"]),
                "2 of 4 methods on 16 cells keep displacement and pressure within 10 % up to ν = 0.4999 at T_v = 0.2: `M0`, `M2`.",
            ),
            (
                "locking",
                locking(&["kept"]),
                "1 of 1 method on 16 cells keeps displacement and pressure within 10 % up to ν = 0.4999 at T_v = 0.2: `M0`.",
            ),
            (
                "locking",
                locking(&["lost", "unknown"]),
                "0 of 2 methods on 16 cells keep displacement and pressure within 10 % up to ν = 0.4999 at T_v = 0.2.",
            ),
            ("verdict", verdict(0, 0, 0, &[]), "**No expectations** in 1 study of 2 runs."),
            (
                "verdict",
                verdict(3, 2, 1, &["a", "b"]),
                "**2 of 3 expectations met** in 1 study of 2 runs. 1 check of runs fails. Not as expected: `a`, `b`.",
            ),
            (
                "changes",
                json!({"changed": 0, "worse": 0}),
                "Nothing: every value that these studies share with the golden values agrees within its tolerance.",
            ),
            (
                "changes",
                json!({"changed": 2, "worse": 1}),
                "Against the golden values 2 studies changed, of which 1 got worse.",
            ),
            (
                "time-step",
                steps(&[two, half, few], &[], Some(true)),
                "Order of the pressure in the step, from the differences between neighbouring steps at T_v = 0.1: 2.00 for `A`, `B`; \
              0.50 (pre-asymptotic) for `C`; too few steps for an order for `D`. All steps tried are stable. Against the exact \
              solution `A` is off by 30.0 % with courant=0.8 and by 10.0 % with courant=0.1: the step is too large for the mesh.",
            ),
            (
                "time-step",
                steps(&[five], &[fails], Some(false)),
                "Order of the pressure in the step, from the differences between neighbouring steps at T_v = 0.1: divergent for `A`, \
              `B`, `C`, `D`, 1 more. `B` ends unstable from Δt = 0.04 s on. Against the exact solution `A` is off by 30.0 % with \
              courant=0.8 and by 10.0 % with courant=0.1: the mesh, not the step, makes the error.",
            ),
            (
                "audit",
                audit(&[
                    printed.clone(),
                    pairing("r", false, true, Some(-0.004)),
                    wrong,
                    pairing("n", false, false, None),
                ]),
                "On 40 cells these pairings of law and continuity give Xie & Leo's settlement at every time (largest error): `r, c` \
              (0.40 %). These are other theories (largest difference): `p, c` (as printed) (−5.0 % at T_v = 0.5), `w, c` (+3.0 % \
              at T_v = 0.5).",
            ),
            (
                "audit",
                audit(&[printed]),
                "On 40 cells no pairing of law and continuity gives Xie & Leo's settlement within 1 %. These are other theories \
              (largest difference): `p, c` (as printed) (−5.0 % at T_v = 0.5).",
            ),
            (
                "double-point",
                double(Some([0.5, 2.0]), [0, 0], &[], Some([2.0, 3.5])),
                "2 pairs of runs differ in the point sets alone: double-point MPM has 0.50 to 2.00 times the error. All runs reached \
              their last output; in no double-point run did the pressure exceed what the load can cause. A double-point run takes \
              2.00 to 3.50 times as long.",
            ),
            (
                "double-point",
                double(Some([1.0, 1.0]), [1, 3], &["a", "b"], None),
                "2 pairs of runs differ in the point sets alone: double-point MPM has 1.00 times the error. 1 single-point run and 3 \
              double-point runs ended before their last output; the pressure exceeded what the load can cause in 2 double-point \
              runs: a; b.",
            ),
            (
                "converges",
                converges(&[column(None, &Json::Null, &[]), column(Some(0.154), &better, &[])], false),
                "At small strain `A` converges to Terzaghi's solution with compressible water: order 2.02 in the pressure at the \
              points, order 1.50 (pre-asymptotic) in the effective stress, locked in the settlement; on 10 cells the error of its \
              pressure is 0.30 %. At a final strain of 15.4 % `A`, the paper's method, has no settled order against Terzaghi's \
              solution with compressible water in some quantity: order 2.02 in the pressure at the points, order 1.50 \
              (pre-asymptotic) in the effective stress, locked in the settlement; on 10 cells the error of its pressure is 0.30 %.",
            ),
        ];
        for (name, findings, wanted) in rows {
            assert_eq!(sentence(name, &findings).expect(name), wanted, "{name}");
        }
        for (column, end) in [
            (
                column(None, &better, &[coarsest.clone()]),
                " Take `B` instead: the largest of its errors on 20 cells is 10.0 %, against 20.0 %. A pressure within 1 % at T_v = 0.1 \
              costs, each timed once beside others: `B` 100 ms on 40 cells.",
            ),
            (column(None, &Json::Null, &[]), " No run has an error of the pressure below 1 % at T_v = 0.1."),
        ] {
            let told = sentence("converges", &converges(&[column], true)).expect("filled");
            assert!(told.ends_with(end), "{told}");
        }
    }
}
