//! A topic of DDS that is received, message by message.

use std::sync::Arc;
use std::task::{Wake, Waker};

use rustdds::dds::ReadError;
use rustdds::no_key::{DeserializedCacheChange, SimpleDataReader};
use rustdds::{GUID, SampleIdentity};

use super::raw::{AtMost, Payload, Raw};
use crate::GatewayError;

pub(super) struct Reader {
    topic: String,
    reader: SimpleDataReader<Payload, Raw>,
    waker: Waker,
    max_bytes: usize,
}

pub(super) struct Sample {
    /// Message with the header of CDR.
    pub(super) bytes: Vec<u8>,
    /// The publisher, and the message's number among its messages.
    pub(super) identity: SampleIdentity,
    /// Identity of the message to which this one refers, as given by its sender.
    pub(super) related: Option<SampleIdentity>,
}

struct GraphWaker(transport::Waker);

impl Wake for GraphWaker {
    fn wake(self: Arc<Self>) {
        self.0.wake();
    }
}

impl Reader {
    /// Reads a topic that is called `topic` in the log; wakes the graph if there is a waker.
    pub(super) fn new(
        topic: &str,
        reader: SimpleDataReader<Payload, Raw>,
        waker: Option<transport::Waker>,
        max_bytes: usize,
    ) -> Self {
        let waker = waker.map(|waker| Waker::from(Arc::new(GraphWaker(waker))));
        let waker = waker.unwrap_or_else(|| Waker::noop().clone());
        reader.set_waker(Some(waker.clone()));
        Reader {
            topic: topic.to_owned(),
            reader,
            waker,
            max_bytes,
        }
    }

    pub(super) fn guid(&self) -> GUID {
        self.reader.guid()
    }

    pub(super) fn next(&self) -> Option<Result<Sample, GatewayError>> {
        if let Some(next) = self.take() {
            return Some(next);
        }
        // The waker fires once. A message that came between the two looks woke no one.
        self.reader.drain_read_notifications();
        self.reader.set_waker(Some(self.waker.clone()));
        self.take()
    }

    fn take(&self) -> Option<Result<Sample, GatewayError>> {
        let taken = self.reader.try_take_one_with(AtMost(self.max_bytes));
        let taken = taken.map_err(|error| match error {
            ReadError::Deserialization { .. } => "its representation is not plain CDR".to_owned(),
            error => error.to_string(),
        });
        match taken.map_err(GatewayError::decoding(&self.topic)) {
            Ok(change) => change.map(|change| self.sample(change)),
            Err(error) => Some(Err(error)),
        }
    }

    fn sample(&self, change: DeserializedCacheChange<Payload>) -> Result<Sample, GatewayError> {
        let related = change.related_sample_identity();
        let identity = SampleIdentity {
            writer_guid: change.writer_guid(),
            sequence_number: change.sequence_number,
        };
        match change.into_value() {
            Payload::Cdr(bytes) => Ok(Sample {
                bytes,
                identity,
                related,
            }),
            Payload::TooLong(found) => {
                Err(GatewayError::too_long(&self.topic, found, self.max_bytes))
            }
        }
    }
}
