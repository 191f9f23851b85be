//! Horizontal rules across a plot, with their words at the right end.
use crate::render::chart::Chart;
use crate::render::chart::draw::Layout;
use crate::render::chart::svg::{Font, group, layer, line, stroke, write};
use crate::render::palette::QUIET;
use plotters::style::text_anchor::HPos;

const FONT: Font = Font { size: 11.0, colour: QUIET.light, is_bold: false };
/// A white edge around words on data.
const HALO: &str = " paint-order=\"stroke\" stroke=\"#FFFFFF\" stroke-width=\"36\" stroke-linejoin=\"round\"";
/// Distance of the words from their rule, and from the frame, px.
const OFF: f64 = 10.0;

/// The rules, each with its words above it, or below where there is no room.
pub(super) fn rules(chart: &Chart, layout: &Layout) -> Result<String, String> {
    let plot = layout.plot;
    let mut out = String::new();
    for rule in &chart.rules {
        let Some(px) = layout.y.ends.visible(rule.at).ok().and_then(|at| layout.y.px(at)) else { continue };
        let across = [(plot.left, px), (plot.right, px)];
        let drawn = layer(layout.size, |area| line(area, &across, stroke(QUIET.light, 1.0)))?;
        out += &group(" stroke-dasharray=\"50 30\"", &rule.label, &drawn);
        let off = if px - plot.top < 2.0 * OFF { OFF } else { -OFF };
        let at = (plot.right - OFF, px + off);
        out += &group(HALO, "", &layer(layout.size, |area| write(area, &rule.label, at, FONT, HPos::Right))?);
    }
    Ok(out)
}
