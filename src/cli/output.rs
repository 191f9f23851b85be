//! What is printed: standard output and standard error, tables in their formats, and files that a user names.
//!
//! A reader that closes the pipe early is not a failure: the command goes on to its exit code. A full device under standard
//! output is one, because data are lost; errors of standard error are ignored. Control characters that would steer a
//! terminal are removed; colour is for terminals only.
//!
//! A file that a user names for a copy of the verdicts is replaced as a whole where it is a regular one; a link is followed,
//! and other targets (a terminal, a pipe, `/dev/stdout`) are appended to.

use crate::cli::exit::{Ended, Exit};
use crate::record::atomic_file::write_atomically;
use crate::render::escape::{csv_field, document};
use crate::render::table::Table;
use clap::ValueEnum;
use std::ffi::OsString;
use std::fmt::Arguments;
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Writes a line to standard error, formatted as by `format!`.
macro_rules! say {
    ($($words:tt)*) => {
        $crate::cli::output::say_line(format_args!($($words)*))
    };
}
pub(crate) use say;

/// Writes data to standard output and flushes it.
///
/// # Errors
/// When the device fails; a closed pipe is not an error.
pub fn print_data(text: &str) -> anyhow::Result<()> {
    print_as_it_is(&document(text))
}

/// Writes text to standard output with its control characters, like those of colours.
///
/// # Errors
/// Those of [`print_data`].
pub fn print_as_it_is(text: &str) -> anyhow::Result<()> {
    written(write_out(io::stdout().lock(), text))
}

/// Writes data to standard output as they are produced.
///
/// # Errors
/// Those of [`print_data`].
pub fn print_with(fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> anyhow::Result<()> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    written(fill(&mut out).and_then(|()| out.flush()))
}

