//! SVG as a backend of the plotting library: its shapes as elements, its text with subscripts and
//! superscripts, and groups with attributes of their own, which the library does not know.
use crate::render::escape::plain_html;
use crate::render::script::{ScriptLevel, runs};
use plotters_backend::text_anchor::HPos;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};
use std::fmt::{self, Write};

/// Where the pen of a subscript stands below the line, and where it climbs back from there, in font sizes.
const SUBSCRIPT: [&str; 2] = ["0.28em", "-0.202em"];
/// The same of a superscript.
const SUPERSCRIPT: [&str; 2] = ["-0.5em", "0.36em"];

/// Width of a space, in font sizes.
const SPACE: f64 = 0.3;

type SvgWritten = Result<(), DrawingErrorKind<fmt::Error>>;

/// The elements of a document in the making.
pub(crate) struct SvgBackend {
    size: (u32, u32),
    elements: String,
}

impl SvgBackend {
    pub fn new(size: (u32, u32)) -> Self {
        Self { size, elements: String::new() }
    }

    /// What was drawn so far.
    pub fn elements(&self) -> &str {
        &self.elements
    }

    /// Opens a group with attributes; what it takes to close it.
    pub fn open_group(&mut self, attributes: &[(&str, &str)]) -> OpenGroup {
        let start = self.elements.len();
        self.elements.push_str("<g");
        for (name, value) in attributes {
            self.attribute(name, plain_html(value));
        }
        self.elements.push_str(">\n");
        OpenGroup { start, inside: self.elements.len() }
    }

    /// Closes a group; one without elements leaves no trace.
    pub fn close_group(&mut self, group: &OpenGroup) {
        if self.elements.len() == group.inside {
            self.elements.truncate(group.start);
        } else {
            self.elements.push_str("</g>\n");
        }
    }

    fn attribute(&mut self, name: &str, value: impl fmt::Display) {
        let _ = write!(self.elements, " {name}=\"{value}\"");
    }

    /// Opacity, where not everything beneath is hidden.
    fn opacity(&mut self, colour: BackendColor) {
        if colour.alpha < 1.0 {
            self.attribute("opacity", colour.alpha);
        }
    }

    /// The colour of an area, or of an outline of some width.
    fn paint(&mut self, style: &impl BackendStyle, is_area: bool) {
        self.opacity(style.color());
        self.attribute("fill", if is_area { hexadecimal(style.color()) } else { "none".to_owned() });
        if !is_area {
            self.attribute("stroke", hexadecimal(style.color()));
            self.attribute("stroke-width", style.stroke_width());
        }
    }

    /// A line or an area through points.
    fn corners(
        &mut self,
        element: &str,
        path: impl IntoIterator<Item = BackendCoord>,
        style: &impl BackendStyle,
        is_area: bool,
    ) {
        self.elements.push_str(element);
        self.paint(style, is_area);
        let points: Vec<String> = path.into_iter().map(|(x, y)| format!("{x},{y}")).collect();
        self.attribute("points", points.join(" "));
        self.elements.push_str("/>\n");
    }
}

/// Where a group begins, and where its elements do.
pub(crate) struct OpenGroup {
    start: usize,
    inside: usize,
}

impl DrawingBackend for SvgBackend {
    type ErrorType = fmt::Error;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> SvgWritten {
        Ok(())
    }

    fn present(&mut self) -> SvgWritten {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> SvgWritten {
        self.draw_rect((x, y), (x + 1, y + 1), &colour, true)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        is_area: bool,
    ) -> SvgWritten {
        self.elements.push_str("<rect");
        for (name, value) in [("x", left), ("y", top), ("width", right - left), ("height", bottom - top)] {
            self.attribute(name, value);
        }
        self.paint(style, is_area);
        self.elements.push_str("/>\n");
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> SvgWritten {
        self.corners("<polyline", path, style, false);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> SvgWritten {
        self.corners("<polygon", path, style, true);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        is_area: bool,
    ) -> SvgWritten {
        let _ = write!(self.elements, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"");
        self.paint(style, is_area);
        self.elements.push_str("/>\n");
        Ok(())
    }

    /// Text whose base line runs through the place, whatever vertical anchor the style names.
    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> SvgWritten {
        let _ = write!(self.elements, "<text x=\"{x}\" y=\"{y}\"");
        match style.anchor().h_pos {
            HPos::Left => {}
            HPos::Center => self.attribute("text-anchor", "middle"),
            HPos::Right => self.attribute("text-anchor", "end"),
        }
        self.attribute("font-size", style.size());
        self.opacity(style.color());
        self.attribute("fill", hexadecimal(style.color()));
        if matches!(style.style(), FontStyle::Bold) {
            self.attribute("font-weight", "bold");
        }
        if matches!(style.transform(), FontTransform::Rotate270) {
            self.attribute("transform", format_args!("rotate(270, {x}, {y})"));
        }
        let _ = writeln!(self.elements, ">{}</text>", with_scripts(text));
        Ok(())
    }
}

fn hexadecimal(colour: BackendColor) -> String {
    let (red, green, blue) = colour.rgb;
    format!("#{red:02X}{green:02X}{blue:02X}")
}

/// The text with a span for each of its scripts, and for what follows one back on the line.
fn with_scripts(text: &str) -> String {
    let span = |attributes: String, words: &str| format!("<tspan {attributes}>{words}</tspan>");
    let climb = |back: &str, words: &str| span(format!("dy=\"{back}\""), words);
    // White space at the start of a span is lost to some readers: the pen moves by as much.
    let climb_on = |back: &str, text: &str| {
        let spaces = text.chars().take_while(|c| *c == ' ').count();
        let shift = format!("{}em", SPACE * spaces as f64);
        let moved = if spaces > 0 { format!("dx=\"{shift}\" ") } else { String::new() };
        span(format!("{moved}dy=\"{back}\""), &plain_html(&edges_kept(&text[spaces..])))
    };
    let mut out = String::new();
    let mut way_back = None;
    for run in runs(text) {
        let words = plain_html(&edges_kept(&run.text));
        let [shift, back] = match run.level {
            ScriptLevel::Base => {
                out += &way_back.take().map_or_else(|| words.clone(), |back| climb_on(back, &run.text));
                continue;
            }
            ScriptLevel::Sub => SUBSCRIPT,
            ScriptLevel::Super => SUPERSCRIPT,
        };
        // A script right after another: climb back with a space of no width.
        out += &way_back.map_or_else(String::new, |back| climb(back, "\u{200b}"));
        out += &span(format!("dy=\"{shift}\" font-size=\"0.72em\""), &words);
        way_back = Some(back);
    }
    out
}

/// White space at the edge of a span would be lost.
fn edges_kept(text: &str) -> String {
    let start = text.len() - text.trim_start_matches(' ').len();
    let inner = text.trim_matches(' ');
    let end = text.len() - start - inner.len();
    format!("{}{inner}{}", "\u{a0}".repeat(start), "\u{a0}".repeat(end))
}
