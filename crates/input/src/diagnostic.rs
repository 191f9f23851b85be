//! Messages on mistakes in a study file: what is wrong, where, and what would be right.

use crate::nearest::nearest;
use crate::synonyms::usual_word;
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::fmt;
use std::ops::Range;

/// Width of a rendered diagnostic: fixed, so that output does not depend on the terminal.
const RENDER_WIDTH: usize = 110;
/// Longest message, and longest help, letters.
const LONGEST_MESSAGE: usize = 2000;
/// Names that are listed where none is near.
const MOST_LISTED: usize = 12;

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong, a sentence without its full stop.
    pub message: String,
    /// Bytes of the source it is about.
    pub span: Option<Range<usize>>,
    /// What would be right.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A diagnostic at a place.
    pub fn at(span: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { message: message.into(), span: Some(span), help: Some(help.into()) }
    }
}

/// A study that cannot run: every diagnostic, with the source they point into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudyError {
    /// File name, or what stands for it.
    pub name: String,
    /// Text of the study.
    pub source: String,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
}

impl std::error::Error for StudyError {}

impl fmt::Display for StudyError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rendered: Vec<String> =
            self.diagnostics.iter().map(|one| one.render(Level::ERROR, &self.name, &self.source)).collect();
        out.write_str(&rendered.join("\n"))
    }
}

impl Diagnostic {
    /// The diagnostic as a warning about a source, with which the study still runs.
    pub fn warning(&self, name: &str, source: &str) -> String {
        self.render(Level::WARNING, name, source)
    }

    fn render(&self, level: Level<'_>, name: &str, source: &str) -> String {
        let message = bounded(&self.message, LONGEST_MESSAGE);
        let title = level.primary_title(message);
        let mut group = match &self.span {
            Some(span) => title.element(
                Snippet::source(source)
                    .path(name)
                    .annotation(AnnotationKind::Primary.span(inside(source, span))),
            ),
            None => title.element(annotate_snippets::Origin::path(name)),
        };
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(bounded(help, LONGEST_MESSAGE)));
        }
        let renderer = Renderer::plain().term_width(RENDER_WIDTH).decor_style(DecorStyle::Ascii);
        renderer.render(&[group])
    }
}

/// The beginning of a text.
fn bounded(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// A span held inside a source, on character boundaries and within the line in which it begins.
fn inside(source: &str, span: &Range<usize>) -> Range<usize> {
    let floor = |index: usize| {
        let boundaries = (0..=index.min(source.len())).rev();
        boundaries.into_iter().find(|index| source.is_char_boundary(*index)).unwrap_or(0)
    };
    let start = floor(span.start);
    let line = source[start..].find('\n').map_or(source.len(), |end| start + end);
    start..floor(span.end).clamp(start, line)
}

/// The candidate that a word was probably meant to be.
pub(crate) fn near_word<'a>(word: &str, candidates: &[&'a str]) -> Option<&'a str> {
    usual_word(word, candidates).or_else(|| nearest(word, candidates.iter().copied()))
}

/// Help for a word that is not among the candidates.
pub fn one_of(word: &str, candidates: &[&str]) -> String {
    match near_word(word, candidates) {
        Some(near) if candidates.len() > MOST_LISTED => {
            format!("did you mean `{near}`? `oedometer list` has all {}", candidates.len())
        }
        None if candidates.len() > MOST_LISTED => {
            let some = listed(&candidates[..MOST_LISTED]);
            format!("it can be {some}, …: `oedometer list` has all {}", candidates.len())
        }
        Some(near) => format!("did you mean `{near}`? It can be {}", listed(candidates)),
        None => format!("it can be {}", listed(candidates)),
    }
}

/// Words in a row, quoted.
fn listed(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagnostic_shows_file_line_and_caret() {
        let source = "title = \"x\"\nporosty = 0.3\n".to_owned();
        let diagnostics = vec![Diagnostic::at(12..19, "unknown key `porosty`", "did you mean `porosity`?")];
        let error = StudyError { name: "a.toml".to_owned(), source, diagnostics };
        let text = error.to_string();
        assert!(text.contains("a.toml:2:1"), "{text}");
        assert!(text.contains("^^^^^^^"), "{text}");
        assert!(text.contains("did you mean `porosity`?"), "{text}");
    }

    #[test]
    fn a_line_of_a_million_letters_is_quoted_in_part_with_its_place() {
        let long = "s".repeat(1_000_000);
        for (before, place) in
            [("", "a.toml:3:1"), ("key = ", "a.toml:3:7"), (&long[..5000], "a.toml:3:5001")]
        {
            let source = format!("title = 1\n\n{before}ζ{long}\nrest = 2\n");
            let start = 11 + before.len();
            for span in [start..start + 3, start..source.len()] {
                let diagnostics = vec![Diagnostic::at(span, format!("odd `{long}`"), long.clone())];
                let error = StudyError { name: "a.toml".to_owned(), source: source.clone(), diagnostics };
                let told = error.to_string();
                assert!(told.contains(place) && told.contains('^') && told.contains('ζ'), "{told}");
                assert!(told.len() < 6000, "{} letters", told.len());
                let quoted = told.lines().find(|line| line.contains('ζ')).expect("the line");
                assert!(quoted.len() < 230, "{quoted}");
            }
        }
    }

    #[test]
    fn a_span_beyond_the_text_or_inside_a_letter_does_no_harm() {
        let error = StudyError {
            name: "a.toml".to_owned(),
            source: "ζ = 1".to_owned(),
            diagnostics: vec![Diagnostic::at(1..99, "odd", "none")],
        };
        assert!(error.to_string().contains("odd"));
    }

    #[test]
    fn the_nearest_name_is_near_or_none() {
        assert_eq!(nearest("porosty", ["porosity", "height"]), Some("porosity"));
        assert_eq!(nearest("gc-sri-patch", ["GIMP", "GC-SRI-patch"]), Some("GC-SRI-patch"));
        assert_eq!(nearest("zzz", ["porosity", "height"]), None);
    }

    #[test]
    fn a_name_is_near_from_three_letters_in_five_on() {
        assert_eq!(nearest("abcde", ["uvwxy", "abcxy", "zzzzz"]), Some("abcxy"));
        assert_eq!(nearest("abcde", ["abwxy"]), None);
        assert_eq!(nearest("abcde", ["abcdx", "abcxy"]), Some("abcdx"));
        assert_eq!(nearest("abcde", ["abcxy", "abcdx"]), Some("abcdx"));
    }

    #[test]
    fn a_dozen_names_are_listed_and_of_more_there_is_the_beginning_and_where_all_are() {
        let names: Vec<String> = ('a'..='m').map(|letter| letter.to_string().repeat(4)).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let dozen =
            "`aaaa`, `bbbb`, `cccc`, `dddd`, `eeee`, `ffff`, `gggg`, `hhhh`, `iiii`, `jjjj`, `kkkk`, `llll`";
        for (word, count, told) in [
            ("zzzz", 1, "it can be `aaaa`".to_owned()),
            ("aaaz", 1, "did you mean `aaaa`? It can be `aaaa`".to_owned()),
            ("zzzz", 12, format!("it can be {dozen}")),
            ("bbzb", 12, format!("did you mean `bbbb`? It can be {dozen}")),
            ("zzzz", 13, format!("it can be {dozen}, …: `oedometer list` has all 13")),
            ("mmzm", 13, "did you mean `mmmm`? `oedometer list` has all 13".to_owned()),
        ] {
            assert_eq!(one_of(word, &names[..count]), told, "{word} of {count}");
        }
    }
}
