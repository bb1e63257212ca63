//! A topic on its way in.
//!
//! It waits in a queue; the thread that owns the graph checks it, and writes it into
//! shared memory.

use map::MemoryLimit;
use messages::{MapHeader, Topic, topic};
use network_payload::{Arrival, Arrivals, Received, Wire, WireError};
use transport::{Graph, Publisher, TransportError, monotonic_ns};
use zenoh::Session;
use zenoh_session::{Past, Queue, QueueLimits, Report};

use crate::BridgeError;

/// Receives one topic.
pub(crate) struct Incoming<T: Wire> {
    queue: Queue,
    publisher: Publisher<T>,
    arrivals: Arrivals,
    /// The header of the kept sample that entered last, as it came.
    last: Option<T::Header>,
    /// What the graph may take for a map.
    memory_limit: MemoryLimit,
}

impl<T: Wire> Incoming<T> {
    pub(crate) fn open(
        graph: &Graph,
        session: &Session,
        robot: &str,
        memory_limit: MemoryLimit,
    ) -> Result<Self, BridgeError> {
        let key = network_payload::key::<T>(robot);
        let past = if T::KEPT { Past::Last(1) } else { Past::Gone };
        let limits = QueueLimits::for_any(T::DEPTH.max(4), T::MAX_BYTES);
        let publisher = graph.publisher()?;
        let queue = Queue::open(session, &key, past, limits, graph.waker()?)?;
        Ok(Incoming {
            queue,
            publisher,
            arrivals: Arrivals::default(),
            last: None,
            memory_limit,
        })
    }

    /// Lets what has come since the last call into the graph, if it is sound.
    pub(crate) fn step(&mut self, report: &mut Report) -> Result<(), BridgeError> {
        report.dropped(self.queue.dropped());
        while let Some(found) = self.queue.next_too_long() {
            report.received();
            let (topic, most) = (T::NAME, T::MAX_BYTES);
            let error = WireError::TooLong { topic, found, most };
            report.refused(&BridgeError::from(error))?;
        }
        // As many as fit at once: a flood must not keep the others waiting.
        for _ in 0..self.queue.limits().messages {
            let Some(sample) = self.queue.next() else {
                break;
            };
            report.received();
            let encoding = sample.encoding().to_string();
            match network_payload::decode::<T>(&encoding, &sample.payload().to_bytes()) {
                Ok(message) => match refuse_too_large(&message, self.memory_limit) {
                    Ok(()) => self.enter(message, report)?,
                    Err(error) => report.map_refused(&error)?,
                },
                Err(error) => report.refused(&BridgeError::from(error))?,
            }
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
        if T::NAME == topic::Map::NAME {
            // One that was refused before is no more what is wanted.
            report.map_taken()?;
        }
        Ok(())
    }

    /// Whether it is in the graph already: its sender was started again, and
    /// nothing else is.
    fn is_last(&self, header: &T::Header) -> bool {
        let last = self.last.as_ref();
        last.is_some_and(|last| bytemuck::bytes_of(last) == bytemuck::bytes_of(header))
    }
}

/// What came small may be more than the nodes can hold once they prepare for it.
fn refuse_too_large<T: Wire>(message: &Received<T>, limit: MemoryLimit) -> Result<(), BridgeError> {
    if T::NAME != topic::Map::NAME {
        return Ok(());
    }
    // Every topic is received alike; the map alone is what others prepare for.
    match bytemuck::try_from_bytes::<MapHeader>(bytemuck::bytes_of(&message.header)) {
        Ok(map) => {
            let cells = bytemuck::cast_slice(&message.items);
            Ok(limit.check_cells((map.width, map.height), map.resolution_m, cells)?)
        }
        Err(_) => Ok(()),
    }
}
