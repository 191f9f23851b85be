//! Times of files that hold one step: by name, from a list, or from the number of the step.

use crate::import::mapping::Mapping;
use crate::import::raw_row::SolvedBody;
use std::path::Path;

/// The time that the mapping declares for a file, the so many-th of its run, s.
///
/// # Errors
/// When the list of times is too short, or the name has no number of a step.
pub fn declared_time(
    path: &Path,
    place: usize,
    mapping: &Mapping,
    frame: SolvedBody,
) -> Result<Option<f64>, String> {
    let time = &mapping.time;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let seconds = |time: f64| mapping.units.time.seconds(time, frame.seconds_per_time_factor);
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
        Some(pattern) => format!("its name does not fit the pattern `{pattern}` of [time]"),
        None => "its name has no number of a step".to_owned(),
    })?;
    Ok(Some(step * number))
}

/// Number of the step in a file name.
pub fn step_of(name: &str, pattern: Option<&str>) -> Option<f64> {
    let Some(pattern) = pattern else {
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let end = stem.rfind(|symbol: char| symbol.is_ascii_digit())? + 1;
        let start = stem[..end]
            .rfind(|symbol: char| !symbol.is_ascii_digit())
            .map_or(0, |before| before + stem[before..].chars().next().map_or(1, char::len_utf8));
        return stem[start..end].parse().ok();
    };
    let (before, after) = pattern.split_once("{step}")?;
    // The longest number that fits, wherever it stands.
    let starts = name.char_indices().filter(|(_, symbol)| symbol.is_ascii_digit()).map(|(start, _)| start);
    starts
        .filter_map(|start| {
            let rest = &name[start..];
            let digits = rest.find(|symbol: char| !symbol.is_ascii_digit()).unwrap_or(rest.len());
            let is_fit = fits(&name[..start], before) && fits(&rest[digits..], after);
            let is_begin = !name[..start].ends_with(|symbol: char| symbol.is_ascii_digit());
            (is_fit && is_begin).then(|| rest[..digits].parse().ok()).flatten()
        })
        .next_back()
}

/// Whether a text is what a pattern says, `*` being anything and `?` any character.
pub fn fits(text: &str, pattern: &str) -> bool {
    let (text, pattern): (Vec<char>, Vec<char>) = (text.chars().collect(), pattern.chars().collect());
    let (mut at, mut of) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while at < text.len() {
        if of < pattern.len() && pattern[of] == '*' {
            star = Some((of, at));
            of += 1;
        } else if of < pattern.len() && (pattern[of] == '?' || pattern[of] == text[at]) {
            at += 1;
            of += 1;
        } else if let Some((again, from)) = star {
            star = Some((again, from + 1));
            (of, at) = (again + 1, from + 1);
        } else {
            return false;
        }
    }
    pattern[of..].iter().all(|symbol| *symbol == '*')
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
        ] {
            assert_eq!(step_of(name, pattern), step, "{name} {pattern:?}");
        }
        assert!(fits("abc.vtk", "a*.vt?") && !fits("abc.vtk", "b*") && fits("", "*"));
    }
}
