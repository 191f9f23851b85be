//! Where an axis has ticks and what they say.
use crate::render::chart::axis_numbers::{decimals, power, whole};
use crate::render::chart::layout::scale::{Ruler, Scale, Span, drawable};
use crate::render::number::minus;
use crate::render::script::{exponent, width};
use oedometer_soil::elementary;

/// A tick; without a label it is a minor one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub value: f64,
    pub label: Option<String>,
}

/// Characters of a label that are still read at a glance.
const LONGEST_LABEL: usize = 8;

/// What labels need: the size of their font, and whether they stand beside each other or above.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room {
    pub font: f64,
    pub beside: bool,
}

/// The ticks of an axis, with labels that never overlap.
pub(crate) fn ticks(ruler: &Ruler, wanted: Option<&[f64]>, room: Room) -> Vec<Tick> {
    let mut all = match wanted {
        Some(values) => given(&ruler.span, values),
        None => automatic(ruler, room),
    };
    all.retain(|t| ruler.px(t.value).is_ok_and(|px| ruler.holds(px)));
    thin(&mut all, ruler, room);
    all
}

fn given(span: &Span, values: &[f64]) -> Vec<Tick> {
    let usable: Vec<f64> = values.iter().copied().filter(|&v| drawable(v, span.kind).is_ok()).collect();
    let plain = usable.iter().all(|v| *v == 0.0 || (1e-4..1e5).contains(&v.abs()));
    usable
        .iter()
        .map(|&value| Tick {
            value,
            label: Some(if plain { minus(short(value)) } else { power(value, None) }),
        })
        .collect()
}

/// A number in full, or to four digits where that is too long for a label.
fn short(value: f64) -> String {
    let full = format!("{value}");
    if full.len() <= LONGEST_LABEL {
        return full;
    }
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded}")
}

fn automatic(ruler: &Ruler, room: Room) -> Vec<Tick> {
    let span = ruler.span;
    let apart = if room.beside { 4.8 * room.font } else { 3.4 * room.font };
    let most = (ruler.length() / apart).clamp(2.0, 12.0);
    match span.kind {
        Scale::Linear => even(&span, most),
        Scale::Log10 if elementary::log10(span.high / span.low) < 0.75 => even(&span, most),
        Scale::Log10 => decades(&span, most),
    }
}

/// Multiples of 1, 2 or 5 times a power of ten.
fn even(span: &Span, most: f64) -> Vec<Tick> {
    let rough = (span.high - span.low) / most;
    let base = elementary::log10(rough).floor();
    let mantissa = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|m| m * elementary::powf(10.0, base) >= rough * 0.999)
        .unwrap_or(10.0);
    let step = mantissa * elementary::powf(10.0, base);
    let first = (span.low / step - 1e-9).ceil();
    let count = ((span.high / step + 1e-9).floor() - first).clamp(0.0, 40.0);
    let largest = span.low.abs().max(span.high.abs());
    let digits = if mantissa >= 10.0 { base + 1.0 } else { base };
    let mut out = Vec::new();
    let mut i = 0.0;
    while i <= count {
        let whole = (first + i) * mantissa;
        // Dividing by a whole power of ten keeps 0.3 from being 0.30000000000000004.
        let value = if base < 0.0 {
            whole / elementary::powf(10.0, -base)
        } else {
            whole * elementary::powf(10.0, base)
        };
        let label = if largest >= 1e5 || step < 0.999e-4 {
            power(value, Some(digits))
        } else {
            let decimals = decimals(digits);
            minus(format!("{value:.decimals$}"))
        };
        out.push(Tick { value, label: Some(label) });
        i += 1.0;
    }
    out
}

/// Powers of ten, labelled all or every so many, with minor ticks between them where they fit.
fn decades(span: &Span, most: f64) -> Vec<Tick> {
    let (a, b) = (elementary::log10(span.low), elementary::log10(span.high));
    let (first, last) = (whole((a - 1e-9).floor()), whole((b + 1e-9).ceil()));
    let stride = whole(((b - a) / most).ceil().max(1.0));
    let plain = a > -3.2 && b < 3.2;
    let label = |m: i32, n: i32| {
        if plain {
            let decimals = usize::try_from(-n).unwrap_or(0);
            format!("{:.decimals$}", f64::from(m) * elementary::powi(10.0, n))
        } else if m == 1 {
            format!("10{}", exponent(n))
        } else {
            format!("{m}·10{}", exponent(n))
        }
    };
    // Over few decades two numbers between the powers get a label as well.
    let between: &[i32] = if b - a <= 2.2 { &[2, 5] } else { &[] };
    let mut out = Vec::new();
    for n in first..=last {
        for m in 1..10 {
            if m > 1 && stride > 1 {
                break;
            }
            let value = value_of(m, n);
            let named = (m == 1 && n.rem_euclid(stride) == 0) || between.contains(&m);
            out.push(Tick { value, label: named.then(|| label(m, n)) });
        }
    }
    out
}

