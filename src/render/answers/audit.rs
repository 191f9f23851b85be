//! Are the published equations right? Each pairing of stress–strain law and continuity against the wanted solution:
//! over time on one mesh, and over the mesh at one time, where right equations converge and wrong ones do not.

use crate::case::Case;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::Path;
use crate::judge::study_results::StudyResults;
use crate::record::{Record, Status};
use crate::render::answers::{Answer, Question, study_with_most};
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, SlopeTriangle};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::labels::{self, first_measure, grouped};
use crate::study::expectation::Axis;
use oedometer_exact::reference::ReferenceKind;

const QUESTION: Question = Question { heading: "Are the published equations right?", id: "audit" };

/// Largest error of the settlement on the finest mesh for the wanted equations.
const AGREES: f64 = 0.01;

/// Equations as the paper prints them: its Eq. 6 without the porosity gradient, and its Eqs 7 and 8 as rates.
const PRINTED: (&str, &str) = ("porosity-dependent", "constant-porosity-gradient");

const MAPPING_BACK: &str = "The paper's step 5, mapping velocities back, needs a boundary condition that the paper does not name: where \
    the skeleton sticks to a base and the water slides along it, a flux between the phases grows that no pressure drives. Here the \
    nodes of the base keep the velocity of the water themselves, and nothing grows (docs/theory.md, section 3).";

const SETTLEMENT: (Quantity, Sample) = (Quantity::Settlement, Sample::Surface);
const PRESSURE: (Quantity, Sample) = (Quantity::Pressure, Sample::Points);

/// Law and continuity of a pairing, in words.
fn name_of(pairing: &Path<'_>) -> String {
    let (law, continuity) = law_and_continuity(&pairing.records[0].case);
    let mark = if is_printed(pairing) { " (as printed)" } else { "" };
    format!("{law}, {continuity}{mark}")
}

fn law_and_continuity(case: &Case) -> (&'static str, &'static str) {
    (case.material.law.name(), case.material.continuity.name())
}

fn is_printed(pairing: &Path<'_>) -> bool {
    law_and_continuity(&pairing.records[0].case) == PRINTED
}

/// The run of a pairing on a mesh.
fn on<'a>(pairing: &Path<'a>, cells: usize) -> Option<&'a Record> {
    pairing.records.iter().copied().find(|record| record.case.cells == cells)
}

/// The error of a quantity at a time, with its sign if it has one.
fn error(record: &Record, (quantity, sample): (Quantity, Sample), time: f64) -> Option<f64> {
    Some(first_measure(quantity, sample, ReferenceKind::XieLeo.name(), time).error(record)?.value)
}

/// What is compared: the finest mesh of all pairings, its times, and the time of the figure over the mesh.
struct Common {
    cells: usize,
    times: Vec<f64>,
    middle: f64,
}

/// Settlement over time and pressure over the mesh, in a figure each, and which equations agree.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let (one, (pairings, common)) = study_with_most(results, |one| {
        let pairings = pairings(one);
        let common = common_of(&pairings)?;
        // More pairings first, then more meshes and times.
        let levels: usize = pairings.iter().map(|one| one.records.len()).sum();
        Some(((pairings.len().min(4), levels * common.times.len()), (pairings, common)))
    })?;
    let figures = vec![over_time(&pairings, &common), over_mesh(&pairings, &common)];
    let blocks = vec![Block::Figures(figures), Block::Paragraph(MAPPING_BACK.to_owned())];
    Some(QUESTION.told(&sentence(&pairings, &common), [one.study.name.as_str()], blocks))
}

/// Pairings of law and continuity from coarse to fine, of the method that has most of them.
fn pairings<'a>(one: &StudyResults<'a>) -> Vec<Path<'a>> {
    let audited = one.paths.along(Axis::Cells).iter().filter_map(|path| {
        let mut path = path.clone();
        path.records.retain(|record| {
            record.status == Status::Ok
                && record.case.scene.is_large_strain()
                && record.references.iter().any(|used| used.name == ReferenceKind::XieLeo.name())
        });
        Some((what_is_shared(&path.records.first()?.case), path))
    });
    let groups = grouped(audited).into_iter().map(|(_, group)| group);
    groups.max_by_key(Vec::len).unwrap_or_default()
}

