//! Publisher of a topic, which never waits for slow subscribers.

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

/// Publishes samples of topic `T`. Dropped, it leaves those that subscribers hold.
#[derive(Debug)]
pub struct Publisher<T: Topic> {
    inner: Rc<Inner<T>>,
}

#[derive(Debug)]
struct Inner<T: Topic> {
    port: Port<T>,
    notifier: Notifier<ipc::Service>,
    samples: Samples<T>,
    /// Subscribers at the time late joiners were last served.
    served: RefCell<Vec<u128>>,
    last_sent: Cell<Option<usize>>,
    losses: Losses,
    /// Samples lost by this publisher since it last sent one.
    unsent: Cell<u64>,
}

impl<T: Topic> Publisher<T> {
    /// Creates a publisher whose first segment is for samples of up to `items` items.
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
            .max_loaned_samples(service::MAX_LOANED)
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create()
            .map_err(|error| match error {
                PublisherCreateError::ExceedsMaxSupportedPublishers => {
                    service::too_many::<T>("publishers", T::MAX_PUBLISHERS)
                }
                other => service::failed::<T>("create the publisher of", &other),
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

    pub(crate) fn for_event_loop(&self) -> Weak<dyn Connects> {
        let weak: Weak<Inner<T>> = Rc::downgrade(&self.inner);
        weak
    }

    /// Loans zeroed memory for a sample of `items` items. If shared memory is full, a sample of a
    /// latched topic is refused; others get private memory, and are lost and counted when sent.
    pub fn loan(&self, items: usize) -> Result<Loan<'_, T>, TransportError> {
        Loan::of(self, items)
    }

    /// Sends a sample with copies of these items.
    pub fn send(&self, header: T::Header, items: &[T::Item]) -> Result<(), TransportError> {
        let mut loan = self.loan(items.len())?;
        *loan.header_mut() = header;
        loan.items_mut().copy_from_slice(items);
        loan.send()
    }

    /// True if the topic has subscribers. A killed subscriber counts until it has been cleaned up.
    pub fn has_subscribers(&self) -> bool {
        self.inner.samples.dynamic_config().number_of_subscribers() > 0
    }

    /// Returns the current subscribers.
    pub fn subscribers(&self) -> Peers {
        Peers(self.inner.subscribers())
    }

    /// Returns true if every subscriber has dropped the last sample sent, or has left.
    ///
    /// When a publisher ends, samples not yet received are lost, so a source waits for this, with a
    /// time limit: it may stay false if samples are dropped out of order, or the topic is latched.
    pub fn is_settled(&self) -> Result<bool, TransportError> {
        const { assert!(!T::LATCHED, "a latched topic keeps its newest sample") };
        let Some(last) = self.inner.last_sent.get() else {
            return Ok(true);
        };
        // Reclaims the samples of subscribers that have left.
        self.inner.update_connections()?;
        // iceoryx2 does not tell which samples were received. But it reuses memory only after all
        // subscribers have dropped it, and the last returned first.
        Ok(self.loan(0)?.address() == last)
    }

    pub(crate) fn port(&self) -> &Port<T> {
        &self.inner.port
    }

    /// Wakes the subscribers after the sample at `address` was sent.
    pub(crate) fn sent(&self, address: usize) -> Result<(), TransportError> {
        self.inner.last_sent.set(Some(address));
        let unsent = self.inner.unsent.replace(0);
        if unsent > 0 {
            let topic = T::NAME;
            tracing::warn!("{unsent} samples of topic {topic} were lost: shared memory was full");
        }
        self.inner.wake()
    }

    /// Counts a sample that is not sent because of `full`.
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
            .map_err(|error| service::failed::<T>("send on", &error))
    }

    fn update_connections(&self) -> Result<(), TransportError> {
        self.port
            .update_connections()
            .map_err(|error| service::failed::<T>("send on", &error))
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
        // Connecting needs room, too. Without it, late joiners wait for another tick.
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
