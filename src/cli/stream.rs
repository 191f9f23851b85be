//! Writes to standard output and standard error. A reader that closes the pipe early is not a failure: the command goes
//! on to its exit code. A full device under standard output is one, because data are lost; errors of standard error are
//! ignored. Control characters that would steer a terminal are removed.

use crate::cli::exit::{Ended, Exit};
use crate::render::escape::document;
use std::fmt::Arguments;
use std::io::{ErrorKind, Result, Write};

/// Writes a line to standard error, formatted as by `format!`.
macro_rules! say {
    ($($words:tt)*) => {
        $crate::cli::stream::say_line(format_args!($($words)*))
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
    written(write_out(std::io::stdout().lock(), text))
}

/// Writes data to standard output as they are produced.
///
/// # Errors
/// Those of [`print_data`].
pub fn print_with(fill: impl FnOnce(&mut dyn Write) -> Result<()>) -> anyhow::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    written(fill(&mut out).and_then(|()| out.flush()))
}

/// Turns an error of standard output into that of the command.
///
/// # Errors
/// Those of [`print_data`].
pub fn written(result: Result<()>) -> anyhow::Result<()> {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Ended::with(Exit::CaseFailed, format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// The error of the device under a CSV writer, which shows whether the reader has gone.
pub fn of_device(error: csv::Error) -> std::io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => std::io::Error::other(format!("{other:?}")),
    }
}

/// Writes and flushes: what is left in a buffer at the end of the program is lost silently.
fn write_out(mut out: impl Write, text: &str) -> Result<()> {
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Writes a line to standard error.
pub fn say_line(words: Arguments<'_>) {
    let _ = writeln!(std::io::stderr().lock(), "{}", document(&words.to_string()));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that refuses in its own way.
    struct Device(ErrorKind);

    impl Write for Device {
        fn write(&mut self, _: &[u8]) -> Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> Result<()> {
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
        let buffered = std::io::LineWriter::new(Device(ErrorKind::StorageFull));
        assert!(write_out(buffered, "no end of line").is_err());
    }
}
