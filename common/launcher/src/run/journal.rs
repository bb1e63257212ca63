//! Prints a run for the user: a line for each answer as it comes, and summary figures at the end.

use std::time::Duration;

use answers::{Frame, Row, Rows, ScanAnswer};
use messages::{HypothesesHeader, Hypothesis, LogHeader, PoseHeader};
use schemars::JsonSchema;
use serde::Serialize;

use super::console::{LAUNCHER, say};
use super::log_files::LogFiles;
use super::output::Output;
use super::report::Report;
use super::summary::Summary;
use crate::control::LogLine;

/// Last line of a run in JSON.
#[derive(Serialize, JsonSchema)]
pub(crate) struct SummaryLine<'a> {
    summary: &'a Summary,
}

pub(crate) struct Journal {
    pub report: Report,
    /// Rows that wait for the tracker's pose; `None` without a tracker.
    rows: Option<Rows>,
    pub output: Output,
    json: bool,
    /// Frame of the poses in the table so far.
    frame: Option<Frame>,
    logs: Option<LogFiles>,
}

impl Journal {
    pub(crate) fn new(
        output: Output,
        json: bool,
        is_tracked: bool,
        logs: Option<LogFiles>,
    ) -> Self {
        Journal {
            report: Report::new(is_tracked),
            rows: is_tracked.then(Rows::default),
            output,
            json,
            frame: None,
            logs,
        }
    }

    pub(crate) fn has_logs(&self) -> bool {
        self.logs.is_some()
    }

    pub(crate) fn log(&mut self, header: &LogHeader, text: &[u8]) {
        if let Some(logs) = &mut self.logs {
            logs.write(&LogLine::of(header, text));
        }
    }

    pub(crate) fn answer(&mut self, header: &HypothesesHeader, found: &[Hypothesis]) {
        let answer = self.report.answer(header, found);
        if let Some(rows) = &mut self.rows {
            let due = rows.answer(header.stamp, answer);
            return self.print(&due);
        }
        if answer.best.laser.is_some() || self.frame.is_none() {
            self.show_header(answer.best.frame, ScanAnswer::header);
        }
        let text = answer.text();
        let row = Row {
            stamp_ns: answer.stamp_ns,
            single: Some(answer),
            pose: None,
        };
        let line = shown(self.json, &row, |_| text.clone());
        self.output.line(line);
    }

    /// Records the tracker's pose of a scan and prints it. Poses between scans have no row.
    pub(crate) fn pose(&mut self, header: &PoseHeader, words: &[u8]) {
        let (Some(rows), 1) = (&mut self.rows, header.from_scan) else {
            return;
        };
        let line = self.report.pose(header, words);
        let due = rows.pose(header.stamp, line);
        self.print(&due);
    }

    fn print(&mut self, rows: &[Row]) {
        for row in rows {
            let pose = row.pose.as_ref();
            let of = || pose.map_or(Frame::Laser, |pose| pose.place.frame);
            if let Some(frame) = row.frame().or_else(|| self.frame.is_none().then(of)) {
                self.show_header(frame, Row::header);
            }
            self.output.line(shown(self.json, row, Row::text));
        }
    }

    fn show_header(&mut self, frame: Frame, header: fn(Frame) -> String) {
        if self.frame.replace(frame) != Some(frame) && !self.json {
            self.output.line(header(frame));
        }
    }

    /// Prints the summary if `wanted`, and waits at most for `patience` until all is printed.
    pub(crate) fn finish(
        mut self,
        wanted: bool,
        patience: Option<Duration>,
    ) -> anyhow::Result<Summary> {
        let summary = self.report.summary();
        let rest = self.rows.as_mut().map(Rows::finish);
        self.print(&rest.unwrap_or_default());
        if wanted {
            let last = SummaryLine { summary: &summary };
            let text = shown(self.json, &last, |last| last.summary.text());
            self.output.line(text);
        }
        let unprinted = self.output.finish(patience)?;
        if unprinted > 0 {
            let lost = "lines were not printed: standard output was not read in time";
            say(LAUNCHER, &format!("{unprinted} {lost}"));
        }
        Ok(summary)
    }
}

fn shown<T: Serialize>(json: bool, value: &T, text: impl Fn(&T) -> String) -> String {
    match json {
        true => command_line::json::object(value),
        false => text(value),
    }
}
