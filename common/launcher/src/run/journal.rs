//! What the user gets to see of a run: a line for each answer as it comes, and
//! the figures of all of them at the end.

use std::time::Duration;

use messages::{HypothesesHeader, Hypothesis, LogHeader, PoseHeader};
use pose_table::{Line, Row, Rows};
use serde::Serialize;

use super::{
    console::{LAUNCHER, say},
    log_files::LogFiles,
    output::{Output, Reader},
    report::Report,
    summary::Summary,
};
use crate::{LauncherError, control::LogLine};

/// The lines and the figures behind them.
pub(crate) struct Journal {
    pub report: Report,
    /// Where the graph has a tracker: what waits for its poses.
    rows: Option<Rows>,
    output: Output,
    json: bool,
    begun: bool,
    /// Where the nodes' log goes, if it is wanted.
    logs: Option<LogFiles>,
}

impl Journal {
    /// Opens it on `output`, as a table or in JSON, for a graph that has a tracker or
    /// none.
    pub(crate) fn new(output: Output, json: bool, is_tracked: bool) -> Self {
        Journal {
            report: Report::new(is_tracked),
            rows: is_tracked.then(Rows::default),
            output,
            json,
            begun: false,
            logs: None,
        }
    }

    /// Also writes what the nodes log to files.
    pub(crate) fn with_logs(mut self, logs: Option<LogFiles>) -> Self {
        self.logs = logs;
        self
    }

    /// Whether it takes what the nodes log.
    pub(crate) fn has_logs(&self) -> bool {
        self.logs.is_some()
    }

    /// Enters a line of a node's log.
    pub(crate) fn log(&mut self, header: &LogHeader, text: &[u8]) {
        if let Some(logs) = &mut self.logs {
            logs.write(&LogLine::of(header, text));
        }
    }

    /// Prints what stands above the lines, once.
    pub(crate) fn begin(&mut self) {
        if !std::mem::replace(&mut self.begun, true) && !self.json {
            let header = match self.rows {
                Some(_) => Row::header(),
                None => Line::header(),
            };
            self.output.line(header);
        }
    }

    /// Enters an answer and prints it; where there is a tracker, beside its pose.
    pub(crate) fn answer(&mut self, header: &HypothesesHeader, found: &[Hypothesis]) -> Reader {
        let line = self.report.answer(header, found);
        let Some(rows) = &mut self.rows else {
            let text = if self.json {
                json::object(&line)
            } else {
                line.text()
            };
            return self.output.line(text);
        };
        let due = rows.answer(header.stamp, line);
        self.print(&due)
    }

    /// Enters the tracker's pose of a scan and prints it. Those between scans have no row.
    pub(crate) fn pose(&mut self, header: &PoseHeader, words: &[u8]) -> Reader {
        let (Some(rows), 1) = (&mut self.rows, header.from_scan) else {
            return Reader::Reads;
        };
        let line = self.report.pose(header, words);
        let due = rows.pose(header.stamp, line);
        self.print(&due)
    }

    fn print(&mut self, rows: &[Row]) -> Reader {
        let mut reader = Reader::Reads;
        for row in rows {
            let text = if self.json {
                json::object(row)
            } else {
                row.text()
            };
            reader = self.output.line(text);
        }
        reader
    }

    /// Prints the figures where `wanted`, and waits until all is printed, at
    /// most for `patience` where there is one.
    ///
    /// # Errors
    /// Standard output cannot be written.
    pub(crate) fn finish(
        mut self,
        wanted: bool,
        patience: Option<Duration>,
    ) -> Result<Summary, LauncherError> {
        #[derive(Serialize)]
        struct Last<'a> {
            summary: &'a Summary,
        }
        let summary = self.report.summary();
        let rest = self.rows.as_mut().map(Rows::finish);
        self.print(&rest.unwrap_or_default());
        if wanted {
            let last = Last { summary: &summary };
            self.output.line(if self.json {
                json::object(&last)
            } else {
                summary.text()
            });
        }
        let unprinted = self.output.finish(patience)?;
        if unprinted > 0 {
            let why = "standard output was not read in time";
            say(
                LAUNCHER,
                &format!("{unprinted} lines were not printed: {why}"),
            );
        }
        Ok(summary)
    }
}
