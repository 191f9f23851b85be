//! Files of one step each: their times, from the name, a list, or the step number, and those of one state that a program
//! writes side by side: scalars, vectors and tensors, or one array in each.

use crate::import::mapping::Mapping;
use crate::import::raw_row::SolvedBody;
use glob::Pattern;
use oedometer_formats::{Frame, ImportError, Step, Wanted, read_states, steps_of};
use regex_lite::{Captures, Regex, escape};
use std::path::{Path, PathBuf};

/// The time that the mapping declares for a file, s; `place` counts the files of a run.
///
/// # Errors
/// When the list of times is too short, or the name has no number of a step.
pub fn declared_time(
    path: &Path,
    place: usize,
    mapping: &Mapping,
    body: SolvedBody,
) -> Result<Option<f64>, String> {
    let time = &mapping.time;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let seconds = |time: f64| mapping.units.time.seconds(time, body.seconds_per_time_factor);
    if let Some(given) = time.files.get(&name) {
        return Ok(Some(seconds(*given)));
    }
    if !time.list.is_empty() {
        let given = time.list.get(place);
        let given = given.ok_or_else(|| {
            format!("it is file {} of its run, and [time] list has {} times", place + 1, time.list.len())
        })?;
        return Ok(Some(seconds(*given)));
    }
    let Some(step) = time.step else { return Ok(None) };
    let number = step_of(&name, time.pattern.as_deref());
    let number = number.ok_or_else(|| match &time.pattern {
        Some(pattern) => format!("its name does not match the pattern `{pattern}` of [time]"),
        None => "its name has no number of a step".to_owned(),
    })?;
    Ok(Some(step * number))
}

/// The number of the step in a file name: the last number, or the one that the pattern marks.
pub fn step_of(name: &str, pattern: Option<&str>) -> Option<f64> {
    let is_digit = |symbol: char| symbol.is_ascii_digit();
    let Some(pattern) = pattern else {
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let up_to_number = stem.trim_end_matches(|symbol| !is_digit(symbol));
        return up_to_number[up_to_number.trim_end_matches(is_digit).len()..].parse().ok();
    };
    let (before, after) = pattern.split_once("{step}")?;
    let (before, after) = (Pattern::new(before).ok()?, Pattern::new(after).ok()?);
    // The last number that fits; where no whole one does, the last part of one.
    let starts = || name.char_indices().filter(|(_, symbol)| is_digit(*symbol));
    let is_whole = |(start, _): &(usize, char)| !name[..*start].ends_with(is_digit);
    let step = |(start, _): (usize, char)| {
        let rest = name[start..].trim_start_matches(is_digit);
        let is_fit = before.matches(&name[..start]) && after.matches(rest);
        is_fit.then(|| name[start..name.len() - rest.len()].parse().ok()).flatten()
    };
    let whole = starts().filter(is_whole).filter_map(step).next_back();
    whole.or_else(|| starts().find_map(step))
}

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
    fn the_number_of_a_step_is_found_in_a_name() {
        for (name, pattern, step) in [
            ("porous_0_1000.vtk", None, Some(1000.0)),
            ("col_000004.vtu", None, Some(4.0)),
            ("column.vtu", None, None),
            ("7.vtk", None, Some(7.0)),
            ("run_12_of_90.vtk", Some("run_{step}_of_*.vtk"), Some(12.0)),
            ("run_12_of_90.vtk", Some("run_*_of_{step}.vtk"), Some(90.0)),
            ("run_12.vtu", Some("run_{step}.vtk"), None),
            ("a_MPScalar_001000013.vtk", Some("*_???{step}.vtk"), Some(13.0)),
        ] {
            assert_eq!(step_of(name, pattern), step, "{name} {pattern:?}");
        }
    }

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
