//! What a golden value is of: a case, the time factor of an output, and a measure. Titles are text in files alone.

use crate::case::{Quantity, Sample};
use crate::record::ErrorRow;
use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// What is kept of a case.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Measure {
    /// Steps in time: a whole number, and better where it is less.
    Steps,
    /// The critical step, s.
    CriticalStep {
        /// Whether it was observed, and not predicted.
        is_observed: bool,
    },
    /// Share of the water that a balance misses.
    Water(WaterBalance),
    /// A signed error in the norm that its quantity is reported in first.
    Error {
        /// Quantity.
        quantity: Quantity,
        /// Where it is sampled.
        sample: Sample,
        /// Reference.
        reference: Arc<str>,
    },
}

/// A balance of water.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WaterBalance {
    /// Of the body.
    Body,
    /// Of the pores of a second point set.
    Pores,
    /// Of what has left through the surface.
    WhatLeft,
}

/// Titles of measures without a parameter.
const TITLES: [(Measure, &str); 6] = [
    (Measure::Steps, "steps"),
    (Measure::CriticalStep { is_observed: false }, "predicted critical step"),
    (Measure::CriticalStep { is_observed: true }, "observed critical step"),
    (Measure::Water(WaterBalance::Body), "water balance"),
    (Measure::Water(WaterBalance::Pores), "water balance of pores"),
    (Measure::Water(WaterBalance::WhatLeft), "water balance of what left"),
];

impl Measure {
    /// The measure of an error; `None` in a norm that no golden file keeps.
    pub fn of_error(row: &ErrorRow) -> Option<Self> {
        (row.norm == row.quantity.first_norm()).then(|| Self::Error {
            quantity: row.quantity,
            sample: row.sample,
            reference: row.reference.as_str().into(),
        })
    }

    /// Whether it is an error at a time, and no balance.
    pub fn is_error(&self) -> bool {
        matches!(self, Self::Error { .. })
    }

    /// Whether it is a share of the water.
    pub fn is_water(&self) -> bool {
        matches!(self, Self::Water(_))
    }

    /// Whether a smaller value is better: true of errors and steps, not of critical steps.
    pub fn is_better_if_smaller(&self) -> bool {
        !matches!(self, Self::CriticalStep { .. })
    }

    /// What it shares a spread by round-off with; steps are whole numbers and share with none.
    pub fn spreading(&self) -> Option<Spreading> {
        match self {
            Self::Steps => None,
            Self::CriticalStep { is_observed } => Some(Spreading::CriticalStep { is_observed: *is_observed }),
            Self::Water(_) => Some(Spreading::Water),
            Self::Error { quantity, .. } => Some(Spreading::Quantity(*quantity)),
        }
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Error { quantity, sample, reference } => {
                write!(out, "{} {} {reference}", quantity.name(), sample.name())
            }
            plain => {
                let title = TITLES.iter().find(|(measure, _)| measure == plain);
                out.write_str(title.map_or("", |(_, title)| title))
            }
        }
    }
}

/// A title that no measure has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no measure: `steps`, `water balance`, `predicted critical step`, or a quantity, a sample and a reference, like \
     `pressure points terzaghi`"
)]
pub struct UnknownMeasure(pub String);

impl FromStr for Measure {
    type Err = UnknownMeasure;

    fn from_str(title: &str) -> Result<Self, UnknownMeasure> {
        if let Some((measure, _)) = TITLES.iter().find(|(_, known)| *known == title) {
            return Ok(measure.clone());
        }
        let unknown = || UnknownMeasure(title.to_owned());
        let words: Vec<&str> = title.split(' ').collect();
        let [quantity, sample, reference] = words[..] else { return Err(unknown()) };
        let quantity = Quantity::named(quantity).ok_or_else(unknown)?;
        let sample = Sample::named(sample).ok_or_else(unknown)?;
        Ok(Self::Error { quantity, sample, reference: reference.into() })
    }
}

/// What values share a spread with: the errors of one quantity at one time, at all places and against all references. A
/// single difference may be small by luck, the largest of such a group is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Spreading {
    /// A critical step, with itself.
    CriticalStep {
        /// Whether it was observed.
        is_observed: bool,
    },
    /// Balances of water at all times.
    Water,
    /// Errors of a quantity at a time.
    Quantity(Quantity),
}

