//! Puts a figure together, from the back to the front.
use crate::render::chart::canvas::{Canvas, Hold, Px, Type};
use crate::render::chart::describe::{Chart, Style};
use crate::render::chart::field::colour_of;
use crate::render::chart::layout::clip::pieces;
use crate::render::chart::layout::missing::place;
use crate::render::chart::layout::space::Space;
use crate::render::chart::layout::{ChartLayout, LegendSide, lay_out};
use crate::render::chart::palette::{QUIET, WHITE, marker};
use crate::render::chart::parts::axes::{draw_axes, draw_bar, draw_grid};
use crate::render::chart::parts::legend::{Legend, Look, looks, stroke};
use crate::render::chart::parts::triangle::draw_triangles;
use crate::render::chart::parts::words::{draw_names, draw_rules};
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
        let layout = lay_out(self, &legend, &first.notes);
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

    /// Field, grid and lines.
    fn draw_data(
        &self,
        canvas: &mut Canvas,
        layout: &ChartLayout,
        looks: &[Look],
        places: &[Vec<Option<Px>>],
    ) {
        if let Some(field) = self.field.as_ref().filter(|f| f.shape().is_some()) {
            let span = field.span();
            field.draw_cells(canvas, &layout.x.ruler, &layout.y.ruler);
            draw_bar(canvas, layout, |share| colour_of(span.low + share * (span.high - span.low), &span));
        } else {
            draw_grid(canvas, layout);
        }
        for theory in [false, true] {
            for ((series, look), places) in self.series.iter().zip(looks).zip(places) {
                if look.line && (series.style == Style::Theory) == theory {
                    let pieces = pieces(places, &layout.plot);
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

    /// Everything above the frame: markers, triangles, words.
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
        for (look, places) in looks.iter().zip(places) {
            if look.line {
                for piece in pieces(places, &layout.plot) {
                    space.add_line(&piece);
                }
            }
            if let Some(slot) = look.marker {
                let place = kinds.iter().position(|k| k == look).unwrap_or_else(|| {
                    kinds.push(*look);
                    kinds.len() - 1
                });
                let size = radius(place, look.line);
                for at in places.iter().flatten().copied().filter(|&p| inside.holds(p)) {
                    marker(canvas, at, slot, size, look.colour);
                    space.add_marker(at);
                }
            }
        }
        if places.iter().flatten().flatten().next().is_none()
            && self.field.as_ref().is_none_or(|f| f.shape().is_none())
        {
            let look = Type { size: 22.0, ink: QUIET, bold: false, hold: Hold::Middle, upright: false };
            let f = layout.plot;
            let centre = (f64::midpoint(f.left, f.right), f64::midpoint(f.top, f.bottom) + 7.0);
            canvas.text("no data", centre, look);
        }
        draw_triangles(canvas, &mut space, self, layout, places);
        draw_rules(canvas, &mut space, self, layout);
        draw_names(canvas, &mut space, self, layout);
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
