//! The ends of an axis, its ticks, and its counterpart in plotters.
use crate::render::chart::ChartAxis;
use crate::render::chart::svg::units;
use crate::render::number::minus;
use crate::render::script::{exponent, width};
use oedometer_soil::elementary;
use plotters::coord::combinators::{BindKeyPoints, WithKeyPoints};
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::{RangedCoordf64, RangedCoordi32};

/// How an axis spreads its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// In proportion to the value.
    Linear,
    /// In proportion to the decimal logarithm.
    Log10,
}

/// Largest magnitude that is drawn, and inverse of the smallest on a logarithmic axis.
const HUGE: f64 = 1e150;

/// Why a value is not drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Reason {
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

/// The value, or why an axis cannot show it.
pub(super) fn drawable(value: f64, scale: Scale) -> Result<f64, Reason> {
    match scale {
        _ if !value.is_finite() => Err(Reason::NotFinite),
        Scale::Log10 if value <= 0.0 => Err(Reason::NotPositive),
        _ if value.abs() > HUGE => Err(Reason::Extreme),
        Scale::Log10 if value < 1.0 / HUGE => Err(Reason::Extreme),
        _ => Ok(value),
    }
}

/// Margin at both ends as a share of the length.
const MARGIN: f64 = 0.04;

/// The lower and upper end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ends {
    pub scale: Scale,
    pub low: f64,
    pub high: f64,
}

impl Ends {
    /// The ends of an axis that shows `values`.
    pub fn of(axis: &ChartAxis, values: impl Iterator<Item = f64>) -> Self {
        let scale = axis.scale;
        let is_drawable = |value: f64| drawable(value, scale).is_ok();
        if let Some((low, high)) = axis.range
            && low < high
            && is_drawable(low)
            && is_drawable(high)
        {
            return Self { scale, low, high };
        }
        let (low, high) = values
            .filter(|value| is_drawable(*value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = match scale {
            Scale::Linear if low > high => (0.0, 1.0),
            Scale::Log10 if low > high => (0.1, 10.0),
            Scale::Linear => widen(low, high),
            Scale::Log10 => {
                let (a, b) = (elementary::log10(low), elementary::log10(high));
                let least = if b - a < 0.3 { 0.15 } else { 0.0 };
                let room = (MARGIN * (b - a)).max(least);
                (elementary::powf(10.0, a - room), elementary::powf(10.0, b + room))
            }
        };
        Self { scale, low, high }
    }

    /// Where a value lies between the ends: 0 at the lower, 1 at the upper.
    pub fn share(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log10 => elementary::log10(value / self.low) / elementary::log10(self.high / self.low),
        }
    }

    /// The value, or the nearest within twenty lengths of the axis: farther off no pixel has a number.
    pub fn near(&self, value: f64) -> f64 {
        let (low, high) = (self.low, self.high);
        match self.scale {
            Scale::Linear => value.clamp(low - 20.0 * (high - low), high + 20.0 * (high - low)),
            Scale::Log10 => {
                let reach = elementary::powf(high / low, 20.0);
                value.clamp(low / reach, high * reach)
            }
        }
    }

    /// The value, or why it is not seen between the ends.
    pub fn visible(&self, value: f64) -> Result<f64, Reason> {
        let value = drawable(value, self.scale)?;
        if (-1e-3..=1.001).contains(&self.share(value)) { Ok(value) } else { Err(Reason::Outside) }
    }
}

/// Adds a margin at both ends, except at a round number, where a curve may end in the frame.
fn widen(low: f64, high: f64) -> (f64, f64) {
    let span = high - low;
    if span <= f64::EPSILON * 8.0 * low.abs().max(high.abs()) {
        let room = if low == 0.0 { 1.0 } else { low.abs() * 0.1 };
        return (low - room, high + room);
    }
    let step = elementary::powf(10.0, (elementary::log10(span) - 0.3).floor()) / 2.0;
    let room = |end: f64| {
        let is_round = (end / step - (end / step).round()).abs() < 1e-9;
        if is_round { 0.0 } else { MARGIN * span }
    };
    (low - room(low), high + room(high))
}

/// A tick; without a label it is a minor one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: Option<String>,
}

