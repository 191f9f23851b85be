//! The results that are scored: read, their times matched, each held against the references.

use crate::case::Case;
use crate::case::quantity::Quantity;
use crate::cli::exit::{Ended, Exit};
use crate::exact::parameters::ColumnParameters;
use crate::exact::reference::ReferenceKind;
use crate::import::mapping::Mapping;
use crate::import::sample_row::SolvedBody;
use crate::import::table::{SampledState, states_of};
use crate::judge::score::completeness::{Whole, missing_times, uneven_meshes};
use crate::judge::score::diagnosis::diagnosis;
use crate::judge::score::score_series::{ScoredSeries, series_of};
use crate::judge::score::times::TimeGroups;
use crate::judge::score::times::time_factors;
use crate::judge::score::{Score, score};
use crate::scene::column::column_parameters;
use std::path::PathBuf;

/// What results are held against, and how they are read.
pub struct Held<'a> {
    /// The scene's column.
    pub case: &'a Case,
    /// Meaning of the columns.
    pub mapping: &'a Mapping,
    /// References, the scene's own first.
    pub references: &'a [ReferenceKind],
    /// Time factors that were asked for; none for all there are.
    pub requested: &'a [f64],
    /// How far, relative, a time may lie from the one that it stands for.
    pub tolerance: f64,
}

/// One result.
pub struct Read {
    files: Vec<PathBuf>,
    /// Cells over the height, where they were told.
    cells: Option<usize>,
    states: Vec<SampledState>,
    /// What it came to.
    pub score: Score,
    /// What is not there to be seen.
    pub notes: Vec<String>,
}

/// All results, in the order in which they were given.
pub struct Results {
    /// Each.
    pub all: Vec<Read>,
    /// Their places from the coarsest mesh to the finest.
    order: Vec<usize>,
    /// Their times, in that order.
    times: TimeGroups,
    /// Whether times were asked for.
    is_requested: bool,
}

impl Results {
    /// Reads and scores the files: one result, or with numbers of cells one a file.
    pub fn of(files: &[PathBuf], cells: Option<&str>, held: &Held) -> anyhow::Result<Self> {
        let parameters = column_parameters(&held.case.column, &held.case.material);
        let mut all = match cells {
            None => vec![Read::of(files.to_vec(), None, held)?],
            Some(typed) => cells_of(typed, files.len())?
                .into_iter()
                .zip(files)
                .map(|(cells, file)| Read::of(vec![file.clone()], Some(cells), held))
                .collect::<anyhow::Result<_>>()?,
        };
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by_key(|place| all[*place].cells);
        let times_of = |all: &[Read]| {
            let lists: Vec<Vec<f64>> =
                order.iter().map(|place| time_factors(&parameters, &all[*place].states)).collect();
            TimeGroups::of(held.requested, &lists, held.tolerance)
        };
        let mut times = times_of(&all);
        for (rank, place) in order.iter().enumerate() {
            let one = &mut all[*place];
            let has = time_factors(&parameters, &one.states);
            let asked = !held.requested.is_empty();
            one.score.warnings.extend(missing_times(&times.missing(rank), &has, asked));
            if asked {
                let mut wanted = times.groups[rank].iter().map(Option::is_some);
                one.states.retain(|_| wanted.next().unwrap_or(false));
            }
        }
        if all.iter().all(|one| one.states.is_empty()) {
            let missing = all.iter().find_map(|one| one.score.warnings.first());
            let sentence = missing.map_or("", |finding| finding.sentence.as_str());
            return Err(Ended::with(
                Exit::NothingSelected,
                format!(
                    "no time is one of those asked for: {sentence}; --time-tolerance says how near is near"
                ),
            ));
        }
        if !held.requested.is_empty() {
            times = times_of(&all);
        }
        for one in &mut all {
            one.assess(held, &parameters)?;
        }
        let results = Self { all, order, times, is_requested: !held.requested.is_empty() };
        Ok(results.with_uneven_meshes(&parameters))
    }

    /// With what shows only beside other meshes.
    fn with_uneven_meshes(mut self, parameters: &ColumnParameters) -> Self {
        let meshes: Vec<(usize, &SampledState)> = self
            .order
            .iter()
            .filter_map(|place| Some((self.all[*place].cells?, self.all[*place].states.first()?)))
            .collect();
        if meshes.len() == self.all.len()
            && let Some((rank, finding)) = uneven_meshes(&meshes, parameters)
        {
            let place = self.order[rank];
            self.all[place].score.warnings.push(finding);
        }
        self
    }

