//! Writes our remarks and the nodes' output to standard error, each line whole and with its source;
//! in the graph, remarks are also published on `log`.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::sync::mpsc::Sender;
use std::thread;

use messages::LogLevel;
use transport::log_in_graph;

/// Longest line in bytes; a longer one is broken, so that it cannot fill our memory.
const MAX_LINE_BYTES: u64 = 1 << 16;

pub const LAUNCHER: &str = "backcast";

pub fn note(line: &str) {
    say(LAUNCHER, line);
    log_in_graph(LogLevel::Info, line);
}

pub fn warn(line: &str) {
    say(LAUNCHER, line);
    log_in_graph(LogLevel::Warn, line);
}

/// Writes a line. A closed standard error is ignored.
pub fn say(who: &str, line: &str) {
    let text = format!("{who:>18} | {line}\n");
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Copies the lines of `stream` to the console and `also` on a new thread, then drops `open`.
pub fn forward(
    who: &str,
    stream: impl Read + Send + 'static,
    open: Sender<()>,
    also: impl Fn(&str) + Send + 'static,
) -> io::Result<()> {
    let who = who.to_owned();
    let body = move || {
        // A read error counts as the end of the stream.
        let _ = for_each_line(stream, |line| {
            say(&who, line);
            also(line);
        });
        drop(open);
    };
    thread::Builder::new()
        .name("output".into())
        .spawn(body)
        .map(drop)
}

/// Calls `call` for each line without its newline; bytes that are not UTF-8 are replaced.
fn for_each_line(stream: impl Read, mut call: impl FnMut(&str)) -> io::Result<()> {
    let mut reader = BufReader::new(stream);
    let mut line = Vec::new();
    loop {
        line.clear();
        let length = (&mut reader)
            .take(MAX_LINE_BYTES)
            .read_until(b'\n', &mut line)?;
        if length == 0 {
            return Ok(());
        }
        let text = String::from_utf8_lossy(&line);
        call(text.trim_end_matches(['\n', '\r']));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<String> {
        let mut lines = Vec::new();
        for_each_line(bytes, |line| lines.push(line.to_owned())).unwrap();
        lines
    }

    #[test]
    fn lines_lose_their_ends_only() {
        assert_eq!(lines(b"a\n\n b\r\nlast"), ["a", "", " b", "last"]);
        assert_eq!(lines(b""), [""; 0]);
        assert_eq!(lines(b"\xff\n"), ["\u{fffd}"]);
    }

    #[test]
    fn an_endless_line_is_broken() {
        let limit = usize::try_from(MAX_LINE_BYTES).unwrap();
        let found = lines(&vec![b'x'; limit + 1]);
        assert_eq!(
            found.iter().map(String::len).collect::<Vec<_>>(),
            [limit, 1]
        );
    }
}
