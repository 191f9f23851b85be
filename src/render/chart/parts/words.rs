//! What is written inside the plot beside the data: level lines with their words.
use crate::render::chart::canvas::{Canvas, Hold, Px, Rgb, Type};
use crate::render::chart::describe::Chart;
use crate::render::chart::layout::ChartLayout;
use crate::render::chart::layout::space::{Offer, Space, around};
use crate::render::chart::palette::{QUIET, TEXT};
use crate::render::script::width;

const FONT: f64 = 11.0;
const HALO: [(&str, &str); 4] =
    [("paint-order", "stroke"), ("stroke", "#FFFFFF"), ("stroke-width", "36"), ("stroke-linejoin", "round")];

pub(crate) fn write(canvas: &mut Canvas, text: &str, centre: Px, ink: Rgb) {
    let look = Type { size: FONT, ink, bold: false, hold: Hold::Middle, upright: false };
    canvas.group(&HALO, |canvas| canvas.text(text, (centre.0, centre.1 + 0.36 * FONT), look));
}

/// Level lines, each with its words where there is most room.
pub(crate) fn draw_rules(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &ChartLayout) {
    let (plot, ruler) = (layout.plot, &layout.y.ruler);
    for rule in &chart.rules {
        let Some(px) = ruler.px(rule.at).ok().filter(|&px| ruler.holds(px)) else { continue };
        canvas.group(&[("stroke-dasharray", "50 30")], |canvas| {
            canvas.line(&[(plot.left, px), (plot.right, px)], QUIET, 1.0);
        });
        let (w, h) = (0.5 * FONT * width(&rule.label) + 2.0, 0.62 * FONT);
        let offers = (0..=20).map(f64::from).flat_map(|i| {
            let t = i / 20.0;
            let x = plot.left + w + 4.0 + t * (plot.width() - 2.0 * w - 8.0);
            [(-10.0, 0.0), (10.0, 0.1)].map(|(off, penalty)| ((x, px + off), 0.2 * (1.0 - t) + penalty))
        });
        let offers: Vec<(Px, f64)> = offers.collect();
        let rooms: Vec<Offer> =
            offers.iter().map(|&(at, penalty)| Offer { room: around(at, w, h), penalty }).collect();
        if let Some(i) = space.best(&rooms) {
            space.take(rooms[i].room);
            write(canvas, &rule.label, offers[i].0, QUIET);
        }
    }
}

/// Names of single points: beside, above or below them, where least is in the way; none where there is no room.
pub(crate) fn draw_names(canvas: &mut Canvas, space: &mut Space, chart: &Chart, layout: &ChartLayout) {
    let mut written: Vec<&str> = Vec::new();
    for one in &chart.names {
        // Points of one name that lie together have it once.
        if written.contains(&one.name.as_str()) {
            continue;
        }
        let (x, y) = (layout.x.ruler.px(one.at.0), layout.y.ruler.px(one.at.1));
        let (Ok(x), Ok(y)) = (x, y) else { continue };
        if !layout.plot.grown(0.5).holds((x, y)) {
            continue;
        }
        let (w, h) = (0.5 * FONT * width(&one.name) + 2.0, 0.62 * FONT);
        let away: [(Px, f64); 8] = [
            ((x + w + 7.0, y - 5.0), 0.0),
            ((x + w + 7.0, y + 6.0), 0.1),
            ((x, y - 13.0), 0.3),
            ((x, y + 14.0), 0.3),
            ((x - w - 7.0, y - 5.0), 0.2),
            ((x - w - 7.0, y + 6.0), 0.3),
            ((x + 0.7 * w, y - 24.0), 0.6),
            ((x - 0.7 * w, y + 25.0), 0.6),
        ];
        let rooms: Vec<Offer> =
            away.iter().map(|&(at, penalty)| Offer { room: around(at, w, h), penalty }).collect();
        // A name on another name is none.
        if let Some(i) = space.best(&rooms).filter(|i| space.is_free(&rooms[*i].room)) {
            space.take(rooms[i].room);
            write(canvas, &one.name, away[i].0, TEXT);
            written.push(&one.name);
        }
    }
}
