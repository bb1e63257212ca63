//! Standard output on a thread of its own, so that its reader cannot block supervision.

use std::io::{self, ErrorKind, Write};
use std::sync::mpsc::{
    Receiver, RecvTimeoutError, SyncSender, TrySendError, channel, sync_channel,
};
use std::thread;
use std::time::Duration;

use command_line::OutputError;

/// Number of lines queued for a slow reader; further lines are dropped and counted.
const CAPACITY: usize = 4096;

pub(crate) struct Output {
    lines: SyncSender<String>,
    ended: Receiver<io::Result<()>>,
    lost: u64,
    /// False once the reader of standard output has gone away.
    pub is_read: bool,
}

impl Output {
    pub(crate) fn start(mut writer: impl Write + Send + 'static) -> anyhow::Result<Self> {
        let (lines, waiting) = sync_channel::<String>(CAPACITY);
        let (end, ended) = channel();
        let body = move || {
            let written = waiting.iter().try_for_each(|line| {
                writer.write_all(line.as_bytes())?;
                writer.flush()
            });
            // The receiver may be gone.
            let _ = end.send(written);
        };
        thread::Builder::new()
            .name("stdout".into())
            .spawn(body)
            .map_err(OutputError)?;
        Ok(Output {
            lines,
            ended,
            lost: 0,
            is_read: true,
        })
    }

    pub(crate) fn line(&mut self, mut line: String) {
        line.push('\n');
        match self.lines.try_send(line) {
            Ok(()) => {}
            Err(TrySendError::Full(_)) => self.lost += 1,
            Err(TrySendError::Disconnected(_)) => self.is_read = false,
        }
    }

    /// Waits at most for `patience` until all is written; returns the number of dropped lines.
    pub(crate) fn finish(self, patience: Option<Duration>) -> anyhow::Result<u64> {
        drop(self.lines);
        let ended = match patience {
            None => self.ended.recv().map_err(RecvTimeoutError::from),
            Some(patience) => self.ended.recv_timeout(patience),
        };
        match ended {
            Ok(Err(error)) if error.kind() != ErrorKind::BrokenPipe => {
                Err(OutputError(error).into())
            }
            // Written, reader gone, or timeout: none of them is an error.
            _ => Ok(self.lost),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_that_stops_reading_blocks_nobody() {
        let (reader, writer) = io::pipe().unwrap();
        let mut output = Output::start(writer).unwrap();
        // More than the pipe, the queue and the line being written hold together.
        for _ in 0..3 * CAPACITY {
            output.line("x".repeat(1000));
        }
        assert!(output.is_read);
        let lost = output.finish(Some(Duration::ZERO)).unwrap();
        assert!(lost > 0, "{lost}");
        drop(reader);
    }

    #[test]
    fn a_reader_that_went_away_is_noticed_and_no_failure() {
        let (reader, writer) = io::pipe().unwrap();
        drop(reader);
        let mut output = Output::start(writer).unwrap();
        while output.is_read {
            output.line("x".into());
            thread::yield_now();
        }
        assert!(output.finish(None).is_ok());
    }

    #[test]
    fn a_full_disk_is_a_failure() {
        let full = std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let mut output = Output::start(full).unwrap();
        output.line("x".into());
        let error = output.finish(None).unwrap_err();
        assert!(error.is::<OutputError>(), "{error}");
    }
}
