//! Shapes and words in pixels, drawn by the plotting library on its SVG backend.
//!
//! The library's coordinates are whole numbers, so everything is drawn ten times larger and shown
//! through the view box.
use crate::render::chart::svg_backend::SvgBackend;
use crate::render::escape::plain_html;
use crate::render::render_error::RenderError;
use plotters::coord::Shift;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::{Circle, DrawingArea, IntoFont, PathElement, Polygon, RGBAColor, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, ShapeStyle, TextStyle};
use std::cell::RefCell;
use std::rc::Rc;

/// Drawing units per pixel.
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

/// A figure in the making.
pub(crate) struct Canvas {
    size: (u32, u32),
    backend: Rc<RefCell<SvgBackend>>,
    area: DrawingArea<SvgBackend, Shift>,
    failure: Option<String>,
}

impl Canvas {
    pub fn new(width: f64, height: f64) -> Self {
        let size = (units(width).unsigned_abs(), units(height).unsigned_abs());
        let backend = Rc::new(RefCell::new(SvgBackend::new(size)));
        Self { size, area: DrawingArea::from(&backend), backend, failure: None }
    }

    /// Draws a group with attributes of its own.
    pub fn group(&mut self, attributes: &[(&str, &str)], draw: impl FnOnce(&mut Self)) {
        let group = self.backend.borrow_mut().open_group(attributes);
        draw(self);
        self.backend.borrow_mut().close_group(&group);
    }

    /// The finished SVG, named for those who cannot see it.
    pub fn finish(self, title: &str, description: &str) -> Result<String, RenderError> {
        if let Some(reason) = self.failure {
            return Err(RenderError::Draw { title: title.to_owned(), reason });
        }
        let (w, h) = self.size;
        let (title, description) = (one_line(title), one_line(description));
        Ok(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{title}\" \
             width=\"{}\" height=\"{}\" viewBox=\"0 0 {w} {h}\" font-family=\"{FONTS}\">\n\
             <title>{title}</title>\n<desc>{description}</desc>\n{}</svg>\n",
            f64::from(w) / UNIT,
            f64::from(h) / UNIT,
            self.backend.borrow().elements(),
        ))
    }

    /// The first failure is kept for [`Canvas::finish`].
    fn put<E>(&mut self, element: &E)
    where
        for<'e> &'e E: PointCollection<'e, (i32, i32)>,
        E: Drawable<SvgBackend>,
    {
        if let Err(error) = self.area.draw(element) {
            self.failure.get_or_insert(error.to_string());
        }
    }

    pub fn line(&mut self, points: &[Px], ink: impl Into<Ink>, width: f64) {
        self.put(&PathElement::new(spots(points), ink.into().style(width, false)));
    }

    pub fn polygon(&mut self, points: &[Px], ink: impl Into<Ink>) {
        self.put(&Polygon::new(spots(points), ink.into().style(0.0, true)));
    }

    pub fn rect(&mut self, corner: Px, opposite: Px, ink: impl Into<Ink>) {
        self.put(&Rectangle::new([spot(corner), spot(opposite)], ink.into().style(0.0, true)));
    }

    pub fn disc(&mut self, centre: Px, radius: f64, ink: impl Into<Ink>) {
        self.put(&Circle::new(spot(centre), units(radius), ink.into().style(0.0, true)));
    }

    /// Text whose base line runs through `at`.
    pub fn text(&mut self, text: &str, at: Px, look: Type) {
        let Rgb(r, g, b) = look.ink;
        let weight = if look.bold { FontStyle::Bold } else { FontStyle::Normal };
        let turn = if look.upright { FontTransform::Rotate270 } else { FontTransform::None };
        let hold = match look.hold {
            Hold::Start => HPos::Left,
            Hold::Middle => HPos::Center,
            Hold::End => HPos::Right,
        };
        let font = ("sans-serif", look.size * UNIT).into_font().style(weight).transform(turn);
        let ink = RGBAColor(r, g, b, 1.0);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(hold, VPos::Bottom));
        self.put(&Text::new(text.to_owned(), spot(at), style));
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

/// Text for an attribute or a title, as it is spelled.
fn one_line(text: &str) -> String {
    plain_html(&text.replace(['\n', '\t'], ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Type =
        Type { size: 12.0, ink: Rgb(0, 0, 0), bold: false, hold: Hold::Start, upright: false };

    #[test]
    fn text_is_escaped_and_scripts_become_spans() {
        let mut canvas = Canvas::new(100.0, 50.0);
        canvas.text("<b> T_v & 10⁻³ s", (1.0, 2.0), PLAIN);
        let svg = canvas.finish("a <title>", "").unwrap_or_default();
        assert!(svg.contains("&lt;b&gt; T<tspan dy=\"0.28em\" font-size=\"0.72em\">v</tspan>"), "{svg}");
        assert!(svg.contains("<tspan dx=\"0.3em\" dy=\"-0.202em\">&amp; 10</tspan>"), "{svg}");
        assert!(svg.contains(r#"font-size="120""#), "{svg}");
        assert!(svg.contains("<title>a &lt;title&gt;</title>"), "{svg}");
    }

    #[test]
    fn groups_carry_their_attributes_and_empty_ones_vanish() {
        let mut canvas = Canvas::new(100.0, 50.0);
        canvas.group(&[("stroke-dasharray", "3 2")], |canvas| {
            canvas.line(&[(0.0, 0.0), (10.04, 5.0)], Rgb(1, 2, 3), 1.5);
        });
        canvas.group(&[("class", "empty")], |_| {});
        let svg = canvas.finish("t", "d").unwrap_or_default();
        assert!(svg.contains("<g stroke-dasharray=\"3 2\">"), "{svg}");
        assert!(svg.contains("points=\"0,0 100,50\""), "{svg}");
        assert!(!svg.contains("empty"), "{svg}");
    }
}
