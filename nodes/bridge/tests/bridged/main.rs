//! Tests of the bridge: on one machine, over networks, in fleets.

mod fleet;
mod joined;
mod machines;
