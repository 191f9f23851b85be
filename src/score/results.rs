//! Matches the times of the results to be scored and compares each with the references.

mod other_water;

use crate::case::{Case, Quantity, Sample};
use crate::import::mapping::Mapping;
use crate::import::nodes::counted_otherwise;
use crate::import::run::Run;
use crate::import::{Absent, SampledState, not_ended};
use crate::measure::round_off::SINGLE_PRECISION;
use crate::record::ErrorRow;
use crate::score::completeness::{Finding, Lack, Whole, interior_zeros, missing_times, uneven_meshes};
use crate::score::diagnosis::{SEVERAL_RUNS, diagnosis};
use crate::score::score_series::{ScoredSeries, TimeGroups, series_of, time_factors};
use crate::score::{Score, has_settlement, score};
use crate::study::asked::Asked;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::ReferenceKind;
use oedometer_scenes::scene::Body;
use oedometer_wording::rounded;

/// Why results have no score.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScoreError {
    /// No state is at a requested time.
    #[error("no state is at a requested time: {0}; --time-tolerance sets how far a time may differ")]
    NoTime(String),
    /// A reference refuses its inputs.
    #[error(transparent)]
    Exact(#[from] ExactError),
}

/// What results are compared with, and how.
pub struct Comparison<'a> {
    /// The case that was solved.
    pub case: &'a Case,
    /// Parameters of the references.
    pub parameters: ColumnParameters,
    /// Meaning of the columns.
    pub mapping: &'a Mapping,
    /// References, the scene's own first.
    pub references: &'a [ReferenceKind],
    /// Requested time factors; all if empty.
    pub requested: &'a [f64],
    /// Largest relative distance of a time from the one that it stands for.
    pub tolerance: f64,
    /// Whether the numbers of cells were found in the files, and not given by the user.
    pub are_cells_found: bool,
}

impl Asked {
    /// The comparison at every time there is, as the files' own numbers of cells have it.
    pub fn comparison<'a>(&'a self, mapping: &'a Mapping) -> Comparison<'a> {
        Comparison {
            case: self.case(),
            parameters: self.parameters,
            mapping,
            references: &self.references,
            requested: &self.requested,
            tolerance: 1e-3,
            are_cells_found: true,
        }
    }
}

/// One result with its score.
#[derive(Default)]
pub struct Scored {
    /// Its states and notes.
    pub run: Run,
    /// Its score.
    pub score: Score,
}

/// All results, in the order in which they were given.
pub struct Results<'a> {
    /// Each result.
    pub all: Vec<Scored>,
    /// Their places from the coarsest mesh to the finest.
    order: Vec<usize>,
    /// Their times, in that order.
    times: TimeGroups,
    comparison: &'a Comparison<'a>,
}

impl<'a> Results<'a> {
    /// Scores runs.
    ///
    /// # Errors
    /// When no run is at a requested time, or a reference refuses its inputs.
    pub fn of(runs: Vec<Run>, comparison: &'a Comparison<'a>) -> Result<Self, ScoreError> {
        let Comparison { parameters, requested, tolerance, .. } = comparison;
        let mut all: Vec<Scored> =
            runs.into_iter().map(|run| Scored { run, score: Score::default() }).collect();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by_key(|place| all[*place].run.cells);
        let times_of = |all: &[Scored]| {
            let times = |place: &usize| time_factors(parameters, &all[*place].run.states);
            TimeGroups::of(requested, &order.iter().map(times).collect::<Vec<_>>(), *tolerance)
        };
        let mut times = times_of(&all);
        let is_requested = !requested.is_empty();
        for (rank, place) in order.iter().enumerate() {
            let Scored { run, score } = &mut all[*place];
            let has = time_factors(parameters, &run.states);
            score.warnings.extend(missing_times(&times.missing(rank), &has, is_requested));
            if is_requested {
                let mut wanted = times.groups[rank].iter().map(Option::is_some);
                run.states.retain(|_| wanted.next().unwrap_or(false));
            }
        }
        if all.iter().all(|scored| scored.run.states.is_empty()) {
            let missing = all.iter().find_map(|scored| scored.score.warnings.first());
            let sentence = missing.map_or("", |finding| finding.sentence.as_str());
            return Err(ScoreError::NoTime(sentence.to_owned()));
        }
        if is_requested {
            times = times_of(&all);
        }
        for scored in &mut all {
            scored.assess(comparison, parameters)?;
        }
        let mut results = Self { all, order, times, comparison };
        results.compare_meshes(parameters);
        Ok(results)
    }

