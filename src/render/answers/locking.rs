//! Which method locks, from which Poisson's ratio, and by how much? Answered where a study sweeps it in the plane.

use crate::judge::comparison::stiffness_sweep::{KEPT, StiffnessSweep, SweepRow, SweptStiffness};
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::largest as largest_of;
use crate::render::answers::{self, Answer, Question};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};
use oedometer_exact::exact_error::ExactError;
use oedometer_soil::wording::{count_of, short, typed};
use std::fmt::Write;

const QUESTION: Question = Question { heading: "Who locks?", id: "locking" };

/// The study that sweeps Poisson's ratio with the most methods.
///
/// # Errors
/// When a reference refuses a case.
pub fn answer(results: &[StudyResults<'_>]) -> Result<Answer, ExactError> {
    let mut widest: Option<(&StudyResults<'_>, StiffnessSweep)> = None;
    for one in results.iter().filter(|one| one.study.scene.shows_locking() && !one.study.is_race) {
        let sweep = StiffnessSweep::of(one.study, one.records, SweptStiffness::Skeleton)?;
        let is_wider = |sweep: &StiffnessSweep| {
            widest.as_ref().is_none_or(|(_, other)| sweep.rows.len() > other.rows.len())
        };
        if let Some(sweep) = sweep.filter(is_wider) {
            widest = Some((one, sweep));
        }
    }
    let Some((one, sweep)) = widest else { return Ok(None) };
    let Some(time) = sweep.time_factors.last().copied() else { return Ok(None) };
    let rows: Vec<&SweepRow> = sweep.at(time).collect();
    let sentence = sentence(&sweep, &rows, time);
    let table = answers::short(table(&sweep, &rows), "on the page of the study");
    Ok(Some(QUESTION.told(&sentence, [one.study.name.as_str()], vec![Block::Table(table)])))
}

fn sentence(sweep: &StiffnessSweep, rows: &[&SweepRow], time: f64) -> String {
    let names = |of: &dyn Fn(&SweepRow) -> bool| {
        let named = rows.iter().filter(|row| of(row)).map(|row| format!("`{}`", row.method));
        named.collect::<Vec<_>>().join(", ")
    };
    let largest = sweep.values.last().copied().unwrap_or_default();
    let last = sweep.values.len().saturating_sub(1);
    let is_kept = |row: &SweepRow| {
        row.lost_from().is_none()
            && row.failed_from().is_none()
            && row.errors(last).iter().all(Option::is_some)
    };
    let kept = rows.iter().filter(|row| is_kept(row)).count();
    let mut text = format!(
        "Of {} on {} cells, at T_v = {}, {kept} {} displacement and pressure within {} % up to ν = {}",
        count_of(rows.len(), "method", "methods"),
        sweep.cells,
        typed(time),
        if kept == 1 { "keeps" } else { "keep" },
        short(100.0 * KEPT),
        typed(largest)
    );
    if kept > 0 {
        text += ": ";
        text += &names(&is_kept);
    }
    for (place, value) in sweep.values.iter().enumerate() {
        let of_place = |row: &SweepRow| row.lost_from() == Some(place);
        let lost = names(&of_place);
        if !lost.is_empty() {
            let errors = rows.iter().filter(|row| of_place(row)).flat_map(|row| row.errors(place)).flatten();
            let off = largest_of(errors)
                .map_or(String::new(), |off| format!(" (off by up to {})", off_in_words(off)));
            text += &["; lost from ν = ", &typed(*value), " on", &off, ": ", &lost].concat();
        }
    }
    for row in rows {
        if let Some((place, how)) = row.failed_from() {
            let _ = write!(text, "; failed at ν = {} ({how}): `{}`", typed(sweep.values[place]), row.method);
        }
    }
    text + "."
}

/// An error in percent, or from twice the exact value on in multiples of it.
fn off_in_words(error: f64) -> String {
    if error < 1.5 {
        number::percent(error)
    } else {
        format!("{} times the exact value", number::number(error.round()))
    }
}

/// One row for each method, those that keep their result first.
fn table(sweep: &StiffnessSweep, rows: &[&SweepRow]) -> Table {
    let last = sweep.values.len() - 1;
    let mut rows = rows.to_vec();
    rows.sort_by_key(|row| std::cmp::Reverse(row.lost_from().unwrap_or(usize::MAX)));
    let cells = rows.into_iter().map(|row| {
        let verdict = match row.lost_from() {
            None if row.failed_from().is_some() => {
                let (place, how) = row.failed_from().unwrap_or_default();
                Cell::Verdict(Mood::Fail, format!("failed at ν = {}: {how}", typed(sweep.values[place])))
            }
            None => Cell::Verdict(Mood::Pass, "kept".to_owned()),
            Some(place) => Cell::Verdict(Mood::Fail, format!("lost from ν = {}", typed(sweep.values[place]))),
        };
        let error = |place: usize, which: usize| Cell::of(row.errors(place)[which], Cell::Error, "no result");
        vec![
            Cell::Code(row.method.to_string()),
            verdict,
            error(0, 0),
            error(last, 0),
            error(0, 1),
            error(last, 1),
        ]
    });
    let [first, last] = [sweep.values[0], sweep.values[last]].map(typed);
    let header = format!(
        "method | result | > displacement, ν = {first} | > ν = {last} | > pressure, ν = {first} | > ν = {last}"
    );
    Table::of("Errors over Poisson's ratio", columns(&header), cells).note(format!(
        "relative L2 errors of the nodal displacement and of the pressure at the points on {} cells; kept: both below {}",
        sweep.cells,
        short(KEPT)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::SolverName;
    use crate::case::planned::Tier;
    use oedometer_mpm::method::Method;

    #[test]
    fn every_error_of_the_table_stands_under_its_quantity_and_stiffness() {
        let method = |name: &str| SolverName::Own(Method::named(name).expect("a method"));
        let row = |name: &str, first: f64| SweepRow {
            method: method(name),
            time_factor: 0.1,
            found: (0..3)
                .map(|place| [0.0, 0.001, 0.002].map(|which| Some(first + 0.01 * f64::from(place) + which)))
                .collect(),
            failed: vec![None; 3],
        };
        let rows = [row("MPM", 0.01), row("GIMP", 0.04)];
        let sweep = StiffnessSweep {
            stiffness: SweptStiffness::Skeleton,
            cells: 4,
            values: vec![0.2, 0.4, 0.49],
            time_factors: vec![0.1],
            rows: rows.to_vec(),
        };
        let table = table(&sweep, &[&rows[0], &rows[1]]);
        for (row, first) in table.rows.iter().zip([0.01, 0.04]) {
            let numbers: Vec<f64> = row
                .iter()
                .filter_map(|cell| if let Cell::Error(error) = cell { Some(*error) } else { None })
                .collect();
            let wanted = [first, first + 0.02, first + 0.001, first + 0.021];
            assert_eq!(numbers.len(), 4, "{row:?}");
            assert!(numbers.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-12), "{row:?}");
        }
    }

    #[test]
    fn an_error_is_a_share_until_it_is_twice_the_exact_value() {
        let told = [0.529, 1.04, 1.49, 1.5, 288.6].map(off_in_words);
        assert_eq!(
            told,
            ["52.9 %", "104 %", "149 %", "2 times the exact value", "289 times the exact value"]
        );
    }

    #[test]
    fn a_result_is_lost_with_either_quantity_from_the_first_value_on() {
        let method = |name: &str| SolverName::Own(Method::named(name).expect("a method"));
        // Oscillation does not count.
        let row = |name: &str, errors: [[Option<f64>; 2]; 3]| SweepRow {
            method: method(name),
            time_factor: 0.1,
            found: errors.map(|[displacement, pressure]| [displacement, pressure, Some(9.0)]).to_vec(),
            failed: vec![None; 3],
        };
        let (kept, lost) = (Some(0.05), Some(0.2));
        let sound = [[kept; 2]; 3];
        assert_eq!(row("MPM", sound).lost_from(), None);
        assert_eq!(row("MPM", [[Some(0.099), Some(0.0)]; 3]).lost_from(), None);
        for bad in [
            [lost, kept],
            [kept, lost],
            [lost, lost],
            [None, kept],
            [kept, None],
            [Some(f64::NAN), kept],
            [kept, Some(f64::NAN)],
            [Some(KEPT), kept],
            [kept, Some(KEPT)],
        ] {
            for place in 0..3 {
                let mut errors = sound;
                errors[place] = bad;
                assert_eq!(row("MPM", errors).lost_from(), Some(place), "{errors:?}");
                errors[2] = [lost; 2];
                assert_eq!(row("MPM", errors).lost_from(), Some(place), "{errors:?}");
            }
        }
        let rows = [
            row("MPM", [[kept, kept], [kept, Some(0.25)], [Some(3.2), kept]]),
            row("GIMP", sound),
            row("GIMP-SRI", [[kept, kept], [kept, kept], [Some(4.6), Some(0.1)]]),
            row("VP", [[kept, kept], [Some(0.5), kept], [kept, kept]]),
        ];
        let sweep = StiffnessSweep {
            stiffness: SweptStiffness::Skeleton,
            cells: 4,
            values: vec![0.2, 0.4, 0.49],
            time_factors: vec![0.1],
            rows: rows.to_vec(),
        };
        let all: Vec<&SweepRow> = rows.iter().collect();
        assert_eq!(
            sentence(&sweep, &all, 0.1),
            "Of 4 methods on 4 cells, at T_v = 0.1, 1 keeps displacement and pressure within 10 % up to ν = 0.49: `GIMP`; \
             lost from ν = 0.4 on (off by up to 50.0 %): `MPM`, `VP`; lost from ν = 0.49 on (off by up to 5 times the \
             exact value): `GIMP-SRI`."
        );
        let words = |cell: &Cell| cell.show();
        let shown = table(&sweep, &all);
        let told: Vec<[String; 2]> = shown.rows.iter().map(|row| [words(&row[0]), words(&row[1])]).collect();
        let methods: Vec<&str> = told.iter().map(|row| row[0].as_str()).collect();
        assert_eq!(methods, ["GIMP", "GIMP-SRI", "MPM", "VP"], "those that keep it first: {told:?}");
        let none: Vec<&SweepRow> = all.iter().copied().filter(|row| row.method.to_string() == "VP").collect();
        assert_eq!(
            sentence(&sweep, &none, 0.1),
            "Of 1 method on 4 cells, at T_v = 0.1, 0 keep displacement and pressure within 10 % up to ν = 0.49; lost from ν = 0.4 \
             on (off by up to 50.0 %): `VP`."
        );
        for (row, word) in
            told.iter().zip(["kept", "lost from ν = 0.49", "lost from ν = 0.4", "lost from ν = 0.4"])
        {
            assert!(row[1].ends_with(word), "{told:?}");
        }
    }

    #[test]
    fn of_several_studies_the_one_with_most_methods_answers_and_at_its_last_time() {
        let of = |name: &str, methods: &str| {
            let text = format!(
                "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\nmethod = {methods}\n\
                 integrator = ['implicit']\ncells = [2]\npoissons_ratio = [0.25, 0.3, 0.4]\ntime_step = [{{ growth = 0.5 }}]\n"
            );
            solved(name, &text)
        };
        let all =
            [of("one", "['GIMP']"), of("two", "['GIMP', 'GIMP-SRI']"), of("as-many", "['MPM', 'GIMP']")];
        let told = |places: &[usize]| {
            let results: Vec<StudyResults<'_>> = places
                .iter()
                .map(|place| StudyResults::new(&all[*place].0, &all[*place].1, Tier::Full))
                .collect();
            let section = answer(&results).expect("an answer")?;
            let Some(Block::Paragraph(text)) = section.blocks.first() else { panic!("a sentence first") };
            Some(text.clone())
        };
        for places in [&[0, 1, 2][..], &[1, 0], &[1, 2, 0]] {
            let text = told(places).expect("who locks");
            assert!(text.starts_with("Of 2 methods on 2 cells, at T_v = 0.2, "), "{text}");
            assert!(text.ends_with(" Evidence: [`two`](studies/two.html)."), "{text}");
        }
        assert_eq!(told(&[]), None);
    }
}
