//! `oedometer merge`: the records of shards into one folder, with the whole table of each study.

use crate::campaign::refinement;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::say;
use crate::cli::place::{DEFAULT_RESULTS, chosen_as, studies_of_this_project};
use crate::cli::study_files::{load, tell_of_passed_over, write_tables};
use crate::record::csv::TableForm;
use crate::record::provenance::Origins;
use crate::record::store::RecordStore;
use crate::record::{Record, WallSample};
use crate::study::check::Study;
use crate::study::shipped::{name_of, shipped_names};
use std::path::PathBuf;

/// Holes that are named before the rest is only counted.
const MOST_HOLES: usize = 10;

/// Arguments of `merge`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files (`*.toml`) and results folders; without study files, those of the project and the built-in ones
    /// with records in the folders
    #[arg(required = true, value_name = "STUDY.toml|DIR")]
    inputs: Vec<PathBuf>,
    /// Folder for the merged results
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    out: PathBuf,
    /// Test level of the required cases
    #[arg(long, alias = "test-level", value_enum, default_value_t = Tier::Full)]
    tier: Tier,
}

/// Merges and reports missing cases.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let is_study = |path: &&PathBuf| path.extension().is_some_and(|extension| extension == "toml");
    let (files, folders): (Vec<PathBuf>, Vec<PathBuf>) =
        arguments.inputs.iter().cloned().partition(|path| is_study(&path));
    if let Some(missing) = folders.iter().find(|folder| !folder.is_dir()) {
        return Err(Ended::usage(format!("there is no results folder {}", missing.display())));
    }
    let files = if files.is_empty() { known_to(&folders) } else { files };
    if files.is_empty() {
        let why = "the folders contain no results of a study of this project or of a built-in one";
        return Err(Ended::with(Exit::NothingSelected, why));
    }
    let studies = load(&files, None)?;
    // Every record is looked at before any is written.
    let origins = studies.iter().map(|study| origins_of(study, &folders, arguments));
    let origins = origins.collect::<anyhow::Result<Vec<Origins>>>()?;
    for (study, origins) in studies.iter().zip(&origins) {
        if let Some(differences) = origins.main().and_then(|main| origins.differences_from(main)) {
            say!(
                "{}: the records come from several builds of one program and have the same values: {differences}",
                study.name
            );
        }
    }
    let mut exit = Exit::Pass;
    for study in &studies {
        if merge_study(study, &folders, arguments)? > 0 {
            exit = Exit::IncompleteMerge;
        }
    }
    Ok(exit)
}

/// The studies of this project and the shipped ones that folders of results know.
fn known_to(folders: &[PathBuf]) -> Vec<PathBuf> {
    let mut known = studies_of_this_project().unwrap_or_default();
    let shipped = shipped_names().into_iter().filter(|name| chosen_as(name, &known).is_none());
    let shipped: Vec<PathBuf> = shipped.map(PathBuf::from).collect();
    known.extend(shipped);
    known.retain(|path| folders.iter().any(|folder| folder.join(name_of(&path.to_string_lossy())).is_dir()));
    known
}

/// The stores of a study in the target and in each other folder.
fn stores_of(study: &Study, folders: &[PathBuf], arguments: &Arguments) -> (RecordStore, Vec<RecordStore>) {
    let store = |folder: &PathBuf| RecordStore::new(folder, &study.name);
    let real = |folder: &PathBuf| folder.canonicalize().ok();
    let others =
        folders.iter().filter(|folder| real(folder) != real(&arguments.out) || real(folder).is_none());
    (store(&arguments.out).naming(&study.cases(Tier::Full)), others.map(store).collect())
}

/// What made the records of a study in target and folders: one program, of however many builds.
fn origins_of(study: &Study, folders: &[PathBuf], arguments: &Arguments) -> anyhow::Result<Origins> {
    let mut origins = Origins::default();
    let (target, others) = stores_of(study, folders, arguments);
    let cases = study.cases(arguments.tier);
    for store in std::iter::once(&target).chain(&others) {
        origins.join(&store.origins(&cases));
    }
    match origins.several_programs() {
        None => Ok(origins),
        Some(programs) => Err(Ended::with(
            Exit::IncompleteMerge,
            format!(
                "{}: the records come from several programs: {programs}; run all shards with the same one",
                study.name
            ),
        )),
    }
}

