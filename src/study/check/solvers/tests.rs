use crate::study::{Study, StudySource};
use std::fs;
use std::path::Path;

const SOLVER: &str = r#"
[[solver]]
name = "toy"
command = ["sh", "adapter.sh", "{case}", "{out}"]
result = "{out}/result.csv"
"#;

fn text(solver: &str, sweep: &str) -> String {
    format!("title = \"t\"\nscene = \"terzaghi\"\n{solver}\n[[sweep]]\n{sweep}\n")
}

const BESIDE: &str = "method = [\"GC-SRI-patch\", \"toy\"]\nintegrator = [\"explicit\", \"implicit\"]\n\
                      cells = [4, 8]";

fn checked(folder: &Path, text: &str) -> Result<Study, String> {
    let name = folder.join("s.toml").display().to_string();
    Study::check(&StudySource { name, text: text.to_owned() }).map_err(|error| error.to_string())
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::TempDir::new().expect("a folder");
    fs::write(folder.path().join("adapter.sh"), "one").expect("a file");
    folder
}

#[test]
fn a_solver_stands_among_the_methods_and_integrators_do_not_multiply_it() {
    let folder = folder();
    let study = checked(folder.path(), &text(SOLVER, BESIDE)).expect("sound");
    let labels: Vec<String> = study.planned.iter().map(|planned| planned.case.label()).collect();
    assert_eq!(labels.len(), 4 + 2, "{labels:?}");
    assert_eq!(labels.iter().filter(|label| label.starts_with("toy cells=")).count(), 2);
    let solver = study.solver_of(&study.planned[5].case).expect("its solver");
    assert_eq!((solver.name(), solver.repeats, solver.warm_up, solver.timeout), ("toy", 1, false, 3600.0));
}

#[test]
fn variables_that_no_system_passes_on_are_refused() {
    let folder = folder();
    let refused = |more: &str| {
        let text = text(&format!("{SOLVER}{more}\n"), "method = [\"toy\"]\ncells = [4]");
        checked(folder.path(), &text).err().unwrap_or_default()
    };
    for more in ["env = { \"A=B\" = \"1\" }", "env = { \"\" = \"1\" }", "env = { \"A\\u0000\" = \"1\" }"] {
        assert!(refused(more).contains("cannot be the name of a variable"), "{more}: {}", refused(more));
    }
    for more in ["env = { A = \"a\\u0000b\" }", "version = [\"sh\", \"\\u0000\"]"] {
        assert!(refused(more).contains("NUL"), "{more}: {}", refused(more));
    }
    assert_eq!(refused("env = { A = \"b=c\" }"), "", "a value may have one");
}

#[test]
fn the_identity_follows_the_adapter_and_the_command_and_no_path_or_time() {
    let hash = |folder: &Path, solver: &str| {
        let sweep = "method = [\"toy\"]\ncells = [4]";
        checked(folder, &text(solver, sweep)).expect("sound").planned[0].case.hash()
    };
    let (here, there) = (folder(), folder());
    let own = hash(here.path(), SOLVER);
    assert_eq!(hash(there.path(), SOLVER), own, "the folder is no part of it");
    for same in ["timeout = 5\n", "repeats = 3\n", "at_once = 2\n", "version = [\"sh\", \"--version\"]\n"] {
        assert_eq!(hash(here.path(), &format!("{SOLVER}{same}")), own, "{same}");
    }
    for (from, to) in [
        ("\"{case}\"", "\"{case}\", \"--fast\""),
        ("\"toy\"", "\"toy\"\nenv = { OMP_NUM_THREADS = \"1\" }"),
        ("\"toy\"", "\"toy\"\npreset = \"meshio\""),
        ("result.csv", "other.csv"),
    ] {
        assert_ne!(hash(here.path(), &SOLVER.replacen(from, to, 1)), own, "{to}");
    }
    let with_file = format!("{SOLVER}files = [\"template.prj\"]\n");
    fs::write(here.path().join("template.prj"), "1").expect("a file");
    let first = hash(here.path(), &with_file);
    fs::write(here.path().join("template.prj"), "2").expect("a file");
    assert!(first != own && hash(here.path(), &with_file) != first);
    let by_folder = SOLVER.replace("adapter.sh", "{study}/adapter.sh");
    let named = hash(here.path(), &by_folder);
    fs::write(here.path().join("adapter.sh"), "two").expect("a file");
    assert_ne!(hash(here.path(), SOLVER), own, "another adapter is another case");
    assert_ne!(hash(here.path(), &by_folder), named, "wherever its name begins");
}

