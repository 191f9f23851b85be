//! Results of other programs that a run takes over from an earlier one, and by what these are known.

use crate::case::grouping::grouped;
use crate::record::Record;
use oedometer_wording::{count_of, first_few};

/// Cases of a sentence before the rest is only counted.
const MOST_CASES: usize = 12;

/// A result that was not made by this run.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct TakenOver {
    /// Name of the solver.
    pub solver: String,
    /// Label of the case.
    pub case: String,
    /// What made it.
    pub made_by: String,
    /// Whether the program is known to be that of now.
    pub is_proven: bool,
}

impl TakenOver {
    /// A record that is reused; `None` for one of this program, whose sources decide its values.
    pub fn of(record: &Record, is_proven: bool) -> Option<Self> {
        let about = record.outside_run()?;
        Some(Self {
            solver: record.case.method.to_string(),
            case: record.case.label(),
            made_by: about.made_by(),
            is_proven,
        })
    }

    /// The sentences on several, one for each solver and origin.
    pub fn sentences(all: &[Self]) -> Vec<String> {
        let groups = grouped(all, |result| (&result.solver, &result.made_by, result.is_proven));
        groups.into_iter().map(|(_, alike)| alike[0].sentence(&alike)).collect()
    }

    fn sentence(&self, alike: &[&Self]) -> String {
        let count = count_of(alike.len(), "result", "results");
        let cases = alike.iter().map(|result| result.case.clone()).collect();
        let cases = first_few(cases, MOST_CASES).join(", ");
        let proof = if self.is_proven {
            "whose version and named files are unchanged"
        } else {
            "and nothing proves that its program is unchanged"
        };
        format!("`{}` was not run: {count} reused ({cases}), made by {}, {proof}", self.solver, self.made_by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_one_origin_are_one_sentence_that_names_each_case() {
        let of = |solver: &str, cells: usize, made_by: &str, is_proven| TakenOver {
            solver: solver.to_owned(),
            case: format!("{solver} cells={cells}"),
            made_by: made_by.to_owned(),
            is_proven,
        };
        let all =
            [of("a", 4, "v1", true), of("b", 4, "v1", false), of("a", 8, "v1", true), of("a", 9, "v2", true)];
        assert_eq!(
            TakenOver::sentences(&all),
            [
                "`a` was not run: 2 results reused (a cells=4, a cells=8), made by v1, whose version and named files are \
                 unchanged",
                "`b` was not run: 1 result reused (b cells=4), made by v1, and nothing proves that its program is unchanged",
                "`a` was not run: 1 result reused (a cells=9), made by v2, whose version and named files are unchanged",
            ]
        );
        let many: Vec<TakenOver> = (0..14).map(|cells| of("a", cells, "v1", true)).collect();
        let told = TakenOver::sentences(&many).remove(0);
        assert!(
            told.contains("14 results reused (a cells=0,") && told.contains("a cells=11, and 2 more)"),
            "{told}"
        );
    }
}
