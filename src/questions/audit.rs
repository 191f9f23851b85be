//! Are the published equations right? Each pairing of stress–strain law and continuity against Xie & Leo's solution: over time
//! on one mesh, and over the mesh at one time, where right equations converge and wrong ones do not.

use crate::case::grouping::grouped;
use crate::case::{Case, Quantity, Sample};
use crate::judge::paths::{Path, first_measure};
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question, best};
use crate::questions::words;
use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Mood, Table, columns};
use crate::study::expectation::Axis;
use oedometer_exact::ExactError;
use oedometer_exact::reference::ReferenceKind;

/// Are the published equations right?
pub static AUDIT: Question = Question {
    id: "audit",
    heading: "Are the published equations right?",
    template: include_str!("audit.md"),
    places: &[Place::Study, Place::Report],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cells of the finest mesh that all pairings have.
    cells: usize,
    /// Number of pairings.
    pairings: usize,
    /// Number of those whose settlement is Xie & Leo's at every time.
    agreeing: usize,
    /// Their laws and continuities.
    agreeing_pairings: Vec<String>,
    /// The settlement of Xie & Leo's own equations is within this share of theirs.
    agrees_within: f64,
    /// The largest error of the equations as the paper prints them, with its sign.
    printed_error: Option<f64>,
    /// Time factor of that error.
    printed_time_factor: Option<f64>,
}

/// Largest error of the settlement of equations that are Xie & Leo's.
const AGREES: f64 = 0.01;

/// Equations as the paper prints them: its Eq. 6 without the porosity gradient, and its Eqs 7 and 8 as rates.
const PRINTED: (&str, &str) = ("porosity-dependent", "constant-porosity-gradient");

/// Pairings of law and continuity against Xie & Leo's solution.
#[derive(Debug, PartialEq)]
struct Audit {
    method: String,
    /// Cells of the finest mesh that all pairings have.
    cells: usize,
    /// Time factor of the pressures.
    time_factor: f64,
    /// The printed one first.
    pairings: Vec<Pairing>,
}

/// A law with a continuity.
#[derive(Debug, PartialEq)]
struct Pairing {
    law: &'static str,
    continuity: &'static str,
    /// Time factor, and settlement over Xie & Leo's less one, on the mesh of the comparison.
    settlement: Vec<(f64, f64)>,
    /// Cell size, m, and relative L2 error of the pressure at the points.
    pressure: Vec<(f64, f64)>,
    /// Time factor and largest error of the settlement with its sign; none where an output has none.
    largest: Option<(f64, f64)>,
}

/// The study that has most pairings, then most meshes and times, answers.
fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let audited = best(studies, |one| {
        let pairings = pairings(one);
        let Some(audit) = Audit::new(&pairings) else { return Ok(None) };
        let levels: usize = pairings.iter().map(|pairing| pairing.records.len()).sum();
        let times = audit.pairings.iter().map(|pairing| pairing.settlement.len()).max();
        Ok(times.map(|times| ((pairings.len().min(4), levels * times), audit)))
    })?;
    Ok(audited.map(|(one, audit)| answer(&one.study.name, &audit)))
}

fn answer(study: &str, audit: &Audit) -> Finding {
    let agreeing: Vec<&Pairing> = audit.pairings.iter().filter(|pairing| pairing.agrees()).collect();
    let printed = audit.pairings.iter().find(|pairing| pairing.is_printed()).and_then(|one| one.largest);
    let facts = Facts {
        cells: audit.cells,
        pairings: audit.pairings.len(),
        agreeing: agreeing.len(),
        agreeing_pairings: agreeing.iter().map(|one| format!("{}, {}", one.law, one.continuity)).collect(),
        agrees_within: AGREES,
        printed_error: printed.map(|(_, error)| error),
        printed_time_factor: printed.map(|(time_factor, _)| time_factor),
    };
    AUDIT
        .answer([study], &facts)
        .with(Block::Table(table(audit)))
        .with(Block::Figures(vec![over_time(audit), over_mesh(audit)]))
}

