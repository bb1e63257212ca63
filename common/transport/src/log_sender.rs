//! Publishes the log lines of the process on topic `log`.

use messages::{LogHeader, LogLevel, Name, topic};

use crate::log_lines::{self, Line};
use crate::{Publisher, TransportError};

#[derive(Debug)]
pub(crate) struct LogSender {
    node: Name,
    publisher: Publisher<topic::Log>,
    sent: u64,
    /// Lines lost because shared memory was full.
    unsent: u64,
    /// Losses already reported: dropped lines, unsent lines.
    reported: (u64, u64),
}

impl LogSender {
    pub(crate) fn new(node: &str, publisher: Publisher<topic::Log>) -> Self {
        LogSender {
            node: Name::new(node),
            publisher,
            sent: 0,
            unsent: 0,
            reported: (0, 0),
        }
    }

    /// Sends the waiting lines; errors are only counted, as logging must not end a process.
    pub(crate) fn send_waiting(&mut self) {
        let mut last = None;
        log_lines::send_each(|line, dropped| {
            if self.send(&line, dropped).is_err() {
                self.unsent += 1;
            }
            last = Some((line, dropped));
        });
        let Some((line, dropped)) = last else {
            return;
        };
        let (too_fast, no_room) = (dropped - self.reported.0, self.unsent - self.reported.1);
        let why = match (too_fast, no_room) {
            (0, 0) => return,
            (_, 0) => "they arrived faster than they could be sent",
            (0, _) => "shared memory was full",
            _ => "they arrived faster than they could be sent, and shared memory was full",
        };
        let line = Line {
            level: LogLevel::Warn,
            text: format!("{} log lines were lost: {why}", too_fast + no_room),
            ..line
        };
        if self.send(&line, dropped).is_ok() {
            self.reported = (dropped, self.unsent);
        }
    }

    fn send(&mut self, line: &Line, dropped: u64) -> Result<(), TransportError> {
        let end = line.text.floor_char_boundary(LogHeader::TEXT_CAPACITY);
        let text = &line.text.as_bytes()[..end];
        let header = LogHeader {
            node: self.node,
            written_ns: line.written_ns,
            wall_ns: line.wall_ns,
            counter: self.sent,
            dropped: dropped + self.unsent,
            level: line.level as u32,
            pid: std::process::id(),
        };
        self.publisher.send(header, text)?;
        self.sent += 1;
        Ok(())
    }
}
