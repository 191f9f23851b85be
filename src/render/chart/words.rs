//! What is written among the data where there is room: slope triangles and the words of rules.
use crate::render::chart::Chart;
use crate::render::chart::axis::Scale;
use crate::render::chart::draw::Layout;
use crate::render::chart::svg::{Drawn, Font, Px, group, layer, line, polygon, stroke, write};
use crate::render::palette::{QUIET, THEORY};
use crate::render::script::width;
use oedometer_soil::elementary;
use plotters::prelude::{Color, RGBColor};
use plotters::style::text_anchor::HPos;

const FONT: f64 = 11.0;
/// A white edge around words on data.
const HALO: &str = " paint-order=\"stroke\" stroke=\"#FFFFFF\" stroke-width=\"36\" stroke-linejoin=\"round\"";

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Frame {
    /// A frame with this middle and these half-lengths.
    fn around((x, y): Px, half_width: f64, half_height: f64) -> Self {
        Self { left: x - half_width, top: y - half_height, right: x + half_width, bottom: y + half_height }
    }

    pub fn holds(&self, (x, y): Px) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }

    fn meets(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// The frame, `by` wider on every side.
    pub fn grown(&self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }
}

/// A room that would do, what speaks against it from the start, and what would be drawn there.
struct Offer<T> {
    room: Frame,
    penalty: f64,
    drawn: T,
}

/// What is in the way of words.
#[derive(Debug)]
pub(super) struct Space {
    frame: Frame,
    obstacles: Vec<Px>,
    taken: Vec<Frame>,
}

impl Space {
    pub fn within(frame: Frame) -> Self {
        Self { frame, obstacles: Vec::new(), taken: Vec::new() }
    }

    /// A marker counts three times as much as a piece of a line.
    pub fn add_marker(&mut self, at: Px) {
        self.obstacles.extend([at; 3]);
    }

    /// A line, as points six pixels apart.
    pub fn add_line(&mut self, a: Px, b: Px) {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let pieces = (elementary::hypot(dx, dy) / 6.0).ceil().clamp(1.0, 1000.0);
        let mut place = 0.0;
        while place <= pieces {
            let at = (a.0 + dx * place / pieces, a.1 + dy * place / pieces);
            if self.frame.holds(at) {
                self.obstacles.push(at);
            }
            place += 1.0;
        }
    }

    /// Takes the room with the least in its way, the first of equals.
    fn take<T>(&mut self, offers: Vec<Offer<T>>) -> Option<T> {
        let cost = |offer: &Offer<T>| {
            let room = offer.room.grown(3.0);
            let met = self.obstacles.iter().filter(|at| room.holds(**at)).count();
            let words = self.taken.iter().filter(|taken| taken.meets(&offer.room)).count();
            let is_outside = !self.frame.holds((offer.room.left, offer.room.top))
                || !self.frame.holds((offer.room.right, offer.room.bottom));
            met as f64 + 60.0 * words as f64 + offer.penalty + if is_outside { 1e4 } else { 0.0 }
        };
        let costs = offers.iter().map(cost).collect::<Vec<_>>();
        let best = (0..offers.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b]))?;
        let offer = offers.into_iter().nth(best)?;
        self.taken.push(offer.room);
        Some(offer.drawn)
    }
}

/// Words with a halo around a place.
fn words(size: Px, text: &str, centre: Px, colour: RGBColor) -> Result<String, String> {
    let font = Font { size: FONT, colour, is_bold: false };
    Ok(group(HALO, "", &layer(size, |area| write(area, text, centre, font, HPos::Center))?))
}

fn half_size(text: &str) -> (f64, f64) {
    (0.5 * FONT * width(text) + 2.0, 0.62 * FONT)
}

/// Rules, each with its words where there is most room.
pub(super) fn rules(space: &mut Space, chart: &Chart, layout: &Layout) -> Result<String, String> {
    let plot = layout.plot;
    let mut out = String::new();
    for rule in &chart.rules {
        let Some(px) = layout.y.ends.visible(rule.at).ok().and_then(|at| layout.y.px(at)) else { continue };
        let across = [(plot.left, px), (plot.right, px)];
        let drawn = layer(layout.size, |area| line(area, &across, stroke(QUIET.light, 1.0)))?;
        out += &group(" stroke-dasharray=\"50 30\"", &rule.label, &drawn);
        let (w, h) = half_size(&rule.label);
        let offers = (0..=20).map(|step| f64::from(step) / 20.0).flat_map(|t| {
            let x = plot.left + w + 4.0 + t * (plot.right - plot.left - 2.0 * w - 8.0);
            [(-10.0, 0.0), (10.0, 0.1)].map(|(off, penalty)| {
                let at = (x, px + off);
                Offer { room: Frame::around(at, w, h), penalty: 0.2 * (1.0 - t) + penalty, drawn: at }
            })
        });
        if let Some(at) = space.take(offers.collect()) {
            out += &words(layout.size, &rule.label, at, QUIET.light)?;
        }
    }
    Ok(out)
}

/// A triangle with its right angle at the second corner.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corners: [Px; 3],
    /// Where the slope and the 1 are written.
    rise: Px,
    run: Px,
}

/// Positions along a series that are tried for a triangle.
const MOST_POSITIONS: usize = 30;

