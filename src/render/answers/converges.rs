//! Does the method converge, and to what? The meshes of one study at small strain and of one at large strain, a row for
//! each method.

use crate::case::Case;
use crate::case::contender::PAPERS;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::Path;
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::largest;
use crate::render::answers::{Answer, Question, short, study_with_most};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::labels::{
    self, CONVERGENCE, QUOTED_CELLS, distinct, first_measure, grouped, is_settled, order_or_class,
};
use crate::render::report::refinement;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::study::expectation::{Axis, Measure};
use oedometer_convergence::{Class, Classification};
use oedometer_soil::elementary;

const QUESTION: Question = Question { heading: "Does the method converge, and to what?", id: "converges" };

/// Headings of the measures of [`CONVERGENCE`].
const HEADINGS: [&str; 4] = ["p, points", "p, centres", "σ′, points", "settlement"];

/// Methods of a study that are enough to compare.
const ENOUGH_METHODS: usize = 3;

/// Methods of the table.
const MOST_METHODS: usize = 5;

/// What is measured: quantity and places.
type Measured = (Quantity, Sample);

/// Pressure and effective stress at the points, and settlement, with their words.
const MAIN: [(&str, Measured); 3] = [
    ("in the pressure at the points", (Quantity::Pressure, Sample::Points)),
    ("in the effective stress", (Quantity::EffectiveStress, Sample::Points)),
    ("in the settlement", (Quantity::Settlement, Sample::Surface)),
];

/// Methods that solved one column on several meshes, in one study.
struct Refined<'a> {
    results: &'a StudyResults<'a>,
    /// The column's strain in words.
    strain: &'static str,
    /// Methods with their runs from coarse to fine.
    methods: Vec<(String, Path<'a>)>,
    time_factor: f64,
    /// The solution of the scene's own equations.
    reference: &'static str,
}

impl<'a> Refined<'a> {
    /// The plain runs of a study in one dimension, on the column of the first of them.
    fn of(results: &'a StudyResults<'a>, strain: &'static str, fits: impl Fn(&Case) -> bool) -> Option<Self> {
        let mut paths = refinement::longest_paths(results, Axis::Cells);
        paths.retain(|path| {
            let case = &path.records[0].case;
            case.column.dimensions == 1 && fits(case) && is_plain(case)
        });
        let first = paths.first()?.records[0];
        paths.retain(|path| {
            let case = &path.records[0].case;
            case.column == first.case.column
                && case.material == first.case.material
                && case.points_per_cell == first.case.points_per_cell
        });
        let (time_factor, reference) =
            (refinement::shown_time(&paths)?, results.study.references.first()?.name());
        let mut refined = Self { results, strain, methods: Vec::new(), time_factor, reference };
        let by_method =
            grouped(paths.into_iter().map(|path| (path.records[0].case.method.to_string(), path)));
        for (method, own) in by_method {
            // Of several integrators the first with most orders that are settled.
            let best =
                own.into_iter().reduce(|a, b| if refined.worth(&b) > refined.worth(&a) { b } else { a });
            refined.methods.extend(best.map(|path| (method, path)));
        }
        Some(refined)
    }

    /// How much a method's runs tell: whether the quoted mesh is among them, settled orders, levels.
    fn worth(&self, path: &Path<'_>) -> (bool, usize, usize) {
        let is_quoted = path.records.iter().any(|record| record.case.cells == QUOTED_CELLS);
        let settled = CONVERGENCE.iter().filter(|measured| is_settled(self.found(path, **measured).class));
        (is_quoted, settled.count(), path.records.len())
    }

    /// The method of the sentence: the paper's, or the first.
    fn told(&self) -> &(String, Path<'a>) {
        self.method(PAPERS).unwrap_or(&self.methods[0])
    }

    fn method(&self, name: &str) -> Option<&(String, Path<'a>)> {
        self.methods.iter().find(|(method, _)| method == name)
    }

    fn found(&self, path: &Path<'_>, (quantity, sample): Measured) -> Classification {
        path.summary(&self.measure(path, (quantity, sample))).classification
    }

    /// A method's error on a mesh.
    fn error(&self, path: &Path<'_>, (quantity, sample): Measured, cells: usize) -> Option<f64> {
        let record = path.records.iter().find(|record| record.case.cells == cells)?;
        Some(self.measure(path, (quantity, sample)).error(record)?.value.abs())
    }

    /// The measure at the places that a solver has.
    fn measure(&self, path: &Path<'_>, (quantity, sample): Measured) -> Measure {
        path.own_measure(&first_measure(quantity, sample, self.reference, self.time_factor))
    }

