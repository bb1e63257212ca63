//! ROS 2 on RTPS, compatible with Fast DDS and Cyclone DDS (humble and later), by crate `rustdds`.
//!
//! | what | topic | type |
//! |---|---|---|
//! | messages of `/scan` | `rt/scan` | `sensor_msgs::msg::dds_::LaserScan_` |
//! | requests of service `/a/b` | `rq/a/bRequest` | `….srv.dds_::Name_Request_` |
//! | its responses | `rr/a/bReply` | `….srv.dds_::Name_Response_` |
//! | nodes and their endpoints | `ros_discovery_info` | `rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_` |
//!
//! Messages are CDR. Threads of `rustdds` receive them and queue at most the depth of the topic;
//! they are decoded on the thread that owns the graph.

mod discovery;
mod domain;
mod entities;
mod member;
mod node;
mod quality;
mod raw;
mod reader;
mod service;
mod topic;
mod watch;

use super::description::TypeInfo;
use super::{Calls, Discovery, Middleware, Sink, Source, Topic};
use crate::GatewayError;
pub(super) use member::Member;
use service::Service;
use topic::{Publisher, Subscription};
use watch::Watch;

impl Middleware for Member {
    fn domain(&self) -> u32 {
        self.id
    }

    /// Exchanges lists of nodes and their topics with other participants.
    fn tick(&self) {
        self.node.tick();
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
        Ok(Box::new(Watch::open(self)))
    }
}
