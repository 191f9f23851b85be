//! What a program says: all of it is read, so that it never waits, and the end of it is kept.

use std::collections::VecDeque;
use std::io::Read;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Bytes that are kept of what a program says on one stream.
pub const KEPT_BYTES: usize = 65_536;
/// Bytes that are read at once.
const BLOCK: usize = 8192;

/// A stream that is being read.
pub struct Listener {
    kept: Arc<Mutex<VecDeque<u8>>>,
    ended: Receiver<()>,
}

impl Listener {
    /// Reads a stream to its end, in a thread of its own.
    pub fn to(mut stream: impl Read + Send + 'static) -> Self {
        let kept = Arc::new(Mutex::new(VecDeque::new()));
        let (tell, ended) = channel();
        let shared = Arc::clone(&kept);
        std::thread::spawn(move || {
            let mut block = [0; BLOCK];
            loop {
                match stream.read(&mut block) {
                    Ok(0) => break,
                    Ok(count) => keep(&shared, &block[..count]),
                    Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                    Err(_) => break,
                }
            }
            // Nobody listens any more where the program was given up.
            let _ = tell.send(());
        });
        Self { kept, ended }
    }

    /// Whether the stream comes to its end within a time: it does not while any process holds it open.
    pub fn ends_within(&self, time: Duration) -> bool {
        !matches!(self.ended.recv_timeout(time), Err(RecvTimeoutError::Timeout))
    }

    /// The end of what was said so far.
    pub fn text(&self) -> String {
        let bytes: Vec<u8> =
            self.kept.lock().map_or_else(|_| Vec::new(), |kept| kept.iter().copied().collect());
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

fn keep(shared: &Mutex<VecDeque<u8>>, block: &[u8]) {
    if let Ok(mut kept) = shared.lock() {
        kept.extend(block);
        let beyond = kept.len().saturating_sub(KEPT_BYTES);
        kept.drain(..beyond);
    }
}

/// The last lines of a text, as a person reads them: without control characters, each of a bounded length.
pub fn last_lines(text: &str, most: usize, longest: usize) -> Vec<String> {
    let plain = |line: &str| {
        let letters = line.chars().filter(|letter| !letter.is_control());
        let line: String = letters.clone().take(longest).collect();
        if letters.count() > longest { line + "…" } else { line }
    };
    let lines: Vec<String> =
        text.lines().map(|line| plain(line.trim_end())).filter(|line| !line.is_empty()).collect();
    lines[lines.len().saturating_sub(most)..].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_long_talk_is_kept_and_no_more() {
        let talk = "x".repeat(3 * KEPT_BYTES) + "the end";
        let listener = Listener::to(std::io::Cursor::new(talk));
        assert!(listener.ends_within(Duration::from_secs(60)));
        let text = listener.text();
        assert_eq!(text.len(), KEPT_BYTES);
        assert!(text.ends_with("xxthe end"));
    }

    #[test]
    fn last_lines_are_few_short_and_without_control_characters() {
        let text = "one\n\ntwo\u{1b}[31m\u{7}\n  \nthree is long\n";
        assert_eq!(last_lines(text, 2, 8), ["two[31m", "three is…"]);
        assert!(last_lines("", 3, 8).is_empty());
    }
}