/// Brings the records of a study together; the number of holes that are left.
fn merge_study(study: &Study, folders: &[PathBuf], arguments: &Arguments) -> anyhow::Result<usize> {
    let (target, others) = stores_of(study, folders, arguments);
    std::iter::once(&target).chain(&others).for_each(|store| tell_of_passed_over(study, store));
    let mut holes: Vec<&Case> = Vec::new();
    let cases = study.cases(arguments.tier);
    for case in &cases {
        if !bring(study, case, &target, &others)? {
            holes.push(case);
        }
    }
    let there = cases.len() - holes.len();
    if there > 0 {
        target.note_named_cases()?;
    }
    if study.is_race {
        let records: Vec<Record> = cases.iter().filter_map(|case| target.kept(case)).collect();
        holes = refinement::wanted(study, holes, &records);
    }
    if there > 0 {
        let table = write_tables(study, &target, &[], TableForm::Plain)?;
        say!("{}: {there} of {} cases, {}", study.name, cases.len(), table.display());
    }
    for case in holes.iter().take(MOST_HOLES) {
        say!("{}: no result of {} {}", study.name, case.hash(), case.label());
    }
    if holes.len() > MOST_HOLES {
        say!("{}: and {} more; `plan --missing` lists them all", study.name, holes.len() - MOST_HOLES);
    }
    Ok(holes.len())
}

/// Brings the record of a case to the target, with the wall times of all stores that have it; whether there is one then.
fn bring(study: &Study, case: &Case, target: &RecordStore, others: &[RecordStore]) -> anyhow::Result<bool> {
    let having: Vec<&RecordStore> = others.iter().filter(|store| store.has(case)).collect();
    if having.is_empty() {
        return Ok(target.has(case));
    }
    let kept = target.kept(case);
    let mut merged = kept.clone().map(|record| (record, target));
    for store in having {
        let Some(other) = store.kept(case) else { continue };
        let Some((record, from)) = &mut merged else {
            merged = Some((other, store));
            continue;
        };
        // Builds of one program differ in the time they take and in nothing else.
        let values = |kept: &Record| Record {
            wall: Vec::new(),
            provenance: record.provenance.clone(),
            ..kept.clone()
        };
        if values(record) != values(&other) {
            return Err(Ended::with(
                Exit::IncompleteMerge,
                format!(
                    "{}: {} and {} have different results of {} {}, although both name the same program",
                    study.name,
                    from.folder().display(),
                    store.folder().display(),
                    case.hash(),
                    case.label()
                ),
            ));
        }
        if record.provenance.is_of_one_build_with(&other.provenance) {
            add_wall(&mut record.wall, other.wall);
        }
    }
    let Some((record, _)) = merged else { return Ok(false) };
    if kept.as_ref() != Some(&record) {
        target.write(&record)?;
    }
    Ok(true)
}

