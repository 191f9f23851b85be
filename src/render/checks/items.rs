//! Paragraphs of a terminal's width, and tables that are too wide for it as a list of items.

use crate::render::table::{Cell, Table};

/// Columns of a terminal.
const WIDTH: usize = 80;
/// A text in lines that fit a terminal; a longer word stays whole.
pub(crate) fn wrapped(text: &str, first: &str, others: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut line = first.to_owned();
    let mut is_empty = true;
    for word in text.split_whitespace() {
        if !is_empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(std::mem::replace(&mut line, others.to_owned()));
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.extend(word.chars().filter(|c| !c.is_control()));
        is_empty = false;
    }
    lines.push(line);
    lines.join("\n") + "\n"
}

/// A subject, and below it what is said of it.
pub(crate) fn item(subject: &str, words: &str) -> String {
    wrapped(subject, "  ", "    ") + &wrapped(words, "    ", "    ")
}

/// A table that is wider than a terminal as items: the first cell of a row, and below it the others with their headings.
pub(crate) fn items_of(table: &Table) -> String {
    let mut text = format!("\n{}\n", table.title);
    for row in &table.rows {
        let Some((subject, others)) = row.split_first() else { continue };
        let others = table.columns.iter().skip(1).zip(others).map(|(column, cell)| match cell {
            Cell::Missing(why) => format!("no {}: {why}", column.heading()),
            cell => format!("{} {}", column.heading(), cell.show()),
        });
        text += &item(&subject.show(), &others.collect::<Vec<_>>().join("; "));
    }
    for note in &table.notes {
        text += &wrapped(&format!("({note})"), "  ", "  ");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::table::columns;

    #[test]
    fn lines_fit_a_terminal_and_lose_no_word() {
        let text = "order 1.01 outside 1.90 … 2.10, ".repeat(20);
        let lines = wrapped(&text, "  ", "    ");
        assert!(lines.lines().count() > 5 && lines.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(lines.starts_with("  order") && lines.lines().skip(1).all(|line| line.starts_with("    ")));
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&lines), words(&text));
        let long = "x".repeat(100);
        assert_eq!(wrapped(&long, "", "  "), format!("{long}\n"), "a name stays whole");
        assert_eq!(wrapped("a\u{1b}[31m", "", ""), "a[31m\n", "nothing steers the terminal");
    }

    #[test]
    fn a_wide_table_becomes_items_that_lose_nothing() {
        let rows = [vec!["a value".into(), Cell::Count(5), Cell::missing("fewer than four levels")]];
        let table =
            Table::of("values", columns("value | > levels | > least squares"), rows).note("of a study");
        let text = items_of(&table);
        for part in
            ["values", "a value", "levels 5", "no least squares: fewer than four levels", "(of a study)"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
    }
}
