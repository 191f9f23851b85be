//! How does the surface settle by date? Settlements at the outputs of a study, exact and of the run that its answer names: what
//! an engineer looks up by date.

use crate::case::grouping::grouped;
use crate::case::{Norm, Quantity, Sample};
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::larger;
use crate::measure::theory::known_reference;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::within::{choice, problem, within};
use crate::record::Record;
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};
use crate::study::check::Study;
use oedometer_exact::ExactError;
use oedometer_wording::clock_time;
use serde::Serialize;

/// How does the surface settle by date? Asked of studies with outputs at times.
pub static SETTLEMENT: Question = Question {
    id: "settlement",
    heading: "Settlement by date",
    template: include_str!("settlement.md"),
    places: &[Place::Terminal, Place::Study],
    ask,
};

/// Every number and name of the sentence.
#[derive(Serialize)]
struct Facts {
    /// Label of the first run.
    run: String,
    /// Number of the others: the same method and mesh on other problems.
    others: usize,
    /// Reference.
    reference: String,
    /// Largest error of all settlements; `None` where no run has one to compare.
    largest_error: Option<f64>,
}

fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let [one] = studies else { return Ok(None) };
    if one.study.is_race || !one.study.has_dates {
        return Ok(None);
    }
    Ok(answer(&one.study.name, &settlements(one.study, one.records)?))
}

fn answer(study: &str, runs: &[RunSettlements]) -> Option<Finding> {
    let first = runs.first()?;
    let (run, others, reference) = (first.run.clone(), runs.len() - 1, first.reference.clone());
    let errors = runs.iter().flat_map(|of_run| &of_run.rows).filter_map(|row| row.error);
    let largest_error = errors.map(f64::abs).reduce(larger);
    let finding = SETTLEMENT.answer([study], &Facts { run, others, reference, largest_error });
    Some(finding.with(Block::Table(table(runs))))
}

/// Most problems of a study whose settlements are listed: of more nobody reads them.
const MOST_PROBLEMS: usize = 4;

/// The settlement of one problem at every output.
struct RunSettlements {
    /// Label of the run.
    run: String,
    /// What is unusual about its soil and geometry.
    variant: String,
    /// Reference.
    reference: String,
    /// Outputs, in the order of their times.
    rows: Vec<SettlementRow>,
}

/// The settlement at one output.
#[derive(Debug)]
struct SettlementRow {
    /// Time, s.
    seconds: f64,
    /// Time factor.
    time_factor: f64,
    /// Degree of consolidation by settlement of the exact solution, where it has an end.
    degree: Option<f64>,
    /// Exact settlement, m.
    exact: f64,
    /// Settlement of the run, m.
    computed: Option<f64>,
    /// Settlement of the run over the exact one, less one; `None` where it has none to compare.
    error: Option<f64>,
}

/// The settlements of the runs that the answer for the settlement names: of the cheapest choice within its largest bound, or
/// else of the choice with the least error. Empty where nothing settles, or where a study has more problems than anyone reads.
///
/// # Errors
/// When a reference refuses a case.
fn settlements(study: &Study, records: &[Record]) -> Result<Vec<RunSettlements>, ExactError> {
    let within = within(study, records);
    let settlement = within.iter().find(|answer| answer.best.quantity == Quantity::Settlement);
    let (Some(answer), Some(kind)) = (settlement, study.references.first()) else { return Ok(Vec::new()) };
    let answering = answer.choices.iter().flatten().next().unwrap_or(&answer.best).case.as_str();
    let Some(named) = records.iter().find(|record| record.hash == answering) else { return Ok(Vec::new()) };
    let alike = records.iter().filter(|record| choice(&record.case) == choice(&named.case));
    let problems = grouped(alike, |record| problem(&record.case));
    if problems.len() > MOST_PROBLEMS {
        return Ok(Vec::new());
    }
    let runs = problems.into_iter().map(|(_, runs)| runs[0]);
    runs.map(|record| {
        let case = &record.case;
        let reference = known_reference(case, kind.for_soil(&case.material), &case.time_factors)?;
        let row = |time_factor: &f64| -> Result<SettlementRow, ExactError> {
            let (surface, norm) = (Sample::Surface, Norm::Relative);
            let error = record.error(Quantity::Settlement, surface, norm, reference.name(), *time_factor);
            let has_degree = reference.has_degree();
            let exact = reference.settlement(*time_factor)?;
            let error = error.map(|row| row.value).filter(|value| value.is_finite());
            Ok(SettlementRow {
                seconds: time_factor * case.seconds_per_time_factor(),
                time_factor: *time_factor,
                degree: has_degree.then(|| reference.degree_of_consolidation(*time_factor)).transpose()?,
                exact,
                computed: error.map(|error| exact * (1.0 + error)),
                error,
            })
        };
        let rows = case.time_factors.iter().map(row).collect::<Result<_, _>>()?;
        let (run, variant) = (case.label(), case.variant());
        Ok(RunSettlements { run, variant, reference: reference.name().to_owned(), rows })
    })
    .collect()
}

