//! What the plotting library cannot say: scripts in its text, and SVG without empty words.
use crate::render::script::{Level, runs};
use std::fmt::Write as _;

/// Stand-ins for the mark-up of scripts while text passes through the library.
const MARKS: [(char, &str); 5] = [
    ('\u{e000}', r#"<tspan dy="0.28em" font-size="0.72em">"#),
    ('\u{e001}', r#"<tspan dy="-0.5em" font-size="0.72em">"#),
    ('\u{e002}', r#"<tspan dy="-0.202em">"#),
    ('\u{e003}', r#"<tspan dy="0.36em">"#),
    ('\u{e004}', "</tspan>"),
];

/// The text with stand-ins for its scripts.
pub(crate) fn marked(text: &str) -> String {
    let mut out = String::new();
    let mut back: Option<char> = None;
    let all = runs(text);
    for run in &all {
        let text = edges_kept(&run.text);
        match run.level {
            Level::Base => {
                // The next base run must climb back from where the script left the pen.
                if let Some(mark) = back.take() {
                    out.push(mark);
                    out.push_str(&text);
                    out.push(MARKS[4].0);
                } else {
                    out.push_str(&text);
                }
            }
            level => {
                if let Some(mark) = back.take() {
                    // A script right after another: climb back with a space of no width.
                    out.push(mark);
                    out.push('\u{200b}');
                    out.push(MARKS[4].0);
                }
                let sub = level == Level::Sub;
                out.push(MARKS[usize::from(!sub)].0);
                out.push_str(&text);
                out.push(MARKS[4].0);
                back = Some(MARKS[if sub { 2 } else { 3 }].0);
            }
        }
    }
    out
}

/// White space at the edge of a span would be lost.
fn edges_kept(text: &str) -> String {
    let inner = text.trim_matches(' ');
    let start = text.len() - text.trim_start_matches(' ').len();
    let end = text.len() - text.trim_end_matches(' ').len();
    if inner.is_empty() {
        return "\u{a0}".repeat(start);
    }
    format!("{}{inner}{}", "\u{a0}".repeat(start), "\u{a0}".repeat(end))
}

/// Removes what says nothing, puts the scripts in, and leaves font and base line to us.
pub(crate) fn polish(svg: &str) -> String {
    let mut out = svg
        .replace(r#" opacity="1""#, "")
        .replace(r#" stroke="none""#, "")
        .replace(r#" dy="-0.5ex""#, "")
        .replace(r#" text-anchor="start""#, "")
        .replace(r#" font-family="sans-serif""#, "")
        .replace(r#" stroke-width="0""#, "")
        .replace(" \"/>", "\"/>")
        .replace(">\n<", ">\u{e005}<")
        .replace("\n</text>", "</text>");
    out = out.replace(">\n", ">").replace('\u{e005}', "\n");
    out.push('\n');
    for (mark, tag) in MARKS {
        out = out.replace(mark, tag);
    }
    whole_font_sizes(&out)
}

/// The library's division leaves sizes like 120.00000000000001.
fn whole_font_sizes(svg: &str) -> String {
    const KEY: &str = " font-size=\"";
    let mut out = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some((before, after)) = rest.split_once(KEY) {
        let (value, tail) = after.split_once('"').unwrap_or((after, ""));
        out.push_str(before);
        out.push_str(KEY);
        match value.parse::<f64>() {
            Ok(size) => {
                let _ = write!(out, "{}", size.round());
            }
            Err(_) => out.push_str(value),
        }
        out.push('"');
        rest = tail;
    }
    out.push_str(rest);
    out
}
