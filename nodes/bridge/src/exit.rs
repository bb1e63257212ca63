//! Sending of payloads to the network.
//!
//! Live messages are sent at once or dropped. Kept messages are sent reliably: if the network is
//! slower, Zenoh blocks the sender, for seconds after a cable was pulled. They are therefore sent
//! on a thread of their own, which sends only the newest one of those that arrive meanwhile.

use crossbeam::channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use zenoh::Wait;
use zenoh_ext::AdvancedPublisher;

type Outcome = zenoh::Result<()>;

pub(crate) enum Exit {
    /// Sends on the calling thread.
    Here(AdvancedPublisher<'static>),
    /// Sends on a thread of its own.
    Aside(Aside),
}

pub(crate) struct Aside {
    to: Sender<Vec<u8>>,
    /// Receiver of the thread's queue, to remove a payload that the thread has not taken.
    waiting: Receiver<Vec<u8>>,
    outcomes: Receiver<Outcome>,
}

impl Exit {
    /// Returns true if there is a subscriber, or if Zenoh does not know. Always true for kept
    /// messages, because of late joiners.
    pub(crate) fn has_subscribers(&self) -> bool {
        match self {
            Exit::Here(publisher) => {
                let status = publisher.matching_status().wait();
                status.map_or(true, |status| status.matching())
            }
            Exit::Aside(_) => true,
        }
    }

    /// Sends a payload; returns the result if it is known at once.
    pub(crate) fn put(&self, payload: Vec<u8>) -> Option<Outcome> {
        match self {
            Exit::Here(publisher) => Some(publisher.put(payload).wait()),
            Exit::Aside(aside) => {
                aside.put(payload);
                None
            }
        }
    }

    pub(crate) fn outcome(&self) -> Option<Outcome> {
        match self {
            Exit::Here(_) => None,
            Exit::Aside(aside) => aside.outcomes.try_recv().ok(),
        }
    }
}

impl Aside {
    pub(crate) fn new(publisher: AdvancedPublisher<'static>) -> Self {
        Aside::by(move |payload| publisher.put(payload).wait())
    }

    /// Starts the thread, which ends when this is dropped, or with the process if `send` blocks.
    fn by(send: impl Fn(Vec<u8>) -> Outcome + Send + 'static) -> Self {
        let (to, from) = bounded(1);
        let (done, outcomes) = unbounded();
        let waiting = from.clone();
        std::thread::spawn(move || {
            for payload in from {
                // Without a receiver the process is about to end.
                let _ = done.send(send(payload));
            }
        });
        Aside {
            to,
            waiting,
            outcomes,
        }
    }

    fn put(&self, payload: Vec<u8>) {
        if let Err(TrySendError::Full(payload)) = self.to.try_send(payload) {
            let _ = self.waiting.try_recv();
            // There is room now, because no one else sends.
            let _ = self.to.try_send(payload);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_sends_is_not_held_up_and_the_newest_goes() {
        let (begun, begins) = unbounded();
        let (release, released) = unbounded();
        let aside = Aside::by(move |payload| {
            begun.send(payload).unwrap();
            released.recv().map_err(zenoh::Error::from)
        });
        aside.put(vec![0]);
        assert_eq!(begins.recv().unwrap(), [0]);
        // Meanwhile the network is blocked.
        for number in 1..=5 {
            aside.put(vec![number]);
        }
        assert!(aside.outcomes.try_recv().is_err());
        release.send(()).unwrap();
        assert_eq!(begins.recv().unwrap(), [5]);
        release.send(()).unwrap();
        for _ in 0..2 {
            assert!(aside.outcomes.recv().unwrap().is_ok());
        }
    }
}
