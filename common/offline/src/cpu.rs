//! CPU time of this thread: the cost of a computation, independent of the load of the machine.

use std::time::Duration;

use anyhow::Context;
use nix::time::{ClockId, clock_gettime};

/// Runs `work` and returns its result, with its CPU time in milliseconds.
pub fn timed<T>(work: impl FnOnce() -> T) -> anyhow::Result<(T, f64)> {
    let start = thread_time()?;
    let done = work();
    let cost = thread_time()?.saturating_sub(start);
    Ok((done, cost.as_secs_f64() * 1e3))
}

fn thread_time() -> anyhow::Result<Duration> {
    let time = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID);
    Ok(time
        .context("cannot read the processor time of a thread")?
        .into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_work_of_other_threads_is_theirs() {
        // The other thread stops once its own clock has advanced, within our two readings.
        let (theirs, ours) = timed(|| {
            let spin = || {
                let work = || while thread_time().unwrap() < Duration::from_millis(20) {};
                timed(work).unwrap().1
            };
            std::thread::spawn(spin).join().unwrap()
        })
        .unwrap();
        // Starting and joining a thread takes a fraction of a millisecond.
        assert!(ours < theirs, "{ours} {theirs}");
    }
}
