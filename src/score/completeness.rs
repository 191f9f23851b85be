//! Whether an external result is complete: missing parts make an error small.

use crate::import::nodes::{SAME_PLACE, levels};
use crate::import::{RIM, SampledState};
use crate::measure::fields::{ExactFields, resolution};
use crate::score::coverage;
use crate::score::coverage::{Bare, End};
use crate::score::places_of;
use crate::score::score_series::time_factors;
use oedometer_exact::row::Axis;
use oedometer_exact::{ColumnParameters, ExactError, Reference, ReferenceKind};
use oedometer_soil::elementary::ln;
use oedometer_wording::{count_of, rounded, typed, words};

/// Share by which volumes may differ beyond what consolidation explains: round-off of written
/// numbers.
const VOLUME: f64 = 1e-3;
/// Ratio of the sum of volumes to that of the scene from which on they count as weights in another unit.
const OTHER_UNIT: f64 = 2.5;
/// Ratio of the samples per cell of two meshes from which on one lacks some.
const UNEVEN: f64 = 1.5;
/// Up to this many distances from the crest are profiles of a layer that were chosen for display.
const PROFILES: usize = 3;
/// Share of the largest exact pressure of a state below which a pressure of 0 is right.
const NEARLY_ZERO: f64 = 1e-3;
/// Samples that a band has on average where places have no order.
const PER_BIN: usize = 12;

/// In what way a result is incomplete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// Volumes do not add up to that of the scene, or not to the same at all times.
    VolumeDiffers,
    /// Samples leave a stretch of the height bare.
    HeightNotCovered,
    /// Samples leave a stretch of a layer's length bare.
    LengthNotCovered,
    /// Places of a lattice are missing.
    PlacesMissing,
    /// Rows are repeated.
    RowsRepeated,
    /// Times have different numbers of samples.
    SamplesDiffer,
    /// A time is missing that another result has, or that was asked for.
    TimeMissing,
    /// Pressures of exactly 0 stand inside the body.
    ZerosInside,
    /// The mapping does not declare the units and signs of the columns.
    Undeclared,
    /// A quantity is missing at a time.
    QuantityMissing,
    /// The last line of a table does not end.
    EndMissing,
    /// A value is far beyond what the load can bring about.
    ValueImpossible,
    /// A file says a thing in two ways: a header that does not fit its data.
    FileContradicts,
    /// The number of cells that was given is that of nodes, or of all cells of a mesh.
    CellsDoubtful,
    /// Two meshes have the same numbers.
    ResultsIdentical,
}

words!(
    Lack:
    VolumeDiffers "volume-differs", HeightNotCovered "height-not-covered",
    LengthNotCovered "length-not-covered", PlacesMissing "places-missing", RowsRepeated "rows-repeated",
    SamplesDiffer "samples-differ", TimeMissing "time-missing", ZerosInside "zeros-inside",
    Undeclared "undeclared", QuantityMissing "quantity-missing", EndMissing "end-missing",
    ValueImpossible "value-impossible", FileContradicts "file-contradicts",
    CellsDoubtful "cells-doubtful", ResultsIdentical "results-identical",
);

/// One thing that is missing from a result.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// What is missing.
    pub name: Lack,
    /// Where, and how much.
    pub sentence: String,
}

impl Finding {
    /// What is missing, and a sentence on where and how much.
    pub fn new(name: Lack, sentence: String) -> Self {
        Self { name, sentence }
    }
}

/// What a complete result would have.
#[derive(Clone, Copy, Debug)]
pub struct Whole<'a> {
    /// The column or layer.
    pub parameters: &'a ColumnParameters,
    /// The solution that tells how far the volume shrinks.
    pub reference: ReferenceKind,
    /// Volumes of the scene that the samples' may add up to; one, or those of a column with and
    /// without its width.
    pub volumes: &'a [f64],
    /// Whether the first of them was declared, so that no other is meant.
    pub is_declared: bool,
    /// Whether the samples have volumes at all.
    pub has_volumes: bool,
}

