//! Subscription to a topic of one robot or of all robots.

use std::marker::PhantomData;

use network_payload::{Received, Wire, WireError};
use transport::{Waker, monotonic_ns};
use zenoh::Session;
use zenoh::sample::Sample;
use zenoh_session::{Past, Queue, QueueLimits};

use crate::FleetError;

/// Wildcard for all robots in a key.
pub(crate) const ALL: &str = "*";

/// Largest number of waiting messages per topic: half a second of a hundred robots.
const WAITING: usize = 1024;

/// Largest number of waiting bytes per topic; a real map takes about a thousandth of it.
const WAITING_BYTES: usize = 128 << 20;

pub(crate) struct Feed<T: Wire> {
    queue: Queue,
    topic: PhantomData<T>,
}

pub(crate) struct FleetMessage<T: Wire> {
    pub(crate) robot: String,
    pub(crate) message: Received<T>,
}

impl<T: Wire> Feed<T> {
    /// Subscribes to the topic of one robot, or of [`ALL`].
    pub(crate) fn open(session: &Session, robot: &str, waker: Waker) -> Result<Self, FleetError> {
        let key = network_payload::key::<T>(robot);
        let past = if T::KEPT { Past::Last(1) } else { Past::Gone };
        let limits = QueueLimits {
            messages: WAITING,
            message_bytes: T::MAX_BYTES,
            bytes: WAITING_BYTES,
        };
        Ok(Feed {
            queue: Queue::open(session, &key, past, limits, waker)?,
            topic: PhantomData,
        })
    }

    /// Returns the number of messages lost since the last call because the queue was full.
    pub(crate) fn dropped(&self) -> u64 {
        self.queue.dropped()
    }

    /// Returns the waiting messages after validation, with an error for each that was too long.
    /// Their number is limited, so that a flood does not block other topics. Times are converted to
    /// this machine's clock.
    pub(crate) fn waiting(&self) -> impl Iterator<Item = Result<FleetMessage<T>, WireError>> {
        let (topic, most) = (T::NAME, T::MAX_BYTES);
        let too_long = std::iter::from_fn(move || {
            let found = self.queue.next_too_long()?;
            Some(Err(WireError::TooLong { topic, found, most }))
        });
        let samples = std::iter::from_fn(|| self.queue.next());
        let received = samples.take(WAITING).map(|sample| receive(&sample));
        too_long.take(WAITING).chain(received)
    }
}

fn receive<T: Wire>(sample: &Sample) -> Result<FleetMessage<T>, WireError> {
    let robot = sample.key_expr().as_str().split('/').nth(1);
    let robot = network_payload::robot(robot.unwrap_or_default())?;
    let encoding = sample.encoding().to_string();
    let mut message = network_payload::decode::<T>(&encoding, &sample.payload().to_bytes())?;
    message.rebase(monotonic_ns());
    Ok(FleetMessage { robot, message })
}
