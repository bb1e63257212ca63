//! Subscriber of a topic; samples are read where the publisher wrote them.

use iceoryx2::node::Node;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::subscriber::{Subscriber as IoxSubscriber, SubscriberCreateError};
use iceoryx2::prelude::{CallbackProgression, PortFactory, ipc};
use iceoryx2::sample::Sample as IoxSample;
use messages::Topic;

use crate::header::Header;
use crate::service::{self, Samples};
use crate::{Peers, TransportError, space};

#[derive(Debug)]
pub struct Subscriber<T: Topic> {
    listener: Listener<ipc::Service>,
    port: IoxSubscriber<ipc::Service, [T::Item], Header<T::Header>>,
    samples: Samples<T>,
}

impl<T: Topic> Subscriber<T> {
    pub(crate) fn create(node: &Node<ipc::Service>) -> Result<Self, TransportError> {
        space::ensure_free(T::NAME, 0)?;
        let samples = service::open_samples::<T>(node)?;
        // The listener exists before the subscriber becomes visible.
        let listener = service::listener::<T>(node)?;
        let port = samples
            .subscriber_builder()
            .create()
            .map_err(|error| match error {
                SubscriberCreateError::ExceedsMaxSupportedSubscribers => {
                    service::too_many::<T>("subscribers", T::MAX_SUBSCRIBERS)
                }
                other => service::failed::<T>("create the subscriber of", &other),
            })?;
        Ok(Subscriber {
            listener,
            port,
            samples,
        })
    }

    /// Receives the oldest sample of a publisher; fails if as many as allowed are held.
    pub fn receive(&self) -> Result<Option<Sample<T>>, TransportError> {
        let received = self.port.receive();
        let sample = received.map_err(|error| service::failed::<T>("receive on", &error))?;
        Ok(sample.map(|inner| Sample { inner }))
    }

    /// Returns the current publishers.
    pub fn publishers(&self) -> Peers {
        let mut ids = Vec::new();
        self.samples.dynamic_config().list_publishers(|details| {
            ids.push(details.publisher_id.value());
            CallbackProgression::Continue
        });
        Peers(ids)
    }

    pub fn has_publishers(&self) -> bool {
        self.samples.dynamic_config().number_of_publishers() > 0
    }

    /// Receives all samples and returns the newest, for topics with one publisher.
    pub fn newest(&self) -> Result<Option<Sample<T>>, TransportError> {
        let mut newest = None;
        while let Some(sample) = self.receive()? {
            newest = Some(sample);
        }
        Ok(newest)
    }
}

/// A sample in the publisher's memory, which stays unchanged even if the publisher ends.
#[derive(Debug)]
pub struct Sample<T: Topic> {
    inner: IoxSample<ipc::Service, [T::Item], Header<T::Header>>,
}

impl<T: Topic> Sample<T> {
    pub fn header(&self) -> &T::Header {
        &self.inner.user_header().0
    }

    pub fn items(&self) -> &[T::Item] {
        self.inner.payload()
    }
}

/// Input that can wake an event loop: a subscriber.
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
