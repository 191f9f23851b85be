//! A page as one self-contained HTML file. The frame around its sections is in `page.html` and `page.css`.

use crate::render::marked_text::{paragraphs, to_html};
use crate::render::page::contents::check;
use crate::render::page::walk::{Group, Walk, Writer};
use crate::render::page::{Callout, Figure, Page, Section, shown_rows};
use crate::render::table::{Mood, Table};
use crate::render::{RenderError, escape, palette};
use minijinja::value::Serde;
use minijinja::{Environment, Value};
use serde_json::json;
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// Sorts and filters tables; the page is whole without it.
const SCRIPT: &str = include_str!("page.js");

/// The page as one HTML file that needs nothing else.
///
/// # Errors
/// If a name is unusable or used twice, a table is ragged, or a figure cannot be drawn.
pub fn render_html(page: &Page) -> Result<String, RenderError> {
    check(page)?;
    let mut sections = Html { out: String::new(), has_files: page.files.is_some() };
    Walk::page(page, &mut sections)?;
    let link = |(words, target): &(String, String)| (escape::html(words), escape::plain_html(target));
    let callout = |(mood, text): &Callout| (mood.class(), mood.mark(), marked(text).trim_end().to_owned());
    // No list where links at the top have the sections.
    let has_room = page.links.is_empty() || !page.is_wide;
    let has_contents = has_room && (2..=MOST_CONTENTS).contains(&page.sections.len());
    let entry = |section: &Section| (section.id.clone(), escape::html(&section.heading), mark(section));
    let contents = page.sections.iter().filter(|_| has_contents).map(entry);
    let facts = json!({
        "title": escape::plain_html(&page.title),
        "style": STYLE.to_owned() + &palette::dark_rules(".card"),
        "wide": if page.is_wide { " wide" } else { "" },
        "links": page.links.iter().map(link).collect::<Vec<_>>(),
        "heading": escape::html(&page.title),
        "lead": marked(&page.lead),
        "callout": page.callout.as_ref().map(callout),
        "contents": contents.collect::<Vec<_>>(),
        "filter": page.filter.as_deref().map(escape::plain_html),
        "sections": sections.out,
        "footer": marked(&page.footer),
        "script": SCRIPT,
    });
    Ok(Environment::new().render_str(TEMPLATE, Value::from(Serde(facts)))? + "\n")
}

/// Sections that a list of contents may have: a longer one hides the page on a phone.
const MOST_CONTENTS: usize = 20;

fn mark(section: &Section) -> String {
    let marked = |mood: Mood| format!(" <span class=\"{}\">{}</span>", mood.class(), mood.mark());
    section.mood.map(marked).unwrap_or_default()
}

/// The paragraphs of a lightly marked text.
fn marked(text: &str) -> String {
    paragraphs(text).iter().fold(String::new(), |out, paragraph| out + "<p>" + &to_html(paragraph) + "</p>\n")
}

struct Html {
    out: String,
    /// Whether the page links to its tables and figures as files.
    has_files: bool,
}

impl<'a> Writer<'a> for Html {
    fn paragraph(&mut self, text: &'a str) {
        self.out += &marked(text);
    }

    fn code(&mut self, lines: &'a str) {
        let _ = writeln!(self.out, "<pre><code>{}</code></pre>", escape::plain_html(lines));
    }

    fn heading(&mut self, words: &'a str) {
        let _ = writeln!(self.out, "<h3>{}</h3>", escape::html(words));
    }

    fn list(&mut self, points: &'a [String]) {
        self.out += "<ul>\n";
        for point in points {
            let _ = writeln!(self.out, "<li>{}</li>", to_html(&paragraphs(point).join(" ")));
        }
        self.out += "</ul>\n";
    }

    /// A table with a link to its file.
    fn table(&mut self, table: &'a Table, file: Option<String>) -> Result<(), RenderError> {
        let (shown, rest) = shown_rows(table, file.as_deref());
        self.out += &shown.to_html()?;
        self.out += &rest.map(|rest| marked(&rest)).unwrap_or_default();
        if let Some(file) = file {
            let _ = writeln!(self.out, "<p class=\"files\"><a href=\"tables/{file}.csv\">CSV</a></p>");
        }
        Ok(())
    }