/// An axis over pixels, with its ticks.
#[derive(Debug, Clone)]
pub(super) struct PlacedAxis {
    pub ends: Ends,
    /// Pixels of the lower and of the upper end.
    from: f64,
    to: f64,
    is_inverted: bool,
    pub ticks: Vec<Tick>,
}

/// Size of the labels of ticks, px.
pub(super) const TICK_FONT: f64 = 12.0;

impl PlacedAxis {
    /// An axis from its lower to its upper pixel, horizontal or upright.
    pub fn new(axis: &ChartAxis, ends: Ends, (low, high): (f64, f64), is_upright: bool) -> Self {
        let (from, to) = if axis.inverted { (high, low) } else { (low, high) };
        let mut placed = Self { ends, from, to, is_inverted: axis.inverted, ticks: Vec::new() };
        let room = if is_upright { 3.4 } else { 4.8 };
        let most = ((to - from).abs() / (room * TICK_FONT)).clamp(2.0, 12.0);
        let is_narrow = elementary::log10(ends.high / ends.low) < 0.75;
        let mut ticks = match (&axis.ticks, ends.scale) {
            (Some(values), scale) => given_ticks(values, scale),
            (None, Scale::Log10) if !is_narrow => decades(&ends, most),
            (None, _) => even(&ends, most),
        };
        ticks.retain(|tick| ends.visible(tick.value).is_ok());
        placed.drop_crowded_labels(&mut ticks, is_upright);
        placed.ticks = ticks;
        placed
    }

    /// The pixel of a value, inside the ends or not.
    pub fn px(&self, value: f64) -> Option<f64> {
        let value = self.ends.near(drawable(value, self.ends.scale).ok()?);
        Some(self.from + self.ends.share(value) * (self.to - self.from))
    }

    /// Width of the widest label, px.
    pub fn label_width(&self) -> f64 {
        let labels = self.ticks.iter().filter_map(|tick| tick.label.as_deref());
        labels.map(|label| width(label) * TICK_FONT).fold(0.0, f64::max)
    }

    /// The label of the tick at a place in drawing units.
    pub fn label_at(&self, place: i32) -> String {
        let is_there = |tick: &&Tick| tick.label.is_some() && self.px(tick.value).map(units) == Some(place);
        self.ticks.iter().find(is_there).and_then(|tick| tick.label.clone()).unwrap_or_default()
    }

    /// The axis for plotters, in drawing units.
    pub fn for_plotters(&self) -> WithKeyPoints<RangedCoordi32> {
        let places = |is_major: bool| -> Vec<i32> {
            let ticks = self.ticks.iter().filter(|tick| tick.label.is_some() == is_major);
            ticks.filter_map(|tick| self.px(tick.value).map(units)).collect()
        };
        let (from, to) = (units(self.from), units(self.to));
        let range = if self.is_inverted { to..from } else { from..to };
        range.with_key_points(places(true)).with_light_points(places(false))
    }

    /// Removes labels that would touch a neighbour; powers of ten keep theirs first.
    fn drop_crowded_labels(&self, ticks: &mut [Tick], is_upright: bool) {
        let mut order: Vec<usize> = (0..ticks.len()).filter(|&i| ticks[i].label.is_some()).collect();
        if self.ends.scale == Scale::Log10 {
            order.sort_by_key(|&i| !is_power(ticks[i].value));
        }
        let mut taken: Vec<(f64, f64)> = Vec::new();
        for i in order {
            let (Some(px), Some(label)) = (self.px(ticks[i].value), &ticks[i].label) else { continue };
            let half = if is_upright { 0.62 * TICK_FONT } else { 0.5 * TICK_FONT * width(label) + 4.0 };
            if taken.iter().any(|(from, to)| px - half < *to && px + half > *from) {
                ticks[i].label = None;
            } else {
                taken.push((px - half, px + half));
            }
        }
    }
}

fn is_power(value: f64) -> bool {
    let n = elementary::log10(value.abs());
    (n - n.round()).abs() < 1e-9
}

/// Longest label of a given tick that is written with all digits, in characters.
const LONGEST_LABEL: usize = 8;

