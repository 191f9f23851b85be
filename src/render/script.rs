//! Text with subscripts and superscripts, so that `T_v`, `10⁻³` and `m²` look right in every font.
//!
//! A single letter, an underscore and letters or digits is a symbol with a subscript (`K_w`,
//! `Δt_crit`, `L_∞`); `points_per_cell` is a name and stays as it is. Unicode superscripts and
//! subscripts are taken apart, because few fonts hold all of them.

/// The level of a piece of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ScriptLevel {
    Base,
    Sub,
    Super,
}

/// A piece of text on one level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ScriptRun {
    pub level: ScriptLevel,
    pub text: String,
}

/// Splits a text into runs of one level. Characters that no document may hold are dropped.
pub(crate) fn runs(text: &str) -> Vec<ScriptRun> {
    let chars: Vec<char> = text.chars().filter(|&c| is_allowed(c)).collect();
    let mut out = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let c = chars[i];
        if let Some((line, end)) = subscript_at(&chars, i) {
            chars[i..line].iter().for_each(|&c| push(&mut out, ScriptLevel::Base, c));
            chars[line + 1..end].iter().for_each(|&c| push(&mut out, ScriptLevel::Sub, c));
            i = end;
            continue;
        }
        match (superscript(c), subscript(c)) {
            (Some(s), _) => push(&mut out, ScriptLevel::Super, s),
            (_, Some(s)) => push(&mut out, ScriptLevel::Sub, s),
            _ => push(&mut out, ScriptLevel::Base, c),
        }
        i += 1;
    }
    out
}

/// Whether a document may hold the character.
fn is_allowed(c: char) -> bool {
    !(c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}'))
}

fn push(out: &mut Vec<ScriptRun>, level: ScriptLevel, c: char) {
    match out.last_mut() {
        Some(run) if run.level == level => run.text.push(c),
        _ => out.push(ScriptRun { level, text: c.to_string() }),
    }
}

/// The places of the underscore of a symbol at `i` and of the end of its subscript.
fn subscript_at(chars: &[char], i: usize) -> Option<(usize, usize)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    // A difference is a symbol too.
    let start = if i > 0 && chars[i - 1] == 'Δ' { i - 1 } else { i };
    let alone = start == 0 || !is_word(chars[start - 1]);
    let prime = usize::from(chars.get(i + 1) == Some(&'\''));
    let line = i + 1 + prime;
    if !alone || !chars[i].is_alphabetic() || chars.get(line) != Some(&'_') {
        return None;
    }
    let tail = chars[line + 1..].iter().take_while(|&&c| belongs(c)).count();
    let end = line + 1 + tail;
    (tail > 0 && chars.get(end) != Some(&'_')).then_some((line, end))
}

fn belongs(c: char) -> bool {
    (c.is_alphanumeric() && superscript(c).is_none()) || c == '∞'
}

/// Characters that Unicode has above the line, and the same upon it.
const ABOVE: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺ⁿ";
const ON_THE_LINE: &str = "0123456789−+n";

/// The character on the line of a Unicode superscript.
fn superscript(c: char) -> Option<char> {
    if c.is_ascii() {
        return None; // Nearly every character: not worth a search.
    }
    let at = ABOVE.chars().position(|one| one == c)?;
    ON_THE_LINE.chars().nth(at)
}

fn subscript(c: char) -> Option<char> {
    let digit = u32::from(c).checked_sub(0x2080)?;
    char::from_digit(digit, 10)
}

/// A whole number as a Unicode superscript.
pub(crate) fn exponent(n: i32) -> String {
    let raised = |c: char| {
        let at = ON_THE_LINE.chars().position(|one| one == c)?;
        ABOVE.chars().nth(at)
    };
    n.to_string().replace('-', "−").chars().filter_map(raised).collect()
}

/// An upper estimate of the width of `text`, in units of the font size.
///
/// The advances are those of `DejaVu Sans`, the widest of the fonts that a reader may have.
pub(crate) fn width(text: &str) -> f64 {
    runs(text)
        .iter()
        .map(|run| {
            let scale = if run.level == ScriptLevel::Base { 1.0 } else { 0.72 };
            scale * run.text.chars().map(advance).sum::<f64>()
        })
        .sum()
}

fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | 'J' | '\'' => 0.295,
        ' ' | '.' | ',' | ':' | ';' | '/' | '|' | '·' | '\u{2009}' => 0.337,
        'f' | 'r' | 't' | '-' | '(' | ')' | '[' | ']' => 0.41,
        'c' | 's' | 'z' | '_' | '*' => 0.55,
        'm' | 'M' | 'w' | 'W' | '%' | '@' | '—' => 0.98,
        '=' | '+' | '<' | '>' | '−' | '×' | '≤' | '≥' | '≈' | '∞' | '#' | '~' | '–' => 0.838,
        'O' | 'Q' | 'G' | 'D' | 'N' | 'H' | 'U' | '&' => 0.787,
        'a'..='z' | '0'..='9' => 0.636,
        'A'..='Z' => 0.7,
        c if c.is_ascii() => 0.6,
        c if u32::from(c) >= 0x2e80 => 1.05,
        _ => 0.75,
    }
}

/// Breaks `text` at spaces into lines of at most `limit` font sizes; a longer word stays whole.
pub(crate) fn wrap(text: &str, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line) + width(" ") + width(word) <= limit => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spelled(text: &str) -> String {
        runs(text)
            .into_iter()
            .map(|run| match run.level {
                ScriptLevel::Base => run.text,
                ScriptLevel::Sub => format!("<{}>", run.text),
                ScriptLevel::Super => format!("^{}^", run.text),
            })
            .collect()
    }

    #[test]
    fn symbols_get_subscripts_and_names_do_not() {
        assert_eq!(spelled("T_v = 0.1"), "T<v> = 0.1");
        assert_eq!(spelled("K_w/E_oed"), "K<w>/E<oed>");
        assert_eq!(spelled("points_per_cell"), "points_per_cell");
        assert_eq!(spelled("a_b_c"), "a_b_c");
        assert_eq!(spelled("L_∞"), "L<∞>");
        assert_eq!(spelled("x_"), "x_");
        assert_eq!(spelled("p_exact²"), "p<exact>^2^");
        assert_eq!(spelled("Δt_crit, σ'_yy"), "Δt<crit>, σ'<yy>");
    }

    #[test]
    fn unicode_scripts_are_taken_apart() {
        assert_eq!(spelled("2·10⁻³ m²"), "2·10^−3^ m^2^");
        assert_eq!(spelled("E₀"), "E<0>");
        assert_eq!(exponent(-12), "⁻¹²");
    }

    #[test]
    fn forbidden_characters_are_dropped() {
        assert_eq!(spelled("a\u{0}b\u{fffe}c\n"), "abc");
    }

    #[test]
    fn wrapping_keeps_every_word() {
        let lines = wrap("one two three four", 5.0);
        assert!(lines.len() > 1);
        assert_eq!(lines.join(" "), "one two three four");
        assert_eq!(wrap("", 5.0), Vec::<String>::new());
        // Three letters of 0.636, and a space of 0.337 between two words.
        let near = |text: &str, wanted: f64| (width(text) - wanted).abs() < 1e-12;
        assert!(near("abd", 1.908) && near("T_v", 0.7 + 0.72 * 0.636) && near("abd abd", 4.153));
        assert_eq!(wrap("abd abd", 4.16), ["abd abd"]);
        assert_eq!(wrap("abd abd", 4.15), ["abd", "abd"]);
    }
}
