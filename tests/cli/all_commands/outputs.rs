//! Every subcommand on small inputs: its exit code and what it writes to both outputs, whole. And what `score` says of a result
//! whose table or mapping has one edit.

use crate::all_commands::place::git;
use crate::program::{PROGRAM, assert_snapshot, call};
use oedometer::{GoldenFile, RecordStore, RunOptions, Study, StudySource, Tier, run_study};
use regex_lite::{Captures, Regex};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const STUDY: &str = r#"title = "A short study"
summary = "Which order?"
scene = "terzaghi"
column = { height = 2.5, load = 40.0 }
material = { youngs_modulus = 3.2e6, porosity = 0.37 }
output.time_factors = [0.1, 0.3]

[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [3, 5, 8]
time_step = [{ growth = 0.2 }]

[[expect]]
method = "MPM"
time_factor = 0.1
order = { value = 1.0, minus = 0.6, plus = 0.6 }
"#;

/// A text without what differs from run to run, from machine to machine and from build to build; long numbers have the digits
/// that every machine has in common.
pub fn steady(text: &str, folder: &Path) -> String {
    let text = text.replace(&folder.display().to_string(), "FOLDER").replace(PROGRAM, "oedometer");
    let changes = [
        // Wall times, cores and builds.
        (r"(point updates, |takes |core, |about |longest case |after )[0-9.e-]+ (s|ms)\b", "$1# s"),
        (r#"("(wall|cpu|own|estimated)?_?seconds": )[0-9.e-]+"#, "$1#"),
        (r"\b\d+ here\b", "# here"),
        (r"[0-9.]+ times the mean", "# times the mean"),
        (r"(?m)^([0-9a-f]{16},ok,[^\n]*?,\d+),.*$", "$1,MACHINE"),
        (
            r"(?m)^(\| `?s`? +\|[^\n]*(same|mixed|improved|regressed)[^\n]*)\|[^|\n]*\|[^|\n]*\|$",
            "$1| # | # |",
        ),
        (
            r"(?m)^(s +[✓✗•] \w+ +[✓✗•] \w+( +[0-9,]+){4} +(– \[\w\]|[0-9.e-]+)) +[0-9.e-]+( \([^)\n]*\))? +[0-9.e-]+( \([^)\n]*\))?$",
            "$1 # #",
        ),
        (r"(?m)^(s,(same|mixed|improved|regressed),[^\n]*),[^,\n]*,[^,\n]*$", "$1,#,#"),
        (" {2,}", " "),
        ("-{3,}:?", "---"),
        (r"20\d\d-\d\d-\d\d", "DAY"),
        (r"oedometer \d+\.\d+\.\d+[^\n]*", "oedometer VERSION"),
    ];
    let text = changes.into_iter().fold(text, |text, (what, by)| {
        Regex::new(what).expect("a pattern").replace_all(&text, by).into_owned()
    });
    // Hashes of cases and commits: hexadecimal words with a letter.
    let word = Regex::new(r"[A-Za-z0-9_.]{7,40}").expect("a pattern");
    let is_hash = |word: &str| {
        word.bytes().all(|letter| matches!(letter, b'0'..=b'9' | b'a'..=b'f')) && word.parse::<u64>().is_err()
    };
    let hash = |found: &Captures| if is_hash(&found[0]) { "HASH".to_owned() } else { found[0].to_owned() };
    let text = word.replace_all(&text, hash);
    let number = Regex::new(r"-?\d+\.\d{5,}(e-?\d+)?|-?\d+(\.\d+)?e-1[1-9]|-?\d+(\.\d+)?e-[2-9]\d")
        .expect("a pattern");
    let short = |found: &Captures| match found[0].parse::<f64>() {
        Ok(tiny) if tiny.abs() < 1e-11 => "≈0".to_owned(),
        Ok(number) => format!("{number:.3e}"),
        Err(_) => found[0].to_owned(),
    };
    number.replace_all(&text, short).into_owned()
}

/// What a call says, with at most so many lines of its output.
fn told(text: &mut String, folder: &Path, words: &[&str], most: usize) {
    let said = call(folder, words);
    let lines: Vec<&str> = said.out.lines().collect();
    let shown = lines[..lines.len().min(most)].join("\n");
    let more = if lines.len() > most { format!("\n… {} lines in all", lines.len()) } else { String::new() };
    let (out, err) = (steady(&(shown + &more), folder), steady(said.err.trim_end(), folder));
    write!(text, "$ oedometer {}\n[{}]\n", words.join(" "), said.code).expect("memory");
    for part in [out, err].iter().filter(|part| !part.is_empty()) {
        writeln!(text, "{part}").expect("memory");
    }
    text.push('\n');
}

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

const ASKING: [&str; 46] = [
    "list",
    "list --show terzaghi-mesh",
    "list --show nothing",
    "exact terzaghi --time-factor 0.1,0.3 --zeta 0,0.35,1",
    "exact terzaghi --degree 0.5,0.9 --zeta 0.5 --set column.height=2.5 --set column.load=40",
    "exact terzaghi --degree 1.5 --zeta 0.5",
    "exact terzaghi --time-factor 0.1 --degree 0.5",
    "exact terzaghi-incompressible --time-factor 0.1 --zeta 0.5 --format json",
    "exact single-mode --time-factor 0.1 --zeta 0.25",
    "exact xie-leo --time-factor 0.1 --zeta 0.25 --set column.load=1e5",
    "exact dynamic-column --time-factor 1e-4 --zeta 0.25",
    "exact standing-wave --time-factor 1e-5 --zeta 0.25",
    "exact cosine-layer --time-factor 0.1 --zeta 0.25 --x 0,0.25",
    "exact mandel --time-factor 0.1 --x 0,0.5",
    "exact footing --time-factor 1",
    "exact sealed-element --time-factor 0.1 --zeta 0.5",
    "exact yield-front --time-factor 0.0002 --zeta 0.01",
    "exact layered --time-factor 0.1 --zeta 0.25 --set column.soils=[{thickness=0.5},{thickness=0.5,hydraulic_conductivity=1e-6}]",
    "exact terzaghi --zeta 2",
    "exact terzaghi --x 0.5",
    "exact terzaghi --set column.heigth=2",
    "exact terzaghi --set material.porosity=2",
    "exact nobody",
    "solve terzaghi --cells 3 --integrator implicit --time-factor 0.1,0.3 --set column.height=2.5",
    "solve terzaghi --cells 3 --integrator implicit --time-factor 0.1 --format csv",
    "solve terzaghi --cells 3 --integrator implicit --time-factor 0.1 --format json",
    "solve terzaghi --cells 3 --integrator implicit --time-factor 0.1 --reference terzaghi --points-per-cell 3 --point-wise",
    "solve terzaghi --cells 3 --integrator semi-implicit --time-step growth=0.2 --time-factor 0.1 --method MPM",
    "solve terzaghi --cells 3 --time-step stable=3 --time-factor 0.01 --set material.hydraulic_conductivity=1e-3",
    "solve cosine-layer --cells 2 --integrator implicit --time-step seconds=0.1 --time-factor 0",
    "solve mandel --cells 5 --integrator implicit --time-factor 0.1 --format csv",
    "solve footing --cells 1 --integrator implicit --time-step growth=0.5 --format csv",
    "solve terzaghi --time-step seconds=0.5,1",
    "solve terzaghi --reference mandel",
    "solve terzaghi --method VPX",
    "solve terzaghi --cells 0",
    "stability terzaghi --method MPM,GIMP-SRI --cells 4 --points-per-cell 2,3 --time-factor 0.001",
    "stability terzaghi --cells 4 --format csv --time-factor 0.001",
    "stability terzaghi --cells 4 --format json --time-factor 0.001",
    "stability manufactured-box",
    "schema study",
    "schema record",
    "schema mapping",
    "schema case",
    "schema nothing",
    "completions nothing",
];

#[test]
fn what_needs_no_study_is_told_as_it_was() {
    let folder = TempDir::new().expect("a folder");
    let mut text = String::new();
    for line in ASKING {
        told(&mut text, folder.path(), &words(line), 60);
    }
    for word in words(
        "exact solve stability score run check accept explain plan merge compare history bisect report list new schema records completions",
    ) {
        told(&mut text, folder.path(), &[word, "--help"], 200);
    }
    assert_snapshot("commands_without_a_study", &text);
}

/// Takes golden values of the study in a folder; the program itself takes none from sources that no commit has.
fn take_golden(at: &Path) {
    let text = fs::read_to_string(at.join("s.toml")).expect("a study");
    let study = Study::check(&StudySource { name: "s.toml".to_owned(), text }).expect("a sound study");
    let report = run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {});
    let golden = GoldenFile::of("s", &report.records, "a test");
    golden.write(&at.join("golden")).expect("written");
}

/// A study that is planned, run, shared, merged and judged.
const FIRST: &[&str] = &[
    "plan s.toml",
    "plan s.toml --format json --tier smoke",
    "plan s.toml --format json",
    "plan s.toml --tasks 2 --balance",
    "plan none.toml",
    "run s.toml --jobs 1",
    "run s.toml --jobs 1 --resume --shard 1/2 --out half",
    "run s.toml --shard 3/2",
    "run s.toml --case ffff",
    "merge half",
    "run s.toml --jobs 1 --resume --shard 2/2 --out half",
    "merge half --out half",
    "plan s.toml --missing half",
    "run s.toml --engine slurm --tasks 2 --dry-run --partition short --time 01:30:00 --cores 3 --sbatch --mem=2G",
    "run s.toml --engine slurm --tasks 0 --dry-run",
    "records out/s",
    "report s.toml --from-records --out pages",
    "report s.toml --from-records --records none --out pages2",
    "records out/none",
    "check s.toml",
    "accept s.toml",
];

/// The study beside golden values.
const ACCEPTED: &[&str] = &[
    "check s.toml",
    "check s.toml --format markdown",
    "check s.toml --format csv",
    "explain MPM s.toml",
    "explain nothing s.toml",
    "history s",
    "compare out half",
    "compare out golden",
];

/// The study after a change.
const CHANGED: &[&str] = &[
    "check s.toml --jobs 1",
    "check s.toml --jobs 1 --format markdown",
    "check s.toml --jobs 1 --format csv",
    "check s.toml --jobs 1 --format json",
    "run s.toml --jobs 1 --out later",
    "compare out later",
    "compare out later --format csv",
    "compare out later --format markdown",
];

/// The study over two commits.
const COMMITTED: &[&str] = &[
    "history",
    "history s --format csv",
    "compare HEAD~1 HEAD",
    "compare HEAD~1 nothing",
    "report s.toml --out pages --jobs 1",
];

/// What is written for a beginning.
const NEW: &[&str] = &["new trial", "new trial", "new-solver theirs --language shell", "plan trial.toml"];

#[test]
fn studies_are_run_judged_accepted_compared_and_merged_as_they_were() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("s.toml"), STUDY).expect("a file");
    let mut text = String::new();
    let mut tell = |line: &str| told(&mut text, at, &words(line), 70);
    for line in FIRST {
        tell(line);
    }
    take_golden(at);
    for line in ACCEPTED {
        tell(line);
    }
    git(at, &["init", "-q"]);
    git(at, &["add", "s.toml", "golden"]);
    git(at, &["commit", "-q", "-m", "Accept first values"]);
    fs::write(
        at.join("s.toml"),
        STUDY.replace("porosity = 0.37", "porosity = 0.3").replace("value = 1.0", "value = 2.0"),
    )
    .expect("a file");
    for line in CHANGED {
        tell(line);
    }
    take_golden(at);
    git(at, &["add", "s.toml", "golden"]);
    git(at, &["commit", "-q", "-m", "Accept other values"]);
    for line in COMMITTED {
        tell(line);
    }
    for line in NEW {
        tell(line);
    }
    for name in ["trial.toml", "theirs.toml", "theirs/theirs.toml"] {
        if let Ok(made) = fs::read_to_string(at.join(name)) {
            writeln!(text, "{name}\n{}", steady(&made, at)).expect("memory");
        }
    }
    // One commit in fifty has a short hash of digits alone, which is a number to `steady`.
    for commit in git(at, &["log", "--format=%h", "--abbrev=8"]).lines() {
        text = text.replace(commit, "HASH");
    }
    assert_snapshot("commands_of_studies", &text);
}

