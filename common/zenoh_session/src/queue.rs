//! Queue of messages from the network for the thread that owns the graph.
//!
//! Zenoh calls back on its own threads; they only put messages into a bounded queue and wake the
//! event loop. In a flood, the oldest messages are dropped and counted.

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use crossbeam::queue::ArrayQueue;
use transport::Waker;
use zenoh::bytes::{Encoding, ZBytes};
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

use crate::KeyError;

/// Largest size of what comes with a payload: the encoding and an attachment, in bytes.
pub const ENVELOPE_BYTES: usize = 4096;

/// Returns the size of a message in bytes. Its payload is only a part of what its sender chooses,
/// and of what is kept while it waits.
pub fn message_bytes(encoding: Option<&Encoding>, parts: [Option<&ZBytes>; 2]) -> usize {
    let parts = parts.into_iter().flatten().map(ZBytes::len);
    let encoding = encoding.map_or(0, |encoding| Cow::from(encoding).len());
    parts.fold(encoding, usize::saturating_add)
}

fn sample_bytes(sample: &Sample) -> usize {
    let parts = [Some(sample.payload()), sample.attachment()];
    message_bytes(Some(sample.encoding()), parts)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueueLimits {
    pub messages: usize,
    /// Largest size of one message, in bytes, without [`ENVELOPE_BYTES`].
    pub message_bytes: usize,
    /// Largest total size of waiting messages, in bytes.
    pub bytes: usize,
}

impl QueueLimits {
    /// Returns limits for this many messages of the largest size.
    pub fn for_any(messages: usize, message_bytes: usize) -> Self {
        QueueLimits {
            messages,
            message_bytes,
            bytes: messages.saturating_mul(message_bytes.saturating_add(ENVELOPE_BYTES)),
        }
    }
}

/// Selects messages that were sent before the subscription.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Past {
    Gone,
    /// This many of each sender that keeps them with Zenoh's advanced publisher.
    Last(usize),
}

/// Waiting messages of one subscription, which ends when this is dropped.
pub struct Queue {
    waiting: Arc<Waiting>,
    _subscriber: Box<dyn Send + Sync>,
}

struct Waiting {
    samples: ArrayQueue<Sample>,
    limits: QueueLimits,
    /// Total size of the waiting messages, in bytes.
    bytes: AtomicUsize,
    /// Messages dropped because the queue was full.
    dropped: AtomicU64,
    /// Messages above the size limit, and the size of the last one.
    too_long: AtomicU64,
    too_long_bytes: AtomicUsize,
}

impl Queue {
    /// Subscribes to `key`.
    ///
    /// # Panics
    /// `limits.messages` is 0.
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
        let failed = KeyError::when("subscribe to", key);
        let _subscriber: Box<dyn Send + Sync> = match past {
            // The advanced subscriber is not used: it would take a message for a repetition if its
            // time is before that of an earlier one by the same clock, and a router that adds the
            // times has one clock for all its senders.
            Past::Gone => Box::new(subscriber.wait().map_err(failed)?),
            // Senders number the messages that they keep.
            Past::Last(messages) => {
                let history = HistoryConfig::default().max_samples(messages);
                let subscriber = subscriber
                    .history(history.detect_late_publishers())
                    .recovery(RecoveryConfig::default().heartbeat());
                Box::new(subscriber.wait().map_err(failed)?)
            }
        };
        Ok(Queue {
            waiting,
            _subscriber,
        })
    }

    pub fn next(&self) -> Option<Sample> {
        self.waiting.take()
    }

    /// Returns the limits. An event loop that takes at most `messages` at once does not starve its
    /// other inputs, however fast messages come.
    pub fn limits(&self) -> QueueLimits {
        self.waiting.limits
    }

    /// Returns the number of messages lost since the last call because the queue was full.
    pub fn dropped(&self) -> u64 {
        self.waiting.dropped.swap(0, Ordering::Relaxed)
    }

    /// Returns the size in bytes of a message above the size limit, once for each; if there were
    /// several, the size of the last one.
    pub fn next_too_long(&self) -> Option<usize> {
        let take = |count: u64| count.checked_sub(1);
        let (order, counter) = (Ordering::Relaxed, &self.waiting.too_long);
        counter.fetch_update(order, order, take).ok()?;
        Some(self.waiting.too_long_bytes.load(order))
    }
}

impl Waiting {
    fn put(&self, sample: Sample) {
        let bytes = sample_bytes(&sample);
        if bytes > self.limits.message_bytes.saturating_add(ENVELOPE_BYTES) {
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
        self.bytes
            .fetch_sub(sample_bytes(sample), Ordering::Relaxed);
    }
}
