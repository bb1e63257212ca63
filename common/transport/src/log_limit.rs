//! Keeps one message, by its whole text, from filling a log.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::Context;

use crate::log_lines::text_of;

/// Number of equal lines within [`PERIOD`]; further ones are omitted and counted.
const LINES: u32 = 20;
const PERIOD: Duration = Duration::from_secs(10);
/// Largest number of messages tracked. Beyond it, all counts are reset.
const MESSAGES: usize = 256;

/// Layer that omits lines which repeat too fast. Lines of level `debug` and below are not limited.
#[derive(Debug, Default)]
pub(crate) struct Limit {
    recent: Mutex<HashMap<u64, Recent>>,
}

#[derive(Debug, Clone, Copy)]
struct Recent {
    since: Instant,
    lines: u32,
}

#[derive(Debug, PartialEq, Eq)]
enum Fate {
    Written,
    /// Written, after this number of equal lines was omitted.
    WrittenAfter(u32),
    LeftOut,
}

impl Limit {
    fn judge(&self, message: u64, now: Instant) -> Fate {
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        if recent.len() >= MESSAGES && !recent.contains_key(&message) {
            recent.clear();
        }
        let new = Recent {
            since: now,
            lines: 0,
        };
        let of_message = recent.entry(message).or_insert(new);
        let mut fate = Fate::Written;
        if now.saturating_duration_since(of_message.since) >= PERIOD {
            let left_out = of_message.lines.saturating_sub(LINES);
            if left_out > 0 {
                fate = Fate::WrittenAfter(left_out);
            }
            *of_message = new;
        }
        of_message.lines = of_message.lines.saturating_add(1);
        match of_message.lines > LINES {
            true => Fate::LeftOut,
            false => fate,
        }
    }
}

impl<S: Subscriber> Layer<S> for Limit {
    fn event_enabled(&self, event: &Event<'_>, _: Context<'_, S>) -> bool {
        if *event.metadata().level() > Level::INFO {
            return true;
        }
        let mut hasher = DefaultHasher::new();
        text_of(event).hash(&mut hasher);
        match self.judge(hasher.finish(), Instant::now()) {
            Fate::Written => true,
            Fate::WrittenAfter(left_out) => {
                tracing::warn!("{left_out} lines like the next one were omitted");
                true
            }
            Fate::LeftOut => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_written_so_often_and_then_counted() {
        let limit = Limit::default();
        let start = Instant::now();
        let fates: Vec<_> = (0..30).map(|_| limit.judge(1, start)).collect();
        let written = fates.iter().filter(|fate| **fate == Fate::Written);
        assert_eq!(written.count(), 20);
        assert_eq!(fates[29], Fate::LeftOut);
        assert_eq!(limit.judge(2, start), Fate::Written, "another one");
        let later = start + PERIOD;
        assert_eq!(limit.judge(1, later), Fate::WrittenAfter(10));
        assert_eq!(limit.judge(1, later), Fate::Written);
    }

    #[test]
    fn memory_is_bounded() {
        let limit = Limit::default();
        let now = Instant::now();
        assert!((0..100_000).all(|message| limit.judge(message, now) == Fate::Written));
        assert!(limit.recent.lock().unwrap().len() <= MESSAGES);
    }
}
