//! `compare`, `history` and `bisect` on a repository of ten commits: one makes results worse, one does not build, one
//! crashes, one only renames.

use crate::all_commands::place::git;
use crate::packs::change_records;
use crate::program::{PROGRAM, Told, call, call_with};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// The commit that makes the results worse.
const WORSE: &str = "Take a larger porosity";

const STUDY: &str = "title = \"Gate\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.1], references = [\"terzaghi\"] }\n\
                     [material]\nporosity = 0.3\n[[sweep]]\nmethod = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\n\
                     cells = [5, 10]\ntime_step = [{ growth = 0.05 }]\n";

/// Golden values of two cases with an error each.
fn golden(errors: [f64; 2], reason: &str) -> String {
    let mut text = format!(
        "# schema = 2\n# study = \"gate\"\n# reason = \"{reason}\"\n# relative_tolerance = 1e-9\n\
         # absolute_tolerance = 1e-12\n# basis = \"a test\"\n#\n# [provenance]\n# version = \"0.2.0\"\n# sources = \"0\"\n\
         # commit = \"0\"\n# dirty = false\n# compiler = \"c\"\n# target = \"t\"\n# profile = \"p\"\n\
         case,T_v,point updates,pressure points l2 terzaghi\n"
    );
    for (cells, error) in [(5, errors[0]), (10, errors[1])] {
        let label = format!("GIMP-SRI implicit cells={cells} points=2 growth=0.05");
        let _ = write!(text, "{label},,{},\n{label},0.1,,{error:?}\n", 100 * cells);
    }
    text
}

fn repository() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let write = |name: &str, text: &str| {
        let path = at.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    };
    let commit = |subject: &str| {
        git(at, &["add", "-A"]);
        git(at, &["commit", "-q", "--allow-empty", "-m", subject]);
    };
    let run = format!("exec '{PROGRAM}' run $(find . -name gate.toml) --out \"$1\"\n");
    git(at, &["init", "-q"]);
    write("gate.toml", STUDY);
    write("run.sh", &run);
    write("build.sh", "true\n");
    write("golden/gate.csv", &golden([8e-2, 4e-2], "first values"));
    commit("Add a gate");
    git(at, &["tag", "good"]);
    write("README", "a gate\n");
    commit("Describe the gate");
    git(at, &["mv", "gate.toml", "moved.toml"]);
    fs::create_dir(at.join("studies")).expect("made");
    git(at, &["mv", "moved.toml", "studies/gate.toml"]);
    commit("Move the study");
    write("run.sh", "kill -9 $$\n");
    commit("Crash");
    write("run.sh", &run);
    // In the middle, where the search begins.
    write("build.sh", "exit 1\n");
    commit("Break the build");
    write("build.sh", "true\n");
    commit("Mend the build");
    commit("Change nothing");
    write("studies/gate.toml", &STUDY.replace("porosity = 0.3", "porosity = 0.45"));
    write("golden/gate.csv", &golden([8e-2, 5e-2], "a larger porosity"));
    commit(WORSE);
    write("golden/gate.csv", &golden([8e-2, 6e-2], "worse again"));
    commit("Accept more");
    commit("Change nothing again");
    folder
}

#[test]
fn bisect_finds_the_commit_that_moved_the_results_and_skips_what_cannot_be_tried() {
    let folder = repository();
    let before = git(folder.path(), &["status", "--porcelain"]);
    let told = call(
        folder.path(),
        &[
            "bisect",
            "gate",
            "--good",
            "good",
            "--bad",
            "HEAD",
            "--build",
            "sh build.sh",
            "--run",
            "sh run.sh {out}",
        ],
    );
    assert_eq!(told.code, 0, "{}", told.err);
    let first = told.out.lines().next().expect("a commit");
    assert!(first.ends_with(WORSE), "{}{}", told.out, told.err);
    assert!(told.out.contains(" moved, in 2 cases"), "{}", told.out);
    assert!(told.err.contains(" skip: Break the build"), "{}", told.err);
    let skipped: Vec<&str> = told.out.lines().filter_map(|line| line.strip_prefix("  skipped ")).collect();
    let why = " Break the build: the build failed: exit status: 1: it printed nothing";
    assert!(skipped.iter().any(|line| line.ends_with(why) && line.len() == 8 + why.len()), "{skipped:?}");
    // The user's own work tree is as it was.
    assert_eq!(git(folder.path(), &["status", "--porcelain"]), before);
    assert_eq!(git(folder.path(), &["worktree", "list"]).lines().count(), 1);
    let nothing = call(
        folder.path(),
        &["bisect", "gate", "--good", "good", "--bad", "good~0", "--run", "sh run.sh {out}"],
    );
    assert_eq!(nothing.code, 4, "{}", nothing.err);
    assert!(nothing.err.contains("no value differs between"), "{}", nothing.err);
}

