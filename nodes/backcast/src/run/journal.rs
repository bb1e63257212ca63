//! What the user gets to see of a run: a line for each answer as it comes, and
//! the figures of all of them at the end.

use std::time::Duration;

use messages::{HypothesesHeader, Hypothesis};
use serde::Serialize;

use super::{
    console::{LAUNCHER, say},
    line::Line,
    output::{Output, Reader},
    report::Report,
    summary::Summary,
};
use crate::BackcastError;

/// The lines and the figures behind them.
pub(crate) struct Journal {
    pub(crate) report: Report,
    output: Output,
    json: bool,
}

impl Journal {
    /// Opens it on `output`, as a table or in JSON.
    pub(crate) fn new(output: Output, json: bool) -> Self {
        Journal {
            report: Report::new(),
            output,
            json,
        }
    }

    /// Prints what stands above the lines.
    pub(crate) fn begin(&mut self) {
        if !self.json {
            self.output.line(Line::header());
        }
    }

    /// Enters and prints an answer.
    pub(crate) fn answer(&mut self, header: &HypothesesHeader, found: &[Hypothesis]) -> Reader {
        let line = self.report.answer(header, found);
        let text = if self.json { json(&line) } else { line.text() };
        self.output.line(text)
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
    ) -> Result<Summary, BackcastError> {
        #[derive(Serialize)]
        struct Last<'a> {
            summary: &'a Summary,
        }
        let summary = self.report.summary();
        if wanted {
            let last = Last { summary: &summary };
            self.output.line(if self.json {
                json(&last)
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

/// One line of JSON. Our own structs have text keys and plain values, which
/// cannot fail to serialize; a fault there would show as the line's content.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|error| format!("{{\"error\":\"{error}\"}}"))
}