impl Audit {
    /// `None` for fewer than two pairings.
    fn new(pairings: &[Path<'_>]) -> Option<Self> {
        let first = pairings.first().filter(|_| pairings.len() > 1)?;
        let cells = pairings.iter().filter_map(|one| Some(one.records.last()?.case.cells)).min()?;
        let times = on(first, cells)?.case.time_factors.iter().copied();
        let times: Vec<f64> = times.filter(|time| *time > 0.0).collect();
        let time_factor = *times.get(times.len().saturating_sub(1) / 2)?;
        let mut pairings: Vec<Pairing> =
            pairings.iter().map(|pairing| Pairing::new(pairing, cells, &times, time_factor)).collect();
        pairings.sort_by_key(|pairing| !pairing.is_printed());
        Some(Self { method: first.records[0].case.method.to_string(), cells, time_factor, pairings })
    }
}

impl Pairing {
    fn new(pairing: &Path<'_>, cells: usize, times: &[f64], time_factor: f64) -> Self {
        let (law, continuity) = law_and_continuity(&pairing.records[0].case);
        let settlement: Vec<(f64, f64)> = on(pairing, cells).map_or(Vec::new(), |record| {
            let error =
                |time: &f64| Some((*time, error(record, Quantity::Settlement, Sample::Surface, *time)?));
            times.iter().filter_map(error).collect()
        });
        let pressure = pairing.records.iter().filter_map(|record| {
            Some((record.case.cell_size(), error(record, Quantity::Pressure, Sample::Points, time_factor)?))
        });
        // What has no error at one of the times agrees at every time with nothing.
        let largest = settlement.iter().filter(|_| settlement.len() == times.len());
        let largest = largest.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).copied();
        Self { law, continuity, pressure: pressure.collect(), largest, settlement }
    }

    fn is_printed(&self) -> bool {
        (self.law, self.continuity) == PRINTED
    }

    fn agrees(&self) -> bool {
        self.largest.is_some_and(|(_, error)| error.abs() < AGREES)
    }

    /// Whether the last mesh halves the error of the pressure at least.
    fn falls(&self) -> bool {
        matches!(self.pressure.as_slice(), [.., (_, coarse), (_, fine)] if coarse.abs() > 2.0 * fine.abs())
    }

    fn name(&self) -> String {
        let mark = if self.is_printed() { " (as printed)" } else { "" };
        format!("{}, {}{mark}", self.law, self.continuity)
    }
}

fn table(audit: &Audit) -> Table {
    let rows = audit.pairings.iter().map(|pairing| {
        let mood =
            if pairing.agrees() { (Mood::Pass, "Xie & Leo's") } else { (Mood::Fail, "another theory") };
        let missing = || Cell::missing("an output has no settlement");
        let [error, time, verdict] = pairing.largest.map_or_else(
            || [missing(), missing(), missing()],
            |(time, error)| {
                [Cell::Percent(error), Cell::Number(time), Cell::Verdict(mood.0, mood.1.to_owned())]
            },
        );
        vec![Cell::Code(pairing.name()), error, time, verdict]
    });
    let header = "law, continuity | > largest error of the settlement | > at T_v | equations";
    Table::of("Settlement against Xie & Leo's", columns(header), rows).file("audit")
}

