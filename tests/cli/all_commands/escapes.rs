//! Titles and names from anywhere: what would steer a terminal, turn a line or be computed by a spreadsheet reaches no
//! output and no file.

use crate::program::call;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Letters that do something to the text around them.
const UNSEEN: [char; 6] = ['\u{1b}', '\u{7}', '\u{202e}', '\u{2066}', '\u{9b}', '\u{2028}'];

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
}

fn clean(text: &str, whose: &str) {
    for unseen in UNSEEN {
        assert!(!text.contains(unseen), "{whose} has {unseen:?}: {text}");
    }
}

#[test]
fn what_a_title_and_a_reason_hold_reaches_no_terminal_page_or_table() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let unseen = "\\u001b[2J\\u0007\\u202e\\u2066\\u009b\\u2028";
    let study = format!(
        "title = \"=1+1 {unseen}\"\nsummary = \"@SUM(A1) {unseen}\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\
         [[sweep]]\nmethod = [\"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [4, 8]\n\
         [[expect]]\nmethod = \"GIMP\"\ntime_factor = 0.1\nat = {{ cells = 4, below = 1e-9 }}\n\
         xfail = {{ reason = \"+cmd|' /C calc'!A0 {unseen}\" }}\n"
    );
    fs::write(at.join("s.toml"), study).expect("a study");
    let calls: [&[&str]; 8] = [
        &["plan", "s.toml"],
        &["check", "s.toml", "--junit", "j.xml", "--summary", "s.md", "--annotate"],
        &["check", "s.toml", "--format", "csv"],
        &["check", "s.toml", "--format", "markdown"],
        &["report", "s.toml"],
        &["explain", "GIMP cells=4", "s.toml"],
        &["plan", "no\u{1b}[31m\u{202e}such.toml"],
        &["score", "no\u{1b}[31m\u{202e}such.csv", "--scene", "terzaghi"],
    ];
    for words in calls {
        let told = call(at, words);
        clean(&told.out, &format!("{words:?}"));
        clean(&told.err, &format!("{words:?}"));
        assert!(!told.out.is_empty() || !told.err.is_empty());
    }
    let mut seen = 0;
    for path in files_below(&at.join("report")).into_iter().chain([at.join("j.xml"), at.join("s.md")]) {
        let text = fs::read_to_string(&path).expect("text");
        clean(&text, &path.display().to_string());
        seen += usize::from(text.contains("1+1 \u{fffd}") || text.contains("calc"));
        if path.extension().is_some_and(|kind| kind == "csv") {
            let mut reader = csv::Reader::from_reader(text.as_bytes());
            let header = reader.headers().expect("a header").clone();
            let rows = reader.records().map(|row| row.expect("a row"));
            for field in std::iter::once(header)
                .chain(rows)
                .flat_map(|row| row.iter().map(str::to_owned).collect::<Vec<_>>())
            {
                let computed =
                    field.starts_with(['=', '@']) || (field.starts_with(['+', '-']) && field.contains('!'));
                assert!(!computed, "{}: {field}", path.display());
            }
        }
    }
    assert!(seen > 2, "the title is on the pages");
}
