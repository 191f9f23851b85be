//! Whether an external result is whole: what is missing makes an error small.

use crate::import::table::SampledState;
use crate::judge::score::coverage;
use crate::judge::score::coverage::Bare;
use crate::judge::score::times::time_factors;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_soil::elementary::ln;

/// Share by which volumes may differ beyond what consolidation explains: round-off of written
/// numbers.
const VOLUME: f64 = 1e-3;
/// Ratio of the volumes' sum to that of the scene from which on they are weights of another unit.
const OTHER_UNIT: f64 = 2.5;
/// Ratio of the samples a cell of two meshes from which on one lacks some.
const UNEVEN: f64 = 1.5;
/// Up to so many distances from the crest are profiles of a layer, chosen to be looked at.
const PROFILES: usize = 3;
/// Bins of places without order hold so many samples on average.
const PER_BIN: usize = 12;

/// In what a result is not whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Lack {
    /// Volumes do not add up to that of the scene, or not to the same at all times.
    VolumeDiffers,
    /// Samples leave a stretch of the height bare.
    HeightNotCovered,
    /// Samples leave a stretch of a layer's length bare.
    LengthNotCovered,
    /// Places of a lattice are missing.
    PlacesMissing,
    /// Rows stand twice.
    RowsRepeated,
    /// Times have different numbers of samples.
    SamplesDiffer,
    /// A time is missing that another result has, or that was asked for.
    TimeMissing,
    /// Pressures of exactly 0 stand inside the body.
    ZerosInside,
    /// Nobody said which units and signs the columns have.
    Undeclared,
    /// A quantity is gone at a time.
    QuantityMissing,
    /// The last line of a table does not end.
    EndMissing,
    /// A value is far beyond what the load can bring about.
    ValueImpossible,
}

impl Lack {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::VolumeDiffers => "volume-differs",
            Self::HeightNotCovered => "height-not-covered",
            Self::LengthNotCovered => "length-not-covered",
            Self::PlacesMissing => "places-missing",
            Self::RowsRepeated => "rows-repeated",
            Self::SamplesDiffer => "samples-differ",
            Self::TimeMissing => "time-missing",
            Self::ZerosInside => "zeros-inside",
            Self::Undeclared => "undeclared",
            Self::QuantityMissing => "quantity-missing",
            Self::EndMissing => "end-missing",
            Self::ValueImpossible => "value-impossible",
        }
    }
}

/// One thing that is missing from a result.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// What is missing.
    pub name: Lack,
    /// Where, and how much.
    pub sentence: String,
}

