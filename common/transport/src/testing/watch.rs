//! Ends tests that hang.

use std::io::{Write, stderr};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use nix::sys::signal::{Signal, raise};

use crate::GraphName;

/// How long a test may take: it waits for what it expects, and what never comes
/// would hold up all tests behind it. Many times the slowest test on a slow machine.
const TIMEOUT: Duration = Duration::from_secs(300);

/// From being asked to end until it has to, for what does not wait in a graph.
const GRACE: Duration = Duration::from_secs(10);

/// Starts and ends of what takes long by itself.
static LONG_WORK: AtomicUsize = AtomicUsize::new(0);

/// Does what takes long without hanging, as compiling; one at a time. Tests have all
/// their time again afterwards.
pub fn allow_long<R>(work: impl FnOnce() -> R) -> R {
    LONG_WORK.fetch_add(1, Ordering::Relaxed);
    let done = work();
    LONG_WORK.fetch_add(1, Ordering::Relaxed);
    done
}

/// Ends the process, and so its test, where that hangs: waiting in a graph ends, and
/// the test fails with what its nodes logged. Until the sender is dropped.
pub(super) fn watch(graph: GraphName) -> Sender<()> {
    let (watched, end) = channel();
    std::thread::spawn(move || {
        let lasts = |time| end.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
        let mut before = LONG_WORK.load(Ordering::Relaxed);
        while lasts(TIMEOUT) {
            let now = LONG_WORK.load(Ordering::Relaxed);
            // Where a start has no end yet, that continues.
            if now == before && now.is_multiple_of(2) {
                // Not by `eprintln!`, whose words a test keeps until it ends.
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
