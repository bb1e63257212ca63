//! `backcast doctor`: what is wrong with a recording.
//!
//! `finding` is what can be said, `survey` gathers what is looked at in one
//! pass over the messages, and `checks` judges it; `sensors` compares the laser with
//! the odometry, as `drive` has them. Nothing is repaired.

mod checks;
mod command;
mod delay;
mod drive;
mod finding;
mod sensors;
mod survey;

pub use command::{Config, NOTES, run};