#[test]
fn history_marks_the_step_and_compare_tells_it() {
    let folder = repository();
    let at = folder.path();
    let told = call(at, &["history", "gate", "--format", "csv"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let rows: Vec<&str> = told.out.lines().collect();
    assert_eq!(rows.len(), 4, "{}", told.out);
    // Geometric means over both errors, chained: √(5/4), then times √(6/5).
    let place = rows[0].split(',').position(|name| name.starts_with("error index")).expect("a column");
    let index = |row: &str| -> f64 { row.split(',').nth(place).expect("a field").parse().expect("a number") };
    assert!((index(rows[2]) - 1.25_f64.sqrt()).abs() < 1e-6, "{}", rows[2]);
    assert!((index(rows[3]) - 1.5_f64.sqrt()).abs() < 1e-6, "{}", rows[3]);
    assert!(rows[1].contains("first values") && rows[1].contains("same"), "{}", rows[1]);
    assert!(rows[2].contains("regressed") && rows[2].contains(WORSE), "{}", rows[2]);

    let told = call(at, &["compare", "good", "HEAD"]);
    assert_eq!(told.code, 1, "{}", told.err);
    let words = told.words();
    assert!(words.contains("regressed") && words.contains("porosity"), "{}", told.out);
    assert!(words.contains("0.3") && words.contains("0.45"), "{}", told.out);
    let same = call(at, &["compare", "HEAD~1", "HEAD"]);
    assert_eq!(same.code, 0, "{}{}", same.out, same.err);

    // Records of two runs: the study as it was and as it is.
    for (revision, out) in [("good", "a"), ("HEAD", "b")] {
        git(at, &["checkout", "-q", revision]);
        let study = if revision == "good" { "gate.toml" } else { "studies/gate.toml" };
        assert_eq!(call(at, &["run", study, "--out", out]).code, 0);
        git(at, &["checkout", "-q", "-"]);
    }
    let told = call(at, &["compare", "a", "b", "--format", "json"]);
    assert_eq!(told.code, 1, "{}{}", told.out, told.err);
    let found: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    assert_eq!(found[0]["study"], "gate");
    assert_eq!(found[0]["inputs"][0]["key"], "porosity");
    assert_eq!(found[0]["cost"], "same");
    assert_eq!(call(at, &["compare", "a", "a"]).code, 0);
}

#[test]
fn inside_a_hook_of_another_repository_the_one_of_the_folder_is_read() {
    let (folder, other) = (repository(), TempDir::new().expect("a folder"));
    git(other.path(), &["init", "-q"]);
    fs::write(other.path().join("README"), "another\n").expect("written");
    git(other.path(), &["add", "-A"]);
    git(other.path(), &["commit", "-q", "-m", "Begin"]);
    let at = |name: &str| other.path().join(name).display().to_string();
    for command in [&["history", "gate", "--format", "csv"][..], &["compare", "good", "HEAD"]] {
        let plain = call(folder.path(), command);
        let variables = [
            ("GIT_DIR", at(".git")),
            ("GIT_WORK_TREE", at("")),
            ("GIT_INDEX_FILE", at(".git/index")),
            ("GIT_COMMON_DIR", at(".git")),
            ("GIT_OBJECT_DIRECTORY", at(".git/objects")),
        ];
        let differs = |(_, told): &(&str, Told)| {
            (told.code, &told.out, &told.err) != (plain.code, &plain.out, &plain.err)
        };
        let found = variables
            .map(|(variable, value)| (variable, call_with(folder.path(), &[(variable, &value)], command)));
        let misled: Vec<&str> =
            found.iter().filter(|one| differs(one)).map(|(variable, _)| *variable).collect();
        assert_eq!(misled, [""; 0], "{command:?}");
    }
}

#[test]
fn what_cannot_be_compared_is_refused_in_sentences() {
    let folder = repository();
    let refused = |at: &Path, arguments: &[&str], part: &str| {
        let Told { code, err, .. } = call(at, arguments);
        assert!(code == 2 || code == 4, "{arguments:?}: {err}");
        assert!(err.contains(part), "{arguments:?}: {err}");
    };
    let at = folder.path();
    refused(at, &["compare", "good", "no-such-thing"], "is neither a folder nor a revision");
    refused(at, &["compare", "studies", "HEAD"], "has no records");
    refused(at, &["compare", "good", "HEAD", "--golden", "elsewhere"], "has no golden values in elsewhere/");
    refused(at, &["history", "other"], "no commit has golden values");
    refused(
        at,
        &["bisect", "gate", "--good", "no-such-thing", "--bad", "HEAD"],
        "is neither a folder nor a revision",
    );
    let outside = TempDir::new().expect("a folder");
    refused(outside.path(), &["history"], "is not in a git repository");
    let [there, root] = [outside.path(), at].map(|folder| folder.canonicalize().expect("a folder"));
    let told = format!("error: {} lies outside the repository {}\n", there.display(), root.display());
    refused(at, &["history", "--golden", &there.display().to_string()], &told);
    // A golden file of another layout is passed over with a word.
    fs::write(at.join("golden/gate.csv"), "{\"schema\": 1}\n").expect("written");
    git(at, &["commit", "-q", "-a", "-m", "Write another layout"]);
    let told = call(at, &["history"]);
    assert!(told.code == 0 && told.err.contains("is skipped"), "{}", told.err);
    for number in 2..6 {
        fs::write(at.join("golden/gate.csv"), format!("{{\"schema\": {number}}}\n")).expect("written");
        git(at, &["commit", "-q", "-a", "-m", "Write one more"]);
    }
    let told = call(at, &["history"]);
    let lines: Vec<&str> = told.err.lines().collect();
    assert_eq!((lines.len(), lines[3]), (4, "and 2 more"), "{}", told.err);
}

/// A solver in Python, right but for a factor, with its study.
fn attached(at: &Path) {
    let solver = |factor: &str| {
        format!(
            "import json, math, pathlib, sys\n\
             case = json.loads(pathlib.Path(sys.argv[1]).read_text())\n\
             cells, height = case['cells'], case['column']['height']\n\
             with open(pathlib.Path(sys.argv[2]) / 'result.csv', 'w') as result:\n\
             \x20   result.write('t,y,p,u_y\\n')\n\
             \x20   for time, factor in zip(case['times'], case['time_factors']):\n\
             \x20       u, before, load = 0.0, None, case['column']['load']\n\
             \x20       for node in range(cells + 1):\n\
             \x20           k = [(2 * m + 1) * math.pi / 2 for m in range(60)]\n\
             \x20           p = sum(2 / a * math.sin(a * (1 - node / cells)) * math.exp(-a * a * factor) for a in k)\n\
             \x20           p *= load * (1 + {factor})\n\
             \x20           if node > 0:\n\
             \x20               u -= height / cells * (load - (p + before) / 2) / case['derived']['oedometric_modulus']\n\
             \x20           before = p\n\
             \x20           result.write(f'{{time!r}},{{node * height / cells!r}},{{p!r}},{{u!r}}\\n')\n"
        )
    };
    for (name, factor) in [("good.py", "0.3 / cells**2"), ("worse.py", "0.3 / cells"), ("crash.py", "1 / 0")]
    {
        fs::write(at.join(name), solver(factor)).expect("written");
    }
    fs::write(at.join("nodes.toml"), "sample = \"nodes\"\n").expect("written");
    fs::write(
        at.join("own.toml"),
        "title = \"Own\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.1], references = [\"terzaghi-incompressible\"] }\n\
         [[solver]]\nname = \"own\"\ncommand = [\"python3\", \"-I\", \"-S\", \"good.py\", \"{case}\", \"{out}\"]\n\
         result = \"{out}/result.csv\"\nmapping = \"nodes.toml\"\ntimeout = 60.0\n\
         [[sweep]]\nmethod = [\"own\"]\ncells = [8, 16, 32]\n",
    )
    .expect("written");
}

#[test]
fn two_commands_of_an_attached_solver_are_compared_in_rounds() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    attached(at);
    let compare = |b: &str, more: &[&str]| {
        let a = "python3 -I -S good.py {case} {out}";
        call(
            at,
            &[&["compare", "--commands", a, b, "own.toml", "--allow-solvers", "--rounds", "2"], more]
                .concat(),
        )
    };
    let same = compare("python3 -I -S good.py {case} {out}", &[]);
    assert_eq!(same.code, 0, "{}{}", same.out, same.err);
    let worse = compare("python3 -I -S worse.py {case} {out}", &["--format", "json"]);
    assert_eq!(worse.code, 1, "{}{}", worse.out, worse.err);
    let found: serde_json::Value = serde_json::from_str(&worse.out).expect("JSON");
    assert_eq!((&found[0]["accuracy"], &found[0]["cost"]), (&"regressed".into(), &"same".into()));
    let orders = found[0]["orders"].as_array().expect("orders that changed");
    let of_pressure =
        |one: &&serde_json::Value| one["series"].as_str().is_some_and(|name| name.contains("pressure nodes"));
    let pressure = orders.iter().find(of_pressure).expect("the order of the pressure");
    let [before, after] = ["before", "after"].map(|side| pressure[side]["order"].as_f64());
    assert!((before.expect("an order") - 2.0).abs() < 0.1, "{found:#}");
    assert!((after.expect("an order") - 1.0).abs() < 0.1, "{found:#}");
    for side in 0..2 {
        let [least, most] = ["least", "most"].map(|name| found[0]["seconds"][side][name].as_f64());
        assert!(least.expect("timed") <= most.expect("timed"), "{found:#}");
    }
    let crash = compare("python3 -I -S crash.py {case} {out}", &[]);
    assert_eq!(crash.code, 1, "{}{}", crash.out, crash.err);
    for (arguments, told) in [
        (&["compare", "--commands", "a", "b"][..], "takes one study file"),
        (&["compare", "--commands", "a", "", "own.toml", "--allow-solvers"], "the command is empty"),
    ] {
        let refused = call(at, arguments);
        assert!(refused.code != 0 && refused.err.contains(told), "{arguments:?}: {}", refused.err);
    }
    // What would be started is asked about, not what the study names.
    let asked =
        call_with(at, &[("OEDOMETER_ALLOW_SOLVERS", "")], &["compare", "--commands", "a", "b", "own.toml"]);
    assert!(asked.code == 6 && asked.err.contains("runs `a` in"), "{}", asked.err);
}

#[test]
fn states_that_are_not_whole_are_told_in_sentences() {
    let folder = repository();
    let at = folder.path();
    // Golden values of the first layout are passed over with a word, and so is what is not committed.
    fs::write(at.join("golden/old.json"), "{}\n").expect("written");
    git(at, &["add", "-A"]);
    git(at, &["commit", "-q", "-m", "Write the first layout"]);
    fs::write(at.join("golden/gate.csv"), golden([9e-2, 9e-2], "not committed")).expect("written");
    let told = call(at, &["history"]);
    assert!(told.code == 0 && told.err.contains("1 golden file in JSON is skipped"), "{}", told.err);
    assert!(told.err.contains("uncommitted changes"), "{}", told.err);
    git(at, &["checkout", "-q", "--", "golden/gate.csv"]);
    // Records of another layout.
    assert_eq!(call(at, &["run", "studies/gate.toml", "--out", "a"]).code, 0);
    change_records(&at.join("a"), "gate", |number, record| record.schema += u32::from(number == 0));
    let told = call(at, &["compare", "a", "a"]);
    assert!(told.err.contains("1 record of `gate`") && told.err.contains("skipped"), "{}", told.err);
    // A shallow clone, and no git at all.
    let clone = TempDir::new().expect("a folder");
    let from = format!("file://{}", at.display());
    git(clone.path(), &["clone", "-q", "--depth", "1", &from, "shallow"]);
    let shallow = clone.path().join("shallow");
    let told = call(&shallow, &["history"]);
    assert!(told.err.contains("the clone is shallow"), "{}", told.err);
    let told = call(&shallow, &["compare", "HEAD~3", "HEAD"]);
    assert!(told.code == 2 && told.err.contains("git fetch --unshallow"), "{}", told.err);
    let without = Command::new(PROGRAM).arg("history").current_dir(at).env("PATH", "").output().expect("run");
    let said = String::from_utf8_lossy(&without.stderr);
    assert!(!without.status.success() && said.contains("cannot start `git`"), "{said}");
}

/// Golden values and records know a case by its label, which names what the study sweeps: `porosity`.
#[test]
fn records_of_earlier_states_of_a_study_are_left_out_and_each_case_keeps_its_label() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let run = |conductivity: &str, cells: &str, out: &str| {
        let sweep = format!("porosity = [0.3, 0.4]\ncells = {cells}");
        let text = STUDY.replace("cells = [5, 10]", &sweep);
        let text = text.replace("porosity = 0.3\n", &format!("hydraulic_conductivity = {conductivity}\n"));
        fs::write(at.join("gate.toml"), text).expect("written");
        assert_eq!(call(at, &["run", "gate.toml", "--resume", "--out", out]).code, 0);
    };
    run("1e-4", "[5, 10]", "kept");
    run("2e-4", "[5, 10]", "kept");
    run("2e-4", "[5]", "kept");
    run("2e-4", "[5]", "fresh");
    let compared = || {
        let told = call(at, &["compare", "fresh", "kept", "--format", "json"]);
        let json: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
        (told, json)
    };
    let (told, json) = compared();
    assert!(
        told.err.contains("`gate` in kept: 6 records of earlier states of the study are left out"),
        "{}",
        told.err
    );
    assert!(!told.err.contains("`gate` in fresh"), "{}", told.err);
    assert_eq!((told.code, &json[0]["unpaired"]), (0, &serde_json::json!(0)), "{}", told.out);
    change_records(&at.join("kept"), "gate", |_, record| {
        for row in record.errors.iter_mut().filter(|_| record.case.material.porosity == 0.4) {
            (row.value, row.absolute) = (2.0 * row.value, 2.0 * row.absolute);
        }
    });
    let (told, json) = compared();
    let changes = json[0]["changes"].as_array().expect("changes");
    assert_eq!((told.code, changes.len()), (1, 1), "{}", told.out);
    assert!(changes[0]["case"].as_str().is_some_and(|case| case.ends_with("(porosity=0.4)")), "{}", told.out);
    // A run that is refused names nothing.
    let endless = STUDY.replace("implicit", "explicit").replace("growth = 0.05", "stable = 0.5");
    let endless = endless.replace("porosity = 0.3", "hydraulic_conductivity = 1e-12");
    fs::write(at.join("gate.toml"), endless).expect("written");
    let told = call(at, &["run", "gate.toml", "--out", "refused"]);
    assert!(told.code == 2 && !at.join("refused").exists(), "{}", told.err);
    run("2e-4", "[5]", "kept");
    // A merge brings what the study names.
    assert_eq!(call(at, &["merge", "gate.toml", "kept", "--out", "merged"]).code, 0);
    assert!(!call(at, &["compare", "fresh", "merged"]).err.contains("left out"));
}
