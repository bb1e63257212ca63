//! `backcast simulate`: a recording of a drive through a map that no robot
//! drove, with the truth in it.
//!
//! What is true and what a sensor makes of it comes from crate `simulation`; here
//! it becomes messages and a file. It searches nothing.

mod command;
mod messages;

pub use command::{Config, run};
