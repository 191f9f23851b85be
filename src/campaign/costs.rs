//! What cases cost, in seconds: the estimate by formula, corrected by what finished cases of the same kind took.

use crate::case::Case;
use crate::case::step_cost::StepKind;
use crate::case::work_estimate::estimated_seconds;
use crate::record::{Record, Status};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Columns of a table of costs.
const COLUMNS: [&str; 6] = ["step", "dimensions", "method", "points_from", "cases", "ratio"];
/// Cases from which on a kind is known on its own.
const ENOUGH: usize = 3;
/// What stands for every method, or every size.
const ANY: &str = "any";

/// Cases that cost alike: kind of step, dimensions, method, and number of points to a power of two.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct CostKind {
    step: String,
    dimensions: usize,
    method: String,
    points_from: usize,
}

/// What cases of a kind took over what was estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Learned {
    cases: usize,
    ratio: f64,
}

/// Costs of cases: by formula alone, or as learned.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CostTable {
    ratios: BTreeMap<CostKind, Learned>,
}

/// Why a table of costs cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("line {line} of the table of costs is none: it has the columns {columns}, and a ratio is positive")]
pub struct CostError {
    line: usize,
    columns: String,
}

/// The kinds a case belongs to, the narrowest first.
fn kinds_of(case: &Case) -> [CostKind; 3] {
    let step = format!("{:?}", StepKind::of(case)).to_lowercase();
    let points_from = 1 << case.expected_points().max(1).ilog2();
    let kind = |method: &str, points_from| CostKind {
        step: step.clone(),
        dimensions: case.column.dimensions,
        method: method.to_owned(),
        points_from,
    };
    [kind(&case.method.to_string(), points_from), kind(ANY, points_from), kind(ANY, 0)]
}

impl CostTable {
    /// Learns from records of cases that came to their end and whose processor time is known; the median of each
    /// kind counts, and kinds of too few cases do not.
    pub fn learned(records: impl IntoIterator<Item = Record>) -> Self {
        let mut samples: BTreeMap<CostKind, Vec<f64>> = BTreeMap::new();
        for record in records.into_iter().filter(|record| record.status == Status::Ok) {
            let seconds = |sample: &crate::record::WallSample| sample.cpu_seconds.unwrap_or(sample.seconds);
            let Some(least) = record.wall.iter().map(seconds).reduce(f64::min) else { continue };
            let ratio = least / estimated_seconds(&record.case);
            if ratio.is_finite() && ratio > 0.0 {
                for kind in kinds_of(&record.case) {
                    samples.entry(kind).or_default().push(ratio);
                }
            }
        }
        samples.retain(|_, ratios| ratios.len() >= ENOUGH);
        let median = |mut ratios: Vec<f64>| {
            ratios.sort_by(f64::total_cmp);
            Learned { cases: ratios.len(), ratio: ratios[ratios.len() / 2] }
        };
        Self { ratios: samples.into_iter().map(|(kind, ratios)| (kind, median(ratios))).collect() }
    }

    /// Seconds that a case will take on one core.
    pub fn seconds(&self, case: &Case) -> f64 {
        let estimate = estimated_seconds(case);
        if self.ratios.is_empty() {
            return estimate;
        }
        let learned = kinds_of(case).iter().find_map(|kind| self.ratios.get(kind).copied());
        estimate * learned.map_or(1.0, |learned| learned.ratio)
    }

    /// The same in whole nanoseconds; the largest number where there are more.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates, it is an estimate"
    )]
    pub fn work(&self, case: &Case) -> u64 {
        (1e9 * self.seconds(case)).max(1.0) as u64
    }

    /// Whether anything was learned.
    pub fn is_empty(&self) -> bool {
        self.ratios.is_empty()
    }

    /// The table as CSV, from which [`CostTable::parse`] makes it again.
    pub fn to_csv(&self) -> String {
        let mut text = COLUMNS.join(",") + "\n";
        for (kind, learned) in &self.ratios {
            let CostKind { step, dimensions, method, points_from } = kind;
            let method = if method.contains(',') { format!("\"{method}\"") } else { method.clone() };
            let _ = writeln!(
                text,
                "{step},{dimensions},{method},{points_from},{},{:e}",
                learned.cases, learned.ratio
            );
        }
        text
    }

    /// Reads a table.
    ///
    /// # Errors
    /// When a line is none of a table of costs.
    pub fn parse(text: &str) -> Result<Self, CostError> {
        let mut ratios = BTreeMap::new();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let wrong = |line: usize| CostError { line, columns: COLUMNS.join(", ") };
        if reader.headers().is_ok_and(|header| header.iter().ne(COLUMNS)) {
            return Err(wrong(1));
        }
        for (number, row) in reader.records().enumerate() {
            let entry = row.ok().and_then(|row| {
                let kind = CostKind {
                    step: row.get(0)?.to_owned(),
                    dimensions: row.get(1)?.parse().ok()?,
                    method: row.get(2)?.to_owned(),
                    points_from: row.get(3)?.parse().ok()?,
                };
                let learned = Learned { cases: row.get(4)?.parse().ok()?, ratio: row.get(5)?.parse().ok()? };
                (learned.ratio.is_finite() && learned.ratio > 0.0).then_some((kind, learned))
            });
            let (kind, learned) = entry.ok_or_else(|| wrong(number + 2))?;
            ratios.insert(kind, learned);
        }
        Ok(Self { ratios })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    fn records(seconds: impl Fn(&Case) -> f64) -> Vec<Record> {
        let mut records = records_of(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
             method = [\"MPM\", \"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [4, 5, 6, 7]\n",
        );
        for record in &mut records {
            let cpu_seconds = Some(seconds(&record.case));
            record.wall =
                vec![WallSample { seconds: 1e9, alone: true, cpu_seconds, ..WallSample::default() }];
        }
        records
    }

    #[test]
    fn what_was_learned_of_a_kind_holds_for_its_other_cases() {
        let slow = |case: &Case| {
            let factor = if case.method.to_string() == "MPM" { 2.0 } else { 6.0 };
            factor * estimated_seconds(case)
        };
        let records = records(slow);
        let costs = CostTable::learned(records.clone());
        let mut case = records[0].case.clone();
        // Eight points, as those of four to seven cells have; that of a method at no other size is not known.
        assert!((costs.seconds(&case) / estimated_seconds(&case) - 2.0).abs() < 1e-9);
        case.method = records[7].case.method;
        assert!((costs.seconds(&case) / estimated_seconds(&case) - 6.0).abs() < 1e-9);
        case.cells = 1000;
        let ratio = costs.seconds(&case) / estimated_seconds(&case);
        assert!((2.0..=6.0).contains(&ratio), "that of the step's kind: {ratio}");
        assert_eq!(CostTable::default().seconds(&case), estimated_seconds(&case));
    }

    #[test]
    fn a_table_of_costs_is_read_back_and_another_file_refused() {
        let costs = CostTable::learned(records(|case| 3.0 * estimated_seconds(case)));
        assert!(!costs.is_empty());
        let read = CostTable::parse(&costs.to_csv()).expect("a table");
        assert_eq!(read, costs);
        assert!(CostTable::parse("a,b\n1,2\n").is_err());
        let negative = costs.to_csv().replace("3e0", "-3e0");
        let told = CostTable::parse(&negative).expect_err("refused").to_string();
        assert!(told.contains("line 2") && told.contains("positive"), "{told}");
    }
}
