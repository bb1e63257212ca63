//! Tests of the bridge: on one machine, over networks, in fleets.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

mod fleet;
mod joined;
mod machines;
