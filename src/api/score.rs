//! Somebody else's result, given as lists, held against the references of a scene.

use crate::api::sentence;
use crate::case::Case;
use crate::case::quantity::Sample;
use crate::cli::commands::score::results::{Comparison, Results};
use crate::cli::commands::score::study_of;
use crate::cli::overrides::{Assignments, Outputs};
use crate::import::mapping::Mapping;
use crate::import::raw_row::{RawRow, SolvedBody};
use crate::import::runs::Run;
use crate::import::{SampledState, states_of};
use crate::judge::score::Score;
use oedometer_formats::ImportError;
use std::path::Path;

/// Samples of a result: of each list that is there one number a time and place, `[time][place]`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Samples<'a> {
    /// Times, s.
    pub time: &'a [f64],
    /// Initial heights over the base, m: one a place.
    pub height: &'a [f64],
    /// Distances from the crest of a layer's load, m: one a place; empty for a column.
    pub distance: &'a [f64],
    /// Volumes or weights: one a place, or empty.
    pub volume: &'a [f64],
    /// Excess pore pressure, compression positive, Pa.
    pub pressure: &'a [f64],
    /// Vertical effective stress, tension positive, Pa.
    pub effective_stress: &'a [f64],
    /// Vertical displacement, upward positive, m.
    pub displacement: &'a [f64],
    /// Horizontal displacement, m.
    pub horizontal_displacement: &'a [f64],
    /// Settlement of the surface, downward positive, m: one a time, or empty.
    pub settlement: &'a [f64],
}

/// Scores samples against the references of a scene, or one of them. `assignments` are those of `--set`, `sample` the
/// name of the kind of places.
///
/// # Errors
/// When lists do not fit each other, a number is none, or the scene or a reference refuses.
pub fn score(
    scene: &str,
    samples: &Samples,
    sample: &str,
    reference: Option<&str>,
    assignments: &[String],
) -> Result<Score, String> {
    let outputs = Outputs {
        reference: reference.map(str::to_owned),
        time_factor: None,
        set: Assignments { assignments: assignments.to_vec() },
    };
    let (study, _) = study_of(scene, &outputs).map_err(|error| sentence(&error))?;
    let case = &study.planned[0].case;
    let kind = Sample::ALL.into_iter().find(|kind| kind.name() == sample);
    let kind = kind.ok_or_else(|| {
        let names = Sample::ALL.map(Sample::name).join(", ");
        format!("no kind of places is called `{sample}`; there are {names}")
    })?;
    let mut mapping =
        Mapping::convention(case.scene.has_plane_fields()).map_err(|error| error.to_string())?;
    mapping.sample = kind;
    mapping.columns.volume = (!samples.volume.is_empty()).then(|| "volume".to_owned());
    let run = Run { files: vec!["arrays".into()], states: samples.states(case, &mapping)?, ..Run::default() };
    let references: Vec<_> = study.references.iter().map(|kind| kind.of_soil(&case.material)).collect();
    let comparison = Comparison {
        case,
        mapping: &mapping,
        references: &references,
        requested: &[],
        tolerance: 1e-3,
        are_cells_found: false,
    };
    let results = Results::of(vec![run], &comparison).map_err(|error| sentence(&error))?;
    results
        .scores()
        .first()
        .map(|score| (*score).clone())
        .ok_or_else(|| "there is nothing to score".to_owned())
}

