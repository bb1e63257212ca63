//! Errors as the exceptions that Python expects: `ValueError` with the value found and those
//! allowed, `OSError` for files, and never a panic.

use std::error::Error;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use engine::EngineError;
use index_cache::CacheError;
use map::MapError;
use pyo3::exceptions::{PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use recording::RecordingError;

/// Makes a `ValueError`.
pub(crate) fn value(text: impl Into<String>) -> PyErr {
    PyValueError::new_err(text.into())
}

/// Converts an error of the engine about a map or a scan.
pub(crate) fn of_engine(error: EngineError) -> PyErr {
    match error {
        // The command's options have other names here.
        EngineError::Memory {
            needed_mb,
            limit_mb,
        } => PyMemoryError::new_err(format!(
            "preparing the map takes about {needed_mb} MB and memory_limit allows {limit_mb}: \
             larger cells (search_cell), fewer headings (headings) or a part of the map (region) \
             take less"
        )),
        other => value(with_causes(&other)),
    }
}

/// Converts an error in reading or building a map.
pub(crate) fn of_map(error: &MapError) -> PyErr {
    match error.source().and_then(|cause| cause.downcast_ref()) {
        Some(cause) => of_file(error, cause),
        None => value(with_causes(error)),
    }
}

/// Converts an error of a recording; keywords have the names of the command's options.
pub(crate) fn of_recording(error: &RecordingError) -> PyErr {
    match error {
        RecordingError::Open { source, .. } => of_file(error, source),
        other => value(
            with_causes(other)
                .replace("--odom-topic", "odom_topic")
                .replace("--map-topic", "map_topic"),
        ),
    }
}

/// Makes an `OSError` of the class that fits the cause, such as `FileNotFoundError`.
fn of_file(error: &dyn Error, cause: &io::Error) -> PyErr {
    io::Error::new(cause.kind(), with_causes(error)).into()
}

/// Converts an error of the index cache, which is about files.
pub(crate) fn of_cache(error: &CacheError) -> PyErr {
    PyOSError::new_err(with_causes(error))
}

fn with_causes(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

/// Time between two checks for a signal to stop.
pub(crate) const SIGNALS_EVERY: Duration = Duration::from_millis(50);

/// Runs a long computation without Python's lock. A panic, which would be a bug of the engine,
/// becomes a `RuntimeError`.
pub(crate) fn detached<T: Send>(
    py: Python<'_>,
    run: impl FnOnce() -> PyResult<T> + Send,
) -> PyResult<T> {
    py.detach(|| without_panic(run))
}

/// Runs a long computation that nothing can stop, on a thread, and raises the exception of a
/// signal's handler, such as `KeyboardInterrupt`, at once. The thread then ends in the background,
/// and its result is dropped; a process that exits does not wait for it.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    run: impl FnOnce() -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = mpsc::sync_channel(1);
    // After a signal the receiver is gone.
    let work = move || drop(sender.send(without_panic(run)));
    thread::Builder::new().spawn(work)?;
    py.detach(move || {
        loop {
            match receiver.recv_timeout(SIGNALS_EVERY) {
                Ok(done) => return done,
                Err(RecvTimeoutError::Timeout) => check_signals()?,
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("a thread ended without a result"));
                }
            }
        }
    })
}

/// Runs the handlers of signals; by default that of Ctrl-C is an error.
pub(crate) fn check_signals() -> PyResult<()> {
    let check = |py: Python<'_>| py.check_signals();
    Python::attach(check)
}

fn without_panic<T>(run: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(PyRuntimeError::new_err(format!(
            "a fault in the engine: {}",
            text.unwrap_or("it says nothing")
        )))
    })
}
