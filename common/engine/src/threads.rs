//! Work shared by threads.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs each share on its own thread, the first one on this thread, with its number. Returns the
/// error of the first share that failed, if any.
///
/// If the first share fails, the others are asked to stop; only the first checks the caller's
/// `stop`.
///
/// # Panics
/// If there is no share, or one of them panics.
pub(crate) fn run<S: Send, E: Send>(
    shares: &mut [S],
    stop: &dyn Fn() -> bool,
    run: impl Fn(usize, &mut S, &dyn Fn() -> bool) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let (own, others) = shares.split_first_mut().expect("a share");
    // A scope allocates even without threads.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_share_is_run_once_with_its_number() {
        for threads in 1..4 {
            let mut shares = vec![0; threads];
            let end = run(&mut shares, &|| false, |number, share, _| {
                *share += number + 1;
                Ok::<(), ()>(())
            });
            assert_eq!(end, Ok(()));
            assert_eq!(shares, (1..=threads).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_failure_is_told_and_that_of_the_first_share_stops_the_others() {
        let failing = |failed: &'static [usize]| {
            run(&mut [(); 3], &|| false, move |number, (), _| {
                if failed.contains(&number) {
                    Err(number)
                } else {
                    Ok(())
                }
            })
        };
        assert_eq!(failing(&[1, 2]), Err(1));
        assert_eq!(failing(&[2]), Err(2));
        // The others run until they are asked to stop.
        let end = run(&mut [(); 3], &|| true, |number, (), stop| {
            while !stop() {
                std::thread::yield_now();
            }
            Err::<(), _>(number)
        });
        assert_eq!(end, Err(0));
    }

    #[test]
    #[should_panic(expected = "the third")]
    fn a_panic_of_another_share_goes_on_here() {
        let _ = run(&mut [(); 3], &|| false, |number, (), _| {
            assert_ne!(number, 2, "the third");
            Ok::<(), ()>(())
        });
    }
}