#[test]
fn a_case_is_explained_as_it_was_in_every_format() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("s.toml"), STUDY).expect("a file");
    let mut text = String::new();
    let mut tell = |words: &[&str]| told(&mut text, at, words, 80);
    take_golden(at);
    fs::write(at.join("s.toml"), STUDY.replace("porosity = 0.37", "porosity = 0.3")).expect("a file");
    for format in ["table", "markdown", "csv", "json"] {
        tell(&["explain", "GC-SRI-patch cells=5", "s.toml", "--format", format]);
    }
    tell(&[
        "explain",
        "GC-SRI-patch implicit cells=5 points=2 growth=0.2 | pressure centres terzaghi T_v=0.3",
        "s.toml",
    ]);
    assert_snapshot("commands_explain", &text);
}

/// Times of the runs alone of every case of the study, s.
fn times(at: &Path) -> Vec<Vec<f64>> {
    let store = RecordStore::new(&at.join("out"), "s");
    let of_case = |hash: &String| {
        let record = store.read(hash).expect("a record");
        record.wall.iter().filter(|sample| sample.alone).map(|sample| sample.seconds).collect()
    };
    let mut hashes = store.hashes();
    hashes.sort();
    hashes.iter().map(of_case).collect()
}

#[test]
fn cases_are_timed_as_often_as_their_study_asks_and_never_anew() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let mut before: Vec<Vec<f64>> = Vec::new();
    for (repeats, jobs) in [(2, "1"), (2, "2"), (4, "2")] {
        fs::write(at.join("s.toml"), format!("timing.repeats = {repeats}\n{STUDY}")).expect("a file");
        assert_eq!(call(at, &["run", "s.toml", "--resume", "--jobs", jobs]).code, 0);
        let after = times(at);
        assert_eq!(after.len(), 6);
        assert!(
            after.iter().all(|times| times.len() == repeats && times.iter().all(|time| *time > 0.0)),
            "{after:?}"
        );
        for (before, after) in before.iter().zip(&after) {
            assert_eq!(before[..], after[..before.len()], "times that are there stay");
        }
        before = after;
    }
}

