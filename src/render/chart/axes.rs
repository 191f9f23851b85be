//! Grid, frame, ticks and words around the plot.
use crate::render::chart::canvas::{Canvas, Hold, Rgb, Type};
use crate::render::chart::clip::Frame;
use crate::render::chart::layout::{Edge, LABEL, Layout, NOTE, SMALL, TITLE};
use crate::render::chart::palette::{FRAME, MAJOR, MINOR, QUIET, TEXT};

const PLAIN: Type = Type { size: SMALL, ink: TEXT, bold: false, hold: Hold::Start, upright: false };
const LINE: f64 = 1.3;

/// Thin lines behind the data.
pub(crate) fn draw_grid(canvas: &mut Canvas, layout: &Layout) {
    let plot = layout.plot;
    for (major, ink) in [(false, MINOR), (true, MAJOR)] {
        canvas.group(&[], |b| {
            for t in layout.x.ticks.iter().filter(|t| t.label.is_some() == major) {
                if let Ok(x) = layout.x.ruler.px(t.value) {
                    b.line(&[(x, plot.top), (x, plot.bottom)], ink, 1.0)?;
                }
            }
            for t in layout.y.ticks.iter().filter(|t| t.label.is_some() == major) {
                if let Ok(y) = layout.y.ruler.px(t.value) {
                    b.line(&[(plot.left, y), (plot.right, y)], ink, 1.0)?;
                }
            }
            Ok(())
        });
    }
}

/// The frame, its ticks, labels, titles and notes.
pub(crate) fn draw_axes(canvas: &mut Canvas, layout: &Layout) {
    let plot = layout.plot;
    outline(canvas, &plot);
    canvas.group(&[], |b| {
        for t in &layout.x.ticks {
            let Ok(x) = layout.x.ruler.px(t.value) else {
                continue;
            };
            let length = if t.label.is_some() { 5.0 } else { 3.0 };
            b.line(&[(x, plot.bottom), (x, plot.bottom + length)], FRAME, 1.0)?;
            if let Some(label) = &t.label {
                b.text(label, (x, plot.bottom + 18.0), Type { hold: Hold::Middle, ..PLAIN })?;
            }
        }
        for (i, words) in layout.x.words.iter().enumerate() {
            let at = (f64::midpoint(plot.left, plot.right), plot.bottom + 36.0 + i as f64 * LABEL * LINE);
            b.text(words, at, Type { size: LABEL, hold: Hold::Middle, ..PLAIN })?;
        }
        for t in &layout.y.ticks {
            let Ok(y) = layout.y.ruler.px(t.value) else {
                continue;
            };
            let length = if t.label.is_some() { 5.0 } else { 3.0 };
            b.line(&[(plot.left - length, y), (plot.left, y)], FRAME, 1.0)?;
            if let Some(label) = &t.label {
                b.text(label, (plot.left - 8.0, y + 4.2), Type { hold: Hold::End, ..PLAIN })?;
            }
        }
        upright(b, &layout.y, layout.left + 11.0, &plot)?;
        let mut y = layout.left + TITLE * 0.85;
        for line in &layout.title {
            b.text(line, (layout.left, y), Type { size: TITLE, bold: true, ..PLAIN })?;
            y += TITLE * LINE;
        }
        y -= TITLE - SMALL;
        for line in &layout.subtitle {
            b.text(line, (layout.left, y), Type { ink: QUIET, ..PLAIN })?;
            y += SMALL * LINE;
        }
        for (i, line) in layout.notes.iter().enumerate() {
            let at = (layout.left, layout.notes_top + NOTE + i as f64 * NOTE * LINE);
            b.text(line, at, Type { size: NOTE, ink: QUIET, ..PLAIN })?;
        }
        Ok(())
    });
}

/// The colour bar of a field, in as many steps as it has colours.
pub(crate) fn draw_bar(canvas: &mut Canvas, layout: &Layout, colour: impl Fn(f64) -> Rgb) {
    let Some(bar) = &layout.bar else { return };
    let frame = bar.frame;
    canvas.group(&[("shape-rendering", "crispEdges")], |b| {
        let steps = 120;
        for i in 0..steps {
            let (low, high) = (f64::from(i) / f64::from(steps), f64::from(i + 1) / f64::from(steps));
            let y = |share: f64| frame.bottom - share * frame.height();
            b.rect((frame.left, y(high)), (frame.right, y(low)), colour(f64::midpoint(low, high)))?;
        }
        Ok(())
    });
    outline(canvas, &frame);
    canvas.group(&[], |b| {
        let mut reach = 0.0_f64;
        for t in &bar.edge.ticks {
            let (Ok(y), Some(label)) = (bar.edge.ruler.px(t.value), &t.label) else {
                continue;
            };
            b.line(&[(frame.right, y), (frame.right + 4.0, y)], FRAME, 1.0)?;
            b.text(label, (frame.right + 8.0, y + 4.2), PLAIN)?;
            reach = reach.max(crate::render::script::width(label) * SMALL);
        }
        upright(b, &bar.edge, frame.right + 8.0 + reach + 14.0, &frame)
    });
}

fn upright(
    b: &crate::render::chart::canvas::Brush<'_, '_>,
    edge: &Edge,
    x: f64,
    frame: &Frame,
) -> Result<(), String> {
    let look = Type { size: LABEL, hold: Hold::Middle, upright: true, ..PLAIN };
    edge.words.iter().enumerate().try_for_each(|(i, words)| {
        b.text(words, (x + i as f64 * LABEL * LINE, f64::midpoint(frame.top, frame.bottom)), look)
    })
}

fn outline(canvas: &mut Canvas, f: &Frame) {
    let corners =
        [(f.left, f.top), (f.right, f.top), (f.right, f.bottom), (f.left, f.bottom), (f.left, f.top)];
    canvas.group(&[], |b| b.line(&corners, FRAME, 1.0));
}
