//! Progress bar of a command on a terminal; all other output goes through it.

use std::io::{self, ErrorKind, Write};
use std::ops::ControlFlow;

use command_line::{OutputError, say, stdout};
use indicatif::{ProgressBar, ProgressStyle};

/// The bar; it is removed when this is dropped.
pub struct Progress(ProgressBar);

impl Progress {
    /// Creates a bar with the label `name` for `total` scans.
    pub fn new(name: &str, total: u64) -> Self {
        Self::counting(name, "scans", total)
    }

    /// Creates a bar with the label `name` for `total` of something else.
    pub fn counting(name: &str, unit: &str, total: u64) -> Self {
        let template = format!("{{msg}} [{{bar:40}}] {{pos}}/{{len}} {unit}, {{eta}} left");
        let style = ProgressStyle::with_template(&template)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        // The default target is standard error, and hidden if that is not a terminal.
        let bar = ProgressBar::new(total)
            .with_style(style)
            .with_message(name.to_owned());
        bar.tick();
        Progress(bar)
    }

    /// Changes the label.
    pub fn show(&self, name: String) {
        self.0.set_message(name);
    }

    /// Counts another one.
    pub fn step(&self) {
        self.0.inc(1);
    }

    /// Writes a line to standard output. Returns `Break` if the reader has closed it.
    pub fn print(&self, line: &str) -> Result<ControlFlow<()>, OutputError> {
        let written = self.0.suspend(|| {
            let mut stdout = io::stdout().lock();
            writeln!(stdout, "{line}")?;
            stdout.flush()
        });
        match written {
            Ok(()) => Ok(ControlFlow::Continue(())),
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(ControlFlow::Break(())),
            Err(error) => Err(OutputError(error)),
        }
    }

    /// Writes text to standard output; a closed reader is no error.
    pub fn write(&self, text: &str) -> Result<(), OutputError> {
        self.0.suspend(|| stdout::print(text))
    }

    /// Writes a remark to standard error.
    pub fn say(&self, remark: &str) {
        self.0.suspend(|| say(remark));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