const TABLE: &str = "t,y,p,u_y,s,v\n\
    8.175,0.1,38.2,-1.0e-7,3.1,0.2\n8.175,0.3,36.5,-3.5e-7,5.2,0.2\n8.175,0.5,29.1,-8.0e-7,10.5,0.2\n\
    8.175,0.7,20.2,-1.6e-6,19.1,0.2\n8.175,0.9,7.3,-2.8e-6,33.0,0.2\n\
    24.525,0.1,24.1,-1.3e-6,16.0,0.2\n24.525,0.3,21.8,-4.0e-6,18.0,0.2\n24.525,0.5,17.5,-7.0e-6,22.6,0.2\n\
    24.525,0.7,11.3,-1.06e-5,29.0,0.2\n24.525,0.9,3.7,-1.5e-5,36.4,0.2\n";

const MAPPING: &str = r#"columns = { t = "t", y = "y", p = "p", u_y = "u_y", effective_stress = "s", volume = "v" }
units = { time = "s", length = "m", stress = "Pa" }
sign = { y = "up", p = "compression-positive", u_y = "up", effective_stress = "compression-positive" }
position = { y = "reference" }
"#;

/// Edits of the mapping.
const MAPPINGS: [(&str, &str); 44] = [
    ("time = \"s\"", "time = \"min\""),
    ("time = \"s\"", "time = \"h\""),
    ("time = \"s\"", "time = \"d\""),
    ("time = \"s\"", "time = \"time-factor\""),
    ("time = \"s\"", "time = \"years\""),
    ("length = \"m\"", "length = \"cm\""),
    ("length = \"m\"", "length = \"mm\""),
    ("length = \"m\"", "length = \"m\", displacement = \"mm\""),
    ("stress = \"Pa\"", "stress = \"kPa\""),
    ("stress = \"Pa\"", "stress = \"MPa\""),
    ("sign = { y = \"up\"", "sign = { y = \"down\""),
    ("p = \"compression-positive\"", "p = \"tension-positive\""),
    ("u_y = \"up\"", "u_y = \"down\""),
    ("effective_stress = \"compression-positive\"", "effective_stress = \"tension-positive\""),
    ("effective_stress = \"compression-positive\"", "effective_stress = \"tension\""),
    ("y = \"reference\"", "y = \"current\""),
    ("volume = \"v\"", "volume = \"w\""),
    (", volume = \"v\"", ""),
    (", effective_stress = \"s\"", ""),
    ("p = \"p\"", "p = \"q\""),
    ("p = \"p\"", "p = \"\""),
    ("t = \"t\"", "t = \"\""),
    ("columns", "sample = \"nodes\"\ncolumns"),
    ("columns", "sample = \"centres\"\ncolumns"),
    ("columns", "sample = \"surface\"\ncolumns"),
    ("columns", "whole_volume = 1.0\ncolumns"),
    ("columns", "whole_volume = 2.0\ncolumns"),
    ("columns", "whole_volume = -2.0\ncolumns"),
    ("columns", "origin = { y = 0.1 }\ncolumns"),
    ("columns", "origin = { y = -5.0 }\ncolumns"),
    ("columns", "rows = { equals = { v = 0.2 } }\ncolumns"),
    ("columns", "rows = { equals = { v = 0.3 } }\ncolumns"),
    ("columns", "rows = { equals = { w = 0.3 } }\ncolumns"),
    ("columns", "hydrostatic = { unit_weight = 2.0 }\ncolumns"),
    ("columns", "hydrostatic = { unit_weight = 2.0, surface = 1.5 }\ncolumns"),
    ("columns", "stress = { is = \"total\" }\ncolumns"),
    ("columns", "csv = { delimiter = \";\" }\ncolumns"),
    ("columns", "csv = { comment = \"8\" }\ncolumns"),
    ("columns", "settlement = { file = \"curve.csv\" }\ncolumns"),
    ("columns", "settlement = { file = \"curve.csv\", t = \"time\", s = \"down\", sign = \"up\" }\ncolumns"),
    ("columns", "settlement = { file = \"none.csv\" }\ncolumns"),
    ("columns", "time = { list = [8.175, 24.525] }\ncolumns"),
    ("columns", "displacement = { from = \"first-frame\" }\ncolumns"),
    ("columns", "colums = { t = \"t\" }\ncolumns"),
];

