//! The robot's side: a node of ROS 2 with its topics and services, on any middleware.
//!
//! `zenoh` speaks the protocol of `rmw_zenoh`, and `dds` that of Fast DDS and Cyclone DDS; `any` is
//! one of them, chosen at the start. The other files are pure and serve both.

mod any;
mod call;
mod dds;
mod description;
mod expected;
mod name;
mod received;
mod zenoh;

pub(crate) use any::{Member, Publisher, Service, Subscription, Watch};
pub(crate) use expected::Seen;
pub(crate) use name::resolve;

/// Reliability and durability of a topic, in the words of ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keeping {
    /// Best effort, volatile: for sensors.
    Fresh,
    /// Reliable, volatile.
    Reliable,
    /// Reliable, transient local: late subscribers get the last messages of each sender.
    Kept,
}
