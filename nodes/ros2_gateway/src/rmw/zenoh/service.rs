//! A service: each request has one response.

use std::marker::PhantomData;
use std::sync::Arc;

use crossbeam::queue::ArrayQueue;
use ros::RosService;
use transport::{Graph, TransportError, wall_ns};
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::query::{Query, Queryable};
use zenoh_session::{KeyError, Report};

use super::entity::Kind;
use super::{Attachment, Member};
use crate::GatewayError;
use crate::rmw::{Keeping, call, description};

const MAX_WAITING: usize = 16;

pub(crate) struct Service<S> {
    topic: String,
    calls: Arc<ArrayQueue<Query>>,
    /// One for clients that know the type's hash, and one for those of ROS 2 Humble.
    _queryables: [Queryable<()>; 2],
    _token: LivelinessToken,
    service: PhantomData<S>,
}

impl<S: RosService> Service<S> {
    pub(crate) fn open(graph: &Graph, member: &Member, topic: &str) -> Result<Self, GatewayError> {
        let info = description::of_service(S::NAME, S::REQUEST, S::RESPONSE)?;
        // Default quality of service of ROS for services.
        let quality = (Keeping::Reliable, 10);
        let endpoint = member.endpoint(Kind::Service, topic, &info, quality);
        let calls = Arc::new(ArrayQueue::new(MAX_WAITING));
        let offer = |key: &String| -> Result<_, GatewayError> {
            let (calls, waker) = (Arc::clone(&calls), graph.waker()?);
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
            topic: topic.to_owned(),
            calls,
            _queryables: queryables,
            _token: member.show(&endpoint)?,
            service: PhantomData,
        })
    }

    /// Answers the queued calls with `respond`, and counts them; returns the number of answers.
    pub(crate) fn serve(
        &self,
        report: &mut Report,
        mut respond: impl FnMut(S::Request) -> S::Response,
    ) -> Result<u64, TransportError> {
        let mut answered = 0;
        while let Some(call) = self.calls.pop() {
            report.received();
            match self.answer(&call, &mut respond) {
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

    fn answer(
        &self,
        query: &Query,
        respond: impl FnOnce(S::Request) -> S::Response,
    ) -> Result<(), GatewayError> {
        let none = ZBytes::new();
        let payload = query.payload().unwrap_or(&none).to_bytes();
        let attachment = Attachment::decode(&self.topic, query.attachment().unwrap_or(&none))?;
        let response = call::answer::<S>(&self.topic, &payload, respond)?;
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
