//! A graph as its user starts and asks it: `run` builds, starts and supervises its
//! processes, `check` says what is wrong with its descriptor, and `control` speaks with
//! a launcher that runs. It localizes nothing and links none of the nodes.

pub mod check;
pub mod control;
pub mod descriptor;
mod error;
mod installed;
pub mod run;

pub use error::LauncherError;
pub use installed::node;