    /// Whether anything tells which times must be there: a request, or other meshes.
    pub fn are_times_known(&self) -> bool {
        self.is_requested || self.all.len() > 1
    }

    /// The scores.
    pub fn scores(&self) -> Vec<&Score> {
        self.all.iter().map(|one| &one.score).collect()
    }

    /// The series over meshes with their numbers of cells, where those were told.
    pub fn series(&self, case: &Case) -> Option<(Vec<ScoredSeries>, Vec<usize>)> {
        let levels: Vec<(usize, &Score)> = self
            .order
            .iter()
            .map(|place| Some((self.all[*place].cells?, &self.all[*place].score)))
            .collect::<Option<_>>()?;
        let cells = levels.iter().map(|(cells, _)| *cells).collect();
        Some((series_of(&levels, &self.times, case.column.height), cells))
    }
}

impl Read {
    fn of(files: Vec<PathBuf>, cells: Option<usize>, held: &Held) -> anyhow::Result<Self> {
        let column = &held.case.column;
        let frame = SolvedBody {
            height: column.height,
            length: held.case.scene.has_plane_fields().then_some(column.horizontal_extent),
            seconds_per_time_factor: held.case.seconds_per_time_factor(),
        };
        let states = states_of(&files, held.mapping, frame)?;
        Ok(Self { files, cells, states, score: Score::default(), notes: Vec::new() })
    }

    /// Its files.
    pub fn name(&self) -> String {
        self.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ")
    }

    /// Holds it against the references and asks whether it is whole.
    fn assess(&mut self, held: &Held, parameters: &ColumnParameters) -> anyhow::Result<()> {
        let missing = std::mem::take(&mut self.score.warnings);
        self.score = score(parameters, held.references, &self.states, held.mapping.sample)?;
        self.score.warnings = missing;
        if let Some(own) = held.references.first() {
            let column = &held.case.column;
            let of_scene = match held.mapping.whole_volume {
                Some(volume) => vec![volume],
                None if held.case.scene.has_plane_fields() => vec![column.volume()],
                None => vec![column.height, column.height * column.horizontal_extent],
            };
            let whole = Whole {
                parameters,
                reference: *own,
                volumes: &of_scene,
                is_declared: held.mapping.whole_volume.is_some(),
                has_volumes: held.mapping.columns.volume.is_some(),
            };
            self.score.warnings.extend(whole.findings(&self.states)?);
            self.notes.extend(whole.unit_of_volume(&self.states));
            self.notes.extend(whole.profiles(&self.states));
            self.score.diagnosis = diagnosis(parameters, *own, &self.states, held.mapping)?;
        }
        self.note_absences(held);
        Ok(())
    }

    /// What a reader might look for in vain.
    fn note_absences(&mut self, held: &Held) {
        let has = |quantity: Quantity| self.score.errors.iter().any(|row| row.quantity == quantity);
        let is_plane = held.case.scene.has_plane_fields();
        if has(Quantity::Displacement) && !has(Quantity::Settlement) {
            let place =
                if is_plane { "on the surface under the crest of the load" } else { "on the surface" };
            self.notes.push(format!("no settlement is judged, for no sample lies {place}"));
        }
        let first = self.states.first();
        if is_plane
            && has(Quantity::Displacement)
            && first.is_some_and(|state| state.horizontal_displacement.is_empty())
        {
            self.notes.push(
                "there is no u_x: the displacement is judged by its vertical component alone".to_owned(),
            );
        }
    }
}

/// Numbers of cells, one a result.
fn cells_of(typed: &str, results: usize) -> anyhow::Result<Vec<usize>> {
    let cells: Vec<usize> = typed
        .split(',')
        .map(|entry| entry.trim().parse().ok().filter(|cells| *cells > 0))
        .collect::<Option<_>>()
        .ok_or_else(|| Ended::usage(format!("`--cells {typed}` is no list of numbers from 1 on")))?;
    if cells.len() == results {
        return Ok(cells);
    }
    Err(Ended::usage(format!(
        "`--cells {typed}` has {} numbers for {results} results: give one a result",
        cells.len()
    )))
}
