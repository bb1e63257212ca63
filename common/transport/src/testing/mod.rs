//! Helpers for tests of nodes. They panic and wait without a time limit, because a test cannot know
//! the speed of the machine; only a test that hangs for minutes is ended.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod isolated;
mod node_process;
mod own_file_system;
mod waiting;
mod watch;

pub use isolated::Isolated;
pub use node_process::{NodeProcess, StoppedAtEnd};
pub use own_file_system::OwnFileSystem;
pub use waiting::{
    wait_for, wait_for_health, wait_for_next, wait_for_state, wait_to_see, wait_until,
    wait_until_ready,
};
pub use watch::allow_long;
