//! `backcast doctor`: what is wrong with a recording.
//!
//! `ailment` is what can be said, `patient` gathers what is looked at in one
//! pass over the messages, and `checks` judges it. Nothing is repaired.

mod ailment;
mod checks;
mod command;
mod delay;
mod patient;

pub use command::{Config, NOTES, run};
