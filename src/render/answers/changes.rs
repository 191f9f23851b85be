//! What changed since the golden values, or another state? What got worse first.

use crate::history::comparison::StudyComparison;
use crate::render::answers::{Answer, Question, short};
use crate::render::history_tables::comparison_tables;
use crate::render::page::Block;
use oedometer_soil::wording::count_of;

const QUESTION: Question = Question { heading: "What changed?", id: "changes" };

/// The studies that differ, as `oedometer compare` shows them.
pub fn answer(changes: Option<&[StudyComparison]>, against: &str) -> Answer {
    let changes = changes?;
    if changes.is_empty() {
        let text = format!(
            "Nothing: every value that these studies share with {against} agrees within its tolerance."
        );
        return Some(QUESTION.told(text, Vec::new()));
    }
    let worse = changes.iter().filter(|one| one.is_regression()).count();
    let sentence = format!(
        "Against {against} {} changed, of which {worse} got worse.",
        count_of(changes.len(), "study", "studies")
    );
    let tables = comparison_tables(changes, [against, "this report"]);
    let block = |table| Block::Table(short(table, "listed by `oedometer compare` and `oedometer check`"));
    Some(QUESTION.told(sentence, tables.into_iter().map(block).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::history::state::StudyState;

    #[test]
    fn what_got_worse_is_counted_and_shown_and_nothing_is_said_to_be_nothing() {
        let state = |error: f64| {
            let values = [("GIMP cells=4 | pressure T_v=1".to_owned(), error)].into();
            StudyState::of_golden(GoldenFile { values, ..GoldenFile::of("s", &[], "-") })
        };
        let changes = [("worse", 0.3), ("better", 0.1)]
            .map(|(name, error)| StudyComparison::of(name, &state(0.2), &state(error)));
        let Some(section) = answer(Some(&changes), "v1.0") else { panic!("they differ") };
        let told = format!("{section:?}");
        assert!(told.contains("Against v1.0 2 studies changed, of which 1 got worse"), "{told}");
        assert!(told.contains("regressed") && told.contains("improved"), "{told}");
        assert!(format!("{:?}", answer(Some(&[]), "v1.0")).contains("Nothing"));
        assert!(answer(None, "v1.0").is_none());
    }
}
