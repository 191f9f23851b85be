//! Which of many series a figure shows.

use crate::judge::paths::Path;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most series of a figure with several soils.
const MOST_SERIES: usize = 14;
/// Most series of a figure with one soil.
const MOST_OF_A_SOIL: usize = 60;

/// How many series a figure shows, where it does not show all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DrawnSeries {
    /// Series that are shown.
    pub shown: usize,
    /// All series.
    pub all: usize,
    /// Whether they are the first of those of their soil.
    pub is_cut: bool,
    /// What tells their soil from the plain one; `None` where they are of the plain one.
    pub soil: Option<String>,
}

/// All paths; if they are too many, those of the undisturbed soil, or else of the first soil, with their number.
pub fn drawn<'a>(all: &[Path<'a>]) -> (Vec<Path<'a>>, Option<DrawnSeries>) {
    if all.len() <= MOST_SERIES {
        return (all.to_vec(), None);
    }
    let variant = |path: &Path<'_>| path.records[0].case.variant();
    let of_variant = |wanted: &str| -> Vec<Path<'a>> {
        all.iter().filter(|path| variant(path) == wanted).cloned().collect()
    };
    let plain = of_variant("");
    let (mut paths, soil) = if plain.is_empty() {
        let first = variant(&all[0]);
        (of_variant(&first), Some(first))
    } else {
        (plain, None)
    };
    let is_cut = paths.len() > MOST_OF_A_SOIL;
    paths.truncate(MOST_OF_A_SOIL);
    let drawn = DrawnSeries { shown: paths.len(), all: all.len(), is_cut, soil };
    let is_part = paths.len() < all.len();
    (paths, is_part.then_some(drawn))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::judge::paths::paths;
    use crate::study::expectation::Axis;

    fn series_of(sweep: &str) -> (usize, usize, Option<DrawnSeries>) {
        let records = records_of(&format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\ncells = [2, 4]\n\
             integrator = ['implicit']\ntime_step = [{{ growth = 0.5 }}]\n{sweep}"
        ));
        let all = paths(&records, Axis::Cells);
        let (shown, note) = drawn(&all);
        (shown.len(), all.len(), note)
    }

    #[test]
    fn a_figure_shows_all_paths_or_those_of_one_soil_and_counts_them() {
        let (shown, all, note) = series_of("method = ['MPM', 'GIMP']\nporosity = [0.3, 0.4]\n");
        assert_eq!((shown, all, note), (4, 4, None));
        let soils = "porosity = [0.3, 0.32, 0.34, 0.36, 0.38, 0.4, 0.42, 0.44]\n";
        let (shown, all, note) = series_of(&format!("method = ['MPM', 'GIMP']\n{soils}"));
        assert_eq!((shown, all), (2, 16));
        let soil = Some("porosity=0.3".to_owned());
        assert_eq!(note, Some(DrawnSeries { shown: 2, all: 16, is_cut: false, soil }));
    }

    #[test]
    fn the_plain_soil_is_drawn_where_there_is_one_and_fourteen_series_are_not_too_many() {
        let soils = |count: usize| (0..count).map(|one| format!("0.{one:02}")).collect::<Vec<_>>().join(", ");
        let of =
            |count: usize| series_of(&format!("method = ['MPM', 'GIMP']\njitter = [{}]\n", soils(count)));
        assert_eq!(of(7), (14, 14, None));
        let note = DrawnSeries { shown: 2, all: 16, is_cut: false, soil: None };
        assert_eq!(of(8), (2, 16, Some(note)));
    }
}