    /// The finest mesh that all methods can have run.
    fn finest_cells(&self) -> usize {
        let finest = |(_, path): &(String, Path<'_>)| path.records.iter().map(|one| one.case.cells).max();
        self.methods.iter().filter_map(finest).min().unwrap_or_default()
    }

    /// The largest of a method's main errors on that mesh; infinite where one is missing.
    fn largest_error(&self, path: &Path<'_>) -> f64 {
        let errors = MAIN.map(|(_, measured)| self.error(path, measured, self.finest_cells()));
        errors.into_iter().collect::<Option<Vec<f64>>>().and_then(largest).unwrap_or(f64::INFINITY)
    }
}

/// Whether a case is of the scene's own equations, on regular points, however it is integrated.
fn is_plain(case: &Case) -> bool {
    let variant = case.variant();
    variant.is_empty() || variant.split(", ").all(|part| part.ends_with(" drag"))
}

/// Sentence, table and figure.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let is_small = |case: &Case| {
        let scene = case.scene;
        !scene.is_large_strain() && !scene.has_waves() && !scene.has_plane_fields() && scene.is_loaded()
    };
    let of = |strain, fits: &dyn Fn(&Case) -> bool| {
        let most = study_with_most(results, |one| {
            let refined = Refined::of(one, strain, fits)?;
            let (method, path) = refined.told();
            // A few methods make a comparison; of studies with more the one whose orders are settled tells most.
            let methods = refined.methods.len().min(ENOUGH_METHODS);
            let worth = refined.worth(path);
            let worth = (method == PAPERS, worth.0, methods, worth);
            Some((worth, refined))
        });
        most.map(|(_, refined)| refined)
    };
    let (small, large) =
        (of("small strain", &is_small), of("large strain", &|case| case.scene.is_large_strain()));
    let all: Vec<&Refined<'_>> = [&small, &large].into_iter().flatten().collect();
    if all.is_empty() {
        return None;
    }
    // Beside the race and timed studies, which have sections of their own on what to take and what it costs.
    let is_alone = !results.iter().any(|one| one.study.is_race || one.study.timing_repeats > 1);
    let sentences = all.iter().map(|refined| {
        let advice =
            if is_alone { better(refined).unwrap_or_default() + &cost(refined) } else { String::new() };
        sentence(refined) + &advice
    });
    let sentences = sentences.collect::<Vec<_>>().join(" ");
    let studies = all.iter().map(|refined| refined.results.study.name.as_str());
    let mut blocks = vec![Block::Table(short(table(&all), "in the studies"))];
    blocks.extend(small.as_ref().and_then(figure).map(Block::Figure));
    Some(QUESTION.told(&sentences, studies, blocks))
}

/// What the paper's method, or the first of the methods, converges to and how fast; where an order is not settled, the
/// class instead.
fn sentence(refined: &Refined<'_>) -> String {
    let (method, path) = refined.told();
    let found = MAIN.map(|(words, measured)| {
        let class = refined.found(path, measured);
        let order = if class.order.is_some() { "order " } else { "" };
        (is_settled(class.class), format!("{order}{} {words}", order_or_class(&class)))
    });
    let does = if found.iter().all(|(is_settled, _)| *is_settled) {
        format!("converges to {}", labels::solution(refined.reference))
    } else {
        format!("has no settled order against {} in some quantity", labels::solution(refined.reference))
    };
    let orders = found.map(|(_, words)| words).join(", ");
    let whose = if method == PAPERS { ", the paper's method," } else { "" };
    let case = &path.records[0].case;
    let strain = if case.scene.is_large_strain() {
        let strain = 1.0 - elementary::exp(-case.column.load / case.material.oedometric_modulus());
        format!("At a final strain of {},", number::percent(strain))
    } else {
        format!("At {}", refined.strain)
    };
    let error = refined.error(path, MAIN[0].1, QUOTED_CELLS).map_or(String::new(), |error| {
        format!("; on {QUOTED_CELLS} cells the error of its pressure is {}", number::percent(error))
    });
    format!("{strain} `{method}`{whose} {does}: {orders}{error}.")
}

