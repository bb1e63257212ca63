//! Ends tests that hang.

use std::io::{Write, stderr};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use nix::sys::signal::{Signal, raise};

use crate::GraphName;

/// Longest time of a test; a message that never comes would block all tests behind it.
const TIMEOUT: Duration = Duration::from_secs(300);

/// Time from SIGTERM to the abort, which is for code that does not wait in a graph.
const GRACE: Duration = Duration::from_secs(10);

/// Counts starts and ends of long work.
static LONG_WORK: AtomicUsize = AtomicUsize::new(0);

/// Runs long work that is not a hang, such as compiling; one at a time.
pub fn allow_long<R>(work: impl FnOnce() -> R) -> R {
    LONG_WORK.fetch_add(1, Ordering::Relaxed);
    let done = work();
    LONG_WORK.fetch_add(1, Ordering::Relaxed);
    done
}

/// Ends the process with the log of its nodes if its test hangs, until the sender is dropped.
pub(super) fn watch(graph: GraphName) -> Sender<()> {
    let (watched, end) = channel();
    std::thread::spawn(move || {
        let lasts = |time| end.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
        let mut before = LONG_WORK.load(Ordering::Relaxed);
        while lasts(TIMEOUT) {
            let now = LONG_WORK.load(Ordering::Relaxed);
            // An odd number means that long work is going on.
            if now == before && now.is_multiple_of(2) {
                // Not by `eprintln!`, whose output the test harness captures until the test ends.
                let _ = writeln!(
                    stderr(),
                    "the test in graph {graph} takes more than {TIMEOUT:?}: it is ended"
                );
                let _ = raise(Signal::SIGTERM);
                if lasts(GRACE) {
                    std::process::abort();
                }
            }
            before = now;
        }
    });
    watched
}
