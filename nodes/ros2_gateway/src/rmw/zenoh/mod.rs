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
//! The crate `ros` has the definitions of messages, and `hiroz-schema` makes the hashes. Its sister
//! `hiroz-protocol`, which writes the same keys and tokens, builds only with all transports of
//! Zenoh, most of which are not wanted here.

mod attachment;
mod entity;
mod service;
mod topic;
mod watch;

use attachment::Attachment;
pub(super) use entity::Member;
pub(super) use service::Service;
pub(super) use topic::{Publisher, Subscription};
pub(super) use watch::Watch;
