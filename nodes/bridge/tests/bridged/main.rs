//! Graphs that the bridge joins: on one machine, over networks, in fleets.

mod fleet;
mod joined;
mod machines;
