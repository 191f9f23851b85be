//! What is written and drawn inside the plot beside the data: tags at curves, rules,
//! annotations.
use crate::render::chart::canvas::{Canvas, Hold, Ink, Px, Rgb, Type};
use crate::render::chart::describe::{Chart, ChartDirection};
use crate::render::chart::layout::ChartLayout;
use crate::render::chart::layout::clip::PixelFrame;
use crate::render::chart::layout::space::{Offer, Space, around, trail};
use crate::render::chart::palette::{DARK, QUIET, WHITE};
use crate::render::chart::parts::legend::Look;
use crate::render::script::width;

const FONT: f64 = 11.0;
const HALO: [(&str, &str); 4] =
    [("paint-order", "stroke"), ("stroke", "#FFFFFF"), ("stroke-width", "36"), ("stroke-linejoin", "round")];

pub(crate) fn write(canvas: &mut Canvas, text: &str, centre: Px, ink: Rgb) {
    let look = Type { size: FONT, ink, bold: false, hold: Hold::Middle, upright: false };
    canvas.group(&HALO, |canvas| canvas.text(text, (centre.0, centre.1 + 0.36 * FONT), look));
}

fn half(text: &str) -> (f64, f64) {
    (0.5 * FONT * width(text) + 2.0, 0.62 * FONT)
}

/// Writes where there is most room, and takes that room.
fn write_best(
    canvas: &mut Canvas,
    space: &mut Space,
    offers: &[(Px, f64)],
    text: &str,
    ink: Rgb,
    owner: Option<usize>,
) {
    let (w, h) = half(text);
    let rooms: Vec<Offer> =
        offers.iter().map(|&(at, penalty)| Offer { room: around(at, w, h), penalty }).collect();
    if let Some(i) = space.best(&rooms, owner) {
        space.take(rooms[i].room);
        if owner.is_some() {
            // Blanks what is beneath, but for a trace.
            let PixelFrame { left, top, right, bottom } = rooms[i].room;
            canvas.rect((left, top), (right, bottom), Ink(WHITE, 0.9));
        }
        write(canvas, text, offers[i].0, ink);
    }
}

/// The tag of a curve, on it or right beside it, as near its middle as there is room.
pub(crate) fn draw_tag(
    canvas: &mut Canvas,
    space: &mut Space,
    text: &str,
    pieces: &[Vec<Px>],
    look: Look,
    owner: usize,
) {
    let places: Vec<Px> = pieces.iter().flat_map(|p| trail(p, 7.0)).collect();
    let (w, h) = half(text);
    let mut offers = Vec::new();
    for (i, &(x, y)) in places.iter().enumerate() {
        let from_middle = ((i as f64 + 0.5) / places.len() as f64 - 0.5).abs();
        let shifts = [(0.0, 0.0), (w + 7.0, 0.0), (-w - 7.0, 0.0), (0.0, -h - 6.0), (0.0, h + 6.0)];
        offers.extend(
            shifts
                .iter()
                .enumerate()
                .map(|(k, (dx, dy))| ((x + dx, y + dy), 2.0 * from_middle + if k == 0 { 0.0 } else { 1.5 })),
        );
    }
    write_best(canvas, space, &offers, text, look.colour, Some(owner));
}

/// Lines at one value, with their words.
pub(crate) fn draw_rules(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &ChartLayout) {
    let plot = layout.plot;
    for rule in &chart.rules {
        let (ruler, upright) = match rule.axis {
            ChartDirection::X => (&layout.x.ruler, true),
            ChartDirection::Y => (&layout.y.ruler, false),
        };
        let Some(px) = ruler.px(rule.at).ok().filter(|&px| ruler.holds(px)) else {
            continue;
        };
        let ends =
            if upright { [(px, plot.top), (px, plot.bottom)] } else { [(plot.left, px), (plot.right, px)] };
        canvas.group(&[("stroke-dasharray", "50 30")], |canvas| canvas.line(&ends, QUIET, 1.0));
        if rule.label.is_empty() {
            continue;
        }
        let (w, _) = half(&rule.label);
        let offers: Vec<(Px, f64)> = (0..=20)
            .flat_map(|i| {
                let t = f64::from(i) / 20.0;
                let penalty = 0.2 * (1.0 - t);
                if upright {
                    let y = plot.bottom - 12.0 - t * (plot.height() - 24.0);
                    [((px + w + 4.0, y), penalty), ((px - w - 4.0, y), penalty + 0.1)]
                } else {
                    let x = plot.left + w + 4.0 + t * (plot.width() - 2.0 * w - 8.0);
                    [((x, px - 10.0), penalty), ((x, px + 10.0), penalty + 0.1)]
                }
            })
            .collect();
        write_best(canvas, space, &offers, &rule.label, QUIET, None);
    }
}

/// Words at points.
pub(crate) fn draw_annotations(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &ChartLayout) {
    for note in &chart.annotations {
        let (Ok(x), Ok(y)) = (layout.x.ruler.px(note.at.0), layout.y.ruler.px(note.at.1)) else {
            continue;
        };
        if !layout.plot.holds((x, y)) {
            continue;
        }
        let (w, h) = half(&note.text);
        let offers: Vec<(Px, f64)> = [
            (0.0, -1.0),
            (0.0, 1.0),
            (1.0, 0.0),
            (-1.0, 0.0),
            (1.0, -1.0),
            (-1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
        ]
        .into_iter()
        .enumerate()
        .map(|(i, (sx, sy))| ((x + sx * (w + 8.0), y + sy * (h + 7.0)), 0.1 * i as f64))
        .collect();
        write_best(canvas, space, &offers, &note.text, DARK, None);
    }
}
