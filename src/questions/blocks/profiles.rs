//! Isochrones of the pore pressure and the degree of consolidation beside theory's.

use crate::case::quantity::{Norm, Quantity, Sample};
use crate::judge::paths::{first_measure, grouped};
use crate::measure::statistics::largest;
use crate::measure::theory::{
    computed_consolidation, computed_isochrone, constant_recovery_error, theory_consolidation,
    theory_isochrones,
};
use crate::questions::answers::QUOTED_CELLS;
use crate::questions::blocks::Point;
use crate::questions::study_results::StudyResults;
use crate::record::{Record, Status};
use oedometer_exact::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_scenes::scene::{Clock, Question};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Points per cell of the runs whose profiles are drawn: the first of these that a study has.
const SHOWN_POINTS: [usize; 2] = [2, 4];

/// The profiles of a column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProfilesFinding {
    /// Cells over the height of all runs that are shown.
    pub cells: usize,
    /// Isochrones of the first and of the last method.
    pub isochrones: Vec<Isochrones>,
    /// Degree of consolidation of every method, where the methods differ.
    pub consolidation: Option<Consolidation>,
    /// What the sampling points do to the order.
    pub sampling: Option<SamplingFinding>,
}

/// Isochrones of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Isochrones {
    /// Method.
    pub method: String,
    /// Cells over the height.
    pub cells: usize,
    /// Places of the computed pressures; `None` for material points of this program.
    pub sample: Option<Sample>,
    /// Reference.
    pub reference: String,
    /// Whether strains are large, so that the degree of consolidation is the measure of progress.
    #[serde(default)]
    pub is_large_strain: bool,
    /// Whether lines cross, because waves run.
    #[serde(default)]
    pub has_waves: bool,
    /// One per output, or a few from the first to the last.
    pub curves: Vec<Isochrone>,
}

/// The pressure of a run and of theory at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Isochrone {
    /// Time factor.
    pub time_factor: f64,
    /// Theory's degree of consolidation by settlement.
    pub degree: f64,
    /// Theory: `p/q` and depth over the height.
    pub theory: Vec<Point>,
    /// The run: `p/q` and depth over the height.
    pub computed: Vec<Point>,
}

/// Degree of consolidation by settlement of several runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Consolidation {
    /// Reference.
    pub reference: String,
    /// Theory: time factor and degree.
    pub theory: Vec<Point>,
    /// The runs, thinned to as many as are marked.
    pub runs: Vec<ConsolidationRun>,
}

/// Degree of consolidation of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConsolidationRun {
    /// Method.
    pub method: String,
    /// Time factor and degree.
    pub points: Vec<Point>,
}

/// Why a constant in each cell is of first order at the points and of second at the centres, with numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SamplingFinding {
    /// Method.
    pub method: String,
    /// Time factor.
    pub time_factor: f64,
    /// Points in a cell.
    pub points_per_cell: usize,
    /// Error of the pressure at the centres.
    pub at_centres: f64,
    /// Error of the pressure at the points.
    pub at_points: f64,
    /// What the slope of the slowest mode must leave at the points.
    pub predicted: f64,
}

impl ProfilesFinding {
    /// Profiles of the runs of a study on the paper's mesh, one run per method; `None` for a study of one method or of a
    /// plane.
    ///
    /// # Errors
    /// When the reference refuses a case.
    pub fn new(results: &StudyResults<'_>) -> Result<Option<Self>, ExactError> {
        let scene = results.study.scene;
        let shown = shown_records(results.records, scene.question == Question::Layers);
        if shown.len() < 2 || scene.body.is_plane() {
            return Ok(None);
        }
        let own = results.study.references[0];
        // The first and the last method of the study: the plainest and the paper's.
        let ends = shown.first().into_iter().chain(shown.last());
        let isochrones = ends.map(|record| Isochrones::new(record, own)).collect::<Result<_, _>>()?;
        // A half-space has no settlement in the end.
        let is_half_space = scene.clock == Clock::HalfSpace;
        let consolidation = if is_half_space || coincide(results, &shown) {
            None
        } else {
            Some(Consolidation::new(&shown, own)?)
        };
        let has_one_soil = shown[0].case.column.soils.is_empty();
        let sampling = if !is_half_space && has_one_soil { sampling(&shown) } else { None };
        Ok(Some(Self { cells: shown[0].case.cells, isochrones, consolidation, sampling }))
    }
}

