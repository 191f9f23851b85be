//! Files of one step each: their times, from the name, a list, or the step number, and those of one state that a program
//! writes side by side: scalars, vectors and tensors, or one array in each.

use crate::import::mapping::Mapping;
use crate::import::raw_row::SolvedBody;
use glob::Pattern;
use oedometer_formats::{Frame, ImportError, Step, Wanted, read_states, steps_of};
use regex_lite::{Captures, Regex, escape};
use std::path::{Path, PathBuf};

/// Whether the folders of files count the steps: `Cycle000001/data.pvtu`, `Cycle000002/data.pvtu`.
pub fn have_steps_in_folders(files: &[PathBuf]) -> bool {
    let parent = |path: &PathBuf| path.parent().map(Path::to_owned);
    files.len() > 1
        && files
            .windows(2)
            .all(|pair| pair[0].file_name() == pair[1].file_name() && parent(&pair[0]) != parent(&pair[1]))
}

/// The time that the mapping declares for a file, s; `place` counts the files of a run, and `are_folders` says whether their
/// folders count the steps.
///
/// # Errors
/// When the list of times is too short, or the name has no number of a step.
pub fn declared_time(
    path: &Path,
    place: usize,
    are_folders: bool,
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
            format!("it is file {} of its run, but [time] list has {} times", place + 1, time.list.len())
        })?;
        return Ok(Some(seconds(*given)));
    }
    let Some(step) = time.step else { return Ok(None) };
    let number = match &time.pattern {
        // So many parts of the path as the pattern has.
        Some(pattern) if pattern.contains('/') => {
            let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
            let from = parts.len().saturating_sub(pattern.matches('/').count() + 1);
            step_of(&parts[from..].join("/"), Some(pattern))
        }
        None if are_folders => {
            let folder = path.parent().and_then(Path::file_name).unwrap_or_default();
            step_of(&folder.to_string_lossy(), None)
        }
        pattern => step_of(&name, pattern.as_deref()),
    };
    let number = number.ok_or_else(|| match &time.pattern {
        Some(pattern) => format!("its name does not match the pattern `{pattern}` of [time]"),
        None => "its name has no step number".to_owned(),
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

/// The numbers in a name: 50 and 4.0875 in `col_ts_50_t_4.0875`.
pub fn numbers_in(name: &str) -> Vec<f64> {
    let number = Regex::new(r"\d+(\.\d+)?");
    number
        .iter()
        .flat_map(|number| number.find_iter(name))
        .filter_map(|found| found.as_str().parse().ok())
        .collect()
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
            frame.join(part).map_err(|why| ImportError::content(other, why.to_string()))
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
            // Of several numbers that fit, the last.
            ("mesh-10-step-0200.vtu", None, Some(200.0)),
            ("mesh-10-step-0200.vtu", Some("*-{step}*.vtu"), Some(200.0)),
            ("mesh-10-step-0200.vtu", Some("*-{step}-*.vtu"), Some(10.0)),
            ("a-1-b-2-c-3.vtu", Some("*-{step}*.vtu"), Some(3.0)),
            ("a-1-b-2-c-3.vtu", Some("*-{step}-*"), Some(2.0)),
            ("a-1-b-2-c-3.vtu", Some("?-{step}*"), Some(1.0)),
            ("a-1-b-2-c-3.vtu", Some("*-{step}"), None),
            // A whole number goes before a part of a later one.
            ("a-1-x23.vtu", Some("*[-2]{step}*"), Some(1.0)),
        ] {
            assert_eq!(step_of(name, pattern), step, "{name} {pattern:?}");
        }
    }

    #[test]
    fn the_numbers_of_a_name_may_have_fractions() {
        for (name, numbers) in [
            ("col_ts_50_t_4.0875", &[50.0, 4.0875][..]),
            ("porous_0_1000", &[0.0, 1000.0]),
            ("a", &[]),
            ("Cycle000010", &[10.0]),
        ] {
            assert_eq!(numbers_in(name), numbers, "{name}");
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

    /// The seconds that a mapping declares for a file, or what is said of it.
    fn declared(time: &str, unit: &str, name: &str, place: usize) -> Result<Option<f64>, String> {
        let text = format!("[units]\ntime = \"{unit}\"\n[time]\n{time}\n");
        let source = oedometer_input::source::StudySource { name: "m.toml".to_owned(), text };
        let mapping = Mapping::read(&source).expect("a mapping");
        let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 250.0 };
        declared_time(Path::new("folder").join(name).as_path(), place, false, &mapping, body)
    }

    #[test]
    fn a_declared_time_is_that_of_its_file_in_the_unit_of_the_mapping_and_steps_are_in_seconds() {
        let list = "list = [2.0, 3.0, 5.0]";
        let files = "files = { \"a_1.vtu\" = 7.0, \"a_2.vtu\" = 11.0 }";
        let step = "step = 0.5\npattern = \"a_{step}*.vtu\"";
        for (time, unit, name, place, wanted) in [
            ("", "min", "a_1.vtu", 0, None),
            (list, "s", "a_1.vtu", 0, Some(2.0)),
            (list, "min", "a_1.vtu", 0, Some(120.0)),
            (list, "min", "a_1.vtu", 1, Some(180.0)),
            (list, "h", "a_1.vtu", 2, Some(18_000.0)),
            (list, "d", "a_1.vtu", 1, Some(259_200.0)),
            (list, "time-factor", "a_1.vtu", 2, Some(1250.0)),
            (files, "s", "a_1.vtu", 5, Some(7.0)),
            (files, "min", "a_1.vtu", 0, Some(420.0)),
            (files, "min", "a_2.vtu", 0, Some(660.0)),
            (files, "time-factor", "a_2.vtu", 0, Some(2750.0)),
            (files, "min", "a_3.vtu", 0, None),
            (step, "s", "a_12.vtu", 0, Some(6.0)),
            (step, "min", "a_12.vtu", 3, Some(6.0)),
            (step, "time-factor", "a_12_of_90.vtu", 0, Some(6.0)),
            ("step = 0.5", "d", "a_12_of_90.vtu", 0, Some(45.0)),
            // Of several the one that says most of the file.
            (&format!("{list}\n{files}\n{step}"), "min", "a_2.vtu", 1, Some(660.0)),
            (&format!("{list}\n{files}\n{step}"), "min", "a_3.vtu", 1, Some(180.0)),
            (&format!("{files}\n{step}"), "min", "a_3.vtu", 1, Some(1.5)),
        ] {
            assert_eq!(declared(time, unit, name, place), Ok(wanted), "{time} {unit} {name} {place}");
        }
    }

    #[test]
    fn a_file_beyond_the_list_or_without_a_number_of_its_step_is_told() {
        for (time, name, place, told) in [
            ("list = [2.0, 3.0]", "a_1.vtu", 2, "it is file 3 of its run, but [time] list has 2 times"),
            ("step = 1.0", "column.vtu", 0, "its name has no step number"),
            (
                "step = 1.0\npattern = \"b_{step}.vtu\"",
                "a_1.vtu",
                0,
                "does not match the pattern `b_{step}.vtu`",
            ),
        ] {
            let error = declared(time, "s", name, place).expect_err(name);
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn what_is_joined_is_one_state_of_the_same_points() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, points: usize, array: &str| {
            let places = (0..points).map(|at| format!("0 {at} 0\n")).collect::<Vec<_>>().concat();
            let text = format!(
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS {points} double\n{places}\
                 POINT_DATA {points}\nSCALARS {array} double\nLOOKUP_TABLE default\n{}",
                "4\n".repeat(points)
            );
            std::fs::write(folder.path().join(name), text).expect("a file");
            folder.path().join(name)
        };
        let names = ["p", "u"].map(str::to_owned).into();
        let patterns = ["p_*.vtk", "u_*.vtk"].map(str::to_owned);
        let joined = |number: &str| {
            let file = folder.path().join(format!("p_{number}.vtk"));
            let steps = steps_of(&file, &mut Vec::new()).expect("a state");
            let mut found = None;
            read_states(&steps, Wanted(&names), &mut |step, mut frame| {
                found = Some(join(step, &patterns, Wanted(&names), &mut frame).map(|()| frame));
                Ok(())
            })
            .expect("a state");
            found.expect("a state").map_err(|error| error.to_string())
        };
        for (number, points) in [("1", 2), ("2", 3), ("3", 2)] {
            write(&format!("p_{number}.vtk"), 2, "p");
            if number != "3" {
                write(&format!("u_{number}.vtk"), points, "u");
            }
        }
        let names_of = |frame: Frame| frame.arrays.into_iter().map(|one| one.name).collect::<Vec<_>>();
        assert_eq!(joined("1").map(names_of), Ok(vec!["p".to_owned(), "u".to_owned()]));
        assert!(joined("2").is_err_and(|told| told.contains("u_2.vtk")), "it has other points");
        assert_eq!(joined("3").map(names_of), Ok(vec!["p".to_owned()]), "there is nothing to join");
    }
}
