//! Scores a result given as lists against the references of a scene.

use crate::api::error::ApiError;
use crate::api::{Meaning, runs_with};
use crate::case::Case;
use crate::case::quantity::Sample;
use crate::foreign::case_file::CaseFile;
use crate::import::mapping::{Axes, Mapping};
use crate::import::origins::{Origin, Origins, PartKind};
use crate::import::raw_row::{RawRow, SolvedBody};
use crate::import::run::Run;
use crate::import::{SampledState, states_of};
use crate::score::Score;
use crate::score::results::{Comparison, Results};
use crate::study::asked::Asked;
use crate::study::overrides::{Assignments, Outputs};
use oedometer_formats::ImportError;
use std::path::{Path, PathBuf};

/// Samples of a result. Lists of fields have one number per time and place, `[time][place]`, or are empty.
#[derive(Clone, Copy, Debug, Default)]
pub struct Samples<'a> {
    /// Times, s.
    pub time: &'a [f64],
    /// Initial heights over the base, m: one per place; of a slab the places across.
    pub height: &'a [f64],
    /// Distances from the crest of a layer's load, m, or from the middle of a slab to its drained side: one per place;
    /// empty for a column.
    pub distance: &'a [f64],
    /// Volumes or weights: one per place, or empty.
    pub volume: &'a [f64],
    /// Excess pore pressure, compression positive, Pa.
    pub pressure: &'a [f64],
    /// Vertical effective stress, tension positive, Pa.
    pub effective_stress: &'a [f64],
    /// Vertical displacement, upward positive, m.
    pub displacement: &'a [f64],
    /// Horizontal displacement, m.
    pub horizontal_displacement: &'a [f64],
    /// Settlement of the surface, downward positive, m: one per time, or empty.
    pub settlement: &'a [f64],
}

/// Scores samples against all references of a scene, or one of them. `assignments` are those of `--set`, `sample` is the
/// kind of places.
///
/// # Errors
/// When lists do not fit each other, a number is not finite, or the scene or a reference refuses its inputs.
pub fn score(
    scene: &str,
    samples: &Samples,
    sample: &str,
    reference: Option<&str>,
    assignments: &[String],
) -> Result<Score, ApiError> {
    let asked = asked(scene, reference, assignments)?;
    let case = asked.case();
    let kind = Sample::named(sample).ok_or_else(|| {
        let names = Sample::NAMES.join(", ");
        ApiError::UnknownName(format!("unknown kind of places `{sample}`: expected {names}"))
    })?;
    let mut mapping = Mapping::convention(Axes::of(case.scene))?;
    mapping.sample = kind;
    mapping.columns.volume = (!samples.volume.is_empty()).then(|| "volume".to_owned());
    let axes = Axes::of(case.scene);
    if axes != Axes::Column && samples.distance.is_empty() {
        let from = match axes {
            Axes::Slab => "middle of the slab to its drained side",
            _ => "crest of the load",
        };
        let why = format!("the fields of `{scene}` depend on it: give `distance`, m from the {from}");
        return Err(ApiError::Unfit(why));
    }
    let (states, contradictions) = samples.states(case, &mapping)?;
    let run = Run { files: vec!["arrays".into()], states, contradictions, ..Run::default() };
    let comparison = asked.comparison(&mapping);
    let mut results = Results::of(vec![run], &comparison)?;
    results
        .all
        .pop()
        .map(|one| one.score)
        .ok_or_else(|| ApiError::Unfit("there is nothing to score".to_owned()))
}

/// Scores files of another program: their names and a score per mesh, in the order of the files.
///
/// # Errors
/// When a file cannot be read or does not fit, with its name, or the scene or a reference refuses its inputs.
pub fn score_files(
    scene: &str,
    files: &[PathBuf],
    meaning: &Meaning,
    reference: Option<&str>,
    assignments: &[String],
) -> Result<Vec<(String, Score)>, ApiError> {
    let asked = asked(scene, reference, assignments)?;
    let case = asked.case();
    let (mapping, runs) = runs_with(files, meaning, SolvedBody::of(case), Axes::of(case.scene))?;
    let comparison = Comparison { are_cells_found: meaning.cells.is_empty(), ..asked.comparison(&mapping) };
    let mut results = Results::of(runs, &comparison)?;
    results.join_meshes();
    Ok(results.all.into_iter().map(|one| (one.name(), one.score)).collect())
}

