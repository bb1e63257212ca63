//! A service of type `std_srvs/srv/Empty`: an empty request with an empty reply.

use std::sync::Arc;

use crossbeam::queue::ArrayQueue;
use transport::{Graph, wall_ns};
use zenoh::Wait;
use zenoh::liveliness::LivelinessToken;
use zenoh::query::{Query, Queryable};
use zenoh_session::KeyError;

use super::entity::Kind;
use super::{Attachment, Keeping, Member, description};
use crate::GatewayError;

/// Calls that wait for their answer; more are turned away.
const MAX_WAITING: usize = 16;

/// Most bytes of a request: a header and the one byte of a message without fields,
/// filled up.
const MAX_BYTES: usize = 16;

/// A message without fields in CDR, little-endian: ROS gives it one of eight bits.
const EMPTY: [u8; 5] = [0, 1, 0, 0, 0];

/// Offers the service as long as it lives.
pub(crate) struct Service {
    topic: String,
    key: String,
    calls: Arc<ArrayQueue<Query>>,
    _queryable: Queryable<()>,
    _token: LivelinessToken,
}

impl Service {
    pub(crate) fn open(graph: &Graph, member: &Member, topic: &str) -> Result<Self, GatewayError> {
        let info = description::of_service("std_srvs/srv/Empty", "", "")?;
        // As ROS has it for services.
        let quality = (Keeping::Reliable, 10);
        let endpoint = member.endpoint(Kind::Service, topic, &info, quality);
        let calls = Arc::new(ArrayQueue::new(MAX_WAITING));
        let waker = graph.waker()?;
        let put = {
            let calls = Arc::clone(&calls);
            move |call: Query| {
                if let Err(call) = calls.push(call) {
                    // Where this fails, the caller has gone.
                    let _ = call.reply_err("busy").wait();
                }
                waker.wake();
            }
        };
        let queryable = member.session().declare_queryable(endpoint.key.clone());
        let queryable = queryable.complete(true).callback(put).wait();
        let queryable = queryable.map_err(KeyError::when("offer", &endpoint.key))?;
        Ok(Service {
            topic: topic.to_owned(),
            calls,
            _queryable: queryable,
            _token: member.show(&endpoint)?,
            key: endpoint.key,
        })
    }

    /// Answers the next call, and says that there was one.
    pub(crate) fn next(&self) -> Option<Result<(), GatewayError>> {
        let call = self.calls.pop()?;
        let outcome = self.answer(&call);
        if let Err(error) = &outcome {
            let _ = call.reply_err(error.to_string()).wait();
        }
        Some(outcome)
    }

    fn answer(&self, call: &Query) -> Result<(), GatewayError> {
        let found = call.payload().map_or(0, zenoh::bytes::ZBytes::len);
        if found > MAX_BYTES {
            return Err(GatewayError::TooLong {
                topic: self.topic.clone(),
                found,
                most: MAX_BYTES,
            });
        }
        let none = zenoh::bytes::ZBytes::new();
        let request = Attachment::decode(&self.topic, call.attachment().unwrap_or(&none))?;
        // The caller knows its call again by number and sender.
        let attachment = Attachment {
            sent_ns: wall_ns(),
            ..request
        };
        let reply = call.reply(self.key.as_str(), EMPTY.as_slice());
        let reply = reply.attachment(attachment.encode()).wait();
        Ok(reply.map_err(KeyError::when("answer", &self.key))?)
    }
}
