//! The interface for other languages: names, lists of numbers and `key=value` texts in, lists and plain values out.
//!
//! It computes nothing and calls what the command line calls, so that a number in Python is the number that
//! `oedometer` prints. Numbers are in SI; lists over places are `[time][place]`, one time after the other.

pub mod convergence;
pub mod error;
pub mod exact;
pub mod score;

use crate::api::error::ApiError;
use crate::case::keys::Key;
use crate::foreign::reading::mapping_file;
use crate::import::SampledState;
use crate::import::given_files::{are_tables, files_of};
use crate::import::mapping::{Axes, Mapping};
use crate::import::raw_row::SolvedBody;
use crate::import::run::Run;
use crate::import::runs::runs_of;
use crate::study::file::StudySource;
use crate::study::solver::Preset;
use crate::study::synonyms::read_as;
use clap::ValueEnum;
use oedometer_exact::reference::ReferenceKind;
use oedometer_exact::{AddedKey, TextbookProblem};
use oedometer_scenes::Scene;
use std::path::PathBuf;

/// A solution by its name, and the scene of its column.
///
/// # Errors
/// When no solution has the name: lists the names.
pub fn scene_of(solution: &str) -> Result<(ReferenceKind, &'static Scene), ApiError> {
    let kind: ReferenceKind = read_as(solution).parse().map_err(|_| {
        let textbook = TextbookProblem::ALL.map(ReferenceKind::Textbook);
        let names: Vec<&str> = ReferenceKind::ALL.iter().chain(&textbook).map(|kind| kind.name()).collect();
        let known = names.join(", ");
        ApiError::UnknownName(format!("there is no exact solution `{solution}`; there are {known}"))
    })?;
    Ok((kind, Scene::of_solution(kind)))
}

/// The dotted key of a study file for a bare name, such as `material.porosity` for `porosity`; a name with a dot stays.
/// Geometry and load belong to the table that the scene has for them.
///
/// # Errors
/// When no scene, solution or input has the name: lists the names.
pub fn dotted_key(scene: &str, name: &str) -> Result<String, ApiError> {
    if name.contains('.') {
        return Ok(name.to_owned());
    }
    if let Ok(kind) = scene.parse::<ReferenceKind>()
        && let Some(added) = AddedKey::ALL.iter().find(|added| kind.takes(added) && added.name() == name)
    {
        return Ok(added.key.to_owned());
    }
    let scene = match Scene::named(scene) {
        Some(scene) => scene,
        None => scene_of(scene)?.1,
    };
    let body = scene.body.table();
    let tables = [body, "material", "integrator", "points"];
    let found = tables.iter().find(|table| Key::named(name, table).is_some());
    found.map(|table| format!("{table}.{name}")).ok_or_else(|| {
        let names: Vec<&str> =
            [body, "material"].iter().flat_map(|table| Key::in_table(table)).map(|key| key.name).collect();
        let (scene, known) = (scene.name, names.join(", "));
        ApiError::UnknownName(format!("`{scene}` has no input `{name}`; it has {known}"))
    })
}

/// What the columns or arrays of files mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meaning {
    /// The program that wrote them; for tables and by default the convention.
    pub preset: Option<String>,
    /// A mapping file, which overrides the preset key by key.
    pub mapping: Option<PathBuf>,
    /// The text of a mapping in place of a file.
    pub mapping_text: Option<String>,
    /// Cells over the height of each result, in the order of the files; each table is then a separate result.
    pub cells: Vec<usize>,
    /// Seconds from one numbered step to the next, where file names have the number of the step.
    pub time_step: Option<f64>,
}

/// Reads files with a preset's mapping (tables with the convention), one list of states per mesh. `time_step` is
/// that of `--set-time-step`, s.
///
/// # Errors
/// When a file cannot be read or does not fit, with its name.
pub fn read(
    files: &[PathBuf],
    preset: &str,
    time_step: Option<f64>,
    height: f64,
) -> Result<Vec<Vec<SampledState>>, ApiError> {
    let body = SolvedBody { height, length: None, seconds_per_time_factor: 1.0 };
    let meaning = Meaning { preset: Some(preset.to_owned()), time_step, ..Meaning::default() };
    let (_, runs) = runs_with(files, &meaning, body, Axes::Column)?;
    Ok(runs.into_iter().map(|run| run.states).collect())
}

