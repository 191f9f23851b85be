//! The words that start a solver: placeholders filled in, files of the adapter found beside the study.

use crate::case::Case;
use crate::foreign::case_file::suggested_step;
use crate::study::solver::Solver;
use std::ffi::OsString;
use std::path::Path;

/// The values of the placeholders for a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Filling {
    values: Vec<(&'static str, String)>,
}

impl Filling {
    /// Those of a case whose file and fresh folder are known.
    pub fn of(case: &Case, solver: &Solver, case_file: &Path, out: &Path) -> Self {
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

    /// A text with its placeholders filled in, in one pass: what a value has in braces stays as it is.
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
pub fn words_of(solver: &Solver, typed: &[String], fill: impl Fn(&str) -> String) -> Vec<OsString> {
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
    use crate::foreign::attachment::tests::solver;

    #[test]
    fn placeholders_are_filled_once_and_other_braces_stay() {
        let filling = Filling { values: vec![("out", "/a/{cells}".to_owned()), ("cells", "10".to_owned())] };
        assert_eq!(filling.fill("{out}/x-{cells}.csv {} {a} {"), "/a/{cells}/x-10.csv {} {a} {");
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
    }
}
