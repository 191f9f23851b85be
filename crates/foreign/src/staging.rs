//! What a run needs: the words that start it, with placeholders filled in and files of the adapter found beside the study;
//! and its folder, empty, under a temporary name until the run is complete, then beside the record.

use crate::case_file::suggested_step;
use crate::solver::ExternalSolver;
use oedometer_case::Case;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Name of the folder of a whole run beside its record.
pub const WHOLE: &str = "solver";
/// Name of the folder of a run that failed.
pub const FAILED: &str = "solver.failed";
/// What the name of a folder begins with while its run goes on.
const STAGED: &str = ".solver-";
/// Most names that a message lists.
const MOST_NAMES: usize = 8;

/// A fresh folder for the run of a solver, with `case.json` and an empty folder `out`.
#[derive(Debug)]
pub struct Staged {
    folder: PathBuf,
    /// Where it goes in the end; `None` if nothing of the run is kept.
    place: Option<PathBuf>,
}

impl Staged {
    /// A fresh folder, within the folder of the record where there is one, with the text of the case file.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn new(place: Option<&Path>, case_file: &str) -> std::io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let parent = match place {
            Some(place) => std::path::absolute(place)?,
            None => std::env::temp_dir(),
        };
        fs::create_dir_all(&parent)?;
        if place.is_some() {
            remove_left(&parent);
        }
        let folder = parent.join(format!("{STAGED}{}-{number}", std::process::id()));
        // Left by an earlier process of this number: abandoned.
        remove(&folder);
        let staged = Self { folder, place: place.map(|_| parent) };
        fs::create_dir_all(staged.out())?;
        fs::write(staged.case_file(), case_file)?;
        Ok(staged)
    }

    /// The folder in which the solver is started and leaves its result.
    pub fn out(&self) -> PathBuf {
        self.folder.join("out")
    }

    /// The file that says what is to be solved.
    pub fn case_file(&self) -> PathBuf {
        self.folder.join("case.json")
    }

    /// Keeps what the solver said.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn keep_words(&self, output: &str, errors: &str) -> std::io::Result<()> {
        fs::write(self.folder.join("stdout.txt"), output)?;
        fs::write(self.folder.join("stderr.txt"), errors)
    }

    /// What lies in the folder of the result, in a few words.
    pub fn contents(&self) -> String {
        let mut names: Vec<String> = fs::read_dir(self.out())
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        let more = names.len().saturating_sub(MOST_NAMES);
        names.truncate(MOST_NAMES);
        match (names.is_empty(), more) {
            (true, _) => "nothing".to_owned(),
            (false, 0) => names.join(", "),
            (false, more) => format!("{} and {more} more", names.join(", ")),
        }
    }

    /// A text with the paths of this folder as the study writes them: what is kept does not tell where it was made.
    pub fn without_paths(&self, text: &str) -> String {
        text.replace(&self.out().display().to_string(), "{out}")
            .replace(&self.case_file().display().to_string(), "{case}")
            .replace(&self.folder.display().to_string(), "{out}/..")
    }

    /// Moves the folder to its place, in one step: whoever finds it there finds all of it.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn keep(self, is_whole: bool) -> std::io::Result<()> {
        let Some(place) = &self.place else { return Ok(()) };
        for name in [WHOLE, FAILED] {
            remove(&place.join(name));
        }
        fs::rename(&self.folder, place.join(if is_whole { WHOLE } else { FAILED }))
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        remove(&self.folder);
        if let Some(place) = &self.place {
            // Only where nothing is in it: a case of which nothing is kept leaves no trace.
            let _ = fs::remove_dir(place);
        }
    }
}

/// Removes a folder if it exists; a folder that cannot be removed stays and does no harm.
fn remove(folder: &Path) {
    let _ = fs::remove_dir_all(folder);
}

/// Removes the staged folders of ended processes, if the system can tell.
fn remove_left(parent: &Path) {
    let all = Path::new("/proc");
    if !all.join("self").exists() {
        return;
    }
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let process = name.to_str().and_then(|name| name.strip_prefix(STAGED)?.split('-').next());
        if process.is_some_and(|process| !all.join(process).exists()) {
            remove(&entry.path());
        }
    }
}

/// The values of the placeholders for a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Filling {
    values: Vec<(&'static str, String)>,
}

impl Filling {
    /// Those of a case whose file and fresh folder are known.
    pub fn of(case: &Case, solver: &ExternalSolver, case_file: &Path, out: &Path) -> Self {
        let end = case.time_factors.last().copied().unwrap_or(0.0) * case.seconds_per_time_factor();
        Self {
            values: vec![
                ("case", case_file.display().to_string()),
                ("out", out.display().to_string()),
                ("study", solver.folder.display().to_string()),
                ("cells", case.cells.to_string()),
                ("points_per_cell", case.points_per_cell.to_string()),
                ("time_step", suggested_step(case).to_string()),
                ("end_time", end.to_string()),
            ],
        }
    }

    /// A text with its placeholders filled in, in one pass: braces in a value stay as they are.
    pub fn fill(&self, text: &str) -> String {
        let mut filled = String::new();
        let mut rest = text;
        while let Some(open) = rest.find('{') {
            filled.push_str(&rest[..open]);
            rest = &rest[open..];
            let known = self.values.iter().find_map(|(name, value)| {
                let after = rest.strip_prefix('{')?.strip_prefix(name)?.strip_prefix('}')?;
                Some((value, after))
            });
            if let Some((value, after)) = known {
                filled.push_str(value);
                rest = after;
            } else {
                filled.push('{');
                rest = &rest[1..];
            }
        }
        filled + rest
    }
}

