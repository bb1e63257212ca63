//! The processor time of this thread: what a computation costs, whatever else
//! runs on the machine.

use std::time::Duration;

use nix::time::{ClockId, clock_gettime};

use crate::OfflineError;

/// Does `work` and returns what it gave, with the milliseconds that it cost.
///
/// # Errors
/// The system has no such clock.
pub fn timed<T>(work: impl FnOnce() -> T) -> Result<(T, f64), OfflineError> {
    let start = thread_time()?;
    let done = work();
    let cost = thread_time()?.saturating_sub(start);
    Ok((done, cost.as_secs_f64() * 1e3))
}

fn thread_time() -> Result<Duration, OfflineError> {
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID)
        .map(Duration::from)
        .map_err(OfflineError::Clock)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn computing_costs() {
        // Spins until the clock itself has moved on by two milliseconds.
        let spin = || {
            let start = thread_time().unwrap();
            while thread_time().unwrap() - start < Duration::from_millis(2) {}
            "done"
        };
        let (said, cost) = timed(spin).unwrap();
        assert_eq!(said, "done");
        assert!(cost >= 2.0, "{cost}");
    }

    #[test]
    fn the_work_of_other_threads_is_theirs() {
        // The other thread stops when its own clock has moved on, so the first
        // reading of ours lies before, the second after its work.
        let (theirs, ours) = timed(|| {
            let spin = || {
                let work = || while thread_time().unwrap() < Duration::from_millis(20) {};
                timed(work).unwrap().1
            };
            std::thread::spawn(spin).join().unwrap()
        })
        .unwrap();
        // To start and to join a thread takes a share of a millisecond; the
        // process as a whole has worked for more than theirs.
        assert!(ours < theirs, "{ours} {theirs}");
    }
}
