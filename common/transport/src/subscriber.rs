//! The receiving end of a topic.
//!
//! Samples are read where the publisher wrote them. Nothing waits here: that is
//! the event loop's part.

use iceoryx2::node::Node;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::subscriber::{Subscriber as IoxSubscriber, SubscriberCreateError};
use iceoryx2::prelude::{CallbackProgression, PortFactory, ipc};
use iceoryx2::sample::Sample as IoxSample;
use messages::Topic;

use crate::header::Header;
use crate::service::{self, Samples};
use crate::{Peers, TransportError, space};

/// Receives samples of topic `T`.
#[derive(Debug)]
pub struct Subscriber<T: Topic> {
    listener: Listener<ipc::Service>,
    port: IoxSubscriber<ipc::Service, [T::Item], Header<T::Header>>,
    samples: Samples<T>,
}

impl<T: Topic> Subscriber<T> {
    /// Samples of one publisher that may be held at the same time: the current
    /// map, the one before it while work on it ends, the newest found so far
    /// while looking for a newer one, and that one.
    pub const MAX_HELD: usize = service::MAX_BORROWED;

    pub(crate) fn create(node: &Node<ipc::Service>) -> Result<Self, TransportError> {
        space::ensure_free(T::NAME, 0)?;
        let samples = service::open_samples::<T>(node)?;
        // Whoever sees the subscriber finds the listener there already.
        let listener = service::listener::<T>(node)?;
        let port = samples
            .subscriber_builder()
            .create()
            .map_err(|error| match error {
                SubscriberCreateError::ExceedsMaxSupportedSubscribers => {
                    service::too_many_subscribers::<T>()
                }
                other => service::port_failed::<T>("subscriber", &other),
            })?;
        Ok(Subscriber {
            listener,
            port,
            samples,
        })
    }

    /// The oldest sample that has not been taken, if there is one. Where several
    /// publishers send, the order holds for each of them.
    ///
    /// # Errors
    /// [`TransportError::Receive`] if [`Subscriber::MAX_HELD`] samples of the
    /// publisher are held already, or its memory cannot be mapped.
    pub fn receive(&self) -> Result<Option<Sample<T>>, TransportError> {
        match self.port.receive() {
            Ok(sample) => Ok(sample.map(|inner| Sample { inner })),
            Err(error) => Err(TransportError::Receive {
                topic: T::NAME,
                reason: format!("{error:?}"),
            }),
        }
    }

    /// Those whose samples come from now on.
    #[must_use]
    pub fn publishers(&self) -> Peers {
        let mut ids = Vec::new();
        self.samples.dynamic_config().list_publishers(|details| {
            ids.push(details.publisher_id.value());
            CallbackProgression::Continue
        });
        Peers::of(ids)
    }

    /// Whether somebody sends on the topic.
    #[must_use]
    pub fn has_publishers(&self) -> bool {
        self.samples.dynamic_config().number_of_publishers() > 0
    }

    /// Takes everything that has come and keeps the newest: for topics with one
    /// publisher whose samples replace each other, as the latched ones do.
    ///
    /// # Errors
    /// As [`Subscriber::receive`].
    pub fn newest(&self) -> Result<Option<Sample<T>>, TransportError> {
        let mut newest = None;
        while let Some(sample) = self.receive()? {
            newest = Some(sample);
        }
        Ok(newest)
    }
}

/// A sample in the publisher's memory. It stays as it is while this lives, even
/// if the publisher goes or is killed.
#[derive(Debug)]
pub struct Sample<T: Topic> {
    inner: IoxSample<ipc::Service, [T::Item], Header<T::Header>>,
}

impl<T: Topic> Sample<T> {
    /// The header.
    #[must_use]
    pub fn header(&self) -> &T::Header {
        &self.inner.user_header().0
    }

    /// The items.
    #[must_use]
    pub fn items(&self) -> &[T::Item] {
        self.inner.payload()
    }
}

/// What an event loop can wait for: the subscribers.
pub trait Input: sealed::Wakes {}

pub(crate) mod sealed {
    use super::{Listener, ipc};

    pub trait Wakes {
        fn listener(&self) -> &Listener<ipc::Service>;
    }
}

impl<T: Topic> sealed::Wakes for Subscriber<T> {
    fn listener(&self) -> &Listener<ipc::Service> {
        &self.listener
    }
}

impl<T: Topic> Input for Subscriber<T> {}