    /// Adds the findings on numbers of cells that were given, and those that show only beside other meshes.
    fn compare_meshes(&mut self, parameters: &ColumnParameters) {
        if !self.comparison.are_cells_found {
            self.doubt_cells(parameters.height);
        }
        self.find_identical();
        let first = |place: &usize| {
            let run = &self.all[*place].run;
            Some((run.cells?, run.states.first()?))
        };
        let meshes: Vec<(usize, &SampledState)> = self.order.iter().filter_map(first).collect();
        if meshes.len() == self.all.len()
            && let Some((rank, finding)) = uneven_meshes(&meshes, parameters)
        {
            self.all[self.order[rank]].score.warnings.push(finding);
        }
    }

    /// Doubts numbers of cells that are those of nodes, or of all cells; equal places on all meshes are a choice.
    fn doubt_cells(&mut self, height: f64) {
        let counts = |scored: &Scored| scored.run.states.first().map(|state| state.initial_height.len());
        let all: Vec<Option<usize>> = self.all.iter().map(counts).collect();
        if all.len() > 1 && all.iter().all(|count| *count == all[0]) {
            return;
        }
        for Scored { run, score } in &mut self.all {
            let Some((cells, state)) = run.cells.zip(run.states.first()) else { continue };
            let doubt = counted_otherwise(cells, &state.initial_height, height);
            score.warnings.extend(doubt.map(|sentence| Finding::new(Lack::CellsDoubtful, sentence)));
        }
    }

    /// Finds meshes with the numbers of a coarser one, unless both are exact.
    fn find_identical(&mut self) {
        for rank in 1..self.order.len() {
            let finest = &self.all[self.order[rank]];
            let is_exact = finest.score.errors.iter().all(|row| row.value.abs() < SINGLE_PRECISION);
            let has_same = |place: &&usize| {
                self.all[**place].run.states == finest.run.states
                    && self.all[**place].run.cells != finest.run.cells
            };
            if let Some(place) = self.order[..rank].iter().find(has_same).filter(|_| !is_exact) {
                let sentence = format!(
                    "its numbers are identical to those of {}: was a result copied, or the mesh not refined?",
                    self.all[*place].name()
                );
                self.all[self.order[rank]]
                    .score
                    .warnings
                    .push(Finding::new(Lack::ResultsIdentical, sentence));
            }
        }
    }

    /// Whether it is known which times must be there: from a request, or from other meshes.
    pub fn are_times_known(&self) -> bool {
        !self.comparison.requested.is_empty() || self.all.len() > 1
    }

    /// The scores.
    pub fn scores(&self) -> Vec<&Score> {
        self.all.iter().map(|scored| &scored.score).collect()
    }

    /// The series of a result's error and the result's cells. Meshes have times of their own, so the error is found by
    /// what it is of.
    pub fn series_of_row<'b>(
        &self,
        result: usize,
        row: &ErrorRow,
        series: &'b [ScoredSeries],
    ) -> Option<(usize, &'b ScoredSeries)> {
        let rank = self.order.iter().position(|place| *place == result)?;
        let scored = &self.all[result];
        let time =
            scored.score.samples.iter().position(|(time, _)| time.to_bits() == row.time_factor.to_bits())?;
        let group = self.times.groups[rank][time]?;
        let is_own = |series: &&ScoredSeries| {
            let of = &series.measure;
            series.group == group
                && (of.quantity, of.sample, of.norm) == (row.quantity, row.sample, row.norm)
                && of.reference == row.reference
        };
        Some((scored.run.cells?, series.iter().find(is_own)?))
    }

    /// The series over meshes, if their numbers of cells are known; every score keeps them, for programs that read it.
    pub fn join_meshes(&mut self) -> Option<Vec<ScoredSeries>> {
        let levels: Vec<(usize, &Score)> = self
            .order
            .iter()
            .map(|place| Some((self.all[*place].run.cells?, &self.all[*place].score)))
            .collect::<Option<_>>()?;
        let is_rising = levels.windows(2).all(|pair| pair[0].0 < pair[1].0);
        if (levels.len() < 2 || !is_rising) && self.comparison.are_cells_found {
            return None;
        }
        let series = series_of(&levels, &self.times, self.comparison.case.column.height);
        self.all.iter_mut().for_each(|scored| scored.score.series.clone_from(&series));
        Some(series)
    }
}

