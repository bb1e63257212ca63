//! The robot's side: a node of ROS 2 with its topics and services, whatever the middleware.
//!
//! `zenoh` speaks as `rmw_zenoh` does and `dds` as Fast DDS and Cyclone DDS do; `any` is one
//! of them, chosen at the start. The other files are pure and serve both.

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