/// Adds the wall times of another store that are not here yet. A time that one store has twice was measured twice; what
/// two stores have in common is one measurement that was copied.
fn add_wall(wall: &mut Vec<WallSample>, others: Vec<WallSample>) {
    let mut here = wall.clone();
    for sample in others {
        match here.iter().position(|known| *known == sample) {
            Some(known) => {
                here.swap_remove(known);
            }
            None => wall.push(sample),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::outcome::Outcome;
    use crate::measure::record::record_of;
    use crate::record::{AttachedRun, Status};
    use crate::study::file::StudySource;

    fn times(wall: &[WallSample]) -> Vec<f64> {
        let mut seconds: Vec<f64> = wall.iter().map(|sample| sample.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        seconds
    }

    #[test]
    fn wall_times_are_merged_in_any_order_without_loss_and_once() {
        let mut seed = 7_u64;
        let mut dice = |count: u64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % count
        };
        for _ in 0..500 {
            let mut store = || -> Vec<WallSample> {
                let sample = |seconds| WallSample { seconds, alone: true, ..WallSample::default() };
                (0..dice(5)).map(|_| sample(0.5 * dice(3) as f64)).collect()
            };
            let stores = [store(), store(), store()];
            let merged = |order: [usize; 3]| {
                let mut wall = stores[order[0]].clone();
                order[1..].iter().for_each(|at| add_wall(&mut wall, stores[*at].clone()));
                wall
            };
            let first = merged([0, 1, 2]);
            for order in [[0, 2, 1], [1, 0, 2], [2, 1, 0], [1, 2, 0]] {
                assert_eq!(times(&merged(order)), times(&first), "{stores:?}");
            }
            for sample in &first {
                let count = |wall: &[WallSample]| wall.iter().filter(|one| *one == sample).count();
                let most = stores.iter().map(|store| count(store)).max();
                assert_eq!(Some(count(&first)), most, "a repeat is lost or counted twice: {stores:?}");
            }
            let mut again = first.clone();
            add_wall(&mut again, first.clone());
            assert_eq!(times(&again), times(&first), "the same store once more adds nothing");
        }
    }

    /// What is another in a record.
    type Change = fn(&mut Record);

    fn record(case: &Case, seconds: f64, change: Change) -> Record {
        let about = AttachedRun::default();
        let record = record_of(case, &[], Outcome::of_end(Status::Ok).made_by(about)).expect("a record");
        let wall = vec![WallSample { seconds, alone: true, ..WallSample::default() }];
        let mut record = Record { wall, ..record };
        change(&mut record);
        record
    }

    fn one_case() -> Study {
        let text = "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"MPM\"]\ncells = [4]\n";
        Study::check(&StudySource { name: "s.toml".to_owned(), text: text.to_owned() }).expect("sound")
    }

    #[test]
    fn wall_times_of_one_build_come_together_and_those_of_another_stay_out() {
        let study = one_case();
        let case = &study.planned[0].case;
        let changes: [(&str, bool, Change); 6] = [
            ("nothing", true, |_| {}),
            ("commit", true, |record| record.provenance.commit = "another".to_owned()),
            ("tree", true, |record| record.provenance.dirty ^= true),
            ("compiler", false, |record| record.provenance.compiler = "rustc 0.0.0".to_owned()),
            ("target", false, |record| record.provenance.target = "elsewhere".to_owned()),
            ("profile", false, |record| record.provenance.profile = "another".to_owned()),
        ];
        for (name, is_one_build, change) in changes {
            // The record of the other build stands first, in the middle, last.
            for place in 0..3 {
                let folder = tempfile::TempDir::new().expect("a folder");
                let store = |name: &str| RecordStore::new(&folder.path().join(name), "s");
                let (target, others) = (store("target"), ["a", "b", "c"].map(store));
                for (at, store) in others.iter().enumerate() {
                    let change = if at == place { change } else { |_: &mut Record| {} };
                    store.write(&record(case, (at + 1) as f64, change)).expect("written");
                }
                assert!(bring(&study, case, &target, &others).expect("alike"), "{name}");
                let own = [1.0, 2.0, 3.0];
                let wanted: Vec<f64> = match (is_one_build, place) {
                    (true, _) => own.to_vec(),
                    // The first record is the one that the others join.
                    (false, 0) => own[..1].to_vec(),
                    (false, _) => own.into_iter().filter(|seconds| *seconds != own[place]).collect(),
                };
                let kept = target.kept(case).expect("a record");
                assert_eq!(times(&kept.wall), wanted, "{name} at {place}");
            }
        }
    }

    #[test]
    fn records_with_unlike_values_are_no_merge_and_a_case_without_a_record_is_a_hole() {
        let study = one_case();
        let case = &study.planned[0].case;
        let folder = tempfile::TempDir::new().expect("a folder");
        let store = |name: &str| RecordStore::new(&folder.path().join(name), "s");
        let stores = ["a", "b"].map(store);
        assert!(!bring(&study, case, &store("target"), &stores).expect("nothing"), "a hole");
        stores[1].write(&record(case, 1.0, |_| {})).expect("written");
        assert!(bring(&study, case, &store("target"), &stores).expect("one record"));
        assert!(bring(&study, case, &store("target"), &[]).expect("the target's own"));
        stores[0].write(&record(case, 1.0, |record| record.counters.steps += 1)).expect("written");
        let told = bring(&study, case, &store("target"), &stores).expect_err("unlike");
        assert!(told.to_string().contains("have different results of"), "{told}");
    }
}