/// What a whole result would have.
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
    /// What the states of one result lack, one finding a kind.
    ///
    /// # Errors
    /// When the reference refuses a time.
    pub fn findings(&self, states: &[SampledState]) -> Result<Vec<Finding>, ExactError> {
        let mut findings = Vec::new();
        if self.has_volumes {
            findings.extend(self.volume(states)?);
        }
        findings.extend(self.first(states, Lack::HeightNotCovered, |state| self.bare_height(state)));
        findings.extend(self.first(states, Lack::LengthNotCovered, |state| self.bare_length(state)));
        findings.extend(self.first(states, Lack::PlacesMissing, |state| self.holes(state)));
        findings.extend(self.first(states, Lack::RowsRepeated, |state| {
            (state.repeated > 0).then(|| {
                format!(
                    "{} of {} rows repeat the place of another; where they are samples side by side, keep the column \
                     that tells them apart",
                    state.repeated,
                    state.initial_height.len()
                )
            })
        }));
        findings.extend(self.counts(states));
        Ok(findings)
    }

    /// The first state of which something is to be said, and how many more there are.
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
            more => format!("; so it is at {more} more of {} times", states.len()),
        };
        Some(Finding { name, sentence: format!("at {}, {what}{more}", self.when(state)) })
    }

    fn when(&self, state: &SampledState) -> String {
        format!("T_v = {}", short(self.parameters.time_factor(state.time)))
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
        let mut worst: Option<(usize, f64)> = None;
        for (place, (sum, time)) in sums.iter().zip(&times).enumerate() {
            let settled = reference.settlement(*time)? / self.parameters.height;
            let share = sum / whole - 1.0;
            let is_whole = (-VOLUME - settled.max(0.0)..=VOLUME).contains(&share);
            if !is_whole && worst.is_none_or(|(_, other)| share.abs() > other.abs()) {
                worst = Some((place, share));
            }
        }
        let of = if scene.is_some() { "that of the scene" } else { "the largest of all times" };
        Ok(worst.map(|(place, share)| Finding {
            name: Lack::VolumeDiffers,
            sentence: format!(
                "at {}, the volumes add up to {}, and {of} is {}: {:.2} % {}",
                self.when(&states[place]),
                short(sums[place]),
                short(whole),
                100.0 * share.abs(),
                if share < 0.0 { "are missing" } else { "are too many" }
            ),
        }))
    }

    /// A note where the volumes are in a unit of their own, so that their sum tells nothing.
    pub fn unit_of_volume(&self, states: &[SampledState]) -> Option<String> {
        let sum: f64 = states.first()?.volume.iter().sum();
        let is_other = |volume: &f64| ln(sum / volume).abs() > ln(OTHER_UNIT);
        let is_weight = self.has_volumes && !self.is_declared && self.volumes.iter().all(is_other);
        is_weight.then(|| {
            format!(
                "the volumes add up to {}, which is no volume of the scene: they are taken as weights; with \
                 `whole_volume` in the mapping their sum is checked",
                short(sum)
            )
        })
    }

    /// A note where samples lie at one height, or along a few verticals of a layer: they were
    /// chosen to be looked at.
    pub fn profiles(&self, states: &[SampledState]) -> Option<String> {
        let state = states.first()?;
        let heights = coverage::lines(&state.initial_height, self.parameters.height);
        let distances = coverage::lines(&state.initial_distance, self.parameters.length);
        let all = |lines: &[f64]| lines.iter().map(|line| short(*line)).collect::<Vec<_>>().join(", ");
        let place = if heights.len() == 1 {
            format!("y = {}", all(&heights))
        } else if self.is_plane() && distances.len() <= PROFILES {
            format!("x = {}", all(&distances))
        } else {
            return None;
        };
        Some(format!("the samples lie at {place} m: nothing is known of the rest"))
    }

    fn bare_height(&self, state: &SampledState) -> Option<String> {
        let is_one_height = |lines: &[f64]| lines.len() == 1;
        let can_scatter = !state.initial_distance.is_empty();
        let bare = bare_along(&state.initial_height, self.parameters.height, can_scatter, is_one_height);
        bare.map(|bare| stretch(bare, "over the base"))
    }

    fn bare_length(&self, state: &SampledState) -> Option<String> {
        let places = Some(&state.initial_distance).filter(|places| self.is_plane() && !places.is_empty())?;
        let are_profiles = |lines: &[f64]| lines.len() <= PROFILES;
        let bare = bare_along(places, self.parameters.length, true, are_profiles);
        bare.map(|bare| stretch(bare, "from the crest"))
    }

    fn holes(&self, state: &SampledState) -> Option<String> {
        if !self.is_plane() || state.repeated > 0 {
            return None;
        }
        let extent = [self.parameters.length, self.parameters.height];
        coverage::incomplete_lattice(&state.initial_distance, &state.initial_height, extent).map(|lattice| {
            format!(
                "samples stand at {} of the {} crossings of their lines",
                lattice.samples, lattice.crossings
            )
        })
    }

    fn counts(&self, states: &[SampledState]) -> Option<Finding> {
        let count = |state: &SampledState| state.initial_height.len();
        let most = states.iter().max_by_key(|state| count(state))?;
        let fewer: Vec<&SampledState> = states.iter().filter(|state| count(state) < count(most)).collect();
        let first = fewer.first()?;
        let more = match fewer.len() - 1 {
            0 => String::new(),
            more => format!("; fewer than the most there are at {more} more"),
        };
        Some(Finding {
            name: Lack::SamplesDiffer,
            sentence: format!(
                "{} has {} samples, and {} has {}{more}",
                self.when(first),
                count(first),
                self.when(most),
                count(most)
            ),
        })
    }

    fn is_plane(&self) -> bool {
        matches!(self.reference, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible)
    }
}

