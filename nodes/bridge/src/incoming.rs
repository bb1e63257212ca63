//! A topic on its way in.
//!
//! Zenoh calls on threads of its own; they only put what came into a queue that
//! never grows, and wake the thread that owns the graph. That one checks, and
//! writes into shared memory. A flood pushes out the oldest, which is counted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crossbeam::queue::ArrayQueue;
use transport::{Graph, Publisher, TransportError, Waker, monotonic_ns};
use wire::{Arrival, Arrivals, Received, Wire, WireError};
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedSubscriber, AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

use crate::BridgeError;
use crate::report::Report;

/// Receives one topic.
pub(crate) struct Incoming<T: Wire> {
    /// Receives as long as it lives.
    _subscriber: AdvancedSubscriber<()>,
    waiting: Arc<Waiting>,
    publisher: Publisher<T>,
    arrivals: Arrivals,
    /// The header of the kept sample that entered last, as it came.
    last: Option<T::Header>,
}

/// What came and was not looked at yet.
struct Waiting {
    samples: ArrayQueue<Sample>,
    /// Pushed out by later ones.
    dropped: AtomicU64,
    /// Larger than a message can be, and the size of the last such.
    too_long: AtomicU64,
    too_long_bytes: AtomicU64,
}

impl<T: Wire> Incoming<T> {
    pub(crate) fn open(graph: &Graph, session: &Session, robot: &str) -> Result<Self, BridgeError> {
        let waiting = Arc::new(Waiting {
            samples: ArrayQueue::new(T::DEPTH.max(4)),
            dropped: AtomicU64::new(0),
            too_long: AtomicU64::new(0),
            too_long_bytes: AtomicU64::new(0),
        });
        let publisher = graph.publisher()?;
        let subscriber = declare::<T>(session, robot, &waiting, graph.waker()?)?;
        Ok(Incoming {
            _subscriber: subscriber,
            waiting,
            publisher,
            arrivals: Arrivals::default(),
            last: None,
        })
    }

    /// Lets what has come since the last call into the graph, if it is sound.
    pub(crate) fn step(&mut self, report: &mut Report) -> Result<(), BridgeError> {
        report.dropped(self.waiting.dropped.swap(0, Ordering::Relaxed));
        self.refuse_too_long(report)?;
        // As many as fit at once: a flood must not keep the others waiting.
        for _ in 0..self.waiting.samples.capacity() {
            let Some(sample) = self.waiting.samples.pop() else {
                break;
            };
            report.received();
            let encoding = sample.encoding().to_string();
            match wire::decode::<T>(&encoding, &sample.payload().to_bytes()) {
                Ok(message) => self.enter(message, report)?,
                Err(error) => report.refused(&error.into())?,
            }
        }
        Ok(())
    }

    fn refuse_too_long(&self, report: &mut Report) -> Result<(), TransportError> {
        let found = self.waiting.too_long_bytes.load(Ordering::Relaxed);
        for _ in 0..self.waiting.too_long.swap(0, Ordering::Relaxed) {
            report.received();
            let error = WireError::TooLong {
                topic: T::NAME,
                found: usize::try_from(found).unwrap_or(usize::MAX),
                most: T::MAX_BYTES,
            };
            report.refused(&error.into())?;
        }
        Ok(())
    }

    fn enter(
        &mut self,
        mut message: Received<T>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let preamble = message.preamble;
        match self.arrivals.note(preamble.sender, preamble.sequence) {
            Arrival::Repeated => return Ok(()),
            // What is kept says all by itself; the ones before it are no loss.
            Arrival::New { lost } if !T::KEPT => report.dropped(lost),
            Arrival::New { .. } => {}
        }
        if T::KEPT && self.is_last(&message.header) {
            return Ok(());
        }
        self.last = Some(message.header);
        message.rebase(monotonic_ns());
        let mut loan = self.publisher.loan(message.items.len())?;
        *loan.header_mut() = message.header;
        loan.items_mut().copy_from_slice(&message.items);
        loan.send()?;
        report.sent();
        Ok(())
    }

    /// Whether it is in the graph already: its sender was started anew, and
    /// nothing else is.
    fn is_last(&self, header: &T::Header) -> bool {
        let last = self.last.as_ref();
        last.is_some_and(|last| bytemuck::bytes_of(last) == bytemuck::bytes_of(header))
    }
}

fn declare<T: Wire>(
    session: &Session,
    robot: &str,
    waiting: &Arc<Waiting>,
    waker: Waker,
) -> Result<AdvancedSubscriber<()>, BridgeError> {
    let key = wire::key::<T>(robot);
    let waiting = Arc::clone(waiting);
    let subscriber = session
        .declare_subscriber(key.clone())
        .callback(move |sample| {
            waiting.put::<T>(sample);
            waker.wake();
        })
        .advanced();
    let subscriber = if T::KEPT {
        let history = HistoryConfig::default().max_samples(1);
        subscriber
            .history(history.detect_late_publishers())
            .recovery(RecoveryConfig::default().heartbeat())
    } else {
        subscriber
    };
    subscriber.wait().map_err(|source| BridgeError::Key {
        action: "subscribe to",
        key,
        source,
    })
}

impl Waiting {
    fn put<T: Wire>(&self, sample: Sample) {
        if sample.kind() != SampleKind::Put {
            return;
        }
        let bytes = sample.payload().len();
        if bytes > T::MAX_BYTES {
            self.too_long_bytes.store(bytes as u64, Ordering::Relaxed);
            self.too_long.fetch_add(1, Ordering::Relaxed);
        } else if self.samples.force_push(sample).is_some() {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }
}