impl Scored {
    /// Its files.
    pub fn name(&self) -> String {
        match &self.run.files[..] {
            [first, _, _, .., last] => {
                format!("{} … {} ({} files)", first.display(), last.display(), self.run.files.len())
            }
            files => files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", "),
        }
    }

    /// Compares it with the references, and checks whether it is complete.
    fn assess(&mut self, held: &Comparison, parameters: &ColumnParameters) -> Result<(), ExactError> {
        let missing = std::mem::take(&mut self.score.warnings);
        let states = &self.run.states;
        self.score = score(parameters, held.references, states, held.mapping.sample)?;
        let is_judged = |quantity: &Quantity| !self.run.without.contains(quantity);
        self.score.errors.retain(|row| is_judged(&row.quantity));
        self.score.unresolved.retain(|output| is_judged(&output.quantity));
        self.score.warnings.splice(0..0, missing);
        self.score.warnings.extend(self.missing(parameters, held.mapping));
        self.score.warnings.extend(held.mapping.taken_for_granted(held.case.scene.body.is_plane()).map(
            |taken| Finding {
                name: Lack::Undeclared,
                sentence: format!(
                    "the mapping does not declare {taken}: write what the file uses into [units] and [sign], \
                 because nothing is guessed from its numbers"
                ),
            },
        ));
        if let Some(reference) = held.references.first() {
            let column = &held.case.column;
            let of_scene = match held.mapping.whole_volume {
                Some(volume) => vec![volume],
                None if matches!(reference, ReferenceKind::Textbook(_)) => Vec::new(),
                None if held.case.scene.body.is_plane() => vec![column.volume(held.case.cells)],
                None => {
                    let widths = [Some(1.0), Some(column.extent()), self.run.width];
                    widths.into_iter().flatten().map(|width| column.height * width).collect()
                }
            };
            let whole = Whole {
                parameters,
                reference: *reference,
                volumes: &of_scene,
                is_declared: held.mapping.whole_volume.is_some(),
                has_volumes: held.mapping.columns.volume.is_some(),
            };
            let changes = self.run.has_changing_mesh;
            let is_of_mesh = |finding: &Finding| changes && finding.name == Lack::SamplesDiffer;
            self.score
                .warnings
                .extend(whole.findings(states)?.into_iter().filter(|finding| !is_of_mesh(finding)));
            for set in beside_by_set(states) {
                self.score.warnings.extend(Whole { has_volumes: false, ..whole }.findings(&set)?);
            }
            self.score.warnings.extend(interior_zeros(parameters, *reference, states)?);
            self.run.notes.extend(whole.unit_of_volume(states));
            self.run.notes.extend(whole.profiles(states));
            let are_nodes = held.mapping.sample == Sample::Nodes;
            self.score.not_judged.extend(whole.end_without_sample(states, are_nodes));
            let sentences = diagnosis(parameters, *reference, states, held.mapping);
            let are_runs = sentences.iter().any(|sentence| sentence.contains(SEVERAL_RUNS));
            // Of a mixture nothing else is explained.
            let mixture = self.run.contradictions.first().filter(|_| !are_runs);
            self.score.diagnosis =
                mixture.map_or(sentences, |why| vec![format!("{why}: was a second run appended?")]);
            let settles = has_settlement(parameters, *reference, states)?;
            self.note_absences(held.case, settles);
        }
        Ok(())
    }

    /// Quantities that are missing at a scored time, and tables that may be cut.
    fn missing(&self, parameters: &ColumnParameters, mapping: &Mapping) -> Vec<Finding> {
        let when =
            |place: usize| format!("T_v = {}", rounded(parameters.time_factor(self.run.states[place].time)));
        let absent = self.run.expected.absent(&self.run.states).into_iter();
        let shown = |lacking: Absent| Absent {
            column: lacking.column.map(|column| mapping.shown(column)),
            ..lacking
        };
        let absent = absent
            .map(|lacking| Finding { name: Lack::QuantityMissing, sentence: shown(lacking).sentence(when) });
        let unended =
            self.run.unended.iter().map(|file| Finding { name: Lack::EndMissing, sentence: not_ended(file) });
        let said_twice: Vec<&String> = self.run.contradictions.iter().chain(&self.run.doubts).collect();
        let doubts = said_twice.first().map(|doubt| {
            let more = match said_twice.len() {
                1 => String::new(),
                many => format!(" (and {} more)", many - 1),
            };
            Finding { name: Lack::FileContradicts, sentence: format!("{doubt}{more}") }
        });
        absent.chain(unended).chain(doubts).collect()
    }

    /// Says which quantity has no error, and why; `settles`: whether the problem has a settlement at these times.
    fn note_absences(&mut self, case: &Case, settles: bool) {
        let is_compared = |quantity: Quantity| {
            self.score.errors.iter().any(|row| row.quantity == quantity)
                || self.score.unresolved.iter().any(|output| output.quantity == quantity)
        };
        let [displacement, settlement] = [Quantity::Displacement, Quantity::Settlement].map(is_compared);
        let is_known = !settles || self.run.without.contains(&Quantity::Settlement);
        let is_plane = case.scene.body.is_plane();
        let is_curve = self.run.states.iter().all(|state| state.initial_height.is_empty());
        if displacement && !settlement && !is_known && !is_curve {
            let why = if case.scene.body == Body::Slab {
                "it is that of the plate, where there is no sample: give a curve in [settlement] of the mapping"
            } else if is_plane {
                "no sample lies on the surface under the crest of the load"
            } else {
                "no sample lies on the surface"
            };
            let sentence = format!("the settlement is not judged: {why}");
            self.score.not_judged.push(Finding::new(Lack::QuantityMissing, sentence));
        }
        let first = self.run.states.first();
        if is_plane && displacement && first.is_some_and(|state| state.horizontal_displacement.is_empty()) {
            self.run.notes.push(
                "there is no u_x: only the vertical component of the displacement is judged".to_owned(),
            );
        }
    }
}

