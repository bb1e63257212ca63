//! ROS 2 as `rmw_zenoh` puts it on Zenoh.
//!
//! | what | where |
//! |---|---|
//! | messages of a topic | `<domain>/<topic>/<type>/<type hash>`, CDR, with an [`Attachment`] |
//! | calls of a service | queries of `<domain>/<service>/<type>/<type hash>` |
//! | who is there | liveliness tokens `@ros2_lv/<domain>/<session>/<node>/<entity>/<kind>/…` |
//!
//! Humble writes `TypeHashNotSupported` for each hash. What it sends is taken, and what is sent is
//! on its keys as well: it costs next to nothing where nobody listens.
//!
//! What a message is made of stands in crate `ros`, hashes are made by
//! `hiroz-schema`. Its sister `hiroz-protocol`, which writes the same keys and tokens,
//! builds with all transports of Zenoh alone, of which most are not wanted here.

mod attachment;
mod entity;
mod publisher;
mod service;
mod subscription;
mod watch;

use attachment::Attachment;
pub(super) use entity::Member;
pub(super) use publisher::Publisher;
pub(super) use service::Service;
pub(super) use subscription::Subscription;
pub(super) use watch::Watch;
