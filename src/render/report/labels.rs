//! Words for quantities, samples, axes and orders, shared by all figures and tables.

use crate::case::quantity::{Quantity, Sample};
use crate::case::step_label;
use crate::judge::answers::is_settled;
use crate::judge::path_labels::PathLabels;
pub use crate::judge::paths::first_measure;
use crate::judge::paths::{Path, SeriesSummary};
use crate::record::Record;
use crate::render::number;
use crate::render::table::Cell;
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
use oedometer_convergence::Class;
use oedometer_mpm::run::TimeStepRule;

/// The words beside an order that is not settled, or instead of one, with their meanings.
const CLASSES: [(&str, &str); 8] = [
    ("pre-asymptotic", "the order still changes from mesh to mesh"),
    ("contaminated", "a term of lower order takes over on fine meshes"),
    ("superconvergent", "higher than promised"),
    ("oscillatory", "the error goes up and down"),
    ("divergent", "the error grows"),
    ("floor-limited", "something else than the mesh limits the error"),
    ("exact", "round-off is all the error there is"),
    ("locked", "the body hardly moves"),
];

/// The meaning of the words for classes that stand in some rows of a table.
pub fn class_meanings(rows: &[Vec<Cell>]) -> String {
    let is_met = |class: &str| rows.iter().flatten().any(|cell| cell.show().contains(class));
    let met = CLASSES.iter().filter(|(class, _)| is_met(class));
    met.map(|(class, meaning)| format!("{class}: {meaning}")).collect::<Vec<_>>().join("; ")
}

/// Items by their keys, both in the order of their first appearance.
pub fn grouped<K: PartialEq, V>(items: impl IntoIterator<Item = (K, V)>) -> Vec<(K, Vec<V>)> {
    let mut groups: Vec<(K, Vec<V>)> = Vec::new();
    for (key, item) in items {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, own)) => own.push(item),
            None => groups.push((key, vec![item])),
        }
    }
    groups
}

/// The words with a capital first letter.
pub fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// The order, with its class unless it is asymptotic; the class alone without an order.
pub fn order_or_class(class: Class, order: Option<f64>) -> String {
    match order {
        Some(order) if is_settled(class) => number::order(order),
        Some(order) => format!("{} ({class})", number::order(order)),
        None => class.name().to_owned(),
    }
}