/// Edits of the table.
const TABLES: [(&str, &str); 26] = [
    ("", ""),
    ("38.2", ""),
    ("38.2", "nan"),
    ("38.2", "wet"),
    ("38.2", "1e400"),
    ("0.1,38.2", "0.3,38.2"),
    ("0.1,38.2", "-0.1,38.2"),
    ("0.1,38.2", "1.1,38.2"),
    ("0.9,7.3", "0.2,7.3"),
    (",0.2\n", ",-0.2\n"),
    (",0.2\n", ",0.2,7\n"),
    (",0.2\n", "\n"),
    ("t,y,p,u_y,s,v", "t,y,p,u_y,s,w"),
    ("t,y,p,u_y,s,v", "t,y,p,p,s,v"),
    ("t,y,p,u_y,s,v", "t;y;p;u_y;s;v"),
    ("t,y,p,u_y,s,v\n", "# made by hand\nt,y,p,u_y,s,v\n"),
    ("t,y,p,u_y,s,v\n", ""),
    ("24.525,0.1", "9.0,0.1"),
    ("24.525,0.1,24.1,-1.3e-6,16.0,0.2\n", ""),
    ("8.175,0.1,38.2,-1.0e-7,3.1,0.2\n8.175,0.3,36.5,-3.5e-7,5.2,0.2\n", ""),
    ("38.2", "0"),
    ("38.2,-1.0e-7", "38200,-1.0e-7"),
    ("-1.0e-7", "1.0e-7"),
    ("3.1", "43.1"),
    ("8.175,0.1", "-8.175,0.1"),
    ("36.5", "36.5 "),
];

