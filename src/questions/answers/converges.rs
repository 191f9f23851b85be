//! Does the method converge, and to what? The meshes of one study at small strain and of one at large strain, with the orders
//! and errors of every method.

use crate::case::contender::PAPERS;
use crate::case::{Case, Quantity, Sample};
use crate::judge::paths::{Path, first_measure, grouped, shown_time};
use crate::judge::reaching::QuotedRuns;
use crate::measure::statistics::largest;
use crate::questions::answers::{CONVERGENCE, QUOTED_CELLS, study_with_most};
use crate::questions::blocks::error_figure::ErrorFigure;
use crate::questions::study_results::StudyResults;
use crate::record::Record;
use crate::study::expectation::{Axis, Measure};
use oedometer_convergence::Class;
use oedometer_soil::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Methods of a study that are enough to compare.
const ENOUGH_METHODS: usize = 3;

/// The error whose cost is told.
const WITHIN: f64 = 0.01;

/// What is measured: quantity and places.
type Measured = (Quantity, Sample);

/// Pressure and effective stress at the points, and settlement.
const MAIN: [Measured; 3] = [
    (Quantity::Pressure, Sample::Points),
    (Quantity::EffectiveStress, Sample::Points),
    (Quantity::Settlement, Sample::Surface),
];

/// The columns on which methods were refined.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConvergesFinding {
    /// Cells of the mesh on which errors are quoted.
    pub cells: usize,
    /// Whether no race and no timed study says which method to take and what it costs.
    pub is_alone: bool,
    /// A column at small and one at large strain, as far as there are studies of them.
    pub columns: Vec<ColumnFinding>,
}

/// Methods that solved one column on several meshes, in one study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ColumnFinding {
    /// Study.
    pub study: String,
    /// Final strain of a column at large strain.
    pub final_strain: Option<f64>,
    /// The solution of the scene's own equations.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// The paper's method, or the first.
    pub method: String,
    /// Whether that is the paper's.
    pub is_papers: bool,
    /// Whether its orders are settled in the pressure, the effective stress and the settlement.
    pub is_settled: bool,
    /// These orders, with the errors on the quoted mesh.
    pub orders: Vec<OrderFinding>,
    /// Every method.
    pub methods: Vec<MethodOrders>,
    /// A method whose largest error is at most half as large.
    pub better: Option<BetterMethod>,
    /// The coarsest mesh on which each method's pressure is within 1 %, the cheapest first.
    pub within: Vec<CoarsestWithin>,
    /// The error of the pressure over the mesh.
    #[serde(default)]
    pub figure: Option<ErrorFigure>,
}

/// A method's orders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MethodOrders {
    /// Method.
    pub method: String,
    /// Orders and errors of the pressure at the points and the centres, the effective stress and the settlement.
    pub orders: Vec<OrderFinding>,
    /// The largest of its errors of pressure, effective stress and settlement on the finest mesh that all methods have; none
    /// where one of them is missing.
    pub largest_error: Option<f64>,
}

/// An order, and an error on the quoted mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OrderFinding {
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Class of the series.
    pub class: Class,
    /// Order on the finest three meshes, where the class has one.
    pub order: Option<f64>,
    /// Whether it no longer changes from mesh to mesh.
    pub is_settled: bool,
    /// Relative error on the quoted mesh.
    pub error: Option<f64>,
}

/// A method to take instead.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BetterMethod {
    /// Method.
    pub method: String,
    /// Cells of the comparison.
    pub cells: usize,
    /// The largest of its errors.
    pub error: f64,
    /// The largest of the other's.
    pub instead_of: f64,
}

/// The coarsest mesh within 1 % of the pressure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CoarsestWithin {
    /// Method.
    pub method: String,
    /// Cells over the height.
    pub cells: usize,
    /// Whether a finer mesh is within it too.
    #[serde(default)]
    pub is_confirmed: bool,
    /// Shortest wall time, s, beside other runs.
    pub seconds: f64,
}