const HEADER: &str = "> time | > T_v | > degree of consolidation U | > exact, mm | > this run, mm | > error";

/// A row per output: date, time factor, degree of consolidation, settlement exact and of the run; where there are several runs,
/// with what tells them apart.
fn table(all: &[RunSettlements]) -> Table {
    let rows = all.iter().flat_map(|of_run| of_run.rows.iter().map(move |row| (of_run, row)));
    if let [only] = all {
        let title = format!("Settlement of {}", only.run);
        return Table::of(title, columns(HEADER), rows.map(|(_, row)| cells_of(row))).file("settlement");
    }
    let rows = rows.map(|(of_run, row)| {
        std::iter::once(Cell::from(of_run.variant.as_str())).chain(cells_of(row)).collect()
    });
    let run = all[0].run.split(" (").next().unwrap_or_default();
    let title = format!("Settlement of {run}");
    Table::of(title, columns(&format!("problem | {HEADER}")), rows).file("settlement")
}

fn cells_of(row: &SettlementRow) -> Vec<Cell> {
    let millimetres = |metres: f64| number::significant(1e3 * metres, 4).into();
    vec![
        clock_time(row.seconds).into(),
        number::time_factor(row.time_factor).into(),
        Cell::of(row.degree, Cell::Percent, "the exact solution has no end"),
        millimetres(row.exact),
        Cell::of(row.computed, millimetres, "no settlement of this run"),
        Cell::of(row.error, Cell::Percent, "no settlement of this run"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;

    /// A clay of 5 m, 2 megapascals and 1e-9 m/s under 50 kilopascals: `s(∞) = q H/E_oed`, and by Terzaghi's series the degree at its dates.
    #[test]
    fn a_clay_settles_by_millimetres_at_the_dates_that_were_asked_for() {
        let text = "title = 't'\nscene = 'terzaghi'\n[material]\nyoungs_modulus = '2 MPa'\nhydraulic_conductivity = '1e-9 m/s'\n\
                    [column]\nheight = '5 m'\nload = '50 kPa'\n[output]\ntimes = ['30 d', '365 d']\n[[sweep]]\n\
                    method = ['GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [10, 20]\n";
        let (study, records) = solved("s", text);
        let answers = within(&study, &records);
        let tables = settlements(&study, &records).expect("a theory");
        let chosen = answers[0].choices[0].as_ref().expect("within 1 %");
        let run = records.iter().find(|record| record.hash == chosen.case).expect("its run");
        assert_eq!((tables.len(), tables[0].run.as_str()), (1, run.case.label().as_str()));
        let modulus = run.case.material.oedometric_modulus();
        let final_settlement = 50e3 * 5.0 / modulus;
        let coefficient = 1e-9 * modulus / 9810.0;
        for (row, (days, snapshot)) in
            tables[0].rows.iter().zip([30.0, 365.0].into_iter().zip(&run.snapshots))
        {
            assert!((row.seconds / (86400.0 * days) - 1.0).abs() < 1e-12, "{row:?}");
            let terms = (0..200).map(|m| {
                let root = std::f64::consts::PI * (f64::from(m) + 0.5);
                2.0 / root.powi(2) * (-root.powi(2) * coefficient * row.seconds / 25.0).exp()
            });
            let degree = 1.0 - terms.sum::<f64>();
            // The water is as good as incompressible.
            assert!((row.degree.expect("an end") - degree).abs() < 2e-3, "{row:?} {degree}");
            assert!((row.exact / (degree * final_settlement) - 1.0).abs() < 1e-2, "{row:?}");
            let computed = row.computed.expect("a run");
            assert!(
                (computed / snapshot.settlement - 1.0).abs() < 1e-9,
                "{computed} {}",
                snapshot.settlement
            );
        }
    }

    #[test]
    fn of_more_problems_than_anyone_reads_no_settlement_is_listed() {
        let tables = |moduli: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                 integrator = ['implicit']\ncells = [4]\nyoungs_modulus = [{moduli}]\n"
            );
            let (study, records) = solved("s", &text);
            settlements(&study, &records).expect("a theory").len()
        };
        assert_eq!([tables("1e6, 2e6"), tables("1e6, 2e6, 3e6, 4e6, 5e6")], [2, 0]);
    }

    #[test]
    fn every_date_has_its_settlement_in_millimetres() {
        let row = |days: f64, degree: Option<f64>, error: Option<f64>| SettlementRow {
            seconds: 86400.0 * days,
            time_factor: 0.085_36,
            degree,
            exact: 0.0338,
            computed: error.map(|error| 0.0338 * (1.0 + error)),
            error,
        };
        let rows = vec![row(365.0, Some(0.4567), Some(-0.01)), row(40.0, None, None)];
        let found = RunSettlements {
            run: "MPM".to_owned(),
            variant: String::new(),
            reference: "terzaghi".to_owned(),
            rows,
        };
        let shown: Vec<Vec<String>> = table(std::slice::from_ref(&found))
            .rows
            .iter()
            .map(|row| row.iter().map(Cell::show).collect())
            .collect();
        assert_eq!(shown[0], ["365 days", "0.08536", "45.7 %", "33.80", "33.46", "-1.00 %"]);
        assert_eq!(shown[1], ["40 days", "0.08536", "–", "33.80", "–", "–"]);
        let answer = answer("s", &[found]).expect("a run");
        let told = "`MPM` differs from Terzaghi's solution with compressible water by at most 1.00 %.";
        assert_eq!(answer.sentence().expect("a sentence"), told);
    }

    #[test]
    fn several_runs_share_a_table_with_what_tells_them_apart() {
        let row = |time_factor: f64| SettlementRow {
            seconds: 86400.0,
            time_factor,
            degree: None,
            exact: 0.0338,
            computed: Some(0.0338 * 1.01),
            error: Some(0.01),
        };
        let of_run = |ratio: &str, outputs: &[f64]| RunSettlements {
            run: format!("MPM implicit cells=16 (ν {ratio})"),
            variant: format!("ν {ratio}"),
            reference: "terzaghi".to_owned(),
            rows: outputs.iter().copied().map(row).collect(),
        };
        let both = table(&[of_run("0.3", &[0.1, 0.2]), of_run("0.4", &[0.1])]);
        assert_eq!(both.title, "Settlement of MPM implicit cells=16");
        let shown: Vec<Vec<String>> =
            both.rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        assert_eq!(shown[0], ["ν 0.3", "1 day", "0.1", "–", "33.80", "34.14", "1.00 %"]);
        assert_eq!([&*shown[1][2], &*shown[2][0]], ["0.2", "ν 0.4"]);
        assert_eq!(table(&[of_run("0.3", &[0.1])]).title, "Settlement of MPM implicit cells=16 (ν 0.3)");
    }
}
