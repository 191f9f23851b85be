//! Words for quantities, samples, axes and orders, shared by all figures and tables.

use crate::case::Case;
use crate::case::quantity::{Quantity, Sample};
use crate::render::number;
use crate::render::table::Cell;
use crate::study::expectation::{Axis, NEXT_FINER};
use oedometer_convergence::Class;
use oedometer_exact::reference::ReferenceKind;
use oedometer_scenes::scene::Clock;
use oedometer_wording::clock_time;

/// What every cost is, wherever one stands.
pub const COUNTED_WORK: &str = "counted operations times their calibrated times";

/// The words beside an order that is not settled, or instead of one, with their meanings.
const CLASSES: [(&str, &str); 8] = [
    ("pre-asymptotic", "the order still changes from mesh to mesh"),
    ("contaminated", "a term of lower order dominates on fine meshes"),
    ("superconvergent", "above the formal order"),
    ("oscillatory", "the error goes up and down"),
    ("divergent", "the error grows"),
    ("floor-limited", "something other than the mesh limits the error; an order is that before its plateau"),
    ("exact", "the error is round-off only"),
    ("locked", "the body hardly moves"),
];

/// The meaning of the words for classes that stand in some rows of a table.
pub fn class_meanings(rows: &[Vec<Cell>]) -> String {
    let is_met = |class: &str| rows.iter().flatten().any(|cell| cell.show().contains(class));
    let met = CLASSES.iter().filter(|(class, _)| is_met(class));
    met.map(|(class, meaning)| format!("{class}: {meaning}")).collect::<Vec<_>>().join("; ")
}

/// The words with a capital first letter.
pub fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// The order, with its class unless it is asymptotic; the class alone without an order.
pub fn order_or_class(class: Class, order: Option<f64>) -> String {
    match order {
        Some(order) if class.is_settled() => number::order(order),
        Some(order) => format!("{} ({class})", number::order(order)),
        None => class.name().to_owned(),
    }
}

/// The same in a sentence.
pub fn order_with_class(class: Class, order: Option<f64>) -> String {
    match order {
        Some(_) => format!("order {}", order_or_class(class, order)),
        None if class == Class::NotEvaluable => "no order to evaluate".to_owned(),
        None => class.name().to_owned(),
    }
}

/// Sorted ticks for the sizes of levels.
pub fn ticks(sizes: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut ticks: Vec<f64> = sizes.collect();
    ticks.sort_by(f64::total_cmp);
    ticks.dedup();
    ticks
}

/// A reference in words, for running text.
pub fn solution(reference: &str) -> String {
    if reference == NEXT_FINER {
        return "the next finer run".to_owned();
    }
    let known: Option<ReferenceKind> = reference.parse().ok();
    let words = known.map(|kind| kind.row().words).filter(|words| !words.is_empty());
    words.map_or_else(|| format!("the exact solution `{reference}`"), str::to_owned)
}

/// The time of an output, and where a clock shows it, what that shows.
pub fn output_time(case: &Case, factor: f64) -> String {
    let (name, typed) = (case.scene.clock.factor_name(), number::time_factor(factor));
    if case.scene.clock == Clock::Push {
        return format!("{name} = {typed}");
    }
    format!("{name} = {typed} ({})", clock_time(factor * case.seconds_per_time_factor()))
}

/// A reference as the name of a line.
pub fn theory(reference: &str) -> String {
    capitalised(solution(reference).trim_start_matches("the ")).replace('`', "")
}

/// A quantity in words.
pub fn quantity(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Pressure => "pore pressure",
        Quantity::EffectiveStress => "effective stress",
        Quantity::Displacement => "displacement",
        Quantity::Settlement => "settlement",
        Quantity::LoadFactor => "bearing-capacity factor",
    }
}

/// Places in words.
pub fn sample(sample: Sample) -> &'static str {
    match sample {
        Sample::Points => "at the points",
        Sample::Centres => "at the cell centres",
        Sample::Nodes => "at the nodes",
        Sample::Surface => "of the surface",
    }
}

/// A quantity at its places, in words.
pub fn measured(measured: Quantity, at: Sample) -> String {
    format!("{} {}", quantity(measured), sample(at))
}