impl Whole<'_> {
    /// What the states of one result lack, one finding for each kind.
    ///
    /// # Errors
    /// When the reference refuses a time.
    pub fn findings(&self, states: &[SampledState]) -> Result<Vec<Finding>, ExactError> {
        let volume = if self.has_volumes { self.volume(states)? } else { None };
        let repeated = |state: &SampledState| {
            let (repeated, all) = (state.repeated, state.initial_height.len());
            (repeated > 0).then(|| {
                let at = state.repeated_at.as_ref().map_or(String::new(), |at| format!(", first at {at}"));
                format!(
                    "{repeated} of {all} rows repeat the place of another with different values{at}: was \
                     this time written twice? If they are samples side by side, keep the column that \
                     distinguishes them"
                )
            })
        };
        let findings = [
            volume,
            self.first(states, Lack::HeightNotCovered, |state| self.bare_height(state)),
            self.first(states, Lack::LengthNotCovered, |state| self.bare_length(state)),
            self.first(states, Lack::PlacesMissing, |state| self.holes(state)),
            self.first(states, Lack::RowsRepeated, repeated),
            self.counts(states),
        ];
        Ok(findings.into_iter().flatten().collect())
    }

    /// The first state with a problem, and how many more there are.
    fn first(
        &self,
        states: &[SampledState],
        name: Lack,
        said: impl Fn(&SampledState) -> Option<String>,
    ) -> Option<Finding> {
        let mut all = states.iter().filter_map(|state| Some((state, said(state)?)));
        let (state, what) = all.next()?;
        let more = match all.count() {
            0 => String::new(),
            more => format!("; the same at {more} more of {} times", states.len()),
        };
        Some(Finding::new(name, format!("at {}, {what}{more}", self.when(state))))
    }

    fn when(&self, state: &SampledState) -> String {
        format!("T_v = {}", rounded(self.parameters.time_factor(state.time)))
    }

    /// The sum of the volumes against that of the scene; less by what was squeezed out is whole.
    fn volume(&self, states: &[SampledState]) -> Result<Option<Finding>, ExactError> {
        let sums: Vec<f64> = states.iter().map(|state| state.volume.iter().sum()).collect();
        let Some(largest) = sums.iter().copied().reduce(f64::max) else { return Ok(None) };
        let off = |volume: &f64| ln(largest / volume).abs();
        let nearest = self.volumes.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)));
        let scene = nearest.filter(|volume| self.is_declared || off(volume) <= ln(OTHER_UNIT));
        let whole = scene.unwrap_or(largest);
        let times = time_factors(self.parameters, states);
        let reference = Reference::new(self.reference, self.parameters, &times)?;
        let mut off = Vec::new();
        for ((state, sum), time) in states.iter().zip(&sums).zip(&times) {
            let settled = reference.settlement(*time)? / self.parameters.height;
            let share = if whole > 0.0 { sum / whole - 1.0 } else { -1.0 };
            if !(-VOLUME - settled.max(0.0)..=VOLUME).contains(&share) {
                off.push((state, *sum, share));
            }
        }
        let worst = off.into_iter().rev().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
        let of = if scene.is_some() { "that of the problem" } else { "the largest of all times" };
        Ok(worst.map(|(state, sum, share)| {
            let (when, [sum, whole]) = (self.when(state), [sum, whole].map(rounded));
            let wrong = if share < 0.0 { "are missing" } else { "are too many" };
            let percent = 100.0 * share.abs();
            let sentence = format!(
                "at {when}, the volumes add up to {sum}, and {of} is {whole}: {percent:.2} % {wrong}"
            );
            Finding::new(Lack::VolumeDiffers, sentence)
        }))
    }

    /// A note where the volumes are in a unit of their own, so that their sum cannot be checked.
    pub fn unit_of_volume(&self, states: &[SampledState]) -> Option<String> {
        let sum: f64 = states.first()?.volume.iter().sum();
        let is_other = |volume: &f64| ln(sum / volume).abs() > ln(OTHER_UNIT);
        let is_weight = self.has_volumes && !self.is_declared && self.volumes.iter().all(is_other);
        is_weight.then(|| {
            format!(
                "the volumes add up to {}, which is not a volume of the problem: they are used as weights; \
                 with `whole_volume` in the mapping their sum is checked",
                rounded(sum)
            )
        })
    }

    /// A note where samples lie at one height, or along a few verticals of a layer that were chosen for display.
    pub fn profiles(&self, states: &[SampledState]) -> Option<String> {
        let state = states.first().filter(|state| !state.initial_height.is_empty())?;
        let heights = levels(&state.initial_height, self.parameters.height);
        let distances = levels(&state.initial_distance, self.parameters.length);
        let all = |lines: &[f64]| lines.iter().map(|line| rounded(*line)).collect::<Vec<_>>().join(", ");
        let place = if heights.len() == 1 {
            let axis = if self.reference.row().axis == Axis::AlongSlab { "x" } else { "y" };
            format!("{axis} = {}", all(&heights))
        } else if self.is_plane() && distances.len() <= PROFILES {
            format!("x = {}", all(&distances))
        } else {
            return None;
        };
        Some(format!("the samples lie only at {place} m: nothing is known about the rest"))
    }

    /// Nodes of which the outermost row is missing at an end; a place declared to be one has its row at both.
    pub fn end_without_sample(&self, states: &[SampledState], are_nodes: bool) -> Option<Finding> {
        let [base, surface, axis] = match self.reference.row().axis {
            Axis::AlongSlab => ["the middle", "the drained side", "x"],
            _ => ["the base", "the surface", "y"],
        };
        let place = |end: &str, at: f64| format!("{end} ({axis} = {} m)", rounded(at));
        let bottom = place(base, 0.0);
        let top = place(surface, self.parameters.height);
        let what_is_bare = |state: &SampledState| {
            let lines = levels(&state.initial_height, self.parameters.height);
            Some(match coverage::open_end(&lines, self.parameters.height, are_nodes)? {
                End::Top => {
                    format!("no sample lies on {top}: the nodes have no row there, but one on {base}")
                }
                End::Bottom => {
                    format!("no sample lies on {bottom}: the nodes have no row there, but one on {surface}")
                }
                End::Both => format!("no sample lies on {top} or on {bottom}: the nodes have no row there"),
            })
        };
        self.first(states, Lack::HeightNotCovered, what_is_bare)
    }

    fn bare_height(&self, state: &SampledState) -> Option<String> {
        // A settlement curve has no places.
        if state.initial_height.is_empty() {
            return None;
        }
        let can_scatter = !state.initial_distance.is_empty();
        let is_one_height = |lines: &[f64]| lines.len() == 1;
        let bare = bare_along(&state.initial_height, self.parameters.height, can_scatter, is_one_height)?;
        let from =
            if self.reference.row().axis == Axis::AlongSlab { "from the middle" } else { "over the base" };
        Some(stretch(bare, from))
    }

    fn bare_length(&self, state: &SampledState) -> Option<String> {
        let places = Some(&state.initial_distance).filter(|places| self.is_plane() && !places.is_empty())?;
        let are_profiles = |lines: &[f64]| lines.len() <= PROFILES;
        let bare = bare_along(places, self.parameters.length, true, are_profiles)?;
        Some(stretch(bare, "from the crest"))
    }

    fn holes(&self, state: &SampledState) -> Option<String> {
        if !self.is_plane() || state.repeated > 0 {
            return None;
        }
        let extent = [self.parameters.length, self.parameters.height];
        let [samples, crossings] =
            coverage::incomplete_lattice(&state.initial_distance, &state.initial_height, extent)?;
        Some(format!("samples lie at {samples} of the {crossings} crossings of their lines"))
    }

    fn counts(&self, states: &[SampledState]) -> Option<Finding> {
        let count = |state: &SampledState| state.initial_height.len();
        let most = states.iter().max_by_key(|state| count(state))?;
        let fewer: Vec<&SampledState> = states.iter().filter(|state| count(state) < count(most)).collect();
        let first = fewer.first()?;
        let more = match fewer.len() - 1 {
            0 => String::new(),
            more => {
                format!("; {} fewer samples than that", count_of(more, "more time has", "more times have"))
            }
        };
        let samples = count_of(count(first), "sample", "samples");
        let [few, many] = [*first, most].map(|state| self.when(state));
        let sentence = format!("{few} has {samples}, and {many} has {}{more}", count(most));
        Some(Finding::new(Lack::SamplesDiffer, sentence))
    }

    fn is_plane(&self) -> bool {
        self.reference.row().axis == Axis::InPlane
    }
}

