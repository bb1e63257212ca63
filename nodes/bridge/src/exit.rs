//! Where payloads leave the process.
//!
//! What is live goes at once or not at all. What is kept goes for good: where the
//! network is slower, Zenoh holds up whoever sends it, for seconds where a cable was
//! pulled. That is done on a thread of its own, so that nothing else waits; of what
//! comes meanwhile it sends the newest.

use crossbeam::channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use zenoh::Wait;
use zenoh_ext::AdvancedPublisher;

/// What Zenoh says of a payload.
type Outcome = zenoh::Result<()>;

/// Sends the payloads of one topic.
pub(crate) enum Exit {
    /// From the thread that calls.
    Here(AdvancedPublisher<'static>),
    /// From one of its own.
    Aside(Aside),
}

/// A thread that sends, and what is on the way to it and back.
pub(crate) struct Aside {
    to: Sender<Vec<u8>>,
    /// The thread's own end, to take out what it did not come to.
    waiting: Receiver<Vec<u8>>,
    outcomes: Receiver<Outcome>,
}

impl Exit {
    /// Whether anybody would get it. If Zenoh does not know, it is sent; so is what
    /// is kept, for those who come later.
    pub(crate) fn has_subscribers(&self) -> bool {
        match self {
            Exit::Here(publisher) => {
                let status = publisher.matching_status().wait();
                status.map_or(true, |status| status.matching())
            }
            Exit::Aside(_) => true,
        }
    }

    /// Sends a payload; what came of it, if that is known at once.
    pub(crate) fn put(&self, payload: Vec<u8>) -> Option<Outcome> {
        match self {
            Exit::Here(publisher) => Some(publisher.put(payload).wait()),
            Exit::Aside(aside) => {
                aside.put(payload);
                None
            }
        }
    }

    /// What came of an earlier one.
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

    /// The thread ends with this, or with the process where `send` holds it up.
    fn by(send: impl Fn(Vec<u8>) -> Outcome + Send + 'static) -> Self {
        let (to, from) = bounded(1);
        let (done, outcomes) = unbounded();
        let waiting = from.clone();
        std::thread::spawn(move || {
            for payload in from {
                // Where nobody wants to know, the process is about to end.
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
            // There is limits, for nobody else sends.
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
        // Meanwhile the network takes nothing.
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
