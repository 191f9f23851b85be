//! Documents of plotters' SVG backend: drawn in pixels, layer by layer, with subscripts and superscripts in their text.
//!
//! The coordinates of plotters are whole numbers, so everything is drawn ten times larger and shown through the view box.
use crate::render::escape::{one_line, plain_html};
use crate::render::script::{ScriptLevel, runs};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{PathElement, Polygon, Text};
use plotters::prelude::{Color, IntoFont, RGBColor, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, ShapeStyle, TextStyle};

/// Width of a figure on the screen of a phone, px.
pub(super) const NARROW: f64 = 368.0;

/// A place on the figure in pixels, from the upper left corner.
pub(super) type Px = (f64, f64);
pub(super) type Area<'s> = DrawingArea<SVGBackend<'s>, Shift>;
pub(super) type Drawn<T = ()> = Result<T, DrawingAreaErrorKind<std::io::Error>>;

const FONTS: &str = "'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// What plotters divides the size of a font by in SVG.
const FONT_SCALE: f64 = 1.24;

/// Begin and end of scripts and what follows them, as characters that plotters passes on and their elements.
const MARKS: [(char, &str); 5] = [
    ('\u{e000}', "<tspan dy=\"0.28em\" font-size=\"0.76em\">"),
    ('\u{e001}', "<tspan dy=\"-0.202em\">"),
    ('\u{e002}', "<tspan dy=\"-0.5em\" font-size=\"0.76em\">"),
    ('\u{e003}', "<tspan dy=\"0.36em\">"),
    ('\u{e004}', "</tspan>"),
];

/// Pixels in drawing units.
#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and pixels are small")]
pub(super) fn units(pixels: f64) -> i32 {
    (pixels * 10.0).round() as i32
}

pub(super) fn spot((x, y): Px) -> (i32, i32) {
    (units(x), units(y))
}

pub(super) fn stroke(colour: RGBColor, width: f64) -> ShapeStyle {
    colour.stroke_width(units(width).unsigned_abs())
}

/// The elements that `draw` makes on an area of this size in pixels.
pub(super) fn layer(size: Px, draw: impl FnOnce(&Area<'_>) -> Drawn) -> Result<String, String> {
    let mut text = String::new();
    {
        let size = (units(size.0).unsigned_abs(), units(size.1).unsigned_abs());
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        draw(&area).and_then(|()| area.present()).map_err(|error| error.to_string())?;
    }
    // The document around the elements belongs to the figure.
    let elements = text.split_once(">\n").map_or("", |(_, rest)| rest.trim_end_matches("</svg>\n"));
    let mut out = String::with_capacity(elements.len());
    for line in elements.lines() {
        out.push_str(line);
        // White space at the ends of a text would be drawn.
        if !line.starts_with("<text") && (line.starts_with('<') || line.is_empty()) {
            out.push('\n');
        }
    }
    for default in
        [" opacity=\"1\"", " stroke=\"none\"", " stroke-width=\"0\"", " font-family=\"sans-serif\""]
    {
        out = out.replace(default, "");
    }
    Ok(MARKS.iter().fold(out, |out, (mark, element)| out.replace(*mark, element)))
}

/// Elements in a group with attributes, named for a pointer that rests on it.
pub(super) fn group(attributes: &str, name: &str, elements: &str) -> String {
    let title =
        if name.is_empty() { String::new() } else { format!("<title>{}</title>\n", plain_html(name)) };
    if elements.is_empty() { String::new() } else { format!("<g{attributes}>\n{title}{elements}</g>\n") }
}

/// The whole document, with a name and a description for those who cannot see it.
pub(super) fn document(size: Px, title: &str, description: &str, elements: &str) -> String {
    let (title, description) = (plain_html(&one_line(title)), plain_html(&one_line(description)));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{title}\" width=\"{}\" height=\"{}\" \
         viewBox=\"0 0 {} {}\" font-family=\"{FONTS}\">\n<title>{title}</title>\n<desc>{description}</desc>\n\
         {elements}</svg>\n",
        size.0,
        size.1,
        units(size.0),
        units(size.1),
    )
}

/// Size, colour and weight of a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Font {
    pub size: f64,
    pub colour: RGBColor,
    pub is_bold: bool,
}

