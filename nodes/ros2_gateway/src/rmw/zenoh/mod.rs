//! ROS 2 on Zenoh, with the keys and tokens of `rmw_zenoh`.
//!
//! | what | where |
//! |---|---|
//! | messages of a topic | `<domain>/<topic>/<type>/<type hash>`, CDR, with an [`Attachment`] |
//! | calls of a service | queries of `<domain>/<service>/<type>/<type hash>` |
//! | nodes and their endpoints | liveliness tokens `@ros2_lv/<domain>/<session>/<node>/<entity>/<kind>/…` |
//!
//! Humble writes `TypeHashNotSupported` for each hash. The gateway takes its messages, and
//! publishes on its keys as well: that costs next to nothing without a listener.
//!
//! `hiroz-protocol`, which writes the same keys and tokens, builds only with all transports of
//! Zenoh, most of which are not wanted here.

mod attachment;
mod entity;
mod service;
mod topic;
mod watch;

use ::zenoh::Session;

use super::description::TypeInfo;
use super::{Calls, Discovery, Middleware, Sink, Source, Topic};
use crate::GatewayError;
use attachment::Attachment;
pub(super) use entity::Member;
use service::Service;
use topic::{Publisher, Subscription};
use watch::Watch;

impl Middleware for Member {
    fn domain(&self) -> u32 {
        self.domain
    }

    fn session(&self) -> Option<&Session> {
        Some(&self.session)
    }

    fn missing(&self) -> String {
        self.routers.missing(&self.session)
    }

    fn sink(&self, topic: &Topic<'_>, blocks: bool) -> Result<Box<dyn Sink>, GatewayError> {
        Ok(Box::new(Publisher::open(self, topic, blocks)?))
    }

    fn source(&self, topic: &Topic<'_>, max_bytes: usize) -> Result<Box<dyn Source>, GatewayError> {
        Ok(Box::new(Subscription::open(self, topic, max_bytes)?))
    }

    fn calls(&self, name: &str, info: &TypeInfo) -> Result<Box<dyn Calls>, GatewayError> {
        Ok(Box::new(Service::open(self, name, info)?))
    }

    fn discovery(&self) -> Result<Box<dyn Discovery>, GatewayError> {
        Ok(Box::new(Watch::open(self)?))
    }
}