/// Ticks at given values.
fn given_ticks(ticks: &[(f64, Option<String>)], scale: Scale) -> Vec<Tick> {
    let usable: Vec<_> = ticks.iter().filter(|(value, _)| drawable(*value, scale).is_ok()).collect();
    let is_plain = usable.iter().all(|(value, _)| *value == 0.0 || (1e-4..1e5).contains(&value.abs()));
    let label = |value: f64| match format!("{value}") {
        _ if !is_plain => power(value, None),
        text if text.len() <= LONGEST_LABEL => minus(text),
        _ => minus(format!("{}", format!("{value:.3e}").parse().unwrap_or(value))),
    };
    let tick = |(value, own): &(f64, Option<String>)| Tick {
        value: *value,
        label: Some(own.clone().unwrap_or_else(|| label(*value))),
    };
    usable.into_iter().map(tick).collect()
}

/// Key points of plotters, at most so many, with as many decimals as they need.
fn even(ends: &Ends, most: f64) -> Vec<Tick> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 12")]
    let values = RangedCoordf64::from(ends.low..ends.high).key_points(most as usize);
    let step = values.windows(2).next().map_or(ends.high - ends.low, |pair| pair[1] - pair[0]);
    let digits = (elementary::log10(step) + 1e-9).floor();
    let has_powers = ends.low.abs().max(ends.high.abs()) >= 1e5 || step < 0.999e-4;
    let label = |value: f64| {
        // Zero may come with rounding errors.
        let value = if value.abs() < 1e-9 * step { 0.0 } else { value };
        if has_powers { power(value, Some(digits)) } else { minus(format!("{value:.*}", decimals(digits))) }
    };
    values.into_iter().map(|value| Tick { value, label: Some(label(value)) }).collect()
}

/// Powers of ten with labels at all or at every so many, and minor ticks between them where they fit.
fn decades(ends: &Ends, most: f64) -> Vec<Tick> {
    let (a, b) = (elementary::log10(ends.low), elementary::log10(ends.high));
    let (first, last) = (whole_number((a - 1e-9).floor()), whole_number((b + 1e-9).ceil()));
    let stride = whole_number(((b - a) / most).ceil().max(1.0));
    let is_plain = a > -3.2 && b < 3.2;
    let ten_to = |n: i32| if n < 0 { 1.0 / elementary::powi(10.0, -n) } else { elementary::powi(10.0, n) };
    let label = |m: i32, n: i32| match m {
        _ if is_plain => format!("{:.*}", usize::try_from(-n).unwrap_or(0), f64::from(m) * ten_to(n)),
        1 => format!("10{}", exponent(n)),
        _ => format!("{m}·10{}", exponent(n)),
    };
    // Over few decades two numbers between the powers have labels as well.
    let between: &[i32] = if b - a <= 2.2 { &[2, 5] } else { &[] };
    let mut out = Vec::new();
    for n in first..=last {
        for m in if stride > 1 { 1..2 } else { 1..10 } {
            let value =
                if n < 0 { f64::from(m) / elementary::powi(10.0, -n) } else { f64::from(m) * ten_to(n) };
            let is_named = (m == 1 && n.rem_euclid(stride) == 0) || between.contains(&m);
            out.push(Tick { value, label: is_named.then(|| label(m, n)) });
        }
    }
    out
}

/// A number as `1.5·10⁻³`, rounded to the decimal place `digits` if that is given.
fn power(value: f64, digits: Option<f64>) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let mut n = elementary::log10(value.abs()).floor();
    if value.abs() / elementary::powf(10.0, n) >= 9.999_999_99 {
        n += 1.0;
    }
    let mantissa = value / elementary::powf(10.0, n);
    let text = match digits {
        Some(digits) => format!("{mantissa:.*}", decimals(digits - n)),
        None => format!("{}", (mantissa * 1e3).round() / 1e3),
    };
    let ten = format!("10{}", exponent(whole_number(n)));
    match text.as_str() {
        "1" => ten,
        "-1" => minus(format!("-{ten}")),
        _ => minus(format!("{text}·{ten}")),
    }
}

/// Decimals down to the decimal place `digit`.
fn decimals(digit: f64) -> usize {
    usize::try_from(whole_number(-digit)).unwrap_or(0).min(15)
}

