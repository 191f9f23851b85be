//! The only file that knows the plotting library: pixels in, SVG out.
//!
//! The library's coordinates are whole numbers, so everything is drawn ten times larger and shown
//! through the view box. Each group is drawn on a sheet of its own, which lets it carry what the
//! library cannot say: dashes, halos, crisp edges.
use crate::render::chart::polish::{marked, polish};
use crate::render::error::RenderError;
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::prelude::{
    Circle, DrawingArea, IntoDrawingArea, IntoFont, PathElement, Polygon, RGBAColor, Rectangle, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, ShapeStyle, TextStyle};
use std::fmt::Write as _;

/// Drawing units a pixel.
const UNIT: f64 = 10.0;
const FONTS: &str = "'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// A colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rgb(pub u8, pub u8, pub u8);

/// A colour and how much of it: 1 hides what is beneath.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ink(pub Rgb, pub f64);

impl From<Rgb> for Ink {
    fn from(colour: Rgb) -> Self {
        Self(colour, 1.0)
    }
}

impl Ink {
    fn style(self, width: f64, filled: bool) -> ShapeStyle {
        let Self(Rgb(r, g, b), opacity) = self;
        ShapeStyle { color: RGBAColor(r, g, b, opacity), filled, stroke_width: units(width).unsigned_abs() }
    }
}

/// A place on the canvas in pixels, from the upper left corner.
pub(crate) type Px = (f64, f64);

/// Which end of a text its place names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hold {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Type {
    pub size: f64,
    pub ink: Rgb,
    pub bold: bool,
    pub hold: Hold,
    /// Read from below upwards.
    pub upright: bool,
}

type Drawn = Result<(), String>;
type Sheet<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws on the sheet of one group.
pub(crate) struct Brush<'a, 'b>(&'a Sheet<'b>);

/// A figure in the making.
pub(crate) struct Canvas {
    size: (u32, u32),
    body: String,
    failure: Option<String>,
}

impl Canvas {
    pub fn new(width: f64, height: f64) -> Self {
        let size = (units(width).unsigned_abs(), units(height).unsigned_abs());
        Self { size, body: String::new(), failure: None }
    }

    /// Draws a group with attributes of its own. The first failure is kept for [`Canvas::finish`].
    pub fn group(&mut self, attributes: &[(&str, &str)], draw: impl FnOnce(&Brush<'_, '_>) -> Drawn) {
        let mut text = String::new();
        let drawn = {
            let sheet = SVGBackend::with_string(&mut text, self.size).into_drawing_area();
            draw(&Brush(&sheet)).and_then(|()| sheet.present().map_err(|e| e.to_string()))
        };
        if let Err(reason) = drawn {
            self.failure.get_or_insert(reason);
        }
        let inside = text
            .split_once('\n')
            .and_then(|(_, rest)| rest.rsplit_once("</svg>"))
            .map_or("", |(inside, _)| inside);
        if inside.is_empty() {
            return;
        }
        if attributes.is_empty() {
            self.body.push_str(&polish(inside));
            return;
        }
        self.body.push_str("<g");
        for (name, value) in attributes {
            let _ = write!(self.body, r#" {name}="{}""#, escape(value));
        }
        let _ = write!(self.body, ">\n{}</g>\n", polish(inside));
    }

    /// The finished SVG, named for those who cannot see it.
    pub fn finish(self, title: &str, description: &str) -> Result<String, RenderError> {
        if let Some(reason) = self.failure {
            return Err(RenderError::Draw { title: title.to_owned(), reason });
        }
        let (w, h) = self.size;
        let (title, description) = (escape(&clean(title)), escape(&clean(description)));
        Ok(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{title}\" \
             width=\"{}\" height=\"{}\" viewBox=\"0 0 {w} {h}\" font-family=\"{FONTS}\">\n\
             <title>{title}</title>\n<desc>{description}</desc>\n{}</svg>\n",
            f64::from(w) / UNIT,
            f64::from(h) / UNIT,
            self.body,
        ))
    }
}

impl Brush<'_, '_> {
    pub fn line(&self, points: &[Px], ink: impl Into<Ink>, width: f64) -> Drawn {
        self.0
            .draw(&PathElement::new(spots(points), ink.into().style(width, false)))
            .map_err(|e| e.to_string())
    }

    pub fn polygon(&self, points: &[Px], ink: impl Into<Ink>) -> Drawn {
        self.0.draw(&Polygon::new(spots(points), ink.into().style(0.0, true))).map_err(|e| e.to_string())
    }

