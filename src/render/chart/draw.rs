//! Puts a figure together, from the back to the front.
use crate::elementary;
use crate::render::chart::canvas::{Canvas, Hold, Px, Type};
use crate::render::chart::describe::{Chart, Series, Style};
use crate::render::chart::layout::clip::{PixelFrame, pieces};
use crate::render::chart::layout::missing::place;
use crate::render::chart::layout::scale::Scale;
use crate::render::chart::layout::space::Space;
use crate::render::chart::layout::{ChartLayout, LegendSide, lay_out};
use crate::render::chart::palette::{DARK, QUIET, WHITE, marker};
use crate::render::chart::parts::axes::{draw_axes, draw_bar, draw_grid};
use crate::render::chart::parts::legend::{Legend, Look, looks, stroke};
use crate::render::chart::parts::triangle::draw_triangles;
use crate::render::chart::parts::words::{draw_annotations, draw_rules, draw_tag};
use crate::render::render_error::RenderError;

/// Radius of markers. Later ones are smaller, so that points that coincide are seen to be several,
/// above all where no line tells of it.
fn radius(place: usize, joined: bool) -> f64 {
    let step = place.min(3) as f64;
    if joined { 4.6 - 0.25 * step } else { 5.4 - 0.85 * step }
}

impl Chart {
    /// The figure as a self-contained SVG document.
    ///
    /// # Errors
    /// If the drawing library refuses; it has no reason to.
    pub fn svg(&self) -> Result<String, RenderError> {
        let looks = looks(self);
        // A first layout tells what is missing, which the second has to find room for.
        let drawn_of = |places: &[Vec<Option<Px>>]| -> Vec<usize> {
            places.iter().map(|p| p.iter().flatten().count()).collect()
        };
        let draft = lay_out(self, &Legend::of(self, &looks, &vec![1; looks.len()]), &[]);
        let first = place(self, &draft.x.ruler, &draft.y.ruler, &draft.plot);
        let legend = Legend::of(self, &looks, &drawn_of(&first.points));
        let notes: Vec<String> = self.notes.iter().cloned().chain(first.notes).collect();
        let layout = lay_out(self, &legend, &notes);
        let places = place(self, &layout.x.ruler, &layout.y.ruler, &layout.plot).points;

        let mut canvas = Canvas::new(layout.width, layout.height);
        canvas.rect((0.0, 0.0), (layout.width, layout.height), WHITE);
        self.draw_data(&mut canvas, &layout, &looks, &places);
        draw_axes(&mut canvas, &layout);
        self.draw_front(&mut canvas, &layout, &looks, &places);
        match layout.side {
            LegendSide::None => {}
            LegendSide::Right => legend.draw_column(&mut canvas, layout.legend),
            LegendSide::Below => {
                legend.draw_rows(&mut canvas, layout.legend, layout.width - layout.plot.left - layout.left);
            }
        }
        canvas.finish(&self.title, &self.description())
    }

    /// Field, grid, bands and lines.
    fn draw_data(
        &self,
        canvas: &mut Canvas,
        layout: &ChartLayout,
        looks: &[Look],
        places: &[Vec<Option<Px>>],
    ) {
        if let Some(field) = self.field.as_ref().filter(|f| f.shape().is_some()) {
            let span = field.span();
            self.draw_cells(canvas, layout);
            draw_bar(canvas, layout, |share| {
                let value = match span.kind {
                    Scale::Linear => span.low + share * (span.high - span.low),
                    Scale::Log10 => span.low * elementary::powf(span.high / span.low, share),
                };
                field.colour(&span, value)
            });
        } else {
            draw_grid(canvas, layout);
        }
        self.draw_bands(canvas, layout);
        for theory in [false, true] {
            for ((series, look), places) in self.series.iter().zip(looks).zip(places) {
                if look.line && (series.style == Style::Theory) == theory {
                    let pieces = lines(series, places, &layout.plot);
                    if self.field.is_some() {
                        // No colour of a line shows on all colours of a field.
                        stroke(
                            canvas,
                            &pieces,
                            Look { colour: WHITE, dash: None, width: look.width + 20, ..*look },
                        );
                    }
                    stroke(canvas, &pieces, *look);
                }
            }
        }
    }