impl Samples<'_> {
    /// The lists as states, every number looked at.
    fn states(&self, case: &Case, mapping: &Mapping) -> Result<Vec<SampledState>, String> {
        let (times, places) = (self.time.len(), self.height.len());
        if times == 0 || places == 0 {
            return Err("there is no time or no place: give at least one of each".to_owned());
        }
        self.lists_fit(times, places)?;
        let body = SolvedBody::of(case);
        let mut rows = Vec::with_capacity(times * places);
        for (at, time) in self.time.iter().enumerate() {
            for place in 0..places {
                let refused = |why: String| {
                    ImportError::content(Path::new("arrays"), format!("[{at}][{place}]: {why}"))
                };
                let number = |list: &[f64], index: usize, name: &str| match list.get(index) {
                    None => Ok(None),
                    Some(value) if value.is_finite() => Ok(Some(*value)),
                    Some(value) => Err(refused(format!("`{name}` is {value}")).to_string()),
                };
                let index = at * places + place;
                let stress = number(self.effective_stress, index, "effective_stress")?;
                let raw = RawRow {
                    time: number(&[*time], 0, "time")?.unwrap_or_default(),
                    x: number(self.distance, place, "distance")?,
                    y: number(self.height, place, "height")?.unwrap_or_default(),
                    volume: number(self.volume, place, "volume")?,
                    pressure: number(self.pressure, index, "pressure")?,
                    // The convention of files counts compression positive, that of this program tension.
                    stress: stress.map(|stress| -stress),
                    displacement: number(self.displacement, index, "displacement")?,
                    horizontal_displacement: number(
                        self.horizontal_displacement,
                        index,
                        "horizontal_displacement",
                    )?,
                    moved: None,
                    others: place as u64,
                };
                rows.push(raw.sample(mapping, body, &refused).map_err(|error| error.to_string())?);
            }
        }
        let mut states = states_of(&rows).map_err(|error| error.to_string())?;
        if let Some(at) = self.settlement.iter().position(|settlement| !settlement.is_finite()) {
            return Err(format!("arrays: [{at}]: `settlement` is {}", self.settlement[at]));
        }
        if !self.settlement.is_empty() {
            for state in &mut states {
                let at = self.time.iter().position(|time| *time == state.time);
                state.surface_displacement = at.map(|at| -self.settlement[at]);
            }
        }
        Ok(states)
    }

    fn lists_fit(&self, times: usize, places: usize) -> Result<(), String> {
        let fields = [
            ("pressure", self.pressure),
            ("effective_stress", self.effective_stress),
            ("displacement", self.displacement),
            ("horizontal_displacement", self.horizontal_displacement),
        ];
        for (name, list) in fields {
            if !list.is_empty() && list.len() != times * places {
                return Err(format!(
                    "`{name}` has {} numbers for {times} times and {places} places: its shape is [time][place]",
                    list.len()
                ));
            }
        }
        for (name, list, wanted) in [
            ("distance", self.distance, places),
            ("volume", self.volume, places),
            ("settlement", self.settlement, times),
        ] {
            if !list.is_empty() && list.len() != wanted {
                return Err(format!("`{name}` has {} numbers and {wanted} are needed", list.len()));
            }
        }
        if fields.iter().all(|(_, list)| list.is_empty()) && self.settlement.is_empty() {
            return Err("nothing is given to score: pressure, effective_stress, displacement or settlement"
                .to_owned());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::api::exact::exact;
    use crate::case::quantity::Quantity;

    #[test]
    fn exact_lists_score_round_off_and_others_what_they_are_off_by() {
        let depths: Vec<f64> = (0..20).map(|place| (f64::from(place) + 0.5) / 20.0).collect();
        let load = ["column.load=1000.0".to_owned()];
        let found = exact("terzaghi", &[0.1, 0.2], &depths, &load).expect("inside its range");
        let height: Vec<f64> = depths.iter().map(|depth| 1.0 - depth).collect();
        let with = |pressure: &[f64]| {
            let samples = Samples {
                time: &found.time,
                height: &height,
                pressure,
                effective_stress: &found.effective_stress,
                displacement: &found.displacement,
                settlement: &found.settlement,
                ..Samples::default()
            };
            score("terzaghi", &samples, "centres", Some("terzaghi"), &load)
        };
        let clean = with(&found.pressure).expect("a score");
        assert!(clean.errors.len() >= 2 * (3 * 3 + 1), "{}", clean.errors.len());
        assert!(clean.errors.iter().all(|row| row.value.abs() < 1e-9), "{:?}", clean.errors);
        assert!(clean.errors.iter().any(|row| row.quantity == Quantity::Settlement));
        let off: Vec<f64> = found.pressure.iter().map(|pressure| 1.01 * pressure).collect();
        let off = with(&off).expect("a score");
        let pressures = off.errors.iter().filter(|row| row.quantity == Quantity::Pressure);
        assert!(
            pressures.clone().count() > 0 && pressures.clone().all(|row| (row.value - 0.01).abs() < 1e-9)
        );
        let mut holed = found.pressure.clone();
        holed[3] = f64::NAN;
        assert!(with(&holed).is_err_and(|told| told.contains("[0][3]") && told.contains("NaN")));
        // One that is none is no settlement that nobody gave.
        let settlement = [f64::NAN, 1e-6];
        let samples = Samples {
            time: &found.time,
            height: &height,
            pressure: &found.pressure,
            settlement: &settlement,
            ..Samples::default()
        };
        let told = score("terzaghi", &samples, "centres", None, &load).expect_err("no number");
        assert!(told.contains("[0]: `settlement` is NaN"), "{told}");
        assert!(with(&found.pressure[1..]).is_err_and(|told| told.contains("39 numbers for 2 times")));
    }
}
