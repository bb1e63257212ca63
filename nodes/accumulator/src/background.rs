//! Runs one job on a thread of its own.
//!
//! The result is polled, never waited for, because the caller answers scans meanwhile. A job that
//! is dropped runs to its end or to the end of the process.

use std::any::Any;
use std::io;
use std::thread::{Builder, JoinHandle};

#[derive(Debug)]
pub(crate) struct Background<T> {
    thread: JoinHandle<T>,
}

impl<T: Send + 'static> Background<T> {
    /// Starts `work` on a thread with this name, which debuggers show.
    pub(crate) fn start(
        name: &str,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<Self, io::Error> {
        let thread = Builder::new().name(name.into()).spawn(work)?;
        Ok(Background { thread })
    }

    pub(crate) fn is_finished(&self) -> bool {
        self.thread.is_finished()
    }

    /// Returns the result, or the message with which the work panicked.
    pub(crate) fn finish(self) -> Result<T, String> {
        self.thread.join().map_err(|panic| words_of(&*panic))
    }
}

fn words_of(panic: &(dyn Any + Send)) -> String {
    let literal = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let formatted = || panic.downcast_ref::<String>().cloned();
    literal
        .or_else(formatted)
        .unwrap_or_else(|| "it panicked without a message".into())
}

#[cfg(test)]
mod tests {
    use std::panic::panic_any;
    use std::sync::mpsc;

    use super::*;

    #[test]
    fn the_outcome_is_there_when_the_work_is_done() {
        let (let_go, wait) = mpsc::channel::<()>();
        let work = Background::start("test", move || wait.recv().map(|()| 5)).unwrap();
        assert!(!work.is_finished(), "it waits for this test");
        let_go.send(()).unwrap();
        assert_eq!(work.finish(), Ok(Ok(5)));
    }

    #[test]
    fn work_that_panics_is_reported_and_not_waited_for() {
        let dies = |work: fn()| Background::start("test", work).unwrap().finish();
        assert_eq!(dies(|| panic!("no memory")), Err("no memory".into()));
        assert_eq!(dies(|| panic!("{} left", 0)), Err("0 left".into()));
        assert_eq!(
            dies(|| panic_any(7)),
            Err("it panicked without a message".into())
        );
    }
}