/// The mapping of files, and their results, one per mesh.
pub(crate) fn runs_with(
    files: &[PathBuf],
    meaning: &Meaning,
    body: SolvedBody,
    axes: Axes,
) -> Result<(Mapping, Vec<Run>), ApiError> {
    let given = files_of(files)?;
    let is_tables = are_tables(&given)?;
    let own = meaning.mapping.clone().map(mapping_file).transpose()?;
    let typed = meaning.mapping_text.clone().map(|text| StudySource { name: "the mapping".to_owned(), text });
    let own = own.or(typed);
    let default = (own.is_none() && !is_tables).then_some("meshio");
    let named = meaning.preset.as_deref().filter(|_| !is_tables).or(default);
    let preset =
        named.map(|name| Preset::from_str(name, false)).transpose().map_err(ApiError::UnknownName)?;
    let mut mapping = Mapping::resolve(preset, own.as_ref(), axes)?;
    if let Some(step) = meaning.time_step {
        if !(step.is_finite() && step > 0.0) {
            let why = format!("a time step of {step} is invalid: give seconds above 0");
            return Err(ApiError::Unfit(why));
        }
        mapping.time.step = Some(step);
    }
    // With as many numbers of cells as files each file is a mesh.
    let is_by_mesh = !meaning.cells.is_empty() && (is_tables || meaning.cells.len() == given.len());
    let each = if is_by_mesh { 1 } else { given.len().max(1) };
    let runs: Result<Vec<Vec<Run>>, _> =
        given.chunks(each).map(|some| runs_of(some, &mapping, body)).collect();
    let mut runs = runs?.concat();
    if !meaning.cells.is_empty() && meaning.cells.len() != runs.len() {
        let (cells, results) = (meaning.cells.len(), runs.len());
        let why = format!("`cells` has {cells} numbers for {results} results: give one per result");
        return Err(ApiError::Unfit(why));
    }
    for (run, cells) in runs.iter_mut().zip(&meaning.cells) {
        if *cells == 0 {
            let why = "a result has 0 cells: give whole numbers from 1 up";
            return Err(ApiError::Unfit(why.to_owned()));
        }
        run.cells = Some(*cells);
    }
    if let Some(run) = runs.iter().find(|run| run.sample.is_some()) {
        mapping.sample = run.sample(&mapping);
    }
    Ok((mapping, runs))
}
#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_scenes::{COSINE_LAYER, MANDEL, TERZAGHI};

    #[test]
    fn a_bare_name_finds_its_table() {
        for (scene, name, key) in [
            ("terzaghi", "porosity", "material.porosity"),
            ("terzaghi-incompressible", "load", "column.load"),
            ("cosine-layer", "load", "layer.load"),
            ("terzaghi", "column.load", "column.load"),
        ] {
            assert_eq!(dotted_key(scene, name).expect("a key"), key);
        }
        let told = dotted_key("terzaghi", "permeability").expect_err("no such key").to_string();
        let start = "`terzaghi` has no input `permeability`; it has height, ";
        assert!(told.starts_with(start) && told.contains(", hydraulic_conductivity, "), "{told}");
        let told = dotted_key("terzagi", "load").expect_err("no such problem").to_string();
        let start = "there is no exact solution `terzagi`; there are terzaghi, terzaghi-incompressible, ";
        assert!(
            told.starts_with(start)
                && told.ends_with(TextbookProblem::ALL[TextbookProblem::ALL.len() - 1].name()),
            "{told}"
        );
        for (solution, scene) in
            [("terzaghi-incompressible", &TERZAGHI), ("cosine-layer", &COSINE_LAYER), ("mandel", &MANDEL)]
        {
            let (kind, found) = scene_of(solution).expect("a solution");
            assert_eq!((kind.name(), found), (solution, scene));
        }
    }

    #[test]
    fn a_preset_that_is_named_is_the_one_that_is_taken() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let file = folder.path().join("a.vtk");
        let text = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 0 1 0\n\
                    FIELD f 1\nTIME 1 1 float\n3\nPOINT_DATA 2\nSCALARS {name} float\nLOOKUP_TABLE default\n2 1\n";
        let read_as = |name: &str, preset: &str| {
            std::fs::write(&file, text.replace("{name}", name)).expect("written");
            read(std::slice::from_ref(&file), preset, None, 1.0)
        };
        assert_eq!(read_as("pressure", "meshio").expect("a state")[0][0].pressure.len(), 2);
        assert!(read_as("pressure", "nonsense").is_err_and(|told| told.to_string().contains("nonsense")));
        let [water, pressure] = ["WATER_PRESSURE", "pressure"].map(|name| read_as(name, "kratos"));
        let state = &water.expect("a state")[0][0];
        assert_eq!(state.pressure[0], -2.0, "suction is positive there");
        assert!(pressure.is_err(), "there is no such array");
    }

    #[test]
    fn a_bare_name_is_a_key_that_its_scene_takes() {
        for (scene, name, key) in [
            ("mandel", "load", "column.load"),
            ("mandel", "width", "column.width"),
            ("cosine-layer", "length", "layer.length"),
            ("terzaghi", "height", "column.height"),
            ("xie-leo", "porosity", "material.porosity"),
        ] {
            assert_eq!(dotted_key(scene, name).expect("a key"), key, "{scene}");
            let value = if name == "porosity" { "0.35" } else { "2.0" };
            let found = exact::exact(scene, &[0.1], &[], &[0.5], &[format!("{key}={value}")]);
            assert!(found.is_ok() || scene == "terzaghi" || scene == "xie-leo", "{scene}: {found:?}");
        }
        // A key of a textbook problem is that problem's alone.
        assert_eq!(dotted_key("seabed", "period").expect("a key"), "wave.period");
        for problem in ["davis-raymond", "terzaghi"] {
            assert!(dotted_key(problem, "period").is_err(), "{problem}");
        }
    }

    #[test]
    fn a_time_step_numbers_files_and_a_mapping_stands_alone_unless_a_preset_is_named() {
        use crate::import::mapping::DeclaredBy::{Convention, Preset, User};
        let folder = tempfile::TempDir::new().expect("a folder");
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).expect("written");
            folder.path().join(name)
        };
        let file = write(
            "a_4.vtk",
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 0 1 0\nPOINT_DATA 2\n\
             SCALARS pressure float\nLOOKUP_TABLE default\n2 1\n",
        );
        let table = write("a.csv", "t,y,p,u_y\n3,0.5,7,0\n");
        let own = write("m.toml", "[columns]\ny = \"coordinates[1]\"\np = \"pressure\"\nu_y = \"\"\n");
        let read_at = |step: Option<f64>| read(std::slice::from_ref(&file), "meshio", step, 1.0);
        assert_eq!(read_at(Some(0.5)).expect("a state")[0][0].time, 2.0);
        assert!(read_at(None).is_err(), "its time is given nowhere");
        for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(read_at(Some(step)).is_err_and(|told| told.to_string().contains("is invalid")), "{step}");
        }
        let states = read(std::slice::from_ref(&table), "kratos", None, 1.0).expect("the convention");
        assert_eq!((states[0][0].time, states[0][0].pressure[0]), (3.0, 7.0));
        let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 1.0 };
        for (file, preset, mapping, wanted) in [
            (&file, None, None, Preset("meshio")),
            (&file, None, Some(&own), User),
            (&file, Some("meshio"), Some(&own), Preset("meshio")),
            (&table, None, None, Convention),
        ] {
            let meaning = Meaning {
                preset: preset.map(str::to_owned),
                mapping: mapping.cloned(),
                time_step: Some(0.5),
                ..Meaning::default()
            };
            let (found, _) =
                runs_with(std::slice::from_ref(file), &meaning, body, Axes::Column).expect("a state");
            assert_eq!(found.declared_by, wanted);
        }
        // Names that differ by numbers alone are steps of one mesh, unless each has its cells.
        let later = file.with_file_name(
            file.file_name().and_then(|name| name.to_str()).expect("a name").replace('4', "8"),
        );
        std::fs::copy(&file, &later).expect("a copy");
        for (cells, count) in [(vec![], 1), (vec![5, 10], 2)] {
            let meaning = Meaning { time_step: Some(0.5), cells, ..Meaning::default() };
            let found =
                runs_with(&[file.clone(), later.clone()], &meaning, body, Axes::Column).expect("states");
            assert_eq!(found.1.len(), count, "{:?}", meaning.cells);
        }
        // What the files show of their places goes over what a preset takes for granted, and not over a mapping's word.
        let foreign = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign/kratos-vtk");
        let nodes = std::fs::read_dir(foreign).expect("files").flatten().map(|entry| entry.path());
        let nodes = nodes
            .filter(|path| path.extension().is_some_and(|ending| ending == "vtk"))
            .min()
            .expect("a file");
        let said = write("s.toml", "sample = \"points\"\n[columns]\np = \"WATER_PRESSURE\"\nu_y = \"\"\n");
        let arrays = write("w.toml", "[columns]\np = \"WATER_PRESSURE\"\nu_y = \"\"\n");
        for (mapping, sample) in [(&said, "points"), (&arrays, "nodes")] {
            let meaning = Meaning {
                preset: Some("meshio".to_owned()),
                mapping: Some(mapping.clone()),
                time_step: Some(0.08175),
                ..Meaning::default()
            };
            let (found, _) =
                runs_with(std::slice::from_ref(&nodes), &meaning, body, Axes::Column).expect("a state");
            assert_eq!(found.sample.name(), sample);
        }
        let none = Meaning { mapping: Some(folder.path().join("none.toml")), ..Meaning::default() };
        let told = runs_with(std::slice::from_ref(&table), &none, body, Axes::Column)
            .expect_err("no mapping")
            .to_string();
        let start = format!("cannot read the mapping {}: ", folder.path().join("none.toml").display());
        assert!(told.starts_with(&start), "{told}");
    }
}