impl Isochrones {
    /// The paper's Figs 3a and 4a: `p/q` against depth.
    ///
    /// # Errors
    /// When the reference refuses the case.
    pub fn new(record: &Record, own: ReferenceKind) -> Result<Self, ExactError> {
        let curves = few(theory_isochrones(&record.case, own)?).into_iter().map(|theory| Isochrone {
            time_factor: theory.time_factor,
            degree: theory.degree,
            computed: computed_isochrone(record, theory.time_factor),
            theory: theory.line,
        });
        Ok(Self {
            method: record.case.method.to_string(),
            cells: record.case.cells,
            sample: (!record.case.has_integrator()).then(|| record.main_sample()),
            reference: own.name().to_owned(),
            is_large_strain: record.case.scene.is_large_strain(),
            has_waves: record.case.scene.waves,
            curves: curves.collect(),
        })
    }
}

impl Consolidation {
    /// The paper's Figs 3b and 4b: degree of consolidation against the time factor.
    ///
    /// # Errors
    /// When the reference refuses a case.
    pub fn new(shown: &[&Record], own: ReferenceKind) -> Result<Self, ExactError> {
        let ends = shown.iter().filter_map(|record| record.case.time_factors.last());
        let end = ends.copied().reduce(f64::max).unwrap_or(1.0);
        let runs = shown.iter().enumerate().map(|(slot, record)| ConsolidationRun {
            method: record.case.method.to_string(),
            points: thinned(&computed_consolidation(record), slot, shown.len()),
        });
        Ok(Self {
            reference: own.name().to_owned(),
            theory: theory_consolidation(&shown[0].case, own, end)?,
            runs: runs.collect(),
        })
    }
}

/// Relative difference up to which settlements share one marker.
const ONE_MARKER: f64 = 0.01;

/// Whether the settlements of all runs coincide at every output, so that their curves show no difference.
fn coincide(results: &StudyResults<'_>, shown: &[&Record]) -> bool {
    let own = results.study.references[0].name();
    shown[0].case.time_factors.iter().all(|time| {
        let measure = first_measure(Quantity::Settlement, Sample::Surface, own, *time);
        let errors = shown.iter().filter_map(|record| Some(measure.error(record)?.value));
        // Numbers that are none differ from all.
        let highest = |sign: f64| largest(errors.clone().map(|error| sign * error));
        highest(1.0).zip(highest(-1.0)).is_none_or(|(high, low)| high + low < ONE_MARKER)
    })
}

/// The first sound run of each method on the paper's mesh; where pressures have a kink, on the coarsest of the study.
fn shown_records(records: &[Record], has_kink: bool) -> Vec<&Record> {
    let coarsest = records.iter().map(|record| record.case.cells).min().filter(|_| has_kink);
    let cells = coarsest.unwrap_or(QUOTED_CELLS);
    let is_sound = |record: &&Record| record.case.cells == cells && record.status == Status::Ok;
    let with =
        |points: &usize| records.iter().filter(is_sound).any(|record| record.case.points_per_cell == *points);
    let points_per_cell = SHOWN_POINTS.into_iter().find(with);
    let is_shown =
        |record: &&Record| is_sound(record) && Some(record.case.points_per_cell) == points_per_cell;
    let runs = records.iter().filter(is_shown);
    grouped(runs, |record| record.case.method.to_string()).into_iter().map(|(_, own)| own[0]).collect()
}

/// Most isochrones of a figure: as many as a reader tells apart.
const MOST_CURVES: usize = 6;

/// A few of many items, evenly spread, with the first and the last.
fn few<T>(items: Vec<T>) -> Vec<T> {
    let last = items.len().saturating_sub(1);
    let kept: Vec<usize> = (0..MOST_CURVES).map(|place| (place * last).div_ceil(MOST_CURVES - 1)).collect();
    let is_kept = |place: usize| last < MOST_CURVES || kept.contains(&place);
    items.into_iter().enumerate().filter(|(place, _)| is_kept(*place)).map(|(_, item)| item).collect()
}

/// Markers of one run on a curve of consolidation.
const MARKERS: usize = 12;

/// Every so many of the points, with those of other runs between them, so that the line is seen and no run hides
/// another.
fn thinned(points: &[(f64, f64)], slot: usize, runs: usize) -> Vec<(f64, f64)> {
    let stride = (points.len() / MARKERS).max(1);
    let first = stride * slot / runs.max(1);
    points.iter().skip(first).step_by(stride).copied().collect()
}

