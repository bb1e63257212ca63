//! How far the bench has come: a bar on standard error where that is a
//! terminal, nothing in a pipe.

use command_line::stdout;
use indicatif::{ProgressBar, ProgressStyle};

/// The bar; it goes when it is dropped.
pub(super) struct Progress(ProgressBar);

impl Progress {
    /// A bar for this many measurements.
    pub(super) fn new(measurements: usize) -> Self {
        let template = "[{bar:30}] {pos}/{len} measurements, {eta} left: {msg}";
        let style = ProgressStyle::with_template(template)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        // Its own target is standard error, and none where that is no terminal.
        let bar = ProgressBar::new(measurements as u64).with_style(style);
        bar.tick();
        Progress(bar)
    }

    /// What is going on.
    pub(super) fn say(&self, what: String) {
        self.0.set_message(what);
    }

    /// Another measurement is done.
    pub(super) fn step(&self) {
        self.0.inc(1);
    }

    /// Writes to standard output, with no bar in between.
    ///
    /// # Errors
    /// Writing failed.
    pub(super) fn print(&self, text: &str) -> anyhow::Result<()> {
        Ok(self.0.suspend(|| stdout::print(text))?)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