/// A bare stretch along one direction, of bands where the places lie without order; none where their lines were
/// chosen to be looked at.
fn bare_along(
    places: &[f64],
    extent: f64,
    can_scatter: bool,
    are_chosen: impl Fn(&[f64]) -> bool,
) -> Option<Bare> {
    let lines = coverage::lines(places, extent);
    let is_scattered = can_scatter && 2 * lines.len() > places.len() && lines.len() > 2 * PER_BIN;
    match (are_chosen(&lines), is_scattered) {
        (true, _) => None,
        (false, true) => empty_band(places, extent),
        (false, false) => coverage::bare(&lines, extent),
    }
}

/// A band in which no sample lies, where a dozen would on average.
fn empty_band(places: &[f64], extent: f64) -> Option<Bare> {
    let count = (places.len() / PER_BIN).clamp(2, 100);
    let length = extent / count as f64;
    let mut taken = vec![false; count];
    for place in places {
        let band = (0..count).find(|band| *place <= (*band + 1) as f64 * length).unwrap_or(count - 1);
        taken[band] = true;
    }
    let empty = taken.iter().position(|taken| !taken)?;
    let end = taken[empty..].iter().position(|taken| *taken).map_or(count, |more| empty + more);
    Some(Bare { from: empty as f64 * length, to: end as f64 * length })
}

/// The times that a result lacks.
pub fn missing_times(missing: &[f64], has: &[f64], asked: bool) -> Option<Finding> {
    let first = missing.first()?;
    let nearest = has.iter().copied().min_by(|a, b| (a - first).abs().total_cmp(&(b - first).abs()));
    let near = nearest.map_or(String::new(), |time| {
        format!(
            "; the nearest it has is T_v = {}, {:.2e} off in relative terms",
            short(time),
            (time / first - 1.0).abs()
        )
    });
    let more = match missing.len() {
        1 => String::new(),
        many => format!(" (and {} more)", many - 1),
    };
    let who = if asked { "which was asked for" } else { "which another result has" };
    Some(Finding {
        name: Lack::TimeMissing,
        sentence: format!("there is no T_v = {}{more}, {who}{near}", short(*first)),
    })
}

/// The mesh, by its place from the coarsest, that has far fewer samples a cell over the height than
/// another; the same number on all meshes is a choice of places.
pub fn uneven_meshes(
    meshes: &[(usize, &SampledState)],
    parameters: &ColumnParameters,
) -> Option<(usize, Finding)> {
    let height = parameters.height;
    let per_cell: Vec<f64> = meshes
        .iter()
        .map(|(cells, state)| {
            let lines = coverage::lines(&state.initial_height, height);
            // Nodes have one more than there are spacings.
            let reaches = |line: Option<&f64>, end: f64| {
                line.is_some_and(|y| (y - end).abs() <= coverage::SAME_PLACE * height)
            };
            let nodes = reaches(lines.first(), 0.0) && reaches(lines.last(), height);
            (lines.len() - usize::from(nodes)) as f64 / *cells as f64
        })
        .collect();
    let by_size = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
    let (fewest, least) = per_cell.iter().enumerate().min_by(by_size)?;
    let (most, largest) = per_cell.iter().enumerate().max_by(by_size)?;
    let count = |place: usize| meshes[place].1.initial_height.len();
    let are_alike = (0..meshes.len()).all(|place| count(place) == count(0));
    let is_uneven = *largest > UNEVEN * least && !are_alike;
    is_uneven.then(|| {
        let sentence = format!(
            "there are {} heights a cell, and {} on {} cells",
            short(*least),
            short(*largest),
            meshes[most].0
        );
        (fewest, Finding { name: Lack::SamplesDiffer, sentence })
    })
}

fn stretch(bare: Bare, from: &str) -> String {
    format!("no sample lies between {} m and {} m {from}", short(bare.from), short(bare.to))
}

/// A number in a sentence: six digits at most.
pub(crate) fn short(value: f64) -> String {
    let digits = format!("{value:.5e}");
    digits.parse::<f64>().map_or(digits, |rounded| {
        let is_plain = rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs());
        if is_plain { format!("{rounded}") } else { format!("{rounded:e}") }
    })
}
