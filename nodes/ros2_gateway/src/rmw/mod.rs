//! The robot's side: a node of ROS 2 with its topics and services, on any middleware.
//!
//! `zenoh` speaks the protocol of `rmw_zenoh`, and `dds` that of Fast DDS and Cyclone DDS; `any` is
//! one of them, chosen at the start. The other files are pure and serve both.

mod any;
mod call;
mod dds;
mod description;
mod expected;
mod keeping;
mod name;
mod received;
mod type_info;
mod zenoh;

pub(crate) use any::{Member, Publisher, Service, Subscription, Watch};
pub(crate) use expected::Seen;
pub(crate) use keeping::Keeping;
pub(crate) use name::resolve;
