//! The states of one mesh, and what every way of reading them does in the end: weights, a start without a load, a settlement
//! curve, and the order of files.

use crate::import::expected::Expected;
use crate::import::given_files::goes_back;
use crate::import::mapping::Mapping;
use crate::import::nodes::weigh;
use crate::import::raw_row::SolvedBody;
use crate::import::samples::SampledState;
use crate::import::table_rows::Curve;
use oedometer_case::quantity::{Quantity, Sample};
use oedometer_formats::ImportError;
use std::path::PathBuf;

/// The states of one mesh.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// What the user gave.
    pub files: Vec<PathBuf>,
    /// Number of cells over the height, if the files have cells.
    pub cells: Option<usize>,
    /// Its states, by time.
    pub states: Vec<SampledState>,
    /// What was read from where, and what was left out.
    pub notes: Vec<String>,
    /// What the samples are, if the files show it.
    pub sample: Option<Sample>,
    /// What every state must have.
    pub expected: Expected,
    /// Tables whose last line does not end: they may be cut inside a number.
    pub unended: Vec<PathBuf>,
    /// What files say in two ways: a header that does not fit its data.
    pub doubts: Vec<String>,
    /// What states say in two ways: other values at one place and time, times that go back.
    pub contradictions: Vec<String>,
    /// Width of a body whose files show it, m.
    pub width: Option<f64>,
    /// Whether its mesh changes with time; its cells are then those of the finest.
    pub has_changing_mesh: bool,
    /// Quantities that are left out on purpose.
    pub without: Vec<Quantity>,
}

impl Run {
    /// What the samples are: as the mapping declares, or as the files show where it leaves that open. What lies on cells is
    /// at no node, whatever is declared.
    pub fn sample(&self, mapping: &Mapping) -> Sample {
        let is_wrong = mapping.sample == Sample::Nodes && self.sample == Some(Sample::Centres);
        self.sample.filter(|_| mapping.is_sample_open || is_wrong).unwrap_or(mapping.sample)
    }
}

impl Run {
    /// Leaves out quantities, which no state then has or must have.
    pub fn leave_out(&mut self, quantities: &[Quantity]) {
        for quantity in quantities {
            for state in &mut self.states {
                state.change(&|state| match quantity {
                    Quantity::Pressure => state.pressure.clear(),
                    Quantity::EffectiveStress => state.effective_stress.clear(),
                    Quantity::Displacement => {
                        state.displacement.clear();
                        state.horizontal_displacement.clear();
                    }
                    Quantity::Settlement => state.surface_displacement = None,
                    Quantity::LoadFactor => {}
                });
            }
            self.expected.leave_out(*quantity);
        }
        self.without.extend(quantities);
    }

    /// Leaves out the state at the start if its pressure is 0 everywhere.
    pub(super) fn leave_out_unloaded(&mut self) {
        let is_loaded = |state: &SampledState| {
            state.time > 0.0 || state.pressure.is_empty() || state.pressure.iter().any(|p| *p != 0.0)
        };
        let before = self.states.len();
        self.states.retain(is_loaded);
        if self.states.len() < before && !self.states.is_empty() {
            let note = "the state at t = 0 is left out: its pressure is 0, so the load is not applied yet";
            self.notes.push(note.to_owned());
        }
    }

    /// Gives nodes of graded meshes the weights of the lengths that they stand for, where the file has no weights.
    pub(super) fn weigh_nodes(&mut self, mapping: &Mapping, body: SolvedBody) {
        let sample = self.sample(mapping);
        if mapping.columns.volume.is_some() {
            return;
        }
        let mut is_weighed = false;
        for state in &mut self.states {
            let beside = state.beside.iter_mut().map(|set| (set.sample.unwrap_or(sample), &mut set.state));
            let sets = beside.collect::<Vec<_>>();
            for (_, set) in sets.into_iter().filter(|(sample, _)| *sample != Sample::Centres) {
                is_weighed |= weigh(set, body.height, body.length);
            }
            is_weighed |= sample != Sample::Centres && weigh(state, body.height, body.length);
        }
        if is_weighed {
            let note = "weight = the length that each node represents, because they are unevenly spaced";
            self.notes.push(note.to_owned());
        }
    }

    /// Refuses files whose times are listed in their order and whose numbers are in another one: a shell sorts `a_10` before
    /// `a_9`.
    pub(super) fn files_are_in_order(&self, mapping: &Mapping) -> Result<(), ImportError> {
        let is_listed = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            !mapping.time.list.is_empty() && !mapping.time.files.contains_key(&*name)
        };
        let listed: Vec<&PathBuf> = self.files.iter().filter(|path| is_listed(path)).collect();
        let Some(pair) = listed.windows(2).find(|pair| goes_back(pair[0], pair[1])) else { return Ok(()) };
        Err(ImportError::content(
            pair[1],
            format!(
                "it comes after {}, but [time] counts the files in their order: give them in the order of \
                 their numbers, as a quoted pattern does, or write [time] files",
                pair[0].display()
            ),
        ))
    }

    /// Notes how many rows repeat another one with equal values; they count once.
    pub(super) fn note_repeated(&mut self, rows: usize) {
        let kept = self.states.iter().flat_map(|state| state.sets(Sample::Points));
        let kept: usize = kept.map(|(_, state)| state.initial_height.len()).sum();
        if kept < rows {
            let note = format!(
                "{} of {rows} rows repeat the place and values of another and count once",
                rows - kept
            );
            self.notes.push(note);
        }
    }

    /// Adds the settlement curve, if the mapping names a file for it.
    pub(super) fn attach_settlement(
        &mut self,
        mapping: &Mapping,
        body: SolvedBody,
    ) -> Result<(), ImportError> {
        let Some(series) = &mapping.settlement else { return Ok(()) };
        let curve = Curve::read(series, self.files.first().map(PathBuf::as_path), mapping, body)?;
        let matched = curve.attach(&mut self.states);
        self.contradictions.extend(curve.contradictions);
        let file = curve.file;
        let is_told = curve.table_notes.is_ended || self.unended.contains(&file);
        for (own, of_curve) in
            [(&mut self.notes, curve.table_notes.notes), (&mut self.doubts, curve.table_notes.doubts)]
        {
            for sentence in of_curve {
                if !own.contains(&sentence) {
                    own.push(sentence);
                }
            }
        }
        self.expected.settlement = matched > 0;
        self.notes.push(format!(
            "settlement from {} at {matched} of {} times, each the nearest within 0.1 %",
            if series.file.is_empty() { file.display().to_string() } else { series.file.clone() },
            self.states.len()
        ));
        self.unended.extend((!is_told).then_some(file));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_as_declared_or_as_found_and_what_lies_on_cells_is_at_no_node() {
        use Sample::{Centres, Nodes, Points};
        let convention = Mapping::convention(crate::import::mapping::Axes::Column).expect("a constant");
        for (declared, is_sample_open, shown, told) in [
            (Nodes, false, None, Nodes),
            (Nodes, false, Some(Nodes), Nodes),
            (Nodes, false, Some(Centres), Centres),
            (Points, false, Some(Centres), Points),
            (Centres, false, Some(Nodes), Centres),
            (Points, true, Some(Nodes), Nodes),
            (Points, true, None, Points),
        ] {
            let mapping = Mapping { sample: declared, is_sample_open, ..convention.clone() };
            let run = Run { sample: shown, ..Run::default() };
            assert_eq!(run.sample(&mapping), told, "{declared:?} {shown:?}");
        }
    }
}
