//! Fields over a body: cells coloured by a value.
use crate::render::chart::canvas::{Canvas, Rgb};
use crate::render::chart::layout::scale::{Range, Ruler, Scale, Span, drawable};

/// A value a cell, on a grid of straight lines. Its colours meet in near-white at zero and are safe for the
/// colour-blind.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourField {
    /// What the colours mean, with its unit; written at the colour bar.
    pub label: String,
    /// How far the colours reach on both sides of zero, where fields share them; the field's own largest value where
    /// not given. What lies beyond has the last colour.
    pub reach: Option<f64>,
    /// The lines between the columns of cells, one more than columns.
    pub x_edges: Vec<f64>,
    /// The lines between the rows of cells, one more than rows.
    pub y_edges: Vec<f64>,
    /// The values, row after row, each row from the first column on. A value that cannot be drawn
    /// leaves its cell grey.
    pub values: Vec<f64>,
}

/// Blue to red by way of near-white, after the `RdBu` of Brewer (2003).
const COLOURS: [Rgb; 9] = [
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

const MISSING: Rgb = Rgb(0xC9, 0xC9, 0xC9);

impl ColourField {
    /// Columns and rows, and nothing at all where edges and values do not belong together.
    pub(crate) fn shape(&self) -> Option<(usize, usize)> {
        let columns = self.x_edges.len().checked_sub(1)?;
        let rows = self.y_edges.len().checked_sub(1)?;
        (columns > 0 && rows > 0 && self.values.len() == columns * rows).then_some((columns, rows))
    }

    /// What the colours span: as far on both sides of zero.
    pub(crate) fn span(&self) -> Span {
        let span = Span::over(Scale::Linear, Range::Auto, self.values.iter().copied(), 0.0);
        let own = span.high.abs().max(span.low.abs());
        let reach = self.reach.filter(|reach| *reach > 0.0).unwrap_or(own);
        Span { low: -reach, high: reach, ..span }
    }

    /// How many cells have no value that can be drawn.
    pub(crate) fn missing(&self) -> usize {
        self.values.iter().filter(|&&v| drawable(v, Scale::Linear).is_err()).count()
    }

    /// Draws the cells, equal neighbours of a row as one.
    pub(crate) fn draw_cells(&self, canvas: &mut Canvas, x: &Ruler, y: &Ruler) {
        let Some((columns, rows)) = self.shape() else { return };
        let span = self.span();
        let px = |ruler: &Ruler, edges: &[f64]| -> Vec<Option<f64>> {
            let (low, high) = (ruler.from.min(ruler.to), ruler.from.max(ruler.to));
            edges.iter().map(|&e| ruler.px(e).ok().map(|p| p.clamp(low, high))).collect()
        };
        let (xs, ys) = (px(x, &self.x_edges), px(y, &self.y_edges));
        canvas.group(&[("shape-rendering", "crispEdges")], |canvas| {
            for (row, values) in self.values.chunks(columns).enumerate().take(rows) {
                let inks: Vec<Rgb> = values.iter().map(|value| colour_of(*value, &span)).collect();
                let mut start = 0;
                for run in inks.chunk_by(|a, b| a == b) {
                    let end = start + run.len();
                    if let (Some(x0), Some(x1), Some(y0), Some(y1)) =
                        (xs[start], xs[end], ys[row], ys[row + 1])
                    {
                        canvas.rect((x0.min(x1), y0.min(y1)), (x0.max(x1), y0.max(y1)), run[0]);
                    }
                    start = end;
                }
            }
        });
    }
}

/// The colour of a value.
pub(crate) fn colour_of(value: f64, span: &Span) -> Rgb {
    drawable(value, Scale::Linear).map_or(MISSING, |value| mix(span.share(value).clamp(0.0, 1.0)))
}

/// Between the colours, in 240 steps, so that equal neighbours can share a rectangle.
fn mix(share: f64) -> Rgb {
    let place = (share * 240.0).round() / 30.0;
    let below = place.floor().min(7.0);
    let t = place - below;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 7")]
    let i = below as usize;
    let (Rgb(r0, g0, b0), Rgb(r1, g1, b1)) = (COLOURS[i], COLOURS[i + 1]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let part = |a: u8, b: u8| (f64::from(a) + t * (f64::from(b) - f64::from(a))).round() as u8;
    Rgb(part(r0, r1), part(g0, g1), part(b0, b1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(values: Vec<f64>) -> ColourField {
        ColourField {
            label: "p/q".into(),
            reach: None,
            x_edges: vec![0.0, 1.0, 2.0],
            y_edges: vec![0.0, 1.0],
            values,
        }
    }

    #[test]
    fn a_field_of_the_wrong_shape_has_none() {
        assert_eq!(field(vec![1.0, 2.0]).shape(), Some((2, 1)));
        assert_eq!(field(vec![1.0]).shape(), None);
    }

    #[test]
    fn the_middle_is_near_white_and_the_ends_are_blue_and_red() {
        let f = field(vec![-1.0, 3.0]);
        let span = f.span();
        assert_eq!((span.low, span.high), (-3.0, 3.0));
        assert_eq!(
            [-3.0, 0.0, 99.0].map(|value| colour_of(value, &span)),
            [COLOURS[0], COLOURS[4], COLOURS[8]]
        );
        assert_eq!(colour_of(f64::NAN, &span), MISSING);
    }
}