/// Triangles of given slopes beside their series, where both axes are logarithmic.
pub(super) fn triangles(space: &mut Space, chart: &Chart, layout: &Layout) -> Result<String, String> {
    let mut out = String::new();
    if chart.x.scale != Scale::Log10 || chart.y.scale != Scale::Log10 {
        return Ok(out);
    }
    for wanted in chart.triangles.iter().filter(|wanted| wanted.slope.is_finite()) {
        let own = chart.series.iter().zip(&layout.points).filter(|(series, _)| series.name == wanted.beside);
        let pairs =
            own.flat_map(|(_, points)| points.windows(2).filter_map(|pair| Some((pair[0]?, pair[1]?))));
        let positions: Vec<Px> = pairs
            .flat_map(|(a, b)| [0.25, 0.5, 0.75].map(|t| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))))
            .collect();
        let stride = positions.len().div_ceil(MOST_POSITIONS).max(1);
        let offers = positions.into_iter().step_by(stride).flat_map(|at| beside(at, wanted.slope, layout));
        if let Some(found) = space.take(offers.collect()) {
            let [a, b, c] = found.corners;
            let drawn = layer(layout.size, |area| -> Drawn {
                polygon(area, &found.corners, QUIET.light.mix(0.10))?;
                line(area, &[a, b, c, a], stroke(QUIET.light, 1.1))
            })?;
            out += &group(" stroke-linejoin=\"round\"", "", &drawn);
            let label = format!("{}", (wanted.slope.abs() * 100.0).round() / 100.0);
            out += &words(layout.size, &label, found.rise, THEORY.light)?;
            out += &words(layout.size, "1", found.run, THEORY.light)?;
        }
    }
    Ok(out)
}

/// Triangles below and above a place on a curve, at several distances.
fn beside(at: Px, slope: f64, layout: &Layout) -> Vec<Offer<Triangle>> {
    // Pixels down for one pixel to the right along the wanted slope.
    let steep = slope * layout.y.decade() / layout.x.decade();
    let plot = layout.plot;
    let run = ((plot.right - plot.left) * 0.11).min((plot.bottom - plot.top) * 0.26 / steep.abs().max(1e-6));
    let rise = run * steep;
    let norm = elementary::hypot(steep, 1.0);
    let mut out = Vec::new();
    for distance in [16.0, 26.0, 40.0] {
        for (side, penalty) in [(1.0, 0.0), (-1.0, 0.3)] {
            // Away from the curve, at a right angle to the slope.
            let middle = (at.0 - side * distance * steep / norm, at.1 + side * distance / norm);
            let a = (middle.0 - run / 2.0, middle.1 - rise / 2.0);
            let c = (middle.0 + run / 2.0, middle.1 + rise / 2.0);
            // The right angle lies on the far side of the slanted side.
            let corner = if (side > 0.0) == (a.1 > c.1) { (c.0, a.1) } else { (a.0, c.1) };
            let outwards = |from: f64, to: f64| if to > from { 9.0 } else { -9.0 };
            let rise_at = (corner.0 + outwards(middle.0, corner.0), middle.1);
            let run_at = (middle.0, corner.1 + outwards(middle.1, corner.1));
            let all = [a, corner, c, rise_at, run_at];
            let start = Frame::around(middle, 0.0, 0.0);
            let room = all.iter().fold(start, |room, &(x, y)| Frame {
                left: room.left.min(x),
                top: room.top.min(y),
                right: room.right.max(x),
                bottom: room.bottom.max(y),
            });
            out.push(Offer {
                room: room.grown(5.0),
                penalty: 0.02 * distance + penalty,
                drawn: Triangle { corners: [a, corner, c], rise: rise_at, run: run_at },
            });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::{ChartAxis, Series};

    #[test]
    fn the_emptier_place_wins_and_the_frame_is_kept() {
        let mut space = Space::within(Frame { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 });
        space.add_line((0.0, 50.0), (100.0, 50.0));
        let offers = |places: &[Px]| -> Vec<Offer<usize>> {
            let offer = |(drawn, at): (usize, &Px)| Offer {
                room: Frame::around(*at, 10.0, 5.0),
                penalty: 0.0,
                drawn,
            };
            places.iter().enumerate().map(offer).collect()
        };
        assert_eq!(space.take(offers(&[(50.0, 50.0), (50.0, 20.0), (99.0, 20.0)])), Some(1));
        assert_eq!(space.take(offers(&[(50.0, 20.0), (20.0, 80.0)])), Some(1), "the first is taken");
        assert_eq!(space.take(offers(&[])), None);
    }

    #[test]
    fn the_slanted_side_has_the_slope_it_is_named_after() {
        let points = vec![(1e-3, 1e-5), (1e-1, 3e-2)];
        for (axis, sign) in [(ChartAxis::log10("h"), 1.0), (ChartAxis::log10("h").inverted(), -1.0)] {
            let chart = Chart::new("", axis, ChartAxis::log10("e")).with(Series::new("a", points.clone()));
            let layout = Layout::of(&chart);
            for slope in [1.0, 2.0, -1.5, 4.0] {
                for offer in beside((400.0, 200.0), slope, &layout) {
                    let [a, corner, c] = offer.drawn.corners;
                    let (x, y) = ((c.0 - a.0) / layout.x.decade(), (c.1 - a.1) / layout.y.decade());
                    assert!((y / x - slope).abs() < 1e-9, "{slope} {x} {y}");
                    assert!(x * sign > 0.0);
                    let legs = (corner.0 == a.0 || corner.0 == c.0, corner.1 == a.1 || corner.1 == c.1);
                    assert_eq!(legs, (true, true));
                }
            }
        }
    }
}
