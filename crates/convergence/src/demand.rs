//! What a study expects of a series of errors.

use crate::class::Class;

/// A two-sided band about an order: an order that is too high is as suspect as one too low.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrderBand {
    /// The order expected.
    pub value: f64,
    /// How far below it may lie.
    pub minus: f64,
    /// How far above it may lie.
    pub plus: f64,
}

/// A bound on the error at a named level: a doubled error constant keeps the order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBound {
    /// Size of the level, as in the series.
    pub size: f64,
    /// The error must be smaller than this, in its own unit.
    pub below: f64,
    /// The error must be at least this: a result that is too good is as suspect.
    pub above: f64,
}

/// Where the floor under the errors must lie; no floor counts as 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloorBand {
    /// Lowest floor allowed, in the unit of the errors.
    pub above: f64,
    /// Highest floor allowed.
    pub below: f64,
}

/// Marks an expectation that is known to fail.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownFailure {
    /// Whether meeting the expectation after all is a failure.
    pub strict: bool,
    /// Why it fails.
    pub reason: String,
}

/// What is expected of one series; every part that is given is judged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeriesDemand {
    /// Order on the finest window.
    pub order: Option<OrderBand>,
    /// Error at a named level.
    pub at: Option<ErrorBound>,
    /// Class of the series; asymptotic where an order is expected and no class is named.
    pub class: Option<Class>,
    /// Floor under the errors.
    pub floor: Option<FloorBand>,
    /// Largest error over the smallest, minus one, over the levels of this size and below.
    pub spread: Option<ErrorBound>,
    /// Bound on the oscillation index of the series.
    pub oscillation_below: Option<f64>,
    /// Bound on the numerical uncertainty of the finest value, over that value.
    pub uncertainty_below: Option<f64>,
    /// Marks the expectation as known to fail.
    pub xfail: Option<KnownFailure>,
}

impl OrderBand {
    /// Whether an order lies in the band, ends included.
    pub fn contains(&self, order: f64) -> bool {
        (self.value - self.minus..=self.value + self.plus).contains(&order)
    }
}

impl FloorBand {
    /// Whether a floor lies in the band, ends included.
    pub fn contains(&self, floor: f64) -> bool {
        (self.above..=self.below).contains(&floor)
    }
}

/// What is wrong with an expectation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DemandProblem {
    /// The key that is wrong; empty where it is none of them.
    pub key: &'static str,
    /// What is wrong.
    pub sentence: &'static str,
}

impl DemandProblem {
    /// What would be right.
    pub fn right(&self) -> &'static str {
        match self.key {
            "order" => "write it like `order = { value = 2.0, minus = 0.1, plus = 0.15 }`",
            "at" => "write it like `at = { cells = 10, above = 1e-3, below = 1e-2 }`",
            "spread" => "write it like `spread = { water_bulk_modulus = 1e9, below = 0.02 }`",
            "floor" => "write it like `floor = { above = 1e-4, below = 1e-3 }`",
            "oscillation" => "write it like `oscillation = { below = 0.01 }`",
            "uncertainty" => "write it like `uncertainty = { below = 1e-3 }`",
            "xfail" => "write why it fails, like `xfail = { reason = \"issue 7\" }`",
            _ => "add what must hold, like `order = { value = 2.0 }` or `at = { cells = 10, below = 1e-2 }`",
        }
    }
}

impl SeriesDemand {
    /// The class that must be found, if any.
    pub fn expected_class(&self) -> Option<Class> {
        self.class.or_else(|| self.order.map(|_| Class::Asymptotic))
    }

    /// What is wrong with the expectation itself; such an expectation never passes.
    pub fn problems(&self) -> Vec<DemandProblem> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let width = |value: f64| value.is_finite() && value >= 0.0;
        let &Self { order, at, class, floor, spread, oscillation_below: oscillation, .. } = self;
        let uncertainty = self.uncertainty_below;
        let asks = class.is_some() || order.is_some() || at.is_some() || floor.is_some() || spread.is_some();
        let order_width = |band: OrderBand| width(band.minus) && width(band.plus);
        let range = |at: ErrorBound| width(at.above) && at.above < at.below;
        let is_band = |band: FloorBand| width(band.above) && positive(band.below) && band.above <= band.below;
        let has_reason = |known: &KnownFailure| !known.reason.trim().is_empty();
        let rules = [
            (
                "order",
                order.is_none_or(|band| positive(band.value)),
                "the expected order must be a positive number",
            ),
            ("order", order.is_none_or(order_width), "`minus` and `plus` of the order must be 0 or more"),
            ("at", at.is_none_or(|at| positive(at.size)), "the level of `at` must have a positive size"),
            ("at", at.is_none_or(|at| positive(at.below)), "`below` of `at` must be a positive number"),
            ("at", at.is_none_or(range), "`above` of `at` must be 0 or more and smaller than `below`"),
            (
                "spread",
                spread.is_none_or(|spread| positive(spread.size) && positive(spread.below)),
                "`spread` needs a level of a positive size and a positive bound",
            ),
            (
                "floor",
                floor.is_none_or(is_band),
                "the plateau must lie between `above`, 0 or more, and a larger `below`",
            ),
            (
                "oscillation",
                oscillation.is_none_or(f64::is_finite),
                "the bound on the oscillation must be a number",
            ),
            (
                "uncertainty",
                uncertainty.is_none_or(positive),
                "the bound on the uncertainty must be a positive number",
            ),
            ("xfail", self.xfail.as_ref().is_none_or(has_reason), "a known failure needs a reason"),
            ("", asks || oscillation.is_some() || uncertainty.is_some(), "the expectation demands nothing"),
        ];
        let wrong = rules.into_iter().filter(|(_, is_met, _)| !is_met);
        wrong.map(|(key, _, sentence)| DemandProblem { key, sentence }).collect()
    }
}
