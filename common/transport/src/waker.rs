//! Ends the event loop's sleep from another thread, e.g. that of a network library.

use std::io::Write;
use std::os::unix::net::UnixStream;
use std::sync::Arc;

/// Wakes the event loop of its graph; may be sent to any thread.
#[derive(Debug, Clone)]
pub struct Waker(pub(crate) Arc<UnixStream>);

impl Waker {
    /// Makes [`crate::Graph::run`] call its step once more, at once or after the current one.
    pub fn wake(&self) {
        // If the socket is full, wake-ups are pending already; if closed, there is no loop.
        let _ = (&*self.0).write(&[0]);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use crate::testing::Isolated;
    use crate::{Flow, TransportError};

    #[test]
    fn a_sleeping_event_loop_is_woken() {
        let isolated = Isolated::new("waker");
        let graph = isolated.join("test");
        let waker = graph.waker().unwrap();
        let mut steps = 0;
        let thread = std::thread::spawn(move || waker.wake());
        // Without the waker, the second step would come in a day.
        let day = Duration::from_secs(86_400);
        let outcome = graph.run(&[], day, |wake| {
            steps += 1;
            assert_eq!(wake.tick, steps == 1);
            Ok::<_, TransportError>(match steps {
                2 => Flow::Stop,
                _ => Flow::Continue,
            })
        });
        outcome.unwrap();
        thread.join().unwrap();
    }

    #[test]
    fn more_wake_ups_than_anybody_takes_hold_nobody_up() {
        let isolated = Isolated::new("wakers");
        let graph = isolated.join("test");
        let waker = graph.waker().unwrap();
        for _ in 0..1_000_000 {
            waker.wake();
        }
        assert!(graph.signals().drain());
        assert!(!graph.signals().drain());
    }
}
