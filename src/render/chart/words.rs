//! What is written and drawn inside the plot beside the data: tags at curves, rules, annotations,
//! slope triangles.
use super::canvas::{Canvas, Hold, Px, Rgb, Type};
use super::clip::Frame;
use super::describe::{Chart, Direction, Place, Scale};
use super::layout::Layout;
use super::legend::Look;
use super::palette::{DARK, QUIET};
use super::space::{Offer, Space, around, trail};
use crate::render::script::width;

const FONT: f64 = 11.0;
const HALO: [(&str, &str); 4] =
    [("paint-order", "stroke"), ("stroke", "#FFFFFF"), ("stroke-width", "36"), ("stroke-linejoin", "round")];

fn write(canvas: &mut Canvas, text: &str, centre: Px, ink: Rgb) {
    let look = Type { size: FONT, ink, bold: false, hold: Hold::Middle, upright: false };
    canvas.group(&HALO, |b| b.text(text, (centre.0, centre.1 + 0.36 * FONT), look));
}

/// Blanks what is beneath, but for a trace.
fn blank(canvas: &mut Canvas, room: Frame) {
    let (corner, opposite) = ((room.left, room.top), (room.right, room.bottom));
    canvas.group(&[], |b| b.rect(corner, opposite, super::canvas::Ink(super::palette::WHITE, 0.9)));
}

fn half(text: &str) -> (f64, f64) {
    (0.5 * FONT * width(text) + 2.0, 0.62 * FONT)
}

/// Writes where there is most room, and takes that room.
fn write_best(canvas: &mut Canvas, space: &mut Space, offers: &[(Px, f64)], text: &str, ink: Rgb, owner: Option<usize>) {
    let (w, h) = half(text);
    let rooms: Vec<Offer> = offers.iter().map(|&(at, penalty)| Offer { room: around(at, w, h), penalty }).collect();
    if let Some(i) = space.best(&rooms, owner) {
        space.take(rooms[i].room);
        if owner.is_some() {
            blank(canvas, rooms[i].room);
        }
        write(canvas, text, offers[i].0, ink);
    }
}

/// The tag of a curve, on it or right beside it, as near its middle as there is room.
pub(super) fn draw_tag(canvas: &mut Canvas, space: &mut Space, text: &str, pieces: &[Vec<Px>], look: Look, owner: usize) {
    let places: Vec<Px> = pieces.iter().flat_map(|p| trail(p, 7.0)).collect();
    let (w, h) = half(text);
    let mut offers = Vec::new();
    for (i, &(x, y)) in places.iter().enumerate() {
        let from_middle = ((i as f64 + 0.5) / places.len() as f64 - 0.5).abs();
        let shifts = [(0.0, 0.0), (w + 7.0, 0.0), (-w - 7.0, 0.0), (0.0, -h - 6.0), (0.0, h + 6.0)];
        offers.extend(shifts.iter().enumerate().map(|(k, (dx, dy))| {
            ((x + dx, y + dy), 2.0 * from_middle + if k == 0 { 0.0 } else { 1.5 })
        }));
    }
    write_best(canvas, space, &offers, text, look.colour, Some(owner));
}

