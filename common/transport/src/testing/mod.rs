//! Helpers for tests of nodes: a graph of their own, the node as a process, and waiting for its
//! messages.
//!
//! Everything here fails the test by panicking and waits without a time limit, because a test
//! cannot know the speed of the machine; only a test that hangs for minutes is ended. Nodes
//! themselves use none of it.

#![allow(
    clippy::unwrap_used,
    reason = "what tests share fails the test, as tests do"
)]

mod isolated;
mod node_process;
mod own_file_system;
mod waiting;
mod watch;

pub use isolated::Isolated;
pub use node_process::NodeProcess;
pub use own_file_system::OwnFileSystem;
pub use waiting::{wait_for, wait_for_health, wait_for_next, wait_until, wait_until_ready};
pub use watch::allow_long;
