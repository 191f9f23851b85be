//! Which paths of a study a figure shows: all of them, or, where nobody could tell them apart, those of one soil.

use crate::judge::paths::Path;

/// From more series than these on a figure shows one soil alone.
const MOST_SERIES: usize = 14;
/// More series of one soil than these are no figure.
const MOST_OF_A_SOIL: usize = 60;

/// The paths of a figure.
pub struct DrawnPaths<'a> {
    /// Those that are shown.
    pub paths: Vec<Path<'a>>,
    /// What of all they are, as a sentence; none where they are all.
    pub note: Option<String>,
}

/// All paths, or, where they are too many, those of the undisturbed soil, or else of the first soil there is.
pub fn drawn<'a>(all: &[Path<'a>]) -> DrawnPaths<'a> {
    if all.len() <= MOST_SERIES {
        return DrawnPaths { paths: all.to_vec(), note: None };
    }
    let variant = |path: &Path<'_>| path.records[0].case.variant();
    let of_variant = |wanted: &str| -> Vec<Path<'a>> {
        all.iter().filter(|path| variant(path) == wanted).cloned().collect()
    };
    let plain = of_variant("");
    let (mut paths, what) = if plain.is_empty() {
        let first = variant(&all[0]);
        (of_variant(&first), format!("those with {first}"))
    } else {
        (plain, "the plain soil only".to_owned())
    };
    let first = if paths.len() > MOST_OF_A_SOIL { "the first of " } else { "" };
    paths.truncate(MOST_OF_A_SOIL);
    let note = (paths.len() < all.len()).then(|| {
        format!(
            "The figures show {} of {} series, {first}{what}; the tables have every one.",
            paths.len(),
            all.len()
        )
    });
    DrawnPaths { paths, note }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::judge::paths::paths;
    use crate::study::expectation::Axis;

    fn series_of(sweep: &str) -> (usize, usize, Option<String>) {
        let records = records_of(&format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\ncells = [2, 4]\n\
             integrator = ['implicit']\ntime_step = [{{ growth = 0.5 }}]\n{sweep}"
        ));
        let all = paths(&records, Axis::Cells);
        let shown = drawn(&all);
        (shown.paths.len(), all.len(), shown.note)
    }

    #[test]
    fn a_figure_shows_all_paths_or_those_of_one_soil_and_says_so() {
        let (shown, all, note) = series_of("method = ['MPM', 'GIMP']\nporosity = [0.3, 0.4]\n");
        assert_eq!((shown, all, note), (4, 4, None));
        let soils = "porosity = [0.3, 0.32, 0.34, 0.36, 0.38, 0.4, 0.42, 0.44]\n";
        let (shown, all, note) = series_of(&format!("method = ['MPM', 'GIMP']\n{soils}"));
        assert_eq!((shown, all), (2, 16));
        let note = note.expect("not all are shown");
        assert!(note.contains("show 2 of 16 series, those with porosity=0.3"), "{note}");
    }
}