/// A number for all inputs but mesh, outputs, law and continuity.
fn what_is_shared(case: &Case) -> u64 {
    case.number_with(|case| {
        let seed = Case::seed(case.task, case.scene).material;
        case.cells = 0;
        case.time_factors.clear();
        case.material.law = seed.law;
        case.material.continuity = seed.continuity;
    })
}

/// What is compared of several pairings; `None` for a single one.
fn common_of(pairings: &[Path<'_>]) -> Option<Common> {
    let first = pairings.first().filter(|_| pairings.len() > 1)?;
    let cells = pairings.iter().filter_map(|one| Some(one.records.last()?.case.cells)).min()?;
    let times = on(first, cells)?.case.time_factors.iter().copied();
    let times: Vec<f64> = times.filter(|time| *time > 0.0).collect();
    let middle = *times.get(times.len().saturating_sub(1) / 2)?;
    Some(Common { cells, times, middle })
}

/// The error of the settlement of a pairing at all times.
fn settlement(one: &Path<'_>, common: &Common) -> Vec<(f64, f64)> {
    let Some(record) = on(one, common.cells) else { return Vec::new() };
    common.times.iter().filter_map(|time| Some((*time, error(record, SETTLEMENT, *time)?))).collect()
}

/// Which pairings are the wanted equations, and how far off the others are, the printed one first.
fn sentence(pairings: &[Path<'_>], common: &Common) -> String {
    let mut right = Vec::new();
    let mut wrong = Vec::new();
    for one in pairings {
        let errors = settlement(one, common);
        // What has no error at one of the times agrees at every time with nothing.
        if errors.len() < common.times.len() {
            continue;
        }
        let worst = errors.into_iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((time, error)) = worst else { continue };
        let percent = number::percent(error.abs());
        if error.abs() < AGREES {
            right.push(format!("`{}` ({percent})", name_of(one)));
        } else {
            let sign = if error > 0.0 { "+" } else { "−" };
            let place = if is_printed(one) { 0 } else { wrong.len() };
            wrong.insert(place, format!("`{}` ({sign}{percent} at T_v = {time})", name_of(one)));
        }
    }
    let (cells, limit) = (common.cells, number::percent(AGREES));
    let agree = match right.as_slice() {
        [] => format!(
            "On {cells} cells no pairing of law and continuity gives Xie & Leo's settlement within {limit}"
        ),
        all => format!(
            "On {cells} cells these pairings of law and continuity give Xie & Leo's settlement at every time (largest \
             error): {}",
            all.join(", ")
        ),
    };
    match wrong.as_slice() {
        [] => format!("{agree}."),
        all => format!("{agree}. These are other theories (largest difference): {}.", all.join(", ")),
    }
}

fn over_time(pairings: &[Path<'_>], common: &Common) -> Figure {
    let mut chart = Chart::new(
        "Settlement against Xie & Leo, over time",
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("settlement over the exact one, minus one (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(subtitle(pairings, &format!("{} cells", common.cells)));
    chart.series.extend(pairings.iter().map(|one| Series::new(name_of(one), settlement(one, common))));
    chart.rules.push(Rule { at: 0.0, label: "Xie & Leo".to_owned() });
    let caption = "One line per pairing of law and continuity; zero is Xie & Leo's column.";
    Figure::new("readme-audit-settlement", chart, caption)
}

fn over_mesh(pairings: &[Path<'_>], common: &Common) -> Figure {
    let ticks =
        labels::ticks(pairings.iter().flat_map(|one| &one.records).map(|record| record.case.cell_size()));
    let mut chart = Chart::new(
        "Pressure against Xie & Leo, over the mesh",
        ChartAxis::log10("cell size h (m)").with_ticks(ticks),
        ChartAxis::log10("relative L_2 error of the pressure at the points (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(subtitle(pairings, &format!("T_v = {}", common.middle)));
    let mut falls: Vec<(f64, String)> = Vec::new();
    for one in pairings {
        let point =
            |record: &&Record| Some((record.case.cell_size(), error(record, PRESSURE, common.middle)?));
        let points: Vec<(f64, f64)> = one.records.iter().filter_map(point).collect();
        if let [coarse, _, .., fine] = points.as_slice() {
            falls.push((coarse.1 / fine.1, name_of(one)));
        }
        chart.series.push(Series::new(name_of(one), points));
    }
    let steepest = falls.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    chart.triangles.extend(steepest.map(|(_, beside)| SlopeTriangle { slope: 2.0, beside }));
    let caption = "The error of the right equations falls with every mesh; the triangle has the slope of second order, which \
                   the method promises. The error of wrong ones stops at the difference of the two theories.";
    Figure::new("readme-audit-pressure", chart, caption)
}

/// The method, which all pairings share.
fn subtitle(pairings: &[Path<'_>], at: &str) -> String {
    let method = pairings.first().and_then(|one| one.records.first()).map(|record| record.case.method);
    method.map_or_else(|| at.to_owned(), |method| format!("{method}, {at}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, solved};
    use crate::case::planned::Tier;
    use crate::judge::paths::paths;

    const TIMES: [f64; 3] = [0.1, 0.5, 1.0];

    #[test]
    fn equations_are_judged_by_their_largest_error_of_either_sign_at_any_time() {
        let runs = records_of(
            "title = 't'\nscene = 'xie-leo'\noutput.time_factors = [0.1, 0.5, 1.0]\n[[sweep]]\n\
             method = ['TL-GIMP-SRI-patch']\nlaw = ['log-linear', 'porosity-dependent']\n\
             continuity = ['conservative', 'constant-porosity-gradient']\nintegrator = ['implicit']\ncells = [2, 4]\n\
             time_step = [{ growth = 0.5 }]\n",
        );
        let common = Common { cells: 4, times: TIMES.to_vec(), middle: 0.5 };
        // Settlement errors of each pairing on the finer mesh; none is taken away.
        let told = |errors: [[Option<f64>; 3]; 4]| {
            let mut records = runs.clone();
            let finer = records.iter_mut().filter(|record| record.case.cells == 4);
            for (record, errors) in finer.zip(errors) {
                record.errors.retain_mut(|row| {
                    let place = TIMES.iter().position(|time| *time == row.time_factor).expect("an output");
                    let is_settlement = row.quantity == Quantity::Settlement;
                    row.value = errors[place].filter(|_| is_settlement).unwrap_or(row.value);
                    !is_settlement || errors[place].is_some()
                });
            }
            let pairings = paths(&records, Axis::Cells);
            assert_eq!(pairings.len(), 4);
            sentence(&pairings, &common)
        };
        let all = |errors: [f64; 3]| errors.map(Some);
        let small = all([0.001, -0.002, 0.0]);
        assert_eq!(
            told([
                all([0.001, -0.004, 0.002]),
                all([-0.02, 0.005, 0.001]),
                all([0.001, 0.03, -0.02]),
                all([0.0, 0.02, -0.05]),
            ]),
            "On 4 cells these pairings of law and continuity give Xie & Leo's settlement at every time (largest error): \
             `log-linear, conservative` (0.40 %). These are other theories (largest difference): \
             `porosity-dependent, constant-porosity-gradient (as printed)` (−5.00 % at T_v = 1), \
             `log-linear, constant-porosity-gradient` (−2.00 % at T_v = 0.1), \
             `porosity-dependent, conservative` (+3.00 % at T_v = 0.5)."
        );
        let right = |pairing: usize, errors: [Option<f64>; 3]| {
            let mut given = [small; 4];
            given[pairing] = errors;
            let text = told(given);
            let (right, wrong) = text.split_once("These are other theories").unwrap_or((&text, ""));
            (right.matches('`').count() / 2, wrong.matches('`').count() / 2)
        };
        for pairing in 0..4 {
            for place in 0..3 {
                for (error, counts) in [
                    (Some(0.02), (3, 1)),
                    (Some(-0.02), (3, 1)),
                    (Some(0.009), (4, 0)),
                    (Some(-0.009), (4, 0)),
                    (Some(f64::NAN), (3, 1)),
                    // Neither told to agree nor to be another theory.
                    (None, (3, 0)),
                ] {
                    let mut errors = small;
                    errors[place] = error;
                    assert_eq!(right(pairing, errors), counts, "{pairing} {errors:?}");
                }
            }
        }
        let none = told([all([0.02, 0.0, 0.0]); 4]);
        assert!(none.starts_with("On 4 cells no pairing of law and continuity gives Xie & Leo's"), "{none}");
    }

    #[test]
    fn pairings_are_drawn_on_the_finest_mesh_of_all_and_at_the_middle_time_and_the_steepest_has_the_triangle()
    {
        let text = "title = 't'\nscene = 'xie-leo'\noutput.time_factors = [0.1, 0.5, 1.0]\n[[sweep]]\n\
                    method = ['TL-GIMP-SRI-patch']\nlaw = ['log-linear', 'porosity-dependent']\n\
                    continuity = ['conservative', 'constant-porosity-gradient']\nintegrator = ['implicit']\n\
                    cells = [2, 4, 8]\ntime_step = [{ growth = 0.5 }]\n";
        let (study, mut records) = solved("s", text);
        for record in &mut records {
            let cells = record.case.cells as f64;
            let is_wanted = law_and_continuity(&record.case) == ("log-linear", "conservative");
            for row in record.errors.iter_mut().filter(|row| row.reference == "xie-leo") {
                let size = if is_wanted { 1.0 / (cells * cells) } else { 1.0 / cells };
                row.value = if row.quantity == Quantity::Settlement {
                    -row.time_factor
                } else {
                    size * row.time_factor
                };
            }
            // The steepest of all would be one with two meshes.
            if law_and_continuity(&record.case) == PRINTED {
                record.errors.iter_mut().for_each(|row| row.value /= cells.powi(3));
                record.status = if record.case.cells < 8 { Status::Ok } else { failed_at(1) };
            }
        }
        let results = StudyResults::new(&study, &records, Tier::Full);
        let found = pairings(&results);
        let common = common_of(&found).expect("four pairings");
        assert_eq!((found.len(), common.cells, common.middle), (4, 4, 0.5));
        assert_eq!(common.times, TIMES);
        assert!(common_of(&found[..1]).is_none() && common_of(&[]).is_none(), "one is compared with nothing");
        let own = |figure: &Figure, name: &str| {
            figure.chart.series.iter().find(|one| one.name == name).expect("drawn").points.clone()
        };
        let [time, mesh] = [over_time(&found, &common), over_mesh(&found, &common)];
        assert_eq!(time.chart.subtitle.as_deref(), Some("TL-GIMP-SRI-patch, 4 cells"));
        assert_eq!(mesh.chart.subtitle.as_deref(), Some("TL-GIMP-SRI-patch, T_v = 0.5"));
        assert_eq!(own(&time, "log-linear, conservative"), TIMES.map(|time| (time, -time)));
        let cells = [2.0, 4.0, 8.0];
        assert_eq!(own(&mesh, "log-linear, conservative"), cells.map(|one| (1.0 / one, 0.5 / (one * one))));
        assert_eq!(
            own(&mesh, "log-linear, constant-porosity-gradient"),
            cells.map(|one| (1.0 / one, 0.5 / one))
        );
        assert_eq!(own(&mesh, "porosity-dependent, constant-porosity-gradient (as printed)").len(), 2);
        let triangle = SlopeTriangle { slope: 2.0, beside: "log-linear, conservative".to_owned() };
        assert_eq!(mesh.chart.triangles, [triangle]);
        assert_eq!(time.chart.rules, [Rule { at: 0.0, label: "Xie & Leo".to_owned() }]);
    }
}