#[test]
fn results_with_one_edit_are_scored_as_they_were() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(
        at.join("curve.csv"),
        "t,s,time,down\n8.175,1.19e-5,8.175,-1.19e-5\n24.525,2.05e-5,24.525,-2.05e-5\n",
    )
    .expect("a file");
    let common = "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --format csv";
    let mut text = String::new();
    let of_table = TABLES.map(|(from, to)| (TABLE.replacen(from, to, 1), MAPPING.to_owned(), (from, to)));
    let of_mapping = MAPPINGS.map(|(from, to)| (TABLE.to_owned(), MAPPING.replacen(from, to, 1), (from, to)));
    for (table, mapping, (from, to)) in of_table.into_iter().chain(of_mapping) {
        fs::write(at.join("r.csv"), table).expect("a file");
        fs::write(at.join("m.toml"), mapping).expect("a file");
        writeln!(text, "## {from:?} → {to:?}").expect("memory");
        told(&mut text, at, &words(common), 9);
    }
    fs::write(at.join("r.csv"), TABLE).expect("a file");
    fs::write(at.join("m.toml"), MAPPING).expect("a file");
    fs::write(at.join("r8.csv"), TABLE.replace("38.2", "37.9").replace("24.1", "24.3")).expect("a file");
    for line in [
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --format markdown",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --format json",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --strict",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --below 0.01",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --below 0.9",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --without pressure",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --reference terzaghi-incompressible",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --time-factor 0.1,0.2",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --time-factor 0.1 --time-tolerance 0.1",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=50",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --set material.youngs_modulus=2e6",
        "score r.csv --scene terzaghi --mapping m.toml --set column.load=40 --set column.height=2",
        "score r.csv r8.csv --scene terzaghi --mapping m.toml --set column.load=40 --cells 5,8",
        "score r.csv r8.csv --scene terzaghi --mapping m.toml --set column.load=40 --cells 5",
        "score r.csv r8.csv --scene terzaghi --mapping m.toml --set column.load=40",
        "score r.csv --scene xie-leo --mapping m.toml --set column.load=40",
        "score r.csv --scene mandel --mapping m.toml",
        "score r.csv --scene terzaghi",
        "score r.csv --scene terzaghi --preset ogs",
        "score r.csv --scene terzaghi --mapping m.toml --show-mapping",
        "score --preset kratos --scene terzaghi --show-mapping",
        "score none.csv --scene terzaghi",
        "score --scene terzaghi",
    ] {
        told(&mut text, at, &words(line), 60);
    }
    assert_snapshot("commands_score", &text);
}