#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and exponents are small")]
fn whole_number(x: f64) -> i32 {
    x.round() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::coord::ranged1d::BoldPoints;

    fn ends(axis: &ChartAxis, values: &[f64]) -> Ends {
        Ends::of(axis, values.iter().copied())
    }

    fn placed(scale: Scale, low: f64, high: f64, length: f64, is_upright: bool) -> PlacedAxis {
        let axis = ChartAxis { scale, ..ChartAxis::linear("") };
        PlacedAxis::new(&axis, Ends { scale, low, high }, (0.0, length), is_upright)
    }

    fn labels(scale: Scale, low: f64, high: f64, length: f64, is_upright: bool) -> Vec<String> {
        placed(scale, low, high, length, is_upright).ticks.into_iter().filter_map(|tick| tick.label).collect()
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
    fn what_is_just_within_a_limit_is_drawn_and_what_is_just_beyond_is_not() {
        assert_eq!([1e150, 1.01e150].map(|one| drawable(one, Scale::Linear).is_ok()), [true, false]);
        assert_eq!([1e-150, 0.99e-150].map(|one| drawable(one, Scale::Log10).is_ok()), [true, false]);
        assert_eq!(drawable(-1.01e150, Scale::Linear), Err(Reason::Extreme));
        let (unit, decade) = (
            Ends { scale: Scale::Linear, low: 0.0, high: 1.0 },
            Ends { scale: Scale::Log10, low: 1.0, high: 10.0 },
        );
        let seen = [-0.0011, -0.0009, 1.0009, 1.0011].map(|one| unit.visible(one).is_ok());
        assert_eq!(seen, [false, true, true, false]);
        assert_eq!([-99.0, -5.0, 99.0].map(|one| unit.near(one)), [-20.0, -5.0, 21.0]);
        let powers = [1e-30, 1e-5, 1e30].map(|one| decade.near(one).log10().round());
        assert_eq!(powers, [-20.0, -5.0, 21.0]);
        // Room of 4 % of two decades; of a sixth of a decade where the data take less than a third.
        let of = |values: [f64; 2]| {
            let own = ends(&ChartAxis::log10(""), &values);
            [own.low / values[0], own.high / values[1]].map(|ratio| (1e3 * ratio.log10()).round())
        };
        assert_eq!(
            [of([1.0, 100.0]), of([1.0, 1.9]), of([1.0, 2.1])],
            [[-80.0, 80.0], [-150.0, 150.0], [-13.0, 13.0]]
        );
    }

    #[test]
    fn round_ends_stay_and_others_get_room() {
        let whole = ends(&ChartAxis::linear(""), &[0.0, 1.0]);
        assert_eq!((whole.low, whole.high), (0.0, 1.0));
        let widened = ends(&ChartAxis::linear(""), &[0.013, 0.97]);
        assert!(widened.low < 0.013 && widened.high > 0.97, "{widened:?}");
    }

    #[test]
    fn a_single_value_or_none_still_has_an_axis() {
        for axis in [ChartAxis::linear(""), ChartAxis::log10("")] {
            for value in [1.0, 7e-9, 3e120] {
                let one = ends(&axis, &[value]);
                assert!(one.low < value && value < one.high, "{one:?}");
            }
            let none = ends(&axis, &[]);
            assert!(none.low < none.high);
        }
    }

    #[test]
    fn an_unusable_fixed_range_gives_way_to_the_data() {
        let axis = ChartAxis::log10("").between(-1.0, 10.0);
        let own = ends(&axis, &[1.0, 100.0]);
        assert!(own.low > 0.0 && own.high > 100.0, "{own:?}");
        let nan = ChartAxis::linear("").between(f64::NAN, 1.0);
        assert!(ends(&nan, &[2.0]).high > 2.0);
    }

    #[test]
    fn a_value_stands_at_its_share_of_the_axis_and_a_tick_keeps_its_label() {
        // Two of four decades, and 1.25 of 4 from the other end.
        for (axis, value, wanted) in [
            (ChartAxis::log10("").between(1e-3, 1e1), 1e-1, 200.0),
            (ChartAxis::log10("").between(1e-3, 1e1), 1e0, 300.0),
            (ChartAxis::linear("").between(-1.0, 3.0).inverted(), 0.25, 275.0),
        ] {
            let own = PlacedAxis::new(&axis, ends(&axis, &[]), (0.0, 400.0), false);
            let px = own.px(value).expect("a value that can be drawn");
            assert!((px - wanted).abs() < 1e-9, "{value} {px}");
            let theirs = own.for_plotters();
            assert_eq!(theirs.map(&units(px), (0, 4000)), units(px));
            let labels: Vec<String> = own.ticks.iter().filter_map(|tick| tick.label.clone()).collect();
            let places = theirs.key_points(BoldPoints(12));
            assert_eq!(places.into_iter().map(|place| own.label_at(place)).collect::<Vec<_>>(), labels);
        }
    }

    #[test]
    fn linear_ticks_are_round_numbers() {
        assert_eq!(labels(Scale::Linear, 0.0, 1.0, 500.0, false), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear, -0.3, 0.2, 250.0, false), ["−0.2", "0.0", "0.2"]);
        assert_eq!(
            labels(Scale::Linear, 0.0, 2e6, 300.0, false),
            ["0", "5·10⁵", "1.0·10⁶", "1.5·10⁶", "2.0·10⁶"]
        );
    }

    #[test]
    fn log_ticks_are_powers_or_plain_numbers() {
        assert_eq!(labels(Scale::Log10, 1e-6, 1e-1, 300.0, true)[0], "10⁻⁶");
        assert_eq!(labels(Scale::Log10, 0.02, 0.25, 400.0, false), ["0.02", "0.05", "0.1", "0.2"]);
        let wide = labels(Scale::Log10, 1e-30, 1e30, 300.0, true);
        assert!(wide.len() >= 4 && wide.len() <= 13, "{wide:?}");
        let narrow = labels(Scale::Log10, 0.11, 0.13, 400.0, false);
        assert!(narrow.len() >= 3, "{narrow:?}");
    }

    #[test]
    fn labels_never_overlap() {
        for scale in [Scale::Linear, Scale::Log10] {
            for (low, high) in [(1e-9, 1.0), (0.1, 0.2), (1.0, 1e12), (1e7, 1.000_01e7), (3e-5, 4e-5)] {
                for length in [60.0, 200.0, 700.0] {
                    let axis = placed(scale, low, high, length, false);
                    let shown: Vec<(f64, f64)> = axis
                        .ticks
                        .iter()
                        .filter_map(|tick| Some((axis.px(tick.value)?, 6.0 * width(tick.label.as_deref()?))))
                        .collect();
                    for pair in shown.windows(2) {
                        let apart = pair[0].0 + pair[0].1 < pair[1].0 - pair[1].1;
                        assert!(apart, "{scale:?} {low} {high} {length}");
                    }
                }
            }
        }
    }

    #[test]
    fn given_ticks_keep_their_places() {
        let axis = ChartAxis::log10("").with_ticks(vec![0.2, 0.1, 0.05, 0.025, 5.0, f64::NAN, -1.0]);
        let ends = Ends { scale: Scale::Log10, low: 0.02, high: 0.3 };
        let placed = PlacedAxis::new(&axis, ends, (0.0, 500.0), false);
        let labels: Vec<_> = placed.ticks.into_iter().filter_map(|tick| tick.label).collect();
        assert_eq!(labels, ["0.2", "0.1", "0.05", "0.025"]);
        let long = given_ticks(&[1.0 / 3.0, 0.015_625, 0.007_812_5].map(|value| (value, None)), Scale::Log10);
        let long: Vec<_> = long.into_iter().filter_map(|tick| tick.label).collect();
        assert_eq!(long, ["0.3333", "0.015625", "0.007812"]);
    }

    #[test]
    fn numbers_as_powers() {
        assert_eq!(power(1.5e-3, None), "1.5·10⁻³");
        assert_eq!(power(1e-3, None), "10⁻³");
        assert_eq!(power(-1e5, None), "−10⁵");
        assert_eq!(power(0.0, None), "0");
        assert_eq!(power(2e6, Some(5.0)), "2.0·10⁶");
    }
}
