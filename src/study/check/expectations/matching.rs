//! Whether there is anything for an expectation to judge: cases that it names, with its time and its levels.

use crate::case::planned::PlannedCase;
use crate::case::{Case, Task};
use crate::study::case_expectation::CaseExpectation;
use crate::study::check::checker::{Checker, Purpose};
use crate::study::expectation::{Axis, Selection, SeriesExpectation};
use crate::study::file::{ExpectCaseTable, ExpectTable};
use crate::study::inputs::{InputTable, One};
use std::ops::Range;
use toml::Spanned;

impl Checker<'_> {
    /// Complains where no case of the study can answer an expectation of series.
    pub(crate) fn series_is_there(
        &mut self,
        entry: &Spanned<ExpectTable>,
        expectation: &SeriesExpectation,
        planned: &[PlannedCase],
    ) {
        let table = entry.get_ref();
        let axis = expectation.axis.name();
        let Some(cases) = self.selected(table, &expectation.selection, axis, entry.span(), planned) else {
            return;
        };
        let time = table.time_factor.as_ref().map(|typed| typed.span());
        self.time_is_kept(&cases, expectation.measure.time_factor, time.unwrap_or(entry.span()));
        let Some(level) = table.at.as_ref().filter(|_| expectation.axis == Axis::Cells) else { return };
        let Some(wanted) = level.get_ref().cells.as_ref() else { return };
        let has = |case: &&Case| i64::try_from(case.cells) == Ok(*wanted.get_ref());
        if !cases.iter().any(has) {
            let levels = listed(cases.iter().map(|case| case.cells.to_string()));
            self.complain(
                wanted.span(),
                format!("no case that the expectation names has {} cells", wanted.get_ref()),
                format!("they have {levels}"),
            );
        }
    }

    /// The same for an expectation of single cases.
    pub(crate) fn case_is_there(
        &mut self,
        entry: &Spanned<ExpectCaseTable>,
        expectation: &CaseExpectation,
        planned: &[PlannedCase],
    ) {
        let table = entry.get_ref();
        let Some(cases) = self.selected(table, &expectation.selection, "", entry.span(), planned) else {
            return;
        };
        if let Some(error) = &expectation.demand.error {
            let time = table.time_factor.as_ref().map(|typed| typed.span());
            self.time_is_kept(&cases, error.measure.time_factor, time.unwrap_or(entry.span()));
        }
    }

    /// The cases that a selection names along an axis; a complaint at the first key that leaves none. Nothing where
    /// there are complaints already: they may be why.
    fn selected<'a, Own>(
        &mut self,
        table: &InputTable<One, Own>,
        selection: &Selection,
        axis: &str,
        place: Range<usize>,
        planned: &'a [PlannedCase],
    ) -> Option<Vec<&'a Case>> {
        if !self.diagnostics.is_empty() || self.purpose != Purpose::Solving {
            return None;
        }
        let mut cases: Vec<&Case> = planned.iter().map(|planned| &planned.case).collect();
        for (key, value) in selection.0.iter().filter(|(key, _)| key.name != axis) {
            let before = cases.clone();
            cases.retain(|case| key.get(case) == *value);
            if cases.is_empty() {
                let others = listed(before.iter().map(|case| key.get(case).to_string()));
                let span = table.typed(key.name).map_or(place, Spanned::span);
                let with =
                    if selection.0.len() > 1 { " with the others that the expectation names" } else { "" };
                self.complain(
                    span,
                    format!("no case of the study has `{} = {value}`{with}", key.name),
                    format!("the cases have {others}"),
                );
                return None;
            }
        }
        Some(cases)
    }

    /// Complains where none of the cases keeps its state at a time factor.
    fn time_is_kept(&mut self, cases: &[&Case], time_factor: f64, place: Range<usize>) {
        let is_kept = |case: &&Case| case.task == Task::Stability || case.time_factors.contains(&time_factor);
        if !cases.iter().any(is_kept) {
            let factors =
                listed(cases.iter().flat_map(|case| case.time_factors.iter()).map(ToString::to_string));
            self.complain(
                place,
                format!("no case keeps its state at T_v = {time_factor}"),
                format!("the outputs are at {factors}: name one of them, or add it to `output.time_factors`"),
            );
        }
    }
}

/// Words in the order in which they come, each once.
fn listed(words: impl Iterator<Item = String>) -> String {
    const MOST: usize = 12;
    let mut once: Vec<String> = Vec::new();
    for word in words {
        if !once.contains(&word) {
            once.push(word);
        }
        if once.len() > MOST {
            break;
        }
    }
    if once.len() > MOST {
        once.truncate(MOST);
        once.push("…".to_owned());
    }
    once.join(", ")
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn said(expectation: &str) -> Option<String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1, 0.2]\n\n[[sweep]]\n\
             method = [\"MPM\", \"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [4, 8, 16]\n\n{expectation}\n"
        );
        let source = StudySource { name: "t.toml".to_owned(), text };
        Study::check(&source).err().map(|error| error.to_string())
    }

    #[test]
    fn an_expectation_that_no_case_can_answer_is_refused_at_its_line() {
        let series = "[[expect]]\nmethod = \"GIMP\"\ntime_factor = 0.1\norder = { value = 2.0 }";
        assert_eq!(said(series), None);
        for (from, to, parts) in [
            (
                "\"GIMP\"",
                "\"GIMP-SRI\"",
                ["no case of the study has `method = GIMP-SRI`", "the cases have MPM, GIMP"],
            ),
            ("0.1", "0.15", ["no case keeps its state at T_v = 0.15", "the outputs are at 0.1, 0.2"]),
            ("0.1", "0.1\nintegrator = \"explicit\"", ["`integrator = explicit`", "the cases have implicit"]),
            ("order", "at = { cells = 10, below = 0.1 }\norder", ["has 10 cells", "they have 4, 8, 16"]),
        ] {
            let told = said(&series.replacen(from, to, 1)).expect("refused");
            assert!(parts.iter().all(|part| told.contains(part)) && told.contains("t.toml:1"), "{told}");
        }
        let case = "[[expect_case]]\ncells = 4\nstatus = \"ok\"";
        assert_eq!(said(case), None);
        assert!(said(&case.replacen('4', "5", 1)).expect("refused").contains("`cells = 5`"));
    }
}
