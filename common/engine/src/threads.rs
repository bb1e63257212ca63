//! Work that is shared by threads.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs each share on a thread of its own, the first one on this, with its number;
/// what the first of them failed with, if one did.
///
/// Where the first one fails, the others are asked to stop; only it checks `stop`
/// from outside.
///
/// # Panics
/// If there is no share, or one of them panics.
pub(crate) fn run<S: Send, E: Send>(
    shares: &mut [S],
    stop: &dyn Fn() -> bool,
    run: impl Fn(usize, &mut S, &dyn Fn() -> bool) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let (own, others) = shares.split_first_mut().expect("a share");
    // A scope allocates, be it of no thread.
    if others.is_empty() {
        return run(0, own, stop);
    }
    let stopped = AtomicBool::new(false);
    let is_stopped = || stopped.load(Ordering::Relaxed);
    std::thread::scope(|scope| {
        let run = &run;
        let spawn = |(thread, share)| scope.spawn(move || run(thread, share, &is_stopped));
        let others: Vec<_> = (1..).zip(others).map(spawn).collect();
        let own = run(0, own, stop);
        stopped.store(own.is_err(), Ordering::Relaxed);
        let joined = others.into_iter().map(std::thread::ScopedJoinHandle::join);
        let joined = joined.map(|end| end.unwrap_or_else(|panic| resume_unwind(panic)));
        joined.fold(own, Result::and)
    })
}
