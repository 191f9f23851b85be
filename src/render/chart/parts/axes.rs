//! Grid, frame, ticks and words around the plot.
use crate::render::chart::canvas::{Canvas, Hold, Rgb, Type};
use crate::render::chart::layout::clip::PixelFrame;
use crate::render::chart::layout::ticks::Tick;
use crate::render::chart::layout::{ChartLayout, Edge, LABEL, LINE, NOTE, SMALL, TITLE};
use crate::render::chart::palette::{FRAME, MAJOR, MINOR, QUIET, TEXT};
use crate::render::script::width;

const PLAIN: Type = Type { size: SMALL, ink: TEXT, bold: false, hold: Hold::Start, upright: false };

/// Thin lines behind the data.
pub(crate) fn draw_grid(canvas: &mut Canvas, layout: &ChartLayout) {
    let plot = layout.plot;
    for (major, ink) in [(false, MINOR), (true, MAJOR)] {
        let lines_of = |edge: &Edge| -> Vec<f64> {
            let lines = edge.ticks.iter().filter(|tick| tick.label.is_some() == major);
            lines.filter_map(|tick| edge.ruler.px(tick.value).ok()).collect()
        };
        for x in lines_of(&layout.x) {
            canvas.line(&[(x, plot.top), (x, plot.bottom)], ink, 1.0);
        }
        for y in lines_of(&layout.y) {
            canvas.line(&[(plot.left, y), (plot.right, y)], ink, 1.0);
        }
    }
}

/// The frame, its ticks, labels, titles and notes.
pub(crate) fn draw_axes(canvas: &mut Canvas, layout: &ChartLayout) {
    let plot = layout.plot;
    outline(canvas, &plot);
    draw_ticks(canvas, layout);
    for (i, words) in layout.x.words.iter().enumerate() {
        let at = (f64::midpoint(plot.left, plot.right), plot.bottom + 36.0 + i as f64 * LABEL * LINE);
        canvas.text(words, at, Type { size: LABEL, hold: Hold::Middle, ..PLAIN });
    }
    upright(canvas, &layout.y, layout.left + 11.0, &plot);
    let mut y = layout.left + TITLE * 0.85;
    for line in &layout.title {
        canvas.text(line, (layout.left, y), Type { size: TITLE, bold: true, ..PLAIN });
        y += TITLE * LINE;
    }
    y -= TITLE - SMALL;
    for line in &layout.subtitle {
        canvas.text(line, (layout.left, y), Type { ink: QUIET, ..PLAIN });
        y += SMALL * LINE;
    }
    for (i, line) in layout.notes.iter().enumerate() {
        let at = (layout.left, layout.notes_top + NOTE + i as f64 * NOTE * LINE);
        canvas.text(line, at, Type { size: NOTE, ink: QUIET, ..PLAIN });
    }
}

/// The ticks of both axes with their labels.
fn draw_ticks(canvas: &mut Canvas, layout: &ChartLayout) {
    let plot = layout.plot;
    let length = |tick: &Tick| if tick.label.is_some() { 5.0 } else { 3.0 };
    for tick in &layout.x.ticks {
        let Ok(x) = layout.x.ruler.px(tick.value) else { continue };
        canvas.line(&[(x, plot.bottom), (x, plot.bottom + length(tick))], FRAME, 1.0);
        if let Some(label) = &tick.label {
            canvas.text(label, (x, plot.bottom + 18.0), Type { hold: Hold::Middle, ..PLAIN });
        }
    }
    for tick in &layout.y.ticks {
        let Ok(y) = layout.y.ruler.px(tick.value) else { continue };
        canvas.line(&[(plot.left - length(tick), y), (plot.left, y)], FRAME, 1.0);
        if let Some(label) = &tick.label {
            canvas.text(label, (plot.left - 8.0, y + 4.2), Type { hold: Hold::End, ..PLAIN });
        }
    }
}

/// The colour bar of a field, in as many steps as it has colours.
pub(crate) fn draw_bar(canvas: &mut Canvas, layout: &ChartLayout, colour: impl Fn(f64) -> Rgb) {
    let Some(bar) = &layout.bar else { return };
    let frame = bar.frame;
    canvas.group(&[("shape-rendering", "crispEdges")], |canvas| {
        let steps = 120;
        for i in 0..steps {
            let (low, high) = (f64::from(i) / f64::from(steps), f64::from(i + 1) / f64::from(steps));
            let y = |share: f64| frame.bottom - share * frame.height();
            canvas.rect((frame.left, y(high)), (frame.right, y(low)), colour(f64::midpoint(low, high)));
        }
    });
    outline(canvas, &frame);
    let mut reach = 0.0_f64;
    for tick in &bar.edge.ticks {
        let (Ok(y), Some(label)) = (bar.edge.ruler.px(tick.value), &tick.label) else { continue };
        canvas.line(&[(frame.right, y), (frame.right + 4.0, y)], FRAME, 1.0);
        canvas.text(label, (frame.right + 8.0, y + 4.2), PLAIN);
        reach = reach.max(width(label) * SMALL);
    }
    upright(canvas, &bar.edge, frame.right + 8.0 + reach + 14.0, &frame);
}

/// Words beside an upright axis.
fn upright(canvas: &mut Canvas, edge: &Edge, x: f64, frame: &PixelFrame) {
    let look = Type { size: LABEL, hold: Hold::Middle, upright: true, ..PLAIN };
    for (i, words) in edge.words.iter().enumerate() {
        let at = (x + i as f64 * LABEL * LINE, f64::midpoint(frame.top, frame.bottom));
        canvas.text(words, at, look);
    }
}

fn outline(canvas: &mut Canvas, f: &PixelFrame) {
    let corners =
        [(f.left, f.top), (f.right, f.top), (f.right, f.bottom), (f.left, f.bottom), (f.left, f.top)];
    canvas.line(&corners, FRAME, 1.0);
}
