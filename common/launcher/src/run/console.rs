//! Standard error: our own remarks and the output of the nodes, each line whole
//! and marked with who said it. Standard output is left to the poses. What the
//! launcher remarks while it is in the graph is sent there, too, on topic `log`.

use std::{
    io::{self, BufRead, BufReader, Read, Write},
    sync::mpsc::Sender,
    thread,
};

use messages::LogLevel;
use transport::log_in_graph;

/// Longer lines are broken, so that a node which never ends its line cannot
/// fill our memory.
const MAX_LINE_BYTES: u64 = 1 << 16;

/// As whom the launcher speaks.
pub const LAUNCHER: &str = "backcast";

/// What the launcher does, on the console and in the graph's log.
pub fn note(line: &str) {
    say(LAUNCHER, line);
    log_in_graph(LogLevel::Info, line);
}

/// What the launcher does not like, on the console and in the graph's log.
pub fn warn(line: &str) {
    say(LAUNCHER, line);
    log_in_graph(LogLevel::Warn, line);
}

/// Writes a line. A standard error that is closed is nobody's loss but its own.
pub fn say(who: &str, line: &str) {
    let text = format!("{who:>18} | {line}\n");
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Passes on what `stream` says, on a thread of its own, until its end, to `also`, too; drops
/// `open` then.
///
/// # Errors
/// The thread cannot be started.
pub fn forward(
    who: &str,
    stream: impl Read + Send + 'static,
    open: Sender<()>,
    also: impl Fn(&str) + Send + 'static,
) -> io::Result<()> {
    let who = who.to_owned();
    let body = move || {
        // A pipe that cannot be read is at its end for us.
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

/// Calls for each line without its end; bytes that are not UTF-8 are replaced.
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
