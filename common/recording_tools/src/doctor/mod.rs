//! `backcast doctor`: what is wrong with a recording.
//!
//! `finding` is what can be said, `survey` gathers what is looked at in one
//! pass over the messages, and `checks` judges it. Nothing is repaired.

mod checks;
mod command;
mod delay;
mod finding;
mod survey;

pub use command::{Config, NOTES, run};