    /// Everything above the frame: bars, markers, rings, words.
    fn draw_front(
        &self,
        canvas: &mut Canvas,
        layout: &ChartLayout,
        looks: &[Look],
        places: &[Vec<Option<Px>>],
    ) {
        let inside = layout.plot.grown(0.5);
        let mut space = Space::within(layout.plot.grown(-2.0));
        let mut kinds: Vec<Look> = Vec::new();
        for (i, ((series, look), places)) in self.series.iter().zip(looks).zip(places).enumerate() {
            if look.line {
                for piece in lines(series, places, &layout.plot) {
                    space.add_line(&piece, i);
                }
            }
            let shown = || places.iter().flatten().copied().filter(|&p| inside.holds(p));
            draw_bars(canvas, series, *look, layout);
            if let Some(slot) = look.marker {
                let place = kinds.iter().position(|k| k == look).unwrap_or_else(|| {
                    kinds.push(*look);
                    kinds.len() - 1
                });
                let size = radius(place, look.line);
                for at in shown() {
                    marker(canvas, at, slot, size, look.colour);
                    space.add_marker(at);
                }
            }
        }
        for (series, places) in self.series.iter().zip(places) {
            let ringed = series.ringed.iter().filter_map(|&i| *places.get(i)?).filter(|&p| inside.holds(p));
            ringed.for_each(|at| canvas.ring(at, 7.6, DARK, 1.3));
        }
        if places.iter().flatten().flatten().next().is_none()
            && self.field.as_ref().is_none_or(|f| f.shape().is_none())
            && self.bands.iter().all(|b| b.points.is_empty())
        {
            let look = Type { size: 22.0, ink: QUIET, bold: false, hold: Hold::Middle, upright: false };
            let f = layout.plot;
            let centre = (f64::midpoint(f.left, f.right), f64::midpoint(f.top, f.bottom) + 7.0);
            canvas.text("no data", centre, look);
        }
        draw_triangles(canvas, &mut space, self, layout, places);
        draw_rules(canvas, &mut space, self, layout);
        for (i, ((series, look), places)) in self.series.iter().zip(looks).zip(places).enumerate() {
            if let Some(tag) = &series.tag {
                draw_tag(canvas, &mut space, tag, &lines(series, places, &layout.plot), *look, i);
            }
        }
        draw_annotations(canvas, &mut space, self, layout);
    }

    /// What the figure shows, for those who cannot see it.
    fn description(&self) -> String {
        let mut names: Vec<&str> =
            self.series.iter().map(|s| s.name.as_str()).filter(|n| !n.is_empty()).collect();
        names.dedup();
        let field = self.field.as_ref().map(|f| format!("{} in colour. ", f.label)).unwrap_or_default();
        let what = if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
        format!("{field}{} against {}{what}.", self.y.label, self.x.label)
    }
}

/// The visible pieces of the line of a series.
fn lines(series: &Series, places: &[Option<Px>], plot: &PixelFrame) -> Vec<Vec<Px>> {
    if series.style != Style::Stairs {
        return pieces(places, plot);
    }
    let mut steps = Vec::new();
    for pair in places.windows(2) {
        steps.push(pair[0]);
        if let (Some(a), Some(b)) = (pair[0], pair[1]) {
            steps.push(Some((b.0, a.1)));
        }
    }
    steps.extend(places.last().copied());
    pieces(&steps, plot)
}

fn draw_bars(canvas: &mut Canvas, series: &Series, look: Look, layout: &ChartLayout) {
    for (&(at, _), &(low, high)) in series.points.iter().zip(&series.bars) {
        let (Ok(x), Ok(low), Ok(high)) =
            (layout.x.ruler.px(at), layout.y.ruler.px(low), layout.y.ruler.px(high))
        else {
            continue;
        };
        for piece in pieces(&[Some((x, low)), Some((x, high))], &layout.plot) {
            canvas.line(&piece, look.colour, 1.2);
            for end in piece {
                canvas.line(&[(end.0 - 3.5, end.1), (end.0 + 3.5, end.1)], look.colour, 1.2);
            }
        }
    }
}