/// The method to take instead of the one of the sentence: where the largest of its errors is at most half as large.
fn better(refined: &Refined<'_>) -> Option<String> {
    let largest = |one: &(String, Path<'_>)| refined.largest_error(&one.1);
    let own = largest(refined.told());
    let least = refined.methods.iter().min_by(|a, b| largest(a).total_cmp(&largest(b)))?;
    let instead = Some(largest(least)).filter(|instead| own.is_finite() && 2.0 * instead <= own)?;
    let [instead, own] = [instead, own].map(number::percent);
    Some(format!(
        " Take `{}` instead: the largest of its errors on {} cells is {instead}, against {own}.",
        least.0,
        refined.finest_cells()
    ))
}

/// The coarsest meshes with a pressure error of 1 %, of studies that time nothing by repeats, and what these runs took.
fn cost(refined: &Refined<'_>) -> String {
    let within = refined.methods.iter().filter_map(|(method, path)| {
        let is_within = |cells| Some(refined.error(path, MAIN[0].1, cells)? <= WITHIN);
        // From coarse to fine; single times are too rough to choose by.
        let run = path.records.iter().find(|record| is_within(record.case.cells) == Some(true))?;
        let seconds = run.wall.iter().map(|sample| sample.seconds).reduce(f64::min)?;
        Some((seconds, format!("`{method}` {} on {} cells", number::seconds(seconds), run.case.cells)))
    });
    let mut within: Vec<(f64, String)> = within.collect();
    within.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ways = within.into_iter().map(|(_, way)| way).collect::<Vec<_>>().join(", ");
    let (share, time) = (number::number(100.0 * WITHIN), number::time_factor(refined.time_factor));
    match ways.as_str() {
        "" => format!(" No run has an error of the pressure below {share} % at T_v = {time}."),
        _ => format!(
            " A pressure within {share} % at T_v = {time} costs, each timed once beside others: {ways}."
        ),
    }
}

/// The error whose cost is told.
const WITHIN: f64 = 0.01;

fn table(all: &[&Refined<'_>]) -> Table {
    let methods = all.iter().flat_map(|refined| refined.methods.iter().map(|(method, _)| method.as_str()));
    let mut ranked = distinct(methods);
    // The paper's method first, then those that answer most, then those with the smaller error where it is hardest.
    ranked.sort_by(|a, b| {
        let tried = |name: &str| all.iter().filter(|refined| refined.method(name).is_some()).count();
        let error = |name: &str| {
            let last = all.iter().rev().find_map(|refined| Some((refined, refined.method(name)?)));
            last.map_or(f64::INFINITY, |(refined, (_, path))| refined.largest_error(path))
        };
        let is_papers = |name: &str| name == PAPERS;
        is_papers(b).cmp(&is_papers(a)).then(tried(b).cmp(&tried(a))).then(error(a).total_cmp(&error(b)))
    });
    let mut columns = columns("method");
    for refined in all {
        let of = if all.len() > 1 { format!("{}: ", refined.strain) } else { String::new() };
        columns.extend(HEADINGS.map(|what| TableColumn::text(format!("{of}{what}"))));
    }
    let rows = ranked.into_iter().map(|name| {
        let method = if name == PAPERS {
            Cell::Verdict(Mood::Note, format!("{name}, the paper's"))
        } else {
            Cell::Code(name.to_owned())
        };
        let cells = all.iter().flat_map(|refined| {
            CONVERGENCE.map(|measured| match refined.method(name) {
                Some((_, path)) => quote(refined, path, measured),
                None => Cell::missing("not tried on this column with at least three meshes"),
            })
        });
        std::iter::once(method).chain(cells).collect()
    });
    let at = all.iter().map(|refined| {
        let solution = labels::solution(refined.reference);
        format!("{}: T_v = {}, against {solution}", refined.strain, number::time_factor(refined.time_factor))
    });
    let mut rows: Vec<Vec<Cell>> = rows.collect();
    let more = rows.len().saturating_sub(MOST_METHODS);
    rows.truncate(MOST_METHODS);
    let norms = format!(
        "{}; relative L_2 norm over the volume, |s/s_exact − 1| of the settlement",
        at.collect::<Vec<_>>().join("; ")
    );
    let others = if more > 0 { format!("{more} more: on the pages of the studies") } else { String::new() };
    let notes = [norms, labels::class_meanings(&rows), others].into_iter().filter(|note| !note.is_empty());
    Table::of(format!("Order on the finest three meshes, error on {QUOTED_CELLS} cells"), columns, rows)
        .notes(notes)
}

/// Order and error in a few characters.
fn quote(refined: &Refined<'_>, path: &Path<'_>, measured: Measured) -> Cell {
    let found = refined.found(path, measured);
    let words = labels::order_and_error(&found, refined.error(path, measured, QUOTED_CELLS));
    match found.class {
        Class::Locked => Cell::Verdict(Mood::Fail, words),
        Class::NotEvaluable => Cell::missing("fewer than three meshes have this error"),
        _ => words.into(),
    }
}

/// The error of the pressure over the mesh.
fn figure(refined: &Refined<'_>) -> Option<Figure> {
    let (quantity, sample) = MAIN[0].1;
    let mut figure = refinement::mesh_figure(refined.results, quantity, sample, refined.time_factor)?;
    "readme-mesh".clone_into(&mut figure.name);
    Some(figure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::case::planned::Tier;
    use crate::record::{Record, WallSample};

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['GIMP', 'GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n[[sweep]]\n\
        method = ['MPM']\nintegrator = ['implicit']\ncells = [40]\n";

    /// Records with errors of second order, by their sizes on twenty cells: pressure, effective stress and settlement of
    /// the three methods, and one run's seconds.
    fn records(errors: [[f64; 3]; 3]) -> Vec<Record> {
        let mut records = records_of(STUDY);
        for record in &mut records {
            let name = record.case.method.to_string();
            let place = ["GIMP", PAPERS, "MPM"].iter().position(|one| *one == name).expect("one of them");
            let [pressure, stress, settlement] = errors[place];
            let coarse = 400.0 / (record.case.cells * record.case.cells) as f64;
            for row in &mut record.errors {
                row.value = coarse
                    * match row.quantity {
                        Quantity::Pressure if row.sample == Sample::Points => pressure,
                        Quantity::EffectiveStress => stress,
                        Quantity::Settlement => -settlement,
                        _ => 1e-9,
                    };
            }
            let of_run = |seconds: f64| WallSample { seconds, ..WallSample::default() };
            record.wall = [[9.0, 8.0], [0.3, 0.2], [0.1, 0.4]][place].map(of_run).to_vec();
        }
        records
    }

    fn with<T>(records: &[Record], told: impl FnOnce(&Refined<'_>) -> T) -> T {
        let study = study_of("s", STUDY);
        let results = StudyResults::new(&study, records, Tier::Full);
        told(&Refined::of(&results, "small strain", |_| true).expect("three methods"))
    }

    #[test]
    fn another_method_is_advised_where_its_largest_error_on_the_finest_mesh_of_all_is_half_as_large() {
        let advice = |own: [f64; 3], other: [f64; 3]| {
            with(&records([[0.9; 3], own, other]), |refined| {
                assert_eq!(
                    refined.finest_cells(),
                    20,
                    "that of the paper's method, though another ran on 40"
                );
                better(refined)
            })
        };
        let told = " Take `MPM` instead: the largest of its errors on 20 cells is 10.0 %, against 20.0 %.";
        for own in [[0.2, 0.01, 0.1], [0.1, 0.2, 0.01], [0.01, 0.1, 0.2]] {
            for other in [[0.1, 0.05, 0.01], [0.05, 0.1, 0.0], [0.0, 0.05, 0.1]] {
                assert_eq!(advice(own, other).as_deref(), Some(told), "{own:?} {other:?}");
                assert_eq!(advice(own, other.map(|error| 1.02 * error)), None, "it is not half as large");
            }
        }
        assert_eq!(advice([0.1; 3], [f64::NAN, 0.01, 0.01]), None, "no number is no small one");
    }

    #[test]
    fn the_cost_of_a_percent_is_that_of_the_coarsest_mesh_within_it_the_cheapest_method_first() {
        let told = |own: f64, other: f64| with(&records([[0.9; 3], [own; 3], [other; 3]]), cost);
        assert_eq!(
            told(0.01, 0.02),
            " A pressure within 1 % at T_v = 0.1 costs, each timed once beside others: `MPM` 100 ms on 40 cells, \
             `GC-SRI-patch` 200 ms on 20 cells."
        );
        assert_eq!(
            told(0.002, 0.05),
            " A pressure within 1 % at T_v = 0.1 costs, each timed once beside others: `GC-SRI-patch` 200 ms on 10 cells."
        );
        assert_eq!(told(0.011, 0.05), " No run has an error of the pressure below 1 % at T_v = 0.1.");
    }

    #[test]
    fn the_paper_s_method_leads_the_table_and_the_others_follow_by_their_largest_error() {
        let [first, others] = [[0.5, 0.3], [0.3, 0.5]].map(|[one, other]| {
            with(&records([[one; 3], [0.01, 0.02, 0.03], [0.1, other, 0.1]]), |refined| table(&[refined]))
        });
        let names = |table: &Table| table.rows.iter().map(|row| row[0].show()).collect::<Vec<_>>();
        assert_eq!(names(&first), ["• GC-SRI-patch, the paper's", "MPM", "GIMP"]);
        assert_eq!(names(&others), ["• GC-SRI-patch, the paper's", "GIMP", "MPM"]);
        // On ten cells four times the error, each under its quantity.
        let errors =
            ["2.00, 4.00e\u{2011}2", "2.00, 4.00e\u{2011}9", "2.00, 8.00e\u{2011}2", "2.00, 1.20e\u{2011}1"];
        assert_eq!(first.rows[0][1..], errors.map(Cell::from));
        let heads: Vec<&str> = first.columns.iter().map(|column| column.header.as_str()).collect();
        assert_eq!(heads, ["method", "p, points", "p, centres", "σ′, points", "settlement"]);
    }
}