impl Font {
    /// The style of plotters.
    pub fn style(self, anchor: HPos) -> TextStyle<'static> {
        let weight = if self.is_bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = ("sans-serif", self.size * 10.0 * FONT_SCALE).into_font().style(weight);
        let style = TextStyle { color: self.colour.to_backend_color(), ..TextStyle::from(font) };
        style.pos(Pos::new(anchor, VPos::Center))
    }
}

/// Writes a text whose middle height is at a place.
pub(super) fn write(area: &Area<'_>, text: &str, at: Px, font: Font, anchor: HPos) -> Drawn {
    area.draw(&Text::new(scripted(text), spot(at), font.style(anchor)))
}

pub(super) fn line(area: &Area<'_>, points: &[Px], style: ShapeStyle) -> Drawn {
    area.draw(&PathElement::new(points.iter().copied().map(spot).collect::<Vec<_>>(), style))
}

pub(super) fn polygon(area: &Area<'_>, points: &[Px], style: impl Into<ShapeStyle>) -> Drawn {
    area.draw(&Polygon::new(points.iter().copied().map(spot).collect::<Vec<_>>(), style))
}

/// The text with the marks of its scripts.
pub(super) fn scripted(text: &str) -> String {
    let is_mark = |c: &char| MARKS.iter().any(|(mark, _)| mark == c);
    let text: String = one_line(text).chars().filter(|c| !is_mark(c)).collect();
    let mut out = String::new();
    let mut climb = None;
    for run in runs(&text) {
        // White space at the edge of a span is lost to some readers.
        let words = match run.text.strip_prefix(' ') {
            Some(rest) if climb.is_some() => format!("\u{a0}{rest}"),
            _ => run.text,
        };
        let [start, back] = match run.level {
            ScriptLevel::Base => {
                out += &climb.take().map_or(words.clone(), |back| format!("{back}{words}{}", MARKS[4].0));
                continue;
            }
            ScriptLevel::Sub => [MARKS[0].0, MARKS[1].0],
            ScriptLevel::Super => [MARKS[2].0, MARKS[3].0],
        };
        // A script right after another climbs back with a space of no width.
        out.extend(climb.into_iter().flat_map(|back| [back, '\u{200b}', MARKS[4].0]));
        out.push(start);
        out.push_str(&words);
        out.push(MARKS[4].0);
        climb = Some(back);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::style::colors::BLACK;

    #[test]
    fn text_is_escaped_and_scripts_become_spans() {
        let font = Font { size: 12.0, colour: BLACK, is_bold: false };
        let text = |text: &str| layer((99.0, 9.0), |area| write(area, text, (1.0, 2.0), font, HPos::Left));
        let svg = text("<b> T_v & 10⁻³ s").expect("a text");
        assert!(svg.contains(">&lt;b&gt; T<tspan dy=\"0.28em\" font-size=\"0.76em\">v</tspan>"), "{svg}");
        assert!(svg.contains("<tspan dy=\"-0.202em\">\u{a0}&amp; 10</tspan><tspan dy=\"-0.5em\""), "{svg}");
        assert!(svg.contains("<tspan dy=\"0.36em\">\u{a0}s</tspan></text>\n"), "{svg}");
        assert!(svg.contains("font-size=\"120"), "{svg}");
        assert!(!text("a\u{e000}b\u{0}").expect("a text").contains("tspan"), "marks of others are dropped");
        assert!(document((9.0, 9.0), "a <title>", "", "").contains("<title>a &lt;title&gt;</title>"));
    }

    #[test]
    fn a_group_has_its_attributes_and_an_empty_one_vanishes() {
        let drawn = layer((99.0, 9.0), |area| line(area, &[(0.0, 0.0), (10.04, 5.0)], stroke(BLACK, 1.5)));
        let drawn = group(" stroke-dasharray=\"3 2\"", "a & b", &drawn.expect("a line"));
        assert!(
            drawn.starts_with("<g stroke-dasharray=\"3 2\">\n<title>a &amp; b</title>\n<polyline"),
            "{drawn}"
        );
        assert!(drawn.contains("points=\"0,0 100,50 \"") && drawn.contains("stroke-width=\"15\""), "{drawn}");
        assert_eq!(group("", "name", ""), "");
    }
}