/// The case file of a scene, as the commands of a study get it: what a solver that is tested in Python has to solve.
///
/// # Errors
/// When the scene refuses its inputs.
pub fn case_file(
    scene: &str,
    cells: usize,
    time_factors: &[f64],
    assignments: &[String],
) -> Result<String, ApiError> {
    let mut case = asked(scene, None, assignments)?.case().clone();
    if cells == 0 || time_factors.iter().any(|time| !(*time >= 0.0 && time.is_finite())) {
        return Err(ApiError::Unfit("give cells from 1 up and time factors from 0 up".to_owned()));
    }
    case.cells = cells;
    if !time_factors.is_empty() {
        let mut times = time_factors.to_vec();
        times.sort_by(f64::total_cmp);
        case.time_factors = times.into();
    }
    Ok(CaseFile::of(&case).text()?)
}

/// What a result is compared with.
fn asked(scene: &str, reference: Option<&str>, assignments: &[String]) -> Result<Asked, ApiError> {
    let outputs = Outputs {
        reference: reference.map(str::to_owned),
        time_factor: None,
        times: None,
        set: Assignments { assignments: assignments.to_vec() },
    };
    Ok(Asked::of_scene(scene, &outputs)?)
}

impl Samples<'_> {
    /// The lists as states, and what of them contradicts itself.
    fn states(&self, case: &Case, mapping: &Mapping) -> Result<(Vec<SampledState>, Vec<String>), ApiError> {
        self.check()?;
        let body = SolvedBody::of(case);
        let mut turned = *self;
        if mapping.is_turned {
            // The fields of a slab vary along x; what is across lies in the place of a layer's distance.
            (turned.height, turned.distance) = (self.distance, self.height);
            (turned.displacement, turned.horizontal_displacement) =
                (self.horizontal_displacement, self.displacement);
        }
        turned.rows(body, mapping)
    }

    /// The same of lists in the directions of a column.
    fn rows(
        &self,
        body: SolvedBody,
        mapping: &Mapping,
    ) -> Result<(Vec<SampledState>, Vec<String>), ApiError> {
        let mut origins = Origins::new(mapping);
        let arrays = Path::new("arrays");
        let mut rows = Vec::with_capacity(self.time.len() * self.height.len());
        for (at, time) in self.time.iter().enumerate() {
            let part = origins.add(arrays, arrays, PartKind::State(Some(at + 1)));
            for (place, height) in self.height.iter().enumerate() {
                let index = at * self.height.len() + place;
                let raw = RawRow {
                    time: *time,
                    x: self.distance.get(place).copied(),
                    y: *height,
                    volume: self.volume.get(place).copied(),
                    pressure: self.pressure.get(index).copied(),
                    // Files count compression positive, this interface tension.
                    stress: self.effective_stress.get(index).map(|stress| -stress),
                    displacement: self.displacement.get(index).copied(),
                    horizontal_displacement: self.horizontal_displacement.get(index).copied(),
                    moved: None,
                    others: place as u64,
                    set: Default::default(),
                    origin: Origin { part, line: 0 },
                };
                let refused = |why: String| {
                    ImportError::content(Path::new("arrays"), format!("[{at}][{place}]: {why}"))
                };
                rows.push(raw.sample(mapping, body, &refused)?);
            }
        }
        let (mut states, contradictions) = states_of(&rows, &origins)?;
        if !self.settlement.is_empty() {
            for state in &mut states {
                let at = self.time.iter().position(|time| *time == state.time);
                state.surface_displacement = at.map(|at| -self.settlement[at]);
            }
        }
        Ok((states, contradictions))
    }

    /// Refuses lists of the wrong length, numbers that are not finite, and a result without fields.
    fn check(&self) -> Result<(), ApiError> {
        let (times, places) = (self.time.len(), self.height.len());
        if times == 0 || places == 0 {
            let why = "there is no time or no place: give at least one of each";
            return Err(ApiError::Unfit(why.to_owned()));
        }
        let fields = [
            ("pressure", self.pressure),
            ("effective_stress", self.effective_stress),
            ("displacement", self.displacement),
            ("horizontal_displacement", self.horizontal_displacement),
        ];
        let others = [
            ("time", self.time, times),
            ("height", self.height, places),
            ("distance", self.distance, places),
            ("volume", self.volume, places),
            ("settlement", self.settlement, times),
        ];
        for (name, list) in fields {
            if !list.is_empty() && list.len() != times * places {
                return Err(ApiError::Unfit(format!(
                    "`{name}` has {} numbers for {times} times and {places} places: its shape is [time][place]",
                    list.len()
                )));
            }
        }
        for (name, list, wanted) in others {
            if !list.is_empty() && list.len() != wanted {
                let why = format!("`{name}` has {} numbers and needs {wanted}", list.len());
                return Err(ApiError::Unfit(why));
            }
        }
        let of_fields = fields.map(|(name, list)| (name, list, Some(places)));
        let of_others = others.map(|(name, list, _)| (name, list, None));
        for (name, list, row) in of_fields.into_iter().chain(of_others) {
            if let Some(at) = list.iter().position(|value| !value.is_finite()) {
                let place = row.map_or(format!("[{at}]"), |row| format!("[{}][{}]", at / row, at % row));
                return Err(ApiError::Unfit(format!("arrays: {place}: `{name}` is {}", list[at])));
            }
        }
        if fields.iter().all(|(_, list)| list.is_empty()) && self.settlement.is_empty() {
            let why =
                "there is nothing to score: give pressure, effective_stress, displacement or settlement";
            return Err(ApiError::Unfit(why.to_owned()));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::api::exact::exact;
    use crate::case::quantity::{Norm, Quantity};

    #[test]
    fn exact_lists_score_round_off_and_others_what_they_are_off_by() {
        let depths: Vec<f64> = (0..20).map(|place| (f64::from(place) + 0.5) / 20.0).collect();
        let load = ["column.load=1000.0".to_owned()];
        let found = exact("terzaghi", &[0.1, 0.2], &depths, &[], &load).expect("inside its range");
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
        // A volume belongs to its place at every time: an error where it is nothing is none.
        let mut wrong = found.pressure.clone();
        (wrong[3], wrong[20 + 3]) = (2.0 * wrong[3], 2.0 * wrong[23]);
        let volume: Vec<f64> = (0..20).map(|place| if place == 3 { 0.0 } else { 1.0 }).collect();
        let samples = Samples {
            time: &found.time,
            height: &height,
            volume: &volume,
            pressure: &wrong,
            ..Samples::default()
        };
        let blind = score("terzaghi", &samples, "centres", Some("terzaghi"), &load).expect("a score");
        let square = blind.errors.iter().filter(|row| row.norm == Norm::L2);
        assert!(
            square.clone().count() == 2 && square.clone().all(|row| row.value < 1e-9),
            "{:?}",
            blind.errors
        );
        let mut holed = found.pressure.clone();
        holed[3] = f64::NAN;
        assert!(with(&holed).is_err_and(|told| told.to_string().contains("[0][3]: `pressure` is NaN")));
        // A settlement that is not finite is an error, not a missing one.
        let settlement = [f64::NAN, 1e-6];
        let samples = Samples {
            time: &found.time,
            height: &height,
            pressure: &found.pressure,
            settlement: &settlement,
            ..Samples::default()
        };
        let told = score("terzaghi", &samples, "centres", None, &load).expect_err("no number").to_string();
        assert!(told.contains("[0]: `settlement` is NaN"), "{told}");
        assert!(
            with(&found.pressure[1..]).is_err_and(|told| told.to_string().contains("39 numbers for 2 times"))
        );
        // In the plane a place has a distance too.
        let samples = Samples { settlement: &[], pressure: &found.pressure, ..samples };
        let told =
            score("cosine-layer", &samples, "centres", None, &[]).expect_err("no distance").to_string();
        assert!(told.contains("give `distance`, m from the crest"), "{told}");
    }

    #[test]
    fn times_and_places_come_in_any_order_and_each_keeps_its_own_numbers() {
        let scored = |times: &[f64], depths: &[f64]| {
            let found = exact("terzaghi", times, depths, &[], &[]).expect("inside its range");
            let height: Vec<f64> = depths.iter().map(|depth| 1.0 - depth).collect();
            // Only the middle time is off, by one percent.
            let off = |values: &[f64], row: usize| -> Vec<f64> {
                let of = |at: usize| if times[at / row] == 0.2 { 1.01 } else { 1.0 };
                values.iter().enumerate().map(|(at, value)| of(at) * value).collect()
            };
            let samples = Samples {
                time: &found.time,
                height: &height,
                pressure: &off(&found.pressure, depths.len()),
                effective_stress: &found.effective_stress,
                displacement: &found.displacement,
                settlement: &off(&found.settlement, 1),
                ..Samples::default()
            };
            score("terzaghi", &samples, "centres", Some("terzaghi"), &[]).expect("a score")
        };
        let depths: Vec<f64> = (0..8).map(|place| (f64::from(place) + 0.5) / 8.0).collect();
        let turned: Vec<f64> = depths.iter().rev().copied().collect();
        for times in [[0.1, 0.2, 0.4], [0.4, 0.2, 0.1], [0.2, 0.4, 0.1], [0.2, 0.1, 0.4], [0.4, 0.1, 0.2]] {
            for depths in [&depths, &turned] {
                let found = scored(&times, depths);
                let of_settlement = found.errors.iter().filter(|row| row.quantity == Quantity::Settlement);
                assert_eq!(of_settlement.count(), 3, "{times:?}");
                for row in &found.errors {
                    let is_off = (row.time_factor - 0.2).abs() < 1e-9
                        && [Quantity::Settlement, Quantity::Pressure].contains(&row.quantity);
                    let wanted = if is_off { 0.01 } else { 0.0 };
                    assert!((row.value.abs() - wanted).abs() < 1e-9, "{times:?}: {row:?}");
                }
            }
        }
    }

    #[test]
    fn a_list_of_the_wrong_length_is_told_by_its_name() {
        let (two, three, six) = ([1.0, 2.0], [0.25, 0.5, 0.75], [1.0; 6]);
        let whole = Samples {
            time: &two,
            height: &three,
            distance: &three,
            volume: &three,
            pressure: &six,
            effective_stress: &six,
            displacement: &six,
            horizontal_displacement: &six,
            settlement: &two,
        };
        whole.check().expect("a result");
        for (samples, told) in [
            (Samples { time: &[], ..whole }, "there is no time or no place"),
            (Samples { height: &[], ..whole }, "there is no time or no place"),
            (Samples { distance: &two, ..whole }, "`distance` has 2 numbers and needs 3"),
            (Samples { volume: &two, ..whole }, "`volume` has 2 numbers and needs 3"),
            (Samples { settlement: &three, ..whole }, "`settlement` has 3 numbers and needs 2"),
            (Samples { pressure: &three, ..whole }, "`pressure` has 3 numbers for 2 times and 3 places"),
            (Samples { effective_stress: &two, ..whole }, "`effective_stress` has 2 numbers for"),
            (Samples { displacement: &two, ..whole }, "`displacement` has 2 numbers for"),
            (
                Samples { horizontal_displacement: &two, ..whole },
                "`horizontal_displacement` has 2 numbers for",
            ),
            (Samples { time: &[1.0, f64::NAN], ..whole }, "[1]: `time` is NaN"),
            (
                Samples { displacement: &[1.0, 1.0, 1.0, 1.0, 1.0, f64::INFINITY], ..whole },
                "[1][2]: `displacement` is inf",
            ),
            (
                Samples { time: &two, height: &three, ..Samples::default() },
                "there is nothing to score: give pressure",
            ),
        ] {
            assert!(
                samples.check().is_err_and(|error| error.to_string().contains(told)),
                "{told}: {:?}",
                samples.check()
            );
        }
        for alone in [
            Samples { time: &two, height: &three, settlement: &two, ..Samples::default() },
            Samples { time: &two, height: &three, horizontal_displacement: &six, ..Samples::default() },
        ] {
            alone.check().expect("a result");
        }
    }

    #[test]
    fn places_of_a_layer_keep_their_distance_and_errors_the_kind_of_places() {
        let (depths, x) = ([0.1, 0.5, 0.9], [0.0, 0.2, 0.6, 1.0]);
        let set = ["layer.length=3.0".to_owned()];
        let found = exact("cosine-layer", &[0.1], &depths, &x, &set).expect("inside");
        // Heights over the base of a layer 1 m high.
        let places = depths.iter().flat_map(|depth| x.iter().map(move |x| (1.0 - depth, 3.0 * x)));
        let (height, distance): (Vec<f64>, Vec<f64>) = places.unzip();
        let scored = |along: &[f64], sample: &str| {
            let samples = Samples {
                time: &found.time,
                height: &height,
                distance: &distance,
                pressure: &found.pressure,
                effective_stress: &found.effective_stress,
                displacement: &found.displacement,
                horizontal_displacement: along,
                ..Samples::default()
            };
            score("cosine-layer", &samples, sample, Some("cosine-layer"), &set).expect("a score").errors
        };
        for sample in ["points", "nodes", "centres"] {
            let rows = scored(&found.horizontal_displacement, sample);
            assert!(rows.iter().all(|row| row.value.abs() < 1e-9), "{rows:?}");
            assert!(rows.iter().any(|row| row.sample.name() == sample), "{sample}: {rows:?}");
        }
        let off: Vec<f64> = found.horizontal_displacement.iter().map(|along| 1.5 * along).collect();
        let largest = scored(&off, "points").into_iter().map(|row| row.value.abs()).fold(0.0, f64::max);
        assert!(largest > 1e-2, "a displacement along the layer counts: {largest}");
    }

    #[test]
    fn files_have_a_score_each_mesh_by_their_names_in_their_order() {
        let foreign = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign");
        let [ten, twenty, forty] = ["ogs", "ogs-20", "ogs-40"].map(|name| foreign.join(name).join("col.pvd"));
        let meaning = Meaning { preset: Some("ogs".to_owned()), ..Meaning::default() };
        let of = |files: &[PathBuf], reference| score_files("terzaghi", files, &meaning, reference, &[]);
        let files = [forty, ten, twenty];
        let found = of(&files, Some("terzaghi")).expect("scores");
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, files.each_ref().map(|file| file.to_str().expect("UTF-8")));
        let alone = files.map(|file| of(&[file], Some("terzaghi")).expect("a score").remove(0).1.errors);
        assert!(
            found.iter().zip(&alone).all(|((_, score), alone)| score.errors == *alone && !alone.is_empty())
        );
        assert!(alone[0] != alone[1] && alone[1] != alone[2], "each has its own");
        assert!(alone.iter().flatten().all(|row| row.reference == "terzaghi"));
        // Meshes in one order or another make the same series; their cells are found or given.
        let rows = |score: &Score| {
            score.series.iter().map(|row| (row.cells.clone(), row.classification.class)).collect::<Vec<_>>()
        };
        assert!(found.iter().all(|(_, score)| rows(score) == rows(&found[0].1) && !score.series.is_empty()));
        assert_eq!(found[0].1.series[0].cells, [10, 20, 40]);
        let told = of(&[foreign.join("none.pvd")], None).expect_err("no file").to_string();
        assert!(told.contains("none.pvd"), "{told}");
        let samples = Samples { time: &[1.0], height: &[0.5], pressure: &[1.0], ..Samples::default() };
        let told = score("terzaghi", &samples, "places", None, &[]).err().map(|error| error.to_string());
        let words = "unknown kind of places `places`: expected points, centres, nodes, surface";
        assert_eq!(told.as_deref(), Some(words));
    }
}