impl ConvergesFinding {
    pub(super) fn new(results: &[StudyResults<'_>]) -> Option<Self> {
        let is_small = |case: &Case| {
            let scene = case.scene;
            !scene.is_large_strain() && !scene.waves && !scene.body.is_plane() && scene.is_loaded()
        };
        let is_large = |case: &Case| case.scene.is_large_strain();
        let columns = [refined_column(results, &is_small), refined_column(results, &is_large)];
        let columns: Vec<ColumnFinding> = columns.into_iter().flatten().collect();
        if columns.is_empty() {
            return None;
        }
        let is_alone = !results.iter().any(|one| one.study.is_race || one.study.timing_repeats > 1);
        Some(Self { cells: QUOTED_CELLS, is_alone, columns })
    }
}

/// The column of the study that tells most about the paper's method and some others.
fn refined_column(results: &[StudyResults<'_>], fits: &dyn Fn(&Case) -> bool) -> Option<ColumnFinding> {
    let most = study_with_most(results, |one| {
        let refined = Refined::new(one, fits)?;
        let (method, path) = refined.chosen();
        let methods = refined.methods.len().min(ENOUGH_METHODS);
        let (is_quoted, settled, levels) = refined.worth(path);
        let worth = (method == PAPERS, is_quoted, methods, settled, levels);
        Some((worth, refined))
    });
    most.map(|(_, refined)| refined.finding())
}

/// Methods with their runs on the meshes of one column.
struct Refined<'b, 'a> {
    results: &'b StudyResults<'a>,
    /// Methods with their runs from coarse to fine.
    methods: Vec<(String, Path<'a>)>,
    time_factor: f64,
    reference: &'static str,
}

impl<'b, 'a> Refined<'b, 'a> {
    /// The plain runs of a study in one dimension, on the column of the first of them.
    fn new(results: &'b StudyResults<'a>, fits: impl Fn(&Case) -> bool) -> Option<Self> {
        let mut paths = results.refined(Axis::Cells);
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
        let (time_factor, reference) = (shown_time(&paths)?, results.study.references.first()?.name());
        let mut refined = Self { results, methods: Vec::new(), time_factor, reference };
        for (method, paths) in grouped(paths, |path| path.records[0].case.method.to_string()) {
            // Of several integrators the first with most orders that are settled.
            let worth = |path: &Path<'_>| refined.worth(path);
            let best = paths.into_iter().reduce(|a, b| if worth(&b) > worth(&a) { b } else { a });
            refined.methods.extend(best.map(|path| (method, path)));
        }
        Some(refined)
    }

    /// How much a method's runs tell: whether the quoted mesh is among them, settled orders, levels.
    fn worth(&self, path: &Path<'_>) -> (bool, usize, usize) {
        let is_quoted = path.records.iter().any(|record| record.case.cells == QUOTED_CELLS);
        let settled = CONVERGENCE.iter().filter(|measured| self.order(path, **measured).is_settled);
        (is_quoted, settled.count(), path.records.len())
    }

    /// The paper's method, or the first.
    fn chosen(&self) -> &(String, Path<'a>) {
        self.methods.iter().find(|(method, _)| method == PAPERS).unwrap_or(&self.methods[0])
    }

    fn finding(&self) -> ColumnFinding {
        let (method, path) = self.chosen();
        let case = &path.records[0].case;
        let orders = MAIN.map(|measured| self.order(path, measured)).to_vec();
        let strain = || 1.0 - elementary::exp(-case.column.load / case.material.oedometric_modulus());
        let of_method = |(method, path): &(String, Path<'a>)| MethodOrders {
            method: method.clone(),
            orders: CONVERGENCE.map(|measured| self.order(path, measured)).to_vec(),
            largest_error: self.largest_error(path),
        };
        ColumnFinding {
            study: self.results.study.name.clone(),
            final_strain: case.scene.is_large_strain().then(strain),
            reference: self.reference.to_owned(),
            time_factor: self.time_factor,
            method: method.clone(),
            is_papers: method == PAPERS,
            is_settled: orders.iter().all(|order| order.is_settled),
            figure: ErrorFigure::over_the_mesh(self.results, MAIN[0], self.time_factor),
            orders,
            methods: self.methods.iter().map(of_method).collect(),
            better: self.better(),
            within: self.within(),
        }
    }

    fn order(&self, path: &Path<'_>, measured: Measured) -> OrderFinding {
        let found = path.summary(&self.measure(path, measured)).classification;
        OrderFinding {
            quantity: measured.0,
            sample: measured.1,
            class: found.class,
            order: found.order,
            is_settled: found.class.is_settled(),
            error: self.error(path, measured, QUOTED_CELLS),
        }
    }

    /// A method's error on a mesh.
    fn error(&self, path: &Path<'_>, measured: Measured, cells: usize) -> Option<f64> {
        let record = path.records.iter().find(|record| record.case.cells == cells)?;
        Some(self.measure(path, measured).error(record)?.value.abs())
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

    /// The largest of the main errors of a run.
    fn largest_of(&self, path: &Path<'_>, record: &Record) -> Option<f64> {
        let errors = MAIN.map(|measured| Some(self.measure(path, measured).error(record)?.value.abs()));
        errors.into_iter().collect::<Option<Vec<f64>>>().and_then(largest).filter(|error| error.is_finite())
    }

    /// The largest of a method's main errors on that mesh.
    fn largest_error(&self, path: &Path<'_>) -> Option<f64> {
        let cells = self.finest_cells();
        let record = path.records.iter().find(|record| record.case.cells == cells)?;
        self.largest_of(path, record)
    }

    /// The runs of a path on the meshes from which on an error stays within a tolerance, and whether a finer one confirms it.
    fn reaching(
        &self,
        path: &Path<'a>,
        tolerance: f64,
        error: impl Fn(&Record) -> Option<f64>,
    ) -> Vec<(&'a Record, bool)> {
        let runs = path.records.iter().copied();
        let quoted = QuotedRuns::new(runs.clone(), &self.results.study.case_expectations, error);
        let reaching = quoted.reaching(tolerance);
        runs.filter_map(|record| Some((record, *reaching.get(record.hash.as_str())?))).collect()
    }

    /// The method with the least of the largest errors, where that is at most half that of the chosen one on the same mesh and
    /// on all finer ones.
    fn better(&self) -> Option<BetterMethod> {
        let instead_of = self.largest_error(&self.chosen().1)?;
        let cells = self.finest_cells();
        let stays_better = |path: &Path<'a>| {
            let reaching = self.reaching(path, 0.5 * instead_of, |record| self.largest_of(path, record));
            reaching.iter().any(|(record, _)| record.case.cells == cells)
        };
        let better = self.methods.iter().filter(|(_, path)| stays_better(path));
        let errors = better.filter_map(|(method, path)| Some((method, self.largest_error(path)?)));
        let (method, error) = errors.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(BetterMethod { method: method.clone(), cells, error, instead_of })
    }

    /// The coarsest mesh from which on each method's pressure is within 1 %, the cheapest first; single times are too rough to
    /// choose by.
    fn within(&self) -> Vec<CoarsestWithin> {
        let within = self.methods.iter().filter_map(|(method, path)| {
            let measure = self.measure(path, MAIN[0]);
            let reaching = self.reaching(path, WITHIN, |record| Some(measure.error(record)?.value));
            let (run, is_confirmed) = *reaching.first()?;
            let seconds = run.wall.iter().map(|sample| sample.seconds).reduce(f64::min)?;
            Some(CoarsestWithin { method: method.clone(), cells: run.case.cells, is_confirmed, seconds })
        });
        let mut within: Vec<CoarsestWithin> = within.collect();
        within.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        within
    }
}

/// Whether a case is of the scene's own equations, on regular points, however it is integrated.
fn is_plain(case: &Case) -> bool {
    let variant = case.variant();
    variant.is_empty() || variant.split(", ").all(|part| part.ends_with(" drag"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::case::planned::Tier;
    use crate::record::WallSample;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['GIMP', 'GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n[[sweep]]\n\
        method = ['MPM']\nintegrator = ['implicit']\ncells = [40]\n";

    /// What is found of errors of second order, by their sizes on twenty cells: pressure, effective stress and settlement of
    /// the three methods, with the seconds of each.
    fn found(errors: [[f64; 3]; 3]) -> ColumnFinding {
        let mut records: Vec<Record> = records_of(STUDY);
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
            let sample = |seconds: f64| WallSample { seconds, ..WallSample::default() };
            record.wall = [[9.0, 8.0], [0.3, 0.2], [0.1, 0.4]][place].map(sample).to_vec();
        }
        let study = study_of("s", STUDY);
        let finding = ConvergesFinding::new(&[StudyResults::new(&study, &records, Tier::Full)]);
        finding.expect("three methods").columns.remove(0)
    }

    #[test]
    fn a_method_is_better_where_its_largest_error_on_the_finest_mesh_of_all_is_half_as_large() {
        let better = |papers: [f64; 3], other: [f64; 3]| found([[0.9; 3], papers, other]).better;
        for papers in [[0.2, 0.01, 0.1], [0.1, 0.2, 0.01], [0.01, 0.1, 0.2]] {
            for other in [[0.1, 0.05, 0.01], [0.05, 0.1, 0.0], [0.0, 0.05, 0.1]] {
                let told = better(papers, other).expect("half as large");
                let (error, instead_of) = (told.error, told.instead_of);
                assert!((error - 0.1).abs() < 1e-12 && (instead_of - 0.2).abs() < 1e-12, "{told:?}");
                // That of the paper's method, though another ran on 40.
                assert_eq!((told.method.as_str(), told.cells), ("MPM", 20));
                assert_eq!(better(papers, other.map(|error| 1.02 * error)), None, "it is not half as large");
            }
        }
        assert_eq!(better([0.1; 3], [f64::NAN, 0.01, 0.01]), None, "no number is no small one");
    }

    #[test]
    fn the_coarsest_mesh_within_a_percent_is_found_the_cheapest_method_first() {
        let within = |papers: f64, other: f64| {
            let within = found([[0.9; 3], [papers; 3], [other; 3]]).within.into_iter();
            within.map(|one| (one.method, one.cells, one.seconds)).collect::<Vec<_>>()
        };
        let [other, papers] = ["MPM", PAPERS].map(str::to_owned);
        assert_eq!(within(0.01, 0.02), [(other, 40, 0.1), (papers.clone(), 20, 0.2)]);
        assert_eq!(within(0.002, 0.05), [(papers, 10, 0.2)]);
        assert_eq!(within(0.011, 0.05), []);
    }

    #[test]
    fn orders_and_errors_stand_under_their_quantities() {
        let column = found([[0.5; 3], [0.01, 0.02, 0.03], [0.1; 3]]);
        assert_eq!((column.method.as_str(), column.is_papers, column.is_settled), (PAPERS, true, true));
        let papers = column.methods.iter().find(|one| one.method == PAPERS).expect("the paper's");
        let errors: Vec<f64> = papers.orders.iter().filter_map(|order| order.error).collect();
        // On ten cells four times the error.
        assert!(errors.iter().zip([0.04, 4e-9, 0.08, 0.12]).all(|(a, b)| (a / b - 1.0).abs() < 1e-12));
        assert!(papers.orders.iter().all(|order| (order.order.unwrap_or(0.0) - 2.0).abs() < 1e-9));
        assert!((papers.largest_error.expect("three errors") - 0.03).abs() < 1e-12);
    }
}
