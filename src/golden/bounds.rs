//! What a golden file may allow: a tolerance is room for round-off, and one that lets an error of the
//! method pass is no tolerance. A file edited by hand is held to the same bounds as one that `accept` wrote.

use crate::golden::GoldenFile;
use crate::golden::tolerance::{ROOM, spread_group};
use std::collections::BTreeMap;

/// Largest relative tolerance of a file: a hundred times the one that holds where no spread was measured.
const MOST_RELATIVE: f64 = 1e-6;
/// Largest absolute tolerance of a file: a thousand times the one that holds where no spread was measured.
const MOST_ABSOLUTE: f64 = 1e-9;
/// Largest tolerance by a measured spread, over the largest value of the spread's group.
const MOST_OF_THE_LARGEST: f64 = 0.1;
/// Spread that round-off around zero explains, whatever the size of the values: balances on 640 cells
/// scatter by 1.5e-10.
const ROUND_OFF: f64 = 1e-9;

impl GoldenFile {
    /// What is out of bounds in the file, as a sentence; `None` where it is sound.
    pub fn out_of_bounds(&self) -> Option<String> {
        if self.reason.trim().is_empty() || self.basis.trim().is_empty() {
            let what = if self.reason.trim().is_empty() { "reason" } else { "basis" };
            return Some(format!("its `{what}` is empty: nobody said why these values and tolerances hold"));
        }
        let tolerances = [
            ("relative_tolerance", self.relative_tolerance, MOST_RELATIVE),
            ("absolute_tolerance", self.absolute_tolerance, MOST_ABSOLUTE),
        ];
        for (name, value, most) in tolerances {
            // Written so that what is no number is refused.
            let holds = (0.0..=most).contains(&value);
            if !holds {
                return Some(format!("its `{name}` is {value:e}, which is not between 0 and {most:e}"));
            }
        }
        if let Some((name, value)) = self.values.iter().find(|(_, value)| !value.is_finite()) {
            return Some(format!("its value `{name}` is {value}"));
        }
        self.wide_spread()
    }

    /// The first spread that is wider than round-off can be.
    fn wide_spread(&self) -> Option<String> {
        let mut largest: BTreeMap<String, f64> = BTreeMap::new();
        for (name, value) in &self.values {
            if let Some(group) = spread_group(name) {
                let size = largest.entry(group).or_default();
                *size = size.max(value.abs());
            }
        }
        self.spread.iter().find_map(|(group, spread)| {
            let size = largest.get(group).copied().unwrap_or(0.0);
            let most = (MOST_OF_THE_LARGEST * size / ROOM).max(ROUND_OFF);
            let holds = (0.0..=most).contains(spread);
            (!holds).then(|| {
                format!(
                    "its spread of `{group}` is {spread:e}, which is not between 0 and {most:.1e}: round-off moves \
                     values of {size:.1e} by no more"
                )
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenError;

    const VALUE: &str = "MPM cells=4 | pressure points l2 terzaghi T_v=0.1";
    const GROUP: &str = "MPM cells=4 | pressure T_v=0.1";

    fn sound() -> GoldenFile {
        let values = BTreeMap::from([(VALUE.to_owned(), 0.02)]);
        let spread = BTreeMap::from([(GROUP.to_owned(), 1e-9)]);
        GoldenFile { values, ..GoldenFile::of("study", &[], "a reason") }.with_spread(spread)
    }

    fn refusal(change: impl FnOnce(&mut GoldenFile)) -> String {
        let mut file = sound();
        change(&mut file);
        file.out_of_bounds().expect("it is refused")
    }

    #[test]
    fn tolerances_that_let_anything_or_nothing_pass_are_refused() {
        assert_eq!(sound().out_of_bounds(), None);
        for value in [1e9, 1.1e-6, -1.0, f64::NAN, f64::INFINITY] {
            let told = refusal(|file| file.relative_tolerance = value);
            assert!(told.starts_with("its `relative_tolerance` is "), "{told}");
        }
        for value in [1e9, 1.1e-9, -1e-13, f64::NAN] {
            let told = refusal(|file| file.absolute_tolerance = value);
            assert!(told.starts_with("its `absolute_tolerance` is "), "{told}");
        }
        // Ten times a hundredth of the largest value is a tenth of it.
        for value in [1e9, 2.1e-4, -1.0, f64::NAN] {
            let told = refusal(|file| {
                file.spread.insert(GROUP.to_owned(), value);
            });
            assert!(told.starts_with(&format!("its spread of `{GROUP}` is ")), "{told}");
        }
        let mut file = sound();
        file.spread.insert(GROUP.to_owned(), 1.9e-4);
        assert_eq!(file.out_of_bounds(), None);
    }

    #[test]
    fn values_without_a_reason_or_a_number_are_refused() {
        assert!(refusal(|file| file.reason = "  ".to_owned()).contains("its `reason` is empty"));
        assert!(refusal(|file| file.basis.clear()).contains("its `basis` is empty"));
        let told = refusal(|file| {
            file.values.insert(VALUE.to_owned(), f64::NAN);
        });
        assert_eq!(told, format!("its value `{VALUE}` is NaN"));
    }

    #[test]
    fn a_file_out_of_bounds_is_neither_read_nor_written() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = sound().write(folder.path()).expect("written");
        assert_eq!(GoldenFile::read(folder.path(), "study").expect("sound"), sound());
        let wide = GoldenFile { relative_tolerance: 1e9, ..sound() };
        assert!(matches!(wide.write(folder.path()), Err(GoldenError::Refused { what: "is refused", .. })));
        let text = std::fs::read_to_string(&path).expect("a file");
        let edited = text.replace("relative_tolerance = 1e-12", "relative_tolerance = 1e9");
        assert_ne!(edited, text);
        std::fs::write(&path, edited).expect("written");
        let error = GoldenFile::read(folder.path(), "study").expect_err("refused");
        assert!(error.to_string().contains("its `relative_tolerance` is 1e9"), "{error}");
    }
}
