//! Messages from the network, on their way to the thread that owns the graph.
//!
//! Zenoh calls on threads of its own; they only put what came into a queue that
//! never grows, and wake the event loop. A flood pushes out the oldest, which is
//! counted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use crossbeam::queue::ArrayQueue;
use transport::Waker;
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedSubscriber, AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

use crate::KeyError;

/// What opening a queue tries.
const ACTION: &str = "subscribe to";

/// How much may wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueueLimits {
    /// Messages.
    pub messages: usize,
    /// Bytes of one message.
    pub message_bytes: usize,
    /// Bytes of all of them.
    pub bytes: usize,
}

impl QueueLimits {
    /// For this many messages, each as long as it may be.
    #[must_use]
    pub fn for_any(messages: usize, message_bytes: usize) -> Self {
        QueueLimits {
            messages,
            message_bytes,
            bytes: messages.saturating_mul(message_bytes),
        }
    }
}

/// Which messages come that were sent before somebody listened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Past {
    /// None.
    Gone,
    /// This many of each sender, who keeps them by Zenoh's advanced publisher.
    Last(usize),
}

/// What came and was not looked at yet. Receives as long as it lives.
pub struct Queue {
    waiting: Arc<Waiting>,
    _subscriber: Subscription,
}

/// Listens until it is dropped.
enum Subscription {
    /// To what comes. The advanced one would take a message for a repetition that has
    /// an earlier time than one before it by the same clock, and a router that gives
    /// the times has one for all who send through it.
    Live { _subscriber: Subscriber<()> },
    /// Also to what was. Those who send it number their messages.
    Kept { _subscriber: AdvancedSubscriber<()> },
}

struct Waiting {
    samples: ArrayQueue<Sample>,
    limits: QueueLimits,
    /// Of all payloads that wait.
    bytes: AtomicUsize,
    /// Pushed out by later ones, or too large.
    dropped: AtomicU64,
    /// Longer than a message can be; and the size of the last such.
    too_long: AtomicU64,
    too_long_bytes: AtomicUsize,
}

impl Queue {
    /// Subscribes to a key.
    ///
    /// # Errors
    /// If Zenoh refuses.
    ///
    /// # Panics
    /// If there is room for no message.
    pub fn open(
        session: &Session,
        key: &str,
        past: Past,
        limits: QueueLimits,
        waker: Waker,
    ) -> Result<Self, KeyError> {
        let waiting = Arc::new(Waiting {
            samples: ArrayQueue::new(limits.messages),
            limits,
            bytes: AtomicUsize::new(0),
            dropped: AtomicU64::new(0),
            too_long: AtomicU64::new(0),
            too_long_bytes: AtomicUsize::new(0),
        });
        let to = Arc::clone(&waiting);
        let subscriber = session.declare_subscriber(key.to_owned());
        let subscriber = subscriber.callback(move |sample| {
            if sample.kind() == SampleKind::Put {
                to.put(sample);
                waker.wake();
            }
        });
        let _subscriber = match past {
            Past::Gone => Subscription::Live {
                _subscriber: subscriber.wait().map_err(KeyError::when(ACTION, key))?,
            },
            Past::Last(messages) => {
                let history = HistoryConfig::default().max_samples(messages);
                let subscriber = subscriber
                    .history(history.detect_late_publishers())
                    .recovery(RecoveryConfig::default().heartbeat());
                Subscription::Kept {
                    _subscriber: subscriber.wait().map_err(KeyError::when(ACTION, key))?,
                }
            }
        };
        Ok(Queue {
            waiting,
            _subscriber,
        })
    }

    /// The oldest that waits.
    #[must_use]
    pub fn next(&self) -> Option<Sample> {
        self.waiting.take()
    }

    /// Most messages that can wait: who takes no more at once keeps nobody else
    /// waiting, however fast they come.
    #[must_use]
    pub fn limits(&self) -> QueueLimits {
        self.waiting.limits
    }

    /// How many were lost since the last call because the queue was full.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.waiting.dropped.swap(0, Ordering::Relaxed)
    }

    /// The bytes of a message that was not let in at all, once for each such; where
    /// there were several, those of the last.
    #[must_use]
    pub fn next_too_long(&self) -> Option<usize> {
        let take = |count: u64| count.checked_sub(1);
        let (order, counter) = (Ordering::Relaxed, &self.waiting.too_long);
        counter.fetch_update(order, order, take).ok()?;
        Some(self.waiting.too_long_bytes.load(order))
    }
}

impl Waiting {
    fn put(&self, sample: Sample) {
        let bytes = sample.payload().len();
        if bytes > self.limits.message_bytes {
            self.too_long_bytes.store(bytes, Ordering::Relaxed);
            self.too_long.fetch_add(1, Ordering::Relaxed);
            return;
        }
        if self.bytes.load(Ordering::Relaxed).saturating_add(bytes) > self.limits.bytes {
            self.dropped.fetch_add(1, Ordering::Relaxed);
            return;
        }
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
        if let Some(oldest) = self.samples.force_push(sample) {
            self.forget(&oldest);
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn take(&self) -> Option<Sample> {
        let sample = self.samples.pop()?;
        self.forget(&sample);
        Some(sample)
    }

    fn forget(&self, sample: &Sample) {
        let bytes = sample.payload().len();
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
    }
}
