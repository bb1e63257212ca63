//! `backcast convert`: laser logs of CARMEN to recordings and back.
//!
//! `carmen` is the text format (pure), `to_recording` and `to_carmen` translate.
//! Lines that hold no laser and no odometry are left out and counted.

mod carmen;
mod command;
mod to_carmen;
mod to_recording;

pub(crate) use command::{Config, NOTES, run};
