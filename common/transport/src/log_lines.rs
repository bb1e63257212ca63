//! What the process logs, until it can be sent.
//!
//! Any thread may log, but only the one that joined a graph can send. So lines
//! wait here, a set number at most; those beyond are dropped and counted.

use std::cell::Cell;
use std::collections::VecDeque;
use std::fmt::{Debug, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

use messages::{LogLevel, Topic, topic};
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::Context;

use crate::{monotonic_ns, wall_ns};

/// The target of events that the console alone may see: secrets, say.
pub const CONSOLE_ONLY: &str = "console_only";

/// Lines that wait at most, so that a subscriber has room for all of them and for
/// the one that reports losses.
const CAPACITY: usize = topic::Log::DEPTH - 1;

static WAITING: Mutex<Waiting> = Mutex::new(Waiting::none());

thread_local! {
    /// What is logged while lines are being sent would be about these lines.
    static SENDING: Cell<bool> = const { Cell::new(false) };
}

/// A line, when it was written, and how grave it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Line {
    pub(crate) written_ns: i64,
    pub(crate) wall_ns: i64,
    pub(crate) level: LogLevel,
    pub(crate) text: String,
}

impl Line {
    fn now(level: LogLevel, text: String) -> Self {
        Line {
            written_ns: monotonic_ns(),
            wall_ns: wall_ns(),
            level,
            text,
        }
    }
}

/// Lines in their order.
#[derive(Debug)]
struct Waiting {
    /// Whether anything is kept.
    kept: bool,
    lines: VecDeque<Line>,
    dropped: u64,
}

impl Waiting {
    const fn none() -> Self {
        Waiting {
            kept: false,
            lines: VecDeque::new(),
            dropped: 0,
        }
    }

    fn put(&mut self, line: Line) {
        match self.lines.len() < CAPACITY {
            true => self.lines.push_back(line),
            false => self.dropped += 1,
        }
    }
}

/// The receiver of events that keeps their lines from now on.
pub(crate) fn keep() -> KeepLines {
    waiting().kept = true;
    KeepLines
}

/// Keeps a line for topic `log` that is no event: what the process has printed
/// already, in a form of its own. Without a log there it goes nowhere.
pub fn log_in_graph(level: LogLevel, text: &str) {
    let mut waiting = waiting();
    if waiting.kept {
        waiting.put(Line::now(level, text.to_owned()));
    }
}

/// Whether there is one.
pub(crate) fn are_kept() -> bool {
    waiting().kept
}

/// Calls for each line that waits, and with how many were dropped since the process
/// began; what it logs itself is not kept.
pub(crate) fn send_each(mut send: impl FnMut(Line, u64)) {
    let (lines, dropped) = {
        let mut waiting = waiting();
        (std::mem::take(&mut waiting.lines), waiting.dropped)
    };
    SENDING.set(true);
    lines.into_iter().for_each(|line| send(line, dropped));
    SENDING.set(false);
}

fn waiting() -> MutexGuard<'static, Waiting> {
    WAITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps what is logged.
#[derive(Debug)]
pub(crate) struct KeepLines;

impl<S: Subscriber> Layer<S> for KeepLines {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        if SENDING.get() || event.metadata().target() == CONSOLE_ONLY {
            return;
        }
        let level = level(event.metadata().level());
        waiting().put(Line::now(level, text_of(event)));
    }
}

/// The message of an event, and what it names beside.
pub(crate) fn text_of(event: &Event<'_>) -> String {
    let mut text = Text::default();
    event.record(&mut text);
    text.message + &text.fields
}

#[derive(Debug, Default)]
struct Text {
    message: String,
    fields: String,
}

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        // Writing to a text does not fail.
        let _ = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            name => write!(self.fields, " {name}={value:?}"),
        };
    }
}

fn level(level: &Level) -> LogLevel {
    match *level {
        Level::ERROR => LogLevel::Error,
        Level::WARN => LogLevel::Warn,
        Level::INFO => LogLevel::Info,
        Level::DEBUG | Level::TRACE => LogLevel::Debug,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_bounded_and_what_does_not_fit_is_counted() {
        let mut waiting = Waiting::none();
        for number in 0..CAPACITY + 3 {
            waiting.put(Line {
                written_ns: 0,
                wall_ns: 0,
                level: LogLevel::Info,
                text: number.to_string(),
            });
        }
        assert_eq!((waiting.lines.len(), waiting.dropped), (CAPACITY, 3));
        assert_eq!(waiting.lines[0].text, "0");
    }
}