/// The order or class of a series with its error on some mesh, for a cell of a table.
pub fn order_and_error(class: Class, order: Option<f64>, error: Option<f64>) -> String {
    // A hyphen that does not break the line.
    let error = error.map(|error| format!(", {}", number::error(error).replace('-', "\u{2011}")));
    order_or_class(class, order) + &error.unwrap_or_default()
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
    let words = match reference {
        NEXT_FINER => "the next finer run",
        "terzaghi" => "Terzaghi's solution with compressible water",
        "terzaghi-incompressible" => "Terzaghi's solution",
        "single-mode" => "the exact slowest mode",
        "xie-leo" => "Xie & Leo's solution",
        "dynamic-column" => "the exact column with inertia",
        "dynamic-single-mode" => "the exact slowest mode with inertia",
        "standing-wave" => "the exact standing wave",
        "large-strain" => "the exact large-strain solution of its own equations",
        "cosine-layer" => "the exact layer with compressible water",
        "cosine-layer-incompressible" => "the exact layer with incompressible water",
        "mandel" => "Mandel's solution with compressible water",
        "at-rest" => "the state of rest",
        "layered" => "the exact column of layers",
        "yield-front" => "the exact yield front",
        "sealed-element" => "the exact sealed column",
        "footing" => "Prandtl's load at collapse",
        "manufactured-box" | "manufactured-shear" | "manufactured-vortex" => "the manufactured motion",
        other => return format!("the exact solution `{other}`"),
    };
    words.to_owned()
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
        Quantity::LoadFactor => "load factor",
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

/// Why the work of a case is not known.
pub const NOT_COUNTED: &str = "of an attached solver";

/// Work of a case, where it is counted.
pub fn counted(record: &Record, work: u64) -> Cell {
    if record.case.counts_work() { Cell::Count(work) } else { Cell::missing(NOT_COUNTED) }
}

/// A measure in words, without its time.
pub fn measure(measure: &Measure) -> String {
    format!("{} {}", quantity(measure.quantity), sample(measure.sample))
}

/// The step of a run in words: seconds with their unit, else its rule.
pub fn step(record: &Record) -> String {
    match record.case.time_step {
        TimeStepRule::Seconds(seconds) => format!("Δt = {} s", number::number(seconds)),
        rule => step_label(&rule),
    }
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
pub fn error_axis(measure: &Measure) -> String {
    match measure.quantity {
        one if one.is_of_surface() => format!("relative error of {} (–)", quantity(one)),
        other => format!("relative L_2 error, {} (–)", quantity(other)),
    }
}

impl PathLabels {
    /// The labels with the places of a path's errors, where they are not those of the figure.
    #[must_use]
    pub fn with_places(mut self, summaries: &[SeriesSummary<'_>], asked: Sample) -> Self {
        for (label, summary) in self.each.iter_mut().zip(summaries) {
            if summary.measure.sample != asked {
                *label = format!("{label}, {}", sample(summary.measure.sample));
            }
        }
        self
    }
}

/// Most series of a figure with several soils.
const MOST_SERIES: usize = 14;
/// Most series of a figure with one soil.
const MOST_OF_A_SOIL: usize = 60;

/// The paths of a figure.
pub struct DrawnPaths<'a> {
    /// The paths that are shown.
    pub paths: Vec<Path<'a>>,
    /// Which of all they are, as a sentence; `None` if they are all.
    pub note: Option<String>,
}

/// All paths; if they are too many, those of the undisturbed soil, or else of the first soil.
pub fn drawn<'a>(all: &[Path<'a>]) -> DrawnPaths<'a> {
    if all.len() <= MOST_SERIES {
        return DrawnPaths { paths: all.to_vec(), note: None };
    }
    let variant = |path: &Path<'_>| path.records[0].case.variant();
    let of_variant = |wanted: &str| -> Vec<Path<'a>> {
        all.iter().filter(|path| variant(path) == wanted).cloned().collect()
    };
    let plain = of_variant("");
    let (mut paths, what) = if plain.is_empty() {
        let first = variant(&all[0]);
        (of_variant(&first), format!("those with {first}"))
    } else {
        (plain, "the plain soil only".to_owned())
    };
    let first = if paths.len() > MOST_OF_A_SOIL { "the first of " } else { "" };
    paths.truncate(MOST_OF_A_SOIL);
    let note = (paths.len() < all.len()).then(|| {
        format!(
            "The figures show {} of {} series, {first}{what}; the tables have every one.",
            paths.len(),
            all.len()
        )
    });
    DrawnPaths { paths, note }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::judge::paths::paths;
    use crate::study::expectation::Axis;
    use oedometer_exact::reference::ReferenceKind;

    #[test]
    fn every_size_has_one_tick_in_rising_order() {
        let sizes = [0.2, 0.05, 0.1, 0.2, 0.05];
        assert_eq!(ticks(sizes.into_iter()), [0.05, 0.1, 0.2]);
    }

    fn series_of(sweep: &str) -> (usize, usize, Option<String>) {
        let records = records_of(&format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\ncells = [2, 4]\n\
             integrator = ['implicit']\ntime_step = [{{ growth = 0.5 }}]\n{sweep}"
        ));
        let all = paths(&records, Axis::Cells);
        let shown = drawn(&all);
        (shown.paths.len(), all.len(), shown.note)
    }

    #[test]
    fn a_figure_shows_all_paths_or_those_of_one_soil_and_says_so() {
        let (shown, all, note) = series_of("method = ['MPM', 'GIMP']\nporosity = [0.3, 0.4]\n");
        assert_eq!((shown, all, note), (4, 4, None));
        let soils = "porosity = [0.3, 0.32, 0.34, 0.36, 0.38, 0.4, 0.42, 0.44]\n";
        let (shown, all, note) = series_of(&format!("method = ['MPM', 'GIMP']\n{soils}"));
        assert_eq!((shown, all), (2, 16));
        let note = note.expect("not all are shown");
        assert!(note.contains("show 2 of 16 series, those with porosity=0.3"), "{note}");
    }

    #[test]
    fn the_plain_soil_is_drawn_where_there_is_one_and_fourteen_series_are_not_too_many() {
        let soils = |count: usize| (0..count).map(|one| format!("0.{one:02}")).collect::<Vec<_>>().join(", ");
        let of =
            |count: usize| series_of(&format!("method = ['MPM', 'GIMP']\njitter = [{}]\n", soils(count)));
        assert_eq!(of(7), (14, 14, None));
        let note = "The figures show 2 of 16 series, the plain soil only; the tables have every one.";
        assert_eq!(of(8), (2, 16, Some(note.to_owned())));
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
            (LoadFactor, Sample::Surface, "load factor of the surface", "relative error of load factor (–)"),
        ];
        for (quantity, sample, words, of_axis) in all {
            let measured = first_measure(quantity, sample, "terzaghi", 0.1);
            assert_eq!((measure(&measured).as_str(), error_axis(&measured).as_str()), (words, of_axis));
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
            assert_eq!(order_and_error(class, order, Some(0.0012)), format!("{words}, 1.20e\u{2011}3"));
            assert_eq!(order_and_error(class, order, None), words);
        }
        assert_eq!(["", "a b", "σ c"].map(capitalised), ["", "A b", "Σ c"]);
    }
}
