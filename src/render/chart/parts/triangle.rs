//! Triangles that show what an order looks like.
use crate::render::chart::canvas::{Canvas, Ink, Px};
use crate::render::chart::describe::Chart;
use crate::render::chart::layout::ChartLayout;
use crate::render::chart::layout::clip::PixelFrame;
use crate::render::chart::layout::scale::{Ruler, Scale};
use crate::render::chart::layout::space::{Offer, Space};
use crate::render::chart::palette::{DARK, QUIET};
use crate::render::chart::parts::words::write;
use oedometer_soil::elementary;

/// A triangle with its right angle at the second corner.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corners: [Px; 3],
    /// Where the slope and the 1 are written.
    rise: Px,
    run: Px,
}

/// Triangles with a given slope, where both axes are logarithmic.
pub(crate) fn draw_triangles(
    canvas: &mut Canvas,
    space: &mut Space,
    chart: &Chart,
    layout: &ChartLayout,
    places: &[Vec<Option<Px>>],
) {
    if chart.x.scale != Scale::Log10 || chart.y.scale != Scale::Log10 {
        return;
    }
    for wanted in &chart.triangles {
        if !wanted.slope.is_finite() {
            continue;
        }
        let label = format!("{}", (wanted.slope.abs() * 100.0).round() / 100.0);
        let offers: Vec<(Triangle, f64)> = chart
            .series
            .iter()
            .zip(places)
            .filter(|(s, _)| s.name == wanted.beside)
            .flat_map(|(_, p)| p.windows(2).filter_map(|w| Some((w[0]?, w[1]?))))
            .flat_map(|(a, b)| [0.25, 0.5, 0.75].map(|t| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))))
            .flat_map(|at| beside(at, wanted.slope, layout, &[16.0, 26.0, 40.0]))
            .collect();
        let rooms: Vec<Offer> =
            offers.iter().map(|(t, penalty)| Offer { room: reach(t), penalty: *penalty }).collect();
        if let Some(i) = space.best(&rooms) {
            space.take(rooms[i].room);
            draw_triangle(canvas, &offers[i].0, &label);
        }
    }
}

fn draw_triangle(canvas: &mut Canvas, t: &Triangle, label: &str) {
    canvas.group(&[("stroke-linejoin", "round")], |canvas| {
        canvas.polygon(&t.corners, Ink(QUIET, 0.10));
        canvas.line(&[t.corners[0], t.corners[1], t.corners[2], t.corners[0]], QUIET, 1.1);
    });
    write(canvas, label, t.rise, DARK);
    write(canvas, "1", t.run, DARK);
}

fn reach(t: &Triangle) -> PixelFrame {
    let points = t.corners.iter().chain([&t.rise, &t.run]);
    let start = PixelFrame { left: f64::MAX, top: f64::MAX, right: f64::MIN, bottom: f64::MIN };
    points
        .fold(start, |f, &(x, y)| PixelFrame {
            left: f.left.min(x),
            top: f.top.min(y),
            right: f.right.max(x),
            bottom: f.bottom.max(y),
        })
        .grown(5.0)
}

/// Triangles below and above a place on a curve, at several distances.
fn beside(at: Px, slope: f64, layout: &ChartLayout, distances: &[f64]) -> Vec<(Triangle, f64)> {
    let decade = |r: &Ruler| (r.to - r.from) / elementary::log10(r.span.high / r.span.low);
    let (dx, dy) = (decade(&layout.x.ruler), decade(&layout.y.ruler));
    // Pixels down for one pixel to the right along the wanted slope.
    let steep = slope * dy / dx;
    let run = (layout.plot.width() * 0.11).min(layout.plot.height() * 0.26 / steep.abs().max(1e-6));
    let rise = run * steep;
    let mut out = Vec::new();
    for &distance in distances {
        for below in [true, false] {
            // Away from the curve, at a right angle to the slope.
            let norm = elementary::hypot(steep, 1.0);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::describe::{ChartAxis, Series};
    use crate::render::chart::layout::lay_out;
    use crate::render::chart::parts::legend::Legend;

    #[test]
    fn the_slanted_side_has_the_slope_it_is_named_after() {
        let points = vec![(1e-3, 1e-5), (1e-1, 3e-2)];
        for (axis, sign) in [(ChartAxis::log10("h"), 1.0), (ChartAxis::log10("h").inverted(), -1.0)] {
            let chart = Chart::new("", axis, ChartAxis::log10("e")).with(Series::new("a", points.clone()));
            let layout = lay_out(&chart, &Legend::of(&chart, &[], &[]), &[]);
            let decades = |r: &Ruler, from: f64, to: f64| {
                (to - from) / (r.to - r.from) * (r.span.high / r.span.low).log10()
            };
            for slope in [1.0, 2.0, -1.5, 4.0] {
                for (t, _) in beside((400.0, 200.0), slope, &layout, &[16.0, 30.0]) {
                    let [a, corner, c] = t.corners;
                    let x = decades(&layout.x.ruler, a.0, c.0);
                    let y = decades(&layout.y.ruler, a.1, c.1);
                    assert!((y / x - slope).abs() < 1e-9, "{slope} {x} {y}");
                    assert!(x * sign > 0.0);
                    let legs = (corner.0 == a.0 || corner.0 == c.0, corner.1 == a.1 || corner.1 == c.1);
                    assert_eq!(legs, (true, true));
                    // The slanted side is the one that faces the curve.
                    let away = (t.rise.0 - 400.0).hypot(t.rise.1 - 200.0);
                    assert!(away > 5.0);
                }
            }
        }
    }
}
