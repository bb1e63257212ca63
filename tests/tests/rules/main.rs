//! Rules of the workspace that the compiler does not check.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod builds;
mod cycles;
mod dependencies;
mod links;
mod purity;
mod workspace;