fn value_of(m: i32, n: i32) -> f64 {
    if n < 0 { f64::from(m) / elementary::powi(10.0, -n) } else { f64::from(m) * elementary::powi(10.0, n) }
}

/// Drops the labels that would touch a neighbour; powers of ten hold their place first.
fn thin(ticks: &mut [Tick], ruler: &Ruler, room: Room) {
    let mut order: Vec<usize> = (0..ticks.len()).filter(|&i| ticks[i].label.is_some()).collect();
    if ruler.span.kind == Scale::Log10 {
        order.sort_by_key(|&i| !is_power(ticks[i].value));
    }
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for i in order {
        let Ok(px) = ruler.px(ticks[i].value) else {
            continue;
        };
        let text = ticks[i].label.as_deref().unwrap_or_default();
        let half = if room.beside { 0.5 * room.font * width(text) + 4.0 } else { 0.62 * room.font };
        if taken.iter().any(|(from, to)| px - half < *to && px + half > *from) {
            ticks[i].label = None;
        } else {
            taken.push((px - half, px + half));
        }
    }
}

fn is_power(value: f64) -> bool {
    let n = elementary::log10(value.abs());
    (n - n.round()).abs() < 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(kind: Scale, low: f64, high: f64, length: f64, beside: bool) -> Vec<String> {
        let ruler = Ruler { span: Span { kind, low, high }, from: 0.0, to: length };
        ticks(&ruler, None, Room { font: 12.0, beside }).into_iter().filter_map(|t| t.label).collect()
    }

    #[test]
    fn linear_ticks_are_round_numbers() {
        assert_eq!(labels(Scale::Linear, 0.0, 1.0, 500.0, true), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear, -0.3, 0.2, 250.0, true), ["−0.2", "0.0", "0.2"]);
        assert_eq!(
            labels(Scale::Linear, 0.0, 2e6, 300.0, true),
            ["0", "5·10⁵", "1.0·10⁶", "1.5·10⁶", "2.0·10⁶"]
        );
    }

    #[test]
    fn log_ticks_are_powers_or_plain_numbers() {
        assert_eq!(labels(Scale::Log10, 1e-6, 1e-1, 300.0, false).first().map(String::as_str), Some("10⁻⁶"));
        assert_eq!(labels(Scale::Log10, 0.02, 0.25, 400.0, true), ["0.02", "0.05", "0.1", "0.2"]);
        let wide = labels(Scale::Log10, 1e-30, 1e30, 300.0, false);
        assert!(wide.len() >= 4 && wide.len() <= 13, "{wide:?}");
        let narrow = labels(Scale::Log10, 0.11, 0.13, 400.0, true);
        assert!(narrow.len() >= 3, "{narrow:?}");
    }

    #[test]
    fn labels_never_overlap() {
        for kind in [Scale::Linear, Scale::Log10] {
            for (low, high) in [(1e-9, 1.0), (0.1, 0.2), (1.0, 1e12), (1e7, 1.000_01e7), (3e-5, 4e-5)] {
                for length in [60.0, 200.0, 700.0] {
                    let ruler = Ruler { span: Span { kind, low, high }, from: 0.0, to: length };
                    let shown: Vec<(f64, f64)> = ticks(&ruler, None, Room { font: 12.0, beside: true })
                        .iter()
                        .filter_map(|t| Some((ruler.px(t.value).ok()?, 6.0 * width(t.label.as_deref()?))))
                        .collect();
                    for pair in shown.windows(2) {
                        assert!(
                            pair[0].0 + pair[0].1 < pair[1].0 - pair[1].1,
                            "{kind:?} {low} {high} {length}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn given_ticks_are_taken_as_they_are() {
        let ruler = Ruler { span: Span { kind: Scale::Log10, low: 0.02, high: 0.3 }, from: 0.0, to: 500.0 };
        let room = Room { font: 12.0, beside: true };
        let labels: Vec<_> = ticks(&ruler, Some(&[0.2, 0.1, 0.05, 0.025, 5.0, f64::NAN, -1.0]), room)
            .into_iter()
            .filter_map(|t| t.label)
            .collect();
        assert_eq!(labels, ["0.2", "0.1", "0.05", "0.025"]);
        assert_eq!([1.0 / 3.0, 0.015_625, 0.007_812_5].map(short), ["0.3333", "0.015625", "0.007812"]);
    }
}