/// Turns an error of standard output into that of the command.
///
/// # Errors
/// Those of [`print_data`].
pub fn written(result: io::Result<()>) -> anyhow::Result<()> {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Ended::with(Exit::CaseFailed, format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// The error of the device under a CSV writer, which shows whether the reader has gone.
pub fn of_device(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// Writes and flushes: what is left in a buffer at the end of the program is lost silently.
fn write_out(mut out: impl Write, text: &str) -> io::Result<()> {
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Writes a line to standard error.
pub fn say_line(words: Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{}", document(&words.to_string()));
}

/// Writes a document to a path.
///
/// # Errors
/// When the file system refuses, with the path.
pub fn write_document(path: &Path, text: &str) -> anyhow::Result<()> {
    let text = &document(text);
    let is_link = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink());
    let target = fs::metadata(path);
    match target {
        // A device may be this program's own output, so it is not truncated.
        Ok(metadata) if !metadata.is_file() || is_system_path(path) => {
            through(path, OpenOptions::new().append(true), text)
        }
        Ok(_) if is_link => {
            let behind = fs::canonicalize(path).map_err(|error| refused(path, &error))?;
            write_atomically(&behind, text.as_bytes()).map_err(|error| refused(path, &error))
        }
        Err(_) if is_link => through(path, OpenOptions::new().create(true).append(true), text),
        _ => write_atomically(path, text.as_bytes()).map_err(|error| refused(path, &error)),
    }
}

/// Appends text to a file.
///
/// # Errors
/// When the file system refuses, with the path.
pub fn append(path: &Path, text: &str) -> anyhow::Result<()> {
    through(path, OpenOptions::new().create(true).append(true), &document(text))
}

fn through(path: &Path, options: &OpenOptions, text: &str) -> anyhow::Result<()> {
    let written = options.open(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| refused(path, &error))
}

fn refused(path: &Path, error: &dyn std::fmt::Display) -> anyhow::Error {
    Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display()))
}

fn is_system_path(path: &Path) -> bool {
    path.starts_with("/dev") || path.starts_with("/proc")
}

/// Whether a variable of the environment is set, and not empty, `0`, `false`, `no` or `off`.
pub fn is_on(name: &str) -> bool {
    means_on(std::env::var_os(name))
}

fn means_on(value: Option<OsString>) -> bool {
    value.is_some_and(|value| {
        !["", "0", "false", "no", "off"].contains(&value.to_string_lossy().to_lowercase().as_str())
    })
}

/// The path in a variable of the environment, unless it is empty.
pub fn path_in(name: &str) -> Option<PathBuf> {
    std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SolveFormat {
    /// Text for the terminal
    Table,
    /// One row per measure or case
    Csv,
    /// Everything
    Json,
}

/// How a table is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    /// Text for the terminal
    Table,
    /// Tables in Markdown
    Markdown,
    /// Rows with all digits
    Csv,
    /// Everything
    Json,
}

/// Prints tables separated by empty lines.
pub fn print_tables(tables: &[Table], format: TableFormat) -> anyhow::Result<()> {
    let write = match format {
        TableFormat::Table => |table: &Table| table.to_text(table_width()),
        TableFormat::Markdown => Table::to_markdown,
        TableFormat::Csv => Table::to_csv,
        TableFormat::Json => |table: &Table| Ok(table.to_json().to_string()),
    };
    let text = tables.iter().map(write).collect::<Result<Vec<_>, _>>()?.join("\n");
    if format == TableFormat::Table { print_coloured(&text) } else { print_data(&text) }
}

/// A CSV of a header and rows.
pub fn csv_of<F: AsRef<[u8]>>(
    header: impl IntoIterator<Item = F>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for row in rows {
        writer.write_record(row.iter().map(|field| csv_field(field).into_owned()))?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// A value as indented JSON with a line break at the end.
pub fn json_of(value: &impl serde::Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Prints text for people, the marks of verdicts in colour.
///
/// # Errors
/// When the device fails.
pub fn print_coloured(text: &str) -> anyhow::Result<()> {
    let text = document(text);
    let is_wanted = wants_colour(io::stdout().is_terminal(), |name| std::env::var(name).ok());
    print_as_it_is(&if is_wanted { coloured(&text) } else { text.into_owned() })
}

/// The marks of verdicts in their colours.
fn coloured(text: &str) -> String {
    text.replace('✓', "\x1b[32m✓\x1b[0m").replace('✗', "\x1b[31m✗\x1b[0m")
}

/// Letters of a line of standard output: those of the terminal, or 80.
pub fn terminal_width() -> usize {
    let of_terminal = console::Term::stdout().size_checked().map(|(_, columns)| usize::from(columns));
    of_terminal.filter(|columns| *columns > 0).unwrap_or(USUAL_WIDTH)
}

/// Letters of a line where standard output is no terminal.
const USUAL_WIDTH: usize = 80;

/// Letters of the lines of a table: those of the terminal; a file or another program gets each row on one line.
pub fn table_width() -> usize {
    if io::stdout().is_terminal() { terminal_width() } else { usize::MAX }
}

/// Whether colours are wanted: on a terminal, unless `NO_COLOR` is set or the terminal is dumb.
fn wants_colour(is_terminal: bool, variable: impl Fn(&str) -> Option<String>) -> bool {
    is_terminal
        && variable("NO_COLOR").is_none_or(|value| value.is_empty())
        && variable("TERM").as_deref() != Some("dumb")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that refuses in its own way.
    struct Device(ErrorKind);

    impl Write for Device {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_who_left_is_no_error_and_a_full_device_is() {
        let end = |kind| written(write_out(Device(kind), "data"));
        assert!(end(ErrorKind::BrokenPipe).is_ok());
        let error = end(ErrorKind::StorageFull).expect_err("data are lost");
        assert!(error.to_string().starts_with("cannot write to standard output: "), "{error}");
        assert_eq!(Exit::of(&error), Exit::CaseFailed);
    }

    #[test]
    fn what_waits_in_a_buffer_is_written_before_the_end() {
        let buffered = io::LineWriter::new(Device(ErrorKind::StorageFull));
        assert!(write_out(buffered, "no end of line").is_err());
    }

    #[test]
    fn a_variable_is_on_unless_it_is_empty_or_says_off() {
        for (value, on) in [
            ("true", true),
            ("1", true),
            ("yes", true),
            ("", false),
            ("0", false),
            ("False", false),
            ("NO", false),
            ("off", false),
            ("on", true),
            ("00", true),
        ] {
            assert_eq!(means_on(Some(value.into())), on, "`{value}`");
        }
        assert!(!means_on(None));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_its_file_is_replaced_as_a_whole() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("file"), "a longer text than the new one").expect("a file");
        for (link, target) in [("link", "file"), ("dangling", "new")] {
            std::os::unix::fs::symlink(at(target), at(link)).expect("a link");
            write_document(&at(link), "new text").expect("written");
            assert!(fs::symlink_metadata(at(link)).expect("it is there").is_symlink(), "{link}");
            assert_eq!(fs::read_to_string(at(target)).expect("a file"), "new text", "{link}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_stays_a_device() {
        use std::os::unix::fs::FileTypeExt;
        write_document(Path::new("/dev/null"), "text").expect("written");
        let found = fs::metadata("/dev/null").expect("a device");
        assert!(found.file_type().is_char_device());
        let error = write_document(Path::new("/dev/full"), "text").expect_err("it is full");
        assert!(error.to_string().starts_with("cannot write /dev/full: No space left"), "{error}");
    }

    #[test]
    fn colours_are_for_terminals_that_want_them() {
        let none = |_: &str| None;
        assert!(wants_colour(true, none));
        assert!(!wants_colour(false, none));
        assert!(!wants_colour(true, |name| (name == "NO_COLOR").then(|| "1".to_owned())));
        assert!(wants_colour(true, |name| (name == "NO_COLOR").then(String::new)));
        assert!(!wants_colour(true, |name| (name == "TERM").then(|| "dumb".to_owned())));
    }

    #[test]
    fn a_mark_that_passes_is_green_and_one_that_fails_red() {
        assert_eq!(coloured("✓ a ✗ ✓"), "\x1b[32m✓\x1b[0m a \x1b[31m✗\x1b[0m \x1b[32m✓\x1b[0m");
        assert_eq!(coloured("plain"), "plain");
    }

    #[test]
    fn what_is_appended_stands_behind_what_is_there_and_what_is_written_in_its_place() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.md");
        let text = || fs::read_to_string(&path).expect("a file");
        append(&path, "one\n").expect("written");
        append(&path, "two\x1b\n").expect("written");
        assert_eq!(text(), "one\ntwo\u{fffd}\n");
        write_document(&path, "three\n").expect("written");
        assert_eq!(text(), "three\n");
        let told = append(folder.path(), "x").expect_err("a folder").to_string();
        assert!(told.starts_with(&format!("cannot write {}: ", folder.path().display())), "{told}");
        let rows = [vec!["1".to_owned(), "x, y".to_owned()], vec![String::new(), "z".to_owned()]];
        assert_eq!(csv_of(["a", "b"], rows).expect("text"), "a,b\n1,\"x, y\"\n,z\n");
    }
}
