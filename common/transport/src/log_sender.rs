//! Sends what the process logs on topic `log`.

use messages::{LogHeader, LogLevel, Name, topic};

use crate::log_lines::{self, Line};
use crate::{Publisher, TransportError};

/// The node's end of topic `log`.
#[derive(Debug)]
pub(crate) struct LogSender {
    node: Name,
    publisher: Publisher<topic::Log>,
    sent: u64,
    /// Losses that were told already.
    told: u64,
}

impl LogSender {
    pub(crate) fn new(node: &str, publisher: Publisher<topic::Log>) -> Self {
        LogSender {
            node: Name::new(node),
            publisher,
            sent: 0,
            told: 0,
        }
    }

    /// Sends the lines that wait, and a line about those that were lost.
    pub(crate) fn send_waiting(&mut self) -> Result<(), TransportError> {
        let mut last = None;
        log_lines::send_each(|line, dropped| {
            self.send(&line, dropped)?;
            last = Some((line, dropped));
            Ok(())
        })?;
        let Some((line, dropped)) = last.filter(|(_, dropped)| *dropped > self.told) else {
            return Ok(());
        };
        let lost = dropped - self.told;
        self.told = dropped;
        let line = Line {
            level: LogLevel::Warn,
            text: format!("{lost} log lines were lost: they came faster than they could be sent"),
            ..line
        };
        self.send(&line, dropped)
    }

    fn send(&mut self, line: &Line, dropped: u64) -> Result<(), TransportError> {
        let end = line.text.floor_char_boundary(LogHeader::TEXT_CAPACITY);
        let text = &line.text.as_bytes()[..end];
        let mut loan = self.publisher.loan(text.len())?;
        *loan.header_mut() = LogHeader {
            node: self.node,
            written_ns: line.written_ns,
            wall_ns: line.wall_ns,
            counter: self.sent,
            dropped,
            level: line.level as u32,
            pid: std::process::id(),
        };
        loan.items_mut().copy_from_slice(text);
        self.sent += 1;
        loan.send()
    }
}
