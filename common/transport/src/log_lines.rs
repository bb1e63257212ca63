//! Bounded queue of log lines of any thread, until the one that joined a graph publishes them.

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

/// Target of events that only the console may show, such as secrets.
pub const CONSOLE_ONLY: &str = "console_only";

/// Capacity of the queue: a subscriber has room for all its lines and the report of losses.
const CAPACITY: usize = topic::Log::DEPTH - 1;

static WAITING: Mutex<Waiting> = Mutex::new(Waiting {
    kept: false,
    lines: VecDeque::new(),
    dropped: 0,
});

thread_local! {
    /// True while lines are being sent: lines logged meanwhile would be about these lines.
    static SENDING: Cell<bool> = const { Cell::new(false) };
}

#[derive(Debug)]
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

#[derive(Debug)]
struct Waiting {
    kept: bool,
    lines: VecDeque<Line>,
    dropped: u64,
}

impl Waiting {
    fn put(&mut self, line: Line) {
        match self.lines.len() < CAPACITY {
            true => self.lines.push_back(line),
            false => self.dropped += 1,
        }
    }
}

pub(crate) fn keep() -> KeepLines {
    waiting().kept = true;
    KeepLines
}

/// Adds a line to topic `log` that the process has printed already; needs started logging.
pub fn log_in_graph(level: LogLevel, text: &str) {
    let mut waiting = waiting();
    if waiting.kept {
        waiting.put(Line::now(level, text.to_owned()));
    }
}

pub(crate) fn are_kept() -> bool {
    waiting().kept
}

/// Calls `send` for each waiting line, with the number of lines dropped since the start.
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
        // Writing to a string cannot fail.
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
