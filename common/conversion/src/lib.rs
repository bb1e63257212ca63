//! From the messages of the graph to those of ROS, and back.
//!
//! What a recording holds and what a ROS 2 robot is told are made here, once. Pure;
//! refuses what no message of the other side can say.

pub mod diagnostics;
mod error;
pub mod lasers;
pub mod measurements;
pub mod planar;
pub mod poses;

pub use error::Unsayable;