/// Lines at one value, with their words.
pub(super) fn draw_rules(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &Layout) {
    let plot = layout.plot;
    for rule in &chart.rules {
        let (ruler, upright) = match rule.axis {
            Direction::X => (&layout.x.ruler, true),
            Direction::Y => (&layout.y.ruler, false),
        };
        let Some(px) = ruler.px(rule.at).ok().filter(|&px| ruler.holds(px)) else { continue };
        let ends = if upright { [(px, plot.top), (px, plot.bottom)] } else { [(plot.left, px), (plot.right, px)] };
        canvas.group(&[("stroke-dasharray", "50 30")], |b| b.line(&ends, QUIET, 1.0));
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
pub(super) fn draw_annotations(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &Layout) {
    for note in &chart.annotations {
        let (Ok(x), Ok(y)) = (layout.x.ruler.px(note.at.0), layout.y.ruler.px(note.at.1)) else { continue };
        if !layout.plot.holds((x, y)) {
            continue;
        }
        let (w, h) = half(&note.text);
        let offers: Vec<(Px, f64)> = [(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .into_iter()
            .enumerate()
            .map(|(i, (sx, sy))| ((x + sx * (w + 8.0), y + sy * (h + 7.0)), 0.1 * i as f64))
            .collect();
        write_best(canvas, space, &offers, &note.text, DARK, None);
    }
}

/// A triangle with its right angle at the second corner.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corners: [Px; 3],
    /// Where the slope and the 1 are written.
    rise: Px,
    run: Px,
}

/// Triangles with a given slope, where both axes are logarithmic.
pub(super) fn draw_triangles(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &Layout, places: &[Vec<Option<Px>>]) {
    if chart.x.scale != Scale::Log10 || chart.y.scale != Scale::Log10 {
        return;
    }
    for wanted in &chart.triangles {
        if !wanted.slope.is_finite() {
            continue;
        }
        let label = format!("{}", (wanted.slope.abs() * 100.0).round() / 100.0);
        let offers = match &wanted.place {
            Place::At(x, y) => match (layout.x.ruler.px(*x), layout.y.ruler.px(*y)) {
                (Ok(px), Ok(py)) if layout.plot.holds((px, py)) => beside((px, py), wanted.slope, layout, &[0.0]),
                _ => continue,
            },
            Place::Beside(name) => chart
                .series
                .iter()
                .zip(places)
                .filter(|(s, _)| s.name == *name)
                .flat_map(|(_, p)| p.windows(2).filter_map(|w| Some((w[0]?, w[1]?))).collect::<Vec<_>>())
                .flat_map(|(a, b)| [0.25, 0.5, 0.75].map(|t| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))))
                .flat_map(|at| beside(at, wanted.slope, layout, &[16.0, 26.0, 40.0]))
                .collect(),
        };
        let rooms: Vec<Offer> =
            offers.iter().map(|(t, penalty)| Offer { room: reach(t), penalty: *penalty }).collect();
        if let Some(i) = space.best(&rooms, None) {
            space.take(rooms[i].room);
            draw_triangle(canvas, &offers[i].0, &label);
        }
    }
}

fn draw_triangle(canvas: &mut Canvas, t: &Triangle, label: &str) {
    canvas.group(&[("stroke-linejoin", "round")], |b| {
        b.polygon(&t.corners, super::canvas::Ink(QUIET, 0.10))?;
        b.line(&[t.corners[0], t.corners[1], t.corners[2], t.corners[0]], QUIET, 1.1)
    });
    write(canvas, label, t.rise, DARK);
    write(canvas, "1", t.run, DARK);
}

fn reach(t: &Triangle) -> Frame {
    let points = t.corners.iter().chain([&t.rise, &t.run]);
    let start = Frame { left: f64::MAX, top: f64::MAX, right: f64::MIN, bottom: f64::MIN };
    points
        .fold(start, |f, &(x, y)| Frame {
            left: f.left.min(x),
            top: f.top.min(y),
            right: f.right.max(x),
            bottom: f.bottom.max(y),
        })
        .grown(5.0)
}

/// Triangles below and above a place on a curve, at several distances.
fn beside(at: Px, slope: f64, layout: &Layout, distances: &[f64]) -> Vec<(Triangle, f64)> {
    let decade = |r: &super::scale::Ruler| (r.to - r.from) / (r.span.high / r.span.low).log10();
    let (dx, dy) = (decade(&layout.x.ruler), decade(&layout.y.ruler));
    // Pixels down for one pixel to the right along the wanted slope.
    let steep = slope * dy / dx;
    let run = (layout.plot.width() * 0.11).min(layout.plot.height() * 0.26 / steep.abs().max(1e-6));
    let rise = run * steep;
    let mut out = Vec::new();
    for &distance in distances {
        for below in [true, false] {
            // Away from the curve, at a right angle to the slope.
            let norm = steep.hypot(1.0);
            let side = if below { 1.0 } else { -1.0 };
            let (ox, oy) = (-side * distance * steep / norm, side * distance / norm);
            let middle = (at.0 + ox, at.1 + oy);
            let a = (middle.0 - run / 2.0, middle.1 - rise / 2.0);
            let c = (middle.0 + run / 2.0, middle.1 + rise / 2.0);
            // The right angle lies on the far side of the slanted side.
            let corner = if below == (a.1 > c.1) { (c.0, a.1) } else { (a.0, c.1) };
            let horizontal_y = corner.1;
            let out_y = if horizontal_y > middle.1 { 9.0 } else { -9.0 };
            let out_x = if corner.0 > middle.0 { 9.0 } else { -9.0 };
            let triangle = Triangle {
                corners: [a, corner, c],
                rise: (corner.0 + out_x, middle.1),
                run: (middle.0, horizontal_y + out_y),
            };
            out.push((triangle, 0.02 * distance + if below { 0.0 } else { 0.3 }));
        }
    }
    out
}