    /// A figure with its number, caption and links to its files.
    fn figure(&mut self, figure: &'a Figure, number: Option<usize>) -> Result<(), RenderError> {
        let number = number.map_or(String::new(), |number| format!("<b>Figure {number}.</b> "));
        let (name, svg) = (&figure.name, figure.svg()?);
        let files = if self.has_files {
            let svg = format!("<a href=\"figures/{name}.svg\">SVG</a>");
            format!(" <span class=\"files\">{svg} <a href=\"figures/{name}.csv\">data</a></span>")
        } else {
            String::new()
        };
        // No screen makes a figure larger than it was meant to be.
        let width = natural_width(svg);
        let own = width.map_or(String::new(), |width| format!(" style=\"--own: {width}px\""));
        // A figure of several panels beside another would have letters that nobody reads.
        let whole = if width.is_some_and(|width| width > WIDEST_BESIDE) { " class=\"whole\"" } else { "" };
        let narrow = figure.narrow_svg()?.map(|svg| format!("<div class=\"card narrow\">{svg}</div>\n"));
        let (wide, narrow) = (if narrow.is_some() { " wide" } else { "" }, narrow.unwrap_or_default());
        let caption =
            paragraphs(&figure.caption).iter().map(|text| to_html(text)).collect::<Vec<_>>().join("<br>");
        let _ = write!(
            self.out,
            "<figure{whole} id=\"figure-{name}\">\n<div class=\"card{wide}\"{own}>{svg}</div>\n{narrow}\
             <figcaption>{number}{caption}{files}</figcaption>\n</figure>\n",
        );
        Ok(())
    }

    fn open(&mut self, group: &Group<'a>) -> bool {
        let out = &mut self.out;
        let _ = match group {
            Group::Section(section) => {
                let (id, heading, mark) = (&section.id, escape::html(&section.heading), mark(section));
                writeln!(
                    out,
                    "<section id=\"{id}\">\n<h2>{heading}{mark}<a class=\"anchor\" href=\"#{id}\" \
                     aria-label=\"Link to this section\">#</a></h2>"
                )
            }
            Group::Row => writeln!(out, "<div class=\"row\">"),
            Group::Beside => writeln!(out, "<div class=\"beside\">"),
            Group::Main => writeln!(out, "<div>"),
            Group::Aside => writeln!(out, "<aside>"),
            Group::Switch(number, words) => {
                out.push_str("<div class=\"switch\">\n");
                words.iter().enumerate().try_for_each(|(place, word)| {
                    let (id, on) =
                        (format!("view-{number}-{place}"), if place == 0 { " checked" } else { "" });
                    writeln!(
                        out,
                        "<input type=\"radio\" name=\"view-{number}\" id=\"{id}\"{on}><label for=\"{id}\">{}</label>",
                        escape::html(word)
                    )
                })
            }
            // Where all views are shown, as on paper, each has its word.
            Group::View(_, word) => writeln!(out, "<div>\n<p class=\"view\">{}</p>", escape::html(word)),
            Group::Details(summary) => {
                writeln!(out, "<details>\n<summary>{}</summary>", escape::html(summary))
            }
        };
        true
    }

    fn close(&mut self, group: &Group<'a>) {
        self.out += match group {
            Group::Section(_) => "</section>\n",
            Group::Aside => "</aside>\n",
            Group::Details(_) => "</details>\n",
            _ => "</div>\n",
        };
    }
}

/// The widest figure that stands beside another, px.
const WIDEST_BESIDE: f64 = 600.0;

/// The width that an SVG document gives itself, in pixels.
fn natural_width(svg: &str) -> Option<f64> {
    let (head, _) = svg.split_once('>')?;
    let (_, after) = head.split_once(" width=\"")?;
    after.split_once('"')?.0.parse().ok().filter(|width: &f64| width.is_finite())
}