/// The quantities at places of their own, by set, each over the times that have it.
fn beside_by_set(states: &[SampledState]) -> Vec<Vec<SampledState>> {
    let most = states.iter().map(|state| state.beside.len()).max().unwrap_or(0);
    let of_set = |set: usize| {
        let there = states.iter().filter_map(|state| Some((state.time, &state.beside.get(set)?.state)));
        there.map(|(time, state)| SampledState { time, ..state.clone() }).collect()
    };
    (0..most).map(of_set).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Norm, Task};
    use crate::import::mapping::preset::CONVENTION;
    use crate::score::Unresolved;
    use crate::score::tests::state;
    use crate::study::file::StudySource;
    use oedometer_scenes::{COSINE_LAYER, MANDEL, Scene, TERZAGHI};

    #[test]
    fn a_result_is_named_by_its_files_and_by_their_ends_where_they_are_many() {
        let name = |files: &[&str]| {
            let files = files.iter().map(Into::into).collect();
            Scored { run: Run { files, ..Run::default() }, ..Scored::default() }.name()
        };
        assert_eq!([name(&["a"]), name(&["a", "b", "c"])], ["a", "a, b, c"]);
        assert_eq!([name(&["a", "b", "c", "d"]), name(&[])], ["a … d (4 files)", ""]);
        let missing = ScoreError::NoTime("there is no T_v = 0.1".to_owned()).to_string();
        let told = "no state is at a requested time: there is no T_v = 0.1; --time-tolerance sets how far a \
                    time may differ";
        assert_eq!(missing, told);
    }

    #[test]
    fn what_is_left_out_is_neither_judged_nor_listed_as_vanishing_nor_noted_as_absent() {
        use Quantity::{Displacement, Pressure, Settlement};
        let text = CONVENTION.to_owned();
        let mapping = Mapping::read(&StudySource { name: "map.toml".to_owned(), text }).expect("a mapping");
        let case = Case::seed(Task::Solve, &TERZAGHI);
        let comparison = Comparison {
            case: &case,
            parameters: ColumnParameters::default(),
            mapping: &mapping,
            references: &[ReferenceKind::TerzaghiIncompressible],
            requested: &[],
            tolerance: 1e-3,
            are_cells_found: true,
        };
        // What has an error at the first time, and what has none because its exact value vanishes at the second.
        let judged = |times: [f64; 2], without: &[Quantity]| {
            let states = times.map(|time| state(20, time, |_| 0.0)).to_vec();
            let mut one = Scored { run: Run { states, ..Run::default() }, ..Scored::default() };
            one.run.leave_out(without);
            one.assess(&comparison, &comparison.parameters).expect("a score");
            assert_eq!(one.score.not_judged, [], "{times:?}");
            let all = [Pressure, Displacement, Settlement];
            let errors = all.map(|quantity| one.score.errors.iter().any(|row| row.quantity == quantity));
            let vanished =
                all.map(|quantity| one.score.unresolved.iter().any(|row| row.quantity == quantity));
            [errors, vanished]
        };
        let (at_first, late) = ([0.1, 0.0], [0.1, 50.0]);
        for (times, without, left) in [
            (at_first, &[][..], [[true; 3], [false, true, true]]),
            (at_first, &[Pressure], [[false, true, true], [false, true, true]]),
            (at_first, &[Settlement], [[true, true, false], [false, true, false]]),
            (at_first, &[Settlement, Pressure], [[false, true, false], [false, true, false]]),
            (at_first, &[Displacement], [[true, false, false], [false; 3]]),
            (late, &[], [[true; 3], [true, false, false]]),
            (late, &[Pressure], [[false, true, true], [false; 3]]),
        ] {
            assert_eq!(judged(times, without), left, "{times:?} {without:?}");
        }
    }

    #[test]
    fn what_keeps_a_settlement_from_being_judged_is_noted_by_the_scene() {
        let row = |quantity: Quantity| ErrorRow {
            time_factor: 0.1,
            quantity,
            sample: Sample::Nodes,
            norm: Norm::L2,
            reference: "terzaghi".to_owned(),
            value: 0.1,
            absolute: 0.1,
        };
        let (moved, settled) = (row(Quantity::Displacement), row(Quantity::Settlement));
        let notes_of = |scene: &'static Scene, score: Score, horizontal: &[f64], settles: bool| {
            let states = vec![SampledState {
                horizontal_displacement: horizontal.to_vec(),
                initial_height: vec![0.5],
                ..SampledState::default()
            }];
            let run = Run { states, ..Run::default() };
            let mut one = Scored { run, score };
            one.note_absences(&Case::seed(Task::Solve, scene), settles);
            let not_judged = one.score.not_judged.into_iter().map(|finding| finding.sentence);
            not_judged.chain(one.run.notes).collect::<Vec<String>>()
        };
        let notes = |scene: &'static Scene, errors: &[ErrorRow], horizontal: &[f64]| {
            notes_of(scene, Score { errors: errors.to_vec(), ..Score::default() }, horizontal, true)
        };
        let surface = "the settlement is not judged: no sample lies on the surface";
        let crest = "the settlement is not judged: no sample lies on the surface under the crest of the load";
        let plate = "the settlement is not judged: it is that of the plate, where there is no sample: give a \
                     curve in [settlement] of the mapping";
        let vertical = "there is no u_x: only the vertical component of the displacement is judged";
        let (both, alone) = ([moved.clone(), settled.clone()], [moved]);
        assert_eq!(notes(&TERZAGHI, &alone, &[]), [surface]);
        assert_eq!(notes(&MANDEL, &alone, &[]), [plate]);
        assert_eq!(notes(&COSINE_LAYER, &alone, &[]), [crest, vertical]);
        assert_eq!(notes(&COSINE_LAYER, &alone, &[0.1]), [crest]);
        assert_eq!(notes(&COSINE_LAYER, &both, &[]), [vertical]);
        assert_eq!(notes(&TERZAGHI, &both, &[]), [""; 0]);
        assert_eq!(notes(&COSINE_LAYER, &[settled], &[]), [""; 0], "no displacement at all");
        // At the base the exact displacement is 0, and the settlement is judged no more than elsewhere; a problem without one
        // lacks none.
        let at_base = Unresolved {
            time_factor: 0.1,
            quantity: Quantity::Displacement,
            sample: Sample::Nodes,
            reference: "terzaghi".to_owned(),
            absolute: 0.0,
        };
        let vanishing = Score { unresolved: vec![at_base], ..Score::default() };
        for (settles, told) in [(true, &[surface][..]), (false, &[])] {
            assert_eq!(notes_of(&TERZAGHI, vanishing.clone(), &[], settles), told);
        }
        let settles = |kind: ReferenceKind, time: f64| {
            has_settlement(&ColumnParameters::default(), kind, &[state(20, time, |_| 0.0)])
        };
        let all = [(ReferenceKind::Terzaghi, 0.1), (ReferenceKind::TerzaghiIncompressible, 0.0)];
        assert_eq!(all.map(|(kind, time)| settles(kind, time)), [Ok(true), Ok(false)]);
        assert_eq!(settles(ReferenceKind::AtRest, 0.1), Ok(false));
    }
}
