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

impl SeriesDemand {
    /// The class that must be found, if any.
    pub fn expected_class(&self) -> Option<Class> {
        self.class.or_else(|| self.order.map(|_| Class::Asymptotic))
    }

    /// What is wrong with the expectation itself; such an expectation never passes.
    pub fn problems(&self) -> Vec<String> {
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
            (order.is_none_or(|band| positive(band.value)), "the expected order must be a positive number"),
            (order.is_none_or(order_width), "`minus` and `plus` of the order must be 0 or more"),
            (at.is_none_or(|at| positive(at.size)), "the level of `at` must have a positive size"),
            (at.is_none_or(|at| positive(at.below)), "`below` of `at` must be a positive number"),
            (at.is_none_or(range), "`above` of `at` must be 0 or more and smaller than `below`"),
            (
                spread.is_none_or(|spread| positive(spread.size) && positive(spread.below)),
                "`spread` needs a level of a positive size and a positive bound",
            ),
            (
                floor.is_none_or(is_band),
                "the plateau must lie between `above`, 0 or more, and a larger `below`",
            ),
            (oscillation.is_none_or(f64::is_finite), "the bound on the oscillation must be a number"),
            (uncertainty.is_none_or(positive), "the bound on the uncertainty must be a positive number"),
            (self.xfail.as_ref().is_none_or(has_reason), "a known failure needs a reason"),
            (asks || oscillation.is_some() || uncertainty.is_some(), "the expectation demands nothing"),
        ];
        rules.into_iter().filter(|(met, _)| !met).map(|(_, problem)| problem.to_owned()).collect()
    }
}
