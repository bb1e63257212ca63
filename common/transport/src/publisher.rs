//! The sending end of a topic.
//!
//! A subscriber that is too slow loses its oldest samples; it never holds the
//! publisher up, and the publisher never waits for anybody.

mod loan;

use std::cell::{Cell, RefCell};
use std::rc::{Rc, Weak};

use iceoryx2::node::Node;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::{Publisher as IoxPublisher, PublisherCreateError};
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::prelude::{
    AllocationStrategy, BackpressureStrategy, CallbackProgression, PortFactory, ipc,
};
use messages::Topic;

use crate::header::Header;
use crate::idle::Connects;
use crate::losses::Losses;
use crate::service::{self, Samples};
use crate::{Peers, TransportError, space};

pub use loan::Loan;

pub(crate) type Port<T> =
    IoxPublisher<ipc::Service, [<T as Topic>::Item], Header<<T as Topic>::Header>>;

/// Sends samples of topic `T`. When it is dropped, its memory goes with the last
/// sample that somebody holds.
#[derive(Debug)]
pub struct Publisher<T: Topic> {
    inner: Rc<Inner<T>>,
}

#[derive(Debug)]
struct Inner<T: Topic> {
    port: Port<T>,
    notifier: Notifier<ipc::Service>,
    samples: Samples<T>,
    /// The subscribers that were there when late joiners were last served.
    served: RefCell<Vec<u128>>,
    /// Where the sample lies that was sent last.
    last_sent: Cell<Option<usize>>,
    /// Of the whole process.
    losses: Losses,
    /// Of this publisher, since one was sent last.
    unsent: Cell<u64>,
}

impl<T: Topic> Publisher<T> {
    /// Samples that may be filled at the same time.
    pub const MAX_LOANED: usize = service::MAX_LOANED;

    /// A publisher whose first segment holds samples of up to `items` items; it
    /// grows by itself.
    pub(crate) fn create(
        node: &Node<ipc::Service>,
        items: usize,
        losses: Losses,
    ) -> Result<Self, TransportError> {
        space::ensure_free(T::NAME, 0)?;
        let samples = service::open_samples::<T>(node)?;
        let notifier = service::notifier::<T>(node)?;
        let port = samples
            .publisher_builder()
            .initial_max_slice_len(items)
            .allocation_strategy(AllocationStrategy::PowerOfTwo)
            .max_loaned_samples(Self::MAX_LOANED)
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create()
            .map_err(|error| match error {
                PublisherCreateError::ExceedsMaxSupportedPublishers => {
                    service::too_many_publishers::<T>()
                }
                other => service::port_failed::<T>("publisher", &other),
            })?;
        Ok(Publisher {
            inner: Rc::new(Inner {
                port,
                notifier,
                samples,
                served: RefCell::default(),
                last_sent: Cell::new(None),
                losses,
                unsent: Cell::new(0),
            }),
        })
    }

    /// For the event loop.
    pub(crate) fn for_event_loop(&self) -> Weak<dyn Connects> {
        let weak: Weak<Inner<T>> = Rc::downgrade(&self.inner);
        weak
    }

    /// Memory for a sample of `items` items in shared memory, all of them and
    /// the header zero, to be filled in place.
    ///
    /// # Errors
    /// [`TransportError::SharedMemoryFull`] where shared memory has no room for
    /// it and the topic is latched, or the process has no room for it either (on other
    /// topics it is lost when it is sent, and counted),
    /// [`TransportError::TooLarge`] where no memory could have,
    /// [`TransportError::Loan`] where [`Publisher::MAX_LOANED`] samples are being
    /// filled already.
    pub fn loan(&self, items: usize) -> Result<Loan<'_, T>, TransportError> {
        Loan::of(self, items)
    }

    /// Whether anybody would get what is sent. A subscriber that was killed
    /// counts until it has been cleaned away.
    #[must_use]
    pub fn has_subscribers(&self) -> bool {
        self.inner.samples.dynamic_config().number_of_subscribers() > 0
    }

    /// Those who get what is sent from now on.
    #[must_use]
    pub fn subscribers(&self) -> Peers {
        Peers::of(self.inner.subscribers())
    }

    /// Whether every subscriber is done with the sample that was sent last, and
    /// so with all before it: has taken it and let go of it, or has left. One
    /// that was killed counts until it has been cleaned away.
    ///
    /// A publisher that ends takes along what it has sent since a subscriber
    /// last looked, so a source that ends by itself waits for this before, though
    /// not for ever: where a subscriber drops samples in another order than
    /// they came, this may stay false. A latched topic keeps its newest sample
    /// and has no such moment.
    ///
    /// # Errors
    /// As [`Publisher::loan`]; there must be no loan at the time.
    pub fn is_settled(&self) -> Result<bool, TransportError> {
        const { assert!(!T::LATCHED, "a latched topic keeps its newest sample") };
        let Some(last) = self.inner.last_sent.get() else {
            return Ok(true);
        };
        // Those that have left give back what they had.
        self.inner.update_connections()?;
        // iceoryx2 does not say who has taken what. But it gives memory out
        // again only once nobody holds it, and then what came back last first.
        Ok(self.loan(0)?.address() == last)
    }

    pub(crate) fn port(&self) -> &Port<T> {
        &self.inner.port
    }

    /// Wakes the subscribers, after the sample at `address` was sent.
    pub(crate) fn sent(&self, address: usize) -> Result<(), TransportError> {
        self.inner.last_sent.set(Some(address));
        let unsent = self.inner.unsent.replace(0);
        if unsent > 0 {
            let topic = T::NAME;
            tracing::warn!("{unsent} samples of topic {topic} were lost: shared memory was full");
        }
        self.inner.wake()
    }
}

impl<T: Topic> Publisher<T> {
    /// A sample is not sent, because of `full`.
    pub(crate) fn lost(&self, full: &TransportError) {
        let unsent = self.inner.unsent.get();
        if unsent == 0 {
            tracing::warn!("samples are lost: {full}");
        }
        self.inner.unsent.set(unsent + 1);
        self.inner.losses.add(full);
    }
}

impl<T: Topic> Inner<T> {
    fn wake(&self) -> Result<(), TransportError> {
        self.notifier
            .notify()
            .map(drop)
            .map_err(|error| send_failed::<T>(&error))
    }

    fn update_connections(&self) -> Result<(), TransportError> {
        self.port
            .update_connections()
            .map_err(|error| send_failed::<T>(&error))
    }

    fn subscribers(&self) -> Vec<u128> {
        let mut ids = Vec::new();
        self.samples.dynamic_config().list_subscribers(|details| {
            ids.push(details.subscriber_id.value());
            CallbackProgression::Continue
        });
        ids
    }
}

impl<T: Topic> Connects for Inner<T> {
    fn serve_late_joiners(&self) -> Result<(), TransportError> {
        let subscribers = self.subscribers();
        // To connect takes room, too. Without it they wait for another tick.
        if *self.served.borrow() == subscribers || space::ensure_free(T::NAME, 0).is_err() {
            return Ok(());
        }
        self.update_connections()?;
        if T::LATCHED {
            self.wake()?;
        }
        self.served.replace(subscribers);
        Ok(())
    }
}

pub(crate) fn send_failed<T: Topic>(error: &dyn std::fmt::Debug) -> TransportError {
    TransportError::Send {
        topic: T::NAME,
        reason: format!("{error:?}"),
    }
}
