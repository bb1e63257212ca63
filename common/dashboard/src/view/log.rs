//! Log lines of the nodes.

use messages::{LogHeader, LogLevel};
use serde::Serialize;

pub(crate) const MAX_LINES: usize = 200;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct LogLine {
    node: String,
    /// Identifies a line, together with the counter.
    pid: u32,
    counter: u64,
    level: &'static str,
    /// In seconds since 1970.
    at_s: f64,
    text: String,
}

impl LogLine {
    pub(crate) fn new(header: &LogHeader, text: &[u8]) -> Self {
        LogLine {
            node: header.node.as_str().to_owned(),
            pid: header.pid,
            counter: header.counter,
            level: match LogLevel::from_code(header.level) {
                Some(LogLevel::Debug) => "debug",
                Some(LogLevel::Info) | None => "info",
                Some(LogLevel::Warn) => "warn",
                Some(LogLevel::Error) => "error",
            },
            at_s: header.wall_ns as f64 / 1e9,
            text: String::from_utf8_lossy(text).into_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::Name;

    use super::*;

    #[test]
    fn a_line_is_kept_as_it_was_written() {
        let header = LogHeader {
            node: Name::new("accumulator"),
            wall_ns: 1_500_000_000,
            counter: 3,
            level: LogLevel::Warn as u32,
            ..LogHeader::zeroed()
        };
        let line = LogLine::new(&header, b"no \xff map");
        assert_eq!((line.counter, line.level, line.at_s), (3, "warn", 1.5));
        assert_eq!(line.text, "no \u{fffd} map");
    }
}
