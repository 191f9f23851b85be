//! Areas of colour: shaded intervals and the cells of a field.
use crate::render::chart::canvas::{Canvas, Ink, Px};
use crate::render::chart::describe::Chart;
use crate::render::chart::layout::ChartLayout;
use crate::render::chart::layout::scale::Ruler;
use crate::render::chart::palette::colour;

impl Chart {
    pub(crate) fn draw_bands(&self, canvas: &mut Canvas, layout: &ChartLayout) {
        for band in &self.bands {
            let ends: Vec<(Px, Px)> = band
                .points
                .iter()
                .filter_map(|&(at, low, high)| {
                    let x = layout.x.ruler.px(at).ok()?;
                    let (low, high) = (layout.y.ruler.px(low).ok()?, layout.y.ruler.px(high).ok()?);
                    Some((layout.plot.nearest((x, low)), layout.plot.nearest((x, high))))
                })
                .collect();
            let outline: Vec<Px> = ends.iter().map(|e| e.0).chain(ends.iter().rev().map(|e| e.1)).collect();
            if outline.len() > 2 {
                canvas.polygon(&outline, Ink(colour(band.colour), 0.22));
            }
        }
    }

    pub(crate) fn draw_cells(&self, canvas: &mut Canvas, layout: &ChartLayout) {
        let Some(field) = &self.field else { return };
        let Some((columns, rows)) = field.shape() else {
            return;
        };
        let span = field.span();
        let px = |ruler: &Ruler, edges: &[f64]| -> Vec<Option<f64>> {
            let (low, high) = (ruler.from.min(ruler.to), ruler.from.max(ruler.to));
            edges.iter().map(|&e| ruler.px(e).ok().map(|p| p.clamp(low, high))).collect()
        };
        let (xs, ys) = (px(&layout.x.ruler, &field.x_edges), px(&layout.y.ruler, &field.y_edges));
        canvas.group(&[("shape-rendering", "crispEdges")], |canvas| {
            for row in 0..rows {
                let mut column = 0;
                while column < columns {
                    let ink = field.colour(&span, field.values[row * columns + column]);
                    let start = column;
                    while column < columns && field.colour(&span, field.values[row * columns + column]) == ink
                    {
                        column += 1;
                    }
                    if let (Some(x0), Some(x1), Some(y0), Some(y1)) =
                        (xs[start], xs[column], ys[row], ys[row + 1])
                    {
                        canvas.rect((x0.min(x1), y0.min(y1)), (x0.max(x1), y0.max(y1)), ink);
                    }
                }
            }
        });
    }
}
