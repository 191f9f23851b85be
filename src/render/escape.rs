//! Text made safe for the document it goes into.
use crate::render::script::{ScriptLevel, ScriptRun, runs};

/// Text for HTML, with real subscripts and superscripts.
pub(crate) fn html(text: &str) -> String {
    runs(text)
        .into_iter()
        .map(|run| {
            let text = plain_html(&run.text);
            match run.level {
                ScriptLevel::Base => text,
                ScriptLevel::Sub => format!("<sub>{text}</sub>"),
                ScriptLevel::Super => format!("<sup>{text}</sup>"),
            }
        })
        .collect()
}

/// Text for HTML as it is spelled; also fit for attributes.
pub(crate) fn plain_html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() && c != '\n' && c != '\t' => {}
            c => out.push(c),
        }
    }
    out
}

/// Text for one line of GitHub's Markdown.
pub(crate) fn markdown(text: &str) -> String {
    let chars: Vec<char> = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let mut out = String::with_capacity(text.len());
    for (i, &c) in chars.iter().enumerate() {
        let inside_word =
            |j: Option<usize>| j.and_then(|j| chars.get(j)).is_some_and(|c| c.is_alphanumeric());
        match c {
            '\\' | '`' | '*' | '[' | ']' | '|' | '~' | '$' => out.extend(['\\', c]),
            '_' if !(inside_word(i.checked_sub(1)) && inside_word(Some(i + 1))) => {
                out.push_str("\\_");
            }
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            // At the start of a line these would make a heading or a list.
            '#' | '-' | '+' if i == 0 => out.extend(['\\', c]),
            c => out.push(c),
        }
    }
    out
}

/// Text for LaTeX with real subscripts and superscripts.
pub(crate) fn latex_text(text: &str) -> String {
    let piece = |run: ScriptRun| match run.level {
        ScriptLevel::Base => latex(&run.text),
        ScriptLevel::Sub => format!("\\textsubscript{{{}}}", latex(&run.text)),
        ScriptLevel::Super => format!("\\textsuperscript{{{}}}", latex(&run.text)),
    };
    runs(text).into_iter().map(piece).collect()
}

/// Text for LaTeX as it is spelled: what would be read as commands is escaped, symbols become mathematics.
pub(crate) fn latex(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().filter(|c| !c.is_control()) {
        match c {
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                out.push('\\');
                out.push(c);
            }
            '−' => out.push_str("$-$"),
            '±' => out.push_str("$\\pm$"),
            '×' => out.push_str("$\\times$"),
            '≤' => out.push_str("$\\le$"),
            '…' => out.push_str("\\ldots{}"),
            'σ' => out.push_str("$\\sigma$"),
            'ν' => out.push_str("$\\nu$"),
            'Δ' => out.push_str("$\\Delta$"),
            '′' => out.push_str("$'$"),
            '\u{2011}' => out.push('-'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_text_stays_text() {
        assert_eq!(
            html("<a href=\"x\">T_v & 10⁻³"),
            "&lt;a href=&quot;x&quot;&gt;T<sub>v</sub> &amp; 10<sup>−3</sup>"
        );
        assert_eq!(latex_text("T_v = 0.1 & h²"), "T\\textsubscript{v} = 0.1 \\& h\\textsuperscript{2}");
        assert_eq!(plain_html("a\u{0}'b"), "a&#39;b");
        assert_eq!(markdown("a|b *c* <i> T_v _x_"), "a\\|b \\*c\\* &lt;i&gt; T_v \\_x\\_");
        assert_eq!(markdown("# not a heading\n- nor a list"), "\\# not a heading - nor a list");
    }
}
