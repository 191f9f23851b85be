//! What changed since the golden values? The worst first.

use crate::golden::compare::{Change, Difference};
use crate::render::answers::{Answer, Question, short};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};

const QUESTION: Question = Question { heading: "What changed since the golden values?", id: "changes" };

/// The worst differences of all studies together.
pub fn answer(changes: Option<&[(String, Difference)]>) -> Answer {
    let Some(changes) = changes else {
        return QUESTION.open("golden values of these studies, which `oedometer accept` writes");
    };
    if changes.is_empty() {
        let text =
            "Nothing: every value of these studies with a golden value agrees with it within its tolerance.";
        return QUESTION.told(text, Vec::new());
    }
    let mut ranked: Vec<&(String, Difference)> = changes.iter().collect();
    let size = |one: &Difference| one.relative_change().unwrap_or(0.0);
    ranked.sort_by(|a, b| a.1.change.cmp(&b.1.change).then_with(|| size(&b.1).total_cmp(&size(&a.1))));
    let count = |kind: Change| changes.iter().filter(|(_, one)| one.change == kind).count();
    let kinds = [Change::Moved, Change::Missing, Change::Extra, Change::Smaller, Change::Stale];
    let counted: Vec<String> = kinds
        .into_iter()
        .filter(|kind| count(*kind) > 0)
        .map(|kind| format!("{} {}", count(kind), kind.name()))
        .collect();
    let rows = ranked.iter().map(|(study, one)| {
        let mood = if one.change == Change::Moved { Mood::Fail } else { Mood::Note };
        let [golden, found] = values_of(one);
        vec![
            Cell::Verdict(mood, one.change.name().to_owned()),
            Cell::Code(study.clone()),
            one.name.as_str().into(),
            golden,
            found,
            Cell::of(one.relative_change(), Cell::Percent, "nothing to compare"),
        ]
    });
    let table = Table::of(
        "The worst first",
        columns("change | study | value | > golden | > now | > relative change"),
        rows,
    );
    let sentence = format!("Values that differ from the golden ones: {}.", counted.join(", "));
    QUESTION.told(sentence, vec![Block::Table(short(table, "listed by oedometer check"))])
}

/// The golden and the present value, with digits that tell them apart.
fn values_of(one: &Difference) -> [Cell; 2] {
    if let (Some(golden), Some(found)) = (one.golden, one.found) {
        return number::told_apart([golden, found]).map(Cell::Text);
    }
    [one.golden, one.found]
        .map(|value| value.map_or(Cell::missing("no value"), |value| Cell::Text(number::error(value))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn change(name: &str, change: Change, found: f64) -> (String, Difference) {
        let difference = Difference {
            name: name.to_owned(),
            change,
            golden: Some(1.0),
            found: Some(found),
            tolerance: 0.0,
        };
        ("study".to_owned(), difference)
    }

    #[test]
    fn the_worst_stands_first_and_what_is_better_last() {
        let all = [
            change("stale | T_v=1", Change::Stale, 0.1),
            change("little | T_v=1", Change::Moved, 1.1),
            change("much | T_v=1", Change::Moved, 2.0),
        ];
        let Answer::Told(section) = answer(Some(&all)) else { panic!("they differ") };
        let Some(Block::Table(table)) = section.blocks.last() else { panic!("{section:?}") };
        let names: Vec<&Cell> = table.rows.iter().map(|row| &row[2]).collect();
        assert_eq!(names, [&"much | T_v=1".into(), &"little | T_v=1".into(), &"stale | T_v=1".into()]);
        assert!(format!("{:?}", answer(Some(&[]))).contains("Nothing"));
        assert!(matches!(answer(None), Answer::Open { .. }));
    }
}
