//! A topic as JSON under the key `<topic>/json`, in addition to its payload.

use std::rc::Rc;

use messages::Topic;
use network_payload::Wire;
use transport::{Graph, Input, Subscriber, monotonic_ns};
use zenoh::Wait;
use zenoh::bytes::Encoding;
use zenoh::pubsub::Publisher;
use zenoh::qos::CongestionControl;
use zenoh_session::{KeyError, Report};

use crate::BridgeError;
use crate::rates::Limit;
use crate::route::{Ends, Route};

/// Sender of a topic as JSON while there is a subscriber.
pub(crate) struct Plain<T: Topic> {
    subscriber: Rc<Subscriber<T>>,
    key: String,
    publisher: Publisher<'static>,
    limit: Limit,
    write: fn(&T::Header, &[T::Item]) -> String,
}

impl<T: Wire> Plain<T> {
    pub(crate) fn open(
        ends: Ends<'_>,
        write: fn(&T::Header, &[T::Item]) -> String,
    ) -> Result<Self, BridgeError> {
        let key = format!("{}/json", network_payload::key::<T>(ends.robot));
        let publisher = ends
            .session
            .declare_publisher(key.clone())
            .encoding(Encoding::APPLICATION_JSON)
            .congestion_control(CongestionControl::Drop)
            .wait()
            .map_err(KeyError::when("publish", &key))?;
        Ok(Plain {
            subscriber: Rc::new(ends.graph.subscriber()?),
            key,
            publisher,
            limit: Limit::of::<T>(&ends.config.rate),
            write,
        })
    }
}

impl<T: Wire> Route for Plain<T> {
    fn input(&self) -> Option<Rc<dyn Input>> {
        Some(self.subscriber.clone())
    }

    fn step(&mut self, _: &Graph, _: bool, report: &mut Report) -> Result<(), BridgeError> {
        while let Some(sample) = self.subscriber.receive()? {
            let status = self.publisher.matching_status().wait();
            let is_wanted = status.map_or(true, |status| status.matching());
            if !is_wanted || !self.limit.admits(monotonic_ns()) {
                continue;
            }
            let text = (self.write)(sample.header(), sample.items());
            if let Err(source) = self.publisher.put(text).wait() {
                report.dropped(1);
                report.refused(&KeyError::when("send on", &self.key)(source))?;
            }
        }
        Ok(())
    }
}