    pub fn rect(&self, corner: Px, opposite: Px, ink: impl Into<Ink>) -> Drawn {
        let corners = [spot(corner), spot(opposite)];
        self.0.draw(&Rectangle::new(corners, ink.into().style(0.0, true))).map_err(|e| e.to_string())
    }

    pub fn disc(&self, centre: Px, radius: f64, ink: impl Into<Ink>) -> Drawn {
        self.circle(centre, radius, ink.into().style(0.0, true))
    }

    pub fn ring(&self, centre: Px, radius: f64, ink: impl Into<Ink>, width: f64) -> Drawn {
        self.circle(centre, radius, ink.into().style(width, false))
    }

    fn circle(&self, centre: Px, radius: f64, style: ShapeStyle) -> Drawn {
        self.0.draw(&Circle::new(spot(centre), units(radius), style)).map_err(|e| e.to_string())
    }

    /// Text whose base line runs through `at`.
    pub fn text(&self, text: &str, at: Px, look: Type) -> Drawn {
        let Rgb(r, g, b) = look.ink;
        let weight = if look.bold { FontStyle::Bold } else { FontStyle::Normal };
        let turn = if look.upright { FontTransform::Rotate270 } else { FontTransform::None };
        let hold = match look.hold {
            Hold::Start => HPos::Left,
            Hold::Middle => HPos::Center,
            Hold::End => HPos::Right,
        };
        // The library divides by 1.24 what it is given.
        let font = ("sans-serif", look.size * UNIT * 1.24).into_font().style(weight).transform(turn);
        let ink = RGBAColor(r, g, b, 1.0);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(hold, VPos::Bottom));
        self.0.draw(&Text::new(marked(text), spot(at), style)).map_err(|e| e.to_string())
    }
}

/// Pixels in drawing units. Whatever is drawn has been clipped to the canvas before.
#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and pixels are small")]
fn units(pixels: f64) -> i32 {
    (pixels * UNIT).round() as i32
}

fn spot((x, y): Px) -> (i32, i32) {
    (units(x), units(y))
}

/// Points in drawing units, without repetitions.
fn spots(points: &[Px]) -> Vec<(i32, i32)> {
    let mut out: Vec<_> = points.iter().map(|&p| spot(p)).collect();
    out.dedup();
    out
}

/// The text as spelled, without what no document may hold.
fn clean(text: &str) -> String {
    text.chars().filter(|c| !c.is_control() && !('\u{e000}'..='\u{f8ff}').contains(c)).collect()
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Type =
        Type { size: 12.0, ink: Rgb(0, 0, 0), bold: false, hold: Hold::Start, upright: false };

    fn text(words: &str) -> String {
        let mut canvas = Canvas::new(100.0, 50.0);
        canvas.group(&[], |b| b.text(words, (1.0, 2.0), PLAIN));
        canvas.finish("a <title>", "").unwrap_or_default()
    }

    #[test]
    fn text_is_escaped_and_scripts_become_spans() {
        let svg = text("<b> T_v & 10⁻³ s");
        assert!(svg.contains("&lt;b&gt; T<tspan dy=\"0.28em\" font-size=\"0.72em\">v</tspan>"), "{svg}");
        assert!(svg.contains("<tspan dy=\"-0.202em\">\u{a0}&amp; 10</tspan>"), "{svg}");
        assert!(svg.contains(r#"font-size="120""#), "{svg}");
        assert!(svg.contains("<title>a &lt;title&gt;</title>"), "{svg}");
    }

    #[test]
    fn groups_carry_their_attributes() {
        let mut canvas = Canvas::new(100.0, 50.0);
        canvas.group(&[("stroke-dasharray", "3 2")], |b| {
            b.line(&[(0.0, 0.0), (10.04, 5.0)], Rgb(1, 2, 3), 1.5)
        });
        canvas.group(&[("class", "empty")], |_| Ok(()));
        let svg = canvas.finish("t", "d").unwrap_or_default();
        assert!(svg.contains("<g stroke-dasharray=\"3 2\">"), "{svg}");
        assert!(svg.contains("points=\"0,0 100,50\""), "{svg}");
        assert!(!svg.contains("empty"), "{svg}");
    }

    #[test]
    fn a_failure_is_kept_and_told() {
        let mut canvas = Canvas::new(10.0, 10.0);
        canvas.group(&[], |_| Err("first".into()));
        canvas.group(&[], |_| Err("second".into()));
        let told = canvas.finish("t", "").err().map(|e| e.to_string());
        assert_eq!(told.as_deref(), Some("figure `t` cannot be drawn: first"));
    }
}
