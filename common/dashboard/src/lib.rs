//! A web page to watch robots, and the API behind it.
//!
//! | file | contents |
//! |---|---|
//! | `view` | the JSON and images sent to the page, made from the messages of a graph; pure |
//! | `robot` | state of one robot, and its viewers |
//! | `robots` | all known robots |
//! | `server` | HTTP and WebSocket: access control, API, page |
//! | `webhook` | state changes of the robots, posted to another server |
//!
//! The caller is the source of the messages: it passes each one to a [`Robot`] and carries out the
//! requests that it receives. No source waits for a viewer: a message is serialized once and sent
//! to all; a slow viewer loses messages and is sent their number. The crate does not localize, and
//! shows only what a node has published.

mod error;
mod options;
mod robot;
mod robots;
mod server;
mod token;
mod view;
mod webhook;

pub use error::DashboardError;
pub use options::Options;
pub use robot::{Request, Robot, hint};
pub use robots::Robots;
pub use server::Server;
pub use view::{Abilities, Recording};
