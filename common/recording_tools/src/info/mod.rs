//! `backcast info`: what a recording holds.
//!
//! `contents` gathers it, `text` and its JSON show it. Nothing is judged here;
//! that is `doctor`'s.

mod command;
mod contents;
mod text;

pub use command::{Config, run};
