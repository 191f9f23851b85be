//! Files of one state that a program writes side by side: scalars, vectors and tensors, or one array in each.

use oedometer_formats::{Frame, ImportError, Step, Wanted, read_states, steps_of};
use regex_lite::{Captures, Regex, escape};
use std::path::{Path, PathBuf};

/// What a pattern's `*` stand for in a name; `None` where the name does not match.
fn captures<'a>(name: &'a str, pattern: &str) -> Option<Captures<'a>> {
    let parts: Vec<String> = pattern.split('*').map(escape).collect();
    Regex::new(&format!("^{}$", parts.join("(.*)"))).ok()?.captures(name)
}

/// The files of a state's step, in the order of the patterns that join them; only itself where none matches its name.
pub fn members(path: &Path, patterns: &[String]) -> Vec<PathBuf> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(found) = patterns.iter().find_map(|pattern| captures(&name, pattern)) else {
        return vec![path.to_owned()];
    };
    let sibling = |pattern: &String| {
        let mut stars = found.iter().skip(1).flatten().map(|found| found.as_str());
        let mut parts = pattern.split('*');
        let first = parts.next().unwrap_or_default().to_owned();
        let name = parts.fold(first, |name, part| name + stars.next().unwrap_or_default() + part);
        path.with_file_name(name)
    };
    patterns.iter().map(sibling).filter(|file| file == path || file.is_file()).collect()
}

/// Adds the arrays of the other files of a step to its frame.
///
/// # Errors
/// When one of them cannot be read, has several states, or has other points.
pub fn join(step: &Step, patterns: &[String], wanted: Wanted, frame: &mut Frame) -> Result<(), ImportError> {
    for other in members(&step.file, patterns).iter().filter(|other| **other != step.file) {
        let steps = steps_of(other, &mut Vec::new())?;
        if steps.len() != 1 {
            return Err(ImportError::content(other, "a file that is joined must have one state"));
        }
        read_states(&steps, wanted, &mut |_, part| {
            frame.join(part).map_err(|why| ImportError::content(other, why))
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_a_step_are_found_by_what_their_stars_stand_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        for name in ["a_MPScalar_010.vtk", "a_MPVector_010.vtk", "b_MPVector_010.vtk", "a_MPVector_011.vtk"] {
            std::fs::write(at(name), "").expect("a file");
        }
        let join = ["*_MPScalar_*.vtk", "*_MPVector_*.vtk", "*_MPTensor_*.vtk"].map(str::to_owned);
        let both = [at("a_MPScalar_010.vtk"), at("a_MPVector_010.vtk")];
        assert_eq!(members(&at("a_MPVector_010.vtk"), &join), both);
        assert_eq!(members(&at("a_MPScalar_010.vtk"), &join), both);
        assert_eq!(members(&at("b_MPVector_010.vtk"), &join), [at("b_MPVector_010.vtk")]);
        assert_eq!(members(&at("a.b*.vtk"), &join), [at("a.b*.vtk")]);
    }
}