/// A bare stretch along one direction, of bands where the places have no order; `None` where their lines were
/// chosen for display.
fn bare_along(
    places: &[f64],
    extent: f64,
    can_scatter: bool,
    are_chosen: impl Fn(&[f64]) -> bool,
) -> Option<Bare> {
    let lines = levels(places, extent);
    let is_scattered = can_scatter && 2 * lines.len() > places.len() && lines.len() > 2 * PER_BIN;
    match (are_chosen(&lines), is_scattered) {
        (true, _) => None,
        (false, true) => {
            let bands = (places.len() / PER_BIN).clamp(2, 100);
            coverage::longest(coverage::empty_bands(places, extent, bands))
        }
        (false, false) => coverage::bare(&lines, extent),
    }
}

/// The times that a result lacks.
pub fn missing_times(missing: &[f64], has: &[f64], asked: bool) -> Option<Finding> {
    let first = missing.first()?;
    let nearest = has.iter().copied().min_by(|a, b| (a - first).abs().total_cmp(&(b - first).abs()));
    let near = nearest.map_or(String::new(), |time| {
        let off = (time / first - 1.0).abs();
        // Nothing is relative to the start.
        let off = if off.is_finite() { format!(", {off:.2e} off in relative terms") } else { String::new() };
        format!("; the nearest it has is T_v = {}{off}", typed(time))
    });
    let more = match missing.len() {
        1 => String::new(),
        many => format!(" (and {} more)", many - 1),
    };
    let who = if asked { "which was asked for" } else { "which another result has" };
    let sentence = format!("there is no T_v = {}{more}, {who}{near}", typed(*first));
    Some(Finding::new(Lack::TimeMissing, sentence))
}

