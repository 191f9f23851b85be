//! The results that are scored: read, their times matched, each held against the references.

use crate::case::Case;
use crate::case::quantity::Quantity;
use crate::cli::exit::{Ended, Exit};
use crate::import::expected::Expected;
use crate::import::mapping::Mapping;
use crate::import::opened_csv::not_ended;
use crate::import::runs::Run;
use crate::import::table::SampledState;
use crate::judge::score::completeness::interior_zeros;
use crate::judge::score::completeness::{Finding, Lack, Whole, missing_times, uneven_meshes};
use crate::judge::score::diagnosis::diagnosis;
use crate::judge::score::score_series::TimeGroups;
use crate::judge::score::score_series::time_factors;
use crate::judge::score::score_series::{ScoredSeries, series_of};
use crate::judge::score::{Score, score};
use crate::record::ErrorRow;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::scene::column::column_parameters;
use oedometer_soil::wording::short;
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
    /// Whether the files tell their cells, and not the user.
    pub are_cells_found: bool,
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
    expected: Expected,
    unended: Vec<PathBuf>,
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
    /// Whether the files tell their cells, and not the user.
    pub are_cells_found: bool,
}

impl Results {
    /// Scores runs, each with its number of cells where that was told or found.
    pub fn of(runs: Vec<Run>, held: &Held) -> anyhow::Result<Self> {
        let parameters = column_parameters(&held.case.column, &held.case.material);
        let mut all: Vec<Read> = runs.into_iter().map(Read::of).collect();
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
        let is_requested = !held.requested.is_empty();
        let are_cells_found = held.are_cells_found;
        let results = Self { all, order, times, is_requested, are_cells_found };
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

    /// The place of a result's error in the list of its series, and the result's cells: by what it is of, for the
    /// meshes have times of their own.
    pub fn series_of_row<'a>(
        &self,
        result: usize,
        row: &ErrorRow,
        series: &'a [ScoredSeries],
    ) -> Option<(usize, &'a ScoredSeries)> {
        let rank = self.order.iter().position(|place| *place == result)?;
        let one = &self.all[result];
        let time =
            one.score.samples.iter().position(|(time, _)| time.to_bits() == row.time_factor.to_bits())?;
        let group = self.times.groups[rank][time]?;
        let is_own = |series: &&ScoredSeries| {
            let of = &series.measure;
            series.group == group
                && (of.quantity, of.sample, of.norm) == (row.quantity, row.sample, row.norm)
                && of.reference == row.reference
        };
        Some((one.cells?, series.iter().find(is_own)?))
    }

    /// Puts the series into every score, for programs that read them.
    pub fn keep_series(&mut self, series: &[ScoredSeries], cells: &[usize]) {
        for one in &mut self.all {
            one.score.series = series.iter().map(|series| series.row(cells)).collect();
        }
    }

    /// The series over meshes with their numbers of cells, where those were told.
    pub fn series(&self, case: &Case) -> Option<(Vec<ScoredSeries>, Vec<usize>)> {
        let levels: Vec<(usize, &Score)> = self
            .order
            .iter()
            .map(|place| Some((self.all[*place].cells?, &self.all[*place].score)))
            .collect::<Option<_>>()?;
        let is_rising = levels.windows(2).all(|pair| pair[0].0 < pair[1].0);
        if (levels.len() < 2 || !is_rising) && self.are_cells_found {
            return None;
        }
        let cells = levels.iter().map(|(cells, _)| *cells).collect();
        Some((series_of(&levels, &self.times, case.column.height), cells))
    }
}

impl Read {
    fn of(run: Run) -> Self {
        let Run { files, cells, states, notes, expected, unended, .. } = run;
        Self { files, cells, states, score: Score::default(), notes, expected, unended }
    }

    /// Its files.
    pub fn name(&self) -> String {
        match &self.files[..] {
            [first, _, _, .., last] => {
                format!("{} … {} ({} files)", first.display(), last.display(), self.files.len())
            }
            files => files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", "),
        }
    }

    /// Holds it against the references and asks whether it is whole.
    fn assess(&mut self, held: &Held, parameters: &ColumnParameters) -> anyhow::Result<()> {
        let missing = std::mem::take(&mut self.score.warnings);
        self.score = score(parameters, held.references, &self.states, held.mapping.sample)?;
        self.score.warnings.splice(0..0, missing);
        self.score.warnings.extend(self.gone(parameters));
        self.score.warnings.extend(held.mapping.taken_for_granted().map(|taken| Finding {
            name: Lack::Undeclared,
            sentence: format!(
                "the mapping says nothing of {taken}: write into [units] and [sign] what the file has, for nothing \
                 is guessed from its numbers"
            ),
        }));
        if let Some(own) = held.references.first() {
            let column = &held.case.column;
            let of_scene = match held.mapping.whole_volume {
                Some(volume) => vec![volume],
                None if held.case.scene.has_plane_fields() => vec![column.volume()],
                None => vec![column.height, column.height * column.extent()],
            };
            let whole = Whole {
                parameters,
                reference: *own,
                volumes: &of_scene,
                is_declared: held.mapping.whole_volume.is_some(),
                has_volumes: held.mapping.columns.volume.is_some(),
            };
            self.score.warnings.extend(whole.findings(&self.states)?);
            self.score.warnings.extend(interior_zeros(parameters, &self.states));
            self.notes.extend(whole.unit_of_volume(&self.states));
            self.notes.extend(whole.profiles(&self.states));
            self.score.diagnosis = diagnosis(parameters, *own, &self.states, held.mapping)?;
        }
        self.note_absences(held);
        Ok(())
    }

    /// What is missing at a time that was scored, and tables that may be cut.
    fn gone(&self, parameters: &ColumnParameters) -> Vec<Finding> {
        let when = |place: usize| format!("T_v = {}", short(parameters.time_factor(self.states[place].time)));
        let absent = self.expected.absent(&self.states).into_iter();
        let absent = absent.map(|one| Finding { name: Lack::QuantityMissing, sentence: one.sentence(when) });
        let unended =
            self.unended.iter().map(|file| Finding { name: Lack::EndMissing, sentence: not_ended(file) });
        absent.chain(unended).collect()
    }

    /// What a reader might look for in vain.
    fn note_absences(&mut self, held: &Held) {
        let has = |quantity: Quantity| self.score.errors.iter().any(|row| row.quantity == quantity);
        let is_plane = held.case.scene.has_plane_fields();
        if has(Quantity::Displacement) && !has(Quantity::Settlement) {
            let why = if held.case.scene.has_plates() {
                "it is the plate's, which no sample has: [settlement] in the mapping takes a curve"
            } else if is_plane {
                "no sample lies on the surface under the crest of the load"
            } else {
                "no sample lies on the surface"
            };
            self.notes.push(format!("no settlement is judged, for {why}"));
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