/// A command as it is started. A program with a `/` is found from the study's folder, another one as the system finds
/// programs; any other word that names a file beside the study is that file.
pub fn words_of(solver: &ExternalSolver, typed: &[String], fill: impl Fn(&str) -> String) -> Vec<OsString> {
    let word = |(place, word): (usize, &String)| {
        let is_path = place == 0 && word.contains('/') && !word.contains('{');
        let is_program_by_name = place == 0 && !word.contains('/');
        match solver.file(word) {
            Some(path) if !is_program_by_name => path.into_os_string(),
            _ if is_path => solver.folder.join(word).into_os_string(),
            _ => OsString::from(fill(word)),
        }
    };
    typed.iter().enumerate().map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::tests::solver;

    #[test]
    fn a_run_takes_its_place_in_the_end_and_replaces_what_was_there() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let names = || {
            let entries = fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("one"));
            let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
            names.sort();
            names
        };
        let staged = Staged::new(Some(folder.path()), "{}").expect("fresh");
        fs::write(staged.out().join("result.csv"), "first").expect("a file");
        assert_eq!(staged.contents(), "result.csv");
        let told = staged.without_paths(&format!("see {}/result.csv", staged.out().display()));
        assert_eq!(told, "see {out}/result.csv");
        let [case, beside] =
            [staged.case_file(), staged.out().with_file_name("x")].map(|path| path.display().to_string());
        assert_eq!(staged.without_paths(&format!("{case} {beside}")), "{case} {out}/../x");
        assert_eq!(fs::read_to_string(staged.case_file()).expect("a file"), "{}");
        staged.keep_words("said", "wrong").expect("kept");
        for (number, told) in [
            (7, "0, 1, 2, 3, 4, 5, 6, result.csv"),
            (8, "0, 1, 2, 3, 4, 5, 6, 7 and 1 more"),
            (9, "0, 1, 2, 3, 4, 5, 6, 7 and 2 more"),
        ] {
            (0..number).for_each(|name| fs::write(staged.out().join(name.to_string()), "").expect("a file"));
            assert_eq!(staged.contents(), told);
        }
        staged.keep(false).expect("kept");
        assert_eq!(names(), [FAILED]);
        let words = ["stdout.txt", "stderr.txt"]
            .map(|name| fs::read_to_string(folder.path().join(FAILED).join(name)).ok());
        assert_eq!(words, ["said", "wrong"].map(|word| Some(word.to_owned())));
        let second = Staged::new(Some(folder.path()), "{}").expect("fresh");
        assert_eq!(second.contents(), "nothing", "nothing of the first run is there");
        second.keep(true).expect("kept");
        assert_eq!(names(), [WHOLE]);
        drop(Staged::new(Some(folder.path()), "{}").expect("fresh"));
        assert_eq!(names(), [WHOLE], "what is given up leaves nothing");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_a_dead_process_left_is_cleared_and_a_living_ones_stays() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let living = folder.path().join(format!("{STAGED}{}-77", std::process::id()));
        let dead = folder.path().join(format!("{STAGED}4194305-0"));
        for path in [&living, &dead] {
            fs::create_dir(path).expect("a folder");
        }
        let staged = Staged::new(Some(folder.path()), "{}").expect("fresh");
        assert!(living.exists() && !dead.exists() && staged.out().exists());
    }

    #[test]
    fn placeholders_are_filled_once_and_other_braces_stay() {
        let filling = Filling { values: vec![("out", "/a/{cells}".to_owned()), ("cells", "10".to_owned())] };
        assert_eq!(filling.fill("{out}/x-{cells}.csv {} {a} {"), "/a/{cells}/x-10.csv {} {a} {");
        assert_eq!(filling.fill(""), "");
        // Every one is that of the case: 0.002 s a step, and 0.3 · 81.75 s to the last output.
        let case = Case {
            cells: 7,
            points_per_cell: 3,
            time_factors: vec![0.1, 0.3].into(),
            time_step: oedometer_problem::time_step::TimeStep::Seconds(0.002),
            ..Case::seed(oedometer_case::Task::Solve, &oedometer_scenes::TERZAGHI)
        };
        let solver = solver(Path::new("/studies"), &["sh"]);
        let filling = Filling::of(&case, &solver, Path::new("/f/case.json"), Path::new("/f/out"));
        let filled =
            filling.fill("{case} {out} {study} {cells} {points_per_cell} {time_step} {end_time} {times}");
        let (words, rest) = filled.rsplit_once("0.002 ").expect("the step");
        assert_eq!(words, "/f/case.json /f/out /studies 7 3 ");
        let end: f64 = rest.strip_suffix(" {times}").expect("no placeholder").parse().expect("a number");
        assert!((end - 24.525).abs() < 1e-9, "{end}");
    }

    #[test]
    fn files_beside_the_study_are_found_and_programs_are_not_taken_for_them() {
        let folder = tempfile::TempDir::new().expect("a folder");
        for name in ["python3", "adapter.py", "toy"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        let solver = solver(folder.path(), &["python3"]);
        let words = |typed: &[&str]| {
            let typed: Vec<String> = typed.iter().map(|word| (*word).to_owned()).collect();
            let words = words_of(&solver, &typed, |word| word.replace("{case}", "C"));
            words.iter().map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>()
        };
        let beside = |name: &str| folder.path().join(name).display().to_string();
        assert_eq!(
            words(&["python3", "adapter.py", "{case}", "other.py"]),
            ["python3", &beside("adapter.py"), "C", "other.py"]
        );
        assert_eq!(words(&["./toy", "{case}"])[0], beside("./toy"));
        assert_eq!(words(&["./missing"])[0], beside("./missing"));
        assert_eq!(words(&["{study}/toy", "{study}/adapter.py"]), [beside("toy"), beside("adapter.py")]);
    }
}