impl fmt::Display for Spreading {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::CriticalStep { is_observed } => Measure::CriticalStep { is_observed }.fmt(out),
            Self::Water => Measure::Water(WaterBalance::Body).fmt(out),
            Self::Quantity(quantity) => out.write_str(quantity.name()),
        }
    }
}

impl FromStr for Spreading {
    type Err = UnknownMeasure;

    fn from_str(title: &str) -> Result<Self, UnknownMeasure> {
        match title.parse() {
            Ok(Measure::CriticalStep { is_observed }) => Ok(Self::CriticalStep { is_observed }),
            Ok(Measure::Water(WaterBalance::Body)) => Ok(Self::Water),
            _ => Quantity::named(title).map(Self::Quantity).ok_or_else(|| UnknownMeasure(title.to_owned())),
        }
    }
}

/// The time factor of an output, by its size.
#[derive(Clone, Copy, Debug)]
pub struct TimeFactor(pub f64);

impl Ord for TimeFactor {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for TimeFactor {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for TimeFactor {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for TimeFactor {}

/// Which value it is: in the order of a file's rows, and in a row of its columns.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct GoldenKey {
    /// Label of the case.
    pub case: Arc<str>,
    /// Output; none of what a case has once.
    pub time: Option<TimeFactor>,
    /// Measure.
    pub measure: Measure,
}

impl GoldenKey {
    /// The spread that its value shares.
    pub fn spread(&self) -> Option<SpreadKey> {
        let of = self.measure.spreading()?;
        let time = self.time.filter(|_| of != Spreading::Water);
        Some(SpreadKey { case: self.case.clone(), time, of })
    }
}

/// Which spread it is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpreadKey {
    /// Label of the case.
    pub case: Arc<str>,
    /// Output; none of what a case has once.
    pub time: Option<TimeFactor>,
    /// Values that share it.
    pub of: Spreading,
}

/// As people name it: `CASE | pressure points terzaghi T_v=0.1`.
fn named(
    out: &mut fmt::Formatter<'_>,
    case: &str,
    time: Option<TimeFactor>,
    what: &impl fmt::Display,
) -> fmt::Result {
    write!(out, "{case} | {what}")?;
    time.map_or(Ok(()), |TimeFactor(time)| write!(out, " T_v={time}"))
}

impl fmt::Display for GoldenKey {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        named(out, &self.case, self.time, &self.measure)
    }
}

impl fmt::Display for SpreadKey {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        named(out, &self.case, self.time, &self.of)
    }
}

impl serde::Serialize for GoldenKey {
    fn serialize<S: serde::Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.collect_str(self)
    }
}

/// The key of a value for tests: case, output, and the title of its measure.
#[cfg(test)]
pub(crate) fn key(case: &str, time: impl Into<Option<f64>>, measure: &str) -> GoldenKey {
    let measure = measure.parse().expect("a measure");
    GoldenKey { case: case.into(), time: time.into().map(TimeFactor), measure }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_is_read_back_as_its_measure_and_no_other_word_is_one() {
        for title in [
            "steps",
            "predicted critical step",
            "observed critical step",
            "water balance",
            "water balance of pores",
            "water balance of what left",
            "pressure points terzaghi",
            "effective_stress centres cosine-layer-incompressible",
            "settlement surface xie-leo",
            "load_factor surface footing",
        ] {
            let measure: Measure = title.parse().expect("a measure");
            assert_eq!(measure.to_string(), title);
            if let Some(of) = measure.spreading().filter(|of| *of != Spreading::Water) {
                assert_eq!(of.to_string().parse(), Ok(of));
            }
        }
        for title in
            ["", "step", "point updates", "pressure points", "pressure points l2 terzaghi", "heat points a"]
        {
            assert_eq!(title.parse::<Measure>(), Err(UnknownMeasure(title.to_owned())));
        }
    }

    #[test]
    fn values_share_a_spread_by_case_quantity_and_time() {
        let shared = |time: Option<f64>, measure: &str| {
            key("a", time, measure).spread().map(|spread| spread.to_string())
        };
        let pressure = "a | pressure T_v=0.1";
        assert_eq!(shared(Some(0.1), "pressure points terzaghi").as_deref(), Some(pressure));
        assert_eq!(shared(Some(0.1), "pressure nodes xie-leo").as_deref(), Some(pressure));
        assert_eq!(shared(Some(0.1), "water balance of pores").as_deref(), Some("a | water balance"));
        assert_eq!(shared(None, "steps"), None);
        assert_eq!(shared(None, "observed critical step").as_deref(), Some("a | observed critical step"));
    }
}