/// The mesh, by its place from the coarsest, that has far fewer samples per cell over the height than
/// another; equal numbers on all meshes are a choice of places.
pub fn uneven_meshes(
    meshes: &[(usize, &SampledState)],
    parameters: &ColumnParameters,
) -> Option<(usize, Finding)> {
    let height = parameters.height;
    let per_cell: Vec<f64> = meshes
        .iter()
        .map(|(cells, state)| {
            let lines = levels(&state.initial_height, height);
            // Nodes have one more than there are spacings.
            let reaches =
                |line: Option<&f64>, end: f64| line.is_some_and(|y| (y - end).abs() <= SAME_PLACE * height);
            let nodes = reaches(lines.first(), 0.0) && reaches(lines.last(), height);
            (lines.len() - usize::from(nodes)) as f64 / *cells as f64
        })
        .collect();
    let by_size = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
    let (fewest, least) = per_cell.iter().enumerate().min_by(by_size)?;
    let (most, largest) = per_cell.iter().enumerate().max_by(by_size)?;
    let count = |place: usize| meshes[place].1.initial_height.len();
    let are_alike = (0..meshes.len()).all(|place| count(place) == count(0));
    (*largest > UNEVEN * least && !are_alike).then(|| {
        let ([least, largest], cells) = ([*least, *largest].map(rounded), meshes[most].0);
        let sentence = format!("samples lie at {least} heights per cell, and at {largest} on {cells} cells");
        (fewest, Finding::new(Lack::SamplesDiffer, sentence))
    })
}

fn stretch(bare: Bare, from: &str) -> String {
    format!("no sample lies between {} m and {} m {from}", rounded(bare.from), rounded(bare.to))
}