/// What all series of a figure share, as the end of its subtitle.
pub fn subtitle_end(shared: &str) -> String {
    if shared.is_empty() { String::new() } else { format!("; {shared}") }
}

/// Label of an axis of refinement.
pub fn axis(axis: Axis) -> &'static str {
    match axis {
        Axis::Cells => "cell size h (m)",
        Axis::TimeStep => "time step Δt (s)",
        Axis::PointsPerCell => "spacing of the points in a cell, 1/m (–)",
        Axis::WaterBulkModulus => "compressibility of the water 1/K_w (1/Pa)",
    }
}

/// Label of an error's axis.
pub fn error_axis(of: Quantity) -> String {
    match of {
        one if one.is_of_surface() => format!("relative error of {} (–)", quantity(one)),
        other => format!("relative L_2 error, {} (–)", quantity(other)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_size_has_one_tick_in_rising_order() {
        let sizes = [0.2, 0.05, 0.1, 0.2, 0.05];
        assert_eq!(ticks(sizes.into_iter()), [0.05, 0.1, 0.2]);
    }

    #[test]
    fn the_time_of_an_output_is_on_a_clock_except_where_a_plate_is_pushed() {
        for (scene, told) in
            [(&oedometer_scenes::TERZAGHI, "T_v = 0.2 (16.35 s)"), (&oedometer_scenes::FOOTING, "u/B = 0.2")]
        {
            let case = Case::seed(crate::case::Task::Solve, scene);
            assert_eq!(output_time(&case, 0.2), told);
        }
    }

    #[test]
    fn quantities_places_references_axes_and_orders_have_words_of_their_own() {
        use Quantity::{Displacement, EffectiveStress, LoadFactor, Pressure, Settlement};
        assert_eq!(
            ["terzaghi", "terzaghi-incompressible", "large-strain", "xie-leo", "stokes"].map(solution),
            [
                "Terzaghi's solution with compressible water",
                "Terzaghi's solution",
                "the exact large-strain solution of its own equations",
                "Xie & Leo's solution",
                "the exact solution `stokes`"
            ]
        );
        assert_eq!(["stokes", "standing-wave"].map(theory), ["Exact solution stokes", "Exact standing wave"]);
        // Each solution that a scene is judged by has words.
        for kind in ReferenceKind::ALL {
            assert!(!solution(kind.name()).contains('`'), "{}", kind.name());
        }
        let all = [
            (
                Pressure,
                Sample::Points,
                "pore pressure at the points",
                "relative L_2 error, pore pressure (–)",
            ),
            (
                EffectiveStress,
                Sample::Centres,
                "effective stress at the cell centres",
                "relative L_2 error, effective stress (–)",
            ),
            (
                Displacement,
                Sample::Nodes,
                "displacement at the nodes",
                "relative L_2 error, displacement (–)",
            ),
            (Settlement, Sample::Surface, "settlement of the surface", "relative error of settlement (–)"),
            (
                LoadFactor,
                Sample::Surface,
                "bearing-capacity factor of the surface",
                "relative error of bearing-capacity factor (–)",
            ),
        ];
        for (quantity, sample, words, of_axis) in all {
            assert_eq!((&*measured(quantity, sample), &*error_axis(quantity)), (words, of_axis));
        }
        assert_eq!(
            Axis::ALL.map(axis),
            [
                "cell size h (m)",
                "time step Δt (s)",
                "spacing of the points in a cell, 1/m (–)",
                "compressibility of the water 1/K_w (1/Pa)"
            ]
        );
        for (class, order, words) in [
            (Class::Asymptotic, Some(1.998), "2.00"),
            (Class::Superconvergent, Some(3.0), "3.00"),
            (Class::PreAsymptotic, Some(1.5), "1.50 (pre-asymptotic)"),
            (Class::Contaminated, Some(1.0), "1.00 (contaminated)"),
            (Class::Divergent, None, "divergent"),
        ] {
            assert_eq!(order_or_class(class, order), words);
        }
        assert_eq!(["", "a b", "σ c"].map(capitalised), ["", "A b", "Σ c"]);
    }
}
