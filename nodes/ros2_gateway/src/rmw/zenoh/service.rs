//! A service: each request has one response.

use std::sync::Arc;

use crossbeam::queue::ArrayQueue;
use transport::{TransportError, wall_ns};
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::query::{Query, Queryable};
use zenoh_session::{KeyError, Report};

use super::entity::Kind;
use super::{Attachment, Member};
use crate::GatewayError;
use crate::rmw::description::TypeInfo;
use crate::rmw::{Calls, Keeping, Respond, Topic};

const MAX_WAITING: usize = 16;

pub(super) struct Service {
    name: String,
    calls: Arc<ArrayQueue<Query>>,
    /// One for clients that know the type's hash, and one for those of ROS 2 Humble.
    _queryables: [Queryable<()>; 2],
    _token: LivelinessToken,
}

impl Service {
    pub(super) fn open(member: &Member, name: &str, info: &TypeInfo) -> Result<Self, GatewayError> {
        // Default quality of service of ROS for services.
        let topic = Topic {
            name,
            info,
            keeping: Keeping::Reliable,
            depth: 10,
        };
        let endpoint = member.endpoint(Kind::Service, &topic);
        let calls = Arc::new(ArrayQueue::new(MAX_WAITING));
        let offer = |key: &String| -> Result<_, GatewayError> {
            let (calls, waker) = (Arc::clone(&calls), member.waker.clone());
            let put = move |call: Query| {
                if let Err(call) = calls.push(call) {
                    // This fails only if the caller has gone.
                    let _ = call.reply_err("busy").wait();
                }
                waker.wake();
            };
            let queryable = member.session.declare_queryable(key.clone());
            let queryable = queryable.complete(true).callback(put).wait();
            Ok(queryable.map_err(KeyError::when("offer", key))?)
        };
        let queryables = [offer(&endpoint.key)?, offer(&endpoint.humble_key)?];
        Ok(Service {
            name: name.to_owned(),
            calls,
            _queryables: queryables,
            _token: member.show(&endpoint)?,
        })
    }

    fn answer(&self, query: &Query, respond: &mut Respond<'_>) -> Result<(), GatewayError> {
        let none = ZBytes::new();
        let payload = query.payload().unwrap_or(&none).to_bytes();
        let attachment = Attachment::decode(&self.name, query.attachment().unwrap_or(&none))?;
        let response = respond(&payload)?;
        // The caller recognises its call by number and sender.
        let attachment = Attachment {
            sent_ns: wall_ns(),
            ..attachment
        };
        let reply = query.reply(query.key_expr(), response);
        let reply = reply.attachment(attachment.encode()).wait();
        Ok(reply.map_err(KeyError::when("answer", query.key_expr()))?)
    }
}

impl Calls for Service {
    fn serve(&self, report: &mut Report, respond: &mut Respond<'_>) -> Result<u64, TransportError> {
        let mut answered = 0;
        while let Some(call) = self.calls.pop() {
            report.received();
            match self.answer(&call, respond) {
                Ok(()) => answered += 1,
                Err(error) => {
                    // This fails only if the caller has gone.
                    let _ = call.reply_err(error.to_string()).wait();
                    report.refused(&error)?;
                }
            }
        }
        Ok(answered)
    }
}
