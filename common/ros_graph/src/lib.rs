//! Messages of ROS on their way into a graph, [`replay`]ed from a recording, and out of it,
//! [`export`]ed for files and viewers.

pub mod export;
pub mod replay;