fn sampling(shown: &[&Record]) -> Option<SamplingFinding> {
    let record = shown
        .iter()
        .find(|record| record.case.method.built_in().is_some_and(|method| method.has_constant_recovery()))?;
    let own = record.references.first()?.name.as_str();
    let time_factor = *record.case.time_factors.iter().rfind(|factor| **factor <= 0.2)?;
    let error =
        |sample| record.error(Quantity::Pressure, sample, Norm::L2, own, time_factor).map(|row| row.value);
    Some(SamplingFinding {
        method: record.case.method.to_string(),
        time_factor,
        points_per_cell: record.case.points_per_cell,
        at_centres: error(Sample::Centres)?,
        at_points: error(Sample::Points)?,
        predicted: constant_recovery_error(&record.case),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    const TIMES: [f64; 3] = [0.05, 0.1, 0.2];

    #[test]
    fn curves_coincide_where_they_do_so_at_every_output_and_for_every_method() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.1, 0.2]\n[[sweep]]\n\
                    method = ['MPM', 'GIMP', 'GIMP-SRI']\nintegrator = ['implicit']\ncells = [10]\n\
                    time_step = [{ growth = 0.5 }]\n";
        let (study, records) = solved("t", text);
        // Errors of the settlement, by method and output.
        let found = |errors: [[f64; 3]; 3]| {
            let mut records = records.clone();
            for (record, errors) in records.iter_mut().zip(errors) {
                for row in record.errors.iter_mut().filter(|row| row.quantity == Quantity::Settlement) {
                    let place = TIMES.iter().position(|time| *time == row.time_factor).expect("an output");
                    row.value = errors[place];
                }
            }
            let results = StudyResults::new(&study, &records, Tier::Full);
            let shown = shown_records(&records, false);
            assert_eq!(shown.len(), 3);
            let profiles = ProfilesFinding::new(&results).expect("theory").expect("three methods");
            let drawn = profiles.consolidation.is_some();
            let answer = coincide(&results, &shown);
            assert_eq!(drawn, !answer, "the figure shows the difference");
            answer
        };
        // All are off alike, and more at one output than at another.
        let alike = [[0.2, -0.3, 0.01]; 3];
        assert!(found(alike));
        for (method, output) in (0..3).flat_map(|method| (0..3).map(move |output| (method, output))) {
            for (change, coincide) in
                [(0.02, false), (-0.02, false), (0.005, true), (-0.005, true), (f64::NAN, false)]
            {
                let mut errors = alike;
                errors[method][output] += change;
                assert_eq!(found(errors), coincide, "{method} {output} {change}");
            }
        }
    }

    #[test]
    fn six_isochrones_of_many_are_shown_with_the_first_and_the_last() {
        let shown = |count: usize| few((0..count).collect());
        assert_eq!(shown(6), [0, 1, 2, 3, 4, 5]);
        assert_eq!(shown(7), [0, 2, 3, 4, 5, 6]);
        assert_eq!(shown(12), [0, 3, 5, 7, 9, 11]);
        assert_eq!([shown(0), shown(1)], [vec![], vec![0]]);
    }

    #[test]
    fn markers_of_runs_are_thinned_and_stand_beside_each_other() {
        let points: Vec<(f64, f64)> = (0..48).map(|place| (f64::from(place), 0.0)).collect();
        let places = |slot: usize, runs: usize, count: usize| -> Vec<f64> {
            thinned(&points[..count], slot, runs).into_iter().map(|point| point.0).collect()
        };
        assert_eq!(places(0, 1, 48), (0..12).map(|marker| f64::from(4 * marker)).collect::<Vec<_>>());
        assert_eq!([places(0, 2, 48)[0], places(1, 2, 48)[0], places(3, 4, 48)[0]], [0.0, 2.0, 3.0]);
        assert_eq!(places(1, 2, 5), [0.0, 1.0, 2.0, 3.0, 4.0], "few are all shown");
    }

    #[test]
    fn the_first_sound_run_of_each_method_is_shown_on_ten_cells_or_the_coarsest() {
        let of = |methods: &str, more: &str| {
            solved(
                "t",
                &format!(
                    "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = {methods}\n\
                     integrator = ['implicit']\ncells = [5, 10]\ntime_step = [{{ growth = 0.5 }}]\n{more}\n"
                ),
            )
        };
        let shown = |records: &[Record], has_kink: bool| {
            let case = |record: &&Record| {
                (record.case.method.to_string(), record.case.cells, record.case.points_per_cell)
            };
            shown_records(records, has_kink).iter().map(case).collect::<Vec<_>>()
        };
        let is = |method: &str, cells: usize, points: usize| (method.to_owned(), cells, points);
        let (_, mut points) = of("['MPM', 'GIMP']", "points_per_cell = [3, 4, 2]");
        assert_eq!(shown(&points, false), [is("MPM", 10, 2), is("GIMP", 10, 2)]);
        assert_eq!(shown(&points, true), [is("MPM", 5, 2), is("GIMP", 5, 2)], "kinks show on the coarsest");
        points.retain(|record| record.case.points_per_cell != 2);
        assert_eq!(shown(&points, false), [is("MPM", 10, 4), is("GIMP", 10, 4)]);
        points.retain(|record| record.case.points_per_cell != 4);
        assert_eq!(shown(&points, false), []);
    }
}
