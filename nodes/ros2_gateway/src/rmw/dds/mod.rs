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
mod entities;
mod member;
mod node;
mod quality;
mod raw;
mod reader;
mod service;
mod topic;
mod watch;

pub(super) use member::Member;
pub(super) use service::Service;
pub(super) use topic::{Publisher, Subscription};
pub(super) use watch::Watch;
