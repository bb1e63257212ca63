//! How far a command has come: a bar on standard error where that is a
//! terminal, nothing in a pipe. Whatever else is printed goes through it, so
//! that the bar never stands within a line.

use std::io::{self, ErrorKind, Write};
use std::ops::ControlFlow;

use command_line::OutputError;
use indicatif::{ProgressBar, ProgressStyle};

/// The bar; it goes when it is dropped.
pub struct Progress(ProgressBar);

impl Progress {
    /// A bar for `total` scans of what is called `name`.
    pub fn new(name: &str, total: u64) -> Self {
        let template = "{msg} [{bar:40}] {pos}/{len} scans, {eta} left";
        let style = ProgressStyle::with_template(template)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        // Its own target is standard error, and none where that is no terminal.
        let bar = ProgressBar::new(total)
            .with_style(style)
            .with_message(name.to_owned());
        bar.tick();
        Progress(bar)
    }

    /// Another scan is done.
    pub fn step(&self) {
        self.0.inc(1);
    }

    /// Writes a line to standard output. Breaks where nobody reads any more,
    /// which is no failure.
    ///
    /// # Errors
    /// Writing failed otherwise.
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

    /// Writes a remark to standard error.
    pub fn say(&self, remark: &str) {
        self.0.suspend(|| say(remark));
    }
}

/// Writes a remark to standard error while there is no bar. One that is closed
/// is nobody's loss but its own.
pub fn say(remark: &str) {
    let _ = writeln!(io::stderr().lock(), "backcast: {remark}");
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
