//! Cells coloured by a value: fields over a body, maps over two parameters.
use crate::render::chart::canvas::Rgb;
use crate::render::chart::layout::scale::{Range, Scale, Span, drawable};

/// A value a cell, on a grid of straight lines.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourField {
    /// What the colours mean, with its unit; written at the colour bar.
    pub label: String,
    /// The lines between the columns of cells, one more than columns.
    pub x_edges: Vec<f64>,
    /// The lines between the rows of cells, one more than rows.
    pub y_edges: Vec<f64>,
    /// The values, row after row, each row from the first column on. A value that cannot be drawn
    /// leaves its cell grey.
    pub values: Vec<f64>,
    /// The colours.
    pub colours: Colours,
    /// How the values are spread over them.
    pub scale: Scale,
    /// What the colours span. Values beyond it take the colour of the end.
    pub range: Range,
}

/// A family of colours; both are safe for the colour-blind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colours {
    /// Dark to light, also on grey paper.
    Sequential,
    /// Two colours that meet in near-white at the given value.
    Diverging(f64),
}

/// Viridis at nine even places.
const SEQUENTIAL: [Rgb; 9] = [
    Rgb(0x44, 0x01, 0x54),
    Rgb(0x47, 0x2D, 0x7B),
    Rgb(0x3B, 0x52, 0x8B),
    Rgb(0x2C, 0x72, 0x8E),
    Rgb(0x21, 0x91, 0x8C),
    Rgb(0x28, 0xAE, 0x80),
    Rgb(0x5E, 0xC9, 0x62),
    Rgb(0xAD, 0xDC, 0x30),
    Rgb(0xFD, 0xE7, 0x25),
];

/// Blue to red by way of near-white, after the `RdBu` of Brewer (2003).
const DIVERGING: [Rgb; 9] = [
    Rgb(0x21, 0x66, 0xAC),
    Rgb(0x43, 0x93, 0xC3),
    Rgb(0x92, 0xC5, 0xDE),
    Rgb(0xD1, 0xE5, 0xF0),
    Rgb(0xF7, 0xF7, 0xF7),
    Rgb(0xFD, 0xDB, 0xC7),
    Rgb(0xF4, 0xA5, 0x82),
    Rgb(0xD6, 0x60, 0x4D),
    Rgb(0xB2, 0x18, 0x2B),
];

pub(crate) const MISSING: Rgb = Rgb(0xC9, 0xC9, 0xC9);

impl ColourField {
    /// Columns and rows, and nothing at all where edges and values do not belong together.
    pub(crate) fn shape(&self) -> Option<(usize, usize)> {
        let columns = self.x_edges.len().checked_sub(1)?;
        let rows = self.y_edges.len().checked_sub(1)?;
        (columns > 0 && rows > 0 && self.values.len() == columns * rows).then_some((columns, rows))
    }

    /// What the colours span. A diverging family reaches as far on both sides of its middle.
    pub(crate) fn span(&self) -> Span {
        let span = Span::over(self.scale, self.range, self.values.iter().copied(), 0.0);
        match (self.colours, self.range, self.scale) {
            (Colours::Diverging(middle), Range::Auto, Scale::Linear) if middle.is_finite() => {
                let reach = (span.high - middle).abs().max((middle - span.low).abs());
                Span { low: middle - reach, high: middle + reach, ..span }
            }
            _ => span,
        }
    }

    /// The colour of a value.
    pub(crate) fn colour(&self, span: &Span, value: f64) -> Rgb {
        let Ok(value) = drawable(value, self.scale) else {
            return MISSING;
        };
        let share = span.share(value).clamp(0.0, 1.0);
        match self.colours {
            Colours::Sequential => mix(&SEQUENTIAL, share),
            Colours::Diverging(middle) => {
                let centre = span.share(middle);
                let centre = if centre.is_finite() { centre.clamp(0.0, 1.0) } else { 0.5 };
                let side = if share >= centre {
                    0.5 + 0.5 * (share - centre) / (1.0 - centre).max(1e-12)
                } else {
                    0.5 * share / centre.max(1e-12)
                };
                mix(&DIVERGING, side)
            }
        }
    }

    /// Cells without a colour of their own.
    pub(crate) fn missing(&self) -> usize {
        self.values.iter().filter(|&&v| drawable(v, self.scale).is_err()).count()
    }
}

/// Between the colours of a family, in 240 steps, so that equal neighbours can share a rectangle.
fn mix(colours: &[Rgb; 9], share: f64) -> Rgb {
    let place = (share * 240.0).round() / 30.0;
    let below = place.floor().min(7.0);
    let t = place - below;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 7")]
    let i = below as usize;
    let (Rgb(r0, g0, b0), Rgb(r1, g1, b1)) = (colours[i], colours[i + 1]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let part = |a: u8, b: u8| (f64::from(a) + t * (f64::from(b) - f64::from(a))).round() as u8;
    Rgb(part(r0, r1), part(g0, g1), part(b0, b1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(values: Vec<f64>, colours: Colours) -> ColourField {
        ColourField {
            label: "p/q".into(),
            x_edges: vec![0.0, 1.0, 2.0],
            y_edges: vec![0.0, 1.0],
            values,
            colours,
            scale: Scale::Linear,
            range: Range::Auto,
        }
    }

    #[test]
    fn a_field_of_the_wrong_shape_has_none() {
        assert_eq!(field(vec![1.0, 2.0], Colours::Sequential).shape(), Some((2, 1)));
        assert_eq!(field(vec![1.0], Colours::Sequential).shape(), None);
    }

    #[test]
    fn the_middle_of_a_diverging_family_is_near_white() {
        let f = field(vec![-1.0, 3.0], Colours::Diverging(0.0));
        let span = f.span();
        assert_eq!((span.low, span.high), (-3.0, 3.0));
        assert_eq!(f.colour(&span, 0.0), DIVERGING[4]);
        assert_eq!(f.colour(&span, 99.0), DIVERGING[8]);
        assert_eq!(f.colour(&span, f64::NAN), MISSING);
    }

    #[test]
    fn sequential_colours_run_from_dark_to_light() {
        let f = field(vec![0.0, 1.0], Colours::Sequential);
        let span = f.span();
        assert_eq!(f.colour(&span, 0.0), SEQUENTIAL[0]);
        assert_eq!(f.colour(&span, 1.0), SEQUENTIAL[8]);
        assert_eq!(f.colour(&span, 0.5), SEQUENTIAL[4]);
        let light = |c: Rgb| 2 * u32::from(c.0) + 5 * u32::from(c.1) + u32::from(c.2);
        for i in 1..=20_u32 {
            let (a, b) = (f64::from(i - 1) / 20.0, f64::from(i) / 20.0);
            assert!(light(f.colour(&span, a)) < light(f.colour(&span, b)));
        }
    }
}