/// Zeros where none can be, as programs write them at nodes without a pressure: pressures of exactly 0 inside the body
/// beside others, where the reference has one. The first such state is named.
///
/// # Errors
/// When the reference refuses a time.
pub fn interior_zeros(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
) -> Result<Option<Finding>, ExactError> {
    for (state, time) in states.iter().zip(time_factors(parameters, states)) {
        let is_inside = |height: f64| (RIM..1.0 - RIM).contains(&(height / parameters.height));
        let places = 0..state.initial_height.len().min(state.pressure.len());
        let inside: Vec<usize> = places.filter(|place| is_inside(state.initial_height[*place])).collect();
        let mut zeros: Vec<usize> =
            inside.iter().copied().filter(|place| state.pressure[*place] == 0.0).collect();
        if zeros.is_empty() || zeros.len() == inside.len() {
            continue;
        }
        // A wave that has not come, a line between crest and trough, a drained side: there 0 is right.
        let reference = Reference::new(reference, parameters, &[time])?;
        let exact = ExactFields::of(&reference, time, places_of(state, parameters.height))?.pressure;
        let largest = exact.iter().fold(0.0_f64, |largest, pressure| largest.max(pressure.abs()));
        let nearly_zero = NEARLY_ZERO * largest + resolution(&reference, time) * parameters.load;
        zeros.retain(|place| exact[*place].abs() > nearly_zero);
        if !zeros.is_empty() {
            let (when, zeros, all) = (typed(parameters.time_factor(state.time)), zeros.len(), inside.len());
            let sentence = format!(
                "at T_v = {when}, {zeros} of {all} pressures inside are exactly 0 and the others are not: programs \
                 write 0 at the middle of sides; keep the corners of the cells ([rows] corners = true in the \
                 mapping) or take an interpolated array"
            );
            return Ok(Some(Finding::new(Lack::ZerosInside, sentence)));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_at_the_middle_of_sides_are_told_and_those_of_the_surface_are_not() {
        let column = ColumnParameters::default();
        let heights: Vec<f64> = (0..=4).map(|node| f64::from(node) / 4.0).collect();
        let found = |reference: ReferenceKind, time: f64, pressure: [f64; 5], distance: &[f64]| {
            let state = SampledState {
                time: column.time(time),
                initial_height: heights.clone(),
                initial_distance: distance.to_vec(),
                pressure: pressure.to_vec(),
                ..SampledState::default()
            };
            let found = interior_zeros(&column, reference, &[state]).expect("the reference takes the time");
            found.map(|one| (one.name, one.sentence.replace("0.09999999999999999", "0.1")))
        };
        let (kind, layer) = (ReferenceKind::Terzaghi, ReferenceKind::CosineLayer);
        let told = "at T_v = 0.1, 2 of 3 pressures inside are exactly 0 and the others are not: programs write 0 at the middle \
                    of sides; keep the corners of the cells ([rows] corners = true in the mapping) or take an interpolated array";
        let midsides = [1.0, 0.0, 0.8, 0.0, 0.0];
        assert_eq!(found(kind, 0.1, midsides, &[]), Some((Lack::ZerosInside, told.to_owned())));
        assert_eq!(found(kind, 0.1, [1.0, 0.9, 0.8, 0.4, 0.0], &[]), None);
        assert_eq!(found(kind, 0.1, [0.0; 5], &[]), None, "nothing but zeros is another mistake");
        // Half-way between crest and trough, ahead of a wave, and at rest there is no pressure.
        let half = 0.5 * column.length;
        assert_eq!(found(layer, 0.1, midsides, &[0.0, half, 0.0, half, 0.0]), None);
        assert!(found(layer, 0.1, midsides, &[0.0; 5]).is_some());
        assert_eq!(found(ReferenceKind::DynamicColumn, 1e-6, [0.0, 0.0, 1e-9, 0.9, 0.0], &[]), None);
        assert_eq!(found(ReferenceKind::AtRest, 0.1, [0.0, 0.0, 1e-17, 0.0, 0.0], &[]), None);
    }

    #[test]
    fn as_much_volume_may_be_missing_as_the_column_has_settled_as_a_share_of_it() {
        let tall = ColumnParameters { height: 4.0, ..ColumnParameters::default() };
        let load = tall.load * 0.02 * tall.height / tall.final_settlement();
        let column = ColumnParameters { load, ..tall };
        let whole = Whole {
            parameters: &column,
            reference: ReferenceKind::Terzaghi,
            volumes: &[4.0],
            is_declared: false,
            has_volumes: true,
        };
        let said = |missing: f64| {
            let volume = vec![0.5 * 4.0 * (1.0 - missing); 2];
            let state = SampledState { time: column.time(2.0), volume, ..SampledState::default() };
            whole.volume(&[state]).expect("the seed column")
        };
        assert_eq!((said(0.0), said(0.019)), (None, None), "it settles by 2 %");
        assert_eq!(said(0.025).map(|found| found.name), Some(Lack::VolumeDiffers));
        assert_eq!(said(-0.002).map(|found| found.name), Some(Lack::VolumeDiffers));
    }

    fn at(time_factor: f64, heights: &[f64], distances: &[f64]) -> SampledState {
        SampledState {
            time: ColumnParameters::default().time(time_factor),
            initial_height: heights.to_vec(),
            initial_distance: distances.to_vec(),
            ..SampledState::default()
        }
    }

    #[test]
    fn a_layer_is_covered_along_its_length_and_not_along_its_height() {
        let column = ColumnParameters { length: 4.0, ..ColumnParameters::default() };
        let reference = ReferenceKind::CosineLayer;
        let layer =
            Whole { parameters: &column, reference, volumes: &[4.0], is_declared: false, has_volumes: false };
        // Five lines across, and five up of which the middle one is off by less than a place.
        let lattice = |to: f64, off: f64| {
            let places = (0..=4).flat_map(|i| (0..=4).map(move |j| [f64::from(i) / 4.0, f64::from(j) / 4.0]));
            let shifted = places.map(|[x, y]| (to * x + if y == 0.5 { off } else { 0.0 }, y));
            let (distances, heights): (Vec<f64>, Vec<f64>) = shifted.unzip();
            at(0.1, &heights, &distances)
        };
        assert_eq!(layer.bare_length(&lattice(4.0, 0.0)), None);
        assert!(layer.bare_length(&lattice(2.0, 0.0)).is_some_and(|bare| bare.ends_with("from the crest")));
        let mut one_less = lattice(4.0, 2e-6);
        one_less.initial_distance.remove(12);
        one_less.initial_height.remove(12);
        let told = "samples lie at 24 of the 25 crossings of their lines";
        assert_eq!(layer.holes(&one_less), Some(told.to_owned()));
    }

    #[test]
    fn what_is_missing_is_told_with_its_time_its_place_and_how_much() {
        let column = ColumnParameters::default();
        let (kind, layer) = (ReferenceKind::Terzaghi, ReferenceKind::CosineLayer);
        let whole = |reference: ReferenceKind, is_declared: bool, has_volumes: bool| {
            let volumes = &[1.0, 0.25];
            Whole { parameters: &column, reference, volumes, is_declared, has_volumes }
        };
        let told = |reference: ReferenceKind, states: &[SampledState]| -> Vec<(Lack, String)> {
            let found = whole(reference, false, true).findings(states).expect("the seed column");
            found.into_iter().map(|one| (one.name, one.sentence)).collect()
        };
        let nodes = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];
        let with = |time: f64, sum: f64| SampledState { volume: vec![0.5 * sum; 2], ..at(time, &nodes, &[]) };
        // Of the scene, or of all times where volumes have another unit, and the farthest off of all.
        let (scene, all) = ("that of the problem", "the largest of all times");
        for (sums, place, of, said) in [
            ([1.0, 0.5, 0.75], "T_v = 0.2, the volumes add up to 0.5", scene, "1: 50.00 % are missing"),
            ([1.0, 1.0, 1.25], "T_v = 0.4, the volumes add up to 1.25", scene, "1: 25.00 % are too many"),
            ([0.25, 0.25, 0.2], "T_v = 0.4, the volumes add up to 0.2", scene, "0.25: 20.00 % are missing"),
            ([3.0, 2.0, 3.0], "T_v = 0.2, the volumes add up to 2", all, "3: 33.33 % are missing"),
        ] {
            let states = [0, 1, 2].map(|place| with([0.1, 0.2, 0.4][place], sums[place]));
            let sentence = format!("at {place}, and {of} is {said}");
            assert_eq!(told(kind, &states), [(Lack::VolumeDiffers, sentence)]);
            assert_eq!(whole(kind, false, false).findings(&states).expect("the seed column"), []);
        }
        let unit = |is_declared: bool, has_volumes: bool, sum: f64| {
            whole(kind, is_declared, has_volumes).unit_of_volume(&[with(0.1, sum)])
        };
        let taken = "the volumes add up to 3, which is not a volume of the problem: they are used as \
                     weights; with `whole_volume` in the mapping their sum is checked";
        assert_eq!(unit(false, true, 3.0), Some(taken.to_owned()));
        assert_eq!(
            [unit(true, true, 3.0), unit(false, false, 3.0), unit(false, true, 2.4)],
            [None, None, None]
        );
        let all = |distances: &[f64], heights: &[f64]| {
            let (x, y): (Vec<f64>, Vec<f64>) =
                distances.iter().flat_map(|x| heights.iter().map(move |y| (*x, *y))).unzip();
            SampledState { volume: vec![1.0], ..at(0.1, &y, &x) }
        };
        let gap = [0.0, 0.125, 0.25, 0.375, 0.75, 0.875, 1.0];
        let cut = SampledState { volume: vec![1.0], ..at(0.1, &gap, &[]) };
        let mut holes = all(&nodes, &nodes);
        holes.initial_distance.remove(31);
        holes.initial_height.remove(31);
        let bare = "no sample lies between 0.375 m and 0.75 m";
        let base = format!("{bare} over the base");
        for (reference, states, lack, said) in [
            (kind, vec![cut], Lack::HeightNotCovered, &*base),
            (layer, vec![all(&gap, &nodes)], Lack::LengthNotCovered, &format!("{bare} from the crest")),
            (layer, vec![holes], Lack::PlacesMissing, "samples lie at 80 of the 81 crossings of their lines"),
        ] {
            assert_eq!(told(reference, &states), [(lack, format!("at T_v = 0.1, {said}"))]);
        }
        assert_eq!(told(layer, &[all(&nodes, &nodes)]), []);
        let one_more = "; 1 more time has fewer samples than that";
        for (counts, few, many, more) in [
            ([9, 8, 9], "T_v = 0.2 has 8 samples", "T_v = 0.4", ""),
            ([1, 9, 8], "T_v = 0.1 has 1 sample", "T_v = 0.2", one_more),
        ] {
            let states = [0, 1, 2].map(|place| at([0.1, 0.2, 0.4][place], &nodes[..counts[place]], &[]));
            let found = whole(kind, false, true).counts(&states).expect("they differ");
            assert_eq!(found.sentence, format!("{few}, and {many} has 9{more}"));
        }
        // Samples that were chosen for display are told and not blamed.
        let shown = |kind: ReferenceKind, state: SampledState| whole(kind, false, true).profiles(&[state]);
        let lie =
            |place: &str| Some(format!("the samples lie only at {place} m: nothing is known about the rest"));
        assert_eq!(shown(kind, at(0.1, &[0.5; 3], &[])), lie("y = 0.5"));
        assert_eq!(shown(layer, all(&[0.0, 0.25, 0.5], &nodes)), lie("x = 0, 0.25, 0.5"));
        assert_eq!(shown(layer, all(&[0.0, 0.25, 0.5, 1.0], &nodes)), None);
        assert_eq!(shown(kind, all(&[0.0, 0.25], &nodes)), None, "of a column no verticals are chosen");
    }

    #[test]
    fn times_that_are_missing_and_meshes_with_fewer_samples_are_told() {
        let told = |missing: &[f64], has: &[f64], asked: bool| {
            missing_times(missing, has, asked).map(|one| one.sentence)
        };
        let near = "; the nearest it has is T_v = 0.11, 1.00e-1 off in relative terms";
        let said =
            |more: &str, who: &str, near: &str| Some(format!("there is no T_v = 0.1{more}, {who}{near}"));
        let (asked, other) = ("which was asked for", "which another result has");
        assert_eq!(told(&[], &[0.1], true), None);
        assert_eq!(told(&[0.1], &[], true), said("", asked, ""));
        let start = "there is no T_v = 0, which was asked for; the nearest it has is T_v = 0.1";
        assert_eq!(told(&[0.0], &[0.1], true).as_deref(), Some(start));
        assert_eq!(told(&[0.1], &[0.05, 0.11, 0.2], true), said("", asked, near));
        assert_eq!(told(&[0.1, 0.3, 0.4], &[0.5, 0.11], false), said(" (and 2 more)", other, near));
        let column = ColumnParameters::default();
        let states =
            [&[0.125, 0.375, 0.625, 0.875][..], &[0.1, 0.5, 0.9], &[0.0, 0.5, 1.0], &[0.2, 0.4, 0.6, 0.8]]
                .map(|heights| at(0.1, heights, &[]));
        let [full, few, nodes, same] = states.each_ref();
        for (meshes, found) in [
            ([(2, full), (4, few)], Some((1, "samples lie at 0.75 heights per cell, and at 2 on 2 cells"))),
            ([(4, few), (2, full)], Some((0, "samples lie at 0.75 heights per cell, and at 2 on 2 cells"))),
            ([(2, nodes), (2, full)], Some((0, "samples lie at 1 heights per cell, and at 2 on 2 cells"))),
            ([(2, full), (4, same)], None),
            ([(4, full), (3, few)], None),
        ] {
            let told = uneven_meshes(&meshes, &column).map(|(place, one)| (place, one.name, one.sentence));
            let expected = found.map(|(place, told)| (place, Lack::SamplesDiffer, told.to_owned()));
            assert_eq!(told, expected, "{meshes:?}");
        }
    }
}
