//! Rules of the workspace that the compiler does not check.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod builds;
mod cycles;
mod dependencies;
mod links;
mod purity;
mod workspace;
