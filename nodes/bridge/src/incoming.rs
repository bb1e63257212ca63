//! A topic received from the network.
//!
//! Messages wait in a queue; the thread that owns the graph checks them and writes them into shared
//! memory.

use map::MemoryLimit;
use messages::{MapHeader, Topic, topic};
use network_payload::{Arrival, Arrivals, Received, Wire, WireError};
use transport::{Graph, Publisher, TransportError, monotonic_ns};
use zenoh_session::{Past, Queue, QueueLimits, Report};

use crate::BridgeError;
use crate::route::{Ends, Route};

pub(crate) struct Incoming<T: Wire> {
    queue: Queue,
    publisher: Publisher<T>,
    arrivals: Arrivals,
    /// Header of the last kept sample, as received.
    last: Option<T::Header>,
    memory_limit: MemoryLimit,
}

impl<T: Wire> Incoming<T> {
    pub(crate) fn open(ends: Ends<'_>) -> Result<Self, BridgeError> {
        let graph = ends.graph;
        let key = network_payload::key::<T>(ends.robot);
        let past = if T::KEPT { Past::Last(1) } else { Past::Gone };
        let limits = QueueLimits::for_any(T::DEPTH.max(4), T::MAX_BYTES);
        let publisher = graph.publisher()?;
        let queue = Queue::open(ends.session, &key, past, limits, graph.waker()?)?;
        Ok(Incoming {
            queue,
            publisher,
            arrivals: Arrivals::default(),
            last: None,
            memory_limit: ends.config.memory.limit(),
        })
    }

    fn enter(
        &mut self,
        mut message: Received<T>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let preamble = message.preamble;
        match self.arrivals.note(preamble.sender, preamble.sequence) {
            Arrival::Repeated => return Ok(()),
            // A kept message is complete in itself; missing earlier ones are no loss.
            Arrival::New { lost } if !T::KEPT => report.dropped(lost),
            Arrival::New { .. } => {}
        }
        if T::KEPT && self.is_last(&message.header) {
            return Ok(());
        }
        self.last = Some(message.header);
        message.rebase(monotonic_ns());
        self.publisher.send(message.header, &message.items)?;
        report.sent();
        if T::NAME == topic::Map::NAME {
            // A map that was refused before is superseded.
            report.map_taken()?;
        }
        Ok(())
    }

    /// Returns true if this sample was published last: then its sender has just restarted.
    fn is_last(&self, header: &T::Header) -> bool {
        let last = self.last.as_ref();
        last.is_some_and(|last| bytemuck::bytes_of(last) == bytemuck::bytes_of(header))
    }
}

impl<T: Wire> Route for Incoming<T> {
    fn step(&mut self, _: &Graph, _: bool, report: &mut Report) -> Result<(), BridgeError> {
        report.dropped(self.queue.dropped());
        while let Some(found) = self.queue.next_too_long() {
            report.received();
            let (topic, most) = (T::NAME, T::MAX_BYTES);
            let error = WireError::TooLong { topic, found, most };
            report.refused(&BridgeError::from(error))?;
        }
        // Limited to one queue length, so that a flood does not block the other topics.
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
}

/// Rejects a map that is small as a message but too large for the nodes to prepare.
fn refuse_too_large<T: Wire>(message: &Received<T>, limit: MemoryLimit) -> Result<(), BridgeError> {
    if T::NAME != topic::Map::NAME {
        return Ok(());
    }
    // All topics are received in the same way, but only the map needs memory in other nodes.
    match bytemuck::try_from_bytes::<MapHeader>(bytemuck::bytes_of(&message.header)) {
        Ok(map) => {
            let cells = bytemuck::cast_slice(&message.items);
            Ok(limit.check_cells((map.width, map.height), map.resolution_m, cells)?)
        }
        Err(_) => Ok(()),
    }
}
