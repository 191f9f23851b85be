//! From values to pixels.
use oedometer_soil::elementary;

/// How an axis or a colour bar spreads its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly in the decimal logarithm.
    Log10,
}

/// What an axis or a colour bar shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// All of the data.
    Auto,
    /// From the first value to the second, whatever the data.
    Fixed(f64, f64),
}

/// Beyond these, no picture of the rest would be left.
const HUGE: f64 = 1e150;

/// Why a value is not drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Reason {
    NotFinite,
    NotPositive,
    Extreme,
    Outside,
}

impl Reason {
    pub fn words(self) -> &'static str {
        match self {
            Self::NotFinite => "not finite",
            Self::NotPositive => "not positive on a logarithmic axis",
            Self::Extreme => "beyond 10^±150",
            Self::Outside => "outside the axes",
        }
    }
}

/// Whether a value can be put on such an axis at all.
pub(crate) fn drawable(value: f64, kind: Scale) -> Result<f64, Reason> {
    match kind {
        _ if !value.is_finite() => Err(Reason::NotFinite),
        Scale::Log10 if value <= 0.0 => Err(Reason::NotPositive),
        _ if value.abs() > HUGE => Err(Reason::Extreme),
        Scale::Log10 if value < 1.0 / HUGE => Err(Reason::Extreme),
        _ => Ok(value),
    }
}

/// The lower and upper end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub kind: Scale,
    pub low: f64,
    pub high: f64,
}

impl Span {
    /// The span of an axis that has to show `values`, with a margin as a share of it.
    pub fn over(kind: Scale, range: Range, values: impl Iterator<Item = f64>, margin: f64) -> Self {
        if let Range::Fixed(low, high) = range
            && low < high
            && drawable(low, kind).is_ok()
            && drawable(high, kind).is_ok()
        {
            return Self { kind, low, high };
        }
        let ends = values.filter_map(|v| drawable(v, kind).ok()).fold(None, |ends: Option<(f64, f64)>, v| {
            Some(ends.map_or((v, v), |(low, high)| (low.min(v), high.max(v))))
        });
        let (low, high) = match (ends, kind) {
            (None, Scale::Linear) => (0.0, 1.0),
            (None, Scale::Log10) => (0.1, 10.0),
            (Some((low, high)), Scale::Linear) => widen(low, high, margin),
            (Some((low, high)), Scale::Log10) => {
                let (a, b) = (elementary::log10(low), elementary::log10(high));
                let room = (margin * (b - a)).max(if b - a < 0.3 && margin > 0.0 { 0.15 } else { 0.0 });
                let room = if a == b { room.max(0.15) } else { room };
                (elementary::powf(10.0, a - room), elementary::powf(10.0, b + room))
            }
        };
        Self { kind, low, high }
    }

    /// Where a value stands between the ends: 0 at the lower, 1 at the upper.
    pub fn share(&self, value: f64) -> f64 {
        match self.kind {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log10 => elementary::log10(value / self.low) / elementary::log10(self.high / self.low),
        }
    }
}

/// Room at both ends, except at a round number, where a curve may well end in the frame.
fn widen(low: f64, high: f64, margin: f64) -> (f64, f64) {
    let span = high - low;
    if span <= f64::EPSILON * 8.0 * low.abs().max(high.abs()) {
        let room = if low == 0.0 { 1.0 } else { low.abs() * 0.1 };
        return (low - room, high + room);
    }
    let round = |v: f64| {
        let step = elementary::powf(10.0, (elementary::log10(span) - 0.3).floor()) / 2.0;
        (v / step - (v / step).round()).abs() < 1e-9
    };
    (
        if round(low) { low } else { low - margin * span },
        if round(high) { high } else { high + margin * span },
    )
}

/// A span laid out over pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ruler {
    pub span: Span,
    /// Pixel of the lower and of the upper end.
    pub from: f64,
    pub to: f64,
}

impl Ruler {
    /// The pixel of a value, inside the axis or not.
    pub fn px(&self, value: f64) -> Result<f64, Reason> {
        let value = drawable(value, self.span.kind)?;
        Ok(self.from + self.span.share(value) * (self.to - self.from))
    }

    /// Whether a pixel lies between the ends, with half a pixel to spare.
    pub fn holds(&self, px: f64) -> bool {
        px > self.from.min(self.to) - 0.5 && px < self.from.max(self.to) + 0.5
    }

    pub fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::describe::ChartAxis;

    fn of(axis: &ChartAxis, values: impl Iterator<Item = f64>) -> Span {
        Span::over(axis.scale, axis.range, values, 0.04)
    }

    #[test]
    fn what_cannot_be_drawn_has_a_reason() {
        assert_eq!(drawable(f64::NAN, Scale::Linear), Err(Reason::NotFinite));
        assert_eq!(drawable(f64::INFINITY, Scale::Log10), Err(Reason::NotFinite));
        assert_eq!(drawable(0.0, Scale::Log10), Err(Reason::NotPositive));
        assert_eq!(drawable(-1.0, Scale::Linear), Ok(-1.0));
        assert_eq!(drawable(1e-200, Scale::Log10), Err(Reason::Extreme));
        assert_eq!(drawable(1e200, Scale::Linear), Err(Reason::Extreme));
    }

    #[test]
    fn round_ends_stay_and_others_get_room() {
        let span = of(&ChartAxis::linear(""), [0.0, 1.0].into_iter());
        assert_eq!((span.low, span.high), (0.0, 1.0));
        let span = of(&ChartAxis::linear(""), [0.013, 0.97].into_iter());
        assert!(span.low < 0.013 && span.high > 0.97, "{span:?}");
    }

    #[test]
    fn a_single_value_still_has_an_axis() {
        for axis in [ChartAxis::linear(""), ChartAxis::log10("")] {
            for v in [1.0, 7e-9, 3e120] {
                let span = of(&axis, std::iter::once(v));
                assert!(span.low < v && v < span.high, "{span:?}");
            }
            let span = of(&axis, std::iter::empty());
            assert!(span.low < span.high);
        }
    }

    #[test]
    fn an_unusable_fixed_range_gives_way_to_the_data() {
        let axis = ChartAxis::log10("").between(-1.0, 10.0);
        let span = of(&axis, [1.0, 100.0].into_iter());
        assert!(span.low > 0.0 && span.high > 100.0, "{span:?}");
        let nan = ChartAxis::linear("").between(f64::NAN, 1.0);
        assert!(of(&nan, std::iter::once(2.0)).high > 2.0);
    }

    #[test]
    fn values_map_linearly_or_by_their_logarithm() {
        let span = Span { kind: Scale::Log10, low: 1e-3, high: 1e1 };
        let ruler = Ruler { span, from: 400.0, to: 0.0 };
        assert!((ruler.px(1e-1).unwrap_or(0.0) - 200.0).abs() < 1e-9);
        assert_eq!(ruler.px(-1.0), Err(Reason::NotPositive));
        assert!(!ruler.holds(ruler.px(1e2).unwrap_or(0.0)));
    }
}