#[test]
fn what_cannot_be_a_solver_is_refused_at_its_place() {
    let folder = folder();
    for (from, to, told) in [
        ("name = \"toy\"", "name = \"GIMP\"", "`GIMP` is a method of this program"),
        ("name = \"toy\"", "name = \"to y\"", "a solver cannot be called `to y`"),
        ("{out}/result.csv", "result.csv", "must lie below `{out}`"),
        ("{out}/result.csv", "{out}/../old.csv", "must lie below `{out}`"),
        ("\"{case}\"", "\"{cases}\"", "did you mean `case`?"),
        ("[\"sh\", \"adapter.sh\", \"{case}\", \"{out}\"]", "[]", "the command is empty"),
        ("name = \"toy\"", "name = \"toy\"\npreset = \"osg\"", "did you mean `ogs`?"),
        ("name = \"toy\"", "name = \"toy\"\nmapping = \"no.toml\"", "there is no file"),
        ("name = \"toy\"", "name = \"toy\"\nrepeats = 0", "`repeats` is 0"),
        ("name = \"toy\"", "name = \"toy\"\ntimeout = -1.0", "`timeout` is -1 s"),
        ("name = \"toy\"", "name = \"toy\"\nsolve_seconds = \"took [0-9]+\"", "no group for the seconds"),
        ("name = \"toy\"", "name = \"toy\"\nsolve_seconds = \"took ([0-9]+\"", "not a regular expression"),
        ("name = \"toy\"", "name = \"toy\"\nversion = [\"sh\", \"{case}\"]", "has a placeholder, `{case}`"),
    ] {
        let solver = SOLVER.replacen(from, to, 1);
        let error = checked(folder.path(), &text(&solver, BESIDE)).expect_err(to);
        assert!(error.contains(told) && error.contains("s.toml:"), "{to}: {error}");
        // A sweep that names a refused solver makes no mistake of its own.
        let is_renamed = to.starts_with("name = \"GIMP") || to.starts_with("name = \"to y");
        assert_eq!(error.matches("error: ").count() > 1, is_renamed, "{to}: {error}");
    }
    let twice = format!("{SOLVER}{SOLVER}");
    assert!(
        checked(folder.path(), &text(&twice, BESIDE))
            .expect_err("twice")
            .contains("the name of another solver")
    );
    let unknown = checked(folder.path(), &text("", BESIDE)).expect_err("no solver");
    assert!(unknown.contains("no method is called `toy`"), "{unknown}");
    let searched = text(SOLVER, BESIDE).replacen("scene", "task = \"stability\"\nscene", 1);
    assert!(checked(folder.path(), &searched).expect_err("no search").contains("critical step"));
}

#[test]
fn another_content_or_another_reading_of_a_result_is_another_case() {
    let folder = folder();
    let hash = |more: &str| {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\n[[result]]\nname = \"table\"\nfiles = [\"p-{{cells}}.csv\"]\ncells = [4]\n{more}\n"
        );
        checked(folder.path(), &text).expect("sound").planned[0].case.hash()
    };
    fs::write(folder.path().join("p-4.csv"), "t,y,p\n").expect("a file");
    let own = hash("");
    assert_eq!(hash(""), own);
    assert_ne!(hash("time_step = 2.0"), own, "times that are read otherwise");
    fs::write(folder.path().join("p-4.csv"), "t,y,p\n1,0,0\n").expect("a file");
    assert_ne!(hash(""), own, "another content");
}

/// A part of a collection, a link and a curve are inputs as the file that names them is; the formats
/// that name others are walked in `crates/formats/src/named_files.rs`.
#[test]
fn a_change_in_any_file_that_a_given_result_is_read_from_makes_another_case() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("a.pvd", "<VTKFile type=\"Collection\"><DataSet timestep=\"1\" file=\"part.pvtu\"/></VTKFile>");
    write("part.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><Piece Source=\"piece.vtu\"/></VTKFile>");
    let mapping = "[columns]\np = \"p\"\n[settlement]\nfile = \"curve.csv\"\n[units]\ntime = \"s\"\nlength = \"m\"\n\
                   stress = \"Pa\"\n[sign]\np = \"compression-positive\"\n";
    write("m.toml", mapping);
    for name in ["piece.vtu", "one.csv", "curve.csv"] {
        write(name, "before");
    }
    let hash = |files: &str| {
        let result = format!(
            "[[result]]\nname = \"given\"\ncells = [4]\nfiles = [\"{files}\"]\nmapping = \"m.toml\"\n"
        );
        let text = text(&result, "method = [\"MPM\"]\ncells = [4]");
        let study = checked(folder.path(), &text).expect("sound");
        let case = study.planned.iter().find(|planned| study.solver_of(&planned.case).is_some());
        case.expect("a given result").case.hash()
    };
    for (files, changed) in
        [("a.pvd", "piece.vtu"), ("one.csv", "one.csv"), ("one.csv", "curve.csv"), ("one_*.csv", "curve.csv")]
    {
        let before = hash(files);
        assert_eq!(before, hash(files), "{files}");
        write(changed, "after");
        assert_ne!(before, hash(files), "{files}: {changed}");
        write(changed, "before");
        assert_eq!(before, hash(files), "{files}");
    }
}
