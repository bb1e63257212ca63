//! Log lines of the nodes.

use std::collections::VecDeque;

use messages::{LogHeader, LogLevel};
use serde::Serialize;

/// Number of lines kept for new viewers.
const CAPACITY: usize = 200;

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

/// The last lines of all nodes.
#[derive(Debug, Default)]
pub(crate) struct Log {
    lines: VecDeque<LogLine>,
}

impl Log {
    pub(crate) fn receive(&mut self, line: LogLine) {
        if self.lines.len() == CAPACITY {
            self.lines.pop_front();
        }
        self.lines.push_back(line);
    }

    /// Lines, oldest first.
    pub(crate) fn lines(&self) -> impl Iterator<Item = &LogLine> {
        self.lines.iter()
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::Name;

    use super::*;

    #[test]
    fn the_last_lines_are_kept_as_they_were_written() {
        let mut log = Log::default();
        for counter in 0..CAPACITY as u64 + 3 {
            let header = LogHeader {
                node: Name::new("accumulator"),
                wall_ns: 1_500_000_000,
                counter,
                level: LogLevel::Warn as u32,
                ..LogHeader::zeroed()
            };
            log.receive(LogLine::new(&header, b"no \xff map"));
        }
        assert_eq!(log.lines().count(), CAPACITY);
        let first = log.lines().next().unwrap();
        assert_eq!((first.counter, first.level, first.at_s), (3, "warn", 1.5));
        assert_eq!(first.text, "no \u{fffd} map");
    }
}
