//! Does it reproduce the paper? The runs of the paper's method on the columns of Figs 3 and 4 of Zheng et al. (2021), and how
//! far they and the printed equations are from the exact solutions.

use crate::case::contender::PAPERS;
use crate::case::{Case, Quantity, Sample};
use crate::judge::paths::first_error;
use crate::questions::answers::QUOTED_CELLS;
use crate::questions::blocks::profiles::{Consolidation, Isochrones};
use crate::questions::published_equations::{LARGE_STRAIN_LOAD, PublishedEquations};
use crate::questions::study_results::StudyResults;
use crate::record::{Record, Status};
use oedometer_exact::ExactError;
use oedometer_scenes::column::Column;
use oedometer_scenes::{TERZAGHI, XIE_LEO};
use oedometer_soil::material::Material;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far the paper's figures are from theory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PaperFinding {
    /// Figs 3 and 4, as far as there are runs of them.
    pub figures: Vec<PaperFigure>,
    /// The curves of each, with theory's.
    #[serde(default)]
    pub curves: Vec<PaperCurves>,
    /// The printed equations against Xie & Leo's solution, with Fig. 4.
    pub printed: Option<PublishedEquations>,
}

/// The curves of one of the paper's columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PaperCurves {
    /// Number of the figure.
    pub number: u32,
    /// Pressure over depth.
    pub isochrones: Isochrones,
    /// Degree of consolidation, beside other methods.
    pub consolidation: Consolidation,
}

/// The pressure of one of the paper's columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PaperFigure {
    /// Number of the figure.
    pub number: u32,
    /// Study.
    pub study: String,
    /// Method: the paper's.
    pub method: String,
    /// Cells over the height: the paper's.
    pub cells: usize,
    /// Reference.
    pub reference: String,
    /// Largest relative L2 error of the pressure at the points over all outputs.
    pub error: f64,
    /// Time factor of that output.
    pub time_factor: f64,
}

/// The run of one of the paper's figures.
struct PaperRun<'b, 'a> {
    number: u32,
    results: &'b StudyResults<'a>,
    record: &'a Record,
}

/// Methods of a figure of consolidation, the paper's first.
const MOST_METHODS: usize = 3;

/// Number of the figure at large strain.
const LARGE_STRAIN_FIGURE: u32 = 4;

impl<'b, 'a> PaperRun<'b, 'a> {
    /// The sound run of the paper's method on the paper's mesh with most outputs, the first of equals.
    fn new(number: u32, results: &'b [StudyResults<'a>]) -> Option<Self> {
        let fits = |record: &&Record| {
            let case = &record.case;
            record.status == Status::Ok
                && record.stability.is_none()
                && case.method.to_string() == PAPERS
                && case.cells == QUOTED_CELLS
                && is_papers_column(case, number == LARGE_STRAIN_FIGURE)
                && case.variant().is_empty()
        };
        let of_study = |results: &'b StudyResults<'a>| {
            results.records.iter().filter(fits).map(move |record| Self { number, results, record })
        };
        let outputs = |run: &Self| run.record.case.time_factors.len();
        let all = results.iter().flat_map(of_study);
        all.reduce(|best, next| if outputs(&next) > outputs(&best) { next } else { best })
    }

    /// The run with those of other methods that differ in nothing else.
    fn beside(&self) -> Vec<&'a Record> {
        let mut shown = vec![self.record];
        for record in self.results.records {
            let mut same = record.case.clone();
            same.method = self.record.case.method;
            let is_new = shown.iter().all(|other| other.case.method != record.case.method);
            let is_sound = record.status == Status::Ok;
            if is_new && is_sound && same == self.record.case && shown.len() < MOST_METHODS {
                shown.push(record);
            }
        }
        shown
    }

    fn curves(&self) -> Result<PaperCurves, ExactError> {
        let own = self.results.study.references[0];
        Ok(PaperCurves {
            number: self.number,
            isochrones: Isochrones::new(self.record, own)?,
            consolidation: Consolidation::new(&self.beside(), own)?,
        })
    }

    /// Name of the scene's own reference.
    fn reference(&self) -> &'static str {
        self.results.study.references[0].name()
    }
}

/// The largest error of the pressure at the points over all outputs, and its time factor.
pub(crate) fn largest_pressure_error(record: &Record, reference: &str) -> Option<(f64, f64)> {
    let error = |time: &f64| first_error(record, Quantity::Pressure, Sample::Points, reference, *time);
    let errors = record.case.time_factors.iter().filter_map(|time| Some((error(time)?, *time)));
    errors.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether a case is of the soil, height and, at large strain, load of Figs 3 and 4.
fn is_papers_column(case: &Case, is_large: bool) -> bool {
    let (scene, load) = if is_large { (&XIE_LEO, LARGE_STRAIN_LOAD) } else { (&TERZAGHI, case.column.load) };
    let papers = Column { load, points: case.column.points, ..Column::default() };
    let soil =
        Material { law: case.material.law, continuity: case.material.continuity, ..Material::default() };
    case.scene == scene && *case.column == papers && *case.material == soil
}

impl PaperFinding {
    /// # Errors
    /// When an exact solution refuses the paper's column.
    pub(crate) fn new(results: &[StudyResults<'_>]) -> Result<Option<Self>, ExactError> {
        // Fig. 3 is at small strain.
        let figures = [3, LARGE_STRAIN_FIGURE].into_iter();
        let runs: Vec<_> = figures.filter_map(|number| PaperRun::new(number, results)).collect();
        if runs.is_empty() {
            return Ok(None);
        }
        let figure = |run: &PaperRun<'_, '_>| {
            let (error, time_factor) = largest_pressure_error(run.record, run.reference())?;
            Some(PaperFigure {
                number: run.number,
                study: run.results.study.name.clone(),
                method: PAPERS.to_owned(),
                cells: QUOTED_CELLS,
                reference: run.reference().to_owned(),
                error,
                time_factor,
            })
        };
        let is_large = runs.iter().any(|run| run.number == LARGE_STRAIN_FIGURE);
        let printed = if is_large { Some(PublishedEquations::new()?) } else { None };
        let curves = runs.iter().map(PaperRun::curves).collect::<Result<_, _>>()?;
        Ok(Some(Self { figures: runs.iter().filter_map(figure).collect(), curves, printed }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    #[test]
    fn only_the_papers_column_reproduces_the_paper() {
        for (scene, inputs, is_papers) in [
            ("terzaghi", "", true),
            ("xie-leo", "[column]\nload = 200e3", true),
            ("terzaghi", "[material]\nyoungs_modulus = 2e6", false),
            ("terzaghi", "[column]\nheight = 5.0", false),
            ("xie-leo", "[column]\nload = 100e3", false),
        ] {
            let text = format!(
                "title = 't'\nscene = '{scene}'\n{inputs}\n[output]\ntime_factors = [0.1]\n[[sweep]]\n\
                 method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n"
            );
            let (study, records) = solved("s", &text);
            let found = PaperFinding::new(&[StudyResults::new(&study, &records, Tier::Full)]);
            assert_eq!(found.expect("sound").is_some(), is_papers, "{scene} {inputs}");
        }
    }
}