fn over_time(audit: &Audit) -> Figure {
    let mut chart = Chart::new(
        format!(
            "{} of {} pairings settle within {} of Xie & Leo",
            audit.pairings.iter().filter(|one| one.agrees()).count(),
            audit.pairings.len(),
            number::rounded_percent(AGREES)
        ),
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("settlement over the exact one, minus one (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(format!("{}, {} cells", audit.method, audit.cells));
    let series = |pairing: &Pairing| Series::new(pairing.name(), pairing.settlement.clone());
    chart.series.extend(audit.pairings.iter().map(series));
    chart.rules.push(Rule { at: 0.0, label: "Xie & Leo".to_owned() });
    Figure::new("audit-settlement", chart, "Zero is Xie & Leo's solution.")
}

fn over_mesh(audit: &Audit) -> Figure {
    let points = || audit.pairings.iter().flat_map(|pairing| &pairing.pressure);
    let mut chart = Chart::new(
        format!(
            "The error of {} of {} pairings still falls on the last mesh",
            audit.pairings.iter().filter(|one| one.falls()).count(),
            audit.pairings.len()
        ),
        ChartAxis::log10("cell size h (m)").with_ticks(words::ticks(points().map(|(size, _)| *size))),
        ChartAxis::log10("relative L_2 error of the pressure at the points (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(format!("{}, T_v = {}", audit.method, audit.time_factor));
    let series = |pairing: &Pairing| Series::new(pairing.name(), pairing.pressure.clone());
    chart.series.extend(audit.pairings.iter().map(series));
    let caption = "With the right equations the error falls with every mesh; with wrong ones it stops at \
                   the difference between the two theories.";
    Figure::new("audit-pressure", chart, caption)
}

fn law_and_continuity(case: &Case) -> (&'static str, &'static str) {
    (case.material.law.name(), case.material.continuity.name())
}

/// The run of a pairing on a mesh.
fn on<'a>(pairing: &Path<'a>, cells: usize) -> Option<&'a Record> {
    pairing.records.iter().copied().find(|record| record.case.cells == cells)
}

/// The error of a quantity against Xie & Leo's solution at a time, with its sign if it has one.
fn error(record: &Record, quantity: Quantity, sample: Sample, time: f64) -> Option<f64> {
    Some(first_measure(quantity, sample, ReferenceKind::XieLeo.name(), time).error(record)?.value)
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
        Some(path).filter(|path| !path.records.is_empty())
    });
    let groups = grouped(audited, |path| what_is_shared(&path.records[0].case));
    groups.into_iter().map(|(_, group)| group).max_by_key(Vec::len).unwrap_or_default()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;

    const TIMES: [f64; 3] = [0.1, 0.5, 1.0];
    const STUDY: &str = "title = 't'\nscene = 'xie-leo'\noutput.time_factors = [0.1, 0.5, 1.0]\n[[sweep]]\n\
        method = ['TL-GIMP-SRI-patch']\nlaw = ['log-linear', 'porosity-dependent']\n\
        continuity = ['conservative', 'constant-porosity-gradient']\nintegrator = ['implicit']\ncells = [2, 4, 8]\n\
        time_step = [{ growth = 0.5 }]\n";

    #[test]
    fn equations_are_judged_by_their_largest_error_of_either_sign_at_any_time() {
        let (study, runs) = solved("s", STUDY);
        // Settlement errors of each pairing on the finest mesh; none is taken away.
        let judged = |errors: [[Option<f64>; 3]; 4]| {
            let mut records = runs.clone();
            let finest = records.iter_mut().filter(|record| record.case.cells == 8);
            for (record, errors) in finest.zip(errors) {
                record.errors.retain_mut(|row| {
                    let place = TIMES.iter().position(|time| *time == row.time_factor).expect("an output");
                    let is_settlement = row.quantity == Quantity::Settlement;
                    row.value = errors[place].filter(|_| is_settlement).unwrap_or(row.value);
                    !is_settlement || errors[place].is_some()
                });
            }
            let audit = Audit::new(&pairings(&StudyResults::new(&study, &records, Tier::Full)));
            let pairings = audit.expect("four pairings").pairings.into_iter();
            pairings.map(|one| (one.law, one.continuity, one.agrees(), one.largest)).collect::<Vec<_>>()
        };
        let all = |errors: [f64; 3]| errors.map(Some);
        let of = |law, continuity, agrees: bool, error: f64, time_factor: f64| {
            (law, continuity, agrees, Some((time_factor, error)))
        };
        assert_eq!(
            judged([
                all([0.001, -0.004, 0.002]),
                all([-0.02, 0.005, 0.001]),
                all([0.001, 0.03, -0.02]),
                all([0.0, 0.02, -0.05]),
            ]),
            [
                of("porosity-dependent", "constant-porosity-gradient", false, -0.05, 1.0),
                of("log-linear", "conservative", true, -0.004, 0.5),
                of("log-linear", "constant-porosity-gradient", false, -0.02, 0.1),
                of("porosity-dependent", "conservative", false, 0.03, 0.5),
            ],
            "the printed ones first"
        );
        let small = all([0.001, -0.002, 0.0]);
        for pairing in 0..4 {
            for place in 0..3 {
                for (error, counts) in [
                    (Some(0.02), (3, 1)),
                    (Some(-0.02), (3, 1)),
                    (Some(0.009), (4, 0)),
                    (Some(-0.009), (4, 0)),
                    (Some(f64::NAN), (3, 1)),
                    // Neither found to agree nor to be another theory.
                    (None, (3, 0)),
                ] {
                    let mut given = [small; 4];
                    given[pairing][place] = error;
                    let told = judged(given);
                    let right = told.iter().filter(|one| one.2).count();
                    let wrong = told.iter().filter(|one| !one.2 && one.3.is_some()).count();
                    assert_eq!((right, wrong), counts, "{pairing} {place} {error:?}");
                }
            }
        }
    }

    #[test]
    fn pairings_are_compared_on_the_finest_mesh_of_all_and_at_the_middle_time() {
        let (study, mut records) = solved("s", STUDY);
        for record in &mut records {
            let cells = record.case.cells as f64;
            for row in record.errors.iter_mut().filter(|row| row.reference == "xie-leo") {
                let is_settlement = row.quantity == Quantity::Settlement;
                row.value = if is_settlement { -row.time_factor } else { row.time_factor / (cells * cells) };
            }
            if law_and_continuity(&record.case) == PRINTED && record.case.cells == 8 {
                record.status = failed_at(1);
            }
        }
        let results = [StudyResults::new(&study, &records, Tier::Full)];
        let audit = Audit::new(&pairings(&results[0])).expect("an audit");
        assert_eq!((audit.cells, audit.time_factor, audit.method.as_str()), (4, 0.5, "TL-GIMP-SRI-patch"));
        let [printed, wanted, ..] = &audit.pairings[..] else { panic!("{audit:?}") };
        assert_eq!((printed.is_printed(), printed.pressure.len()), (true, 2), "its finest run failed");
        assert_eq!(wanted.settlement, TIMES.map(|time| (time, -time)));
        assert_eq!(wanted.pressure, [2.0, 4.0, 8.0].map(|cells| (1.0 / cells, 0.5 / (cells * cells))));
        let found = ask(&results).expect("sound").expect("an audit");
        assert_eq!(
            found.sentence().expect("a sentence"),
            "On 4 cells, 0 of 4 pairings of law and continuity reproduce Xie & Leo's settlement within 1 % \
             at every time. The equations as printed in the paper are off by −100.0 % at T_v = 1."
        );
        records.retain(|record| law_and_continuity(&record.case) == PRINTED);
        let alone = ask(&[StudyResults::new(&study, &records, Tier::Full)]);
        assert_eq!(alone.expect("sound"), None, "one pairing is compared with nothing");
    }

    #[test]
    fn every_pairing_is_drawn_and_told() {
        let pairing = |law, continuity, error: Option<f64>, pressure: &[(f64, f64)]| Pairing {
            law,
            continuity,
            settlement: vec![(0.1, -0.1)],
            pressure: pressure.to_vec(),
            largest: error.map(|error| (0.5, error)),
        };
        let audit = Audit {
            method: "M".to_owned(),
            cells: 4,
            time_factor: 0.5,
            pairings: vec![
                pairing(PRINTED.0, PRINTED.1, Some(0.079), &[(0.5, 1.0), (0.25, 0.001)]),
                pairing("flat", "c", None, &[(0.5, 1.0), (0.25, 0.5), (0.125, 0.25)]),
                pairing("right", "c", Some(-0.004), &[(0.5, 1.0), (0.25, 0.25), (0.125, 0.0625)]),
            ],
        };
        let [time, mesh] = [over_time(&audit), over_mesh(&audit)].map(|figure| figure.chart);
        let names: Vec<&str> = mesh.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(
            names,
            ["porosity-dependent, constant-porosity-gradient (as printed)", "flat, c", "right, c"]
        );
        assert_eq!(time.series[1].points, [(0.1, -0.1)]);
        assert_eq!(mesh.series[2].points, audit.pairings[2].pressure);
        let subtitles = [&time, &mesh].map(|chart| chart.subtitle.clone().unwrap_or_default());
        assert_eq!(subtitles, ["M, 4 cells", "M, T_v = 0.5"]);
        assert_eq!(time.rules, [Rule { at: 0.0, label: "Xie & Leo".to_owned() }]);
        let told: Vec<Vec<String>> =
            table(&audit).rows.iter().map(|row| row[1..].iter().map(Cell::show).collect()).collect();
        assert_eq!(
            told,
            [["7.90 %", "0.5", "✗ another theory"], ["–"; 3], ["-0.40 %", "0.5", "✓ Xie & Leo's"]]
        );
        let facts = answer("s", &audit).facts;
        let errors = ["printed_error", "printed_time_factor"].map(|key| facts[key].as_f64());
        assert_eq!(errors, [Some(0.079), Some(0.5)]);
    }
}
