//! Settlements at the outputs of a study in m, exact and of the run that its answer names: what an engineer looks up by date.

use crate::case::{Norm, Quantity, Sample};
use crate::judge::paths::grouped;
use crate::measure::theory::known_reference;
use crate::questions::findings::QuantityWithin;
use crate::questions::findings::within::{choice, problem};
use crate::record::Record;
use crate::study::check::Study;
use oedometer_exact::ExactError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most problems of a study whose settlements are listed: of more nobody reads them.
const MOST_PROBLEMS: usize = 4;

/// The settlement of one problem at every output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SettlementTable {
    /// Label of the run.
    pub run: String,
    /// Reference.
    pub reference: String,
    /// Outputs, in the order of their times.
    pub rows: Vec<SettlementRow>,
}

/// The settlement at one output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SettlementRow {
    /// Time, s.
    pub seconds: f64,
    /// Time factor.
    pub time_factor: f64,
    /// Degree of consolidation by settlement of the exact solution, where it has an end.
    pub degree: Option<f64>,
    /// Exact settlement, m.
    pub exact: f64,
    /// Settlement of the run, m.
    #[serde(default)]
    pub computed: Option<f64>,
    /// Settlement of the run over the exact one, less one; `None` where it has none to compare.
    pub error: Option<f64>,
}

/// The settlements of the runs that the answer for the settlement names: of the cheapest choice within its largest bound, or
/// else of the choice with the least error. Empty where nothing settles, or where a study has more problems than anyone reads.
///
/// # Errors
/// When a reference refuses a case.
pub fn settlement_tables(
    study: &Study,
    records: &[Record],
    within: &[QuantityWithin],
) -> Result<Vec<SettlementTable>, ExactError> {
    let settlement = within.iter().find(|answer| answer.quantity == Quantity::Settlement);
    let (Some(answer), Some(kind)) = (settlement, study.references.first()) else { return Ok(Vec::new()) };
    let answering =
        answer.bounds.iter().find_map(|bound| bound.choice.as_ref()).unwrap_or(&answer.best).case.as_str();
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
        Ok(SettlementTable { run: case.label(), reference: reference.name().to_owned(), rows })
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::questions::findings::within::within;

    /// A clay of 5 m, 2 megapascals and 1e-9 m/s under 50 kilopascals: `s(∞) = q H/E_oed`, and by Terzaghi's series the degree at its dates.
    #[test]
    fn a_clay_settles_by_millimetres_at_the_dates_that_were_asked_for() {
        let text = "title = 't'\nscene = 'terzaghi'\n[material]\nyoungs_modulus = '2 MPa'\nhydraulic_conductivity = '1e-9 m/s'\n\
                    [column]\nheight = '5 m'\nload = '50 kPa'\n[output]\ntimes = ['30 d', '365 d']\n[[sweep]]\n\
                    method = ['GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [10, 20]\n";
        let (study, records) = solved("s", text);
        let answers = within(&study, &records);
        let tables = settlement_tables(&study, &records, &answers).expect("a theory");
        let chosen = answers[0].bounds[0].choice.as_ref().expect("within 1 %");
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
            settlement_tables(&study, &records, &within(&study, &records)).expect("a theory").len()
        };
        assert_eq!([tables("1e6, 2e6"), tables("1e6, 2e6, 3e6, 4e6, 5e6")], [2, 0]);
    }
}
